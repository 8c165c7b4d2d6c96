/* Where copies of a line are looked up, and what their inks add up to. Müller, equations 4 and 5 and section 2.3. */

#define LINE_COPIES (DARK + LIGHT)
#define JOINS_INK
#ifdef BROAD_LINES
#undef BROAD_LINES
#endif
#ifndef WITH_OVERRUN
#define FILL_STAYS
#endif

uniform vec4 u_numbers[2 * LINE_COPIES + 1]; /* numbers_of in pencil.c */

vec2  s_position;
vec2  s_fraction; /* σ: the position as fractions of the page */
vec2  s_fill;
float s_bare;
float s_fading; /* noise, 0 … 1 */
float s_streak;
vec4  s_dark, s_light;

/* Sine of an angle up to some hundred radians, within 0.00002. */
vec2 near_sine(vec2 angle)
{
    vec2 turn = angle * 0.15915494 + 0.5;
    turn = (turn - floor(turn)) * 2.0 - 1.0; /* in half turns, −1 … 1 */
    turn -= sign(turn) * max(2.0 * abs(turn) - 1.0, vec2(0.0)); /* the same sine in −1/2 … 1/2 */
    vec2 square = turn * turn;
    return turn * (3.1415904 + square * (-5.1676023 + square * (2.5442290 + square * -0.5557037)));
}

#ifdef WITH_OVERRUN
#include "gpu/hash.glsl"

float band_noise(float band)
{
    return corner_noise(uint(int(band)) * 0x9e3779b1u).x;
}

/* The fill, moved along its strokes by another way in each band. */
vec2 overrun_position(vec2 at)
{
    vec2 along = u_perturb_overrun_angle;
    float across = dot(at, vec2(-along.y, along.x)) / u_perturb_overrun_width;
    float band = floor(across), fraction = across - band;
    float amount = mix(band_noise(band), band_noise(band + 1.0), smoothstep(0.35, 0.65, fraction));
    return at + along * (u_perturb_overrun * amount);
}
#endif

void find_positions(ivec2 pixel)
{
    s_position = vec2(pixel);
    s_fraction = (s_position + 0.5) / u_size;
    s_dark = s_light = vec4(0.0);
    s_fading = s_streak = 1.0;
    s_bare = 1.0;
    s_fill = s_position;
#ifdef WITH_OVERRUN
    s_fill = overrun_position(s_position);
    ivec2 last = ivec2(u_size) - 1, at = ivec2(floor(s_fill + 0.5));
    bool inside = texelFetch(t_depth, pixel, 0).r < 1.0;
    bool found = texelFetch(t_depth, clamp(at, ivec2(0), last), 0).r < 1.0;
    s_bare = inside && !found ? 0.0 : 1.0;
    s_fill = inside && !found ? s_position : s_fill;
#endif
}

float fill_fraction()
{
    return s_bare;
}

vec2 fill_position()
{
    return s_fill;
}

/* Equations 4 and 5. */
vec2 line_position(int i)
{
    vec4 wave = u_numbers[2 * i], rest = u_numbers[2 * i + 1];
    /* A cosine is a sine a quarter turn on. */
    vec2 sway = near_sine(vec2(wave.x * s_fraction.y + wave.y, wave.z * s_fraction.x + wave.w + 1.5707963));
    return s_position + rest.z * sway - rest.xy;
}

void read_graphite()
{
    vec2 at = s_position / (u_perturb_grain * u_graphite_facts.x);
    vec2 grain = textureLod(t_graphite, vec3(at, 0.0), 0.0).rg;
    s_fading = grain.r;
#ifdef WITH_TEXTURE
    s_streak = 1.0 - u_perturb_texture * (1.0 - grain.g);
#endif
}

#ifdef HAS_LINES
/* The composition's: compose/joined.glsl. */
vec4 averaged_at(vec2 position, int i);
vec4 ink_of_mean(vec4 mean);

/* Row P34: coloured copies lie over each other, each takes its colour away from what comes through. As ink over white paper. */
vec4 coloured_ink(float darkest)
{
    vec3 through = vec3(1.0);
    for (int i = 0; i < DARK; i++) {
        vec4 pencil = u_perturb_colours[i % max(u_perturb_colours_count, 1)];
        through *= 1.0 - (1.0 - pencil.rgb) * (ink_of_mean(averaged_at(line_position(i), i)).a * darkest * pencil.a);
    }
    float bare = min(through.r, min(through.g, through.b));
    return vec4(through - bare, 1.0 - bare);
}

/* Both groups as ink: light lines fade as if noise were bleached into them (Screen), and of both groups the darker one is seen (Darken). */
vec4 joined_ink()
{
    read_graphite();
    vec4 light = ink_of_mean(s_light / float(max(LIGHT, 1))) * (u_perturb_sketch * (1.0 - s_fading));
    vec4 dark = ink_of_mean(s_dark / float(max(DARK, 1)));
    float force = s_streak;
#ifdef WITH_PRESSURE
    force *= dark.a >= light.a ? 1.0 - u_perturb_pressure * (1.0 - s_fading) : 1.0;
#endif
    float darkest = u_numbers[2 * LINE_COPIES].x * force;
    vec4 ink = dark.a >= light.a ? dark : light;
    ink *= darkest;
    int coloured = u_perturb_colours_count > 1 && dark.a >= light.a ? 1 : 0;
    for (int once = 0; once < coloured; once++)
        ink = coloured_ink(darkest);
    return ink;
}

void join_copy(vec4 own, int i)
{
    if (i < DARK)
        s_dark += own;
    else
        s_light += own;
}
#endif
