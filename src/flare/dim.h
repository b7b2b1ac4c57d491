/* SPDX-License-Identifier: MIT
 *
 * Table of the brightness of each ghost of a lens, by wavelength and by angle
 * of the light. If a ghost is so dim that its coloured outlines cannot be
 * distinguished, it is drawn with the rays of one wavelength instead of three.
 * nodes.c fills the table. */
#ifndef GLINT_FLARE_DIM_H
#define GLINT_FLARE_DIM_H

#include "base/divide.h"
#include "base/q.h"
#include "base/real.h"
#include "glint/flare.h"

enum {
    GLINT_DIM_WAVE = 1,  /* index of the wavelength whose rays also draw the
                            other wavelengths of a dim ghost */
    GLINT_DIM_WAVES = 3, /* number of wavelengths in the table; frames with
                            another number do not use it */
    GLINT_DIM_WHOLE_Q8 = 256,
    GLINT_DIM_LAST = GLINT_DIM_NODES - 1,
    GLINT_DIM_DARK = INT16_MIN, /* table value of a wavelength that does not
                                   pass through the lens */
    GLINT_LIGHT_HELD =
        14 /* additional fraction bits of colours while lights are merged */
};

struct glint_flare;

/* Functions of the table, called through pointers, so that programs without the
 * table do not link them. */
struct glint_dim_method {
    /* Computes those nodes (sampled angles) of the table that the plan's first
     * N_LIGHTS lights need and that have not been computed before. */
    void (*fill_nodes)(struct glint_flare *flare, int n_lights);
    /* Merges lights that are close together, separately for each ghost, among
     * the plan's first N_LIGHTS lights. A light is merged into the nearest
     * light before it in the list, and both are drawn as one light between
     * them, if the ghost is so dim that the shift is invisible. The brighter
     * the ghost, the smaller is the merged fraction of the light. */
    void (*merge_near_lights)(struct glint_flare *flare, int n_lights);
    /* Returns the merged light that replaces LIGHT for GHOST, or NULL if
     * max_bundles is too small. The pointer is valid until the first ray bundle
     * of this ghost and light is planned. */
    struct glint_light *(*merged_light)(struct glint_flare *flare, int ghost,
                                        int light);
    /* Returns the fraction of LIGHT that is not merged into another light for
     * GHOST, 0 .. GLINT_DIM_WHOLE_Q8. LIGHT is light number I plus all light
     * that was merged into it. */
    int (*unmerged_fraction_q8)(const struct glint_flare_frame *frame,
                                const struct glint_light *light, int i,
                                int ghost);
    /* glint_dim_compute_own_rays_fraction_q8() and
     * glint_dim_compute_wave_ratio_q16(), see below. */
    int (*own_rays_q8)(const struct glint_flare_frame *frame,
                       const struct glint_light *light, int ghost);
    int64_t (*wave_ratio_q16)(const struct glint_flare_frame *frame,
                              int32_t sine_q30, int ghost, int wave);
};

/* Returns log2 of (mean light of GHOST from LIGHT / the frame's parameter
 * dimmest, below which ghosts count as dim). Returns 256, far above any ratio,
 * if the table does not have the mean light. */
int32_t
glint_dim_compute_brightness_log2_q8(const struct glint_flare_frame *frame,
                                     const struct glint_light *light,
                                     int ghost);

/* Returns the fraction of a wavelength's light that is drawn with its own rays,
 * 0 .. GLINT_DIM_WHOLE_Q8, the same for all wavelengths of GHOST and LIGHT. The
 * rest is drawn with the rays of GLINT_DIM_WAVE. */
int glint_dim_compute_own_rays_fraction_q8(
    const struct glint_flare_frame *frame, const struct glint_light *light,
    int ghost);

/* Returns (light of GHOST in wavelength WAVE) / (its light in GLINT_DIM_WAVE)
 * at the angle whose sine is SINE; at most 2^11. The colours of wavelengths are
 * not included. */
int64_t glint_dim_compute_wave_ratio_q16(const struct glint_flare_frame *frame,
                                         int32_t sine_q30, int ghost, int wave);

/* Returns the squared distance between two directions on the unit sphere, at
 * most 4. */
uint64_t glint_light_compute_squared_distance_q60(const struct glint_light *a,
                                                  const struct glint_light *b);

/* Merges light B into A: A gets the sum of the powers, and the means of colour
 * and direction weighted by power. Colours have GLINT_LIGHT_HELD additional
 * fraction bits. */
void glint_light_merge(struct glint_light *a, const struct glint_light *b);

/* Returns log2 of X, interpolated linearly between powers of two. X must be
 * above 0. */
static inline int32_t glint_dim_compute_log2_q8(struct glint_real x)
{
    return q_clamp_sat(x.exponent, -120, 120) * 256 + 30 * 256 +
           ((x.mantissa >> 22) - 256);
}

/* Converts the sine of an angle to a fractional index of the table's nodes. */
static inline int32_t
glint_dim_find_node_q16(const struct glint_flare_frame *frame, int32_t sine_q30)
{
    const int64_t most = frame->lens->header->sine_hi_q30;

    return q_clamp_sat(
        q_divide((int64_t)sine_q30 * GLINT_DIM_LAST * (1 << 16), most), 0,
        GLINT_DIM_LAST * (1 << 16) - 1);
}

/* Returns the GLINT_DIM_VALUES table values of ghost GHOST at node NODE, for a
 * white light of power 1. All are logarithms to base 2 of light, 1 = display
 * white. Value 0: mean light in GLINT_DIM_WAVE; eight times that if the ghost
 * is folded. Value 1 + w: total light of wavelength w. */
static inline int16_t *
glint_dim_get_values(const struct glint_flare_frame *frame, int node, int ghost)
{
    const int64_t at = (int64_t)node * frame->lens->header->n_ghosts + ghost;

    return frame->dim->log2_q8 + GLINT_DIM_VALUES * at;
}

#endif
