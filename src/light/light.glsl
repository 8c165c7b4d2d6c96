/* The lights of the scene, as sums over all of them. */
#include "light/point.glsl"

uniform int  u_light_count;
uniform vec4 u_light_position[8]; /* w 0: unit direction to the light; w 1: its place. Eye space. */
uniform vec4 u_light_colour[8];   /* linear */

vec3 towards_light(int i, vec3 eye)
{
    vec4 light = u_light_position[i];
    return light.w > 0.5 ? normalize(light.xyz - eye) : light.xyz;
}

/* Sum of the lights' diffuse terms. */
vec3 diffuse_light(surface_point p)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 8 && i < u_light_count; i++)
        sum += u_light_colour[i].rgb * max(dot(p.normal, towards_light(i, p.eye)), 0.0);
    return sum;
}

/* Sum of half-Lambert terms, 0 … 1 for one white light: 0.5 at the terminator. */
float wrapped_light(surface_point p)
{
    float sum = 0.0;
    float total = 0.0;
    for (int i = 0; i < 8 && i < u_light_count; i++) {
        float strength = dot(u_light_colour[i].rgb, vec3(0.2126, 0.7152, 0.0722));
        sum += strength * (0.5 * dot(p.normal, towards_light(i, p.eye)) + 0.5);
        total += strength;
    }
    return total > 0.0 ? sum / total : 0.0;
}

/* Phong's highlight of the brightest light: reflected light direction against the viewer's. */
float highlight(surface_point p, float shininess)
{
    vec3 viewer = towards_viewer(p.eye);
    float best = 0.0;
    for (int i = 0; i < 8 && i < u_light_count; i++) {
        vec3 light = towards_light(i, p.eye);
        float facing = step(0.0, dot(p.normal, light));
        float strength = dot(u_light_colour[i].rgb, vec3(0.2126, 0.7152, 0.0722));
        best = max(best, strength * facing * pow(max(dot(reflect(-light, p.normal), viewer), 0.0), shininess));
    }
    return best;
}
