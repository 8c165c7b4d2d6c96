/* Where lines and fill are looked up. Nienhaus 2005, section 6.3 and listing 6-1; Nienhaus et al. 2006, section 4. */
#include "perturb/field.glsl"
#include "gpu/hash.glsl"

#define LINE_COPIES REPEAT

vec3  s_uncertainty;
vec2  s_position;
vec4  s_grain; /* displacement of this grain: of lines, of fill */
vec2  s_bare;  /* what is left of lines and of fill */

/* To be called first. */
void find_positions(ivec2 pixel)
{
    s_position = vec2(pixel);
    s_uncertainty = uncertainty_at(pixel);
    s_grain = vec4(0.0);
    s_bare = vec2(1.0);
    int grainy = u_perturb_rough + u_perturb_tooth > 0.0 ? 1 : 0;
    for (int once = 0; once < grainy; once++) {
        uvec3 position = uvec3(uvec2(vec2(pixel) / u_perturb_grain), 0u);
        uvec3 hash = uvec3(hash_of(position, u_seed), hash_of(position, u_seed + 1u), hash_of(position, u_seed + 2u));
        s_grain = (vec4(hash.xy & 65535u, hash.xy >> 16u) * (2.0 / 65535.0) - 1.0) * (u_perturb_rough * border_fraction(pixel));
        float height = float(hash.z >> 8u) / 16777215.0;
        s_bare = clamp(1.0 + 5.0 * (height - u_perturb_tooth * vec2(0.5, 1.0)), 0.0, 1.0);
    }
}

float fill_fraction()
{
    return s_bare.y;
}

vec2 fill_position()
{
    mat2 degree = mat2(u_perturb_shades_xx, u_perturb_shades_yx, u_perturb_shades_xy, u_perturb_shades_yy);
    return s_position + u_perturb_amount * (degree * s_uncertainty.xy) + s_grain.zw;
}

/* Of the i-th repetition. Section 6.6: each has a degree of uncertainty of its own. */
vec2 line_position(int i)
{
    mat2 degree = mat2(u_perturb_edges_xx, u_perturb_edges_yx, u_perturb_edges_xy, u_perturb_edges_yy);
    vec2 direction = s_uncertainty.xy;
#if REPEAT > 1
    float angle = 6.2831853 * float(i) / float(REPEAT);
    direction = mat2(cos(angle), sin(angle), -sin(angle), cos(angle)) * direction * pow(u_perturb_repeat_degree, float(i));
#endif
    return s_position + u_perturb_amount * (degree * direction) + s_grain.xy;
}

/* Fraction of its ink that a line loses where it is eased most; broad ones thin instead. */
#ifdef BROAD_LINES
#define EASED_AWAY 0.2
#else
#define EASED_AWAY 0.6
#endif

/* The ink that the i-th repetition leaves. Pressed, the soft rims of a line fill and it grows wider; eased, they go first and it thins. */
vec4 copy_ink(vec4 ink, int i)
{
    float force = u_perturb_pressure * ((i & 1) == 0 ? s_uncertainty.z : -s_uncertainty.z);
    float pressed = min(ink.a * (1.0 + 4.0 * max(force, 0.0)), 1.0);
    float eased = max(1.0 - (1.0 - pressed) * (1.0 + 1.5 * max(-force, 0.0)), 0.0) * (1.0 - EASED_AWAY * max(-force, 0.0));
    ink *= s_bare.x * eased / max(ink.a, 1e-4);
    if (i > 0) {
        vec4 colour = u_perturb_repeat_colours[(i - 1) % u_perturb_repeat_colours_count];
        ink = vec4(colour.rgb, 1.0) * (ink.a * colour.a);
    }
    return ink;
}

#ifdef BROAD_LINES
/* How much thicker lines are at most, pixels, and how much thicker (or, negative, thinner) they are here; thin ones are all rim. */
float most_broadening()
{
    return 0.75 * u_perturb_pressure * (u_line_width - 1.0);
}

float broadening()
{
    return most_broadening() * s_uncertainty.z;
}
#endif
