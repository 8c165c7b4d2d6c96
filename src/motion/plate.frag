/* A plate that is exposed once more: what differs most from the ground stays, dark on light as well as light on dark; but what moves hides what was there before it, unless it is to be seen through. Großmann 2011, section 2.1.4 (Marey's chronophotographs). */
layout(location = 0) out vec4 out_plate;
uniform sampler2D t_mean; /* the plate so far */
uniform sampler2D t_page;
uniform sampler2D t_moving; /* depth of what moves, and of all; as far as nothing: it is not there */
uniform sampler2D t_all;
uniform vec4  u_ground; /* premultiplied, as the page is */
uniform float u_ink;    /* of the new picture */
uniform int   u_first;
uniform int   u_hides;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 page = (texelFetch(t_page, pixel, 0) - u_ground) * u_ink, plate = u_first != 0 ? vec4(0.0) : texelFetch(t_mean, pixel, 0) - u_ground;
    float moving = u_hides != 0 ? texelFetch(t_moving, pixel, 0).r : 1.0;
    bool hides = moving < 1.0 && moving <= texelFetch(t_all, pixel, 0).r;
    out_plate = u_ground + (hides ? page : mix(plate, page, vec4(greaterThan(abs(page), abs(plate)))));
}
