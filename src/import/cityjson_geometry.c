/* Geometries: nested lists of numbers of vertices, and beside them lists nested alike that say what each face is. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "import/cityjson.h"

static const struct {
    const char   *name;
    cityjson_kind kind;
} kinds[] = {
    {"Solid", KIND_SOLID},       {"MultiSurface", KIND_SURFACES},     {"CompositeSurface", KIND_SURFACES},
    {"MultiSolid", KIND_SOLIDS}, {"CompositeSolid", KIND_SOLIDS},     {"MultiLineString", KIND_LINES},
    {"MultiPoint", KIND_POINTS}, {"GeometryInstance", KIND_INSTANCE},
};

static cityjson_kind kind_of(json_span name)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (span_is(name, kinds[i].name))
            return kinds[i].kind;
    return KIND_UNKNOWN;
}

/* "2.2", or a number in files of version 1.0. */
static float read_lod(json_scan *s)
{
    double value = -1;
    if (scan_peek(s) != '"') {
        scan_number(s, &value);
    } else {
        json_span text = scan_string(s);
        json_scan inside = scan_of(text);
        if (!text.at || !scan_number(&inside, &value))
            value = -1;
    }
    return value >= 0 && value < 100 ? (float)value : -1;
}

void cityjson_scan_geometry(cityjson_reader *r, json_scan *s, cityjson_geometry *out)
{
    *out = (cityjson_geometry){.kind = KIND_UNKNOWN, .lod = -1};
    for (bool more = scan_open(s, '{'); more; more = scan_next(s, '}')) {
        json_span key = scan_key(s);
        if (span_is(key, "type"))
            out->kind = kind_of(scan_string(s));
        else if (span_is(key, "lod"))
            out->lod = read_lod(s);
        else if (span_is(key, "boundaries"))
            out->boundaries = cityjson_pack(r, scan_skip(s));
        else if (span_is(key, "semantics"))
            out->semantics = cityjson_pack(r, scan_skip(s));
        else if (span_is(key, "material"))
            out->material = cityjson_pack(r, scan_skip(s));
        else if (span_is(key, "texture"))
            out->texture = cityjson_pack(r, scan_skip(s));
        else if (span_is(key, "template"))
            out->semantics = cityjson_pack(r, scan_skip(s));
        else if (span_is(key, "transformationMatrix"))
            out->material = cityjson_pack(r, scan_skip(s));
        else
            scan_skip(s);
    }
    cityjson_good(r, s);
}

/* --- boundaries ----------------------------------------------------------------------------------------- */

static bool note_count(cityjson_reader *r, size_t **list, size_t *count, size_t *capacity, size_t value)
{
    if (!mem_grow((void **)list, capacity, *count + 1, sizeof **list))
        return cityjson_no_memory(r);
    (*list)[(*count)++] = value;
    return true;
}

/* What ends with a bracket so many levels above the numbers: a ring, a face, a shell, a solid. */
static bool end_level(cityjson_reader *r, int above, cityjson_kind kind)
{
    city_shape *shape = &r->shape;
    size_t      begun = r->solid_count ? r->solid_shells[r->solid_count - 1] : 0;
    switch (above) {
    case 0: return city_shape_end_ring(shape) || cityjson_no_memory(r);
    case 1: {
        bool inner = kind >= KIND_SOLID && r->shell_count > begun;
        return shape->lines || city_shape_end_face(shape, NONE, CITY_NO_WORD, inner ? CITY_INNER : 0) ||
               cityjson_no_memory(r);
    }
    case 2:
        return kind < KIND_SOLID ||
               note_count(r, &r->shell_ends, &r->shell_count, &r->shell_capacity, shape->face_count);
    case 3:
        return kind < KIND_SOLIDS ||
               note_count(r, &r->solid_shells, &r->solid_count, &r->solid_capacity, r->shell_count);
    default: return true;
    }
}

/* The numbers of a ring up to its ']'. A number that no point can have stands for those that are none. */
static bool read_ring(cityjson_reader *r, json_scan *s)
{
    for (;;) {
        uint32_t    number = 0;
        const char *digits = s->at;
        while (*s->at >= '0' && *s->at <= '9')
            number = number * 10 + (uint32_t)(*s->at++ - '0');
        if (s->at == digits || s->at - digits > 9 || *s->at == '.' || *s->at == 'e' || *s->at == 'E') {
            double value;
            s->at = digits;
            if (!scan_number(s, &value))
                return false;
            number = value >= 0 && value < UINT32_MAX && !(value > floor(value)) ? (uint32_t)value : UINT32_MAX;
        }
        if (!city_shape_corner(&r->shape, number))
            return cityjson_no_memory(r);
        char c = *s->at;
        if (c != ',' && c != ']')
            c = scan_peek(s);
        if (c == ']')
            return true;
        if (c != ',') {
            scan_fail(s, "',' or ']' is expected");
            return false;
        }
        s->at++;
        scan_peek(s);
    }
}

/* Reads lists that are nested `nesting` times around numbers. False: they are not. */
static bool read_boundaries(cityjson_reader *r, json_span span, cityjson_kind kind)
{
    int       nesting = (int)kind, depth = 0;
    json_scan s = scan_of(span);
    do {
        char c = scan_peek(&s);
        if (c == '[' && depth < nesting) {
            depth++;
            s.at++;
        } else if (c == ']' && depth > 0) {
            s.at++;
            depth--;
            if (!end_level(r, nesting - 1 - depth, kind))
                return false;
        } else if (c == ',' && depth > 0) {
            s.at++;
        } else if (depth != nesting || (c != '-' && (c < '0' || c > '9')) || !read_ring(r, &s)) {
            return false;
        }
    } while (depth > 0);
    return true;
}

/* --- what is said of faces ------------------------------------------------------------------------------ */

typedef struct face_walk face_walk;
typedef void (*face_fn)(cityjson_reader *r, json_scan *s, face_walk *w);

/* Through lists nested like those of faces. Whole shells and solids may be null. */
struct face_walk {
    size_t      face, shell, solid; /* the next ones */
    face_fn     apply;              /* reads the value for `face` */
    const void *with;
};

static void end_group(const cityjson_reader *r, face_walk *w, int above)
{
    if (above == 2 && w->solid < r->solid_count)
        w->shell = r->solid_shells[w->solid++];
    else if (above == 1)
        w->shell++;
    if (above && w->shell && w->shell <= r->shell_count)
        w->face = r->shell_ends[w->shell - 1];
}

static void walk_faces(cityjson_reader *r, json_scan *s, int above, face_walk *w)
{
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']')) {
        if (above == 0) {
            if (w->face >= r->shape.face_count)
                scan_skip(s);
            else if (!scan_null(s))
                w->apply(r, s, w);
            w->face++;
            continue;
        }
        if (!scan_null(s))
            walk_faces(r, s, above - 1, w);
        end_group(r, w, above);
    }
}

static int levels_above_faces(cityjson_kind kind)
{
    return kind == KIND_SOLIDS ? 2 : kind == KIND_SOLID ? 1 : 0;
}

static void walk(cityjson_reader *r, json_span values, cityjson_kind kind, size_t first_face, face_fn apply,
                 const void *with)
{
    if (!values.at || values.at[0] != '[')
        return;
    json_scan s = scan_of(values);
    face_walk w = {.face = first_face, .apply = apply, .with = with};
    walk_faces(r, &s, levels_above_faces(kind), &w);
    cityjson_good(r, &s);
}

/* --- semantics ------------------------------------------------------------------------------------------ */

static void apply_word(cityjson_reader *r, json_scan *s, face_walk *w)
{
    double index = -1;
    if (!scan_number(s, &index))
        return;
    if (index >= 0 && index < (double)r->word_count && !(index > floor(index)))
        r->shape.faces[w->face].word = r->words[(size_t)index];
    else
        r->builder.tally.broken_references++;
}

static void read_words(cityjson_reader *r, json_scan *s)
{
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']')) {
        if (!mem_grow((void **)&r->words, &r->word_capacity, r->word_count + 1, 1)) {
            cityjson_no_memory(r);
            return;
        }
        uint8_t *word = &r->words[r->word_count++];
        *word = CITY_NO_WORD;
        for (bool next = scan_open(s, '{'); next; next = scan_next(s, '}')) {
            if (!span_is(scan_key(s), "type")) {
                scan_skip(s);
                continue;
            }
            json_span type = scan_string(s);
            *word = type.at ? city_word_of_class(type.at, type.size) : CITY_NO_WORD;
        }
    }
}

static void read_semantics(cityjson_reader *r, const cityjson_geometry *g, size_t first_face)
{
    json_span values = {0};
    json_span semantics = cityjson_unpack(r, g->semantics);
    if (!semantics.at || semantics.at[0] != '{')
        return;
    r->word_count = 0;
    json_scan s = scan_of(semantics);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        if (span_is(key, "surfaces") && scan_peek(&s) == '[')
            read_words(r, &s);
        else if (span_is(key, "values"))
            values = scan_skip(&s);
        else
            scan_skip(&s);
    }
    if (cityjson_good(r, &s))
        walk(r, values, g->kind, first_face, apply_word, NULL);
}

/* --- materials and textures ----------------------------------------------------------------------------- */

static void give_material(cityjson_reader *r, double index, size_t face)
{
    if (index >= 0 && index < (double)r->material_count)
        r->shape.faces[face].material = r->materials[(size_t)index];
    else
        r->builder.tally.broken_references++;
}

static void apply_material(cityjson_reader *r, json_scan *s, face_walk *w)
{
    double index = -1;
    if (scan_number(s, &index))
        give_material(r, index, w->face);
}

static void read_material(cityjson_reader *r, const cityjson_geometry *g, size_t first_face)
{
    json_span theme, values = {0};
    double    one = -1;
    if (!cityjson_find_theme(cityjson_unpack(r, g->material), r->material_theme, &theme))
        return;
    json_scan s = scan_of(theme);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        if (span_is(key, "value"))
            scan_number(&s, &one);
        else if (span_is(key, "values"))
            values = scan_skip(&s);
        else
            scan_skip(&s);
    }
    if (!cityjson_good(r, &s))
        return;
    for (size_t f = first_face; one >= 0 && f < r->shape.face_count; f++)
        give_material(r, one, f);
    walk(r, values, g->kind, first_face, apply_material, NULL);
}

/* A ring's texture, and the numbers of places in it: [texture, place, place …]. */
static void read_ring_texture(cityjson_reader *r, json_scan *s, size_t face, size_t ring)
{
    size_t corner = city_first_corner(&r->shape, ring), end = r->shape.rings[ring];
    bool   first = true;
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']'), first = false) {
        double number = -1;
        if (scan_null(s) || !scan_number(s, &number))
            continue;
        if (first) {
            int32_t material =
                number >= 0 && number < (double)r->texture_count ? cityjson_texture(r, (size_t)number) : NONE;
            if (material != NONE)
                r->shape.faces[face].material = material;
        } else if (corner < end) {
            if (number >= 0 && number < (double)r->uv_count)
                r->shape.uvs[corner] = r->uvs[(size_t)number];
            corner++;
        }
    }
}

static void apply_texture(cityjson_reader *r, json_scan *s, face_walk *w)
{
    size_t ring = city_first_ring(&r->shape, w->face), end = r->shape.faces[w->face].ring_end;
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']'), ring++) {
        if (ring < end && scan_peek(s) == '[')
            read_ring_texture(r, s, w->face, ring);
        else
            scan_skip(s);
    }
}

static bool make_uvs(cityjson_reader *r)
{
    city_shape *shape = &r->shape;
    if (!mem_grow((void **)&shape->uvs, &shape->uv_capacity, shape->corner_count, sizeof *shape->uvs))
        return cityjson_no_memory(r);
    memset(shape->uvs + shape->uv_count, 0, (shape->corner_count - shape->uv_count) * sizeof *shape->uvs);
    shape->uv_count = shape->corner_count;
    return true;
}

static void read_texture(cityjson_reader *r, const cityjson_geometry *g, size_t first_face)
{
    json_span theme;
    if (!r->texture_count || !cityjson_find_theme(cityjson_unpack(r, g->texture), r->texture_theme, &theme) ||
        !make_uvs(r))
        return;
    json_scan s = scan_of(theme);
    json_span values = {0};
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        if (span_is(scan_key(&s), "values"))
            values = scan_skip(&s);
        else
            scan_skip(&s);
    }
    if (cityjson_good(r, &s))
        walk(r, values, g->kind, first_face, apply_texture, NULL);
}

/* --- a geometry ----------------------------------------------------------------------------------------- */

/* Whatever was added for it is taken away. */
static bool take_back(cityjson_reader *r, size_t corners, size_t rings, size_t faces)
{
    r->shape.corner_count = corners;
    r->shape.ring_count = rings;
    r->shape.face_count = faces;
    if (r->shape.uv_count > corners)
        r->shape.uv_count = corners;
    return false;
}

bool cityjson_read_shape(cityjson_reader *r, const cityjson_geometry *g)
{
    size_t corners = r->shape.corner_count, rings = r->shape.ring_count, faces = r->shape.face_count;
    r->shell_count = r->solid_count = 0;
    r->shape.lines = g->kind == KIND_LINES;
    if (!g->boundaries.size || !read_boundaries(r, cityjson_unpack(r, g->boundaries), g->kind)) {
        r->builder.tally.bad_geometry += r->status == LMN_OK;
        return take_back(r, corners, rings, faces);
    }
    if (r->shape.lines)
        return true;
    read_semantics(r, g, faces);
    if (r->status == LMN_OK)
        read_material(r, g, faces);
    if (r->status == LMN_OK)
        read_texture(r, g, faces);
    if (r->shape.uv_count && r->shape.uv_count < r->shape.corner_count && r->status == LMN_OK)
        make_uvs(r);
    return r->status == LMN_OK;
}
