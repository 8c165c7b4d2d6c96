/* Strokes from SVG drawings, which any drawing program writes, and back. Entities are not replaced, and nothing is
 * fetched. */
#include "stroke_texture/stroke_svg.h"

#include <limits.h>
#include <string.h>

#include <libxml/parser.h>
#include <libxml/tree.h>

#include "base/memory.h"

/* tolerance: of curves, fraction of the square. */
static const double curve_tolerance = 0.0008, dot_radius = 0.02, dot_written = 0.003;

enum { SVG_BYTES_MAX = 256 << 20, SVG_DEPTH_MAX = 200 };

typedef struct svg_box {
    double x0, y0, x1, y1;
} svg_box;

typedef struct svg_reader {
    const char    *name;
    strokes       *out;    /* NULL: only the bounds are wanted */
    svg_box        bounds; /* of all chords */
    svg_box        frame;  /* what becomes the square */
    double         side;   /* its longer side; 0: not known yet */
    const xmlNode *layers; /* whose groups are layers; NULL: all is layer 0 */
    int32_t        layer, next_layer;
    float          light, perspective; /* of the element, where it states them */
    bool           stated, all_stated;
    int            line;
    lmn_status     status;
    lmn_error     *error;
} svg_reader;

/* --- attributes --- */

static bool is_named(const xmlNode *node, const char *name)
{
    return node->type == XML_ELEMENT_NODE && strcmp((const char *)node->name, name) == 0;
}

static char *attribute(const xmlNode *node, const char *name)
{
    return (char *)xmlGetNoNsProp((xmlNode *)node, (const xmlChar *)name);
}

static void fail(svg_reader *r, lmn_status status, const char *what, const char *value)
{
    if (r->status != LMN_OK)
        return;
    r->status = status;
    if (status == LMN_MEMORY)
        error_memory(r->error);
    else if (status == LMN_LIMIT)
        strokes_too_many(r->name, r->line, r->error);
    else if (value)
        error_in_file(r->error, status, r->name, r->line, "%s is '%.60s'", what, value);
    else
        error_in_file(r->error, status, r->name, r->line, "%s", what);
}

typedef struct svg_unit {
    const char *name;
    double      factor; /* in user units, which are pixels of 1/96 inch */
} svg_unit;

/* A length; `whole` is what 100 % are. */
static bool parse_length(const char *text, double whole, double *out)
{
    static const svg_unit units[] = {{"", 1},           {"px", 1},  {"mm", 96 / 25.4}, {"cm", 96 / 2.54}, {"in", 96},
                                     {"pt", 96 / 72.0}, {"pc", 16}, {"em", 16},        {"ex", 8}};
    const char           *at = svg_skip_blanks(text), *end;
    if (!*at || !strchr("+-.0123456789", *at) || !(end = text_parse_double(at, at + strlen(at), out)) ||
        !isfinite(*out))
        return false;
    size_t length = strcspn(end, " \t\r\n");
    if (*svg_skip_blanks(end + length))
        return false;
    if (length == 1 && *end == '%') {
        *out *= whole / 100;
        return true;
    }
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strlen(units[i].name) == length && strncmp(end, units[i].name, length) == 0) {
            *out *= units[i].factor;
            return true;
        }
    return false;
}

static double length_of(svg_reader *r, const xmlNode *node, const char *name, double whole, double absent)
{
    char  *value = attribute(node, name);
    double out = absent;
    if (value && strcmp(value, "auto") != 0 && !parse_length(value, whole, &out))
        fail(r, LMN_FORMAT, name, value);
    xmlFree(value);
    return out;
}

static double x_of(svg_reader *r, const xmlNode *node, const char *name)
{
    return length_of(r, node, name, r->frame.x1 - r->frame.x0, 0);
}

static double y_of(svg_reader *r, const xmlNode *node, const char *name)
{
    return length_of(r, node, name, r->frame.y1 - r->frame.y0, 0);
}

/* Does a style, "a: b; c: d", say display: none? */
static bool style_hides(const char *style)
{
    for (const char *at = style; at && *at;) {
        at = svg_skip_blanks(at);
        if (strncmp(at, "display", 7) == 0) {
            const char *value = svg_skip_blanks(at + 7);
            if (*value == ':' && strncmp(svg_skip_blanks(value + 1), "none", 4) == 0)
                return true;
        }
        at = strchr(at, ';');
        at = at ? at + 1 : NULL;
    }
    return false;
}

static bool is_hidden(const xmlNode *node)
{
    char *display = attribute(node, "display"), *style = attribute(node, "style");
    bool  hidden = (display && strcmp(display, "none") == 0) || (style && style_hides(style));
    xmlFree(display);
    xmlFree(style);
    return hidden;
}

/* --- chords --- */

static void widen(svg_box *box, svg_point p)
{
    box->x0 = fmin(box->x0, p.x);
    box->y0 = fmin(box->y0, p.y);
    box->x1 = fmax(box->x1, p.x);
    box->y1 = fmax(box->y1, p.y);
}

static svg_point in_square(const svg_reader *r, svg_point p)
{
    return (svg_point){(p.x - r->frame.x0) / r->side, (r->frame.y1 - p.y) / r->side};
}

static bool add_chord(void *user, svg_point from, svg_point to)
{
    svg_reader *r = user;
    if (!r->out) {
        widen(&r->bounds, from);
        widen(&r->bounds, to);
        return true;
    }
    svg_point a = in_square(r, from), b = in_square(r, to);
    if (!(fmax(fmax(fabs(a.x), fabs(a.y)), fmax(fabs(b.x), fabs(b.y))) <= LIMIT_STROKE_REACH)) {
        fail(r, LMN_FORMAT, "a line is more than 16 times the drawing's size away from it", NULL);
        error_hint(r->error, "take away what lies far outside of the view box");
        return false;
    }
    texture_stroke s = {(float)a.x, (float)a.y, (float)b.x, (float)b.y, r->light, r->perspective, r->layer};
    if (r->out->count >= LIMIT_STROKES)
        fail(r, LMN_LIMIT, NULL, NULL);
    else if (!strokes_add(r->out, s))
        fail(r, LMN_MEMORY, NULL, NULL);
    return r->status == LMN_OK;
}

static void draw_line(svg_reader *r, svg_pen *pen, const xmlNode *node)
{
    svg_move(pen, (svg_point){x_of(r, node, "x1"), y_of(r, node, "y1")});
    svg_line(pen, (svg_point){x_of(r, node, "x2"), y_of(r, node, "y2")});
}

static void draw_points(svg_reader *r, svg_pen *pen, const xmlNode *node, bool closed)
{
    char       *points = attribute(node, "points");
    const char *at = points ? svg_skip_blanks(points) : "";
    for (bool begun = false; *at && !pen->failed; begun = true) {
        svg_point   p;
        const char *behind = svg_number(at, &p.x);
        behind = behind ? svg_number(behind, &p.y) : NULL;
        if (!behind) {
            fail(r, LMN_FORMAT, "points: no pair of numbers", at);
            break;
        }
        at = behind;
        if (begun)
            svg_line(pen, p);
        else
            svg_move(pen, p);
    }
    if (closed && pen->drawn)
        svg_close(pen);
    xmlFree(points);
}

/* Is a box, without rotation, all that is drawn on? Then it is the paper. */
static bool is_paper(const svg_reader *r, const svg_pen *pen, svg_point from, svg_point to)
{
    svg_point a = svg_apply(&pen->transform, from), b = svg_apply(&pen->transform, to);
    double    near = 1e-6 * r->side;
    return r->side > 0 && fmin(a.x, b.x) <= r->frame.x0 + near && fmin(a.y, b.y) <= r->frame.y0 + near &&
           fmax(a.x, b.x) >= r->frame.x1 - near && fmax(a.y, b.y) >= r->frame.y1 - near;
}

static void draw_rectangle(svg_reader *r, svg_pen *pen, const xmlNode *node)
{
    double x = x_of(r, node, "x"), y = y_of(r, node, "y"), w = x_of(r, node, "width"), h = y_of(r, node, "height");
    double rx = length_of(r, node, "rx", w, -1), ry = length_of(r, node, "ry", h, -1);
    if (w <= 0 || h <= 0 || is_paper(r, pen, (svg_point){x, y}, (svg_point){x + w, y + h}))
        return;
    rx = fmin(fmax(rx < 0 ? ry : rx, 0), w / 2);
    ry = fmin(fmax(ry < 0 ? rx : ry, 0), h / 2);
    bool round = rx > 0 && ry > 0;
    if (!round)
        rx = ry = 0;
    const svg_point sides[4][2] = {{{x + rx, y}, {x + w - rx, y}},
                                   {{x + w, y + ry}, {x + w, y + h - ry}},
                                   {{x + w - rx, y + h}, {x + rx, y + h}},
                                   {{x, y + h - ry}, {x, y + ry}}};
    svg_move(pen, sides[0][0]);
    for (int i = 0; i < 4; i++) {
        svg_line(pen, sides[i][1]);
        if (round)
            svg_arc(pen, rx, ry, 0, false, true, sides[(i + 1) % 4][0]);
    }
}

static void draw_ellipse(svg_reader *r, svg_pen *pen, const xmlNode *node, bool circle)
{
    svg_point            m = {x_of(r, node, "cx"), y_of(r, node, "cy")};
    double               rx = x_of(r, node, circle ? "r" : "rx"), ry = circle ? rx : y_of(r, node, "ry");
    const svg_transform *t = &pen->transform;
    if (rx <= 0 || ry <= 0)
        return;
    if (circle && r->side > 0 && rx * sqrt(fabs(t->a * t->d - t->b * t->c)) < dot_radius * r->side) {
        svg_move(pen, m);
        svg_line(pen, m);
        return;
    }
    svg_move(pen, (svg_point){m.x + rx, m.y});
    svg_arc(pen, rx, ry, 0, false, true, (svg_point){m.x - rx, m.y});
    svg_arc(pen, rx, ry, 0, false, true, (svg_point){m.x + rx, m.y});
}

static void draw_path(svg_reader *r, svg_pen *pen, const xmlNode *node)
{
    char *d = attribute(node, "d");
    if (d && strcmp(d, "none") != 0 && !svg_path(pen, d))
        fail(r, LMN_FORMAT, "a path's data is wrong: d", d);
    xmlFree(d);
}

static bool stated_number(const xmlNode *node, const char *name, float *out)
{
    char  *value = attribute(node, name);
    double number;
    bool   good = value && text_is_double(value, &number) && isfinite((float)number);
    if (good)
        *out = (float)number;
    xmlFree(value);
    return good;
}

static void draw_element(svg_reader *r, const xmlNode *node, const svg_transform *transform)
{
    svg_pen pen = {.transform = *transform, .tolerance = curve_tolerance * r->side, .chord = add_chord, .user = r};
    r->light = r->perspective = 1;
    bool stated =
        stated_number(node, "data-light", &r->light) && stated_number(node, "data-perspective", &r->perspective);
    size_t before = r->out ? r->out->count : 0;
    if (is_named(node, "line"))
        draw_line(r, &pen, node);
    else if (is_named(node, "polyline") || is_named(node, "polygon"))
        draw_points(r, &pen, node, is_named(node, "polygon"));
    else if (is_named(node, "rect"))
        draw_rectangle(r, &pen, node);
    else if (is_named(node, "circle") || is_named(node, "ellipse"))
        draw_ellipse(r, &pen, node, is_named(node, "circle"));
    else if (is_named(node, "path"))
        draw_path(r, &pen, node);
    svg_finish(&pen);
    if (r->out && r->out->count > before && !stated)
        r->all_stated = false;
}

/* --- the tree --- */

static bool is_container(const xmlNode *node)
{
    static const char *const names[] = {"g", "a", "svg", "switch"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (is_named(node, names[i]))
            return true;
    return false;
}

/* The node whose groups are layers: going down while there is one group alone. */
static const xmlNode *layers_below(const xmlNode *node)
{
    for (int depth = 0; depth < SVG_DEPTH_MAX; depth++) {
        const xmlNode *group = NULL;
        int            count = 0;
        for (const xmlNode *child = node->children; child; child = child->next)
            if (is_named(child, "g") && !is_hidden(child)) {
                group = child;
                count++;
            }
        if (count != 1)
            return count ? node : NULL;
        node = group;
    }
    return NULL;
}

static svg_transform transform_of(svg_reader *r, const xmlNode *node, const svg_transform *outer)
{
    svg_transform own = svg_identity;
    char         *value = attribute(node, "transform");
    if (value && !svg_parse_transform(value, &own))
        fail(r, LMN_FORMAT, "transform", value);
    xmlFree(value);
    /* A drawing within the drawing; the outermost has no position. */
    if (is_named(node, "svg") && is_container(node->parent))
        own = svg_combine(own, (svg_transform){1, 0, 0, 1, x_of(r, node, "x"), y_of(r, node, "y")});
    return svg_combine(*outer, own);
}

static void walk(svg_reader *r, const xmlNode *node, const svg_transform *outer, int depth)
{
    r->line = (int)xmlGetLineNo((xmlNode *)node);
    if (is_hidden(node))
        return;
    if (depth > SVG_DEPTH_MAX) {
        fail(r, LMN_FORMAT, "groups are nested too deeply; allowed are 200 levels", NULL);
        return;
    }
    svg_transform t = transform_of(r, node, outer);
    if (!is_container(node)) {
        draw_element(r, node, &t);
        return;
    }
    for (const xmlNode *child = node->children; child && r->status == LMN_OK; child = child->next) {
        if (child->type != XML_ELEMENT_NODE)
            continue;
        if (node == r->layers && is_named(child, "g") && !is_hidden(child)) {
            if (r->next_layer >= LIMIT_STROKE_LAYERS) {
                fail(r, LMN_FORMAT, "there are more than 65536 groups, which are layers", NULL);
                return;
            }
            r->layer = r->next_layer++;
        }
        walk(r, child, &t, depth + 1);
    }
}

/* --- the drawing --- */

static bool read_view_box(svg_reader *r, const xmlNode *root)
{
    char       *text = attribute(root, "viewBox");
    double      n[4] = {0};
    const char *at = text ? svg_skip_blanks(text) : NULL;
    for (int i = 0; i < 4 && at; i++)
        at = svg_number(at, &n[i]);
    bool good = at && n[2] > 0 && n[3] > 0;
    if (text && !good)
        fail(r, LMN_FORMAT, "viewBox", text);
    xmlFree(text);
    if (good)
        r->frame = (svg_box){n[0], n[1], n[0] + n[2], n[1] + n[3]};
    return good;
}

static bool read_size(svg_reader *r, const xmlNode *root)
{
    char  *w = attribute(root, "width"), *h = attribute(root, "height");
    double width = 0, height = 0;
    bool   good = w && h && parse_length(w, 0, &width) && parse_length(h, 0, &height) && width > 0 && height > 0;
    xmlFree(w);
    xmlFree(h);
    if (good)
        r->frame = (svg_box){0, 0, width, height};
    return good;
}

/* Bounds of what is drawn, for drawings without a size. */
static void measure(svg_reader *r, const xmlNode *root)
{
    strokes *out = r->out;
    r->out = NULL;
    r->bounds = (svg_box){INFINITY, INFINITY, -INFINITY, -INFINITY};
    walk(r, root, &svg_identity, 0);
    r->out = out;
    r->frame = r->bounds;
    if (!(r->bounds.x0 <= r->bounds.x1)) /* nothing is there */
        r->frame = (svg_box){0, 0, 1, 1};
}

static void read_drawing(svg_reader *r, const xmlNode *root)
{
    r->line = root ? (int)xmlGetLineNo((xmlNode *)root) : 0;
    if (!root || !is_named(root, "svg")) {
        fail(r, LMN_FORMAT, "this is not an SVG drawing: its outermost element is not svg", NULL);
        return;
    }
    if (!read_view_box(r, root) && r->status == LMN_OK && !read_size(r, root))
        measure(r, root);
    r->side = fmax(r->frame.x1 - r->frame.x0, r->frame.y1 - r->frame.y0);
    if (!(r->side > 0))
        r->side = 1; /* one dot */
    if (!isfinite(r->side))
        fail(r, LMN_FORMAT, "the drawing has no finite size", NULL);
    r->layers = layers_below(root);
    r->layer = r->next_layer = 0;
    if (r->status == LMN_OK)
        walk(r, root, &svg_identity, 0);
}

static lmn_status refuse_xml(const char *name, const xmlError *why, lmn_error *error)
{
    char message[160] = "no well-formed XML";
    if (why && why->code == XML_ERR_NO_MEMORY)
        return error_memory(error);
    if (why && why->message) {
        size_t length = strcspn(why->message, "\r\n");
        snprintf(message, sizeof message, "%.*s", (int)(length < 150 ? length : 150), why->message);
    }
    error_in_file(error, LMN_FORMAT, name, why ? why->line : 0, "this is not well-formed SVG: %s", message);
    error_hint(error, "save it again as plain SVG, without entities");
    return LMN_FORMAT;
}

lmn_status strokes_read_svg(strokes *out, const char *name, const char *bytes, size_t size, lmn_error *error)
{
    *out = (strokes){.width = 1};
    if (size > SVG_BYTES_MAX)
        return error_in_file(error, LMN_LIMIT, name, 0, "the drawing is larger than 256 MiB");
    xmlParserCtxt *context = xmlNewParserCtxt();
    if (!context)
        return error_memory(error);
    int        options = XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING | XML_PARSE_BIG_LINES;
    xmlDoc    *document = size ? xmlCtxtReadMemory(context, bytes, (int)size, NULL, NULL, options) : NULL;
    svg_reader r = {.name = name, .out = out, .all_stated = true, .error = error};
    if (document)
        read_drawing(&r, xmlDocGetRootElement(document));
    else
        r.status = refuse_xml(name, size ? xmlCtxtGetLastError(context) : NULL, error);
    xmlFreeDoc(document);
    xmlFreeParserCtxt(context);
    if (r.status == LMN_OK && !r.all_stated)
        r.status = strokes_set_light(out, ORDER_DRAWN, FRACTION_COUNT, 0, 0, error);
    if (r.status == LMN_OK && !r.all_stated)
        r.status = strokes_set_perspective(out, PERSPECTIVE_TIED, 0, error);
    if (r.status == LMN_OK)
        strokes_wrap(out);
    else
        strokes_release(out);
    return r.status;
}

/* --- writing --- */

static void write_attribute(text *out, const char *name, float value)
{
    text_append(out, " %s=\"", name);
    stroke_write_number(out, value);
    text_append(out, "\"");
}

static void write_point(text *out, const char *between, double u, double v)
{
    text_append(out, "%s", between);
    stroke_write_number(out, (float)u);
    text_append(out, ",");
    stroke_write_number(out, (float)(1 - v));
}

static bool same_priorities(const texture_stroke *a, const texture_stroke *b)
{
    return a->light == b->light && a->perspective == b->perspective;
}

/* A stroke, or the curve that begins with it. Returns how many strokes that are. */
static size_t write_line(text *out, const strokes *s, size_t first)
{
    const texture_stroke *t = &s->items[first];
    size_t                count = 1;
    if (t->u0 == t->u1 && t->v0 == t->v1) {
        text_append(out, "<circle");
        write_attribute(out, "cx", t->u0);
        write_attribute(out, "cy", (float)(1 - (double)t->v0));
        write_attribute(out, "r", (float)dot_written);
        text_append(out, " fill=\"black\" stroke=\"none\"");
    } else {
        double u = (double)t->u1, v = (double)t->v1;
        text_append(out, "<polyline points=\"");
        write_point(out, "", (double)t->u0, (double)t->v0);
        write_point(out, " ", u, v);
        for (; first + count < s->count; count++) {
            const texture_stroke *next = &t[count];
            if (!stroke_goes_on(next - 1, next) || !same_priorities(t, next))
                break;
            u += (double)next->u1 - (double)next->u0;
            v += (double)next->v1 - (double)next->v0;
            write_point(out, " ", u, v);
        }
        text_append(out, "\"");
    }
    write_attribute(out, "data-light", t->light);
    write_attribute(out, "data-perspective", t->perspective);
    text_append(out, "/>\n");
    return count;
}

/* Indices of strokes by layer, within it as they are. NULL: memory is gone. */
static size_t *sort_by_layer(const strokes *s, size_t *starts, int32_t layers)
{
    size_t *order = mem_calloc(s->count, sizeof *order);
    for (size_t i = 0; i < s->count; i++)
        starts[s->items[i].layer + 1]++;
    for (int32_t k = 0; k < layers; k++)
        starts[k + 1] += starts[k];
    for (size_t i = s->count; order && i > 0; i--)
        order[--starts[s->items[i - 1].layer + 1]] = i - 1;
    return order;
}

/* starts[k + 1] is where layer k begins in `order`. */
static void write_layers(text *out, const strokes *s, const size_t *order, const size_t *starts, int32_t layers)
{
    for (int32_t layer = 0; layer < layers; layer++) {
        size_t end = layer + 1 < layers ? starts[layer + 2] : s->count;
        text_append(out, "<g id=\"layer-%d\">\n", (int)layer);
        for (size_t i = starts[layer + 1]; i < end;)
            i += write_line(out, s, order[i]);
        text_append(out, "</g>\n");
    }
}

void strokes_write_svg(text *out, const strokes *s)
{
    int32_t layers = strokes_layer_count(s);
    size_t *starts = mem_calloc((size_t)layers + 2, sizeof *starts);
    size_t *order = starts ? sort_by_layer(s, starts, layers) : NULL;
    text_append(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1024\" height=\"1024\" viewBox=\"0 0 1 1\">\n"
        "<style>g{fill:none;stroke:black;stroke-width:0.006;stroke-linecap:round;stroke-linejoin:round}</style>\n");
    if (order)
        write_layers(out, s, order, starts, layers);
    else
        out->failed = true;
    text_append(out, "</svg>\n");
    mem_free(starts);
    mem_free(order);
}
