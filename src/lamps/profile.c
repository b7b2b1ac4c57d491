/* SPDX-License-Identifier: MIT */
#include "lamps/profile.h"

#include "base/arena.h"
#include "lamps/unclip.h"

/* Allocates a profile from A. Returns NULL if A only measures or has too little
 * memory. The tables have a width of one pixel, as a profile reads single
 * pixels and scans no rows. */
static struct glint_profile *allocate_profile(struct glint_arena *a)
{
    struct glint_profile *placed = glint_arena_allocate(a, 1, sizeof *placed);
    struct glint_bright measured;

    glint_bright_allocate(placed ? &placed->rings.bright : &measured, a, 1);
    return a->used <= a->size ? placed : NULL;
}

size_t glint_profile_bytes(void)
{
    struct glint_arena measured = glint_arena_begin_measuring();

    allocate_profile(&measured);
    return measured.used;
}

enum glint_status glint_profile_init(struct glint_profile **profile, void *mem,
                                     size_t bytes)
{
    struct glint_arena arena = glint_arena_init_in_memory(mem, bytes);
    struct glint_profile *p;

    if ((uintptr_t)mem % GLINT_ALIGN)
        return GLINT_E_ARGUMENT;
    p = allocate_profile(&arena);
    if (!p)
        return GLINT_E_MEMORY;
    glint_bright_init(&p->rings.bright, 1);
    *profile = p;
    return GLINT_OK;
}

/* Spots are changed in place. The measurement of other spots reads only the
 * position and size_q8 of a spot, which do not change. */
void glint_profile_measure(struct glint_profile *profile,
                           const struct glint_image *image,
                           struct glint_spot *spots, int n)
{
    n = n < GLINT_PROFILE_SPOTS ? n : GLINT_PROFILE_SPOTS;
    glint_rings_begin_picture(&profile->rings, image, spots, n);
    for (int i = 0; i < n; i++) {
        struct glint_profile_sums sums;

        glint_rings_sum_spot_light(&sums, &profile->rings, spots, n, i);
        glint_unclip_estimate_lamp(&spots[profile->rings.by_x[i]], &sums);
    }
}
