/* Parameter tables: every parameter is declared once, as a row, and everything else follows from the row: the look
 * file's keys, their validation and messages, --set, the reference, sliders, and the shader's uniforms. */
#ifndef LIMNER_TECHNIQUE_PARAM_H
#define LIMNER_TECHNIQUE_PARAM_H

#include <stddef.h>
#include <stdint.h>

#include "base/colour.h"
#include "base/error.h"

enum { PALETTE_MAX = 8, PARAM_TEXT_MAX = 512 };

/* A short list of colours, darkest first. */
typedef struct palette {
    int32_t count;
    colour  colours[PALETTE_MAX];
} palette;

typedef struct direction {
    float x, y, z;
} direction;

/* A short text: a selector, a cut. Ends in 0; empty means nothing is said. */
typedef struct param_words {
    char text[PARAM_TEXT_MAX];
} param_words;

typedef enum param_type {
    PARAM_INT,       /* int32_t  → uniform int */
    PARAM_FLOAT,     /* float    → uniform float; NaN inside means "auto" where can_auto */
    PARAM_BOOL,      /* bool     → uniform bool */
    PARAM_ENUM,      /* int32_t index into names → uniform int */
    PARAM_COLOUR,    /* colour   → uniform vec4, straight alpha, as it is shown or, `as_light`, as light */
    PARAM_DIRECTION, /* direction → uniform vec3, as given (not normalised); text "x,y,z" or a JSON array */
    PARAM_PALETTE,   /* palette  → uniform vec4 u_KEY[8] and int u_KEY_count; text "#a,#b,…" or a JSON array */
    PARAM_TEXT       /* param_words; no uniform */
} param_type;

typedef enum param_unit {
    UNIT_NONE,
    UNIT_PT /* points of paper, 1/72 inch */,
    UNIT_DEGREES,
    UNIT_COUNT,
    UNIT_FRACTION
} param_unit;

/* Room for one value of any type. */
typedef union param_value {
    int32_t     whole;
    float       number;
    bool        flag;
    colour      tint;
    direction   axis;
    palette     list;
    param_words words;
} param_value;

typedef struct param {
    const char        *key; /* also the struct field, the look key and the uniform u_KEY */
    param_type         type;
    size_t             offset;
    double             def, min, max;      /* outside min…max is refused */
    double             soft_min, soft_max; /* slider range; both 0 = min…max */
    colour             def_colour;
    direction          def_direction;
    palette            def_palette;
    const char        *def_text; /* NULL: empty */
    const char *const *names;    /* PARAM_ENUM, NULL-terminated */
    param_unit         unit;
    bool               can_auto; /* the word "auto" is allowed */
    bool               def_auto;
    const char        *auto_from;   /* colours: "auto" takes the value of this key */
    bool               auto_ground; /* colours: "auto" takes the page's ground */
    bool               logarithmic; /* slider curve */
    bool               as_cosine;   /* an angle in degrees of which the shader gets the cosine */
    bool               as_turn;     /* the same: cosine and sine, a vec2 */
    bool               as_light; /* colours: the shader reckons with the light that they show, not with what is shown */
    bool               variant;  /* a #define KEY_IN_CAPITALS value instead of a uniform (int, bool, enum only) */
    bool toggles; /* a number: WITH_KEY_IN_CAPITALS is defined where it is not 0, so that shaders leave out what it does
                   */
    bool        cpu_only;    /* no uniform */
    bool        a_second;    /* a float: above 0 the picture changes so many times a second of its time */
    bool        along;       /* a length along lines, which makes them no wider */
    float       reach;       /* lengths: how many times as far they can reach; 0 is once */
    const char *only_if;     /* condition (params_condition) on the same technique's parameters under which this one
                                matters; NULL: always */
    const char *example;     /* PARAM_TEXT: a value that does something, for tests */
    bool        is_selector; /* PARAM_TEXT: selects parts; src/look checks it */
    bool        is_file;     /* PARAM_TEXT: may be the path of a file; in look files beside the look */
    lmn_status (*check)(const char *text,
                        lmn_error  *error); /* PARAM_TEXT: LMN_USAGE when it is wrong; NULL: any will do */
    const char *doc;                       /* one line, ends in a full stop */
    const char *since, *was;
} param;

/* Offset of a field, a compile error when the field has another type than the row says. */
#define PARAM_OFFSET(S, F, T) (offsetof(S, F) + 0 * sizeof(char[_Generic(((S *)0)->F, T : 1)]))
#define PARAM_INT_ROW(S, F, ...)                                                                                       \
    {                                                                                                                  \
        .key = #F, .type = PARAM_INT, .offset = PARAM_OFFSET(S, F, int32_t), __VA_ARGS__                               \
    }
#define PARAM_FLOAT_ROW(S, F, ...)                                                                                     \
    {                                                                                                                  \
        .key = #F, .type = PARAM_FLOAT, .offset = PARAM_OFFSET(S, F, float), __VA_ARGS__                               \
    }
#define PARAM_BOOL_ROW(S, F, ...)                                                                                      \
    {                                                                                                                  \
        .key = #F, .type = PARAM_BOOL, .offset = PARAM_OFFSET(S, F, bool), __VA_ARGS__                                 \
    }
#define PARAM_ENUM_ROW(S, F, ...)                                                                                      \
    {                                                                                                                  \
        .key = #F, .type = PARAM_ENUM, .offset = PARAM_OFFSET(S, F, int32_t), __VA_ARGS__                              \
    }
#define PARAM_COLOUR_ROW(S, F, ...)                                                                                    \
    {                                                                                                                  \
        .key = #F, .type = PARAM_COLOUR, .offset = PARAM_OFFSET(S, F, colour), __VA_ARGS__                             \
    }
#define PARAM_DIRECTION_ROW(S, F, ...)                                                                                 \
    {                                                                                                                  \
        .key = #F, .type = PARAM_DIRECTION, .offset = PARAM_OFFSET(S, F, direction), __VA_ARGS__                       \
    }
#define PARAM_PALETTE_ROW(S, F, ...)                                                                                   \
    {                                                                                                                  \
        .key = #F, .type = PARAM_PALETTE, .offset = PARAM_OFFSET(S, F, palette), __VA_ARGS__                           \
    }
#define PARAM_TEXT_ROW(S, F, ...)                                                                                      \
    {                                                                                                                  \
        .key = #F, .type = PARAM_TEXT, .offset = PARAM_OFFSET(S, F, param_words), .cpu_only = true, __VA_ARGS__        \
    }
#define PARAM_COUNT(array) (sizeof(array) / sizeof *(array))

const char *param_type_text(param_type type); /* "int", "float", … */
const char *param_unit_text(param_unit unit); /* "", "pt", "deg", "count", "share" */

/* The size of a field of this type. */
size_t param_size(param_type type);

/* The allowed range of a number in words, "0 to 64 px"; 128 characters suffice. */
void param_print_range(const param *p, char *out, size_t size);

/* Fills the fields of `values` with the defaults. */
void params_set_defaults(const param *params, size_t count, void *values);

/* Sets one field from text. Errors (the field is unchanged): LMN_USAGE, the message names key, value and range. */
lmn_status param_set_text(const param *p, void *values, const char *text, lmn_error *error);

/* The field as text that param_set_text takes. `out` holds `size` characters (PARAM_TEXT_MAX suffice). */
void param_print(const param *p, const void *values, char *out, size_t size);

bool param_is_default(const param *p, const void *values);

/* Holds the field "auto"? Inside that is NaN in the first component; only numbers, colours and directions can. */
bool param_is_auto(const param *p, const void *values);

/* Reads as numbers whatever the type: the field's address. */
const void *param_field(const param *p, const void *values);

/* Multiplies all lengths on paper (UNIT_PT) in these values. */
void params_scale_lengths(const param *params, size_t count, void *values, double factor);

/* Conditions on parameters: passes, textures and rows have them, and whole techniques. Terms joined by '&', all of
 * which must hold: key               is set: not 0, false, the first word of an enum, transparent, empty or auto
 *   key=word,word     prints as one of these words (param_print)
 *   key>number, key<number   of a PARAM_INT or PARAM_FLOAT; never of an enum, whose words may get another order
 * A '!' before the key turns a term round.
 *
 * Does it hold for these values? NULL always holds. A term that is wrong never does; tests/unit/conditions_test.c holds
 * what every technique says against params_condition_check. */
bool params_condition(const char *condition, const param *params, size_t count, const void *values);

/* Is this a condition on these parameters? Errors: LMN_USAGE, an unknown key, a word that is no value, a comparison of
 * what is no number. NULL is one. */
lmn_status params_condition_check(const char *condition, const param *params, size_t count, lmn_error *error);

#endif
