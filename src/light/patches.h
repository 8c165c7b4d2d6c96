/* Texels that hang together. */
#ifndef LIMNER_LIGHT_PATCHES_H
#define LIMNER_LIGHT_PATCHES_H

#include <stdbool.h>
#include <stdint.h>

/* The part of a picture that is looked at: all of what is not 0, and one texel around where the picture has one. */
typedef struct texel_box {
    uint8_t *texels; /* of four bytes; the first of the box */
    int      x, y, width, height;
    int      picture_width, picture_height;
} texel_box;

/* Where the first byte is not 0, with `margin` around; a width of 0: nowhere. */
texel_box texel_box_of(uint8_t *texels, int width, int height, int margin);

uint8_t *texel_at(const texel_box *box, int x, int y);

/* Marks of a box's texels with a frame of 0 around, so that every texel has eight neighbours. */
typedef struct patch_marks {
    uint8_t *marks;
    int     *found; /* what was flooded last */
    int      stride, height;
} patch_marks;

/* All 0. False: no memory. Ends with patch_marks_release either way. */
bool patch_marks_create(patch_marks *out, const texel_box *box);
void patch_marks_release(patch_marks *p);

/* Where a texel of the box stands in it. */
int patch_index(const patch_marks *p, int x, int y);

/* What hangs together with `first` of texels with the same mark, which is not 0, becomes `into`; how many there are, in
 * `found`. `corners`: over these, too. */
int patch_flood(patch_marks *p, int first, uint8_t into, bool corners);

/* Does it stand at the border of the box? */
bool patch_at_border(const patch_marks *p, int index);

#endif
