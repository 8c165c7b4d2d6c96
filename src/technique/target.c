#include "technique/target.h"

const target_row target_rows[TARGET_COUNT] = {
    /* What the geometry pass draws: channels (technique.h), and the figure's depth buffer. */
    [TARGET_NORMAL_DEPTH] = {"t_normal_depth", TEXEL_RGBA32F, .owner = OWNER_LAYER, .empty = {0, 0, 1, EMPTY_FAR}},
    [TARGET_ID] = {"t_id", TEXEL_RG32UI, .owner = OWNER_LAYER},
    [TARGET_ALBEDO] = {"t_albedo", TEXEL_RGBA16F, .owner = OWNER_LAYER, .empty = {1, 1, 1, 0}},
    /* Normals as TARGET_NORMAL_DEPTH has them, towards the viewer's side, over a length on paper: what light is told by
     * where few tones are to show the form. */
    [TARGET_FORM] = {"t_form", TEXEL_RGBA32F, .owner = OWNER_LAYER, .empty = {0, 0, 1, 0}},
    [TARGET_FORM_HALF] = {"t_form_half", TEXEL_RGBA32F, SCALE_HALF, .owner = OWNER_LAYER, .empty = {0, 0, 1, 0}},
    [TARGET_SHADE] = {"t_shade", TEXEL_RGBA16F, .owner = OWNER_LAYER, .filtered = true},
    [TARGET_REST] = {"t_rest_position", TEXEL_RGBA32F, .owner = OWNER_LAYER},
    [TARGET_DETAIL] = {"t_detail", TEXEL_RGBA8, .owner = OWNER_LAYER},
    [TARGET_VELOCITY] = {"t_velocity", TEXEL_RGBA32F, .owner = OWNER_LAYER},
    /* The same at steps of the past between now and then, where techniques of motion read several. */
    [TARGET_PAST_1] = {"t_past_1", TEXEL_RGBA32F, .owner = OWNER_FIGURE},
    [TARGET_PAST_2] = {"t_past_2", TEXEL_RGBA32F, .owner = OWNER_FIGURE},
    [TARGET_PAST_3] = {"t_past_3", TEXEL_RGBA32F, .owner = OWNER_FIGURE},
    /* The area that a mover sweeps: pixels moved right and up, window depth, part id; all 0: nothing. */
    [TARGET_STRETCHED] = {"t_stretched", TEXEL_RGBA32F, .owner = OWNER_FIGURE},
    [TARGET_DEPTH] = {"t_depth", TEXEL_DEPTH32F, .owner = OWNER_LAYER},
    /* Of opaque parts of other rules that may run through the figure's; there where these are not among the figure's
     * complement. From the first layer to the last. */
    [TARGET_MEETING] = {"t_meeting", TEXEL_DEPTH32F, .owner = OWNER_FRAME},

    /* The edge map: r = profile, g = inner, b = combined, a = id; 1 = no edge. That of the layer in front of this
     * one. */
    [TARGET_EDGE] = {"t_edge", TEXEL_RGBA16F, .owner = OWNER_FIGURE, .filtered = true, .empty = {1, 1, 1, 1}},
    [TARGET_EDGE_BEFORE] = {"t_edge_before", TEXEL_RGBA16F, .owner = OWNER_FIGURE, .empty = {1, 1, 1, 1}},
    /* Of all nearer layers' lines: r = ink, widened by the halo; g = ink around, averaged and added up. */
    [TARGET_NEARER] = {"t_nearer", TEXEL_RGBA16F, .owner = OWNER_FIGURE},
    /* Fraction of the lines' ink that stays; not there = all. */
    [TARGET_DASH] = {"t_dash", TEXEL_R8, .owner = OWNER_LINES},
    /* Where lines run on beyond their ends: r = bits of ink (profile, inner, id, 8 each); g = eye depth, a float. */
    [TARGET_OVERSHOOT] = {"t_overshoot", TEXEL_RG32UI, .owner = OWNER_ALL_LINES},
    /* Depth of what strokes were drawn, or of the shell, 1 elsewhere. */
    [TARGET_STROKES] = {"t_strokes", TEXEL_DEPTH32F, .owner = OWNER_LINES},
    /* The picture behind the lines, blurred. */
    [TARGET_GROUND] = {"t_ground", TEXEL_RGBA16F, .owner = OWNER_FIGURE},

    /* r, g = offset of lookups, −1 … 1; b = a third value of the same kind. The same at each pixel, for maps. */
    [TARGET_UNCERTAINTY] = {"t_uncertainty", TEXEL_RGBA16F, SCALE_CELL, OWNER_FIGURE, .filtered = true},
    [TARGET_FIELD] = {"t_field", TEXEL_RGBA32F, .owner = OWNER_FIGURE},

    /* The scene as the figure's mirror plane sees it. */
    [TARGET_REFLECTION] = {"t_reflection", TEXEL_RGBA16F, .owner = OWNER_FIGURE},
    /* Depth from the first light; there when the look has shadows or a pass reads it. */
    [TARGET_SHADOW] = {"t_shadow", TEXEL_DEPTH32F, SCALE_OWN, OWNER_FRAME},
    /* The directions strokes lie on the page as s · (cos 2θ, sin 2θ), θ from the x axis, s how sure; a: 1 where there
     * is a surface. */
    [TARGET_DIRECTION] = {"t_direction", TEXEL_RGBA16F, SCALE_APART, OWNER_FIGURE, .filtered = true},

    /* A mover as its rule draws it, alone: colour, premultiplied, and depth. And the depth of all that does not move,
     * and of what was drawn before. */
    [TARGET_MOVER] = {"t_mover", TEXEL_RGBA16F, .owner = OWNER_FIGURE, .filtered = true},
    [TARGET_MOVER_DEPTH] = {"t_mover_depth", TEXEL_DEPTH32F, .owner = OWNER_FIGURE},
    [TARGET_SCENE_DEPTH] = {"t_scene_depth", TEXEL_DEPTH32F, .owner = OWNER_FRAME},

    /* What the layers so far add up to, front to back; alpha is what still shows through. */
    [TARGET_LAYERS] = {"t_layers", TEXEL_RGBA16F, .owner = OWNER_LAYERS, .empty = {0, 0, 0, 1}},
    /* The sheet: colour, premultiplied; its depth lies beside it. */
    [TARGET_PAGE] = {"t_page", TEXEL_RGBA16F, .owner = OWNER_FRAME},
};

void target_empty(const target_row *row, double far, float out[4])
{
    for (int k = 0; k < 4; k++)
        out[k] = row->empty[k] == EMPTY_FAR ? (float)far : row->empty[k];
}
