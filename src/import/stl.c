/* STL, binary and text. Facet normals are not used: they split shared edges, and many files have wrong ones.
 * Corners are welded by position instead, so that edges are found. */
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/threads.h"
#include "import/build.h"
#include "import/import.h"
#include "scene/mesh.h"

enum { HEADER_BYTES = 84, NAME_BYTES = 80, FACET_BYTES = 50, NORMAL_BYTES = 12, CORNER_BYTES = 36 };
enum { LOOK_AHEAD = 4096, FACETS_PER_THREAD = 65536 };

static uint32_t read_u32(const unsigned char *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

/* Does the word stand at `at` (any case), ending there? */
static bool is_word(const char *at, const char *end, const char *word)
{
    size_t length = strlen(word);
    if ((size_t)(end - at) < length)
        return false;
    for (size_t i = 0; i < length; i++)
        if ((at[i] | 0x20) != word[i])
            return false;
    return at + length == end || is_blank(at[length]);
}

static bool has_binary_size(const file_data *file)
{
    return file->size >= HEADER_BYTES &&
           (uint64_t)file->size == HEADER_BYTES + (uint64_t)read_u32(file->data + NAME_BYTES) * FACET_BYTES;
}

/* Text starts with "solid", and so do many binary files; the words that must follow decide. */
static bool is_text(const file_data *file)
{
    const char *at = (const char *)file->data, *end = at + file->size;
    if (file->size >= 3 && memcmp(at, "\xEF\xBB\xBF", 3) == 0)
        at += 3;
    while (at < end && is_blank(*at))
        at++;
    if (!is_word(at, end, "solid"))
        return false;
    if (end - at > LOOK_AHEAD)
        end = at + LOOK_AHEAD;
    if (memchr(at, 0, (size_t)(end - at)))
        return false;
    for (at += 5; at < end; at++)
        if (is_blank(at[-1]) && (is_word(at, end, "facet") || is_word(at, end, "endsolid")))
            return true;
    return false;
}

/* Binary headers hold text too, but the count behind them is small against four letters. */
static bool looks_like_words(const file_data *file)
{
    for (size_t i = 0; i < HEADER_BYTES; i++)
        if (file->data[i] < 0x20 && !is_blank((char)file->data[i]))
            return false;
    return true;
}

static bool recognises(const file_data *file)
{
    return has_binary_size(file) || is_text(file);
}

/* --- binary --------------------------------------------------------------------------------------------- */

typedef struct copy_job {
    const unsigned char *facets;
    vec3                *positions;
} copy_job;

static void copy_facets(size_t begin, size_t end, void *user)
{
    const copy_job *job = user;
    for (size_t i = begin; i < end; i++)
        memcpy(job->positions + 3 * i, job->facets + i * FACET_BYTES + NORMAL_BYTES, CORNER_BYTES);
}

/* The header is free text; after "solid" it is a name, else it mostly tells the exporter and becomes an attribute. */
static lmn_status use_header(const import_job *job, lmn_error *error)
{
    const char *header = (const char *)job->file->data;
    size_t      length = 0;
    while (length < NAME_BYTES && header[length])
        length++;
    while (length > 0 && is_blank(header[length - 1]))
        length--;
    bool   named = length > 6 && is_word(header, header + length, "solid");
    size_t skip = named ? 6 : 0;
    if (length == 0)
        return LMN_OK;
    char *words = scene_clean_name(header + skip, length - skip);
    if (!words)
        return error_memory(error);
    node *n = &job->scene->nodes[job->scene->node_count - 1];
    if (named) {
        n->name = words;
        return LMN_OK;
    }
    bool good = build_attribute(n, "header", words);
    mem_free(words);
    return good ? LMN_OK : error_memory(error);
}

static lmn_status add_welded(const import_job *job, primitive *p, const char *name, lmn_error *error)
{
    lmn_status status = import_progress(job, 0.4, "welding", error);
    if (status == LMN_OK)
        status = mesh_weld_positions(p, error);
    if (status != LMN_OK) {
        primitive_release(p);
        return status;
    }
    return build_part(job->scene, p, name, error);
}

static lmn_status read_binary(const import_job *job, lmn_error *error)
{
    const file_data *file = job->file;
    size_t           count = read_u32(file->data + NAME_BYTES);
    uint64_t         wanted = HEADER_BYTES + (uint64_t)count * FACET_BYTES;
    if (wanted > file->size) {
        error_in_file(
            error, LMN_FORMAT, job->path, 0,
            "the file is cut off: its header (byte 80) promises %zu triangles, which take %llu bytes; the file "
            "has %zu",
            count, (unsigned long long)wanted, file->size);
        error_hint(error, "copy or export the file again");
        return LMN_FORMAT;
    }
    if (wanted < file->size)
        warnings_add(&job->scene->warnings, WARNING_IGNORED, "%llu bytes behind the last triangle",
                     (unsigned long long)(file->size - wanted));
    if (count > LIMIT_TRIANGLES || count > LIMIT_VERTICES / 3)
        return error_in_file(error, LMN_LIMIT, job->path, 0,
                             "%zu triangles are more than the %zu that are read from STL", count, LIMIT_VERTICES / 3);
    primitive p = {.vertex_count = (uint32_t)(count * 3)};
    p.positions = mem_alloc(count * CORNER_BYTES);
    if (!p.positions)
        return error_memory(error);
    copy_job copy = {file->data + HEADER_BYTES, p.positions};
    threads_for(count, FACETS_PER_THREAD, copy_facets, &copy);
    p.material = build_plain_material(job->scene, false);
    if (p.material == NONE) {
        primitive_release(&p);
        return error_memory(error);
    }
    lmn_status status = add_welded(job, &p, NULL, error);
    return status == LMN_OK ? use_header(job, error) : status;
}

/* --- text ----------------------------------------------------------------------------------------------- */

typedef struct text_reader {
    const import_job *job;
    const char       *begin, *at, *end;
    vec3             *positions; /* of the current solid */
    size_t            count, capacity, total;
    char             *name;
    int32_t           material;
    lmn_error        *error;
} text_reader;

static void skip_blanks(text_reader *r)
{
    while (r->at < r->end && is_blank(*r->at))
        r->at++;
}

static bool take(text_reader *r, const char *word)
{
    skip_blanks(r);
    if (!is_word(r->at, r->end, word))
        return false;
    r->at += strlen(word);
    return true;
}

static lmn_status wrong(text_reader *r, const char *expected)
{
    skip_blanks(r);
    int line = build_line(r->begin, r->at);
    if (r->at == r->end) {
        error_in_file(r->error, LMN_FORMAT, r->job->path, line, "the file is cut off: expected %s", expected);
        error_hint(r->error, "copy or export the file again");
        return LMN_FORMAT;
    }
    int length = 0;
    while (length < 24 && r->at + length < r->end && !is_blank(r->at[length]))
        length++;
    char *found = scene_clean_name(r->at, (size_t)length);
    error_in_file(r->error, LMN_FORMAT, r->job->path, line, "expected %s, found \"%s\"", expected, found ? found : "");
    mem_free(found);
    return LMN_FORMAT;
}

static bool take_numbers(text_reader *r, vec3 *out)
{
    double value[3];
    for (int i = 0; i < 3; i++) {
        skip_blanks(r);
        const char *next = text_parse_double(r->at, r->end, &value[i]);
        if (!next || (next < r->end && !is_blank(*next)))
            return false;
        r->at = next;
    }
    *out = (vec3){(float)value[0], (float)value[1], (float)value[2]};
    return true;
}

static lmn_status add_corner(text_reader *r, vec3 p)
{
    if (r->total >= LIMIT_VERTICES)
        return error_in_file(r->error, LMN_LIMIT, r->job->path, build_line(r->begin, r->at), "more than %zu corners",
                             LIMIT_VERTICES);
    if (!mem_grow((void **)&r->positions, &r->capacity, r->count + 1, sizeof *r->positions))
        return error_memory(r->error);
    r->positions[r->count++] = p;
    r->total++;
    return LMN_OK;
}

/* "facet normal x y z outer loop vertex … endloop endfacet"; more than three corners are a fan. */
static lmn_status read_facet(text_reader *r)
{
    vec3 normal, first, previous, corner;
    if (take(r, "normal") && !take_numbers(r, &normal))
        return wrong(r, "three numbers after \"normal\"");
    if (!take(r, "outer") || !take(r, "loop"))
        return wrong(r, "\"outer loop\"");
    int corners = 0;
    while (take(r, "vertex")) {
        if (!take_numbers(r, &corner))
            return wrong(r, "three numbers after \"vertex\"");
        if (corners >= LIMIT_POLYGON_CORNERS)
            return error_in_file(r->error, LMN_LIMIT, r->job->path, build_line(r->begin, r->at),
                                 "a facet with more than %d corners", LIMIT_POLYGON_CORNERS);
        if (corners == 0)
            first = corner;
        lmn_status status = LMN_OK;
        if (corners >= 3) {
            status = add_corner(r, first);
            if (status == LMN_OK)
                status = add_corner(r, previous);
        }
        if (status == LMN_OK)
            status = add_corner(r, corner);
        if (status != LMN_OK)
            return status;
        previous = corner;
        corners++;
    }
    if (corners < 3)
        return wrong(r, "three \"vertex\" lines in a facet");
    if (!take(r, "endloop"))
        return wrong(r, "\"endloop\"");
    return take(r, "endfacet") ? LMN_OK : wrong(r, "\"endfacet\"");
}

static lmn_status end_solid(text_reader *r)
{
    lmn_status status = LMN_OK;
    if (r->count > 0) {
        primitive p = {.vertex_count = (uint32_t)r->count, .positions = r->positions, .material = r->material};
        r->positions = NULL;
        r->count = r->capacity = 0;
        status = add_welded(r->job, &p, r->name, r->error);
    }
    mem_free(r->name);
    r->name = NULL;
    return status;
}

static const char *line_end(const text_reader *r)
{
    const char *end = r->at;
    while (end < r->end && *end != '\n' && *end != '\r')
        end++;
    return end;
}

/* What stands on the line after "solid". Some writers put the first facet on the same line. */
static lmn_status read_name(text_reader *r)
{
    const char *end = line_end(r), *from = r->at;
    for (const char *p = from; p < end; p++)
        if (is_blank(p[-1]) && is_word(p, r->end, "facet") && (end - p) > 12)
            end = p;
    r->at = end;
    while (from < end && is_blank(*from))
        from++;
    while (from < end && is_blank(end[-1]))
        end--;
    if (from == end)
        return LMN_OK;
    r->name = scene_clean_name(from, (size_t)(end - from));
    return r->name ? LMN_OK : error_memory(r->error);
}

static lmn_status read_solid(text_reader *r)
{
    lmn_status status = read_name(r);
    size_t     facets = 0;
    while (status == LMN_OK && take(r, "facet")) {
        status = read_facet(r);
        if (status == LMN_OK && (++facets & 0xFFFF) == 0)
            status = import_progress(r->job, 0.4 * (double)(r->at - r->begin) / (double)(r->end - r->begin), "reading",
                                     r->error);
    }
    if (status != LMN_OK)
        return status;
    if (!take(r, "endsolid"))
        return wrong(r, "\"facet\" or \"endsolid\"");
    r->at = line_end(r);
    return end_solid(r);
}

static lmn_status read_text(const import_job *job, lmn_error *error)
{
    const char *begin = (const char *)job->file->data;
    text_reader r = {.job = job, .begin = begin, .at = begin, .end = begin + job->file->size, .error = error};
    if (job->file->size >= 3 && memcmp(begin, "\xEF\xBB\xBF", 3) == 0)
        r.at += 3;
    r.material = build_plain_material(job->scene, false);
    lmn_status status = r.material == NONE ? error_memory(error) : LMN_OK;
    while (status == LMN_OK && take(&r, "solid"))
        status = read_solid(&r);
    skip_blanks(&r);
    while (r.at < r.end && *r.at == '\0')
        r.at++;
    if (status == LMN_OK && r.at < r.end)
        status = wrong(&r, "\"solid\" or the end of the file");
    mem_free(r.positions);
    mem_free(r.name);
    return status;
}

static lmn_status read_stl(const import_job *job, lmn_error *error)
{
    if (has_binary_size(job->file))
        return read_binary(job, error);
    const char *bytes = (const char *)job->file->data;
    if (is_text(job->file))
        return read_text(job, error);
    if (job->file->size >= HEADER_BYTES && !looks_like_words(job->file))
        return read_binary(job, error);
    if (job->file->size >= 5 && is_word(bytes, bytes + job->file->size, "solid"))
        error_in_file(error, LMN_FORMAT, job->path, 0,
                      "the file is cut off: text STL without \"facet\" or \"endsolid\"");
    else if (job->file->size >= HEADER_BYTES)
        error_in_file(error, LMN_FORMAT, job->path, 1, "this is not STL: text that does not begin with \"solid\"");
    else
        error_in_file(error, LMN_FORMAT, job->path, 0, "the file has only %zu bytes, no STL is that short",
                      job->file->size);
    error_hint(error, "check the ending, or copy or export the file again");
    return LMN_FORMAT;
}

const import_format import_stl = {"STL", ".stl", 'z', false, recognises, read_stl};
