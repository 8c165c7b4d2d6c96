/* What a surface technique knows about the place it colours. All vectors in eye space; colours linear. */
struct surface_point {
    vec3 eye;     /* position */
    vec3 normal;  /* unit, towards the viewer's side */
    vec4 albedo;  /* unlit colour of the model, straight alpha */
    bool unlit;   /* the file asks for no light here */
};

uniform float u_perspective; /* 1, or 0 for parallel rays */
uniform vec2  u_unproject;   /* eye xy of a pixel = ndc · this · (depth, or 1 for parallel rays) */

/* Unit vector from the place to the viewer. */
vec3 towards_viewer(vec3 eye)
{
    return u_perspective > 0.5 ? -normalize(eye) : vec3(0.0, 0.0, 1.0);
}
