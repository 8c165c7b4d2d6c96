/* Tonal art maps: nested to the pixel, of the tones that were asked for, evenly filled; and textures kept on disk.
 * Rows P17 to P20, P32, P39 of the notes on the pencil city, and Praun's maps in those on seed 003. */
#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/store.h"
#include "halftone/tonal_art_map.h"
#include "small_input.h"

enum { SIDE = 256, TONES = 6 };

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static tam_options usual(tam_placement placement)
{
    return (tam_options){.side = SIDE,
                         .tones = TONES,
                         .darkest = 0.9,
                         .width = 1.5,
                         .length = 0.4,
                         .opacity = 1,
                         .uneven = 0.5f,
                         .placement = placement,
                         .seed = 1};
}

static double mean_ink(const mip_chain *m, int level, int tone)
{
    const uint8_t *t = mip_layer(m, level, tone);
    size_t         count = mip_level_bytes(m, level) / (size_t)m->layers;
    double         sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += 255 - t[i];
    return sum / 255 / (double)count;
}

/* --- tones ---------------------------------------------------------------------------------------------- */

/* A level is as near to its tone as half of the smallest mark allows; `mark` is that mark's ink in texels on a
 * level, at least. */
static void check_tones(const mip_chain *m, const tam_options *w, double mark, const char *what)
{
    printf("    %s: largest error of tone by level:", what);
    for (int k = 0; k < m->levels; k++) {
        double worst = 0, texels = (double)mip_width(m, k) * mip_width(m, k);
        for (int tone = 0; tone < w->tones; tone++) {
            worst = fmax(worst, fabs(mean_ink(m, k, tone) - w->darkest * (tone + 1) / w->tones));
            if (tone > 0)
                assert_true(mean_ink(m, k, tone) > mean_ink(m, k, tone - 1));
        }
        printf(" %.4f", worst);
        assert_true(worst <= fmax(0.01, texels < 8 * 8 ? 0 : 0.65 * mark / texels));
    }
    printf("\n");
}

/* Ink of a texel never gets less towards darker tones. */
static void check_nested(const mip_chain *m)
{
    for (int k = 0; k < m->levels; k++)
        for (int tone = 1; tone < m->layers; tone++) {
            const uint8_t *lighter = mip_layer(m, k, tone - 1), *darker = mip_layer(m, k, tone);
            for (size_t i = 0; i < mip_level_bytes(m, k) / (size_t)m->layers; i++)
                assert_true(darker[i] <= lighter[i]);
        }
}

typedef struct picture {
    float *ink;
    float  limit, opacity;
} picture;

static void darken(void *user, size_t index, float coverage)
{
    picture *p = user;
    p->ink[index] += (p->limit - p->ink[index]) * coverage * p->opacity;
}

/* Each picture is the strokes of its tone and level and no others: so those of a lighter tone and of a coarser
 * level are in it, at the same position, as wide. */
static void check_strokes(const mip_chain *m, const strokes *kept, const tam_options *w)
{
    static float ink[SIDE * SIDE];
    stroke_brush brush = tonal_art_map_brush(w);
    for (int k = 0; SIDE >> k >= 8; k++)
        for (int tone = 0; tone < w->tones; tone++) {
            int     side = SIDE >> k, worst = 0;
            picture p = {ink, w->opacity < 1 ? (float)(0.5 + 0.5 * w->darkest) : 1, (float)w->opacity};
            memset(ink, 0, sizeof ink);
            for (size_t i = 0; i < kept->count; i++) {
                const texture_stroke *s = &kept->items[i];
                if (s->light > 1 - ((float)tone + 0.5f) / (float)w->tones && (double)s->perspective >= 1 - exp2(-k))
                    stroke_draw(s, side, &brush, darken, &p);
            }
            const uint8_t *t = mip_layer(m, k, tone);
            for (int i = 0; i < side * side; i++) {
                int off = abs(t[i] - (int)(255.5f - 255 * ink[i]));
                worst = off > worst ? off : worst;
            }
            assert_true(worst <= 1);
        }
}

static void maps_are_nested_and_of_their_tones(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        tam_options w = usual(i % 2 ? TAM_STRIPS : TAM_BEST_FIT);
        w.cross = i == 2 || i == 3;
        w.opacity = i >= 2 ? 0.3 : 1;
        w.darkest = i < 6 ? 0.9 : 0.8; /* without crossing strokes the last gaps are hard to find */
        mip_chain m;
        strokes   kept;
        assert_int_equal(tonal_art_map(&m, &kept, &w, NULL), LMN_OK);
        check_tones(&m, &w, 2, i % 2 ? "strips" : "best fit");
        check_nested(&m);
        check_strokes(&m, &kept, &w);
        mip_chain_release(&m);
        strokes_release(&kept);
    }
}

static void a_map_is_fast(void **state)
{
    (void)state;
    for (int side = 256; side <= 512; side *= 2) {
        tam_options w = usual(TAM_BEST_FIT);
        w.side = side;
        w.cross = true;
        mip_chain m;
        double    start = seconds();
        assert_int_equal(tonal_art_map(&m, NULL, &w, NULL), LMN_OK);
        double took = seconds() - start;
        printf("    6 tones, %d texels a side: %.3f s\n", side, took);
        mip_chain_release(&m);
    }
}

/* --- strokes -------------------------------------------------------------------------------------------- */

/* P19: in the lightest tone strokes lie apart, and across the middle of each there is its width in ink, on all
 * levels. */
static void strokes_are_as_wide_on_all_levels(void **state)
{
    (void)state;
    tam_options w = usual(TAM_BEST_FIT);
    mip_chain   m;
    strokes     kept;
    assert_int_equal(tonal_art_map(&m, &kept, &w, NULL), LMN_OK);
    printf("    width by level:");
    for (int k = 0; k < 4; k++) {
        int            side = SIDE >> k, count = 0;
        const uint8_t *t = mip_layer(&m, k, 0);
        double         sum = 0;
        for (size_t i = 0; i < kept.count; i++) {
            const texture_stroke *s = &kept.items[i];
            double                length = stroke_length(s);
            assert_true(length < 0.4001 && length > 0.3 * 0.4 - 1e-4);
            if (s->light < 1 || (double)s->perspective < 1 - exp2(-k))
                continue;
            int x = (int)(0.5f * (s->u0 + s->u1) * (float)side) % side,
                y = (int)floorf(0.5f * (s->v0 + s->v1) * (float)side);
            for (int row = y - 2; row <= y + 2; row++)
                sum += (255 - t[(row + side) % side * side + x]) / 255.0;
            count++;
        }
        printf(" %.2f", sum / count);
        assert_true(fabs(sum / count - 1.5) < 0.25);
    }
    printf("\n");
    mip_chain_release(&m);
    strokes_release(&kept);
}

/* P16: ends have their length in texels, whatever the length of the stroke: ink across a stroke at some texels from
 * its end is what it is in all others. */
static void ends_are_as_long_at_any_length(void **state)
{
    (void)state;
    enum { POSITIONS = 24 };
    static float ink[SIDE * SIDE];
    tam_options  w = usual(TAM_BEST_FIT);
    w.width = 4;
    stroke_brush brush = tonal_art_map_brush(&w);
    double       first[POSITIONS];
    for (int length = 100; length <= 240; length += 20) {
        picture        p = {ink, 1, 1};
        texture_stroke s = {8.0f / SIDE, 100.5f / SIDE, (float)(8 + length) / SIDE, 100.5f / SIDE, 1, 1, 0};
        memset(ink, 0, sizeof ink);
        stroke_draw(&s, SIDE, &brush, darken, &p);
        for (int i = 0; i < POSITIONS; i++) {
            double head = 0, tail = 0;
            for (int y = 90; y < 112; y++) {
                head += (double)ink[y * SIDE + 8 + i];
                tail += (double)ink[y * SIDE + (8 + length - 1 - i) % SIDE];
            }
            first[i] = length == 100 ? head : first[i];
            assert_true(fabs(head - first[i]) < 0.02 && fabs(tail - first[i]) < 0.02);
        }
    }
    /* They run out, and then there is the stroke's whole width. */
    int cap = 0;
    while (cap < POSITIONS - 1 && first[cap] < 0.97 * w.width)
        cap++;
    printf("    ends of strokes of %.0f texels' width: %.2f texels wide at first, whole after %d\n", w.width, first[0],
           cap);
    assert_true(first[0] < 0.3 * w.width && cap >= 10 && cap < POSITIONS - 1);
}

/* The same in maps: of strokes that lie apart, short and long ones begin alike, on all levels that have room for
 * it. */
static void ends_in_maps_are_alike(void **state)
{
    (void)state;
    tam_options w = usual(TAM_BEST_FIT);
    w.side = 1024;
    w.darkest = 0.05;
    w.tones = 2;
    w.uneven = 0;
    mip_chain m;
    strokes   kept;
    assert_int_equal(tonal_art_map(&m, &kept, &w, NULL), LMN_OK);
    for (int k = 0; k < 2; k++) {
        double sums[2][3] = {{0}};
        int    counts[2] = {0}, side = w.side >> k;
        for (size_t i = 0; i < kept.count; i++) {
            const texture_stroke *s = &kept.items[i];
            if (s->light < 1 || (double)s->perspective < 1 - exp2(-k))
                continue;
            bool long_one = stroke_length(s) > 0.65 * w.length;
            int  y = (int)(s->v0 * (float)side);
            counts[long_one]++;
            for (int position = 0; position < 3; position++)
                for (int row = y - 1; row <= y + 1; row++)
                    sums[long_one][position] +=
                        (255 -
                         ((const uint8_t *)mip_layer(
                             &m, k,
                             0))[(row + side) % side * side + ((int)(s->u0 * (float)side) + 1 + 4 * position) % side]) /
                        255.0;
        }
        printf("    level %d: ink across ends", k);
        for (int position = 0; position < 3; position++) {
            double short_ink = sums[0][position] / counts[0], long_ink = sums[1][position] / counts[1];
            printf(" %.2f %.2f,", short_ink, long_ink);
            assert_true(fabs(short_ink - long_ink) < 0.12);
        }
        printf(" of %d short and %d long strokes\n", counts[0], counts[1]);
        assert_true(counts[0] > 10 && counts[1] > 10 && sums[1][0] / counts[1] < 0.6 * sums[1][2] / counts[1]);
    }
    mip_chain_release(&m);
    strokes_release(&kept);
}

/* P17: lengths are 30 to 100 % of the longest. */
static void lengths_are_what_they_may_be(void **state)
{
    (void)state;
    for (int placement = 0; placement < TAM_PLACEMENT_COUNT; placement++) {
        tam_options w = usual((tam_placement)placement);
        mip_chain   m;
        strokes     kept;
        double      sum = 0, least = 1, most = 0;
        int         quarters[4] = {0}, fine = 0;
        assert_int_equal(tonal_art_map(&m, &kept, &w, NULL), LMN_OK);
        for (size_t i = 0; i < kept.count; i++) {
            double fraction = stroke_length(&kept.items[i]) / w.length;
            least = fmin(least, fraction);
            most = fmax(most, fraction);
            sum += fraction;
            if (kept.items[i].perspective <
                0.3f) { /* of the finest level alone, where no stroke is too short to be one */
                quarters[(int)fmin((fraction - 0.3) / 0.7 * 4, 3)]++;
                fine++;
            }
        }
        printf("    %s: lengths from %.2f to %.2f, %.2f on the mean; quarters of the range on the finest level: %d %d "
               "%d %d\n",
               tam_placement_names[placement], least, most, sum / (double)kept.count, quarters[0], quarters[1],
               quarters[2], quarters[3]);
        assert_true(least > 0.2999 && most < 1.0001 && least < 0.33 && most > 0.97);
        for (int q = 0; q < 4; q++)
            assert_true(quarters[q] > fine / 6);
        mip_chain_release(&m);
        strokes_release(&kept);
    }
}

/* --- grain ---------------------------------------------------------------------------------------------- */

/* P29: ink varies along and across a stroke; maps keep their tones and stay nested; without it nothing is
 * different. */
static void strokes_have_grain(void **state)
{
    (void)state;
    static float ink[SIDE * SIDE];
    tam_options  w = usual(TAM_BEST_FIT);
    w.width = 4;
    double before = 0;
    for (int i = 0; i <= 4; i++) {
        w.grain = i / 4.0;
        stroke_brush brush = tonal_art_map_brush(&w);
        double       sum = 0, squares = 0, half[2] = {0};
        for (int n = 0; n < 40; n++) {
            picture        p = {ink, 1, 1};
            texture_stroke s = {0.1f, (float)(20 + n) / 128, 0.9f, (float)(20 + n) / 128, 1, 1, 0};
            memset(ink, 0, sizeof ink);
            stroke_draw(&s, SIDE, &brush, darken, &p);
            for (int y = 40 + 2 * n - 1; y < 40 + 2 * n + 1; y++)
                for (int x = 60; x < 190; x++) {
                    double now = (double)ink[y * SIDE + x];
                    sum += now;
                    squares += now * now;
                    half[x > 124] += now;
                }
        }
        double mean = sum / (40 * 2 * 130), deviation = sqrt(fmax(squares / (40 * 2 * 130) - mean * mean, 0));
        printf("    grain %.2f: ink inside strokes %.2f, deviation %.3f, second half %.2f of the first\n", w.grain,
               mean, deviation, half[1] / half[0]);
        assert_true(i == 0 ? mean > 0.9999 && deviation < 1e-4 : deviation > before + 0.03 && half[1] < 0.99 * half[0]);
        before = deviation;
    }
    for (int i = 0; i < 4; i++) {
        w = usual(i % 2 ? TAM_STRIPS : TAM_BEST_FIT);
        w.grain = 0.9;
        w.darkest = 0.8;
        w.opacity = i >= 2 ? 0.4 : 1;
        mip_chain m;
        strokes   kept;
        assert_int_equal(tonal_art_map(&m, &kept, &w, NULL), LMN_OK);
        check_tones(&m, &w, 2, "with grain");
        check_nested(&m);
        check_strokes(&m, &kept, &w);
        mip_chain_release(&m);
        strokes_release(&kept);
    }
}

static double block_variance(const float *ink)
{
    double sum = 0, squares = 0;
    for (int block = 0; block < 64; block++) {
        double ofblock = 0;
        for (int i = 0; i < 32 * 32; i++)
            ofblock += (double)ink[(block / 8 * 32 + i / 32) * SIDE + block % 8 * 32 + i % 32] / (32 * 32);
        sum += ofblock / 64;
        squares += ofblock * ofblock / 64;
    }
    return squares - sum * sum;
}

/* P17: the means of blocks vary less than with the same strokes thrown anywhere. */
static void strokes_are_evenly_spread(void **state)
{
    (void)state;
    static float ink[SIDE * SIDE];
    for (int placement = 0; placement < TAM_PLACEMENT_COUNT; placement++) {
        tam_options w = usual((tam_placement)placement);
        mip_chain   m;
        strokes     kept;
        assert_int_equal(tonal_art_map(&m, &kept, &w, NULL), LMN_OK);
        random_source r = random_start(5, 5);
        stroke_brush  brush = tonal_art_map_brush(&w);
        printf("    %s: variance of blocks, against strokes thrown anywhere:", tam_placement_names[placement]);
        for (int tone = 0; tone < 4; tone++) {
            picture p = {ink, 1, 1};
            for (int i = 0; i < SIDE * SIDE; i++)
                ink[i] = 1 - ((const uint8_t *)mip_layer(&m, 0, tone))[i] / 255.0f;
            double ours = block_variance(ink), thrown = 0;
            for (int again = 0; again < 4; again++) {
                memset(ink, 0, sizeof ink);
                for (size_t i = 0; i < kept.count; i++) {
                    texture_stroke s = kept.items[i];
                    float          du = s.u1 - s.u0, dv = s.v1 - s.v0;
                    if (s.light < 1 - ((float)tone + 0.5f) / TONES)
                        continue;
                    s.u0 = (float)random_unit(&r);
                    s.v0 = (float)random_unit(&r);
                    s.u1 = s.u0 + du;
                    s.v1 = s.v0 + dv;
                    stroke_draw(&s, SIDE, &brush, darken, &p);
                }
                thrown += block_variance(ink) / 4;
            }
            printf(" %.2f", ours / thrown);
            assert_true(ours < 0.5 * thrown);
        }
        printf("\n");
        mip_chain_release(&m);
        strokes_release(&kept);
    }
}

/* Where strokes that let through lie over each other, the last gaps are looked for along their middles, which are as
 * wide as strokes are: the darkest tone is even, mean of some seeds. */
static void the_last_gaps_are_filled(void **state)
{
    (void)state;
    static const float  opacities[] = {0.35f, 0.6f};
    static const double uneven[] = {0.0235, 0.0435};
    for (int k = 0; k < 2; k++) {
        double deviation = 0;
        for (uint32_t seed = 1; seed <= 3; seed++) {
            tam_options w = usual(TAM_STRIPS);
            mip_chain   m;
            w.opacity = opacities[k];
            w.seed = seed;
            assert_int_equal(tonal_art_map(&m, NULL, &w, NULL), LMN_OK);
            const uint8_t *t = mip_layer(&m, 0, TONES - 1);
            double         sum = 0, squares = 0;
            for (int i = 0; i < SIDE * SIDE; i++) {
                sum += t[i] / 255.0;
                squares += t[i] / 255.0 * t[i] / 255.0;
            }
            sum /= SIDE * SIDE;
            deviation += sqrt(squares / (SIDE * SIDE) - sum * sum) / 3;
            mip_chain_release(&m);
        }
        printf("    opacity %.2f: tones deviate by %.4f in the darkest\n", (double)opacities[k], deviation);
        assert_true(deviation < uneven[k]);
    }
}

/* How far the steps across a border of 2 x 2 copies are off those inside, in deviations of all lines of one copy.
 * `square`: large steps count more. */
static double seam_off(const uint8_t *t, int side, bool across, bool square)
{
    double sums = 0, squares = 0, seam = 0;
    for (int line = side / 2; line < side / 2 + side; line++) { /* the middle one of these is the seam */
        double sum = 0;
        for (int i = 0; i < 2 * side; i++) {
            int here = line % side, next = (line + 1) % side, along = i % side;
            int step = across ? t[along * side + here] - t[along * side + next]
                              : t[here * side + along] - t[next * side + along];
            sum += square ? step * step : abs(step);
        }
        seam = line == side - 1 ? sum : seam;
        sums += sum / side;
        squares += sum * sum / side;
    }
    return fabs(seam - sums) / sqrt(fmax(squares - sums * sums, 1));
}

/* P18: across the border the picture goes on as it does inside, on all levels that have lines to compare. */
static void borders_are_like_the_inside(void **state)
{
    (void)state;
    strokes         dots = {0};
    pattern_options p = {.pattern = PATTERN_STIPPLE, .count = 6000, .seed = 2};
    assert_int_equal(strokes_generate(&dots, &p, NULL), LMN_OK);
    for (int kind = 0; kind < 4; kind++) {
        tam_options w = usual(kind == 1 ? TAM_STRIPS : TAM_BEST_FIT);
        w.cross = kind < 2;
        w.grain = kind == 2 ? 0.8 : 0;
        w.drawn = kind == 3 ? &dots : NULL;
        w.darkest = 0.6;
        mip_chain m;
        assert_int_equal(tonal_art_map(&m, NULL, &w, NULL), LMN_OK);
        double worst = 0;
        for (int k = 0; k < 4; k++)
            for (int tone = 0; tone < TONES; tone++)
                for (int i = 0; i < 4; i++)
                    worst = fmax(worst, seam_off(mip_layer(&m, k, tone), SIDE >> k, i & 1, i & 2));
        printf("    %s: steps across seams are up to %.2f deviations off\n",
               kind == 0   ? "best fit"
               : kind == 1 ? "strips"
               : kind == 2 ? "with grain"
                           : "dots",
               worst);
        assert_true(worst < 3.5);
        mip_chain_release(&m);
    }
    strokes_release(&dots);
}

/* P20: across from the middle tone on. */
static void crosses_from_the_middle(void **state)
{
    (void)state;
    tam_options w = usual(TAM_BEST_FIT);
    w.cross = true;
    mip_chain m;
    strokes   kept;
    assert_int_equal(tonal_art_map(&m, &kept, &w, NULL), LMN_OK);
    double length[2] = {0, 0};
    for (size_t i = 0; i < kept.count; i++) {
        const texture_stroke *s = &kept.items[i];
        bool                  across = fabsf(s->v1 - s->v0) > fabsf(s->u1 - s->u0);
        assert_int_equal(across, s->layer);
        assert_true(!across || s->light <= 0.51f);
        length[across] += stroke_length(s);
    }
    assert_true(length[1] > 0.8 * length[0] && length[1] < 1.1 * length[0]);
    mip_chain_release(&m);
    strokes_release(&kept);
}

/* P32: strokes on top of each other darken less each time, and never past the most. */
static void overlaps_darken_less_and_less(void **state)
{
    (void)state;
    double last = 0, step = 1;
    for (int count = 1; count <= 12; count++) {
        strokes s = {.width = 1};
        for (int i = 0; i < count; i++)
            assert_true(strokes_add(&s, (texture_stroke){0.2f, 0.5f, 0.8f, 0.5f, 1, 1, 0}));
        tam_options w = {
            .side = 32, .tones = 2, .darkest = 0.8, .width = 4, .length = 0.5, .opacity = 0.3, .drawn = &s};
        mip_chain m;
        assert_int_equal(tonal_art_map(&m, NULL, &w, NULL), LMN_OK);
        double ink = 1 - ((const uint8_t *)mip_layer(&m, 0, 1))[16 * 32 + 16] / 255.0;
        assert_true(ink - last < step && ink > last && ink <= 0.9);
        assert_true(count > 1 || fabs(ink - 0.27) < 0.003);
        step = ink - last;
        last = ink;
        mip_chain_release(&m);
        strokes_release(&s);
    }
}

/* P39: other shapes, in the order of their priorities, and only as far away as they may. */
static void drawn_shapes_are_placed(void **state)
{
    (void)state;
    strokes         dots = {0};
    pattern_options p = {.pattern = PATTERN_STIPPLE, .count = 6000, .seed = 2};
    assert_int_equal(strokes_generate(&dots, &p, NULL), LMN_OK);
    tam_options w = usual(TAM_BEST_FIT);
    w.darkest = 0.6;
    w.width = 3;
    w.drawn = &dots;
    mip_chain m;
    strokes   kept;
    assert_int_equal(tonal_art_map(&m, &kept, &w, NULL), LMN_OK);
    check_tones(&m, &w, 7.33, "dots");
    check_nested(&m);
    check_strokes(&m, &kept, &w);
    mip_chain_release(&m);
    strokes_release(&kept);
    strokes_release(&dots);

    strokes house = {.width = 1};
    assert_true(strokes_add(&house, (texture_stroke){0, 0.1f, 0.99f, 0.1f, 1, 1, 0})); /* the eaves, seen from afar */
    assert_true(
        strokes_add(&house, (texture_stroke){0.3f, 0.5f, 0.7f, 0.5f, 0.9f, 0.2f, 1})); /* a window, only from near */
    w.drawn = &house;
    assert_int_equal(tonal_art_map(&m, NULL, &w, NULL), LMN_OK);
    for (int k = 0; k < 4; k++) {
        int            side = SIDE >> k;
        const uint8_t *t = mip_layer(&m, k, TONES - 1);
        assert_true(t[side / 10 * side + side / 2] < 200);
        assert_true(k == 0 ? t[side / 2 * side + side / 2] < 200 : t[side / 2 * side + side / 2] == 255);
    }
    mip_chain_release(&m);
    strokes_release(&house);
}

/* --- options -------------------------------------------------------------------------------------------- */

static void the_same_options_give_the_same_map(void **state)
{
    (void)state;
    tam_options w = usual(TAM_BEST_FIT);
    w.side = 64;
    mip_chain a, b, c;
    assert_int_equal(tonal_art_map(&a, NULL, &w, NULL), LMN_OK);
    assert_int_equal(tonal_art_map(&b, NULL, &w, NULL), LMN_OK);
    w.seed = 2;
    assert_int_equal(tonal_art_map(&c, NULL, &w, NULL), LMN_OK);
    for (int k = 0; k < a.levels; k++)
        assert_memory_equal(a.data[k], b.data[k], mip_level_bytes(&a, k));
    assert_memory_not_equal(a.data[0], c.data[0], mip_level_bytes(&a, 0));
    mip_chain_release(&a);
    mip_chain_release(&b);
    mip_chain_release(&c);
}

static void wrong_options_are_refused(void **state)
{
    (void)state;
    tam_options wrong[11];
    for (int i = 0; i < 11; i++)
        wrong[i] = usual(TAM_BEST_FIT);
    wrong[0].side = 100;
    wrong[1].side = 2048;
    wrong[2].tones = 1;
    wrong[3].tones = 17;
    wrong[4].darkest = 0.99;
    wrong[5].width = (double)NAN;
    wrong[6].length = 1.5;
    wrong[7].opacity = 0;
    wrong[8].uneven = 2;
    wrong[9].placement = TAM_PLACEMENT_COUNT;
    wrong[10].grain = 1.1;
    for (int i = 0; i < 11; i++) {
        mip_chain m;
        lmn_error error;
        assert_int_equal(tonal_art_map(&m, NULL, &wrong[i], &error), LMN_USAGE);
        assert_null(m.data[0]);
    }
}

/* The most and the least of everything ends, and gives its tones. */
static void extremes_end(void **state)
{
    (void)state;
    for (int i = 0; i < 64; i += small_input() ? 7 : 1) { /* by sevens, each value of each option still comes up */
        tam_options w = {.side = i & 1 ? 128 : 16,
                         .tones = i & 2 ? 16 : 2,
                         .darkest = i & 4 ? 0.98 : 0.05,
                         .width = i & 8 ? 4 : 0.5,
                         .length = i & 16 ? 1 : 0.05,
                         .opacity = i & 32 ? 0.1 : 1,
                         .uneven = 1,
                         .cross = i % 3 == 0,
                         .placement = i % 5 == 0 ? TAM_STRIPS : TAM_BEST_FIT,
                         .seed = (uint32_t)i};
        mip_chain   m;
        double      start = seconds();
        assert_int_equal(tonal_art_map(&m, NULL, &w, NULL), LMN_OK);
        double off = mean_ink(&m, 0, w.tones - 1) - w.darkest;
        if (seconds() - start > 1)
            printf("    extreme %d took %.1f s\n", i, seconds() - start);
        /* Faint thin strokes would have to lie more than sixteen times over each texel. */
        if (i & 1 && fabs(off) > 0.01)
            printf("    extreme %d is off by %.3f\n", i, off);
        if (i & 1)
            assert_true(fabs(off) < ((i & 32) && !(i & 8) ? 0.05 : 0.01));
        mip_chain_release(&m);
    }
}

static void failing_memory_is_reported(void **state)
{
    (void)state;
    strokes drawn = {.width = 1};
    for (int i = 0; i < 5; i++)
        assert_true(strokes_add(&drawn, (texture_stroke){0.1f, 0.2f * (float)i, 0.9f, 0.2f * (float)i, 1, 1, 0}));
    for (int i = 0; i < 3; i++) {
        tam_options w = usual((tam_placement)(i % 2));
        w.side = 16;
        w.cross = true;
        w.drawn = i == 2 ? &drawn : NULL;
        lmn_status status = LMN_MEMORY;
        for (long n = 1; status != LMN_OK && n < 1000; n++) {
            mip_chain m;
            strokes   kept;
            mem_fail_at(n);
            status = tonal_art_map(&m, &kept, &w, NULL);
            mem_fail_at(0);
            assert_true(status == LMN_OK || status == LMN_MEMORY);
            if (status == LMN_MEMORY)
                assert_true(!m.data[0] && !kept.items);
            mip_chain_release(&m);
            strokes_release(&kept);
        }
        assert_int_equal(status, LMN_OK);
    }
    strokes_release(&drawn);
}

/* --- kept on disk --------------------------------------------------------------------------------------- */

static char folder[256];

static int make_folder(void **state)
{
    (void)state;
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/limner-store-XXXXXX", temporary ? temporary : "/tmp");
    if (!mkdtemp(folder))
        return -1;
    return setenv("LIMNER_CACHE", folder, 1);
}

/* Calls for each file; removes them when `path` is NULL, else finds the last one's path. Returns how many. */
static int visit_files(char *path, size_t capacity)
{
    int  count = 0;
    DIR *open = opendir(folder);
    for (struct dirent *entry; open && (entry = readdir(open)) != NULL;) {
        char one[600];
        if (entry->d_name[0] == '.')
            continue;
        snprintf(one, sizeof one, "%s/%s", folder, entry->d_name);
        count++;
        if (path)
            snprintf(path, capacity, "%s", one);
        else
            unlink(one);
    }
    if (open)
        closedir(open);
    return count;
}

static int remove_folder(void **state)
{
    (void)state;
    visit_files(NULL, 0);
    rmdir(folder);
    return unsetenv("LIMNER_CACHE");
}

static mip_chain sample(mip_format format, int side, int layers, int levels)
{
    mip_chain     m;
    random_source r = random_start(7, 7);
    assert_int_equal(mip_chain_create(&m, side, side / 2, layers, levels, format, NULL), LMN_OK);
    m.clamped = format == MIP_RG8;
    m.nearest = format == MIP_RG16F;
    for (int k = 0; k < m.levels; k++)
        for (size_t i = 0; i < mip_level_bytes(&m, k); i++)
            ((uint8_t *)m.data[k])[i] = (uint8_t)(random_bits(&r) & 63);
    return m;
}

static bool is_same(const mip_chain *a, const mip_chain *b)
{
    bool same = a->width == b->width && a->height == b->height && a->layers == b->layers && a->levels == b->levels &&
                a->format == b->format && a->clamped == b->clamped && a->nearest == b->nearest;
    for (int k = 0; same && k < a->levels; k++)
        same = memcmp(a->data[k], b->data[k], mip_level_bytes(a, k)) == 0;
    return same;
}

static void what_is_kept_is_found(void **state)
{
    (void)state;
    const char *names[] = {"one", "two 2", ""};
    for (int format = 0; format < 3; format++) {
        mip_chain m = sample((mip_format)format, 32, 3, format), found;
        assert_false(store_find(&found, names[format]));
        store_keep(&m, names[format]);
        store_keep(&m, names[format]); /* again is fine */
        assert_true(store_find(&found, names[format]));
        assert_true(is_same(&m, &found));
        mip_chain_release(&found);
        assert_false(store_find(&found, "three"));
        assert_null(found.data[0]);
        mip_chain_release(&m);
    }
    assert_int_equal(visit_files(NULL, 0), 3);
}

static void write_file(const char *path, const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fwrite(bytes, 1, size, file) == size);
    fclose(file);
}

static void damage_is_not_found(void **state)
{
    (void)state;
    mip_chain m = sample(MIP_R8, 8, 2, 0), found;
    store_keep(&m, "some description");
    char path[600], other[600];
    assert_int_equal(visit_files(path, sizeof path), 1);
    file_data file;
    assert_int_equal(file_load(&file, path, NULL), LMN_OK);
    unsigned char bytes[1024];
    size_t        size = file.size;
    assert_true(size < sizeof bytes - 1);
    memcpy(bytes, file.data, size);
    bytes[size] = 0;
    file_data_release(&file);
    for (size_t i = 0; i < size; i++)
        for (int bit = 0; bit < 9; bit++) {
            unsigned char was = bytes[i];
            bytes[i] = (unsigned char)(bit < 8 ? was ^ (1 << bit) : ~was);
            write_file(path, bytes, size);
            assert_false(store_find(&found, "some description"));
            bytes[i] = was;
        }
    for (size_t cut = 0; cut <= size + 1; cut++) {
        write_file(path, bytes, cut);
        assert_true(store_find(&found, "some description") == (cut == size));
        mip_chain_release(&found);
    }
    /* Another description of the same hash. */
    store_keep(&m, "like description");
    mip_chain_release(&m);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(visit_files(other, sizeof other), 1);
    write_file(other, bytes, size);
    assert_false(store_find(&found, "like description"));
    /* What is not a file. */
    assert_int_equal(unlink(other), 0);
    assert_int_equal(mkdir(other, 0700), 0);
    assert_false(store_find(&found, "like description"));
    assert_int_equal(rmdir(other), 0);
}

static void positions_are_found_or_done_without(void **state)
{
    (void)state;
    mip_chain m = sample(MIP_R8, 8, 1, 0), found;
    char      below[600];
    assert_int_equal(setenv("LIMNER_CACHE", "", 1), 0);
    store_keep(&m, "x");
    assert_false(store_find(&found, "x"));
    char *home = mem_copy_text(getenv("HOME")), *shared = mem_copy_text(getenv("XDG_CACHE_HOME"));
    unsetenv("LIMNER_CACHE");
    unsetenv("XDG_CACHE_HOME");
    unsetenv("HOME");
    store_keep(&m, "x");
    assert_false(store_find(&found, "x"));
    snprintf(below, sizeof below, "%s/file", folder);
    write_file(below, (const unsigned char *)"x", 1);
    setenv("HOME", below, 1); /* no folder can be made there */
    store_keep(&m, "x");
    assert_false(store_find(&found, "x"));
    unlink(below);
    setenv("XDG_CACHE_HOME", folder, 1);
    store_keep(&m, "x");
    assert_true(store_find(&found, "x"));
    mip_chain_release(&found);
    snprintf(below, sizeof below, "%s/limner", folder);
    setenv("LIMNER_CACHE", below, 1);
    assert_true(store_find(&found, "x"));
    mip_chain_release(&found);
    char kept_folder[256];
    memcpy(kept_folder, folder, sizeof folder);
    snprintf(folder, sizeof folder, "%.200s/limner", kept_folder);
    assert_int_equal(visit_files(NULL, 0), 1);
    rmdir(folder);
    memcpy(folder, kept_folder, sizeof folder);
    if (home)
        setenv("HOME", home, 1);
    else
        unsetenv("HOME");
    if (shared)
        setenv("XDG_CACHE_HOME", shared, 1);
    else
        unsetenv("XDG_CACHE_HOME");
    mem_free(home);
    mem_free(shared);
    setenv("LIMNER_CACHE", folder, 1);
    mip_chain_release(&m);
}

/* An entry is a regular file of this user: what anybody else has laid there is neither read nor written. */
static void entries_of_others_are_not_followed(void **state)
{
    (void)state;
    mip_chain   m = sample(MIP_R8, 8, 2, 0), found;
    char        path[600], moved[620];
    struct stat facts;
    store_keep(&m, "x");
    assert_int_equal(visit_files(path, sizeof path), 1);
    snprintf(moved, sizeof moved, "%s/moved", folder);
    assert_int_equal(rename(path, moved), 0);
    assert_int_equal(symlink(moved, path), 0);
    assert_false(store_find(&found, "x"));
    write_file(moved, (const unsigned char *)"mine", 4);
    store_keep(&m, "x"); /* in place of the link, not through it */
    assert_int_equal(lstat(path, &facts), 0);
    assert_true(S_ISREG(facts.st_mode));
    assert_int_equal(stat(moved, &facts), 0);
    assert_int_equal(facts.st_size, 4);
    assert_int_equal(unlink(moved), 0);
    assert_true(store_find(&found, "x"));
    mip_chain_release(&found);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_false(store_find(&found, "x")); /* does not wait for a writer */
    store_keep(&m, "x");
    assert_true(store_find(&found, "x"));
    mip_chain_release(&found);
    if (geteuid() == 0) {
        assert_int_equal(chown(path, 12345, 12345), 0);
        assert_false(store_find(&found, "x"));
    }
    mip_chain_release(&m);
    visit_files(NULL, 0);
}

/* Several processes keep the same and look for it: whatever is found is whole. */
static void writers_do_not_disturb_each_other(void **state)
{
    (void)state;
    enum { WRITERS = 4, TURNS = 40 };
    pid_t     writers[WRITERS];
    mip_chain m = sample(MIP_R8, 64, 4, 0), found;
    store_keep(&m, "x");
    for (int i = 0; i < WRITERS; i++) {
        writers[i] = fork();
        assert_true(writers[i] >= 0);
        for (int k = 0; writers[i] == 0 && k < TURNS; k++) {
            store_keep(&m, "x");
            if (!store_find(&found, "x") || !is_same(&m, &found))
                _exit(1);
            mip_chain_release(&found);
        }
        if (writers[i] == 0)
            _exit(0);
    }
    for (int i = 0; i < WRITERS; i++) {
        int status = 1;
        assert_int_equal(waitpid(writers[i], &status, 0), writers[i]);
        assert_int_equal(status, 0);
    }
    assert_int_equal(visit_files(NULL, 0), 1);
    mip_chain_release(&m);
}

/* Old files make room; others' never. The large ones are holes, which take no room on the disk. */
static void the_oldest_go_first(void **state)
{
    (void)state;
    const char *names[] = {"0000000000000001.texture", "0000000000000002.texture", "0000000000000003.texture.AbCdEf",
                           "notes.texture", "0000000000000004.txt"};
    char        paths[5][600];
    for (int i = 0; i < 5; i++) {
        snprintf(paths[i], sizeof paths[i], "%s/%s", folder, names[i]);
        write_file(paths[i], (const unsigned char *)"", 0);
        assert_int_equal(truncate(paths[i], 100 << 20), 0);
        struct timespec when[2] = {{1000 + 10 * (i ^ 1), 0},
                                   {1000 + 10 * (i ^ 1), 0}}; /* the second is older than the first */
        assert_int_equal(utimensat(AT_FDCWD, paths[i], when, 0), 0);
    }
    mip_chain m = sample(MIP_R8, 8, 1, 0), found;
    store_keep(&m, "x");
    assert_true(access(paths[1], F_OK) != 0);
    assert_true(access(paths[0], F_OK) == 0 && access(paths[2], F_OK) == 0 && access(paths[3], F_OK) == 0 &&
                access(paths[4], F_OK) == 0);
    assert_true(store_find(&found, "x"));
    mip_chain_release(&found);
    mip_chain_release(&m);
    visit_files(NULL, 0);
}

static void the_store_does_without_memory(void **state)
{
    (void)state;
    mip_chain m = sample(MIP_R8, 16, 2, 0), found;
    for (long n = 1; n < 40; n++) {
        mem_fail_at(n);
        store_keep(&m, "x");
        bool there = store_find(&found, "x");
        mem_fail_at(0);
        if (there)
            assert_true(is_same(&m, &found));
        mip_chain_release(&found);
    }
    assert_true(store_find(&found, "x"));
    mip_chain_release(&found);
    mip_chain_release(&m);
    visit_files(NULL, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_are_nested_and_of_their_tones),
        cmocka_unit_test(a_map_is_fast),
        cmocka_unit_test(strokes_are_as_wide_on_all_levels),
        cmocka_unit_test(ends_are_as_long_at_any_length),
        cmocka_unit_test(ends_in_maps_are_alike),
        cmocka_unit_test(lengths_are_what_they_may_be),
        cmocka_unit_test(strokes_have_grain),
        cmocka_unit_test(strokes_are_evenly_spread),
        cmocka_unit_test(the_last_gaps_are_filled),
        cmocka_unit_test(borders_are_like_the_inside),
        cmocka_unit_test(crosses_from_the_middle),
        cmocka_unit_test(overlaps_darken_less_and_less),
        cmocka_unit_test(drawn_shapes_are_placed),
        cmocka_unit_test(the_same_options_give_the_same_map),
        cmocka_unit_test(wrong_options_are_refused),
        cmocka_unit_test(extremes_end),
        cmocka_unit_test(failing_memory_is_reported),
        cmocka_unit_test_setup_teardown(what_is_kept_is_found, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(damage_is_not_found, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(positions_are_found_or_done_without, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(entries_of_others_are_not_followed, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(writers_do_not_disturb_each_other, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(the_oldest_go_first, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(the_store_does_without_memory, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
