/* The lights of the scene, as sums over all of them. */
#include "light/point.glsl"

/* The number of lights is a constant, so that loops over them are unrolled: on a software driver they cost twice as much. */
uniform vec4 u_light_position[LIGHT_COUNT]; /* w 0: unit direction to the light; w 1: its position. Eye space. */
uniform vec4 u_light_colour[LIGHT_COUNT];   /* light */

#include "light/shadow.glsl"
#if defined(HAS_SOFT_SHADOW) || defined(HAS_OCCLUSION)
#include "light/arrived.glsl"
#endif

vec3 towards_light(int i, vec3 eye)
{
    vec4 light = u_light_position[i];
    return light.w > 0.5 ? normalize(light.xyz - eye) : light.xyz;
}

/* Fraction of the first light that is not kept off by what lies between; the others have no shadows. Asked for outside of loops over lights: those with loops
 * inside are not unrolled. */
float unshadowed(surface_point p)
{
#if defined(HAS_SOFT_SHADOW)
    arrived_light arrived = light_at(p);
    float light = arrived.known ? arrived.light : lit_once(p.eye, p.normal), stray = strays(p.normal, p.face, towards_light(0, p.eye));
    /* What was found for such a face is the shadow of its neighbours. */
    if (stray > 0.0 && light < 1.0)
        light = mix(light, max(light, lit_fraction(p.eye, p.normal, p.face, towards_light(0, p.eye))), stray);
    return light;
#elif defined(LIT_WITH_SHADOW)
    return lit_fraction(p.eye, p.normal, p.face, towards_light(0, p.eye));
#else
    return 1.0;
#endif
}

/* Fraction of all light that corners and clefts leave. */
float sky_fraction(surface_point p)
{
#ifdef HAS_OCCLUSION
    return light_at(p).sky;
#else
    return 1.0;
#endif
}

/* Sum of the lights' diffuse terms under an open sky; this fraction of the first one arrives. */
vec3 open_light_of(surface_point p, float first)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < LIGHT_COUNT; i++)
        sum += u_light_colour[i].rgb * (max(dot(p.normal, towards_light(i, p.eye)), 0.0) * (i == 0 ? first : 1.0));
    return sum;
}

/* The same where corners and clefts leave less of it. */
vec3 diffuse_light_of(surface_point p, float first)
{
    return open_light_of(p, first) * sky_fraction(p);
}

vec3 diffuse_light(surface_point p)
{
    return diffuse_light_of(p, unshadowed(p));
}

/* Sum of half-Lambert terms, 0 … 1 for one white light: 0.5 at the terminator. A rim light is from behind and lights what it meets alone, by Lambert's law: half of that law would reach
 * all that is seen. */
float wrapped_light(surface_point p)
{
    float sum = 0.0;
    float total = 0.0;
    float rim = 0.0;
    float first = unshadowed(p);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        float strength = dot(u_light_colour[i].rgb, vec3(0.2126, 0.7152, 0.0722));
        float turned = dot(p.normal, towards_light(i, p.eye));
        if (i == RIM_LIGHT) {
            rim = strength * max(turned, 0.0);
            continue;
        }
        sum += strength * (0.5 * (turned > 0.0 && i == 0 ? turned * first : turned) + 0.5);
        total += strength;
    }
    return total > 0.0 ? min(sum / total + rim, 1.0) * sky_fraction(p) : 0.0;
}

/* Phong's highlight of the key light: reflected light direction against the viewer's. One light, because two highlights on one
 * shape read as two materials. */
float highlight(surface_point p, float shininess)
{
#ifdef ON_GROUND
    return 0.0; /* paper has none */
#endif
    vec3 light = towards_light(0, p.eye);
    float strength = step(0.0, dot(p.normal, light)) * min(dot(u_light_colour[0].rgb, vec3(0.2126, 0.7152, 0.0722)), 1.0);
    return unshadowed(p) * sky_fraction(p) * strength * pow(max(dot(reflect(-light, p.normal), towards_viewer(p.eye)), 0.0), shininess);
}
