/* Indications: pictures whose light places keep strokes away, and what screens of a material are called. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/memory.h"
#include "export/export.h"
#include "surface/indication.h"
#include "surface/screen_textures.h"

static uint8_t texel(const mip_chain *chain, int level, int x, int y)
{
    return ((const uint8_t *)chain->data[level])[y * mip_width(chain, level) + x];
}

/* Each texel is the mean of those four, or fewer at a border, that it stands for. */
static void check_means(const mip_chain *chain)
{
    for (int level = 1; level < chain->levels; level++) {
        int width = mip_width(chain, level - 1), height = mip_height(chain, level - 1);
        for (int y = 0; y < mip_height(chain, level); y++)
            for (int x = 0; x < mip_width(chain, level); x++) {
                int sum = 0, count = 0;
                for (int k = 0; k < 4; k++)
                    if (2 * x + k % 2 < width && 2 * y + k / 2 < height) {
                        sum += texel(chain, level - 1, 2 * x + k % 2, 2 * y + k / 2);
                        count++;
                    }
                assert_true(count > 0);
                assert_true(fabs(texel(chain, level, x, y) - (double)sum / count) <= 0.5);
            }
    }
}

/* Fields of 16 texels, light and dark in turn, like a chessboard's, so that from afar all is grey. */
static void test_checker(void **state)
{
    (void)state;
    mip_chain chain;
    assert_int_equal(indication_make(&chain, "checker", NULL), LMN_OK);
    assert_int_equal(mip_width(&chain, 0), 256);
    assert_int_equal(mip_height(&chain, 0), 256);
    for (int y = 0; y < 256; y++)
        for (int x = 0; x < 256; x++)
            assert_int_equal(texel(&chain, 0, x, y), (x / 16 + y / 16) % 2 ? 192 : 64);
    check_means(&chain);
    assert_int_equal(texel(&chain, chain.levels - 1, 0, 0), 128);
    mip_chain_release(&chain);
}

/* A grey picture of 5 by 3 pixels, rows from the top: what lies in the file's first row has v = 0. */
static void test_picture(void **state)
{
    (void)state;
    char    path[] = "indication-XXXXXX.png";
    uint8_t rgba[15][4];
    int     file = mkstemps(path, 4);
    assert_true(file >= 0);
    for (int i = 0; i < 15; i++)
        for (int k = 0; k < 4; k++)
            rgba[i][k] = (uint8_t)(k < 3 ? 10 + 16 * i : 255);
    export_bytes bytes = {0};
    assert_int_equal(export_png(&bytes, rgba[0], 5, 3, NULL), LMN_OK);
    assert_int_equal(write(file, bytes.data, bytes.size), bytes.size);
    close(file);
    mem_free(bytes.data);
    mip_chain  chain;
    lmn_status status = indication_make(&chain, path, NULL);
    unlink(path);
    if (status == LMN_OK) {
        for (int i = 0; i < 15; i++)
            assert_int_equal(texel(&chain, 0, i % 5, i / 5), 10 + 16 * i);
        check_means(&chain);
        mip_chain_release(&chain);
    }
    assert_int_equal(status, LMN_OK);
}

/* A screen called `material` is the material's strokes, whatever that name's length, and none without them; any other
 * stays. */
static void test_material(void **state)
{
    (void)state;
    static screen_values     v;
    static const char *const names[] = {"dots", "weave of the longer kind"};
    for (int k = 0; k < 2; k++) {
        memset(&v, 'x', sizeof v);
        snprintf(v.screen.text, sizeof v.screen.text, "material");
        assert_true(screen_by_material(&v, names[k]));
        assert_string_equal(v.screen.text, names[k]);
    }
    snprintf(v.screen.text, sizeof v.screen.text, "material");
    assert_true(screen_by_material(&v, NULL));
    assert_string_equal(v.screen.text, "");
    snprintf(v.screen.text, sizeof v.screen.text, "hatch");
    assert_false(screen_by_material(&v, "dots"));
    assert_string_equal(v.screen.text, "hatch");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_checker), cmocka_unit_test(test_picture),
                                       cmocka_unit_test(test_material)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
