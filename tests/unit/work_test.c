/* The work of a call: cancelling, time, memory, nesting, threads; and limits as text. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/threads.h"
#include "base/work.h"

static void sleep_ms(long ms)
{
    nanosleep(&(struct timespec){ms / 1000, ms % 1000 * 1000000}, NULL);
}

/* The callback: says no from the n-th question on. */
typedef struct listener {
    int    asked, no_from;
    double fraction;
} listener;

static bool listen(double fraction, const char *stage, void *user)
{
    listener *l = user;
    assert_non_null(stage);
    l->fraction = fraction;
    return ++l->asked < l->no_from;
}

static void nothing_stops_without_work(void **state)
{
    (void)state;
    lmn_error error;
    assert_null(work_current());
    assert_false(work_stopped());
    assert_int_equal(work_check(&error), LMN_OK);
    void *block = mem_alloc(100);
    assert_non_null(block);
    mem_free(block);
}

static void cancelled_work_gets_no_memory(void **state)
{
    (void)state;
    work      w;
    listener  l = {.no_from = 2};
    lmn_error error = {0};
    work_begin(&w, listen, &l);
    void *before = mem_alloc(64);
    assert_non_null(before);
    assert_int_equal(work_progress(0.25, "first", &error), LMN_OK);
    assert_int_equal(work_progress(0.5, "second", &error), LMN_CANCELLED);
    assert_true(l.fraction == 0.5);
    assert_null(mem_alloc(64));
    assert_null(mem_calloc(4, 16));
    assert_null(mem_realloc(before, 128));
    mem_free(before);
    /* Whatever the call makes of it, the reason is told. */
    assert_int_equal(work_end(&w, error_memory(&error), &error), LMN_CANCELLED);
    assert_int_equal(error.status, LMN_CANCELLED);
    void *after = mem_alloc(64);
    assert_non_null(after);
    mem_free(after);
}

static void silent_work_is_asked_too(void **state)
{
    (void)state;
    work     w;
    listener l = {.no_from = 3};
    work_begin(&w, listen, &l);
    double start = clock_ms();
    while (!work_stopped() && clock_ms() < start + 5000)
        ;
    assert_true(work_stopped());
    assert_true(clock_ms() - start < 1000);
    assert_int_equal(work_end(&w, LMN_OK, NULL), LMN_CANCELLED);
}

static void time_runs_out(void **state)
{
    (void)state;
    work          task, w;
    lmn_error     error = {0};
    lmn_task_desc desc = {.struct_size = sizeof desc, .limits = lmn_limits_standard()};
    desc.limits.time_s = 0.05;
    work_begin_task(&task, &desc);
    sleep_ms(80);
    assert_int_equal(work_check(&error), LMN_OK); /* it is a limit for calls */
    work_begin(&w, NULL, NULL);
    assert_int_equal(work_check(&error), LMN_OK);
    sleep_ms(80);
    assert_int_equal(work_check(&error), LMN_LIMIT);
    error_in_file(&error, LMN_FORMAT, "model.gltf", 3, "nonsense");
    assert_int_equal(work_end(&w, LMN_FORMAT, &error), LMN_LIMIT);
    assert_string_equal(error.file, "model.gltf");
    assert_non_null(strstr(error.message, "0.05 s"));
    assert_non_null(strstr(error.hint, "--limit time="));
    assert_int_equal(work_end(&task, LMN_OK, NULL), LMN_OK);
}

static void memory_runs_out(void **state)
{
    (void)state;
    work          task, w;
    lmn_error     error = {0};
    lmn_task_desc desc = {.struct_size = sizeof desc, .limits = lmn_limits_standard()};
    desc.limits.memory = 1 << 20;
    work_begin_task(&task, &desc);
    work_begin(&w, NULL, NULL);
    for (int i = 0; i < 100; i++) { /* what is given back is free again */
        void *block = mem_alloc(700000);
        assert_non_null(block);
        mem_free(block);
    }
    void *block = mem_alloc(700000);
    assert_non_null(block);
    assert_null(mem_alloc(700000));
    assert_null(mem_alloc(16)); /* it is over */
    mem_free(block);
    assert_int_equal(work_end(&w, error_memory(&error), &error), LMN_LIMIT);
    assert_non_null(strstr(error.hint, "--limit memory="));
    work_end(&task, LMN_OK, NULL);
    work_begin(&w, NULL, NULL);
    block = mem_realloc(mem_alloc(10), 3000000);
    assert_non_null(block);
    mem_free(block);
    assert_int_equal(work_end(&w, LMN_OK, NULL), LMN_OK);
}

static void an_outer_task_stops_the_inner_call(void **state)
{
    (void)state;
    work          task, w;
    listener      l = {.no_from = 2};
    lmn_task_desc desc = {
        .struct_size = sizeof desc, .limits = lmn_limits_standard(), .progress = listen, .progress_user = &l};
    work_begin_task(&task, &desc);
    work_begin(&w, NULL, NULL);
    double start = clock_ms();
    while (work_check(NULL) == LMN_OK && clock_ms() < start + 5000)
        ;
    assert_true(clock_ms() - start < 1000);
    assert_int_equal(work_end(&w, LMN_OK, NULL), LMN_CANCELLED);
    assert_true(work_current() == &task);
    assert_int_equal(work_end(&task, LMN_OK, NULL), LMN_CANCELLED);
    assert_null(work_current());
}

static atomic_int pieces_stopped;

static void wait_for_stop(size_t begin, size_t end, void *user)
{
    (void)begin, (void)end, (void)user;
    double start = clock_ms();
    while (!work_stopped() && clock_ms() < start + 5000)
        ;
    atomic_fetch_add(&pieces_stopped, work_stopped());
}

static void threads_stop_with_their_work(void **state)
{
    (void)state;
    work     w;
    listener l = {.no_from = 3};
    work_begin(&w, listen, &l);
    double start = clock_ms();
    threads_for(64, 1, wait_for_stop, NULL);
    assert_true(clock_ms() - start < 2000);
    assert_true(atomic_load(&pieces_stopped) > 0);
    assert_int_equal(work_end(&w, LMN_OK, NULL), LMN_CANCELLED);
}

/* What only the other threads do must not keep the calling one from hearing. */
static void idle_first(size_t begin, size_t end, void *user)
{
    if (begin > 0)
        wait_for_stop(begin, end, user);
}

static void the_caller_listens_while_others_work(void **state)
{
    (void)state;
    work     w;
    listener l = {.no_from = 3};
    work_begin(&w, listen, &l);
    double start = clock_ms();
    threads_for(64, 1, idle_first, NULL);
    assert_true(clock_ms() - start < 2000);
    work_end(&w, LMN_OK, NULL);
}

static void limits_are_text(void **state)
{
    (void)state;
    lmn_error  error;
    lmn_limits l = lmn_limits_standard(), before;
    assert_int_equal(lmn_limits_set(&l, "time=1.5min,memory=2G,triangles=5M,pixels=100k,textures=none", &error),
                     LMN_OK);
    assert_true(l.time_s == 90);
    assert_true(l.memory == (uint64_t)2 << 30 && l.triangles == 5000000 && l.pixels == 100000 && l.textures == 0);
    before = l;
    static const char *const wrong[] = {"",           "time",    "time=",      "time=0",      "time=-1",
                                        "time=1x",    "speed=3", "memory=2G,", "memory=1e30", "time=3s,pixels=x",
                                        "memory=0.1", "time=nan"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(lmn_limits_set(&l, wrong[i], &error), LMN_USAGE);
        assert_memory_equal(&l, &before, sizeof l);
        assert_true(error.message[0]);
    }
    /* Printed values are read back. */
    lmn_limit_info info;
    lmn_limits     again = lmn_limits_standard(), safe = lmn_limits_safe();
    for (size_t i = 0; lmn_limit_at(i, &info); i++) {
        char text[64];
        snprintf(text, sizeof text, "%s=%s", info.name, info.safe);
        assert_int_equal(lmn_limits_set(&again, text, &error), LMN_OK);
        assert_true(info.doc[0]);
    }
    assert_memory_equal(&again, &safe, sizeof again);
}

/* A call that takes what the task has left ends; once it has given it back, the next one goes on. */
static void a_call_without_room_does_not_end_the_task(void **state)
{
    (void)state;
    enum { BLOCKS = 4000 };
    static void  *blocks[BLOCKS];
    lmn_task     *task;
    lmn_task_desc desc = lmn_task_desc_standard();
    desc.limits.memory = 1 << 20;
    assert_int_equal(lmn_task_begin(&task, &desc, NULL), LMN_OK);
    void  *held = mem_alloc(500000);
    size_t count = 0;
    work   w;
    work_begin(&w, NULL, NULL);
    while (count < BLOCKS && (blocks[count] = mem_alloc(1000)))
        count++;
    assert_true(count > 100 && count < BLOCKS);
    for (size_t i = 0; i < count; i++)
        mem_free(blocks[i]);
    assert_int_equal(work_end(&w, LMN_MEMORY, NULL), LMN_LIMIT);
    work_begin(&w, NULL, NULL);
    blocks[0] = mem_alloc(1000);
    assert_int_equal(work_check(NULL), LMN_OK);
    assert_non_null(blocks[0]);
    mem_free(blocks[0]);
    assert_int_equal(work_end(&w, LMN_OK, NULL), LMN_OK);
    mem_free(held);
    lmn_task_end(&task);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_call_without_room_does_not_end_the_task),
        cmocka_unit_test(nothing_stops_without_work),
        cmocka_unit_test(cancelled_work_gets_no_memory),
        cmocka_unit_test(silent_work_is_asked_too),
        cmocka_unit_test(time_runs_out),
        cmocka_unit_test(memory_runs_out),
        cmocka_unit_test(an_outer_task_stops_the_inner_call),
        cmocka_unit_test(threads_stop_with_their_work),
        cmocka_unit_test(the_caller_listens_while_others_work),
        cmocka_unit_test(limits_are_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
