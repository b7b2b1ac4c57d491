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
/* Total number of wavelengths in all sets, see glint_setup_spread(). */
#define GLINT_SET_WAVES 65

/* Chooses N wavelengths, 1 .. GLINT_MAX_WAVELENGTHS, that represent the
 * spectrum of 400 .. 700 nm, and sets WAVELENGTH_NM to them in rising order.
 * The sum over i of RGB[i] times the light at wavelength i approximates the
 * linear BT.709 colour that the CIE 1931 observer [Wyman13] sees of the whole
 * spectrum. It is exact if the spectrum is a polynomial of a degree below both
 * 4 and N. Each channel of RGB sums to 1, so that a flat spectrum is white.
 * Some channels are negative, because colours of single wavelengths lie outside
 * BT.709. SHARE[i] is the weight of wavelength i in the mean of all
 * wavelengths; SHARE sums to 1. Outlines of ghosts move in proportion to 1 /
 * wavelength^2. The chosen wavelengths minimise the mean square, over the
 * channels, of the steps between outlines. */
void glint_spectrum(int n, double *wavelength_nm, double (*rgb)[3],
                    double *share);

/* How the wavelengths of a setup are chosen. AUTO: each ghost has as many as it
 * needs. COUNT: glint_spectrum() chooses N. LIST: the caller lists them. */
enum glint_waves_kind { GLINT_WAVES_AUTO, GLINT_WAVES_COUNT, GLINT_WAVES_LIST };
struct glint_waves {
    enum glint_waves_kind kind;
    int n;                            /* number of wavelengths; undefined for
                                         AUTO */
    double nm[GLINT_MAX_WAVELENGTHS]; /* wavelengths of a LIST, [n]; otherwise
                                         undefined */
};

/* Sets NM to the wavelengths of WAVES, those of red, green and blue for AUTO.
 * Returns their number. */
int glint_waves_list(const struct glint_waves *waves,
                     double nm[GLINT_MAX_WAVELENGTHS]);

/* Returns the largest of three channels. */
double glint_largest_channel(const double rgb[3]);

/* Deviations of an aperture stop from clean, straight blades. All 0: no
 * deviations. */
struct glint_iris {
    /* Curvature of the edges of the blades between the corners, 1 / stop radii:
     * 0 (straight) .. 1 (a circle). */
    double roundness;
    /* Width of the soft edge, stop radii, 0 .. 1. The transmission rises from 0
     * at the outline to 1 at this distance inside it. */
    double softness;
    /* Fraction of the stop's circle that specks of dust cover, 0 .. 0.5;
     * scratches and smudges are added to them. dust_seed selects all
     * positions. */
    double dust;
    int dust_seed;
    /* Transmission over a square of +-1 stop radius, [mask_height][mask_width];
     * 255: all light. NULL: there is no mask. The mask turns with the blades.
     * It is not copied and must outlive the setup. */
    const uint8_t *mask;
    int mask_width, mask_height; /* sides of the mask, pixels, 2 or more */
};

struct glint_dirt; /* opaque */

/* A wavelength of a set, see set_wave of struct glint_setup. */
struct glint_set_wave {
    double nm, rgb[3];
    double direct_flux, unit_flux; /* fluxes, mm^2, as in struct glint_setup */
};

/* A lens prepared for drawing: values that do not depend on lights or
 * frames. */
struct glint_setup {
    /* The lens table, which must outlive the setup; NULL: the setup is made
     * from a model. */
    const struct glint_prescription *lens;
    struct glint_optics optics;
    int n_ghosts;
    int n_parts; /* the last n_parts ghosts of a model are additional pupil
                    regions of earlier ghosts */
    struct glint_ghost ghost[GLINT_MAX_GHOSTS];
    double opening; /* radius of the stop / radius of the stop of the model, at
                       most 1 */
    int n_blades;   /* blades of the stop; 0: circle */
    double blade_rotation_deg; /* angle of the stop's first corner, from x
                                  towards y */
    struct glint_iris iris;
    const struct glint_dirt *dirt; /* dust and mask in the stop; NULL: none */
    double clear; /* mean transmission of dust and mask; 1 if DIRT is NULL */
    int n_wavelengths;
    double wavelength_nm[GLINT_MAX_WAVELENGTHS];
    double rgb[GLINT_MAX_WAVELENGTHS][3]; /* linear BT.709; each channel sums
                                             to 1 */
    double direct_flux[GLINT_MAX_WAVELENGTHS]; /* flux of the direct image
                                                  through the stop at angle 0
                                                  for irradiance 1, mm^2 */
    /* Flux that counts as light 1, mm^2: the mean of direct_flux over the
     * wavelengths. After glint_setup_balance() it is direct_flux of each
     * wavelength. */
    double unit_flux[GLINT_MAX_WAVELENGTHS];
    /* Set by glint_setup_spread(): sets of wavelengths, one after the other,
     * the smallest set first. Each ghost uses one set. */
    int n_sets, set_size[GLINT_MAX_WAVE_SETS];
    struct glint_set_wave set_wave[GLINT_SET_WAVES];
    /* Parts of the direct light that grow with the second and the fourth power
     * of the distance from the centre of the stop, as fractions of the light
     * through eight straight blades. 0 except for models of fast lenses. */
    double falloff[GLINT_MAX_WAVELENGTHS][2];
};

/* Prepares LENS with a stop of N_BLADES (0 or 3 .. 64; corners on the circle of
 * the f-number) for N wavelengths (1 .. GLINT_MAX_WAVELENGTHS, 300 .. 1100 nm).
 * Three wavelengths become R, G and B in the order given; any other number is
 * weighted by the CIE 1931 observer [Wyman13]. Returns GLINT_E_ARGUMENT if a
 * parameter is out of range. Returns GLINT_E_LENS if no light gets through. */
enum glint_status glint_setup_init(struct glint_setup *setup,
                                   const struct glint_prescription *lens,
                                   int n_blades, double blade_rotation_deg,
                                   const double *wavelength_nm, int n,
                                   struct glint_error *error);

/* Like glint_setup_init(), in a tenth of the time. The flux of the direct
 * light, and so the brightness of a picture, differs by less than 0.1 %. */
enum glint_status glint_setup_init_draft(struct glint_setup *setup,
                                         const struct glint_prescription *lens,
                                         int n_blades,
                                         double blade_rotation_deg,
                                         const double *wavelength_nm, int n,
                                         struct glint_error *error);

/* Prepares a model as glint_setup_init() prepares a lens table, for everything
 * except exact rays. Wavelengths are clamped to the band of the model. */
enum glint_status glint_setup_from_model(struct glint_setup *setup,
                                         const struct glint_lens *lens,
                                         int n_blades,
                                         double blade_rotation_deg,
                                         const double *wavelength_nm, int n,
                                         struct glint_error *error);

/* Sets the f-number of SETUP. SETUP must have been made from LENS, and must not
 * have been changed since. Returns GLINT_E_ARGUMENT if F_NUMBER is below the
 * f-number of the model, or above 1024 times it. */
enum glint_status glint_setup_stop_down(struct glint_setup *setup,
                                        const struct glint_lens *lens,
                                        double f_number,
                                        struct glint_error *error);

/* Sets the iris of SETUP, which must be initialised, to IRIS and computes the
 * fluxes of SETUP again. Programs that use glint_setup_weigh(),
 * glint_setup_spread() or glint_setup_balance() must call these again. Light is
 * relative to the light that the stop transmits; an opaque stop counts as
 * clear. *DIRT receives the dust and mask that SETUP refers to, or NULL.
 * Returns GLINT_E_ARGUMENT and sets ERROR if a member is out of range. May
 * return GLINT_E_MEMORY. */
enum glint_status glint_setup_iris(struct glint_setup *setup,
                                   const struct glint_iris *iris,
                                   struct glint_dirt **dirt,
                                   struct glint_error *error);

/* Frees DIRT, which may be NULL. Setups and flares that refer to it must not be
 * used any more. */
void glint_dirt_free(struct glint_dirt *dirt);

/* Returns the transmission of DIRT at (X, Y), a point inside the outline of the
 * stop, in stop radii, x right, y up. */
double glint_dirt_light(const struct glint_dirt *dirt, double x, double y);

/* Dust, scratches and smudges on the front element. All 0: the element is
 * clean. */
struct glint_front {
    /* Fraction of the front element that specks of dust cover, 0 .. 0.5;
     * scratches and smudges are added to them. dust_seed selects all
     * positions. */
    double dust;
    int dust_seed;
    /* Transmission of the square around the front element,
     * [mask_height][mask_width], top row first; 255: clear glass, 0: covered.
     * NULL: there is no mask. The mask is copied. */
    const uint8_t *mask;
    int mask_width, mask_height; /* sides of the mask, pixels, 2 or more */
};

struct glint_front_dirt; /* opaque */

/* Makes the dirt of a front element, for any number of lenses. *DIRT receives
 * NULL if FRONT is clean. Returns GLINT_E_ARGUMENT if a member is out of range.
 * May return GLINT_E_MEMORY. Both set ERROR. */
enum glint_status glint_front_make(struct glint_front_dirt **dirt,
                                   const struct glint_front *front,
                                   struct glint_error *error);

/* Frees DIRT, which may be NULL. Engines that draw with it must be destroyed
 * before. */
void glint_front_free(struct glint_front_dirt *dirt);

/* Sets the colour of each wavelength of SETUP to the colour that
 * glint_spectrum() returns. glint_spectrum() must also have chosen the
 * wavelengths. */
void glint_setup_weigh(struct glint_setup *setup);

/* Adds to SETUP, made from LENS, the sets of wavelengths from which each ghost
 * selects one. LENS is NULL if SETUP is made from a lens table; it must then
 * have at least three different wavelengths. */
void glint_setup_spread(struct glint_setup *setup,
                        const struct glint_lens *lens);

/* Normalises each wavelength by the flux of its own direct image, as a camera
 * does that is white-balanced behind this lens. Otherwise the ghosts have the
 * tint of the lens, like the rest of the picture. */
void glint_setup_balance(struct glint_setup *setup);

/* Sets STOP to the stop of SETUP, for struct glint_flare_config. */
void glint_setup_stop(const struct glint_setup *setup, struct glint_stop *stop);

#ifdef __cplusplus
}
#endif

#endif
