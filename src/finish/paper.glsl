/* Ink on a paper's grain. A position of contact c, of which each tenth covers a tenth of the sheet, gets (n + 1) cⁿ times its ink: for any n that is once on the
 * mean. Faint ink has a large n and stays on the hills; full ink has n = 0 and fills the valleys, or as much of them as its pressure does. */
uniform vec4 u_sheet;         /* the ground, premultiplied */
uniform vec4 u_range_below;    /* what the strongest ink takes from it, */
uniform vec4 u_range_above;    /* and what it adds */
uniform vec4 u_paper_position;   /* from pixels to the paper: turn and size, shift */
uniform vec4 u_paper_finer;   /* the same for the next octave */
uniform vec4 u_paper_pieces;  /* and for what tells its pieces apart */
uniform vec4 u_paper_fractions;  /* of the finer octave; of the pieces that begin again; how far those are shifted, of each octave */

const float FAINTEST = 3.0; /* n of the faintest ink on the deepest paper */

uniform vec3 u_paper_levels;  /* of the texture, for the three positions */

vec2 paper_at(vec4 position, vec2 pixel, float shift, float level)
{
    return textureLod(t_paper, vec3(position.x * pixel + position.y * vec2(-pixel.y, pixel.x) + position.zw + vec2(shift, 0.0), 0.0), level).rg;
}

#include "gpu/even_sum.glsl"

/* Contact, and light of the bare sheet. */
vec2 paper_here(vec2 pixel)
{
    float begins = 0.0;
#if MOTION > 0
    if (u_paper_fractions.y > 0.0)
        begins = float(paper_at(u_paper_pieces, pixel, 0.0, u_paper_levels.z).x < u_paper_fractions.y);
#endif
    vec2 here = paper_at(u_paper_position, pixel, begins * u_paper_fractions.z, u_paper_levels.x);
#if MOTION == 2
    vec2 finer = paper_at(u_paper_finer, pixel, begins * u_paper_fractions.w, u_paper_levels.y);
    here = vec2(even_sum(vec2(here.x, finer.x), u_paper_fractions.x), mix(here.y, finer.y, u_paper_fractions.x));
#endif
    return vec2(here.x * (255.0 / 256.0) + 0.5 / 256.0, here.y);
}

vec4 on_paper(vec4 page, vec2 pixel)
{
    vec2 here = paper_here(pixel);
    page.rgb = clamp(page.rgb, 0.0, page.a);
    vec4 more = page - u_sheet;
    vec4 range = mix(u_range_above, u_range_below, vec4(lessThan(more, vec4(0.0))));
    vec4 fractions = abs(more) / max(range, 1e-4);
    float ink = clamp(max(max(fractions.r, fractions.g), max(fractions.b, fractions.a)), 1e-4, 1.0);
    float n = u_paper_facts.w * min(1.0 / (ink * u_pressure) - 1.0, FAINTEST);
    page += more * min(u_grain * ((n + 1.0) * pow(here.x, n) - 1.0), 1.0 / ink - 1.0);
#ifdef WITH_RELIEF
    page.rgb *= pow(1.0 - u_relief * u_sheet.a * (1.0 - here.y), 1.0 / 2.2); /* light, as it is shown */
#endif
    return page;
}
