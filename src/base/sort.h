/* SPDX-License-Identifier: MIT
 *
 * Binary heap and heap sort, in place, O(n log n) in the worst case.
 *
 *     glint_sort(order, n, before, ctx);       sorts indices of objects
 *     glint_heap_sort(&heap, n);               sorts objects by swapping them
 */
#ifndef GLINT_BASE_SORT_H
#define GLINT_BASE_SORT_H

#include <stdint.h>

/* Returns whether item A is sorted before item B. If this is a total order, the
 * result of sorting does not depend on the initial order. */
typedef int glint_sort_fn(const void *ctx, int32_t a, int32_t b);

void glint_sort(int32_t *order, int n, glint_sort_fn *before, const void *ctx);

/* A heap of objects at indices 0 .. n - 1. The object at index i never comes
 * after the object at index (i - 1) / 2 in sorting order. So the last object in
 * sorting order is at index 0. */
struct glint_heap {
    int (*before)(const void *things, int a,
                  int b); /* returns whether the object at index A must come
                             before the object at index B */
    void (*swap)(void *things, int a, int b);
    void *things;
};

/* Reorders the objects 0 .. N - 1 into a heap. */
void glint_heap_build(const struct glint_heap *heap, int n);

/* Restores the heap of objects 0 .. N - 1 after object AT was replaced by an
 * object that comes earlier in sorting order. */
void glint_heap_restore_order(const struct glint_heap *heap, int at, int n);

void glint_heap_sort(const struct glint_heap *heap, int n);

#endif
