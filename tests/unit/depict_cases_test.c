/* The example scripts tell what they claim, and when only the behaviour changes, the signs of the same expressions
 * change as it does. Nienhaus 2005, sections 7.6 to 7.10. */
#include "import_support.h"
#include "placed_glyph.h"

#include <math.h>

#include <jansson.h>

#include "depict/depict.h"
#include "depict/depict_private.h"
#include "limner/depict.h"
#include "limner/rules.h"

/* --- scripts ------------------------------------------------------------------------------------------------------ */

/* What a changed script includes has to lie beside it. */
static void copy_included(json_t *script)
{
    json_t *included = json_object_get(script, "include");
    for (size_t i = 0; i < json_array_size(included); i++) {
        char    from[512], to[512];
        json_t *part;
        snprintf(from, sizeof from, LIMNER_SOURCE_DIR "/examples/scripts/%s",
                 json_string_value(json_array_get(included, i)));
        snprintf(to, sizeof to, "%s/included-%zu.json", temp_folder(), i);
        part = json_load_file(from, 0, NULL);
        assert_int_equal(json_dump_file(part, to, 0), 0);
        json_decref(part);
        json_array_set_new(included, i, json_string(strrchr(to, '/') + 1));
    }
}

/* A scene with the expressions of its script in it, seen as the script says; `changed` (may be NULL) changes the script
 * first. */
static lmn_scene *told(const char *path, void (*changed)(json_t *script))
{
    json_t *script = json_load_file(path, 0, NULL);
    assert_non_null(script);
    char        own[512];
    const char *from = path;
    if (changed) {
        copy_included(script);
        changed(script);
        snprintf(own, sizeof own, "%s/changed.json", temp_folder());
        assert_int_equal(json_dump_file(script, own, 0), 0);
        from = own;
    }
    lmn_scene      *scene = load_or_fail(from);
    const json_t   *how = json_object_get(script, "depiction");
    char           *expressions = json_dumps(json_object_get(script, "expressions"), 0);
    lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
    lmn_draw_desc   draw = LMN_DRAW_DESC_INIT;
    lmn_error       error = {0};
    const char     *view = json_string_value(json_object_get(how, "view"));
    draw.view = view && strcmp(view, "front") == 0 ? LMN_VIEW_FRONT : LMN_VIEW_ISO;
    draw.camera = json_string_value(json_object_get(how, "camera"));
    draw.time_s = json_number_value(json_object_get(how, "time"));
    draw.time_given = true;
    desc.expressions = expressions;
    if (lmn_depict(scene, &draw, &desc, NULL, &error) != LMN_OK)
        fail_msg("%s: %s", path, error.message);
    free(expressions);
    json_decref(script);
    return scene;
}

static const char *value_of(const node *n, const char *key)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, key) == 0)
            return n->attributes[i].value;
    return "";
}

/* The k-th glyph of a kind; `when`: "" any. */
static const primitive *sign_at(const lmn_scene *s, const char *glyph, const char *when, size_t k)
{
    for (size_t i = 0; i < s->part_count; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        if (n->mesh != NONE && strcmp(value_of(n, "glyph"), glyph) == 0 &&
            (!*when || strcmp(value_of(n, "when"), when) == 0) && k-- == 0)
            return placed_glyph(s, n);
    }
    return NULL;
}

static size_t count_of(const lmn_scene *s, const char *glyph, const char *when)
{
    size_t count = 0;
    while (sign_at(s, glyph, when, count))
        count++;
    return count;
}

static double reach_of(const primitive *p, bool most)
{
    double out = most ? -INFINITY : INFINITY;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        out = most ? fmax(out, (double)p->positions[i].x) : fmin(out, (double)p->positions[i].x);
    return out;
}

static double breadth_of(const primitive *p)
{
    return reach_of(p, true) - reach_of(p, false);
}

static double middle_of(const primitive *p)
{
    return (reach_of(p, true) + reach_of(p, false)) / 2;
}

static double area_of(const primitive *p)
{
    double sum = 0;
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        double c[3][3], a[3], b[3], normal[3];
        for (uint32_t k = 0; k < 3; k++) {
            const vec3 *v = &p->positions[p->indices[i + k]];
            vector3_set(c[k], (double)v->x, (double)v->y, (double)v->z);
        }
        vector3_add(a, c[1], -1, c[0]);
        vector3_add(b, c[2], -1, c[0]);
        vector3_cross(normal, a, b);
        sum += vector3_length(normal) / 2;
    }
    return sum;
}

/* --- the examples ------------------------------------------------------------------------------------------------- */

typedef struct claim {
    const char *script, *glyph, *when;
    size_t      least, most;
} claim;

/* Ghost images of things with several parts are a glyph a part. */
static const claim claims[] = {
    {"bounce", "arrow", "past", 1, 1},
    {"bounce", "arrow", "future", 1, 1},
    {"bounce", "still", "", 5, 5},
    {"bounce", "star", "", 4, 4}, /* two impacts up to now, each with its rim */
    {"bounce", "noise", "", 2, 2},
    {"plane", "still", "past", 4, 4},
    {"plane", "still", "present", 2, 2},
    {"plane", "still", "future", 2, 2},
    {"plane", "motion-lines", "", 1, 1},
    {"runner", "balloon", "", 1, 1},
    {"runner", "words", "", 1, 1},
    {"runner", "motion-lines", "", 2, 2},
    {"batting-swing", "still", "present", 30, 50},
    {"batting-swing", "still", "past", 10, 16},
    {"batting-swing", "still", "future", 4, 10},
    {"batting-swing", "arrow", "", 0, 0},
    {"batting-hit", "arrow", "past", 1, 1},
    {"batting-hit", "arrow", "future", 1, 1},
    {"batting-hit", "still", "", 5, 5},
    {"batting-hit", "star", "", 0, 0},
    {"batting-crack", "star", "past", 2, 2},
    {"batting-crack", "noise", "", 1, 1},
    {"batting-after", "arrow", "past", 1, 1},
    {"batting-after", "arrow", "future", 1, 1},
    {"batting-after", "motion-lines", "", 2, 2},
    {"crane", "frame", "", 4, 4},
    {"crane", "rails", "", 2, 2},
    {"crane", "inset-frame", "future", 1, 1},
    {"crane", "inset", "", 8, 20},
    {"crane", "leader", "", 1, 1},
    {"closeup", "frame", "", 3, 3},
    {"closeup", "flow-arrow", "past", 1, 1},
    {"closeup", "flow-arrow", "future", 1, 1},
    {"closeup", "inset-frame", "", 1, 1},
    {"closeup", "rails", "", 0, 0},
    {"turning", "bent-arrow", "past", 1, 1},
    {"turning", "bent-arrow", "future", 1, 1},
    {"catapult", "arrow", "past", 3, 4}, /* six pieces, one of them cut where now is */
    {"catapult", "arrow", "future", 3, 4},
    {"catapult", "cause-arrow", "", 1, 1},
    {"explosion", "star", "", 2, 2},
    {"explosion", "noise", "", 1, 1},
    {"explosion", "burst-arrows", "", 1, 1},
};

static void examples_tell_what_they_claim(void **state)
{
    (void)state;
    lmn_scene  *scene = NULL;
    const char *last = "";
    for (size_t i = 0; i < sizeof claims / sizeof *claims; i++) {
        const claim *c = &claims[i];
        char         path[512];
        snprintf(path, sizeof path, LIMNER_SOURCE_DIR "/examples/scripts/%s.json", c->script);
        if (strcmp(last, c->script) != 0) {
            lmn_scene_destroy(&scene);
            scene = told(path, NULL);
            last = c->script;
        }
        const size_t count = count_of(scene, c->glyph, c->when);
        if (count < c->least || count > c->most)
            fail_msg("%s has %zu of %s %s; %zu to %zu were expected", c->script, count, c->glyph, c->when, c->least,
                     c->most);
    }
    lmn_scene_destroy(&scene);
}

/* --- only the behaviour changes ----------------------------------------------------------------------------------- */

static const char bounce_path[] = LIMNER_SOURCE_DIR "/examples/scripts/bounce.json",
                  crane_path[] = LIMNER_SOURCE_DIR "/examples/scripts/crane.json";

static void make_reverse(json_t *script)
{
    json_t *whole = json_pack("{s:O}", "reverse", json_object_get(script, "behaviour"));
    json_object_set_new(script, "behaviour", whole);
}

/* The same way in twice the time, seen at the same place of it. */
static void make_slower(json_t *script)
{
    json_t *whole = json_pack("{s:[O],s:f}", "sequence", json_object_get(script, "behaviour"), "duration", 7.2);
    json_object_set_new(script, "behaviour", whole);
    json_object_set_new(json_object_get(script, "depiction"), "time", json_real(4.4));
}

static void make_higher(json_t *script)
{
    json_t *ball = json_array_get(json_object_get(script, "nodes"), 1);
    json_object_set_new(ball, "translation", json_pack("[f,f,f]", 0.0, 6.0, 0.0));
}

static void make_faster_across(json_t *script)
{
    json_object_set_new(json_object_get(script, "behaviour"), "velocity", json_pack("[f,f,f]", 3.0, 0.0, 0.0));
}

/* The head is the widest part of an arrow: where its last vertex is. */
static double tip_of(const primitive *p)
{
    return (double)p->positions[p->vertex_count - 1].x;
}

static void reversed_behaviour_reverses_signs(void **state)
{
    (void)state;
    lmn_scene       *plain = told(bounce_path, NULL), *back = told(bounce_path, make_reverse);
    const primitive *there = sign_at(plain, "arrow", "future", 0), *again = sign_at(back, "arrow", "future", 0);
    /* To the right; to the left. */
    assert_true(tip_of(there) > middle_of(there) + 0.3 * breadth_of(there));
    assert_true(tip_of(again) < middle_of(again) - 0.3 * breadth_of(again));
    /* Lines lie behind: on the other side of the ball. */
    const primitive *lines[2] = {sign_at(plain, "motion-lines", "", 0), sign_at(back, "motion-lines", "", 0)};
    const double     balls[2] = {middle_of(sign_at(plain, "still", "present", 0)),
                                 middle_of(sign_at(back, "still", "present", 0))};
    assert_true(middle_of(lines[0]) < balls[0] - 0.3);
    assert_true(middle_of(lines[1]) > balls[1] + 0.3);
    lmn_scene_destroy(&plain);
    lmn_scene_destroy(&back);
}

static void slower_behaviour_has_shorter_lines(void **state)
{
    (void)state;
    lmn_scene   *plain = told(bounce_path, NULL), *slow = told(bounce_path, make_slower);
    const double long_ones = area_of(sign_at(plain, "motion-lines", "", 0)),
                 short_ones = area_of(sign_at(slow, "motion-lines", "", 0));
    assert_true(short_ones < 0.75 * long_ones);
    /* The way is what it was. */
    for (int k = 0; k < 2; k++) {
        const char *when = k ? "past" : "future";
        assert_true(fabs(tip_of(sign_at(plain, "arrow", when, 0)) - tip_of(sign_at(slow, "arrow", when, 0))) < 0.02);
    }
    lmn_scene_destroy(&plain);
    lmn_scene_destroy(&slow);
}

/* From a height h it falls for √(2 h / g), and goes 2.2 or 3 units a second across. */
static void stars_go_where_contacts_go(void **state)
{
    (void)state;
    const struct {
        void (*changed)(json_t *);
        double height, across;
    } cases[] = {{NULL, 4, 2.2}, {make_higher, 6, 2.2}, {make_faster_across, 4, 3}};
    for (size_t i = 0; i < 3; i++) {
        lmn_scene       *scene = told(bounce_path, cases[i].changed);
        const primitive *star = sign_at(scene, "star", "", 0);
        const double     expected = cases[i].across * sqrt(2 * (cases[i].height - 0.6) / 9.81);
        /* Seen from the front the star lies before the contact, towards the viewer: the middle of the fan. */
        const double at = (double)star->positions[0].x, eye = 4; /* about */
        if (fabs(at - expected) > 0.12 * fabs(expected - eye) + 0.15)
            fail_msg("case %zu: star at %g, contact at %g", i, at, expected);
        lmn_scene_destroy(&scene);
    }
}

static void make_crane_low(json_t *script)
{
    json_t *way = json_array_get(json_object_get(script, "behaviour"), 0);
    json_object_set_new(json_object_get(way, "curve"), "points",
                        json_pack("[[f,f,f],[f,f,f]]", 0.0, 2.0, 6.8, 0.0, 2.25, 3.6));
    json_t *turn = json_array_get(json_object_get(script, "behaviour"), 1);
    json_object_set_new(turn, "linear", json_pack("[f,f]", 0.0, -5.0));
}

static void frames_go_where_the_camera_goes(void **state)
{
    (void)state;
    lmn_scene   *plain = told(crane_path, NULL), *low = told(crane_path, make_crane_low);
    const double high_first = (double)sign_at(plain, "frame", "", 0)->positions[0].y,
                 low_first = (double)sign_at(low, "frame", "", 0)->positions[0].y,
                 high_last = (double)sign_at(plain, "frame", "", 3)->positions[0].y,
                 low_last = (double)sign_at(low, "frame", "", 3)->positions[0].y;
    assert_true(high_first > low_first + 3);
    assert_true(fabs(high_last - low_last) < 1e-4); /* both end at the same place */
    lmn_scene_destroy(&plain);
    lmn_scene_destroy(&low);
}

/* Letters in the look's ink, and plain paper behind them, where the look would drown them; once. */
static void looks_learn_of_signs(void **state)
{
    (void)state;
    const struct {
        const char *look, *ink;
        size_t      more;
    } cases[] = {{"storyboard", NULL, 0}, {"toon", NULL, 1}, {"line", "#1b1d24", 2}, {"chalk", "#f6f3ea", 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_look *look = NULL;
        lmn_error error = {0};
        char      value[LMN_VALUE_TEXT_MAX];
        assert_int_equal(lmn_look_load(&look, cases[i].look, &error), LMN_OK);
        const size_t before = lmn_look_rule_count(look);
        for (int times = 0; times < 2; times++)
            assert_int_equal(lmn_look_add_sign_rules(look, &error), LMN_OK);
        assert_int_equal(lmn_look_rule_count(look), before + cases[i].more);
        if (cases[i].ink) {
            assert_string_equal(lmn_look_rule_selector(look, before), "[glyph=words], [glyph=noise]");
            assert_int_equal(lmn_look_technique_count(look, before, "lines"), 0);
            assert_int_equal(lmn_look_get_text(look, before, "surface", 0, "colour", value, sizeof value, &error),
                             LMN_OK);
            assert_string_equal(value, cases[i].ink);
            assert_int_equal(lmn_look_technique_count(look, before + 1, "lines"), 1);
        }
        lmn_look_destroy(&look);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(examples_tell_what_they_claim),      cmocka_unit_test(reversed_behaviour_reverses_signs),
        cmocka_unit_test(slower_behaviour_has_shorter_lines), cmocka_unit_test(stars_go_where_contacts_go),
        cmocka_unit_test(frames_go_where_the_camera_goes),    cmocka_unit_test(looks_learn_of_signs),
    };
    return cmocka_run_group_tests_name("depict_cases", tests, NULL, NULL);
}
