/* Light and how it is shown. Pages, maps of shades, inks and papers hold what is shown, the sRGB encoding of light, and are mixed and averaged so, as browsers and printers'
 * programs do: half of a pixel under black ink is half as light a number, in a picture as in the SVG. What is lit is computed in light and then shown. */
vec3 shown(vec3 light)
{
    vec3 low = light * 12.92;
    vec3 high = 1.055 * pow(max(light, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, vec3(lessThanEqual(light, vec3(0.0031308))));
}

vec3 light_shown_as(vec3 colour)
{
    vec3 low = colour / 12.92;
    vec3 high = pow((max(colour, vec3(0.04045)) + 0.055) / 1.055, vec3(2.4));
    return mix(high, low, vec3(lessThanEqual(colour, vec3(0.04045))));
}
