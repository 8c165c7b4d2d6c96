/* What lies around a position of the page, for techniques that are shaded from the G-buffer and have u_smoothing, a radius in pixels. */
#ifdef SHADED_LATER
/* What a surface is like around a position of the page: its mean normal, by how much that turns a pixel to the right and up, its colour
 * without detail, and how much of the disc belongs to it: half along a straight border. */
struct surroundings {
    vec3  normal, across, up, albedo;
    float own;
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
    float weights = 1.0, colour_weights = 1.0, level = 1.0, all = 1.0;
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
        float weight = (1.0 - distance * distance) * smoothstep(0.8, 0.9, dot(normal, p.normal)) * (1.0 - smoothstep(0.65, 0.9, step));
        weight = id.r == p.part ? weight : 0.0;
        vec3 colour = sqrt(texelFetch(t_albedo, pixel, 0).rgb);
        float alike = weight * exp(-30.0 * dot(colour - own, colour - own));
        sum += weight * normal;
        across += weight * offset.x * normal;
        up += weight * offset.y * normal;
        offsets += weight * offset;
        squares += weight * offset * offset;
        weights += weight;
        all += 1.0 - distance * distance;
        level += dot(normal - p.normal, normal - p.normal) < 1e-4 ? weight : 0.0;
        colours += alike * colour;
        colour_weights += alike;
    }
    vec3 mean = sum / weights;
    /* A face that is flat stays so up to its edges: what lies beyond them does not lean into it. */
    float flatness = smoothstep(0.3, 0.5, level / weights);
    vec2 spread = max(squares - offsets * offsets / weights, vec2(1e-3)) / (1.0 - min(flatness, 0.999));
    return surroundings(normalize(mix(mean, p.normal, flatness)), (across - offsets.x * mean) / spread.x, (up - offsets.y * mean) / spread.y,
                        pow(colours / colour_weights, vec3(2.0)), weights / all);
}
#endif
