/* How wide lines are that flow: which of their levels are there follows from the distance that lines shall have on the
 * page, and each is as wide as its strip times what shall be covered. So the tone is right though lines are not quite
 * evenly spaced (the strip is measured), and stays while further lines come in between. */
#include "marks/marks.h"

#include <math.h>

static double clamped(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* How much lines have grown that began so long ago, summed up to now. */
static double grown(double since)
{
    double t = fmin(fmax(since, 0), FLOW_RAMP);
    return t * t / (2 * FLOW_RAMP) + fmax(since - FLOW_RAMP, 0);
}

double mark_cover_of_set(double darkness, double crossed, int set, int series, bool steady)
{
    double dark = clamped(darkness), first = dark;
    if (steady && series > 1) {
        for (int before = 0; before < set; before++)
            dark = fmax(dark - crossed, 0) / fmax(1 - crossed, 1e-6);
        return set + 1 < series ? fmin(dark, crossed) : dark;
    }
    if (series < 2 || dark <= crossed)
        return set == 0 ? dark : 0;
    /* The first goes on to nine tenths, at a slower pace. */
    first = crossed + (0.9 - crossed) * (dark - crossed) / fmax(1 - crossed, 1e-6);
    return set == 0 ? first : 1 - pow((1 - dark) / (1 - first), 1.0 / (series - 1));
}

double mark_flow_width(const mark_line *line, const float spaces[FLOW_SPACES], double apart, int levels, double level,
                       double cover)
{
    int    whole = (int)fmin(fmax(floor(level), 0), levels - 1), after = whole - line->level;
    double coming = 0;
    if (level > 0 && whole + 1 < levels)
        coming = (grown(level - whole - 0.1) - grown(level - whole - 0.1 - FLOW_UNEVEN)) / FLOW_UNEVEN;
    if (after < -1 || (after == -1 && whole + 1 >= levels))
        return 0;
    if (after == -1)
        return cover * (double)spaces[0] * ldexp(apart, -whole - 1) * clamped((level - (double)line->rank) / FLOW_RAMP);
    double now = after < FLOW_SPACES ? (double)spaces[after] : 1,
           next = 0.5 * (after + 1 < FLOW_SPACES ? (double)spaces[after + 1] : 1);
    return cover * ldexp(apart, -whole) * (now + coming * (next - now));
}

double mark_flow_hand(const mark_line *line, const flow_end *end, double pressure, double patchy)
{
    return (1 + pressure * (1 - 2 * (double)end->drawn)) * (1 + patchy * (double)line->group);
}

double mark_flow_gradient(double cover, const flow_end *end, double gradient, bool white)
{
    double by = 1 + gradient * (double)end->shade;
    return clamped(white ? 1 - (1 - cover) * by : cover * by);
}

double mark_flow_sparse(const mark_line *line, double distances, double sparse, double least)
{
    double whole = (double)line->rank * 61 + line->level * 0.73 + 0.5, own = whole - floor(whole);
    /* Each of them has another length, and most are short. */
    double reach = FLOW_SPARSE * own * own / fmax(sparse * sparse, 1e-6);
    return own < sparse ? 1.6 * least * clamped(1.5 * (1 - distances / fmax(reach, 1e-6))) : 0;
}

double mark_flow_room(double distances, double room)
{
    double t = room > 0 ? clamped(2 * distances / room - 1) : 1;
    return t * t * (3 - 2 * t);
}

double mark_flow_grazing(double facing, double darkness)
{
    const double BLACK = 0.8;
    double       t = clamped((fabs(facing) / FLOW_GRAZING - 1) / 2), left = t * t * (3 - 2 * t);
    double       u = clamped((darkness - BLACK) / (1 - BLACK));
    return left + (1 - left) * u * u * (3 - 2 * u);
}

double mark_flow_tip(double to_end, double taper, double tip, double cover, double join)
{
    double t = clamped(2 * cover / join - 1), closed = t * t * (3 - 2 * t);
    double left = pow(clamped(to_end / fmax(taper, 1e-20)), tip);
    return left + closed * (1 - left);
}

double mark_flow_swell(const mark_line *line, double uneven)
{
    double whole = (double)line->rank * 97 + line->level * 0.37;
    return 1 + uneven * (whole - floor(whole) - 0.5);
}
