#include "pyramid.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "message.h"

int pyramid_parse_zoom(const char *text, pyramid *out)
{
    int used = 0, count = sscanf(text, "%4d%n:%4d%n", &out->first, &used, &out->last, &used);
    if (count == 1)
        out->last = out->first;
    if (count < 1 || text[used] || out->first < 0 || out->last < out->first || out->last > ZOOM_MOST)
        return message_usage("for example --zoom 0:4", "--zoom is '%.40s'; allowed is FIRST:LAST with 0 up to %d", text,
                             ZOOM_MOST);
    return EXIT_DONE;
}

long pyramid_page(const pyramid *p, int zoom)
{
    return (long)p->tile << zoom;
}

/* Tiles a side of blocks, and blocks a side of the picture. */
static long tiles_of_block(const pyramid *p, int zoom)
{
    long whole = 1L << zoom, most = BLOCK_SIDE / p->tile;
    return whole < most ? whole : most;
}

static long blocks_across(const pyramid *p, int zoom)
{
    return (1L << zoom) / tiles_of_block(p, zoom);
}

long pyramid_block_count(const pyramid *p)
{
    long count = 0;
    for (int z = p->first; z <= p->last; z++)
        count += blocks_across(p, z) * blocks_across(p, z);
    return count;
}

tile_block pyramid_block_at(const pyramid *p, long index)
{
    int  z = p->last;
    long across = blocks_across(p, z);
    for (; z > p->first && index >= across * across; across = blocks_across(p, --z))
        index -= across * across;
    long side = tiles_of_block(p, z);
    return (tile_block){z, (int)(index % across * side), (int)(index / across * side), (int)side};
}

long pyramid_tile_count(const pyramid *p)
{
    long count = 0;
    for (int z = p->first; z <= p->last; z++)
        count += 1L << (2 * z);
    return count;
}

bool pyramid_path(const pyramid *p, int zoom, int x, int y, char out[TILE_PATH])
{
    int length = snprintf(out, TILE_PATH, "%s/%d/%d/%d.png", p->folder, zoom, x, y);
    return length > 0 && length < TILE_PATH;
}

bool pyramid_has(const pyramid *p, int zoom, int x, int y)
{
    char path[TILE_PATH];
    return pyramid_path(p, zoom, x, y, path) && lmn_picture_is_whole(path, p->tile, p->tile);
}

bool pyramid_has_block(const pyramid *p, const tile_block *b)
{
    for (int i = 0; i < b->side * b->side; i++)
        if (!pyramid_has(p, b->zoom, b->x + i % b->side, b->y + i / b->side))
            return false;
    return true;
}

int make_folders(const char *path)
{
    char part[TILE_PATH];
    int  length = snprintf(part, sizeof part, "%s", path);
    if (length < 0 || length >= (int)sizeof part)
        return message_output(path, "the name is too long");
    for (char *at = part + 1;; at++) {
        char kept = *at;
        if (kept != '/' && kept != '\0')
            continue;
        *at = '\0';
        if (mkdir(part, 0777) != 0 && errno != EEXIST)
            return message_output(part, strerror(errno));
        if (kept == '\0')
            break;
        *at = kept;
    }
    struct stat facts;
    if (stat(path, &facts) != 0 || !S_ISDIR(facts.st_mode))
        return message_output(path, "it is no folder");
    return EXIT_DONE;
}

static int store_tile(const pyramid *p, const tile_block *b, int column, int row, const lmn_drawing *drawing)
{
    char      path[TILE_PATH];
    lmn_error error = {0};
    const int part[4] = {column * p->tile, row * p->tile, p->tile, p->tile};
    if (!pyramid_path(p, b->zoom, b->x + column, b->y + row, path))
        return message_output(p->folder, "the name is too long");
    return lmn_drawing_write_part(drawing, part, path, ".png", NULL, &error) == LMN_OK ? EXIT_DONE
                                                                                       : message_error(&error);
}

int pyramid_store(const pyramid *p, const tile_block *b, const lmn_drawing *drawing, bool again)
{
    int  status = EXIT_DONE;
    char folder[TILE_PATH];
    for (int column = 0; column < b->side && status == EXIT_DONE; column++) {
        int length = snprintf(folder, sizeof folder, "%s/%d/%d", p->folder, b->zoom, b->x + column);
        status = length < TILE_PATH ? make_folders(folder) : message_output(p->folder, "the name is too long");
        for (int row = 0; row < b->side && status == EXIT_DONE; row++)
            if (again || !pyramid_has(p, b->zoom, b->x + column, b->y + row))
                status = store_tile(p, b, column, row, drawing);
    }
    return status;
}
