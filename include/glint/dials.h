/* SPDX-License-Identifier: MIT
 *
 * glint/dials.h - the quality parameters of a frame, which trade accuracy for
 * time.
 *
 *     cfg.dials = glint_dials_at(1 << 14);                  the default
 *     cfg.dials = glint_dials_coarser(cfg.dials, glint_dials_at(1 << 12));
 *
 * A small struct that is copied freely: the requested parameters, those that
 * a budget chose, and those that a measurement varies.
 */
#ifndef GLINT_DIALS_H
#define GLINT_DIALS_H

#ifdef __cplusplus
extern "C" {
#endif

/* Max fraction of all light that may be veil. */
#define GLINT_MOST_VEIL 0.9

enum glint_dial_flag {
    GLINT_DIAL_HALF = 1, /* pictures in codes are drawn at half resolution */
    /* GLINT_DIAL_HALF is fixed: a budget does not change it. */
    GLINT_DIAL_ALWAYS_HALF = 2,
    GLINT_DIAL_NO_VEIL = 4 /* veil and haze are left out */
};

struct glint_dials {
    /* fineness of ray grids, 4 .. GLINT_MAX_CELLS, as in struct
     * glint_flare_frame; with 64, straight lines between rays are 0.01 pixels
     * off in the mean */
    int fineness;
    int irradiance_steps; /* steps an octave, 1 .. 4096; 0: irradiance is not
                             rounded */
    int snap_codes_q8; /* edges with a smaller step than so many codes are moved
                          to whole pixels; 0: none */
    int dispersion_q8; /* max distance of outlines of neighbouring wavelengths,
                          pixels; 0: three wavelengths for all */
    int max_lights; /* max number of lights; more are merged, faint ones first
                     */
    unsigned flags; /* enum glint_dial_flag */
    double cull_codes;  /* codes near black below which light may be left out */
    double area_points; /* max points of a lamp with an extent */
    double
        dim_codes; /* codes near black; a fainter ghost is drawn with the rays
                      of one of three wavelengths, and merged with those of
                      near-by lights, see dimmest of struct glint_flare_frame */
    double star_cull; /* factor on cull_codes for stars, whose ends are smooth
                         and faint, unlike ends of ghosts */
    double still_px;  /* static tolerance, pixels: a light of a video that moved
                         less reuses its rays; 0: none */
    int dust_log2; /* log2 of the cells per side of the finest table of dust and
                      masks in use, 3 .. GLINT_SHADE_MOST_LOG2; coarser ones
                      preserve the light and blur the specks */
};

/* Returns the dials at QUALITY_Q15, 0 .. 2^15, along the measured Pareto
 * front of error and time; 2^14 is the default. */
struct glint_dials glint_dials_at(int quality_q15);

/* Returns the coarser of each dial of A and B. If either does not round
 * irradiance, or draws three wavelengths, so does the result. */
struct glint_dials glint_dials_coarser(struct glint_dials a,
                                       struct glint_dials b);

#ifdef __cplusplus
}
#endif

#endif
