/* The reference for solids against what is known without it: volumes, winding numbers, the laws of sets, flush
 * faces by hand. Nothing is drawn here. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "csg_map.h"
#include "csg_scenes.h"
#include "scenes.h"

static const double pi = 3.14159265358979323846;

/* --- leaves --------------------------------------------------------------------------------------------- */

static double mesh_volume(const csg_mesh *m)
{
    double volume = 0;
    for (size_t f = 0; f < m->face_count; f++)
        volume += dvec_dot(m->points[m->faces[3 * f]],
                           dvec_cross(m->points[m->faces[3 * f + 1]], m->points[m->faces[3 * f + 2]])) /
                  6;
    return volume;
}

/* Sides of triangles without one that runs the other way. */
static int open_sides(const csg_mesh *m)
{
    int open = 0;
    for (size_t k = 0; k < 3 * m->face_count; k++) {
        uint32_t a = m->faces[k], b = m->faces[k % 3 == 2 ? k - 2 : k + 1];
        int      back = 0, same = 0;
        for (size_t j = 0; j < 3 * m->face_count; j++) {
            uint32_t c = m->faces[j], d = m->faces[j % 3 == 2 ? j - 2 : j + 1];
            back += c == b && d == a;
            same += c == a && d == b;
        }
        open += back != 1 || same != 1;
    }
    return open;
}

static void leaves(void)
{
    static const char *const names[] = {"box", "ball", "cylinder", "cone", "torus", "angle", "star", "cup", "hull"};
    csg                      c = {0};
    uint32_t                 state = 5;
    int                      root = csg_add(&c, -1, CSG_UNION);
    csg_box(&c, root, dvec_of(-1, -0.5, 0), dvec_of(1, 1, 0.7));
    csg_ball(&c, root, 1, 16, 24);
    csg_cylinder(&c, root, 0.7, 0.7, 1.2, 24);
    csg_cylinder(&c, root, 0.7, 0, 1.2, 24);
    csg_torus(&c, root, 1, 0.4, 24, 12);
    csg_angle(&c, root, 1.5, 0.4, 0.6);
    csg_star(&c, root, 1, 0.4, 5, 0.7);
    csg_cup(&c, root, 0.8, 1, 0.2, 24);
    csg_hull(&c, root, 1, 12, &state);
    for (int i = 1; i < c.count; i++) {
        csg alone = {0};
        csg_copy(&alone, -1, &c, i);
        csg_place(&alone, 0, dvec_of(i % 2 ? -1 : 1, 1, 1), dvec_of(1, 2, 3), 40, dvec_of(0.3, 0.2, 0.1));
        csg_rays *r = csg_rays_create(&alone, 30);
        double    volume = mesh_volume(&c.nodes[i].mesh);
        check_at_most("self", open_sides(&c.nodes[i].mesh), 0, "%s: open sides", names[i - 1]);
        for (int axis = 0; axis < 3; axis++)
            check_near("self", csg_volume(r, axis, 150), volume, 0.004 * volume,
                       "%s: volume by rays along axis %d and by its faces", names[i - 1], axis);
        csg_rays_destroy(r);
        csg_release(&alone);
    }
    csg_release(&c);
}

/* --- volumes -------------------------------------------------------------------------------------------- */

static void volume_is(csg *c, double wanted, double fraction, const char *what)
{
    csg_rays *r = csg_rays_create(c, 30);
    for (int axis = 0; axis < 3; axis++)
        check_near("self", csg_volume(r, axis, 160), wanted, fraction * wanted, "%s, along axis %d", what, axis);
    csg_rays_destroy(r);
    csg_release(c);
}

static void volumes(void)
{
    csg    c = {0};
    double radius = 1, apart = 0.8;
    /* What two equal balls have in common: two caps. */
    double height = radius - apart / 2, lens = 2 * pi * height * height * (3 * radius - height) / 3, ball = 4 * pi / 3;
    for (int kind = 1; kind <= 3; kind++) {
        static const char *const names[] = {"", "ball and ball", "ball in ball", "ball minus ball"};
        int                      root = csg_add(&c, -1, (csg_kind)kind);
        csg_ball(&c, root, radius, 64, 128);
        csg_move(&c, csg_ball(&c, root, radius, 64, 128), apart, 0, 0);
        volume_is(&c, kind == 1 ? 2 * ball - lens : kind == 2 ? lens : ball - lens, 0.006, names[kind]);
    }
    csg_cylinder(&c, csg_add(&c, -1, CSG_INTERSECTION), 0.5, 0.5, 3, 256);
    csg_box(&c, 0, dvec_of(-1, -1, 0.5), dvec_of(1, 1, 1.7));
    volume_is(&c, pi * 0.25 * 1.2, 0.006, "cylinder in box");
    csg_torus(&c, -1, 1, 0.4, 128, 64);
    volume_is(&c, 2 * pi * pi * 0.16, 0.006, "torus");
    csg_box(&c, csg_add(&c, -1, CSG_DIFFERENCE), dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    csg_box(&c, csg_add(&c, 0, CSG_DIFFERENCE), dvec_of(-0.7, -0.7, -0.7), dvec_of(0.7, 0.7, 0.7));
    csg_box(&c, 2, dvec_of(-0.4, -0.4, -0.4), dvec_of(0.4, 0.4, 0.4));
    volume_is(&c, 8 - 1.4 * 1.4 * 1.4 + 0.8 * 0.8 * 0.8, 0.004, "box in a hollow box");
}

/* --- winding numbers ------------------------------------------------------------------------------------ */

/* Twice around: the solid angle of a triangle, van Oosterom and Strackee. */
static double solid_angle(dvec a, dvec b, dvec c)
{
    double la = dvec_length(a), lb = dvec_length(b), lc = dvec_length(c);
    double up = dvec_dot(a, dvec_cross(b, c));
    double down = la * lb * lc + dvec_dot(a, b) * lc + dvec_dot(b, c) * la + dvec_dot(c, a) * lb;
    return 2 * atan2(up, down);
}

static dvec in_scene(const csg *c, int node, dvec p)
{
    for (; node >= 0; node = c->nodes[node].parent)
        p = dmat_apply(c->nodes[node].matrix, p, 1, NULL);
    return p;
}

/* The tree straight from its definition. */
static bool holds_at(const csg *c, int node, dvec p)
{
    const csg_node *n = &c->nodes[node];
    if (n->kind == CSG_LEAF) {
        double sum = 0;
        for (size_t f = 0; f < n->mesh.face_count; f++) {
            dvec q[3];
            for (size_t k = 0; k < 3; k++)
                q[k] = dvec_sub(in_scene(c, node, n->mesh.points[n->mesh.faces[3 * f + k]]), p);
            sum += solid_angle(q[0], q[1], q[2]);
        }
        return fabs(sum) > 2 * pi;
    }
    int  index = 0;
    bool value = n->kind == CSG_INTERSECTION;
    for (int i = node + 1; i < c->count; i++) {
        if (c->nodes[i].parent != node)
            continue;
        bool own = holds_at(c, i, p);
        if (n->kind == CSG_UNION)
            value = value || own;
        else if (n->kind == CSG_INTERSECTION)
            value = value && own;
        else
            value = index == 0 ? own : value && !own;
        index++;
    }
    return value && index > 0;
}

static void winding(void)
{
    for (int kind = 0; kind < CSG_SCENES; kind++) {
        int wrong = 0, inside = 0, points = 0, leaf_count = 0;
        for (uint32_t seed = 1; seed <= 4; seed++) {
            csg      c = {0};
            dvec     low, high;
            uint32_t state = seed;
            csg_random(&c, (csg_scene)kind, seed);
            csg_rays *r = csg_rays_create(&c, 30);
            csg_rays_box(r, &low, &high);
            for (int k = 0; k < 300; k++) {
                double x = scene_between(&state, low.x, high.x), y = scene_between(&state, low.y, high.y);
                dvec   p = dvec_of(x, y, scene_between(&state, low.z, high.z));
                bool   own = csg_inside(r, p);
                inside += own;
                points++;
                wrong += own != holds_at(&c, 0, p);
            }
            leaf_count += csg_leaf_count(&c);
            csg_rays_destroy(r);
            csg_release(&c);
        }
        check_at_least("K01", inside, 0.05 * points, "%s: points in the solid, of %d", csg_scene_names[kind], points);
        check_at_most("K01", wrong, 0, "%s: points at which rays and solid angles differ (%d leaves)",
                      csg_scene_names[kind], leaf_count);
    }
}

/* --- laws ----------------------------------------------------------------------------------------------- */

/* Three solids of a seed, and trees of them written in two ways. */
typedef struct law {
    const char *name, *left, *right; /* prefix: + union, * intersection, - difference */
} law;

static const char *build(csg *out, int parent, const char *text, const csg parts[3])
{
    if (*text >= 'a') {
        csg_copy(out, parent, &parts[*text - 'a'], 0);
        return text + 1;
    }
    int node = csg_add(out, parent, *text == '+' ? CSG_UNION : *text == '*' ? CSG_INTERSECTION : CSG_DIFFERENCE);
    return build(out, node, build(out, node, text + 1, parts), parts);
}

static int differing_rays(csg_rays *one, csg_rays *other, uint32_t seed, int count)
{
    uint32_t state = seed;
    int      wrong = 0;
    for (int k = 0; k < count; k++) {
        csg_hit     a[CSG_HITS_MAX], b[CSG_HITS_MAX];
        csg_passage passage;
        double      v[6];
        for (int i = 0; i < 6; i++)
            v[i] = scene_between(&state, -1, 1);
        dvec   origin = dvec_of(v[0], v[1], v[2]), direction = dvec_of(v[3], v[4], v[5]);
        size_t found = csg_trace(one, origin, direction, a, CSG_HITS_MAX, &passage), same = 0;
        if (csg_trace(other, origin, direction, b, CSG_HITS_MAX, &passage) == found)
            while (same < found && fabs(a[same].t - b[same].t) * dvec_length(direction) < 1e-9 &&
                   a[same].front == b[same].front && dvec_dot(a[same].flat, b[same].flat) > 1 - 1e-9)
                same++;
        wrong += same < found || (passage.close && !found);
    }
    return wrong;
}

static void laws(void)
{
    static const law all[] = {
        {"A - (B + C) = (A - B) - C", "-a+bc", "--abc"},
        {"A * (B + C) = A * B + A * C", "*a+bc", "+*ab*ac"},
        {"A - (B * C) = (A - B) + (A - C)", "-a*bc", "+-ab-ac"},
        {"A - (B - C) = (A - B) + A * C", "-a-bc", "+-ab*ac"},
        {"A * (B - C) = A * B - C", "*a-bc", "-*abc"},
        {"(A + B) - C = (A - C) + (B - C)", "-+abc", "+-ac-bc"},
        {"A + A = A", "+aa", "a"},
        {"A * A = A", "*aa", "a"},
        {"A + (A * B) = A", "+a*ab", "a"},
        {"(A - B) + (A * B) = A", "+-ab*ab", "a"},
        {"A - (A - B) = A * B", "-a-ab", "*ab"},
        {"A - A = nothing", "-aa", "-bb"},
    };
    for (size_t l = 0; l < sizeof all / sizeof *all; l++) {
        int wrong = 0;
        for (uint32_t seed = 1; seed <= 5; seed++) {
            csg parts[3] = {{0}}, sides[2] = {{0}};
            for (uint32_t k = 0; k < 3; k++)
                csg_random(&parts[k],
                           (csg_scene)((seed + k) % CSG_SCENES == CSG_MANY ? CSG_CONVEX : (seed + k) % CSG_SCENES),
                           10 * seed + k);
            build(&sides[0], -1, all[l].left, parts);
            build(&sides[1], -1, all[l].right, parts);
            csg_rays *one = csg_rays_create(&sides[0], 30), *other = csg_rays_create(&sides[1], 30);
            wrong += differing_rays(one, other, seed, 400);
            csg_rays_destroy(one);
            csg_rays_destroy(other);
            for (int k = 0; k < 3; k++)
                csg_release(&parts[k]);
            csg_release(&sides[0]);
            csg_release(&sides[1]);
        }
        check_at_most("K01", wrong, 0, "%s: rays of 2000 that differ", all[l].name);
    }
}

/* --- flush faces by hand -------------------------------------------------------------------------------- */

/* The surfaces along x through (y, z) = (0.1, 0.2): positions, owners; the first is a front. */
static void along_x(csg *c, int count, const double *positions, const int *owners, const char *what)
{
    csg_rays   *r = csg_rays_create(c, 30);
    csg_hit     hits[CSG_HITS_MAX];
    csg_passage passage;
    int         found = (int)csg_trace(r, dvec_of(-10, 0.1, 0.2), dvec_of(2, 0, 0), hits, CSG_HITS_MAX, &passage);
    check_near("self", found, count, 0, "%s: surfaces", what);
    check_that("self", !passage.close, "  no other order is possible");
    for (int k = 0; k < found && k < count; k++) {
        check_near("self", hits[k].t * 2 - 10, positions[k], 1e-9, "  place of surface %d", k);
        check_near("self", hits[k].leaf, owners[k], 0, "  its owner");
        check_that("self", hits[k].front == (k % 2 == 0) && hits[k].normal.x * (k % 2 ? 1 : -1) > 0.5,
                   "  it faces outwards");
    }
    csg_rays_destroy(r);
    csg_release(c);
}

static void boxes(csg *c, csg_kind kind, int count, double (*ranges)[2])
{
    csg_add(c, -1, kind);
    for (int k = 0; k < count; k++)
        csg_box(c, 0, dvec_of(ranges[k][0], -1, -1), dvec_of(ranges[k][1], 1, 1));
}

static void flush(void)
{
    csg c = {0};
    boxes(&c, CSG_UNION, 2, (double[][2]){{0, 1}, {1, 2}});
    along_x(&c, 2, (double[]){0, 2}, (int[]){0, 1}, "two boxes side by side");
    boxes(&c, CSG_UNION, 2, (double[][2]){{0, 1}, {0, 2}});
    along_x(&c, 2, (double[]){0, 2}, (int[]){0, 1}, "two boxes that begin at one face");
    boxes(&c, CSG_DIFFERENCE, 2, (double[][2]){{0, 2}, {0, 1}});
    along_x(&c, 2, (double[]){1, 2}, (int[]){1, 0}, "a cut flush with a face");
    boxes(&c, CSG_DIFFERENCE, 2, (double[][2]){{0, 2}, {2, 3}});
    along_x(&c, 2, (double[]){0, 2}, (int[]){0, 0}, "a cut that only touches");
    boxes(&c, CSG_DIFFERENCE, 3, (double[][2]){{0, 4}, {1, 2}, {2, 3}});
    along_x(&c, 4, (double[]){0, 1, 3, 4}, (int[]){0, 1, 2, 0}, "two cuts side by side");
    boxes(&c, CSG_INTERSECTION, 2, (double[][2]){{0, 1}, {1, 2}});
    along_x(&c, 0, NULL, NULL, "boxes that only touch have nothing in common");
    boxes(&c, CSG_INTERSECTION, 2, (double[][2]){{0, 3}, {1, 3}});
    along_x(&c, 2, (double[]){1, 3}, (int[]){1, 0}, "boxes that end at one face have this in common");
    boxes(&c, CSG_UNION, 2, (double[][2]){{0, 1}, {0, 1}});
    along_x(&c, 2, (double[]){0, 1}, (int[]){0, 1}, "a box twice, united");
    boxes(&c, CSG_INTERSECTION, 2, (double[][2]){{0, 1}, {0, 1}});
    along_x(&c, 2, (double[]){0, 1}, (int[]){1, 0}, "a box twice, in common");
    boxes(&c, CSG_DIFFERENCE, 2, (double[][2]){{0, 1}, {0, 1}});
    along_x(&c, 0, NULL, NULL, "a box minus itself");
    boxes(&c, CSG_DIFFERENCE, 2, (double[][2]){{0, 2}, {0.5, 1.5}});
    along_x(&c, 4, (double[]){0, 0.5, 1.5, 2}, (int[]){0, 1, 1, 0}, "a box with a cavity");
    /* A plug fills what was cut: its faces are the cut's, turned. */
    boxes(&c, CSG_UNION, 0, NULL);
    csg_add(&c, 0, CSG_DIFFERENCE);
    csg_box(&c, 1, dvec_of(0, -1, -1), dvec_of(3, 1, 1));
    csg_box(&c, 1, dvec_of(1, -1, -1), dvec_of(2, 1, 1));
    csg_box(&c, 0, dvec_of(1, -1, -1), dvec_of(2, 1, 1));
    along_x(&c, 2, (double[]){0, 3}, (int[]){0, 0}, "a cut that is filled again");
    boxes(&c, CSG_DIFFERENCE, 1, (double[][2]){{0, 3}});
    csg_place(&c, csg_box(&c, 0, dvec_of(-2, -1, -1), dvec_of(-1, 1, 1)), dvec_of(-1, 1, 1), dvec_of(1, 0, 0), 0,
              dvec_of(0, 0, 0));
    along_x(&c, 4, (double[]){0, 1, 2, 3}, (int[]){0, 1, 1, 0}, "a mirrored cut");
    csg_ball(&c, csg_add(&c, -1, CSG_UNION), 1, 8, 16);
    csg_ball(&c, 0, 1, 8, 16);
    csg_rays *r = csg_rays_create(&c, 30);
    check_near("self", csg_volume(r, 0, 100), mesh_volume(&c.nodes[1].mesh), 0.02, "a ball twice: volume");
    csg_rays_destroy(r);
    csg_release(&c);
}

/* A crossing that is nearly in one plane with another must be called close. */
static void nearly_flush(void)
{
    static const double gaps[] = {1e-8, 2e-5, 1e-3};
    for (int k = 0; k < 3; k++) {
        csg         c = {0};
        csg_hit     hits[CSG_HITS_MAX];
        csg_passage passage;
        boxes(&c, CSG_DIFFERENCE, 2, (double[][2]){{0, 2}, {-1, 0}});
        c.nodes[2].mesh.points[1].x += gaps[k]; /* one corner alone: the face leans */
        csg_rays *r = csg_rays_create(&c, 30);
        size_t    count = csg_trace(r, dvec_of(-10, -0.7, -0.8), dvec_of(1, 0, 0), hits, CSG_HITS_MAX, &passage);
        check_near("self", (double)count, 2, 0, "a cut that leans by %g: surfaces", gaps[k]);
        check_that("self", passage.close == (k == 1), "  its order is %s", passage.close ? "open" : "sure");
        csg_rays_destroy(r);
        csg_release(&c);
    }
}

/* --- maps ----------------------------------------------------------------------------------------------- */

static void maps(void)
{
    for (int kind = 0; kind < CSG_SCENES; kind++) {
        csg       c = {0};
        shot      blank;
        csg_map   map;
        shot_view view = {.width = 80, .height = 64, .eye = {4, 3, 5}, .up = {0, 1, 0}, .orthographic = kind % 2};
        csg_random(&c, (csg_scene)kind, 3);
        shot_blank(&blank, &view, 1, 20);
        csg_rays *r = csg_rays_create(&c, 30);
        csg_map_make(&map, r, &blank);
        int odd = 0, turned = 0, wrong = 0, back = 0;
        for (int i = 0; i < map.width * map.height; i++) {
            odd += csg_count(&map, i) % 2 == 1;
            for (size_t k = 0; k < csg_count(&map, i); k++) {
                const csg_hit *h = &csg_at(&map, i)[k];
                turned += h->front != (k % 2 == 0);
                back += k > 0 && h->depth < h[-1].depth;
                dvec origin, direction;
                shot_ray(&blank, i % map.width + 0.5, i / map.width + 0.5, &origin, &direction);
                wrong += (dvec_dot(h->flat, direction) < 0) != h->front;
            }
        }
        check_at_most("C5", odd, 0, "%s: pixels with an odd number of surfaces (at most %zu)", csg_scene_names[kind],
                      map.most);
        check_at_most("C5", turned + wrong + back, 0,
                      "  surfaces that do not alternate, face the wrong way or are out of order");
        check_at_least("self", (double)map.sharp_count / (map.width * map.height), 0.9,
                       "  fraction of pixels whose answer is sure");
        csg_map_release(&map);
        csg_rays_destroy(r);
        shot_release(&blank);
        csg_release(&c);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"leaves", leaves}, {"volumes", volumes},     {"winding", winding}, {"laws", laws},
        {"flush", flush},   {"nearly", nearly_flush}, {"maps", maps},
    };
    return check_main(argc, argv, "solid_truth", cases, sizeof cases / sizeof *cases);
}
