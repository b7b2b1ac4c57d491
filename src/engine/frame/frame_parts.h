/* SPDX-License-Identifier: MIT
 *
 * Functions shared by the files frame*.c: memory of a frame (frame_room.c), its
 * lights, and the steps of its plan. */
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
static inline double read_frame_clock(const struct glint_frame *f)
{
    return f->clock ? f->clock() : 0;
}

/* Returns whether F has the quality of a draft: grids as coarse as those of
 * --quality draft, and one set of wavelengths. Exact rays and their starbursts
 * are then measured with fewer samples. */
static inline bool glint_frame_is_draft(const struct glint_frame *f)
{
    enum { DRAFT_CELLS = 32 };

    return f->trace && f->dials.fineness <= DRAFT_CELLS &&
           f->dials.dispersion_q8 == 0;
}

/* Returns whether the flare is planned for 8-bit codes: IMAGE has codes, or the
 * flare will be added to codes later. */
static inline bool is_planned_for_codes(const struct glint_frame *f,
                                        const struct glint_image *image)
{
    return image->format != GLINT_LINEAR_Q20 || f->picture.for_codes;
}

/* Returns the focal length in pixels, which is the number of pixels per unit of
 * an angle's tangent on the axis. */
double glint_frame_compute_pixels_per_tangent(const struct glint_frame *frame);

/* Returns whether each ghost is drawn with one of the setup's sets of
 * wavelengths. */
bool glint_frame_has_wave_sets(const struct glint_frame *frame);

/* Returns the number of ghosts of the frame's model, which counts each pupil
 * region as a ghost; without a model, that of the setup. They differ if the
 * setup was made from the table of the model. */
int glint_frame_count_pupil_regions(const struct glint_frame *frame);

/* Ensures capacity for N lights. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_allocate_lights(struct glint_frame *frame, int n);

/* Allocates the table of the brightness of ghosts, unless it exists. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_allocate_dim_table(struct glint_frame *frame);

/* Allocates the arrays with one element per ghost, unless they exist. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_allocate_ghost_data(struct glint_frame *frame);

/* Marks all nodes of the table of ghost brightness as not computed if stop
 * opening, wavelengths or pixel size have changed. */
void glint_frame_clear_stale_dim_table(struct glint_frame *f);

/* Replaces the memory block by one for the current capacities, and initialises
 * the flare in it. */
enum glint_status glint_frame_reallocate_flare(struct glint_frame *frame);

/* Selects the tables of dust whose fineness is the quality parameter dust_log2.
 * Returns whether the selection changed. */
bool glint_frame_select_dust_tables(struct glint_frame *frame);

/* Ensures memory to plan all ray bundles of the frame's lights, unless memory
 * is reserved. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_ensure_plan_capacity(struct glint_frame *frame);

/* Reuses traced rays for lights that hardly move. If each light of the frame
 * lies within the chord NEAR_Q30 (a distance on the unit sphere) of a light of
 * the last plan, replaces the lights by the planned ones, and sets factors on
 * their colours. Does nothing unless the tolerance still_px is above 0, frames
 * are reused, and reserved memory has capacity. Returns GLINT_E_MEMORY on
 * failure. */
enum glint_status glint_frame_use_static_lights(struct glint_frame *frame,
                                                int32_t near_q30);

/* Returns the number of distinct ghosts among the N ray bundles of the last
 * frame. */
int glint_frame_count_ghosts(struct glint_frame *frame, int n);

/* Returns true if the frame can be drawn after binning with the result STATS:
 * all edges fitted, or memory cannot grow. Otherwise raises the capacities. If
 * these would exceed the memory limit, makes grids coarser instead. Then
 * returns false, and the frame must be planned again. */
bool glint_frame_fit_capacity(struct glint_frame *frame,
                              const struct glint_flare_stats *stats);

/* Returns the number of bytes that the frame used, by glint_flare_bytes(), the
 * size of a flare's memory. */
size_t glint_frame_count_used_bytes(const struct glint_frame *frame,
                                    const struct glint_flare_stats *stats);

/* Returns the number of bytes that are needed to draw the complete frame at the
 * requested quality. */
size_t glint_frame_count_needed_bytes(const struct glint_frame *frame,
                                      const struct glint_flare_stats *stats);

/* Plans the flare of LAMPS without drawing it. Sets *SCALE to the factors by
 * which its light may be scaled, or to {0, 0} if there is no light. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_predict_scale(struct glint_frame *frame,
                                            const struct glint_lamp *lamps,
                                            int n_lamps,
                                            struct glint_frame_scale *scale);

/* Returns the linear light of CODES codes near black in IMAGE; 0 if IMAGE is
 * NULL, or linear and not planned as 8-bit codes. */
double glint_frame_get_light_near_black(const struct glint_frame *frame,
                                        const struct glint_image *image,
                                        double codes);

/* Returns whether GHOST comes from the same pair of surfaces as ghost NUMBER.
 * Both are ghosts of SETUP, or single pupil regions (parts) of such ghosts. */
bool glint_frame_is_part_of_ghost(const struct glint_setup *setup, int ghost,
                                  int number);

/* Returns the number of the ghost of which GHOST is one pupil region (part), or
 * GHOST if it is a complete ghost. GHOST is an index of a ghost of the frame's
 * model; without a model, of the setup. */
int glint_frame_find_ghost_number(const struct glint_frame *frame, int ghost);

/* Lowers max_lights until probing all ray bundles costs at most half of the
 * frame's limit of work. Returns whether max_lights changed, so that lights
 * must be merged again. */
bool glint_frame_limit_probing(struct glint_frame *f);

/* Reduces quality parameters if the plan would exceed the remaining limit of
 * work: first the fineness of grids, then wavelengths, then lights. Returns
 * whether it reduced any. If so, the frame must be planned again; this happens
 * at most a dozen times. */
bool glint_frame_limit_work(struct glint_frame *f);

#endif
