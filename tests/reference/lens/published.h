/* SPDX-License-Identifier: MIT
 *
 * Fits a ghost by the published method [Bodonyi25], for comparison with ours.
 *
 *   in   a ghost of a lens, wavelengths, the field that counts
 *   out  for every wavelength (and range of angles in which the ghost is seen)
 *        polynomials in x, y, r and 1 - r of stop, sensor, energy and largest
 *        relative radius, with coefficients at knots that are equal angles
 *        apart
 *
 * Method: a zone is the surroundings of a knot. Rays are traced all over the
 * ghost's pupil box there, joined with the boxes of the neighbouring knots, so
 * that interpolated polynomials are good wherever either knot lets light
 * through. One sparse basis for each output, found on some of the zones
 * (shared_basis.h), serves all of them. It serves all wavelengths, too, which
 * the method leaves open: the search takes zones of each wavelength in turn, in
 * a third of the time.
 *
 * Limits: those of the search for visible light (bake/visible/visible.h);
 * ranges and boxes are shared by all wavelengths; boxes are interpolated
 * between those of that search's profile. Between two knots the error is that
 * of the interpolation: where the box moves by its own size from knot to knot
 * it is much larger than at the knots. */
#ifndef REFERENCE_LENS_PUBLISHED_H
#define REFERENCE_LENS_PUBLISHED_H

#include "bake/fit/fitted.h"
#include "glint/setup.h"

/* Polynomials for a wavelength and a range of angles. */
struct glint_published_system {
    int ghost;
    double sine_lo, sine_hi;
    double wave_lo, wave_hi; /* 1 / wavelength^2, um^-2; equal */
    int n_knots;
    double *knot;     /* sines, rising */
    double *box;      /* mm [n_knots][3]: middle, half width, half height */
    double radius_mm; /* 1 in x, y and r */
    int n_outputs;
    struct glint_fitted_output output[GLINT_OUT_KINDS]; /* COEF is
                                                           [n_knots][n_terms] */
    bool met;
};

struct glint_published_ghost {
    int n_systems;
    struct glint_published_system *system;
};

void glint_published_finish(struct glint_published_ghost *ghost);

struct glint_published_options {
    int n_zones;    /* number of angles from 0 to max_deg, at least 2; 241 as
                       published */
    double max_deg; /* degrees, at most 89; 60 as published */
    int max_terms;  /* per output, 1 .. 12 */
    const double *wavelength_nm; /* in any order, all different */
    int n_wavelengths;           /* 1 .. GLINT_MAX_WAVELENGTHS */
    double field_mm; /* radius about the sensor's centre beyond which light does
                        not count */
};

/* Sets OPTIONS to 241 zones, 60 degrees, 5 terms for lenses of up to 20
 * surfaces and 10 for others, the wavelengths of SETUP, which are kept, and
 * half the diagonal of its film. */
void glint_published_defaults(struct glint_published_options *options,
                              const struct glint_setup *setup);

/* Fits GHOST of SETUP; OUT has no systems if it is never seen. radius_mm is a
 * power of two, equal for all systems of the ghost, and r = hypot(x, y) is at
 * most 1 in every box. An output met the tolerance if its root mean square
 * error over the knots did: 0.0002 mm, 0.0002 stop radii and relative radii,
 * 0.1 % of the energy. GLINT_E_ARGUMENT, GLINT_E_MEMORY: OUT is empty.
 * Deterministic. */
enum glint_status
glint_published_fit(const struct glint_setup *setup, int ghost,
                    const struct glint_published_options *options,
                    struct glint_published_ghost *out);

#endif
