/* The fence: what the child cannot do, how its end is told, and that the next request finds another one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/work.h"
#include "fence/fence.h"
#include "limner/task.h"

static lmn_status echo(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)error;
    fence_put(answer, request, size);
    return LMN_OK;
}

static lmn_status refuse(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    fence_put(answer, request, size);
    return error_set(error, LMN_UNSUPPORTED, "not today");
}

/* What it can do as letters. */
static lmn_status try_everything(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)error;
    char   able[128] = "";
    size_t count = 0;
    if (open("/etc/passwd", O_RDONLY) >= 0)
        able[count++] = 'r';
    if (open("/tmp/limner-fence-test", O_WRONLY | O_CREAT, 0600) >= 0)
        able[count++] = 'w';
    if (socket(AF_INET, SOCK_STREAM, 0) >= 0)
        able[count++] = 'n';
    pid_t child = fork();
    if (child == 0)
        _exit(0);
    if (child > 0)
        able[count++] = 'f';
    if (kill(getpid(), 0) == 0)
        able[count++] = 'k';
    pid_t parent = 0;
    if (size == sizeof parent)
        memcpy(&parent, request, sizeof parent);
    if (syscall(SYS_tgkill, parent, parent, 0) == 0 || errno != EPERM)
        able[count++] = 't';
    char *const arguments[] = {(char *)"true", NULL};
    if (execv("/bin/true", arguments) == 0 || errno != EPERM)
        able[count++] = 'x';
    /* A file that the parent holds open. */
    for (int i = 4; i < 64; i++)
        if (fcntl(i, F_GETFD) >= 0 || lseek(i, 0, SEEK_CUR) >= 0)
            able[count++] = 'd';
    fence_put_text(answer, able);
    return LMN_OK;
}

static lmn_status crash(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)request, (void)size, (void)answer, (void)error;
    signal(SIGSEGV, SIG_DFL);
    raise(SIGSEGV);
    return LMN_OK;
}

static lmn_status abort_it(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)request, (void)size, (void)answer, (void)error;
    abort();
}

static lmn_status hang(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)request, (void)size, (void)answer, (void)error;
    volatile bool forever = true;
    while (forever)
        ;
    return LMN_OK;
}

static lmn_status eat(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)request, (void)size, (void)answer;
    for (;;) {
        char *block = malloc(1 << 24);
        if (!block)
            return error_memory(error);
        memset(block, 1, 1 << 24);
    }
}

static lmn_status own_id(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)request, (void)size, (void)error;
    fence_put_u32(answer, (uint32_t)getpid());
    return LMN_OK;
}

static uint32_t id_of_child(void)
{
    fence_bytes answer, none = {0};
    assert_int_equal(fence_call(&answer, own_id, "the test", &none, NULL), LMN_OK);
    fence_reader r = fence_read(answer.bytes, answer.size);
    uint32_t     id = fence_take_u32(&r);
    mem_free(answer.bytes);
    return id;
}

static lmn_task *begin(double time_s, uint64_t memory, lmn_progress_fn progress, void *user, bool in_process)
{
    lmn_task     *task;
    lmn_task_desc desc = lmn_task_desc_standard();
    desc.limits.time_s = time_s;
    desc.limits.memory = memory;
    desc.progress = progress;
    desc.progress_user = user;
    desc.in_process = in_process;
    assert_int_equal(lmn_task_begin(&task, &desc, NULL), LMN_OK);
    return task;
}

static void answers_come_back_whole(void **state)
{
    (void)state;
    lmn_task *task = begin(0, 0, NULL, NULL, false);
    for (size_t size = 0; size < (size_t)40 << 20; size = size * 7 + 1) {
        fence_bytes request = {.bytes = mem_alloc(size), .size = size}, answer;
        for (size_t i = 0; i < size; i++)
            request.bytes[i] = (unsigned char)(i * 2654435761u >> 13);
        assert_int_equal(fence_call(&answer, echo, "the test", &request, NULL), LMN_OK);
        assert_int_equal(answer.size, size);
        if (size)
            assert_memory_equal(answer.bytes, request.bytes, size);
        mem_free(answer.bytes);
        mem_free(request.bytes);
    }
    lmn_task_end(&task);
}

static void errors_come_back(void **state)
{
    (void)state;
    for (int in_process = 0; in_process < 2; in_process++) {
        lmn_task   *task = begin(0, 0, NULL, NULL, in_process);
        lmn_error   error;
        fence_bytes answer, request = {0};
        fence_put_text(&request, "words");
        assert_int_equal(fence_call(&answer, refuse, "the test", &request, &error), LMN_UNSUPPORTED);
        assert_string_equal(error.message, "not today");
        assert_null(answer.bytes);
        mem_free(request.bytes);
        lmn_task_end(&task);
    }
}

static void the_child_can_do_nothing(void **state)
{
    (void)state;
    if (strcmp(fence_kind(), "limits") == 0)
        skip();
    lmn_task   *task = begin(0, 0, NULL, NULL, false);
    int         open_here = open("/etc/passwd", O_RDONLY);
    pid_t       own = getpid();
    fence_bytes answer, request = {.bytes = (unsigned char *)&own, .size = sizeof own};
    assert_int_equal(fence_call(&answer, try_everything, "the test", &request, NULL), LMN_OK);
    fence_reader r = fence_read(answer.bytes, answer.size);
    char        *able = fence_take_text(&r);
    assert_string_equal(able, "");
    mem_free(able);
    mem_free(answer.bytes);
    close(open_here);
    lmn_task_end(&task);
}

/* What a decoder that has been taken over might say: that an answer is as long as no memory is. */
static lmn_status lie(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)request, (void)size, (void)error;
    fence_put_u32(answer, 1);
    answer->size = SIZE_MAX;
    return LMN_OK;
}

static lmn_status fail_oddly(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    (void)request, (void)size, (void)answer;
    error_set(error, LMN_FORMAT, "odd");
    error->status = LMN_OK;
    return LMN_FORMAT;
}

static void lies_do_no_harm(void **state)
{
    (void)state;
    lmn_task   *task = begin(0, 0, NULL, NULL, false);
    lmn_error   error;
    fence_bytes answer, none = {0};
    assert_int_equal(fence_call(&answer, lie, "the test", &none, &error), LMN_FORMAT);
    assert_null(answer.bytes);
    assert_int_equal(fence_call(&answer, fail_oddly, "the test", &none, &error), LMN_FORMAT);
    assert_int_equal(error.status, LMN_FORMAT);
    lmn_task_end(&task);
}

static lmn_status dawdle(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    double until = clock_ms() + 150;
    while (clock_ms() < until)
        ;
    return echo(request, size, answer, error);
}

static bool call_again(double fraction, const char *stage, void *user)
{
    (void)fraction, (void)stage;
    fence_bytes answer, request = {.bytes = (unsigned char *)"inner", .size = 5}, none = {0};
    assert_int_equal(fence_call(&answer, crash, "the test", &none, NULL), LMN_FORMAT);
    assert_int_equal(fence_call(&answer, echo, "the test", &request, NULL), LMN_OK);
    assert_int_equal(answer.size, 5);
    assert_memory_equal(answer.bytes, "inner", 5);
    mem_free(answer.bytes);
    ++*(int *)user;
    return true;
}

/* A callback may call the library while the child works for the call that asks it. */
static void callbacks_may_call_again(void **state)
{
    (void)state;
    int         asked = 0;
    lmn_task   *task = begin(0, 0, call_again, &asked, false);
    fence_bytes answer, request = {.bytes = (unsigned char *)"outer", .size = 5};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(fence_call(&answer, dawdle, "the test", &request, NULL), LMN_OK);
        assert_int_equal(answer.size, 5);
        assert_memory_equal(answer.bytes, "outer", 5);
        mem_free(answer.bytes);
    }
    assert_true(asked >= 2);
    lmn_task_end(&task);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); /* no child is left */
}

static void closed_descriptors_do_no_harm(void **state)
{
    (void)state;
    int kept[3];
    for (int i = 0; i < 3; i++)
        kept[i] = fcntl(i, F_DUPFD_CLOEXEC, 10);
    for (int i = 0; i < 3; i++)
        close(i);
    fence_bytes answer, request = {.bytes = (unsigned char *)"words", .size = 5};
    lmn_status  status = fence_call(&answer, echo, "the test", &request, NULL);
    for (int i = 0; i < 3; i++) {
        if (kept[i] >= 0)
            dup2(kept[i], i);
        close(kept[i]);
    }
    assert_int_equal(status, LMN_OK);
    assert_int_equal(answer.size, 5);
    mem_free(answer.bytes);
}

static void one_child_serves_a_task(void **state)
{
    (void)state;
    lmn_task *task = begin(0, 0, NULL, NULL, false);
    uint32_t  first = id_of_child();
    assert_int_not_equal(first, getpid());
    assert_int_equal(id_of_child(), first);
    lmn_task_end(&task);
    assert_int_equal(kill((pid_t)first, 0), -1); /* it ended with the task */
    task = begin(0, 0, NULL, NULL, true);
    assert_int_equal(id_of_child(), getpid());
    lmn_task_end(&task);
}

static void a_crash_is_an_error_for_one_request(void **state)
{
    (void)state;
    lmn_task   *task = begin(0, 0, NULL, NULL, false);
    lmn_error   error;
    fence_bytes answer, none = {0};
    uint32_t    first = id_of_child();
    assert_int_equal(fence_call(&answer, crash, "the test", &none, &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "the test crashed"));
    uint32_t second = id_of_child();
    assert_int_not_equal(second, first);
    assert_int_equal(fence_call(&answer, abort_it, "the test", &none, &error), LMN_LIMIT);
    id_of_child();
    /* One that somebody else ended between two requests. */
    kill((pid_t)id_of_child(), SIGKILL);
    assert_int_not_equal(fence_call(&answer, echo, "the test", &none, &error), LMN_OK);
    id_of_child();
    lmn_task_end(&task);
}

static bool never(double fraction, const char *stage, void *user)
{
    (void)fraction, (void)stage;
    return ++*(int *)user < 4;
}

static void a_child_that_hangs_is_stopped(void **state)
{
    (void)state;
    lmn_error   error = {0};
    fence_bytes answer, none = {0};
    int         asked = 0;
    work        w;
    lmn_task   *task = begin(0.2, 0, NULL, NULL, false);
    double      start = clock_ms();
    work_begin(&w, NULL, NULL);
    assert_int_equal(work_end(&w, fence_call(&answer, hang, "the test", &none, &error), &error), LMN_LIMIT);
    assert_true(clock_ms() - start < 1500);
    lmn_task_end(&task);
    task = begin(0, 0, never, &asked, false);
    start = clock_ms();
    work_begin(&w, NULL, NULL);
    assert_int_equal(work_end(&w, fence_call(&answer, hang, "the test", &none, &error), &error), LMN_CANCELLED);
    assert_true(clock_ms() - start < 1500);
    lmn_task_end(&task);
}

static void memory_of_the_child_is_limited(void **state)
{
    (void)state;
    lmn_error   error = {0};
    fence_bytes answer, none = {0};
    lmn_task   *task = begin(20, 256 << 20, NULL, NULL, false);
    lmn_status  status = fence_call(&answer, eat, "the test", &none, &error);
    assert_true(status == LMN_MEMORY || status == LMN_LIMIT);
    lmn_task_end(&task);
}

static void readers_never_go_beyond_the_end(void **state)
{
    (void)state;
    fence_bytes b = {0};
    fence_put_u32(&b, 1000); /* the length of a text that is not there */
    fence_put(&b, "abc", 3);
    fence_reader r = fence_read(b.bytes, b.size);
    assert_null(fence_take_text(&r));
    assert_true(r.ended);
    assert_int_equal(fence_take_u32(&r), 0);
    assert_null(fence_take(&r, 0));
    mem_free(b.bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_come_back_whole),
        cmocka_unit_test(errors_come_back),
        cmocka_unit_test(the_child_can_do_nothing),
        cmocka_unit_test(one_child_serves_a_task),
        cmocka_unit_test(a_crash_is_an_error_for_one_request),
        cmocka_unit_test(a_child_that_hangs_is_stopped),
        cmocka_unit_test(memory_of_the_child_is_limited),
        cmocka_unit_test(readers_never_go_beyond_the_end),
        cmocka_unit_test(lies_do_no_harm),
        cmocka_unit_test(callbacks_may_call_again),
        cmocka_unit_test(closed_descriptors_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
