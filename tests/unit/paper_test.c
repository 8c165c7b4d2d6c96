/* Papers: seamless, of flat heights, each with a tooth of its own, and what a pencil finds on their hills and
 * flanks. Row P28 of the notes on the pencil city. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "halftone/paper.h"

enum { SIDE = PAPER_SIDE, TEXELS = SIDE * SIDE };

static paper sheet_of(paper_kind kind, uint32_t seed)
{
    paper p;
    assert_int_equal(paper_create(&p, kind, seed, NULL), LMN_OK);
    return p;
}

static float height_at(const paper *p, int x, int y)
{
    return p->heights[(y & (SIDE - 1)) * SIDE + (x & (SIDE - 1))];
}

/* One of each kind, which most tests look at. */
static int make_papers(void **state)
{
    paper *papers = calloc(PAPER_COUNT, sizeof *papers);
    for (int kind = PAPER_SMOOTH; papers && kind < PAPER_COUNT; kind++)
        if (paper_create(&papers[kind], (paper_kind)kind, 0, NULL) != LMN_OK)
            return 1;
    *state = papers;
    return !papers;
}

static int release_papers(void **state)
{
    paper *papers = *state;
    for (int kind = PAPER_SMOOTH; kind < PAPER_COUNT; kind++)
        paper_release(&papers[kind]);
    free(papers);
    return 0;
}

/* Mean product of heights this far apart, 1 at no distance. */
static double likeness(const paper *p, int across, int up)
{
    double sum = 0, all = 0;
    for (int i = 0; i < TEXELS; i += 3) {
        double here = (double)p->heights[i] - 0.5, there = (double)height_at(p, i % SIDE + across, i / SIDE + up) - 0.5;
        sum += here * there;
        all += here * here;
    }
    return sum / all;
}

/* --- heights -------------------------------------------------------------------------------------------- */

static void check_flat(const int *counts, int bins)
{
    for (int i = 0; i < bins; i++)
        assert_true(abs(counts[i] - TEXELS / bins) < TEXELS / bins / 50);
}

static void each_tenth_covers_a_tenth(void **state)
{
    for (int kind = PAPER_SMOOTH; kind < PAPER_COUNT; kind++) {
        const paper *p = &((const paper *)*state)[kind];
        mip_chain    m;
        int          heights[10] = {0}, contacts[16] = {0};
        double       level = 0;
        assert_int_equal(paper_texture(&m, p, NULL), LMN_OK);
        for (int i = 0; i < TEXELS; i++) {
            assert_true(p->heights[i] >= 0 && p->heights[i] <= 1);
            heights[(int)fminf(p->heights[i] * 10, 9)]++;
            contacts[((const uint8_t *)m.data[0])[2 * i] / 16]++;
            level += ((const uint8_t *)m.data[0])[2 * i + 1];
        }
        check_flat(heights, 10);
        check_flat(contacts, 16);
        assert_true(fabs(level / TEXELS - 127.5) < 1.5);
        assert_true(m.fact > 0 && m.fact <= 1);
        mip_chain_release(&m);
    }
}

/* Across the border heights change as much as they do inside. */
static void borders_are_like_the_inside(void **state)
{
    (void)state;
    for (int kind = PAPER_SMOOTH; kind < PAPER_COUNT; kind++) {
        paper p = sheet_of((paper_kind)kind, 3);
        for (int across = 0; across < 2; across++) {
            double sums = 0, squares = 0, seam = 0;
            for (int line = 0; line < SIDE; line++) {
                double sum = 0;
                for (int i = 0; i < SIDE; i++)
                    sum += fabs((double)(across ? height_at(&p, line, i) - height_at(&p, line + 1, i)
                                                : height_at(&p, i, line) - height_at(&p, i, line + 1)));
                seam = sum; /* the last one */
                sums += sum / SIDE;
                squares += sum * sum / SIDE;
            }
            double off = (seam - sums) / sqrt(squares - sums * sums);
            printf("    %s, %s: the seam's steps are %.2f deviations off\n", paper_names[kind],
                   across ? "across" : "up", off);
            assert_true(fabs(off) < 3.5);
        }
        paper_release(&p);
    }
}

/* Texels apart at which heights have lost half of their likeness. */
static double tooth_of(const paper *p, bool up)
{
    double before = 1;
    for (int k = 1; k < 100; k++) {
        double now = likeness(p, up ? 0 : k, up ? k : 0);
        if (now < 0.5)
            return k - (0.5 - now) / (before - now);
        before = now;
    }
    return 100;
}

/* The most that heights far apart are alike along an axis, and at which distance. */
static double repeats(const paper *p, bool up, int *at)
{
    double most = 0;
    for (int k = 12; k < 100; k++) {
        double now = likeness(p, up ? 0 : k, up ? k : 0);
        *at = now > most ? k : *at;
        most = fmax(most, now);
    }
    return most;
}

/* How far a distance is from a whole number of periods, of which the sheet has so many. */
static double whole_periods(int distance, int count)
{
    return fabs(fmod((double)distance * count / SIDE + 0.5, 1) - 0.5);
}

static void papers_differ(void **state)
{
    double tooth[PAPER_COUNT][2], regular[PAPER_COUNT][2];
    int    period[PAPER_COUNT][2] = {{0}};
    for (int kind = PAPER_SMOOTH; kind < PAPER_COUNT; kind++) {
        const paper *p = &((const paper *)*state)[kind];
        for (int up = 0; up < 2; up++) {
            tooth[kind][up] = tooth_of(p, up);
            regular[kind][up] = repeats(p, up, &period[kind][up]);
        }
        printf("    %s: tooth %.1f and %.1f texels; alike by %.2f after %d across, %.2f after %d up\n",
               paper_names[kind], tooth[kind][0], tooth[kind][1], regular[kind][0], period[kind][0], regular[kind][1],
               period[kind][1]);
    }
    /* Felted papers have no direction and nothing that comes back, and differ by the size of their tooth. */
    for (int kind = PAPER_SMOOTH; kind <= PAPER_ROUGH; kind++) {
        assert_true(fabs(tooth[kind][0] / tooth[kind][1] - 1) < 0.1);
        assert_true(regular[kind][0] < 0.12 && regular[kind][1] < 0.12);
    }
    assert_true(tooth[PAPER_DRAWING][0] > 1.1 * tooth[PAPER_SMOOTH][0]);
    assert_true(tooth[PAPER_ROUGH][0] > 1.4 * tooth[PAPER_DRAWING][0]);
    /* 96 ribs run across; 64 threads do both ways, every second of which is alike. */
    assert_true(regular[PAPER_LAID][1] > 0.2 && whole_periods(period[PAPER_LAID][1], 96) < 0.1 &&
                tooth[PAPER_LAID][0] > 1.5 * tooth[PAPER_LAID][1]);
    for (int up = 0; up < 2; up++)
        assert_true(regular[PAPER_CANVAS][up] > 0.2 && whole_periods(period[PAPER_CANVAS][up], 64) < 0.1);
}

/* Blocks much larger than a grain are all alike, or the eye finds them again in the next sheet. */
static void there_are_no_clouds(void **state)
{
    enum { BLOCK = 64 };
    for (int kind = PAPER_SMOOTH; kind < PAPER_COUNT; kind++) {
        const paper *p = &((const paper *)*state)[kind];
        double       squares = 0;
        for (int block = 0; block < TEXELS / BLOCK / BLOCK; block++) {
            double mean = 0;
            for (int i = 0; i < BLOCK * BLOCK; i++)
                mean +=
                    (double)height_at(p, block * BLOCK % SIDE + i % BLOCK, block * BLOCK / SIDE * BLOCK + i / BLOCK) /
                    (BLOCK * BLOCK);
            squares += (mean - 0.5) * (mean - 0.5) / (TEXELS / BLOCK / BLOCK);
        }
        printf("    %s: means of blocks of %d texels differ by %.4f\n", paper_names[kind], BLOCK, sqrt(squares));
        assert_true(sqrt(squares) < 0.012);
    }
}

/* Sheets are looked up texel by texel, so that nothing may flicker from one to the next. */
static void nothing_is_finer_than_a_texel(void **state)
{
    for (int kind = PAPER_SMOOTH; kind < PAPER_COUNT; kind++) {
        const paper *p = &((const paper *)*state)[kind];
        printf("    %s: neighbours are alike by %.2f and %.2f\n", paper_names[kind], likeness(p, 1, 0),
               likeness(p, 0, 1));
        assert_true(likeness(p, 1, 0) > 0.75 && likeness(p, 0, 1) > 0.75);
    }
}

static void the_same_seed_gives_the_same_sheet(void **state)
{
    (void)state;
    paper a = sheet_of(PAPER_DRAWING, 1), b = sheet_of(PAPER_DRAWING, 1), c = sheet_of(PAPER_DRAWING, 2);
    assert_memory_equal(a.heights, b.heights, TEXELS * sizeof(float));
    double sum = 0;
    for (int i = 0; i < TEXELS; i++)
        sum += ((double)a.heights[i] - 0.5) * ((double)c.heights[i] - 0.5) * 12 / TEXELS;
    assert_true(fabs(sum) < 0.02);
    paper_release(&a);
    paper_release(&b);
    paper_release(&c);
}

/* --- what a pencil finds -------------------------------------------------------------------------------- */

static void normals_lean_away_from_hills(void **state)
{
    for (int kind = PAPER_SMOOTH; kind < PAPER_COUNT; kind++) {
        const paper *p = &((const paper *)*state)[kind];
        double       steepest = 0;
        for (int i = 0; i < TEXELS; i += 7) {
            float n[3], across = height_at(p, i % SIDE + 1, i / SIDE) - height_at(p, i % SIDE - 1, i / SIDE),
                        up = height_at(p, i % SIDE, i / SIDE + 1) - height_at(p, i % SIDE, i / SIDE - 1);
            paper_normal(p, i % SIDE, i / SIDE, n);
            assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-5f && n[2] > 0);
            assert_true(fabsf(n[0] * up - n[1] * across) < 1e-5f && n[0] * across + n[1] * up <= 0);
            steepest = fmax(steepest, acos((double)n[2]) * 57.29578);
        }
        printf("    %s: flanks of up to %.0f degrees\n", paper_names[kind], steepest);
        assert_true(steepest > 15 && steepest < 80);
    }
}

/* Of positions alike in height, those that face the stroke are touched first; of positions that lean alike, the higher
 * ones. */
static void contact_is_of_height_and_of_flanks(void **state)
{
    for (int kind = PAPER_SMOOTH; kind < PAPER_COUNT; kind++) {
        const paper *p = &((const paper *)*state)[kind];
        mip_chain    m;
        double       sums[10][2] = {{0}};
        int          counts[10][2] = {{0}};
        assert_int_equal(paper_texture(&m, p, NULL), LMN_OK);
        for (int i = 0; i < TEXELS; i++) {
            float n[3];
            paper_normal(p, i % SIDE, i / SIDE, n);
            float facing = (n[1] - n[0]) * 0.7071f;
            int   tenth = (int)fminf(p->heights[i] * 10, 9);
            if (fabsf(facing) > 0.15f) {
                sums[tenth][facing > 0] += ((const uint8_t *)m.data[0])[2 * i] / 255.0;
                counts[tenth][facing > 0]++;
            }
        }
        for (int tenth = 0; tenth < 10; tenth++)
            for (int faces = 0; faces < 2; faces++) {
                double mean = sums[tenth][faces] / counts[tenth][faces];
                assert_true(counts[tenth][faces] > 100);
                assert_true(!faces || mean > sums[tenth][0] / counts[tenth][0] + 0.08);
                assert_true(!tenth || mean > sums[tenth - 1][faces] / counts[tenth - 1][faces]);
            }
        mip_chain_release(&m);
    }
}

static void failing_memory_is_reported(void **state)
{
    (void)state;
    lmn_status status = LMN_MEMORY;
    for (long n = 1; status != LMN_OK && n < 100; n++) {
        paper     p;
        mip_chain m = {0};
        mem_fail_at(n);
        status = paper_create(&p, PAPER_LAID, 0, NULL);
        if (status == LMN_OK)
            status = paper_texture(&m, &p, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || (status == LMN_MEMORY && !m.data[0]));
        mip_chain_release(&m);
        paper_release(&p);
    }
    assert_int_equal(status, LMN_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_tenth_covers_a_tenth),
        cmocka_unit_test(borders_are_like_the_inside),
        cmocka_unit_test(papers_differ),
        cmocka_unit_test(nothing_is_finer_than_a_texel),
        cmocka_unit_test(the_same_seed_gives_the_same_sheet),
        cmocka_unit_test(normals_lean_away_from_hills),
        cmocka_unit_test(there_are_no_clouds),
        cmocka_unit_test(contact_is_of_height_and_of_flanks),
        cmocka_unit_test(failing_memory_is_reported),
    };
    return cmocka_run_group_tests(tests, make_papers, release_papers);
}
