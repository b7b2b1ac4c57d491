/* SPDX-License-Identifier: MIT */
#include "bake/table/check.h"

#include <math.h>
#include <stdio.h>

/* largest relative error of a stated focal length */
#define STATED_TOLERANCE 1e-3
/* share of the smaller semi-diameter, the height at which neighbours are
 * compared */
#define CLEAR_SHARE 0.9
#define CONTACT_MM  1e-6 /* mm of overlap that rounding may make */
#define MIN_STOP_MM 1e-6
/* relative error of the stop radius that rounding may make */
#define STOP_SLACK 1e-9

/* Returns the distance of element E at HEIGHT from the axis behind its vertex.
 */
static double sag_mm(const struct glint_prescription *lens, int e,
                     double height)
{
    const double c = element_curvature(lens, e);
    const double ch = c * height;

    return ch * height / (1.0 + sqrt(1.0 - ch * ch));
}

/* Checks that each element ends before the next begins. The distance between
 * two spheres only rises or only falls from the axis to the rim, and vertices
 * are in order, so one height decides. It is not the very rim, as published
 * semi-diameters are often estimates: surfaces of the Canon zoom meet at 0.92
 * of theirs. */
static bool check_rims(const struct glint_prescription *lens,
                       const struct glint_text *text,
                       const struct glint_places *places)
{
    const int last = element_count(lens) - 1;

    for (int e = 0; e < last; e++) {
        const double height = CLEAR_SHARE * fmin(element_semi_mm(lens, e),
                                                 element_semi_mm(lens, e + 1));
        const double gap = element_gap_mm(lens, e) +
                           sag_mm(lens, e + 1, height) -
                           sag_mm(lens, e, height);

        if (gap < -CONTACT_MM)
            return glint_text_fail(text, places->thickness[e],
                                   "overlaps the next element by %.4g mm at "
                                   "%.4g mm from the axis",
                                   -gap, height);
    }
    if (element_gap_mm(lens, last) <=
        fmax(0.0, sag_mm(lens, last, element_semi_mm(lens, last))))
        return glint_text_fail(text, places->thickness[last],
                               "the sensor must lie behind the last element");
    return true;
}

/* Checks that FOUND agrees with STATED, if the table states it, at PLACE. */
static bool check_stated(const struct glint_text *text,
                         struct glint_text_place place, const char *name,
                         double stated, double found)
{
    return !place.line || fabs(found - stated) <= STATED_TOLERANCE * stated ||
           glint_text_fail(text, place, "%s is %.6g mm, not the stated %.6g mm",
                           name, found, stated);
}

/* Checks focal lengths and stop. Comparisons are such that a NaN fails. */
static bool check_optics(const struct glint_prescription *lens,
                         const struct glint_text *text,
                         const struct glint_places *places)
{
    const struct glint_text_place end = glint_text_end(text);
    struct glint_optics optics;

    glint_optics_of(lens, &optics);
    if (!(fabs(optics.focal_mm) <= GLINT_MAX_FOCAL_MM))
        return glint_text_fail(text, end, "the lens has no power");
    if (!(optics.focal_mm > 0.0 && optics.back_focal_mm > 0.0))
        return glint_text_fail(text, end,
                               "the lens has no focus behind it: focal length "
                               "%.6g mm, back focal length %.6g mm",
                               optics.focal_mm, optics.back_focal_mm);
    if (!(optics.stop_radius_mm >= MIN_STOP_MM))
        return glint_text_fail(text, places->stop,
                               "the stop lies in a focus of the surfaces "
                               "before it");
    if (!(optics.stop_radius_mm <= lens->stop_semi_mm * (1.0 + STOP_SLACK)))
        return glint_text_fail(text, places->f_number,
                               "f/%g needs a stop of %.4g mm radius, but its "
                               "semi-diameter is %.4g mm",
                               lens->f_number, optics.stop_radius_mm,
                               lens->stop_semi_mm);
    return check_stated(text, places->focal, "focal-length",
                        lens->check_focal_mm, optics.focal_mm) &&
           check_stated(text, places->back_focal, "back-focal-length",
                        lens->check_back_mm, optics.back_focal_mm);
}

bool glint_prescription_check(const struct glint_prescription *lens,
                              const struct glint_text *text,
                              const struct glint_places *places)
{
    if (lens->surface[lens->n_surfaces - 1].vd > 0.0)
        return glint_text_fail(text, places->medium,
                               "the last medium must be air");
    return check_rims(lens, text, places) && check_optics(lens, text, places);
}

enum glint_status
glint_prescription_set_f_number(struct glint_prescription *lens,
                                double f_number, struct glint_error *error)
{
    const double widest = GLINT_MIN_F_NUMBER, narrowest = GLINT_MAX_F_NUMBER;
    struct glint_prescription changed = *lens;
    struct glint_optics optics;

    if (!(f_number >= widest && f_number <= narrowest)) {
        snprintf(error->text, sizeof(error->text),
                 "f-number must be %g .. %g, not %g", widest, narrowest,
                 f_number);
        return GLINT_E_ARGUMENT;
    }
    changed.f_number = f_number;
    glint_optics_of(&changed, &optics);
    if (!(optics.stop_radius_mm <= lens->stop_semi_mm * (1.0 + STOP_SLACK))) {
        snprintf(error->text, sizeof(error->text),
                 "f/%g needs a stop of %.4g mm radius; %s opens to %.4g mm, "
                 "f/%.3g",
                 f_number, optics.stop_radius_mm, lens->name,
                 lens->stop_semi_mm,
                 f_number * optics.stop_radius_mm / lens->stop_semi_mm);
        return GLINT_E_ARGUMENT;
    }
    lens->f_number = f_number;
    return GLINT_OK;
}
