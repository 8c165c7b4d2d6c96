/* What the tests of .csg files share: loading text, counting warnings, comparing bounds. */
#ifndef TESTS_CSG_SUPPORT_H
#define TESTS_CSG_SUPPORT_H

#include "import_support.h"

#include <math.h>

#include "scene/solid.h"

static inline lmn_scene *load_text(const char *text)
{
    return load_or_fail(temp_file("model.csg", text, strlen(text)));
}

static inline lmn_status status_of(const char *text, lmn_error *error)
{
    return load_status(temp_file("model.csg", text, strlen(text)), error);
}

static inline const solid *only_solid(const lmn_scene *s)
{
    assert_int_equal(s->part_count, 1);
    assert_int_equal(s->solid_count, 1 + s->ghost_count);
    return &s->solids[0];
}

static inline size_t warnings_of(const lmn_scene *s, warning_code code)
{
    size_t count = 0;
    for (size_t i = 0; i < s->warnings.count; i++)
        count += s->warnings.items[i].code == code ? s->warnings.items[i].count : 0;
    return count;
}

static inline void check_box(const lmn_scene *s, const double low[3], const double high[3], double within)
{
    lmn_scene_info info = lmn_scene_info_of(s);
    for (int i = 0; i < 3; i++) {
        if (fabs(info.bounds_min[i] - low[i]) > within || fabs(info.bounds_max[i] - high[i]) > within)
            print_error("axis %d: %.9g … %.9g, expected %.9g … %.9g\n", i, info.bounds_min[i], info.bounds_max[i],
                        low[i], high[i]);
        assert_true(fabs(info.bounds_min[i] - low[i]) <= within && fabs(info.bounds_max[i] - high[i]) <= within);
    }
}

#define CHECK_BOX(s, x0, y0, z0, x1, y1, z1)                                                                           \
    check_box(s, (const double[3]){x0, y0, z0}, (const double[3]){x1, y1, z1}, 1e-5)

/* Loads, compares the bounds, and wants no warning. */
static inline void expect_box(const char *text, double x0, double y0, double z0, double x1, double y1, double z1)
{
    lmn_scene *s = load_text(text);
    for (size_t i = 0; i < s->warnings.count; i++)
        print_error("%s: %s\n", text, s->warnings.items[i].text);
    assert_int_equal(s->warnings.count, 0);
    CHECK_BOX(s, x0, y0, z0, x1, y1, z1);
    lmn_scene_destroy(&s);
}

#endif
