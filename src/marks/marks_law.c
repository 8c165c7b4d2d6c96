/* Which marks are drawn: thresholds from position and light. Freudenberg 2003, sections 5.1.1, 5.1.3 and 5.4.3 to
 * 5.4.5, with what is printed wrong there mended: visible is what reaches both thresholds (not what misses one),
 * fades take the greater lack (not the smaller) over a ramp (not over all), and laws know what kind of mark they
 * are for. */
#include "marks/marks.h"

#include <math.h>

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

size_t mark_stroke_middle(mark_line *pieces, size_t count)
{
    size_t middle = 0;
    while (middle + 1 < count && pieces[middle].to < pieces[middle].length / 2)
        middle++;
    const mark_line *m = &pieces[middle];
    const double     d[3] = {(double)m->b.x - (double)m->a.x, (double)m->b.y - (double)m->a.y,
                             (double)m->b.z - (double)m->a.z};
    double           length = fmax(sqrt(dot3(d, d)), 1e-300);
    vec3             direction = {(float)(d[0] / length), (float)(d[1] / length), (float)(d[2] / length)};
    for (size_t i = 0; i < count; i++)
        pieces[i].middle_direction = direction;
    return middle;
}

double mark_page_area(const double position[3], const double normal[3], double focal, bool orthographic)
{
    double depth = fmax(-position[2], 1e-30);
    return orthographic ? focal * focal * fabs(normal[2])
                        : focal * focal * fabs(dot3(position, normal)) / (depth * depth * depth);
}

double mark_page_length(const double position[3], const double direction[3], double focal, bool orthographic)
{
    double depth = fmax(-position[2], 1e-30);
    if (orthographic)
        return focal * hypot(direction[0], direction[1]);
    return focal / depth *
           hypot(direction[0] + position[0] * direction[2] / depth, direction[1] + position[1] * direction[2] / depth);
}

double mark_fraction(mark_law law, const double position[3], const double normal[3], const double direction[3],
                     double d, bool orthographic)
{
    const double END_ON = 0.02; /* lines that are shorter on the page, fraction of their length, are dots */
    if (law == MARK_LAW_THESIS)
        return orthographic ? d * fabs(normal[2])
                            : d * fabs(dot3(position, normal)) / fmax(dot3(position, position), 1e-30);
    double area = mark_page_area(position, normal, 1, orthographic);
    if (law == MARK_LAW_DOT)
        return d * d * area;
    double unit = orthographic ? 1 : 1 / fmax(-position[2], 1e-30);
    return d * area / fmax(mark_page_length(position, direction, 1, orthographic), END_ON * unit);
}

bool mark_is_drawn(float light, float perspective, float light_threshold, float perspective_threshold)
{
    return light >= light_threshold && perspective >= perspective_threshold;
}

static float clamped(float x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

float mark_fade(float light, float perspective, float light_threshold, float perspective_threshold, float ramp)
{
    if (!(ramp > 0))
        return mark_is_drawn(light, perspective, light_threshold, perspective_threshold) ? 1 : 0;
    float lack_of_light = light_threshold * (1 + ramp) - light, lack = perspective_threshold * (1 + ramp) - perspective;
    return clamped(1 - fmaxf(lack_of_light, lack) / ramp);
}

float mark_dot_ink(float priority, float fraction, float ramp, float most)
{
    float rank = 1 - priority, half = fmaxf(ramp, 1e-4f) * fraction, low = fraction - half, high = fraction + half;
    if (!(fraction > 0))
        return 0;
    float own = half > 0 ? clamped((high - rank) / (2 * half)) : 0;
    /* What all dots together have when some would be needed beyond the last one. */
    float all = low >= 1 ? 1 : high <= 1 ? fraction : low + (high * (1 - low) - 0.5f * (1 - low * low)) / (2 * half);
    return own * fminf(fmaxf(fraction / all, 1), most);
}

float mark_line_ink(const mark_line *line, float light_fraction, float fraction, float ramp)
{
    if (line->span > 0) {
        float wanted = clamped((line->light - (1 - light_fraction)) / line->span) * fraction;
        return mark_dot_ink(line->perspective, wanted, ramp, 1);
    }
    return mark_fade(line->light, line->perspective, 1 - light_fraction, 1 - clamped(fraction), ramp);
}

float mark_ink_of_cover(float cover, float rim)
{
    /* Fitted to discs at the positions of marks_stipple, within a hundredth: they touch each other from a third on.
     * Rims that lie over each other cover as what is strewn at random does. */
    float c = fminf(clamped(cover), 0.98f), over = fmaxf(c - 0.311f, 0), ink = c + 0.156f * over * over / (1.08f - c);
    return ink + fminf(0.56f * c * rim, 1) * (-logf(1 - c) - ink);
}

/* The share that dots or strokes side by side with this ink cover: the same curve backwards. */
static float cover_of_ink(float ink)
{
    float v = ink - 0.311f, sum = v + 0.769f;
    return v <= 0 ? ink : 0.311f + (sum - sqrtf(sum * sum - 4 * 0.844f * 0.769f * v)) / (2 * 0.844f);
}

float mark_ink_of_strokes(float cover, float darkest, float span, float crowded)
{
    float bare = 1, wanted = fmaxf(1 - clamped(cover), 1e-4f), ink = 0;
    if (!(span > 0))
        return fminf(-logf(wanted), darkest);
    float most = cover_of_ink(darkest * span);
    for (int set = 0; set < (int)(1 / span + 0.5f); set++) { /* each as far as its own strokes go */
        float c = fminf(clamped(1 - wanted / bare), most);
        float even = mark_ink_of_cover(c, 0);
        ink += even + crowded * (-logf(fmaxf(1 - c, 1e-3f)) - even);
        bare *= 1 - c;
    }
    return fminf(ink, darkest);
}
