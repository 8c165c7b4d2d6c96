/* The pass "strokes": lines with geometry into a figure's edge map. Two ways lead there.
 *
 *   exact:   scene ──► view ──► chains ──► ribbons ──► quads, each frame, visibility worked out by the CPU
 *   sampled: edges of meshes ──► quads, all on the GPU, visibility by the figure's depth around the axis
 */
#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/paper.h"
#include "frame/frame_private.h"
#include "lines/stroke/strokes.h"
#include "perturb/perturb.h"

/* Of parts that may hide the figure's lines: of what is not seen through, for layers of all, of movers themselves.
 * NULL after an error. */
stroke_store *strokes_find_store(frame *f, const figure *fig, int32_t refine)
{
    bool       *hides = mem_calloc(f->up->part_count, sizeof *hides);
    const bool *wanted = fig->mover ? fig->designated : fig->layered ? f->plan->selected : f->plan->opaque;
    for (size_t i = 0; hides && i < f->up->part_count; i++)
        hides[i] = !(f->mirror && f->mirror->designated[i]) && wanted[i];
    if (!hides)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    stroke_section       section = {&f->up->section.cut, f->up->section.spared};
    stroke_store_options options = {f->up->pose, hides, f->up->part_count, f->up->crease_angle, refine, &section};
    stroke_store        *s = hides ? stroke_store_find(&f->up->strokes[fig->layered], f->g, &options) : NULL;
    mem_free(hides);
    return s;
}

/* Does a rule draw lines where surfaces run through each other? */
static bool draws_crossings(const rule *r)
{
    bool draws = false;
    for (size_t i = 0; r && i < r->use_counts[KIND_LINES]; i++) {
        const technique_use *use = &r->uses[KIND_LINES][i];
        const lines_row     *row = use->technique->lines;
        stroke_options       options = STROKE_OPTIONS_INIT;
        stroke_style         style = {0};
        (row->as_strokes ? row->as_strokes : lines_as_strokes)(&options, &style, use->values);
        draws = draws || options.intersections;
    }
    return draws;
}

/* The parts of such rules, a flag each; mem_free. NULL: out of memory, which sticks to the GPU. */
static bool *find_crossing_parts(frame *f)
{
    const rule *last = NULL;
    bool        draws = false, *parts = mem_calloc(f->up->part_count + 1, sizeof *parts);
    for (size_t i = 0; parts && i < f->up->part_count; i++) {
        const rule *r = plan_rule(f->plan, i);
        draws = r == last ? draws : draws_crossings(r);
        last = r;
        parts[i] = draws;
    }
    if (!parts)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    return parts;
}

/* --- programs ------------------------------------------------------------------------------------------- */

/* Gives the figure an empty edge map, and a depth for lines beyond its surfaces, and draws into them from now on. */
static void open_maps(frame *f, figure_state *s)
{
    static const target written[] = {TARGET_EDGE, TARGET_STROKES};
    for (int i = 0; i < 2; i++) {
        gpu_target_release(f->g, s->targets[written[i]]);
        s->targets[written[i]] = frame_acquire(f, written[i]);
    }
    gpu_pass target = {
        .colours = {s->targets[TARGET_EDGE]}, .colour_count = 1, .depth = s->targets[TARGET_STROKES], .clear = true};
    target_empty(&target_rows[TARGET_EDGE], s->far, target.clear_values[0]);
    memcpy(target.clear_box, s->around, sizeof target.clear_box);
    memcpy(target.scissor, s->pixels, sizeof target.scissor);
    if (!gpu_failed(f->g))
        gpu_pass_begin(f->g, &target);
}

/* The darkest ink stays, and the depth of what was drawn last: any line there will do. */
static const gpu_state drawn = {.depth_write = true, .blend = GPU_BLEND_MIN};

/* --- sampled -------------------------------------------------------------------------------------------- */

/* The eye in an item's axes: its position, 1; or without perspective the way towards it, 0. */
static void find_viewer(const frame *f, const mat4 *world, float out[4])
{
    mat4   both = mat4_multiply(&f->camera.view, world);
    double cofactors[9], determinant = mat4_cofactors(&both, cofactors), eye[3], largest = 0;
    /* Columns of cofactors are the inverse's rows: of the point 0, or of the axis z. */
    for (int row = 0; row < 3; row++) {
        const double *c = &cofactors[3 * row];
        eye[row] = f->camera.orthographic ? c[2] : -(c[0] * both.m[12] + c[1] * both.m[13] + c[2] * both.m[14]);
        largest = fmax(largest, fabs(eye[row]));
    }
    double scale = f->camera.orthographic ? (determinant < 0 ? -1 : 1) / fmax(largest, 1e-300)
                   : determinant != 0     ? 1 / determinant
                                          : 0;
    for (int row = 0; row < 3; row++)
        out[row] = (float)(eye[row] * scale);
    out[3] = f->camera.orthographic ? 0 : 1;
}

/* Takes over the records; the GPU fails when there are none. */
static gpu_marks *upload_records(frame *f, int vectors, float *records, size_t count)
{
    gpu_marks *marks = NULL;
    if (records)
        marks = gpu_marks_create(f->g, vectors, records, count);
    else
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    mem_free(records);
    return marks;
}

/* Of a mesh that moves only what this viewer may see as lines is sent: all of it would serve for one picture. */
static void bring_seen(frame *f, stroke_store *store, uint32_t index)
{
    const stroke_item *item = &store->scene.items[index];
    stroke_seen       *seen = &store->seen[index];
    float              viewer[4];
    find_viewer(f, &item->world, viewer);
    if (seen->edges && memcmp(viewer, seen->viewer, sizeof viewer) == 0)
        return;
    gpu_marks_destroy(f->g, &seen->edges);
    memcpy(seen->viewer, viewer, sizeof viewer);
    size_t count = 0;
    float *records = strokes_edge_records_seen(&store->scene.meshes[item->mesh], viewer, &count);
    seen->edges = upload_records(f, EDGE_RECORD_VECTORS, records, count);
}

/* Makes what the item's lines are drawn from, unless it is there. */
void edges_bring(frame *f, stroke_store *store, uint32_t index, bool crossings)
{
    uint32_t         mesh = store->scene.items[index].mesh;
    const edge_mesh *m = &store->scene.meshes[mesh];
    if (m->moves && !gpu_failed(f->g))
        bring_seen(f, store, index);
    else if (!store->edges[mesh] && !gpu_failed(f->g)) {
        store->edges[mesh] =
            upload_records(f, EDGE_RECORD_VECTORS, strokes_edge_records(m), strokes_edge_record_count(m));
        store->turns[mesh] = (float)strokes_gentlest_turn(m);
    }
    if (!crossings || store->crossings[index] || gpu_failed(f->g))
        return;
    size_t count;
    float *records = strokes_crossing_records(&store->scene, index, &count);
    store->crossings[index] = upload_records(f, EDGE_RECORD_VECTORS, records, count);
}

static void draw_records(frame *f, gpu_marks *marks, const mat4 *world)
{
    if (gpu_marks_count(marks) == 0)
        return;
    mat4  both = mat4_multiply(&f->camera.view, world), whole = mat4_multiply(&f->camera.projection, &both);
    float clip[16], viewer[4];
    for (int i = 0; i < 16; i++)
        clip[i] = (float)whole.m[i];
    find_viewer(f, world, viewer);
    gpu_set_mat4(f->g, "u_clip", clip);
    gpu_set_vec4(f->g, "u_viewer", viewer);
    gpu_draw_marks(f->g, marks);
}

void edges_draw(frame *f, stroke_store *store, uint32_t index, bool crossings)
{
    const stroke_item *item = &store->scene.items[index];
    const mat4         still = mat4_identity();
    bool               moves = store->scene.meshes[item->mesh].moves;
    draw_records(f, moves ? store->seen[index].edges : store->edges[item->mesh], &item->world);
    if (crossings)
        draw_records(f, store->crossings[index], &still);
}

/* Is the near plane before all parts, so that closed ones are seen from outside? */
bool eye_is_outside(const frame *f)
{
    double nearest = INFINITY, farthest = -INFINITY;
    for (size_t i = 0; i < f->up->part_count;
         i++) /* one by one, as the planes are laid: the box around all has corners where nothing is */
        if (f->plan->selected[i] && !box3_is_empty(f->up->pose->part_boxes[i]))
            camera_depth_range(&f->camera, f->up->pose->part_boxes[i], &nearest, &farthest);
    return nearest > f->camera.near && !f->mirror;
}

static int wanted_bits(const stroke_options *w)
{
    enum { WANT_CONTOUR = 32 };
    return (w->contours != CONTOURS_NONE ? WANT_CONTOUR : 0) | (w->borders ? RECORD_BORDER : 0) |
           (w->creases ? RECORD_CREASE : 0) | (w->materials ? RECORD_MATERIAL : 0) |
           (w->intersections ? RECORD_CROSSING : 0) | (w->drawn ? RECORD_DRAWN : 0);
}

static void draw_sampled(frame *f, figure_state *s, stroke_store *store, const pass *p, const strokes_values *v)
{
    text prelude = {0};
    reads_declare(&prelude, f, s, p, NULL);
    text_append(&prelude, "#define SAMPLED\n");
    gpu_program *program = program_of(f, GPU_FLOOR, "lines/stroke/edges.vert", "lines/stroke/stroke.frag", &prelude);
    /* Before the pass begins: making records takes the place of what is bound. */
    for (uint32_t i = 0; i < store->scene.item_count; i++)
        if (s->figure->designated[store->scene.items[i].part_index])
            edges_bring(f, store, i, v->options.intersections);
    open_maps(f, s);
    if (!program || gpu_failed(f->g))
        return;
    gpu_use(f->g, program, drawn);
    frame_set_common(f, s);
    reads_set(f, s, p, NULL);
    gpu_set_vec2(f->g, "u_far_corner", (float)(f->width - 1), (float)(f->height - 1));
    gpu_set_vec2(f->g, "u_half_widths", v->common.width / 2, v->common.width * v->style.crease_width / 2);
    gpu_set_int(f->g, "u_wanted", wanted_bits(&v->options));
    gpu_set_int(f->g, "u_inside", !eye_is_outside(f));
    gpu_settle(f->g);
    for (uint32_t i = 0; i < store->scene.item_count; i++)
        if (s->figure->designated[store->scene.items[i].part_index])
            edges_draw(f, store, i, v->options.intersections);
}

/* --- exact ---------------------------------------------------------------------------------------------- */

/* Strokes are found on the sheet, which is 96 units an inch however many pixels a picture of it has: which lines there
 * are, and where they begin and end, is the same for pictures of all sizes, and for vector drawings. */
double strokes_pixels_a_unit(const frame *f)
{
    return f->pixels_per_mm * (MM_PER_INCH / PX_PER_INCH);
}

static int on_sheet(const frame *f, int pixels)
{
    return (int)fmin(fmax(round(pixels / strokes_pixels_a_unit(f)), 1), LIMIT_PICTURE_SIDE);
}

stroke_camera frame_sheet_camera(const frame *f)
{
    stroke_camera camera;
    memset(&camera, 0, sizeof camera); /* compared byte by byte */
    camera.view = f->camera.view;
    camera.projection = f->camera.projection;
    camera.near = f->camera.near;
    camera.orthographic = f->camera.orthographic;
    camera.width = on_sheet(f, f->width);
    camera.height = on_sheet(f, f->height);
    return camera;
}

lmn_status strokes_look(stroke_store *store, const frame *f, lmn_error *error)
{
    stroke_camera camera = frame_sheet_camera(f);
    return stroke_store_look(store, &camera, error);
}

/* Of several layers each has the lines with as many surfaces in front of them. Bodies count once there, and twice
 * among layers: lines of bodies behind others come a layer early, which shows in how much they fade. */
static void keep_layer(stroke_set *set, uint32_t layer)
{
    size_t kept = 0;
    for (size_t i = 0; i < set->stroke_count; i++)
        if (set->strokes[i].hidden_by == layer) {
            set->strokes[kept] = set->strokes[i];
            set->strokes[kept++].hidden_by = 0;
        }
    set->stroke_count = kept;
}

/* A drawing's lengths are in samples; here in units of the sheet. */
static strokes_values values_on_sheet(const strokes_values *v, double pixels)
{
    strokes_values out = *v;
    params_scale_lengths(lines_strokes.params, lines_strokes.param_count, &out, 1 / pixels);
    params_scale_lengths(kind_lines.common, kind_lines.common_count, &out, 1 / pixels);
    return out;
}

void strokes_scale_ribbons(ribbon_set *r, const frame *f)
{
    float unit = (float)strokes_pixels_a_unit(f), right = (float)f->width / (float)on_sheet(f, f->width),
          down = (float)f->height / (float)on_sheet(f, f->height);
    for (size_t i = 0; i < r->point_count; i++) {
        r->points[i].x *= right;
        r->points[i].y *= down;
        r->points[i].half *= unit;
        r->points[i].arc *= unit;
    }
}

/* Lines that files bring are held before the surfaces that they lie on, which may be another figure's; as sampled ones
 * are (lines/stroke/edges.vert). */
static void lift_strokes(stroke_set *set)
{
    const float as_seen = 2;
    for (size_t i = 0; i < set->stroke_count; i++)
        for (uint32_t k = 0; k < set->strokes[i].count && set->strokes[i].lift > 0; k++) {
            stroke_point *p = &set->points[set->strokes[i].first + k];
            p->depth -= as_seen * set->strokes[i].lift;
        }
}

/* What is kept stays as it was found. */
static bool copy_lines(stroke_set *out, const stroke_set *from)
{
    *out = *from;
    out->strokes = mem_copy(from->strokes, from->stroke_count * sizeof *out->strokes);
    out->points = mem_copy(from->points, from->point_count * sizeof *out->points);
    out->marks = NULL;
    out->mark_count = 0;
    return (out->strokes || !from->stroke_count) && (out->points || !from->point_count);
}

/* Strokes boil with what else does. */
static uint32_t seed_of(const frame *f, const figure_state *s)
{
    const technique_use *hand = rule_use(s->figure->rule, KIND_PERTURB);
    return hand ? hand_seed(hand->technique->perturbs, hand->values, f->seed, f->time_s) : f->seed;
}

static lmn_status make_ribbons(ribbon_set *out, stroke_store *store, frame *f, const figure_state *s,
                               const strokes_values *v, lmn_error *error)
{
    const strokes_values seen = values_on_sheet(v, strokes_pixels_a_unit(f));
    const stroke_set    *all = NULL;
    stroke_options       options = strokes_options_of(&seen);
    stroke_style         style = strokes_style_of(&seen);
    stroke_set           set = {0};
    if (s->figure->layered)
        options.hidden = true;
    memset(out, 0, sizeof *out);
    lmn_status status = strokes_look(store, f, error);
    if (status == LMN_OK)
        status = stroke_store_lines(store, &all, &options, s->figure->designated, error);
    if (status == LMN_OK && !copy_lines(&set, all))
        status = error_memory(error);
    set.perspective = !f->camera.orthographic;
    if (status == LMN_OK)
        lift_strokes(&set);
    if (status == LMN_OK && s->figure->layered)
        keep_layer(&set, (uint32_t)s->layer);
    if (status == LMN_OK && s->layer == 0) { /* all layers have theirs from one search */
        f->search.faces += set.search.faces;
        f->search.tested += set.search.tested;
    }
    for (size_t i = 0; i < set.stroke_count && status == LMN_OK; i++)
        f->strokes[set.strokes[i].kind]++;
    if (status == LMN_OK)
        status = ribbons_make(out, &set, &style, seed_of(f, s), error);
    if (status == LMN_OK)
        strokes_scale_ribbons(out, f);
    stroke_set_release(&set);
    return status;
}

/* From eye depth to window depth. */
static void project_depths(ribbon_set *r, const view_camera *c)
{
    const double *m = c->projection.m;
    for (size_t i = 0; i < r->point_count; i++) {
        double depth = r->points[i].depth, clip = m[14] - m[10] * depth, w = m[15] - m[11] * depth;
        r->points[i].depth = (float)fmin(fmax(0.5 * clip / w + 0.5, 0), 1 - 1e-7);
    }
}

gpu_marks *strokes_upload_ribbons(frame *f, ribbon_set *ribbons)
{
    size_t count;
    project_depths(ribbons, &f->camera);
    float *records = strokes_ribbon_records(ribbons, f->height, &count);
    return upload_records(f, RIBBON_RECORD_VECTORS, records, count);
}

/* Lines alone are composed where they are. */
static void find_ink_boxes(frame *f, figure_state *s, const ribbon_set *ribbons)
{
    tile_grid *t = mem_alloc(sizeof *t);
    if (!t) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    tiles_start(t, s->pixels);
    tiles_clear(t);
    for (size_t i = 0; i < ribbons->ribbon_count; i++) {
        const ribbon       *r = &ribbons->ribbons[i];
        const ribbon_point *p = &ribbons->points[r->first];
        for (uint32_t k = 0; k < r->count; k++) {
            const ribbon_point *a = &p[k], *b = k + 1 < r->count ? a + 1 : a;
            const float         far = fmaxf(fabsf(b->x - a->x), fabsf(b->y - a->y));
            const int           steps = (int)(far / (float)t->size) + 1;
            const float         half = 1.5f * fmaxf(a->half, b->half) + 2; /* corners, and a soft rim */
            for (int n = 0; n <= steps; n++) {
                const float part = (float)n / (float)steps, x = a->x + part * (b->x - a->x),
                            y = (float)f->height - (a->y + part * (b->y - a->y));
                const float reach = half + (steps > 1 || a != b ? far / (float)steps / 2 : 0);
                tiles_mark(t,
                           (int[]){(int)floorf(x - reach), (int)floorf(y - reach), (int)ceilf(2 * reach) + 1,
                                   (int)ceilf(2 * reach) + 1},
                           true);
            }
        }
    }
    s->box_count = tiles_boxes(t, 0, s->pixels, s->boxes);
    mem_free(t);
}

static gpu_marks *upload_ribbons(frame *f, stroke_store *store, figure_state *s, const strokes_values *v)
{
    ribbon_set ribbons = {0};
    lmn_error  error = {0};
    lmn_status status = make_ribbons(&ribbons, store, f, s, v, &error);
    gpu_marks *marks = NULL;
    if (status == LMN_OK && s->apart && s->boxes)
        find_ink_boxes(f, s, &ribbons);
    if (status == LMN_OK)
        marks = strokes_upload_ribbons(f, &ribbons);
    else
        gpu_fail(f->g, status, "%s", error.message);
    ribbon_set_release(&ribbons);
    return marks;
}

static void draw_exact(frame *f, figure_state *s, stroke_store *store, const strokes_values *v)
{
    text prelude = {0};
    text_append(&prelude, "#define THE_BRUSH %d\n", (int)v->style.brush);
    gpu_program *program = program_of(f, GPU_FLOOR, "lines/stroke/ribbons.vert", "lines/stroke/stroke.frag", &prelude);
    gpu_marks   *marks = upload_ribbons(f, store, s, v);
    open_maps(f, s);
    if (program && !gpu_failed(f->g)) {
        gpu_use(f->g, program, drawn);
        frame_set_common(f, s);
        gpu_set_float(f->g, "u_pixel", (float)strokes_pixels_a_unit(f));
        gpu_draw_marks(f->g, marks);
    }
    if (marks)
        gpu_marks_destroy(f->g, &marks);
}

void strokes_run(frame *f, figure_state *s, const pass *p, const technique_use *use, const char *group)
{
    const strokes_values *v = use->values;
    bool                  exact = v->visibility == VISIBILITY_EXACT || v->style.hidden != HIDDEN_NONE ||
                 (v->visibility == VISIBILITY_AUTO && (strokes_need_chains(v) || s->figure->layered));
    stopwatch     w = watch_start(&f->profile);
    stroke_store *store = gpu_failed(f->g) ? NULL : strokes_find_store(f, s->figure, v->options.refine);
    bool         *crossing = store && v->options.intersections ? find_crossing_parts(f) : NULL;
    if (store && !gpu_failed(f->g))
        stroke_store_fix(store, f->g, crossing, stroke_options_bend(&v->options));
    mem_free(crossing);
    if (store && exact)
        draw_exact(f, s, store, v);
    else if (store)
        draw_sampled(f, s, store, p, v);
    watch_stop(&f->profile, w, group, p->name);
}
