/* SPDX-License-Identifier: MIT
 *
 * glint/dials.h - the settings of a frame that trade accuracy for time.
 *
 *     cfg.dials = glint_dials_at(1 << 14);                  the default
 *     cfg.dials = glint_dials_coarser(cfg.dials, glint_dials_at(1 << 12));
 *
 * A small struct that is copied freely. The settings that are requested, those
 * that a budget chose and those that a measurement turns are each one of these.
 */
#ifndef GLINT_DIALS_H
#define GLINT_DIALS_H

#ifdef __cplusplus
extern "C" {
#endif

/* Most of all light that may be veil. */
#define GLINT_MOST_VEIL 0.9

enum glint_dial_flag {
    GLINT_DIAL_HALF = 1, /* pictures in codes are drawn with half
                            as many pixels each way */
    /* GLINT_DIAL_HALF, and a budget does not change it. */
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
    int snap_codes_q8;  /* edges weaker than so many codes lie on whole pixels;
                           0: none do */
    int dispersion_q8;  /* pixels that outlines of neighbouring wavelengths
                           may be apart; 0: three wavelengths for all */
    int max_lights;     /* largest number of lights; more are merged, faint ones
                           first */
    unsigned flags;     /* enum glint_dial_flag */
    double cull_codes;  /* codes near black below which light may be left out */
    double area_points; /* points, at most, that a lamp with an extent is drawn
                           as */
    double dim_codes;   /* codes near black; a ghost of a light that gives fewer
                           is drawn by the rays of one of three wavelengths, and
                           with those of lights near by, see dimmest of struct
                           glint_flare_frame */
    double star_cull;   /* factor on cull_codes for stars, which end smoothly
                           and faintly, unlike ghosts */
    double still_px; /* pixels of a video that a light may move while its rays
                        are those of before; 0: none */
    int dust_log2;   /* log2 of the cells a side of the finest table of dust and
                        masks that is used, 3 .. GLINT_SHADE_MOST_LOG2; coarser
                        ones keep the light and blur the specks */
};

/* Returns the dials at QUALITY_Q15, 0 .. 2^15, along the measured front of
 * accuracy over time; 2^14 is the default. */
struct glint_dials glint_dials_at(int quality_q15);

/* Returns each dial of A or B, whichever is coarser. If either does not round
 * irradiance, or draws three wavelengths, so does the result. */
struct glint_dials glint_dials_coarser(struct glint_dials a,
                                       struct glint_dials b);

#ifdef __cplusplus
}
#endif

#endif
