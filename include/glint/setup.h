/* SPDX-License-Identifier: MIT
 *
 * glint/setup.h - a lens prepared for drawing: its colours and its stop.
 */
#ifndef GLINT_SETUP_H
#define GLINT_SETUP_H

#include <stdint.h>

#include "glint/light.h"
#include "glint/model.h"
#include "glint/prescription.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_WAVELENGTHS 32
/* Waves of all sets together, see glint_setup_spread(). */
#define GLINT_SET_WAVES 65

/* Chooses N wavelengths, 1 .. GLINT_MAX_WAVELENGTHS, that stand for all of 400
 * .. 700 nm. WAVELENGTH_NM rises. The sum of RGB[i] times the light at
 * wavelength i is nearly the linear BT.709 that the CIE 1931 observer [Wyman13]
 * sees of the whole spectrum, exactly if that is a polynomial of a degree below
 * both 4 and N. Each channel of RGB sums to 1, so that a flat spectrum is
 * white; single colours lie outside BT.709 and are negative in part.
 * SHARE[i] is the part of wavelength i in the mean over all, and sums to 1.
 * Outlines of ghosts move in proportion to 1 / wavelength^2; the wavelengths
 * make the steps between them smallest in the mean of squares over the
 * channels. */
void glint_spectrum(int n, double *wavelength_nm, double (*rgb)[3],
                    double *share);

/* Returns the largest of three channels. */
double glint_largest_channel(const double rgb[3]);

/* Deviations of an aperture stop from clean, straight blades. All 0: none. */
struct glint_iris {
    /* Curvature of the blades' edges between the corners, 1 / stop radius: 0
     * straight .. 1 a circle. */
    double roundness;
    /* Stop radii, 0 .. 1, inwards from the outline, over which light rises from
     * none to all. */
    double softness;
    /* Fraction of the stop's circle that specks of dust cover, 0 .. 0.5; there
     * are scratches and smudges with them. The seed states where. */
    double dust;
    int dust_seed;
    /* [mask_height][mask_width]: light of a square of +-1 stop radius, 255: all
     * of it; NULL: there is no mask. It turns with the blades. Kept. */
    const uint8_t *mask;
    int mask_width, mask_height; /* 2 or more */
};

struct glint_dirt; /* opaque */

/* One wave of a set. */
struct glint_set_wave {
    double nm, rgb[3];
    double direct_flux, unit_flux; /* fluxes as in struct glint_setup, mm^2 */
};

/* A lens prepared for drawing: everything that does not depend on light or
 * frame. */
struct glint_setup {
    /* kept; NULL: the setup is made from a model. */
    const struct glint_prescription *lens;
    struct glint_optics optics;
    int n_ghosts;
    int n_parts; /* the last n_parts ghosts of a model are further parts of the
                    pupil of ghosts before them */
    struct glint_ghost ghost[GLINT_MAX_GHOSTS];
    double opening; /* radius of the stop over that of the model's, at most 1 */
    int n_blades;   /* blades of the stop; 0: circle */
    double blade_rotation_deg; /* angle of the stop's first corner, from x
                                  towards y */
    struct glint_iris iris;
    const struct glint_dirt *dirt; /* what lies in the stop; NULL: nothing */
    double clear; /* mean light that it lets through, 1 with nothing */
    int n_wavelengths;
    double wavelength_nm[GLINT_MAX_WAVELENGTHS];
    double rgb[GLINT_MAX_WAVELENGTHS][3]; /* linear BT.709; each channel sums
                                             to 1 */
    double direct_flux[GLINT_MAX_WAVELENGTHS]; /* through the stop at angle 0
                                                  for irradiance 1, mm^2 */
    double unit_flux[GLINT_MAX_WAVELENGTHS]; /* flux that light is measured by,
                                                mm^2: the mean of direct_flux,
                                                or itself after
                                                glint_setup_balance() */
    /* Set by glint_setup_spread(): sets of wavelengths, one after the other,
     * the smallest first. Each ghost takes one of them. */
    int n_sets, set_size[GLINT_MAX_WAVE_SETS];
    struct glint_set_wave set_wave[GLINT_SET_WAVES];
};

/* Prepares LENS with a stop of N_BLADES (0 or 3 .. 64; corners on the circle of
 * the f-number) for N wavelengths (1 .. GLINT_MAX_WAVELENGTHS, 300 .. 1100 nm).
 * Three wavelengths become R, G and B in the order given; any other number is
 * weighted by the CIE 1931 observer [Wyman13]. GLINT_E_ARGUMENT: out of range.
 * GLINT_E_LENS: no light gets through. */
enum glint_status glint_setup_init(struct glint_setup *setup,
                                   const struct glint_prescription *lens,
                                   int n_blades, double blade_rotation_deg,
                                   const double *wavelength_nm, int n,
                                   struct glint_error *error);

/* Prepares a model as glint_setup_init() does a lens table, for everything but
 * exact rays. A wavelength outside the model's band counts as the nearest
 * one inside. */
enum glint_status glint_setup_from_model(struct glint_setup *setup,
                                         const struct glint_lens *lens,
                                         int n_blades,
                                         double blade_rotation_deg,
                                         const double *wavelength_nm, int n,
                                         struct glint_error *error);

/* Sets the f-number of SETUP, made from LENS and not changed since, down to a
 * 1024th of the opening that the model was baked for. GLINT_E_ARGUMENT:
 * F_NUMBER requests less, or for more than the model's opening. */
enum glint_status glint_setup_stop_down(struct glint_setup *setup,
                                        const struct glint_lens *lens,
                                        double f_number,
                                        struct glint_error *error);

/* Gives SETUP, made before, the iris IRIS: its light is measured again, and
 * what glint_setup_weigh(), glint_setup_spread() and glint_setup_balance() set
 * has to be set again. Light is counted over that which the stop lets through;
 * one that is all black counts as if it were clear. *DIRT receives what SETUP
 * then refers to, or NULL. GLINT_E_ARGUMENT with ERROR: a member is out of
 * range. GLINT_E_MEMORY. */
enum glint_status glint_setup_iris(struct glint_setup *setup,
                                   const struct glint_iris *iris,
                                   struct glint_dirt **dirt,
                                   struct glint_error *error);

/* Frees DIRT, which may be NULL, after all setups and flares that refer to it.
 */
void glint_dirt_free(struct glint_dirt *dirt);

/* Returns the fraction of light that DIRT lets through at (X, Y) in the stop,
 * in stop radii, x right, y up, inside its outline. */
double glint_dirt_light(const struct glint_dirt *dirt, double x, double y);

/* Dust, scratches and smudges on the front element. All 0: there are none. */
struct glint_front {
    /* Fraction of the front element that specks of dust cover, 0 .. 0.5; there
     * are scratches and smudges with them. The seed states where. */
    double dust;
    int dust_seed;
    /* [mask_height][mask_width]: the square about the front element, up is up,
     * 255: clear glass, 0: covered; NULL: there is no mask. Copied. */
    const uint8_t *mask;
    int mask_width, mask_height; /* 2 or more */
};

struct glint_front_dirt; /* opaque */

/* Makes what lies on a front element, for any number of lenses. *DIRT is NULL
 * if nothing does. GLINT_E_ARGUMENT: a member is out of range; GLINT_E_MEMORY;
 * both with ERROR. */
enum glint_status glint_front_make(struct glint_front_dirt **dirt,
                                   const struct glint_front *front,
                                   struct glint_error *error);

/* Frees DIRT, which may be NULL, after all that draws with it. */
void glint_front_free(struct glint_front_dirt *dirt);

/* Gives SETUP the colours of glint_spectrum(), if its N wavelengths came from
 * there. */
void glint_setup_weigh(struct glint_setup *setup);

/* Gives SETUP, made from LENS, the sets of wavelengths from which each ghost
 * chooses. LENS is NULL if SETUP is made from a lens table, for at least three
 * different wavelengths. */
void glint_setup_spread(struct glint_setup *setup,
                        const struct glint_lens *lens);

/* Normalises each wavelength by its own direct image, like a camera that is
 * white-balanced behind this lens. Otherwise the ghosts have the lens's own
 * tint, like the rest of the picture. */
void glint_setup_balance(struct glint_setup *setup);

/* Sets STOP to the stop of SETUP, in the form that a flare takes. */
void glint_setup_stop(const struct glint_setup *setup, struct glint_stop *stop);

#ifdef __cplusplus
}
#endif

#endif
