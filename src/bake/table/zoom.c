/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "bake/table/elements.h"

/* max distance of a requested focal length from the zoom range, as a fraction
 * of the focal length; allowed because lens barrels state rounded values */
#define BEYOND 2e-3

/* ---------------------------------------------------------------- cubic */

/* Returns the slope of VALUE at position K for monotone cubic interpolation: 0
 * at an extremum, else a weighted mean of the slopes on both sides. */
static double compute_monotone_slope(const struct glint_zoom *z,
                                     const double *value, int k)
{
    const double *const x = z->along;
    const int last = z->n_positions - 1;
    double h0, h1, d0, d1, slope;

    if (last == 1)
        return (value[1] - value[0]) / (x[1] - x[0]);
    if (k > 0 && k < last) {
        h0 = x[k] - x[k - 1];
        h1 = x[k + 1] - x[k];
        d0 = (value[k] - value[k - 1]) / h0;
        d1 = (value[k + 1] - value[k]) / h1;
        return d0 * d1 <= 0.0
                   ? 0.0
                   : 3.0 * (h0 + h1) /
                         ((2.0 * h1 + h0) / d0 + (h1 + 2.0 * h0) / d1);
    }
    /* At the first and last position: the slope of the parabola through the
     * three nearest positions, limited such that the curve does not
     * overshoot. */
    h0 = k ? x[last] - x[last - 1] : x[1] - x[0];
    h1 = k ? x[last - 1] - x[last - 2] : x[2] - x[1];
    d0 = (k ? value[last] - value[last - 1] : value[1] - value[0]) / h0;
    d1 = (k ? value[last - 1] - value[last - 2] : value[2] - value[1]) / h1;
    slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if (slope * d0 <= 0.0)
        return 0.0;
    return d0 * d1 <= 0.0 && fabs(slope) > 3.0 * fabs(d0) ? 3.0 * d0 : slope;
}

/* Interpolates VALUE, one number per zoom position, at the zoom parameter
 * ALONG. */
static double interpolate_zoom_column(const struct glint_zoom *z,
                                      const double *value, double along)
{
    int k = 0;
    double h, t, a, b;

    while (k < z->n_positions - 2 && along >= z->along[k + 1])
        k++;
    h = z->along[k + 1] - z->along[k];
    t = (along - z->along[k]) / h;
    if (t <= 0.0 || t >= 1.0)
        return value[t <= 0.0 ? k : k + 1];
    a = h * compute_monotone_slope(z, value, k);
    b = h * compute_monotone_slope(z, value, k + 1);
    return value[k] +
           t * (a + t * (3.0 * (value[k + 1] - value[k]) - 2.0 * a - b +
                         t * (a + b - 2.0 * (value[k + 1] - value[k]))));
}

/* ----------------------------------------------------------------- zoom */

/* Sets gaps and f-number of LENS for the zoom parameter ALONG, 0 .. 1. */
static void set_zoom_gaps(struct glint_prescription *lens, double along)
{
    const struct glint_zoom *const z = &lens->zoom;
    const int last = count_elements(lens) - 1;
    double defocus[GLINT_MAX_POSITIONS] = {0};
    struct glint_optics optics;
    bool column = false;

    for (int k = 0; k < z->n_positions; k++) {
        defocus[k] = z->last_gap_mm[k] - z->back_mm[k];
        column |= !(along < z->along[k] || along > z->along[k]);
    }
    for (int m = 0; m < z->n_moves; m++)
        *glint_gap_get_pointer(lens, z->move[m]) =
            interpolate_zoom_column(z, z->gap_mm[m], along);
    *glint_gap_get_pointer(lens, last) =
        interpolate_zoom_column(z, z->last_gap_mm, along);
    lens->f_number = interpolate_zoom_column(z, z->f_number, along);
    if (column)
        return;
    glint_optics_of(lens, &optics);
    *glint_gap_get_pointer(lens, last) =
        optics.back_focal_mm + interpolate_zoom_column(z, defocus, along);
}

static enum glint_status
report_missing_zoom(const struct glint_prescription *lens,
                    struct glint_error *error)
{
    snprintf(error->text, sizeof error->text,
             "%s does not zoom: its table has one position", lens->name);
    return GLINT_E_ARGUMENT;
}

enum glint_status glint_prescription_zoom(struct glint_prescription *lens,
                                          double along,
                                          struct glint_error *error)
{
    struct glint_prescription moved = *lens;
    enum glint_status status;

    if (!lens->zoom.n_positions)
        return report_missing_zoom(lens, error);
    if (!(along >= 0.0 && along <= 1.0)) {
        snprintf(error->text, sizeof error->text, "zoom must be 0 to 1, not %g",
                 along);
        return GLINT_E_ARGUMENT;
    }
    set_zoom_gaps(&moved, along);
    moved.zoom_along = along;
    moved.check_focal_mm = moved.check_back_mm = 0;
    status = glint_prescription_check_gaps_and_stop(&moved, error);
    if (status == GLINT_OK)
        *lens = moved;
    return status;
}

static double compute_focal_length_at(struct glint_prescription *lens,
                                      double along)
{
    struct glint_optics optics;

    set_zoom_gaps(lens, along);
    glint_optics_of(lens, &optics);
    return optics.focal_mm;
}

enum glint_status
glint_prescription_zoom_to(const struct glint_prescription *lens,
                           double focal_mm, double *along,
                           struct glint_error *error)
{
    enum { HALVINGS = 60 };
    const struct glint_zoom *const z = &lens->zoom;
    const int last = z->n_positions - 1;
    struct glint_prescription moved = *lens;
    double low = 0.0, high = 1.0;
    bool rises;

    if (!z->n_positions)
        return report_missing_zoom(lens, error);
    rises = z->focal_mm[last] > z->focal_mm[0];
    for (int end = 0; end < 2; end++) {
        const double f = z->focal_mm[end ? last : 0];

        if (fabs(focal_mm - f) <= BEYOND * f) {
            *along = end;
            return GLINT_OK;
        }
    }
    if (!(focal_mm > fmin(z->focal_mm[0], z->focal_mm[last]) &&
          focal_mm < fmax(z->focal_mm[0], z->focal_mm[last]))) {
        snprintf(error->text, sizeof error->text,
                 "%s zooms from %.4g mm to %.4g mm, not to %.4g mm", lens->name,
                 z->focal_mm[0], z->focal_mm[last], focal_mm);
        return GLINT_E_ARGUMENT;
    }
    for (int k = 0; k <= last; k++)
        if (fabs(focal_mm - z->focal_mm[k]) <= 1e-5 * focal_mm) {
            *along = z->along[k];
            return GLINT_OK;
        }
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (low + high);

        if ((compute_focal_length_at(&moved, middle) < focal_mm) == rises)
            low = middle;
        else
            high = middle;
    }
    *along = 0.5 * (low + high);
    return GLINT_OK;
}
