/* What the child may still ask of the kernel. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "fence/fence_private.h"

#ifdef LIMNER_HAVE_SECCOMP
#include <errno.h>
#include <seccomp.h>

/* Memory, answering, the clock, and how a process ends. What is not here fails with an error, as do descriptors of
 * files: none is open. */
static bool forbid_the_rest(bool prepared)
{
    /* Of files that are open already. */
    static const int reading[] = {SCMP_SYS(pread64), SCMP_SYS(fcntl)};
    static const int allowed[] = {
        SCMP_SYS(read),         SCMP_SYS(readv),
        SCMP_SYS(write),        SCMP_SYS(writev),
        SCMP_SYS(sendto),       SCMP_SYS(recvfrom),
        SCMP_SYS(close),        SCMP_SYS(lseek),
        SCMP_SYS(fstat),        SCMP_SYS(mmap),
        SCMP_SYS(munmap),       SCMP_SYS(mremap),
        SCMP_SYS(mprotect),     SCMP_SYS(madvise),
        SCMP_SYS(brk),          SCMP_SYS(futex),
        SCMP_SYS(exit),         SCMP_SYS(exit_group),
        SCMP_SYS(rt_sigreturn), SCMP_SYS(rt_sigprocmask),
        SCMP_SYS(rt_sigaction), SCMP_SYS(sigaltstack),
        SCMP_SYS(getpid),       SCMP_SYS(gettid),
        SCMP_SYS(getrusage),    SCMP_SYS(clock_gettime),
        SCMP_SYS(gettimeofday), SCMP_SYS(getrandom),
        SCMP_SYS(sched_yield),  SCMP_SYS(sched_getaffinity),
        SCMP_SYS(sysinfo),      SCMP_SYS(restart_syscall),
#ifdef FENCE_SANITIZED /* looks through a pipe whether memory can be read */
        SCMP_SYS(pipe),         SCMP_SYS(pipe2),
#endif
    };
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
    bool            good = filter != NULL;
    for (size_t i = 0; good && i < sizeof allowed / sizeof *allowed; i++)
        good = seccomp_rule_add(filter, SCMP_ACT_ALLOW, allowed[i], 0) == 0;
    for (size_t i = 0; good && prepared && i < sizeof reading / sizeof *reading; i++)
        good = seccomp_rule_add(filter, SCMP_ACT_ALLOW, reading[i], 0) == 0;
    /* What fstat has become. */
    good = good && (!prepared || seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(newfstatat), 1,
                                                  SCMP_A3(SCMP_CMP_EQ, (scmp_datum_t)AT_EMPTY_PATH)) == 0);
    /* Aborting is a signal to oneself; others get none. */
    good = good && seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1,
                                    SCMP_A0(SCMP_CMP_EQ, (scmp_datum_t)getpid())) == 0;
    good = good && seccomp_load(filter) == 0;
    seccomp_release(filter);
    return good;
}
#else
static bool forbid_the_rest(bool prepared)
{
    (void)prepared;
    return true;
}
#endif

const char *fence_kind(void)
{
#ifdef LIMNER_HAVE_SECCOMP
    return "seccomp and limits";
#else
    return "limits";
#endif
}

static void limit(__rlimit_resource_t what, rlim_t value)
{
    struct rlimit r = {value, value};
    setrlimit(what, &r);
}

/* Signals go back to what ends a process: the host's handlers are not meant for this copy. */
static void reset_signals(void)
{
    for (int i = 1; i < NSIG; i++)
        signal(i, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
}

bool fence_lock(int channel, size_t address_space, fence_prepare prepare)
{
    reset_signals();
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    prctl(PR_SET_DUMPABLE, 0);
    /* First, for it may be one of the three that follow, in a process that has closed them. */
    if (channel != FENCE_CHANNEL && dup2(channel, FENCE_CHANNEL) < 0)
        return false;
    int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere < 0)
        return false;
    dup2(nowhere, STDIN_FILENO);
    dup2(nowhere, STDOUT_FILENO);
#ifndef FENCE_SANITIZED /* whose findings are to be seen */
    dup2(nowhere, STDERR_FILENO);
#endif
    if (close_range(FENCE_CHANNEL + 1, ~0u, 0) != 0)
        for (int i = FENCE_CHANNEL + 1; i < 65536; i++)
            close(i);
    if (prepare)
        prepare();
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_FSIZE, 0);
#ifndef FENCE_SANITIZED
    limit(RLIMIT_NOFILE, FENCE_CHANNEL + 1);
#endif
    if (address_space)
        limit(RLIMIT_AS, address_space);
    return forbid_the_rest(prepare != NULL);
}
