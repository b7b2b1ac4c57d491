/* SPDX-License-Identifier: MIT
 *
 * A model's rays for the run-time half: bundles by its polynomials instead of
 * by tracing.
 */
#include "bake/feed.h"

#include <math.h>

#include "bake/degrees.h"
#include "bake/quantise.h"
#include "glint/flare.h"

enum { ACROSS = 24, DOWN = 12 }; /* cells of what decides the grid */

/* ---------------------------------------------------------------- transfers */

static int32_t sine_q30(double degrees)
{
    return (int32_t)lrint(glint_sin_deg(degrees) * 0x1p30);
}

static int32_t wave_q24(double nm)
{
    return (int32_t)lrint(1e6 / (nm * nm) * 0x1p24);
}

static bool transfer_of(const struct glint_feed_config *cfg,
                        const struct glint_feed *feed, struct glint_transfer *t)
{
    if (!glint_transfer_init(
            t, cfg->lens, feed->ghost, sine_q30(feed->lamp->theta_deg),
            wave_q24(cfg->setup->wavelength_nm[feed->wavelength])))
        return false;
    if (cfg->narrow)
        glint_transfer_narrow(t);
    return true;
}

/* ------------------------------------------------------------------- survey */

/* One ray: values by kind. */
struct probe {
    double at[GLINT_OUT_KINDS];
    bool inside; /* of the stop and the barrels, and a little around */
};

static double value(const struct glint_transfer *t,
                    const struct glint_outputs *out, int kind)
{
    return ldexp(out->at[kind], t->exponent[kind]);
}

static bool is_inside(const struct glint_transfer *t,
                      const struct glint_outputs *out)
{
    bool inside = hypot(value(t, out, GLINT_OUT_STOP_X),
                        value(t, out, GLINT_OUT_STOP_Y)) < 1.05;

    for (int kind = GLINT_OUT_RADIUS; kind < GLINT_OUT_KINDS; kind++)
        if (t->outputs >> kind & 1)
            inside &= value(t, out, kind) < 1.05;
    return inside;
}

static void probe_ray(const struct glint_transfer *t, int i, int j,
                      struct probe *p)
{
    const int32_t one_q30 = INT32_C(1) << 30;
    struct glint_outputs out;

    glint_transfer_ray(t, (int32_t)((2.0 * i / ACROSS - 1) * one_q30),
                       (int32_t)((double)j / DOWN * one_q30), &out);
    for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
        p->at[kind] = value(t, &out, kind);
    p->inside = is_inside(t, &out) && !(t->hollow && 2 * j < DOWN);
}

/* How a quantity changes from ray to ray: sums of squares. */
struct change {
    double first, second;
};

/* What the rays of a coarse grid say of the bundle. */
struct survey {
    struct probe at[DOWN + 1][ACROSS + 1];
    struct change change[GLINT_OUT_KINDS];
    int n_bends;
    int up, down; /* cells by the way they are turned */
};

/* B between A and C, STEPS of which fit the box. */
static void add_bend(struct survey *s, const struct probe *a,
                     const struct probe *b, const struct probe *c, double steps)
{
    if (!b->inside)
        return;
    for (int k = 0; k < GLINT_OUT_KINDS; k++) {
        const double first = 0.5 * steps * (c->at[k] - a->at[k]);
        const double second =
            steps * steps * (a->at[k] - 2 * b->at[k] + c->at[k]);

        s->change[k].first += first * first;
        s->change[k].second += second * second;
    }
    s->n_bends++;
}

static double bend_mm(const struct survey *s)
{
    return s->n_bends ? sqrt((s->change[GLINT_OUT_SENSOR_X].second +
                              s->change[GLINT_OUT_SENSOR_Y].second) /
                             s->n_bends)
                      : 0;
}

/* What the bend of the kinds FROM .. TO, which cut, is worth on the sensor. */
static double cut_mm(const struct survey *s, int from, int to)
{
    const double sensor = s->change[GLINT_OUT_SENSOR_X].first +
                          s->change[GLINT_OUT_SENSOR_Y].first;
    double first = 0, second = 0;

    for (int k = from; k <= to; k++) {
        first += s->change[k].first;
        second += s->change[k].second;
    }
    return first > 0 ? sqrt(second / s->n_bends * sensor / first) : 0;
}

static double outline_mm(const struct survey *s)
{
    double most = cut_mm(s, GLINT_OUT_STOP_X, GLINT_OUT_STOP_Y);

    for (int k = GLINT_OUT_RADIUS; k < GLINT_OUT_KINDS; k++)
        most = fmax(most, cut_mm(s, k, k));
    return most;
}

static void add_turn(struct survey *s, int i, int j)
{
    const struct probe *a = &s->at[j][i], *b = &s->at[j][i + 1];
    const struct probe *c = &s->at[j + 1][i];
    const double turn = (b->at[0] - a->at[0]) * (c->at[1] - a->at[1]) -
                        (b->at[1] - a->at[1]) * (c->at[0] - a->at[0]);

    if (!(a->inside || b->inside || c->inside))
        return;
    s->up += turn > 0;
    s->down += turn < 0;
}

static void run_survey(struct survey *s, const struct glint_transfer *t)
{
    s->n_bends = s->up = s->down = 0;
    for (int k = 0; k < GLINT_OUT_KINDS; k++)
        s->change[k] = (struct change){0, 0};
    for (int j = 0; j <= DOWN; j++)
        for (int i = 0; i <= ACROSS; i++)
            probe_ray(t, i, j, &s->at[j][i]);
    for (int j = 0; j <= DOWN; j++)
        for (int i = 0; i <= ACROSS; i++) {
            if (i > 0 && i < ACROSS)
                add_bend(s, &s->at[j][i - 1], &s->at[j][i], &s->at[j][i + 1],
                         ACROSS);
            if (j > 0 && j < DOWN)
                add_bend(s, &s->at[j - 1][i], &s->at[j][i], &s->at[j + 1][i],
                         2 * DOWN);
            if (i < ACROSS && j < DOWN)
                add_turn(s, i, j);
        }
}

/* Where the light is, and how strong; a tenth more for what lies between the
 * rays of the survey. False: nothing gets through. */
static bool set_extent(const struct survey *s, struct glint_pupil *p)
{
    double low = HUGE_VAL, high = -HUGE_VAL, y = 0;

    p->energy = 0;
    for (int k = 0; k < (DOWN + 1) * (ACROSS + 1); k++) {
        const struct probe *a = &s->at[k / (ACROSS + 1)][k % (ACROSS + 1)];

        if (!a->inside)
            continue;
        low = fmin(low, a->at[GLINT_OUT_SENSOR_X]);
        high = fmax(high, a->at[GLINT_OUT_SENSOR_X]);
        y = fmax(y, fabs(a->at[GLINT_OUT_SENSOR_Y]));
        p->energy = fmax(p->energy, a->at[GLINT_OUT_ENERGY]);
    }
    p->sensor_mm[0] = low - 0.1 * (high - low);
    p->sensor_mm[1] = high + 0.1 * (high - low);
    p->sensor_mm[3] = 1.1 * y;
    p->sensor_mm[2] = -p->sensor_mm[3];
    return high >= low;
}

/* --------------------------------------------------------------------- feed */

/* Of the largest energy that a transfer can give. */
static int energy_log2(const struct glint_transfer *t)
{
    return t->exponent[GLINT_OUT_ENERGY] + 29;
}

/* How far energies can be lifted where ENERGY is the most that was seen, with a
 * quarter more for what lies between the rays of the survey. */
static int energy_up(const struct glint_transfer *t, double energy)
{
    const int up = energy > 0 ? energy_log2(t) - 1 - ilogb(1.25 * energy) : 0;

    return up < 0 ? 0 : up > 29 ? 29 : up;
}

void glint_feed_plan_model(const struct glint_feed_config *cfg,
                           struct glint_feed *feed)
{
    struct glint_pupil *p = &feed->pupil;
    struct glint_transfer t;
    struct survey s; /* 30 KB */
    double unit;

    feed->n_cells = 0;
    feed->found = transfer_of(cfg, feed, &t);
    if (!feed->found)
        return;
    unit = ldexp(1, t.box_exponent);
    p->x0_mm = unit * ((double)t.box[0] - t.box[1]);
    p->x1_mm = unit * ((double)t.box[0] + t.box[1]);
    p->y1_mm = unit * t.box[2];
    run_survey(&s, &t);
    feed->found = set_extent(&s, p);
    feed->energy_unit = ldexp(1, energy_log2(&t) - energy_up(&t, p->energy));
    if (feed->found && glint_feed_in_view(cfg, feed))
        feed->n_cells = glint_feed_cells(cfg, bend_mm(&s), outline_mm(&s),
                                         s.up > 0 && s.down > 0);
    if (t.hollow) /* its rim has to be a row */
        feed->n_cells = (feed->n_cells + 3) / 4 * 4;
}

void glint_feed_trace_model(const struct glint_feed_config *cfg,
                            const struct glint_feed *feed,
                            struct glint_vertex *vertex)
{
    const struct glint_place place = {
        .cos_q30 = (int32_t)lrint(glint_cos_deg(feed->lamp->phi_deg) * 0x1p30),
        .sin_q30 = (int32_t)lrint(glint_sin_deg(feed->lamp->phi_deg) * 0x1p30),
        .pixels_per_mm =
            glint_real_of(cfg->view.width / cfg->view.sensor_width_mm),
        .middle_x_q8 = cfg->view.width * 128,
        .middle_y_q8 = cfg->view.height * 128};
    struct glint_transfer t;

    if (!transfer_of(cfg, feed, &t))
        return;
    t.energy_up = (uint8_t)(energy_log2(&t) - ilogb(feed->energy_unit));
    glint_transfer_grid(&t, &place, feed->n_cells, vertex);
}
