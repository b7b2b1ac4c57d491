/* SPDX-License-Identifier: MIT */
#include "bake/model_header.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bake/fit/brightness.h"
#include "bake/regress/regress.h"
#include "bake/trace/cells.h"
#include "bake/visible/visible.h"
#include "engine/setup/setup.h"
#include "glint/model.h"

enum {
    /* Revision of the baker, part of the cache key. A change that makes lenses
     * bake to different models raises it, so that cached models are baked
     * again. */
    REVISION = 14,
    /* revision for lenses faster than GLINT_WIDE, replaces REVISION */
    WIDE_REVISION = 18,
    /* further revision in the key of lenses with non-spherical surfaces */
    SHAPED_REVISION = 1,
    /* further revision in the key of lenses that are not round */
    SKEW_REVISION = 2,
    /* further revision in the key of round lenses that are baked for lights
     * beyond GLINT_FAR degrees */
    FAR_REVISION = 3
};

void glint_bake_defaults(struct glint_bake_options *options)
{
    *options = (struct glint_bake_options){
        .band_nm = {400, 700}, .max_deg = 60, .tolerance = 1};
}

enum glint_status
glint_bake_check_options(const struct glint_bake_options *options,
                         struct glint_error *error)
{
    const struct glint_bake_options *const o = options;
    const char *wrong =
        !(o->band_nm[0] >= 300 && o->band_nm[1] <= 1100 &&
          o->band_nm[0] + 1 <= o->band_nm[1])
            ? "the band must be two ascending wavelengths, 1 nm or more apart, "
              "within 300 to 1100 nm"
        : !(o->max_deg > 0 && o->max_deg <= 89)
            ? "the max angle of lights must be above 0 and at most 89 degrees"
        : !(o->field_mm >= 0 && o->field_mm < 1e6)
            ? "the radius of the field must be a number of mm above 0"
        : !(o->tolerance >= 0.1 && o->tolerance <= 100)
            ? "the scale of the tolerances must be 0.1 to 100"
        : !(o->n_beside >= 0 && o->n_beside <= GLINT_MAX_BESIDE) ||
                (o->n_beside > 0 && !o->beside)
            ? "a zoom position has at most two adjacent positions"
            : NULL;

    if (wrong)
        snprintf(error->text, sizeof error->text, "%s", wrong);
    return wrong ? GLINT_E_ARGUMENT : GLINT_OK;
}

double glint_bake_get_field_radius_mm(const struct glint_prescription *lens,
                                      const struct glint_bake_options *o)
{
    return o->field_mm > 0
               ? o->field_mm
               : 0.55 * hypot(lens->film_width_mm, lens->film_height_mm);
}

/* Adds the bytes of VALUE to the hash KEY, by FNV-1a. */
static void add_value_to_key(uint64_t *key, double value)
{
    unsigned char byte[sizeof value];

    memcpy(byte, &value, sizeof value);
    for (size_t i = 0; i < sizeof byte; i++)
        *key = (*key ^ byte[i]) * UINT64_C(0x100000001b3);
}

/* Adds COATING to the hash. A single quarter-wave film is hashed as in
 * earlier versions, so that cached models stay valid. */
static void add_coating_to_key(uint64_t *key,
                               const struct glint_coating *coating)
{
    add_value_to_key(key, coating->nm);
    add_value_to_key(key, coating->film[0].index);
    if (coating->n_films == 0 ||
        (coating->n_films == 1 && coating->film[0].quarters == 1.0))
        return;
    add_value_to_key(key, coating->n_films);
    for (int k = 0; k < coating->n_films; k++) {
        add_value_to_key(key, coating->film[k].index);
        add_value_to_key(key, coating->film[k].quarters);
    }
}

static void add_shape_to_key(uint64_t *key, const struct glint_shape *s)
{
    add_value_to_key(key, SHAPED_REVISION);
    add_value_to_key(key, s->conic);
    for (int k = 0; k < GLINT_SHAPE_TERMS; k++)
        add_value_to_key(key, s->term[k]);
    add_value_to_key(key, s->bend);
    add_value_to_key(key, s->across_mm);
    for (int k = 0; k < 2; k++) {
        add_value_to_key(key, s->decentre_mm[k]);
        add_value_to_key(key, s->tilt_deg[k]);
    }
    add_value_to_key(key, s->pivot_mm);
}

static void add_lens_to_key(uint64_t *key,
                            const struct glint_prescription *lens)
{
    add_value_to_key(key, lens->f_number);
    add_value_to_key(key, lens->film_width_mm);
    add_value_to_key(key, lens->film_height_mm);
    add_value_to_key(key, lens->stop_after);
    add_value_to_key(key, lens->stop_thickness_mm);
    for (int k = 0; k < lens->n_surfaces; k++) {
        const struct glint_surface *s = &lens->surface[k];

        add_value_to_key(key, s->radius_mm);
        add_value_to_key(key, s->thickness_mm);
        add_value_to_key(key, s->semi_mm);
        add_value_to_key(key, s->nd);
        add_value_to_key(key, s->vd);
        for (int i = 0; i < 6 && s->sellmeier[0] > 0; i++)
            add_value_to_key(key, s->sellmeier[i]);
        add_coating_to_key(key, &s->coating);
        if (glint_surface_is_shaped(s))
            add_shape_to_key(key, &s->shape);
    }
}

uint64_t glint_bake_key(const struct glint_prescription *lens,
                        const struct glint_bake_options *options)
{
    uint64_t key = UINT64_C(0xcbf29ce484222325);

    add_value_to_key(&key, GLINT_MODEL_VERSION);
    add_value_to_key(&key,
                     lens->f_number < GLINT_WIDE ? WIDE_REVISION : REVISION);
    add_value_to_key(&key, GLINT_BASIS_AUTO);
    add_value_to_key(&key, options->band_nm[0]);
    add_value_to_key(&key, options->band_nm[1]);
    add_value_to_key(&key, options->max_deg);
    add_value_to_key(&key, glint_bake_get_field_radius_mm(lens, options));
    add_value_to_key(&key, options->tolerance);
    for (int g = 0; options->ghosts && g < glint_ghost_list(lens, NULL, 0); g++)
        add_value_to_key(&key, options->ghosts[g]);
    add_lens_to_key(&key, lens);
    for (int k = 0; k < options->n_beside; k++)
        add_lens_to_key(&key, &options->beside[k]);
    if (!glint_prescription_is_round(lens))
        add_value_to_key(&key, SKEW_REVISION);
    else if (options->max_deg > GLINT_FAR)
        add_value_to_key(&key, FAR_REVISION);
    for (const char *c = lens->name; *c; c++)
        add_value_to_key(&key, (unsigned char)*c);
    return key;
}

enum { FLUX_NODES = 9 };

/* Fits a polynomial in the wavelength coordinate w to FLUX at the nodes W and
 * writes its coefficients, divided by SCALE, to COEF. */
static void fit_flux_polynomial(const double *w, const double *flux,
                                double scale, struct glint_real *coef)
{
    static const double zero[FLUX_NODES];
    double one[FLUX_NODES];
    double scratch[GLINT_REGRESS_DOUBLES(FLUX_NODES, FLUX_NODES, 1,
                                         GLINT_FLUX_TERMS)];
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
    glint_regress_fit_polynomial(scratch, &samples, flux, &degrees,
                                 1e-7 * scale, 1e-7 * scale, &poly);
    for (int i = 0; i < poly.n; i++)
        coef[poly.power[i][3]] = glint_real_of(poly.coef[i]);
}

/* Returns the flux of the direct image at the wavelength NM through a stop
 * closed to the fraction AREA of its full area, divided by AREA; below 0 if
 * there is no memory.
 *
 * Lenses faster than GLINT_FLUX_F_NUMBER: barrels vignette the rim of the full
 * stop, which a stop of blades reaches only with its corners. Their flux is
 * measured through such a stop and divided by (area of the blades' opening /
 * area of the circle), because the run time multiplies by that ratio and
 * corrects it for other stops (glint_iris_compute_light_fraction()). A circular
 * stop would be 10 % too bright at f/1.4 (merte-biotar) and 2.6 % at f/2
 * (tronnier-double-gauss). */
static double measure_direct_flux(const struct glint_setup *whole, double area,
                                  double nm)
{
    struct glint_setup setup = *whole;

    setup.optics.stop_radius_mm *= sqrt(area);
    if (whole->lens->f_number < GLINT_FLUX_F_NUMBER)
        setup.n_blades = GLINT_FLUX_BLADES;
    return glint_direct_compute_flux(&setup, nm, GLINT_FLUX_CELLS) / area /
           glint_iris_compute_area_fraction(&setup);
}

/* Sets the flux of the direct image per stop area, for the full stop and for
 * smaller ones. Ray energy and pupil aberration are even functions of the
 * position on the pupil, so the flux is a smooth function of the squared stop
 * radius. It is measured at three squared radii: 1, 1/2 and 1/8. */
static enum glint_status
set_direct_flux(const struct glint_bake_options *options,
                const struct glint_setup *whole, struct glint_model_header *h)
{
    /* fractions of the full stop area that are closed */
    static const double closed[2] = {0.5, 0.875};
    const double *band = options->band_nm;
    const double lo = 1 / (band[1] * band[1]), hi = 1 / (band[0] * band[0]);
    double w[FLUX_NODES], flux[3][FLUX_NODES], more[2][FLUX_NODES];

    for (int i = 0; i < FLUX_NODES; i++) {
        const double half = 0.5 * (hi - lo);
        double off[2];

        w[i] = 2.0 * i / (FLUX_NODES - 1) - 1;
        for (int k = 0; k < 3; k++) {
            flux[k][i] =
                measure_direct_flux(whole, k ? 1 - closed[k - 1] : 1,
                                    1 / sqrt(0.5 * (lo + hi) + w[i] * half));
            if (flux[k][i] < 0)
                return GLINT_E_MEMORY;
        }
        for (int k = 0; k < 2; k++)
            off[k] = (flux[k + 1][i] - flux[0][i]) / closed[k];
        more[1][i] = (off[1] - off[0]) / (closed[1] - closed[0]);
        more[0][i] = off[0] - closed[0] * more[1][i];
    }
    fit_flux_polynomial(w, flux[0], flux[0][0], h->direct_flux);
    for (int k = 0; k < 2; k++)
        fit_flux_polynomial(w, more[k], flux[0][0], h->stopped_flux[k]);
    return GLINT_OK;
}

enum glint_status
glint_model_set_header(const struct glint_prescription *lens,
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
                     : GLINT_BASIS_LENS + glint_skew_find_mirror_planes(lens),
        .key = {(uint32_t)key, (uint32_t)(key >> 32)},
        .focal_mm = glint_real_of(o->focal_mm),
        .back_focal_mm = glint_real_of(o->back_focal_mm),
        .entrance_radius_mm = glint_real_of(o->entrance_radius_mm),
        .stop_radius_mm = glint_real_of(o->stop_radius_mm),
        .f_number = glint_real_of(lens->f_number),
        .film_width_mm = glint_real_of(lens->film_width_mm),
        .film_height_mm = glint_real_of(lens->film_height_mm),
        .field_mm =
            glint_real_of(glint_bake_get_field_radius_mm(lens, options)),
        .front_mm = glint_real_of(lens->surface[0].semi_mm),
        .wave_lo_q24 = (int32_t)lrint(0x1p24 * 1e6 / (band[1] * band[1])),
        .wave_hi_q24 = (int32_t)lrint(0x1p24 * 1e6 / (band[0] * band[0])),
        .sine_hi_q30 = (int32_t)lrint(
            0x1p30 * sin(options->max_deg * 0.017453292519943295)),
        .n_surfaces = (uint32_t)lens->n_surfaces};
    snprintf(h->name, sizeof h->name, "%s", lens->name);
    return set_direct_flux(options, setup, h);
}
