/* Drawing inside of a program that draws with OpenGL itself: into its framebuffer, with its camera, among what it has
 * drawn. The renderer has adopted the program's context (lmn_renderer_desc.adopt). docs/EMBEDDING.md tells all of it.
 */
#ifndef LIMNER_HOST_H
#define LIMNER_HOST_H

#include "limner/draw.h"
#include "limner/maps.h"

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

/* --- drawings that stay on the GPU ---------------------------------------------------------------------- */

/* The name of the texture with the picture of a drawing that lmn_draw has made with lmn_draw_desc.textures: it lies on
 * the GPU, and nothing was read back (but where a look writes beside the drawing: labels, legend, north arrow and scale
 * bar are in it, too). A GL_TEXTURE_2D, GL_RGBA8, of the drawing's size, with one level, nearest filter
 * and clamped edges. It has the bytes of lmn_drawing_pixels, but row 0 is at the bottom, as in OpenGL: encoded as sRGB,
 * which OpenGL is not told, straight alpha. It is the renderer's and is lent: valid in the context that it has adopted,
 * and those that share objects with it, until the renderer draws or picks again or ends; the drawing itself may end
 * before. It may be looked up and copied from, but not written, and its parameters are not set: samplers
 * (glGenSamplers) have other filters. Who asks is the thread that has the context current; it waits for nothing. The
 * drawing's report, camera and warnings are there at once; for pixels, files, maps in memory and picks call
 * lmn_drawing_read_back before. Errors: LMN_USAGE (NULL, a drawing without textures, a renderer that has drawn again or
 * has ended). Since 0.1. */
LMN_API lmn_status lmn_drawing_texture(const lmn_drawing *drawing, uint32_t *name, lmn_error *error);

/* The same of a map, of drawings with `maps`, too: the numbers of lmn_drawing_copy_map, merged on the GPU. DEPTH is
 * GL_R32F, ID GL_R32UI, EDGE and SHADE GL_RGBA16F; of three numbers and alpha 0 are NORMAL, UNCERTAINTY and VELOCITY in
 * GL_RGBA32F and DIRECTION in GL_RGBA16F. Errors: as lmn_drawing_texture; LMN_USAGE also where the drawing does not
 * have this map. Since 0.1. */
LMN_API lmn_status lmn_drawing_map_texture(const lmn_drawing *drawing, lmn_map map, uint32_t *name, lmn_error *error);

/* Copies picture and maps into memory, while the textures are valid, with the context current: from then on the drawing
 * is one as without `textures`, which outlasts the renderer; but maps of layers (lmn_drawing_write_maps) it has none.
 * The textures stay what they were. A drawing whose pixels are in memory stays as it is. Errors: as
 * lmn_drawing_texture; LMN_GL, LMN_MEMORY. Since 0.1. */
LMN_API lmn_status lmn_drawing_read_back(lmn_drawing *drawing, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
