/* SVG: transforms, and paths as chords. */
#include "stroke_texture/stroke_svg.h"

#include <string.h>

enum { CHORDS_MAX = 256, CHORDS_ROUGHLY = 8, NUMBER_MAX = 256 };

static const double half_turn = 3.14159265358979323846;

/* --- numbers and transforms --- */

const char *svg_skip_blanks(const char *at)
{
    while (*at && strchr(" \t\r\n\f", *at))
        at++;
    return at;
}

static const char *skip_comma(const char *at)
{
    at = svg_skip_blanks(at);
    return *at == ',' ? svg_skip_blanks(at + 1) : at;
}

const char *svg_number(const char *at, double *out)
{
    /* No words: "nan" and "inf" are no numbers here. Looking for the end of all the text each time would take its
     * length squared. */
    bool        begins = *at && strchr("+-.0123456789", *at);
    const char *end = begins ? text_parse_double(at, at + strnlen(at, NUMBER_MAX), out) : NULL;
    return end && isfinite(*out) ? skip_comma(end) : NULL;
}

svg_transform svg_combine(svg_transform o, svg_transform i)
{
    return (svg_transform){o.a * i.a + o.c * i.b, o.b * i.a + o.d * i.b,       o.a * i.c + o.c * i.d,
                           o.b * i.c + o.d * i.d, o.a * i.e + o.c * i.f + o.e, o.b * i.e + o.d * i.f + o.f};
}

svg_point svg_apply(const svg_transform *t, svg_point p)
{
    return (svg_point){t->a * p.x + t->c * p.y + t->e, t->b * p.x + t->d * p.y + t->f};
}

typedef struct named_transform {
    const char *name;
    int         least, most; /* arguments */
} named_transform;

static svg_transform rotation(const double *n, int count)
{
    double        s = sin(n[0] * half_turn / 180), c = cos(n[0] * half_turn / 180);
    svg_transform turned = {c, s, -s, c, 0, 0};
    if (count < 3)
        return turned;
    turned = svg_combine((svg_transform){1, 0, 0, 1, n[1], n[2]}, turned);
    return svg_combine(turned, (svg_transform){1, 0, 0, 1, -n[1], -n[2]});
}

static svg_transform make_transform(int kind, const double *n, int count)
{
    switch (kind) {
    case 0: return (svg_transform){n[0], n[1], n[2], n[3], n[4], n[5]};
    case 1: return (svg_transform){1, 0, 0, 1, n[0], count > 1 ? n[1] : 0};
    case 2: return (svg_transform){n[0], 0, 0, count > 1 ? n[1] : n[0], 0, 0};
    case 3: return rotation(n, count);
    case 4: return (svg_transform){1, 0, tan(n[0] * half_turn / 180), 1, 0, 0};
    default: return (svg_transform){1, tan(n[0] * half_turn / 180), 0, 1, 0, 0};
    }
}

bool svg_parse_transform(const char *at, svg_transform *out)
{
    static const named_transform kinds[] = {{"matrix", 6, 6}, {"translate", 1, 2}, {"scale", 1, 2},
                                            {"rotate", 1, 3}, {"skewX", 1, 1},     {"skewY", 1, 1}};
    enum { KINDS = sizeof kinds / sizeof *kinds };
    *out = svg_identity;
    for (at = svg_skip_blanks(at); *at;) {
        int    kind = 0, count = 0;
        double numbers[6] = {0};
        while (kind < KINDS && strncmp(at, kinds[kind].name, strlen(kinds[kind].name)) != 0)
            kind++;
        if (kind == KINDS)
            return false;
        at = svg_skip_blanks(at + strlen(kinds[kind].name));
        if (*at++ != '(')
            return false;
        for (at = svg_skip_blanks(at); *at != ')' && count < kinds[kind].most; count++)
            if (!(at = svg_number(at, &numbers[count])))
                return false;
        if (*at != ')' || count < kinds[kind].least)
            return false;
        *out = svg_combine(*out, make_transform(kind, numbers, count));
        at = skip_comma(at + 1);
    }
    return true;
}

/* --- the pen --- */

static void chord(svg_pen *pen, svg_point from, svg_point to)
{
    if (!pen->failed && !pen->chord(pen->user, from, to))
        pen->failed = true;
}

/* A chord in the drawing's coordinates; without extent it is left to svg_finish. */
static void visible_chord(svg_pen *pen, svg_point from, svg_point to)
{
    pen->drawn = true;
    if (from.x == to.x && from.y == to.y)
        return;
    pen->marked = true;
    chord(pen, from, to);
}

void svg_finish(svg_pen *pen)
{
    svg_point at = svg_apply(&pen->transform, pen->subpath);
    if (pen->drawn && !pen->marked)
        chord(pen, at, at);
    pen->drawn = pen->marked = false;
}

void svg_move(svg_pen *pen, svg_point to)
{
    svg_finish(pen);
    pen->at = pen->subpath = to;
}

void svg_line(svg_pen *pen, svg_point to)
{
    visible_chord(pen, svg_apply(&pen->transform, pen->at), svg_apply(&pen->transform, to));
    pen->at = to;
}

/* As many chords as the second differences of the corners ask for (Wang's formula). */
static int chord_count(const svg_pen *pen, const svg_point p[4])
{
    double bend = fmax(hypot(p[0].x - 2 * p[1].x + p[2].x, p[0].y - 2 * p[1].y + p[2].y),
                       hypot(p[1].x - 2 * p[2].x + p[3].x, p[1].y - 2 * p[2].y + p[3].y));
    if (!(pen->tolerance > 0))
        return CHORDS_ROUGHLY;
    double count = ceil(sqrt(0.75 * bend / pen->tolerance));
    return count < 1 ? 1 : count < CHORDS_MAX ? (int)count : CHORDS_MAX;
}

void svg_cubic(svg_pen *pen, svg_point a, svg_point b, svg_point to)
{
    svg_point p[4] = {svg_apply(&pen->transform, pen->at), svg_apply(&pen->transform, a), svg_apply(&pen->transform, b),
                      svg_apply(&pen->transform, to)};
    svg_point before = p[0];
    int       count = chord_count(pen, p);
    for (int i = 1; i <= count && !pen->failed; i++) {
        double    t = (double)i / count, s = 1 - t;
        double    w[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
        svg_point at = {w[0] * p[0].x + w[1] * p[1].x + w[2] * p[2].x + w[3] * p[3].x,
                        w[0] * p[0].y + w[1] * p[1].y + w[2] * p[2].y + w[3] * p[3].y};
        if (i == count)
            at = p[3];
        visible_chord(pen, before, at);
        before = at;
    }
    pen->at = to;
}

void svg_quadratic(svg_pen *pen, svg_point a, svg_point to)
{
    svg_point from = pen->at;
    svg_cubic(pen, (svg_point){from.x + (a.x - from.x) * 2 / 3, from.y + (a.y - from.y) * 2 / 3},
              (svg_point){to.x + (a.x - to.x) * 2 / 3, to.y + (a.y - to.y) * 2 / 3}, to);
}

/* A piece of the unit circle, at most a quarter, as a cubic; `circle` leads from there to the pen's coordinates. */
static void arc_piece(svg_pen *pen, const svg_transform *circle, double from, double to)
{
    double    k = 4.0 / 3.0 * tan((to - from) / 4);
    svg_point a = {cos(from) - k * sin(from), sin(from) + k * cos(from)},
              b = {cos(to) + k * sin(to), sin(to) - k * cos(to)};
    svg_cubic(pen, svg_apply(circle, a), svg_apply(circle, b), svg_apply(circle, (svg_point){cos(to), sin(to)}));
}

/* SVG 1.1, appendix F.6: from the ends to the middle. */
void svg_arc(svg_pen *pen, double rx, double ry, double degrees, bool large, bool sweep, svg_point to)
{
    svg_point from = pen->at;
    rx = fabs(rx);
    ry = fabs(ry);
    if (rx == 0 || ry == 0 || (from.x == to.x && from.y == to.y)) {
        svg_line(pen, to);
        return;
    }
    double s = sin(degrees * half_turn / 180), c = cos(degrees * half_turn / 180);
    double hx = (from.x - to.x) / 2, hy = (from.y - to.y) / 2, x = c * hx + s * hy, y = -s * hx + c * hy;
    double size = x * x / (rx * rx) + y * y / (ry * ry);
    if (size > 1) {
        rx *= sqrt(size);
        ry *= sqrt(size);
        size = 1;
    }
    double away = sqrt(fmax(0, 1 / size - 1)) * (large == sweep ? -1 : 1), mx = away * rx * y / ry,
           my = -away * ry * x / rx;
    double from_angle = atan2((y - my) / ry, (x - mx) / rx), to_angle = atan2((-y - my) / ry, (-x - mx) / rx),
           turned = to_angle - from_angle;
    if (sweep && turned < 0)
        turned += 2 * half_turn;
    if (!sweep && turned > 0)
        turned -= 2 * half_turn;
    /* Radii far beyond what doubles square leave nothing to turn by. */
    if (!isfinite(turned) || !isfinite(mx) || !isfinite(my)) {
        svg_line(pen, to);
        return;
    }
    svg_transform circle = {
        c * rx, s * rx, -s * ry, c * ry, c * mx - s * my + (from.x + to.x) / 2, s * mx + c * my + (from.y + to.y) / 2};
    int pieces = (int)ceil(fabs(turned) / (half_turn / 2) - 1e-9);
    pieces = pieces < 1 ? 1 : pieces > 4 ? 4 : pieces;
    for (int i = 0; i < pieces; i++)
        arc_piece(pen, &circle, from_angle + turned * i / pieces, from_angle + turned * (i + 1) / pieces);
    pen->at = to;
}

void svg_close(svg_pen *pen)
{
    svg_line(pen, pen->subpath);
    svg_finish(pen);
}

/* --- path data --- */

typedef struct path_reader {
    svg_pen  *pen;
    svg_point control; /* of the last curve, for smooth ones */
    char      before;  /* the last command, in upper case */
} path_reader;

/* "0" and "1" need no blanks behind them. */
static const char *read_flag(const char *at, double *out)
{
    if (*at != '0' && *at != '1')
        return NULL;
    *out = *at - '0';
    return skip_comma(at + 1);
}

static const char *read_arguments(const char *at, char command, double *n)
{
    static const char counts[] = "M2L2H1V1C6S4Q4T2A7";
    int               count = strchr(counts, command)[1] - '0';
    for (int i = 0; i < count && at; i++)
        at = command == 'A' && (i == 3 || i == 4) ? read_flag(at, &n[i]) : svg_number(at, &n[i]);
    return at;
}

static svg_point mirrored(const path_reader *r, const char *commands)
{
    svg_point at = r->pen->at;
    return strchr(commands, r->before) ? (svg_point){2 * at.x - r->control.x, 2 * at.y - r->control.y} : at;
}

/* One command with its numbers; coordinates relative to `base`. */
static void run_command(path_reader *r, char command, const double *n, svg_point base)
{
    svg_pen  *pen = r->pen;
    svg_point p[3] = {{0, 0}};
    for (int i = 0; i < 3; i++)
        p[i] = (svg_point){base.x + n[2 * i], base.y + n[2 * i + 1]};
    switch (command) {
    case 'M': svg_move(pen, p[0]); break;
    case 'L': svg_line(pen, p[0]); break;
    case 'H': svg_line(pen, (svg_point){base.x + n[0], pen->at.y}); break;
    case 'V': svg_line(pen, (svg_point){pen->at.x, base.y + n[0]}); break;
    case 'C':
        r->control = p[1];
        svg_cubic(pen, p[0], p[1], p[2]);
        break;
    case 'S': {
        svg_point first = mirrored(r, "CS");
        r->control = p[0];
        svg_cubic(pen, first, p[0], p[1]);
        break;
    }
    case 'Q':
        r->control = p[0];
        svg_quadratic(pen, p[0], p[1]);
        break;
    case 'T':
        r->control = mirrored(r, "QT");
        svg_quadratic(pen, r->control, p[0]);
        break;
    default: svg_arc(pen, n[0], n[1], n[2], n[3] != 0, n[4] != 0, (svg_point){base.x + n[5], base.y + n[6]}); break;
    }
    r->before = command;
}

bool svg_path(svg_pen *pen, const char *d)
{
    path_reader r = {.pen = pen, .before = 'Z'};
    const char *at = svg_skip_blanks(d);
    bool        begun = false;
    while (*at && !pen->failed) {
        char letter = *at, command = (char)(letter & ~0x20);
        if (!strchr("MLHVCSQTAZ", command) || !(letter & 0x40) || (!begun && command != 'M'))
            return false;
        at = svg_skip_blanks(at + 1);
        begun = true;
        if (command == 'Z') {
            svg_close(pen);
            r.before = 'Z';
            continue;
        }
        do {
            double      n[8] = {0};
            const char *behind = read_arguments(at, command, n);
            if (!behind)
                return false;
            at = behind;
            run_command(&r, command, n, letter == command ? (svg_point){0, 0} : pen->at);
            /* What follows a move without a letter are lines. */
            if (command == 'M') {
                command = 'L';
                letter = letter == 'M' ? 'L' : 'l';
            }
        } while (*at && strchr("+-.0123456789", *at) && !pen->failed);
    }
    return true;
}
