/* The subcommands, and what several of them need. */
#ifndef LIMNER_CLI_CLI_H
#define LIMNER_CLI_CLI_H

#include <jansson.h>

#include "limner/limner.h"
#include "message.h"
#include "options.h"

extern const command command_draw, command_depict, command_simulate, command_info, command_looks, command_bench,
    command_doctor, command_strokes, command_tiles, command_view;

/* All of them in the order of the usage text; NULL at the end. */
extern const command *const commands[];

/* "y" and "z" for --up-axis; index −1 … 1 gives the axis of the same position. */
extern const char *const up_axis_choices[];
lmn_up_axis              up_axis_of(int choice);

/* Loads files into a new scene. Errors are printed; returns the exit status. */
int scene_of_files(lmn_scene **out, const char *const *paths, size_t count, lmn_up_axis up, progress *p);

/* The same; definitions and strictness are for OpenSCAD programs (.scad) among them, and refused when there is none.
 * The level of detail is for city models, and the library refuses it with others. */
typedef struct program_options {
    const word_list *defines; /* NAME=VALUE */
    bool             strict;
    const char      *lod; /* NULL: the highest */
    const char      *terrain;
    double           populate;
    double           deflection; /* millimetres; 0: as the library sees fit */
} program_options;

/* "--lod", in every command that reads models. */
#define LOD_OPTION(at)                                                                                                 \
    {                                                                                                                  \
        "lod", 0, OPTION_TEXT, at, "N",                                                                                \
            "Of city models (CityJSON, CityGML): the most detailed geometry of each object up to this level, such as " \
            "1 "                                                                                                       \
            "or 2.2. Default: the most detailed."                                                                      \
    }
/* "--terrain" and "--populate", likewise. */
#define TERRAIN_OPTION(at)                                                                                             \
    {                                                                                                                  \
        "terrain", 0, OPTION_TEXT, at, "FILE",                                                                         \
            "Of city models and footprints: a raster of heights (.tif, .hgt, .asc) that lies below them, on which "    \
            "footprints, roads and the like are put. Needs GDAL."                                                      \
    }
#define POPULATE_OPTION(at)                                                                                            \
    {                                                                                                                  \
        "populate", 0, OPTION_NUMBER, at, "DENSITY",                                                                   \
            "Of footprints: people, cars, lamps and trees along roads; 1 as in an ordinary town, up to 4. Default: "   \
            "only those in the file.",                                                                                 \
            0, 4                                                                                                       \
    }
/* "--deflection", likewise. */
#define DEFLECTION_OPTION(at)                                                                                          \
    {                                                                                                                  \
        "deflection", 0, OPTION_NUMBER, at, "MM",                                                                      \
            "Of STEP and IGES files: how far triangles and lines may lie off curved surfaces, millimetres. Default: "  \
            "a 2000th "                                                                                                \
            "of the size of each part.",                                                                               \
            1e-9, 1e9                                                                                                  \
    }
int check_programs(const word_list *inputs, const program_options *programs);
int scene_of_programs(lmn_scene **out, const char *const *paths, size_t count, lmn_up_axis up,
                      const program_options *programs, progress *p);

/* Writes text into a file, whole or not at all; "-" is standard output. Prints what goes wrong; exit status. */
int store_text(const char *path, const char *text);

/* Prints text from the library and frees it; NULL is "out of memory". Returns the exit status. */
int print_and_free(char *text);

/* Parses JSON that the library wrote and frees the text; NULL is printed as an internal error. */
json_t *parse_and_free(char *text);

/* The number or text of a member, or the fallback; for tables that people read. */
double      number_at(const json_t *object, const char *key, double fallback);
const char *text_at(const json_t *object, const char *key, const char *fallback);

#endif
