/* What a surface technique knows about the place it colours. All vectors in eye space. What a technique answers is the colour that is shown, premultiplied. */
#include "light/shown.glsl"

struct surface_point {
    vec3 eye;     /* position */
    vec3 normal;  /* unit, towards the viewer's side */
    vec3 face;    /* unit, of the flat surface that is drawn there; `normal` where that is not known */
    vec4 albedo;  /* unlit colour of the model, light, straight alpha */
    bool unlit;   /* the file asks for no light here */
    uint part;    /* its number, where shading comes after the geometry; else 0 */
};

#ifdef HAS_FIELD
in vec3 v_field_diagonal; /* src/field/direction_field.h, eye space */
in vec3 v_field_sides;
#endif
#ifdef HAS_REST
in vec3 v_rest; /* where it is when nothing has moved, in its part's frame */
#endif
#ifdef HAS_FACTS
flat in vec4  v_own_colour; /* src/layer/raster.vert */
flat in uvec3 v_own;
#endif
#ifdef HAS_WALLS
in vec4 v_wall; /* src/stage/upload_walls.c */
#endif
#ifdef HAS_PATCHES
in vec4 v_patch;
uniform float u_patch_radius;
#endif
#ifdef HAS_UV
/* Texture coordinates of the position, for surfaces that are shaded with their geometry: as the material's own picture has them, and those that a
 * light map has: of the second set, where there is one. */
vec2 s_uv;
vec2 s_uv_unique;
#endif

/* Unit vector from the position to the viewer. */
vec3 towards_viewer(vec3 eye)
{
    return u_perspective > 0.5 ? -normalize(eye) : vec3(0.0, 0.0, 1.0);
}
