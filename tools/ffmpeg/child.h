/* SPDX-License-Identifier: MIT
 *
 * child.h - programs that glint runs beside itself, at the end of a pipe.
 *
 *     child_start(&child, argv, CHILD_WRITES, &error);     child.fd is read
 *     ...
 *     child_end(&child);                                   its exit status
 *
 * No shell takes part, so names need no quotes. The program shares glint's
 * standard error, or is heard there. It is killed when glint dies or gives it
 * up, and its status is always taken.
 */
#ifndef GLINT_TOOLS_FFMPEG_CHILD_H
#define GLINT_TOOLS_FFMPEG_CHILD_H

#include <stdbool.h>
#include <sys/types.h>

#include "glint/status.h"

enum child_pipe {
    CHILD_WRITES, /* The child's standard output is FD, its input is empty. */
    CHILD_PRINTS, /* So are its standard output and standard error. */
    CHILD_READS /* The child's standard input is FD, its output goes nowhere. */
};

struct child {
    pid_t pid;  /* 0: none */
    int fd;     /* glint's end of the pipe; -1: closed */
    int said;   /* file of its standard error; -1: that is glint's own */
    off_t told; /* bytes of SAID that were passed on */
    const char *const *listening; /* ends with NULL, not owned */
    bool heard;                   /* it has said one of those */
};

/* A child that is none. */
#define CHILD_NONE ((struct child){.fd = -1, .said = -1})

/* Returns whether NAME is a program of $PATH. */
bool child_exists(const char *name);

/* Starts ARGV[0] of $PATH with ARGV, which ends with NULL. GLINT_E_UNSUPPORTED:
 * it is not there. GLINT_E_IO: the system gives no process or descriptor. */
enum glint_status child_start(struct child *child, const char *const *argv,
                              enum child_pipe kind, struct glint_error *error);

/* Like child_start(), of a child that WORDS, which end with NULL, are listened
 * for in what it says; child_hear() passes that on. */
enum glint_status child_start_heard(struct child *child,
                                    const char *const *argv,
                                    enum child_pipe kind,
                                    const char *const *words,
                                    struct glint_error *error);

/* Passes on to standard error the lines that a child has said since. */
void child_hear(struct child *child);

/* Closes the pipe and waits until the child has ended. Returns its exit status,
 * or 128 plus the signal that killed it, or 0 if there is no child. */
int child_end(struct child *child);

/* Kills the child, if there is one, and takes its status. */
void child_kill(struct child *child);

#endif
