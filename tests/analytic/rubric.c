/* What a reader who has nothing but the still can tell of a motion: its direction, how far it went, and what it is that
 * moves. Cutting 2002, as Großmann 2011, section 2.3, has it; row 77n. The reader looks at ink beside the object: from
 * where most of it lies the object has come, and as far as it reaches. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "moving_scene.h"
#include "picture.h"
#include "shot.h"

static const double pi = 3.14159265358979323846;
/* The page is ten units of the world high. What moves goes so far while the shutter is open, units. */
enum { SIDE = 400, UNIT = SIDE / 10 };
#define WAY 2.4

typedef struct style {
    const char *name, *motion; /* JSON; NULL: none */
    bool        ours;          /* must hold; others are measured */
} style;

static const style styles[] = {
    {"speed-lines", "{\"technique\": \"traces\", \"exposure\": 1}", true},
    {"ghosts", "{\"technique\": \"traces\", \"exposure\": 1, \"lines\": 0, \"contours\": 5}", true},
    {"echoes", "{\"technique\": \"traces\", \"exposure\": 1, \"lines\": 0, \"contours\": 8, \"trailing\": true}", true},
    {"comic", "{\"technique\": \"traces\", \"exposure\": 1, \"contours\": 2, \"ends\": \"wedges\"}", true},
    {"swept", "{\"technique\": \"traces\", \"exposure\": 1, \"lines\": 0, \"contours\": 1, \"figures\": \"swept\"}",
     true},
    {"plate",
     "{\"technique\": \"accumulate\", \"exposure\": 1.2, \"times\": 6, \"weights\": \"plate\", \"decay\": 0.8}", false},
    {"accumulate", "{\"technique\": \"accumulate\", \"exposure\": 1}", false},
    {"blur", "{\"technique\": \"blur\", \"exposure\": 1}", false},
    {"stretched", "{\"technique\": \"stretched\", \"exposure\": 1}", false},
    {"streaks", "{\"technique\": \"streaks\", \"exposure\": 1}", false},
    {"streak-map", "{\"technique\": \"streak-map\", \"exposure\": 1}", false},
};

typedef struct reading {
    double direction, way; /* degrees off, fraction off */
    double whole;          /* of the object's pixels, how many are as without motion */
} reading;

/* A ball, or a block that is no ball, on its way at an angle. */
static const char *write_mover(bool ball, double angle)
{
    moving_scene m;
    const double grey[3] = {0.3, 0.3, 0.3}, x = cos(angle), y = sin(angle);
    const char  *path = check_path("%s-%.0f.glb", ball ? "ball" : "block", angle * 180 / pi);
    moving_scene_begin(&m);
    int n = ball ? moving_scene_sphere(&m, 0, 0, 0, 0.8, grey)
                 : moving_scene_box(&m, 0, 0, 0, (double[]){0.9, 0.5, 0.5}, grey);
    moving_scene_keys(&m, n, "translation", 2, (double[]){0, 2},
                      (double[]){-1.5 * WAY * x, -1.5 * WAY * y, 0, 0.5 * WAY * x, 0.5 * WAY * y, 0});
    moving_scene_write(&m, path);
    return path;
}

static bool draw(shot *out, const char *path, const char *motion)
{
    char      look[1024];
    shot_view view = {.width = SIDE,
                      .height = SIDE,
                      .eye = {0, 0, 60},
                      .up = {0, 1, 0},
                      .fov_deg = 2 * atan(5.0 / 60) * 180 / pi,
                      .samples = 4,
                      .time_s = 2,
                      .without_maps = motion != NULL};
    snprintf(look, sizeof look, "{\"version\": 1, \"rules\": [{\"surface\": \"lit\", \"lines\": \"strokes\"%s%s}]}",
             motion ? ", \"motion\": " : "", motion ? motion : "");
    return shot_take(out, path, look, NULL, &view);
}

static double ink_at(const shot *s, size_t pixel)
{
    double sum = 0;
    for (size_t k = 0; k < 3; k++)
        sum += fabs((double)s->picture[4 * pixel + k] - (double)s->picture[k]) / 255;
    return sum / 3;
}

/* The object's own outline spills over its pixels by as much. */
static bool near_object(const shot *plain, int x, int y)
{
    enum { BESIDE = 3 };
    for (int dy = -BESIDE; dy <= BESIDE; dy++)
        for (int dx = -BESIDE; dx <= BESIDE; dx++) {
            int at_x = x + dx, at_y = y + dy;
            if (at_x >= 0 && at_y >= 0 && at_x < SIDE && at_y < SIDE && plain->id[at_y * SIDE + at_x])
                return true;
        }
    return false;
}

/* How far ink reaches behind the object along a direction: at each height across from its rear there to the last pixel
 * with ink that is seen, and of all heights the farthest. */
static double reach(const shot *still, const shot *plain, const double middle[2], const double way[2])
{
    enum { HEIGHTS = 2 * SIDE };
    const double seen = 0.08;
    double       rear[HEIGHTS], tail[HEIGHTS], farthest = 0;
    for (int i = 0; i < HEIGHTS; i++)
        rear[i] = tail[i] = INFINITY;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double right = x + 0.5 - middle[0], down = y + 0.5 - middle[1], along = right * way[0] + down * way[1];
            int    height = (int)fmin(fmax(right * -way[1] + down * way[0] + SIDE, 0), HEIGHTS - 1);
            if (plain->id[y * SIDE + x])
                rear[height] = fmin(rear[height], along);
            else if (!near_object(plain, x, y) && ink_at(still, (size_t)(y * SIDE + x)) > seen)
                tail[height] = fmin(tail[height], along);
        }
    for (int i = 0; i < HEIGHTS; i++)
        if (rear[i] < INFINITY && tail[i] < INFINITY)
            farthest = fmax(farthest, rear[i] - tail[i]);
    return farthest;
}

static reading read_still(const shot *still, const shot *plain, double angle)
{
    double middle[2] = {0, 0}, ink[2] = {0, 0}, all = 0, count = 0, same = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            size_t i = (size_t)(y * SIDE + x);
            double own = ink_at(still, i);
            if (plain->id[i]) {
                middle[0] += x + 0.5;
                middle[1] += y + 0.5;
                count++;
                same += abs(still->picture[4 * i] - plain->picture[4 * i]) <= 12;
            } else if (!near_object(plain, x, y)) {
                ink[0] += own * (x + 0.5);
                ink[1] += own * (y + 0.5);
                all += own;
            }
        }
    for (int k = 0; k < 2; k++) {
        middle[k] /= count;
        ink[k] /= fmax(all, 1e-9);
    }
    double x = middle[0] - ink[0], y = middle[1] - ink[1], length = fmax(hypot(x, y), 1e-9),
           way[2] = {x / length, y / length};
    return (reading){fabs(remainder(atan2(-y, x) - angle, 2 * pi)) * 180 / pi,
                     fabs(reach(still, plain, middle, way) / (WAY * UNIT) - 1), same / count};
}

static void readers_can_tell(void)
{
    const double angles[] = {0, 35, 130, 250};
    reading      worst[sizeof styles / sizeof *styles] = {{0, 0, 0}};
    for (size_t s = 0; s < sizeof styles / sizeof *styles; s++)
        worst[s].whole = 1;
    for (int i = 0; i < 8; i++) {
        double      angle = angles[i / 2] * pi / 180;
        const char *path = write_mover(i % 2, angle);
        shot        plain, still;
        if (!draw(&plain, path, NULL))
            return;
        for (size_t s = 0; s < sizeof styles / sizeof *styles; s++) {
            if (!draw(&still, path, styles[s].motion))
                return;
            reading one = read_still(&still, &plain, angle);
            worst[s] = (reading){fmax(worst[s].direction, one.direction), fmax(worst[s].way, one.way),
                                 fmin(worst[s].whole, one.whole)};
            shot_release(&still);
        }
        shot_release(&plain);
    }
    for (size_t s = 0; s < sizeof styles / sizeof *styles; s++) {
        check_note("%-12s direction off by %5.1f degrees, way by %5.1f %%, %5.1f %% of the object as it is",
                   styles[s].name, worst[s].direction, 100 * worst[s].way, 100 * worst[s].whole);
        if (!styles[s].ours)
            continue;
        check_at_most("77n", worst[s].direction, 10, "%s: direction is read, degrees off", styles[s].name);
        check_at_most("77n", worst[s].way, 0.15, "%s: the way is read, fraction off", styles[s].name);
        check_at_least("77n", worst[s].whole, 0.95, "%s: share of the object that is as it is", styles[s].name);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"readers", readers_can_tell}};
    int                     status = check_main(argc, argv, "rubric", cases, 1);
    shot_end();
    return status;
}
