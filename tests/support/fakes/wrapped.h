/* SPDX-License-Identifier: MIT
 *
 * Functions that tests replace or make fail: the linker redirects calls of
 * NAME() to __wrap_NAME(), and __real_NAME() is the original (--wrap, in
 * tools/make/check.mk).
 */
#ifndef GLINT_SUPPORT_WRAPPED_H
#define GLINT_SUPPORT_WRAPPED_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/stat.h>
#include <sys/types.h>

int __real_ioctl(int fd, unsigned long request, ...);
int __wrap_ioctl(int fd, unsigned long request, ...);
int __real_open64(const char *path, int flags, ...);
int __wrap_open64(const char *path, int flags, ...);
int __real_close(int fd);
int __wrap_close(int fd);

void *__real_mmap64(void *at, size_t bytes, int how, int flags, int fd,
                    off_t offset);
void *__wrap_mmap64(void *at, size_t bytes, int how, int flags, int fd,
                    off_t offset);
int __real_munmap(void *at, size_t bytes);
int __wrap_munmap(void *at, size_t bytes);

void *__real_malloc(size_t bytes);
void *__wrap_malloc(size_t bytes);
void *__real_calloc(size_t n, size_t bytes);
void *__wrap_calloc(size_t n, size_t bytes);
void *__real_realloc(void *old, size_t bytes);
void *__wrap_realloc(void *old, size_t bytes);
int __real_posix_memalign(void **mem, size_t align, size_t bytes);
int __wrap_posix_memalign(void **mem, size_t align, size_t bytes);

/* Returns whether FD is open on the file PATH. */
static inline bool wrapped_is_file(int fd, const char *path)
{
    struct stat a, b;

    return fstat(fd, &a) == 0 && stat(path, &b) == 0 && a.st_ino == b.st_ino;
}

#endif
