/* limner tiles: a zoomable pyramid of tiles, each part of one big picture, drawn by as many processes as one likes. */
#include "cli.h"
#include "job.h"
#include "mbtiles.h"
#include "names.h"
#include "pyramid.h"
#include "sets.h"
#include "task.h"
#include "tile_facts.h"
#include "viewpoint.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct tiles_values {
    const char      *output, *zoom, *look, *select, *cut, *background;
    word_list        sets, defines;
    option_number    time, seed, samples, dpi, populate, deflection;
    const char      *lod, *terrain;
    int              up_axis, tile;
    bool             resume, strict, lenient, quiet, verbose;
    viewpoint_values viewpoint;
    job_values       job;
    task_values      task;
} tiles_values;

static const char *const tile_sizes[] = {"256", "512", NULL};

#define AT(field) offsetof(tiles_values, field)

static const option options[] = {
    {"output", 'o', OPTION_TEXT, AT(output), "DIR|FILE.mbtiles",
     "Folder for z/x/y.png, tiles.json and index.html, or one MBTiles file. Default: the first INPUT's stem and "
     "-tiles."},
    {"zoom", 'z', OPTION_TEXT, AT(zoom), "FIRST:LAST",
     "Zooms to draw. At 0 the whole picture is one tile; each step doubles its sides. Default: 0:3."},
    {"tile", 0, OPTION_CHOICE, AT(tile), "256|512", "Pixels a side of a tile. Default: 256.", .choices = tile_sizes},
    {"look", 'l', OPTION_TEXT, AT(look), "NAME|FILE", "Look: one of `limner looks`, or a file. Default: edges."},
    {"set", 's', OPTION_LIST, AT(sets), "KIND.PARAM=VALUE",
     "Set a parameter of the look, for all rules or with RULE:KIND.PARAM for one. May be repeated."},
    {"select", 0, OPTION_TEXT, AT(select), "SEL", "Draw and fit only these parts."},
    {"cut", 0, OPTION_TEXT, AT(cut), "SPEC", "Cut a section, as of `limner draw`."},
    {"dpi", 0, OPTION_NUMBER, AT(dpi), "N",
     "Pixels an inch, for lengths of looks, which are on paper: the same at all zooms, so that lines keep their width "
     "in pixels. Default: 96.",
     1, 10000},
    VIEWPOINT_OPTIONS(tiles_values),
    {"time", 0, OPTION_NUMBER, AT(time), "SECONDS", "Draw the model as it is at this time of its animation.", -1e9,
     1e9},
    {"seed", 0, OPTION_WHOLE, AT(seed), "N", "Seed of everything random. Default: 0.", 0, 4294967295.0},
    {"samples", 0, OPTION_WHOLE, AT(samples), "N", "Samples a pixel: 1, 4, 9 or 16. Default: 1.", 1, 16},
    {"background", 0, OPTION_TEXT, AT(background), "COLOUR|none", "Ground of the picture. Default: the look's."},
    {"up-axis", 0, OPTION_CHOICE, AT(up_axis), "y|z", "Which of the file's axes points up. Default: the format's.",
     .choices = up_axis_choices},
    LOD_OPTION(AT(lod)),
    TERRAIN_OPTION(AT(terrain)),
    POPULATE_OPTION(AT(populate)),
    DEFLECTION_OPTION(AT(deflection)),
    {"resume", 0, OPTION_FLAG, AT(resume), NULL, "Draw only tiles that are not there yet."},
    JOB_OPTIONS(tiles_values),
    TASK_OPTIONS(tiles_values),
    {"define", 'D', OPTION_LIST, AT(defines), "NAME=VALUE",
     "Of OpenSCAD programs (.scad): a variable's value instead of the program's. May be repeated."},
    {"strict", 0, OPTION_FLAG, AT(strict), NULL, "Of OpenSCAD programs: warnings are errors."},
    {"lenient", 0, OPTION_FLAG, AT(lenient), NULL,
     "Draw what can be drawn and warn of the rest, instead of refusing it."},
    {"quiet", 'q', OPTION_FLAG, AT(quiet), NULL, "No warnings and no progress."},
    {"verbose", 'v', OPTION_FLAG, AT(verbose), NULL, "Say what is done."},
};

/* One run of the command. */
typedef struct tiles_run {
    const tiles_values *values;
    char                folder[TILE_PATH], packed[TILE_PATH]; /* packed: the MBTiles file; empty: none */
    pyramid             pyramid;
    shard               shard;
    lmn_look           *look;
    lmn_scene          *scene;
    lmn_renderer       *renderer;
    lmn_draw_desc       desc;
    json_t             *facts; /* tiles.json */
    progress            bar;
    long                done, to_draw; /* blocks */
    char                label[64];
    bool                warned;
} tiles_run;

/* --- arguments ------------------------------------------------------------------------------------------ */

static int check_values(const tiles_values *v)
{
    if (v->quiet && v->verbose)
        return message_usage(NULL, "--quiet and --verbose exclude each other");
    for (int side = 1; side <= 4; side++)
        if (!v->samples.given || (int)v->samples.value == side * side)
            return EXIT_DONE;
    return message_usage(NULL, "--samples is '%d'; allowed are 1, 4, 9 and 16", (int)v->samples.value);
}

/* The finest picture must be one that pictures can be at all; whether the driver can draw it, it says itself. */
static int check_pages(tiles_run *t)
{
    enum { PAGE_MOST = 16384 };
    pyramid *p = &t->pyramid;
    p->tile = t->values->tile == 1 ? 512 : 256;
    int status = pyramid_parse_zoom(t->values->zoom ? t->values->zoom : "0:3", p), most = 0;
    int side = 1, samples = t->values->samples.given ? (int)t->values->samples.value : 1;
    while (side * side < samples)
        side++;
    while (pyramid_page(p, most + 1) * side <= PAGE_MOST)
        most++;
    if (status == EXIT_DONE && p->last > most)
        return message_usage("fewer zooms, smaller tiles or fewer samples",
                             "--zoom %d is a picture of %ld pixels a side with %d sample%s each; with these the last "
                             "possible zoom is %d",
                             p->last, pyramid_page(p, p->last), samples, samples == 1 ? "" : "s", most);
    return status;
}

static int find_output(tiles_run *t, const word_list *inputs)
{
    const tiles_values *v = t->values;
    struct stat         facts;
    int                 length;
    if (mbtiles_is_name(v->output)) {
        if (!mbtiles_possible())
            return message_usage("build it with libsqlite3-dev, or write a folder",
                                 "this limner was built without SQLite, which MBTiles need");
        snprintf(t->packed, sizeof t->packed, "%s", v->output);
        length = snprintf(t->folder, sizeof t->folder, "%s.tiles", v->output);
    } else if (v->output) {
        length = snprintf(t->folder, sizeof t->folder, "%s", v->output);
    } else {
        char *stem = name_stem(inputs->items[0]);
        if (!stem)
            return message_out_of_memory();
        length = snprintf(t->folder, sizeof t->folder, "%s-tiles", stem);
        free(stem);
    }
    if (length < 1 || length >= TILE_PATH - 64)
        return message_usage(NULL, "the name of the output is too long, or empty");
    if (strcmp(t->folder, "-") == 0)
        return message_usage("-o DIR, or -o FILE.mbtiles", "tiles cannot go to standard output");
    if (stat(t->folder, &facts) == 0 && !S_ISDIR(facts.st_mode))
        return message_usage("-o DIR, or -o FILE.mbtiles", "'%s' is a file; tiles go into a folder", t->folder);
    t->pyramid.folder = t->folder;
    return EXIT_DONE;
}

static int load_look(tiles_run *t)
{
    lmn_error error = {0};
    if (lmn_look_load(&t->look, t->values->look ? t->values->look : "edges", &error) != LMN_OK)
        return message_error(&error);
    int status = set_all(t->look, &t->values->sets, t->values->cut != NULL);
    if (status != EXIT_DONE)
        return status;
    if (t->values->cut && lmn_look_set(t->look, "scene.cut", t->values->cut, &error) != LMN_OK)
        return message_error(&error);
    return EXIT_DONE;
}

/* --- drawing -------------------------------------------------------------------------------------------- */

/* lmn_progress_fn: the whole run as one bar. */
static bool report(double fraction, const char *stage, void *user)
{
    tiles_run *t = user;
    double     all = t->to_draw > 0 ? (double)t->to_draw : 1;
    return progress_report(((double)t->done + fraction) / all, stage, &t->bar);
}

static int fill_desc(tiles_run *t)
{
    enum { SCREEN_DPI = 96 };
    const tiles_values *v = t->values;
    lmn_draw_desc       d = LMN_DRAW_DESC_INIT;
    d.time_s = v->time.given ? v->time.value : d.time_s;
    d.time_given = v->time.given;
    d.seed = v->seed.given ? (uint32_t)v->seed.value : d.seed;
    d.dpi = v->dpi.given ? v->dpi.value : SCREEN_DPI;
    d.samples = v->samples.given ? (int)v->samples.value : 1;
    d.background = v->background;
    d.select = v->select;
    d.lenient = v->lenient;
    d.progress = report;
    d.progress_user = t;
    const int status = viewpoint_fill(&d, &v->viewpoint, t->scene);
    t->desc = d;
    return status;
}

static void print_warnings(tiles_run *t, const lmn_drawing *drawing)
{
    size_t times = 1;
    for (size_t i = 0; i < lmn_drawing_warning_count(drawing) && !t->warned && !t->values->quiet; i++) {
        const char *code = NULL, *text = lmn_drawing_warning_at(drawing, i, &code, &times);
        if (!text || strcmp(code, "layer-memory") == 0)
            continue;
        progress_erase(&t->bar);
        message_warning(text, times);
    }
    t->warned = true; /* those of other blocks are the same */
}

static int draw_block(tiles_run *t, const tile_block *b)
{
    lmn_error     error = {0};
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc d = t->desc;
    int           page = (int)pyramid_page(&t->pyramid, b->zoom), side = b->side * t->pyramid.tile;
    d.width = d.height = page;
    if (side < page) {
        d.window[0] = b->x * t->pyramid.tile;
        d.window[1] = b->y * t->pyramid.tile;
        d.window[2] = d.window[3] = side;
    }
    snprintf(t->label, sizeof t->label, "zoom %d, block %ld of %ld", b->zoom, t->done + 1, t->to_draw);
    t->bar.label = t->label;
    if (lmn_draw(&drawing, t->renderer, t->scene, t->look, &d, &error) != LMN_OK) {
        progress_erase(&t->bar);
        return message_error(&error);
    }
    print_warnings(t, drawing);
    int status = pyramid_store(&t->pyramid, b, drawing, !t->values->resume);
    lmn_drawing_destroy(&drawing);
    t->done++;
    return status;
}

/* Is the block this run's, and not there? */
static bool is_wanted(const tiles_run *t, long index)
{
    tile_block b = pyramid_block_at(&t->pyramid, index);
    return shard_has(&t->shard, index) && !(t->values->resume && pyramid_has_block(&t->pyramid, &b));
}

static int draw_blocks(tiles_run *t)
{
    long  count = pyramid_block_count(&t->pyramid);
    bool *wanted = calloc((size_t)count, sizeof *wanted);
    int   status = wanted ? EXIT_DONE : message_out_of_memory();
    for (long i = 0; i < count && wanted; i++)
        t->to_draw += wanted[i] = is_wanted(t, i);
    if (status == EXIT_DONE && t->to_draw > 0) {
        lmn_error         error = {0};
        lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
        if (lmn_renderer_create(&t->renderer, &desc, &error) != LMN_OK)
            status = message_error(&error);
    }
    for (long i = 0; i < count && status == EXIT_DONE; i++) {
        tile_block b = pyramid_block_at(&t->pyramid, i);
        if (!wanted[i])
            continue;
        status = progress_cancelled() ? EXIT_CANCELLED : draw_block(t, &b);
    }
    progress_erase(&t->bar);
    free(wanted);
    if (status == EXIT_DONE && t->values->verbose)
        message_note("%ld blocks drawn into %s", t->done, t->folder);
    return status;
}

/* --- the whole ------------------------------------------------------------------------------------------ */

/* What was drawn into a folder of its own for one file goes when that is there. */
static int pack(tiles_run *t)
{
    if (!t->packed[0] || t->shard.count > 1)
        return EXIT_DONE;
    int status = mbtiles_pack(t->packed, &t->pyramid, t->facts);
    if (status == EXIT_DONE)
        tile_folder_remove(&t->pyramid);
    return status;
}

static int draw_all(tiles_run *t, const word_list *inputs)
{
    const tiles_values   *v = t->values;
    const program_options programs = {&v->defines, v->strict,         v->lod,
                                      v->terrain,  v->populate.value, v->deflection.value};
    int status = scene_of_programs(&t->scene, inputs->items, inputs->count, up_axis_of(v->up_axis), &programs, &t->bar);
    if (status != EXIT_DONE)
        return status;
    status = fill_desc(t);
    if (status == EXIT_DONE)
        status = tile_facts_make(&t->facts, &t->pyramid,
                                 &(tile_drawing){t->look, &t->desc, inputs, &v->defines, v->up_axis});
    if (status == EXIT_DONE)
        status = make_folders(t->folder);
    if (status == EXIT_DONE)
        status = tile_facts_store(t->facts, &t->pyramid, !t->packed[0]);
    if (status == EXIT_DONE)
        status = draw_blocks(t);
    return status == EXIT_DONE ? pack(t) : status;
}

static int print_job(const tiles_run *t, const word_list *inputs)
{
    return job_print(&command_tiles, inputs, t->values, &t->values->job, t->packed[0] ? "" : NULL);
}

static int run(const word_list *inputs, const void *values)
{
    const tiles_values *v = values;
    tiles_run           t = {.values = v};
    lmn_task           *task = NULL;
    int                 status = viewpoint_check(&v->viewpoint);
    if (status == EXIT_DONE)
        status = check_values(v);
    if (status == EXIT_DONE)
        status = job_check(&v->job);
    if (status == EXIT_DONE)
        status = shard_parse(v->job.shard, &t.shard);
    if (status == EXIT_DONE)
        status = check_pages(&t);
    if (status == EXIT_DONE)
        status = find_output(&t, inputs);
    if (status == EXIT_DONE)
        status = check_programs(inputs, &(program_options){&v->defines, v->strict, NULL, NULL, 0});
    if (status == EXIT_DONE)
        status = load_look(&t);
    if (status == EXIT_DONE && v->job.kind >= 0) {
        status = print_job(&t, inputs);
    } else if (status == EXIT_DONE) {
        progress_begin(&t.bar, v->quiet);
        status = task_begin(&task, &v->task, &t.bar);
        if (status == EXIT_DONE)
            status = draw_all(&t, inputs);
        lmn_task_end(&task);
    }
    json_decref(t.facts);
    lmn_scene_destroy(&t.scene);
    lmn_renderer_destroy(&t.renderer);
    lmn_look_destroy(&t.look);
    return status;
}

const command command_tiles = {
    .name = "tiles",
    .inputs = "INPUT…",
    .summary = "Draw models as a zoomable map of tiles, on as many machines as there are.",
    .detail =
        "Each tile is a part of one big picture of its zoom. docs/TILES.md tells how shards run on several machines.\n"
        "Exit status: as `limner draw`.",
    .options = options,
    .option_count = OPTION_COUNT(options),
    .values_size = sizeof(tiles_values),
    .inputs_min = 1,
    .inputs_max = (size_t)-1,
    .run = run,
};
