/* examples/cloister.glb, examples/store.glb and examples/blocks.glb are what they say: closed shells the right way
 * round, nothing in the air, and no two parts with a face in one plane, which would flicker. */
#include <math.h>

#include "closed_parts.h"

typedef struct corner3 {
    double at[3];
} corner3;

/* A triangle in the building's position. */
typedef struct face {
    corner3  corners[3];
    double   normal[3], distance;
    int      key[3]; /* its direction, roughly */
    uint32_t part, shell;
} face;

typedef struct shell {
    double low[3], high[3], volume;
    size_t part, joined; /* the shell that it hangs on; itself for the first of its group */
} shell;

typedef struct building {
    lmn_scene *scene;
    face      *faces;
    shell     *shells;
    size_t     face_count, shell_count;
} building;

enum { CLOISTER, STORE, BLOCKS, BUILDINGS };

static building buildings[BUILDINGS];

static uint32_t root_of(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
    return i;
}

static void finish_face(face *f)
{
    const double *a = f->corners[0].at, *b = f->corners[1].at, *c = f->corners[2].at;
    double        length = 0;
    for (int k = 0; k < 3; k++) {
        int u = (k + 1) % 3, v = (k + 2) % 3;
        f->normal[k] = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
        length += f->normal[k] * f->normal[k];
    }
    f->distance = 0;
    for (int k = 0; k < 3; k++) {
        f->normal[k] /= sqrt(length);
        f->key[k] = (int)lround(f->normal[k] * 500);
        f->distance += f->normal[k] * a[k];
    }
}

static void grow_shell(shell *s, const face *f)
{
    const double *a = f->corners[0].at, *b = f->corners[1].at, *c = f->corners[2].at;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            s->low[k] = fmin(s->low[k], f->corners[i].at[k]);
            s->high[k] = fmax(s->high[k], f->corners[i].at[k]);
        }
    s->volume +=
        (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) /
        6;
}

/* Adds a part's faces, and its shells: triangles that share corners. */
static void add_part(building *b, size_t index, const mat4 *world)
{
    const primitive *p = b->scene->meshes[b->scene->nodes[b->scene->parts[index].node].mesh].primitives;
    uint32_t        *parents = mem_alloc(p->vertex_count * sizeof *parents),
             *shells = mem_calloc(p->vertex_count, sizeof *shells);
    assert_true(parents && shells);
    for (uint32_t i = 0; i < p->vertex_count; i++)
        parents[i] = i;
    for (uint32_t i = 0; i < p->index_count; i++)
        parents[root_of(parents, p->indices[i])] = root_of(parents, p->indices[i - i % 3]);
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        face    *f = &b->faces[b->face_count++];
        uint32_t root = root_of(parents, p->indices[i]);
        if (shells[root] == 0) {
            shells[root] = (uint32_t)b->shell_count + 1;
            b->shells[b->shell_count] = (shell){{1e9, 1e9, 1e9}, {-1e9, -1e9, -1e9}, 0, index, b->shell_count};
            b->shell_count++;
        }
        f->part = (uint32_t)index;
        f->shell = shells[root] - 1;
        for (int c = 0; c < 3; c++) {
            vec3 v = p->positions[p->indices[i + (uint32_t)c]];
            for (int k = 0; k < 3; k++)
                f->corners[c].at[k] = world->m[k] * (double)v.x + world->m[4 + k] * (double)v.y +
                                      world->m[8 + k] * (double)v.z + world->m[12 + k];
        }
        finish_face(f);
        grow_shell(&b->shells[f->shell], f);
    }
    mem_free(shells);
    mem_free(parents);
}

static int load_buildings(void **state)
{
    static const char *const paths[BUILDINGS] = {LIMNER_SOURCE_DIR "/examples/cloister.glb",
                                                 LIMNER_SOURCE_DIR "/examples/store.glb",
                                                 LIMNER_SOURCE_DIR "/examples/blocks.glb"};
    (void)state;
    for (int i = 0; i < BUILDINGS; i++) {
        building *b = &buildings[i];
        b->scene = load_or_fail(paths[i]);
        size_t count = lmn_scene_info_of(b->scene).triangles;
        b->faces = mem_alloc(count * sizeof *b->faces);
        b->shells = mem_alloc(count * sizeof *b->shells);
        mat4 *world = scene_world_matrices(b->scene, NULL);
        assert_true(b->faces && b->shells && world);
        for (size_t k = 0; k < b->scene->part_count; k++)
            add_part(b, k, &world[b->scene->parts[k].node]);
        mem_free(world);
    }
    return 0;
}

static int unload_buildings(void **state)
{
    (void)state;
    for (int i = 0; i < BUILDINGS; i++) {
        mem_free(buildings[i].faces);
        mem_free(buildings[i].shells);
        lmn_scene_destroy(&buildings[i].scene);
    }
    return 0;
}

static void assert_has_parts(const lmn_scene *scene, const char *const *names, size_t count)
{
    assert_int_equal(scene->warnings.count, 0);
    assert_in_range(lmn_scene_info_of(scene).triangles, 10000, 60000);
    for (size_t n = 0; n < count; n++)
        assert_one_part(scene, names[n]);
}

static void have_their_parts(void **state)
{
    static const char *const cloister[] = {"north arcade", "west columns", "south roof", "east rafters", "north doors",
                                           "lawn",         "well",         "nave",       "apse",         "range",
                                           "tower",        "tower roof",   "bell",       "tree"};
    static const char *const store[] = {"slabs",  "columns",        "glass ground", "mullions", "fins",
                                        "canopy", "canopy columns", "escalators",   "railing",  "plant room",
                                        "sign",   "pavement",       "tree 1",       "tree 2",   "people"};
    static const char *const blocks[] = {"house 1",   "tower 8",    "house 97",     "roofs 1",        "roofs 10",
                                         "windows 1", "windows 10", "ground",       "pavements",      "lamp 1",
                                         "tree 1",    "church",     "church roofs", "church openings"};
    (void)state;
    assert_has_parts(buildings[CLOISTER].scene, cloister, sizeof cloister / sizeof *cloister);
    assert_has_parts(buildings[STORE].scene, store, sizeof store / sizeof *store);
    assert_has_parts(buildings[BLOCKS].scene, blocks, sizeof blocks / sizeof *blocks);
    assert_int_equal(buildings[BLOCKS].scene->camera_count, 2);
}

static void parts_are_closed(void **state)
{
    (void)state;
    for (int i = 0; i < BUILDINGS; i++)
        assert_closed(buildings[i].scene);
}

static void shells_enclose_material(void **state)
{
    size_t wrong = 0;
    (void)state;
    for (int i = 0; i < BUILDINGS; i++)
        for (size_t k = 0; k < buildings[i].shell_count; k++) {
            const shell *s = &buildings[i].shells[k];
            if (s->volume <= 1e-6)
                print_error("%s: %g m³\n", buildings[i].scene->parts[s->part].name, s->volume);
            wrong += s->volume <= 1e-6;
        }
    assert_int_equal(wrong, 0);
}

static size_t group_of(shell *shells, size_t i)
{
    while (shells[i].joined != i)
        i = shells[i].joined = shells[shells[i].joined].joined;
    return i;
}

/* Boxes around shells reach into each other all the way to the ground. */
static void nothing_floats(void **state)
{
    size_t wrong = 0;
    (void)state;
    for (int i = 0; i < BUILDINGS; i++) {
        building *b = &buildings[i];
        for (size_t j = 0; j < b->shell_count; j++)
            for (size_t k = 0; k < j; k++) {
                const shell *x = &b->shells[j], *y = &b->shells[k];
                bool         apart = false;
                for (int axis = 0; axis < 3; axis++)
                    apart = apart || x->low[axis] > y->high[axis] || y->low[axis] > x->high[axis];
                if (!apart)
                    b->shells[group_of(b->shells, j)].joined = group_of(b->shells, k);
            }
        for (size_t k = 0; k < b->shell_count; k++)
            if (group_of(b->shells, k) != group_of(b->shells, 0)) {
                const shell *s = &b->shells[k];
                print_error("%s floats at %g %g %g\n", b->scene->parts[s->part].name, s->low[0], s->low[1], s->low[2]);
                wrong++;
            }
    }
    assert_int_equal(wrong, 0);
}

static int compare_faces(const void *a, const void *b)
{
    const face *x = a, *y = b;
    for (int k = 0; k < 3; k++)
        if (x->key[k] != y->key[k])
            return (x->key[k] > y->key[k]) - (x->key[k] < y->key[k]);
    return (x->distance > y->distance) - (x->distance < y->distance);
}

/* Whether some edge of one triangle has all of the other beyond it, seen along an axis; `within` lets that much
 * overlap pass. */
static bool parted(const face *f, const face *g, int u, int v, double within)
{
    for (int e = 0; e < 3; e++) {
        const double *a = f->corners[e].at, *b = f->corners[(e + 1) % 3].at, *c = f->corners[(e + 2) % 3].at;
        double        out[2] = {b[v] - a[v], a[u] - b[u]}, length = hypot(out[0], out[1]);
        double        side = (c[u] - a[u]) * out[0] + (c[v] - a[v]) * out[1] > 0 ? -1 : 1;
        bool          beyond = true;
        for (int i = 0; i < 3; i++) {
            const double *p = g->corners[i].at;
            beyond = beyond && side * ((p[u] - a[u]) * out[0] + (p[v] - a[v]) * out[1]) > -within * length;
        }
        if (beyond)
            return true;
    }
    return false;
}

static bool in_plane_of(const face *f, const face *g, double apart)
{
    for (int i = 0; i < 3; i++) {
        const double *p = g->corners[i].at;
        if (fabs(f->normal[0] * p[0] + f->normal[1] * p[1] + f->normal[2] * p[2] - f->distance) > apart)
            return false;
    }
    return true;
}

static void no_faces_share_a_plane(void **state)
{
    const double apart = 4e-4, within = 2e-3; /* m */
    size_t       wrong = 0;
    (void)state;
    for (int i = 0; i < BUILDINGS; i++) {
        building *b = &buildings[i];
        qsort(b->faces, b->face_count, sizeof *b->faces, compare_faces);
        for (size_t j = 0; j < b->face_count; j++) {
            const face *f = &b->faces[j];
            int         axis = fabs(f->normal[0]) > 0.7 ? 0 : fabs(f->normal[1]) > 0.7 ? 1 : 2;
            for (size_t k = j + 1; k < b->face_count; k++) {
                const face *g = &b->faces[k];
                if (memcmp(f->key, g->key, sizeof f->key) != 0 || g->distance - f->distance > 0.02)
                    break;
                int u = (axis + 1) % 3, v = (axis + 2) % 3;
                if (f->part == g->part || !in_plane_of(f, g, apart) || parted(f, g, u, v, within) ||
                    parted(g, f, u, v, within))
                    continue;
                if (wrong++ < 40)
                    print_error("%s, %s: at %g %g %g and %g %g %g\n", b->scene->parts[f->part].name,
                                b->scene->parts[g->part].name, f->corners[0].at[0], f->corners[0].at[1],
                                f->corners[0].at[2], g->corners[0].at[0], g->corners[0].at[1], g->corners[0].at[2]);
            }
        }
    }
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(have_their_parts),        cmocka_unit_test(parts_are_closed),
        cmocka_unit_test(shells_enclose_material), cmocka_unit_test(nothing_floats),
        cmocka_unit_test(no_faces_share_a_plane),
    };
    return cmocka_run_group_tests(tests, load_buildings, unload_buildings);
}
