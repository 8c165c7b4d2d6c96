/* Checks that print their numbers: a row of the feature tables, what was measured, the value and the limit. A
 * failed check does not end the program, so that one run shows everything. */
#ifndef TRUTH_CHECK_H
#define TRUTH_CHECK_H

#include <stdbool.h>
#include <stddef.h>

typedef struct check_case {
    const char *name;
    void (*run)(void);
} check_case;

/* Runs the cases named on the command line, or all; with `--cases` alone it lists their names instead. The exit status:
 * 0 when every check held. */
int check_main(int argc, char **argv, const char *program, const check_case *cases, size_t count);

bool check_at_most(const char *row, double got, double limit, const char *what, ...)
    __attribute__((format(printf, 4, 5)));
bool check_at_least(const char *row, double got, double limit, const char *what, ...)
    __attribute__((format(printf, 4, 5)));
bool check_near(const char *row, double got, double wanted, double tolerance, const char *what, ...)
    __attribute__((format(printf, 5, 6)));
bool check_that(const char *row, bool holds, const char *what, ...) __attribute__((format(printf, 3, 4)));

/* Prints a number that is not judged. */
void check_note(const char *what, ...) __attribute__((format(printf, 1, 2)));

/* The folder for this program's files (made when missing), as "FOLDER/NAME"; valid until the eighth next call. */
const char *check_path(const char *name, ...) __attribute__((format(printf, 1, 2)));

/* Allocation that ends the program when memory is gone. */
void *check_alloc(size_t count, size_t size);

#endif
