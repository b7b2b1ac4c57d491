/* SPDX-License-Identifier: MIT */
#include "base/sort.h"

static void swap(int32_t *a, int32_t *b)
{
    const int32_t old = *a;

    *a = *b;
    *b = old;
}

/* Restores the heap order[0 .. n - 1], the last one first, below AT. */
static void sift_down(int32_t *order, int at, int n, glint_sort_fn *before,
                      const void *ctx)
{
    for (;;) {
        int child = 2 * at + 1;

        if (child >= n)
            return;
        if (child + 1 < n && before(ctx, order[child], order[child + 1]))
            child++;
        if (!before(ctx, order[at], order[child]))
            return;
        swap(&order[child], &order[at]);
        at = child;
    }
}

void glint_sort(int32_t *order, int n, glint_sort_fn *before, const void *ctx)
{
    for (int i = n / 2 - 1; i >= 0; i--)
        sift_down(order, i, n, before, ctx);
    for (int end = n - 1; end > 0; end--) {
        swap(&order[0], &order[end]);
        sift_down(order, 0, end, before, ctx);
    }
}
