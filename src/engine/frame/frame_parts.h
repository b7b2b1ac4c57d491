/* SPDX-License-Identifier: MIT
 *
 * Shared by the files of a frame: memory, lights, the block for the run-time
 * half that grows as frames need it (frame_room.c), and the parts of the plan
 * that drawing alone uses (frame_alone.c).
 */
#ifndef GLINT_ENGINE_FRAME_FRAME_PARTS_H
#define GLINT_ENGINE_FRAME_FRAME_PARTS_H

#include "engine/frame/frame.h"

static inline int max_int(int a, int b)
{
    return a > b ? a : b;
}

static inline int min_int(int a, int b)
{
    return a < b ? a : b;
}

/* Returns the time of the frame's clock in seconds; 0 if it has none. */
static inline double now(const struct glint_frame *f)
{
    return f->clock ? f->clock() : 0;
}

/* Returns whether light is added to codes, those of IMAGE or of later
 * pictures. */
static inline bool is_in_codes(const struct glint_frame *f,
                               const struct glint_image *image)
{
    return image->format != GLINT_LINEAR_Q20 || f->picture.for_codes;
}

/* frame_units.c: returns pixels per unit tangent on the axis. */
double glint_frame_pixels_per_tangent(const struct glint_frame *frame);

/* Returns whether ghosts choose among the setup's sets of wavelengths. */
bool glint_frame_has_wave_sets(const struct glint_frame *frame);

/* Allocates memory for N lights. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_allocate_lights(struct glint_frame *frame, int n);

/* Allocates the table of dim ghosts. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_allocate_dim_table(struct glint_frame *frame);

/* Allocates the data of each ghost. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_allocate_ghost_data(struct glint_frame *frame);

/* Clears the table of dim ghosts if the opening, the wavelengths or the
 * pixel size has changed. */
void glint_frame_clear_stale_dim_table(struct glint_frame *f);

/* Replaces the block by one for the current capacities, and reinitialises
 * the flare in it. */
enum glint_status glint_frame_reallocate_flare(struct glint_frame *frame);

/* Selects the tables of dust that the dials request for the stop; returns
 * whether they changed. */
bool glint_frame_select_dust_tables(struct glint_frame *frame);

/* Allocates memory for the max number of bundles of the frame's lights,
 * unless memory is reserved. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_ensure_plan_capacity(struct glint_frame *frame);

/* Replaces the frame's lights by static lights within the chord NEAR_Q30,
 * with factors on their light. Only if the dials set a static tolerance,
 * frames are reused, and reserved memory has capacity. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_use_static_lights(struct glint_frame *frame,
                                                int32_t near_q30);

/* Returns the number of distinct ghosts among the N bundles of the last
 * frame. */
int glint_frame_count_ghosts(struct glint_frame *frame, int n);

/* Returns true if all edges counted in STATS fitted, or the memory cannot
 * grow. Otherwise raises the capacities, or makes grids coarser if the
 * capacities would exceed the frame's memory, and returns false. */
bool glint_frame_fit_capacity(struct glint_frame *frame,
                              const struct glint_flare_stats *stats);

/* Returns the bytes that the frame used, as glint_flare_bytes() counts them. */
size_t glint_frame_count_used_bytes(const struct glint_frame *frame,
                                    const struct glint_flare_stats *stats);

/* Returns the bytes that would have drawn everything. */
size_t glint_frame_count_needed_bytes(const struct glint_frame *frame,
                                      const struct glint_flare_stats *stats);

/* Sets *SCALE to the scale of LAMPS as the plan predicts it, without drawing,
 * or to {0, 0} if there is no light. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_predict_scale(struct glint_frame *frame,
                                            const struct glint_lamp *lamps,
                                            int n_lamps,
                                            struct glint_frame_scale *scale);

/* Returns the light of CODES near black in IMAGE; 0 if IMAGE is NULL or linear.
 */
double glint_frame_convert_codes_to_light(const struct glint_frame *frame,
                                          const struct glint_image *image,
                                          double codes);

/* Returns whether ghost or part GHOST of SETUP is ghost NUMBER. */
bool glint_frame_is_part_of_ghost(const struct glint_setup *setup, int ghost,
                                  int number);

/* Returns the number of the ghost of which GHOST of SETUP is a part. */
int glint_frame_find_ghost_number(const struct glint_setup *setup, int ghost);

/* Removes lights until probing all bundles of all lights cannot cost more than
 * half of the frame's limit. Returns whether it did, so that lights have to be
 * merged again. */
bool glint_frame_limit_probing(struct glint_frame *f);

/* Reduces the dials if the plan would exceed the rest of the frame's limit:
 * grids first, then wavelengths, then lights. Returns whether it did, so that
 * the frame has to be planned again, at most a dozen times. */
bool glint_frame_limit_work(struct glint_frame *f);

#endif
