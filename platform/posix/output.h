/* SPDX-License-Identifier: MIT
 *
 * posix/output.h - writes output files that appear complete or not at all.
 *
 *     glint_output_open(&out, "x.ppm", GLINT_OUTPUT_BINARY, &error);
 *     glint_output_write(&out, data, bytes, &error); any number of times
 *     glint_output_commit(&out, &error); or abort
 *
 * Bytes are written to a temporary file in the directory of the target, named
 * .glint-PID-N.EXT, which commit renames over the target. Until then an older
 * target does not change. An error, an abort, exit(), or death by a signal
 * other than SIGKILL leaves no temporary file; after SIGKILL, the next run that
 * writes to the same folder removes it. Symbolic links are followed, also
 * dangling links, and the new file gets the permission bits of the file it
 * replaces. There is no fsync: files are complete if the process dies, but not
 * if the power fails.
 *
 * "-" is standard output. Standard output, and any target that exists and is
 * not a regular file (a FIFO, /dev/null), are written directly; an abort does
 * not remove bytes written there.
 *
 * The first open changes signal actions of the process (posix/at_death.h). An
 * application that handles deadly signals itself must abort or commit its open
 * outputs, or call exit(). */
#ifndef GLINT_PLATFORM_POSIX_OUTPUT_H
#define GLINT_PLATFORM_POSIX_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "glint/status.h"

enum glint_output_kind {
    GLINT_OUTPUT_TEXT,
    GLINT_OUTPUT_BINARY /* rejected if the output is a terminal */
};

struct glint_output {
    int fd;           /* -1: closed */
    const char *name; /* name for errors; not owned */
    char *target;     /* path of the file that commit replaces, or NULL */
    char *tmp;        /* path of the temporary file, or NULL if the target is
                         written directly */
    uint8_t *buffer;  /* buffer that collects small writes */
    size_t used;      /* number of bytes in buffer */
    int failed;       /* errno of the first write that failed, or 0 */
};

/* Returns whether INPUT and OUTPUT are the same regular file; "-" is the
 * standard stream. */
bool glint_target_is_input(const char *input, const char *output);

/* Returns whether A and B, which need not exist, are the same path: the same
 * name in the same folder. Returns false for existing objects that are not
 * regular files, such as /dev/null. */
bool glint_target_is_same_file(const char *a, const char *b);

/* Opens PATH, which must outlive OUT. On failure OUT is closed. Returns
 * GLINT_E_OUTPUT if PATH cannot be written, or GLINT_E_MEMORY. */
enum glint_status glint_output_open(struct glint_output *out, const char *path,
                                    enum glint_output_kind kind,
                                    struct glint_error *error);

/* Checks, before a long computation, whether a file can be created at PATH;
 * creates no lasting file. Does not test targets that would be written
 * directly. Returns GLINT_E_OUTPUT if PATH cannot be created, or
 * GLINT_E_MEMORY. */
enum glint_status glint_output_check_path(const char *path,
                                          struct glint_error *error);

/* Writes all of DATA[BYTES]. After a failure all later writes fail, too.
 * Returns GLINT_E_CLOSED if the reader of a pipe has closed it, GLINT_E_OUTPUT
 * on any other failure. */
enum glint_status glint_output_write(struct glint_output *out, const void *data,
                                     size_t bytes, struct glint_error *error);

/* Writes the buffered bytes to the file. Needed only if the reader of a pipe
 * waits for them, as commit flushes, too. */
enum glint_status glint_output_flush(struct glint_output *out,
                                     struct glint_error *error);

/* Closes OUT and renames its temporary file to the target. On failure aborts
 * OUT. */
enum glint_status glint_output_commit(struct glint_output *out,
                                      struct glint_error *error);

/* Commits OUT if STATUS is GLINT_OK, else aborts it and returns STATUS. */
enum glint_status glint_output_commit_or_abort(struct glint_output *out,
                                               enum glint_status status,
                                               struct glint_error *error);

/* Writes DATA[BYTES] and commits OUT, or aborts it on failure. */
enum glint_status glint_output_write_and_commit(struct glint_output *out,
                                                const void *data, size_t bytes,
                                                struct glint_error *error);

/* Opens PATH, writes DATA[BYTES] and commits the file. */
enum glint_status glint_output_save_file(const char *path,
                                         enum glint_output_kind kind,
                                         const void *data, size_t bytes,
                                         struct glint_error *error);

/* Returns a stream that appends to *TEXT, a malloc'ed string of *BYTES bytes,
 * or NULL if there is no memory. Unlike glibc's open_memstream() it reports
 * failed writes when it is closed. *TEXT is complete once the stream is closed;
 * the caller frees it. */
FILE *glint_memory_file_open(char **text, size_t *bytes);

/* Closes FILE, a stream of glint_memory_file_open(). Returns false if a write
 * has failed. */
bool glint_memory_file_close(FILE *file);

/* Closes OUT and removes its temporary file, unless OUT is closed already. */
void glint_output_abort(struct glint_output *out);

#endif
