/* SPDX-License-Identifier: MIT
 *
 * glint/dials.h - the quality parameters of a frame, which trade accuracy for
 * time.
 *
 *     cfg.dials = glint_dials_at(1 << 14);                  the default
 *     cfg.dials = glint_dials_coarser(cfg.dials, glint_dials_at(1 << 12));
 *
 * There are several copies of this small struct: the parameters that were
 * requested, the parameters chosen to meet a budget, and the parameters that a
 * measurement varies. */
#ifndef GLINT_DIALS_H
#define GLINT_DIALS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Max sum of veil and haze, as a fraction of all light. */
#define GLINT_MOST_VEIL 0.9

enum glint_dial_flag {
    /* Pictures of integer codes (not linear light) are drawn at half
     * resolution. */
    GLINT_DIAL_HALF = 1,
    /* Like GLINT_DIAL_HALF, but a time budget does not clear the flag. */
    GLINT_DIAL_ALWAYS_HALF = 2,
    GLINT_DIAL_NO_VEIL = 4 /* veil and haze are not drawn */
};

struct glint_dials {
    /* Number of cells per side of ray grids, 4 .. GLINT_MAX_CELLS, as in struct
     * glint_flare_frame. At 64, the straight lines between rays are off by 0.01
     * pixels on average. */
    int fineness;
    /* Number of steps per octave to which irradiance is rounded, 1 .. 4096; 0:
     * irradiance is not rounded. */
    int irradiance_steps;
    /* Edges of a ghost's cells are snapped to the pixel grid if the light
     * changes across them by fewer codes than this; 0: no edge is snapped. */
    int snap_codes_q8;
    /* Max distance between a ghost's outlines in neighbouring wavelengths,
     * pixels; ghosts with larger distances use more wavelengths. 0: all ghosts
     * use three wavelengths. */
    int dispersion_q8;
    int max_lights; /* max number of lights; more are merged, faint ones first
                     */
    unsigned flags; /* enum glint_dial_flag */
    /* Light that adds fewer codes than this to a black pixel may be left
     * out. */
    double cull_codes;
    double area_points; /* max number of points into which a lamp with an extent
                           is divided */
    /* Ghosts that add fewer codes than this to a black pixel count as dim. A
     * dim ghost is drawn with the rays of only one of the three wavelengths,
     * and merged with the same ghost of near-by lights; see dimmest of struct
     * glint_flare_frame. */
    double dim_codes;
    /* Tolerance for reusing rays in a video, pixels: the traced rays of a light
     * are used again if the light has moved by less. 0: rays are always
     * traced. */
    double still_px;
    /* Log2 of the number of cells per side of the finest tables of dust and
     * masks, 3 .. GLINT_SHADE_MOST_LOG2. Lower values blur the specks and
     * preserve the total light. */
    int dust_log2;
    uint64_t reserved[4]; /* must be 0, as in struct glint_engine_config */
};

/* Returns the quality parameters at QUALITY_Q15, 0 .. 2^15, on the measured
 * Pareto front of error and time; 2^14 is the default. */
struct glint_dials glint_dials_at(int quality_q15);

/* Returns, for each quality parameter, the coarser of its two values in A and
 * B. Exception: irradiance_steps and dispersion_q8 are 0 if they are 0 in A or
 * B. */
struct glint_dials glint_dials_coarser(struct glint_dials a,
                                       struct glint_dials b);

#ifdef __cplusplus
}
#endif

#endif
