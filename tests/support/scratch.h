/* SPDX-License-Identifier: MIT
 *
 * Files of a test's own, below /tmp: one, or as many as it likes in a folder.
 *
 *     cmocka_run_group_tests(tests, scratch_open_dir, scratch_close_dir);
 *     scratch_put("a.ppm", BYTES("P6 1 1 255 abc"));
 *     unlink(scratch_path("a.ppm"));
 */
#ifndef GLINT_TESTS_SCRATCH_H
#define GLINT_TESTS_SCRATCH_H

#include <stddef.h>

/* TEXT and its bytes without the 0 at its end, as two arguments. */
#define BYTES(text) text, sizeof text - 1

/* The one file, which is there and empty before the first test. */
extern char scratch_file[];
int scratch_open_file(void **state);
int scratch_close_file(void **state);

/* The folder; closing it fails if a test has left anything in it. */
extern char scratch_dir[];
int scratch_open_dir(void **state);
int scratch_close_dir(void **state);

/* Returns the path of NAME in the folder; it holds until the next but one is
 * asked for. */
const char *scratch_path(const char *name);

/* Writes DATA to NAME in the folder, and asserts that it could. */
void scratch_put(const char *name, const char *data, size_t bytes);

/* Returns how many files DIR has, hidden ones and folders, too. */
int scratch_count(const char *dir);

#endif
