#include "construct/construct.h"
#include "base/error.h"
#define W __attribute__((weak))
#define P(e) { (void)out; return error_set(e, LMN_UNSUPPORTED, "not there yet"); }
#pragma GCC diagnostic ignored "-Wunused-parameter"
W void region_release(region *r) {}
W lmn_status construct_heights(polyhedron *out, const double *h, size_t c, size_t r, bool ce, lmn_error *e) P(e)
W lmn_status construct_square(region *out, const double s[2], bool c, lmn_error *e) P(e)
W lmn_status construct_circle(region *out, double r, facets f, lmn_error *e) P(e)
W lmn_status construct_polygon(region *out, const point2 *p, size_t n, const uint32_t *c, const uint32_t *s, size_t k, lmn_error *e) P(e)
W lmn_status region_combine(region *out, const region *o, size_t c, region_operation op, lmn_error *e) P(e)
W lmn_status region_transform(region *out, const region *r, const double m[6], lmn_error *e) P(e)
W lmn_status region_offset(region *out, const region *r, double d, bool ro, bool c, facets f, lmn_error *e) P(e)
W lmn_status region_hull(region *out, const region *o, size_t c, lmn_error *e) P(e)
W lmn_status region_minkowski(region *out, const region *a, const region *b, lmn_error *e) P(e)
W bool region_bounds(const region *r, double l[2], double h[2]) { return false; }
W lmn_status construct_text(region *out, const char *u, const text_style *s, facets f, bool *m, lmn_error *e) P(e)
W lmn_status construct_linear_extrude(polyhedron *out, const region *r, const linear_extrusion *h, lmn_error *e) P(e)
W lmn_status construct_rotate_extrude(polyhedron *out, const region *r, double a, facets f, lmn_error *e) P(e)
W lmn_status polyhedron_hull(polyhedron *out, const polyhedron *o, size_t c, lmn_error *e) P(e)
W lmn_status polyhedron_minkowski(polyhedron *out, const polyhedron *a, const polyhedron *b, lmn_error *e) P(e)
W lmn_status polyhedron_slice(region *out, const polyhedron *p, lmn_error *e) P(e)
W lmn_status polyhedron_shadow(region *out, const polyhedron *p, lmn_error *e) P(e)
