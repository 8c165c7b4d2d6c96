#include "base/colour.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    c |= 0x20;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

static bool parse_hex(const char *digits, colour *out)
{
    size_t length = strlen(digits);
    if (length != 3 && length != 4 && length != 6 && length != 8)
        return false;
    size_t width = length < 6 ? 1 : 2;
    float  values[4] = {0, 0, 0, 1};
    for (size_t i = 0; i < length / width; i++) {
        int high = hex_digit(digits[i * width]);
        int low = hex_digit(digits[i * width + width - 1]);
        if (high < 0 || low < 0)
            return false;
        values[i] = (float)(high * 16 + low) / 255.0f;
    }
    *out = (colour){values[0], values[1], values[2], values[3]};
    return true;
}

bool colour_parse(const char *text, colour *out)
{
    static const struct {
        const char *name, *hex;
    } names[] = {
        {"black", "000000"},   {"silver", "c0c0c0"}, {"gray", "808080"},   {"grey", "808080"},
        {"white", "ffffff"},   {"maroon", "800000"}, {"red", "ff0000"},    {"purple", "800080"},
        {"fuchsia", "ff00ff"}, {"green", "008000"},  {"lime", "00ff00"},   {"olive", "808000"},
        {"yellow", "ffff00"},  {"navy", "000080"},   {"blue", "0000ff"},   {"teal", "008080"},
        {"aqua", "00ffff"},    {"orange", "ffa500"}, {"none", "00000000"}, {"transparent", "00000000"},
    };
    if (text[0] == '#')
        return parse_hex(text + 1, out);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(text, names[i].name) == 0)
            return parse_hex(names[i].hex, out);
    return false;
}

static unsigned byte_of(float value)
{
    if (!(value > 0))
        return 0;
    return value >= 1 ? 255u : (unsigned)lroundf(value * 255.0f);
}

void colour_print(colour c, char out[10])
{
    if (byte_of(c.a) == 255)
        snprintf(out, 10, "#%02x%02x%02x", byte_of(c.r), byte_of(c.g), byte_of(c.b));
    else
        snprintf(out, 10, "#%02x%02x%02x%02x", byte_of(c.r), byte_of(c.g), byte_of(c.b), byte_of(c.a));
}

float colour_to_linear(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : powf((encoded + 0.055f) / 1.055f, 2.4f);
}

float colour_from_linear(float linear)
{
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * powf(linear, 1.0f / 2.4f) - 0.055f;
}
