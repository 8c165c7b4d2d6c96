/* Where copies of a line are looked up, and what their inks add up to. Seed 004, equations 4 and 5 and section 2.3. */
#ifndef SIZE_DECLARED
#define SIZE_DECLARED
uniform vec2 u_size;
#endif

#define LINE_COPIES (DARK + LIGHT)
#define JOINS_INK

uniform vec4 u_numbers[2 * LINE_COPIES + 1]; /* numbers_of in pencil.c */

vec2  s_place;
vec2  s_share; /* σ: the place as shares of the page */
vec2  s_fill;
float s_bare;
float s_fading; /* noise, 0 … 1 */
float s_streak;
vec4  s_dark, s_light;
vec3  s_through; /* what coloured pencils let through */

/* Sine of an angle up to some hundred radians, within 0.0011. */
vec2 near_sine(vec2 angle)
{
    vec2 turn = angle * 0.15915494 + 0.5;
    turn = (turn - floor(turn)) * 2.0 - 1.0; /* −1 … 1, half a turn on */
    vec2 arch = 4.0 * turn * (1.0 - abs(turn));
    return -arch * (0.775 + 0.225 * abs(arch)) * -1.0;
}

#ifdef WITH_OVERRUN
float band_noise(float band)
{
    uint hash = uint(int(band)) * 0x9e3779b1u;
    hash = (hash ^ (hash >> 15u)) * 0x2c1b3c6du;
    hash ^= hash >> 13u;
    return float(int(hash & 0xFFFFu)) * (2.0 / 65535.0) - 1.0;
}

/* The fill, moved along its strokes by another way in each band. */
vec2 overrun_place(vec2 at)
{
    vec2 along = u_perturb_overrun_angle;
    float across = dot(at, vec2(-along.y, along.x)) / u_perturb_overrun_width;
    float band = floor(across), share = across - band;
    float way = mix(band_noise(band), band_noise(band + 1.0), smoothstep(0.35, 0.65, share));
    return at + along * (u_perturb_overrun * way);
}
#endif

void find_places(ivec2 pixel)
{
    s_place = vec2(pixel);
    s_share = (s_place + 0.5) / u_size;
    s_dark = s_light = vec4(0.0);
    s_through = vec3(1.0);
    s_fading = s_streak = 1.0;
    s_bare = 1.0;
    s_fill = s_place;
#ifdef WITH_OVERRUN
    s_fill = overrun_place(s_place);
    ivec2 last = ivec2(u_size) - 1, at = ivec2(floor(s_fill + 0.5));
    bool inside = texelFetch(t_depth, pixel, 0).r < 1.0;
    bool found = texelFetch(t_depth, clamp(at, ivec2(0), last), 0).r < 1.0;
    s_bare = inside && !found ? 0.0 : 1.0;
    s_fill = inside && !found ? s_place : s_fill;
#endif
}

float fill_share()
{
    return s_bare;
}

vec2 fill_place()
{
    return s_fill;
}

/* Equations 4 and 5. */
vec2 line_place(int i)
{
    vec4 wave = u_numbers[2 * i], rest = u_numbers[2 * i + 1];
    /* A cosine is a sine a quarter turn on. */
    vec2 sway = near_sine(vec2(wave.x * s_share.y + wave.y, wave.z * s_share.x + wave.w + 1.5707963));
    return s_place + rest.z * sway - rest.xy;
}

/* Shown grey to light. */
float light_of_grey(float grey)
{
    return grey * (grey * (grey * 0.305306011 + 0.682171111) + 0.012522878);
}

void read_graphite()
{
    vec2 at = s_place / (u_perturb_grain * u_graphite_facts.x);
    s_fading = textureLod(t_graphite, vec3(at, 0.0), 0.0).r;
#ifdef WITH_TEXTURE
    s_streak = 1.0 - u_perturb_texture * (1.0 - textureLod(t_graphite, vec3(at, 1.0), 0.0).r);
#endif
}

vec4 ink_of_mean(vec4 mean);

/* Both groups as ink: light lines fade as if noise were bleached into them (Screen), and of both groups the darker one is seen (Darken). */
vec4 groups_joined()
{
    read_graphite();
    vec4 light = ink_of_mean(s_light / float(max(LIGHT, 1))) * (u_perturb_sketch * (1.0 - s_fading));
    vec4 dark = ink_of_mean(s_dark / float(max(DARK, 1)));
#ifdef WITH_PRESSURE
    dark *= 1.0 - u_perturb_pressure * (1.0 - s_fading);
#endif
    vec4 ink = dark.a >= light.a ? dark : light;
    float seen = ink.a * u_numbers[2 * LINE_COPIES].x * s_streak;
    return ink * ((1.0 - light_of_grey(1.0 - seen)) / max(ink.a, 1e-4));
}

vec4 joined_ink()
{
    vec4 ink = vec4(0.0);
    vec4 sum = s_dark + s_light;
    int drawn = sum.r + sum.g + sum.b + sum.a > 0.0 ? 1 : 0;
    for (int once = 0; once < drawn; once++)
        ink = groups_joined();
    return ink;
}

void join_copy(vec4 own, int i)
{
    if (i < DARK)
        s_dark += own;
    else
        s_light += own;
}
