/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "engine/frame/frame_parts.h"

bool glint_frame_is_ghost(const struct glint_setup *s, int ghost, int number)
{
    return s->ghost[ghost].i == s->ghost[number].i &&
           s->ghost[ghost].j == s->ghost[number].j;
}

int glint_frame_number(const struct glint_setup *s, int ghost)
{
    int number = ghost;

    if (ghost >= s->n_ghosts - s->n_parts)
        for (number = 0; !glint_frame_is_ghost(s, ghost, number);)
            number++;
    return number;
}

/* Notes that GHOST is in the frame; returns whether it is the first part of its
 * ghost there. */
static bool note_ghost(struct glint_frame *frame, int ghost)
{
    const int number = glint_frame_number(frame->setup, ghost);

    if (frame->seen[number])
        return false;
    return frame->seen[number] = true;
}

int glint_frame_count_ghosts(struct glint_frame *frame, int n)
{
    int n_ghosts = 0;

    memset(frame->seen, 0,
           (size_t)frame->setup->n_ghosts * sizeof *frame->seen);
    for (int i = 0; i < n; i++)
        n_ghosts +=
            note_ghost(frame, frame->lens ? glint_flare_ghost(frame->flare, i)
                                          : frame->trace->ghost(frame, i));
    return n_ghosts;
}
