/* A surface technique of the program's own, in a look that is made by calls: custom_surface MODEL OUT.png */
#include <limner/limner.h>
#include <stdio.h>

/* Contour lines of height in the eye's axes, over a tone that the light gives. */
static const char shader[] =
    "vec4 surface_colour(surface_point p)\n"
    "{\n"
    "    float height = p.eye.y / u_interval;\n"
    "    float line = 1.0 - smoothstep(0.0, u_width * fwidth(height), abs(fract(height) - 0.5));\n"
    "    vec3 ground = mix(u_low.rgb, u_high.rgb, wrapped_light(p));\n"
    "    return vec4(mix(ground, shown(0.25 * p.albedo.rgb), line), 1.0);\n"
    "}\n";

static const lmn_param_desc params[] = {
    {.key = "interval", .type = LMN_PARAM_FLOAT, .standard = "0.2", .min = 0.001, .max = 1000, .logarithmic = true},
    {.key = "width", .type = LMN_PARAM_FLOAT, .standard = "1", .max = 20, .unit = LMN_UNIT_POINTS},
    {.key = "low", .type = LMN_PARAM_COLOUR, .standard = "#35506b", .doc = "Colour away from the light."},
    {.key = "high", .type = LMN_PARAM_COLOUR, .standard = "#f4ead0", .doc = "Colour in the light."},
};

int main(int count, char **arguments)
{
    lmn_error          error = {0};
    lmn_techniques    *techniques = NULL;
    lmn_look          *look = NULL;
    lmn_scene         *scene = NULL;
    lmn_renderer      *renderer = NULL;
    lmn_drawing       *drawing = NULL;
    lmn_technique_desc heights = LMN_TECHNIQUE_DESC_INIT;
    lmn_look_desc      wanted = LMN_LOOK_DESC_INIT;
    lmn_draw_desc      desc = LMN_DRAW_DESC_INIT;
    heights.name = "heights", heights.glsl = shader, heights.params = params, heights.param_count = 4;
    desc.width = 320, desc.height = 240;
    lmn_status status = count == 3 ? lmn_techniques_create(&techniques, &error) : LMN_USAGE;
    if (status == LMN_OK && (status = lmn_techniques_add(techniques, &heights, &error)) == LMN_OK) {
        wanted.techniques = techniques;
        status = lmn_look_open(&look, &wanted, &error);
    }
    if (status == LMN_OK && (status = lmn_look_set_technique(look, 0, "surface", 0, "heights", &error)) == LMN_OK)
        status = lmn_look_set_number(look, 0, "surface", 0, "interval", 0.1, &error);
    if (status == LMN_OK && (status = lmn_scene_create(&scene, &error)) == LMN_OK)
        status = lmn_scene_add_file(scene, arguments[1], NULL, &error);
    if (status == LMN_OK && (status = lmn_renderer_create(&renderer, NULL, &error)) == LMN_OK)
        status = lmn_draw(&drawing, renderer, scene, look, &desc, &error);
    if (status == LMN_OK)
        status = lmn_drawing_write(drawing, arguments[2], NULL, NULL, &error);
    if (status != LMN_OK)
        fprintf(stderr, "%s:%d: %s\n%s\n", error.file, error.line, error.message, error.hint);
    lmn_drawing_destroy(&drawing);
    lmn_renderer_destroy(&renderer);
    lmn_scene_destroy(&scene);
    lmn_look_destroy(&look);
    lmn_techniques_destroy(&techniques);
    return status != LMN_OK;
}
