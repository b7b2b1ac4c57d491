/* SPDX-License-Identifier: MIT
 *
 * A library for LD_PRELOAD that makes allocation number $FAIL_AT of a program
 * fail; if $FAIL_ON is set, all later allocations fail, too. If $FAIL_SIGNAL is
 * set, the allocation succeeds, and the library raises this signal number
 * before it. At exit, the library writes the number of allocations to the file
 * $FAIL_COUNT, if that is set. The library needs glibc; allocations inside
 * glibc are counted as well.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t n, size_t bytes);
void *__libc_realloc(void *old, size_t bytes);
void *__libc_memalign(size_t align, size_t bytes);

static long n, fail_at;
static bool fails_on;
static int fail_signal; /* 0: none */

__attribute__((constructor)) static void read_environment(void)
{
    const char *at = getenv("FAIL_AT");

    fail_at = at ? strtol(at, NULL, 10) : 0;
    fails_on = getenv("FAIL_ON") != NULL;
    at = getenv("FAIL_SIGNAL");
    fail_signal = at ? atoi(at) : 0;
    __atomic_store_n(&n, 0, __ATOMIC_SEQ_CST);
}

__attribute__((destructor)) static void end(void)
{
    const char *const name = getenv("FAIL_COUNT");
    const long count = __atomic_load_n(&n, __ATOMIC_SEQ_CST);
    FILE *const file = name ? fopen(name, "w") : NULL;

    if (file) {
        fprintf(file, "%ld\n", count);
        fclose(file);
    }
}

static bool must_fail_this_allocation(void)
{
    const long k = __atomic_add_fetch(&n, 1, __ATOMIC_SEQ_CST);

    if (fail_at < 1 || !(k == fail_at || (fails_on && k > fail_at)))
        return false;
    if (fail_signal) {
        kill(getpid(), fail_signal);
        return false;
    }
    errno = ENOMEM;
    return true;
}

void *malloc(size_t bytes)
{
    return must_fail_this_allocation() ? NULL : __libc_malloc(bytes);
}

void *calloc(size_t count, size_t bytes)
{
    return must_fail_this_allocation() ? NULL : __libc_calloc(count, bytes);
}

void *realloc(void *old, size_t bytes)
{
    return must_fail_this_allocation() ? NULL : __libc_realloc(old, bytes);
}

int posix_memalign(void **mem, size_t align, size_t bytes)
{
    void *const got =
        must_fail_this_allocation() ? NULL : __libc_memalign(align, bytes);

    if (!got)
        return ENOMEM;
    *mem = got;
    return 0;
}
