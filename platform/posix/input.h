/* SPDX-License-Identifier: MIT
 *
 * posix/input.h - reading files and pipes, whatever interrupts.
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
    const char *name; /* name for errors; kept */
};

/* Opens PATH, which is kept. GLINT_E_IO: it cannot be opened. */
enum glint_status glint_input_open(struct glint_input *in, const char *path,
                                   struct glint_error *error);

/* One read: what is there now, at most BYTES (>= 1). Returns how many bytes
 * came, 0 at the end, -1 with errno set. */
ptrdiff_t glint_input_some(struct glint_input *in, void *dst, size_t bytes);

/* Reads all that is left behind the *BYTES bytes at *DATA, a malloc'ed block
 * (or NULL and 0) that may move and still belongs to the caller when this
 * fails. GLINT_E_UNSUPPORTED: *BYTES would exceed MAX. GLINT_E_IO, _MEMORY. */
enum glint_status glint_input_append(struct glint_input *in, uint8_t **data,
                                     size_t *bytes, size_t max,
                                     struct glint_error *error);

/* Does nothing when closed already. */
void glint_input_close(struct glint_input *in);

/* The whole of PATH as one malloc'ed block for the caller to free; never NULL,
 * even of an empty file. Errors as above. */
enum glint_status glint_input_slurp(uint8_t **data, size_t *bytes,
                                    const char *path, size_t max,
                                    struct glint_error *error);

#endif
