/* Entities of DXF. What a path is made of decides: a line is LINE, an arc ARC or CIRCLE, of an ellipse ELLIPSE; lines
 * and arcs of circles in a row are an LWPOLYLINE, which has bulges, and cubics a SPLINE. Dots are CIRCLE, texts TEXT;
 * areas are their borders, and pictures have no place in it. y is up here, and arcs run anticlockwise. */
#include <math.h>
#include <string.h>

#include "export/dxf_private.h"
#include "sheet/fit.h"

#define PI 3.14159265358979323846

/* Hundredths of a millimetre: the widths of lines that there are. */
static const int line_weights[] = {0,  5,  9,  13, 15, 18,  20,  25,  30,  35,  40,  50,
                                   53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211};

static int line_weight(double width)
{
    int best = 0;
    for (size_t i = 1; i < sizeof line_weights / sizeof *line_weights; i++)
        if (fabs(line_weights[i] - 100 * width) < fabs(line_weights[best] - 100 * width))
            best = (int)i;
    return line_weights[best];
}

static bool has_weight(const sheet_item *item, const sheet_path *path)
{
    return item->kind == SHEET_PATH && !path->filled;
}

int dxf_weight_of(const sheet *s, const sheet_item *item)
{
    if (item->hatch.apart > 0)
        return line_weight(item->hatch.width);
    for (uint32_t k = 0; k < item->count; k++)
        if (has_weight(item, &s->paths[item->first + k]))
            return line_weight((double)s->paths[item->first + k].width);
    return DXF_NO_WEIGHT;
}

/* `path`: NULL for texts. What an entity does not say is its layer's. */
static void begin_entity(dxf_writer *w, const char *type, const sheet_item *item, const sheet_path *path,
                         const char *class_name)
{
    const dxf_layer *layer = dxf_layer_of(w, item);
    int              ink = dxf_palette_index(item->ink);
    uint32_t         line_type = path ? w->line_type_of[path - w->s->paths] : 0;
    dxf_put(w, 0, type);
    dxf_put_handle(w, 5, ++w->handle);
    dxf_put_handle(w, 330, DXF_MODEL_SPACE);
    dxf_put(w, 100, "AcDbEntity");
    dxf_put(w, 8, layer->name);
    if (line_type) {
        char name[DXF_NAME_CAPACITY];
        dxf_put(w, 6, dxf_line_type_name(w, line_type - 1, name));
    }
    if (ink != layer->ink)
        dxf_put_whole(w, 62, ink);
    if (line_type) {
        double stretched = dxf_pattern_of(w->s, path).lengths[0] / w->line_types[line_type - 1].lengths[0];
        if (fabs(stretched - 1) >= 5e-5)
            dxf_put_number(w, 48, stretched);
    }
    if (path && has_weight(item, path) && line_weight((double)path->width) != layer->weight)
        dxf_put_whole(w, 370, line_weight((double)path->width));
    dxf_put(w, 100, class_name);
}

static void put_line(dxf_writer *w, const sheet_item *item, const sheet_path *path, const double a[2],
                     const double b[2])
{
    begin_entity(w, "LINE", item, path, "AcDbLine");
    dxf_put_position(w, 10, a[0], a[1]);
    dxf_put_position(w, 11, b[0], b[1]);
}

/* An angle in degrees, 0 … 360. */
static double degrees(double angle)
{
    double turned = fmod(angle * (180 / PI), 360);
    return turned < 0 ? turned + 360 : turned;
}

/* Where an arc begins and ends when it runs anticlockwise with y up, radians; its own angles grow the other way. */
static void turn_over(const sheet_piece *arc, double out[2])
{
    double begin = -arc->from, end = -(arc->from + arc->sweep);
    out[0] = arc->sweep < 0 ? begin : end;
    out[1] = arc->sweep < 0 ? end : begin;
}

static bool is_round(const sheet_piece *p)
{
    return p->kind == SHEET_ARC && p->radii[0] == p->radii[1];
}

static bool is_whole(const sheet_piece *p)
{
    return fabs(p->sweep) > 2 * PI - 1e-9;
}

static void put_arc(dxf_writer *w, const sheet_item *item, const sheet_path *path, const sheet_piece *arc)
{
    double angles[2];
    turn_over(arc, angles);
    begin_entity(w, is_whole(arc) ? "CIRCLE" : "ARC", item, path, "AcDbCircle");
    dxf_put_position(w, 10, arc->centre[0], arc->centre[1]);
    dxf_put_number(w, 40, arc->radii[0]);
    if (is_whole(arc))
        return;
    dxf_put(w, 100, "AcDbArc");
    dxf_put_number(w, 50, degrees(angles[0]));
    dxf_put_number(w, 51, degrees(angles[1]));
}

/* Ratios and parameters with more decimals than lengths. */
static void put_fine(dxf_writer *w, int code, double value)
{
    text_append(&w->out, "%d\n%.9f\n", code, value);
}

static void put_ellipse(dxf_writer *w, const sheet_item *item, const sheet_path *path, const sheet_piece *arc)
{
    bool   high = arc->radii[1] > arc->radii[0]; /* the longer radius comes first */
    double angles[2], major = arc->radii[high], turn = -arc->turn - (high ? 0.5 * PI : 0), shift = high ? 0.5 * PI : 0;
    turn_over(arc, angles);
    begin_entity(w, "ELLIPSE", item, path, "AcDbEllipse");
    dxf_put_position(w, 10, arc->centre[0], arc->centre[1]);
    dxf_put_number(w, 11, major * cos(turn));
    dxf_put_number(w, 21, major * sin(turn));
    dxf_put_number(w, 31, 0);
    put_fine(w, 40, arc->radii[!high] / major);
    double begin = fmod(fmod(angles[0] + shift, 2 * PI) + 2 * PI, 2 * PI);
    put_fine(w, 41, is_whole(arc) ? 0 : begin);
    put_fine(w, 42, is_whole(arc) ? 2 * PI : begin + fabs(arc->sweep));
}

/* Cubics in a row, as one spline that has their control points: three knots where one ends. */
static void put_spline(dxf_writer *w, const sheet_item *item, const sheet_path *path, const double from[2],
                       const sheet_piece *pieces, uint32_t count)
{
    begin_entity(w, "SPLINE", item, path, "AcDbSpline");
    dxf_put_whole(w, 70, 8);
    dxf_put_whole(w, 71, 3);
    dxf_put_whole(w, 72, (int)(3 * count + 5));
    dxf_put_whole(w, 73, (int)(3 * count + 1));
    dxf_put_whole(w, 74, 0);
    for (uint32_t i = 0; i <= count; i++)
        for (int k = i == 0 || i == count ? 4 : 3; k > 0; k--)
            dxf_put_whole(w, 40, (int)i);
    dxf_put_position(w, 10, from[0], from[1]);
    for (uint32_t i = 0; i < count; i++) {
        dxf_put_position(w, 10, pieces[i].controls[0][0], pieces[i].controls[0][1]);
        dxf_put_position(w, 10, pieces[i].controls[1][0], pieces[i].controls[1][1]);
        dxf_put_position(w, 10, pieces[i].end[0], pieces[i].end[1]);
    }
}

static void begin_polyline(dxf_writer *w, const sheet_item *item, const sheet_path *path, uint32_t count, bool closed)
{
    begin_entity(w, "LWPOLYLINE", item, path, "AcDbPolyline");
    dxf_put_whole(w, 90, (int)count);
    dxf_put_whole(w, 70, 128 + closed);
}

static void put_corner(dxf_writer *w, double x, double y, double bulge)
{
    dxf_put_number(w, 10, x);
    dxf_put_number(w, 20, w->s->height - y);
    if (bulge != 0)
        put_fine(w, 42, bulge);
}

/* Arcs of more than half a turn are two. */
static uint32_t corners_of(const sheet_piece *p)
{
    return p->kind == SHEET_ARC && fabs(p->sweep) > PI ? 2 : 1;
}

/* Lines and arcs of circles in a row. */
static void put_bulged(dxf_writer *w, const sheet_item *item, const sheet_path *path, const double from[2],
                       const sheet_piece *pieces, uint32_t count, bool closed)
{
    uint32_t corners = closed ? 0 : 1;
    double   at[2] = {from[0], from[1]};
    for (uint32_t i = 0; i < count; i++)
        corners += corners_of(&pieces[i]);
    begin_polyline(w, item, path, corners, closed);
    for (uint32_t i = 0; i < count; i++) {
        const sheet_piece *p = &pieces[i];
        uint32_t           parts = corners_of(p);
        for (uint32_t k = 0; k < parts; k++) {
            put_corner(w, at[0], at[1], p->kind == SHEET_ARC ? -tan(p->sweep / parts / 4) : 0);
            if (k + 1 < parts)
                sheet_arc_at(p, p->from + p->sweep / 2, at);
        }
        memcpy(at, p->end, sizeof at);
    }
    if (!closed)
        put_corner(w, at[0], at[1], 0);
}

/* What of a piece's row is one entity: 0 lines and arcs of circles, 1 cubics, 2 those that stand alone. */
static int sort_of(const sheet_piece *p)
{
    return p->kind == SHEET_CUBIC ? 1 : p->kind == SHEET_ARC && (!is_round(p) || is_whole(p)) ? 2 : 0;
}

static void put_pieces(dxf_writer *w, const sheet_item *item, const sheet_path *path)
{
    const sheet_piece *pieces = w->s->pieces + path->first_piece;
    const float       *first = w->s->points[path->first];
    double             from[2] = {(double)first[0], (double)first[1]};
    for (uint32_t i = 0, end; i < path->piece_count; i = end) {
        int sort = sort_of(&pieces[i]);
        for (end = i + 1; sort != 2 && end < path->piece_count && sort_of(&pieces[end]) == sort;)
            end++;
        if (sort == 1)
            put_spline(w, item, path, from, pieces + i, end - i);
        else if (sort == 0 && end - i > 1)
            put_bulged(w, item, path, from, pieces + i, end - i,
                       (path->closed || path->filled) && end - i == path->piece_count);
        else if (pieces[i].kind == SHEET_LINE)
            put_line(w, item, path, from, pieces[i].end);
        else if (is_round(&pieces[i]))
            put_arc(w, item, path, &pieces[i]);
        else
            put_ellipse(w, item, path, &pieces[i]);
        memcpy(from, pieces[end - 1].end, sizeof from);
    }
}

/* The border of an area is one entity; of curves that this has no room for, their points. */
static bool has_one_border(const sheet *s, const sheet_path *path)
{
    for (uint32_t i = 0; i < path->piece_count; i++)
        if (sort_of(&s->pieces[path->first_piece + i]) != 0)
            return path->piece_count == 1;
    return true;
}

/* Bytes that a path takes, nearly: as entities of its pieces, and as a polyline of its points. Where lines and curves
 * take turns every few points, each change is an entity, and more than all points. */
static bool takes_less(const sheet *s, const sheet_path *path)
{
    static const size_t entity = 110, corner = 24, bulge = 14, ellipse = 90, knot = 5, position = 31;
    size_t              size = 0;
    for (uint32_t i = 0; i < path->piece_count; i++) {
        const sheet_piece *p = &s->pieces[path->first_piece + i];
        const int          sort = sort_of(p);
        const bool         begins = i == 0 || sort == 2 || sort != sort_of(p - 1);
        size += begins ? entity : 0;
        if (sort == 2)
            size += ellipse;
        else if (sort == 1)
            size += 3 * (knot + position) + (begins ? 5 * knot + position : 0);
        else
            size += corner + (p->kind == SHEET_ARC ? bulge : 0) + (begins ? corner : 0);
    }
    return size < entity + path->count * corner;
}

static void put_path(dxf_writer *w, const sheet_item *item, const sheet_path *path)
{
    const float(*points)[2] = (const float(*)[2])w->s->points + path->first;
    bool closed = path->closed || path->filled;
    if (path->piece_count && (path->piece_count == 1 || takes_less(w->s, path)) &&
        (!path->filled || has_one_border(w->s, path))) {
        put_pieces(w, item, path);
        return;
    }
    if (path->count == 2 && !closed) {
        const double a[2] = {(double)points[0][0], (double)points[0][1]},
                     b[2] = {(double)points[1][0], (double)points[1][1]};
        put_line(w, item, path, a, b);
        return;
    }
    begin_polyline(w, item, path, path->count, closed);
    for (uint32_t i = 0; i < path->count; i++)
        put_corner(w, (double)points[i][0], (double)points[i][1], 0);
}

/* Areas that are hatched are one HATCH: their borders as polylines, and one family of lines. Programs that have
 * patterns of their own take the one that is called so, at this scale and angle: lines at 45 degrees, an eighth of an
 * inch apart. y is up here, so that what is around an area runs the other way. */
static void put_hatch(dxf_writer *w, const sheet_item *item)
{
    static const double apart_there = 3.175, angle_there = 45;
    const sheet_hatch  *h = &item->hatch;
    const double        angle = degrees(-h->angle);
    begin_entity(w, "HATCH", item, NULL, "AcDbHatch");
    dxf_put_position(w, 10, 0, w->s->height);
    dxf_put_number(w, 210, 0);
    dxf_put_number(w, 220, 0);
    dxf_put_number(w, 230, 1);
    dxf_put(w, 2, "ANSI31");
    dxf_put_whole(w, 70, 0); /* lines */
    dxf_put_whole(w, 71, 0); /* tied to nothing */
    dxf_put_whole(w, 91, (int)item->count);
    for (uint32_t k = 0; k < item->count; k++) {
        const sheet_path *path = &w->s->paths[item->first + k];
        dxf_put_whole(w, 92, 1 + 2); /* outermost of all, a polyline */
        dxf_put_whole(w, 72, 0);     /* without bulges */
        dxf_put_whole(w, 73, 1);
        dxf_put_whole(w, 93, (int)path->count);
        for (uint32_t i = 0; i < path->count; i++)
            put_corner(w, (double)w->s->points[path->first + i][0], (double)w->s->points[path->first + i][1], 0);
        dxf_put_whole(w, 97, 0);
    }
    dxf_put_whole(w, 75, 0); /* inside and outside in turn */
    dxf_put_whole(w, 76, 1);
    dxf_put_number(w, 52, degrees(-h->angle - angle_there * (PI / 180)));
    dxf_put_number(w, 41, h->apart / apart_there);
    dxf_put_whole(w, 77, 0);
    dxf_put_whole(w, 78, 1);
    dxf_put_number(w, 53, angle);
    dxf_put_number(w, 43, h->origin[0]);
    dxf_put_number(w, 44, w->s->height - h->origin[1]);
    dxf_put_number(w, 45, -h->apart * sin(-h->angle));
    dxf_put_number(w, 46, h->apart * cos(-h->angle));
    dxf_put_whole(w, 79, 0);
    dxf_put_whole(w, 98, 0);
}

static void put_dots(dxf_writer *w, const sheet_item *item, const sheet_path *path)
{
    for (uint32_t i = 0; i < path->count; i++) {
        const float *p = w->s->points[path->first + i];
        begin_entity(w, path->width > 0 ? "CIRCLE" : "POINT", item, path, path->width > 0 ? "AcDbCircle" : "AcDbPoint");
        dxf_put_position(w, 10, (double)p[0], (double)p[1]);
        if (path->width > 0)
            dxf_put_number(w, 40, (double)path->width / 2);
    }
}

static void put_text(dxf_writer *w, const sheet_item *item)
{
    /* The height of capitals is what DXF calls a text's height. */
    begin_entity(w, "TEXT", item, NULL, "AcDbText");
    dxf_put_position(w, 10, item->box[0], item->box[1]);
    dxf_put_number(w, 40, 0.716 * item->box[3]);
    dxf_put_words(w, 1, item->text);
    if (item->anchor >= 0) {
        dxf_put_whole(w, 72, item->anchor == 0 ? 1 : 2);
        dxf_put_position(w, 11, item->box[0], item->box[1]);
    }
    dxf_put(w, 100, "AcDbText");
}

void dxf_put_entities(dxf_writer *w)
{
    dxf_put(w, 0, "SECTION");
    dxf_put(w, 2, "ENTITIES");
    for (size_t i = 0; i < w->s->item_count && !w->out.failed; i++) {
        const sheet_item *item = &w->s->items[i];
        if (item->kind == SHEET_TEXT && item->text)
            put_text(w, item);
        if (item->hatch.apart > 0 && item->count) {
            put_hatch(w, item);
            continue;
        }
        for (uint32_t k = 0; k < item->count; k++) {
            if (item->kind == SHEET_DOTS)
                put_dots(w, item, &w->s->paths[item->first + k]);
            else if (item->kind == SHEET_PATH)
                put_path(w, item, &w->s->paths[item->first + k]);
        }
    }
    dxf_put(w, 0, "ENDSEC");
}
