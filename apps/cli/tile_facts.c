#include "tile_facts.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli.h"

/* FNV-1a. */
static uint64_t hash_on(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ at[i]) * UINT64_C(0x100000001b3);
    return hash;
}

static int hash_file(uint64_t *hash, const char *path)
{
    enum { PIECE = 1 << 16 };
    FILE *file = fopen(path, "rb");
    char *bytes = malloc(PIECE);
    int   status = bytes ? EXIT_DONE : message_out_of_memory();
    for (size_t size = 1; file && bytes && size > 0;) {
        size = fread(bytes, 1, PIECE, file);
        *hash = hash_on(*hash, bytes, size);
    }
    if (file && ferror(file))
        status = message_usage(NULL, "%s: cannot be read again", path);
    if (file)
        fclose(file);
    free(bytes);
    return status; /* what is no file was read by the library, which knows how */
}

/* Of the drawing but for its look and inputs; lists of numbers as they are compared. */
static char *settings_text(const pyramid *p, const tile_drawing *t)
{
    const lmn_draw_desc *d = t->desc;
    json_t              *root = json_pack(
                     "{s:s, s:i, s:i, s:i, s:s?, s:s?, s:s?, s:b, s:b, s:b, s:b, s:[f,f,f,f,f], s:[f,f,f], s:[f,f,f], "
                                  "s:[f,f,f], s:I, s:i}",
                     "version", lmn_version(), "tile", p->tile, "view", (int)d->view, "samples", d->samples, "camera", d->camera,
                     "background", d->background, "select", d->select, "orthographic", d->orthographic, "eye_given", d->eye_given,
                     "fit_direction", d->fit_direction, "time_given", d->time_given, "numbers", d->fov_deg, d->fit, d->time_s,
                     d->dpi, (double)d->lenient, "eye", d->eye[0], d->eye[1], d->eye[2], "target", d->target[0], d->target[1],
                     d->target[2], "up", d->up[0], d->up[1], d->up[2], "seed", (json_int_t)d->seed, "up_axis", t->up_axis);
    char *text = root ? json_dumps(root, JSON_COMPACT | JSON_SORT_KEYS) : NULL;
    json_decref(root);
    return text;
}

/* Files that the inputs name, textures for example, are not looked at. */
static int find_key(char out[17], const pyramid *p, const tile_drawing *t)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    char    *settings = settings_text(p, t), *look = lmn_look_json(t->look);
    int      status = settings && look ? EXIT_DONE : message_out_of_memory();
    if (status == EXIT_DONE) {
        hash = hash_on(hash, settings, strlen(settings) + 1);
        hash = hash_on(hash, look, strlen(look) + 1);
    }
    for (size_t i = 0; i < t->defines->count; i++)
        hash = hash_on(hash, t->defines->items[i], strlen(t->defines->items[i]) + 1);
    for (size_t i = 0; i < t->inputs->count && status == EXIT_DONE; i++)
        status = hash_file(&hash, t->inputs->items[i]);
    free(settings);
    lmn_text_free(look);
    snprintf(out, 17, "%016" PRIx64, hash);
    return status;
}

int tile_facts_make(json_t **out, const pyramid *p, const tile_drawing *t)
{
    char key[17], description[256];
    int  status = find_key(key, p, t);
    if (status != EXIT_DONE)
        return status;
    const char *slash = strrchr(t->inputs->items[0], '/'), *name = slash ? slash + 1 : t->inputs->items[0];
    snprintf(description, sizeof description, "Drawn by Limner with the look %.200s.", lmn_look_name(t->look));
    /* A picture has no place on Earth: as zoomable maps have it, it covers all of the square of Web Mercator. */
    const double side = 180, rim = 85.0511287798066;
    *out = json_pack("{s:s, s:s, s:s, s:s, s:[s], s:i, s:i, s:[f,f,f,f], s:[f,f,i], s:{s:s, s:s, s:s, s:i}}",
                     "tilejson", "3.0.0", "name", name, "description", description, "scheme", "xyz", "tiles",
                     "{z}/{x}/{y}.png", "minzoom", p->first, "maxzoom", p->last, "bounds", -side, -rim, side, rim,
                     "center", 0.0, 0.0, p->first, "limner", "version", lmn_version(), "look", lmn_look_name(t->look),
                     "drawing", key, "tile", p->tile);
    return *out ? EXIT_DONE : message_out_of_memory();
}

static const char *key_of(const json_t *facts)
{
    return text_at(json_object_get(facts, "limner"), "drawing", "");
}

int tile_facts_store(json_t *facts, const pyramid *p, bool page)
{
    char path[TILE_PATH + 16];
    int  status = EXIT_DONE;
    snprintf(path, sizeof path, "%s/tiles.json", p->folder);
    json_t *there = json_load_file(path, 0, NULL);
    if (there && strcmp(key_of(there), key_of(facts)) != 0) {
        status =
            message_usage("write into another folder, or remove this one",
                          "%s holds tiles of another drawing (look '%s', tiles of %.0f): another look, view, input "
                          "or version",
                          p->folder, text_at(json_object_get(there, "limner"), "look", "unknown"),
                          number_at(json_object_get(there, "limner"), "tile", 0));
        json_decref(there);
        return status;
    }
    int first = there ? (int)number_at(there, "minzoom", p->first) : p->first,
        last = there ? (int)number_at(there, "maxzoom", p->last) : p->last;
    json_object_set_new(facts, "minzoom", json_integer(first < p->first ? first : p->first));
    json_object_set_new(facts, "maxzoom", json_integer(last > p->last ? last : p->last));
    json_decref(there);
    char *text = json_dumps(facts, JSON_INDENT(2) | JSON_REAL_PRECISION(15));
    status = text ? store_text(path, text) : message_out_of_memory();
    free(text);
    snprintf(path, sizeof path, "%s/index.html", p->folder);
    return status == EXIT_DONE && page ? store_text(path, tile_page) : status;
}

void tile_folder_remove(const pyramid *p)
{
    char path[TILE_PATH + 16];
    for (int z = p->first; z <= p->last; z++) {
        for (long x = 0; x < 1L << z; x++) {
            for (long y = 0; y < 1L << z; y++)
                if (pyramid_path(p, z, (int)x, (int)y, path))
                    unlink(path);
            snprintf(path, sizeof path, "%s/%d/%ld", p->folder, z, x);
            rmdir(path);
        }
        snprintf(path, sizeof path, "%s/%d", p->folder, z);
        rmdir(path);
    }
    snprintf(path, sizeof path, "%s/tiles.json", p->folder);
    unlink(path);
    rmdir(p->folder);
}
