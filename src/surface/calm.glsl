/* The form around a position without what is smaller than a stroke of the brush, for techniques that are shaded from the G-buffer and have u_smoothing: a plane through what a disc shows of the same surface, for each number by itself
 * (local linear regression). So it is defined up to a surface's borders, and its slope with it: borders that follow it are calm and neither ragged nor blurred, and there are no specks. */
#ifdef SHADED_LATER
struct calm_form {
    vec3 normal, across, up; /* and by how much it turns a pixel to the right and up */
    vec3 deep;               /* share of the sky that is hidden, and by how much it changes */
};

float hidden_at(vec2 place)
{
#ifdef HAS_OCCLUSION
    return u_occlusion * (1.0 - texelFetch(t_visibility, clamp(ivec2(place), ivec2(0), textureSize(t_visibility, 0) - 1), 0).y);
#else
    return 0.0;
#endif
}

/* Where the small picture of what light arrives has the position, and how many of its pixels one of the page's is. */
vec4 place_in_visibility(surface_point p)
{
#ifdef HAS_OCCLUSION
    return vec4((p.eye.xy / (u_perspective > 0.5 ? -p.eye.z : 1.0) + u_unproject) / u_pixel, 2.0 * u_unproject / (u_size * u_pixel));
#else
    return vec4(0.0);
#endif
}

calm_form calm_form_of(surface_point p)
{
    const int TAPS = 20;
    const float WIDEST = 14.0; /* 1/96 inch */
    vec4 own = texelFetch(t_form, ivec2(gl_FragCoord.xy), 0), place = place_in_visibility(p);
    vec4 sum = vec4(own.xyz, hidden_at(place.xy)), sum_x = vec4(0.0), sum_y = vec4(0.0);
    vec2 offsets = vec2(0.0), squares = vec2(0.0);
    float weights = 1.0, level = 1.0, radius = min(0.25 * u_smoothing, WIDEST * page_unit());
    for (int i = 0; i < TAPS; i++) {
        float distance = sqrt((float(i) + 0.5) / float(TAPS)), angle = 2.39996323 * float(i);
        vec2 at = clamp(floor(gl_FragCoord.xy + radius * distance * vec2(cos(angle), sin(angle))) + 0.5, vec2(0.5), u_size - 0.5), off = at - gl_FragCoord.xy;
        vec4 form = texelFetch(t_form, ivec2(at), 0);
        float weight = smoothstep(0.5, 0.85, dot(form.xyz, own.xyz)) * (1.0 - 0.8 * distance * distance);
        weight = texelFetch(t_id, ivec2(at), 0).r == p.part ? weight : 0.0;
        vec4 value = weight * vec4(form.xyz, hidden_at(place.xy + off * place.zw));
        weights += weight;
        level += dot(form.xyz - own.xyz, form.xyz - own.xyz) < 1e-6 ? weight : 0.0;
        sum += value;
        sum_x += off.x * value;
        sum_y += off.y * value;
        offsets += weight * off;
        squares += weight * off * off;
    }
    vec2 middle = offsets / weights, spread = max(squares - offsets * middle, vec2(0.25));
    vec4 across = (sum_x - middle.x * sum) / spread.x, up = (sum_y - middle.y * sum) / spread.y, mean = sum / weights - across * middle.x - up * middle.y;
    /* A face that is flat stays so up to its edges. */
    float bent = 1.0 - smoothstep(0.36, 0.5, level / weights);
    return calm_form(normalize(mix(own.xyz, mean.xyz, bent)), bent * across.xyz, bent * up.xyz, vec3(mean.w, across.w, up.w));
}
#endif
