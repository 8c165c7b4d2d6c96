/* Positions of the small picture of what light arrives; light/visibility.frag says what it holds. */

uniform vec2 u_pixel; /* of the small picture: its sides at depth 1, or for parallel rays */

const float EMPTY = -1e30; /* eye depth where there is nothing */

/* Where the ray through a position of the picture, in pixels, meets depth 1; u_pixel is twice u_unproject shared out. */
vec2 ray_of(vec2 at)
{
    return at * u_pixel - u_unproject;
}

vec3 on_ray(vec2 ray, float depth)
{
    return vec3(ray * (u_perspective > 0.5 ? depth : 1.0), -depth);
}

float pixel_size(float depth)
{
    return u_pixel.y * (u_perspective > 0.5 ? depth : 1.0);
}
