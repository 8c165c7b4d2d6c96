#include "halftone_scenes.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"
#include "picture.h"

static const double pi = 3.14159265358979323846;

halftone_part *halftone_add(halftone_scene *s, const char *name, int across, int up, halftone_place position,
                            const void *user)
{
    halftone_part *grown = check_alloc(s->count + 1, sizeof *grown);
    if (s->count)
        memcpy(grown, s->parts, s->count * sizeof *grown);
    free(s->parts);
    s->parts = grown;
    halftone_part *p = &s->parts[s->count++];
    *p = (halftone_part){.across = across, .up = up, .colour = {1, 1, 1}};
    snprintf(p->name, sizeof p->name, "%s", name);
    p->corners = check_alloc((size_t)(across + 1) * (size_t)(up + 1), sizeof *p->corners);
    for (int y = 0; y <= up; y++)
        for (int x = 0; x <= across; x++)
            position((double)x / across, (double)y / up, user, &p->corners[y * (across + 1) + x]);
    return p;
}

void halftone_release(halftone_scene *s)
{
    for (size_t i = 0; i < s->count; i++)
        free(s->parts[i].corners);
    free(s->parts);
    *s = (halftone_scene){0};
}

/* --- surfaces ------------------------------------------------------------------------------------------- */

static void set3(float out[3], double x, double y, double z)
{
    out[0] = (float)x;
    out[1] = (float)y;
    out[2] = (float)z;
}

static void place_wall(double s, double t, const void *user, halftone_corner *out)
{
    const halftone_wall *w = user;
    double               x = w->x + s * w->width, y = w->y + t * w->height;
    set3(out->at, x, y, w->z);
    set3(out->normal, 0, 0, 1);
    out->uv[0] = (float)(x * w->uv);
    out->uv[1] = (float)(y * w->uv);
    out->unique[0] = (float)s;
    out->unique[1] = (float)t;
}

halftone_part *halftone_add_wall(halftone_scene *s, const char *name, halftone_wall wall)
{
    return halftone_add(s, name, 1, 1, place_wall, &wall);
}

static void place_floor(double s, double t, const void *user, halftone_corner *out)
{
    const halftone_floor *f = user;
    double                x = (2 * s - 1) * f->half, z = f->near + t * (f->far - f->near);
    set3(out->at, x, 0, z);
    set3(out->normal, 0, 1, 0);
    out->uv[f->turned] = (float)(x * f->uv);
    out->uv[!f->turned] = (float)(-z * f->uv);
    out->unique[0] = (float)s;
    out->unique[1] = (float)t;
}

halftone_part *halftone_add_floor(halftone_scene *s, const char *name, halftone_floor floor)
{
    return halftone_add(s, name, 16, 64, place_floor, &floor);
}

static void place_tube(double s, double t, const void *user, halftone_corner *out)
{
    const halftone_tube *c = user;
    double               angle = 2 * pi * s;
    set3(out->at, c->radius * sin(angle), c->height * t, c->radius * cos(angle));
    set3(out->normal, sin(angle), 0, cos(angle));
    out->uv[0] = (float)(s * c->around);
    out->uv[1] = (float)(t * c->up);
    out->unique[0] = (float)s;
    out->unique[1] = (float)t;
}

halftone_part *halftone_add_tube(halftone_scene *s, const char *name, halftone_tube tube)
{
    return halftone_add(s, name, 128, 1, place_tube, &tube);
}

/* --- files ---------------------------------------------------------------------------------------------- */

static void put_base64(FILE *file, const uint8_t *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = (uint32_t)bytes[i] << 16 | (i + 1 < size ? (uint32_t)bytes[i + 1] << 8 : 0) |
                        (i + 2 < size ? bytes[i + 2] : 0);
        fputc(digits[word >> 18], file);
        fputc(digits[word >> 12 & 63], file);
        fputc(i + 1 < size ? digits[word >> 6 & 63] : '=', file);
        fputc(i + 2 < size ? digits[word & 63] : '=', file);
    }
}

/* The corner numbers of a grid's triangles; how many. */
static int triangles_of(const halftone_part *p, uint32_t *out)
{
    int count = 0, row = p->across + 1;
    for (int y = 0; y < p->up; y++)
        for (int x = 0; x < p->across; x++) {
            int       a = y * row + x;
            const int corners[6] = {a, a + 1, a + row + 1, a, a + row + 1, a + row};
            for (int k = 0; k < 6; k++)
                out[count++] = (uint32_t)corners[k];
        }
    return count;
}

/* Per corner 40 bytes, as in memory but for v, which glTF counts downwards; then the triangles. */
static void put_bytes(FILE *bin, const halftone_part *p)
{
    int count = (p->across + 1) * (p->up + 1);
    for (int i = 0; i < count; i++) {
        halftone_corner c = p->corners[i];
        c.uv[1] = 1 - c.uv[1];
        c.unique[1] = 1 - c.unique[1];
        fwrite(&c, sizeof c, 1, bin);
    }
    uint32_t *indices = check_alloc((size_t)(p->across * p->up * 6), sizeof *indices);
    int       n = triangles_of(p, indices);
    fwrite(indices, sizeof *indices, (size_t)n, bin);
    free(indices);
}

static void put_accessors(FILE *file, const halftone_part *p, size_t at, size_t index)
{
    static const char *const types[] = {"VEC3", "VEC3", "VEC2", "VEC2"};
    static const size_t      offsets[] = {0, 12, 24, 32};
    int                      corners = (p->across + 1) * (p->up + 1);
    float                    low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int i = 0; i < corners; i++)
        for (int k = 0; k < 3; k++) {
            low[k] = fminf(low[k], p->corners[i].at[k]);
            high[k] = fmaxf(high[k], p->corners[i].at[k]);
        }
    (void)at;
    for (int k = 0; k < 4; k++) {
        fprintf(file, "%s{\"bufferView\":%zu,\"byteOffset\":%zu,\"componentType\":5126,\"count\":%d,\"type\":\"%s\"",
                index || k ? "," : "", 2 * index, offsets[k], corners, types[k]);
        if (k == 0)
            fprintf(file, ",\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]", (double)low[0], (double)low[1],
                    (double)low[2], (double)high[0], (double)high[1], (double)high[2]);
        fputc('}', file);
    }
    fprintf(file, ",{\"bufferView\":%zu,\"componentType\":5125,\"count\":%d,\"type\":\"SCALAR\"}", 2 * index + 1,
            p->across * p->up * 6);
}

static void put_nodes(FILE *file, const halftone_scene *s)
{
    fprintf(file, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[");
    for (size_t i = 0; i < s->count + (size_t)s->light_count; i++)
        fprintf(file, "%s%zu", i ? "," : "", i);
    fprintf(file, "]}],\"nodes\":[");
    for (size_t i = 0; i < s->count; i++)
        fprintf(file, "%s{\"name\":\"%s\",\"mesh\":%zu}", i ? "," : "", s->parts[i].name, i);
    for (int i = 0; i < s->light_count; i++)
        fprintf(file, ",{\"translation\":[%.9g,%.9g,%.9g],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}",
                s->lights[i][0], s->lights[i][1], s->lights[i][2]);
    fprintf(file, "],");
    if (s->light_count)
        fprintf(file, "\"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{\"KHR_lights_punctual\":{"
                      "\"lights\":[{\"type\":\"point\",\"intensity\":1}]}},");
}

static void put_materials(FILE *file, const halftone_scene *s)
{
    int images = 0;
    fprintf(file, "\"materials\":[");
    for (size_t i = 0; i < s->count; i++) {
        const halftone_part *p = &s->parts[i];
        fprintf(file, "%s{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.9g,%.9g,%.9g,1]",
                i ? "," : "", (double)p->colour[0], (double)p->colour[1], (double)p->colour[2]);
        if (p->picture[0])
            fprintf(file, ",\"baseColorTexture\":{\"index\":%d}", images++);
        fprintf(file, "}}");
    }
    fprintf(file, "],");
    for (int list = 0; list < 2 && images; list++) {
        fprintf(file, list ? "\"textures\":[" : "\"images\":[");
        for (int i = 0, k = 0; i < (int)s->count; i++)
            if (s->parts[i].picture[0]) {
                if (list)
                    fprintf(file, "%s{\"source\":%d}", k ? "," : "", k);
                else
                    fprintf(file, "%s{\"uri\":\"%s\"}", k ? "," : "", s->parts[i].picture);
                k++;
            }
        fprintf(file, "],");
    }
}

static bool write_gltf(const char *path, const halftone_scene *s)
{
    char  *bytes = NULL;
    size_t size = 0, at = 0;
    FILE  *bin = open_memstream(&bytes, &size), *file = fopen(path, "wb");
    if (!file || !bin)
        return false;
    put_nodes(file, s);
    put_materials(file, s);
    fprintf(file, "\"meshes\":[");
    for (size_t i = 0; i < s->count; i++) {
        fprintf(file,
                "%s{\"primitives\":[{\"material\":%zu,\"indices\":%zu,\"attributes\":{\"POSITION\":%zu,\"NORMAL\":%zu,"
                "\"TEXCOORD_0\":%zu",
                i ? "," : "", i, 5 * i + 4, 5 * i, 5 * i + 1, 5 * i + 2);
        fprintf(file, s->parts[i].second ? ",\"TEXCOORD_1\":%zu}}]}" : "}}]}", 5 * i + 3);
    }
    fprintf(file, "],\"accessors\":[");
    for (size_t i = 0; i < s->count; i++)
        put_accessors(file, &s->parts[i], at, i);
    fprintf(file, "],\"bufferViews\":[");
    for (size_t i = 0; i < s->count; i++) {
        const halftone_part *p = &s->parts[i];
        size_t               corners = (size_t)((p->across + 1) * (p->up + 1)) * sizeof(halftone_corner),
               indices = (size_t)(p->across * p->up * 6) * 4;
        fprintf(file,
                "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":%zu},{\"buffer\":0,"
                "\"byteOffset\":%zu,\"byteLength\":%zu}",
                i ? "," : "", at, corners, sizeof(halftone_corner), at + corners, indices);
        at += corners + indices;
        put_bytes(bin, p);
    }
    fclose(bin);
    fprintf(file, "],\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:application/octet-stream;base64,", size);
    put_base64(file, (const uint8_t *)bytes, size);
    fprintf(file, "\"}]}");
    free(bytes);
    return fclose(file) == 0;
}

static bool write_obj(const char *path, const halftone_scene *s)
{
    char mtl[512];
    snprintf(mtl, sizeof mtl, "%.*s.mtl", (int)(strlen(path) - 4), path);
    const char *name = strrchr(mtl, '/') ? strrchr(mtl, '/') + 1 : mtl;
    FILE       *file = fopen(path, "wb"), *materials = fopen(mtl, "wb");
    if (!file || !materials)
        return false;
    fprintf(file, "mtllib %s\n", name);
    int first = 1;
    for (size_t i = 0; i < s->count; i++) {
        const halftone_part *p = &s->parts[i];
        int                  count = (p->across + 1) * (p->up + 1);
        fprintf(materials, "newmtl m%zu\nKd %g %g %g\n", i, (double)p->colour[0], (double)p->colour[1],
                (double)p->colour[2]);
        if (p->picture[0])
            fprintf(materials, "map_Kd %s\n", p->picture);
        fprintf(file, "o %s\nusemtl m%zu\n", p->name, i);
        for (int k = 0; k < count; k++) {
            const halftone_corner *c = &p->corners[k];
            fprintf(file, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\nvt %.9g %.9g\n", (double)c->at[0], (double)c->at[1],
                    (double)c->at[2], (double)c->normal[0], (double)c->normal[1], (double)c->normal[2],
                    (double)c->uv[0], (double)c->uv[1]);
        }
        uint32_t *indices = check_alloc((size_t)(p->across * p->up * 6), sizeof *indices);
        int       n = triangles_of(p, indices);
        for (int k = 0; k < n; k++)
            fprintf(file, "%s%d/%d/%d%s", k % 3 ? " " : "f ", (int)indices[k] + first, (int)indices[k] + first,
                    (int)indices[k] + first, k % 3 == 2 ? "\n" : "");
        free(indices);
        first += count;
    }
    fclose(materials);
    return fclose(file) == 0;
}

bool halftone_write(const char *path, const halftone_scene *s)
{
    const char *ending = strrchr(path, '.');
    return ending && strcmp(ending, ".obj") == 0 ? write_obj(path, s) : write_gltf(path, s);
}

/* --- drawings ------------------------------------------------------------------------------------------- */

shot_view halftone_view(int width, int height, double pixels)
{
    double x = width / pixels / 2, y = height / pixels / 2, distance = 10;
    return (shot_view){.width = width,
                       .height = height,
                       .eye = {x, y, distance},
                       .target = {x, y, 0},
                       .up = {0, 1, 0},
                       .orthographic = true,
                       .fov_deg = atan(y / distance) * 360 / pi,
                       .without_maps = true};
}

const char *halftone_look_with(const char *surface, const char *scene, const char *more)
{
    static char texts[4][4096];
    static int  next;
    char       *text = texts[next];
    next = (next + 1) % 4;
    snprintf(text, sizeof texts[0],
             "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"scene\":{%s},\"rules\":[{\"surface\":"
             "{%s\"technique\":\"%s}%s}]}",
             scene,
             strncmp(surface, "textured", 8) == 0 || strstr(surface, "\"ink\"")
                 ? ""
                 : "\"ink\":\"#000000\",\"paper\":\"#ffffff\",",
             surface, more);
    return text;
}

const char *halftone_look(const char *surface)
{
    return halftone_look_with(surface, "", "");
}

double halftone_ink(const shot *s, int x, int y)
{
    return 1 - picture_shown(s->picture[4 * (y * s->width + x) + 1]);
}

double halftone_mean(const shot *s, int x, int y, int width, int height)
{
    double sum = 0;
    for (int j = y; j < y + height; j++)
        for (int i = x; i < x + width; i++)
            sum += halftone_ink(s, i, j);
    return sum / (width * height);
}

double halftone_difference(const shot *a, const shot *b)
{
    double sum = 0;
    for (int i = 0; i < a->width * a->height; i++)
        sum += fabs(picture_shown(a->picture[4 * i]) - picture_shown(b->picture[4 * i]));
    return sum / (a->width * a->height);
}

static double overlap(double from, double to, int at)
{
    return fmax(fmin(to, at + 1) - fmax(from, at), 0);
}

double halftone_box(const shot *s, double x, double y, double width, double height)
{
    double sum = 0, area = 0;
    for (int j = (int)floor(y); j < y + height; j++)
        for (int i = (int)floor(x); i < x + width; i++) {
            if (i < 0 || j < 0 || i >= s->width || j >= s->height)
                continue;
            double fraction = overlap(x, x + width, i) * overlap(y, y + height, j);
            sum += fraction * halftone_ink(s, i, j);
            area += fraction;
        }
    return area > 0 ? sum / area : 0;
}

static double texel_at(const mip_chain *c, int layer, int level, int x, int y)
{
    int w = c->width >> level, h = c->height >> level;
    w = w ? w : 1;
    h = h ? h : 1;
    const uint8_t *texels = (const uint8_t *)c->data[level] + (size_t)layer * (size_t)w * (size_t)h;
    return texels[((y % h + h) % h) * w + (x % w + w) % w] / 255.0;
}

static double bilinear(const mip_chain *c, int layer, double u, double v, int level)
{
    int    w = c->width >> level, h = c->height >> level;
    double x = u * (w ? w : 1) - 0.5, y = v * (h ? h : 1) - 0.5;
    int    i = (int)floor(x), j = (int)floor(y);
    double p = x - i, q = y - j;
    return (texel_at(c, layer, level, i, j) * (1 - p) + texel_at(c, layer, level, i + 1, j) * p) * (1 - q) +
           (texel_at(c, layer, level, i, j + 1) * (1 - p) + texel_at(c, layer, level, i + 1, j + 1) * p) * q;
}

double halftone_sample(const mip_chain *chain, int layer, double u, double v, double level)
{
    level = fmin(fmax(level, 0), chain->levels - 1);
    if (chain->nearest) {
        int k = (int)floor(level + 0.5), width = mip_width(chain, k), height = mip_height(chain, k);
        int x = (int)floor((u - floor(u)) * width), y = (int)floor((v - floor(v)) * height);
        return ((const uint8_t *)mip_layer(chain, k, layer))[y * width + x] / 255.0;
    }
    int    low = (int)floor(level), high = low + 1 < chain->levels ? low + 1 : low;
    double fraction = level - low;
    return bilinear(chain, layer, u, v, low) * (1 - fraction) +
           (fraction > 0 ? bilinear(chain, layer, u, v, high) * fraction : 0);
}

bool halftone_shot(shot *out, const halftone_scene *s, const char *file, const char *look, const char *const *changes,
                   const shot_view *view)
{
    char path[512];
    snprintf(path, sizeof path, "%s", check_path("%s", file));
    *out = (shot){0};
    if (!halftone_write(path, s))
        return check_that("files", false, "%s can be written", path);
    return shot_take(out, path, look, changes, view);
}

int halftone_command(const char *command, const char *arguments, char *out, size_t capacity)
{
    char line[8192];
    snprintf(line, sizeof line, "%s %s 2>&1", command, arguments);
    FILE *pipe = popen(line, "r");
    if (!pipe)
        return -1;
    size_t got = fread(out, 1, capacity - 1, pipe);
    out[got] = '\0';
    while (fgetc(pipe) != EOF) {
    }
    int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* Heights of runs of ink in columns whose middle is dark. */
double halftone_width(const shot *s, double *within)
{
    double sum = 0;
    int    runs = 0, good = 0;
    for (int x = 0; x < s->width; x++)
        for (int y = 0; y < s->height; y++) {
            double width = 0, most = 0;
            int    from = y;
            while (y < s->height && halftone_ink(s, x, y) > 0.08) {
                width += halftone_ink(s, x, y);
                most = fmax(most, halftone_ink(s, x, y));
                y++;
            }
            if (most < 0.5 || from == 0 || y == s->height)
                continue;
            runs++;
            sum += width;
            good += width >= 0.5 && width <= 1.5;
        }
    *within = runs ? (double)good / runs : 0;
    return runs ? sum / runs : 0;
}

/* A wall that fills the picture however far it is: `octave` 0 is 100 px a unit. */
bool halftone_far(shot *out, const char *surface, double octave, int side, double uv)
{
    double         pixels = 100 / exp2(octave), reach = side / pixels;
    halftone_scene s = {0};
    shot_view      view = halftone_view(side, side, pixels);
    halftone_add_wall(&s, "wall", (halftone_wall){-reach, -reach, 0, 3 * reach, 3 * reach, uv});
    bool ok = halftone_shot(out, &s, "far.gltf", halftone_look(surface), NULL, &view);
    halftone_release(&s);
    return ok;
}

void halftone_begin(void)
{
    setenv("LIMNER_CACHE", "", 1);
}

void halftone_begin_kept(const char *program)
{
    char folder[128], path[512];
    snprintf(folder, sizeof folder, "truth/made-%s", program);
    mkdir("truth", 0777);
    mkdir(folder, 0777);
    DIR *files = opendir(folder);
    for (struct dirent *file = files ? readdir(files) : NULL; file; file = readdir(files)) {
        snprintf(path, sizeof path, "%s/%s", folder, file->d_name);
        unlink(path);
    }
    if (files)
        closedir(files);
    setenv("LIMNER_CACHE", folder, 1);
}
