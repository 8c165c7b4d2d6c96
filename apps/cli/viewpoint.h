/* Where models are seen from: options that all commands share which draw. */
#ifndef LIMNER_CLI_VIEWPOINT_H
#define LIMNER_CLI_VIEWPOINT_H

#include "limner/limner.h"
#include "options.h"

typedef struct viewpoint_values {
    const char   *camera;
    option_vector eye, target, up;
    option_number fov, fit;
    int           view; /* index into viewpoint_names; −1: not given */
    bool          orthographic;
} viewpoint_values;

/* Of --view, in the order of lmn_view, and behind these "best"; NULL at the end. */
extern const char *const viewpoint_names[];

/* Rows for a command whose values have a `viewpoint_values viewpoint`. */
#define VIEWPOINT_OPTIONS(values)                                                                                      \
    {"view",                                                                                                           \
     0,                                                                                                                \
     OPTION_CHOICE,                                                                                                    \
     offsetof(values, viewpoint.view),                                                                                 \
     "VIEW",                                                                                                           \
     "iso, front, back, left, right, top, bottom, or best: from where most is seen. Default: iso.",                    \
     .choices = viewpoint_names},                                                                                      \
        {"eye",         0,                                                                                             \
         OPTION_VECTOR, offsetof(values, viewpoint.eye),                                                               \
         "X,Y,Z",       "Where the viewer is, in the scene's unit."},                                                  \
        {"target",      0,                                                                                             \
         OPTION_VECTOR, offsetof(values, viewpoint.target),                                                            \
         "X,Y,Z",       "What the viewer looks at. Default: the scene's middle."},                                     \
        {"up",          0,                                                                                             \
         OPTION_VECTOR, offsetof(values, viewpoint.up),                                                                \
         "X,Y,Z",       "Which way is up in the picture. Default: the scene's up axis."},                              \
        {"camera", 0, OPTION_TEXT, offsetof(values, viewpoint.camera), "NAME", "A camera of the file."},               \
        {"ortho", 0, OPTION_FLAG, offsetof(values, viewpoint.orthographic), NULL, "Parallel projection."},             \
        {"fov", 0,  OPTION_NUMBER, offsetof(values, viewpoint.fov), "DEG", "Vertical angle of view. Default: 30.",     \
         1,     170},                                                                                                  \
    {                                                                                                                  \
        "fit", 0, OPTION_NUMBER, offsetof(values, viewpoint.fit), "FACTOR",                                            \
            "Fraction of the picture that the model fills. With --eye only its direction counts then. Default: 0.9; "  \
            "with --eye nothing is fitted.",                                                                           \
            0.01, 10                                                                                                   \
    }

/* Do they go together? Prints what is wrong; exit status. */
int viewpoint_check(const viewpoint_values *v);

/* Is it said where from? */
bool viewpoint_given(const viewpoint_values *v);

/* Puts them into the description, which says what is selected and when. Target and up that were not given come from the
 * scene. Prints what is wrong; exit status. */
int viewpoint_fill(lmn_draw_desc *desc, const viewpoint_values *v, const lmn_scene *scene);

#endif
