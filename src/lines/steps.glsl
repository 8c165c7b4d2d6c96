/* Steps of depth between pairs of pixels, along an outline. Where it runs out on a smooth body what is behind it is hardly deeper, and pixels find a step here and there: lines would
 * end in dots. What is much deeper is an outline wherever pixels find it. */
const int STEPS_LEAST = 12, STEPS_MOST = 48; /* pixels that are looked at to either side */
const int STEPS_NONE = 2; /* where the first few find nothing there is nothing */
const float WIDTHS = 6.0;                      /* of the line, as far as that goes */
const float STEPS_FEW = 0.6, STEPS_MANY = 0.8; /* of them; between them the outline fades out */
const float MUCH_DEEPER = 8.0; /* times the least step, and what its own slope explains */

float step_beside(ivec2 at)
{
    vec2 own = texelFetch(t_pairs, at, 0).xy;
    return max(max(own.x, own.y), max(texelFetch(t_pairs, max(at - ivec2(1, 0), ivec2(0)), 0).x, texelFetch(t_pairs, max(at - ivec2(0, 1), ivec2(0)), 0).y));
}

/* How much of an outline the picture has at a position of its axis: depth steps between pixels on its sides. */
float step_at(vec2 axis, vec2 normal)
{
    ivec2 last = ivec2(u_size) - 1;
    return max(step_beside(clamp(ivec2(axis + 0.5 * normal), ivec2(0), last)), step_beside(clamp(ivec2(axis - 0.5 * normal), ivec2(0), last)));
}

/* The same along the outline: 1 where it goes on to one side or the other; `here`: at the position. */
float steps_along(vec2 axis, vec2 normal, float here)
{
    vec2 along = vec2(-normal.y, normal.x), sums = vec2(here);
    int farthest = clamp(int(WIDTHS * u_line_width), STEPS_LEAST, STEPS_MOST), last = farthest;
    float share = 1.0 / float(farthest + 1);
    for (int i = 1; i <= last; i++) {
        sums += vec2(step_at(axis + float(i) * along, normal), step_at(axis - float(i) * along, normal));
        bool none = i >= STEPS_NONE && max(sums.x, sums.y) == 0.0;
        last = none || share * (max(sums.x, sums.y) + float(farthest - i)) < STEPS_FEW ? 0 : last;
    }
    return share * max(sums.x, sums.y);
}

/* Is what lies behind, of this window depth and this slope, so much deeper that the step cannot be doubted? */
bool is_much_deeper(float near, float far, float slope)
{
    float away = u_far - near * (u_far - u_near), least = u_line_step * (u_perspective > 0.5 ? away * away / (u_near * u_far) : 1.0);
    return far >= 1.0 || far - near > MUCH_DEEPER * max(least, abs(slope));
}
