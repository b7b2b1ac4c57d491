/* SPDX-License-Identifier: MIT */
#include "engine/setup/entrance.h"

#include <math.h>
#include <stdbool.h>

#include "engine/setup/setup.h"
#include "glint/transfer.h"

/* The chief ray of a ghost: the ray through the centre of the stop. */
struct chief {
    double x_mm;         /* coordinate, along the light's azimuth, of the ray in
                            the plane of the front vertex, mm */
    double radii_per_mm; /* change of the ray's position in the stop per mm of
                            x_mm, stop radii */
};

/* Finds the chief ray of GHOST for light at the angle whose sine is SINE.
 * Returns false if there is none. */
static bool find_chief_ray(const struct glint_lens *lens, int ghost,
                           double sine, struct chief *chief)
{
    enum { STOP = GLINT_OUT_STOP_X };
    /* two rays at -u and u, a quarter of the pupil's width apart; the position
     * in the stop is linear between them */
    const int32_t u_q30 = 1 << 28;
    struct glint_transfer t;
    struct glint_outputs out;
    double stop[2], mm;

    if (!glint_transfer_init(
            &t, lens, ghost, (int32_t)(sine * 0x1p30),
            (lens->header->wave_lo_q24 + lens->header->wave_hi_q24) / 2) ||
        t.annulus)
        return false;
    for (int k = 0; k < 2; k++) {
        glint_transfer_ray(&t, k ? u_q30 : -u_q30, 0, &out);
        stop[k] = ldexp(out.at[STOP], t.exponent[STOP]);
    }
    mm = ldexp(t.box[1], t.box_exponent) / 2;
    if (!(fabs(stop[1] - stop[0]) > 1e-6) || !(mm > 0))
        return false;
    chief->radii_per_mm = (stop[1] - stop[0]) / mm;
    chief->x_mm = ldexp(t.box[0], t.box_exponent) -
                  0.5 * (stop[0] + stop[1]) / chief->radii_per_mm;
    return true;
}

/* Returns the distance of the entrance pupil from the front vertex, mm, by the
 * polynomials of a ghost that is reflected only behind the stop: its rays reach
 * the stop as direct light does, so that on the axis a stop radius corresponds
 * to a radius of the entrance pupil. Such ghosts come last in a model. */
static double compute_pupil_z_from_model(const struct glint_setup *setup,
                                         const struct glint_lens *lens)
{
    const double sine = 0.03, tangent = sine / sqrt(1 - sine * sine);
    const double radius = glint_real_value(lens->header->entrance_radius_mm);
    const double front = glint_real_value(lens->header->front_mm);
    const double field = glint_real_value(lens->header->field_mm);
    struct chief on, off;

    for (int k = setup->n_ghosts - setup->n_parts - 1; k >= 0; k--)
        if (find_chief_ray(lens, k, 0, &on) && fabs(on.x_mm) < 0.02 * radius &&
            fabs(fabs(on.radii_per_mm) * radius - 1) < 0.05 &&
            find_chief_ray(lens, k, sine, &off))
            return (on.x_mm - off.x_mm) / tangent;
    /* Without such a ghost, the distance is assumed at which the picture's
     * corner is just visible past the rim of the front element. */
    return fmax(front - radius, 0.1 * radius) * fabs(setup->optics.focal_mm) /
           fmax(field, 1e-6);
}

struct glint_entrance glint_entrance_find_pupil(const struct glint_setup *setup,
                                                const struct glint_lens *lens)
{
    if (setup->lens || !lens)
        return (struct glint_entrance){
            setup->optics.entrance_z_mm,
            setup->lens ? setup->lens->surface[0].semi_mm : 0};
    return (struct glint_entrance){compute_pupil_z_from_model(setup, lens),
                                   glint_real_value(lens->header->front_mm)};
}
