/* CityGML 1.0, 2.0 and 3.0 (OGC 08-007, 12-019, 20-010), parsed by libxml2 as it comes. There is no handler for
 * declarations of entities, so that a file that makes itself large by them is refused: its entities are not known. */
#define _GNU_SOURCE /* memmem */
#include "import/citygml.h"

#include <libxml/parser.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"

lmn_status citygml_fail(citygml_reader *r, lmn_status status, const char *format, ...)
{
    if (r->status != LMN_OK)
        return r->status;
    char    message[300];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    r->status = error_in_file(r->error, status, r->job->path, 0, "%s", message);
    return r->status;
}

bool citygml_no_memory(citygml_reader *r)
{
    if (r->status == LMN_OK)
        r->status = error_memory(r->error);
    return false;
}

static void on_start(void *user, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri, int namespace_count,
                     const xmlChar **namespaces, int attribute_count, int defaulted, const xmlChar **attributes)
{
    (void)prefix;
    (void)uri;
    (void)namespace_count;
    (void)namespaces;
    (void)defaulted;
    citygml_open_element(user, (const char *)name, attribute_count, attributes);
}

static void on_end(void *user, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri)
{
    (void)name;
    (void)prefix;
    (void)uri;
    citygml_close_element(user);
}

static void on_text(void *user, const xmlChar *bytes, int size)
{
    citygml_characters(user, (const char *)bytes, (size_t)size);
}

/* Nothing is printed; the first error stays in the parser's context. */
static void on_error(void *user, const xmlError *error)
{
    (void)user;
    (void)error;
}

static void tell_error(citygml_reader *r, xmlParserCtxtPtr parser)
{
    const xmlError *e = xmlCtxtGetLastError(parser);
    char            message[200] = "it ends too early";
    int             line = e ? e->line : 0;
    if (r->status != LMN_OK)
        return;
    if (e && e->code == XML_ERR_NO_MEMORY) {
        citygml_no_memory(r);
        return;
    }
    if (e && e->message)
        snprintf(message, sizeof message, "%s", e->message);
    message[strcspn(message, "\n")] = '\0';
    r->status = error_in_file(r->error, LMN_FORMAT, r->job->path, line, "this is no sound XML: %s", message);
    if (r->error)
        error_hint(r->error, "it was cut off or damaged, or uses entities, which are not read");
}

static void parse(citygml_reader *r)
{
    enum { STEP = 1 << 16 };
    const char      *bytes = (const char *)r->job->file->data;
    size_t           size = r->job->file->size;
    xmlSAXHandler    sax = {.initialized = XML_SAX2_MAGIC,
                            .startElementNs = on_start,
                            .endElementNs = on_end,
                            .characters = on_text,
                            .cdataBlock = on_text,
                            .serror = (xmlStructuredErrorFunc)(void (*)(void))on_error};
    xmlParserCtxtPtr parser = xmlCreatePushParserCtxt(&sax, r, NULL, 0, NULL);
    if (!parser) {
        citygml_no_memory(r);
        return;
    }
    xmlCtxtUseOptions(parser, XML_PARSE_NONET);
    for (size_t at = 0; at < size && r->status == LMN_OK; at += STEP) {
        size_t step = size - at < STEP ? size - at : STEP;
        if (xmlParseChunk(parser, bytes + at, (int)step, 0) != 0)
            tell_error(r, parser);
        if (r->status == LMN_OK && at / STEP % 16 == 15)
            r->status = import_progress(r->job, 0.6 * (double)at / (double)size, "reading", r->error);
    }
    if (r->status == LMN_OK && (xmlParseChunk(parser, NULL, 0, 1) != 0 || !parser->wellFormed))
        tell_error(r, parser);
    if (r->status == LMN_OK && !memmem(bytes, size < 65536 ? size : 65536, "CityModel", 9))
        snprintf(r->builder.cause, sizeof r->builder.cause, "it is XML, but no CityModel");
    if (parser->myDoc)
        xmlFreeDoc(parser->myDoc);
    xmlFreeParserCtxt(parser);
}

static void release(citygml_reader *r)
{
    for (size_t i = 0; i < r->objects_count; i++) {
        gml_object *o = &r->objects[i];
        for (size_t k = 0; k < o->attribute_count; k++)
            attribute_release(&o->attributes[k]);
        mem_free(o->attributes);
        mem_free(o->id);
    }
    mem_free(r->points);
    mem_free(r->template_points);
    mem_free(r->borrowed);
    mem_free(r->rings);
    mem_free(r->polygons);
    mem_free(r->ranges);
    mem_free(r->references);
    mem_free(r->instances);
    mem_free(r->objects);
    mem_free(r->paints);
    mem_free(r->places);
    mem_free(r->uvs);
    text_release(&r->words);
    mem_free(r);
}

static lmn_status read_citygml(const import_job *job, lmn_error *error)
{
    citygml_reader *r = mem_calloc(1, sizeof *r);
    double          wish;
    if (!r)
        return error_memory(error);
    r->job = job;
    r->scene = job->scene;
    r->error = error;
    r->object = r->template_index = r->material = NONE;
    r->dimension = 3;
    r->wish =
        job->desc && job->desc->lod && text_is_double(job->desc->lod, &wish) ? (int)fmin(wish, GML_LODS) : GML_LODS;
    r->status = city_builder_open(&r->builder, job, error);
    if (r->status == LMN_OK)
        parse(r);
    if (r->status == LMN_OK)
        citygml_build(r);
    lmn_status status = city_builder_close(&r->builder, r->status);
    release(r);
    return status;
}

/* XML whose root is a city model: the word stands near the beginning. */
static bool recognises(const file_data *file)
{
    const char *at = (const char *)file->data;
    size_t      size = file->size < 65536 ? file->size : 65536;
    if (size >= 3 && memcmp(at, "\xEF\xBB\xBF", 3) == 0) {
        at += 3;
        size -= 3;
    }
    while (size && strchr(" \t\r\n", *at) && *at) {
        at++;
        size--;
    }
    return size > 16 && *at == '<' && memmem(at, size, "CityModel", 9) && memmem(at, size, "citygml", 7);
}

const import_format import_citygml = {
    .name = "CityGML",
    .endings = ".gml .xml .citygml",
    .up = 'z',
    .recognises = recognises,
    .read = read_citygml,
};
