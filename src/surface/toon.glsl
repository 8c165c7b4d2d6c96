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

float tone_light(surface_point p, float first)
{
    return min(dot(diffuse_light_of(p, first), vec3(0.2126, 0.7152, 0.0722)), 1.0);
}

#ifdef SHADED_LATER
/* What a surface is like around a position of the page: its mean normal, by how much that turns a pixel to the right and up, and its colour
 * without detail. */
struct surroundings {
    vec3 normal, across, up, albedo;
};

vec3 eye_at(vec2 pixel, float depth)
{
    return vec3((2.0 * pixel / u_size - 1.0) * u_unproject * (u_perspective > 0.5 ? depth : 1.0), -depth);
}

/* Over a disc of u_smoothing pixels: not across borders of parts, creases and steps of depth, and of colours only those that are alike. Taps lie on
 * Fermat's spiral, the same at each pixel, so that what comes out is as smooth as the weights are. */
surroundings surroundings_of(surface_point p)
{
    const int TAPS = 32;
    vec3 sum = p.normal, across = vec3(0.0), up = vec3(0.0), own = sqrt(p.albedo.rgb), colours = own; /* as near to what is shown as it takes */
    vec2 offsets = vec2(0.0), squares = vec2(0.0);
    float weights = 1.0, colour_weights = 1.0, level = 1.0;
    for (int i = 0; i < TAPS; i++) {
        float distance = sqrt((float(i) + 0.5) / float(TAPS)), angle = 2.39996323 * float(i);
        vec2 at = floor(gl_FragCoord.xy + u_smoothing * distance * vec2(cos(angle), sin(angle)));
        ivec2 pixel = ivec2(clamp(at, vec2(0.0), u_size - 1.0));
        vec2 offset = vec2(pixel) + 0.5 - gl_FragCoord.xy;
        uvec2 id = texelFetch(t_id, pixel, 0).rg;
        vec4 found = texelFetch(t_normal_depth, pixel, 0);
        vec3 normal = (id.g & SURFACE_TURNED) != 0u ? -found.xyz : found.xyz;
        vec3 away = eye_at(vec2(pixel) + 0.5, found.w) - p.eye;
        float step = abs(dot(p.normal, away)) / max(length(away), 1e-12);
        float weight = (1.0 - distance * distance) * smoothstep(0.3, 0.6, dot(normal, p.normal)) * (1.0 - smoothstep(0.65, 0.9, step));
        weight = id.r == p.part ? weight : 0.0;
        vec3 colour = sqrt(texelFetch(t_albedo, pixel, 0).rgb);
        float alike = weight * exp(-30.0 * dot(colour - own, colour - own));
        sum += weight * normal;
        across += weight * offset.x * normal;
        up += weight * offset.y * normal;
        offsets += weight * offset;
        squares += weight * offset * offset;
        weights += weight;
        level += dot(normal - p.normal, normal - p.normal) < 1e-4 ? weight : 0.0;
        colours += alike * colour;
        colour_weights += alike;
    }
    vec3 mean = sum / weights;
    /* A face that is flat stays so up to its edges: what lies beyond them does not lean into it. */
    float flatness = smoothstep(0.3, 0.5, level / weights);
    vec2 spread = max(squares - offsets * offsets / weights, vec2(1e-3)) / (1.0 - min(flatness, 0.999));
    return surroundings(normalize(mix(mean, p.normal, flatness)), (across - offsets.x * mean) / spread.x, (up - offsets.y * mean) / spread.y,
                        pow(colours / colour_weights, vec3(2.0)));
}
#endif

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

/* 1 in the middle of a stripe, 0 between two; each as strong as its own number says. */
float stripe(float along)
{
    float strength = 0.85 + 0.15 * corner_noise(hash_of(uvec3(uint(int(floor(along)) + 0x8000), 0u, 0u), 1u)).x;
    return strength * (1.0 - abs(2.0 * fract(along) - 1.0));
}

/* An inker's blacks: the fraction of the pixel that is ink. Strokes that feather them lie in planes of light: on any form these cross the border of light
 * and shadow at right angles. They keep their distance on the page within a factor of two: where it would grow beyond that, others come between. `slope`: how fast the form
 * turns towards the light here, by a pixel. */
float inked(surface_point p, float slope)
{
    vec3 light = towards_light(0, p.eye);
    float beyond = 0.5 + 0.5 * dot(p.normal, light) - 0.5 * u_blacks, reach = 0.0, reach_slope = 0.0;
    if (beyond > slope + u_feather)
        return 0.0;
    if (u_feather > 0.0) {
        vec3 first = normalize(cross(light, abs(light.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0))), second = cross(light, first);
        vec3 border = cross(p.normal, light);
        vec3 axis = abs(dot(first, border)) > abs(dot(second, border)) ? first : second;
        float along = dot((u_world_from_eye * vec4(p.eye, 1.0)).xyz, mat3(u_world_from_eye) * axis);
        float slope_along = length(vec2(dot(on_plane(p, vec2(1.0, 0.0)) - p.eye, axis), dot(on_plane(p, vec2(0.0, 1.0)) - p.eye, axis)));
        float octave = log2(max(slope_along * u_spacing, 1e-12)), part = fract(octave), pitch = exp2(octave - part);
        reach = u_feather * mix(stripe(along / pitch), stripe(0.5 * along / pitch), part);
        reach_slope = u_feather * slope_along / pitch * (2.0 - part);
    }
    float width = max(length(vec2(slope, reach_slope)), 1e-4);
    return clamp((reach - beyond) / width + 0.5, 0.0, 1.0);
}

vec4 surface_colour(surface_point p)
{
    p.albedo.rgb = lifted(p.albedo.rgb);
    if (p.unlit)
        return vec4(shown(p.albedo.rgb), 1.0);
#ifdef SHADED_LATER
    surroundings around = surroundings_of(p);
    surface_point right = p, above = p;
    p.normal = around.normal;
    p.albedo.rgb = lifted(around.albedo);
    right.normal = normalize(around.normal + around.across);
    above.normal = normalize(around.normal + around.up);
    float spot = highlight(p, 40.0), spot_slope = length(vec2(highlight(right, 40.0), highlight(above, 40.0)) - spot);
#else
    float spot = highlight(p, 40.0), spot_slope = fwidth(spot);
#endif
    /* The border of a hard shadow is that of its own tone, wherever the steps of light are. */
#ifdef HAS_SOFT_SHADOW
    float first = unshadowed(p), lit = 1.0;
#else
    float first = 1.0, lit = unshadowed(p);
#endif
    float light = tone_light(p, first), dark = tone_light(p, 0.0);
#ifdef SHADED_LATER
    vec2 others = vec2(tone_light(right, first), tone_light(above, first));
    vec2 dark_others = vec2(tone_light(right, 0.0), tone_light(above, 0.0));
    float slope = length(others - light), dark_slope = length(dark_others - dark);
#else
    float slope = fwidth(light), dark_slope = fwidth(dark);
#endif
    float tone = u_bands > 1 ? mix(banded(dark, dark_slope), banded(light, slope), lit) : 1.0;
    vec3 brightness = mix(u_shadow, u_light, tone) * mix(u_shade.rgb, vec3(1.0), tone);
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
#ifdef SHADED_LATER
        vec2 gradient = 0.5 * vec2(dot(right.normal - p.normal, towards), dot(above.normal - p.normal, towards));
#else
        float turned = dot(p.normal, towards);
        vec2 gradient = 0.5 * vec2(dFdx(turned), dFdy(turned));
#endif
        colour = mix(colour, u_ink.rgb, u_ink.a * inked(p, length(gradient)));
    }
    return vec4(colour, 1.0);
}
