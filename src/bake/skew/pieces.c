/* SPDX-License-Identifier: MIT */
#include "bake/skew/pieces.h"

#include <math.h>

/* ------------------------------------------------------------------- halves */

/* Substitutes VARIABLE (s, p or w) in the box polynomial SIDE by AT + x / 2, so
 * that x = -1 .. 1 covers half of its range. */
static void substitute_variable(double side[GLINT_BOX_TERMS], int variable,
                                double at)
{
    double *const c = side;

    if (variable == GLINT_S) {
        c[0] += at * (c[1] + at * c[2]);
        c[1] = 0.5 * (c[1] + 2 * at * c[2]);
        c[2] *= 0.25;
        c[3] += at * c[4];
        c[4] *= 0.5;
        c[6] += at * c[7];
        c[7] *= 0.5;
    } else if (variable == GLINT_P) {
        c[0] += at * (c[3] + at * c[5]);
        c[1] += at * c[4];
        c[3] = 0.5 * (c[3] + 2 * at * c[5]);
        c[4] *= 0.5;
        c[5] *= 0.25;
    } else {
        for (int k = 0; k < 2; k++) {
            c[k] += at * c[GLINT_BOX_POWERS + k];
            c[GLINT_BOX_POWERS + k] *= 0.5;
        }
    }
}

/* Cuts a box along one axis to the range LOW .. HIGH; the uncut box has the
 * range -1 .. 1. MIDDLE, HALF: polynomials of the box's middle and half size
 * along that axis. */
static void cut_box_along_axis(double middle[GLINT_BOX_TERMS],
                               double half[GLINT_BOX_TERMS], double low,
                               double high)
{
    for (int k = 0; k < GLINT_BOX_TERMS; k++) {
        middle[k] += 0.5 * (low + high) * half[k];
        half[k] *= 0.5 * (high - low);
    }
}

/* Reduces P to its lower (SIDE -1) or upper half (SIDE 1) in VARIABLE. */
static void reduce_piece_to_half(struct glint_skew_piece *p, int variable,
                                 int side)
{
    struct glint_zone *const z = &p->zone;
    double *const all[] = {z->middle, z->half_x, z->half_y, z->middle_y};
    double *const ends[GLINT_VARIABLES][2] = {[GLINT_S] = {&z->lo, &z->hi},
                                              [GLINT_P] = {&z->y_lo, &z->y_hi},
                                              [GLINT_W] = {&p->w0, &p->w1}};

    p->depth++;
    if (variable == GLINT_U || variable == GLINT_V) {
        p->parts++;
        if (variable == GLINT_U)
            cut_box_along_axis(z->middle, z->half_x, fmin(0, side),
                               fmax(0, side));
        else
            cut_box_along_axis(z->middle_y, z->half_y, fmin(0, side),
                               fmax(0, side));
        return;
    }
    *ends[variable][side < 0] = 0.5 * (*ends[variable][0] + *ends[variable][1]);
    for (int k = 0; k < GLINT_LENS_SIDES; k++)
        substitute_variable(all[k], variable, 0.5 * side);
}

void glint_piece_halve(const struct glint_skew_piece *p, int variable,
                       struct glint_skew_piece *first,
                       struct glint_skew_piece *second)
{
    *first = *second = *p;
    reduce_piece_to_half(first, variable, -1);
    reduce_piece_to_half(second, variable, 1);
}

/* --------------------------------------------------------------------- crop */

void glint_piece_crop_box(struct glint_skew_piece *p,
                          const struct glint_visible *visible)
{
    enum { BUNDLES = 24, ACROSS = GLINT_ZONE_BATCH / 2, ROWS = 12 };
    const double margin[2] = {3.0 / (ACROSS - 1), 3.0 / (ROWS - 1)};
    double low[2] = {9, 9}, high[2] = {-9, -9};
    struct glint_zone_batch t;

    for (int k = 0; k < BUNDLES * ROWS / 2; k++) {
        const int wave = k % GLINT_VISIBLE_WAVES;
        double x[GLINT_VARIABLES];

        glint_zone_set_scattered_point(&p->zone, k / (ROWS / 2), x);
        x[GLINT_W] = glint_zone_compute_node(wave, GLINT_VISIBLE_WAVES);
        t.path = &visible->position_path[wave];
        for (t.n = 0; t.n < GLINT_ZONE_BATCH;) {
            const int row = 2 * (k % (ROWS / 2)) + t.n / ACROSS;

            x[GLINT_U] = 2.0 * (t.n % ACROSS) / (ACROSS - 1) - 1;
            x[GLINT_V] = 2.0 * row / (ROWS - 1) - 1;
            glint_zone_batch_add_ray(&t, &p->zone, x);
        }
        glint_zone_batch_trace_rays(&t, false);
        for (int i = 0; i < t.n; i++)
            if (t.status[i] == GLINT_RAY_OK &&
                glint_visible_is_ray_visible(visible, &t.ray[i]))
                for (int v = 0; v < 2; v++) {
                    low[v] = fmin(low[v], t.x[i][v]);
                    high[v] = fmax(high[v], t.x[i][v]);
                }
    }
    if (low[0] > high[0])
        return;
    cut_box_along_axis(p->zone.middle, p->zone.half_x,
                       fmax(-1, low[0] - margin[0]),
                       fmin(1, high[0] + margin[0]));
    cut_box_along_axis(p->zone.middle_y, p->zone.half_y,
                       fmax(-1, low[1] - margin[1]),
                       fmin(1, high[1] + margin[1]));
}

/* ------------------------------------------------------------------- choice */

static int compute_term_degree(const uint8_t power[GLINT_VARIABLES])
{
    int sum = 0;

    for (int i = 0; i < GLINT_VARIABLES; i++)
        sum += power[i];
    return sum;
}

static void add_high_power_shares(const struct glint_fitted_output *o,
                                  double share[GLINT_VARIABLES])
{
    int most = 0;

    for (int k = 0; k < o->n_terms; k++)
        most = compute_term_degree(o->power[k]) > most
                   ? compute_term_degree(o->power[k])
                   : most;
    for (int k = 0; k < o->n_terms; k++)
        for (int i = 0; i < GLINT_VARIABLES; i++)
            if (2 * compute_term_degree(o->power[k]) > most && o->grain > 0)
                share[i] += fabs(o->coef[k]) / o->grain *
                            (1 - pow(0.5, o->power[k][i]));
}

void glint_piece_compute_shares(const struct glint_fitted_system *system,
                                double share[GLINT_VARIABLES])
{
    bool all = true;

    for (int k = 0; k < system->n_outputs; k++)
        all &=
            system->output[k].met || system->output[k].kind == GLINT_OUT_ENERGY;
    for (int i = 0; i < GLINT_VARIABLES; i++)
        share[i] = 0;
    for (int k = 0; k < system->n_outputs; k++)
        if (system->output[k].kind != GLINT_OUT_ENERGY &&
            (all || !system->output[k].met))
            add_high_power_shares(&system->output[k], share);
}

int glint_piece_choose_part_number(const struct glint_fitted_ghost *ghost,
                                   const struct glint_fitted_system *system)
{
    const struct glint_fitted_system *const a = system;
    int number = 0;

    for (int k = 0; k < ghost->n_systems; k++) {
        const struct glint_fitted_system *const b = &ghost->system[k];

        if (b->part == number && a->sine_lo < b->sine_hi &&
            b->sine_lo < a->sine_hi && a->y_lo < b->y_hi && b->y_lo < a->y_hi &&
            a->wave_lo < b->wave_hi && b->wave_lo < a->wave_hi) {
            number++;
            k = -1;
        }
    }
    return number;
}
