/* SPDX-License-Identifier: MIT
 *
 * Brightness of the ghosts of a lens, by wave and angle of the light: if a
 * ghost is too dim for its coloured outlines to be distinguished, the rays of
 * one wave represent all three. nodes.c fills the table. */
#ifndef GLINT_FLARE_DIM_H
#define GLINT_FLARE_DIM_H

#include "base/divide.h"
#include "base/q.h"
#include "base/real.h"
#include "glint/flare.h"

enum {
    GLINT_DIM_WAVE = 1,  /* index of the wave whose rays represent all waves */
    GLINT_DIM_WAVES = 3, /* with any other number of waves no ghost is treated
                            as dim */
    GLINT_DIM_WHOLE_Q8 = 256,
    GLINT_DIM_LAST = GLINT_DIM_NODES - 1,
    GLINT_DIM_DARK = INT16_MIN, /* value of a wave whose light does not get
                                   through the lens */
    GLINT_LIGHT_HELD =
        14 /* extra fraction bits of colours while lights merge */
};

struct glint_flare;

/* The functions of the table that a plan calls. */
struct glint_dim_method {
    /* Fills the nodes (sampled angles) next to the angles of the plan's first
     * N_LIGHTS lights, unless they are filled already. */
    void (*fill)(struct glint_flare *flare, int n_lights);
    /* Lets dim ghosts of the plan's first N_LIGHTS lights share rays. For
     * each ghost, a light is merged into the nearest of the preceding lights
     * in the list if the ghost is so dim that the shift is invisible; both
     * are then drawn as one light at a position between them. The merged
     * fraction of the light falls gradually as a ghost gets brighter. */
    void (*gather)(struct glint_flare *flare, int n_lights);
    /* Returns the merged light that is drawn in place of LIGHT for GHOST, or
     * NULL if max_bundles is too small. Valid until the first bundle of this
     * ghost and light is planned. */
    struct glint_light *(*gathered)(struct glint_flare *flare, int ghost,
                                    int light);
    /* Returns the fraction of its own light that light I keeps for GHOST, 0 to
     * GLINT_DIM_WHOLE_Q8; the rest is merged into another light. LIGHT is light
     * I as merged so far. */
    int (*kept_q8)(const struct glint_flare_frame *frame,
                   const struct glint_light *light, int i, int ghost);
    /* Pointers to glint_dim_own_rays_fraction_q8() and
     * glint_dim_wave_ratio_q16(). */
    int (*share_q8)(const struct glint_flare_frame *frame,
                    const struct glint_light *light, int ghost);
    int64_t (*ratio_q16)(const struct glint_flare_frame *frame,
                         int32_t sine_q30, int ghost, int wave);
};

/* Returns log2 of the ratio of the mean light of GHOST from LIGHT to the
 * frame's parameter dimmest; a value far above 0 if the mean light is not
 * known. */
int32_t glint_dim_brightness_log2_q8(const struct glint_flare_frame *frame,
                                     const struct glint_light *light,
                                     int ghost);

/* Returns the fraction of a wave's light, in ghost GHOST of LIGHT, that is
 * drawn with rays of that wave, 0 to GLINT_DIM_WHOLE_Q8; the rays of
 * GLINT_DIM_WAVE draw the rest. */
int glint_dim_own_rays_fraction_q8(const struct glint_flare_frame *frame,
                                   const struct glint_light *light, int ghost);

/* Returns the ratio of the ghost's light in wave WAVE to its light in
 * GLINT_DIM_WAVE, both without the colours of the waves; at most 2^27. */
int64_t glint_dim_wave_ratio_q16(const struct glint_flare_frame *frame,
                                 int32_t sine_q30, int ghost, int wave);

/* Returns the squared distance of two directions on the unit sphere, at most 4.
 */
uint64_t glint_light_squared_distance_q60(const struct glint_light *a,
                                          const struct glint_light *b);

/* Merges B into A: A gets the summed power, the mean colour and a direction
 * between both. Colours have GLINT_LIGHT_HELD additional fraction bits. */
void glint_light_merge(struct glint_light *a, const struct glint_light *b);

/* Returns log2 of X, interpolated linearly between powers of two. X must be
 * above 0. */
static inline int32_t glint_dim_log2_q8(struct glint_real x)
{
    return q_clamp_sat(x.exponent, -120, 120) * 256 + 30 * 256 +
           ((x.mantissa >> 22) - 256);
}

/* Returns the position of the angle whose sine is SINE in the table, as a
 * fractional node index. */
static inline int32_t glint_dim_node_q16(const struct glint_flare_frame *frame,
                                         int32_t sine_q30)
{
    const int64_t most = frame->lens->header->sine_hi_q30;

    return q_clamp_sat(
        q_divide((int64_t)sine_q30 * GLINT_DIM_LAST * (1 << 16), most), 0,
        GLINT_DIM_LAST * (1 << 16) - 1);
}

/* Returns the GLINT_DIM_VALUES logarithms of ghost GHOST at node NODE, for a
 * white light of power 1. First: log2 of the ghost's mean light by
 * GLINT_DIM_WAVE, display white, or of eight times that if the ghost folds.
 * Then, for each wave: log2 of all its light. */
static inline int16_t *glint_dim_values(const struct glint_flare_frame *frame,
                                        int node, int ghost)
{
    const int64_t at = (int64_t)node * frame->lens->header->n_ghosts + ghost;

    return frame->dim->log2_q8 + GLINT_DIM_VALUES * at;
}

#endif
