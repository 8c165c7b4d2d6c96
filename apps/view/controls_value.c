#include "controls_value.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A logarithmic slider begins a little above 0 where its range does. */
static double low_of(const lmn_param_info *info)
{
    if (!info->logarithmic || info->soft_min > 0)
        return info->soft_min;
    return info->soft_max / 1000;
}

double slider_position(const lmn_param_info *info, double value)
{
    double low = low_of(info), high = info->soft_max, out;
    if (!(high > low) || isnan(value))
        return 0;
    if (info->logarithmic)
        out = value > low ? log(value / low) / log(high / low) : 0;
    else
        out = (value - low) / (high - low);
    return fmin(fmax(out, 0), 1);
}

double slider_value(const lmn_param_info *info, double position)
{
    double low = low_of(info), high = info->soft_max;
    if (position <= 0)
        return info->soft_min;
    if (position >= 1)
        return high;
    double out = info->logarithmic ? low * pow(high / low, position) : low + position * (high - low);
    char   text[32];
    snprintf(text, sizeof text, "%.3g", out);
    out = info->type == LMN_PARAM_INT ? round(out) : strtod(text, NULL);
    return fmin(fmax(out, info->soft_min), high);
}

void param_title(const char *key, char *out, size_t size)
{
    snprintf(out, size, "%s", key);
    for (char *c = out; *c; c++)
        *c = *c == '_' ? ' ' : *c;
    *out = (char)toupper((unsigned char)*out);
}

const char *param_unit_text(lmn_param_unit unit)
{
    return unit == LMN_UNIT_POINTS ? "pt" : unit == LMN_UNIT_DEGREES ? "°" : "";
}
