/* Streaks against what is known of the motion: rows 51, 59 to 76h of Großmann 2011. */
#include "checked.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/moving_scene.h"

enum { SIDE = 400, PIXELS = SIDE * SIDE };

static lmn_renderer *renderer;

static const double red[3] = {0.8, 0.05, 0.05}, grey[3] = {0.5, 0.5, 0.5}, green[3] = {0.1, 0.6, 0.2},
                    blue[3] = {0.2, 0.3, 0.9};

static int set_up(void **state)
{
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    (void)state;
    DO(lmn_renderer_create(&renderer, &desc, &error));
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    lmn_renderer_destroy(&renderer);
    return 0;
}

/* A picture of the scene's own camera; `motion`: of its only rule, JSON, or NULL. Row 0 at the bottom. */
static void draw_look(const char *path, const char *json, double seconds, uint8_t (*out)[4])
{
    lmn_scene    *s = NULL;
    lmn_look     *look = NULL;
    lmn_drawing  *d = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, path, NULL, &error));
    DO(lmn_look_parse(&look, json, "test", &error));
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    desc.camera = "eye";
    desc.time_given = true;
    desc.time_s = seconds;
    DO(lmn_draw(&d, renderer, s, look, &desc, &error));
    const uint8_t *pixels = lmn_drawing_pixels(d, NULL, NULL);
    for (int y = 0; y < SIDE; y++)
        memcpy(out[y * SIDE], pixels + (size_t)4 * SIDE * (size_t)(SIDE - 1 - y), (size_t)4 * SIDE);
    lmn_drawing_destroy(&d);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&s);
}

static void draw_rules(const char *path, const char *rules, double seconds, uint8_t (*out)[4])
{
    char json[2048];
    snprintf(json, sizeof json, "{\"version\": 1, \"rules\": [%s]}", rules);
    draw_look(path, json, seconds, out);
}

static void draw(const char *path, const char *motion, double seconds, uint8_t (*out)[4])
{
    char rules[1024];
    snprintf(rules, sizeof rules, "{\"surface\": \"lit\"%s%s%s}",
             motion ? ", \"motion\": {\"technique\": \"streaks\", " : "", motion ? motion : "", motion ? "}" : "");
    draw_rules(path, rules, seconds, out);
}

/* Black strokes alone, of which one can measure how much of a pixel they cover: no object behind or in front. */
#define ALONE                                                                                                          \
    "\"ink\": \"colour\", \"colour\": \"#000000\", \"texture\": \"solid\", \"fade\": 1, \"fade_begin\": 0, "           \
    "\"fade_full\": 0.5, \"begin\": 2, \"full\": 2, \"front\": 0, \"taper\": 0, \"uneven\": 0, \"exposure\": 1"

static double cover(const uint8_t p[4])
{
    return 1 - p[0] / 255.;
}

static const char *path_of(const char *name)
{
    static char path[256];
    snprintf(path, sizeof path, "streaks_%s.glb", name);
    return path;
}

/* One box that moves by (x, y, z) in the last second of two; parallel rays, a unit is half the page. */
static const char *moving_box(const char *name, double half, double x, double y, double z, double turn)
{
    moving_scene m;
    const double times[] = {0, 1, 2}, half3[3] = {half, half, half};
    moving_scene_begin(&m);
    int box = moving_scene_box(&m, 0, 0, 0, half3, red);
    moving_scene_keys(&m, box, "translation", 3, times,
                      (double[]){-x / 2, -y / 2, -z, -x / 2, -y / 2, -z, x / 2, y / 2, 0});
    if (turn != 0) {
        double c = cos(turn / 2), s = sin(turn / 2);
        moving_scene_keys(&m, box, "rotation", 2, (double[]){0, 2}, (double[]){0, 0, s, c, 0, 0, s, c});
    }
    moving_scene_camera(&m, 0, 0, 10, true, 1);
    moving_scene_write(&m, path_of(name));
    return path_of(name);
}

/* --- what is at rest ------------------------------------------------------------------------------------ */

static void at_rest_nothing_changes(void **state)
{
    static uint8_t with[PIXELS][4], without[PIXELS][4];
    (void)state;
    const char *path = moving_box("rest", 0.3, 0.5, 0.2, 0, 0);
    draw(path, "\"exposure\": 0.9", 0.95, with); /* it begins to move at 1 */
    draw(path, NULL, 0.95, without);
    assert_memory_equal(with, without, sizeof with);
    draw(path, "\"exposure\": 0.9", 1.5, with);
    draw(path, NULL, 1.5, without);
    assert_memory_not_equal(with, without, sizeof with);
}

/* Parts that stand still keep every bit where no stroke comes, whatever moves beside them; row 51. */
static void what_stands_still_stays(void **state)
{
    static uint8_t with[PIXELS][4], without[PIXELS][4];
    moving_scene   m;
    const double   times[] = {0, 2}, half[3] = {0.2, 0.2, 0.2}, flat[3] = {0.25, 0.25, 0.01};
    (void)state;
    moving_scene_begin(&m);
    moving_scene_box(&m, 0.6, 0.6, 0, flat, green);
    int box = moving_scene_box(&m, 0, -0.4, 0, half, red);
    moving_scene_keys(&m, box, "translation", 2, times, (double[]){-0.4, -0.4, 0, 0.4, -0.4, 0});
    moving_scene_camera(&m, 0, 0, 10, true, 1);
    moving_scene_write(&m, path_of("still"));
    const char *rules = "{\"surface\": \"lit\", \"lines\": \"discontinuity\"%s}";
    char        plain[256], moved[256];
    snprintf(plain, sizeof plain, rules, "");
    snprintf(moved, sizeof moved, rules, ", \"motion\": {\"technique\": \"streaks\", \"exposure\": 0.5}");
    draw_rules(path_of("still"), moved, 2, with);
    draw_rules(path_of("still"), plain, 2, without);
    int upper = 0;
    for (int i = PIXELS / 2; i < PIXELS; i++)
        upper += memcmp(with[i], without[i], 4) != 0;
    assert_int_equal(upper, 0);
    assert_memory_not_equal(with, without, sizeof with);
}

/* --- where strokes are ---------------------------------------------------------------------------------- */

/* No stroke stands out ahead of an object, A6's other half: from no stroke's pixel does one meet it first against the
 * motion and never along it; row 65. */
static void none_stands_out_ahead(void **state)
{
    static uint8_t strokes[PIXELS][4], plain[PIXELS][4];
    static const struct {
        const char *name;
        double      turn, x, y;
        bool        sphere;
    } rows[] = {{"bar", 0, 0.6, 0, false},
                {"slanted", 0.6, 0.6, 0, false},
                {"slanted-up", 0.35, 0.4, 0.4, false},
                {"ball", 0, 0.6, 0, true},
                {"ball-down", 0, -0.3, -0.5, true}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char  *path = NULL;
        moving_scene m;
        if (rows[i].sphere) {
            moving_scene_begin(&m);
            int ball = moving_scene_sphere(&m, 0, 0, 0, 0.3, red);
            moving_scene_keys(&m, ball, "translation", 2, (double[]){1, 2},
                              (double[]){-rows[i].x / 2, -rows[i].y / 2, 0, rows[i].x / 2, rows[i].y / 2, 0});
            moving_scene_camera(&m, 0, 0, 10, true, 1);
            moving_scene_write(&m, path_of(rows[i].name));
            path = path_of(rows[i].name);
        } else {
            path = moving_box(rows[i].name, 0.3, rows[i].x, rows[i].y, 0, rows[i].turn);
        }
        draw(path, ALONE ", \"width\": 9, \"place\": \"front\"", 2, strokes);
        draw(path, NULL, 2, plain);
        double length = hypot(rows[i].x, rows[i].y), along[2] = {rows[i].x / length, rows[i].y / length};
        int    ahead = 0, all = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                if (cover(strokes[y * SIDE + x]) < 0.02)
                    continue;
                bool before = false, behind = false; /* is the object met when going on, or back? */
                for (int k = 0; k < SIDE; k++)
                    for (int way = -1; way <= 1; way += 2) {
                        int px = (int)floor(x + 0.5 + way * k * along[0]),
                            py = (int)floor(y + 0.5 + way * k * along[1]);
                        if (px < 0 || py < 0 || px >= SIDE || py >= SIDE || plain[py * SIDE + px][1] > 200)
                            continue;
                        before = before || way > 0;
                        behind = behind || way < 0;
                    }
                ahead += behind && !before;
                all++;
            }
        printf("%s: %d pixels of strokes, %d ahead\n", rows[i].name, all, ahead);
        assert_true(all > 2000);
        assert_int_equal(ahead, 0);
    }
}

/* The pixels of one stroke: those that hang together. */
typedef struct blob {
    double x, y, xx, xy, yy, sum; /* moments of cover */
    int    left, right, low, high, label;
} blob;

/* `labels`: of each pixel the first one of its blob, 0: none yet. */
static int flood(const uint8_t (*picture)[4], int *labels, int start, blob *b)
{
    static int stack[PIXELS];
    int        count = 0, pixels = 0;
    *b = (blob){.left = SIDE, .low = SIDE, .label = start + 1};
    stack[count++] = start;
    labels[start] = b->label;
    while (count) {
        int    at = stack[--count], x = at % SIDE, y = at / SIDE;
        double c = cover(picture[at]);
        b->sum += c;
        b->x += c * x;
        b->y += c * y;
        b->xx += c * x * x;
        b->xy += c * x * y;
        b->yy += c * y * y;
        b->left = x < b->left ? x : b->left;
        b->right = x > b->right ? x : b->right;
        b->low = y < b->low ? y : b->low;
        b->high = y > b->high ? y : b->high;
        pixels++;
        for (int k = 0; k < 9; k++) {
            int px = x + k % 3 - 1, py = y + k / 3 - 1;
            if (px < 0 || py < 0 || px >= SIDE || py >= SIDE || labels[py * SIDE + px] ||
                cover(picture[py * SIDE + px]) < 0.004)
                continue;
            labels[py * SIDE + px] = b->label;
            stack[count++] = py * SIDE + px;
        }
    }
    b->x /= b->sum;
    b->y /= b->sum;
    b->xx = b->xx / b->sum - b->x * b->x;
    b->xy = b->xy / b->sum - b->x * b->y;
    b->yy = b->yy / b->sum - b->y * b->y;
    return pixels;
}

/* Which way it lies, radians. */
static double direction_of(const blob *b)
{
    return atan2(2 * b->xy, b->xx - b->yy) / 2;
}

/* As far as a rectangle of its moments would reach: along, and across. */
static double length_of(const blob *b)
{
    double half = (b->xx - b->yy) / 2;
    return sqrt(12 * ((b->xx + b->yy) / 2 + hypot(half, b->xy)));
}

static double thickness_of(const blob *b)
{
    double half = (b->xx - b->yy) / 2;
    return sqrt(12 * fmax((b->xx + b->yy) / 2 - hypot(half, b->xy), 0));
}

/* Cover of the slices across its middle, pixels: how wide it is. */
static double width_of(const uint8_t (*picture)[4], const int *labels, const blob *b)
{
    double angle = direction_of(b), c = cos(angle), s = sin(angle), sum = 0;
    for (int y = b->low; y <= b->high; y++)
        for (int x = b->left; x <= b->right; x++) {
            double along = (x - b->x) * c + (y - b->y) * s;
            /* A slice of 8 pixels, whose ends are shared by the pixels that they cut. */
            double in = fmin(fmax(4.5 - fabs(along), 0), 1);
            sum += labels[y * SIDE + x] == b->label ? in * cover(picture[y * SIDE + x]) : 0;
        }
    return sum / 8;
}

static bool touches_border(const blob *b)
{
    return b->left == 0 || b->low == 0 || b->right == SIDE - 1 || b->high == SIDE - 1;
}

/* As wide as asked for, ±5 %, from the nearest distance to fifty times as far, along any motion, that towards the
 * viewer too; and along it within 2 degrees; rows 53, 61, 62. */
static void strokes_are_as_wide_and_lie_as_told(void **state)
{
    static uint8_t      picture[PIXELS][4];
    static int          seen[PIXELS];
    static const double moves[][3] = {{1, 0, 0}, {0, 1, 0}, {0.7, 0.7, 0}, {0.3, -0.8, 0}, {0, 0, 3}, {0.3, 0.2, 2}};
    (void)state;
    for (int d = 0; d < 3; d++)
        for (size_t i = 0; i < sizeof moves / sizeof *moves; i++) {
            const double distance = d == 0 ? 2 : d == 1 ? 10 : 100, unit = distance / 2 * 0.45;
            moving_scene m;
            double       worst_width = 0, worst_direction = 0;
            int          strokes = 0;
            const double half[3] = {3 * unit, 3 * unit, 0.01 * unit};
            moving_scene_begin(&m);
            int box = moving_scene_box(&m, 0, 0, 0, half, red);
            moving_scene_keys(&m, box, "translation", 2, (double[]){1, 2},
                              (double[]){-moves[i][0] * unit, -moves[i][1] * unit, -moves[i][2] * unit, 0, 0, 0});
            moving_scene_camera(&m, 0, 0, distance, false, 60);
            moving_scene_write(&m, path_of("wide"));
            draw(path_of("wide"), ALONE ", \"width\": 8, \"count\": 24, \"path\": \"straight\"", 2, picture);
            memset(seen, 0, sizeof seen);
            /* The point on the page to which the motion tends, or its direction. */
            for (int at = 0; at < PIXELS; at++) {
                blob b;
                if (seen[at] || cover(picture[at]) < 0.5)
                    continue;
                flood((const uint8_t(*)[4])picture, seen, at, &b);
                /* Whole strokes by themselves. */
                if (touches_border(&b) || length_of(&b) < 40 || thickness_of(&b) > 8.5)
                    continue;
                /* A point p of the plane z = 0 on the page: f p / distance; before, f (p − m) / (distance + mz). */
                double focal = SIDE / 2 / tan(30 * 3.141592653589793 / 180), along[2];
                double page[2] = {b.x + 0.5 - SIDE / 2., b.y + 0.5 - SIDE / 2.};
                for (int k = 0; k < 2; k++) { /* tangent through the middle: derivative of the projection there */
                    double v = moves[i][k] * unit, vz = moves[i][2] * unit;
                    along[k] = focal * v + page[k] * vz;
                }
                double off = fabs(sin(direction_of(&b) - atan2(along[1], along[0])));
                worst_direction = fmax(worst_direction, asin(fmin(off, 1)) * 180 / 3.141592653589793);
                worst_width = fmax(worst_width, fabs(width_of((const uint8_t(*)[4])picture, seen, &b) / 8 - 1));
                strokes++;
            }
            printf("distance %3g, motion %g %g %g: %d strokes, width off by %.1f %%, direction by %.2f degrees\n",
                   distance / 2, moves[i][0], moves[i][1], moves[i][2], strokes, 100 * worst_width, worst_direction);
            assert_true(strokes >= 5);
            assert_true(worst_width < 0.05);
            assert_true(worst_direction < 2);
        }
}

/* As many at the border that strokes come in from as inside, ±15 %; row 60. A plane fills the picture. */
static void the_border_is_as_dense(void **state)
{
    static uint8_t picture[PIXELS][4];
    moving_scene   m;
    const double   half[3] = {8, 8, 0.01};
    (void)state;
    moving_scene_begin(&m);
    int box = moving_scene_box(&m, 0, 0, 0, half, red);
    moving_scene_keys(&m, box, "translation", 2, (double[]){1, 2}, (double[]){-0.1, 0, 0, 0, 0, 0});
    moving_scene_camera(&m, 0, 0, 10, true, 1);
    moving_scene_write(&m, path_of("border"));
    draw(path_of("border"), ALONE ", \"width\": 3, \"count\": 4000", 2, picture);
    double sums[10] = {0};
    for (int i = 0; i < PIXELS; i++)
        sums[i % SIDE / (SIDE / 10)] += cover(picture[i]);
    double inside = 0;
    for (int k = 2; k < 8; k++)
        inside += sums[k] / 6;
    printf("cover left %.3f, right %.3f of that inside\n", sums[0] / inside, sums[9] / inside);
    assert_true(fabs(sums[0] / inside - 1) < 0.15 && fabs(sums[9] / inside - 1) < 0.15);
    /* Without seeds beyond it there is a gap. */
    draw(path_of("border"), ALONE ", \"width\": 3, \"count\": 2800, \"margin\": 0", 2, picture);
    double right = 0;
    inside = 0;
    for (int i = 0; i < PIXELS; i++) {
        right += i % SIDE >= SIDE - 15 ? cover(picture[i]) / 15 : 0;
        inside += i % SIDE >= SIDE / 4 && i % SIDE < 3 * SIDE / 4 ? cover(picture[i]) / (SIDE / 2) : 0;
    }
    assert_true(right < 0.85 * inside);
}

/* --- fading and overlap --------------------------------------------------------------------------------- */

/* Two movers that cross: nowhere darker than the darker of the two as it is drawn at rest (two glazes are a little
 * darker than each alone, as on paper), the one behind is seen through what is left of the other, and what comes first
 * in the file does not matter; rows 48, 69, 70, 75, 76f. */
static void crossing_movers_are_no_darker(void **state)
{
    static uint8_t       both[PIXELS][4], swapped[PIXELS][4], first[PIXELS][4], second[PIXELS][4];
    static const uint8_t objects[2][3] = {{124, 149, 243}, {89, 203, 124}}; /* blue and green */
    const double         times[] = {1, 2}, tall[3] = {0.12, 0.6, 0.05}, wide[3] = {0.6, 0.12, 0.05};
    (void)state;
    for (int which = 0; which < 4; which++) {
        moving_scene m;
        moving_scene_begin(&m);
        for (int k = 0; k < 2; k++) {
            bool is_tall = which == 1 ? k == 1 : k == 0;
            if ((which == 2 && !is_tall) || (which == 3 && is_tall))
                continue;
            int box = is_tall ? moving_scene_box(&m, 0, 0, 0, tall, blue) : moving_scene_box(&m, 0, 0, 0, wide, green);
            if (is_tall)
                moving_scene_keys(&m, box, "translation", 2, times, (double[]){-0.2, 0, 0.2, 0.1, 0, 0.2});
            else
                moving_scene_keys(&m, box, "translation", 2, times, (double[]){0, 0.3, -0.2, 0, 0, -0.2});
        }
        moving_scene_camera(&m, 0, 0, 10, true, 1);
        moving_scene_write(&m, path_of("cross"));
        draw(path_of("cross"), "\"exposure\": 1, \"fade_begin\": 4, \"fade_full\": 40, \"count\": 3000", 2,
             which == 0   ? both
             : which == 1 ? swapped
             : which == 2 ? first
                          : second);
    }
    assert_memory_equal(both, swapped, sizeof both);
    int crossed = 0, through = 0, most = 0;
    for (int i = 0; i < PIXELS; i++) {
        bool here = first[i][0] < 250 && second[i][0] < 250;
        crossed += here;
        through += here && abs(both[i][0] - first[i][0]) > 8 && abs(both[i][0] - second[i][0]) > 8;
        for (int k = 0; k < 3; k++) {
            int darker = first[i][k] < second[i][k] ? first[i][k] : second[i][k];
            most = darker - both[i][k] > most ? darker - both[i][k] : most;
            if (both[i][k] < (objects[0][k] < objects[1][k] ? objects[0][k] : objects[1][k]) - 1)
                fail_msg("pixel %d, %d: %d, alone %d and %d", i % SIDE, i / SIDE, both[i][k], first[i][k],
                         second[i][k]);
        }
    }
    printf("%d pixels where both are, %d where both show; %d steps of 255 darker than both alone at most\n", crossed,
           through, most);
    assert_true(crossed > 500 && through > 100);
}

/* Of two bars that lie crosswise in depth each hides the other where it is nearer, whichever middle is: pixel by
 * pixel; row 69. */
static void order_is_that_of_pixels(void **state)
{
    static uint8_t picture[PIXELS][4];
    const double   half[3] = {0.8, 0.2, 0.01}, turn = 0.5;
    (void)state;
    for (int swapped = 0; swapped < 2; swapped++) {
        moving_scene m;
        moving_scene_begin(&m);
        for (int k = 0; k < 2; k++) {
            bool   flat = k == swapped;
            double z = flat ? 0.05 : 0, s = flat ? 0 : sin(turn / 2), c = flat ? 1 : cos(turn / 2);
            int    bar = moving_scene_box(&m, 0, 0, z, half, flat ? green : blue);
            moving_scene_keys(&m, bar, "translation", 2, (double[]){1, 2}, (double[]){0, -0.05, z, 0, 0, z});
            moving_scene_keys(&m, bar, "rotation", 2, (double[]){1, 2}, (double[]){0, s, 0, c, 0, s, 0, c});
        }
        moving_scene_camera(&m, 0, 0, 10, true, 1);
        moving_scene_write(&m, path_of("order"));
        draw(path_of("order"), "\"exposure\": 1, \"fade\": 0, \"count\": 1", 2, picture);
        /* Turned about y its left end comes nearer. */
        const uint8_t *left = picture[(SIDE / 2) * SIDE + SIDE / 5], *right = picture[(SIDE / 2) * SIDE + 4 * SIDE / 5];
        assert_true(left[2] > 200 && right[1] > 190 && right[2] < 150);
    }
}

/* However many move: two that cross look as they do alone when seventy others move far behind them, and come first. */
static void many_movers_are_each_by_themselves(void **state)
{
    static uint8_t alone[PIXELS][4], among[PIXELS][4];
    const double   times[] = {1, 2}, tall[3] = {0.12, 0.6, 0.05}, wide[3] = {0.6, 0.12, 0.05},
                 speck[3] = {0.001, 0.001, 0.001};
    (void)state;
    for (int others = 0; others <= 70; others += 70) {
        moving_scene m;
        moving_scene_begin(&m);
        for (int k = 0; k < others; k++) {
            int box = moving_scene_box(&m, 0, -0.9, -4, speck, grey);
            moving_scene_keys(&m, box, "translation", 2, times, (double[]){-0.9, -0.97, -4, 0.9, -0.97, -4});
        }
        int first = moving_scene_box(&m, 0, 0, 0, tall, blue), second = moving_scene_box(&m, 0, 0, 0, wide, green);
        moving_scene_keys(&m, first, "translation", 2, times, (double[]){-0.2, 0, 0.2, 0.1, 0, 0.2});
        moving_scene_keys(&m, second, "translation", 2, times, (double[]){0, 0.3, -0.2, 0, 0, -0.2});
        moving_scene_camera(&m, 0, 0, 10, true, 1);
        moving_scene_write(&m, path_of("many"));
        draw(path_of("many"), "\"exposure\": 1, \"count\": 1000, \"path\": \"straight\"", 2, others ? among : alone);
    }
    assert_memory_equal(&alone[PIXELS / 4], &among[PIXELS / 4], sizeof alone / 4 * 3);
}

/* A mover behind a wall with a slit: the wall keeps its bits, in the slit strokes are seen; row 71, scene S6. */
static void walls_hide_strokes(void **state)
{
    static uint8_t with[PIXELS][4], without[PIXELS][4];
    moving_scene   m;
    const double   wall[3] = {0.4, 0.9, 0.02}, ball[3] = {0.15, 0.15, 0.15};
    (void)state;
    moving_scene_begin(&m);
    moving_scene_box(&m, -0.5, 0, 1, wall, grey);
    moving_scene_box(&m, 0.5, 0, 1, wall, grey);
    int box = moving_scene_box(&m, 0.5, 0, 0, ball, red);
    moving_scene_keys(&m, box, "translation", 2, (double[]){1, 2}, (double[]){-0.6, 0, 0, 0.3, 0, 0});
    moving_scene_camera(&m, 0, 0, 10, true, 1);
    moving_scene_write(&m, path_of("curtain"));
    draw(path_of("curtain"), "\"exposure\": 1", 2, with);
    draw(path_of("curtain"), NULL, 2, without);
    int changed = 0, slit = 0;
    for (int i = 0; i < PIXELS; i++) {
        bool is_slit = i % SIDE >= SIDE * 9 / 20 && i % SIDE < SIDE * 11 / 20;
        changed += !is_slit && memcmp(with[i], without[i], 4) != 0;
        slit += is_slit && memcmp(with[i], without[i], 4) != 0;
    }
    assert_int_equal(changed, 0);
    assert_true(slit > 1000);
}

/* Strokes fade in without a jump, and objects out; rows 66, 67, 70. */
static void fading_is_smooth(void **state)
{
    static uint8_t picture[PIXELS][4];
    double         before = 0, biggest = 0;
    (void)state;
    const char *path = moving_box("fading", 0.3, 0.4, 0, 0, 0); /* 80 pixels a second */
    for (int i = 0; i <= 24; i++) {
        char   motion[256];
        double sum = 0;
        snprintf(motion, sizeof motion,
                 "\"ink\": \"colour\", \"colour\": \"#000000\", \"texture\": \"solid\", \"count\": 400, \"begin\": 12, "
                 "\"full\": 36, \"fade\": 0, \"uneven\": 0, \"place\": \"front\", \"exposure\": %g",
                 i / 40. + 0.01);
        draw(path, motion, 2, picture);
        for (int k = 0; k < PIXELS; k++)
            sum += cover(picture[k]);
        if (i > 0)
            biggest = fmax(biggest, fabs(sum - before));
        before = sum;
    }
    printf("the largest step of ink between exposures 2 pixels apart: %.0f of %.0f\n", biggest, before);
    assert_true(before > 3000 && biggest < 0.12 * before);
}

/* --- forms ---------------------------------------------------------------------------------------------- */

/* Strokes of a turning bar lie on circles, within 2 pixels; row 76a. */
static void strokes_follow_arcs(void **state)
{
    static uint8_t picture[PIXELS][4];
    static int     seen[PIXELS];
    static const struct {
        const char *path;
        double      turn;
    } rows[] = {{"bent", 0.9}, {"winding", 1.6}, {"winding", 3}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        moving_scene m;
        const double half[3] = {0.85, 0.06, 0.05};
        char         motion[512];
        double       times[9], turns[36], worst = 0;
        int          strokes = 0;
        for (int k = 0; k < 9; k++) {
            double angle = rows[i].turn * (k / 8. - 1) / 2;
            times[k] = 1 + k / 8.;
            memcpy(&turns[4 * k], (double[]){0, 0, sin(angle), cos(angle)}, 4 * sizeof *turns);
        }
        moving_scene_begin(&m);
        int bar = moving_scene_box(&m, 0, 0, 0, half, red);
        moving_scene_keys(&m, bar, "rotation", 9, times, turns);
        moving_scene_camera(&m, 0, 0, 10, true, 1);
        moving_scene_write(&m, path_of("arc"));
        snprintf(motion, sizeof motion, ALONE ", \"width\": 3, \"count\": 300, \"path\": \"%s\"", rows[i].path);
        draw(path_of("arc"), motion, 2, picture);
        memset(seen, 0, sizeof seen);
        for (int at = 0; at < PIXELS; at++) {
            blob b;
            if (seen[at] || cover(picture[at]) < 0.5)
                continue;
            if (flood((const uint8_t(*)[4])picture, seen, at, &b) < 60)
                continue;
            /* Radii of its pixels, which are all of this blob when no other shares its box's rings. */
            double inner = 1e9, outer = 0;
            for (int p = 0; p < PIXELS; p++)
                if (seen[p] == b.label && cover(picture[p]) > 0.5) {
                    double r = hypot(p % SIDE + 0.5 - SIDE / 2., p / SIDE + 0.5 - SIDE / 2.);
                    inner = fmin(inner, r);
                    outer = fmax(outer, r);
                }
            if (outer - inner > 12) /* several strokes that touch */
                continue;
            worst = fmax(worst, (outer - inner - 3) / 2);
            strokes++;
        }
        printf("%s, %.1f radians: %d strokes, %.2f pixels off their circles at most\n", rows[i].path, rows[i].turn,
               strokes, worst);
        assert_true(strokes >= 5 && worst < 2);
    }
}

/* A6: `behind` leaves the object as it is. A7: twice the exposure, twice the length. Rows 73, 76b. */
static void speed_lines_leave_the_object(void **state)
{
    static uint8_t with[PIXELS][4], without[PIXELS][4];
    double         lengths[2];
    (void)state;
    const char *path = moving_box("lines", 0.2, 0.8, 0, 0, 0);
    draw(path, NULL, 2, without);
    for (int i = 0; i < 2; i++) {
        char motion[300];
        int  left = SIDE, edge = SIDE;
        snprintf(motion, sizeof motion,
                 "\"ink\": \"colour\", \"colour\": \"#000000\", \"texture\": \"solid\", \"fade\": 0, \"place\": "
                 "\"behind\", \"exposure\": %g",
                 0.3 * (i + 1));
        draw(path, motion, 2, with);
        for (int k = 0; k < PIXELS; k++) {
            bool object = without[k][1] < 200;
            if (object)
                assert_memory_equal(with[k], without[k], 4);
            if (object && k % SIDE < edge)
                edge = k % SIDE;
            if (!object && cover(with[k]) > 0.5 && k % SIDE < left)
                left = k % SIDE;
        }
        lengths[i] = edge - left;
    }
    printf("lines of %.0f and %.0f pixels\n", lengths[0], lengths[1]);
    assert_true(fabs(lengths[0] - 48) < 6 && fabs(lengths[1] - 96) < 6);
}

/* With `scaled` what is farther has more and thinner strokes; row 63. */
static void scaled_strokes_shrink_with_distance(void **state)
{
    static uint8_t picture[PIXELS][4];
    static int     seen[PIXELS];
    double         widths[2], inks[2] = {0, 0};
    int            counts[2];
    moving_scene   m;
    const double   half[3] = {1, 0.8, 0.01}, far[3] = {3, 2.4, 0.01};
    (void)state;
    moving_scene_begin(&m);
    /* Both are as large on the page: the upper one three times as far. */
    int near_box = moving_scene_box(&m, 0, -1, 0, half, red), far_box = moving_scene_box(&m, 0, 3, -8, far, red);
    moving_scene_keys(&m, near_box, "translation", 2, (double[]){1, 2}, (double[]){-0.3, -1, 0, 0, -1, 0});
    moving_scene_keys(&m, far_box, "translation", 2, (double[]){1, 2}, (double[]){-0.9, 3, -8, 0, 3, -8});
    moving_scene_camera(&m, 0, 0, 4, false, 60);
    moving_scene_write(&m, path_of("scaled"));
    draw_rules(path_of("scaled"),
               "{\"surface\": \"lit\"}, {\"select\": \"*node*\", \"surface\": \"lit\", \"motion\": {\"technique\": "
               "\"streaks\", " ALONE ", \"width\": 9, \"scaled\": true, \"count\": 600, \"path\": \"straight\"}}",
               2, picture);
    for (int i = 0; i < PIXELS; i++)
        inks[i / (PIXELS / 2)] += cover(picture[i]);
    for (int half_page = 0; half_page < 2; half_page++) {
        double sum = 0;
        counts[half_page] = 0;
        memset(seen, 0, sizeof seen);
        for (int at = half_page * PIXELS / 2; at < (half_page + 1) * PIXELS / 2; at++) {
            blob b;
            if (seen[at] || cover(picture[at]) < 0.5)
                continue;
            flood((const uint8_t(*)[4])picture, seen, at, &b);
            if (touches_border(&b) || length_of(&b) < 15 || thickness_of(&b) > 9.5)
                continue;
            sum += width_of((const uint8_t(*)[4])picture, seen, &b);
            counts[half_page]++;
        }
        widths[half_page] = sum / counts[half_page];
    }
    printf("near %d strokes %.1f wide, far %d strokes %.1f wide\n", counts[0], widths[0], counts[1], widths[1]);
    assert_true(counts[0] >= 3 && counts[1] > 2 * counts[0]);
    assert_true(widths[0] > 2 * widths[1]);
    assert_true(inks[0] < inks[1]); /* a ninth of the strokes, three times as wide */
}

/* Each rule has its own: two objects, two textures; accumulated and streaked ones in one picture; rows 74, 76d. */
static void rules_have_their_own(void **state)
{
    static uint8_t mixed[PIXELS][4], alone[PIXELS][4];
    moving_scene   m;
    const double   half[3] = {0.2, 0.2, 0.05}, times[] = {1, 2};
    (void)state;
    moving_scene_begin(&m);
    int low = moving_scene_box(&m, 0, -0.5, 0, half, red), high = moving_scene_box(&m, 0, 0.5, 0, half, blue);
    moving_scene_keys(&m, low, "translation", 2, times, (double[]){-0.4, -0.5, 0, 0.4, -0.5, 0});
    moving_scene_keys(&m, high, "translation", 2, times, (double[]){-0.4, 0.5, 0, 0.4, 0.5, 0});
    moving_scene_camera(&m, 0, 0, 10, true, 1);
    moving_scene_write(&m, path_of("rules"));
    const char *streaked =
        "{\"surface\": \"lit\"}, {\"select\": \"node0\", \"surface\": \"lit\", \"motion\": {\"technique\": "
        "\"streaks\", \"exposure\": 0.5}}";
    char both[800];
    draw_rules(path_of("rules"), streaked, 2, alone);
    snprintf(
        both, sizeof both,
        "%s, {\"select\": \"node1\", \"surface\": \"lit\", \"motion\": {\"technique\": \"accumulate\", \"times\": 4, "
        "\"exposure\": 0.5}}",
        streaked);
    draw_rules(path_of("rules"), both, 2, mixed);
    int lower = 0, upper = 0;
    for (int i = 0; i < PIXELS; i++) {
        bool differs = abs(mixed[i][0] - alone[i][0]) > 1 || abs(mixed[i][2] - alone[i][2]) > 1;
        lower += i < PIXELS / 2 && differs;
        upper += i >= PIXELS / 2 && differs;
    }
    assert_int_equal(lower, 0);
    assert_true(upper > 1000);
}

/* The viewer comes nearer: strokes are radial all around, and nowhere is a band without any; row 61, scene S2. */
static void a_zoom_leaves_no_band(void **state)
{
    static uint8_t picture[PIXELS][4];
    moving_scene   m;
    const double   half[3] = {8, 8, 0.01};
    double         ink[12] = {0};
    int            pixels[12] = {0};
    (void)state;
    moving_scene_begin(&m);
    moving_scene_box(&m, 0, 0, 0, half, red);
    int eye = moving_scene_camera(&m, 0, 0, 4, false, 60);
    moving_scene_keys(&m, eye, "translation", 2, (double[]){1, 2}, (double[]){0, 0, 6, 0, 0, 4});
    moving_scene_write(&m, path_of("zoom"));
    draw(path_of("zoom"), ALONE ", \"width\": 3, \"count\": 3000", 2, picture);
    for (int i = 0; i < PIXELS; i++) {
        double x = i % SIDE + 0.5 - SIDE / 2., y = i / SIDE + 0.5 - SIDE / 2., r = hypot(x, y);
        if (r < 60 || r > 180)
            continue;
        int sector = (int)((atan2(y, x) / 6.283185307179586 + 1 + 1 / 24.) * 12) % 12; /* centred on the axes */
        ink[sector] += cover(picture[i]);
        pixels[sector]++;
    }
    for (int k = 0; k < 12; k++) {
        printf("%.2f ", ink[k] / pixels[k]);
        assert_true(ink[k] / pixels[k] > 0.2);
    }
    printf("of the sectors is covered\n");
}

/* No stroke begins where the mask is black, or on surfaces that look the wrong way; row 76c. */
static void strokes_begin_where_they_may(void **state)
{
    static uint8_t picture[PIXELS][4];
    static int     seen[PIXELS];
    moving_scene   m;
    int            strokes[3] = {0}, wrong = 0, masked = 0;
    (void)state;
    moving_scene_begin(&m);
    int ball = moving_scene_sphere(&m, 0, 0, 0, 0.7, red);
    moving_scene_keys(&m, ball, "translation", 2, (double[]){1, 2}, (double[]){-0.2, 0, 0, 0, 0, 0});
    moving_scene_camera(&m, 0, 0, 10, true, 1);
    moving_scene_write(&m, path_of("valid"));
    for (int k = 0; k < 3; k++) {
        static const char *const where[] = {"trailing", "leading", "all\", \"mask\": \"checker"};
        char                     motion[512];
        snprintf(motion, sizeof motion, ALONE ", \"width\": 3, \"count\": 300, \"shift_width\": 0, \"where\": \"%s\"",
                 where[k]);
        draw(path_of("valid"), motion, 2, picture);
        memset(seen, 0, sizeof seen);
        for (int at = 0; at < PIXELS; at++) {
            blob b;
            if (seen[at] || cover(picture[at]) < 0.5)
                continue;
            flood((const uint8_t(*)[4])picture, seen, at, &b);
            if (thickness_of(&b) > 4)
                continue;
            strokes[k]++;
            int column = (b.right - 1) / (SIDE / 8), row = (int)b.y / (SIDE / 8); /* its head is at the right */
            wrong += k == 0 ? b.right > SIDE / 2 + 3 : k == 1 ? b.right < SIDE / 2 - 3 : 0;
            masked += k == 2 && (column + row) % 2 == 0 && (b.right - 1) % (SIDE / 8) > 3 &&
                      (b.right - 1) % (SIDE / 8) < SIDE / 8 - 4;
        }
    }
    printf("%d strokes that trail, %d that lead, %d under the mask; %d wrong, %d masked\n", strokes[0], strokes[1],
           strokes[2], wrong, masked);
    assert_true(strokes[0] >= 10 && strokes[1] >= 10 && strokes[2] >= 10);
    assert_int_equal(wrong, 0);
    assert_int_equal(masked, 0);
}

/* Strokes throw shadows onto what lies below, when they are told to and the look has shadows; row 76e. */
static void strokes_throw_shadows(void **state)
{
    static uint8_t pictures[4][PIXELS][4];
    moving_scene   m;
    const double   half[3] = {0.25, 0.25, 0.25}, floor[3] = {0.95, 0.95, 0.02};
    int            darker = 0, same = 0;
    (void)state;
    moving_scene_begin(&m);
    m.lit = true;
    moving_scene_box(&m, 0, 0, -0.6, floor, grey);
    int box = moving_scene_box(&m, 0, 0.2, 0, half, red);
    moving_scene_keys(&m, box, "translation", 2, (double[]){1, 2}, (double[]){-0.5, 0.2, 0, 0.5, 0.2, 0});
    moving_scene_camera(&m, 0, 0, 10, true, 1);
    moving_scene_write(&m, path_of("shadow"));
    for (int k = 0; k < 4; k++) {
        char json[600];
        snprintf(json, sizeof json,
                 "{\"version\": 1, \"scene\": {\"shadows\": %s}, \"rules\": [{\"surface\": \"lit\", \"motion\": "
                 "{\"technique\": \"streaks\", \"exposure\": 1, \"width\": 9, \"count\": 3000, \"shadows\": %s}}]}",
                 k < 2 ? "true" : "false", k % 2 ? "true" : "false");
        draw_look(path_of("shadow"), json, 2, pictures[k]);
    }
    for (int i = 0; i < PIXELS; i++) {
        darker += pictures[1][i][1] < pictures[0][i][1] - 20;
        same += memcmp(pictures[2][i], pictures[3][i], 4) == 0;
    }
    printf("%d pixels lie in the shadow of strokes\n", darker);
    assert_true(darker > 1000);
    assert_int_equal(same, PIXELS);
}

/* How far gradients lie across a direction, 0 … 1, of what is outside of the middle; a half: they lie anyhow. */
static double across(const uint8_t (*picture)[4], double direction)
{
    double sums[2] = {0, 0};
    for (int y = 20; y < SIDE - 20; y++)
        for (int x = 20; x < SIDE - 20; x++) {
            const uint8_t(*p)[4] = picture + y * SIDE + x;
            double g[2] = {p[1][1] - p[-1][1], p[SIDE][1] - p[-SIDE][1]},
                   along = g[0] * cos(direction) + g[1] * sin(direction);
            if (abs(x - SIDE / 2) < 80 && abs(y - SIDE / 2) < 80)
                continue;
            sums[0] += along * along;
            sums[1] += g[0] * g[0] + g[1] * g[1];
        }
    return 1 - sums[0] / sums[1];
}

/* A camera goes with its subject, which stays as it is, and what is behind it dissolves into strokes along the way;
 * row 77l. */
static void a_tracked_subject_stays(void **state)
{
    static uint8_t    with[PIXELS][4], without[PIXELS][4];
    const double      small[3] = {0.04, 0.04, 0.04}, half[3] = {0.3, 0.3, 0.05};
    const char *const motions[] = {
        "{\"technique\": \"streaks\", \"exposure\": 0.6, \"fade_full\": 40, \"front\": 0, \"fade\": 1}",
        "{\"technique\": \"blur\", \"exposure\": 0.6}"};
    (void)state;
    for (int k = 0; k < 4; k++) {
        moving_scene m;
        char         rules[400];
        uint32_t     random = 12345;
        int          changed = 0;
        double       direction = k / 2 ? 0.6 : 0, way[2] = {cos(direction), sin(direction)};
        moving_scene_begin(&m);
        for (int i = 0; i < 500; i++) {
            double at[2];
            for (int c = 0; c < 2; c++) {
                random = random * 1664525u + 1013904223u;
                at[c] = ((random >> 8) / 16777216. - 0.5) * 4.4;
            }
            moving_scene_box(&m, at[0], at[1], -2, small, i % 2 ? green : blue);
        }
        int subject = moving_scene_box(&m, 0, 0, 0, half, red), eye = moving_scene_camera(&m, 0, 0, 10, true, 1);
        moving_scene_keys(&m, subject, "translation", 2, (double[]){0, 2},
                          (double[]){-way[0], -way[1], 0, way[0], way[1], 0});
        moving_scene_keys(&m, eye, "translation", 2, (double[]){0, 2},
                          (double[]){-way[0], -way[1], 10, way[0], way[1], 10});
        moving_scene_write(&m, path_of("tracked"));
        snprintf(rules, sizeof rules, "{\"surface\": \"lit\", \"motion\": %s}", motions[k % 2]);
        draw_rules(path_of("tracked"), rules, 1, with);
        draw_rules(path_of("tracked"), "{\"surface\": \"lit\"}", 1, without);
        for (int y = -58; y <= 58; y++)
            changed += memcmp(with[(SIDE / 2 + y) * SIDE + SIDE / 2 - 58],
                              without[(SIDE / 2 + y) * SIDE + SIDE / 2 - 58], 4 * 117) != 0;
        double before = across((const uint8_t(*)[4])without, direction),
               after = across((const uint8_t(*)[4])with, direction);
        printf("gradients across the way of the camera, %.2f rad: %.2f, in a still %.2f\n", direction, after, before);
        assert_int_equal(changed, 0);
        assert_true(after > 0.8 && before < 0.6);
    }
}

/* How far a mover dissolves follows how fast each of its pixels is: a weapon more than who swings it, its tip more than
 * its hilt. */
static void what_is_faster_dissolves_more(void **state)
{
    static uint8_t picture[PIXELS][4];
    enum { BEGIN = 10, FULL = 160 };
    moving_scene m;
    const double black[3] = {0, 0, 0}, half[3] = {0.15, 0.2, 0.05}, rod[3] = {0.35, 0.03, 0.02}, gone = 0.2, turn = 0.9;
    double       worst = 0, least[2] = {1, 1}, most[2] = {0, 0};
    int          looked[2] = {0, 0};
    (void)state;
    moving_scene_begin(&m);
    int body = moving_scene_box(&m, 0, 0, 0, half, black), shoulder = moving_scene_joint(&m, 0, 0, 0),
        weapon = moving_scene_box(&m, 0.5, 0, 0, rod, black);
    moving_scene_put_in(&m, weapon, shoulder);
    moving_scene_put_in(&m, shoulder, body);
    moving_scene_keys(&m, body, "translation", 2, (double[]){0, 1}, (double[]){-gone, 0, 0, 0, 0, 0});
    moving_scene_keys(&m, shoulder, "rotation", 2, (double[]){0, 1},
                      (double[]){0, 0, sin(turn / 2), cos(turn / 2), 0, 0, 0, 1});
    moving_scene_camera(&m, 0, 0, 10, true, 1);
    moving_scene_write(&m, path_of("weapon"));
    draw(path_of("weapon"),
         "\"exposure\": 1, \"opacity\": 0, \"fade\": 1, \"fade_begin\": 10, \"fade_full\": 160, \"front\": 0, "
         "\"path\": \"straight\"",
         1, picture);
    for (int i = 0; i < PIXELS; i++) {
        double x = (i % SIDE + 0.5 - SIDE / 2.) / (SIDE / 2.), y = (i / SIDE + 0.5 - SIDE / 2.) / (SIDE / 2.);
        bool   in_body = fabs(x) < 0.14 && fabs(y) < 0.19, in_weapon = fabs(x - 0.5) < 0.34 && fabs(y) < 0.022;
        if (!in_body && (!in_weapon || x < 0.18))
            continue;
        double was[2] = {x, y}, light = picture[i][0] / 255.;
        if (!in_body) {
            was[0] = cos(turn) * x - sin(turn) * y;
            was[1] = sin(turn) * x + cos(turn) * y;
        }
        double far = hypot(x - was[0] + gone, y - was[1]) * (SIDE / 2.),
               told = fmin(fmax((far - BEGIN) / (FULL - BEGIN), 0), 1);
        worst = fmax(worst, fabs(light - told));
        least[in_weapon] = fmin(least[in_weapon], light);
        most[in_weapon] = fmax(most[in_weapon], light);
        looked[in_weapon]++;
    }
    printf("dissolved: who swings %.2f to %.2f, the weapon %.2f to %.2f; off by %.3f\n", least[0], most[0], least[1],
           most[1], worst);
    assert_true(looked[0] > 1000 && looked[1] > 400);
    assert_true(worst < 0.03);
    assert_true(most[0] < least[1] && most[1] > least[1] + 0.3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(at_rest_nothing_changes),
                                       cmocka_unit_test(what_stands_still_stays),
                                       cmocka_unit_test(none_stands_out_ahead),
                                       cmocka_unit_test(strokes_are_as_wide_and_lie_as_told),
                                       cmocka_unit_test(the_border_is_as_dense),
                                       cmocka_unit_test(crossing_movers_are_no_darker),
                                       cmocka_unit_test(order_is_that_of_pixels),
                                       cmocka_unit_test(many_movers_are_each_by_themselves),
                                       cmocka_unit_test(walls_hide_strokes),
                                       cmocka_unit_test(fading_is_smooth),
                                       cmocka_unit_test(strokes_follow_arcs),
                                       cmocka_unit_test(speed_lines_leave_the_object),
                                       cmocka_unit_test(scaled_strokes_shrink_with_distance),
                                       cmocka_unit_test(rules_have_their_own),
                                       cmocka_unit_test(a_zoom_leaves_no_band),
                                       cmocka_unit_test(strokes_begin_where_they_may),
                                       cmocka_unit_test(a_tracked_subject_stays),
                                       cmocka_unit_test(what_is_faster_dissolves_more),
                                       cmocka_unit_test(strokes_throw_shadows)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
