/* Which tone a position shall have, 0 … 1: from light, the model's own brightness, and what the look makes of both. Freudenberg 2003, sections 5.4.4 and 6.2. */
#include "light/light.glsl"
#ifdef HAS_FOCUS
#include "light/focus.glsl"
#endif

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

/* Brightness as the eye counts it: what looks half as bright shall get half the ink. */
float seen_brightness(vec3 linear)
{
    return pow(clamp(dot(linear, LUMINANCE), 0.0, 1.0), 1.0 / 2.2);
}

/* Whether strokes are lighter than the paper. What is transparent will lie on something, and that is taken for white. */
bool strokes_are_light()
{
    return dot(u_ink.rgb, LUMINANCE) > dot(mix(vec3(1.0), u_paper.rgb, u_paper.a), LUMINANCE);
}

/* Light strokes on dark paper stand for light. */
float darkness_of(float tone)
{
    return strokes_are_light() ? tone : 1.0 - tone;
}

#ifdef RANGED
float ranged(float tone)
{
    return pow(clamp((tone - u_tone_range.x) * u_tone_range.y, 0.0, 1.0), u_tone_range.z);
}
#endif

float tone_of_light(surface_point p, float light)
{
#ifdef ON_GROUND
    return p.albedo.a; /* found already: src/frame/ground.c */
#endif
    float bent = pow(clamp(light, 0.0, 1.0), u_contrast);
#ifdef WITH_TEXTURE
    float own = mix(1.0, seen_brightness(p.albedo.rgb), u_texture);
#else
    float own = 1.0;
#endif
#ifdef RANGED
    return mix(u_shadow, u_light, ranged(bent * own));
#else
    return mix(u_shadow, u_light, bent) * own;
#endif
}

/* What depth focus leaves of a darkness: fewer strokes, not paler ones. */
float focused(surface_point p, float darkness)
{
#ifdef HAS_FOCUS
    return darkness * in_focus(-p.eye.z);
#else
    return darkness;
#endif
}

/* Shade is kept transparent where a medium has all its tones: so much of the first light comes back into its shadows from what lies around, so that what is painted there is still told. Clefts
 * get none: occlusion takes from all light. */
const float REFLECTED = 0.3;

float light_of(surface_point p)
{
    if (p.unlit)
        return 1.0;
#ifdef RANGED
    return dot(diffuse_light_of(p, mix(REFLECTED, 1.0, unshadowed(p))), LUMINANCE);
#else
    return dot(diffuse_light(p), LUMINANCE);
#endif
}
