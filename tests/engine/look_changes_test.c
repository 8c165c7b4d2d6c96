/* Changes of a look by calls: what is drawn after them is what a look that was so from the beginning draws, byte by
 * byte; a plain number compiles and uploads nothing; and what lmn_look_changes does not say is not made. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/drawing.h"
#include "draw/session.h"
#include "look/look.h"

enum { SIDE = 64, SMALL_SIDE = 24, PIXELS = SIDE * SIDE, THINGS_MAX = 64 };

typedef struct fixture {
    lmn_scene    *scene;
    lmn_renderer *renderer, *other;
} fixture;

static int set_up(void **state)
{
    static fixture    f;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    f = (fixture){.scene = NULL};
    DO(lmn_renderer_create(&f.renderer, &desc, &error));
    DO(lmn_renderer_create(&f.other, &desc, &error));
    DO(lmn_scene_create(&f.scene, &error));
    DO(lmn_scene_add_file(f.scene, TEST_DATA "/two-parts.gltf", NULL, &error));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    lmn_scene_destroy(&f->scene);
    lmn_renderer_destroy(&f->renderer);
    lmn_renderer_destroy(&f->other);
    return 0;
}

static lmn_status draw(const fixture *f, lmn_renderer *r, const lmn_look *look, uint8_t *pixels)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_drawing  *drawing = NULL;
    desc.width = desc.height = pixels ? SIDE : SMALL_SIDE;
    desc.dpi = 96;
    desc.samples = 1;
    lmn_status status = lmn_draw(&drawing, r, f->scene, look, &desc, &error);
    if (status == LMN_OK && pixels)
        memcpy(pixels, lmn_drawing_pixels(drawing, NULL, NULL), 4 * PIXELS);
    lmn_drawing_destroy(&drawing);
    return status;
}

/* What a renderer has made. */
typedef struct made {
    size_t      programs, mesh_count, texture_count;
    const void *meshes[THINGS_MAX], *textures[THINGS_MAX], *strokes[STROKE_STORES];
    int32_t     refine[STROKE_STORES];
} made;

static made made_by(const lmn_renderer *r)
{
    made m = {.programs = gpu_program_count(r->g)};
    for (size_t i = 0; i < r->up.item_count && m.mesh_count + 2 < THINGS_MAX; i++) {
        m.meshes[m.mesh_count++] = r->up.items[i].mesh;
        m.meshes[m.mesh_count++] = r->up.items[i].lapped;
    }
    for (size_t i = 0; i < r->made.count && i < THINGS_MAX; i++)
        m.textures[m.texture_count++] = r->made.items[i].texture;
    for (int i = 0; i < STROKE_STORES; i++) {
        m.strokes[i] = r->up.strokes[i];
        m.refine[i] = r->up.strokes[i] ? r->up.strokes[i]->refine : -1;
    }
    return m;
}

static bool same_meshes(const made *a, const made *b)
{
    return a->mesh_count == b->mesh_count && memcmp(a->meshes, b->meshes, sizeof a->meshes) == 0 &&
           memcmp(a->strokes, b->strokes, sizeof a->strokes) == 0 &&
           memcmp(a->refine, b->refine, sizeof a->refine) == 0;
}

/* Textures may go when nothing was drawn with them for long; none may come. */
static bool no_new_textures(const made *before, const made *after)
{
    for (size_t i = 0; i < after->texture_count; i++) {
        bool known = false;
        for (size_t k = 0; k < before->texture_count; k++)
            known = known || before->textures[k] == after->textures[i];
        if (!known)
            return false;
    }
    return true;
}

static lmn_look *parse(const char *json)
{
    lmn_look *look = NULL;
    DO(lmn_look_parse(&look, json, "test", &error));
    return look;
}

/* Draws what a renderer that knows nothing of the changes draws. */
static void assert_as_from_file(const fixture *f, const lmn_look *look)
{
    static uint8_t changed[4 * PIXELS], fresh[4 * PIXELS];
    char          *json = lmn_look_json(look);
    lmn_look      *again = parse(json);
    lmn_text_free(json);
    DO(draw(f, f->renderer, look, changed));
    DO(draw(f, f->other, again, fresh));
    assert_memory_equal(changed, fresh, sizeof changed);
    lmn_look_destroy(&again);
}

/* --- plain numbers -------------------------------------------------------------------------------------- */

static void test_plain_numbers(void **state)
{
    const fixture *f = *state;
    static const struct {
        const char *look, *kind, *key;
        double      from, to;
    } cases[] = {
        {"edges", "lines", "width", 6, 9},        {"edges", "lines", "gain", 1, 0.5},
        {"pencil", "surface", "light", 1.25, 2},  {"pencil", "perturb", "dark_sway", 0.8, 4},
        {"toon", "lines", "width", 4, 5},         {"gooch", "surface", "specular", 0.6, 0.1},
        {"sketch", "perturb", "amount", 3.75, 9},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static uint8_t one[4 * PIXELS], other[4 * PIXELS];
        lmn_look      *look = NULL;
        const char    *kind = cases[i].kind, *key = cases[i].key;
        DO(lmn_look_load(&look, cases[i].look, &error));
        DO(lmn_look_set_number(look, 0, kind, 0, key, cases[i].from, &error));
        DO(draw(f, f->renderer, look, one));
        made     before = made_by(f->renderer);
        uint64_t revision = lmn_look_revision(look);
        DO(lmn_look_set_number(look, 0, kind, 0, key, cases[i].to, &error));
        unsigned lengths = strcmp(key, "width") == 0 ? LMN_CHANGE_PLAN | LMN_CHANGE_PROGRAMS : 0;
        if ((lmn_look_changes(look, revision) & ~lengths) != LMN_CHANGE_VALUES)
            fail_msg("%s %s.%s: %u", cases[i].look, kind, key, lmn_look_changes(look, revision));
        DO(draw(f, f->renderer, look, other));
        made after = made_by(f->renderer);
        if (memcmp(one, other, sizeof one) == 0)
            fail_msg("%s %s.%s changes nothing", cases[i].look, kind, key);
        if (after.programs != before.programs || !same_meshes(&before, &after) || !no_new_textures(&before, &after))
            fail_msg("%s %s.%s makes %zu programs%s%s", cases[i].look, kind, key, after.programs - before.programs,
                     same_meshes(&before, &after) ? "" : " meshes",
                     no_new_textures(&before, &after) ? "" : " textures");
        assert_as_from_file(f, look);
        lmn_look_destroy(&look);
    }
}

/* --- all of them ---------------------------------------------------------------------------------------- */

typedef struct tally {
    size_t   draws, silent, said; /* changes that said they make nothing, and those that said so */
    size_t   needless;            /* of the latter, those after which nothing was made */
    unsigned mistakes;
} tally;

/* One change, from the look as it is to this value and back. */
static void try_value(const fixture *f, lmn_look *look, const lmn_kind_info *k, const char *technique, const char *key,
                      double value, tally *t)
{
    size_t   rule = k->whole_look ? LMN_WHOLE_LOOK : 0;
    uint64_t revision = lmn_look_revision(look);
    made     before = made_by(f->renderer);
    if (lmn_look_set_number(look, rule, k->name, 0, key, value, &error) != LMN_OK)
        fail_msg("%s: %s", key, error.message);
    unsigned changes = lmn_look_changes(look, revision);
    if (changes && draw(f, f->renderer, look, NULL) == LMN_OK) {
        made after = made_by(f->renderer);
        bool compiled = after.programs != before.programs, meshes = !same_meshes(&before, &after),
             textures = !no_new_textures(&before, &after);
        t->draws++;
        if ((compiled && !(changes & LMN_CHANGE_PROGRAMS)) || (meshes && !(changes & LMN_CHANGE_MESHES)) ||
            (textures && !(changes & LMN_CHANGE_TEXTURES))) {
            print_error("%s.%s.%s = %g: %s%s%s but the change says %u\n", k->name, technique, key, value,
                        compiled ? "programs " : "", meshes ? "meshes " : "", textures ? "textures " : "", changes);
            t->mistakes++;
        }
        bool says = changes & (LMN_CHANGE_PROGRAMS | LMN_CHANGE_MESHES | LMN_CHANGE_TEXTURES);
        t->silent += !says;
        t->said += says;
        t->needless += says && !compiled && !meshes && !textures;
    }
    DO(lmn_look_reset(look, rule, k->name, 0, key, &error));
    if (changes & (LMN_CHANGE_MESHES | LMN_CHANGE_TEXTURES))
        DO(draw(f, f->renderer, look, NULL)); /* back to what the next change is from */
}

/* What takes long however small the picture is. */
static bool takes_long(const lmn_param_info *p)
{
    return strcmp(p->key, "count") == 0 || strcmp(p->key, "tones") == 0 || strcmp(p->key, "refine") == 0 ||
           strcmp(p->key, "memory") == 0;
}

static void try_technique(const fixture *f, const lmn_kind_info *k, const char *technique, bool with_common, tally *t)
{
    lmn_look      *look = NULL;
    lmn_param_info p;
    size_t         rule = k->whole_look ? LMN_WHOLE_LOOK : 0;
    DO(lmn_look_create(&look, &error));
    if (!lmn_look_technique_count(look, 0, "lines") && strcmp(k->name, "lines") != 0)
        DO(lmn_look_add_technique(look, 0, "lines", "discontinuity", 0, &error));
    if (lmn_look_technique_count(look, rule, k->name))
        DO(lmn_look_set_technique(look, rule, k->name, 0, technique, &error));
    else
        DO(lmn_look_add_technique(look, rule, k->name, technique, 0, &error));
    /* Both directions: from the default, which is drawn first, and to what only some value brings. */
    bool drawn = draw(f, f->renderer, look, NULL) == LMN_OK;
    for (size_t i = 0; drawn && lmn_param_at(k->name, technique, i, &p); i++) {
        if ((p.type != LMN_PARAM_FLOAT && p.type != LMN_PARAM_INT) || takes_long(&p) || (p.common && !with_common))
            continue;
        /* One of three values each, in turn: every one takes a drawing. */
        const double values[] = {p.soft_min, p.soft_min + (p.soft_max - p.soft_min) / 2, p.min}, value = values[i % 3];
        try_value(f, look, k, technique, p.key, p.type == LMN_PARAM_INT ? floor(value) : value, t);
    }
    lmn_look_destroy(&look);
}

static void test_what_is_not_said_is_not_made(void **state)
{
    const fixture     *f = *state;
    lmn_kind_info      k;
    lmn_technique_info technique;
    tally              t = {0};
    for (size_t i = 0; lmn_kind_at(i, &k); i++)
        for (size_t n = 0; lmn_technique_at(k.name, n, &technique); n++)
            try_technique(f, &k, technique.name, n == 0, &t);
    print_message(
        "%zu drawings: %zu changes said that nothing is made, %zu that something is, %zu of them needlessly\n", t.draws,
        t.silent, t.said, t.needless);
    assert_int_equal(t.mistakes, 0);
    assert_true(t.silent > 130 && t.silent > t.said);
}

/* --- rules and techniques ------------------------------------------------------------------------------- */

static void test_changes_draw_as_files_do(void **state)
{
    const fixture *f = *state;
    lmn_look      *look = NULL, *copy = NULL;
    const char    *part = f->scene->parts[0].name;
    DO(lmn_look_create(&look, &error));
    assert_as_from_file(f, look);
    DO(lmn_look_add_technique(look, 0, "lines", "four-tap", LMN_AT_END, &error));
    assert_as_from_file(f, look);
    DO(lmn_look_add_technique(look, 0, "lines", "id", 0, &error));
    DO(lmn_look_set_text(look, 0, "lines", 0, "colour", "#c02020", &error));
    DO(lmn_look_set_text(look, 0, "lines", 0, "width", "1.5mm", &error));
    assert_as_from_file(f, look);
    DO(lmn_look_move_technique(look, 0, "lines", 0, 1, &error));
    assert_as_from_file(f, look);
    DO(lmn_look_add_rule(look, part, LMN_AT_END, NULL, &error));
    DO(lmn_look_set_technique(look, 1, "surface", 0, "hatch", &error));
    DO(lmn_look_copy(&copy, look, &error));
    assert_as_from_file(f, look);
    DO(lmn_look_move_rule(look, 1, 0, &error));
    assert_as_from_file(f, look);
    DO(lmn_look_set_rule_selector(look, 1, "nothing", &error));
    assert_as_from_file(f, look);
    DO(lmn_look_remove_rule(look, 1, &error));
    DO(lmn_look_set_number(look, LMN_WHOLE_LOOK, "scene", 0, "crease_angle", 5, &error));
    DO(lmn_look_set_text(look, LMN_WHOLE_LOOK, "scene", 0, "cut", "x=50%", &error));
    assert_as_from_file(f, look);
    DO(lmn_look_add_technique(look, 0, "perturb", "uncertainty", LMN_AT_END, &error));
    DO(lmn_look_set_technique(look, 0, "surface", 0, "pencil", &error));
    assert_as_from_file(f, look);
    DO(lmn_look_reset(look, LMN_WHOLE_LOOK, "scene", 0, NULL, &error));
    assert_as_from_file(f, look);
    assert_as_from_file(f, copy);
    lmn_look_destroy(&copy);
    lmn_look_destroy(&look);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plain_numbers),
        cmocka_unit_test(test_changes_draw_as_files_do),
        cmocka_unit_test(test_what_is_not_said_is_not_made),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
