/* SPDX-License-Identifier: MIT
 *
 * posix/input.h - reading files and pipes, through interruptions.
 *
 *     glint_input_open(&in, "x.ppm", &error);         "-" is standard input
 *     glint_input_append(&in, &data, &bytes, max, &error);
 *     glint_input_close(&in);
 *
 * Reads are repeated after signals and wait on descriptors that do not block.
 * A terminal is refused as standard input: nobody types a picture.
 */
#ifndef GLINT_PLATFORM_POSIX_INPUT_H
#define GLINT_PLATFORM_POSIX_INPUT_H

#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

struct glint_input {
    int fd;           /* -1: closed */
    const char *name; /* name for errors; not owned */
};

/* Opens PATH, which must outlive IN, as a stream: a file, a device or a FIFO,
 * whose writer it waits for. GLINT_E_IO: it cannot be opened. GLINT_E_MEMORY:
 * the system gives no descriptor. */
enum glint_status glint_input_open(struct glint_input *in, const char *path,
                                   struct glint_error *error);

/* Like glint_input_open(), of input that ends: a regular file, "-", /dev/null,
 * or a pipe that is open already (/dev/fd/N). Never waits for a writer.
 * GLINT_E_IO: PATH is a FIFO or another device. */
enum glint_status glint_input_open_file(struct glint_input *in,
                                        const char *path,
                                        struct glint_error *error);

/* Reads what is there now, at most BYTES (>= 1), and waits if there is nothing
 * yet. Returns how many bytes came, 0 at the end, -1 with errno set. */
ptrdiff_t glint_input_some(struct glint_input *in, void *dst, size_t bytes);

/* Reads all that is left of IN and appends it to the *BYTES bytes at *DATA, a
 * malloc'ed block (or NULL and 0). The block may move, and belongs to the
 * caller also on failure. GLINT_E_UNSUPPORTED: *BYTES would exceed MAX.
 * GLINT_E_IO, GLINT_E_MEMORY. */
enum glint_status glint_input_append(struct glint_input *in, uint8_t **data,
                                     size_t *bytes, size_t max,
                                     struct glint_error *error);

/* Closes IN, unless it is closed already. */
void glint_input_close(struct glint_input *in);

/* Reads all of PATH, as glint_input_open_file() opens it, into a malloc'ed
 * block, which the caller frees; it is not NULL even for an empty file. Errors
 * are those of the functions above. */
enum glint_status glint_input_slurp(uint8_t **data, size_t *bytes,
                                    const char *path, size_t max,
                                    struct glint_error *error);

#endif
