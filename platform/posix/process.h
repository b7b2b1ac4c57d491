/* SPDX-License-Identifier: MIT
 *
 * posix/process.h - prepares a process: descriptors, environment and stack.
 * Called first in main(). */
#ifndef GLINT_PLATFORM_POSIX_PROCESS_H
#define GLINT_PLATFORM_POSIX_PROCESS_H

#include <stdbool.h>
#include <stddef.h>

/* Stack size for baking, bytes, independent of the system's default: baking
 * needs GLINT_BAKE_STACK_BYTES, and several times more under a sanitizer. */
#ifdef GLINT_SANITIZED
#define GLINT_WORKER_STACK_BYTES (16 << 20)
#else
#define GLINT_WORKER_STACK_BYTES (2 << 20)
#endif

/* Opens those of the descriptors 0 to 2 that are closed, such that reading or
 * writing them fails. Otherwise a file opened later could become standard
 * input, output or error. */
void glint_process_open_closed_streams(void);

/* Returns the value of the environment variable NAME, or NULL if it is not set
 * or the program is setuid or setgid. */
const char *glint_process_get_setting(const char *name);

/* Sets PATH to the absolute path of the file that contains this code: the
 * program, or the plug-in of a host. Returns false if the path is unknown or
 * too long. */
bool glint_process_find_own_file(char *path, size_t bytes);

/* Returns FN(CTX). If the stack limit is below BYTES, runs FN in a thread with
 * a stack of BYTES; this thread then receives all signals. If the thread cannot
 * be created, runs FN directly. Meant for main(). */
int glint_process_run_with_stack(size_t bytes, int (*fn)(void *ctx), void *ctx);

#endif
