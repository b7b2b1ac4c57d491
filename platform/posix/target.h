/* SPDX-License-Identifier: MIT
 *
 * posix/target.h - where an output file goes, for posix/output.c.
 */
#ifndef GLINT_PLATFORM_POSIX_TARGET_H
#define GLINT_PLATFORM_POSIX_TARGET_H

#include <stdbool.h>
#include <sys/stat.h>

/* Returns the file that PATH leads to, all links followed, malloc'ed. ST is the
 * status of PATH, or NULL if there is no file yet, as at the end of a dangling
 * link. Returns NULL with errno set: EACCES for a dangling link that the kernel
 * would not follow, ESTALE if PATH leads to another file than ST now, or an
 * error of the system. */
char *glint_target_of(const char *path, const struct stat *st);

/* Returns the temporary name DIR/.glint-PID-N.EXT for the target DIR/NAME.EXT,
 * malloc'ed, or NULL without memory. */
char *glint_target_beside(const char *target, unsigned n);

/* Removes temporary files beside TARGET that killed runs have left: files of
 * this user's, whose process is gone, and locked by nobody on any machine. Does
 * nothing in the folder that it has cleaned last. */
void glint_target_clean(const char *target);

/* Returns whether INPUT and OUTPUT are the same regular file; "-" is the
 * standard stream. */
bool glint_target_is_input(const char *input, const char *output);

/* Returns whether A and B, which need not be there, name one place: the same
 * name in the same folder. What is there and no regular file, as /dev/null, is
 * no place. */
bool glint_target_is_same(const char *a, const char *b);

#endif
