/* SPDX-License-Identifier: MIT */
#include "base/sort.h"

void glint_heap_restore_order(const struct glint_heap *heap, int at, int n)
{
    void *const things = heap->things;

    for (;;) {
        int child = 2 * at + 1;

        if (child >= n)
            return;
        if (child + 1 < n && heap->before(things, child, child + 1))
            child++;
        if (!heap->before(things, at, child))
            return;
        heap->swap(things, at, child);
        at = child;
    }
}

void glint_heap_build(const struct glint_heap *heap, int n)
{
    for (int i = n / 2 - 1; i >= 0; i--)
        glint_heap_restore_order(heap, i, n);
}

void glint_heap_sort(const struct glint_heap *heap, int n)
{
    glint_heap_build(heap, n);
    for (int end = n - 1; end > 0; end--) {
        heap->swap(heap->things, 0, end);
        glint_heap_restore_order(heap, 0, end);
    }
}

/* ------------------------------------------------------------------ numbers */

struct numbers {
    int32_t *order;
    glint_sort_fn *before;
    const void *ctx;
};

static int is_number_before(const void *things, int a, int b)
{
    const struct numbers *const n = things;

    return n->before(n->ctx, n->order[a], n->order[b]);
}

static void swap_sorted_numbers(void *things, int a, int b)
{
    const struct numbers *const n = things;
    const int32_t old = n->order[a];

    n->order[a] = n->order[b];
    n->order[b] = old;
}

void glint_sort(int32_t *order, int n, glint_sort_fn *before, const void *ctx)
{
    struct numbers numbers = {order, before, ctx};
    const struct glint_heap heap = {is_number_before, swap_sorted_numbers,
                                    &numbers};

    glint_heap_sort(&heap, n);
}
