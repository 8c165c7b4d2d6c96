/* What a window shows and how: files, look, view, what is hidden, time. All of it that a person can change is one
 * state; states follow one another and can be gone back to. A state never changes once it is there, so that the artist
 * can draw it while the next one is made. Main thread. */
#ifndef LIMNER_VIEW_DOCUMENT_H
#define LIMNER_VIEW_DOCUMENT_H

#include <glib.h>

#include "orbit.h"
#include "solid_edits.h"

/* An animation, and where it ends. */
typedef struct clip_info {
    char  *name; /* "": it has none */
    double end_s;
} clip_info;

/* A scene, its files and what lists show of it; shared and never changed but by the artist (solids). */
typedef struct scene_ref {
    lmn_scene     *scene;
    GStrv          paths;
    lmn_scene_info info;
    GArray        *clips;       /* of clip_info */
    GStrv          cameras;     /* their names */
    GArray        *boxes;       /* of double[6]: the bounds of each part, as they were read */
    GArray        *edited;      /* what was done to its solids; the artist's own; NULL: nothing */
    char          *script_told; /* expressions that its files have (expressions.h); NULL: none */
    double         script_time; /* of the still that they ask for, seconds; below 0: of none */
    GMutex         lock;        /* held while signs are put into the scene, and while lists are read from it */
    char          *signs;       /* what its signs were made of; the artist's own; NULL: it has none */
} scene_ref;
/* While lists are filled from the scene. */
void scene_ref_lock(const scene_ref *s);
void scene_ref_unlock(const scene_ref *s);
/* Makes the scene's solids as a state has them. On the artist's thread. */
lmn_status scene_ref_edit(scene_ref *s, const GArray *edits, lmn_error *error);

/* Takes the scene. Any thread: what lists need of it is read here, not while they are filled. */
scene_ref *scene_ref_make(lmn_scene *scene, const char *const *paths);
scene_ref *scene_ref_take(scene_ref *s);
void       scene_ref_drop(scene_ref *s); /* NULL is accepted */

/* A look, and the name or file that it comes from; shared and never changed. */
typedef struct look_ref {
    lmn_look *look;
    char     *origin;
} look_ref;
look_ref *look_ref_make(lmn_look *look, const char *origin); /* takes the look */
look_ref *look_ref_load(const char *name_or_path, lmn_error *error);
look_ref *look_ref_take(look_ref *l);
void      look_ref_drop(look_ref *l); /* NULL is accepted */

typedef struct view_state {
    look_ref *look;
    orbit     view;
    GArray   *hidden; /* of uint32_t: the parts that are not drawn, by number, rising; NULL: none */
    bool      timed;  /* drawn at `time_s`, else at rest */
    double    time_s;
    char     *clip;  /* as lmn_draw_desc.clip */
    GArray   *edits; /* of solid_edit; NULL: none */
    char     *told;  /* expressions, of which there are signs (expressions.h); NULL: none */
    uint32_t  seed;
    bool      fitted; /* nobody has moved the view since it was made to fill the picture */
} view_state;

typedef struct document document;

/* What has changed, or-ed. */
typedef enum document_change {
    DOCUMENT_SCENE = 1,
    DOCUMENT_LOOK = 2, /* of the look: values, techniques or rules */
    DOCUMENT_VIEW = 4,
    DOCUMENT_PARTS = 8, /* what is hidden */
    DOCUMENT_TIME = 16,
    DOCUMENT_HISTORY = 32,  /* what can be undone */
    DOCUMENT_SELECTED = 64, /* the marked part or node */
    DOCUMENT_SOLIDS = 128,  /* where nodes of solids stand, and which are hidden */
    DOCUMENT_TOLD = 256     /* expressions */
} document_change;
typedef void (*document_listener)(document *d, unsigned changes, void *user);

document *document_make(void);
void      document_free(document *d);
void      document_listen(document *d, document_listener listener, void *user);

/* Shows another scene; takes the reference. `fit`: with a new view and nothing hidden, and a new history. */
void             document_set_scene(document *d, scene_ref *scene, bool fit, int width, int height);
const scene_ref *document_scene(const document *d); /* NULL: none yet */

/* The state now; borrowed until the next change. */
const view_state *document_state(const document *d);

/* --- changes: each is a step that undo goes back by. Changes with the same `what` (static text, for people) that
 * follow one another within a moment become one step. */
void document_set_view(document *d, const orbit *view, const char *what);
/* The view fills the picture now. No step of its own; nothing when it was moved, or is seen from
 * another side than `before`. */
void document_fit_view(document *d, const orbit *before, const orbit *view);
void document_set_time(document *d, bool timed, double time_s, const char *clip);
void document_set_look(document *d, look_ref *look, const char *what); /* takes the reference */
/* Hides or shows parts; `alone`: shows these and no other. */
void document_show_parts(document *d, const uint32_t *parts, size_t count, bool shown);
void document_show_alone(document *d, const uint32_t *parts, size_t count);
void document_show_all(document *d);
bool document_is_hidden(const document *d, uint32_t part);

/* A copy of the look to change, and the way back: document_put_look takes it. */
lmn_look *document_copy_look(const document *d, lmn_error *error);
void      document_put_look(document *d, lmn_look *look, const char *what);

/* The part that is marked in lists and in the picture; 0: none. Not a part of the state. */
void     document_select(document *d, uint32_t part);
uint32_t document_selected(const document *d);

/* The node of a solid that is marked, and where its handles are. Not a part of the state. */
typedef struct node_handle {
    solid_edit edit; /* node 0: none is marked */
    double     at[3];
    double     above[16]; /* the product of the matrices above it */
} node_handle;
void               document_set_handle(document *d, const node_handle *handle);
const node_handle *document_handle(const document *d);
/* Puts a node elsewhere, hides it or shows it. */
void document_edit_solid(document *d, const solid_edit *edit, const char *what);

/* Other expressions; takes the list. */
void document_set_told(document *d, char *told, const char *what);

bool        document_undo(document *d);
bool        document_redo(document *d);
const char *document_undo_name(const document *d); /* NULL: nothing to undo */
const char *document_redo_name(const document *d);
/* The next change is a step of its own, whatever was before. */
void document_end_step(document *d);

/* --- what to draw --- */

/* The selector of a state's parts, for lmn_draw_desc.select; NULL: all. Free with g_free. */
char *state_selector(const view_state *s, const scene_ref *scene);

/* The bounds of the state's parts, at rest. */
void state_bounds(const view_state *s, const scene_ref *scene, double box_min[3], double box_max[3]);

/* Fills size, camera, seed, and the time when the scene has the clip (files that are read again may have lost it);
 * `select` and `clip` point into the state and into `selector`. */
void state_describe(const view_state *s, const scene_ref *scene, const char *selector, int width, int height,
                    lmn_draw_desc *desc);

/* Makes the scene as a state has it for a picture: its solids, and its signs, which face the viewer that the
 * description places. *look gets the state's, or with signs one that knows of them, which lmn_look_destroy ends in
 * *own. On the artist's thread. */
lmn_status scene_ref_prepare(scene_ref *s, const view_state *state, const lmn_draw_desc *desc, const lmn_look **look,
                             lmn_look **own, lmn_error *error);

view_state *state_copy(const view_state *s);
void        state_free(view_state *s);

#endif
