/* What of a mover crosses a pixel while the shutter is open. Großmann 2011, section 4.5: from the pixel towards where the surface that crosses it is now. What it shows at
 * a fraction s of the exposure ago is what is now s times its motion further on. The stretched surface guesses that motion, and the surface found there says it exactly, so
 * that what moves otherwise, in front or behind, is not taken for it; where nothing else is found, the surface that is at the pixel now shows as it moves itself. */
#include "motion/mover.glsl"

const float BESIDE = 12.0; /* pixels, as far as lines stand beside surfaces */

struct crossing {
    vec2  position; /* the pixel's middle */
    vec2  guess;    /* pixels moved by what sweeps the pixel */
    vec2  bend;     /* how much more is guessed for the whole exposure than for its end: things turn */
    vec2  own;      /* by what is there now */
    bool  there, apart; /* something crosses it; both move otherwise */
    float longest;  /* of both, pixels */
    float depth;    /* window depth of the nearest that sweeps it */
};

/* Beyond its pictures there is nothing, as along their border. */
vec2 within(vec2 position)
{
    return clamp(position, u_around.xy + 0.5, u_around.zw - 0.5);
}

vec4 velocity_at(vec2 position)
{
    return texelFetch(t_velocity, ivec2(within(position)), 0);
}

/* The nearest surface: lines beside it move as it does. w 0: it is too far away. */
vec4 nearest_to(vec2 position)
{
    vec4 near = texelFetch(t_nearest, ivec2(within(position)) / DIRECTION_APART, 0);
    return vec4(near.xyz, near.w > 0.0 && distance(near.zw, position) < BESIDE ? 1.0 : 0.0);
}

/* What turns has come from elsewhere than its motion here says: that of what has been here longest ago. */
vec2 bend_of(vec2 position, vec2 guess)
{
    vec4 found = velocity_at(position + guess), near = nearest_to(position + guess);
    vec2 other = (found.w > 0.0 ? found.xy : near.w > 0.0 ? near.xy : guess) - guess;
    return length(other) < 0.6 * length(guess) ? other : vec2(0.0);
}

/* Is the nearest surface near enough, or ahead, so that it may have been here? */
bool may_cross(vec2 to, vec2 moved)
{
    float far = length(to), way = length(moved);
    return far < BESIDE || (far < way + BESIDE && dot(to, moved) > -BESIDE * way);
}

crossing crossing_of(ivec2 pixel)
{
    crossing c;
    vec4 swept = texelFetch(t_stretched, pixel, 0), now = texelFetch(t_velocity, pixel, 0),
         near = texelFetch(t_nearest, pixel / DIRECTION_APART, 0);
    float depth = mover_depth_at(pixel);
    c.position = vec2(pixel) + 0.5;
    bool beside = near.w > 0.0 && may_cross(near.zw - c.position, near.xy);
    c.guess = swept.w > 0.0 ? swept.xy : now.w > 0.0 ? now.xy : near.xy;
    c.bend = bend_of(c.position, c.guess);
    c.own = now.w > 0.0 ? now.xy : c.guess;
    c.there = swept.w > 0.0 || now.w > 0.0 || beside || depth < 1.0;
    c.apart = distance(c.guess, c.own) > 0.5;
    c.longest = c.there ? max(length(c.guess), length(c.own)) : 0.0;
    c.depth = min(depth, swept.w > 0.0 ? swept.z : beside ? mover_depth_at(ivec2(near.zw)) : 1.0);
    return c;
}

/* How many samples tell what crosses it: each mixes two pixels, and short ways take one a pixel; 0: nothing does. */
int samples_of(crossing c, int most)
{
    return c.there ? clamp(int(ceil(max(0.5 * c.longest, min(c.longest, 8.0)))), 1, most) : 0;
}

/* The mover's colour at the pixel a fraction of the exposure ago, premultiplied. */
vec4 mover_ago(crossing c, float s)
{
    vec2 first = c.position + s * (c.guess + s * c.bend);
    vec4 found = velocity_at(first), near = nearest_to(first);
    vec2 moved = found.w > 0.0 ? found.xy : c.apart ? c.own : near.w > 0.0 ? near.xy : c.guess;
    return textureLod(t_mover, within(c.position + s * moved) * u_texel, 0.0);
}
