#define _GNU_SOURCE /* memmem */
/* CityJSON 1.0 to 2.0 (cityjson.org/specs), whole files and sequences of features (one a line). The text is scanned
 * where it lies (json_scan.h): most of it are vertices and their numbers, for which a tree of values would take many
 * times the memory and the time. */
#include "import/cityjson.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/build.h"

/* --- errors --------------------------------------------------------------------------------------------- */

lmn_status cityjson_fail(cityjson_reader *r, lmn_status status, const char *at, const char *format, ...)
{
    if (r->status != LMN_OK)
        return r->status;
    char    message[300];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    const char *from = (const char *)r->job->file->data;
    int         line = at ? build_line(from, at) : 0, column = 0;
    for (const char *back = at; back && (back == from || back[-1] != '\n') && column < 1000000; column++)
        if (back-- == from)
            break;
    r->status = error_in_file(r->error, status, r->job->path, line, "%s", message);
    if (r->error && at)
        r->error->column = column + 1;
    return r->status;
}

bool cityjson_good(cityjson_reader *r, const json_scan *s)
{
    if (s->wrong && r->status == LMN_OK) {
        cityjson_fail(r, LMN_FORMAT, s->wrong_at, "%s", s->wrong);
        error_hint(r->error, "the file is no JSON from there on, or was cut off; export or download it again");
    }
    return r->status == LMN_OK;
}

bool cityjson_no_memory(cityjson_reader *r)
{
    if (r->status == LMN_OK)
        r->status = error_memory(r->error);
    return false;
}

cityjson_span cityjson_pack(const cityjson_reader *r, json_span span)
{
    const char *from = (const char *)r->job->file->data;
    return span.at ? (cityjson_span){(uint32_t)(span.at - from), (uint32_t)span.size} : (cityjson_span){0, 0};
}

json_span cityjson_unpack(const cityjson_reader *r, cityjson_span span)
{
    const char *from = (const char *)r->job->file->data;
    return span.at ? (json_span){from + span.at, span.size} : (json_span){NULL, 0};
}

/* --- a document ----------------------------------------------------------------------------------------- */

static void scan_document(cityjson_reader *r, json_scan *s, cityjson_document *d)
{
    *d = (cityjson_document){{0}};
    for (bool more = scan_open(s, '{'); more; more = scan_next(s, '}')) {
        json_span  key = scan_key(s);
        json_span *to = span_is(key, "transform")            ? &d->transform
                        : span_is(key, "metadata")           ? &d->metadata
                        : span_is(key, "CityObjects")        ? &d->objects
                        : span_is(key, "vertices")           ? &d->vertices
                        : span_is(key, "appearance")         ? &d->appearance
                        : span_is(key, "geometry-templates") ? &d->templates
                        : span_is(key, "extensions")         ? &d->extensions
                                                             : NULL;
        if (span_is(key, "type"))
            d->type = scan_string(s);
        else if (span_is(key, "version"))
            d->version = scan_string(s);
        else if (to)
            *to = scan_skip(s);
        else
            scan_skip(s);
    }
    cityjson_good(r, s);
}

static void read_numbers(cityjson_reader *r, json_scan *s, double out[3])
{
    int         k = 0;
    const char *at = s->at;
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']'), k++) {
        double value = 0;
        if (scan_number(s, &value) && k < 3)
            out[k] = value;
    }
    bool good = k == 3;
    for (int i = 0; i < 3; i++)
        good = good && isfinite(out[i]) && fabs(out[i]) <= 1e15;
    if (!s->wrong && !good)
        cityjson_fail(r, LMN_FORMAT, at, "'transform' needs three numbers each for 'scale' and 'translate'");
}

static void read_transform(cityjson_reader *r, json_span span)
{
    if (!span.at)
        return;
    json_scan s = scan_of(span);
    for (bool more = scan_open(&s, '{'); more && r->status == LMN_OK; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        if (span_is(key, "scale"))
            read_numbers(r, &s, r->scale);
        else if (span_is(key, "translate"))
            read_numbers(r, &s, r->translate);
        else
            scan_skip(&s);
    }
    if (r->scale[0] == 0 || r->scale[1] == 0)
        snprintf(r->builder.cause, sizeof r->builder.cause, "'scale' of its 'transform' is 0");
    cityjson_good(r, &s);
}

/* A text in version 1.1 and later, a URN or a number with "crs" in earlier ones. */
static void read_crs(cityjson_reader *r, json_span metadata)
{
    if (!metadata.at || metadata.at[0] != '{' || r->scene->city.crs)
        return;
    json_scan s = scan_of(metadata);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        if (!span_is(key, "referenceSystem") || scan_peek(&s) != '"') {
            scan_skip(&s);
            continue;
        }
        mem_free(r->scene->city.crs);
        r->scene->city.crs = span_decode(scan_string(&s));
    }
    cityjson_good(r, &s);
}

static void check_version(cityjson_reader *r, const cityjson_document *d)
{
    double    version = 0;
    json_scan s = scan_of(d->version);
    if (!d->version.at || !scan_number(&s, &version) || version < 0.95 || version >= 3) {
        warnings_add(&r->scene->warnings, WARNING_APPROXIMATE,
                     "this file says that it is CityJSON %.*s; it is read as if it were 2.0",
                     (int)(d->version.size < 20 ? d->version.size : 20), d->version.at ? d->version.at : "?");
        if (d->version.at)
            snprintf(r->builder.cause, sizeof r->builder.cause,
                     "its version is '%.*s'; CityJSON 1.0, 1.1 and 2.0 are read",
                     (int)(d->version.size < 20 ? d->version.size : 20), d->version.at);
    }
}

/* Where vertices are behind the objects, as most writers have it, their text is a third of the file, and no longer
 * wanted once they are read. Nothing else may point into the file then. */
static void cut_vertices(cityjson_reader *r, cityjson_document *d)
{
    const char *from = (const char *)r->job->file->data;
    if (!d->vertices.at || !d->objects.at || d->vertices.at < d->objects.at || d->appearance.at || d->templates.at)
        return;
    const size_t objects = (size_t)(d->objects.at - from);
    file_data_cut(r->job->file, (size_t)(d->vertices.at - from));
    d->objects.at = (const char *)r->job->file->data + objects;
}

/* `whole`: the document is all that the file has. */
static void read_content(cityjson_reader *r, cityjson_document *d, bool whole)
{
    if (d->appearance.at) {
        cityjson_end_appearance(r);
        cityjson_read_appearance(r, d->appearance);
    }
    if (r->status == LMN_OK && d->templates.at && !r->templates)
        cityjson_read_templates(r, d->templates);
    if (r->status == LMN_OK && (d->vertices.at || !r->placed))
        cityjson_read_points(r, d->vertices, d->metadata);
    if (r->status == LMN_OK && whole)
        cut_vertices(r, d);
    if (r->status == LMN_OK && d->objects.at)
        cityjson_read_objects(r, d->objects);
}

static void read_model(cityjson_reader *r, json_scan *s)
{
    cityjson_document d;
    const char       *begin = s->at;
    scan_document(r, s, &d);
    if (r->status != LMN_OK)
        return;
    if (!span_is(d.type, "CityJSON")) {
        cityjson_fail(r, LMN_FORMAT, begin, "\"type\" of a CityJSON file has to be \"CityJSON\"");
        return;
    }
    if (!d.objects.at)
        cityjson_fail(r, LMN_FORMAT, begin, "'CityObjects' is missing");
    check_version(r, &d);
    read_transform(r, d.transform);
    read_crs(r, d.metadata);
    if (r->status == LMN_OK)
        r->status = import_progress(r->job, 0.1, "reading vertices", r->error);
    const bool whole = !scan_peek(s);
    if (r->status == LMN_OK)
        read_content(r, &d, whole);
    if (whole) /* the file may lie elsewhere now */
        *s = scan_of((json_span){"", 0});
}

/* The lines behind the model of a sequence. */
static void read_features(cityjson_reader *r, json_scan *s)
{
    const char *begin = s->at;
    for (size_t count = 0; scan_peek(s) && r->status == LMN_OK; count++) {
        cityjson_document d;
        const char       *line = s->at;
        scan_document(r, s, &d);
        if (r->status == LMN_OK && span_is(d.type, "CityJSONFeature"))
            read_content(r, &d, false);
        else if (r->status == LMN_OK)
            cityjson_fail(r, LMN_FORMAT, line, "behind the first line of a sequence come features (CityJSONFeature)");
        if (count % 256 == 255 && r->status == LMN_OK)
            r->status = import_progress(r->job, 0.1 + 0.7 * (double)(s->at - begin) / (double)(s->end - begin),
                                        "reading features", r->error);
    }
    cityjson_good(r, s);
}

static void tell_lods(cityjson_reader *r)
{
    for (size_t i = 0; i < r->lod_count; i++) {
        char name[16];
        snprintf(name, sizeof name, "%.3g", (double)r->lods[i]);
        for (char *c = name; *c; c++)
            *c = *c == ',' ? '.' : *c; /* the host's decimal point */
        city_add(&r->scene->city, CITY_LODS, r->lods[i] < 0 ? "none" : name, r->lod_counts[i]);
    }
}

static void release(cityjson_reader *r)
{
    cityjson_end_appearance(r);
    cityjson_end_templates(r);
    city_shape_release(&r->shape);
    mem_free(r->points);
    mem_free(r->objects);
    mem_free(r->geometries);
    mem_free(r->slots);
    mem_free(r->shell_ends);
    mem_free(r->solid_shells);
    mem_free(r->words);
    mem_free(r);
}

/* The API has checked that it is a number. */
static float wish_of(const char *lod)
{
    double value;
    return text_is_double(lod, &value) ? (float)value : INFINITY;
}

static lmn_status read_cityjson(const import_job *job, lmn_error *error)
{
    cityjson_reader *r = mem_calloc(1, sizeof *r);
    if (!r)
        return error_memory(error);
    r->job = job;
    r->scene = job->scene;
    r->error = error;
    r->wish = INFINITY;
    if (job->desc && job->desc->lod)
        r->wish = wish_of(job->desc->lod);
    for (int k = 0; k < 3; k++)
        r->scale[k] = 1;
    r->status = city_builder_open(&r->builder, job, error);
    json_scan s = {.at = (const char *)job->file->data, .end = (const char *)job->file->data + job->file->size};
    if (job->file->size >= 3 && memcmp(s.at, "\xEF\xBB\xBF", 3) == 0)
        s.at += 3;
    if (r->status == LMN_OK)
        read_model(r, &s);
    if (r->status == LMN_OK)
        read_features(r, &s);
    if (r->status == LMN_OK)
        tell_lods(r);
    lmn_status status = city_builder_close(&r->builder, r->status);
    release(r);
    return status;
}

/* An object that holds the word: "type" may stand behind all objects. */
static bool recognises(const file_data *file)
{
    const char *at = (const char *)file->data, *end = at + file->size;
    if (end - at >= 3 && memcmp(at, "\xEF\xBB\xBF", 3) == 0)
        at += 3;
    while (at < end && (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t'))
        at++;
    if (at == end || *at != '{')
        return false;
    static const char word[] = "\"CityJSON\"", objects[] = "\"CityObjects\"";
    return memmem(at, (size_t)(end - at), objects, sizeof objects - 1) &&
           memmem(at, (size_t)(end - at), word, sizeof word - 1);
}

const import_format import_cityjson = {
    .name = "CityJSON",
    .endings = ".json .jsonl",
    .up = 'z',
    .recognises = recognises,
    .read = read_cityjson,
};
