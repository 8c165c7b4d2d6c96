#include "light/light.glsl"

/* Brightness of the summed light in steps; a step's border is blended over u_softness pixels, measured by how fast the light
 * changes on the screen. */
float banded(float light)
{
    float bands = float(u_bands);
    float scaled = clamp(light, 0.0, 0.9999) * bands;
    float band = floor(scaled);
    float to_border = scaled - band;
    float width = u_softness * fwidth(light) * bands;
    float lower = band / max(bands - 1.0, 1.0);
    float upper = min(band + 1.0, bands - 1.0) / max(bands - 1.0, 1.0);
    float before = max(band - 1.0, 0.0) / max(bands - 1.0, 1.0);
    if (width <= 0.0 || width > 1.0)
        return lower;
    float rise = clamp((to_border - 1.0) / width + 0.5, 0.0, 0.5);
    float fall = clamp(0.5 - to_border / width, 0.0, 0.5);
    return lower + (upper - lower) * rise - (lower - before) * fall;
}

vec4 surface_colour(surface_point p)
{
    if (p.unlit)
        return vec4(shown(p.albedo.rgb), 1.0);
    float light = min(dot(diffuse_light(p), vec3(0.2126, 0.7152, 0.0722)), 1.0);
    float brightness = mix(u_shadow, u_light, u_bands > 1 ? banded(light) : 1.0);
    float grey = dot(p.albedo.rgb, vec3(0.2126, 0.7152, 0.0722));
    vec3 colour = max(mix(vec3(grey), p.albedo.rgb, u_saturation), vec3(0.0)) * brightness;
    if (u_highlight > 0.0) {
        float spot = highlight(p, 40.0);
        float width = max(u_softness * fwidth(spot), 1e-4);
        colour += u_highlight * smoothstep(0.5 - 0.5 * width, 0.5 + 0.5 * width, spot);
    }
    return vec4(shown(min(colour, vec3(1.0))), 1.0);
}
