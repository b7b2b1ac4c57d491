/* SPDX-License-Identifier: MIT
 *
 * Focuses a lens at a distance: finds how far the focusing group, or the whole
 * lens, must move.
 *
 * As the group moves by d towards the light, the distance of the image from
 * the sensor changes. The lens is focused at the smallest d at which this
 * distance changes its sign.
 */
#include <math.h>
#include <stdio.h>

#include "bake/table/elements.h"

/* step of the search for d, as a fraction of the focal length */
#define STEP 2e-3
enum { STEPS = 2000, HALVINGS = 60 };

/* Input of the search. object_mm: distance of the object from the sensor.
 * defocus_mm: distance of the sensor behind the paraxial focus of the lens when
 * it is focused at infinity. */
struct search {
    const struct glint_prescription *lens;
    double object_mm, defocus_mm;
};

/* Moves the focusing group, or the whole lens if there is none, by D mm towards
 * the light. */
static void move_focusing_group(struct glint_prescription *lens, double d)
{
    const int n = lens->n_focus, last = count_elements(lens) - 1;
    const int first = get_surface_element(lens, lens->focus_first);

    if (!n) {
        *glint_gap_get_pointer(lens, last) += d;
        return;
    }
    if (first > 0)
        *glint_gap_get_pointer(lens, first - 1) -= d;
    *glint_gap_get_pointer(lens, first + n - 1) += d;
}

/* Returns the distance, mm, by which the image lies behind the sensor after the
 * focusing group was moved by D; NaN if elements would overlap. */
static double compute_defocus(const struct search *s, double d)
{
    struct glint_prescription lens = *s->lens;
    struct glint_error error;
    struct glint_optics optics;

    move_focusing_group(&lens, d);
    if (glint_prescription_check_gaps_and_stop(&lens, &error) != GLINT_OK)
        return (double)NAN;
    glint_optics_of(&lens, &optics);
    if (!(s->object_mm > optics.length_mm))
        return (double)NAN;
    return glint_image_compute_distance_mm(&lens,
                                           s->object_mm - optics.length_mm) +
           s->defocus_mm - get_element_gap_mm(&lens, count_elements(&lens) - 1);
}

/* Finds the smallest displacement D, with the sign of SIDE, that focuses the
 * lens. Returns false if there is none. */
static bool find_focus_displacement(const struct search *s, double side,
                                    double *d)
{
    struct glint_optics optics;
    double at = compute_defocus(s, 0.0), step;

    glint_optics_of(s->lens, &optics);
    step = side * STEP * optics.focal_mm;
    for (int k = 1; k <= STEPS; k++) {
        const double now = compute_defocus(s, k * step);

        if (!isfinite(now) || !isfinite(at))
            return false;
        if ((now < 0.0) != (at < 0.0)) {
            double high = k * step, low = high - step;

            for (int i = 0; i < HALVINGS; i++) {
                const double middle = 0.5 * (low + high);

                if ((compute_defocus(s, middle) < 0.0) == (at < 0.0))
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

static bool solve_focus_displacement(const struct glint_prescription *lens,
                                     double metres, double *d)
{
    struct glint_optics optics;
    struct search s = {lens, 1000.0 * metres, 0.0};

    glint_optics_of(lens, &optics);
    s.defocus_mm = get_element_gap_mm(lens, count_elements(lens) - 1) -
                   optics.back_focal_mm;
    return find_focus_displacement(&s, 1.0, d) ||
           (lens->n_focus && find_focus_displacement(&s, -1.0, d));
}

/* Returns the nearest distance from the sensor at which the lens can focus,
 * metres. */
static double find_nearest_focus_distance(const struct glint_prescription *lens)
{
    double low = 0.0, high = 1e6, d;

    for (int k = 0; k < HALVINGS; k++) {
        const double middle = low > 0.0 ? sqrt(low * high) : 1e-3;

        if (solve_focus_displacement(lens, middle, &d))
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
    if (!solve_focus_displacement(lens, metres, &d)) {
        snprintf(error->text, sizeof error->text,
                 "%s cannot focus at %g m, only down to %.3g m from the sensor",
                 lens->name, metres, find_nearest_focus_distance(lens));
        return GLINT_E_ARGUMENT;
    }
    move_focusing_group(lens, d);
    lens->focus_m = metres;
    lens->check_focal_mm = lens->check_back_mm = 0;
    return GLINT_OK;
}
