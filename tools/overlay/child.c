/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* pipe2 */
#include "overlay/child.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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

/* Runs ARGV in the child, with IN and OUT as its streams. If it cannot be run,
 * sends errno through FAILED. Makes system calls only. */
static void become(const char *const *argv, int in, int out, int failed)
{
    sigset_t none;
    int number;

    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0)
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

enum glint_status child_start(struct child *child, const char *const *argv,
                              enum child_pipe kind, struct glint_error *error)
{
    const int mine = kind == CHILD_WRITES ? 0 : 1;
    int data[2], failed[2], number;
    const int null = open("/dev/null", O_RDWR | O_CLOEXEC);

    *child = (struct child){0, -1};
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
               failed[1]);
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

/* ------------------------------------------------------------------- ending */

int child_end(struct child *child)
{
    int status = 0;
    pid_t pid;

    if (child->fd >= 0)
        close(child->fd);
    child->fd = -1;
    if (child->pid <= 0)
        return 0;
    do
        pid = waitpid(child->pid, &status, 0);
    while (pid < 0 && errno == EINTR);
    replace(child->pid, 0);
    child->pid = 0;
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
