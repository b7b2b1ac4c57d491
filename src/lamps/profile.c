/* SPDX-License-Identifier: MIT */
#include "lamps/profile.h"

#include "base/arena.h"
#include "lamps/unclip.h"

/* Allocates a profile from A. Returns NULL if A only measures or is full. No
 * row is scanned, so tables for one pixel are enough. */
static struct glint_profile *carve(struct glint_arena *a)
{
    struct glint_profile *placed = glint_arena_take(a, 1, sizeof *placed);
    struct glint_bright measured;

    glint_bright_carve(placed ? &placed->rings.bright : &measured, a, 1);
    return a->used <= a->size ? placed : NULL;
}

size_t glint_profile_bytes(void)
{
    struct glint_arena measured = glint_arena_measure();

    carve(&measured);
    return measured.used;
}

enum glint_status glint_profile_init(struct glint_profile **profile, void *mem,
                                     size_t bytes)
{
    struct glint_arena arena = glint_arena_over(mem, bytes);
    struct glint_profile *p;

    if ((uintptr_t)mem % GLINT_ALIGN)
        return GLINT_E_ARGUMENT;
    p = carve(&arena);
    if (!p)
        return GLINT_E_MEMORY;
    glint_bright_init(&p->rings.bright, 1);
    *profile = p;
    return GLINT_OK;
}

/* Measures the spots in place: measuring a spot preserves its position and
 * size_q8, the only members on which the measurement of other spots depends. */
void glint_profile_measure(struct glint_profile *profile,
                           const struct glint_image *image,
                           struct glint_spot *spots, int n)
{
    n = n < GLINT_PROFILE_SPOTS ? n : GLINT_PROFILE_SPOTS;
    glint_rings_begin(&profile->rings, image, spots, n);
    for (int i = 0; i < n; i++) {
        struct glint_profile_sums sums;

        glint_rings_sum(&sums, &profile->rings, spots, n, i);
        glint_unclip(&spots[profile->rings.by_x[i]], &sums);
    }
}
