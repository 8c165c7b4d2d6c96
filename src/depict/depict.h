/* Dynamics into glyphs: what moves in a scene is told by arrows, ghosts, stars, balloons and frames, which are content
 * of the scene like all else, so that every look draws them. Needs no GPU. Nienhaus 2005, chapter 7. */
#ifndef LIMNER_DEPICT_DEPICT_H
#define LIMNER_DEPICT_DEPICT_H

#include <jansson.h>

#include "base/warnings.h"
#include "limner/draw.h"
#include "pose/pose.h"
#include "technique/param.h"

struct depict_job;
struct expression;

/* One way to tell one characteristic of what moves: a room of its own. A row with semantics is asked before one
 * without. */
typedef struct depiction {
    const char  *characteristic; /* "path" */
    const char  *semantics;      /* "paper-plane": of such things alone; NULL: of all */
    const char  *doc;
    const param *params;
    size_t       param_count, values_size;
    bool         hides_target; /* its glyphs stand for the target */
    lmn_status (*depict)(struct depict_job *job, const struct expression *e, lmn_error *error);
    bool last; /* made when the glyphs of all others are there: it looks for room */
} depiction;

/* All rows; NULL at the end. */
extern const depiction *const depictions[];
/* The row for a characteristic and what a thing is (may be NULL), or for any thing; NULL: there is none. */
const depiction *depiction_find(const char *characteristic, const char *semantics);

/* All rows as a page of Markdown; free with mem_free. NULL when memory is gone. */
char *depict_reference(void);

/* What is to be told of one target: a characteristic within an interval, with the row's parameters. */
typedef struct expression {
    const depiction *row;
    int32_t          target, partner; /* nodes; NONE: no partner */
    double           from, to, now;   /* seconds; what is before `now` is past, what is after it future */
    uint32_t         number;          /* among all expressions: seeds what is random */
    int              line, column;    /* where it was read; 0: it was not */
    size_t           choice[2];       /* how many things the names of target and partner mean; the first is taken */
    void            *values;          /* of row->params; owned */
} expression;

typedef struct expression_list {
    expression *items;
    size_t      count, capacity;
} expression_list;
void expression_list_release(expression_list *l);
/* An expression with its row's defaults; NULL when memory is gone. */
expression *expression_add(expression_list *l, const depiction *row, int32_t target, double from, double to,
                           double now);

/* Reads JSON text: [{"target": "ball", "depict": "path", "from": 0, "to": 2, "now": 1, PARAMETER: VALUE …}], or an
 * object (a script, what --explain writes) that has these as "expressions". Intervals are the whole of the moment's
 * clips and `now` the moment's time where they are left out. Errors, with line and column: LMN_FORMAT, LMN_MEMORY. */
lmn_status expressions_read(expression_list *out, const char *text, const lmn_scene *scene, const moment *when,
                            lmn_error *error);
/* Says which expression an error is of, and where that was read: what it asks for is wrong, LMN_FORMAT, whatever the
 * room called it. Errors of memory and of who ends the work stay. Returns the status. */
lmn_status expression_blame(const expression *e, const lmn_scene *scene, lmn_status status, lmn_error *error);
/* As expressions_read takes them; NULL when memory is gone. */
json_t *expressions_json(const expression_list *l, const lmn_scene *scene);

/* The node that a name means: "#N" its number, from 1 on, else a node's name, else a part's path or a glob of these,
 * the first one in order; NONE when there is none. */
int32_t depict_find_node(const lmn_scene *scene, const char *name);
/* A name that means this node: its own, or its number, which is written into `numbered`. */
enum { DEPICT_NAME_SIZE = 16 };
const char *depict_name_of(const lmn_scene *scene, int32_t node, char numbered[DEPICT_NAME_SIZE]);
/* What a thing is: its own attribute "semantics", or "camera"; NULL when nothing says so. */
const char *depict_semantics(const lmn_scene *scene, int32_t node);

/* What is worth telling where nobody says what: `reasons` (may be NULL) gets an array of objects, why;
 * `warnings` (may be NULL) what is told by nothing, and why not. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status depict_propose(expression_list *out, json_t **reasons, const lmn_scene *scene, const moment *when,
                          double from, double to, warnings *warnings, lmn_error *error);

/* Puts the glyphs of all expressions into the scene, in place of those that it has: nodes below one called "glyphs"
 * with the attributes "glyph" (what it is), "of" (its target), "when" (past, present, future). They face the viewer
 * that the description places, and targets for which glyphs stand are hidden. Errors: LMN_USAGE (the description),
 * LMN_MEMORY, LMN_LIMIT, LMN_FORMAT, LMN_CANCELLED; then the scene has no glyphs, and all it has is shown. */
lmn_status depict(lmn_scene *scene, const expression_list *expressions, const lmn_draw_desc *desc, warnings *warnings,
                  lmn_error *error);
/* As lmn_look_add_sign_rules. */
lmn_status look_add_sign_rules(lmn_look *look, lmn_error *error);

/* Takes all glyphs out, and shows what was hidden for them. Errors: LMN_MEMORY (then changes of the scene stay open).
 */
lmn_status depict_clear(lmn_scene *scene, lmn_error *error);

#endif
