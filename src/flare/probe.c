/* SPDX-License-Identifier: MIT */
#include "flare/probe.h"

#include "base/q.h"
#include "base/real.h"

/* Converts X to an integer in the unit of output KIND (a position or a barrel
 * value) of the polynomials T. */
static int64_t convert_to_output_units(const struct glint_transfer *t, int kind,
                                       int64_t x_q46)
{
    return real_integer(real_of(x_q46, -46), -t->exponent[kind],
                        INT64_C(1) << 31);
}

static int is_stop_output(int kind)
{
    return kind == GLINT_OUT_STOP_X || kind == GLINT_OUT_STOP_Y;
}

static void init_probe(struct glint_probe *s, const struct glint_transfer *t,
                       int32_t opening_q30, int across, int down)
{
    /* Rays just outside count as inside, so the limits are multiplied by
     * 1.05. */
    const int64_t near_q16 = 68813;

    s->across = across;
    s->down = t->whole ? 2 * down : down;
    s->rows = 2 * down;
    s->n_bends = s->n_up = s->n_down = s->n_inside = 0;
    s->n_bent[0] = s->n_bent[1] = 0;
    s->seen = s->reach = (struct glint_probe_extent){INT32_MAX, -INT32_MAX,
                                                     t->whole ? INT32_MAX : 0,
                                                     t->whole ? -INT32_MAX : 0};
    s->whole = t->whole;
    s->energy = 0;
    s->least_area = UINT64_MAX;
    s->n_kinds = 0;
    for (int k = 0; k < GLINT_OUT_KINDS; k++) {
        s->change[k] = (struct glint_probe_change){0, 0, {0, 0}};
        s->limit[k] = convert_to_output_units(
            t, k,
            near_q16 * (is_stop_output(k) ? opening_q30 : INT32_C(1) << 30));
        if (t->outputs >> k & 1 && k != GLINT_OUT_ENERGY)
            s->kind[s->n_kinds++] = (uint8_t)k;
    }
}

static int is_ray_inside(const struct glint_probe *s,
                         const struct glint_transfer *t, const int32_t *at)
{
    const int64_t x = at[GLINT_OUT_STOP_X], y = at[GLINT_OUT_STOP_Y];
    const int64_t r = s->limit[GLINT_OUT_STOP_X];

    if (x * x + y * y >= r * r)
        return 0;
    for (int kind = GLINT_OUT_RADIUS; kind < GLINT_OUT_KINDS; kind++)
        if (t->outputs >> kind & 1 && at[kind] >= s->limit[kind])
            return 0;
    return 1;
}

/* Traces row J of the probe's rays, 0 .. s->down. */
static void trace_probe_row(struct glint_probe *s, struct glint_transfer *t,
                            int j)
{
    const int32_t one_q30 = INT32_C(1) << 30;
    const int32_t v_q30 = glint_transfer_v(t, j, s->down);
    struct glint_probe_node *row = s->row[j % 3];

    for (int first = 0; first <= s->across; first += GLINT_RAYS) {
        int32_t u_q30[GLINT_RAYS], out[GLINT_OUT_KINDS][GLINT_RAYS];

        for (int i = 0; i < GLINT_RAYS; i++)
            u_q30[i] = glint_transfer_u(
                t, first + i < s->across
                       ? 2 * (one_q30 / s->across) * (first + i) - one_q30
                       : one_q30);
        glint_transfer_rays(t, v_q30, u_q30, first == 0, out);
        for (int i = 0; i < GLINT_RAYS && first + i <= s->across; i++) {
            struct glint_probe_node *n = &row[first + i];

            for (int k = 0; k < s->n_kinds; k++)
                n->at[s->kind[k]] = out[s->kind[k]][i];
            n->at[GLINT_OUT_ENERGY] = out[GLINT_OUT_ENERGY][i];
            n->inside = is_ray_inside(s, t, n->at);
        }
    }
}

/* Adds the first and second differences of all outputs at ray B to the sums of
 * S, if B is inside. A and C are its neighbours. The differences are scaled
 * from STEPS cells to the complete pupil box. WAY: direction from A to C, 0
 * across, 1 down. */
static void add_differences_at_ray(struct glint_probe *s,
                                   const struct glint_probe_node *a,
                                   const struct glint_probe_node *b,
                                   const struct glint_probe_node *c, int steps,
                                   int way)
{
    if (!b->inside)
        return;
    for (int i = 0; i < s->n_kinds; i++) {
        const int k = s->kind[i];
        const int64_t first = ((int64_t)c->at[k] - a->at[k]) / 2 * steps;
        const int64_t second =
            ((int64_t)a->at[k] - 2 * (int64_t)b->at[k] + c->at[k]) * steps *
            steps;
        /* Squares are below 2^62 / 2^10, so several hundred can be summed. */
        const int64_t f =
            q_clamp_sat(first >> GLINT_PROBE_FINE_LOG2, -INT32_MAX, INT32_MAX);
        const int64_t d =
            q_clamp_sat(second >> GLINT_PROBE_FINE_LOG2, -INT32_MAX, INT32_MAX);

        s->change[k].first += (uint64_t)(f * f) >> 10;
        s->change[k].second += (uint64_t)(d * d) >> 10;
        s->change[k].bent[way] += d;
    }
    s->n_bends++;
    s->n_bent[way]++;
}

static void add_cell_orientation_and_area(struct glint_probe *s,
                                          const struct glint_probe_node *a,
                                          const struct glint_probe_node *b,
                                          const struct glint_probe_node *c)
{
    const int64_t turn =
        ((int64_t)b->at[0] - a->at[0]) * ((int64_t)c->at[1] - a->at[1]) / 2 -
        ((int64_t)b->at[1] - a->at[1]) * ((int64_t)c->at[0] - a->at[0]) / 2;
    const uint64_t area = (uint64_t)(turn < 0 ? -turn : turn);

    if (!(a->inside || b->inside || c->inside))
        return;
    s->n_up += turn > 0;
    s->n_down += turn < 0;
    s->least_area = area < s->least_area ? area : s->least_area;
}

static void extend_extent_by_ray(const struct glint_probe *s,
                                 struct glint_probe_extent *e,
                                 const struct glint_probe_node *n)
{
    const int64_t x = n->at[GLINT_OUT_SENSOR_X], y = n->at[GLINT_OUT_SENSOR_Y];
    const int64_t away = y < 0 ? -y : y;
    const int64_t low = s->whole ? y : -away, high = s->whole ? y : away;

    e->low = x < e->low ? x : e->low;
    e->high = x > e->high ? x : e->high;
    e->y_low = low < e->y_low ? low : e->y_low;
    e->y_high = high > e->y_high ? high : e->y_high;
}

/* Extends s->reach by a cell if one of its corner rays is inside. The rays A
 * and B are above C and D. */
static void extend_reach_by_cell(struct glint_probe *s,
                                 const struct glint_probe_node *a,
                                 const struct glint_probe_node *b,
                                 const struct glint_probe_node *c,
                                 const struct glint_probe_node *d)
{
    if (!(a->inside || b->inside || c->inside || d->inside))
        return;
    extend_extent_by_ray(s, &s->reach, a);
    extend_extent_by_ray(s, &s->reach, b);
    extend_extent_by_ray(s, &s->reach, c);
    extend_extent_by_ray(s, &s->reach, d);
}

static void add_passing_ray(struct glint_probe *s,
                            const struct glint_probe_node *n)
{
    if (!n->inside)
        return;
    s->n_inside++;
    extend_extent_by_ray(s, &s->seen, n);
    s->energy = n->at[GLINT_OUT_ENERGY] > s->energy ? n->at[GLINT_OUT_ENERGY]
                                                    : s->energy;
}

void glint_probe_trace_bundle(struct glint_probe *probe,
                              struct glint_transfer *t, int32_t opening_q30,
                              int across, int down)
{
    init_probe(probe, t, opening_q30, across, down);
    down = probe->down;
    probe->n_rays += (across + 1) * (down + 1);
    for (int j = 0; j <= down; j++) {
        const struct glint_probe_node *here = probe->row[j % 3];
        const struct glint_probe_node *above = probe->row[(j + 2) % 3];
        const struct glint_probe_node *top = probe->row[(j + 1) % 3];

        trace_probe_row(probe, t, j);
        for (int i = 0; i <= across; i++) {
            add_passing_ray(probe, &here[i]);
            if (i > 0 && i < across)
                add_differences_at_ray(probe, &here[i - 1], &here[i],
                                       &here[i + 1], across, 0);
            if (j > 1)
                add_differences_at_ray(probe, &top[i], &above[i], &here[i],
                                       probe->rows, 1);
            if (j > 0 && i < across) {
                add_cell_orientation_and_area(probe, &above[i], &above[i + 1],
                                              &here[i]);
                extend_reach_by_cell(probe, &above[i], &above[i + 1], &here[i],
                                     &here[i + 1]);
            }
        }
    }
}
