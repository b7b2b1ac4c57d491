/* SPDX-License-Identifier: MIT
 *
 * Prepares lens, stop and wavelengths for drawing. Computes the colours of the
 * wavelengths, and the flux of the direct image, which is the unit of all
 * light. */
#include "engine/setup/setup.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "engine/setup/degrees.h"
#include "engine/setup/spectrum.h"
#include "glint/model.h"

/* Scales each channel of the wavelengths' colours so that its sum over the
 * wavelengths is 1. So a flat spectrum is white. If the sum of a channel is
 * near 0 or negative, all its values are set equal, as a grey picture is better
 * than wrong colours. */
static void normalise_colours(struct glint_setup *s)
{
    const int n = s->n_wavelengths;

    for (int c = 0; c < 3; c++) {
        double sum = 0, size = 0;

        for (int i = 0; i < n; i++) {
            sum += s->rgb[i][c];
            size += fabs(s->rgb[i][c]);
        }
        for (int i = 0; i < n; i++)
            s->rgb[i][c] =
                sum > 0.2 * size && sum > 0.05 ? s->rgb[i][c] / sum : 1.0 / n;
    }
}

static void set_wavelength_colours(struct glint_setup *s)
{
    for (int i = 0; i < s->n_wavelengths; i++) {
        glint_observer_compute_rgb(s->wavelength_nm[i], s->rgb[i]);
        for (int c = 0; s->n_wavelengths == 3 && c < 3; c++)
            s->rgb[i][c] = c == i;
    }
    if (s->n_wavelengths != 3)
        normalise_colours(s);
}

enum glint_status glint_setup_check_arguments(int n_blades, double rotation_deg,
                                              const double *wavelength_nm,
                                              int n, struct glint_error *error)
{
    if (n_blades != 0 && (n_blades < 3 || n_blades > GLINT_MAX_BLADES))
        snprintf(error->text, sizeof error->text,
                 "a stop must have 3 to %d blades, not %d", GLINT_MAX_BLADES,
                 n_blades);
    else if (!isfinite(rotation_deg))
        snprintf(error->text, sizeof error->text,
                 "the rotation of the stop must be a finite angle");
    else if (n < 1 || n > GLINT_MAX_WAVELENGTHS)
        snprintf(error->text, sizeof error->text,
                 "1 to %d wavelengths can be drawn, not %d",
                 GLINT_MAX_WAVELENGTHS, n);
    else {
        for (int i = 0; i < n; i++)
            if (!(wavelength_nm[i] >= 300 && wavelength_nm[i] <= 1100)) {
                snprintf(error->text, sizeof error->text,
                         "a wavelength must be 300 to 1100 nm, not %g",
                         wavelength_nm[i]);
                return GLINT_E_ARGUMENT;
            }
        return GLINT_OK;
    }
    return GLINT_E_ARGUMENT;
}

void glint_setup_init_common(struct glint_setup *s, int n_blades,
                             double rotation_deg, const double *wavelength_nm,
                             int n)
{
    s->opening = 1;
    s->iris = (struct glint_iris){0};
    s->dirt = NULL;
    s->clear = 1;
    memset(s->falloff, 0, sizeof s->falloff);
    s->n_blades = n_blades;
    s->blade_rotation_deg = rotation_deg;
    s->n_sets = 0;
    s->n_wavelengths = n;
    memcpy(s->wavelength_nm, wavelength_nm, (size_t)n * sizeof *wavelength_nm);
    set_wavelength_colours(s);
}

enum glint_status glint_setup_set_unit_flux(struct glint_setup *s,
                                            const char *name,
                                            struct glint_error *error)
{
    const int n = s->n_wavelengths;
    double mean = 0;

    for (int i = 0; i < n; i++) {
        if (!(s->direct_flux[i] > 0)) {
            snprintf(error->text, sizeof error->text,
                     "%s: no light of %g nm reaches the sensor", name,
                     s->wavelength_nm[i]);
            return GLINT_E_LENS;
        }
        mean += s->direct_flux[i] / n;
    }
    for (int i = 0; i < n; i++)
        s->unit_flux[i] = mean;
    return GLINT_OK;
}

static double evaluate_polynomial(const struct glint_real *coef, int n,
                                  double w)
{
    double sum = 0;

    for (int k = n - 1; k >= 0; k--)
        sum = sum * w + glint_real_value(coef[k]);
    return sum;
}

/* Returns the flux of the direct image, mm^2, of the model H through the stop
 * of SETUP at wavelength NM, clamped to the model's wavelengths. Sets FALLOFF
 * as in struct glint_setup. */
static double compute_direct_flux_of_model(const struct glint_setup *setup,
                                           const struct glint_model_header *h,
                                           double nm, double falloff[2])
{
    const double lo = h->wave_lo_q24, hi = h->wave_hi_q24;
    const double wave = 0x1p24 * 1e6 / (nm * nm);
    const double w = fmax(-1, fmin(1, (2 * wave - lo - hi) / fmax(1, hi - lo)));
    const double opening = setup->opening, area = opening * opening;
    const double closed = 1 - opening * opening;
    const double flux =
        evaluate_polynomial(h->direct_flux, GLINT_FLUX_TERMS, w);
    const double first =
        evaluate_polynomial(h->stopped_flux[0], GLINT_FLUX_TERMS, w);
    const double second =
        evaluate_polynomial(h->stopped_flux[1], GLINT_FLUX_TERMS, w);
    const double light = flux + closed * (first + closed * second);
    const bool fast = glint_real_value(h->f_number) < GLINT_FLUX_F_NUMBER;

    /* the coefficients of area and area^2 in LIGHT */
    falloff[0] = fast ? -(first + 2 * second) * area / light : 0;
    falloff[1] = fast ? second * area * area / light : 0;
    return glint_iris_compute_light_fraction(setup, falloff) *
           (opening * opening * light);
}

/* Sets direct_flux and falloff of SETUP from the model H. */
static void set_direct_flux_of_model(struct glint_setup *setup,
                                     const struct glint_model_header *h)
{
    for (int i = 0; i < setup->n_wavelengths; i++)
        setup->direct_flux[i] = compute_direct_flux_of_model(
            setup, h, setup->wavelength_nm[i], setup->falloff[i]);
}

enum glint_status glint_setup_from_model(struct glint_setup *setup,
                                         const struct glint_lens *lens,
                                         int n_blades,
                                         double blade_rotation_deg,
                                         const double *wavelength_nm, int n,
                                         struct glint_error *error)
{
    const struct glint_model_header *h = lens->header;
    const enum glint_status status = glint_setup_check_arguments(
        n_blades, blade_rotation_deg, wavelength_nm, n, error);

    if (status != GLINT_OK)
        return status;
    if (h->n_ghosts > GLINT_MAX_GHOSTS) {
        snprintf(error->text, sizeof error->text,
                 "model %s has %lu ghosts, but glint can draw %d at most: "
                 "bake the lens again with this version of glint",
                 h->name, (unsigned long)h->n_ghosts, GLINT_MAX_GHOSTS);
        return GLINT_E_LENS;
    }
    setup->lens = NULL;
    setup->optics = (struct glint_optics){
        .focal_mm = glint_real_value(h->focal_mm),
        .back_focal_mm = glint_real_value(h->back_focal_mm),
        .entrance_radius_mm = glint_real_value(h->entrance_radius_mm),
        .stop_radius_mm = glint_real_value(h->stop_radius_mm),
        .scale_mm = glint_real_value(h->focal_mm)};
    setup->n_ghosts = (int)h->n_ghosts;
    setup->n_parts = (int)h->n_parts;
    for (int k = 0; k < setup->n_ghosts; k++)
        setup->ghost[k] =
            (struct glint_ghost){(int)lens->ghost[k].i, (int)lens->ghost[k].j};
    glint_setup_init_common(setup, n_blades, blade_rotation_deg, wavelength_nm,
                            n);
    set_direct_flux_of_model(setup, h);
    return glint_setup_set_unit_flux(setup, h->name, error);
}

enum glint_status glint_setup_stop_down(struct glint_setup *setup,
                                        const struct glint_lens *lens,
                                        double f_number,
                                        struct glint_error *error)
{
    const struct glint_model_header *h = lens->header;
    const double widest = glint_real_value(h->f_number);
    /* F_NUMBER may be the rounded f-number of the fully open stop. */
    const double by =
        fabs(widest / f_number - 1) < 1e-6 ? 1 : widest / f_number;

    if (!(by <= 1 && by >= 0x1p-10)) {
        snprintf(error->text, sizeof error->text,
                 "%s: the model was baked for f/%g and can draw f/%g to f/%g, "
                 "not f/%g",
                 h->name, widest, widest, 1024 * widest, f_number);
        return GLINT_E_ARGUMENT;
    }
    setup->opening = by;
    setup->optics.entrance_radius_mm *= by;
    setup->optics.stop_radius_mm *= by;
    set_direct_flux_of_model(setup, h);
    return glint_setup_set_unit_flux(setup, h->name, error);
}

void glint_setup_weigh(struct glint_setup *setup)
{
    const int n = setup->n_wavelengths;
    double nm[GLINT_MAX_WAVELENGTHS], share[GLINT_MAX_WAVELENGTHS], mean = 0;

    glint_spectrum(n, nm, setup->rgb, share);
    for (int i = 0; i < n; i++)
        mean += share[i] * setup->direct_flux[i];
    for (int i = 0; i < n; i++)
        setup->unit_flux[i] = mean;
}

/* Returns the flux of the direct image, mm^2, at wavelength NM. It is
 * interpolated by a parabola in 1 / wavelength^2 through three wavelengths of
 * S. */
static double interpolate_direct_flux(const struct glint_setup *s, double nm)
{
    const int at[3] = {0, s->n_wavelengths / 2, s->n_wavelengths - 1};
    double sum = 0;

    if (s->n_wavelengths < 3)
        return s->direct_flux[0];
    for (int k = 0; k < 3; k++) {
        double part = s->direct_flux[at[k]];

        for (int i = 0; i < 3; i++) {
            const double node = s->wavelength_nm[at[i]];
            const double here = s->wavelength_nm[at[k]];

            if (i != k)
                part *= (1 / (nm * nm) - 1 / (node * node)) /
                        (1 / (here * here) - 1 / (node * node));
        }
        sum += part;
    }
    return sum;
}

void glint_setup_spread(struct glint_setup *setup,
                        const struct glint_lens *lens)
{
    static const int sizes[] = {4, 6, 10, 17, 28};
    enum { N_SETS = sizeof sizes / sizeof *sizes };
    struct glint_set_wave *wave = setup->set_wave;

    setup->n_sets = N_SETS;
    for (int s = 0; s < N_SETS; wave += sizes[s++]) {
        double nm[GLINT_MAX_WAVELENGTHS], share[GLINT_MAX_WAVELENGTHS];
        double rgb[GLINT_MAX_WAVELENGTHS][3], falloff[2], mean = 0;

        setup->set_size[s] = sizes[s];
        glint_spectrum(sizes[s], nm, rgb, share);
        for (int i = 0; i < sizes[s]; i++) {
            wave[i].nm = nm[i];
            memcpy(wave[i].rgb, rgb[i], sizeof rgb[i]);
            wave[i].direct_flux =
                lens ? compute_direct_flux_of_model(setup, lens->header, nm[i],
                                                    falloff)
                     : interpolate_direct_flux(setup, nm[i]);
            mean += share[i] * wave[i].direct_flux;
        }
        for (int i = 0; i < sizes[s]; i++)
            wave[i].unit_flux = mean;
    }
}

void glint_setup_balance(struct glint_setup *setup)
{
    int n = 0;

    for (int i = 0; i < setup->n_wavelengths; i++)
        setup->unit_flux[i] = setup->direct_flux[i];
    for (int s = 0; s < setup->n_sets; s++)
        n += setup->set_size[s];
    for (int i = 0; i < n; i++)
        setup->set_wave[i].unit_flux = setup->set_wave[i].direct_flux;
}
