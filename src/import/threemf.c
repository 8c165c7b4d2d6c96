/* A package is a ZIP archive (PKWARE's APPNOTE), and the model one XML part of it. That is read a second time, as it is
 * unpacked, for the few attributes that assimp does not hand over. */
#include "import/threemf.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <libxml/parser.h>
#include <zlib.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"
#include "import/build.h"

enum { STORED = 0, DEFLATED = 8, STEP = 1 << 16 };
enum { END_SIZE = 22, END64_SIZE = 56, LOCATOR_SIZE = 20, ENTRY_SIZE = 46, LOCAL_SIZE = 30, COMMENT_MOST = 65535 };

typedef struct object_name {
    uint32_t id;
    char    *name; /* owned */
} object_name;

typedef struct threemf_reader {
    const import_job *job;
    lmn_error        *error;
    lmn_status        status;
    bool              found; /* the model's element: what it says of its unit is known */
    char             *unit;  /* owned; NULL: it says none */
    object_name      *names;
    size_t            name_count, name_capacity;
} threemf_reader;

/* --- the package ---------------------------------------------------------------------------------------- */

/* A whole number of `bytes` bytes, the lowest first; the caller has seen that they are there. */
static uint64_t number_at(const unsigned char *at, int bytes)
{
    uint64_t value = 0;
    for (int i = bytes; i-- > 0;)
        value = value << 8 | at[i];
    return value;
}

static bool is_at(const file_data *file, uint64_t at, size_t size, const char *signature)
{
    return at <= file->size && file->size - at >= size && memcmp(file->data + at, signature, 4) == 0;
}

/* Where the directory begins: said at the end of the file, of large archives in another place that is said there. */
static bool find_directory(const file_data *file, uint64_t *out)
{
    size_t least = file->size > END_SIZE + COMMENT_MOST ? file->size - END_SIZE - COMMENT_MOST : 0;
    for (size_t at = file->size < END_SIZE ? 0 : file->size - END_SIZE + 1; at-- > least;) {
        if (!is_at(file, at, END_SIZE, "PK\5\6"))
            continue;
        *out = number_at(file->data + at + 16, 4);
        if (at < LOCATOR_SIZE || !is_at(file, at - LOCATOR_SIZE, LOCATOR_SIZE, "PK\6\7"))
            return true;
        uint64_t large = number_at(file->data + at - LOCATOR_SIZE + 8, 8);
        if (is_at(file, large, END64_SIZE, "PK\6\6"))
            *out = number_at(file->data + large + 48, 8);
        return true;
    }
    return false;
}

/* Of an entry: where its data is said to be and how much; those that 32 bits do not hold stand behind the name. */
static void read_extent(const unsigned char *entry, uint64_t *size, uint64_t *local)
{
    size_t               name = number_at(entry + 28, 2), left = number_at(entry + 30, 2);
    const unsigned char *at = entry + ENTRY_SIZE + name;
    bool                 unpacked_too = number_at(entry + 24, 4) == UINT32_MAX;
    *size = number_at(entry + 20, 4);
    *local = number_at(entry + 42, 4);
    for (size_t taken; left >= 4; at += 4 + taken, left -= 4 + taken) {
        taken = number_at(at + 2, 2);
        if (taken > left - 4)
            return;
        if (number_at(at, 2) != 1)
            continue;
        const unsigned char *value = at + 4 + (unpacked_too ? 8 : 0), *end = at + 4 + taken;
        if (*size == UINT32_MAX && value + 8 <= end)
            *size = number_at(value, 8), value += 8;
        if (*local == UINT32_MAX && value + 8 <= end)
            *local = number_at(value, 8);
        return;
    }
}

/* The bytes of the model's part as they are packed, NULL: there is none; how: STORED, DEFLATED. */
static const unsigned char *find_model(const file_data *file, size_t *size, int *how)
{
    static const char    path[] = "3D/3dmodel.model", ending[] = ".model";
    const unsigned char *found = NULL;
    uint64_t             at;
    if (!find_directory(file, &at))
        return NULL;
    while (is_at(file, at, ENTRY_SIZE, "PK\1\2")) {
        const unsigned char *entry = file->data + at;
        size_t               length = number_at(entry + 28, 2),
               whole = ENTRY_SIZE + length + number_at(entry + 30, 2) + number_at(entry + 32, 2);
        const char *name = (const char *)entry + ENTRY_SIZE;
        if (file->size - at < whole)
            break;
        bool usual = length == sizeof path - 1 && strncasecmp(name, path, length) == 0;
        if (usual || (!found && length >= sizeof ending &&
                      strncasecmp(name + length - sizeof ending + 1, ending, sizeof ending - 1) == 0))
            found = entry;
        if (usual)
            break;
        at += whole;
    }
    uint64_t packed, local;
    if (!found)
        return NULL;
    read_extent(found, &packed, &local);
    *how = (int)number_at(found + 10, 2);
    if (!is_at(file, local, LOCAL_SIZE, "PK\3\4") || (*how != STORED && *how != DEFLATED))
        return NULL;
    uint64_t from = local + LOCAL_SIZE + number_at(file->data + local + 26, 2) + number_at(file->data + local + 28, 2);
    if (from > file->size || packed > file->size - from)
        return NULL;
    *size = (size_t)packed;
    return file->data + from;
}

/* --- the model ------------------------------------------------------------------------------------------ */

static char *attribute_of(const xmlChar **attributes, int count, const char *name)
{
    for (int i = 0; i < count; i++) /* name, prefix, namespace, value, its end */
        if (!attributes[5 * i + 1] && strcmp((const char *)attributes[5 * i], name) == 0)
            return scene_clean_name((const char *)attributes[5 * i + 3],
                                    (size_t)(attributes[5 * i + 4] - attributes[5 * i + 3]));
    return NULL;
}

/* The number that is the whole of a text; false: it is none. */
static bool is_number(const char *text, uint32_t *out)
{
    char         *end = NULL;
    unsigned long value = text && *text >= '0' && *text <= '9' ? strtoul(text, &end, 10) : 0;
    *out = (uint32_t)value;
    return end && !*end && value <= UINT32_MAX;
}

static void add_name(threemf_reader *r, const xmlChar **attributes, int count)
{
    char    *id = attribute_of(attributes, count, "id"), *name = attribute_of(attributes, count, "name");
    uint32_t number;
    if (is_number(id, &number) && name && *name) {
        if (mem_grow((void **)&r->names, &r->name_capacity, r->name_count + 1, sizeof *r->names)) {
            r->names[r->name_count++] = (object_name){number, name};
            name = NULL;
        } else {
            r->status = error_memory(r->error);
        }
    }
    mem_free(id);
    mem_free(name);
}

static void on_start(void *user, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri, int namespace_count,
                     const xmlChar **namespaces, int attribute_count, int defaulted, const xmlChar **attributes)
{
    threemf_reader *r = user;
    (void)prefix, (void)uri, (void)namespace_count, (void)namespaces, (void)defaulted;
    if (r->status == LMN_OK && !r->found && strcmp((const char *)name, "model") == 0) {
        r->unit = attribute_of(attributes, attribute_count, "unit");
        r->found = true;
    } else if (r->status == LMN_OK && strcmp((const char *)name, "object") == 0) {
        add_name(r, attributes, attribute_count);
    }
}

static void on_error(void *user, const xmlError *error)
{
    (void)user, (void)error;
}

/* False: no more is wanted. What is damaged ends it, too: assimp has found enough to draw. */
static bool feed(threemf_reader *r, xmlParserCtxtPtr parser, const unsigned char *bytes, size_t size)
{
    if (work_stopped())
        r->status = work_check(r->error);
    return r->status == LMN_OK && xmlParseChunk(parser, (const char *)bytes, (int)size, 0) == 0 && r->status == LMN_OK;
}

static void parse_stored(threemf_reader *r, xmlParserCtxtPtr parser, const unsigned char *bytes, size_t size)
{
    for (size_t at = 0, step; at < size; at += step) {
        step = size - at < STEP ? size - at : STEP;
        if (!feed(r, parser, bytes + at, step))
            return;
    }
}

static void parse_packed(threemf_reader *r, xmlParserCtxtPtr parser, const unsigned char *bytes, size_t size)
{
    unsigned char out[STEP];
    z_stream      stream = {0};
    size_t        at = 0, all = 0;
    int           result = inflateInit2(&stream, -MAX_WBITS);
    if (result != Z_OK) {
        r->status = error_memory(r->error);
        return;
    }
    while (result == Z_OK && all < LIMIT_FILE_BYTES) {
        if (stream.avail_in == 0) {
            stream.next_in = (Bytef *)(uintptr_t)(bytes + at);
            stream.avail_in = (uInt)(size - at < STEP ? size - at : STEP);
            at += stream.avail_in;
        }
        stream.next_out = out;
        stream.avail_out = STEP;
        result = inflate(&stream, Z_NO_FLUSH);
        all += STEP - stream.avail_out;
        if (!feed(r, parser, out, STEP - stream.avail_out))
            break;
    }
    inflateEnd(&stream);
}

static void read_model(threemf_reader *r)
{
    size_t               size;
    int                  how;
    const unsigned char *bytes = find_model(r->job->file, &size, &how);
    xmlSAXHandler        sax = {.initialized = XML_SAX2_MAGIC,
                                .startElementNs = on_start,
                                .serror = (xmlStructuredErrorFunc)(void (*)(void))on_error};
    xmlParserCtxtPtr     parser = bytes ? xmlCreatePushParserCtxt(&sax, r, NULL, 0, NULL) : NULL;
    if (!parser)
        return;
    /* Entities are those of XML: there is no handler that would declare others. */
    xmlCtxtUseOptions(parser, XML_PARSE_NONET | XML_PARSE_NOENT);
    if (how == STORED)
        parse_stored(r, parser, bytes, size);
    else
        parse_packed(r, parser, bytes, size);
    if (parser->myDoc)
        xmlFreeDoc(parser->myDoc);
    xmlFreeParserCtxt(parser);
}

/* --- the scene ------------------------------------------------------------------------------------------ */

static double unit_in_mm(const threemf_reader *r)
{
    static const struct {
        const char *name;
        double      mm;
    } units[] = {{"micron", 0.001}, {"millimeter", 1}, {"centimeter", 10},
                 {"inch", 25.4},    {"foot", 304.8},   {"meter", 1000}};
    warnings *list = &r->job->scene->warnings;
    for (size_t i = 0; r->unit && i < sizeof units / sizeof *units; i++)
        if (strcmp(r->unit, units[i].name) == 0)
            return units[i].mm;
    if (!r->found)
        warnings_add(list, WARNING_BAD_VALUE, "the unit of the 3MF file cannot be read; it is taken for millimetres");
    else if (r->unit) /* a file without one is in millimetres */
        warnings_add(list, WARNING_BAD_VALUE,
                     "the unit is '%.40s', which 3MF does not have; it is taken for millimetres", r->unit);
    return 1;
}

static void set_unit(threemf_reader *r)
{
    lmn_scene   *scene = r->job->scene;
    const double mm = unit_in_mm(r);
    for (size_t i = 0; i < scene->node_count && mm != 1 && r->status == LMN_OK; i++) {
        mat4 place = node_local_matrix(&scene->nodes[i]);
        if (scene->nodes[i].parent != NONE)
            continue;
        for (int k = 0; k < 16; k++)
            place.m[k] *= k % 4 < 3 ? mm : 1;
        if (!node_set_matrix(&scene->nodes[i], &place))
            r->status = error_memory(r->error);
    }
    for (size_t i = 0; i < scene->node_count && r->unit && r->status == LMN_OK; i++)
        if (scene->nodes[i].mesh != NONE && !build_attribute(&scene->nodes[i], "file-unit", r->unit))
            r->status = error_memory(r->error);
}

static int compare_names(const void *a, const void *b)
{
    uint32_t one = ((const object_name *)a)->id, other = ((const object_name *)b)->id;
    return one < other ? -1 : one > other;
}

/* Assimp calls objects by their numbers: "Object_7". */
static void set_name(threemf_reader *r, char **name)
{
    static const char head[] = "Object_";
    object_name       key = {0};
    if (!*name || strncmp(*name, head, sizeof head - 1) != 0 || !is_number(*name + sizeof head - 1, &key.id))
        return;
    const object_name *found =
        r->name_count ? bsearch(&key, r->names, r->name_count, sizeof *r->names, compare_names) : NULL;
    char *copy = found ? mem_copy_text(found->name) : NULL;
    if (found && !copy)
        r->status = error_memory(r->error);
    if (!copy)
        return;
    mem_free(*name);
    *name = copy;
}

lmn_status threemf_describe(const import_job *job, lmn_error *error)
{
    threemf_reader r = {.job = job, .error = error, .status = LMN_OK};
    read_model(&r);
    if (r.status == LMN_OK)
        set_unit(&r);
    if (r.name_count)
        qsort(r.names, r.name_count, sizeof *r.names, compare_names);
    for (size_t i = 0; i < job->scene->node_count && r.status == LMN_OK; i++)
        set_name(&r, &job->scene->nodes[i].name);
    for (size_t i = 0; i < job->scene->mesh_count && r.status == LMN_OK; i++)
        set_name(&r, &job->scene->meshes[i].name);
    for (size_t i = 0; i < r.name_count; i++)
        mem_free(r.names[i].name);
    mem_free(r.names);
    mem_free(r.unit);
    return r.status;
}
