/* A plate that is exposed once more: what differs most from the ground stays, dark on light as well as light on dark. Großmann 2011, section 2.1.4 (Marey's chronophotographs). */
layout(location = 0) out vec4 out_plate;
uniform sampler2D t_mean; /* the plate so far */
uniform sampler2D t_page;
uniform vec4  u_ground; /* premultiplied, as the page is */
uniform float u_ink;    /* of the new picture */
uniform int   u_first;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 page = (texelFetch(t_page, pixel, 0) - u_ground) * u_ink, plate = u_first != 0 ? vec4(0.0) : texelFetch(t_mean, pixel, 0) - u_ground;
    out_plate = u_ground + mix(plate, page, vec4(greaterThan(abs(page), abs(plate))));
}
