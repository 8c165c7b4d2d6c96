#include "job.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "message.h"

const char *const job_kinds[] = {"slurm", "parallel", NULL};

enum { JOB_SLURM, TASKS_STANDARD = 8, SHARDS_MOST = 1000000 };

int shard_parse(const char *text, shard *out)
{
    int used = 0;
    *out = (shard){1, 1};
    if (!text)
        return EXIT_DONE;
    if (sscanf(text, "%7ld/%7ld%n", &out->index, &out->count, &used) != 2 || text[used] || out->index < 1 ||
        out->count > SHARDS_MOST || out->index > out->count)
        return message_usage("for example --shard 3/8", "--shard is '%.40s'; allowed is I/N with I from 1 to N", text);
    return EXIT_DONE;
}

bool shard_has(const shard *s, long item)
{
    return item % s->count == s->index - 1;
}

int job_check(const job_values *v)
{
    if (v->kind >= 0 && v->shard)
        return message_usage("--tasks N says how many shards there are",
                             "--shard does not go with --job, whose script has a shard for each task");
    if (v->tasks.given && v->kind < 0)
        return message_usage(NULL, "--tasks goes with --job");
    return EXIT_DONE;
}

/* What runs the command in the script. */
static void print_program(void)
{
    char    path[4096];
    ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    path[length > 0 ? length : 0] = '\0';
    bool plain = length > 0 && !strpbrk(path, " \t\n'\"\\$`*?[]{}()<>|&;#~!");
    fputs(plain ? path : "limner", stdout);
}

static const char *const left_out[] = {"shard", "job", "tasks", "resume", "quiet", "verbose", NULL};

static void print_line(const command *c, const word_list *inputs, const void *values, const char *options)
{
    print_program();
    putchar(' ');
    options_print_line(c, inputs, values, left_out);
    printf(" --resume --quiet%s", options);
}

/* A worker that is killed ends with 128 and its signal, a task that ends so is not started again. With 75 it is, where
 * slurm.conf says RequeueExit=75, as often as RESTARTS: what kills it every time would go on for ever. */
static void print_slurm(const command *c, const word_list *inputs, const void *values, long tasks, const char *last)
{
    enum { RESTARTS = 5 };
    printf(
        "#!/bin/bash\n"
        "# %ld shards of one drawing. Submit with: sbatch FILE. Tasks whose worker is killed are queued again where\n"
        "# slurm.conf has RequeueExit=75; to draw what is missing by hand, submit it again.\n"
        "#SBATCH --job-name=limner-%s\n"
        "#SBATCH --array=1-%ld\n"
        "#SBATCH --ntasks=1\n"
        "#SBATCH --requeue\n"
        "#SBATCH --open-mode=append\n"
        "#SBATCH --output=limner-%s-%%a.log\n",
        tasks, c->name, tasks, c->name);
    print_line(c, inputs, values, "");
    printf(" --shard \"$SLURM_ARRAY_TASK_ID/%ld\"\n"
           "status=$?\n"
           "if [ $status -gt 128 ] && [ \"${SLURM_RESTART_COUNT:-0}\" -lt %d ]; then\n"
           "    exit 75\n"
           "fi\n"
           "exit $status\n",
           tasks, RESTARTS);
    if (last) {
        printf("# When all are done:\n# ");
        print_line(c, inputs, values, last);
        putchar('\n');
    }
}

/* --resume of GNU parallel would skip tasks that failed or were killed. */
static void print_parallel(const command *c, const word_list *inputs, const void *values, long tasks, const char *last)
{
    printf("seq %ld | parallel --will-cite --quote --joblog limner-%s.joblog --resume-failed ", tasks, c->name);
    print_line(c, inputs, values, "");
    printf(" --shard {}/%ld", tasks);
    if (last) {
        printf(" && ");
        print_line(c, inputs, values, last);
    }
    putchar('\n');
}

int job_print(const command *c, const word_list *inputs, const void *values, const job_values *v, const char *last)
{
    long tasks = v->tasks.given ? (long)v->tasks.value : TASKS_STANDARD;
    if (v->kind == JOB_SLURM)
        print_slurm(c, inputs, values, tasks, last);
    else
        print_parallel(c, inputs, values, tasks, last);
    return EXIT_DONE;
}
