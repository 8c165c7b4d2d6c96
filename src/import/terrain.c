/* Grids of heights: asking for them, filling their holes, and drawing them as what lies below a city. */
#include "import/terrain.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "import/access.h"
#include "import/city_crs.h"
#include "import/geodata.h"
#include "import/gunzip.h"

enum { POSTS_ALONG = 300, FEWEST_ALONG = 12 };

#define MARGIN       0.08 /* of the city's extent, beyond it */
#define LEAST_MARGIN 30.0 /* m */

void terrain_free(terrain *t)
{
    if (!t)
        return;
    mem_free(t->heights);
    mem_free(t->known);
    mem_free(t);
}

/* --- asking --------------------------------------------------------------------------------------------- */

/* In which system, and where in it, the city's coordinates are. */
typedef struct frame {
    char   system[256];
    double origin[2], metres; /* a position of the scene is (position − origin) · metres */
} frame;

static void find_frame(frame *out, const city_facts *city)
{
    out->metres = city_metres(city, 0);
    out->origin[0] = city->origin[0];
    out->origin[1] = city->origin[1];
    if (!city->geographic) {
        city_crs_plane_name(city->crs, out->system, sizeof out->system);
        return;
    }
    double meridian = city_meridian(city->origin[0]);
    snprintf(out->system, sizeof out->system, "+proj=tmerc +lat_0=0 +lon_0=%.0f +k=1 +datum=WGS84 +units=m +no_defs",
             meridian);
    city_plane(city->origin[0], city->origin[1], meridian, out->origin);
}

lmn_status terrain_take_extent(geodata_extent *out, char *system, size_t size, const fence_bytes *answer,
                               const char *path, lmn_error *error)
{
    fence_reader r = fence_read(answer->bytes, answer->size);
    const void  *extent = fence_take(&r, sizeof *out);
    char        *name = fence_take_text(&r);
    if (extent)
        memcpy(out, extent, sizeof *out);
    if (name)
        snprintf(system, size, "%s", name);
    bool good = extent && name && isfinite(out->low[0]) && isfinite(out->low[1]) && isfinite(out->high[0]) &&
                isfinite(out->high[1]) && out->step > 0 && isfinite(out->step);
    mem_free(name);
    return good ? LMN_OK : error_in_file(error, LMN_FORMAT, path, 0, "the raster does not say where it lies");
}

static lmn_status ask_extent(const import_job *job, geodata_extent *out, char *system, size_t size, lmn_error *error)
{
    fence_bytes answer;
    lmn_status  status = geodata_ask(job, GEODATA_EXTENT, NULL, NULL, &answer, error);
    if (status == LMN_OK)
        status = terrain_take_extent(out, system, size, &answer, job->path, error);
    mem_free(answer.bytes);
    return status;
}

/* How far apart posts are: as in the raster, but not more of them than can be drawn, nor so few that all is one plane.
 */
static void lay_grid(terrain *t, const city_facts *city, double native)
{
    double sides[2], longer;
    for (int k = 0; k < 2; k++) {
        double margin = fmax(MARGIN * (city->high[k] - city->low[k]), LEAST_MARGIN);
        t->low[k] = city->low[k] - margin;
        sides[k] = city->high[k] - city->low[k] + 2 * margin;
    }
    longer = fmax(sides[0], sides[1]);
    t->step = fmin(fmax(native, longer / POSTS_ALONG), longer / FEWEST_ALONG);
    t->columns = (uint32_t)(sides[0] / t->step) + 2;
    t->rows = (uint32_t)(sides[1] / t->step) + 2;
}

/* Heights that nobody knows are those of the nearest post in the row, or of the row before or behind. */
static bool fill(terrain *t, double zero)
{
    size_t   count = (size_t)t->columns * t->rows;
    uint64_t there = 0;
    for (size_t i = 0; i < count; i++) {
        t->known[i] = isfinite(t->heights[i]);
        t->heights[i] = t->known[i] ? (float)(t->heights[i] - zero) : NAN;
        there += t->known[i];
    }
    t->filled = count - there;
    for (uint32_t row = 0; row < t->rows; row++) {
        float *h = t->heights + (size_t)row * t->columns;
        for (uint32_t i = 1; i < t->columns; i++)
            h[i] = isfinite(h[i]) ? h[i] : h[i - 1];
        for (uint32_t i = t->columns - 1; i-- > 0;)
            h[i] = isfinite(h[i]) ? h[i] : h[i + 1];
    }
    for (uint32_t pass = 0; pass < 2; pass++)
        for (uint32_t n = 1; n < t->rows; n++) {
            uint32_t row = pass ? t->rows - 1 - n : n, other = pass ? row + 1 : row - 1;
            for (uint32_t i = 0; i < t->columns; i++) {
                float *h = &t->heights[(size_t)row * t->columns + i];
                *h = isfinite(*h) ? *h : t->heights[(size_t)other * t->columns + i];
            }
        }
    return there > 0;
}

lmn_status terrain_take_heights(terrain *t, const fence_bytes *answer, double zero, const char *path, lmn_error *error)
{
    size_t count = (size_t)t->columns * t->rows;
    t->heights = mem_calloc(count, sizeof *t->heights);
    t->known = mem_calloc(count, sizeof *t->known);
    if (!t->heights || !t->known)
        return error_memory(error);
    if (answer->size != count * sizeof *t->heights)
        return error_in_file(error, LMN_FORMAT, path, 0, "the terrain has not as many heights as it should");
    memcpy(t->heights, answer->bytes, answer->size);
    return fill(t, zero) ? LMN_OK : error_in_file(error, LMN_FORMAT, path, 0, "no height is known below the model");
}

static lmn_status ask_heights(const import_job *job, terrain *t, const frame *f, double zero, lmn_error *error)
{
    geodata_grid grid = {f->origin[0] + t->low[0] / f->metres, f->origin[1] + t->low[1] / f->metres,
                         t->step / f->metres, t->columns, t->rows};
    fence_bytes  answer;
    lmn_status   status = geodata_ask(job, GEODATA_HEIGHTS, &grid, f->system, &answer, error);
    if (status == LMN_OK)
        status = terrain_take_heights(t, &answer, zero, job->path, error);
    mem_free(answer.bytes);
    return status;
}

static lmn_status load(terrain *t, const import_job *job, const city_facts *city, lmn_error *error)
{
    geodata_extent extent;
    frame          f;
    char           system[256];
    lmn_status     status = ask_extent(job, &extent, system, sizeof system, error);
    if (status != LMN_OK)
        return status;
    find_frame(&f, city);
    if (!f.system[0] && extent.geographic) {
        error_in_file(error, LMN_USAGE, job->path, 0,
                      "the model does not name its coordinate system, and the terrain is in degrees");
        error_hint(error, "give the model a coordinate system, or terrain that is in the model's");
        return LMN_USAGE;
    }
    lay_grid(t, city, extent.geographic ? extent.step * 111000 : extent.step);
    return ask_heights(job, t, &f, city->origin[2] * city_metres(city, 1), error);
}

lmn_status terrain_load(terrain **out, const char *path, const city_facts *city, lmn_error *error)
{
    file_data  file = {0};
    import_job job = {.path = path, .model = path, .file = &file};
    *out = NULL;
    if (!city->known)
        return error_set(error, LMN_USAGE, "terrain is for models that say where they lie, which this one does not");
    lmn_status status = access_read(NULL, "terrain", path, &file, NULL, error);
    if (status == LMN_OK)
        status = gunzip(&file, path, error);
    if (status == LMN_OK && !geodata_is_raster(path, &file)) {
        status = error_in_file(error, LMN_FORMAT, path, 0, "this is no raster of heights");
        error_hint(error, "terrain is read from GeoTIFF (.tif), SRTM (.hgt) and ESRI's grids (.asc)");
    }
    terrain *t = status == LMN_OK ? mem_calloc(1, sizeof *t) : NULL;
    if (status == LMN_OK)
        status = t ? load(t, &job, city, error) : error_memory(error);
    file_data_release(&file);
    if (status == LMN_OK)
        *out = t;
    else
        terrain_free(t);
    return status;
}

lmn_status city_builder_terrain(city_builder *b)
{
    const char *path = b->job->desc ? b->job->desc->terrain : NULL;
    return path && !b->terrain ? terrain_load(&b->terrain, path, &b->scene->city, b->error) : LMN_OK;
}

/* --- heights -------------------------------------------------------------------------------------------- */

double terrain_height(const terrain *t, double x, double y)
{
    double   u = fmax(0, fmin((x - t->low[0]) / t->step, t->columns - 1.0));
    double   v = fmax(0, fmin((y - t->low[1]) / t->step, t->rows - 1.0));
    uint32_t column = (uint32_t)fmin(floor(u), t->columns - 2.0), row = (uint32_t)fmin(floor(v), t->rows - 2.0);
    u -= column;
    v -= row;
    const float *h = t->heights + (size_t)row * t->columns + column, *above = h + t->columns;
    return u >= v ? h[0] + u * (h[1] - h[0]) + v * (above[1] - h[1])
                  : h[0] + v * (above[0] - h[0]) + u * (above[1] - above[0]);
}

double terrain_lowest(const terrain *t, const double (*ring)[2], size_t count)
{
    enum { STEPS_MAX = 1000 };
    double lowest = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const double *a = ring[i], *b = ring[(i + 1) % count];
        int           steps = 1 + (int)fmin(2 * hypot(b[0] - a[0], b[1] - a[1]) / t->step, STEPS_MAX);
        for (int k = 0; k < steps; k++)
            lowest =
                fmin(lowest, terrain_height(t, a[0] + (b[0] - a[0]) * k / steps, a[1] + (b[1] - a[1]) * k / steps));
    }
    return isfinite(lowest) ? lowest : 0;
}

/* --- as a mesh ------------------------------------------------------------------------------------------ */

/* Twice a triangle's area along its normal; slivers count as little as they are seen. */
static vec3 area_of(const primitive *p, const uint32_t corners[3])
{
    const vec3   at = p->positions[corners[0]], b = p->positions[corners[1]], c = p->positions[corners[2]];
    const double u[3] = {(double)b.x - (double)at.x, (double)b.y - (double)at.y, (double)b.z - (double)at.z};
    const double v[3] = {(double)c.x - (double)at.x, (double)c.y - (double)at.y, (double)c.z - (double)at.z};
    return (vec3){(float)(u[1] * v[2] - u[2] * v[1]), (float)(u[2] * v[0] - u[0] * v[2]),
                  (float)(u[0] * v[1] - u[1] * v[0])};
}

bool terrain_make_smooth(primitive *p)
{
    enum { SHOWN_AS_OUTLINE = 1 };
    p->edges.values = mem_alloc(p->index_count);
    p->normals = mem_calloc(p->vertex_count, sizeof *p->normals);
    if (!p->edges.values || !p->normals)
        return false;
    memset(p->edges.values, SHOWN_AS_OUTLINE, p->index_count);
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        vec3 area = area_of(p, &p->indices[i]);
        for (int k = 0; k < 3; k++) {
            vec3 *n = &p->normals[p->indices[i + (uint32_t)k]];
            *n = (vec3){n->x + area.x, n->y + area.y, n->z + area.z};
        }
    }
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        vec3 *n = &p->normals[i];
        float length = sqrtf(n->x * n->x + n->y * n->y + n->z * n->z);
        *n = length > 0 ? (vec3){n->x / length, n->y / length, n->z / length} : (vec3){0, 0, 1};
    }
    return true;
}

static bool fill_mesh(const terrain *t, primitive *p)
{
    size_t posts = (size_t)t->columns * t->rows, cells = (size_t)(t->columns - 1) * (t->rows - 1);
    p->positions = mem_calloc(posts, sizeof *p->positions);
    p->indices = mem_calloc(6 * cells, sizeof *p->indices);
    if (!p->positions || !p->indices)
        return false;
    p->vertex_count = (uint32_t)posts;
    for (size_t i = 0; i < posts; i++)
        p->positions[i] = (vec3){(float)(t->low[0] + (double)(i % t->columns) * t->step),
                                 (float)(t->low[1] + (double)(i / t->columns) * t->step), t->heights[i]};
    for (uint32_t row = 0; row + 1 < t->rows; row++)
        for (uint32_t column = 0; column + 1 < t->columns; column++) {
            uint32_t a = row * t->columns + column, b = a + 1, c = a + t->columns + 1, d = a + t->columns;
            if (!t->known[a] || !t->known[b] || !t->known[c] || !t->known[d])
                continue;
            const uint32_t two[6] = {a, b, c, a, c, d};
            memcpy(p->indices + p->index_count, two, sizeof two);
            p->index_count += 6;
        }
    return true;
}

lmn_status terrain_into_scene(const terrain *t, city_builder *b)
{
    static const char type[] = "ReliefFeature";
    primitive         p = {.material = b->plain};
    mesh             *m = NULL;
    bool              good = fill_mesh(t, &p);
    if (good && p.index_count == 0) {
        primitive_release(&p);
        return LMN_OK;
    }
    good = good && terrain_make_smooth(&p) && (m = scene_append_mesh(b->scene)) && mesh_set_primitives(m, &p, 1);
    if (!good) {
        primitive_release(&p);
        return error_memory(b->error);
    }
    city_mesh         one = {(int32_t)b->scene->mesh_count - 1, city_word_of_class(type, sizeof type - 1)};
    const city_meshes meshes = {&one, 1, 1};
    int32_t           node = city_object(b, mem_copy_text("terrain"), type, sizeof type - 1);
    if (node == NONE)
        return error_memory(b->error);
    b->scene->nodes[node].numbered = true; /* the file has no name for it */
    b->surfaces[one.word]++;
    if (t->filled && !city_add(&b->scene->city, CITY_REPAIRED, "filled-heights", t->filled))
        return error_memory(b->error);
    return city_attach(b, node, &meshes, NULL, true);
}

/* --- alone ---------------------------------------------------------------------------------------------- */

lmn_status terrain_read(const import_job *job, lmn_error *error)
{
    geodata_extent extent;
    char           system[256] = "";
    city_builder   b;
    terrain       *t = NULL;
    city_facts    *city = &job->scene->city;
    lmn_status     status = ask_extent(job, &extent, system, sizeof system, error);
    if (status != LMN_OK)
        return status;
    double low[3] = {extent.low[0], extent.low[1], 0}, high[3] = {extent.high[0], extent.high[1], 0};
    city->crs = system[0] ? mem_copy_text(system) : NULL;
    city_crs_understand(city, city->crs, low, high, NULL);
    city_choose_origin(city, low, high);
    status = city_builder_open(&b, job, error);
    if (status == LMN_OK)
        t = mem_calloc(1, sizeof *t);
    if (status == LMN_OK)
        status = t ? load(t, job, city, error) : error_memory(error);
    b.terrain = t;
    if (status != LMN_OK || !t->heights) {
        b.terrain = NULL;
        terrain_free(t);
    }
    return city_builder_close(&b, status);
}
