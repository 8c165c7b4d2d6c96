#include "check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int         failed, done;
static const char *program_name = "truth";

static bool judge(bool holds, const char *row, const char *numbers, const char *what, va_list arguments)
{
    done++;
    failed += !holds;
    printf("%-4s %-12s ", holds ? "ok" : "FAIL", row);
    vprintf(what, arguments);
    printf("%s%s\n", *numbers ? ": " : "", numbers);
    fflush(stdout);
    return holds;
}

bool check_at_most(const char *row, double got, double limit, const char *what, ...)
{
    char    numbers[64];
    va_list arguments;
    snprintf(numbers, sizeof numbers, "%.6g <= %.6g", got, limit);
    va_start(arguments, what);
    bool holds = judge(got <= limit, row, numbers, what, arguments);
    va_end(arguments);
    return holds;
}

bool check_at_least(const char *row, double got, double limit, const char *what, ...)
{
    char    numbers[64];
    va_list arguments;
    snprintf(numbers, sizeof numbers, "%.6g >= %.6g", got, limit);
    va_start(arguments, what);
    bool holds = judge(got >= limit, row, numbers, what, arguments);
    va_end(arguments);
    return holds;
}

bool check_near(const char *row, double got, double wanted, double tolerance, const char *what, ...)
{
    char    numbers[96];
    va_list arguments;
    snprintf(numbers, sizeof numbers, "%.6g, wanted %.6g +- %.3g", got, wanted, tolerance);
    va_start(arguments, what);
    bool holds = judge(fabs(got - wanted) <= tolerance, row, numbers, what, arguments);
    va_end(arguments);
    return holds;
}

bool check_that(const char *row, bool holds, const char *what, ...)
{
    va_list arguments;
    va_start(arguments, what);
    judge(holds, row, "", what, arguments);
    va_end(arguments);
    return holds;
}

void check_note(const char *what, ...)
{
    va_list arguments;
    va_start(arguments, what);
    printf("     %-12s ", "");
    vprintf(what, arguments);
    printf("\n");
    va_end(arguments);
}

const char *check_path(const char *name, ...)
{
    static char paths[8][512];
    static int  next;
    char       *path = paths[next];
    next = (next + 1) % 8;
    mkdir("truth", 0777);
    int length = snprintf(path, sizeof paths[0], "truth/%s", program_name);
    mkdir(path, 0777);
    path[length++] = '/';
    va_list arguments;
    va_start(arguments, name);
    vsnprintf(path + length, sizeof paths[0] - (size_t)length, name, arguments);
    va_end(arguments);
    return path;
}

void *check_alloc(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory) {
        fprintf(stderr, "%s: out of memory\n", program_name);
        exit(2);
    }
    return memory;
}

int check_main(int argc, char **argv, const char *program, const check_case *cases, size_t count)
{
    program_name = program;
    const bool list = argc == 2 && strcmp(argv[1], "--cases") == 0;
    for (size_t i = 0; list && i < count; i++)
        printf("%s\n", cases[i].name);
    if (list)
        return 0;
    for (size_t i = 0; i < count; i++) {
        bool wanted = argc < 2;
        for (int k = 1; k < argc; k++)
            wanted = wanted || strcmp(argv[k], cases[i].name) == 0;
        if (!wanted)
            continue;
        printf("-- %s\n", cases[i].name);
        cases[i].run();
    }
    printf("%s: %d of %d checks failed\n", program, failed, done);
    return failed || !done;
}
