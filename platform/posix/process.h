/* SPDX-License-Identifier: MIT
 *
 * posix/process.h - preparations of a process, before all else in main().
 */
#ifndef GLINT_PLATFORM_POSIX_PROCESS_H
#define GLINT_PLATFORM_POSIX_PROCESS_H

#include <stdbool.h>
#include <stddef.h>

/* Opens those of the descriptors 0 to 2 that are closed such that reading or
 * writing them fails. So no file that is opened later becomes standard
 * output. */
void glint_process_hold_streams(void);

/* Returns the environment's value of NAME, or NULL if it has none or the
 * program has more rights than its user. */
const char *glint_process_setting(const char *name);

/* Sets PATH to the absolute path of the program, or of the plug-in of a host,
 * that this code is linked into. Returns false if it is unknown or too long. */
bool glint_process_own_file(char *path, size_t bytes);

/* Returns FN(CTX). If the stack may grow to less than BYTES, FN runs in a
 * thread that has BYTES, to which all signals go meanwhile, or directly if
 * there can be no such thread. For main(). */
int glint_process_on_stack(size_t bytes, int (*fn)(void *ctx), void *ctx);

#endif
