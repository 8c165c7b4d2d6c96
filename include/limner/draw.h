/* Drawing: a renderer owns the GL context and draws a scene with a look into a picture. */
#ifndef LIMNER_DRAW_H
#define LIMNER_DRAW_H

#include "limner/error.h"
#include "limner/look.h"
#include "limner/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lmn_renderer lmn_renderer;
typedef struct lmn_drawing  lmn_drawing;

/* The directions from which a scene can be viewed; see docs/reference/draw.md. */
typedef enum lmn_view {
    LMN_VIEW_ISO = 0,
    LMN_VIEW_FRONT,
    LMN_VIEW_BACK,
    LMN_VIEW_LEFT,
    LMN_VIEW_RIGHT,
    LMN_VIEW_TOP,
    LMN_VIEW_BOTTOM
} lmn_view;

/* How a renderer is made. Initialise with LMN_RENDERER_DESC_INIT. */
typedef struct lmn_renderer_desc {
    size_t struct_size;
    bool   es;    /* ask for OpenGL ES 3 instead of desktop GL */
    bool   debug; /* debug context; GL errors become LMN_GL errors */
    /* Takes the context that is current on the calling thread, of EGL or GLX, OpenGL 3.3 or OpenGL ES 3.0 at least,
     * instead of making one; `es` is ignored. It stays the caller's, must be current in all calls with the renderer,
     * and end after it. docs/EMBEDDING.md. Since 0.1. */
    bool adopt;
    /* With adopt: the context's state is not given back after calls (docs/reference/gl-state.md). Since 0.1. */
    bool no_restore;
} lmn_renderer_desc;
#define LMN_RENDERER_DESC_INIT                                                                                         \
    {                                                                                                                  \
        sizeof(lmn_renderer_desc), false, false, false, false                                                          \
    }

/* What to draw. Initialise with LMN_DRAW_DESC_INIT. Angles in degrees, lengths in the scene's unit, sizes in
 * pixels. */
typedef struct lmn_draw_desc {
    size_t      struct_size;
    int         width, height; /* 1 … 16384 */
    lmn_view    view;          /* used when neither eye nor camera is given */
    bool        eye_given;     /* use eye, target, up */
    double      eye[3], target[3], up[3];
    const char *camera; /* name of a camera of the scene, or NULL */
    bool        orthographic;
    double      fov_deg; /* vertical, 1 … 170 */
    double   fit; /* fraction of the frame that what is drawn fills, 0.01 … 10; solids and `fit_time`: their boxes */
    double   time_s; /* seconds on the scene's timeline */
    uint32_t seed;
    int      samples; /* supersamples a pixel, a square number 1 … 64; 0: one, and more for pictures of less than 64
                         pixels an inch */
    const char     *background; /* colour, "none", or NULL for the look's ground */
    const char     *select;     /* selector that restricts what is drawn and fitted, or NULL */
    bool            maps;       /* keep the AOVs for lmn_drawing_write_maps */
    bool            profile;    /* time each pass in an extra frame */
    lmn_progress_fn progress;   /* NULL: silent */
    void           *progress_user;
    bool            lenient; /* what cannot be drawn is left out with a warning; else it is refused */
    /* A scene with animations is drawn at rest, unless one of `time_given`, `clip` and a time other than 0 asks for
     * the scene at `time_s`. Times outside the clips are brought to their begin or end, with a warning. */
    bool        time_given;
    const char *clip;     /* clips by name or number from 1 on, separated by commas; NULL: the first of each file */
    bool        fit_time; /* fits the picture to all times of the clips, so that it stands still from time to time */
    /* Pixels an inch of paper, 1 … 10000: how large widths of lines, dashes and strokes are. 0: the longer side is
     * 1024/96 inches (270.93 mm), whatever its pixels, so that a picture of another size is the same drawing. */
    double dpi;
    /* Use these instead of eye, camera and view: from the scene to eye space (rigid; the viewer looks along −Z) and on
     * to clip space (−1 … 1), column by column, as OpenGL takes them. Near and far of the projection cut what is drawn.
     * A perspective must be symmetric; y goes up. Not for sheets. Since 0.1. */
    bool   matrices_given;
    double view_matrix[16], projection_matrix[16];
    /* Of lmn_draw with an adopted context: picture and maps stay on the GPU, as textures that limner/host.h names, and
     * nothing is read back. Not with `profile`. Since 0.1. */
    bool textures;
    /* For pictures that the next one replaces at once, while somebody turns a model: what costs most and shows least is
     * left out. Lines found in pictures lie to the pixel only, without the exact edges of meshes; hard shadows on the
     * ground have the borders that they fall with. Sheets do not heed
     * it. Since 0.1. */
    bool draft;
    /* With eye_given: eye, target and up say only from which direction and which way up; how near the eye is follows
     * from `fit`, as with named views. Since 0.1. */
    bool fit_direction;
    /* The part of the picture that is wanted: x and y of its upper left corner, width, height; a width of 0: all of
     * it. The drawing has the part's size; its pixels are those that the whole picture has there, to the bit, and
     * little beside them is drawn. Not with maps, profile or textures, and not for sheets. Since 0.1. */
    int window[4];
} lmn_draw_desc;
#define LMN_DRAW_DESC_INIT                                                                                             \
    {                                                                                                                  \
        sizeof(lmn_draw_desc), 1024, 1024, LMN_VIEW_ISO, false, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, NULL, false, 30.0,    \
            0.9, 0.0, 0, 0, NULL, NULL, false, false, NULL, NULL, false, false, NULL, false, 0, false, {0}, {0},       \
            false, false, false,                                                                                       \
        {                                                                                                              \
            0                                                                                                          \
        }                                                                                                              \
    }

/* Makes a renderer with a GL context of its own, without display or window, or one that draws in the caller's (adopt).
 * End it with lmn_renderer_destroy. An own context is current only while a call runs: afterwards that is current which
 * was before. Several renderers can be there at once, and each be used by any thread, by one at a time: a second one
 * gets LMN_USAGE. Progress callbacks run with Limner's context, or the caller's with Limner's state, current: they draw
 * nothing. Errors: LMN_USAGE (desc; adopt: no context is current), LMN_GL (also when a context lacks something, and
 * once it was lost: then the renderer can only be destroyed), LMN_MEMORY. */
LMN_API lmn_status lmn_renderer_create(lmn_renderer **out, const lmn_renderer_desc *desc, lmn_error *error);

/* Frees a renderer and sets the handle to NULL; NULL and a pointer to NULL are accepted. When the context that it
 * adopted is not current on this thread, or was lost, what lies in the context stays there and goes with it. */
LMN_API void lmn_renderer_destroy(lmn_renderer **renderer);

/* The driver as JSON: versions, limits, paths, extensions used. Free with lmn_text_free. NULL when memory is gone. */
LMN_API char *lmn_renderer_json(const lmn_renderer *renderer);

/* Points `desc` at where the scene shows most of what it selects, at its time: eye, target and up, fitted by direction.
 * Two dozen directions from a little above are compared by the area, the silhouette and the parts that they show, and
 * by how evenly they show what there is (Secord et al. 2011; Vázquez et al. 2001). A film keeps what was found once.
 * Errors: LMN_USAGE (`select`, `clip`), LMN_MEMORY, LMN_CANCELLED. No GL context needed. Since 0.1. */
LMN_API lmn_status lmn_scene_best_view(const lmn_scene *scene, lmn_draw_desc *desc, lmn_error *error);

/* Would drawing these be refused, as far as that can be told without drawing? `vectors`: by lmn_draw_sheet. For
 * those who draw many pictures. Errors: LMN_USAGE. */
LMN_API lmn_status lmn_draw_check(const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc, bool vectors,
                                  lmn_error *error);

/* Draws. The result owns its pixels and its report; end it with lmn_drawing_destroy. The renderer keeps GPU copies
 * of the scene until another scene is drawn. Errors: LMN_USAGE (desc, selector, a time that changes nothing),
 * LMN_UNSUPPORTED (what the look cannot draw), LMN_FORMAT (nothing to draw), LMN_LIMIT (size), LMN_GL, LMN_MEMORY,
 * LMN_CANCELLED. */
LMN_API lmn_status lmn_draw(lmn_drawing **out, lmn_renderer *renderer, const lmn_scene *scene, const lmn_look *look,
                            const lmn_draw_desc *desc, lmn_error *error);

/* Frees a drawing and sets the handle to NULL; NULL and a pointer to NULL are accepted. */
LMN_API void lmn_drawing_destroy(lmn_drawing **drawing);

/* The picture: RGBA, 8 bits, sRGB, straight alpha, row 0 on top, width·4 bytes a row; borrowed from the drawing.
 * `width` and `height` may be NULL. NULL, and sizes of 0, without a drawing; NULL while the picture lies on the GPU
 * alone (lmn_draw_desc.textures). */
LMN_API const uint8_t *lmn_drawing_pixels(const lmn_drawing *drawing, int *width, int *height);

/* Writes the picture. The format comes from `format` (".png") or, when that is NULL, from the path's ending; path
 * "-" is standard output. A file appears whole or not at all. `bytes` (may be NULL) gets the size. Errors:
 * LMN_USAGE (unknown ending), LMN_WRITE, LMN_MEMORY. */
LMN_API lmn_status lmn_drawing_write(const lmn_drawing *drawing, const char *path, const char *format, uint64_t *bytes,
                                     lmn_error *error);

/* The same of a part of the picture: x and y of its upper left corner, width, height. For tiles. Errors: those of
 * lmn_drawing_write, and LMN_USAGE when the part does not lie in the picture. Since 0.1. */
LMN_API lmn_status lmn_drawing_write_part(const lmn_drawing *drawing, const int part[4], const char *path,
                                          const char *format, uint64_t *bytes, lmn_error *error);

/* The same as lmn_drawing_write in memory instead of a file: *bytes gets them, *size how many. `format` is as for
 * lmn_drawing_write and not NULL. Free them with lmn_bytes_free. Errors: LMN_USAGE (unknown format), LMN_MEMORY. Since
 * 0.1. */
LMN_API lmn_status lmn_drawing_encode(const lmn_drawing *drawing, const char *format, uint8_t **bytes, size_t *size,
                                      lmn_error *error);

/* Frees bytes that Limner returned. NULL is accepted. Since 0.1. */
LMN_API void lmn_bytes_free(uint8_t *bytes);

/* Writes depth.pfm, normal.pfm, id.png, edge.png and shade.png into a folder (made when missing), uncertainty.pfm
 * where something is perturbed, perturbed.depth.pfm, perturbed.edge.png and perturbed.shade.png besides, which are what
 * is composed, direction.pfm where strokes follow the form on the page, velocity.pfm of scenes that
 * are drawn at a time, and for looks that are
 * seen through the same of every layer, layerK.depth.pfm and so on (docs/reference/report.md). The drawing must
 * have been made with desc.maps. Errors: LMN_USAGE, LMN_WRITE, LMN_MEMORY. */
LMN_API lmn_status lmn_drawing_write_maps(const lmn_drawing *drawing, const char *directory, lmn_error *error);

/* The report as JSON (docs/reference/report.md). Free with lmn_text_free. NULL when memory is gone. */
LMN_API char *lmn_drawing_report_json(const lmn_drawing *drawing);

/* How many warnings the drawing has, and one of them as text (borrowed; NULL when out of range). */
LMN_API size_t      lmn_drawing_warning_count(const lmn_drawing *drawing);
LMN_API const char *lmn_drawing_warning_at(const lmn_drawing *drawing, size_t index, const char **code, size_t *count);

/* Measures whole frames of looks against `plain`, each in turn with plain frames, as JSON (docs/reference/bench.md).
 * Free with lmn_text_free. Errors: those of lmn_look_load and lmn_draw. */
LMN_API lmn_status lmn_bench_json(char **out, lmn_renderer *renderer, const lmn_scene *scene, const char *const *looks,
                                  size_t look_count, const lmn_draw_desc *desc, int repeat, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
