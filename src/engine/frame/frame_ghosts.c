/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "engine/frame/frame_parts.h"

bool glint_frame_is_part_of_ghost(const struct glint_setup *s, int ghost,
                                  int number)
{
    return s->ghost[ghost].i == s->ghost[number].i &&
           s->ghost[ghost].j == s->ghost[number].j;
}

static struct glint_ghost get_ghost(const struct glint_frame *f, int ghost)
{
    const struct glint_lens *const lens = f->lens;

    return lens ? (struct glint_ghost){(int)lens->ghost[ghost].i,
                                       (int)lens->ghost[ghost].j}
                : f->setup->ghost[ghost];
}

int glint_frame_find_ghost_number(const struct glint_frame *f, int ghost)
{
    const int n_parts =
        f->lens ? (int)f->lens->header->n_parts : f->setup->n_parts;
    const struct glint_ghost part = get_ghost(f, ghost);

    if (ghost < glint_frame_count_pupil_regions(f) - n_parts)
        return ghost;
    for (int number = 0; number < ghost; number++) {
        const struct glint_ghost at = get_ghost(f, number);

        if (at.i == part.i && at.j == part.j)
            return number;
    }
    return ghost;
}

/* Marks the ghost with index GHOST as drawn in the frame. If GHOST is one pupil
 * region (part) of a ghost, marks that ghost. Returns whether the ghost had not
 * been marked before. */
static bool mark_ghost_seen(struct glint_frame *frame, int ghost)
{
    const int number = glint_frame_find_ghost_number(frame, ghost);

    if (frame->lights.seen[number])
        return false;
    return frame->lights.seen[number] = true;
}

int glint_frame_count_ghosts(struct glint_frame *frame, int n)
{
    int n_ghosts = 0;

    memset(frame->lights.seen, 0,
           (size_t)glint_frame_count_pupil_regions(frame) *
               sizeof *frame->lights.seen);
    for (int i = 0; i < n; i++)
        n_ghosts += mark_ghost_seen(
            frame, frame->lens ? glint_flare_ghost(frame->memory.flare, i)
                               : frame->trace->ghost(frame, i));
    return n_ghosts;
}

enum glint_status glint_frame_allocate_dim_table(struct glint_frame *f)
{
    f->dim.table.method = &glint_dim_method;
    if (!f->dim.table.log2_q8)
        f->dim.table.log2_q8 =
            calloc((size_t)GLINT_DIM_NODES * GLINT_DIM_VALUES *
                       ((size_t)glint_frame_count_pupil_regions(f) + 1),
                   sizeof *f->dim.table.log2_q8);
    return f->dim.table.log2_q8 ? GLINT_OK : GLINT_E_MEMORY;
}

static bool are_waves_equal(const struct glint_wave *a,
                            const struct glint_wave *b)
{
    return a->wave_q24 == b->wave_q24 && a->rgb_q14[0] == b->rgb_q14[0] &&
           a->rgb_q14[1] == b->rgb_q14[1] && a->rgb_q14[2] == b->rgb_q14[2] &&
           a->weight.mantissa == b->weight.mantissa &&
           a->weight.exponent == b->weight.exponent;
}

void glint_frame_clear_stale_dim_table(struct glint_frame *f)
{
    const double size = f->view.width / f->view.sensor_width_mm;
    bool same = f->dim.opening == f->setup->opening && f->dim.size == size;

    for (int i = 0; i < 3; i++)
        same = same && are_waves_equal(&f->dim.wave[i], &f->lights.wave[i]);
    if (same)
        return;
    memset(f->dim.table.done, 0, sizeof f->dim.table.done);
    memcpy(f->dim.wave, f->lights.wave, sizeof f->dim.wave);
    f->dim.opening = f->setup->opening;
    f->dim.size = size;
}

enum glint_status glint_frame_allocate_ghost_data(struct glint_frame *f)
{
    if (!f->lights.seen)
        f->lights.seen = calloc(GLINT_MAX_GHOSTS, sizeof *f->lights.seen);
    if (f->lights.seen && f->lens && f->dials.dim_codes > 0)
        return glint_frame_allocate_dim_table(f);
    return f->lights.seen ? GLINT_OK : GLINT_E_MEMORY;
}
