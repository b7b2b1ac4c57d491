/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* for secure_getenv */
#include "posix/process.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

void glint_process_hold_streams(void)
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (fcntl(fd, F_GETFD) < 0 && errno == EBADF &&
            open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY) != fd)
            _exit(1); /* No stream is open to report the cause. */
}

const char *glint_process_setting(const char *name)
{
    return secure_getenv(name);
}

/* Reads /proc/self/maps, as dladdr() returns the path passed to dlopen(),
 * which may be relative to an earlier working directory, and argv[0] for a
 * program. */
bool glint_process_own_file(char *path, size_t bytes)
{
    static const char own = 0;
    const uintptr_t at = (uintptr_t)&own;
    FILE *const maps = fopen("/proc/self/maps", "re");
    char line[4096 + 128], *file = NULL;
    size_t n = 0;

    while (maps && !file && fgets(line, sizeof line, maps)) {
        char *rest; /* A line begins with "BEGIN-END ", two hexadecimal
                       addresses. */
        const uintmax_t begin = strtoumax(line, &rest, 16);
        const uintmax_t end = *rest == '-' ? strtoumax(rest + 1, &rest, 16) : 0;

        if (begin <= at && at < end)
            file = strchr(rest, '/');
    }
    if (file) {
        n = strcspn(file, "\n");
        if (n < bytes) {
            memcpy(path, file, n);
            path[n] = '\0';
        }
    }
    if (maps)
        fclose(maps);
    return n > 0 && n < bytes;
}

struct call {
    int (*fn)(void *ctx);
    void *ctx;
    int result;
    sigset_t signals; /* signal mask of the thread that called */
};

static void *do_call(void *arg)
{
    struct call *const c = arg;

    pthread_sigmask(SIG_SETMASK, &c->signals, NULL);
    c->result = c->fn(c->ctx);
    return NULL;
}

/* Runs C in a thread with a stack of BYTES; signals go to that thread
 * meanwhile. Returns false if the thread cannot be created. */
static bool call_in_thread(size_t bytes, struct call *c)
{
    pthread_attr_t attr;
    pthread_t thread;
    sigset_t all;
    bool started;

    if (pthread_attr_init(&attr))
        return false;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &c->signals);
    started = !pthread_attr_setstacksize(&attr, bytes) &&
              !pthread_create(&thread, &attr, do_call, c);
    if (started)
        pthread_join(thread, NULL);
    pthread_sigmask(SIG_SETMASK, &c->signals, NULL);
    pthread_attr_destroy(&attr);
    return started;
}

int glint_process_on_stack(size_t bytes, int (*fn)(void *ctx), void *ctx)
{
    struct call c = {.fn = fn, .ctx = ctx};
    struct rlimit stack;

    if (getrlimit(RLIMIT_STACK, &stack) < 0 ||
        stack.rlim_cur == RLIM_INFINITY || stack.rlim_cur >= bytes ||
        !call_in_thread(bytes, &c))
        return fn(ctx);
    return c.result;
}
