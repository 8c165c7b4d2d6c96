/* Another program as a child process that takes bytes on its standard input and says on its standard error what went
 * wrong. No shell, a process group of its own (Ctrl-C is ours to answer), and no end of this process by SIGPIPE. */
#ifndef LIMNER_FILM_CHILD_H
#define LIMNER_FILM_CHILD_H

#include "base/error.h"

enum { CHILD_PATH_CAPACITY = 4096, CHILD_FILE = 3 };

typedef struct child child;

/* The first executable file of this name in the PATH. */
bool child_find(char out[CHILD_PATH_CAPACITY], const char *name);

/* Starts `program` (a path); `arguments` end with NULL and begin with its name. It gets `file` open as the descriptor
 * CHILD_FILE. Errors: LMN_WRITE, LMN_MEMORY. */
lmn_status child_start(child **out, const char *program, const char *const *arguments, int file, lmn_error *error);

/* Hands bytes over, as fast as they are taken. Errors: LMN_WRITE with what the program said, LMN_CANCELLED,
 * LMN_LIMIT. */
lmn_status child_write(child *c, const void *bytes, size_t size, lmn_error *error);

/* No more bytes come: waits until the program is done. Errors: as child_write. */
lmn_status child_end(child *c, lmn_error *error);

/* Ends the program if it still runs, and frees it; NULL and a pointer to NULL are accepted. */
void child_kill(child **handle);

#endif
