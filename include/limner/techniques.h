/* Techniques from outside of the library: surfaces that a program brings, with parameters of their own, and that looks
 * then have like Limner's.
 *
 * Techniques live in a set, which looks are opened with (lmn_look_open). From then on "surface": "NAME" in look files
 * and all of limner/rules.h mean them, too. A set goes when its handle is destroyed and the last look with it is.
 *
 * The shader is one function, GLSL that is 3.30 and ES 3.00 at once, without #version:
 *
 *     vec4 surface_colour(surface_point p)
 *
 * It answers the colour that is shown at a position: sRGB, multiplied by its alpha; opaque surfaces have alpha 1. It
 * writes nothing else and does not discard. It may read
 *
 *     p.eye      position in eye space: x right, y up, the viewer looks along -z; the scene's unit
 *     p.normal   unit, towards the viewer's side, in the same axes
 *     p.albedo   the model's own colour as light (linear), straight alpha
 *     p.unlit    the file wants no light here
 *     u_KEY      the technique's parameters (lmn_param_desc)
 *     u_size, u_pixels_per_mm, u_time, u_near, u_far, u_perspective, gl_FragCoord
 *                the page in pixels, its scale, seconds, depths of the figure, 1 or 0 for parallel rays, the pixel
 *     towards_viewer(p.eye), towards_light(0, p.eye)   unit, in eye space; light 0 … LIGHT_COUNT - 1
 *     diffuse_light(p)       vec3, the sum of the lights' diffuse terms, shadows and occlusion in it
 *     wrapped_light(p)       float, the same without colour, 0.5 where the surface turns from the light
 *     highlight(p, sharp)    float, Phong's highlight of the first light
 *     unshadowed(p), sky_fraction(p)   float, what shadows and clefts leave of light, 0 … 1
 *     shown(light), light_shown_as(colour)   vec3, from light to what is shown and back
 *
 * and nothing more: other names of Limner's shaders may change. #include and #line are refused. Functions of the text's
 * own best begin with the technique's name; u_ and t_ at the beginning of names are Limner's. What the driver has
 * against the text comes from the drawing call as LMN_GL, with `file` = lmn_technique_desc.file and `line` as the text
 * counts them. A text is compiled once a renderer; changes of parameters compile nothing.
 *
 * Sets are changed by one thread at a time and never while a look with them is changed or drawn. No GL context needed.
 * Texts are copied. All since 0.1. */
#ifndef LIMNER_TECHNIQUES_H
#define LIMNER_TECHNIQUES_H

#include "limner/rules.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lmn_techniques lmn_techniques;

/* One parameter, as a row of a table. All that is not named is 0. */
typedef struct lmn_param_desc {
    const char *key; /* in looks; a-z, 0-9 and _, at most 40; the shader has u_KEY */
    lmn_param_type
        type;             /* BOOL: bool, INT and ENUM: int, FLOAT: float, COLOUR: vec4, DIRECTION: vec3 as given,
                             PALETTE:  vec4 u_KEY[8] and int u_KEY_count. No TEXT. Colours are sRGB with straight alpha */
    const char *standard; /* the default as look files write it: "0.5", "true", "#ff8800", "#000,#fff", "0,1,0"; of ENUM
                             one of its names; NULL: "0", "false", the first name */
    double             min, max;           /* of INT and FLOAT: min < max; what is outside is refused */
    double             soft_min, soft_max; /* the range for a slider; both 0: all */
    lmn_param_unit     unit;               /* POINTS: of FLOAT; the shader gets pixels */
    bool               logarithmic;        /* the slider's curve */
    bool               as_light;           /* of COLOUR and PALETTE: the shader gets light (linear) */
    const char *const *names;              /* of ENUM: name_count of them, the shader gets the index */
    size_t             name_count;
    const char        *only_if; /* as lmn_param_info.only_if; NULL: always */
    const char        *doc;     /* one line; NULL: none */
} lmn_param_desc;

/* A technique. Initialise with LMN_TECHNIQUE_DESC_INIT. */
typedef struct lmn_technique_desc {
    size_t                struct_size;
    size_t                param_size; /* of one row */
    const char           *kind;       /* "surface", the only one so far; NULL: that */
    const char           *name;       /* a-z, 0-9, _ and -, at most 40; none that the kind has */
    const char           *doc;        /* one line; NULL: none */
    const lmn_param_desc *params;
    size_t                param_count; /* at most 64 */
    const char           *glsl;        /* at most 1999 lines */
    const char           *file;        /* how messages call the text; NULL: the name */
} lmn_technique_desc;
#define LMN_TECHNIQUE_DESC_INIT                                                                                        \
    {                                                                                                                  \
        sizeof(lmn_technique_desc), sizeof(lmn_param_desc), NULL, NULL, NULL, NULL, 0, NULL, NULL                      \
    }

/* Makes an empty set. End it with lmn_techniques_destroy. Errors: LMN_USAGE (NULL), LMN_MEMORY. */
LMN_API lmn_status lmn_techniques_create(lmn_techniques **out, lmn_error *error);

/* Gives the handle back and sets it to NULL; looks keep what they have of the set. NULL and a pointer to NULL are
 * accepted. */
LMN_API void lmn_techniques_destroy(lmn_techniques **techniques);

/* Adds a technique; looks that have the set know it at once. On any error the set is unchanged. Errors: LMN_USAGE
 * (desc, a name that is there, a row; what in the text can be told to be wrong without a driver, with file and line),
 * LMN_UNSUPPORTED (another kind), LMN_LIMIT, LMN_MEMORY. */
LMN_API lmn_status lmn_techniques_add(lmn_techniques *techniques, const lmn_technique_desc *desc, lmn_error *error);

/* One of the set, by index from 0, and one of its parameters; false when out of range. Text stays as long as the set.
 */
LMN_API bool lmn_techniques_at(const lmn_techniques *techniques, size_t index, lmn_technique_info *out);
LMN_API bool lmn_techniques_param_at(const lmn_techniques *techniques, const char *technique, size_t index,
                                     lmn_param_info *out);

/* Where a look comes from. Initialise with LMN_LOOK_DESC_INIT. Either a look that ships or a file, or a text, or with
 * both NULL a look of one rule for all parts with the standard techniques. */
typedef struct lmn_look_desc {
    size_t          struct_size;
    const char     *name_or_path; /* as lmn_look_load */
    const char     *json;         /* as lmn_look_parse */
    const char     *name;         /* with json: stands in messages; NULL: "look" */
    lmn_techniques *techniques;   /* that it may have besides Limner's, which it shares from now on; NULL: none */
} lmn_look_desc;
#define LMN_LOOK_DESC_INIT                                                                                             \
    {                                                                                                                  \
        sizeof(lmn_look_desc), NULL, NULL, NULL, NULL                                                                  \
    }

/* Makes a look from this description. End it with lmn_look_destroy. Errors: those of lmn_look_load and lmn_look_parse.
 */
LMN_API lmn_status lmn_look_open(lmn_look **out, const lmn_look_desc *desc, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
