/* The plan of a drawing: rules to figures. */
#ifndef LIMNER_PLAN_PLAN_H
#define LIMNER_PLAN_PLAN_H

#include "layer/layer.h"
#include "look/look.h"
#include "plan/camera.h"
#include "plan/datum.h"
#include "plan/section.h"
#include "pose/pose.h"

/* The parts that one rule draws. */
typedef struct figure {
    const rule                   *rule;
    const rule                   *hidden;     /* layered: the rule with its lines as hidden layers have them */
    bool                         *focus;      /* layered, per part: to be uncovered; NULL: nothing */
    colour                        highlight;  /* drawn in this colour instead of its own; alpha 0: as it is */
    bool                         *designated; /* per part: drawn by this figure */
    size_t                        part_count; /* designated ones */
    box3                          box;        /* of the designated parts, world axes */
    unsigned                      channels;
    bool                          complement; /* other figures' parts take part in edge detection */
    bool                          meets;      /* instead: lines where it runs through those, found by depth */
    bool                          deferred;
    bool                          direct; /* drawn straight onto the page */
    bool                          reflects;
    bool                          layered;  /* composed layer by layer */
    bool                          ghostly;  /* of ghosts alone */
    bool                          unmarked; /* marks of its surface are left out */
    bool                          mover;    /* moves on the page, and is drawn by itself: src/plan/movers.h */
    layering                      layering;
    int                           layer_count; /* layers at most */
    const struct figure_textures *textures;    /* that who draws has made for it */
} figure;

typedef struct plan {
    const pose      *pose;
    const lmn_scene *scene;
    const lmn_look  *look;          /* with its lengths in pixels of this drawing, supersamples counted */
    lmn_look        *own_look;      /* the same */
    double           pixels_per_mm; /* of paper, supersamples counted */
    /* what stages need */
    section    section;
    bool       has_cut;      /* there may be cut faces */
    double     crease_angle; /* radians */
    mesh_needs meshes;       /* of all techniques */
    bool       has_removed;  /* the look selects what solids take away: ghosts are parts, too */
    /* parts */
    size_t   part_count;
    int32_t *rule_of;  /* per part: index of the look's rule that draws it; NONE: it is not drawn */
    bool    *selected; /* per part: drawn by some rule */
    bool    *opaque;   /* per part: drawn by a figure that is not seen through, so that it may hide others */
    size_t   selected_count, opaque_count;
    box3     box;         /* of the selection, before it is cut */
    fit_body fit;         /* what the picture is fitted to: the same, or where it comes over time */
    bool    *throws;      /* per part: it is drawn and throws a shadow */
    bool    *fitted;      /* per part: it is a part of that */
    box3    *ghost_boxes; /* per part: of ghosts, what of them counts for it */
    /* figures */
    colour  ground; /* of the page */
    datum   datum;  /* shown as the parts' colours */
    rule   *rules;  /* the look's, and variants of them */
    size_t  rule_count;
    figure *figures; /* drawn in this order: direct ones, others, mirrors, what is seen through, movers; among
                        these as their rules. Rules without parts have none */
    size_t figure_count;
} plan;

/* How a drawing wants its plan. */
typedef struct plan_options {
    const char *select;        /* restricts what is drawn, or NULL */
    const char *background;    /* a colour, or NULL: the look's */
    double      pixels_per_mm; /* of paper, supersamples counted */
    bool        as_sprites;    /* no figure is drawn directly (maps need their buffers) */
    const char *cut;           /* what is cut away, in the words of scene.cut; NULL: as the look says */
    bool        surfaces_only; /* neither lines, nor marks on surfaces, nor hatching of sections */
    bool        on_sheet;      /* lines are strokes, which find each other whatever rule they are of */
    bool        parts_only;    /* no figures, ghosts and sections: for who draws parts by the look's own rules */
} plan_options;

/* The pose and the look are lent. Errors: LMN_USAGE (bad selector, colour or section), LMN_FORMAT (nothing to
 * draw), LMN_MEMORY. Warnings (rules that select nothing, settings without effect) go to `warnings`. */
lmn_status plan_create(plan *out, const pose *pose, const lmn_look *look, const plan_options *options,
                       warnings *warnings, lmn_error *error);
void       plan_release(plan *p);

/* Works out again how figures are drawn, and in which order, after they have changed. */
void plan_settle(plan *p, bool as_sprites);

/* The look's rule that draws a part; NULL: none does. */
const rule *plan_rule(const plan *p, size_t part_index);

/* The colour that a part has for what is known about it; NULL: its own. */
const colour *plan_datum_colour(const plan *p, size_t part_index);

/* The planes between which all that is drawn lies. Warns of a model behind the viewer. */
void plan_camera_range(const plan *p, view_camera *camera, warnings *warnings);

/* Must the surface be shaded while the geometry is drawn? */
bool shades_with_geometry(const technique_use *surface);

/* The use of a kind that holds one technique; NULL when the rule has none. */
const technique_use *rule_use(const rule *r, kind_id id);
/* Are the technique's lines strokes, which the CPU or the GPU finds on meshes? */
bool technique_draws_strokes(const technique *t);
/* Solids are drawn pixel by pixel: they have neither strokes nor marks. */
bool figure_has_solids(const plan *p, const figure *f);
/* The composition of a rule when it shades the geometry again, so that nothing is drawn over surfaces; NULL: it
 * does not. */
const technique_use *rule_shades_again(const rule *r);

#endif
