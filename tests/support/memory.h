/* SPDX-License-Identifier: MIT
 *
 * Memory that lives until the end of a test: main() of tests frees it. In other
 * programs it lives until free() or the end of the program.
 */
#ifndef GLINT_TESTS_SUPPORT_MEMORY_H
#define GLINT_TESTS_SUPPORT_MEMORY_H

#include <stddef.h>

/* Frees MEMORY, which must not be NULL, after the test. Returns MEMORY. */
void *test_free_later(void *memory);

/* Returns BYTES bytes at a multiple of 64, which are freed after the test. */
void *test_allocate(size_t bytes);

void test_free_memory(void);

#endif
