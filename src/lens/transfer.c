/* SPDX-License-Identifier: MIT
 *
 * Rays through a bundle's polynomials. The C definition of the kernels.
 *
 * Formats: variables are q30 and within +-2^30; coefficients and every
 * intermediate of an output are integers of that output's own unit, below 2^30
 * as bake has proven (bound in struct glint_model_output). So each product of
 * the two is below 2^60, and rounds to its unit by a shift of 30.
 */
#include "glint/lens.h"

#include "base/compiler.h"
#include "base/divide.h"
#include "base/q.h"
#include "glint/flare.h"
#include "kernels/kernels.h"
#include "lens/box.h"

enum {
    ONE_LOG2 = 30,
    RAYS = GLINT_RAYS,
    MAX_EXPONENT = 15 /* of any variable */
};

#define ONE_Q30 (INT32_C(1) << ONE_LOG2)

STATIC_ASSERT((int)RAYS == (int)GLINT_TURNED);

/* ------------------------------------------------------------------- tables */

static const void *at(const struct glint_lens *lens, uint32_t offset)
{
    return (const unsigned char *)lens->header + offset;
}

/* X of LO .. HI as -1 .. 1. */
static int32_t within_q30(int32_t x, int32_t lo, int32_t hi)
{
    const int64_t span = (int64_t)hi - lo;

    if (x <= lo)
        return -ONE_Q30;
    if (x >= hi)
        return ONE_Q30;
    return (int32_t)q_divide((2 * (int64_t)x - lo - hi) * ONE_Q30, span);
}

static void powers_q30(int32_t x_q30, int n, int32_t *power_q30)
{
    power_q30[0] = ONE_Q30;
    for (int k = 1; k <= n; k++)
        power_q30[k] = q_mul(power_q30[k - 1], x_q30, 30);
}

/* Whether WAVE is the system's; the upper end of its band is the next one's. */
static int is_in_band(const struct glint_model_system *s,
                      const struct glint_model_header *h, int32_t wave_q24)
{
    return wave_q24 >= s->wave_lo_q24 &&
           (wave_q24 < s->wave_hi_q24 ||
            (wave_q24 == s->wave_hi_q24 && wave_q24 == h->wave_hi_q24));
}

/* How far WAVE lies outside of the system's band. */
static int64_t off_band(const struct glint_model_system *s, int32_t wave_q24)
{
    const int64_t below = (int64_t)s->wave_lo_q24 - wave_q24;
    const int64_t above = (int64_t)wave_q24 - s->wave_hi_q24;

    return below > 0 ? below : above > 0 ? above : 0;
}

static const struct glint_model_system *
find_system(const struct glint_lens *lens, int ghost, int32_t sine_q30,
            int32_t wave_q24)
{
    const struct glint_model_ghost *g = &lens->ghost[ghost];
    const struct glint_model_header *h = lens->header;
    const struct glint_model_system *best = NULL;

    wave_q24 = wave_q24 < h->wave_lo_q24   ? h->wave_lo_q24
               : wave_q24 > h->wave_hi_q24 ? h->wave_hi_q24
                                           : wave_q24;
    for (uint32_t k = 0; k < g->n_systems; k++) {
        const struct glint_model_system *s = &lens->system[g->first_system + k];

        if (sine_q30 < s->sine_lo_q30 || sine_q30 > s->sine_hi_q30 ||
            (s->n_knots == 0 && !is_in_band(s, h, wave_q24)))
            continue;
        if (!best || off_band(s, wave_q24) < off_band(best, wave_q24))
            best = s;
    }
    return best;
}

/* Angle and wavelength of a bundle within its system. */
struct setting {
    uint32_t knot; /* the lower one */
    int32_t part_q30;
    int32_t s_q30[MAX_EXPONENT + 1], w_q30[MAX_EXPONENT + 1];
};

static void settle(struct setting *set, const struct glint_lens *lens,
                   const struct glint_model_system *s, int32_t sine_q30,
                   int32_t wave_q24)
{
    set->knot = 0;
    set->part_q30 = 0;
    if (s->n_knots) {
        const int32_t *knot_q30 = at(lens, s->knot_at);
        uint32_t k = 0;

        while (k + 2 < s->n_knots && sine_q30 >= knot_q30[k + 1])
            k++;
        set->knot = k;
        set->part_q30 = within_q30(sine_q30, knot_q30[k], knot_q30[k + 1]) / 2 +
                        ONE_Q30 / 2;
        return;
    }
    powers_q30(within_q30(sine_q30, s->sine_lo_q30, s->sine_hi_q30),
               MAX_EXPONENT, set->s_q30);
    powers_q30(within_q30(wave_q24, s->wave_lo_q24, s->wave_hi_q24),
               MAX_EXPONENT, set->w_q30);
}

static int32_t between(int32_t a, int32_t b, int32_t part_q30)
{
    return a + q_mul(b - a, part_q30, 30);
}

static void set_box(struct glint_transfer *t, const struct glint_lens *lens,
                    const struct setting *set)
{
    const struct glint_model_system *s = t->system;
    const int32_t *box = at(lens, s->box_at), *low = box + 3 * set->knot;
    int32_t side[GLINT_BOX_TERMS];

    t->box_exponent = s->box_exponent;
    for (int k = 0; k < 3; k++) {
        if (s->n_knots) {
            t->box[k] = between(low[k], low[3 + k], set->part_q30);
            continue;
        }
        box = box_unpack(box, s->box_terms, side);
        t->box[k] = box_side(side, set->s_q30[1], set->w_q30[1]);
    }
}

/* The sparse basis: between two knots. */
static void set_terms(struct glint_transfer *t, const struct glint_lens *lens,
                      const struct glint_model_output *o,
                      const struct setting *set)
{
    const uint16_t *power = at(lens, o->term_at);
    const int32_t *low = at(lens, o->coef_at), *high;

    low += set->knot * o->n_terms;
    high = low + o->n_terms;
    t->of.sparse[o->kind].n_terms = (int32_t)o->n_terms;
    for (uint32_t k = 0; k < o->n_terms; k++) {
        t->of.sparse[o->kind].power[k] = power[k];
        t->of.sparse[o->kind].coef[k] = between(low[k], high[k], set->part_q30);
    }
}

/* VALUE, of a term with the powers POWER, with angle and wavelength put in. */
static WHOLLY_INLINE int32_t put_in(const struct setting *set, int32_t value,
                                    uint16_t power)
{
    const int c = power >> 8 & 15, d = power >> 12;

    if (c)
        value = q_mul(value, set->s_q30[c], 30);
    return d ? q_mul(value, set->w_q30[d], 30) : value;
}

/* A polynomial of u and v while it is added up. */
struct table {
    int32_t (*row)[GLINT_TABLE_WIDTH];
    int degree_u, degree_v;
};

static WHOLLY_INLINE void add_term(struct table *t, uint16_t power,
                                   int32_t value)
{
    const int a = power & 15, b = power >> 4 & 15;

    t->row[b][a] += value;
    t->degree_u = a > t->degree_u ? a : t->degree_u;
    t->degree_v = b > t->degree_v ? b : t->degree_v;
}

/* The auto basis. */
static void set_table(struct glint_transfer *t, const struct glint_lens *lens,
                      const struct glint_model_output *o,
                      const struct setting *set)
{
    const uint32_t n = o->n_terms, n_wide = n - o->n_narrow;
    const int32_t *coef = at(lens, o->coef_at);
    const int32_t by = INT32_C(1) << o->narrow_shift;
    const int16_t *narrow = (const int16_t *)(const void *)(coef + n_wide);
    const uint16_t *power = at(lens, o->term_at);
    struct table table = {t->of.table[o->kind], 0, 0};

    for (int b = 0; b <= GLINT_MAX_POWER; b++)
        for (int a = 0; a < GLINT_TABLE_WIDTH; a++)
            table.row[b][a] = 0;
    for (uint32_t k = 0; k < n_wide; k++)
        add_term(&table, power[k], put_in(set, coef[k], power[k]));
    for (uint32_t k = n_wide; k < n; k++)
        add_term(&table, power[k],
                 put_in(set, narrow[k - n_wide] * by, power[k]));
    t->degree_u[o->kind] = (uint8_t)table.degree_u;
    t->degree_v[o->kind] = (uint8_t)table.degree_v;
}

static void set_output(struct glint_transfer *t, const struct glint_lens *lens,
                       const struct glint_model_output *o,
                       const struct setting *set)
{
    t->outputs |= UINT32_C(1) << o->kind;
    t->exponent[o->kind] = o->exponent;
    if (o->kind == GLINT_OUT_ENERGY) {
        t->head = o->head;
        t->roots = o->roots;
        t->exponent[o->kind] -= o->head;
        for (int k = 0; k < o->roots; k++)
            t->exponent[o->kind] = 2 * t->exponent[o->kind] + 29;
    }
    if (t->basis == GLINT_BASIS_SPARSE)
        set_terms(t, lens, o, set);
    else
        set_table(t, lens, o, set);
}

static void clear(struct glint_transfer *t)
{
    t->outputs = 0;
    t->head = t->roots = t->energy_up = 0;
    t->sets = 0;
    t->n_nodes = 0;
    for (int k = 0; k < GLINT_OUT_KINDS; k++) {
        t->exponent[k] = 0;
        t->degree_u[k] = t->degree_v[k] = 0;
    }
}

int glint_transfer_init(struct glint_transfer *transfer,
                        const struct glint_lens *lens, int ghost,
                        int32_t sine_q30, int32_t wave_q24)
{
    const struct glint_model_system *system =
        find_system(lens, ghost, sine_q30, wave_q24);
    const struct glint_model_output *output;
    struct setting set;

    if (!system)
        return 0;
    clear(transfer);
    transfer->system = system;
    transfer->hollow = (uint8_t)system->hollow;
    transfer->basis = (enum glint_basis)lens->header->basis;
    settle(&set, lens, system, sine_q30, wave_q24);
    set_box(transfer, lens, &set);
    output = at(lens, system->output_at);
    for (uint32_t k = 0; k < system->n_outputs; k++)
        set_output(transfer, lens, &output[k], &set);
    return 1;
}

/* --------------------------------------------------------------------- rays */

static int has(const struct glint_transfer *t, int kind)
{
    return (t->outputs >> kind & 1) != 0;
}

/* Powers of v of a kind are all odd, or all even. */
static int is_odd(int kind)
{
    return kind & 1 && kind < GLINT_OUT_ENERGY;
}

/* An output's polynomial in u along one row of the grid. */
static void set_row(const struct glint_transfer *t,
                    const struct glint_horner *k, int kind, int32_t v_q30,
                    int32_t v2_q30, int32_t *of_u)
{
    const int odd = is_odd(kind);

    k->across(of_u, t->of.table[kind][odd], 2 * GLINT_TABLE_WIDTH,
              (t->degree_v[kind] - odd) / 2, v2_q30,
              t->degree_u[kind] < 8 ? 8 : GLINT_TABLE_WIDTH);
    for (int a = 0; odd && a <= t->degree_u[kind]; a++)
        of_u[a] = q_mul(of_u[a], v_q30, 30);
}

/* Fills the polynomials in u of the rays at V. */
static void set_rows(const struct glint_transfer *t,
                     const struct glint_horner *k, int32_t v_q30,
                     int32_t (*of_u)[GLINT_TABLE_WIDTH])
{
    const int32_t v2_q30 = q_mul(v_q30, v_q30, 30);

    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (has(t, kind))
            set_row(t, k, kind, v_q30, v2_q30, of_u[kind]);
}

/* From values of the polynomial of energy to N energies. */
static void raise_energies(const struct glint_transfer *t, int32_t *e, int n)
{
    const int32_t most = (INT32_C(1) << 29) >> t->head;

    for (int i = 0; (t->head || t->roots) && i < n; i++)
        e[i] = (e[i] < 0 ? 0 : e[i] > most ? most : e[i]) * (1 << t->head);
    for (int k = 0; k < t->roots; k++)
        for (int i = 0; i < n; i++)
            e[i] = q_mul(e[i], e[i], 29);
}

/* The rays at U, by kind. */
static void rays_of_rows(const struct glint_transfer *t,
                         const struct glint_horner *k, const int32_t *u_q30,
                         int32_t (*out)[RAYS])
{
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        if (has(t, kind))
            k->along(out[kind], t->of_u[kind], t->degree_u[kind], u_q30, RAYS);
    raise_energies(t, out[GLINT_OUT_ENERGY], RAYS);
}

static void ray_of_terms(const struct glint_transfer *t, int32_t u_q30,
                         int32_t v_q30, struct glint_outputs *out)
{
    int32_t x[4][MAX_EXPONENT + 1];
    const int32_t px_q30 = t->box[0] + q_mul(t->box[1], u_q30, 30);
    const int32_t py_q30 = q_mul(t->box[2], v_q30, 30);
    const int64_t r2_q60 = (int64_t)px_q30 * px_q30 + (int64_t)py_q30 * py_q30;
    const int32_t r_q30 = q_clamp_sat(q_root((uint64_t)r2_q60), 0, ONE_Q30);

    powers_q30(px_q30, MAX_EXPONENT, x[0]);
    powers_q30(py_q30, MAX_EXPONENT, x[1]);
    powers_q30(r_q30, MAX_EXPONENT, x[2]);
    powers_q30(ONE_Q30 - r_q30, MAX_EXPONENT, x[3]);
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        int32_t sum = 0;

        for (int k = 0; has(t, kind) && k < t->of.sparse[kind].n_terms; k++) {
            int32_t value = t->of.sparse[kind].coef[k];

            for (int i = 0; i < 4; i++) {
                const int e = t->of.sparse[kind].power[k] >> (4 * i) & 15;

                value = e ? q_mul(value, x[i][e], 30) : value;
            }
            sum += value;
        }
        out->at[kind] = sum;
    }
}

void glint_transfer_ray(const struct glint_transfer *transfer, int32_t u_q30,
                        int32_t v_q30, struct glint_outputs *out)
{
    const struct glint_transfer *t = transfer;
    const int32_t v2_q30 = q_mul(v_q30, v_q30, 30);
    const struct glint_horner *k = glint_horner_of(0);

    if (transfer->basis == GLINT_BASIS_SPARSE) {
        ray_of_terms(transfer, u_q30, v_q30, out);
        return;
    }
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++) {
        int32_t of_u[GLINT_TABLE_WIDTH];

        out->at[kind] = 0;
        if (!has(t, kind))
            continue;
        set_row(t, k, kind, v_q30, v2_q30, of_u);
        k->along(&out->at[kind], of_u, t->degree_u[kind], &u_q30, 1);
    }
    raise_energies(t, &out->at[GLINT_OUT_ENERGY], 1);
}

static void rays_of_terms(const struct glint_transfer *t, const int32_t *u_q30,
                          int32_t v_q30, int32_t (*rays)[RAYS])
{
    for (int i = 0; i < RAYS; i++) {
        struct glint_outputs out;

        ray_of_terms(t, u_q30[i], v_q30, &out);
        for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
            rays[kind][i] = out.at[kind];
    }
}

void glint_transfer_rays(struct glint_transfer *transfer, int32_t v_q30,
                         const int32_t u_q30[GLINT_RAYS], int is_new,
                         int32_t out[GLINT_OUT_KINDS][GLINT_RAYS])
{
    const struct glint_horner *k = glint_horner_of(transfer->sets);

    if (transfer->basis == GLINT_BASIS_SPARSE) {
        rays_of_terms(transfer, u_q30, v_q30, out);
        return;
    }
    if (is_new)
        set_rows(transfer, k, v_q30, transfer->of_u);
    rays_of_rows(transfer, k, u_q30, out);
}

/* ----------------------------------------------------------------- vertices */

enum { LIMIT_Q16 = 1 << 30 };

/* As many rays as are computed at once, on their way to vertices. */
struct block {
    /* x and y, and those of the other side of the light's plane */
    int32_t sensor_q8[4][RAYS], stop_q16[4][RAYS];
    int32_t barrel_q16[2][RAYS];
    int32_t energy_q16[RAYS];
    int32_t lost[2][RAYS]; /* here and there: all bits, or none */
};

/* The rays' values X over 2^SHIFT; where that is LIMIT or more, or negative, a
 * ray is lost. */
static void scale_rays(const int32_t *x, int shift, int32_t limit,
                       int32_t *scaled, int32_t *lost)
{
    if (shift < 1 || shift > 30 || limit < LIMIT_Q16) {
        for (int i = 0; i < RAYS; i++)
            scaled[i] = q_scaled(x[i], shift, limit, &lost[i]);
        return;
    }
    for (int i = 0; i < RAYS; i++) /* below 2^30 + 61 and 2^29: no overflow */
        scaled[i] = (x[i] + (INT32_C(1) << (shift - 1))) >> shift;
}

static void set_radius(const struct glint_transfer *t, const int32_t *rays,
                       struct block *b)
{
    int32_t r_q16[RAYS];

    scale_rays(rays, -(t->exponent[GLINT_OUT_RADIUS] + 16), 1 << 23, r_q16,
               b->lost[0]);
    for (int i = 0; i < RAYS; i++)
        b->barrel_q16[0][i] =
            (int32_t)(((INT64_C(1) << 16) +
                       q_shift((int64_t)r_q16[i] * r_q16[i], 16)) /
                      2);
}

static void set_barrels(const struct glint_transfer *t,
                        const int32_t (*rays)[RAYS], struct block *b)
{
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < RAYS; i++)
            b->barrel_q16[k][i] = 0;
    if (has(t, GLINT_OUT_RADIUS))
        set_radius(t, rays[GLINT_OUT_RADIUS], b);
    for (int kind = GLINT_OUT_BARREL_0; kind < GLINT_OUT_KINDS; kind++) {
        int32_t *to = b->barrel_q16[kind > GLINT_OUT_BARREL_0];
        int32_t more[RAYS];

        if (!has(t, kind))
            continue;
        scale_rays(rays[kind], -(t->exponent[kind] + 16), LIMIT_Q16, more,
                   b->lost[0]);
        for (int i = 0; i < RAYS; i++) {
            b->lost[0][i] |= more[i] >> 31;
            to[i] = more[i] > to[i] ? more[i] : to[i];
        }
    }
}

/* Energies count 2^UP times, in 2^13, held to 0 .. 1. */
static void set_energies(const int32_t *energy, int up, int32_t *energy_q16)
{
    const int raise = up > 13 ? up - 13 : 0, lower = up < 13 ? 13 - up : 0;
    const int32_t half = lower ? INT32_C(1) << (lower - 1) : 0;
    const int32_t most = (INT32_C(1) << 16) >> raise;

    for (int i = 0; i < RAYS; i++) {
        const int32_t e = (energy[i] + half) >> lower;

        energy_q16[i] = (e < 0 ? 0 : e > most ? most : e) * (1 << raise);
    }
}

/* How rays lie in the picture: the azimuth of the light, for the sensor times
 * pixels per mm, and the shifts to the formats of a vertex. */
struct turns {
    struct glint_turn sensor, stop;
};

static struct turns turns_of(const struct glint_transfer *t,
                             const struct glint_place *p)
{
    const struct glint_real size = p->pixels_per_mm;

    return (struct turns){
        {(int32_t)q_shift((int64_t)p->cos_q30 * size.mantissa, 30),
         (int32_t)q_shift((int64_t)p->sin_q30 * size.mantissa, 30),
         -(t->exponent[GLINT_OUT_SENSOR_X] + size.exponent + 8),
         GLINT_VERTEX_LIMIT_Q8 / 2},
        {p->cos_q30, p->sin_q30, 30 - (t->exponent[GLINT_OUT_STOP_X] + 16),
         LIMIT_Q16}};
}

static void turn(const struct glint_turn *turn, unsigned sets, const int32_t *x,
                 const int32_t *y, int32_t (*out)[RAYS], int32_t (*lost)[RAYS])
{
    const int usual = turn->shift >= 1 && turn->shift <= 62;

    glint_turn_of(usual ? sets : 0)(turn, x, y, out, lost);
}

static void set_block(const struct glint_transfer *t, const struct turns *turns,
                      const int32_t (*rays)[RAYS], struct block *b)
{
    for (int i = 0; i < RAYS; i++)
        b->lost[0][i] = 0;
    set_barrels(t, rays, b);
    for (int i = 0; i < RAYS; i++)
        b->lost[1][i] = b->lost[0][i];
    set_energies(rays[GLINT_OUT_ENERGY], t->energy_up, b->energy_q16);
    turn(&turns->sensor, t->sets, rays[GLINT_OUT_SENSOR_X],
         rays[GLINT_OUT_SENSOR_Y], b->sensor_q8, b->lost);
    turn(&turns->stop, t->sets, rays[GLINT_OUT_STOP_X], rays[GLINT_OUT_STOP_Y],
         b->stop_q16, b->lost);
}

/* The first N of them on this side of the light's plane, or, SIDE 1, on the
 * other one. */
static void put_block(const struct block *b, const struct glint_place *p,
                      int side, int n, struct glint_vertex *v)
{
    for (int i = 0; i < n; i++)
        v[i] = (struct glint_vertex){
            .x_q8 = p->middle_x_q8 + b->sensor_q8[2 * side][i],
            .y_q8 = p->middle_y_q8 - b->sensor_q8[2 * side + 1][i],
            .stop_x_q16 = b->stop_q16[2 * side][i],
            .stop_y_q16 = b->stop_q16[2 * side + 1][i],
            .barrel_q16 = {b->barrel_q16[0][i], b->barrel_q16[1][i]},
            .energy_q16 = b->energy_q16[i] | b->lost[side][i]};
}

static int32_t node_q30(int k, int n_cells)
{
    return (int32_t)q_divide((int64_t)(2 * k - n_cells) * ONE_Q30, n_cells);
}

int32_t glint_transfer_v(const struct glint_transfer *transfer, int j, int n)
{
    const int rim = transfer->hollow;

    /* NOLINTNEXTLINE: there is a step */
    return (int32_t)q_divide(ONE_Q30 * ((int64_t)rim * n + j), (rim + 1) * n);
}

/* Whether row J lies between the two sides of a hollow box. */
static int is_hidden(const struct glint_transfer *t, int n_cells, int j)
{
    return t->hollow && 2 * j == n_cells;
}

/* V of row J. */
static int32_t row_q30(const struct glint_transfer *t, int n_cells, int j)
{
    const int last = n_cells / 2 - 1; /* of the lower side, at its rim */

    if (!t->hollow)
        return node_q30(j, n_cells);
    return j <= last ? -glint_transfer_v(t, last - j, last)
                     : glint_transfer_v(t, last - (n_cells - j), last);
}

/* Row J of the lower half into ROW, and the one on the other side of the
 * light's plane into MIRRORED, unless they are NULL. */
static void set_row_pair(struct glint_transfer *t,
                         const struct glint_place *place, int n_cells, int j,
                         struct glint_vertex *row,
                         struct glint_vertex *mirrored)
{
    const struct turns turns = turns_of(t, place);
    const int32_t v_q30 = row_q30(t, n_cells, j);

    if (t->n_nodes != n_cells + 1) {
        t->n_nodes = n_cells + 1;
        for (int i = 0; i < n_cells + RAYS; i++)
            t->node_q30[i] = node_q30(i < n_cells ? i : n_cells, n_cells);
    }
    for (int first = 0; first <= n_cells; first += RAYS) {
        const int n = n_cells + 1 - first < RAYS ? n_cells + 1 - first : RAYS;
        int32_t rays[GLINT_OUT_KINDS][RAYS];
        struct block b;

        glint_transfer_rays(t, v_q30, t->node_q30 + first, first == 0, rays);
        set_block(t, &turns, (const int32_t(*)[RAYS])rays, &b);
        if (row)
            put_block(&b, place, 0, n, row + first);
        if (mirrored)
            put_block(&b, place, 1, n, mirrored + first);
    }
}

static void lose_row(struct glint_vertex *row, int n_cells)
{
    for (int i = 0; i <= n_cells; i++)
        row[i].energy_q16 = -1;
}

void glint_transfer_row(struct glint_transfer *transfer,
                        const struct glint_place *place, int n_cells, int j,
                        struct glint_vertex *row)
{
    const int sparse = transfer->basis == GLINT_BASIS_SPARSE;

    if (is_hidden(transfer, n_cells, j))
        lose_row(row, n_cells);
    else if (sparse || 2 * j <= n_cells)
        set_row_pair(transfer, place, n_cells, j, row, NULL);
    else
        set_row_pair(transfer, place, n_cells, n_cells - j, NULL, row);
}

void glint_transfer_rows(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells, int j,
                         struct glint_vertex *row,
                         struct glint_vertex *mirrored)
{
    if (is_hidden(transfer, n_cells, j)) {
        lose_row(row, n_cells);
        lose_row(mirrored, n_cells);
    } else if (transfer->basis == GLINT_BASIS_SPARSE) {
        set_row_pair(transfer, place, n_cells, j, row, NULL);
        set_row_pair(transfer, place, n_cells, n_cells - j, mirrored, NULL);
    } else {
        set_row_pair(transfer, place, n_cells, j, row, mirrored);
    }
}

void glint_transfer_grid(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells,
                         struct glint_vertex *vertices)
{
    const int sparse = transfer->basis == GLINT_BASIS_SPARSE;
    const int nodes = n_cells + 1;

    for (int j = 0; j < nodes; j++) {
        struct glint_vertex *row = vertices + (ptrdiff_t)j * nodes;
        struct glint_vertex *mirrored =
            vertices + (ptrdiff_t)(n_cells - j) * nodes;

        if (is_hidden(transfer, n_cells, j))
            lose_row(row, n_cells);
        else if (sparse)
            set_row_pair(transfer, place, n_cells, j, row, NULL);
        else if (2 * j <= n_cells)
            set_row_pair(transfer, place, n_cells, j, row, mirrored);
    }
}
