/* SPDX-License-Identifier: MIT */
#include "flare/score.h"

#include "base/q.h"
#include "base/sort.h"

enum {
    FLOOR_Q20 = 1 << 12, /* added to light: noise of the dark is no contrast */
    MOST_Q8 = 6 * 256,   /* of a contrast */
    MOST_CROWD = 127
};

/* Adds WEIGHT of MEASURE, held to LEAST .. MOST, over LEAST. */
struct term {
    int8_t measure;
    int16_t least_q8, most_q8, weight_q8;
};

enum { BIAS_Q8 = -2000 };

/* Scores beyond are all the same: a lamp without doubt. */
#define SURE_Q8 384

static const struct term terms[] = {{EVIDENCE_AROUND, 0, 4 * 256, 192},
                                    {EVIDENCE_FAR, 0, 5 * 256, 128},
                                    {EVIDENCE_HALO, -256, 3 * 256, 128},
                                    {EVIDENCE_FILL, 0, 256, 512},
                                    {EVIDENCE_SIZE, -18 * 256, -10 * 256, 85},
                                    {EVIDENCE_SIZE, -6 * 256, 0, -128},
                                    {EVIDENCE_REST, -9 * 256, 0, -128},
                                    {EVIDENCE_CLIPPED, 0, 256, 256},
                                    {EVIDENCE_CROWD, 512, 6 * 256, -128},
                                    {EVIDENCE_SCENE, -5 * 256, 0, -85}};

/* ----------------------------------------------------------------- contrast */

static int64_t largest(const int64_t v[3])
{
    const int64_t most = v[0] > v[1] ? v[0] : v[1];

    return most > v[2] ? most : v[2];
}

/* Stops of the largest channel and of luminance. */
static void stops_of(const int64_t rgb_q20[3], int32_t stops_q8[2])
{
    const int64_t y_q20 =
        (rgb_q20[0] * 54 + rgb_q20[1] * 183 + rgb_q20[2] * 19) >> 8;

    stops_q8[0] = glint_stops_q8(largest(rgb_q20) + FLOOR_Q20);
    stops_q8[1] = glint_stops_q8(y_q20 + FLOOR_Q20);
}

/* Of what is IN over pixel X of the row: by the largest channel or luminance,
 * whichever shows more. */
static int32_t contrast_at(const struct glint_score *s, const int32_t in_q8[2],
                           int x)
{
    int32_t rgb_q20[3], out_q8[2];
    int64_t wide_q20[3];

    glint_bright_read(s->bright, x, rgb_q20);
    for (int i = 0; i < 3; i++)
        wide_q20[i] = rgb_q20[i];
    stops_of(wide_q20, out_q8);
    for (int i = 0; i < 2; i++)
        out_q8[i] = in_q8[i] - out_q8[i];
    return q_clamp_sat(out_q8[0] > out_q8[1] ? out_q8[0] : out_q8[1], -256,
                       MOST_Q8);
}

/* Point I of the outline of SUM's box that is D pixels larger on each side. */
static void point_of(const struct glint_region *sum, int32_t d, int i,
                     int32_t *x, int32_t *y)
{
    const int32_t x0 = sum->x0 - d, x1 = sum->x1 - 1 + d;
    const int32_t y0 = sum->y0 - d, y1 = sum->y1 - 1 + d;
    const int side = i >> 2, k = 2 * (i & 3) + 1;

    *x = side == 0   ? x0
         : side == 1 ? x1
                     : x0 + (int32_t)((int64_t)(x1 - x0) * k / 8);
    *y = side == 2   ? y0
         : side == 3 ? y1
                     : y0 + (int32_t)((int64_t)(y1 - y0) * k / 8);
}

/* Contrasts at the points that are in the picture; returns how many. */
static int look_around(const struct glint_score *s,
                       const struct glint_region *sum, int32_t d,
                       const int32_t in_q8[2], int32_t found_q8[SCORE_POINTS])
{
    int n = 0;

    for (int i = 0; i < SCORE_POINTS; i++) {
        int32_t x, y;

        point_of(sum, d, i, &x, &y);
        if (x < 0 || y < 0 || x >= s->width || y >= s->height)
            continue;
        glint_bright_go(s->bright, y);
        found_q8[n++] = contrast_at(s, in_q8, x);
    }
    return n;
}

static int32_t mean_of(const int32_t *v, int n)
{
    int32_t sum = 0;

    for (int i = 0; i < n; i++)
        sum += v[i];
    return n ? sum / n : 0;
}

static int32_t quartile_of(int32_t *v, int n)
{
    for (int i = 1; i < n; i++)
        for (int j = i; j > 0 && v[j] < v[j - 1]; j--) {
            const int32_t old = v[j];

            v[j] = v[j - 1];
            v[j - 1] = old;
        }
    return n ? v[n / 4] : 0;
}

/* Distance of ring I from the box of SUM: in 1/800 of the picture's side, and
 * in half of the box's. */
static int32_t distance_of(const struct glint_score *s,
                           const struct glint_region *sum, int i)
{
    static const int16_t in_q8[SCORE_RINGS][2] = {
        {320, 64}, {768, 192}, {2048, 512}};
    const int64_t side = q_root((uint64_t)((int64_t)s->width * s->height));
    const int64_t box =
        q_root((uint64_t)((int64_t)(sum->x1 - sum->x0) * (sum->y1 - sum->y0)));

    return (int32_t)(1 +
                     (in_q8[i][0] * side / 800 + in_q8[i][1] * box / 2) / 256);
}

static void look_at_rings(struct glint_candidate *c,
                          const struct glint_score *s)
{
    int32_t around_q8[SCORE_RINGS], in_q8[2], quartile_q8 = 0;
    int64_t mean_q20[3];

    for (int i = 0; i < 3; i++)
        mean_q20[i] = c->sum.rgb_q14[i] * 64 / c->sum.area;
    stops_of(mean_q20, in_q8);
    for (int i = 0; i < SCORE_RINGS; i++) {
        int32_t found_q8[SCORE_POINTS];
        const int n = look_around(s, &c->sum, distance_of(s, &c->sum, i), in_q8,
                                  found_q8);

        around_q8[i] = n || i == 0 ? mean_of(found_q8, n) : around_q8[i - 1];
        if (i == 1)
            quartile_q8 = quartile_of(found_q8, n);
    }
    c->evidence_q8[EVIDENCE_NEAR] = around_q8[0];
    c->evidence_q8[EVIDENCE_AROUND] = quartile_q8;
    c->evidence_q8[EVIDENCE_FAR] = around_q8[2];
    c->evidence_q8[EVIDENCE_HALO] = around_q8[2] - around_q8[0];
}

/* -------------------------------------------------------------------- shape */

/* Over 2 pi r^2; a pixel by itself has 1 / 6 of a squared pixel. */
static int32_t fill_q8(const struct glint_region *sum)
{
    const int64_t r_q8 = glint_region_radius_q8(sum);
    const int64_t disc_q16 = q_shift(
        (r_q8 * r_q8 + Q_CONST(1.0 / 6, 16)) * Q_CONST(6.2831853, 8), 8);

    return q_clamp_sat(((int64_t)sum->area << 24) / disc_q16, 0, 512);
}

static int32_t colour_q8(const struct glint_region *sum)
{
    int64_t rim[3], least;

    for (int i = 0; i < 3; i++)
        rim[i] = 63 * sum->rim_rgb_q14[i] + sum->rgb_q14[i];
    least = rim[0] < rim[1] ? rim[0] : rim[1];
    least = least < rim[2] ? least : rim[2];
    return 256 - (int32_t)(least / (largest(rim) / 256 + 1));
}

static void look_at_shape(struct glint_candidate *c,
                          const struct glint_score *s)
{
    const int64_t pixels = (int64_t)s->width * s->height;
    const int64_t share_q20 = ((int64_t)c->sum.area << 20) / pixels;
    const int64_t rest_q20 =
        (int64_t)glint_white_share_q15(s->white, s->level[c->level].low) * 32 -
        share_q20;
    int32_t *e_q8 = c->evidence_q8;

    e_q8[EVIDENCE_FILL] = fill_q8(&c->sum);
    e_q8[EVIDENCE_SIZE] = glint_stops_q8(share_q20);
    e_q8[EVIDENCE_REST] = glint_stops_q8((rest_q20 > 0 ? rest_q20 : 0) + 256);
    e_q8[EVIDENCE_CLIPPED] =
        s->level[c->level].low >= BRIGHT_CLIPPED
            ? 128
            : (int32_t)(((int64_t)c->sum.n_clipped << 8) / c->sum.area);
    e_q8[EVIDENCE_COLOUR] = colour_q8(&c->sum);
    e_q8[EVIDENCE_SCENE] = glint_stops_q8(
        s->bright->curve->decode_q20[glint_white_reached_by(s->white, 1)] +
        FLOOR_Q20);
}

/* -------------------------------------------------------------------- crowd */

static int by_place(const void *ctx, int32_t a, int32_t b)
{
    const struct glint_candidate *p = (const struct glint_candidate *)ctx + a;
    const struct glint_candidate *q = (const struct glint_candidate *)ctx + b;

    if (p->level != q->level)
        return p->level < q->level;
    if (p->sum.y0 != q->sum.y0)
        return p->sum.y0 < q->sum.y0;
    return p->sum.first < q->sum.first;
}

/* Whether B, which is DY rows away, is as large as A, within a factor of 4,
 * and within 12 of its sides. */
static int is_alike(const struct glint_candidate *a,
                    const struct glint_candidate *b, int64_t reach2)
{
    const int64_t dx = (a->sum.x0 + a->sum.x1 - b->sum.x0 - b->sum.x1) / 2;
    const int64_t dy = (a->sum.y0 + a->sum.y1 - b->sum.y0 - b->sum.y1) / 2;

    return b->sum.area < 4 * (int64_t)a->sum.area &&
           a->sum.area < 4 * (int64_t)b->sum.area && dx * dx + dy * dy < reach2;
}

/* Regions like that of order[AT], going by STEP, at most MOST. */
static int count_alike(const struct glint_candidate *candidate,
                       const int32_t *order, int n, int at, int step, int most)
{
    const struct glint_candidate *c = &candidate[order[at]];
    const int64_t reach2 = 144 * (int64_t)c->sum.area + 256;
    int found = 0;

    for (int i = at + step; i >= 0 && i < n && found < most; i += step) {
        const struct glint_candidate *other = &candidate[order[i]];
        const int64_t dy = other->sum.y0 - c->sum.y0;

        if (other->level != c->level || dy * dy > reach2)
            break;
        found += is_alike(c, other, reach2);
    }
    return found;
}

static int32_t crowd_q8(const struct glint_candidate *candidate,
                        const int32_t *order, int n, int at)
{
    const int before = count_alike(candidate, order, n, at, -1, MOST_CROWD);
    const int all =
        before + count_alike(candidate, order, n, at, 1, MOST_CROWD - before);

    return glint_stops_q8((int64_t)(all + 1) << 20);
}

/* -------------------------------------------------------------------- score */

static int32_t score_of(const int32_t evidence_q8[EVIDENCES])
{
    int32_t sum_q16 = BIAS_Q8 * 256;

    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        const struct term *t = &terms[i];
        const int32_t v_q8 =
            q_clamp_sat(evidence_q8[t->measure], t->least_q8, t->most_q8);

        sum_q16 += (v_q8 - t->least_q8) * t->weight_q8;
    }
    return sum_q16 >> 8;
}

void glint_score_all(const struct glint_score *score,
                     struct glint_candidate *candidate, int32_t *order, int n)
{
    glint_sort(order, n, by_place, candidate);
    for (int i = 0; i < n; i++) {
        struct glint_candidate *c = &candidate[order[i]];

        look_at_rings(c, score);
        look_at_shape(c, score);
        c->evidence_q8[EVIDENCE_CROWD] = crowd_q8(candidate, order, n, i);
        c->score_q8 = score_of(c->evidence_q8);
    }
}

/* ----------------------------------------------------------- one of its kind
 */

static int by_rank(const void *ctx, int32_t a, int32_t b)
{
    const struct glint_candidate *p = (const struct glint_candidate *)ctx + a;
    const struct glint_candidate *q = (const struct glint_candidate *)ctx + b;

    if (p->rank_q8 != q->rank_q8)
        return p->rank_q8 > q->rank_q8;
    if (p->level != q->level)
        return p->level < q->level;
    return p->sum.first < q->sum.first;
}

/* Whether INNER, of a higher level, lies in the box of OUTER. */
static int is_within(const struct glint_candidate *inner,
                     const struct glint_candidate *outer)
{
    const struct glint_region *in = &inner->sum, *out = &outer->sum;

    return inner->level > outer->level && in->x0 >= out->x0 &&
           in->x1 <= out->x1 && in->y0 >= out->y0 && in->y1 <= out->y1;
}

void glint_score_choose(const struct glint_score *score,
                        struct glint_candidate *candidate, int32_t *order,
                        int n)
{
    for (int i = 0; i < n; i++) {
        struct glint_candidate *c = &candidate[order[i]];

        c->rank_q8 = (c->score_q8 < SURE_Q8 ? c->score_q8 : SURE_Q8) -
                     score->level[c->level].cost_q8;
    }
    glint_sort(order, n, by_rank, candidate);
    for (int i = 0; i < n; i++) {
        const struct glint_candidate *c = &candidate[order[i]];

        for (int j = i + 1; j < n && !c->gone; j++) {
            struct glint_candidate *other = &candidate[order[j]];

            other->gone |=
                (uint8_t)(is_within(other, c) || is_within(c, other));
        }
    }
}
