/* SPDX-License-Identifier: MIT
 *
 * The bake divides the light directions of lenses without rotational symmetry
 * into pieces. Checks that the halves of a piece cover it, that a piece is
 * halved along the variable whose high powers weigh most, and that pupil parts
 * get the smallest free number.
 */
#include "bake/skew/pieces.h"
#include "support/rng.h"
#include "support/test.h"

/* A ray of a piece (range of light directions): start point, direction, and
 * position W in the wavelength band. */
struct entry {
    double x_mm, y_mm, direction[2], w;
};

static double interpolate_linearly(double lo, double hi, double x)
{
    return 0.5 * (lo + hi) + 0.5 * x * (hi - lo);
}

static struct entry compute_pupil_entry(const struct glint_skew_piece *p,
                                        const double x[GLINT_VARIABLES])
{
    const struct glint_zone *z = &p->zone;

    return (struct entry){
        glint_zone_evaluate_box_polynomial(z, z->middle, x) +
            x[GLINT_U] * glint_zone_evaluate_box_polynomial(z, z->half_x, x),
        glint_zone_evaluate_box_polynomial(z, z->middle_y, x) +
            x[GLINT_V] * glint_zone_evaluate_box_polynomial(z, z->half_y, x),
        {interpolate_linearly(z->lo, z->hi, x[GLINT_S]),
         interpolate_linearly(z->y_lo, z->y_hi, x[GLINT_P])},
        interpolate_linearly(p->w0, p->w1, x[GLINT_W])};
}

static void assert_pieces_are_same(const struct entry *a, const struct entry *b)
{
    assert_true(fabs(a->x_mm - b->x_mm) < 1e-12);
    assert_true(fabs(a->y_mm - b->y_mm) < 1e-12);
    assert_true(fabs(a->direction[0] - b->direction[0]) < 1e-14);
    assert_true(fabs(a->direction[1] - b->direction[1]) < 1e-14);
    assert_true(fabs(a->w - b->w) < 1e-14);
}

static void fill_output_randomly(uint32_t *seed, double side[GLINT_BOX_TERMS])
{
    for (int k = 0; k < GLINT_BOX_TERMS; k++)
        side[k] = 2 * rng_unit(seed) - 1;
}

static struct glint_skew_piece make_random_piece(uint32_t *seed)
{
    struct glint_skew_piece p = {.zone = {.lo = -0.1,
                                          .hi = 0.3,
                                          .y_lo = 0.2,
                                          .y_hi = 0.25,
                                          .skew = true},
                                 .w0 = -1,
                                 .w1 = 0.5,
                                 .depth = 3};

    fill_output_randomly(seed, p.zone.middle);
    fill_output_randomly(seed, p.zone.middle_y);
    fill_output_randomly(seed, p.zone.half_x);
    fill_output_randomly(seed, p.zone.half_y);
    return p;
}

TEST(halves_equal_the_whole_piece)
{
    uint32_t seed = 5;

    for (int k = 0; k < 1000; k++) {
        const struct glint_skew_piece p = make_random_piece(&seed);
        const int variable = k % GLINT_VARIABLES;
        double whole[GLINT_VARIABLES], half[GLINT_VARIABLES];
        struct glint_skew_piece piece[2];
        struct entry a, b;

        for (int i = 0; i < GLINT_VARIABLES; i++)
            half[i] = whole[i] = 2 * rng_unit(&seed) - 1;
        half[variable] = 2 * fabs(whole[variable]) - 1;
        if (whole[variable] < 0)
            half[variable] = -half[variable];
        glint_piece_halve(&p, variable, &piece[0], &piece[1]);
        a = compute_pupil_entry(&p, whole);
        b = compute_pupil_entry(&piece[whole[variable] > 0], half);
        assert_pieces_are_same(&a, &b);
        for (int i = 0; i < 2; i++) {
            assert_int_equal(piece[i].depth, 4);
            assert_int_equal(piece[i].parts,
                             variable == GLINT_U || variable == GLINT_V);
        }
    }
}

/* Sets output O to a polynomial of a single term: power POWER of VARIABLE. */
static void set_output_to_one_term(struct glint_fitted_output *o, double *coef,
                                   enum glint_channel kind, int variable,
                                   int power, bool met)
{
    *o = (struct glint_fitted_output){
        .kind = kind, .n_terms = 1, .coef = coef, .grain = 0.5, .met = met};
    *coef = -1;
    o->power[0][variable] = (uint8_t)power;
}

TEST(error_is_shared_by_variables)
{
    static struct glint_fitted_system system;
    double coef[3], share[GLINT_VARIABLES];

    set_output_to_one_term(&system.output[0], &coef[0], GLINT_OUT_SENSOR_X,
                           GLINT_S, 1, true);
    set_output_to_one_term(&system.output[1], &coef[1], GLINT_OUT_STOP_X,
                           GLINT_V, 3, false);
    set_output_to_one_term(&system.output[2], &coef[2], GLINT_OUT_ENERGY,
                           GLINT_W, 5, false);
    system.n_outputs = 3;
    glint_piece_compute_shares(&system, share);
    assert_true(share[GLINT_V] == 2 * 0.875);
    assert_true(share[GLINT_S] == 0 && share[GLINT_W] == 0);

    /* if all outputs meet their tolerances, all outputs are weighed */
    system.output[1].met = true;
    glint_piece_compute_shares(&system, share);
    assert_true(share[GLINT_V] == 2 * 0.875 && share[GLINT_S] == 2 * 0.5);
    assert_true(share[GLINT_U] == 0 && share[GLINT_W] == 0);
}

TEST(pieces_are_numbered_by_part)
{
    /* two parts of one piece, and a system of the next piece */
    struct glint_fitted_system has[] = {
        {.part = 1, .sine_hi = 0.1, .y_hi = 0.1, .wave_hi = 6},
        {.part = 0, .sine_hi = 0.1, .y_hi = 0.1, .wave_hi = 6},
        {.part = 0, .sine_lo = 0.1, .sine_hi = 0.2, .y_hi = 0.1, .wave_hi = 6}};
    const struct glint_fitted_ghost ghost = {3, has};
    struct glint_fitted_system next = has[0];

    assert_int_equal(glint_piece_choose_part_number(&ghost, &next), 2);
    next.sine_lo = 0.1;
    next.sine_hi = 0.15;
    assert_int_equal(glint_piece_choose_part_number(&ghost, &next), 1);
    next.y_lo = 0.1;
    next.y_hi = 0.2;
    assert_int_equal(glint_piece_choose_part_number(&ghost, &next), 0);
    next = has[0];
    next.wave_lo = 6;
    next.wave_hi = 7;
    assert_int_equal(glint_piece_choose_part_number(&ghost, &next), 0);
}
