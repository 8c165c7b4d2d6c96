/* How much of the key light reaches a position: its depth as the light sees it against what is nearest there. Nothing where there is no shadow map. */
#ifdef HAS_SHADOW
uniform mat4 u_shadow_from_eye;  /* to 0 … 1 in all three */
uniform vec2 u_shadow_texel;     /* side of a texel: of the map, and in eye space */
uniform float u_shadow_pixel;    /* side of a pixel of the page, in texels, in perspective at distance 1 */

/* One comparison, for the few positions that nothing better is known of. */
float lit_once(vec3 eye, vec3 normal)
{
    vec3 at = (u_shadow_from_eye * vec4(eye + normal * (1.5 * u_shadow_texel.y), 1.0)).xyz;
    return step(min(at.z, 1.0), texelFetch(t_shadow, clamp(ivec2(at.xy / u_shadow_texel.x), ivec2(0), textureSize(t_shadow, 0) - 1), 0).r);
}

/* How the depth of a flat surface rises over the map, for each texel to the right and up. */
vec2 shadow_slope(vec3 normal)
{
    vec3 right = vec3(u_shadow_from_eye[0].x, u_shadow_from_eye[1].x, u_shadow_from_eye[2].x), up = vec3(u_shadow_from_eye[0].y, u_shadow_from_eye[1].y, u_shadow_from_eye[2].y),
         away = vec3(u_shadow_from_eye[0].z, u_shadow_from_eye[1].z, u_shadow_from_eye[2].z);
    float facing = dot(away, normal) / dot(away, away);
    vec2 turned = vec2(dot(right, normal) / dot(right, right), dot(up, normal) / dot(up, up));
    return -turned * u_shadow_texel.x / (facing < 0.0 ? min(facing, -1e-6) : max(facing, 1e-6));
}

/* How far a face is raised, for the square of the sine of the angle to its normal, as a share of what the map spans: that of a ball as large as that. */
const float RAISED = 0.4;

/* How far a face is turned away from the light of what it stands for, 0 … 1; faces tilted by more than 30 degrees stand for nothing else. */
float strays(vec3 normal, vec3 face, vec3 light)
{
    float tilt = 1.0 - dot(face, normal) * dot(face, normal);
    return smoothstep(0.0, 0.01, tilt) * (1.0 - smoothstep(0.2, 0.4, tilt)) * (1.0 - smoothstep(0.3, 0.6, dot(face, light))) * step(dot(face, light), dot(normal, light));
}

/* The mean of comparisons over the side of a pixel, one texel to three: the border of a shadow has no steps on the page, and what is finer than a pixel is a
 * tone. */
float lit_fraction(vec3 eye, vec3 normal, vec3 face, vec3 light)
{
    /* What is looked at is as deep as its face's plane is there; off that by as much as planes can differ within a texel. A face that turns away from the light while
     * the shape that it stands for does not would lie in the shadow of its neighbours: its position is raised to where that shape is. */
    float turned = dot(face, light), slope = sqrt(max(1.0 - turned * turned, 0.0)), tilt = min(1.0 - dot(face, normal) * dot(face, normal), 0.1); /* normal maps tilt farther */
    float raised = dot(normal, light) > 0.0 ? RAISED * tilt * (1.0 - smoothstep(0.0, 0.5, turned)) / u_shadow_texel.x : 0.0;
    vec3 at = (u_shadow_from_eye * vec4(eye + normal * (u_shadow_texel.y * (0.35 + 0.4 * slope + raised)), 1.0)).xyz;
    vec2 texel = at.xy / u_shadow_texel.x - 0.5, low = floor(texel), fraction = texel - low;
    ivec2 position = ivec2(low) - 1, last = textureSize(t_shadow, 0) - 1;
    float side = clamp(u_shadow_pixel * (u_perspective > 0.5 ? -eye.z : 1.0), 1.0, 3.0), reach = 0.5 * side + 0.5, sum = 0.0;
    vec2 rise = shadow_slope(turned > 0.0 ? face : normal);
    const vec4 steps = vec4(-1.0, 0.0, 1.0, 2.0);
    vec4 across = clamp(reach - abs(steps - fraction.x), 0.0, 1.0), along = clamp(reach - abs(steps - fraction.y), 0.0, 1.0);
    vec4 depths = at.z + rise.x * (steps - fraction.x);
#ifdef GL_ARB_texture_gather
    for (int half_ = 0; half_ < 2; half_++) {
        vec4 a = textureGather(t_shadow, (low + vec2(0.0, 2.0 * float(half_))) / vec2(textureSize(t_shadow, 0))), b = textureGather(t_shadow, (low + vec2(2.0, 2.0 * float(half_))) / vec2(textureSize(t_shadow, 0)));
        vec4 lower = vec4(a.wz, b.wz), upper = vec4(a.xy, b.xy);
        int row = 2 * half_;
        sum += along[row] * dot(step(min(depths + rise.y * (steps[row] - fraction.y), 1.0), lower), across);
        sum += along[row + 1] * dot(step(min(depths + rise.y * (steps[row + 1] - fraction.y), 1.0), upper), across);
    }
#else
    for (int row = 0; row < 4; row++) {
        vec4 nearest;
        for (int column = 0; column < 4; column++)
            nearest[column] = texelFetch(t_shadow, clamp(position + ivec2(column, row), ivec2(0), last), 0).r;
        /* Beyond all that throws shadows, where nothing is nothing is in the way. */
        sum += along[row] * dot(step(min(depths + rise.y * (steps[row] - fraction.y), 1.0), nearest), across);
    }
#endif
    return sum / (side * side);
}
#endif
