/* The side of a stick on paper: smears, strokes over them, teeth. Layers are independent of each other, so that the mean of what they leave is the product of their
 * means; all are dealt out so that this is even in tone. */
#include "surface/halftone/position.glsl"
#include "surface/halftone/tone.glsl"
#include "surface/halftone/screen.glsl"
#include "surface/halftone/paper_of.glsl"

surface_point s_point;
rest_position s_rest;
float         s_contact; /* of the paper here, 0 … 1: how early a stick touches it */
vec2          s_hand;          /* where the hand is, pixels along and across the stroke */
float         s_pressed = 0.5; /* how hard the hand presses here, 0 … 1 */

const float BROAD = 18.0;  /* how much wider the hand's pressure varies than teeth do */
const float ALONG = 0.35;  /* of that along strokes, and */
const float ACROSS = 1.5;  /* across them */
const float PRESSED = 0.3; /* weight of it against theirs */
const float UNEVEN = 0.3;  /* how much of a rubbed tone goes with it */

#include "gpu/even_sum.glsl"

#define MIXES_TONES 1
#include "surface/halftone/tones.glsl"

/* Cosine and sine of some degrees, up to a right angle. */
vec2 turn_of_degrees(float degrees)
{
    return vec2(cos(degrees * 0.017453293), sin(degrees * 0.017453293));
}

const float FIRST = 1.5; /* how much broader strokes are the first time over */
float s_size = 1.0;      /* of strokes, times their own */

#define STROKE_SIZE s_size
#include "surface/halftone/map_strokes.glsl"

/* What one time over leaves, before the paper has its say: even in darkness up to 1. First with the whole side of the stick, then with less of it. */
float gone_over(float darkness, int layer)
{
    s_size = layer == 0 ? FIRST : 1.0;
#ifdef HAS_FORM
    s_between = 0.5 * float(layer);
#endif
    vec2 turn = turns_added(u_angle, turn_of_degrees(layer == 0 ? -u_vary : u_vary));
    float bare = 1.0;
    for (int i = 0; i < PLANES; i++) {
        stroke_plane s = plane_of(s_point, s_rest, i, turn);
        int there = s.weight > 0.01 ? 1 : 0;
        for (int once = 0; once < there; once++)
            bare *= 1.0 - strokes_at(s, darkness_of_fraction(min(darkness, u_tones_facts.w), s.weight), vec2(0.37, 0.61) * float(layer + 2 * int(s.key & 15u)));
    }
    return 1.0 - bare;
}

/* Light touches reach the highest teeth alone and leave little on them, heavy ones fill the valleys. Contacts are even, so that the mean of a ramp over them is its
 * area: it is as steep for all pressures, and moves. */
float on_teeth(float cover)
{
    const float SOFT = 0.6;
    float light = min(cover, 1.0 - cover), height = cover < 0.5 ? s_contact : 1.0 - s_contact;
    float start = light < 0.5 * SOFT ? sqrt(2.0 * SOFT * light) : light + 0.5 * SOFT;
    float left = clamp((height - 1.0 + start) / SOFT, 0.0, 1.0);
    return mix(cover, cover < 0.5 ? left : 1.0 - left, u_tooth);
}

/* How much of a darkness is rubbed smooth under the strokes: what is dark has been gone over with the hand, in what is light strokes stand alone. */
float rubbed_of(float darkness)
{
    return 1.0 - pow(1.0 - darkness, u_smear * mix(0.3, 1.0, darkness));
}

/* The hand rubs here more and there less. */
float rubbed_here(float rubbed)
{
    return rubbed + min(rubbed, 1.0 - rubbed) * UNEVEN * (2.0 * s_pressed - 1.0);
}

/* The fraction of the paper that one stick covers for a darkness. */
float stick_cover(float darkness, int layer)
{
    float rubbed = rubbed_of(darkness), strokes = 1.0 - (1.0 - darkness) / max(1.0 - rubbed, 1e-4);
    return 1.0 - (1.0 - rubbed_here(rubbed)) * (1.0 - on_teeth(gone_over(strokes, layer)));
}

float stick_cover_twice(float darkness)
{
    float rubbed = rubbed_of(darkness), strokes = 1.0 - sqrt((1.0 - darkness) / max(1.0 - rubbed, 1e-4));
    float cover = 1.0 - (1.0 - gone_over(strokes, 0)) * (1.0 - gone_over(strokes, 1));
    return 1.0 - (1.0 - rubbed_here(rubbed)) * (1.0 - on_teeth(cover));
}

/* Where the hand is: its pressure varies less along strokes than across them. */
vec2 hand_at(vec2 at)
{
#ifdef HAS_FORM
    stroke_plane first = plane_of(s_point, s_rest, 0, u_angle), second = plane_of(s_point, s_rest, 1, u_angle);
    stroke_plane s = first.weight > second.weight ? first : second;
    return s.at * page_unit() * vec2(ALONG, ACROSS);
#else
    return at;
#endif
}

/* How early the paper is touched at a place of it: by its teeth, and by how hard the hand presses there. */
float contact_at(vec2 at)
{
#ifdef HAS_TEETH
    vec2 texel = at / (u_teeth_facts.x * u_tooth_size * 0.25);
    vec2 found = vec2(textureLod(t_teeth, vec3(texel, 0.0), 0.0).r, textureLod(t_teeth, vec3((s_hand + at - gl_FragCoord.xy + u_anchor) / (u_teeth_facts.x * u_tooth_size * 0.25 * BROAD) + vec2(0.31, 0.57), 0.0), 0.0).r) * (255.0 / 256.0) + 0.5 / 256.0;
    s_pressed = found.y;
    return even_sum(found, PRESSED);
#else
    return 0.5;
#endif
}

#if MEDIUM == 1
/* The first stick takes the light half, the second comes with the dark; together as much as is wanted. a, b: of the paper's light that each takes at most. */
vec4 two_sticks(vec4 paper, vec3 own, float darkness)
{
    /* Greys live by the two colours alone; what has a colour keeps it, and a little more of it than it has, since paper shows through. */
    float grey = 1.0 - 0.7 * smoothstep(0.08, 0.4, max(own.r, max(own.g, own.b)) - min(own.r, min(own.g, own.b)));
    own = clamp(mix(vec3(dot(own, LUMINANCE)), own, 1.2), 0.0, 1.0);
    vec3 warm = mix(vec3(1.0), u_second_ink.rgb, grey), cool = mix(vec3(dot(u_ink.rgb, LUMINANCE)), u_ink.rgb, grey);
    vec3 first = mix(u_second_ink.rgb, own * warm, u_ink_tint), second = mix(u_ink.rgb, own * cool, u_ink_tint);
    float white = max(dot(paper.rgb, LUMINANCE), 1e-3);
    float a = clamp(1.0 - dot(first, LUMINANCE) , 0.02, 1.0), b = clamp(1.0 - dot(second, LUMINANCE), 0.02, 1.0);
    float most = u_darkest, whole = 1.0 - (1.0 - most * a) * (1.0 - most * b), wanted = darkness * whole;
    float light = min(most * (1.0 - pow(1.0 - darkness, 1.6)), wanted / a);
    float dark = clamp((1.0 - (1.0 - wanted) / (1.0 - light * a)) / b, 0.0, most);
    vec3 left = (1.0 - stick_cover(light, 0) * (1.0 - first)) * (1.0 - stick_cover(dark, 1) * (1.0 - second));
    return vec4(paper.rgb * left, paper.a);
}
#elif MEDIUM == 2
const float BOTH = 0.18; /* of the sticks at the paper's own tone, */
const float SPAN = 0.4; /* and how far from it, of all there is to either side, they lie together */

/* White from the paper's own tone up, black from there down. */
vec4 toned(vec4 paper, vec3 own, float tone)
{
    /* What has a colour gets pastels of it, light ones and deep ones; of greys black takes less, so that shades stay deep. */
    float colourful = smoothstep(0.1, 0.35, max(own.r, max(own.g, own.b)) - min(own.r, min(own.g, own.b)));
    vec3 pale = mix(own, vec3(1.0), 0.35 * colourful);
    vec3 white = mix(u_ink.rgb, pale, min(mix(1.0, 2.0, colourful) * u_ink_tint, 1.0)), black = mix(u_second_ink.rgb, own * 0.4, min(mix(0.45, 1.6, colourful) * u_ink_tint, 1.0));
    float w = dot(white, LUMINANCE), b = dot(black, LUMINANCE), g = dot(paper.rgb, LUMINANCE);
    float up = max(w - g, 0.02) * u_darkest, down = max(g - b, 0.02) * u_darkest, middle = down / (up + down);
    float above = clamp((tone - middle) / (1.0 - middle), 0.0, 1.0), below = clamp((middle - tone) / middle, 0.0, 1.0);
    /* Around the paper's own tone some of both lies, which together leave the tone. */
    float both = BOTH * max(1.0 - max(above, below) / SPAN, 0.0), dark = min(below + both, 1.0) * u_darkest;
    float wanted = g + up * above - down * below, light = clamp(((wanted - b * dark) / (1.0 - dark) - g) / max(w - g, 0.02), 0.0, u_darkest);
    vec4 page = paper;
    if (light > 0.0)
        page = mix(page, vec4(white, 1.0), stick_cover_twice(light));
    s_contact = contact_at(gl_FragCoord.xy - u_anchor + vec2(337.0, 89.0) * page_unit());
    if (dark > 0.0)
        page = mix(page, vec4(black, 1.0), stick_cover_twice(dark));
    return page;
}
#endif

vec4 surface_colour(surface_point p)
{
    s_point = p;
    s_rest = position_at_rest(p);
    s_hand = hand_at(gl_FragCoord.xy - u_anchor);
    s_contact = contact_at(gl_FragCoord.xy - u_anchor);
    float tone = tone_of_light(p, light_of(p));
#ifdef ON_GROUND
    vec3 own = vec3(1.0); /* the ground has no colour of its own */
#else
    tone += u_gloss * highlight(p, 40.0);
#ifdef HAS_OCCLUSION
    /* Where a part of the sky is shut out that is seen, whatever the tone misses for it. */
    tone -= u_accent * smoothstep(0.08, 0.45, (1.0 - sky_fraction(p)) / max(u_occlusion, 0.01));
#endif
    vec3 own = shown(p.albedo.rgb);
#endif
    tone = 1.0 - focused(p, 1.0 - clamp(tone, 0.0, 1.0));
    vec4 paper = paper_of(p);
#if MEDIUM == 1
    return two_sticks(paper, own, 1.0 - tone);
#elif MEDIUM == 2
#ifdef ON_GROUND
    return mix(paper, vec4(u_second_ink.rgb, 1.0), stick_cover_twice((1.0 - tone) * u_darkest));
#else
    return toned(paper, own, tone);
#endif
#else
    vec3 ink = mix(u_ink.rgb, own, u_ink_tint);
    return mix(paper, vec4(ink, 1.0), stick_cover_twice((1.0 - tone) * u_darkest) * u_ink.a);
#endif
}
