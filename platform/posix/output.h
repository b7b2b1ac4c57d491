/* SPDX-License-Identifier: MIT
 *
 * posix/output.h - output files that appear whole or not at all.
 *
 *     glint_output_open(&out, "x.ppm", GLINT_OUTPUT_BINARY, &error);
 *     glint_output_write(&out, data, bytes, &error);       any number of times
 *     glint_output_commit(&out, &error);                   or abort
 *
 * Bytes go to a temporary file in the directory of the target, named
 * .glint-PID-N.EXT, which commit renames over the target. Until then an older
 * target is untouched. An error, an abort, exit(), or death by a signal other
 * than SIGKILL leaves no temporary file; one that SIGKILL leaves is removed by
 * the next run that writes into the same folder. Symbolic links are followed,
 * dangling ones, too, and the new file gets the permission bits of the one it
 * replaces. There is no fsync: files are whole when the process dies, but not
 * when the power fails.
 *
 * "-" is standard output. It and any target that exists and is not a regular
 * file (a FIFO, /dev/null) are written directly; bytes written there stay.
 *
 * The first open changes how the process takes signals, as posix/at_death.h
 * says. An application that handles deadly signals itself must abort or commit
 * its open outputs, or call exit().
 */
#ifndef GLINT_PLATFORM_POSIX_OUTPUT_H
#define GLINT_PLATFORM_POSIX_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "glint/status.h"

enum glint_output_kind {
    GLINT_OUTPUT_TEXT,
    GLINT_OUTPUT_BINARY /* refused on a terminal */
};

struct glint_output {
    int fd;           /* -1: closed */
    const char *name; /* name for errors; not owned */
    char *target;     /* file that commit replaces, or NULL */
    char *tmp;        /* temporary file that is written instead, or NULL */
    uint8_t *buffer;  /* Small writes are gathered here. */
    size_t used;      /* bytes in buffer */
    int failed;       /* errno of the first write that failed, or 0 */
};

/* Returns whether INPUT and OUTPUT are the same regular file; "-" is the
 * standard stream. */
bool glint_target_is_input(const char *input, const char *output);

/* Returns whether A and B, which need not be there, name one place: the same
 * name in the same folder. What is there and no regular file, as /dev/null, is
 * no place. */
bool glint_target_is_same(const char *a, const char *b);

/* Opens PATH, which must outlive OUT. On failure OUT is closed. GLINT_E_OUTPUT:
 * it cannot be written; GLINT_E_MEMORY. */
enum glint_status glint_output_open(struct glint_output *out, const char *path,
                                    enum glint_output_kind kind,
                                    struct glint_error *error);

/* Checks, before long work, whether a file can be created at PATH; leaves none
 * there. A target that would be written directly passes untouched.
 * GLINT_E_OUTPUT: it cannot be created; GLINT_E_MEMORY. */
enum glint_status glint_output_check(const char *path,
                                     struct glint_error *error);

/* Writes all of DATA[BYTES], or fails; once it has failed, it keeps failing.
 * GLINT_E_CLOSED: the reader of a pipe went away. GLINT_E_OUTPUT: any other
 * failure. */
enum glint_status glint_output_write(struct glint_output *out, const void *data,
                                     size_t bytes, struct glint_error *error);

/* Writes out the buffer, for pipes, whose reader waits. Commit does so, too. */
enum glint_status glint_output_flush(struct glint_output *out,
                                     struct glint_error *error);

/* Closes OUT and puts its file in place of the target. On failure aborts it. */
enum glint_status glint_output_commit(struct glint_output *out,
                                      struct glint_error *error);

/* Commits OUT if STATUS is GLINT_OK, else aborts it and returns STATUS. */
enum glint_status glint_output_end(struct glint_output *out,
                                   enum glint_status status,
                                   struct glint_error *error);

/* Writes DATA[BYTES] and commits OUT, or aborts it on failure. */
enum glint_status glint_output_finish(struct glint_output *out,
                                      const void *data, size_t bytes,
                                      struct glint_error *error);

/* Does so for a new file PATH. */
enum glint_status glint_output_save(const char *path,
                                    enum glint_output_kind kind,
                                    const void *data, size_t bytes,
                                    struct glint_error *error);

/* Returns a stream that appends to *TEXT, a malloc'ed string of *BYTES bytes,
 * or NULL without memory. Unlike open_memstream() of glibc it keeps in mind
 * that a write failed. *TEXT is complete once the stream is closed, belongs to
 * the caller, and is NULL if nothing was written. */
FILE *glint_memory_file_open(char **text, size_t *bytes);

/* Closes FILE of glint_memory_file_open(). Returns false if any of its text is
 * missing. */
bool glint_memory_file_close(FILE *file);

/* Closes OUT and removes its temporary file, unless it is closed already. */
void glint_output_abort(struct glint_output *out);

#endif
