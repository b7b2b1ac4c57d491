/* SPDX-License-Identifier: MIT
 *
 * Temporary files for a test, below /tmp: either one file, or a folder for any
 * number of files.
 *
 *     TEST_GROUP(scratch_create_dir, scratch_remove_dir);
 *     scratch_write_file("a.ppm", BYTES("P6 1 1 255 abc"));
 *     unlink(scratch_make_path("a.ppm"));
 */
#ifndef GLINT_TESTS_SCRATCH_H
#define GLINT_TESTS_SCRATCH_H

#include <stddef.h>

/* Expands to two arguments: TEXT, and its length without the terminating 0. */
#define BYTES(text) text, sizeof text - 1

/* path of the single file; it exists and is empty before the first test */
extern char scratch_file[];
void scratch_create_file(void);
void scratch_remove_file(void);

/* path of the folder; scratch_remove_dir() fails if a test has left a file in
 * it */
extern char scratch_dir[];
void scratch_create_dir(void);
void scratch_remove_dir(void);

/* Returns the path of file NAME in the folder. Two results are valid at a time:
 * the third call overwrites the first. */
const char *scratch_make_path(const char *name);

/* Writes DATA[BYTES] to file NAME in the folder; fails the test on an error. */
void scratch_write_file(const char *name, const char *data, size_t bytes);

/* Checks that the file PATH has exactly the bytes WANT[BYTES]. */
void scratch_expect_bytes(const char *path, const char *want, size_t bytes);

/* Returns the number of entries of the folder DIR, including hidden ones. */
int scratch_count_entries(const char *dir);

#endif
