/* What is worked out twice, by the GPU for pictures and by the CPU for vectors and for what is made ahead, comes to the
 * same: functions of shaders, drawn into a picture of numbers, against their twins in C. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "field/lapped.h"
#include "gpu/gpu.h"
#include "marks/marks.h"

enum { SIDE = 256 };

/* Draws what `value` is, a vec4 of GLSL, where u and v go from 0 to 1 and x and y count pixels. */
static void values_of(float (*out)[4], const char *name, const char *includes, const char *value)
{
    gpu *g = NULL;
    char path[64], text[1000];
    DO(gpu_create(&g, false, false, &error));
    snprintf(path, sizeof path, "test/%s.frag", name);
    snprintf(text, sizeof text,
             "%s\nlayout(location = 0) out vec4 out_0;\nvoid main()\n{\nfloat x = floor(gl_FragCoord.x), y = "
             "floor(gl_FragCoord.y), u = x / 255.0, v = y / 255.0;\nout_0 = %s;\n}\n",
             includes, value);
    assert_true(gpu_give_source(g, path, name, text));
    gpu_program *p = gpu_program_of(g, GPU_FLOOR, "gpu/screen.vert", path, "");
    DO(gpu_check(g, &error));
    gpu_texture *t = gpu_target_acquire(g, SIDE, SIDE, GPU_RGBA32F);
    gpu_pass_begin(g, &(gpu_pass){.colours = {t}, .colour_count = 1, .clear = true});
    gpu_use(g, p, (gpu_state){0});
    gpu_draw_screen(g);
    gpu_read(g, t, out);
    gpu_target_release(g, t);
    DO(gpu_leave(g, LMN_OK, &error));
    gpu_destroy(&g);
}

static float values[SIDE * SIDE][4];

static void outlines_of_patches(void **state)
{
    (void)state;
    double worst = 0;
    values_of(values, "outline", "#include \"layer/patch.glsl\"",
              "vec4(patch_outline(6.2831853 * u - 3.14159265, y), x, y, 0.0)");
    for (int i = 0; i < SIDE * SIDE; i++) {
        double angle = 2 * 3.14159265358979 * (double)values[i][1] / 255 - 3.14159265358979;
        worst = fmax(worst, fabs((double)values[i][0] - lapped_outline((uint32_t)values[i][2], angle)));
    }
    print_message("outlines of patches: %.2g radii apart\n", worst);
    assert_true(worst < 2e-3); /* by less than what the outline on the CPU is smaller */
}

static void ink_of_dots(void **state)
{
    (void)state;
    static const float fades[] = {0.001f, 0.15f, 0.5f}, mosts[] = {1, 2.25f};
    for (int f = 0; f < 3; f++)
        for (int m = 0; m < 2; m++) {
            char   name[32], value[128];
            double worst = 0;
            snprintf(name, sizeof name, "dots%d%d", f, m);
            snprintf(value, sizeof value, "vec4(ink_of_rank(u, 1.5 * v, %.4f, %.4f), x, y, 0.0)", (double)mosts[m],
                     (double)fades[f]);
            values_of(values, name, "#include \"surface/marks_law.glsl\"", value);
            for (int i = 0; i < SIDE * SIDE; i++) {
                float rank = values[i][1] / 255, fraction = 1.5f * values[i][2] / 255;
                /* At the ramp's very middle a rounded rank decides. */
                if (fades[f] > 0.01f || fabsf(rank - fraction) > 0.004f)
                    worst = fmax(worst,
                                 fabs((double)(values[i][0] - mark_dot_ink(1 - rank, fraction, fades[f], mosts[m]))));
            }
            print_message("dots, ramp %g, growing to %g: %.2g apart\n", (double)fades[f], (double)mosts[m], worst);
            assert_true(worst < 1e-3);
        }
}

static void ink_of_covers(void **state)
{
    (void)state;
    double worst = 0;
    values_of(values, "cover", "#include \"surface/marks_law.glsl\"",
              "vec4(ink_of_cover(u, 0.5 + 4.0 * v), x, y, 0.0)");
    for (int i = 0; i < SIDE * SIDE; i++) {
        float diameter = 0.5f + 4 * values[i][2] / 255;
        worst = fmax(worst,
                     fabs((double)(values[i][0] - mark_ink_of_cover(values[i][1] / 255, 1 / (diameter * diameter)))));
    }
    print_message("ink of covers: %.2g apart\n", worst);
    assert_true(worst < 1e-3);
}

static void ink_of_strokes(void **state)
{
    (void)state;
    for (int series = 0; series <= 4; series++)
        for (int crowded = 0; crowded < 2; crowded++) {
            char   name[32], value[160];
            float  span = series ? 1 / (float)series : 0;
            double worst = 0;
            snprintf(name, sizeof name, "strokes%d%d", series, crowded);
            snprintf(value, sizeof value,
                     "vec4(min(ink_of_strokes(u, 0.1 + 2.4 * v, %.9f, %.2f), 0.1 + 2.4 * v), x, y, 0.0)", (double)span,
                     crowded ? 0.24 : 0);
            values_of(values, name, "#include \"surface/marks_law.glsl\"", value);
            for (int i = 0; i < SIDE * SIDE; i++) {
                float darkest = 0.1f + 2.4f * values[i][2] / 255;
                worst = fmax(worst, fabs((double)(values[i][0] - mark_ink_of_strokes(values[i][1] / 255, darkest, span,
                                                                                     crowded ? 0.24f : 0))));
            }
            print_message("strokes of %d sets, crowded %d: %.2g apart\n", series, crowded, worst);
            assert_true(worst < 2e-3);
        }
}

/* How far a place on a line is from the end of its stroke, pixels, when the line comes nearer: strokes are cut in two
 * where the cut grows out of nothing, so nothing jumps as they pass from one octave to the next. One line a row. */
static void strokes_are_cut_smoothly(void **state)
{
    (void)state;
    double worst = 0, mean = 0;
    values_of(values, "cuts",
              "#define u_length 8.0\n#define u_gap 2.0\n#define u_taper 100.0\n#include \"surface/stroke_cut.glsl\"",
              "vec4(100.0 * stroke_fraction(0.37 + 0.0713 * y, exp2(6.0 + 2.0 * u), uint(y) * 2654435769u + 1u, 1.0), "
              "x, y, 0.0)");
    for (int i = 0; i < SIDE * SIDE; i++) {
        mean += (double)values[i][0] / (SIDE * SIDE);
        if (i % SIDE)
            worst = fmax(worst, fabs((double)(values[i][0] - values[i - 1][0])));
    }
    print_message("strokes that come nearer: in steps of half a percent their ends move by %.2g px at most, of %.2g in "
                  "the mean\n",
                  worst, mean);
    assert_true(mean > 1);
    assert_true(worst < 0.6);
}

/* What discs on the corners of a lattice of squares cover of a cell: those that overlap count what lies beyond the
 * cell's sides once. */
static double cover_of_discs(double area)
{
    double radius = sqrt(area / 3.14159265358979), half = fmin(acos(fmin(0.5 / radius, 1)), 3.14159265358979 / 4);
    double beyond = radius * radius * (half - sin(half) * cos(half)); /* of a disc, over one side */
    return radius >= sqrt(0.5) ? 1 : area - 4 * beyond;
}

static void discs_cover_what_is_wanted(void **state)
{
    (void)state;
    double worst = 0;
    values_of(values, "discs", "#include \"surface/dot_area.glsl\"",
              "vec4(area_that_covers((x + 256.0 * y) / 65535.0), x, y, 0.0)");
    for (int i = 0; i < SIDE * SIDE; i++)
        worst = fmax(worst, fabs(cover_of_discs((double)values[i][0]) - i / 65535.0));
    print_message("cover of discs: %.2g from the wanted\n", worst);
    assert_true(worst < 0.011);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outlines_of_patches),
        cmocka_unit_test(ink_of_dots),
        cmocka_unit_test(ink_of_covers),
        cmocka_unit_test(ink_of_strokes),
        cmocka_unit_test(strokes_are_cut_smoothly),
        cmocka_unit_test(discs_cover_what_is_wanted),
    };
    return cmocka_run_group_tests_name("twins", tests, NULL, NULL);
}
