/* The light on a mesh, laid out by its texture coordinates. Freudenberg 2003, section 6.6.1; row IM-19. The surface technique says what light is. */
#include "light/point.glsl"
#include "layer/material.glsl"

uniform int u_unlit;
layout(location = 0) out vec4 out_light;

void main()
{
    vec4 albedo = model_colour();
    vec3 normal = model_normal();
    if (dot(normal, towards_viewer(v_eye)) < 0.0 && !gl_FrontFacing)
        normal = -normal;
    out_light = vec4(light_of(surface_point(v_eye, normal, normal, vec4(albedo.rgb, 1.0), u_unlit != 0, 0u)), 0.0, 0.0, 1.0);
}
