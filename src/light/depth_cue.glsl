/* Depth cue by colourfulness: what is farther has less of it and the same light. Weiskopf and Ertl 2002, a linear transformation towards the grey of a
 * colour's own luminance; Nienhaus 2005, section 4.8; row C06. */
uniform vec4 u_depth_cue; /* share of colourfulness that the farthest loses, eye depth of the nearest, 1 / range, 0 */

vec4 depth_cued(vec4 shade, float eye_depth)
{
    float lost = u_depth_cue.x * clamp((eye_depth - u_depth_cue.y) * u_depth_cue.z, 0.0, 1.0);
    vec3 light = light_shown_as(shade.rgb);
    return vec4(shown(mix(light, vec3(dot(light, vec3(0.2126, 0.7152, 0.0722))), lost)), shade.a);
}
