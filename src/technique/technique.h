/* What a technique is: a room's parameters, the G-buffer channels it needs and the passes it draws, all declared as
 * data. A kind is a table of techniques that answer the same question. src/frame runs them without knowing any by
 * name. */
#ifndef LIMNER_TECHNIQUE_TECHNIQUE_H
#define LIMNER_TECHNIQUE_TECHNIQUE_H

#include "base/mip_chain.h"
#include "base/text.h"
#include "technique/param.h"
#include "technique/target.h"

/* What the geometry pass can write for each pixel. Only what some technique needs is drawn. */
typedef enum channel {
    CHANNEL_NORMAL_DEPTH = 1 << 0, /* eye-space unit normal, linear eye depth (−z, file units) */
    CHANNEL_ID = 1 << 1,           /* part id (0 = empty), surface id */
    CHANNEL_ALBEDO = 1 << 2,       /* unlit surface colour, light */
    CHANNEL_SHADE = 1 << 3,        /* the surface technique's colour as it is shown, premultiplied */
    CHANNEL_REST = 1 << 4,         /* of deformed parts: where it is when nothing has moved, in its part's frame; 1 */
    CHANNEL_VELOCITY = 1 << 5,     /* pixels moved over the exposure: right, up; window depth before; 1 */
    CHANNEL_DETAIL = 1 << 6        /* what the surface technique's detail shader tells of the geometry */
} channel;

enum { PASS_READS_MAX = 13, NUMBERS_MAX = 96 };

typedef enum pass_blend { BLEND_NONE, BLEND_MIN, BLEND_OVER, BLEND_UNDER } pass_blend;

/* What a pass on the CPU reads: a part of its pictures, row 0 at the bottom. */
typedef struct pass_pixels {
    const float   *values[PASS_READS_MAX]; /* of each picture that it reads, 4 a pixel */
    const uint8_t *own; /* not 0 where the figure's own surfaces are; NULL: all that is there is its own */
    int            x, y, width, height; /* of the part */
    float          pixel; /* side of a pixel at depth 1 in perspective, at any depth without, file units */
    float          scale; /* pixels of the picture to one that is seen: more than 1 with several samples */
    bool           perspective;
} pass_pixels;

/* Where strips are needed. */
typedef struct strip_view {
    int      width, height, box[4]; /* of the page, and of the object on it, pixels */
    uint32_t seed;
    double   time_s;
} strip_view;

/* Strips of triangles that a pass draws instead of the screen: one a record. */
typedef struct strip_source {
    const char *vertex;                  /* path below src/ */
    int (*vertices)(const void *values); /* of one */
    /* Records of four floats, attribute 0 of all its vertices; free with mem_free. NULL when memory is gone. */
    float *(*make)(size_t *count, const void *values, const strip_view *view);
} strip_source;

/* One full-screen pass. Reading what it writes is allowed: the runner gives it a second picture. */
typedef struct pass {
    const char *name;
    const char *shader;                /* path below src/, for example "lines/edge/four_tap.frag" */
    target      reads[PASS_READS_MAX]; /* as samplers t_NAME, with HAS_NAME, in capitals, where the picture is there */
    target      writes;
    target      writes_too; /* TARGET_NONE, or a second picture of the same size: WRITES_TOO */
    pass_blend  blend;
    bool depth;    /* test gl_FragDepth against the page, and write it there (a depth sprite) unless a layer is drawn */
    bool geometry; /* draws the figure's parts again instead of a full screen: shaded and inked by the shader file's
                      ink_at */
    const char *enlarge; /* with geometry: key of the length in pixels by which surfaces are moved along their normals;
                            no shader */
    bool shell; /* with enlarge: only faces that look away, moved across the page; their depth alone is written */
    /* Instead of a shader: work on the CPU, from pictures of floats to one of integers. In `out` is what passes of
     * the figure's line techniques before wrote, or zeros. Gets the technique's values; false when memory is gone. */
    bool (*process)(const pass_pixels *in, void *out, const void *values);
    /* Draws a mover's geometry, each pixel at as many moments of the exposure as this parameter says, with this
     * fragment shader; the nearest depth goes into the next of the technique's own targets. */
    const char *scattered;
    target      tiles; /* TARGET_NONE, or a picture of SCALE_TILE: drawn only in the tiles where it is not 0 */
    bool
        records; /* instead of a shader: edges of the figure's meshes, where they are on the page: lines/records.vert */
    bool strokes; /* instead of a shader: strokes of the figure's parts, as the technique's strokes_values say */
    const strip_source *strips; /* these instead of the screen, one over the other; into a picture of depth the nearest
                                   (DEPTH_ALONE) */
    int repeat;                 /* 0 and 1: once; n: n times, ping-ponged, with u_iteration counting */
    int (*rounds)(const void *values); /* instead of `repeat`, by the technique's values */
    target      with, without;         /* TARGET_NONE, or only if this picture is there, or is not */
    const char *when;                  /* condition on the technique's parameters; NULL: always */
    bool prepares; /* surface: run before the figure is shaded from its G-buffer, not after; left out where it is shaded
                      with its geometry */
    bool onto;     /* drawn onto what is there, which it does not read */
    bool stylised; /* left out in maps, which show what was detected */
    bool looks_up; /* where the figure's perturbation says, though it is not drawn onto the page */
} pass;

/* What a technique wants meshes to have besides positions and normals. */
typedef struct mesh_needs {
    bool  field; /* the direction in which surfaces bend */
    float patch; /* radius of patches that cover them, fraction of a mesh's diagonal; 0: none */
    bool  rest;  /* where vertices of deformed parts are when nothing has moved */
    bool  walls; /* where on a wall a vertex of an upright face lies */
    bool  glue;  /* patches between the two sides of hard edges, which motion pulls apart */
} mesh_needs;

struct stroke_style;

/* What a technique that moves lookups must tell. */
typedef struct perturbation {
    /* GLSL file with find_positions, fill_position, line_position, copy_ink, fill_fraction and LINE_COPIES; see
     * compose/positions.glsl. With BROAD_LINES also broadening and most_broadening; see lines/ink.glsl and
     * compose/reach.glsl. */
    const char *positions;
    bool (*active)(const void *values); /* false: pictures are what they are without it */
    float (*reach)(const void *values); /* how far it moves anything, pixels */
    float (*cell)(const void *values);  /* side of the texels of coarse pictures, pixels */
    uint32_t (*seed)(const void *values, uint32_t seed, double time_s); /* u_seed: from the drawing's */
    const struct pass *map;                                             /* writes TARGET_FIELD; NULL: there is none */
    void (*as_hand)(struct stroke_style *style,
                    const void *values); /* as vectors: what it does to strokes, lengths in pixels; NULL: nothing */
} perturbation;

/* A texture that a technique makes from its parameters on the CPU. Shaders get it as sampler2DArray t_NAME, its
 * longer side, layers, levels and fact as vec4 u_NAME_facts, HAS_NAME, in capitals, and SIMILAR_NAME and
 * NEAREST_NAME where the chain is. */
typedef struct texture_source {
    const char *name;
    const char *when; /* condition on the parameters; NULL: always */
    /* Appends all that decides the content; equal text, equal texture. */
    void (*describe)(text *out, const void *values);
    lmn_status (*make)(mip_chain *out, const void *values, lmn_error *error);
    bool kept; /* takes long: it is kept on disk */
} texture_source;

/* Marks that lie on a figure's surfaces and are drawn over it once it is shaded: src/marks/marks.h. */
struct marks;
struct mark_surface;
typedef struct mark_source {
    /* Appends all that decides which marks there are. */
    void (*describe)(text *out, const void *values);
    /* `extent`: diagonal of what is drawn. */
    lmn_status (*make)(struct marks *out, const struct mark_surface *surface, double extent, const void *values,
                       lmn_error *error);
    const char *vertex, *fragment;      /* paths below src/ */
    float (*point)(const void *values); /* the largest dot's diameter, pixels: drawn as points (AS_POINTS) where the
                                           driver has such large ones, else as quads. NULL: quads */
} mark_source;

struct layering;
struct stroke_options;

/* What a surface technique is beside its passes. */
typedef struct surface_row {
    const char *shader;  /* GLSL file with `vec4 surface_colour(surface_point p)`, several joined by '+' */
    const char *outside; /* text of the last of them and how messages call it, where it is no file of the library */
    const char *label;
    bool        direct;         /* may be drawn straight onto the page when the rule has no lines */
    bool        forward;        /* always shaded while the geometry is drawn, whatever the layers ask for */
    bool        reflects;       /* wants TARGET_REFLECTION */
    const char *detail;         /* GLSL file with `vec4 surface_detail()`, four fractions, of what a place is that only
                                   the geometry pass knows; shading later finds them in t_detail. For walls' meshes
                                   alone (needs); NULL: nothing */
    const char *light_map_when; /* condition under which it wants t_light_map, the light (its function light_of) laid
                                   out by texture coordinates */
    const char *forward_when;   /* the same as `forward` under this condition on its parameters; NULL: never */
    const char *deferred_when;  /* condition under which it is shaded from the G-buffer wherever that can be; NULL: as
                                   the layers say */
    mesh_needs (*needs)(const void *values); /* NULL: nothing */
    /* Changes values to those for a material whose picture has strokes in this file (NULL: it has none), for its
     * textures; false: all materials are alike. NULL: always so. */
    bool (*by_material)(void *values, const char *strokes);
    /* May it draw the shadow on the ground, too, on a page of this colour? Its tone there is p.albedo.a (ON_GROUND).
     * NULL: no. */
    bool (*on_ground)(const void *values, colour ground);
    /* It draws a shadow that is thrown on the ground, whose colour is p.albedo.rgb, too, as something to be laid over
     * the page. */
    bool               casts_on_ground;
    const mark_source *marks; /* what is drawn over it; NULL: nothing */
    /* As vectors. */
    bool (*as_fill)(colour *out, const void *values); /* its one colour, sRGB; false: it has more. NULL: it has more */
    void (*as_marks)(void *values); /* changes values so that one pen can draw its marks, all alike; NULL: they are */
} surface_row;

/* What tells of motion: by whole pictures of several times, or by passes over what moves (TARGET_MOVER). */
typedef struct motion_row {
    int (*times)(const void *values);                /* pictures: how many; NULL: none */
    double (*weight)(const void *values, int newer); /* of one that so many are newer than */
    bool (*plate)(const void *values);   /* the pictures are laid over each other; weights are of their ink */
    bool (*through)(const void *values); /* of a plate: older figures show through newer ones */
    /* Are their moments those that tell most? How many, 0: as many as tell something, and how much of one figure may
     * lie over another one. NULL: they are equally far apart */
    bool (*chooses)(const void *values, int *count, double *cover);
    int (*steps)(
        const void *values); /* passes: how many steps of the past they read, 1, 2 or 4; NULL: there are none */
    unsigned (*moved)(const void *values); /* channels that they read of what moves, besides its velocity; NULL: none */
    bool stretched;                        /* they read TARGET_STRETCHED */
    bool of_meshes;                        /* they draw vertices: solids have none */
    bool traces;                           /* lines with geometry behind what moves (src/trace) */
} motion_row;

/* What a line technique is. */
typedef struct lines_row {
    const char *detect;  /* of one pass: GLSL file with `void detect_edges()`; NULL: others */
    bool        own_ink; /* compositions get its own parameters too, with which it is inked */
    /* As vectors, lengths in pixels: which strokes and how they look; NULL: lines_as_strokes. */
    void (*as_strokes)(struct stroke_options *options, struct stroke_style *style, const void *values);
} lines_row;

/* What a composition is. */
typedef struct compose_row {
    const char *merges_when; /* condition on the lines' common parameters under which it runs a single line technique's
                              * `detect` itself instead of reading its map; NULL: never */
    const char *map_when; /* condition on its own parameters under which it needs the map all the same, as any further
                             pass does that reads it */
    bool layered;         /* takes layers, one by one */
    bool perturbable;     /* its passes onto the page look maps up where compose/positions.glsl says */
    bool lines_only;      /* surfaces are not drawn */
} compose_row;

/* What a technique of layers is: which surfaces are seen, src/layer/layer.h. */
typedef struct layers_row {
    void (*layering)(struct layering *out, const void *values);
} layers_row;

/* What all techniques have, and a row of their kind. */
typedef struct technique {
    const char           *name, *doc; /* doc: one line that ends in a full stop */
    const char           *example;    /* JSON of a rule that shows it: test input and documentation */
    const param          *params;
    size_t                param_count, params_size;
    unsigned              channels;      /* of channel, that its passes read */
    unsigned              part_channels; /* the same, needed only when the figure has several parts */
    const pass           *passes;
    size_t                pass_count;
    const target_row     *targets;      /* pictures that these passes alone write and read: TARGET_OWN(0) and up */
    size_t                target_count; /* at most OWN_TARGETS_MAX */
    const texture_source *textures;     /* surface, finish: what it makes on the CPU */
    size_t                texture_count;
    /* surface, perturb: what its shader needs and is the same for every pixel, into vec4 u_numbers[]; returns how
     * many, at most NUMBERS_MAX. NULL: nothing. */
    size_t (*numbers)(const void *values, uint32_t seed, int width, int height, float out[][4]);
    /* That of its kind; scene and finish have none. */
    const surface_row  *surface;
    const lines_row    *lines;
    const compose_row  *compose;
    const layers_row   *layers;
    const perturbation *perturbs; /* how lookups are moved */
    const motion_row   *motion;
} technique;

typedef enum kind_id {
    KIND_SCENE, /* look-wide: light and geometry preparation */
    KIND_LAYERS,
    KIND_SURFACE,
    KIND_LINES,
    KIND_PERTURB,
    KIND_COMPOSE,
    KIND_MOTION,
    KIND_FINISH, /* look-wide: the sheet */
    KIND_COUNT
} kind_id;

/* A table of techniques. Parameters in `common` belong to every technique of the kind; their struct is the first
 * member of each technique's parameter struct. */
typedef struct kind {
    kind_id                 id;
    const char             *name, *doc;
    const technique *const *techniques;
    size_t                  technique_count;
    const technique        *standard; /* used when a rule does not say; NULL: nothing is drawn by this kind */
    const char  *selector_key;        /* "technique", or another key that names the technique ("operator" for lines) */
    bool         look_wide;           /* one for the whole look instead of one a rule */
    bool         array;               /* a rule may hold several, drawn in order */
    const param *common;
    size_t       common_count;
    const pass  *fold; /* array kinds: drawn after each use but the last, to take its result into the picture */
} kind;

/* A technique with values for its parameters. */
typedef struct technique_use {
    const technique *technique;
    void            *values; /* technique->params_size bytes, owned */
} technique_use;

#endif
