/* SPDX-License-Identifier: MIT
 *
 * Sorts numbers of things: in place, without memory of its own, n log n at
 * worst.
 */
#ifndef GLINT_BASE_SORT_H
#define GLINT_BASE_SORT_H

#include <stdint.h>

/* Whether thing A comes before B. A total order makes the result the same
 * however the things came. */
typedef int glint_sort_fn(const void *ctx, int32_t a, int32_t b);

void glint_sort(int32_t *order, int n, glint_sort_fn *before, const void *ctx);

#endif
