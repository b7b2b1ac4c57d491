/* SPDX-License-Identifier: MIT */
#include "bake/table/check.h"

#include <math.h>
#include <stdio.h>

#include "bake/table/form.h"
#include "bake/table/elements.h"
#include "engine/setup/degrees.h"

/* max relative error of a focal length that the table states */
#define STATED_TOLERANCE 1e-3
/* height at which the gap between neighbouring spheres is checked, as a
 * fraction of the smaller semi-diameter of the two */
#define CLEAR_SHARE 0.9
#define CONTACT_MM  1e-6 /* max overlap that is attributed to rounding, mm */
/* overlap from which elements are rejected, mm; a smaller one is a warning,
 * because published semi-diameters are rounded */
#define MIN_OVERLAP_MM 0.02
#define MIN_STOP_MM    1e-6
/* relative amount by which the required stop radius may exceed the opening
 * because of rounding */
#define STOP_SLACK 1e-9

/* numbers of heights and azimuths at which the gap between neighbouring
 * elements is checked if one of them is not a sphere */
enum { HEIGHTS = 12, TURNS = 8 };
/* max sag that the aspheric terms of a surface may add at its rim, in
 * semi-diameters */
#define MOST_TERMS 4.0
/* max ratio of the focal lengths in x and y of an anamorphic lens */
#define MOST_SQUEEZE 16.0

/* Returns the sag of element E at (X, Y) from the lens axis, mm. For a tilted
 * element this is an approximation, which ignores that the tilt also shifts the
 * point sideways. */
static double compute_element_sag_mm(const struct glint_prescription *lens,
                                     int e, double x, double y)
{
    const int k = get_element_surface(lens, e);
    const double c = get_element_curvature(lens, e);
    const double ch = c * hypot(x, y);
    double slope[2] = {0, 0}, at[3];
    struct glint_form form;

    if (k < 0 || !glint_surface_is_shaped(&lens->surface[k]))
        return ch * hypot(x, y) / (1.0 + sqrt(1.0 - ch * ch));
    glint_form_init(&form, &lens->surface[k], 0);
    for (int i = 0; i < 3; i++)
        at[i] = form.turn[i][0] * x + form.turn[i][1] * y + form.shift[i];
    return (glint_form_compute_sag(&form, at[0], at[1], slope) - at[2]) /
           form.turn[2][2];
}

static bool is_shaped_element(const struct glint_prescription *lens, int e)
{
    const int k = get_element_surface(lens, e);

    return k >= 0 && glint_surface_is_shaped(&lens->surface[k]);
}

/* Returns the min gap between element E and the next one, mm. AT receives the
 * distance from the axis at which the gap is smallest. If the stop is in front
 * of the lens, the first surface may bulge through its opening; then only the
 * rim of the stop is compared. */
static double compute_min_gap_mm(const struct glint_prescription *lens, int e,
                                 double *at)
{
    const bool through = e == 0 && get_element_gap_mm(lens, e) < 0.0;
    const double height =
        (through ? 1.0 : CLEAR_SHARE) *
        fmin(get_element_semi_mm(lens, e), get_element_semi_mm(lens, e + 1));
    const bool shaped =
        is_shaped_element(lens, e) || is_shaped_element(lens, e + 1);
    double least = HUGE_VAL;

    *at = height;
    if (!shaped)
        return get_element_gap_mm(lens, e) +
               compute_element_sag_mm(lens, e + 1, height, 0) -
               compute_element_sag_mm(lens, e, height, 0);
    for (int k = through ? (HEIGHTS - 1) * TURNS : 0; k < HEIGHTS * TURNS;
         k++) {
        const int ring = 1 + k / TURNS;
        const double h = height * ring / HEIGHTS;
        const double x = h * glint_cos_deg(360.0 / TURNS * (k % TURNS));
        const double y = h * glint_sin_deg(360.0 / TURNS * (k % TURNS));
        const double gap = get_element_gap_mm(lens, e) +
                           compute_element_sag_mm(lens, e + 1, x, y) -
                           compute_element_sag_mm(lens, e, x, y);

        if (gap < least) {
            least = gap;
            *at = h;
        }
    }
    return least;
}

/* Checks that surface S is defined up to its rim, and that its aspheric terms
 * are small, as large terms indicate a misprint. */
static bool check_surface_profile(const struct glint_surface *s,
                                  const struct glint_text *text,
                                  struct glint_text_place place)
{
    const struct glint_shape *const a = &s->shape;
    const double radius = fabs(s->radius_mm), semi = s->semi_mm;
    double terms = 0.0, most = 0.0;

    if (radius != 0.0 && (1.0 + a->conic) * semi * semi >= radius * radius)
        return glint_text_set_error(
            text, place,
            a->conic == 0.0 ? "semi-diameter %g must be less than the "
                              "radius %g"
                            : "semi-diameter %g must be less than %g, "
                              "where the conic ends",
            semi, radius / sqrt(1.0 + a->conic));
    if (a->across_mm != 0.0 && semi >= fabs(a->across_mm))
        return glint_text_set_error(text, place,
                                    "semi-diameter %g must be less than the "
                                    "radius %g of the other section",
                                    semi, fabs(a->across_mm));
    for (int k = GLINT_SHAPE_TERMS - 1; k >= 0; k--) {
        terms = terms * semi * semi + a->term[k];
        most = fmax(most, fabs(terms));
    }
    terms *= semi * semi * semi * semi;
    return (fabs(terms) <= MOST_TERMS * semi && most < 1e30) ||
           glint_text_set_error(text, place,
                                "the aspheric terms add %.4g mm of sag at the "
                                "rim, which is too much",
                                terms);
}

/* Sets the error text of TEXT to a warning that names element E and the next
 * one. */
static void set_overlap_warning(const struct glint_prescription *lens, int e,
                                double overlap_mm, double height_mm,
                                const struct glint_text *text,
                                struct glint_text_place place)
{
    char name[2][24] = {"stop", "stop"};

    for (int i = 0; i < 2; i++)
        if (get_element_surface(lens, e + i) >= 0)
            snprintf(name[i], sizeof name[i], "surface %d",
                     get_element_surface(lens, e + i));
    glint_text_set_error(text, place,
                         "%s and %s overlap by %.4g mm at %.4g mm from the "
                         "axis; drawn as they are",
                         name[0], name[1], overlap_mm, height_mm);
}

/* Checks that elements do not overlap. The gap between two spheres is compared
 * at one height, because it changes monotonically from axis to rim. This height
 * is below the rim, because published semi-diameters are often estimates: two
 * surfaces of the Canon zoom touch at 0.92 of their semi-diameter. If an
 * element is not a sphere, the gap is compared at many heights. */
static bool check_element_gaps(const struct glint_prescription *lens,
                               const struct glint_text *text,
                               const struct glint_places *places)
{
    const int last = count_elements(lens) - 1;

    for (int e = 0; e < last; e++) {
        double height;
        const double gap = compute_min_gap_mm(lens, e, &height);

        if (!(gap > -MIN_OVERLAP_MM))
            return glint_text_set_error(
                text, places->thickness[e],
                "element overlaps the next one by %.4g mm at "
                "%.4g mm from the axis",
                -gap, height);
        if (gap < -CONTACT_MM)
            set_overlap_warning(lens, e, -gap, height, text,
                                places->thickness[e]);
    }
    if (get_element_gap_mm(lens, last) <=
        fmax(0.0, compute_element_sag_mm(lens, last,
                                         get_element_semi_mm(lens, last), 0)))
        return glint_text_set_error(
            text, places->thickness[last],
            "the sensor must lie behind the last element");
    return true;
}

/* Checks that the computed focal length FOUND agrees with STATED, the value in
 * the table. Passes if the table states none (PLACE has line 0). NAME: name of
 * the length in error texts. */
static bool check_stated_focal_length(const struct glint_text *text,
                                      struct glint_text_place place,
                                      const char *name, double stated,
                                      double found)
{
    return !place.line || fabs(found - stated) <= STATED_TOLERANCE * stated ||
           glint_text_set_error(text, place,
                                "%s is %.6g mm, not the stated %.6g mm", name,
                                found, stated);
}

/* Checks focal lengths and stop. All comparisons are written so that NaN values
 * fail. */
static bool check_focus_and_stop(const struct glint_prescription *lens,
                                 const struct glint_text *text,
                                 const struct glint_places *places)
{
    const struct glint_text_place end = glint_text_get_end_place(text);
    struct glint_optics optics;

    glint_optics_of(lens, &optics);
    if (!(fabs(optics.focal_mm) <= GLINT_MAX_FOCAL_MM))
        return glint_text_set_error(text, end,
                                    "the lens has no refractive power");
    if (!(optics.focal_mm > 0.0 && optics.back_focal_mm > 0.0))
        return glint_text_set_error(
            text, end,
            "the lens has no focus behind it: focal length "
            "%.6g mm, back focal length %.6g mm",
            optics.focal_mm, optics.back_focal_mm);
    if (!(optics.squeeze <= MOST_SQUEEZE &&
          optics.squeeze * MOST_SQUEEZE >= 1.0))
        return glint_text_set_error(
            text, end,
            "focal lengths of %.6g mm in x and %.6g mm in y must have the same "
            "sign and a ratio of at most 16",
            optics.focal_mm / optics.squeeze, optics.focal_mm);
    if (!(optics.stop_radius_mm >= MIN_STOP_MM))
        return glint_text_set_error(
            text, places->stop,
            "the stop lies in the focal plane of the surfaces before it");
    if (!(optics.stop_radius_mm <= lens->stop_semi_mm * (1.0 + STOP_SLACK)))
        return glint_text_set_error(
            text, places->f_number,
            "f/%g needs a stop of %.4g mm radius, but its "
            "semi-diameter is %.4g mm",
            lens->f_number, optics.stop_radius_mm, lens->stop_semi_mm);
    return check_stated_focal_length(text, places->focal, "focal-length",
                                     lens->check_focal_mm, optics.focal_mm) &&
           check_stated_focal_length(text, places->back_focal,
                                     "back-focal-length", lens->check_back_mm,
                                     optics.back_focal_mm);
}

bool glint_prescription_check(const struct glint_prescription *lens,
                              const struct glint_text *text,
                              const struct glint_places *places)
{
    for (int k = 0; k < lens->n_surfaces; k++)
        if (!check_surface_profile(&lens->surface[k], text, places->semi[k]))
            return false;
    if (lens->surface[lens->n_surfaces - 1].vd > 0.0)
        return glint_text_set_error(text, places->medium,
                                    "the last medium must be air");
    return check_element_gaps(lens, text, places) &&
           check_focus_and_stop(lens, text, places);
}

enum glint_status
glint_prescription_check_gaps_and_stop(const struct glint_prescription *lens,
                                       struct glint_error *error)
{
    const int last = count_elements(lens) - 1;
    struct glint_optics optics;
    double height;

    for (int e = 0; e < last; e++) {
        const double gap = compute_min_gap_mm(lens, e, &height);

        if (gap > -MIN_OVERLAP_MM && (get_element_gap_mm(lens, e) >= 0.0 ||
                                      (e == 0 && !lens->stop_after)))
            continue;
        snprintf(error->text, sizeof error->text,
                 "%s: element %d would overlap the next by %.4g mm", lens->name,
                 e + 1, -fmin(gap, get_element_gap_mm(lens, e)));
        return GLINT_E_ARGUMENT;
    }
    glint_optics_of(lens, &optics);
    if (optics.focal_mm > 0.0 && optics.focal_mm <= GLINT_MAX_FOCAL_MM &&
        get_element_gap_mm(lens, last) >
            fmax(0.0, compute_element_sag_mm(
                          lens, last, get_element_semi_mm(lens, last), 0)) &&
        optics.stop_radius_mm <= lens->stop_semi_mm * (1.0 + STOP_SLACK))
        return GLINT_OK;
    snprintf(error->text, sizeof error->text,
             "%s: the lens forms no image, or f/%g needs a stop of %.4g mm "
             "radius, but it opens to %.4g mm only",
             lens->name, lens->f_number, optics.stop_radius_mm,
             lens->stop_semi_mm);
    return GLINT_E_ARGUMENT;
}

double glint_prescription_widest(const struct glint_prescription *lens)
{
    struct glint_optics optics;
    double widest, unit;

    glint_optics_of(lens, &optics);
    widest = lens->f_number * optics.stop_radius_mm / lens->stop_semi_mm;
    unit = pow(10.0, floor(log10(widest)) - 2.0);
    return fmax(ceil(widest / unit * (1.0 - 0.5 * STOP_SLACK)) * unit,
                GLINT_MIN_F_NUMBER);
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
                 lens->stop_semi_mm, glint_prescription_widest(lens));
        return GLINT_E_ARGUMENT;
    }
    lens->f_number = f_number;
    return GLINT_OK;
}
