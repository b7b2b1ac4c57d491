/* SPDX-License-Identifier: MIT */
#include "flare/plan.h"

#include "base/divide.h"
#include "base/q.h"
#include "base/real.h"

enum {
    /* a row is as many rays as are computed at once */
    FEW_ACROSS = GLINT_RAYS - 1,
    FEW_DOWN = 4,
    FEW_INSIDE = 6,
    FINE_LOG2 = 6, /* squares are of differences over so much */
    LEAST = 8,     /* cells a side */
    FOLD_OCTAVES = 3
};

/* --------------------------------------------------------------------- survey
 */

/* X as an integer of the output's unit. */
static int64_t in_units(const struct glint_transfer *t, int kind, int64_t x_q16)
{
    return real_integer(real_of(x_q16, -16), -t->exponent[kind],
                        INT64_C(1) << 31);
}

static void begin(struct glint_plan_survey *s, const struct glint_transfer *t,
                  int across, int down)
{
    const int64_t near_q16 = 68813; /* 1.05 */

    s->across = across;
    s->down = down;
    s->n_bends = s->n_up = s->n_down = s->n_inside = 0;
    s->n_bent[0] = s->n_bent[1] = 0;
    s->seen = s->reach = (struct glint_plan_extent){INT32_MAX, -INT32_MAX, 0};
    s->energy = 0;
    s->least_area = UINT64_MAX;
    s->n_kinds = 0;
    for (int k = 0; k < GLINT_OUT_KINDS; k++) {
        s->change[k] = (struct glint_plan_change){0, 0, {0, 0}};
        s->limit[k] = in_units(t, k, near_q16);
        if (t->outputs >> k & 1 && k != GLINT_OUT_ENERGY)
            s->kind[s->n_kinds++] = (uint8_t)k;
    }
}

static int is_inside(const struct glint_plan_survey *s,
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

/* Rays of row J of s->down. */
static void survey_row(struct glint_plan_survey *s, struct glint_transfer *t,
                       int j)
{
    const int32_t one_q30 = INT32_C(1) << 30;
    const int32_t v_q30 = glint_transfer_v(t, j, s->down);
    struct glint_plan_node *row = s->row[j % 3];

    for (int first = 0; first <= s->across; first += GLINT_RAYS) {
        int32_t u_q30[GLINT_RAYS], out[GLINT_OUT_KINDS][GLINT_RAYS];

        for (int i = 0; i < GLINT_RAYS; i++)
            u_q30[i] = first + i < s->across
                           ? 2 * (one_q30 / s->across) * (first + i) - one_q30
                           : one_q30;
        glint_transfer_rays(t, v_q30, u_q30, first == 0, out);
        for (int i = 0; i < GLINT_RAYS && first + i <= s->across; i++) {
            struct glint_plan_node *n = &row[first + i];

            for (int k = 0; k < s->n_kinds; k++)
                n->at[s->kind[k]] = out[s->kind[k]][i];
            n->at[GLINT_OUT_ENERGY] = out[GLINT_OUT_ENERGY][i];
            n->inside = is_inside(s, t, n->at);
        }
    }
}

/* B between A and C, STEPS of which fit the box, across (WAY 0) or down. */
static void add_bend(struct glint_plan_survey *s,
                     const struct glint_plan_node *a,
                     const struct glint_plan_node *b,
                     const struct glint_plan_node *c, int steps, int way)
{
    if (!b->inside)
        return;
    for (int i = 0; i < s->n_kinds; i++) {
        const int k = s->kind[i];
        const int64_t first = ((int64_t)c->at[k] - a->at[k]) / 2 * steps;
        const int64_t second =
            ((int64_t)a->at[k] - 2 * (int64_t)b->at[k] + c->at[k]) * steps *
            steps;
        /* squares below 2^62, some hundred of them over 2^10 */
        const int64_t f =
            q_clamp_sat(first >> FINE_LOG2, -INT32_MAX, INT32_MAX);
        const int64_t d =
            q_clamp_sat(second >> FINE_LOG2, -INT32_MAX, INT32_MAX);

        s->change[k].first += (uint64_t)(f * f) >> 10;
        s->change[k].second += (uint64_t)(d * d) >> 10;
        s->change[k].bent[way] += d;
    }
    s->n_bends++;
    s->n_bent[way]++;
}

static void add_cell(struct glint_plan_survey *s,
                     const struct glint_plan_node *a,
                     const struct glint_plan_node *b,
                     const struct glint_plan_node *c)
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

static void widen(struct glint_plan_extent *e, const struct glint_plan_node *n)
{
    const int64_t x = n->at[GLINT_OUT_SENSOR_X], y = n->at[GLINT_OUT_SENSOR_Y];

    e->low = x < e->low ? x : e->low;
    e->high = x > e->high ? x : e->high;
    e->wide = y > e->wide ? y : -y > e->wide ? -y : e->wide;
}

/* The cell between A and B, and C and D beside them. */
static void add_reach(struct glint_plan_survey *s,
                      const struct glint_plan_node *a,
                      const struct glint_plan_node *b,
                      const struct glint_plan_node *c,
                      const struct glint_plan_node *d)
{
    if (!(a->inside || b->inside || c->inside || d->inside))
        return;
    widen(&s->reach, a);
    widen(&s->reach, b);
    widen(&s->reach, c);
    widen(&s->reach, d);
}

static void add_seen(struct glint_plan_survey *s,
                     const struct glint_plan_node *n)
{
    if (!n->inside)
        return;
    s->n_inside++;
    widen(&s->seen, n);
    s->energy = n->at[GLINT_OUT_ENERGY] > s->energy ? n->at[GLINT_OUT_ENERGY]
                                                    : s->energy;
}

static void run_survey(struct glint_plan_survey *s, struct glint_transfer *t,
                       int across, int down)
{
    begin(s, t, across, down);
    s->n_rays += (across + 1) * (down + 1);
    for (int j = 0; j <= down; j++) {
        const struct glint_plan_node *here = s->row[j % 3];
        const struct glint_plan_node *above = s->row[(j + 2) % 3];
        const struct glint_plan_node *top = s->row[(j + 1) % 3];

        survey_row(s, t, j);
        for (int i = 0; i <= across; i++) {
            add_seen(s, &here[i]);
            if (i > 0 && i < across)
                add_bend(s, &here[i - 1], &here[i], &here[i + 1], across, 0);
            if (j > 1)
                add_bend(s, &top[i], &above[i], &here[i], 2 * down, 1);
            if (j > 0 && i < across) {
                add_cell(s, &above[i], &above[i + 1], &here[i]);
                add_reach(s, &above[i], &above[i + 1], &here[i], &here[i + 1]);
            }
        }
    }
}

/* --------------------------------------------------------------------- result
 */

/* Root of SUM / N, of differences whose squares were taken over 2^10 more. */
static int64_t root_mean(uint64_t sum, int n)
{
    return n ? (int64_t)q_root((uint64_t)q_divide((int64_t)sum, n)) << 5 : 0;
}

/* The second derivative of the kinds A and B, worth on the sensor, in units of
 * that over 2^FINE_LOG2. */
static int64_t bend_of(const struct glint_plan_survey *s, int a, int b)
{
    const int64_t second = root_mean(
        s->change[a].second + (a == b ? 0 : s->change[b].second), s->n_bends);
    const int64_t first = root_mean(
        s->change[a].first + (a == b ? 0 : s->change[b].first), s->n_bends);
    const int64_t sensor = root_mean(s->change[GLINT_OUT_SENSOR_X].first +
                                         s->change[GLINT_OUT_SENSOR_Y].first,
                                     s->n_bends);

    return first ? q_divide(second * sensor, first) : 0; /* 2^30 * 2^31 */
}

/* What the stop position changes by over the box, and the stop's radius, both
 * in units of the outputs over 2^FINE_LOG2. */
static int64_t stop_change(const struct glint_plan_survey *s)
{
    return root_mean(s->change[GLINT_OUT_STOP_X].first +
                         s->change[GLINT_OUT_STOP_Y].first,
                     s->n_bends);
}

static int64_t one_radius(const struct glint_plan_survey *s)
{
    const int64_t radius = q_divide(s->limit[GLINT_OUT_STOP_X] * 20, 21) >>
                           FINE_LOG2; /* of 1.05 */

    return radius > 0 ? radius : 1; /* of coarser units than a radius */
}

/* The same of a round stop's outline, (1 + r^2) / 2 like a barrel's: where r is
 * 1, that changes as fast as the stop position S does, and bends by S'^2. */
static int64_t round_bend(const struct glint_plan_survey *s)
{
    const int64_t sensor = root_mean(s->change[GLINT_OUT_SENSOR_X].first +
                                         s->change[GLINT_OUT_SENSOR_Y].first,
                                     s->n_bends);

    /* 2^30 * 2^31 */
    return q_divide((stop_change(s) >> 2) * sensor, (one_radius(s) >> 2) + 1);
}

static struct glint_real pixels_per_mm(const struct glint_plan *p)
{
    struct glint_real x = p->frame->pixels_per_mm;

    x.exponent -= p->half;
    return x;
}

/* What codes need of N cells a side. Errors of a faint ghost are the less seen:
 * in codes its light shrinks by 2^(5/12) with each octave, its errors with the
 * square of the cells. Folds are brighter than their ghost's mean. */
static int cells_for_codes(const struct glint_plan_survey *s,
                           struct glint_real light, int n)
{
    const int folded = s->n_up && s->n_down;
    int octaves = -(light.exponent + 31) - (folded ? FOLD_OCTAVES : 0);

    if (!folded)
        n -= n / 4;
    for (; octaves > 0 && n > LEAST; octaves--)
        n -= n / 8;
    return n;
}

/* How much more outlines may bend than light does. A vertex has two barrels, of
 * which the second is the tightest of all others: where three and more meet it
 * has kinks, so that tips of outlines come and go with the grid. A round stop
 * is round on all sides, of every ghost. */
static int outline_over_light(const struct glint_plan *p,
                              const struct glint_transfer *t)
{
    return p->round || t->outputs >> GLINT_OUT_BARREL_2 & 1 ? 5 : 10;
}

/* As many cells as keep what is straight between rays within a hundredth of a
 * pixel of what bends, at fineness 64, and outlines within a tenth: light piles
 * up along folds, but not along cuts. */
static int cells_of(const struct glint_plan *p,
                    const struct glint_plan_survey *s,
                    const struct glint_transfer *t, struct glint_real light)
{
    const struct glint_flare_frame *r = p->frame;
    const int folds = (s->n_up && s->n_down ? 4 : 2) * r->fineness;
    const int most = folds < GLINT_MAX_CELLS ? folds : GLINT_MAX_CELLS;
    int64_t bend = bend_of(s, GLINT_OUT_SENSOR_X, GLINT_OUT_SENSOR_Y);
    int64_t outline = bend_of(s, GLINT_OUT_STOP_X, GLINT_OUT_STOP_Y);
    int64_t bend_q8;
    int n;

    if (r->uniform)
        return r->fineness;
    for (int k = GLINT_OUT_RADIUS; k < GLINT_OUT_KINDS; k++)
        if (t->outputs >> k & 1) {
            const int64_t cut = bend_of(s, k, k);

            outline = cut > outline ? cut : outline;
        }
    if (p->round) {
        const int64_t cut = round_bend(s);

        outline = cut > outline ? cut : outline;
    }
    outline = q_divide(outline, outline_over_light(p, t));
    bend = bend > outline ? bend : outline;
    bend_q8 = real_integer(
        real_times(real_of(bend, t->exponent[GLINT_OUT_SENSOR_X] + FINE_LOG2),
                   pixels_per_mm(p)),
        8, INT64_C(1) << 40);
    /* the root of 12.5 times as much, times fineness / 64 */
    n = q_narrow(
        ((int64_t)q_root((uint64_t)bend_q8 * 3200) * r->fineness + 16383) >>
        14);
    if (r->faintest.mantissa)
        n = cells_for_codes(s, light, n);
    n = n < LEAST ? LEAST : n;
    n = (n + 3) / 4 * 4;
    return n < most ? n : most;
}

/* As N, but even, and two more if there is room. */
static int hollow_cells(int n)
{
    const int more = (n + 3) / 2 * 2;

    return more < GLINT_MAX_CELLS ? more : GLINT_MAX_CELLS;
}

/* What kind K bends by over the box, all ways together, in its units over
 * 2^FINE_LOG2. */
static int64_t bowl_of(const struct glint_plan_survey *s, int k)
{
    int64_t sum = 0;

    for (int way = 0; way < 2; way++)
        sum += s->n_bent[way] ? q_divide(s->change[k].bent[way], s->n_bent[way])
                              : 0;
    return sum;
}

/* The same of a round stop, where r^2 / 2 bends by the square of what the stop
 * position changes by. */
static int64_t round_bowl_q16(const struct glint_plan_survey *s)
{
    const struct glint_real change =
        real_over(real_of(stop_change(s), 0), real_of(one_radius(s), 0));

    return 2 * real_integer(real_times(change, change), 16, INT64_C(1) << 40);
}

/* How far what is straight between the rays of N_CELLS lies off such a bowl in
 * the mean: where a cell bends by D across and E down, (D + E) / 12. */
static uint16_t sag_q16(int64_t bowl_q16, int n_cells)
{
    return (uint16_t)q_clamp_sat(
        q_divide(bowl_q16, 12 * (int64_t)n_cells * n_cells), 0, 1 << 12);
}

/* A barrel's (1 + r^2) / 2 is a bowl. With the sag taken off, outlines lie as
 * often outside as inside. */
static void set_sags(struct glint_bundle_plan *planned,
                     const struct glint_plan_survey *s,
                     const struct glint_transfer *t, int n_cells, int round)
{
    for (int k = GLINT_OUT_BARREL_0; k <= GLINT_OUT_BARREL_1; k++) {
        const int64_t bowl_q16 =
            t->outputs >> k & 1
                ? real_integer(
                      real_of(bowl_of(s, k), t->exponent[k] + FINE_LOG2), 16,
                      INT64_C(1) << 40)
                : 0;

        planned->sag_q16[k - GLINT_OUT_BARREL_0] = sag_q16(bowl_q16, n_cells);
    }
    planned->sag_q16[2] = round ? sag_q16(round_bowl_q16(s), n_cells) : 0;
}

/* X of the sensor as pixels, q8. */
static int64_t pixels_q8(const struct glint_plan *p,
                         const struct glint_transfer *t, int64_t x)
{
    return real_integer(real_times(real_of(x, t->exponent[GLINT_OUT_SENSOR_X]),
                                   pixels_per_mm(p)),
                        8, INT64_C(1) << 31);
}

/* What the survey's rays reach, and a tenth more, turned by the light's
 * azimuth, meets the picture. */
static int is_in_view(const struct glint_plan *p, const struct glint_light *b,
                      const struct glint_transfer *t,
                      const struct glint_plan_extent *e)
{
    const int64_t middle_q8 = pixels_q8(p, t, (e->low + e->high) / 2);
    const int64_t wide_q8 =
        pixels_q8(p, t, q_divide((e->high - e->low) * 11, 20)) + 256;
    const int64_t high_q8 =
        pixels_q8(p, t, e->wide + q_divide(e->wide, 10)) + 256;
    const int64_t c = b->cos_q30 < 0 ? -b->cos_q30 : b->cos_q30;
    const int64_t s = b->sin_q30 < 0 ? -b->sin_q30 : b->sin_q30;
    const int64_t m = middle_q8 < 0 ? -middle_q8 : middle_q8;

    return ((m - wide_q8) * c - s * high_q8) >> 30 <= p->width * 128 >>
               p->half &&
           ((m - wide_q8) * s - c * high_q8) >> 30 <= p->height * 128 >>
               p->half;
}

static struct glint_real box_side(const struct glint_transfer *t, int k)
{
    return real_of(t->box[k], t->box_exponent);
}

/* The colour of the bundle, its largest channel 1; returns what that was. */
static struct glint_real colour_of(const struct glint_wave *w,
                                   const struct glint_light *b,
                                   int32_t *rgb_q14)
{
    int64_t rgb_q28[3], most = 0;

    for (int c = 0; c < 3; c++) {
        const int64_t x = (int64_t)w->rgb_q14[c] * b->rgb_q14[c];

        rgb_q28[c] = x;
        most = x > most ? x : -x > most ? -x : most;
    }
    for (int c = 0; c < 3; c++)
        rgb_q14[c] =
            most ? q_narrow(q_divide(rgb_q28[c] * (1 << 14), most)) : 0;
    return real_of(most, -28);
}

/* Flux of the whole box, or of what a hollow one is, at energy 2^EXPONENT. */
static struct glint_real flux_of(const struct glint_plan *p,
                                 const struct glint_bundle_plan *s,
                                 const struct glint_transfer *t,
                                 struct glint_real colour, int exponent)
{
    const struct glint_wave *w = &p->frame->wave[s->wave];
    const struct glint_light *b = &p->light[s->light];
    struct glint_real x = real_times(box_side(t, 1), box_side(t, 2));

    x.exponent += 2 + exponent; /* both are halves */
    x.exponent -= 2 * p->half;  /* over pixels as large as four */
    if (t->hollow)
        x = real_over(x, real_of(t->hollow + 1, 0));
    x = real_times(x, real_of(b->cosine_q30, -30));
    x = real_times(x, real_times(w->weight, b->power));
    return real_times(x, colour);
}

/* The most that any cell can shine over what can be seen: flux of a cell of the
 * survey over the least area of one on the sensor, twice as much for what lies
 * between. Of cells that are folded the area says little. */
static int64_t peak_q20(const struct glint_plan *p,
                        const struct glint_plan_survey *s,
                        const struct glint_transfer *t, struct glint_real flux)
{
    const int64_t most = INT64_C(1) << 40;
    struct glint_real area;

    if (p->frame->faintest.mantissa == 0 || (s->n_up && s->n_down) ||
        s->least_area < 2 || s->least_area == UINT64_MAX)
        return most;
    area = real_times(real_of((int64_t)(s->least_area >> 1),
                              2 * t->exponent[GLINT_OUT_SENSOR_X] + 2),
                      real_times(pixels_per_mm(p), pixels_per_mm(p)));
    flux.exponent += 1;
    area = real_times(area, real_of(s->across * 2 * s->down, 0)); /* the box */
    return real_integer(real_over(real_over(flux, area), p->frame->faintest),
                        20, most);
}

void glint_plan_transfer(const struct glint_plan *plan,
                         const struct glint_bundle_plan *planned,
                         struct glint_transfer *transfer)
{
    const struct glint_flare_frame *r = plan->frame;

    glint_transfer_init(transfer, r->lens, planned->ghost,
                        plan->light[planned->light].sine_q30,
                        r->wave[planned->wave].wave_q24);
    transfer->sets = plan->sets;
    transfer->energy_up = planned->energy_up;
}

struct glint_place glint_plan_place(const struct glint_plan *plan, int light)
{
    return (struct glint_place){.cos_q30 = plan->light[light].cos_q30,
                                .sin_q30 = plan->light[light].sin_q30,
                                .pixels_per_mm = pixels_per_mm(plan),
                                .middle_x_q8 = plan->width * 128 >> plan->half,
                                .middle_y_q8 =
                                    plan->height * 128 >> plan->half};
}

/* How far energies can be lifted, with a quarter more than the survey saw. */
static int energy_up(int64_t energy)
{
    const int up = 29 - bit_length((uint64_t)(energy + energy / 4));

    return up > 0 ? up : 0;
}

static void set_flux(struct glint_bundle *b, const struct glint_transfer *t,
                     struct glint_real flux)
{
    const int rows = b->n_cells - (t->hollow ? 2 : 0);
    const struct glint_real cell =
        real_over(flux, real_of((int64_t)b->n_cells * rows, 0));

    /* far below what can be seen, or far above what is held anyway */
    b->flux_q31 = cell.exponent < -400 ? 0 : cell.mantissa;
    b->flux_exponent = cell.exponent > 400 ? 431 : cell.exponent + 31;
}

int glint_plan_is_beyond(const struct glint_lens *lens,
                         const struct glint_light *light)
{
    return light->sine_q30 > lens->header->sine_hi_q30;
}

/* Whether ghost or part GHOST is of the pair asked for. */
static int is_wanted(const struct glint_flare_frame *r, int ghost)
{
    const struct glint_model_ghost *g = &r->lens->ghost[ghost];
    const struct glint_model_ghost *only =
        &r->lens->ghost[r->only_ghost < 0 ? ghost : r->only_ghost];

    return g->i == only->i && g->j == only->j;
}

enum glint_fate glint_plan_bundle(const struct glint_plan *plan,
                                  struct glint_bundle_plan *planned,
                                  struct glint_bundle *bundle,
                                  struct glint_plan_scratch *scratch)
{
    const struct glint_flare_frame *r = plan->frame;
    const struct glint_light *b = &plan->light[planned->light];
    struct glint_transfer *transfer = &scratch->transfer;
    struct glint_plan_survey *s = &scratch->survey;
    struct glint_real colour;
    int64_t wide_q8, high_q8;
    int exponent;

    bundle->n_cells = s->n_rays = 0;
    if (!is_wanted(r, planned->ghost))
        return GLINT_FATE_OTHER;
    if (glint_plan_is_beyond(r->lens, b))
        return GLINT_FATE_BEYOND;
    if (!glint_transfer_init(transfer, r->lens, planned->ghost, b->sine_q30,
                             r->wave[planned->wave].wave_q24))
        return GLINT_FATE_CLOSED;
    transfer->sets = plan->sets;
    colour = colour_of(&r->wave[planned->wave], b, bundle->rgb_q14);
    if (colour.mantissa == 0 || b->power.mantissa == 0)
        return GLINT_FATE_DARK;
    run_survey(s, transfer, FEW_ACROSS, FEW_DOWN);
    if (s->n_inside < FEW_INSIDE)
        run_survey(s, transfer, GLINT_PLAN_ACROSS, GLINT_PLAN_DOWN);
    if (s->n_inside == 0)
        return GLINT_FATE_BLOCKED;
    if (!is_in_view(plan, b, transfer, &s->reach))
        return GLINT_FATE_OUTSIDE;
    wide_q8 = pixels_q8(plan, transfer,
                        q_divide((s->seen.high - s->seen.low) * 3, 5)) +
              256;
    high_q8 =
        pixels_q8(plan, transfer, s->seen.wide + q_divide(s->seen.wide, 10)) +
        256;
    planned->energy_up = (uint8_t)energy_up(s->energy);
    exponent = transfer->exponent[GLINT_OUT_ENERGY] + 29 - planned->energy_up;
    planned->flux = flux_of(plan, planned, transfer, colour, exponent);
    planned->peak_q20 = peak_q20(plan, s, transfer, planned->flux);
    if (plan->n_lights == 1 && !r->sets && planned->peak_q20 < 1 << 20)
        return GLINT_FATE_FAINT;
    planned->irradiance = real_over(
        planned->flux, real_times(real_of(wide_q8, -7), real_of(high_q8, -7)));
    bundle->n_cells = cells_of(plan, s, transfer, planned->irradiance);
    if (transfer->hollow) /* two rows of cells are the middle's */
        bundle->n_cells = hollow_cells(bundle->n_cells);
    set_sags(planned, s, transfer, bundle->n_cells, plan->round);
    set_flux(bundle, transfer, planned->flux);
    return GLINT_FATE_DRAWN;
}
