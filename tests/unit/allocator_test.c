/* limner/memory.h: each block of the library goes through the caller's allocator and comes back, limits count them, and
 * what the allocator does not have is LMN_MEMORY. The log of tasks, which has no memory of its own. */
#include <malloc.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "limner/limner.h"

#define MODEL LIMNER_SOURCE_DIR "/examples/box.glb"

/* What the allocator gives begins with this, so that a block of another one is seen. */
enum { MARK = 0x5a5a1234, HEAD = 32 };

typedef struct pool {
    atomic_long live, made, left; /* blocks; left: so many more, negative: any number */
    atomic_long bytes;
} pool;

static pool all = {.left = -1};

static void *pool_alloc(size_t size, void *user)
{
    pool *p = user;
    if (atomic_load(&p->left) == 0)
        return NULL;
    if (atomic_load(&p->left) > 0)
        atomic_fetch_sub(&p->left, 1);
    char *whole = malloc(size + HEAD);
    assert_non_null(whole);
    memcpy(whole, &(uint32_t){MARK}, sizeof(uint32_t));
    memcpy(whole + 8, &size, sizeof size);
    atomic_fetch_add(&p->live, 1);
    atomic_fetch_add(&p->made, 1);
    atomic_fetch_add(&p->bytes, (long)size);
    return memset(whole + HEAD, 0xcd, size); /* nobody takes it for zeros */
}

static char *whole_of(void *block)
{
    uint32_t mark;
    memcpy(&mark, (char *)block - HEAD, sizeof mark);
    assert_int_equal(mark, MARK);
    return (char *)block - HEAD;
}

static void pool_release(void *block, void *user)
{
    pool  *p = user;
    char  *whole = whole_of(block);
    size_t size;
    memcpy(&size, whole + 8, sizeof size);
    atomic_fetch_sub(&p->live, 1);
    atomic_fetch_sub(&p->bytes, (long)size);
    memset(whole, 0, HEAD);
    free(whole);
}

static void *pool_resize(void *block, size_t size, void *user)
{
    size_t before;
    memcpy(&before, whole_of(block) + 8, sizeof before);
    void *made = pool_alloc(size, user);
    if (!made)
        return NULL;
    memcpy(made, block, before < size ? before : size);
    pool_release(block, user);
    return made;
}

static const lmn_allocator allocator = {sizeof(lmn_allocator), pool_alloc, pool_resize, pool_release, &all};

/* The first test of the program, before any memory is in use. */
static void is_set_once(void **state)
{
    (void)state;
    lmn_error     error = {0};
    lmn_allocator wrong = allocator;
    lmn_scene    *scene = NULL;
    assert_int_equal(lmn_allocator_set(NULL, &error), LMN_USAGE);
    wrong.resize = NULL;
    assert_int_equal(lmn_allocator_set(&wrong, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "resize"));
    assert_int_equal(lmn_allocator_set(&allocator, &error), LMN_OK);
    assert_int_equal(lmn_allocator_set(&allocator, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "in use"));
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    assert_true(atomic_load(&all.live) > 0);
    lmn_scene_destroy(&scene);
    assert_int_equal(atomic_load(&all.live), 0);
}

/* Reads, draws and writes; true when all of it went well. */
static lmn_status work(lmn_error *error)
{
    lmn_scene    *scene = NULL;
    lmn_look     *look = NULL;
    lmn_renderer *renderer = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_sheet    *sheet = NULL;
    uint8_t      *bytes = NULL;
    size_t        size;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = 48;
    desc.maps = true;
    lmn_status status = lmn_scene_create(&scene, error);
    if (status == LMN_OK)
        status = lmn_scene_add_file(scene, MODEL, NULL, error);
    if (status == LMN_OK)
        status = lmn_look_load(&look, "hatch", error);
    if (status == LMN_OK)
        status = lmn_renderer_create(&renderer, NULL, error);
    if (status == LMN_OK)
        status = lmn_draw(&drawing, renderer, scene, look, &desc, error);
    if (status == LMN_OK)
        status = lmn_draw_sheet(&sheet, renderer, scene, look, &desc, NULL, error);
    if (status == LMN_OK)
        status = lmn_sheet_encode(sheet, ".pdf", &bytes, &size, error);
    lmn_bytes_free(bytes);
    char *report = lmn_drawing_report_json(drawing);
    lmn_text_free(report);
    lmn_sheet_destroy(&sheet);
    lmn_drawing_destroy(&drawing);
    lmn_renderer_destroy(&renderer);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    return status;
}

static void gives_all_back(void **state)
{
    (void)state;
    lmn_error error = {0};
    long      before = atomic_load(&all.made);
    if (work(&error) != LMN_OK)
        fail_msg("%s", error.message);
    assert_true(atomic_load(&all.made) - before > 300);
    assert_int_equal(atomic_load(&all.live), 0);
    assert_int_equal(atomic_load(&all.bytes), 0);
}

/* Early, in the middle and late; the driver's memory is its own. */
static void survives_its_end(void **state)
{
    (void)state;
    static const long ends[] = {0, 1, 5, 20, 80, 200, 300};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        lmn_error error = {0};
        atomic_store(&all.left, ends[i]);
        assert_int_equal(work(&error), LMN_MEMORY);
        atomic_store(&all.left, -1);
        assert_int_equal(error.status, LMN_MEMORY);
        assert_int_equal(atomic_load(&all.live), 0);
    }
}

static void limits_count(void **state)
{
    (void)state;
    lmn_error     error = {0};
    lmn_task     *task = NULL;
    lmn_task_desc desc = lmn_task_desc_standard();
    desc.limits.memory = 1 << 19;
    desc.in_process = true;
    assert_int_equal(lmn_task_begin(&task, &desc, &error), LMN_OK);
    void *first = mem_alloc(1 << 18), *second = mem_alloc((1 << 18) - 1024), *third = mem_alloc(2048);
    assert_true(first && second && !third);
    mem_free(second);
    second = mem_alloc(2048);
    assert_null(second); /* the call is to stop */
    mem_free(first);
    lmn_task_end(&task);
    assert_int_equal(atomic_load(&all.live), 0);
    void *cleared = mem_calloc(100, 10), *none = mem_realloc(NULL, 0);
    assert_memory_equal(cleared, (char[1000]){0}, 1000);
    cleared = mem_realloc(cleared, 3000);
    assert_memory_equal(cleared, (char[1000]){0}, 1000);
    mem_free(cleared);
    mem_free(none);
}

/* --- the log -------------------------------------------------------------------------------------------- */

typedef struct heard {
    int  count[2];
    char text[256];
} heard;

static void listen(lmn_log_kind kind, const char *code, const char *text, void *user)
{
    heard *h = user;
    assert_true(kind == LMN_LOG_WARNING || kind == LMN_LOG_DRIVER);
    if (kind == LMN_LOG_WARNING && strcmp(code, "no-match") != 0)
        return;
    h->count[kind]++;
    snprintf(h->text, sizeof h->text, "%s", text);
}

/* A rule that selects nothing is warned of: in the drawing, and as it happens. */
static void draw_with_warning(void)
{
    lmn_error     error = {0};
    lmn_scene    *scene = NULL;
    lmn_look     *look = NULL;
    lmn_sheet    *sheet = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    const char   *code;
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    assert_int_equal(lmn_scene_add_file(scene, MODEL, NULL, &error), LMN_OK);
    assert_int_equal(lmn_look_load(&look, "technical", &error), LMN_OK);
    assert_int_equal(lmn_look_add_rule(look, "nothing-here", LMN_AT_END, NULL, &error), LMN_OK);
    assert_int_equal(lmn_draw_sheet(&sheet, NULL, scene, look, &desc, NULL, &error), LMN_OK);
    bool warned = false;
    for (size_t i = 0; lmn_sheet_warning_at(sheet, i, &code, NULL); i++)
        warned = warned || strcmp(code, "no-match") == 0;
    assert_true(warned);
    lmn_sheet_destroy(&sheet);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

static void log_hears_warnings(void **state)
{
    (void)state;
    lmn_error     error = {0};
    lmn_task     *outer = NULL, *inner = NULL;
    lmn_task_desc listening = lmn_task_desc_standard(), silent = listening;
    heard         h = {{0, 0}, ""};
    draw_with_warning();
    listening.log = listen;
    listening.log_user = &h;
    assert_int_equal(lmn_task_begin(&outer, &listening, &error), LMN_OK);
    draw_with_warning();
    const int once = h.count[LMN_LOG_WARNING];
    assert_true(once > 0);
    assert_non_null(strstr(h.text, "nothing-here"));
    assert_int_equal(lmn_task_begin(&inner, &silent, &error), LMN_OK);
    draw_with_warning(); /* the outer task hears what no inner one does */
    assert_int_equal(h.count[LMN_LOG_WARNING], 2 * once);
    lmn_task_end(&inner);
    lmn_task_end(&outer);
    draw_with_warning();
    assert_int_equal(h.count[LMN_LOG_WARNING], 2 * once);
    assert_int_equal(h.count[LMN_LOG_DRIVER], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_set_once),      cmocka_unit_test(gives_all_back), cmocka_unit_test(log_hears_warnings),
        cmocka_unit_test(survives_its_end), cmocka_unit_test(limits_count),
    };
    return cmocka_run_group_tests_name("allocator", tests, NULL, NULL);
}
