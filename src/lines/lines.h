/* The kind "lines": where lines are, and how they are inked. */
#ifndef LIMNER_LINES_LINES_H
#define LIMNER_LINES_LINES_H

#include "technique/technique.h"

extern const kind kind_lines;

/* What the passes "dashes" and "overshoot" do; see lines/dash.h and lines/overshoot.h. */
bool dash_process(const pass_pixels *in, void *out, const void *values);
bool overshoot_process(const pass_pixels *in, void *out, const void *values);

/* What every line technique has. First member of each technique's parameters. */
typedef struct lines_common {
    colour  colour, inner_colour, id_colour, light_colour;
    float   width, profile_weight, inner_weight, id_weight;
    float   gain, threshold, sharpen;
    int32_t contrast;
    float   offset_x, offset_y, suppress, blur;
    float   dash, gap, overshoot, halo;
} lines_common;

/* Side branches shorter than this come from thinning, pixels. */
#define LINES_SPUR 3.5f

/* Pixels of lines (not 0): the strongest class of ink of an edge map, as the ink shader weighs them. Ink of less
 * than a line's weight is shading; lines that are translucent are lines all the same. */
void lines_find_ink(uint8_t *ink, const float *edges, size_t count, const lines_common *lines);

/* How wide lines are that operators find, in pixels: all that is known is between which pixels an edge runs. */
enum { LINES_FOUND_WIDTH = 2 };

/* How far lines look for others that they yield to, in widths: lines/edge/crowd_blur.frag. */
enum { LINES_CROWD_WIDTHS = 6 };

/* What contrast-aware lines look at. */
#define LINES_PASSES_CONTRAST                                                                                          \
    {.name = "ground",                                                                                                 \
     .shader = "lines/ground.frag",                                                                                    \
     .reads = {TARGET_SHADE, TARGET_PAGE},                                                                             \
     .writes = TARGET_GROUND,                                                                                          \
     .when = "contrast=adaptive"},                                                                                     \
    {                                                                                                                  \
        .name = "blur ground", .shader = "lines/blur.frag", .reads = {TARGET_GROUND}, .writes = TARGET_GROUND,         \
        .repeat = 2, .when = "contrast=adaptive"                                                                       \
    }

/* Pictures that line techniques keep for themselves, rows of lines_targets. */
#define LINES_OUTLINES                                                                                                 \
    TARGET_OWN(0) /* r = 1 − window depth where lines are outlines that something is behind, 0 elsewhere */
#define LINES_NEARER_ROW TARGET_OWN(1) /* how near the nearest outline is across */
#define LINES_FILTERED   TARGET_OWN(2) /* normal and normalised depth, which may be sampled with a filter */
#define LINES_GRADIENT   TARGET_OWN(3) /* r = first-order, g = second-order difference of depth */
#define LINES_FEET       TARGET_OWN(4) /* where the edge beside a pixel is: lines/edge/feet.frag */
#define LINES_TILES      TARGET_OWN(5) /* 1: a tile that lines may reach */
#define LINES_SEEDS      TARGET_OWN(6) /* lines/seed.glsl */
#define LINES_PAIRS      TARGET_OWN(7) /* lines/edge/pairs.frag */
#define LINES_BARE                                                                                                     \
    TARGET_OWN(8) /* 0 beside edges that are drawn already, else 1; r: of outlines, g: of others, b: of a piece's      \
                     steps beside its creases */
#define LINES_THIN   TARGET_OWN(9)  /* the edge map, two pixels wide, of what is not drawn already */
#define LINES_WHOLE  TARGET_OWN(10) /* the edge map, two pixels wide, of all lines */
#define LINES_STYLED TARGET_OWN(11) /* the same, run on and cut short */
#define LINES_CROWD  TARGET_OWN(12) /* r: length of lines around, pixels in a square pixel */
#define LINES_CALM   TARGET_OWN(13) /* 1: a tile where lines crowd: lines/calm.glsl */
enum { LINES_TARGET_COUNT = 14 };
extern const target_row lines_targets[LINES_TARGET_COUNT];
#define LINES_TARGETS .targets = lines_targets, .target_count = LINES_TARGET_COUNT

/* Lines as wide as they are to be, from a map of what is beside them and, where they are known, the places of edges. Of
 * lines so broad that the pixels beside them are far, floods find the nearest of those that have ink. */
#define LINES_PASSES_FLOOD(map, feet)                                                                                  \
    {.name = "wide tiles",                                                                                             \
     .shader = "lines/tiles_wide.frag",                                                                                \
     .reads = {LINES_TILES},                                                                                           \
     .writes = LINES_TILES,                                                                                            \
     .when = "width>3"},                                                                                               \
        {.name = "flood's first",                                                                                      \
         .shader = "lines/flood_first.frag",                                                                           \
         .reads = {map, LINES_TILES, feet},                                                                            \
         .writes = LINES_SEEDS,                                                                                        \
         .tiles = LINES_TILES,                                                                                         \
         .when = "width>3"},                                                                                           \
    {                                                                                                                  \
        .name = "flood", .shader = "lines/flood.frag", .reads = {LINES_SEEDS, LINES_TILES}, .writes = LINES_SEEDS,     \
        .rounds = lines_flood_rounds, .tiles = LINES_TILES, .when = "width>3"                                          \
    }
/* The same of what operators found that know no more than pixels. */
#define LINES_PASSES_SPREAD                                                                                            \
    {.name = "tiles", .shader = "lines/tiles.frag", .reads = {TARGET_EDGE}, .writes = LINES_TILES, .when = "width>2"}, \
        LINES_PASSES_FLOOD(TARGET_EDGE, TARGET_NONE),                                                                  \
    {                                                                                                                  \
        .name = "spread", .shader = "lines/spread.frag", .reads = {TARGET_EDGE, LINES_TILES, LINES_SEEDS},             \
        .writes = TARGET_EDGE, .tiles = LINES_TILES, .when = "width>2"                                                 \
    }
int lines_flood_rounds(const void *values);
/* Once where lines run on, are cut short or dashed, else not at all. */
int lines_style_rounds(const void *values);

/* Passes that surround an operator's own. Lines run on, stop short of what is in front and are dashed before they
 * grow: thin ones are traced best, and dashes know where lines end. */
#define LINES_PASSES_BEFORE                                                                                            \
    {                                                                                                                  \
        .name = "prefilter", .shader = "lines/edge/prefilter.frag", .reads = {TARGET_NORMAL_DEPTH},                    \
        .writes = TARGET_NORMAL_DEPTH, .when = "sharpen"                                                               \
    }
#define LINES_PASSES_STYLISE(found, styled, changed)                                                                   \
    {.name = "overshoot",                                                                                              \
     .process = overshoot_process,                                                                                     \
     .reads = {found, TARGET_NORMAL_DEPTH},                                                                            \
     .writes = TARGET_OVERSHOOT,                                                                                       \
     .when = "overshoot",                                                                                              \
     .stylised = true},                                                                                                \
        {.name = "overshoot ink",                                                                                      \
         .shader = "lines/edge/overshoot.frag",                                                                        \
         .reads = {found, TARGET_OVERSHOOT},                                                                           \
         .writes = styled,                                                                                             \
         .when = "overshoot",                                                                                          \
         .stylised = true},                                                                                            \
        {.name = "halo outlines",                                                                                      \
         .shader = "lines/halo_outline.frag",                                                                          \
         .reads = {found, TARGET_DEPTH, TARGET_NORMAL_DEPTH, changed},                                                 \
         .writes = LINES_OUTLINES,                                                                                     \
         .when = "halo",                                                                                               \
         .stylised = true},                                                                                            \
        {.name = "halo across",                                                                                        \
         .shader = "lines/halo_row.frag",                                                                              \
         .reads = {LINES_OUTLINES},                                                                                    \
         .writes = LINES_NEARER_ROW,                                                                                   \
         .when = "halo",                                                                                               \
         .stylised = true},                                                                                            \
    {                                                                                                                  \
        .name = "dashes", .process = dash_process, .reads = {found, changed}, .writes = TARGET_DASH, .when = "dash",   \
        .stylised = true                                                                                               \
    }
/* Last, when lines are as wide as they are to be. */
#define LINES_PASSES_HALO                                                                                              \
    {                                                                                                                  \
        .name = "halo", .shader = "lines/halo.frag",                                                                   \
        .reads = {TARGET_EDGE, TARGET_DEPTH, TARGET_NORMAL_DEPTH, LINES_OUTLINES, LINES_NEARER_ROW, TARGET_OVERSHOOT}, \
        .writes = TARGET_EDGE, .when = "halo", .stylised = true                                                        \
    }
#define LINES_PASSES_BEHIND                                                                                            \
    LINES_PASSES_STYLISE(TARGET_EDGE, TARGET_EDGE, TARGET_NONE), LINES_PASSES_SPREAD, LINES_PASSES_HALO,               \
        LINES_PASSES_CONTRAST

extern const technique lines_discontinuity, lines_four_tap, lines_sobel, lines_saito, lines_saito_normalised,
    lines_denormal, lines_id, lines_colour, lines_shadow, lines_shell, lines_strokes;

/* As strokes of a mesh: outlines, borders and creases as wide, as coloured and as dashed as the technique's lines.
 * `values` begin with lines_common. */
void lines_as_strokes(struct stroke_options *options, struct stroke_style *style, const void *values);

#endif
