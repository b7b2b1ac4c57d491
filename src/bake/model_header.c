/* SPDX-License-Identifier: MIT */
#include "bake/model_header.h"

#include <math.h>
#include <stdio.h>

#include "bake/regress/regress.h"
#include "bake/visible/visible.h"
#include "bake/options.h"
#include "bake/skew/skew_fit.h"
#include "bake/trace/cells.h"
#include "engine/setup/setup.h"

enum {
    FLUX_NODES = 9,
    BLADES = 8 /* of the stop by which the flux of wide stops is taken */
};

/* Sets COEF to the polynomial in w that fits FLUX at the nodes W of the band.
 */
static void fit_flux(const double *w, const double *flux, double scale,
                     struct glint_real *coef)
{
    static const double zero[FLUX_NODES];
    double one[FLUX_NODES];
    double scratch[GLINT_REGRESS_DOUBLES(FLUX_NODES, GLINT_FLUX_TERMS,
                                         GLINT_FLUX_TERMS,
                                         2 * GLINT_FLUX_TERMS - 1)];
    const struct glint_regress_samples samples = {
        FLUX_NODES, {zero, zero, zero, w}, one};
    const struct glint_degrees degrees = {
        .most = {0, 0, 0, GLINT_FLUX_TERMS - 1},
        .weight = {1, 1, 1, 1},
        .total = GLINT_FLUX_TERMS - 1,
        .parity = -1,
        .terms = GLINT_FLUX_TERMS};
    struct glint_poly poly;

    for (int i = 0; i < FLUX_NODES; i++)
        one[i] = 1;
    glint_regress_fit(scratch, &samples, flux, &degrees, 1e-7 * scale,
                      1e-7 * scale, &poly);
    for (int i = 0; i < poly.n; i++)
        coef[poly.power[i][3]] = glint_real_of(poly.coef[i]);
}

/* Returns the direct image's flux at NM through a stop of AREA times the whole
 * one's, over AREA; below 0 if memory is short. The barrels of a fast lens cut
 * the rim of its widest stop, where blades reach with their corners alone: of
 * wide stops it is taken through blades, and divided by their share of the
 * circle, by which a program multiplies it. Through circles f/1.4 of
 * merte-biotar came out 10 % too bright, f/2 of tronnier-double-gauss 2.6 %. */
static double flux_of(const struct glint_setup *whole, double area, double nm)
{
    struct glint_setup setup = *whole;

    setup.optics.stop_radius_mm *= sqrt(area);
    if (whole->lens->f_number < GLINT_WIDE)
        setup.n_blades = BLADES;
    return glint_direct_flux(&setup, nm) / area / glint_iris_share(&setup);
}

/* Sets the direct image's flux over the stop's area, for the whole stop and for
 * smaller ones. Energy and the pupil's aberration are even in the place on the
 * pupil, so the flux is smooth in the square of the stop's radius. It is traced
 * at three squares: the whole, a half and an eighth. */
static enum glint_status set_flux(const struct glint_bake_options *options,
                                  const struct glint_setup *whole,
                                  struct glint_model_header *h)
{
    /* Closed shares of the stop's area. */
    static const double closed[2] = {0.5, 0.875};
    const double *band = options->band_nm;
    const double lo = 1 / (band[1] * band[1]), hi = 1 / (band[0] * band[0]);
    double w[FLUX_NODES], flux[3][FLUX_NODES], more[2][FLUX_NODES];

    for (int i = 0; i < FLUX_NODES; i++) {
        const double half = 0.5 * (hi - lo);
        double off[2];

        w[i] = 2.0 * i / (FLUX_NODES - 1) - 1;
        for (int k = 0; k < 3; k++) {
            flux[k][i] = flux_of(whole, k ? 1 - closed[k - 1] : 1,
                                 1 / sqrt(0.5 * (lo + hi) + w[i] * half));
            if (flux[k][i] < 0)
                return GLINT_E_MEMORY;
        }
        for (int k = 0; k < 2; k++)
            off[k] = (flux[k + 1][i] - flux[0][i]) / closed[k];
        more[1][i] = (off[1] - off[0]) / (closed[1] - closed[0]);
        more[0][i] = off[0] - closed[0] * more[1][i];
    }
    fit_flux(w, flux[0], flux[0][0], h->direct_flux);
    for (int k = 0; k < 2; k++)
        fit_flux(w, more[k], flux[0][0], h->stopped_flux[k]);
    return GLINT_OK;
}

enum glint_status
glint_model_header_of(const struct glint_prescription *lens,
                      const struct glint_bake_options *options,
                      const struct glint_setup *setup,
                      struct glint_model_header *header)
{
    struct glint_model_header *const h = header;
    const struct glint_optics *o = &setup->optics;
    const double *band = options->band_nm;
    const uint64_t key = glint_bake_key(lens, options);

    *h = (struct glint_model_header){
        .magic = GLINT_MODEL_MAGIC,
        .version = GLINT_MODEL_VERSION,
        .basis = glint_prescription_is_round(lens)
                     ? (uint32_t)GLINT_BASIS_AUTO
                     : GLINT_BASIS_LENS + glint_skew_mirrors(lens),
        .key = {(uint32_t)key, (uint32_t)(key >> 32)},
        .focal_mm = glint_real_of(o->focal_mm),
        .back_focal_mm = glint_real_of(o->back_focal_mm),
        .entrance_radius_mm = glint_real_of(o->entrance_radius_mm),
        .stop_radius_mm = glint_real_of(o->stop_radius_mm),
        .f_number = glint_real_of(lens->f_number),
        .film_width_mm = glint_real_of(lens->film_width_mm),
        .film_height_mm = glint_real_of(lens->film_height_mm),
        .field_mm = glint_real_of(glint_bake_field_mm(lens, options)),
        .front_mm = glint_real_of(lens->surface[0].semi_mm),
        .wave_lo_q24 = (int32_t)lrint(0x1p24 * 1e6 / (band[1] * band[1])),
        .wave_hi_q24 = (int32_t)lrint(0x1p24 * 1e6 / (band[0] * band[0])),
        .sine_hi_q30 = (int32_t)lrint(
            0x1p30 * sin(options->max_deg * 0.017453292519943295)),
        .n_surfaces = (uint32_t)lens->n_surfaces};
    snprintf(h->name, sizeof h->name, "%s", lens->name);
    return set_flux(options, setup, h);
}
