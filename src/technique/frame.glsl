/* The frame's uniforms. They stand before every shader of a technique, which uses what it needs and declares none of them; what is not used costs nothing. Lights,
 * shadows, cut faces and depth focus have theirs beside their functions: light/light.glsl, light/shadow.glsl, light/cut.glsl, light/focus.glsl. Parameters
 * (u_KEY), pictures (t_NAME, HAS_NAME) and made textures are declared from their rows. */

/* The page, and how the viewer's rays run. */
uniform vec2  u_size;         /* of the page, pixels */
uniform vec2  u_texel;        /* 1 / u_size */
uniform float u_pixels_per_mm; /* of paper; lengths among parameters are in pixels already */
uniform float u_perspective;  /* 1, or 0 for parallel rays */
uniform vec2  u_unproject;    /* eye xy of a pixel = ndc · this · (depth, or 1 for parallel rays) */
uniform vec4  u_window_depth; /* of the projection: what makes window depth of eye depth */
uniform vec3  u_first_light;  /* towards the first light that has a direction, eye space */
uniform vec2  u_depths;       /* eye depth of the nearest and the farthest that is drawn */
uniform vec2  u_anchor;       /* where the middle of the model is on the page, pixels */
uniform vec3  u_tone_range;     /* tones that are drawn as no light, gain above, bend: src/plan/tone_range.h */
uniform float u_time;         /* seconds */
uniform vec4  u_height;       /* how high a place in eye space is above the figure's lowest: dot(u_height, vec4(place, 1)) */
uniform vec2  u_height_range; /* how high the lowest is in the file, and how much higher the highest */

/* The figure that is drawn, and the pass. */
uniform float u_near;         /* of the figure, eye depth */
uniform float u_far;
uniform vec4  u_around;       /* the pixels of its pictures that are its own: beyond the first and before the last ones there is nothing */
uniform int   u_figure;       /* its number among those that share their layers */
uniform int   u_layer;        /* 0 = visible */
uniform float u_rear;         /* opacity of layers behind an uncovered focus, 1 before */
uniform float u_forward;      /* window depth by which the figure is in front of what it lies on */
uniform vec4  u_ghost;         /* paper, and how much of the figure's colour it is: of ghost images */
uniform bool  u_filled;       /* with the fill, not only the lines */
uniform int   u_iteration;    /* of a pass that is repeated, from 0 */

/* From eye space to where the part is when nothing has moved. With the geometry: of its part. Later, from t_part_frames: surface/halftone/part_frame.glsl. */
uniform vec4  u_rest[3];      /* rows */
uniform vec3  u_upward;       /* which way is up there */
uniform vec3  u_level;        /* an axis of the part that is not */
uniform mat4  u_world_from_eye;
uniform sampler2D t_part_frames;
uniform int   u_only_part;    /* the part where there are no ids */

/* A figure's perturbation. */
uniform float u_cell;         /* side of a texel of coarse pictures, pixels */
uniform vec2  u_grid;         /* their size, texels */
uniform float u_reach;        /* largest displacement, pixels */
uniform uint  u_seed;
uniform float u_empty;        /* eye depth where nothing is drawn */

/* Where geometry or marks are drawn. */
uniform mat4  u_model_view;
uniform mat3  u_normal_matrix;
uniform mat4  u_projection;
uniform mat4  u_past_1;       /* to clip space, as it was earlier: from the geometry's axes, or without geometry from the eye's */
uniform mat4  u_past_2;
uniform mat4  u_past_3;
uniform mat4  u_past_4;

/* Pixels to 1/96 inch of paper: what is laid out on the page is laid out in these, so that it is the same in pictures of all sizes. */
float page_unit()
{
    return u_pixels_per_mm * (25.4 / 96.0);
}

/* Window depth from eye depth and back, of the frame's projection. */
float window_depth_at_eye(float eye)
{
    return 0.5 * (u_window_depth.y - u_window_depth.x * eye) / (u_window_depth.w - u_window_depth.z * eye) + 0.5;
}

float eye_depth_at_window(float window)
{
    float ndc = 2.0 * window - 1.0;
    return (u_window_depth.y - u_window_depth.w * ndc) / (u_window_depth.x - u_window_depth.z * ndc);
}
