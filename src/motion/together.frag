/* Movers over the page: of each pixel the farthest first. Großmann 2011, section 6.5.2, for any number of objects. The sprites are premultiplied. */
#ifndef DEPTH_ALONE
layout(location = 0) out vec4 out_0;
#endif

vec4 colours[LAYERS];
float depths[LAYERS];

bool inside(vec4 box)
{
    return all(greaterThanEqual(gl_FragCoord.xy, box.xy)) && all(lessThan(gl_FragCoord.xy, box.zw));
}

void sort()
{
    for (int i = 1; i < LAYERS; i++)
        for (int k = i; k > 0 && depths[k - 1] < depths[k]; k--) {
            float depth = depths[k];
            vec4 colour = colours[k];
            depths[k] = depths[k - 1];
            colours[k] = colours[k - 1];
            depths[k - 1] = depth;
            colours[k - 1] = colour;
        }
}

/* Of the i-th mover. */
void take(int i, vec4 box, vec4 colour, float depth)
{
    bool there = inside(box);
    colours[i] = there ? colour : vec4(0.0);
    depths[i] = there ? depth : 1.0;
}

#define TAKE(i, box, colour, depth) take(i, box, texelFetch(colour, pixel, 0), texelFetch(depth, pixel, 0).r)

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    TAKE(0, u_box_0, t_colour_0, t_depth_0);
#if LAYERS > 1
    TAKE(1, u_box_1, t_colour_1, t_depth_1);
#endif
#if LAYERS > 2
    TAKE(2, u_box_2, t_colour_2, t_depth_2);
#endif
#if LAYERS > 3
    TAKE(3, u_box_3, t_colour_3, t_depth_3);
#endif
#if LAYERS > 4
    TAKE(4, u_box_4, t_colour_4, t_depth_4);
#endif
#if LAYERS > 5
    TAKE(5, u_box_5, t_colour_5, t_depth_5);
#endif
#if LAYERS > 6
    TAKE(6, u_box_6, t_colour_6, t_depth_6);
#endif
    sort();
    vec4 sum = vec4(0.0);
    float nearest = 1.0;
    for (int i = 0; i < LAYERS; i++) {
        sum = colours[i] + sum * (1.0 - colours[i].a);
        nearest = colours[i].a > 0.5 ? min(nearest, depths[i]) : nearest;
    }
#ifdef DEPTH_ALONE
    if (nearest >= 1.0)
        discard;
    gl_FragDepth = nearest;
#else
    if (sum.a <= 0.0)
        discard;
    out_0 = sum;
#endif
}
