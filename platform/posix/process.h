/* SPDX-License-Identifier: MIT
 *
 * posix/process.h - what a program sees to before anything else.
 */
#ifndef GLINT_PLATFORM_POSIX_PROCESS_H
#define GLINT_PLATFORM_POSIX_PROCESS_H

#include <stddef.h>

/* Descriptors 0 to 2 that are closed become such as fail when they are read or
 * written, so that no file that is opened later is taken for standard output.
 */
void glint_process_hold_streams(void);

/* Returns the environment's value of NAME, or NULL; a program with rights that
 * its user has not gets none. */
const char *glint_process_setting(const char *name);

/* FN(CTX), where the calling thread's stack may grow to less than BYTES in a
 * thread of its own that has as many, to which all signals go meanwhile. Where
 * there is no such thread to be had, it is called directly. For main(). */
int glint_process_on_stack(size_t bytes, int (*fn)(void *ctx), void *ctx);

#endif
