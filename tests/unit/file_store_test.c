/* Writing of files: whole or not at all, whatever stands in the way. What limits or ends a process is done to a
 * child. */
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file_store.h"
#include "base/file_temporary.h"
#include "base/work.h"

enum { LARGE = 1 << 20, ALARM_S = 20 };

static char          folder[128], at[256];
static unsigned char large[LARGE];

/* The callback of a child's work: says no from the n-th question on. */
static bool go_on(double fraction, const char *stage, void *user)
{
    long *left = user;
    (void)fraction, (void)stage;
    return --*left > 0;
}

static int enter(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/limner-test-XXXXXX");
    for (size_t i = 0; i < sizeof large; i++)
        large[i] = (unsigned char)(i * 131 >> 3);
    return mkdtemp(folder) ? 0 : -1;
}

static int leave(void **state)
{
    char command[160];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

static const char *in_folder(const char *name)
{
    snprintf(at, sizeof at, "%.120s/%.128s", folder, name);
    return at;
}

/* How many names the folder has, and of these how many are hidden. */
static int count_names(int *hidden)
{
    int  count = 0;
    DIR *list = opendir(folder);
    assert_non_null(list);
    *hidden = 0;
    for (struct dirent *entry; (entry = readdir(list)) != NULL;)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            count++;
            *hidden += entry->d_name[0] == '.';
        }
    closedir(list);
    return count;
}

static void assert_names(int wanted)
{
    int hidden, count = count_names(&hidden);
    assert_int_equal(hidden, 0);
    assert_int_equal(count, wanted);
}

static void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void assert_content(const char *path, const void *bytes, size_t size)
{
    unsigned char *got = malloc(size + 1);
    FILE          *file = fopen(path, "rb");
    assert_non_null(got);
    assert_non_null(file);
    assert_int_equal(fread(got, 1, size + 1, file), size);
    assert_memory_equal(got, bytes, size);
    fclose(file);
    free(got);
}

/* Runs the function in a child; what it returns, or 128 and more when a signal ends it. */
static int in_child(int (*run)(void))
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        alarm(ALARM_S);
        _exit(run());
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static int store_large(void)
{
    lmn_error error = {0};
    return (int)file_store(at, large, sizeof large, &error);
}

/* --- files and what is there before --------------------------------------------------------------------- */

static void files_are_made_and_replaced(void **state)
{
    (void)state;
    struct stat facts;
    const char *path = in_folder("x.png");
    mode_t      mask = umask(027);
    assert_int_equal(file_store(path, large, sizeof large, NULL), LMN_OK);
    umask(mask);
    assert_content(path, large, sizeof large);
    assert_int_equal(stat(path, &facts), 0);
    assert_int_equal(facts.st_mode & 0777, 0640);
    assert_int_equal(chmod(path, 0606), 0);
    assert_int_equal(file_store(path, "two", 3, NULL), LMN_OK);
    assert_content(path, "two", 3);
    assert_int_equal(stat(path, &facts), 0);
    assert_int_equal(facts.st_mode & 0777, 0606); /* what was allowed still is */
    assert_names(1);
}

static void long_names_are_no_hindrance(void **state)
{
    (void)state;
    char path[512], name[256];
    memset(name, 'n', 255);
    name[255] = '\0';
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_int_equal(file_store(path, "one", 3, NULL), LMN_OK);
    assert_int_equal(file_store(path, "two", 3, NULL), LMN_OK);
    assert_content(path, "two", 3);
    assert_names(1);
}

static void links_stay_links(void **state)
{
    (void)state;
    char        target[256], first[256], link[256];
    struct stat facts;
    snprintf(target, sizeof target, "%s", in_folder("target.png"));
    snprintf(first, sizeof first, "%s", in_folder("first.png"));
    snprintf(link, sizeof link, "%s", in_folder("link.png"));
    assert_int_equal(symlink("target.png", first), 0); /* from the link's folder, not from the working one */
    assert_int_equal(symlink(first, link), 0);
    for (int i = 0; i < 2; i++) { /* dangling at first */
        assert_int_equal(file_store(link, i ? "two" : "one", 3, NULL), LMN_OK);
        assert_content(target, i ? "two" : "one", 3);
        assert_int_equal(lstat(link, &facts), 0);
        assert_true(S_ISLNK(facts.st_mode));
        assert_int_equal(lstat(first, &facts), 0);
        assert_true(S_ISLNK(facts.st_mode));
    }
    assert_names(3);
}

static void links_in_circles_are_refused(void **state)
{
    (void)state;
    lmn_error   error = {0};
    const char *path = in_folder("round");
    assert_int_equal(symlink("round", path), 0);
    assert_int_equal(file_store(path, "x", 1, &error), LMN_WRITE);
    assert_string_equal(error.file, path);
    assert_names(1);
}

/* In a folder where anybody may write, a link can be a trap. */
static void links_of_others_are_refused(void **state)
{
    (void)state;
    if (geteuid() != 0)
        skip(); /* only the superuser can give a link away */
    lmn_error   error = {0};
    const char *path = in_folder("trap");
    assert_int_equal(chmod(folder, 01777), 0);
    assert_int_equal(symlink("secret", path), 0);
    assert_int_equal(lchown(path, 12345, 12345), 0);
    assert_int_equal(file_store(path, "x", 1, &error), LMN_WRITE);
    assert_names(1);
    assert_int_equal(chmod(folder, 0777), 0);
    assert_int_equal(file_store(path, "x", 1, &error), LMN_OK);
}

static void what_is_kept_follows_nothing(void **state)
{
    (void)state;
    char        secret[256];
    struct stat facts;
    snprintf(secret, sizeof secret, "%s", in_folder("secret"));
    put(secret, "mine");
    assert_int_equal(symlink(secret, in_folder("entry")), 0);
    assert_int_equal(file_replace(at, "x", 1, NULL), LMN_OK);
    assert_content(secret, "mine", 4);
    assert_content(at, "x", 1);
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    assert_int_equal(file_replace(at, "x", 1, NULL), LMN_OK);
    assert_int_equal(lstat(at, &facts), 0);
    assert_true(S_ISREG(facts.st_mode));
    assert_names(3);
}

/* --- what cannot be written ----------------------------------------------------------------------------- */

static int store_beyond_the_limit(void)
{
    struct rlimit limit = {1 << 16, 1 << 16};
    sigset_t      before, after, pending;
    lmn_error     error = {0};
    sigprocmask(SIG_SETMASK, NULL, &before);
    setrlimit(RLIMIT_FSIZE, &limit);
    if (file_store(at, large, sizeof large, &error) != LMN_WRITE || strcmp(error.file, at) != 0)
        return 1;
    sigprocmask(SIG_SETMASK, NULL, &after);
    sigpending(&pending);
    if (sigismember(&after, SIGXFSZ) != sigismember(&before, SIGXFSZ) || sigismember(&pending, SIGXFSZ))
        return 2;
    return 0;
}

static void too_large_a_file_is_an_error(void **state)
{
    (void)state;
    in_folder("x.png");
    assert_int_equal(in_child(store_beyond_the_limit), 0);
    assert_names(0);
    put(at, "before");
    assert_int_equal(in_child(store_beyond_the_limit), 0);
    assert_content(at, "before", 6);
    assert_names(1);
}

static int store_into_closed_pipe(void)
{
    int       ends[2];
    sigset_t  pending;
    lmn_error error = {0};
    if (pipe(ends) != 0 || dup2(ends[1], STDOUT_FILENO) < 0)
        return 1;
    close(ends[0]);
    close(ends[1]);
    for (int i = 0; i < 2; i++)
        if (file_store(i ? "/dev/stdout" : "-", large, sizeof large, &error) != LMN_WRITE ||
            !strstr(error.message, "Broken pipe"))
            return 2;
    sigpending(&pending);
    return sigismember(&pending, SIGPIPE) ? 3 : 0;
}

static void closed_pipes_are_an_error(void **state)
{
    (void)state;
    assert_int_equal(in_child(store_into_closed_pipe), 0);
}

/* A signal that was on its way before stays on its way. */
static int keep_an_earlier_signal(void)
{
    sigset_t blocked, pending;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGPIPE);
    sigprocmask(SIG_BLOCK, &blocked, NULL);
    raise(SIGPIPE);
    if (store_large() != LMN_OK)
        return 1;
    sigpending(&pending);
    return sigismember(&pending, SIGPIPE) ? 0 : 2;
}

static void signals_of_others_are_left_alone(void **state)
{
    (void)state;
    in_folder("x.png");
    assert_int_equal(in_child(keep_an_earlier_signal), 0);
}

static int store_into_a_vanished_folder(void)
{
    lmn_error error = {0};
    if (chdir(folder) != 0 || rmdir(folder) != 0)
        return 1;
    return file_store("x.png", "x", 1, &error) == LMN_WRITE && strcmp(error.file, "x.png") == 0 ? 0 : 2;
}

static void positions_that_take_nothing_are_named(void **state)
{
    (void)state;
    static const char *const positions[] = {"/dev/full",           "/proc/x.png", "/dev/null/x.png",
                                            "nosuch-folder/x.png", "/",           "/dev/fd/999"};
    for (size_t i = 0; i < sizeof positions / sizeof *positions; i++) {
        lmn_error error = {0};
        assert_int_equal(file_store(positions[i], "x", 1, &error), LMN_WRITE);
        assert_string_equal(error.file, positions[i]);
    }
    assert_int_equal(file_store("/dev/null", large, sizeof large, NULL), LMN_OK);
    assert_int_equal(in_child(store_into_a_vanished_folder), 0);
    assert_int_equal(mkdir(folder, 0700), 0);
}

static int store_without_leave(void)
{
    if (geteuid() == 0 && setuid(65534) != 0)
        return 1;
    return store_large() == LMN_WRITE ? 0 : 2;
}

static void folders_that_may_not_be_written_are_refused(void **state)
{
    (void)state;
    in_folder("x.png");
    assert_int_equal(chmod(folder, 0555), 0);
    assert_int_equal(in_child(store_without_leave), 0);
    assert_int_equal(chmod(folder, 0700), 0);
    assert_names(0);
}

/* A descriptor that somebody opened for adding is added to. */
static int add_to_standard_output(void)
{
    int file = open(at, O_WRONLY | O_APPEND);
    if (file < 0 || dup2(file, STDOUT_FILENO) < 0)
        return 1;
    return (int)file_store("/dev/stdout", "two", 3, NULL) + 10 * (int)file_store("-", "three", 5, NULL);
}

static void opened_files_are_written_where_they_are(void **state)
{
    (void)state;
    put(in_folder("log"), "one");
    assert_int_equal(in_child(add_to_standard_output), 0);
    assert_content(at, "onetwothree", 11);
}

/* --- pipes ---------------------------------------------------------------------------------------------- */

static pid_t fork_store(long stop)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        alarm(ALARM_S);
        work w;
        work_begin(&w, stop ? go_on : NULL, &stop);
        /* A callback that says no at once is asked for the first time when it is due. */
        if (stop == 1)
            usleep(50000);
        lmn_status status = store_large();
        work_end(&w, status, NULL);
        _exit(status);
    }
    return child;
}

static int end_of(pid_t child)
{
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

static void slow_readers_get_all(void **state)
{
    (void)state;
    static unsigned char got[LARGE + 1];
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    pid_t child = fork_store(0);
    usleep(60000); /* it waits for a reader */
    int reader = open(at, O_RDONLY);
    assert_true(reader >= 0);
    size_t size = 0;
    for (ssize_t piece; size < sizeof got &&
                        (piece = read(reader, got + size, sizeof got - size < 65000 ? sizeof got - size : 65000)) > 0;
         usleep(1000))
        size += (size_t)piece;
    close(reader);
    assert_int_equal(end_of(child), LMN_OK);
    assert_int_equal(size, sizeof large);
    assert_memory_equal(got, large, sizeof large);
}

static void readers_that_go_are_an_error(void **state)
{
    (void)state;
    char byte;
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    pid_t child = fork_store(0);
    int   reader = open(at, O_RDONLY);
    assert_true(reader >= 0);
    assert_int_equal(read(reader, &byte, 1), 1);
    close(reader);
    assert_int_equal(end_of(child), LMN_WRITE);
}

static void waiting_can_be_ended(void **state)
{
    (void)state;
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    assert_int_equal(end_of(fork_store(3)), LMN_CANCELLED); /* no reader */
    int reader = open(at, O_RDONLY | O_NONBLOCK);
    assert_true(reader >= 0);
    assert_int_equal(end_of(fork_store(10)), LMN_CANCELLED); /* a reader that does not read */
    close(reader);
    assert_names(1);
}

static void regular_files_can_be_ended(void **state)
{
    (void)state;
    in_folder("x.png");
    assert_int_equal(end_of(fork_store(1)), LMN_CANCELLED);
    assert_names(0);
}

/* --- temporary files ------------------------------------------------------------------------------------ */

/* A process number that nobody has. */
static long gone_process(void)
{
    pid_t child = fork();
    if (child == 0)
        _exit(0);
    waitpid(child, NULL, 0);
    return (long)child;
}

/* The name of a temporary file that another process of this host would have. */
static void name_of_process(char out[TEMPORARY_NAME_CAPACITY], const char *stem, long process)
{
    char own[32], *found;
    char name[TEMPORARY_NAME_CAPACITY];
    temporary_name(name, stem);
    snprintf(own, sizeof own, "-%ld-", (long)getpid());
    found = strstr(name + strlen(stem), own);
    assert_non_null(found);
    snprintf(out, TEMPORARY_NAME_CAPACITY, "%.*s-%ld-%s", (int)(found - name), name, process, found + strlen(own));
}

static void leftovers_go_with_the_next_file(void **state)
{
    (void)state;
    char gone[TEMPORARY_NAME_CAPACITY], alive[TEMPORARY_NAME_CAPACITY], elsewhere[TEMPORARY_NAME_CAPACITY],
        link[TEMPORARY_NAME_CAPACITY], longer[TEMPORARY_NAME_CAPACITY];
    struct stat facts;
    name_of_process(gone, ".x.png.", gone_process());
    name_of_process(alive, ".x.png.", (long)getppid());
    name_of_process(link, ".y.png.", gone_process());
    name_of_process(elsewhere, ".z.png.", gone_process());
    char *digit = strstr(elsewhere, "limner-") + 7;
    *digit = *digit == '0' ? '1' : '0'; /* another host */
    snprintf(longer, sizeof longer, "%.200s~", gone);
    put(in_folder(gone), "half");
    put(in_folder(alive), "half");
    put(in_folder(elsewhere), "half");
    put(in_folder(longer), "somebody's own");
    assert_int_equal(symlink("nowhere", in_folder(link)), 0);
    assert_int_equal(file_store(in_folder("x.png"), "x", 1, NULL), LMN_OK);
    assert_int_not_equal(lstat(in_folder(gone), &facts), 0);
    assert_int_equal(lstat(in_folder(alive), &facts), 0);
    assert_int_equal(lstat(in_folder(elsewhere), &facts), 0);
    assert_int_equal(lstat(in_folder(longer), &facts), 0);
    assert_int_equal(lstat(in_folder(link), &facts), 0);
}

/* Files without a name are refused from here on, as by file systems that have none. */
static bool forbid_unnamed_files(void)
{
    struct sock_filter rows[] = {
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 3),
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, args[2])),
        BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, O_TMPFILE & ~O_DIRECTORY, 0, 1),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EOPNOTSUPP),
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
    };
    struct sock_fprog filter = {sizeof rows / sizeof *rows, rows};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

enum { NO_FILTER = 77 };

static int store_named(void)
{
    if (!forbid_unnamed_files())
        return NO_FILTER;
    int tried = open(folder, O_TMPFILE | O_WRONLY, 0600);
    if (tried >= 0)
        return 1;
    return store_large();
}

static void file_systems_without_unnamed_files_do(void **state)
{
    (void)state;
    in_folder("x.png");
    for (int i = 0; i < 2; i++) {
        int got = in_child(store_named);
        if (got == NO_FILTER)
            skip(); /* the system does not let itself be filtered */
        assert_int_equal(got, LMN_OK);
        assert_content(at, large, sizeof large);
        assert_names(1);
        put(at, "before");
    }
}

static int store_for_ever(void)
{
    enum { MORE = 16 << 20 };
    unsigned char *bytes = malloc(MORE);
    for (int i = 0; bytes && (!i || file_store(at, bytes, MORE, NULL) == LMN_OK); i++)
        memset(bytes, 'a' + i % 20, MORE);
    return 1;
}

static int store_named_for_ever(void)
{
    return forbid_unnamed_files() ? store_for_ever() : NO_FILTER;
}

/* Kills the child when the folder shows a temporary file, or, as there is none without a name, after some time;
 * true: it showed one. */
static bool kill_in_the_middle(int (*run)(void))
{
    bool  seen = false;
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        alarm(ALARM_S);
        _exit(run());
    }
    for (int i = 0; i < 300 && !seen; i++) {
        int hidden;
        count_names(&hidden);
        seen = hidden > 0;
        usleep(500);
    }
    kill(child, SIGKILL);
    assert_int_equal(end_of(child), 128 + SIGKILL);
    return seen;
}

static void assert_whole(const char *path)
{
    unsigned char first, last;
    struct stat   facts;
    FILE         *file = fopen(path, "rb");
    if (!file)
        return; /* none is as good */
    assert_int_equal(fstat(fileno(file), &facts), 0);
    assert_int_equal(facts.st_size, 16 << 20);
    assert_int_equal(fread(&first, 1, 1, file), 1);
    assert_int_equal(fseek(file, -1, SEEK_END), 0);
    assert_int_equal(fread(&last, 1, 1, file), 1);
    assert_int_equal(first, last);
    fclose(file);
}

static void killed_writers_leave_nothing(void **state)
{
    (void)state;
    int hidden;
    in_folder("x.png");
    kill_in_the_middle(store_for_ever);
    assert_whole(at);
    assert_int_equal(file_store(at, "x", 1, NULL), LMN_OK);
    assert_names(1);
    if (!kill_in_the_middle(store_named_for_ever))
        skip(); /* the system does not let itself be filtered */
    count_names(&hidden);
    assert_int_equal(hidden, 1); /* it was caught at work */
    assert_int_equal(file_store(at, "x", 1, NULL), LMN_OK);
    assert_names(1);
    assert_content(at, "x", 1);
}

/* Another process writes it, piece by piece; until it is whole, the name is not there or what it was before. */
static int arrive(bool unnamed)
{
    int           hidden;
    uint64_t      bytes = 0;
    char          reopened[64];
    file_arrival *a = NULL, *dropped = NULL;
    if (!unnamed && !forbid_unnamed_files())
        return NO_FILTER;
    for (int i = 0; i < 2; i++) {
        if (file_arrival_begin(&a, at, NULL) != LMN_OK || file_arrival_begin(&dropped, at, NULL) != LMN_OK ||
            file_arrival_write(dropped, "half", 4, NULL) != LMN_OK || count_names(&hidden) != i + (unnamed ? 0 : 2))
            return 1;
        snprintf(reopened, sizeof reopened, "/proc/self/fd/%d", file_arrival_descriptor(a));
        put(reopened, i ? "twice" : "once");
        file_arrival_drop(&dropped);
        if (count_names(&hidden) != i + !unnamed || file_arrival_end(&a, &bytes, NULL) != LMN_OK || a || dropped)
            return 2;
        assert_content(at, i ? "twice" : "once", i ? 5 : 4);
        if (bytes != (i ? 5 : 4))
            return 3;
    }
    return 0;
}

static int arrive_unnamed(void)
{
    return arrive(true);
}

static int arrive_named(void)
{
    return arrive(false);
}

static void files_arrive_piece_by_piece(void **state)
{
    (void)state;
    in_folder("x.mp4");
    assert_int_equal(in_child(arrive_unnamed), 0);
    assert_names(1);
    assert_int_equal(unlink(at), 0);
    int named = in_child(arrive_named);
    if (named == NO_FILTER)
        skip();
    assert_int_equal(named, 0);
    assert_names(1);
}

static void temporary_folders_go(void **state)
{
    (void)state;
    char        made[256], left[TEMPORARY_NAME_CAPACITY], inside[300];
    struct stat facts;
    name_of_process(left, "", gone_process());
    assert_int_equal(mkdir(in_folder(left), 0700), 0);
    snprintf(inside, sizeof inside, "%s/model.csg", at);
    put(inside, "half");
    assert_int_equal(setenv("TMPDIR", folder, 1), 0);
    assert_true(temporary_folder_make(made, sizeof made));
    assert_int_not_equal(stat(in_folder(left), &facts), 0);
    assert_int_equal(stat(made, &facts), 0);
    assert_int_equal(facts.st_mode & 0777, 0700);
    snprintf(inside, sizeof inside, "%s/model.csg", made);
    put(inside, "whole");
    temporary_folder_remove(made);
    assert_names(0);
    assert_int_equal(setenv("TMPDIR", "/nosuch", 1), 0);
    assert_false(temporary_folder_make(made, sizeof made));
    assert_int_equal(unsetenv("TMPDIR"), 0);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, enter, leave)

int main(void)
{
    const struct CMUnitTest tests[] = {
        CASE(files_are_made_and_replaced),
        CASE(long_names_are_no_hindrance),
        CASE(links_stay_links),
        CASE(links_in_circles_are_refused),
        CASE(links_of_others_are_refused),
        CASE(what_is_kept_follows_nothing),
        CASE(too_large_a_file_is_an_error),
        CASE(closed_pipes_are_an_error),
        CASE(signals_of_others_are_left_alone),
        CASE(positions_that_take_nothing_are_named),
        CASE(folders_that_may_not_be_written_are_refused),
        CASE(opened_files_are_written_where_they_are),
        CASE(slow_readers_get_all),
        CASE(readers_that_go_are_an_error),
        CASE(waiting_can_be_ended),
        CASE(regular_files_can_be_ended),
        CASE(leftovers_go_with_the_next_file),
        CASE(file_systems_without_unnamed_files_do),
        CASE(killed_writers_leave_nothing),
        CASE(files_arrive_piece_by_piece),
        CASE(temporary_folders_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
