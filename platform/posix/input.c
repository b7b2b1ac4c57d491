/* SPDX-License-Identifier: MIT */
#include "posix/input.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "posix/error.h"

/* first allocation, bytes, if the size of the input is unknown */
#define FIRST_BYTES 65536

static enum glint_status open_with_flags(struct glint_input *in,
                                         const char *path, int flags,
                                         struct glint_error *error)
{
    const int is_stdin = !strcmp(path, "-");

    in->name = is_stdin ? "standard input" : path;
    if (is_stdin)
        in->fd = dup(STDIN_FILENO);
    else
        in->fd = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | flags);
    if (in->fd < 0)
        return glint_error_report_errno(error, GLINT_E_IO, in->name, errno);
    if (is_stdin && isatty(in->fd)) {
        glint_input_close(in);
        return glint_error_report(error, GLINT_E_IO, in->name,
                                  "is a terminal; pipe a file into it");
    }
    return GLINT_OK;
}

enum glint_status glint_input_open(struct glint_input *in, const char *path,
                                   struct glint_error *error)
{
    return open_with_flags(in, path, 0, error);
}

/* Returns the reason why glint does not accept PATH, with the stat data ST, as
 * a file; NULL if glint accepts it. */
static const char *get_rejection_reason(const char *path, const struct stat *st)
{
    struct stat null;

    if (S_ISFIFO(st->st_mode))
        return strncmp(path, "/dev/fd/", 8) == 0 ||
                       strcmp(path, "/dev/stdin") == 0 ||
                       strncmp(path, "/proc/", 6) == 0
                   ? NULL
                   : "is a FIFO, not a file";
    if (!S_ISCHR(st->st_mode) && !S_ISBLK(st->st_mode))
        return NULL;
    return stat("/dev/null", &null) == 0 && S_ISCHR(null.st_mode) &&
                   st->st_rdev == null.st_rdev
               ? NULL
               : "is a device, not a file";
}

enum glint_status glint_input_open_file(struct glint_input *in,
                                        const char *path,
                                        struct glint_error *error)
{
    struct stat st;
    const char *cause;
    /* With O_NONBLOCK, opening a FIFO does not wait for a writer. */
    enum glint_status status = open_with_flags(in, path, O_NONBLOCK, error);

    if (status != GLINT_OK || !strcmp(path, "-"))
        return status;
    cause = fstat(in->fd, &st) < 0 ? strerror(errno)
                                   : get_rejection_reason(path, &st);
    if (!cause)
        return GLINT_OK;
    glint_input_close(in);
    return glint_error_report(error, GLINT_E_IO, in->name, "%s", cause);
}

/* Returns whether a failed read should be repeated. If the read would have
 * blocked, waits until FD is readable. */
static int is_read_retryable(int fd)
{
    struct pollfd readable = {.fd = fd, .events = POLLIN};

    if (errno == EAGAIN || errno == EWOULDBLOCK)
        return poll(&readable, 1, -1) >= 0 || errno == EINTR;
    return errno == EINTR;
}

ptrdiff_t glint_input_read_available(struct glint_input *in, void *dst,
                                     size_t bytes)
{
    ssize_t n;

    do
        n = read(in->fd, dst, bytes);
    while (n < 0 && is_read_retryable(in->fd));
    return n;
}

/* Returns the bytes of the first allocation: FIRST_BYTES, or the size of a
 * regular file, at most MAX, plus one, so that its end is detected without a
 * larger block. */
static size_t estimate_input_bytes(const struct glint_input *in, size_t max)
{
    struct stat st;

    if (fstat(in->fd, &st) < 0 || !S_ISREG(st.st_mode) || st.st_size < 0)
        return FIRST_BYTES;
    return (uintmax_t)st.st_size < max ? (size_t)st.st_size + 1 : max + 1;
}

static enum glint_status grow_buffer(struct glint_input *in, uint8_t **data,
                                     size_t size, struct glint_error *error)
{
    uint8_t *const moved = realloc(*data, size);

    if (!moved)
        return glint_error_report(error, GLINT_E_MEMORY, in->name,
                                  "no memory for %zu bytes", size);
    *data = moved;
    return GLINT_OK;
}

enum glint_status glint_input_read_rest(struct glint_input *in, uint8_t **data,
                                        size_t *bytes, size_t max,
                                        struct glint_error *error)
{
    size_t size = *bytes + estimate_input_bytes(in, max);
    ptrdiff_t n;

    if (grow_buffer(in, data, size, error))
        return GLINT_E_MEMORY;
    while ((n = glint_input_read_available(in, *data + *bytes, size - *bytes)) >
           0) {
        *bytes += (size_t)n;
        if (*bytes > max)
            return glint_error_report(error, GLINT_E_UNSUPPORTED, in->name,
                                      "larger than %zu bytes", max);
        if (*bytes < size)
            continue;
        size += size / 2 + FIRST_BYTES;
        if (grow_buffer(in, data, size, error))
            return GLINT_E_MEMORY;
    }
    if (n < 0)
        return glint_error_report(error, GLINT_E_IO, in->name, "%s",
                                  strerror(errno));
    return GLINT_OK;
}

void glint_input_close(struct glint_input *in)
{
    if (in->fd >= 0)
        close(in->fd);
    in->fd = -1;
}

enum glint_status glint_input_read_whole_file(uint8_t **data, size_t *bytes,
                                              const char *path, size_t max,
                                              struct glint_error *error)
{
    uint8_t *block = NULL;
    size_t n = 0;
    struct glint_input in;
    enum glint_status status = glint_input_open_file(&in, path, error);

    if (status)
        return status;
    status = glint_input_read_rest(&in, &block, &n, max, error);
    glint_input_close(&in);
    if (status) {
        free(block);
        return status;
    }
    *data = block;
    *bytes = n;
    return GLINT_OK;
}
