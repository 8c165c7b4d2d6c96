#include "stage/view.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "layer/layer.h"

void view_set_transform(gpu *g, const view_camera *camera, const mat4 *world)
{
    mat4  both = mat4_multiply(&camera->view, world);
    float model_view[16], normal[9];
    for (int i = 0; i < 16; i++)
        model_view[i] = (float)both.m[i];
    double cofactor[9], determinant = mat4_cofactors(&both, cofactor), largest = 0;
    for (int i = 0; i < 9; i++)
        largest = fmax(largest, fabs(cofactor[i]));
    double scale = (determinant < 0 ? -1 : 1) / (largest > 0 ? largest : 1);
    for (int i = 0; i < 9; i++)
        normal[i] = (float)(cofactor[i] * scale);
    gpu_set_mat4(g, "u_model_view", model_view);
    gpu_set_mat3(g, "u_normal_matrix", normal);
}

static void set_past(gpu *g, int step, const mat4 *full)
{
    const char *const names[] = {"u_past_1", "u_past_2", "u_past_3", "u_past_4"};
    float             out[16];
    for (int i = 0; i < 16; i++)
        out[i] = (float)full->m[i];
    gpu_set_mat4(g, names[step - 1], out);
}

void view_set_past(gpu *g, int step, const view_camera *then, const mat4 *past)
{
    mat4 both = mat4_multiply(&then->view, past), full = mat4_multiply(&then->projection, &both);
    set_past(g, step, &full);
}

void view_set_past_of_eye(gpu *g, int step, const view_camera *then, const mat4 *past, const view_camera *now,
                          const mat4 *world)
{
    mat4 seen = mat4_multiply(&now->view, world), back = mat4_inverse(&seen), both = mat4_multiply(&then->view, past);
    mat4 full = mat4_multiply(&then->projection, &both), whole = mat4_multiply(&full, &back);
    set_past(g, step, &whole);
}

void view_set_projection(gpu *g, const view_camera *camera)
{
    float projection[16];
    for (int i = 0; i < 16; i++)
        projection[i] = (float)camera->projection.m[i];
    gpu_set_mat4(g, "u_projection", projection);
}

void view_world_from_eye(const view_camera *camera, const double origin[3], double out[16])
{
    const double *view = camera->view.m;
    memset(out, 0, 16 * sizeof *out);
    for (int row = 0; row < 3; row++) {
        out[12 + row] = -origin[row];
        for (int k = 0; k < 3; k++) {
            out[4 * k + row] = view[4 * row + k];
            out[12 + row] -= view[4 * row + k] * view[12 + k];
        }
    }
    out[15] = 1;
}

/* Names for the bits of the surface id, as src/layer/layer.h has them. */
static void declare_id_bits(text *prelude)
{
    text_append(prelude,
                "#define SURFACE_INDEX_BITS %d\n#define SURFACE_INDEX_MASK %uu\n#define SURFACE_FIGURE_MASK %uu\n",
                SURFACE_INDEX_BITS, (1u << SURFACE_INDEX_BITS) - 1, (unsigned)FIGURES_TOGETHER_MAX);
    text_append(prelude,
                "#define SURFACE_COMPLEMENT %uu\n#define SURFACE_TURNED %uu\n#define SURFACE_CUT %uu\n#define "
                "SURFACE_BACK %uu\n"
                "#define SURFACE_OPERAND %uu\n",
                SURFACE_COMPLEMENT, SURFACE_TURNED, SURFACE_CUT, SURFACE_BACK, SURFACE_OPERAND);
    text_append(prelude, "#define ALBEDO_UNLIT %d.0\n", ALBEDO_UNLIT);
}

/* Before each shader: what frame_set_common and its kin set. */
#define FRAME_UNIFORMS "technique/frame.glsl"

/* The program of two stages, behind the frame's uniforms. */
static gpu_program *with_frame(gpu *g, gpu_dialect dialect, const char *vertex, const char *fragment,
                               const char *prelude)
{
    text stages[2] = {{0}};
    text_append(&stages[0], FRAME_UNIFORMS "+%s", vertex);
    text_append(&stages[1], FRAME_UNIFORMS "+%s", fragment);
    char        *first = text_take(&stages[0]), *second = text_take(&stages[1]);
    gpu_program *p = first && second ? gpu_program_of(g, dialect, first, second, prelude) : NULL;
    if (!first || !second)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    mem_free(first);
    mem_free(second);
    return p;
}

gpu_program *view_program(gpu *g, gpu_dialect dialect, const char *vertex, const char *fragment, text *prelude)
{
    declare_id_bits(prelude);
    char        *finished = text_take(prelude);
    gpu_program *p = finished ? with_frame(g, dialect, vertex, fragment, finished) : NULL;
    if (!finished)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    mem_free(finished);
    return p;
}
