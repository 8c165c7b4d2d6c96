#include "mbtiles.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "cli.h"

bool mbtiles_is_name(const char *path)
{
    const char *dot = path ? strrchr(path, '.') : NULL;
    return dot && strcasecmp(dot, ".mbtiles") == 0;
}

#ifdef LIMNER_SQLITE
#include <sqlite3.h>

/* A file while it is written. */
typedef struct packing {
    const char   *path; /* that is told */
    sqlite3      *base;
    sqlite3_stmt *tile, *fact;
} packing;

bool mbtiles_possible(void)
{
    return true;
}

static int complain(const packing *k)
{
    return message_output(k->path, k->base ? sqlite3_errmsg(k->base) : "out of memory");
}

/* The file is thrown away unless it is whole, so that nothing needs to be undone in it. */
static const char SCHEMA[] = "PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; PRAGMA application_id=0x4d504258;"
                             "CREATE TABLE metadata (name text, value text);"
                             "CREATE TABLE tiles (zoom_level integer, tile_column integer, tile_row integer, "
                             "tile_data blob);"
                             "CREATE UNIQUE INDEX tile_index ON tiles (zoom_level, tile_column, tile_row);";

static int open_base(packing *k, const char *temporary)
{
    if (sqlite3_open(temporary, &k->base) != SQLITE_OK ||
        sqlite3_exec(k->base, SCHEMA, NULL, NULL, NULL) != SQLITE_OK ||
        sqlite3_prepare_v2(k->base, "INSERT INTO tiles VALUES (?, ?, ?, ?)", -1, &k->tile, NULL) != SQLITE_OK ||
        sqlite3_prepare_v2(k->base, "INSERT INTO metadata VALUES (?, ?)", -1, &k->fact, NULL) != SQLITE_OK)
        return complain(k);
    return EXIT_DONE;
}

static int add_fact(packing *k, const char *name, const char *value)
{
    sqlite3_reset(k->fact);
    sqlite3_bind_text(k->fact, 1, name, -1, SQLITE_STATIC);
    sqlite3_bind_text(k->fact, 2, value, -1, SQLITE_STATIC);
    return sqlite3_step(k->fact) == SQLITE_DONE ? EXIT_DONE : complain(k);
}

static int add_facts(packing *k, const pyramid *p, const json_t *facts)
{
    char first[8], last[8];
    snprintf(first, sizeof first, "%d", p->first);
    snprintf(last, sizeof last, "%d", p->last);
    const char *const rows[][2] = {{"name", text_at(facts, "name", "")},
                                   {"format", "png"},
                                   {"type", "baselayer"},
                                   {"version", "1"},
                                   {"description", text_at(facts, "description", "")},
                                   {"bounds", "-180,-85.0511287798066,180,85.0511287798066"},
                                   {"center", "0,0,0"},
                                   {"minzoom", first},
                                   {"maxzoom", last}};
    int               status = EXIT_DONE;
    for (size_t i = 0; i < OPTION_COUNT(rows) && status == EXIT_DONE; i++)
        status = add_fact(k, rows[i][0], rows[i][1]);
    return status;
}

/* The bytes of a tile's file; free() them. NULL when it cannot be read. */
static void *read_tile(const char *path, long *size)
{
    FILE *file = fopen(path, "rb");
    void *bytes = NULL;
    if (file && fseek(file, 0, SEEK_END) == 0 && (*size = ftell(file)) > 0 && fseek(file, 0, SEEK_SET) == 0 &&
        (bytes = malloc((size_t)*size)) && fread(bytes, 1, (size_t)*size, file) != (size_t)*size) {
        free(bytes);
        bytes = NULL;
    }
    if (file)
        fclose(file);
    return bytes;
}

static int add_tile(packing *k, const pyramid *p, int zoom, int x, int y)
{
    char  path[TILE_PATH];
    long  size = 0;
    void *bytes = pyramid_path(p, zoom, x, y, path) ? read_tile(path, &size) : NULL;
    if (!bytes)
        return message_output(path, "the tile cannot be read");
    sqlite3_reset(k->tile);
    sqlite3_bind_int(k->tile, 1, zoom);
    sqlite3_bind_int(k->tile, 2, x);
    sqlite3_bind_int(k->tile, 3, (1 << zoom) - 1 - y); /* rows are counted from below */
    sqlite3_bind_blob(k->tile, 4, bytes, (int)size, free);
    return sqlite3_step(k->tile) == SQLITE_DONE ? EXIT_DONE : complain(k);
}

/* A transaction for so many tiles: one for each takes most of the time. */
static int add_tiles(packing *k, const pyramid *p)
{
    enum { TOGETHER = 1000 };
    long count = 0;
    int  status = sqlite3_exec(k->base, "BEGIN", NULL, NULL, NULL) == SQLITE_OK ? EXIT_DONE : complain(k);
    for (int z = p->first; z <= p->last; z++)
        for (long i = 0; i < 1L << (2 * z) && status == EXIT_DONE; i++) {
            status =
                progress_cancelled() ? EXIT_CANCELLED : add_tile(k, p, z, (int)(i >> z), (int)(i & ((1L << z) - 1)));
            if (status == EXIT_DONE && ++count % TOGETHER == 0 &&
                sqlite3_exec(k->base, "COMMIT; BEGIN", NULL, NULL, NULL) != SQLITE_OK)
                status = complain(k);
        }
    if (status == EXIT_DONE && sqlite3_exec(k->base, "COMMIT", NULL, NULL, NULL) != SQLITE_OK)
        status = complain(k);
    return status;
}

int mbtiles_pack(const char *path, const pyramid *p, const json_t *facts)
{
    char    temporary[TILE_PATH];
    packing k = {.path = path};
    int     length = snprintf(temporary, sizeof temporary, "%s.%ld.part", path, (long)getpid());
    if (length < 0 || length >= (int)sizeof temporary)
        return message_output(path, "the name is too long");
    remove(temporary);
    int status = open_base(&k, temporary);
    if (status == EXIT_DONE)
        status = add_facts(&k, p, facts);
    if (status == EXIT_DONE)
        status = add_tiles(&k, p);
    sqlite3_finalize(k.tile);
    sqlite3_finalize(k.fact);
    if (sqlite3_close(k.base) != SQLITE_OK && status == EXIT_DONE)
        status = complain(&k);
    if (status == EXIT_DONE && rename(temporary, path) != 0)
        status = message_output(path, "the file cannot be put in its place");
    if (status != EXIT_DONE)
        remove(temporary);
    return status;
}

#else

bool mbtiles_possible(void)
{
    return false;
}

int mbtiles_pack(const char *path, const pyramid *p, const json_t *facts)
{
    (void)p, (void)facts;
    return message_output(path, "this limner was built without SQLite");
}

#endif
