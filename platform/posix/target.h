/* SPDX-License-Identifier: MIT
 *
 * posix/target.h - where an output file goes, for posix/output.c.
 */
#ifndef GLINT_PLATFORM_POSIX_TARGET_H
#define GLINT_PLATFORM_POSIX_TARGET_H

#include <stdbool.h>
#include <sys/stat.h>

/* The file that PATH means, all links followed, malloc'ed. ST: what it is by
 * stat(), or NULL: it is not there yet, as at the end of a dangling link. NULL
 * with errno: EACCES where a dangling link is somebody else's, ESTALE where
 * PATH means another file than ST now, or any of the system's. */
char *glint_target_of(const char *path, const struct stat *st);

/* DIR/.glint-PID-N.EXT for the target DIR/NAME.EXT; malloc'ed, or NULL. */
char *glint_target_beside(const char *target, unsigned n);

/* Removes files of that kind beside TARGET that runs left that were killed:
 * ours, of a process that is gone, and locked by nobody on any machine. Looks
 * into the same folder once only. */
void glint_target_clean(const char *target);

/* Returns whether A and B, "-" the standard streams, are the same regular file.
 */
bool glint_target_is_input(const char *input, const char *output);

#endif
