/* Lines that tell of motion (src/trace), over the finished page: they know themselves what hides them. They are drawn
 * as strokes are, into a picture of ink, so that pieces that overlap count once, and that is laid over the page. */
#include "frame/frame_private.h"
#include "trace/trace.h"

/* On the sheet, as strokes are found. */
static lmn_status make(ribbon_set *out, colour *ink, frame *f, const figure *fig, stroke_store *store, lmn_error *error)
{
    traces_values values = *traces_of_rule(fig->rule);
    trace_facts   facts;
    traces_scale(&values, 1 / strokes_pixels_a_unit(f));
    lmn_status status = strokes_look(store, f, error);
    if (status != LMN_OK)
        return status;
    traces_options options = {.pose = f->up->pose,
                              .parts = fig->designated,
                              .values = &values,
                              .camera = store->camera,
                              .seen = store->view,
                              .section = {&f->up->section.cut, f->up->section.spared},
                              .crease_angle = f->up->crease_angle,
                              .seed = f->seed};
    traces_take_lines(&options, fig->rule);
    *ink = options.ink;
    status = traces_make(out, &facts, &options, error);
    for (size_t i = 0; i < out->ribbon_count && status == LMN_OK; i++)
        f->strokes[out->ribbons[i].kind]++;
    if (status == LMN_OK)
        trace_facts_add(&f->traces, &facts);
    return status;
}

/* Ink of ribbons that are opaque by their alphas, as an edge map's profile. */
static gpu_texture *draw_ink(frame *f, ribbon_set *ribbons)
{
    text         prelude = {0};
    gpu_program *program = program_of(f, GPU_FLOOR, "lines/stroke/ribbons.vert", "lines/stroke/stroke.frag", &prelude);
    strokes_scale_ribbons(ribbons, f);
    for (size_t i = 0; i < ribbons->ribbon_count; i++)
        ribbons->ribbons[i].kind = STROKE_CONTOUR; /* all into one channel */
    gpu_marks   *marks = strokes_upload_ribbons(f, ribbons);
    gpu_texture *ink = frame_acquire(f, TARGET_EDGE);
    if (program && !gpu_failed(f->g)) {
        gpu_pass_begin(f->g,
                       &(gpu_pass){.colours = {ink}, .colour_count = 1, .clear = true, .clear_values = {{1, 1, 1, 1}}});
        gpu_use(f->g, program, (gpu_state){.blend = GPU_BLEND_MIN});
        gpu_set_vec2(f->g, "u_size", (float)f->width, (float)f->height);
        gpu_set_float(f->g, "u_pixel", (float)strokes_pixels_a_unit(f));
        gpu_settle(f->g);
        gpu_draw_marks(f->g, marks);
    }
    if (marks)
        gpu_marks_destroy(f->g, &marks);
    return ink;
}

static void lay_over(frame *f, gpu_texture *ink, colour c)
{
    text         prelude = {0};
    gpu_program *program = program_of(f, GPU_FLOOR, "gpu/screen.vert", "motion/traces.frag", &prelude);
    if (program && !gpu_failed(f->g)) {
        gpu_pass_begin(f->g, &(gpu_pass){.colours = {f->page}, .colour_count = 1});
        gpu_use(f->g, program, (gpu_state){.blend = GPU_BLEND_OVER});
        gpu_set_texture(f->g, "t_ink", ink, false);
        gpu_set_vec4(f->g, "u_ink", (float[]){c.r, c.g, c.b, c.a});
        gpu_draw_screen(f->g);
    }
}

static void draw_figure_traces(frame *f, const figure *fig)
{
    ribbon_set    ribbons = {NULL};
    colour        ink;
    lmn_error     error = {0};
    stroke_store *store = strokes_find_store(f, fig, 0);
    if (!store)
        return;
    lmn_status status = make(&ribbons, &ink, f, fig, store, &error);
    if (status != LMN_OK)
        gpu_fail(f->g, status, "%s", error.message);
    if (status == LMN_OK && ribbons.ribbon_count) {
        gpu_texture *drawn = draw_ink(f, &ribbons);
        lay_over(f, drawn, ink);
        gpu_target_release(f->g, drawn);
    }
    ribbon_set_release(&ribbons);
}

void traces_draw(frame *f)
{
    stopwatch w = watch_start(&f->profile);
    bool      any = false;
    for (size_t i = 0; i < f->plan->figure_count && !gpu_failed(f->g); i++) {
        if (!traces_of_rule(f->plan->figures[i].rule) || f->plan->figures[i].unmarked || f->mirror)
            continue;
        draw_figure_traces(f, &f->plan->figures[i]);
        any = true;
    }
    if (any)
        watch_stop(&f->profile, w, "motion", "traces");
}
