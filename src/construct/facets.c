/* Into how many pieces round things are divided, and angles whose sines are exact. */
#include <math.h>

#include "base/limits.h"
#include "construct/construct_private.h"

/* OpenSCAD never takes $fa and $fs as smaller than this. */
#define FACETS_SMALLEST 0.01

int facets_of_circle(double radius, facets f)
{
    if (!(radius >= LENGTH_TINY) || !isfinite(radius) || !isfinite(f.fn))
        return 3;
    double count;
    if (f.fn > 0)
        count = f.fn >= 3 ? f.fn : 3;
    else
        count = ceil(fmax(fmin(360 / fmax(f.fa, FACETS_SMALLEST), radius * 2 * PI / fmax(f.fs, FACETS_SMALLEST)), 5));
    /* One more than the limit stays recognisable as too many. */
    return (int)fmin(count, (double)LIMIT_SHAPE_POINTS + 1);
}

/* Sine of an angle in [0, 90]. */
static double sine_of_acute(double degrees)
{
    if (degrees == 30)
        return 0.5;
    if (degrees == 45)
        return sqrt(0.5);
    if (degrees == 60)
        return sqrt(0.75);
    return degrees > 45 ? cos((90 - degrees) * PI / 180) : sin(degrees * PI / 180);
}

double sine_of_degrees(double degrees)
{
    double angle = fmod(degrees, 360), sign = 1;
    if (angle < 0)
        angle += 360;
    if (angle >= 180) {
        angle -= 180;
        sign = -1;
    }
    if (angle > 90)
        angle = 180 - angle;
    return angle == 0 ? 0 : sign * sine_of_acute(angle);
}

double cosine_of_degrees(double degrees)
{
    return sine_of_degrees(fmod(degrees, 360) + 90);
}
