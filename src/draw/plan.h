/* The plan of a drawing: rules to figures. */
#ifndef LIMNER_DRAW_PLAN_H
#define LIMNER_DRAW_PLAN_H

#include "draw/made_textures.h"
#include "draw/upload.h"
#include "look/look.h"

/* The parts that one rule draws. */
typedef struct figure {
    const rule *rule;
    const rule *hidden;     /* layered: the rule with its lines as hidden layers have them */
    bool       *focus;      /* layered, per part: to be uncovered; NULL: nothing */
    const colour *highlight; /* drawn in this colour instead of its own; NULL: as it is */
    bool       *designated; /* per part: drawn by this figure */
    size_t      part_count; /* designated ones */
    box3        box;        /* of the designated parts, world axes */
    unsigned    channels;
    bool        complement; /* other figures' parts take part in edge detection */
    bool        deferred;
    bool        direct;     /* drawn straight onto the page */
    bool        reflects;
    bool        layered;    /* composed layer by layer */
    bool        ghostly;    /* of ghosts alone */
    int         layer_count; /* layers at most */
    used_textures perturb_textures; /* of what perturbs it */
    used_textures textures;  /* of the surface technique; found by who draws */
    used_textures *material_textures; /* the same, one a material of the scene, where these differ; else NULL */
} figure;

typedef struct plan {
    const lmn_scene *scene;
    const lmn_look  *look;
    size_t           part_count; /* of the upload: ghosts too when the look asks for them */
    rule            *rules;    /* the look's, with lengths in pixels of this drawing (supersamples counted), and variants of them */
    size_t           rule_count;
    bool            *selected; /* per part: drawn by some figure */
    bool            *opaque;   /* per part: drawn by a figure that is not seen through, so that it may hide others */
    size_t           selected_count, opaque_count;
    figure          *figures; /* direct ones first, then in the order of the rules; rules without parts have none */
    size_t           figure_count;
    box3             box; /* of the selection, which the picture is fitted to, before it is cut */
    bool             has_cut; /* there are cut faces */
    used_textures    sheet_textures; /* of the sheet; found by who draws */
} plan;

/* How a drawing wants its plan. */
typedef struct plan_wishes {
    const char *select;      /* restricts what is drawn, or NULL */
    int         pixel_scale; /* lengths in pixels are multiplied by it */
    bool        as_sprites;  /* no figure is drawn directly (maps need their buffers) */
    colour      ground;      /* of the page */
} plan_wishes;

/* Errors: LMN_USAGE (bad selector), LMN_FORMAT (nothing to draw), LMN_MEMORY. Warnings (rules that select nothing, settings without
 * effect) go to `notes`. */
lmn_status plan_create(plan *out, const lmn_scene *scene, const lmn_look *look, const upload *up, const plan_wishes *wishes,
                       warnings *notes, lmn_error *error);
void       plan_release(plan *p);

/* Must the surface be shaded while the geometry is drawn? */
bool shades_with_geometry(const technique_use *surface);

/* The use of a kind that holds one technique; NULL when the rule has none. */
const technique_use *rule_use(const rule *r, kind_id id);
/* The composition of a rule when it shades the geometry again, so that nothing is drawn over surfaces; NULL: it does not. */
const technique_use *rule_shades_again(const rule *r);

#endif
