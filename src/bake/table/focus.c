/* SPDX-License-Identifier: MIT
 *
 * Focuses a lens at a distance.
 *
 * With the group moved by d towards the light, or all of the lens, the image of
 * a point at that distance from the sensor lies behind or before the place of
 * focus. It is there for the least d at which that changes sign. */
#include <math.h>
#include <stdio.h>

#include "bake/table/elements.h"

/* Fraction of the focal length that the group is moved in one step of the
 * search.
 */
#define STEP 2e-3
enum { STEPS = 2000, HALVINGS = 60 };

/* A lens to be focused, and how far behind its paraxial focus at infinity the
 * sensor lies. */
struct search {
    const struct glint_prescription *lens;
    double object_mm, defocus_mm;
};

/* Moves the group, or all, by D towards the light. */
static void advance(struct glint_prescription *lens, double d)
{
    const int n = lens->n_focus, last = element_count(lens) - 1;
    const int first = surface_element(lens, lens->focus_first);

    if (!n) {
        *glint_gap_of(lens, last) += d;
        return;
    }
    if (first > 0)
        *glint_gap_of(lens, first - 1) -= d;
    *glint_gap_of(lens, first + n - 1) += d;
}

/* Returns how far the image lies behind where it is to be; NaN if the lens does
 * not fit any more. */
static double off(const struct search *s, double d)
{
    struct glint_prescription lens = *s->lens;
    struct glint_error error;
    struct glint_optics optics;

    advance(&lens, d);
    if (glint_prescription_fits(&lens, &error) != GLINT_OK)
        return (double)NAN;
    glint_optics_of(&lens, &optics);
    if (!(s->object_mm > optics.length_mm))
        return (double)NAN;
    return glint_image_mm(&lens, s->object_mm - optics.length_mm) +
           s->defocus_mm - element_gap_mm(&lens, element_count(&lens) - 1);
}

/* Finds D in the direction of SIDE. */
static bool find(const struct search *s, double side, double *d)
{
    struct glint_optics optics;
    double at = off(s, 0.0), step;

    glint_optics_of(s->lens, &optics);
    step = side * STEP * optics.focal_mm;
    for (int k = 1; k <= STEPS; k++) {
        const double now = off(s, k * step);

        if (!isfinite(now) || !isfinite(at))
            return false;
        if ((now < 0.0) != (at < 0.0)) {
            double high = k * step, low = high - step;

            for (int i = 0; i < HALVINGS; i++) {
                const double middle = 0.5 * (low + high);

                if ((off(s, middle) < 0.0) == (at < 0.0))
                    low = middle;
                else
                    high = middle;
            }
            *d = 0.5 * (low + high);
            return true;
        }
    }
    return false;
}

static bool solve(const struct glint_prescription *lens, double metres,
                  double *d)
{
    struct glint_optics optics;
    struct search s = {lens, 1000.0 * metres, 0.0};

    glint_optics_of(lens, &optics);
    s.defocus_mm =
        element_gap_mm(lens, element_count(lens) - 1) - optics.back_focal_mm;
    return find(&s, 1.0, d) || (lens->n_focus && find(&s, -1.0, d));
}

/* Returns the nearest distance, metres. */
static double nearest(const struct glint_prescription *lens)
{
    double low = 0.0, high = 1e6, d;

    for (int k = 0; k < HALVINGS; k++) {
        const double middle = low > 0.0 ? sqrt(low * high) : 1e-3;

        if (solve(lens, middle, &d))
            high = middle;
        else
            low = middle;
    }
    return high;
}

enum glint_status glint_prescription_focus(struct glint_prescription *lens,
                                           double metres,
                                           struct glint_error *error)
{
    double d;

    if (!(metres > 0.0 && metres <= 1e6)) {
        snprintf(error->text, sizeof error->text,
                 "focus must be a distance of up to 1e6 metres, not %g",
                 metres);
        return GLINT_E_ARGUMENT;
    }
    if (!solve(lens, metres, &d)) {
        snprintf(error->text, sizeof error->text,
                 "%s cannot focus at %g m, only down to %.3g m from the sensor",
                 lens->name, metres, nearest(lens));
        return GLINT_E_ARGUMENT;
    }
    advance(lens, d);
    lens->focus_m = metres;
    lens->check_focal_mm = lens->check_back_mm = 0;
    return GLINT_OK;
}
