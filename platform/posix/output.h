/* SPDX-License-Identifier: MIT
 *
 * posix/output.h - output files that are whole or not there.
 *
 *     glint_output_open(&out, "x.ppm", GLINT_OUTPUT_BINARY, &error);
 *     glint_output_write(&out, data, bytes, &error);       any number of times
 *     glint_output_commit(&out, &error);                   or
 * glint_output_abort
 *
 * Bytes go to a temporary file in the directory of the target, named
 * .glint-PID-N.EXT, which commit renames over the target. Until then an older
 * target is untouched; after an error, an abort, exit(), or death by a signal
 * other than SIGKILL nothing is left, and what a killed run has left is removed
 * by the next that writes into the same folder. Symbolic links are followed,
 * dangling ones, too, and a file that is replaced hands its permission bits on.
 * There is no fsync: what is promised holds when the process dies, not when the
 * power goes.
 *
 * "-" is standard output. It and any target that exists and is no regular file
 * (a FIFO, /dev/null) are written straight into; what went there stays.
 *
 * The first open changes how the process takes signals, as posix/at_death.h
 * says. An application that handles deadly ones itself must abort or commit
 * what it has open, or exit().
 */
#ifndef GLINT_PLATFORM_POSIX_OUTPUT_H
#define GLINT_PLATFORM_POSIX_OUTPUT_H

#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

enum glint_output_kind {
    GLINT_OUTPUT_TEXT,
    GLINT_OUTPUT_BINARY /* refused on a terminal */
};

struct glint_output {
    int fd;           /* -1: closed */
    const char *name; /* name for errors; kept */
    char *target;     /* file that commit replaces; NULL: it is written straight
                         into */
    char *tmp;        /* the file being written; NULL: straight */
    uint8_t *buffer;  /* small writes gather here */
    size_t used;      /* bytes of it */
    int failed;       /* errno of the first write that failed, or 0 */
};

/* Opens PATH, which is kept. On failure OUT is closed.
 * GLINT_E_OUTPUT: it cannot be written; GLINT_E_MEMORY. */
enum glint_status glint_output_open(struct glint_output *out, const char *path,
                                    enum glint_output_kind kind,
                                    struct glint_error *error);

/* Checks whether a file can be created at PATH, before there is work for it;
 * leaves nothing. A file that is written straight into is not touched, and is
 * fine. GLINT_E_OUTPUT: it cannot; GLINT_E_MEMORY. */
enum glint_status glint_output_check(const char *path,
                                     struct glint_error *error);

/* Writes all of DATA[BYTES], or fails; once failed, it keeps failing.
 * GLINT_E_CLOSED: the reader of a pipe went away. GLINT_E_OUTPUT: the rest. */
enum glint_status glint_output_write(struct glint_output *out, const void *data,
                                     size_t bytes, struct glint_error *error);

/* Passes on what small writes left in the buffer. For pipes, where somebody
 * waits; commit does it too. */
enum glint_status glint_output_flush(struct glint_output *out,
                                     struct glint_error *error);

/* Closes OUT and puts it in place. On failure it is aborted. */
enum glint_status glint_output_commit(struct glint_output *out,
                                      struct glint_error *error);

/* Writes DATA[BYTES] and commits, or aborts. */
enum glint_status glint_output_finish(struct glint_output *out,
                                      const void *data, size_t bytes,
                                      struct glint_error *error);

/* Closes OUT and removes the temporary file. Does nothing when closed. */
void glint_output_abort(struct glint_output *out);

#endif
