/* Inside the import folder: scripts, scenes with what happens in them (docs/SCRIPTS.md), between those who read them.
 */
#ifndef LIMNER_IMPORT_SCRIPT_H
#define LIMNER_IMPORT_SCRIPT_H

#include <jansson.h>

#include "base/locate.h"
#include "import/import.h"
#include "scene/behaviour.h"

enum { SCRIPT_STEPS_MAX = 640, SCRIPT_INCLUDES_MAX = 16, SCRIPT_FILES_MAX = 256 };

/* A script or one that it includes. */
typedef struct script_file {
    char                     *path;
    file_data                 data;
    json_t                   *root;
    const struct script_file *by;                  /* who includes it; NULL: the script itself */
    double                    length, angle, time; /* of its units, in metres, radians and seconds */
} script_file;

/* An activity with a name, for all that refer to it. */
typedef struct script_activity {
    const script_file *file;
    const char        *name;
    json_t            *json;
    int32_t            node; /* of the graph; NONE: nobody has asked yet */
    bool               open;
} script_activity;

/* A node that the script declares, and which animations came with its model. */
typedef struct script_node {
    const char *name;
    int32_t     node, first_clip, clip_count;
} script_node;

typedef struct script_reader {
    const import_job *job;
    lmn_scene        *scene;
    lmn_status        status; /* the first error stays */
    lmn_error        *error;

    script_file       *files[SCRIPT_FILES_MAX];
    size_t             file_count;
    const script_file *file; /* that is read now, and where in it */
    locate_step        steps[SCRIPT_STEPS_MAX];
    size_t             step_count;
    locate_memo        memo; /* of the file of `memo_file` */
    const script_file *memo_file;
    script_activity   *activities;
    size_t             activity_count, activity_capacity;
    script_node       *nodes;
    size_t             node_count, node_capacity;
    int                depth; /* of activities */
} script_reader;

/* --- script_json.c: members with their places in messages ------------------------------------------------ */

/* Fills the error unless there is one; it says where reading is. Returns the reader's status. */
lmn_status script_fail(script_reader *r, lmn_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
bool script_out_of_memory(script_reader *r);
/* Into a member or element, and out again. False when there is an error, or nesting is too deep. */
bool script_enter(script_reader *r, const char *key, size_t index);
void script_leave(script_reader *r);
/* A member of a type (any number for JSON_REAL); NULL when it is not there, or of another type, which is an error. */
json_t *script_member(script_reader *r, json_t *object, const char *key, json_type type);
/* Refuses members that are none of the words, separated by blanks. */
void script_check_keys(script_reader *r, json_t *object, const char *words);
/* Numbers times `unit`; what is not there leaves *out as it is. Returns whether it was there and right. */
bool        script_number(script_reader *r, json_t *object, const char *key, double unit, double *out);
bool        script_vector(script_reader *r, json_t *object, const char *key, size_t count, double unit, double *out);
bool        script_flag(script_reader *r, json_t *object, const char *key);
const char *script_text(script_reader *r, json_t *object, const char *key);
/* Which of the words a member is; `otherwise` when it is not there. */
int script_choice(script_reader *r, json_t *object, const char *key, const char *const *words, int otherwise);
/* "#rrggbb" or three numbers, to linear. */
bool script_colour(script_reader *r, json_t *value, double out[3]);

/* --- script_scene.c, script_shape.c, script_behaviour.c, script_map.c ------------------------------------ */

void script_read_nodes(script_reader *r, json_t *list);
/* A mesh of the shape that a node has below `kind`, in the colour of the node; NONE after an error. */
int32_t script_shape(script_reader *r, json_t *node, const char *kind);
/* The scene's node of a name; NONE after an error that says who is near. */
int32_t            script_find_node(script_reader *r, const char *name);
const script_node *script_find_declared(script_reader *r, const char *name);
/* A rotation: a quaternion, {"axis", "angle"}, or {"forward", "up"}. */
bool script_rotation(script_reader *r, json_t *value, double out[4]);
/* One activity and all below it; NONE after an error. */
int32_t script_activity_of(script_reader *r, json_t *value);
/* The map of a constraint whose property is known. */
void script_read_map(script_reader *r, json_t *object, int32_t node);

#endif
