/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* pipe2, memfd_create, fallocate */
#include "ffmpeg/child.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "posix/at_death.h"
#include "posix/error.h"

enum { MAX_CHILDREN = 4, NOT_FOUND = 127 };

/* processes to kill at death; atomic, 0: free */
static pid_t running[MAX_CHILDREN];

static void kill_all(void)
{
    const int saved = errno;

    for (int i = 0; i < MAX_CHILDREN; i++) {
        const pid_t pid = __atomic_load_n(&running[i], __ATOMIC_SEQ_CST);

        if (pid > 0)
            kill(pid, SIGKILL);
    }
    errno = saved;
}

static void replace(pid_t old, pid_t fresh)
{
    for (int i = 0; i < MAX_CHILDREN; i++) {
        pid_t expected = old;

        if (__atomic_compare_exchange_n(&running[i], &expected, fresh, 0,
                                        __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
            return;
    }
}

bool child_exists(const char *name)
{
    const char *path = getenv("PATH");
    char file[4096];

    for (; path && *path; path += strcspn(path, ":"), path += *path == ':') {
        const int n = (int)strcspn(path, ":");

        if (n > 0 &&
            (size_t)snprintf(file, sizeof file, "%.*s/%s", n, path, name) <
                sizeof file &&
            access(file, X_OK) == 0)
            return true;
    }
    return false;
}

/* ----------------------------------------------------------------- starting */

/* Runs ARGV in the child, with IN, OUT and SAID, unless that is -1, as its
 * streams. If it cannot be run, sends errno through FAILED. Makes system calls
 * only. */
static void become(const char *const *argv, int in, int out, int said,
                   int failed)
{
    sigset_t none;
    int number;

    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
        (said < 0 || dup2(said, STDERR_FILENO) >= 0))
        execvp(argv[0], (char *const *)argv);
    number = errno;
    if (write(failed, &number, sizeof number) < 0)
        _exit(NOT_FOUND);
    _exit(NOT_FOUND);
}

/* Returns the errno that kept the child from running, or 0. */
static int read_failure(int fd)
{
    int number = 0;
    ssize_t n;

    do
        n = read(fd, &number, sizeof number);
    while (n < 0 && errno == EINTR);
    return n == (ssize_t)sizeof number ? number : 0;
}

/* Opens two pipes, DATA and FAILED, whose ends are closed by exec. */
static bool open_pipes(int data[2], int failed[2])
{
    if (pipe2(data, O_CLOEXEC) < 0)
        return false;
    if (pipe2(failed, O_CLOEXEC) == 0)
        return true;
    close(data[0]);
    close(data[1]);
    return false;
}

static enum glint_status refuse(const char *name, int number,
                                struct glint_error *error)
{
    return glint_error_report(
        error, number == ENOENT ? GLINT_E_UNSUPPORTED : GLINT_E_IO, name, "%s",
        number == ENOENT ? "is not installed" : strerror(number));
}

static enum glint_status start(struct child *child, const char *const *argv,
                               enum child_pipe kind, struct glint_error *error)
{
    const int mine = kind == CHILD_READS ? 1 : 0;
    int data[2], failed[2], number;
    const int null = open("/dev/null", O_RDWR | O_CLOEXEC);

    glint_at_death(kill_all);
    if (null < 0 || !open_pipes(data, failed)) {
        number = errno;
        if (null >= 0)
            close(null);
        return refuse(argv[0], number, error);
    }
    child->pid = fork();
    if (child->pid == 0)
        become(argv, mine == 0 ? null : data[0], mine == 0 ? data[1] : null,
               kind == CHILD_PRINTS ? data[1] : child->said, failed[1]);
    number = errno;
    close(null);
    close(data[1 - mine]);
    close(failed[1]);
    if (child->pid > 0) {
        replace(0, child->pid);
        number = read_failure(failed[0]);
    }
    close(failed[0]);
    child->fd = data[mine];
    if (child->pid > 0 && number == 0)
        return GLINT_OK;
    if (child->pid < 0)
        child->pid = 0;
    child_end(child);
    return refuse(argv[0], number, error);
}

enum glint_status child_start(struct child *child, const char *const *argv,
                              enum child_pipe kind, struct glint_error *error)
{
    *child = CHILD_NONE;
    return start(child, argv, kind, error);
}

enum glint_status child_start_heard(struct child *child,
                                    const char *const *argv,
                                    enum child_pipe kind,
                                    const char *const *words,
                                    struct glint_error *error)
{
    enum glint_status status;

    *child = CHILD_NONE;
    child->listening = words;
    /* A file, not a pipe: nobody has to read it for the child to go on. */
    child->said = memfd_create("said", MFD_CLOEXEC);
    if (child->said >= 0)
        fcntl(child->said, F_SETFL, O_APPEND);
    status = start(child, argv, kind, error);
    if (status != GLINT_OK)
        child_kill(child);
    return status;
}

/* ------------------------------------------------------------------ hearing */

/* Passes on whole lines, or if ALL what is left. */
static void pass_on(struct child *child, bool all)
{
    char text[4096];
    ssize_t n;

    while (child->said >= 0 &&
           (n = pread(child->said, text, sizeof text - 1, child->told)) > 0) {
        const char *const end = memrchr(text, '\n', (size_t)n);

        if (end)
            n = end - text + 1;
        else if (!all && n < (ssize_t)sizeof text - 1)
            return;
        text[n] = '\0';
        for (int i = 0; child->listening[i]; i++)
            child->heard |= strstr(text, child->listening[i]) != NULL;
        fwrite(text, 1, (size_t)n, stderr);
        child->told += n;
        /* Its memory is given back; where that cannot be, it stays. */
        (void)fallocate(child->said, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
                        0, child->told);
    }
}

void child_hear(struct child *child)
{
    pass_on(child, false);
}

static void end_hearing(struct child *child)
{
    pass_on(child, true);
    if (child->said >= 0)
        close(child->said);
    child->said = -1;
}

/* ------------------------------------------------------------------- ending */

int child_end(struct child *child)
{
    int status = 0;
    pid_t pid;

    if (child->fd >= 0)
        close(child->fd);
    child->fd = -1;
    if (child->pid <= 0) {
        end_hearing(child);
        return 0;
    }
    do
        pid = waitpid(child->pid, &status, 0);
    while (pid < 0 && errno == EINTR);
    replace(child->pid, 0);
    child->pid = 0;
    end_hearing(child);
    if (pid < 0)
        return NOT_FOUND;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void child_kill(struct child *child)
{
    if (child->pid > 0)
        kill(child->pid, SIGKILL);
    child_end(child);
}
