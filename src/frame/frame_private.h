/* What the files that draw a frame share. */
#ifndef LIMNER_FRAME_FRAME_PRIVATE_H
#define LIMNER_FRAME_FRAME_PRIVATE_H

#include "frame/frame.h"
#include "stage/stroke_store.h"
#include "stroke/ribbon.h"
#include "solids/solids.h"
#include "stage/view.h"
#include "stage/uniforms.h"

enum { TILES_SIDE = 64, TILE_BOXES_MAX = TILES_SIDE * TILES_SIDE / 2 };

/* The tiles of a band. */
typedef struct tile_grid {
    int      band[4], size, columns, rows; /* tile size in pixels */
    bool     full[TILES_SIDE][TILES_SIDE]; /* has pixels of the layer */
    uint32_t mask[TILES_SIDE][TILES_SIDE]; /* pixels of what is to be uncovered */
} tile_grid;

/* --- tiles.c --- */
void tiles_start(tile_grid *t, const int band[4]); /* all full */
void tiles_clear(tile_grid *t);                    /* none full */
/* The tiles that a box of pixels meets become full, unless they are only counted. Returns how many. */
int tiles_mark(tile_grid *t, const int box[4], bool full);
/* The full tiles and those within `margin` pixels of them as boxes, at most TILE_BOXES_MAX, inside `limits`. Tiles
 * at the rim of the band reach `margin` beyond it. Returns how many. */
size_t tiles_boxes(const tile_grid *t, int margin, const int limits[4], int (*out)[4]);

/* A figure while it is drawn: its pictures and its range of depth. */
typedef struct figure_state {
    const figure     *figure;
    gpu_texture      *targets[TARGET_SLOTS];
    const target_row *own_targets; /* rows of the technique whose passes run; NULL: it has none */
    gpu_texture      *geometry;    /* the normal-depth buffer as it was drawn; techniques may filter a copy of it */
    float            *edges;       /* for maps: darkest of all line techniques' edge maps, 4 a pixel */
    int               pixels[4];   /* where the figure and its lines can be: scissor */
    int               around[4];   /* what passes there can look at: cleared */
    int               drawn[2][4]; /* both of the geometry, which windows may need more of */
    int               band[4];     /* layered: what is composed now, a part of `pixels` */
    int               layer;       /* layered: 0 = visible */
    int               index;       /* of the figure among those that share their layers, or their geometry pass */
    bool              shared;      /* other figures' surfaces are in these, too, and ids tell which */
    float             rear;        /* layered: opacity */
    int (*boxes)[4];               /* where passes are drawn; NULL: all of `pixels`; layered: the stack's, else owned */
    size_t       box_count;
    bool         apart;  /* its fill is on the page, with others': only its lines are composed */
    bool         filled; /* the fill is drawn with these lines */
    bool         ground; /* what is shaded is the ground; its light lies beside its colour */
    double       near, far;
    solid_layers solids; /* of the figure and what may hide it */
} figure_state;

/* What the figures share that are seen through together: the pictures of one layer at a time. */
typedef struct layer_stack {
    figure_state *states; /* one a figure; they borrow the pictures below and own their edge maps */
    figure       *hidden; /* the figures with the rules of hidden layers */
    int           count;
    unsigned      channels;
    int           limit;     /* layers at most */
    int           reach;     /* of the widest lines, pixels */
    int           box[4];    /* all that is drawn */
    int           band[4];   /* that is drawn now */
    int           around[4]; /* the band and what passes there look at */
    tile_grid     tiles;     /* of the layer before, later of the current one */
    int (*boxes)[4];         /* room for TILE_BOXES_MAX */
    size_t       box_count;
    gpu_texture *targets[TARGET_COUNT];    /* of the current layer */
    gpu_texture *before_depth, *before_id; /* of the layer in front */
    gpu_texture *mask;                     /* depth of what is to be uncovered, or NULL */
    gpu_texture *nodes[2];                 /* lists: nodes of up to eight layers */
    gpu_buffer  *heads, *list, *counter;
    int          node_vectors;
    solid_layers solids; /* of all figures */
} layer_stack;

/* --- window.c: a part of the page --- */
/* Pixels beside a window that are drawn, too, since what lies in it looks at them; beyond the reach of lines. */
enum { WINDOW_MARGIN = 256 };
/* The window and so many pixels around it, inside the page; without a window the page. */
void window_around(const frame *f, int margin, int out[4]);
/* Leaves of a box of pixels what lies so near to the window. */
void window_clip(const frame *f, int margin, int box[4]);
/* Of a figure: where it is drawn and what is cleared, unless something about it depends on the whole page. */
void window_figure(const frame *f, figure_state *s);
/* How much of the page around the window is cleared: for the figure whose lines reach farthest. */
int window_margin(const frame *f);

/* --- figure.c --- */
/* Sets range and pixels; false when nothing of it is on the page. */
bool figure_open(frame *f, figure_state *s, const figure *fig);
/* How far the figure's lines reach beyond it, pixels. */
int figure_reach(const figure *fig);
/* Where its passes have anything to draw: tiles that its parts and their lines can reach. */
void figure_find_boxes(frame *f, figure_state *s);

/* --- lighting.c: what programs that ask for light get --- */
void lights_declare(text *prelude, const frame *f); /* soft shadows and occlusion too, where they were drawn */
void lights_set(frame *f);
void shadow_set(frame *f);     /* uniforms of light/shadow.glsl */
void visibility_set(frame *f); /* of light/light.glsl's soft shadows and occlusion */
/* Are the first light's shadows drawn, and soft? */
bool shadow_is_soft(const frame *f);
/* The first light's direction in eye space, towards it; false when it has a position instead. */
bool lights_first_direction(const frame *f, double out[3]);

/* --- shadow.c --- */
/* Draws what the first light sees, where the look wants shadows or a pass reads them, and the light has a
 * direction. */
void shadow_draw(frame *f);
/* Gives f->shadow back, unless it is kept for the next frame. */
void shadow_release(frame *f);

/* --- visibility.c: soft shadows and ambient occlusion --- */
/* Draws f->visibility, where the look wants it. The caller gives it back. */
void visibility_draw(frame *f);

/* --- ground.c: the shadow on the ground --- */
/* Draws it onto the page, where the look has one and it is seen: by the medium of the first figure, where that can. */
void ground_draw(frame *f);
/* The plane in eye space, normal and distance along it, and as a uniform. */
void ground_plane_set(frame *f, double out[4]);
/* From where to where a box goes along an axis. */
void ground_range(box3 box, int axis, double out[2]);
enum { GROUND_SIDE = 256 }; /* of maps of the ground */
/* The ground as a square: its middle and half its side, in the two level axes; and what is highest above it. */
typedef struct ground_square {
    int    axes[2];
    double middle[2], half, height;
} ground_square;
/* An eye that looks along the upright, with parallel rays: from below up, or from above down. Both have the same right,
 * and the other's picture upside down. */
view_camera ground_camera(const ground_plane *ground, const ground_square *s, bool below);
/* The depth of all that is drawn. The caller gives it back. */
gpu_texture *ground_depth(frame *f, const view_camera *camera);
/* From eye space to 0 … 1 over what the eye below sees. */
mat4 ground_map_from_eye(const frame *f, const view_camera *below);
/* Can the figure's medium draw the ground? */
bool ground_is_drawn_by(const frame *f, const figure *fig);
/* For a technique that draws the shadow: begins the pictures that the ground has as a figure has its own, with the
 * program that fills them; false: there is none. Then the ground is shaded and laid onto the page, over it or instead
 * of it, and its pictures are given back. */
bool ground_buffers(frame *f, figure_state *s, const char *shader, text *prelude);
void ground_shade(frame *f, figure_state *s, bool over);
/* ground_cast.c: the one that the first light throws. */
void ground_cast(frame *f);
/* ground_height.c: how high over the ground it is what throws that, as a fraction of the light that is kept off: 1
 * where it stands there … 0 far up; over the square that the box of the shadow lies in. Flat: for two tones, of which
 * what does not stand there has the paler one. The caller gives it back. */
gpu_texture *ground_height(frame *f, const double towards[3], const box3 *shadow, bool flat, mat4 *from_eye);

/* What solids are evaluated for. */
solid_view frame_solid_view(frame *f);

/* --- bind.c: what programs of all passes get --- */
gpu_texture *frame_acquire(frame *f, target t);
/* The same in another size than the page's: of SCALE_OWN. */
gpu_texture *frame_acquire_sized(frame *f, target t, int width, int height);
/* Any picture, those of the technique that runs too, in the size that its row asks for. */
gpu_texture      *frame_acquire_for(frame *f, const figure_state *s, target t);
const target_row *target_row_of(const figure_state *s, target t);
void              target_size(const frame *f, const figure_state *s, target_scale scale, int out[2]);
/* What a technique works out once for all pixels. */
void frame_set_numbers(frame *f, const technique_use *use);
void frame_set_common(frame *f, const figure_state *s);
/* For programs that tie something to parts: from eye space to the part's frame (upload_part_frames). */
void frame_set_rest(frame *f, size_t part_index);
/* The ground as the page holds it, premultiplied: 4 floats. */
void frame_ground(const frame *f, float out[4]);
/* The program of these files with this prelude, which is used up; NULL after an error. */
gpu_program         *program_of(frame *f, gpu_dialect dialect, const char *vertex, const char *fragment, text *prelude);
param_set            use_own_set(kind_id id, const technique_use *use);
param_set            use_common_set(kind_id id, const technique_use *use);
const technique_use *rule_inked_lines(const rule *r);      /* the line technique that a composition inks, or NULL */
const pass          *rule_merged_detection(const rule *r); /* the pass that the composition does itself, or NULL */
/* Declares, or sets, the pictures that these passes read and that are there; either pass may be NULL. */
void reads_declare(text *prelude, const frame *f, const figure_state *s, const pass *a, const pass *b);
void reads_set(frame *f, const figure_state *s, const pass *a, const pass *b);
/* Does some line technique of the rule work on whole lines? */
bool         rule_traces_lines(const rule *r);
bool         pass_applies(kind_id id, const pass *p, const technique_use *use);
gpu_texture *target_of(const frame *f, const figure_state *s, target t);

/* --- facts.c: what one draw call of many parts looks up --- */
/* Formats without materials: a light neutral grey. */
#define RASTER_STANDARD_COLOUR                                                                                         \
    {                                                                                                                  \
        0.6f, 0.6f, 0.6f, 1                                                                                            \
    }
/* Makes f->facts, where meshes lie in packs. The caller gives it back. */
void facts_open(frame *f);

/* --- raster.c: the geometry pass --- */
void raster_figure(frame *f, figure_state *s); /* G-buffer, and shade unless deferred */
/* One G-buffer for several figures, with what each asks for; `targets` gets the pictures, the caller's to give back. */
void raster_together(frame *f, const figure_state *states, int count, gpu_texture **targets);
void raster_direct(frame *f, figure_state *s);                    /* straight onto the page */
void raster_inked(frame *f, figure_state *s, const pass *inking); /* onto the page, shaded and inked */
void raster_shade_deferred(frame *f, figure_state *s);
/* The pictures of a layer, cleared, as the targets of a pass; their positions are declared. */
void layer_outputs_open(frame *f, layer_stack *stack, gpu_pass *pass, text *prelude);
/* The figure's parts with their surfaces moved outwards by some pixels: x and y of the normal, part id, eye depth
 * (0: empty). */
void raster_enlarged(frame *f, figure_state *s, target into, float pixels);
/* The depth of its own parts' faces that look away, moved outwards across the page. Solids have none: their
 * surfaces are made for one position. */
void raster_shell(frame *f, figure_state *s, target into, float pixels);
/* Where the figure's parts were at `steps` steps of the past (1, 2 or 4), and their depth; with more channels. */
void raster_moved(frame *f, figure_state *s, int steps, unsigned channels);

/* --- stretched.c --- */
/* TARGET_STRETCHED: the figure's meshes pulled from where they were the whole past ago to where they are. */
void stretched_draw(frame *f, figure_state *s);

/* --- raster.c, for layers --- */
/* The next layer by peeling: what lies behind the stack's last one. */
void raster_layer(frame *f, layer_stack *stack, bool first);
/* Every fragment into the pixels' lists. */
void raster_lists(frame *f, layer_stack *stack, int node_vectors, unsigned node_limit);
/* The depth of what is drawn at all, in a picture of the frame's size. */
void raster_depth(frame *f, gpu_texture *depth);
/* The same of some parts. */
void raster_depth_of(frame *f, gpu_texture *depth, bool *parts);
/* Depth of the parts that may run through the figure's, where lines are wanted there and some may. */
void raster_meeting(frame *f, figure_state *s);
/* The depth of some parts alone. */
void raster_mask(frame *f, layer_stack *stack, const bool *parts);

/* --- marks.c: marks on surfaces --- */
bool figure_has_marks(const figure *fig);
/* How far they stand out of its surfaces, units of the world. */
double figure_marks_stand(const figure *fig);
/* Those of the figure's surface technique, where its surface is what is seen, over a picture. */
void marks_draw(frame *f, figure_state *s, gpu_texture *onto);

/* --- frame.c --- */
void frame_draw_figure(frame *f, const figure *fig);
/* From the figure's G-buffer to the page, or to its maps. */
void figure_finish(frame *f, figure_state *s);
void figure_release(frame *f, figure_state *s);

/* --- together.c: opaque figures that share a geometry pass --- */
/* How many of these figures, from the first one on, can do so. */
size_t together_count(const frame *f, const figure *figures, size_t count);
void   together_draw(frame *f, const figure *figures, size_t count);

/* --- movers.c: what moves on the page, each by itself --- */
/* The last figures of the plan: draws them onto the page by their techniques of motion. */
void movers_draw(frame *f, const figure *figures, size_t count);
/* Draws what movers throw shadows with beside themselves into f->shadow. */
void movers_throw_shadows(frame *f);

/* --- scattered.c: a mover at moments of each pixel's own --- */
void scattered_draw(frame *f, figure_state *s, const pass *p, int samples);

/* --- layered.c: figures that are seen through --- */
/* Draws `count` figures whose layers interleave. */
void layered_draw(frame *f, const figure *figures, int count);

/* Gathers every fragment inside the stack's `around` box in at most `capacity` bytes. Returns how many times the room
 * is needed: 1 when everything is there; otherwise the lists are not whole. */
int lists_build(frame *f, layer_stack *stack, size_t capacity);
/* Draws layer `index` into the stack's pictures. Layers are asked for in order. */
void lists_layer(frame *f, layer_stack *stack, int index);
void lists_release(frame *f, layer_stack *stack);

/* --- passes.c: declared passes --- */
/* What a surface technique looks at when it shades from the G-buffer. */
void passes_prepare(frame *f, figure_state *s);
/* What a mover's technique of motion adds to what throws shadows. */
void passes_throw_shadows(frame *f, figure_state *s);
void passes_run_kind(frame *f, figure_state *s, kind_id id);
/* The figure's edge map, fill and eye depth (0: nothing) as its composition finds them, moved by its perturbation;
 * RGBA32F, the caller's to release. */
enum { LOOKED_UP = 3 };
void passes_look_up(frame *f, figure_state *s, gpu_texture *out[LOOKED_UP]);
/* Detects and inks the line techniques one by one, the first with the fill; `nearest_first` puts each under those
 * before. */
void passes_compose_lines(frame *f, figure_state *s, bool nearest_first);

/* --- strokes.c: lines with geometry --- */
void strokes_run(frame *f, figure_state *s, const pass *p, const technique_use *use, const char *group);
/* What strokes of a figure are found with, NULL after an error; and as the frame's camera sees it, on the sheet. */
stroke_store *strokes_find_store(frame *f, const figure *fig, int32_t refine);
lmn_status    strokes_look(stroke_store *store, const frame *f, lmn_error *error);
double        strokes_pixels_a_unit(const frame *f);
/* From units of the sheet to pixels; and onto the GPU, NULL after an error. */
void       strokes_scale_ribbons(ribbon_set *r, const frame *f);
gpu_marks *strokes_upload_ribbons(frame *f, ribbon_set *ribbons);

/* --- traces.c: lines that tell of motion --- */
/* Over the finished page: those of all figures whose rules draw traces. */
void traces_draw(frame *f);

/* Edges of the figure's meshes into the pass's picture: where on the page those are that are lines. Nothing where
 * meshes are not what is drawn, or have no edges that last. */
void records_run(frame *f, figure_state *s, const pass *p, const technique_use *use, const char *group);
/* For programs with lines/stroke/decide.glsl: draws all edges of the item; brings what they are drawn from before. */
void edges_bring(frame *f, stroke_store *store, uint32_t index, bool crossings);
void edges_draw(frame *f, stroke_store *store, uint32_t index, bool crossings);
bool eye_is_outside(const frame *f);

/* --- paper.c: what the sheet's ink is rubbed onto; nothing where there is no paper --- */
void paper_declare(text *prelude, const frame *f);
void paper_set(frame *f);

/* --- mirror.c --- */
/* Makes a frame of what the mirror's plane shows, without pictures to draw into; false when the part has no plane. */
bool mirror_prepare(const frame *f, const figure *mirror, frame *inner);

/* --- collect.c: maps --- */
void collect_edges(frame *f, figure_state *s);
void collect_figure(frame *f, figure_state *s);
void collect_layer(frame *f, figure_state *s); /* of layer s->layer */
/* What the composition finds, where something of the drawing is perturbed; `edges` as figure_state has them. */
void collect_perturbed(frame *f, figure_state *s, const float *edges, bool layered);
/* The layer's map, made when it is not there; NULL after an error. */
layer_map *collect_layer_of(frame *f, layer_maps *maps, size_t index);
void       collect_uncertainty(frame *f, figure_state *s);
void       collect_direction(frame *f, figure_state *s);

#endif
