/* SPDX-License-Identifier: MIT
 *
 * Shared by the files of a frame: its memory, lights and a block for the
 * run-time half that grows to what frames need (frame_room.c), and what drawing
 * alone (frame_alone.c) needs of the plan. */
#ifndef GLINT_ENGINE_FRAME_FRAME_PARTS_H
#define GLINT_ENGINE_FRAME_FRAME_PARTS_H

#include "engine/frame/frame.h"

static inline int larger(int a, int b)
{
    return a > b ? a : b;
}

static inline int smaller(int a, int b)
{
    return a < b ? a : b;
}

/* Returns the time of the frame's clock in seconds; 0 if it has none. */
static inline double now(const struct glint_frame *f)
{
    return f->clock ? f->clock() : 0;
}

/* Returns whether light is added to codes, those of IMAGE or later ones. */
static inline bool is_in_codes(const struct glint_frame *f,
                               const struct glint_image *image)
{
    return image->format != GLINT_LINEAR_Q20 || f->picture.for_codes;
}

/* frame_units.c: returns pixels per unit tangent on the axis. */
double glint_frame_pixels_per_tangent(const struct glint_frame *frame);

/* Returns whether ghosts choose among the setup's sets of wavelengths. */
bool glint_frame_has_sets(const struct glint_frame *frame);

/* Makes room for N lights. GLINT_E_MEMORY. */
enum glint_status glint_frame_hold_lights(struct glint_frame *frame, int n);

/* Allocates the table of dim ghosts. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_hold_dim(struct glint_frame *frame);

/* Allocates the data of each ghost. GLINT_E_MEMORY. */
enum glint_status glint_frame_hold_ghosts(struct glint_frame *frame);

/* Clears the table of dim ghosts if what it depends on has changed: the
 * opening, the waves that are set, the size of a pixel. */
void glint_frame_check_dim(struct glint_frame *f);

/* Replaces the block by one for the present capacities, in which the flare
 * restarts. */
enum glint_status glint_frame_regrow(struct glint_frame *frame);

/* Selects the tables of dust that the dials request for the stop; returns
 * whether they changed. */
bool glint_frame_shade(struct glint_frame *frame);

/* Makes room for all bundles that the frame's lights may have, unless memory is
 * reserved. GLINT_E_MEMORY. */
enum glint_status glint_frame_make_room(struct glint_frame *frame);

/* Represents the frame's lights by the static ones within NEAR_Q30, with
 * factors, if the dials have a static tolerance, frames are reused, and
 * reserved memory has capacity. GLINT_E_MEMORY. */
enum glint_status glint_frame_still(struct glint_frame *frame,
                                    int32_t near_q30);

/* Returns how many ghosts the N bundles of the last frame belong to. */
int glint_frame_count_ghosts(struct glint_frame *frame, int n);

/* Returns true if all of STATS fitted or the memory cannot grow. Else raises
 * the capacities, or makes grids coarser if capacities would exceed the frame's
 * memory, and returns false. */
bool glint_frame_fit_capacity(struct glint_frame *frame,
                              const struct glint_flare_stats *stats);

/* Returns the bytes that the frame used, as glint_flare_bytes() counts them. */
size_t glint_frame_bytes_used(const struct glint_frame *frame,
                              const struct glint_flare_stats *stats);

/* Returns the bytes that would have drawn everything. */
size_t glint_frame_bytes_needed(const struct glint_frame *frame,
                                const struct glint_flare_stats *stats);

/* Sets *SCALE to the scale of LAMPS as the plan predicts it, without drawing,
 * or to {0, 0} if there is no light. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_plan_scale(struct glint_frame *frame,
                                         const struct glint_lamp *lamps,
                                         int n_lamps,
                                         struct glint_frame_scale *scale);

/* Returns the light of CODES near black in IMAGE; 0 if IMAGE is NULL or linear.
 */
double glint_frame_codes_light(const struct glint_frame *frame,
                               const struct glint_image *image, double codes);

/* Returns whether ghost or part GHOST of SETUP is ghost NUMBER. */
bool glint_frame_is_ghost(const struct glint_setup *setup, int ghost,
                          int number);

/* Returns the number of the ghost that GHOST of SETUP is, or is a part of. */
int glint_frame_number(const struct glint_setup *setup, int ghost);

/* Removes lights until probing all bundles of all lights cannot cost more than
 * half of the frame's limit. Returns whether it did, so that lights have to be
 * merged again. */
bool glint_frame_hold_looking(struct glint_frame *f);

/* Reduces the dials if the plan would exceed the rest of the frame's limit:
 * grids first, then wavelengths, then lights. Returns whether it did, so that
 * the frame has to be planned again, at most a dozen times. */
bool glint_frame_hold_work(struct glint_frame *f);

#endif
