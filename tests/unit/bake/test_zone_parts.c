/* SPDX-License-Identifier: MIT
 *
 * A zone is a range of field angles of a ghost with polynomials of its own.
 * Checks that the two halves of a divided zone cover it, and checks which zones
 * the bake divides.
 */
#include "bake/fit/next.h"
#include "bake/fit/zone_rays.h"
#include "engine/setup/degrees.h"
#include "support/lens_check.h"
#include "support/rng.h"

static bool pupil_part_contains_position(const struct glint_zone_part *p,
                                         double u, double v)
{
    return u >= p->u0 && u < p->u1 && v < p->top &&
           v >= p->top * glint_zone_get_inner_rim(p->annulus);
}

/* Checks that after any number of halvings of the pupil box each pupil position
 * lies in exactly one part. */
TEST(parts_are_disjoint)
{
    enum { DEPTH = 8, PARTS = 1 << DEPTH };
    static struct glint_zone_part part[PARTS] = {{-1, 1, 1, -1, 1, 0}};
    uint32_t seed = 5;
    double area = 0;

    for (int depth = 0; depth < DEPTH; depth++)
        for (int k = (1 << depth) - 1; k >= 0; k--) {
            const struct glint_zone_part whole = part[k];

            glint_zone_halve_part(&whole, depth % 2 == 0, &part[2 * k],
                                  &part[2 * k + 1]);
        }
    for (int k = 0; k < PARTS; k++) {
        assert_in_range(part[k].annulus, 0, GLINT_MAX_ANNULUS);
        area += (part[k].u1 - part[k].u0) * part[k].top *
                (1 - glint_zone_get_inner_rim(part[k].annulus));
    }
    assert_near(area, 2, 1e-12);
    for (int i = 0; i < 1000; i++) {
        const double u = rng_signed(&seed), v = fabs(rng_signed(&seed));
        int found = 0;

        for (int k = 0; k < PARTS; k++)
            found += pupil_part_contains_position(&part[k], u, v);
        assert_int_equal(found, 1);
    }
}

/* The attempted fit of a zone of a bright ghost, from FROM to TO degrees. LEFT
 * is the error of the fit divided by the tolerance. The zone that was halved
 * into this one had an error of 10. SHAPED, FAR: see struct glint_visible. */
struct attempted {
    bool shaped, far;
    double from, to, left;
    /* halvings of the pupil box in a thorough fit (next.h); -1: there was
     * none */
    int depth;
    int axis_depth; /* limit of DEPTH on the axis */
    enum glint_next next;
};

static enum glint_next choose_next_division_of_zone(const struct attempted *c)
{
    static struct glint_prescription lens = {.n_surfaces = 2};
    static struct glint_setup setup;
    static struct glint_visible visible;
    const struct glint_tolerance tolerance = {.axis = 1,
                                              .axis_depth = c->axis_depth};
    const struct glint_next_rules rules = {&visible, &tolerance};
    const struct glint_zone_piece piece = {.lo = glint_sin_deg(c->from),
                                           .hi = glint_sin_deg(c->to),
                                           .before = 10,
                                           .w0 = -1,
                                           .w1 = 1,
                                           .thorough = c->depth >= 0,
                                           .depth =
                                               c->depth > 0 ? c->depth : 0};
    const struct glint_attempt attempt = {
        .aim = {.ease = 2, .hidden = 1},
        .errors = {.worst = c->left, .dims = c->left}};

    setup.lens = &lens;
    setup.ghost[0] = (struct glint_ghost){0, 1};
    visible.setup = &setup;
    visible.wide = true;
    visible.shaped = c->shaped;
    visible.far = c->far;
    return glint_next_choose_step(&rules, &piece, &attempt);
}

/* In wide zones (ranges of angles) of aspheric lenses, pupil parts would have
 * gaps between them. So the bake halves these zones in angle, whereas it
 * divides zones of spherical lenses into pupil parts. It may also halve the
 * pupil boxes of aspheric lenses more often. */
TEST(wide_zones_of_aspheres_are_halved)
{
    static const struct attempted all[] = {
        {false, false, 5, 11, 9, -1, 4, GLINT_THOROUGH},
        {true, false, 5, 11, 9, -1, 4, GLINT_HALVE},
        {true, false, 5, 8.7, 9, -1, 4, GLINT_HALVE},
        {true, false, 5, 8.5, 9, -1, 4, GLINT_THOROUGH},
        {true, false, 5, 8.5, 7, -1, 4,
         GLINT_HALVE}, /* because the previous halving reduced the error */
        {true, false, 5, 11, 0.9, -1, 4, GLINT_KEEP},
        {false, false, 5, 8, 9, 3, 4, GLINT_PART},
        {false, false, 5, 8, 9, 4, 4, GLINT_KEEP},
        {true, false, 5, 8, 9, 5, 4, GLINT_PART},
        {true, false, 5, 8, 9, 6, 4, GLINT_KEEP},
        {true, false, 5, 8, 4, 5, 4, GLINT_KEEP},
        /* zones at the axis may be halved more often, up to axis_depth */
        {false, false, 0, 3, 9, 4, 5, GLINT_PART},
        {true, false, 0, 3, 9, 5, 4, GLINT_PART},
        {true, false, 0, 3, 9, 6, 4, GLINT_KEEP},
        {true, false, 0, 3, 9, 7, 8, GLINT_PART},
        /* Zones beyond 60 degrees are halved like those of aspheric lenses, but
         * not divided into pupil parts. */
        {false, true, 70, 74, 9, -1, 4, GLINT_HALVE},
        {false, true, 70, 73.7, 9, -1, 4, GLINT_HALVE},
        {false, true, 70, 73.5, 9, -1, 4, GLINT_THOROUGH},
        {false, true, 70, 72, 9, 4, 4, GLINT_KEEP},
    };

    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (choose_next_division_of_zone(&all[i]) != all[i].next)
            fail_msg("attempt %d: %d, not %d", (int)i,
                     (int)choose_next_division_of_zone(&all[i]),
                     (int)all[i].next);
}
