/* City objects: first what there is and who belongs to whom, then node after node. */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/threads.h"
#include "import/cityjson.h"

/* --- what there is -------------------------------------------------------------------------------------- */

static bool is_extension(json_span type)
{
    return type.size && type.at[0] == '+';
}

static void scan_geometries(cityjson_reader *r, json_scan *s, cityjson_object *o)
{
    if (scan_peek(s) != '[') {
        scan_skip(s);
        return;
    }
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']')) {
        cityjson_geometry g;
        if (scan_peek(s) != '{') {
            scan_skip(s);
            r->builder.tally.bad_geometry++;
            continue;
        }
        cityjson_scan_geometry(r, s, &g);
        if (!mem_grow((void **)&r->geometries, &r->geometry_capacity, r->geometry_count + 1, sizeof g)) {
            cityjson_no_memory(r);
            return;
        }
        r->geometries[r->geometry_count++] = g;
        o->geometry_count++;
    }
}

static json_span first_text(json_scan *s)
{
    json_span first = {0};
    if (scan_peek(s) != '[') {
        scan_skip(s);
        return first;
    }
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']')) {
        json_span text = scan_string(s);
        first = first.at ? first : text;
    }
    return first;
}

static void scan_object(cityjson_reader *r, json_scan *s, json_span id)
{
    cityjson_object o = {.id = cityjson_pack(r, id),
                         .first_geometry = (uint32_t)r->geometry_count,
                         .lod = -1,
                         .below_lod = -1,
                         .parent_index = NONE,
                         .node = NONE};
    for (bool more = scan_open(s, '{'); more && r->status == LMN_OK; more = scan_next(s, '}')) {
        json_span key = scan_key(s);
        if (span_is(key, "type"))
            o.type = cityjson_pack(r, scan_string(s));
        else if (span_is(key, "attributes"))
            o.attributes = cityjson_pack(r, scan_skip(s));
        else if (span_is(key, "geometry"))
            scan_geometries(r, s, &o);
        else if (span_is(key, "parents"))
            o.parent = cityjson_pack(r, first_text(s));
        else if (span_is(key, "children"))
            o.children = cityjson_pack(r, scan_skip(s));
        else
            scan_skip(s);
    }
    if (!cityjson_good(r, s))
        return;
    r->builder.tally.extensions += is_extension(cityjson_unpack(r, o.type));
    if (r->object_count == LIMIT_NODES)
        cityjson_fail(r, LMN_LIMIT, s->at, "more than %zu city objects", LIMIT_NODES);
    else if (!mem_grow((void **)&r->objects, &r->object_capacity, r->object_count + 1, sizeof o))
        cityjson_no_memory(r);
    else
        r->objects[r->object_count++] = o;
}

/* --- who belongs to whom -------------------------------------------------------------------------------- */

static uint64_t hash_span(json_span t)
{
    uint64_t h = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < t.size; i++)
        h = (h ^ (unsigned char)t.at[i]) * UINT64_C(1099511628211);
    return h ^ h >> 29;
}

/* The slot of an id, which holds UINT32_MAX when nothing is called so. */
static uint32_t *find_slot(const cityjson_reader *r, json_span id)
{
    size_t slot = hash_span(id) & (r->slot_count - 1);
    while (r->slots[slot] != UINT32_MAX) {
        json_span there = cityjson_unpack(r, r->objects[r->slots[slot]].id);
        if (there.size == id.size && memcmp(there.at, id.at, id.size) == 0)
            break;
        slot = (slot + 1) & (r->slot_count - 1);
    }
    return &r->slots[slot];
}

static bool fill_slots(cityjson_reader *r)
{
    r->slot_count = 16;
    while (r->slot_count < r->object_count * 2)
        r->slot_count *= 2;
    uint32_t *grown = mem_realloc(r->slots, r->slot_count * sizeof *grown);
    if (!grown)
        return cityjson_no_memory(r);
    r->slots = grown;
    memset(grown, 0xFF, r->slot_count * sizeof *grown);
    for (size_t i = 0; i < r->object_count; i++) {
        uint32_t *slot = find_slot(r, cityjson_unpack(r, r->objects[i].id));
        if (*slot == UINT32_MAX)
            *slot = (uint32_t)i;
    }
    return true;
}

static void set_parent(cityjson_reader *r, size_t child, uint32_t parent)
{
    r->objects[child].parent_index = (int32_t)parent;
    r->objects[parent].has_children = true;
}

static void adopt(cityjson_reader *r, size_t parent)
{
    json_span children = cityjson_unpack(r, r->objects[parent].children);
    if (!children.at || children.at[0] != '[' ||
        span_is(cityjson_unpack(r, r->objects[parent].type), "CityObjectGroup"))
        return;
    json_scan s = scan_of(children);
    for (bool more = scan_open(&s, '['); more; more = scan_next(&s, ']')) {
        json_span id = scan_string(&s);
        uint32_t  child = id.at ? *find_slot(r, id) : UINT32_MAX;
        if (child == UINT32_MAX)
            r->builder.tally.broken_references++;
        else if (r->objects[child].parent_index == NONE && child != parent)
            set_parent(r, child, (uint32_t)parent);
    }
    cityjson_good(r, &s);
}

static void find_parents(cityjson_reader *r)
{
    for (size_t i = 0; i < r->object_count; i++) {
        json_span id = cityjson_unpack(r, r->objects[i].parent);
        uint32_t  parent = id.at ? *find_slot(r, id) : UINT32_MAX;
        if (parent != UINT32_MAX)
            set_parent(r, i, parent);
        else if (id.at)
            r->builder.tally.broken_references++;
    }
    for (size_t i = 0; i < r->object_count && r->status == LMN_OK; i++)
        adopt(r, i);
}

/* Is it a part of what is above it, and not something added to that, such as a chimney? */
static bool is_part(json_span type)
{
    return type.size > 4 && memcmp(type.at + type.size - 4, "Part", 4) == 0;
}

/* The highest level of detail that is wanted, and for all above an object what their parts have. */
static void choose_lods(cityjson_reader *r)
{
    enum { ANCESTORS_MAX = 64 };
    for (size_t i = 0; i < r->object_count; i++) {
        cityjson_object *o = &r->objects[i];
        for (size_t k = 0; k < o->geometry_count; k++) {
            const cityjson_geometry *g = &r->geometries[o->first_geometry + k];
            if (g->lod <= r->wish && g->lod > o->lod)
                o->lod = g->lod;
        }
        int32_t above = is_part(cityjson_unpack(r, o->type)) ? o->parent_index : NONE;
        for (int n = 0; above != NONE && n < ANCESTORS_MAX; n++, above = r->objects[above].parent_index)
            r->objects[above].below_lod = fmaxf(r->objects[above].below_lod, o->lod);
    }
}

/* --- nodes ---------------------------------------------------------------------------------------------- */

enum { ATTRIBUTE_BYTES_MAX = 4096 };

static bool put_attribute(cityjson_reader *r, int32_t node, json_span key, json_scan *s)
{
    bool      text = scan_peek(s) == '"', null = scan_null(s);
    json_span value = null ? (json_span){0} : text ? scan_string(s) : scan_skip(s);
    if (null || !value.at || s->wrong || value.size > ATTRIBUTE_BYTES_MAX)
        return true;
    return city_attribute_of_spans(r->scene, node, key, value) || cityjson_no_memory(r);
}

static void put_attributes(cityjson_reader *r, const cityjson_object *o)
{
    json_span attributes = cityjson_unpack(r, o->attributes);
    if (!attributes.at || attributes.at[0] != '{')
        return;
    json_scan s = scan_of(attributes);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        if (s.wrong || !put_attribute(r, o->node, key, &s))
            break;
    }
    cityjson_good(r, &s);
}

static bool is_building(json_span type)
{
    return type.at && (span_is(type, "Building") || span_is(type, "BuildingPart") || span_is(type, "BuildingUnit") ||
                       span_is(type, "BuildingStorey") || span_is(type, "OtherConstruction"));
}

/* The matrix of an instance: the file's, row by row, moved to the one vertex that its boundaries name. */
static bool read_matrix(cityjson_reader *r, const cityjson_geometry *g, mat4 *out)
{
    double    number = -1;
    int       k = 0;
    json_span matrix = cityjson_unpack(r, g->material), boundaries = cityjson_unpack(r, g->boundaries);
    *out = mat4_identity();
    if (!matrix.at || !boundaries.at || boundaries.at[0] != '[')
        return false;
    json_scan s = scan_of(matrix);
    for (bool more = scan_open(&s, '['); more; more = scan_next(&s, ']'), k++) {
        double value = 0;
        if (!scan_number(&s, &value) || !isfinite(value))
            return false;
        if (k < 16)
            out->m[(k % 4) * 4 + k / 4] = value;
    }
    json_scan at = scan_of(boundaries);
    if (k != 16 || s.wrong || !scan_open(&at, '[') || !scan_number(&at, &number) || !(number >= 0) ||
        !(number < (double)r->point_count))
        return false;
    vec3 p = r->points[(size_t)number];
    out->m[12] += (double)p.x;
    out->m[13] += (double)p.y;
    out->m[14] += (double)p.z;
    return true;
}

static bool read_index(json_span span, size_t count, size_t *out)
{
    double    value = -1;
    json_scan s = scan_of(span);
    if (!span.at || !scan_number(&s, &value) || !(value >= 0) || !(value < (double)count))
        return false;
    *out = (size_t)value;
    return true;
}

static void make_template(cityjson_reader *r, cityjson_template *t, uint8_t own)
{
    cityjson_geometry g;
    t->made = true;
    json_scan s = scan_of(cityjson_unpack(r, t->geometry));
    cityjson_scan_geometry(r, &s, &g);
    if (r->status != LMN_OK)
        return;
    city_shape kept = r->shape; /* of the object that asks */
    memset(&r->shape, 0, sizeof r->shape);
    if (g.kind >= KIND_LINES && g.kind <= KIND_SOLIDS && cityjson_read_shape(r, &g)) {
        city_builder_points(&r->builder, r->template_points, r->template_point_count);
        r->status = city_make(&r->builder, &r->shape, own, false, &t->meshes);
        city_builder_points(&r->builder, r->points, r->point_count);
    }
    city_shape_release(&r->shape);
    r->shape = kept;
}

static void put_instance(cityjson_reader *r, const cityjson_object *o, const cityjson_geometry *g, uint8_t own)
{
    size_t index;
    mat4   matrix;
    if (!read_index(cityjson_unpack(r, g->semantics), r->template_count, &index) || !read_matrix(r, g, &matrix)) {
        r->builder.tally.broken_references++;
        return;
    }
    cityjson_template *t = &r->templates[index];
    if (!t->made)
        make_template(r, t, own);
    if (r->status == LMN_OK)
        r->status = city_attach(&r->builder, o->node, &t->meshes, &matrix, !o->has_children && o->geometry_count == 1);
}

static void count_lod(cityjson_reader *r, float lod)
{
    size_t i = 0;
    while (i < r->lod_count && fabsf(r->lods[i] - lod) > 1e-4f)
        i++;
    if (i == sizeof r->lods / sizeof *r->lods)
        return;
    r->lod_count += i == r->lod_count;
    r->lods[i] = lod;
    r->lod_counts[i]++;
}

static void put_shape(cityjson_reader *r, const cityjson_object *o, uint8_t own, city_meshes *meshes)
{
    meshes->count = 0;
    if (r->status == LMN_OK && (r->shape.face_count || r->shape.lines))
        r->status = city_make(&r->builder, &r->shape, own, is_building(cityjson_unpack(r, o->type)), meshes);
    if (r->status == LMN_OK && meshes->count)
        r->status = city_attach(&r->builder, o->node, meshes, NULL, true);
    city_shape_clear(&r->shape);
}

static void put_geometry(cityjson_reader *r, const cityjson_object *o, uint8_t own, city_meshes *meshes)
{
    city_shape_clear(&r->shape);
    for (size_t k = 0; k < o->geometry_count && r->status == LMN_OK; k++) {
        const cityjson_geometry *g = &r->geometries[o->first_geometry + k];
        if (g->lod < o->lod || (g->lod > o->lod && g->lod > r->wish))
            continue;
        if (g->kind == KIND_INSTANCE) {
            put_instance(r, o, g, own);
        } else if (g->kind == KIND_LINES) {
            put_shape(r, o, own, meshes);
            if (cityjson_read_shape(r, g))
                put_shape(r, o, own, meshes);
        } else if (g->kind == KIND_POINTS) {
            r->builder.tally.points++;
        } else if (g->kind == KIND_UNKNOWN) {
            r->builder.tally.unknown_types++;
        } else {
            cityjson_read_shape(r, g);
        }
    }
    put_shape(r, o, own, meshes);
}

static bool has_wished_lod(const cityjson_reader *r, const cityjson_object *o)
{
    bool found = false;
    for (size_t k = 0; k < o->geometry_count; k++)
        found = found || r->geometries[o->first_geometry + k].lod <= r->wish;
    return found;
}

/* Do its parts stand for it? */
static bool is_coarser(const cityjson_object *o)
{
    return o->has_children && o->lod < o->below_lod;
}

static json_span type_of(const cityjson_reader *r, const cityjson_object *o)
{
    json_span type = cityjson_unpack(r, o->type);
    return type.at ? type : (json_span){"unknown", 7};
}

/* `formed`: what it looks like, where that has been made already; else NULL. */
static void put_object(cityjson_reader *r, cityjson_object *o, city_forms *formed, city_meshes *meshes)
{
    json_span type = type_of(r, o);
    o->node = city_object(&r->builder, span_decode(cityjson_unpack(r, o->id)), type.at, type.size);
    if (o->node == NONE) {
        r->status = LMN_MEMORY;
        return;
    }
    put_attributes(r, o);
    if (r->status != LMN_OK)
        return;
    bool drawable = has_wished_lod(r, o);
    if (!drawable || is_coarser(o)) {
        r->builder.tally.no_geometry += o->geometry_count == 0;
        r->builder.tally.no_lod += o->geometry_count > 0 && !drawable;
        r->builder.tally.coarser += drawable;
        return;
    }
    count_lod(r, o->lod);
    if (!formed) {
        put_geometry(r, o, city_word_of_class(type.at, type.size), meshes);
        return;
    }
    meshes->count = 0;
    r->status = city_keep(&r->builder, formed, meshes);
    if (r->status == LMN_OK && meshes->count)
        r->status = city_attach(&r->builder, o->node, meshes, NULL, true);
}

/* --- several at a time ---------------------------------------------------------------------------------- */

/* What objects look like is made by the batch, on all processors; nodes then follow one by one, in the file's order. */
enum { BATCH = 2048, LEAST_OF_THREAD = 256 };

typedef struct forming {
    cityjson_reader *r;
    size_t           first;
    city_forms       forms[BATCH]; /* of the objects from `first` on */
    bool             formed[BATCH];
    lmn_status       status; /* of the thread that failed; the first of them by its objects, `failed` */
    lmn_error        error;
    size_t           failed;
    pthread_mutex_t  joining;
} forming;

/* Does it consist of surfaces alone that no other object shares, and of nothing that is fetched on the way? */
static bool stands_alone(const cityjson_reader *r, const cityjson_object *o)
{
    bool alone = r->texture_count == 0;
    for (size_t k = 0; k < o->geometry_count && alone; k++) {
        cityjson_kind kind = r->geometries[o->first_geometry + k].kind;
        alone = kind >= KIND_SURFACES && kind <= KIND_SOLIDS;
    }
    return alone && has_wished_lod(r, o) && !is_coarser(o);
}

static void form_object(cityjson_reader *r, const cityjson_object *o, city_forms *out)
{
    json_span type = type_of(r, o);
    city_shape_clear(&r->shape);
    for (size_t k = 0; k < o->geometry_count && r->status == LMN_OK; k++) {
        const cityjson_geometry *g = &r->geometries[o->first_geometry + k];
        if (g->lod == o->lod)
            cityjson_read_shape(r, g);
    }
    if (r->status == LMN_OK && r->shape.face_count)
        r->status = city_form_shape(&r->builder, &r->shape, city_word_of_class(type.at, type.size),
                                    is_building(cityjson_unpack(r, o->type)), out);
}

static void form_some(size_t begin, size_t end, void *user)
{
    forming        *f = user;
    lmn_error       error = {0};
    cityjson_reader own = *f->r;
    size_t          i = f->first + begin;
    own.error = &error;
    own.shape = (city_shape){0};
    own.shell_ends = own.solid_shells = NULL;
    own.words = NULL;
    own.shell_count = own.shell_capacity = own.solid_count = own.solid_capacity = 0;
    own.word_count = own.word_capacity = 0;
    own.status = city_builder_fork(&own.builder, &f->r->builder, &error);
    for (; i < f->first + end && own.status == LMN_OK; i++) {
        const cityjson_object *o = &own.objects[i];
        f->formed[i - f->first] = stands_alone(&own, o);
        if (f->formed[i - f->first])
            form_object(&own, o, &f->forms[i - f->first]);
    }
    pthread_mutex_lock(&f->joining);
    city_builder_join(&f->r->builder, &own.builder);
    if (own.status != LMN_OK && i < f->failed) {
        f->failed = i;
        f->status = own.status;
        f->error = error;
    }
    pthread_mutex_unlock(&f->joining);
    city_shape_release(&own.shape);
    mem_free(own.shell_ends);
    mem_free(own.solid_shells);
    mem_free(own.words);
}

static void put_batch(cityjson_reader *r, forming *f, size_t count, city_meshes *meshes)
{
    memset(f->formed, 0, sizeof f->formed);
    threads_for(count, LEAST_OF_THREAD, form_some, f);
    if (f->status != LMN_OK) {
        r->status = f->status;
        if (r->error)
            *r->error = f->error;
    }
    for (size_t i = 0; i < count && r->status == LMN_OK; i++)
        put_object(r, &r->objects[f->first + i], f->formed[i] ? &f->forms[i] : NULL, meshes);
    for (size_t i = 0; i < count; i++)
        city_forms_release(&f->forms[i]);
}

static void put_objects(cityjson_reader *r)
{
    city_meshes meshes = {0};
    forming    *f = mem_calloc(1, sizeof *f);
    if (!f) {
        cityjson_no_memory(r);
        return;
    }
    f->r = r;
    f->failed = SIZE_MAX;
    pthread_mutex_init(&f->joining, NULL);
    for (f->first = 0; f->first < r->object_count && r->status == LMN_OK; f->first += BATCH) {
        size_t rest = r->object_count - f->first;
        put_batch(r, f, rest < BATCH ? rest : BATCH, &meshes);
        if (r->status == LMN_OK)
            r->status =
                import_progress(r->job, 0.2 + 0.6 * (double)f->first / (double)r->object_count, "building", r->error);
    }
    pthread_mutex_destroy(&f->joining);
    mem_free(f);
    mem_free(meshes.items);
}

void cityjson_read_objects(cityjson_reader *r, json_span objects)
{
    r->object_count = r->geometry_count = 0;
    json_scan s = scan_of(objects);
    for (bool more = scan_open(&s, '{'); more && r->status == LMN_OK; more = scan_next(&s, '}')) {
        json_span id = scan_key(&s);
        if (!s.wrong)
            scan_object(r, &s, id);
    }
    if (!cityjson_good(r, &s) || !fill_slots(r))
        return;
    find_parents(r);
    choose_lods(r);
    city_builder_points(&r->builder, r->points, r->point_count);
    put_objects(r);
    for (size_t i = 0; i < r->object_count && r->status == LMN_OK; i++)
        if (r->objects[i].parent_index != NONE)
            city_link(&r->builder, r->objects[r->objects[i].parent_index].node, r->objects[i].node);
}

/* --- templates ------------------------------------------------------------------------------------------ */

static void read_template_list(cityjson_reader *r, json_span list)
{
    json_scan s = scan_of(list);
    size_t    capacity = r->template_count;
    for (bool more = scan_open(&s, '['); more; more = scan_next(&s, ']')) {
        json_span span = scan_skip(&s);
        if (!mem_grow((void **)&r->templates, &capacity, r->template_count + 1, sizeof *r->templates)) {
            cityjson_no_memory(r);
            return;
        }
        r->templates[r->template_count++] = (cityjson_template){.geometry = cityjson_pack(r, span)};
    }
    cityjson_good(r, &s);
}

void cityjson_read_templates(cityjson_reader *r, json_span templates)
{
    if (!templates.at || templates.at[0] != '{')
        return;
    json_scan s = scan_of(templates);
    for (bool more = scan_open(&s, '{'); more && r->status == LMN_OK; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s), value = scan_skip(&s);
        if (span_is(key, "templates") && value.at[0] == '[')
            read_template_list(r, value);
        else if (span_is(key, "vertices-templates") && value.at[0] == '[' && !r->template_points)
            cityjson_read_plain_points(r, value, &r->template_points, &r->template_point_count);
    }
    cityjson_good(r, &s);
}

void cityjson_end_templates(cityjson_reader *r)
{
    for (size_t i = 0; i < r->template_count; i++)
        mem_free(r->templates[i].meshes.items);
    mem_free(r->templates);
    mem_free(r->template_points);
    r->templates = NULL;
    r->template_points = NULL;
    r->template_count = 0;
}
