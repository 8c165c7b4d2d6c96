/* What lies around a position of the page, for techniques that are shaded from the G-buffer and have u_smoothing, a radius in pixels. */
#ifdef SHADED_LATER
#include "light/face.glsl"

/* What a surface is like around a position of the page: its normal over that radius (surface/form.frag), by how much that turns a pixel to the right and up, its colour
 * without detail, how much of a disc belongs to it, half along a straight border, and the light that shadows leave, the border of a hard one calm and a pixel wide. */
struct surroundings {
    vec3  normal, across, up, albedo;
    float own, light;
};

/* By how much the form changes from here to a pixel beside it, or away from the one on the other side; from a pixel of another surface nothing is learnt. */
vec4 change_of(surface_point p, vec4 own, ivec2 pixel, ivec2 axis)
{
    ivec2 last = ivec2(u_size) - 1, before = max(pixel - axis, ivec2(0)), behind = min(pixel + axis, last);
    vec4 lower = texelFetch(t_form, before, 0), upper = texelFetch(t_form, behind, 0);
    bool low = texelFetch(t_id, before, 0).r == p.part && dot(lower.xyz, own.xyz) > 0.85, high = texelFetch(t_id, behind, 0).r == p.part && dot(upper.xyz, own.xyz) > 0.85;
    return low && high ? 0.5 * (upper - lower) : low ? own - lower : high ? upper - own : vec4(0.0);
}

/* Colours over a disc of u_smoothing pixels, but at most COLOURS, or FLAT_COLOURS where they are to be flat: not across borders of parts, creases and steps of depth, and of them only those that are alike; and how much of the disc is the surface's own, if its `borders` are asked for. Taps lie on
 * Fermat's spiral, the same at each pixel, so that what comes out is as smooth as the weights are. */
surroundings surroundings_of(surface_point p, bool borders)
{
    const float UNLIKE = 0.03; /* as noise of compressed pictures is not */
    const int TAPS = 24, PROBES = 8, FLATTER = 5;
    const float COLOURS = 16.0, FLAT_COLOURS = 32.0; /* 1/96 inch */
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec3 own = sqrt(p.albedo.rgb), colours = own; /* as near to what is shown as it takes */
    float weights = 1.0, colour_weights = 1.0, all = 1.0, radius = min(u_smoothing, (borders ? COLOURS : FLAT_COLOURS) * page_unit());
    /* One colour all around, as most models have: there is nothing to smooth. */
    float unlike = borders ? 1.0 : 0.0;
    for (int i = 0; i < PROBES; i++) {
        float distance = i < PROBES / 2 ? 0.95 : 0.5, angle = 1.5707963 * float(i) + (i < PROBES / 2 ? 0.0 : 0.7853982);
        ivec2 pixel = ivec2(clamp(floor(gl_FragCoord.xy + radius * distance * vec2(cos(angle), sin(angle))), vec2(0.0), u_size - 1.0));
        vec3 off = abs(texelFetch(t_albedo, pixel, 0).rgb - p.albedo.rgb);
        unlike += texelFetch(t_id, pixel, 0).r == p.part ? off.r + off.g + off.b : 0.0;
    }
    int taps = unlike > UNLIKE ? TAPS : 0;
    vec4 seen[TAPS];
    for (int i = 0; i < taps; i++) {
        float distance = sqrt((float(i) + 0.5) / float(TAPS)), angle = 2.39996323 * float(i);
        vec2 at = floor(gl_FragCoord.xy + radius * distance * vec2(cos(angle), sin(angle)));
        ivec2 pixel = ivec2(clamp(at, vec2(0.0), u_size - 1.0));
        uvec2 id = texelFetch(t_id, pixel, 0).rg;
        vec4 found = texelFetch(t_normal_depth, pixel, 0);
        vec3 normal = (id.g & SURFACE_TURNED) != 0u ? -found.xyz : found.xyz;
        vec3 away = eye_of(vec2(pixel) + 0.5, found.w) - p.eye;
        float step = abs(dot(p.normal, away)) / max(length(away), 1e-12);
        float weight = (1.0 - distance * distance) * smoothstep(0.8, 0.9, dot(normal, p.normal)) * (1.0 - smoothstep(0.65, 0.9, step));
        weight = id.r == p.part ? weight : 0.0;
        vec3 colour = sqrt(texelFetch(t_albedo, pixel, 0).rgb);
        float alike = weight * exp(-30.0 * dot(colour - own, colour - own));
        weights += weight;
        all += 1.0 - distance * distance;
        colours += alike * colour;
        colour_weights += alike;
        seen[i] = vec4(colour, weight);
    }
    vec3 mean = colours / colour_weights;
    float kept = smoothstep(0.04, 0.14, (colour_weights - 1.0) / max(weights - 1.0, 1e-3)); /* a border's pixels are like none of its sides */
    /* From there uphill to what most of them are (mean shift, Comaniciu and Meer 2002): a glow goes to one of the colours it joins. */
    for (int round_ = 0; round_ < (borders || taps == 0 ? 0 : FLATTER); round_++) {
        float self = exp(-16.0 * dot(own - mean, own - mean));
        colours = self * own + 1e-4 * mean;
        colour_weights = self + 1e-4;
        for (int i = 0; i < taps; i++) {
            vec3 off = seen[i].rgb - mean;
            float alike = seen[i].w * exp(-16.0 * dot(off, off));
            colours += alike * seen[i].rgb;
            colour_weights += alike;
        }
        mean = colours / colour_weights;
    }
    vec4 form = texelFetch(t_form, here, 0), across = change_of(p, form, here, ivec2(1, 0)), up = change_of(p, form, here, ivec2(0, 1));
#ifdef HAS_SOFT_SHADOW
    float light = form.w;
#else
    float light = clamp((form.w - 0.5) / max(length(vec2(across.w, up.w)), 0.01) + 0.5, 0.0, 1.0);
#endif
    return surroundings(form.xyz, across.xyz, up.xyz, pow(borders || taps == 0 ? mean : mix(own, mean, kept), vec3(2.0)), weights / all, light);
}
#endif
