/* Drawing inside of a program that draws with OpenGL itself: into its framebuffer, with its camera, among what it has
 * drawn. The renderer has adopted the program's context (lmn_renderer_desc.adopt). docs/EMBEDDING.md tells all of it.
 */
#ifndef LIMNER_HOST_H
#define LIMNER_HOST_H

#include "limner/draw.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the drawing has to do with the depth that is there. */
typedef enum lmn_target_depth {
    LMN_TARGET_DEPTH_IGNORE = 0,    /* the drawing covers what is there, and its depth stays */
    LMN_TARGET_DEPTH_TEST_AND_WRITE /* nearer pixels of either win, and the drawing leaves its depth */
} lmn_target_depth;

/* Where to draw. Initialise with LMN_TARGET_INIT. Since 0.1. */
typedef struct lmn_target {
    size_t           struct_size;
    uint32_t         framebuffer;   /* OpenGL's name; 0: the window's. Its first draw buffer is drawn into. */
    int              x, y;          /* pixels: the bottom left corner of the drawing in it */
    int              width, height; /* pixels, 1 … 16384: of the drawing; those of the description are not used */
    lmn_target_depth depth; /* TEST_AND_WRITE needs the host's matrices in the description, and takes the range of depth
                               and the clip control (also a reversed one) that the context has */
} lmn_target;
#define LMN_TARGET_INIT                                                                                                \
    {                                                                                                                  \
        sizeof(lmn_target), 0, 0, 0, 0, 0, LMN_TARGET_DEPTH_IGNORE                                                     \
    }

/* Draws into the target, over what is there, without reading anything back; the work may go on in the driver after the
 * call, as with all of OpenGL. The bytes are those of lmn_draw's picture where that is opaque: encoded as sRGB, and
 * mixed as such; where it is not, colour is multiplied by alpha and alpha adds up. Where the look's ground is not
 * wanted, `background` of the description is "none". A pixel's depth is that of the nearest of what its samples show,
 * the ground's the farthest that there is. `maps`, `profile` are refused. Warnings are not kept: lmn_draw tells them.
 * The renderer keeps plan and GPU copies of the scene, so that the next call of the same scene and look, with another
 * camera or not, uploads no meshes. Any thread where the context is current. Errors: those of lmn_draw; LMN_USAGE also
 * for a target that is not there or has no depth, and for renderers that have adopted no context. Since 0.1. */
LMN_API lmn_status lmn_draw_into(lmn_renderer *renderer, const lmn_scene *scene, const lmn_look *look,
                                 const lmn_draw_desc *desc, const lmn_target *target, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
