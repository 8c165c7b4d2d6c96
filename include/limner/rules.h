/* Looks by calls: rules, techniques and parameters that a program makes, changes and takes away at run time, and all
 * that a user interface needs to show them, without any text of JSON.
 *
 * A look holds rules, a rule one or several techniques of each kind ("surface", "lines" …), a technique its
 * parameters. Some kinds hold for the whole look; then LMN_WHOLE_LOOK stands where a rule's number would. So a
 * parameter's place is rule, kind, index (which of the kind's techniques, from 0 on) and key, for example
 *     lmn_look_set_number(look, 0, "lines", 0, "width", 1.5, &error);
 *
 * On any error the look is unchanged. Every function can fail that returns an lmn_status: with LMN_USAGE, a NULL, a
 * rule, kind, technique or parameter that is not there (the hint names the nearest), a value of another type or out of
 * its range (the message names it); those that make something also with LMN_LIMIT (docs/reference/limits.md) and
 * LMN_MEMORY. What is lent stays until the look's next change. A look is changed by one thread at a time and never
 * while it is drawn; different looks by different threads. The tables of kinds, techniques and parameters never change:
 * any thread, at any time. No GL context needed. All since 0.1. */
#ifndef LIMNER_RULES_H
#define LIMNER_RULES_H

#include "limner/look.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- what there is: kinds, techniques, parameters ------------------------------------------------------- */

/* A question that a look answers. All text is static, here and in the next two structs. */
typedef struct lmn_kind_info {
    const char *name, *doc;
    size_t      technique_count;
    const char *standard;   /* the technique that new rules have; NULL: none */
    bool        whole_look; /* one for the whole look instead of one a rule */
    bool        several;    /* a rule may hold several, drawn in order */
    bool        optional;   /* a rule may hold none */
} lmn_kind_info;

/* The kinds in the order in which they draw: how many, and one of them; false when out of range. */
LMN_API size_t lmn_kind_count(void);
LMN_API bool   lmn_kind_at(size_t index, lmn_kind_info *out);

/* One answer. */
typedef struct lmn_technique_info {
    const char *name, *doc;
    size_t      param_count;  /* of lmn_param_at */
    size_t      common_count; /* so many of them, the first, are those of all techniques of the kind */
} lmn_technique_info;

/* One of a kind's techniques; false when there is no such kind or index. */
LMN_API bool lmn_technique_at(const char *kind, size_t index, lmn_technique_info *out);

/* What a parameter holds, and by which functions it is read and set besides lmn_look_get_text and _set_text. */
typedef enum lmn_param_type {
    LMN_PARAM_BOOL = 0,  /* numbers: 0 or 1 */
    LMN_PARAM_INT,       /* numbers */
    LMN_PARAM_FLOAT,     /* numbers */
    LMN_PARAM_ENUM,      /* numbers: an index into names */
    LMN_PARAM_COLOUR,    /* colours: 1 */
    LMN_PARAM_PALETTE,   /* colours: 1 … LMN_PALETTE_MAX */
    LMN_PARAM_DIRECTION, /* direction */
    LMN_PARAM_TEXT
} lmn_param_type;

typedef enum lmn_param_unit {
    LMN_UNIT_NONE = 0,
    LMN_UNIT_POINTS, /* of paper, 1/72 inch */
    LMN_UNIT_DEGREES,
    LMN_UNIT_COUNT,
    LMN_UNIT_FRACTION
} lmn_param_unit;

enum {
    LMN_PALETTE_MAX = 8,     /* colours of a palette */
    LMN_VALUE_TEXT_MAX = 512 /* bytes of any value as text, the 0 at its end counted */
};

/* One parameter. */
typedef struct lmn_param_info {
    const char        *key, *doc;
    lmn_param_type     type;
    lmn_param_unit     unit;
    double             min, max;           /* of INT and FLOAT: what is outside is refused */
    double             soft_min, soft_max; /* the range for a slider */
    bool               logarithmic;        /* the slider's curve */
    bool               can_auto;           /* lmn_look_set_auto */
    bool               default_auto;
    double             default_number;   /* of BOOL, INT, FLOAT and ENUM; NaN: auto */
    char               default_text[96]; /* of all types, as lmn_look_set_text takes it */
    const char *const *names;            /* of ENUM, name_count of them */
    size_t             name_count;
    const char        *only_if; /* the condition under which it matters, on parameters of the same technique: terms
                                   joined by '&', each KEY, KEY=WORD,WORD, KEY>NUMBER or KEY<NUMBER, '!' before it turns
                                   it round; NULL: always. lmn_look_param_state says whether it holds. */
    const char *auto_from;      /* of COLOUR: "auto" takes the value of this key; NULL: of none */
    bool        common;         /* all techniques of the kind have it: a group of its own in a user interface */
    bool        is_file, is_selector; /* of TEXT: may be the path of a file; selects parts */
    bool compiles; /* some change of it may make other programs for the GPU. Numbers of which this is not true may still
                      do so once when they become 0 or "auto", or are so no longer. lmn_look_changes says it of each
                      change. */
} lmn_param_info;

/* One of a technique's parameters, those of the kind first; false when there is no such kind, technique or index. */
LMN_API bool lmn_param_at(const char *kind, const char *technique, size_t index, lmn_param_info *out);

/* The parameter with this key. */
LMN_API lmn_status lmn_param_find(const char *kind, const char *technique, const char *key, lmn_param_info *out,
                                  lmn_error *error);

/* --- ways to tell of motion ------------------------------------------------------------------------------ */

/* A way that has a name: a technique of the kind "motion" with values. All text is static. */
typedef struct lmn_motion_way_info {
    const char *name, *doc, *technique;
    bool        poses; /* poses of telling moments can be drawn so: "motion.moments" */
} lmn_motion_way_info;

/* One of the ways; false when out of range. */
LMN_API bool lmn_motion_way_at(size_t index, lmn_motion_way_info *out);

/* Gives the rules that tell of motion, or all where none does, a way, or the technique of this name; "none" takes
 * motion away. What other ways with the same technique set gets its default, all else (colours, widths, stretching …)
 * stays. */
LMN_API lmn_status lmn_look_set_motion_way(lmn_look *look, const char *name, lmn_error *error);

/* The way that the first rule with motion has, whatever its exposure; NULL: none. Static. */
LMN_API const char *lmn_look_motion_way(const lmn_look *look);

/* --- looks ---------------------------------------------------------------------------------------------- */

/* Makes a look of one rule for all parts, "*", with the standard techniques and nothing else. End it with
 * lmn_look_destroy. */
LMN_API lmn_status lmn_look_create(lmn_look **out, lmn_error *error);

/* Makes a look that is the same, and from then on a look of its own. End it with lmn_look_destroy. */
LMN_API lmn_status lmn_look_copy(lmn_look **out, const lmn_look *look, lmn_error *error);

/* Gives it a name, by which messages and reports call it. */
LMN_API lmn_status lmn_look_set_name(lmn_look *look, const char *name, lmn_error *error);

/* One line on what it is for. NULL: none. Borrowed. */
LMN_API const char *lmn_look_doc(const lmn_look *look);
LMN_API lmn_status  lmn_look_set_doc(lmn_look *look, const char *doc, lmn_error *error);

/* A number that is another one after each change, also by lmn_look_set, and after no call that changes nothing. Later
 * ones are greater; no two looks of a process ever share one. 0 for NULL. */
LMN_API uint64_t lmn_look_revision(const lmn_look *look);

/* What a change asks of the next drawing, besides drawing. */
typedef enum lmn_look_change {
    LMN_CHANGE_VALUES = 1,   /* something is different; alone: the next drawing makes nothing new */
    LMN_CHANGE_PLAN = 2,     /* which parts are drawn by which techniques, or in which order */
    LMN_CHANGE_MESHES = 4,   /* what is made from the scene's shapes: vertices, sections, lines and marks on surfaces */
    LMN_CHANGE_TEXTURES = 8, /* textures that techniques make */
    LMN_CHANGE_PROGRAMS = 16 /* programs for the GPU: the next drawing may have to compile some */
} lmn_look_change;

/* What has changed since the look had this revision: lmn_look_change, or-ed; 0: nothing. 0 as `since` gives all. What a
 * renderer has drawn with before it may still have, so that a flag means "may". */
LMN_API unsigned lmn_look_changes(const lmn_look *look, uint64_t since);

/* --- rules ---------------------------------------------------------------------------------------------- */

/* A place that stands for the whole look, and the place behind all that is there. */
#define LMN_WHOLE_LOOK ((size_t)-1)
#define LMN_AT_END     ((size_t)-1)

/* A part is drawn by the last rule that selects it. */
LMN_API size_t lmn_look_rule_count(const lmn_look *look);

/* Adds a rule with the standard techniques before rule `before`, or LMN_AT_END. `selector` is as in look files
 * (docs/reference/look-files.md); *rule (may be NULL) gets its number. The numbers of those behind it grow by one. */
LMN_API lmn_status lmn_look_add_rule(lmn_look *look, const char *selector, size_t before, size_t *rule,
                                     lmn_error *error);

/* Takes a rule away. The last one stays: a look without rules would draw nothing. */
LMN_API lmn_status lmn_look_remove_rule(lmn_look *look, size_t rule, lmn_error *error);

/* Gives a rule the number `to`; those between move by one. */
LMN_API lmn_status lmn_look_move_rule(lmn_look *look, size_t rule, size_t to, lmn_error *error);

/* Which parts it draws. Borrowed; NULL when there is no such rule. */
LMN_API const char *lmn_look_rule_selector(const lmn_look *look, size_t rule);
LMN_API lmn_status  lmn_look_set_rule_selector(lmn_look *look, size_t rule, const char *selector, lmn_error *error);

/* Its name; borrowed; NULL: it has none. */
LMN_API const char *lmn_look_rule_name(const lmn_look *look, size_t rule);
LMN_API lmn_status  lmn_look_set_rule_name(lmn_look *look, size_t rule, const char *name, lmn_error *error);

/* --- techniques ----------------------------------------------------------------------------------------- */

/* How many techniques of a kind a rule (LMN_WHOLE_LOOK: the look) has: 0 when there is no such rule or kind, too; and
 * the name of one, static, NULL when it is not there. */
LMN_API size_t      lmn_look_technique_count(const lmn_look *look, size_t rule, const char *kind);
LMN_API const char *lmn_look_technique(const lmn_look *look, size_t rule, const char *kind, size_t index);

/* Exchanges a technique. Values of parameters that both have stay. */
LMN_API lmn_status lmn_look_set_technique(lmn_look *look, size_t rule, const char *kind, size_t index,
                                          const char *technique, lmn_error *error);

/* Adds one, with the defaults, before `before` or LMN_AT_END: to kinds of several, and to optional ones of which the
 * rule has none. */
LMN_API lmn_status lmn_look_add_technique(lmn_look *look, size_t rule, const char *kind, const char *technique,
                                          size_t before, lmn_error *error);

/* Takes one away; the last only where the kind is optional. */
LMN_API lmn_status lmn_look_remove_technique(lmn_look *look, size_t rule, const char *kind, size_t index,
                                             lmn_error *error);

/* Gives one the number `to`; those between move by one. */
LMN_API lmn_status lmn_look_move_technique(lmn_look *look, size_t rule, const char *kind, size_t index, size_t to,
                                           lmn_error *error);

/* --- parameters ----------------------------------------------------------------------------------------- */

/* How a parameter stands. */
typedef struct lmn_param_state {
    bool is_default; /* look files leave it out */
    bool is_auto;
    bool applies; /* its condition (only_if) holds now */
} lmn_param_state;

/* Whether it is the default, auto, and matters now. */
LMN_API lmn_status lmn_look_param_state(const lmn_look *look, size_t rule, const char *kind, size_t index,
                                        const char *key, lmn_param_state *out, lmn_error *error);

/* Of any type, as look files and lmn_look_set write it: "1.5", "0.5mm", "true", "#ff8800", "#000,#fff", "1,0,0". `out`
 * holds `size` bytes; LMN_VALUE_TEXT_MAX suffice, and with less LMN_USAGE is possible. */
LMN_API lmn_status lmn_look_get_text(const lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                     char *out, size_t size, lmn_error *error);
LMN_API lmn_status lmn_look_set_text(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                     const char *value, lmn_error *error);

/* Of BOOL, INT, FLOAT (as 32 bits; "auto" reads as NaN and is not set so) and ENUM. */
LMN_API lmn_status lmn_look_get_number(const lmn_look *look, size_t rule, const char *kind, size_t index,
                                       const char *key, double *out, lmn_error *error);
LMN_API lmn_status lmn_look_set_number(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                       double value, lmn_error *error);

/* Of COLOUR and PALETTE: red, green, blue, alpha, 0 … 1, sRGB with straight alpha, one colour after the other. Set,
 * they are rounded to 8 bits, as look files have them. `rgba` holds LMN_PALETTE_MAX colours (a COLOUR needs 1), *count
 * gets how many there are; 0: auto. */
LMN_API lmn_status lmn_look_get_colours(const lmn_look *look, size_t rule, const char *kind, size_t index,
                                        const char *key, float *rgba, size_t *count, lmn_error *error);
LMN_API lmn_status lmn_look_set_colours(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                        const float *rgba, size_t count, lmn_error *error);

/* Of DIRECTION: x, y, z, not all 0; NaN in all when it is auto. */
LMN_API lmn_status lmn_look_get_direction(const lmn_look *look, size_t rule, const char *kind, size_t index,
                                          const char *key, double out[3], lmn_error *error);
LMN_API lmn_status lmn_look_set_direction(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                          const double value[3], lmn_error *error);

/* Makes it "auto" (lmn_param_info.can_auto). */
LMN_API lmn_status lmn_look_set_auto(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                     lmn_error *error);

/* Gives it its default; key NULL: all parameters of the technique. */
LMN_API lmn_status lmn_look_reset(lmn_look *look, size_t rule, const char *kind, size_t index, const char *key,
                                  lmn_error *error);

/* --- controls ------------------------------------------------------------------------------------------- */

/* Five numbers from -1 to 1 that change many parameters at once, each as the look's file says under "controls"
 * (docs/reference/look-files.md); 0 is the look as its parameters are. Parameters keep their values beside them: what
 * is drawn is both together. */
typedef struct lmn_control_info {
    const char *name, *doc; /* static */
} lmn_control_info;

/* The controls, the same for all looks: how many, and one of them; false when out of range. */
LMN_API size_t lmn_control_count(void);
LMN_API bool   lmn_control_at(size_t index, lmn_control_info *out);

/* Does the look say what this control does? False for unknown names and NULL, too. */
LMN_API bool lmn_look_has_control(const lmn_look *look, const char *name);

/* Errors: LMN_USAGE (an unknown name; setting: the look does not have it, or the value is outside -1 … 1). One that the
 * look does not have is 0. */
LMN_API lmn_status lmn_look_get_control(const lmn_look *look, const char *name, double *out, lmn_error *error);
LMN_API lmn_status lmn_look_set_control(lmn_look *look, const char *name, double value, lmn_error *error);

/* What a control does to one parameter. */
typedef struct lmn_control_map {
    const char *param;     /* as lmn_look_set takes it: "lines.width"; of a number. Borrowed where it is given out */
    bool        times;     /* multiplied, with a geometric way between 0 and an end; else added */
    double      low, high; /* the factor, above 0, or what is added, at -1 and at 1 */
} lmn_control_map;

/* One of a control's maps; false when there is no such control or index. */
LMN_API bool lmn_look_control_map(const lmn_look *look, const char *name, size_t index, lmn_control_map *out);

/* Says what a control does, which is copied; 0 maps: the look has it no more. Its value becomes 0. `maps` may be NULL
 * for none. Errors: LMN_USAGE (an unknown name or parameter, no number, a factor that is not above 0), LMN_LIMIT. */
LMN_API lmn_status lmn_look_set_control_maps(lmn_look *look, const char *name, const lmn_control_map *maps,
                                             size_t count, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
