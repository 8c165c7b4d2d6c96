#include "light/light.glsl"
#include "gpu/hash.glsl"

/* Brightness of the summed light in steps; a step's border is blended over u_softness pixels, measured by how fast the light
 * changes on the screen: by `slope` a pixel; or over u_gradation of a step's light, where that is more. */
float banded(float light, float slope)
{
    float bands = float(u_bands);
    float scaled = clamp(light, 0.0, 0.9999) * bands;
    float band = floor(scaled);
    float to_border = scaled - band;
    float width = u_softness * slope * bands;
    float lower = band / max(bands - 1.0, 1.0);
    float upper = min(band + 1.0, bands - 1.0) / max(bands - 1.0, 1.0);
    float before = max(band - 1.0, 0.0) / max(bands - 1.0, 1.0);
    width = max(width > 1.0 ? 0.0 : width, u_gradation);
    if (width <= 0.0)
        return lower;
    float rise = clamp((to_border - 1.0) / width + 0.5, 0.0, 0.5);
    float fall = clamp(0.5 - to_border / width, 0.0, 0.5);
    return lower + (upper - lower) * rise - (lower - before) * fall;
}

/* Half of what is seen of a ball's shade, about, has the light that comes back. */
const float RETURNS = 0.52;

/* How much a surface looks to where light comes back from, opposite the first one, less from below than that came from above: from what stands around. Clefts see little of it. */
float reflected_light(surface_point p, float sky)
{
    vec3 light = towards_light(0, p.eye);
    return dot(p.normal, normalize(vec3(-light.x, -0.6 * light.y, 0.05))) * sky;
}

float tone_light(surface_point p, float first, float sky)
{
    return min(sky * dot(open_light_of(p, first), vec3(0.2126, 0.7152, 0.0722)), 1.0);
}

#include "surface/surroundings.glsl"
#include "surface/calm.glsl"

/* The colour that is shown, and no fill is darker than u_darkest: ink stays legible on it. What is darker still keeps its order. */
vec3 legible(vec3 colour)
{
    float left = 1.0 - clamp(dot(colour, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0);
    return colour + u_darkest * left * left * left;
}

/* A thin wash of the colour. */
vec3 lifted(vec3 albedo)
{
    return u_lightness > 0.0 ? light_shown_as(mix(shown(albedo), vec3(1.0), u_lightness)) : albedo;
}

/* Where the surface's tangent plane is seen, this many pixels from here. */
vec3 on_plane(surface_point p, vec2 offset)
{
    vec2 step = 2.0 * offset / u_size * u_unproject;
    if (u_perspective < 0.5) {
        float fall = dot(p.normal.xy, step) / max(p.normal.z, 0.05);
        return p.eye + vec3(step, -fall);
    }
    vec3 ray = p.eye / -p.eye.z + vec3(step, 0.0);
    return ray * (dot(p.normal, p.eye) / min(dot(p.normal, ray), -0.05));
}

/* Numbers 0 … 1 of a stripe. */
vec2 of_stripe(float number)
{
    return 0.5 + 0.5 * corner_noise(hash_of(uvec3(uint(int(number) + 0x8000), 0u, 0u), 1u));
}

/* How far the stroke of a stripe reaches there: most in its middle, and as a brush that is lifted leaves it, broad where it begins and long and thin at its end. Strokes differ in length, each
 * by itself and together with those beside it. */
float stripe(float along)
{
    float number = floor(along), group = number / 7.0, part = smoothstep(0.0, 1.0, fract(group));
    float together = mix(of_stripe(floor(group) + 4096.0).y, of_stripe(floor(group) + 4097.0).y, part);
    float length_ = 0.3 + 0.3 * of_stripe(number).x + 0.4 * together;
    return length_ * (1.0 - sqrt(abs(2.0 * fract(along) - 1.0)));
}

/* What is dark itself and has no colour to lose, 0 … 1. */
float darkness(surface_point p)
{
    vec3 colour = shown(p.albedo.rgb);
    float dark = 1.0 - smoothstep(0.15, 0.4, dot(colour, vec3(0.2126, 0.7152, 0.0722)));
    return dark * (1.0 - smoothstep(0.06, 0.16, max(max(colour.r, colour.g), colour.b) - min(min(colour.r, colour.g), colour.b)));
}

/* By how much more than its own turn from the light a place is black: where little of the sky is seen, and what is dark itself. Where less than a quarter of the sky is `hidden` lies no cleft:
 * what is measured there is grain. */
float spotted(float hidden, float dark)
{
    return u_spotted * (clamp(2.0 * hidden - 0.5, 0.0, 1.0) + 0.3 * dark);
}

/* Are there blacks where a stroke that is here would begin? `beyond`: by how much more this place is turned to the light, which changes by `gradient` from pixel to pixel. */
float begins(surface_point p, vec2 gradient, float beyond, vec3 light)
{
#ifdef SHADED_LATER
    vec3 own = texelFetch(t_form, ivec2(gl_FragCoord.xy), 0).xyz;
    float slope = max(length(gradient), 1e-6), most = 0.0;
    if (beyond < 1.5 * slope)
        return 1.0; /* it begins here */
    vec2 back = gradient / slope * (max(beyond, 0.0) / slope + 1.0);
    for (int k = 1; k <= 4; k++) { /* the form may end before */
        ivec2 at = ivec2(clamp(gl_FragCoord.xy - 0.25 * float(k) * back, vec2(0.0), u_size - 1.0));
        float less = 0.5 * dot(own - texelFetch(t_form, at, 0).xyz, light);
        most = max(most, texelFetch(t_id, at, 0).r == p.part ? less : 0.0);
    }
    return smoothstep(0.5, 0.7, most / max(beyond, 1e-6));
#else
    return 1.0;
#endif
}

/* An inker's blacks: the fraction of the pixel that is ink. Strokes that feather them lie in planes of light: on any form these cross the border of light
 * and shadow at right angles. They keep their distance on the page within a factor of two: where it would grow beyond that, others come between. `gradient`: how fast the form
 * turns towards the light here, by a pixel; `shadow`: what else makes it black, how that changes, and by how much more it may from pixel to pixel. */
float inked(surface_point p, vec2 gradient, vec4 shadow)
{
    float slope = length(gradient), border = length(gradient - shadow.yz);
    vec3 light = towards_light(0, p.eye);
    float beyond = 0.5 + 0.5 * dot(p.normal, light) - 0.5 * u_blacks - shadow.x, reach = 0.0, reach_slope = 0.0;
    if (beyond > border + shadow.w + u_feather)
        return 0.0;
    if (u_feather > 0.0) {
        vec3 first = normalize(cross(light, abs(light.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0))), second = cross(light, first);
        vec3 rim = cross(p.normal, light);
        vec3 axis = abs(dot(first, rim)) > abs(dot(second, rim)) ? first : second;
        float along = dot((u_world_from_eye * vec4(p.eye, 1.0)).xyz, mat3(u_world_from_eye) * axis);
        float slope_along = length(vec2(dot(on_plane(p, vec2(1.0, 0.0)) - p.eye, axis), dot(on_plane(p, vec2(0.0, 1.0)) - p.eye, axis)));
        float octave = log2(max(slope_along * u_spacing, 1e-12)), part = fract(octave), pitch = exp2(octave - part);
        /* They begin at blacks: on what hardly turns these are far, or nowhere. */
        float beside = u_feather * smoothstep(0.02, 0.06, slope * u_spacing / u_feather) * begins(p, gradient, beyond, light);
        reach = beside * mix(stripe(along / pitch), stripe(0.5 * along / pitch), part);
        reach_slope = beside * slope_along / pitch * (2.0 - part); /* at the middle of a stroke's length */
    }
    float width = max(length(vec3(border, reach_slope, 0.5 * shadow.w)), 1e-4);
    return clamp((reach - beyond) / width + 0.5, 0.0, 1.0);
}

vec4 surface_colour(surface_point p)
{
    p.albedo.rgb = lifted(p.albedo.rgb);
    if (p.unlit)
        return vec4(shown(p.albedo.rgb), 1.0);
    float arrives = unshadowed(p);
#ifdef SHADED_LATER
    surroundings around = surroundings_of(p, false);
    surface_point right = p, above = p;
    arrives = around.light;
    calm_form calm = calm_form_of(p);
    p.normal = calm.normal;
    p.albedo.rgb = lifted(around.albedo);
    right.normal = normalize(calm.normal + calm.across);
    above.normal = normalize(calm.normal + calm.up);
    float spot = highlight(p, 40.0), spot_slope = length(vec2(highlight(right, 40.0), highlight(above, 40.0)) - spot);
#else
    float spot = highlight(p, 40.0), spot_slope = fwidth(spot);
#endif
    /* The border of a hard shadow is that of its own tone, wherever the steps of light are. */
#ifdef HAS_SOFT_SHADOW
    float first = arrives, lit = 1.0;
#else
    float first = 1.0, lit = arrives;
#endif
#ifdef SHADED_LATER
    float sky = 1.0 - calm.deep.x, sky_right = sky - calm.deep.y, sky_above = sky - calm.deep.z;
    float light = tone_light(p, first, sky), dark = tone_light(p, 0.0, sky), back = reflected_light(p, sky);
    float slope = length(vec2(tone_light(right, first, sky_right), tone_light(above, first, sky_above)) - light);
    float dark_slope = length(vec2(tone_light(right, 0.0, sky_right), tone_light(above, 0.0, sky_above)) - dark);
    float back_slope = length(vec2(reflected_light(right, sky_right), reflected_light(above, sky_above)) - back);
#else
    float sky = sky_fraction(p);
    float light = tone_light(p, first, sky), dark = tone_light(p, 0.0, sky), back = reflected_light(p, sky);
    float slope = fwidth(light), dark_slope = fwidth(dark), back_slope = fwidth(back);
#endif
    float tone = u_bands > 1 ? mix(banded(dark, dark_slope), banded(light, slope), lit) : 1.0;
    vec3 brightness = mix(u_shadow, u_light, tone) * mix(u_shade.rgb, u_bright.rgb, tone);
    /* A step inside the darkest tone. */
    float returned = clamp((back - RETURNS) / max(u_softness * back_slope, 1e-7) + 0.5, 0.0, 1.0);
    brightness *= 1.0 + u_reflected * returned * clamp(1.0 - tone * float(u_bands - 1), 0.0, 1.0);
    float grey = dot(p.albedo.rgb, vec3(0.2126, 0.7152, 0.0722));
    vec3 colour = max(mix(vec3(grey), p.albedo.rgb, u_saturation), vec3(0.0)) * brightness;
    colour = light_shown_as(min(legible(shown(min(colour, vec3(1.0)))), vec3(1.0)));
    if (u_highlight > 0.0) {
        float width = max(u_softness * spot_slope, 1e-4);
        colour += u_highlight * smoothstep(0.5 - 0.5 * width, 0.5 + 0.5 * width, spot);
    }
    colour = shown(min(colour, vec3(1.0)));
    if (u_blacks > 0.0 || u_feather > 0.0) {
        vec3 towards = towards_light(0, p.eye);
        float dark = darkness(p);
        vec4 shadow = vec4(0.0);
#ifdef SHADED_LATER
        vec2 gradient = 0.5 * vec2(dot(calm.across, towards), dot(calm.up, towards));
        shadow.x = spotted(calm.deep.x, dark);
        shadow.yz = spotted(calm.deep.x, 0.0) > 0.0 ? 2.0 * u_spotted * calm.deep.yz : vec2(0.0);
        shadow.w = 0.3 * u_spotted * fwidth(dark);
#else
        float turned = dot(p.normal, towards);
        vec2 gradient = 0.5 * vec2(dFdx(turned), dFdy(turned));
        shadow.x = spotted(1.0 - sky_fraction(p), dark);
        shadow.w = fwidth(shadow.x);
#endif
        colour = mix(colour, u_ink.rgb, u_ink.a * inked(p, gradient, shadow));
    }
    return vec4(colour, 1.0);
}
