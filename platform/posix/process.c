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

void glint_process_open_closed_streams(void)
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++)
        if (fcntl(fd, F_GETFD) < 0 && errno == EBADF &&
            open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY) != fd)
            /* The cause cannot be printed because no stream is open. */
            _exit(1);
}

const char *glint_process_get_setting(const char *name)
{
    return secure_getenv(name);
}

/* Returns the file name in LINE of /proc/self/maps if the line's address range
 * contains AT; else NULL. A line is "BEGIN-END ... FILE"; BEGIN and END are
 * hexadecimal addresses. */
static const char *find_mapped_file(const char *line, uintptr_t at)
{
    char *rest;
    const uintmax_t begin = strtoumax(line, &rest, 16);
    const uintmax_t end = *rest == '-' ? strtoumax(rest + 1, &rest, 16) : 0;

    return begin <= at && at < end ? strchr(rest, '/') : NULL;
}

/* Reads /proc/self/maps instead of calling dladdr(). For a library, dladdr()
 * returns the path passed to dlopen(), which may be relative to an earlier
 * working directory; for a program, it returns argv[0]. Allocates no memory: if
 * an allocation failed, a file that exists would be reported as missing. */
bool glint_process_find_own_file(char *path, size_t bytes)
{
    static const char own = 0;
    const int maps = open("/proc/self/maps", O_RDONLY | O_CLOEXEC);
    char text[2 * (4096 + 128)];
    const char *file = NULL;
    size_t n = 0, length = 0;
    ssize_t got;

    while (maps >= 0 && !file &&
           (got = read(maps, text + n, sizeof text - 1 - n)) > 0) {
        char *line = text, *end;

        n += (size_t)got;
        text[n] = '\0';
        for (; !file && (end = strchr(line, '\n')); line = end + 1) {
            *end = '\0';
            file = find_mapped_file(line, (uintptr_t)&own);
        }
        if (!file) {
            n -= (size_t)(line - text);
            memmove(text, line, n);
        }
    }
    if (maps >= 0)
        close(maps);
    length = file ? strlen(file) : 0;
    if (length > 0 && length < bytes)
        memcpy(path, file, length + 1);
    return length > 0 && length < bytes;
}

struct call {
    int (*fn)(void *ctx);
    void *ctx;
    int result;
    sigset_t signals; /* signal mask of the calling thread */
};

static void *run_call_in_thread(void *arg)
{
    struct call *const c = arg;

    pthread_sigmask(SIG_SETMASK, &c->signals, NULL);
    c->result = c->fn(c->ctx);
    return NULL;
}

/* Runs C in a thread with a stack of BYTES; that thread receives all signals
 * meanwhile. Returns false if the thread cannot be created. */
static bool run_call_in_new_thread(size_t bytes, struct call *c)
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
              !pthread_create(&thread, &attr, run_call_in_thread, c);
    if (started)
        pthread_join(thread, NULL);
    pthread_sigmask(SIG_SETMASK, &c->signals, NULL);
    pthread_attr_destroy(&attr);
    return started;
}

int glint_process_run_with_stack(size_t bytes, int (*fn)(void *ctx), void *ctx)
{
    struct call c = {.fn = fn, .ctx = ctx};
    struct rlimit stack;

    if (getrlimit(RLIMIT_STACK, &stack) < 0 ||
        stack.rlim_cur == RLIM_INFINITY || stack.rlim_cur >= bytes ||
        !run_call_in_new_thread(bytes, &c))
        return fn(ctx);
    return c.result;
}
