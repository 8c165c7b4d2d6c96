/* OpenSCAD's own examples: a solid drawn pixel by pixel against the drawing of the mesh that OpenSCAD made of it,
 * from the same position. LIMNER_DATA names the folder of the corpora (default: shared/data beside or above the
 * source); where there is none, there is nothing to compare. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "check.h"
#include "shot.h"

enum { SIZE = 320, LAYERS = 2, DRAWN = 6 };

static const char front_look[] = "{\"version\":1,\"name\":\"t\",\"rules\":[{\"select\":\"*\",\"surface\":\"flat\"}]}";
static const char look[] =
    "{\"version\":1,\"name\":\"t\",\"rules\":[{\"select\":\"*\",\"surface\":\"flat\","
    "\"layers\":{\"technique\":\"peel\",\"count\":6},\"compose\":{\"technique\":\"xray\",\"opacity\":0.5}}]}";

/* Bounds of a binary STL file. */
static bool stl_bounds(const char *path, dvec *low, dvec *high)
{
    uint8_t  head[84], triangle[50];
    uint32_t count = 0;
    FILE    *file = fopen(path, "rb");
    bool     ok = file && fread(head, 1, sizeof head, file) == sizeof head;
    if (ok)
        memcpy(&count, head + 80, sizeof count);
    *low = dvec_of(INFINITY, INFINITY, INFINITY);
    *high = dvec_of(-INFINITY, -INFINITY, -INFINITY);
    for (uint32_t i = 0; i < count && ok; i++) {
        float p[9];
        ok = fread(triangle, 1, sizeof triangle, file) == sizeof triangle;
        memcpy(p, triangle + 12, sizeof p);
        for (int k = 0; k < 9 && ok; k += 3) {
            dvec v = dvec_from(&p[k]);
            *low = dvec_of(fmin(low->x, v.x), fmin(low->y, v.y), fmin(low->z, v.z));
            *high = dvec_of(fmax(high->x, v.x), fmax(high->y, v.y), fmax(high->z, v.z));
        }
    }
    if (file)
        fclose(file);
    return ok && count > 0;
}

typedef struct comparison {
    double overlap;       /* of the silhouettes: intersection over union */
    double right[LAYERS]; /* fraction of the pixels that both have whose depths agree */
    int    common[LAYERS], x, y;
} comparison;

/* The depths behind a pixel. Where parts nearly meet, OpenSCAD's meshes have clefts and skins without thickness
 * (their positions have six digits): two surfaces closer than `hair` are none. */
static int depths_at(const shot *s, int i, double hair, double out[DRAWN])
{
    int count = 0;
    for (int k = 0; k < s->layer_count && !isinf(s->layers[k].depth[i]); k++) {
        double depth = (double)s->layers[k].depth[i];
        if (count > 0 && depth - out[count - 1] <= hair)
            count--;
        else
            out[count++] = depth;
    }
    return count;
}

static comparison compare(const shot *solid, const shot *mesh, double extent)
{
    comparison c = {.x = -1};
    int        both = 0, any = 0, right[LAYERS] = {0};
    for (int i = 0; i < SIZE * SIZE; i++) {
        double a[DRAWN], b[DRAWN];
        int    of_solid = depths_at(solid, i, 1e-5 * extent, a), of_mesh = depths_at(mesh, i, 1e-5 * extent, b);
        both += of_solid > 0 && of_mesh > 0;
        any += of_solid > 0 || of_mesh > 0;
        for (int k = 0; k < LAYERS && k < of_solid && k < of_mesh; k++) {
            c.common[k]++;
            if (fabs(a[k] - b[k]) <= 0.002 * extent) {
                right[k]++;
            } else if (c.x < 0) {
                c.x = i % SIZE;
                c.y = i / SIZE;
            }
        }
    }
    for (int k = 0; k < LAYERS; k++)
        c.right[k] = c.common[k] ? (double)right[k] / c.common[k] : 0;
    c.overlap = any ? (double)both / any : 0;
    return c;
}

/* The front alone has a way of its own. */
static double right_front(const shot *front, const shot *mesh, double extent)
{
    int right = 0, any = 0;
    for (int i = 0; i < SIZE * SIZE && mesh->layer_count > 0; i++) {
        double a = (double)front->depth[i], b = (double)mesh->layers[0].depth[i];
        any += !isinf(a) || !isinf(b);
        right += !isinf(a) && !isinf(b) && fabs(a - b) <= 0.002 * extent;
    }
    return any ? (double)right / any : 0;
}

static void check_file(const char *folder, const char *name, const char *stl)
{
    char path[2][640];
    dvec low, high;
    shot s[3] = {{0}, {0}, {0}};
    snprintf(path[0], sizeof path[0], "%s/%s", folder, name);
    snprintf(path[1], sizeof path[1], "%s/%s", folder, stl);
    if (!check_that("corpus", stl_bounds(path[1], &low, &high), "%s can be read", stl))
        return;
    double    extent = dvec_length(dvec_sub(high, low));
    dvec      middle = dvec_mix(low, high, 0.5);
    shot_view view = {.width = SIZE,
                      .height = SIZE,
                      .target = middle,
                      .up = {0, 0, 1},
                      .fov_deg = 30,
                      .eye = dvec_add(middle, dvec_scale(dvec_unit(dvec_of(0.8, -1.1, 0.7)), 2 * extent))};
    if (shot_take(&s[0], path[0], look, NULL, &view) && shot_take(&s[1], path[1], look, NULL, &view) &&
        shot_take(&s[2], path[0], front_look, NULL, &view)) {
        comparison c = compare(&s[0], &s[1], extent);
        double     front = right_front(&s[2], &s[1], extent);
        bool       right = front >= 0.99 && c.overlap >= 0.995 && c.right[0] >= 0.99 && c.right[1] >= 0.99;
        if (!check_that("K02", right,
                        "%-40s overlap %.5f, front %.5f, depths of layer 0 %.5f of %6d, of layer 1 %.5f of %6d", name,
                        c.overlap, front, c.right[0], c.common[0], c.right[1], c.common[1]) &&
            c.x >= 0) {
            int i = c.y * SIZE + c.x;
            for (int k = 0; k < LAYERS; k++)
                check_note("first at %d, %d: layer %d of the solid at %.6g, of the mesh at %.6g", c.x, c.y, k,
                           (double)s[0].layers[k].depth[i], (double)s[1].layers[k].depth[i]);
        }
    }
    shot_release(&s[0]);
    shot_release(&s[1]);
    shot_release(&s[2]);
}

enum { SKIPPED = 77 }; /* as ctest is told */
static bool skipped;

static void against_meshes(void)
{
    static const char *const positions[] = {"../shared/data", "../../shared/data", "../../../shared/data"};
    char                     folder[512] = "", path[640];
    const char              *given = getenv("LIMNER_DATA");
    struct stat              unused;
    for (int k = -1; k < 3 && !*folder; k++) {
        if (k < 0 ? !given : given != NULL)
            continue;
        if (k < 0)
            snprintf(folder, sizeof folder, "%s/csg", given);
        else
            snprintf(folder, sizeof folder, "%s/../%s/csg", LIMNER_SOURCE, positions[k]);
        if (stat(folder, &unused) != 0)
            *folder = 0;
    }
    snprintf(path, sizeof path, "%s/ref/reference.json", folder);
    json_t     *all = *folder ? json_load_file(path, 0, NULL) : NULL, *entry;
    const char *name;
    if (!all) {
        check_note("there is no corpus of solids here: nothing compared");
        skipped = true;
        return;
    }
    int count = 0;
    json_object_foreach(all, name, entry)
    {
        const char *stl = json_string_value(json_object_get(entry, "stl"));
        if (!stl)
            continue;
        count++;
        check_file(folder, name, stl);
    }
    check_at_least("corpus", count, 1, "solids with a mesh to compare with");
    json_decref(all);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"corpus", against_meshes}};
    int                     status = check_main(argc, argv, "solid_corpus", cases, sizeof cases / sizeof *cases);
    shot_end();
    return skipped ? SKIPPED : status;
}
