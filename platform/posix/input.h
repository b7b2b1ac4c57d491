/* SPDX-License-Identifier: MIT
 *
 * posix/input.h - reads files and pipes; repeats reads that signals interrupt.
 *
 *     glint_input_open(&in, "x.ppm", &error); "-" is standard input
 *     glint_input_read_rest(&in, &data, &bytes, max, &error);
 *     glint_input_close(&in);
 *
 * Reads wait also on non-blocking descriptors. A terminal is rejected as
 * standard input, as nobody types a picture. */
#ifndef GLINT_PLATFORM_POSIX_INPUT_H
#define GLINT_PLATFORM_POSIX_INPUT_H

#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

struct glint_input {
    int fd;           /* -1: closed */
    const char *name; /* name for errors; not owned */
};

/* Opens PATH as a stream: a file, a device or a FIFO, whose writer it waits
 * for. PATH must outlive IN. Returns GLINT_E_IO if PATH cannot be opened,
 * GLINT_E_MEMORY if the system has no free descriptor. */
enum glint_status glint_input_open(struct glint_input *in, const char *path,
                                   struct glint_error *error);

/* Like glint_input_open(), but accepts only input that has an end: a regular
 * file, "-", /dev/null, or a pipe that is already open (/dev/fd/N). Never waits
 * for a writer. Returns GLINT_E_IO if PATH is a FIFO or another device. */
enum glint_status glint_input_open_file(struct glint_input *in,
                                        const char *path,
                                        struct glint_error *error);

/* Reads the bytes that are available now, at most BYTES (>= 1), or waits for
 * the first byte. Returns the number of bytes read, 0 at the end, or -1 with
 * errno set. */
ptrdiff_t glint_input_read_available(struct glint_input *in, void *dst,
                                     size_t bytes);

/* Reads the rest of IN and appends it to the *BYTES bytes at *DATA, a malloc'ed
 * block (or NULL and 0). The block may move; the caller frees it, also on
 * failure. Returns GLINT_E_UNSUPPORTED if *BYTES would exceed MAX, GLINT_E_IO
 * or GLINT_E_MEMORY. */
enum glint_status glint_input_read_rest(struct glint_input *in, uint8_t **data,
                                        size_t *bytes, size_t max,
                                        struct glint_error *error);

/* Closes IN, unless it is closed already. */
void glint_input_close(struct glint_input *in);

/* Reads all of PATH, opened as by glint_input_open_file(), into a block that
 * the caller frees; *DATA is not NULL even for an empty file. Returns the
 * errors of glint_input_open_file() and glint_input_read_rest(). */
enum glint_status glint_input_read_whole_file(uint8_t **data, size_t *bytes,
                                              const char *path, size_t max,
                                              struct glint_error *error);

#endif
