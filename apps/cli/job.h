/* One command's work on many machines: shards of it, and the scripts by which schedulers that are there run them. */
#ifndef LIMNER_CLI_JOB_H
#define LIMNER_CLI_JOB_H

#include "options.h"

/* One of `count` shards, from 1 on. Items of work are dealt in turn, so that shards together are all of it. */
typedef struct shard {
    long index, count;
} shard;

/* "I/N"; NULL is the only one of one. Prints what is wrong; exit status. */
int  shard_parse(const char *text, shard *out);
bool shard_has(const shard *s, long item);

/* Options of commands that have shards: a `job_values job` among their values. */
typedef struct job_values {
    const char   *shard;
    int           kind; /* of script; −1: none */
    option_number tasks;
} job_values;

extern const char *const job_kinds[];

#define JOB_OPTIONS(values)                                                                                            \
    {"shard",                                                                                                          \
     0,                                                                                                                \
     OPTION_TEXT,                                                                                                      \
     offsetof(values, job.shard),                                                                                      \
     "I/N",                                                                                                            \
     "Only the I-th of N equal shares of the work, for N processes or machines that write into the same folder."},     \
        {"job",                                                                                                        \
         0,                                                                                                            \
         OPTION_CHOICE,                                                                                                \
         offsetof(values, job.kind),                                                                                   \
         "slurm|parallel",                                                                                             \
         "Draw nothing; print a Slurm batch script, or a line for GNU parallel, that draws all of it in shards.",      \
         .choices = job_kinds},                                                                                        \
    {                                                                                                                  \
        "tasks", 0, OPTION_WHOLE, offsetof(values, job.tasks), "N", "Of --job: how many shards. Default: 8.", 1, 10000 \
    }

/* Do they go together? Prints what is wrong; exit status. */
int job_check(const job_values *v);

/* Prints the script that runs the command with these values in shards, each of which goes on where it was broken off.
 * `last` (NULL: nothing): options for a run after all shards. Exit status. */
int job_print(const command *c, const word_list *inputs, const void *values, const job_values *v, const char *last);

#endif
