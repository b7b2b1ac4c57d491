/* SPDX-License-Identifier: MIT */
#include "lamps/score.h"

#include "base/q.h"
#include "base/sort.h"

enum {
    FLOOR_Q20 = 1 << 12, /* light that is added to linear light before log2, so
                            that noise in the dark does not count as contrast */
    LEAST_Q8 = -256,     /* contrasts are clamped to -1 .. 6 stops */
    MOST_Q8 = 6 * 256,
    SMALL_Q8 = -2424, /* log2 of (area of a small region / area of the picture),
                         1/709; up to this size the weight of colour is 1 */
    LARGE_Q8 = -1400, /* log2 of (area of a large region / area of the picture),
                         1/44; from this size on the weight of colour is 0 */
    HALO_MOST_Q8 = 512,
    WIDE_Q8 = 1400,  /* range of log2 of the area in which a region changes
                        gradually from small to large: from 1/1960 to 1/44 of
                        the picture */
    DRAWN_AREA = 36, /* min area, pixels, of a region with EVIDENCE_DRAWN;
                        smaller squares may be round lamps */
    DRAWN_BOX_Q8 = 250,
    SCORE_PARTS = EVIDENCE_DARK_32 - EVIDENCE_DARK_2 + 1
};

/* A term of the score: WEIGHT times (value of the measure MEASURE, clamped to
 * LEAST .. MOST, minus LEAST). */
struct term {
    int8_t measure;
    int16_t least_q8, most_q8, weight_q8;
};

/* Weights from a logistic regression. Each has the sign that is plausible for
 * its measure. tests/corpus/fit prints them. A score that is higher by 64
 * multiplies the odds of a lamp by e. The last weight is set by hand: no lamp
 * of the corpus fills its bounding box, but a bright rectangle in the dark is a
 * lamp nevertheless. */
enum { BIAS_Q8 = -1438 };

static const struct term terms[] = {
    {EVIDENCE_AROUND, 0, 448, 59},     {EVIDENCE_AROUND, 448, 1200, 34},
    {EVIDENCE_HALO, -256, 512, 24},    {EVIDENCE_SPREAD, 0, 512, -47},
    {EVIDENCE_FILL, 64, 160, 288},     {EVIDENCE_FILL, 160, 224, 422},
    {EVIDENCE_BOX, 96, 200, 145},      {EVIDENCE_SIZE, -4400, -3400, 119},
    {EVIDENCE_SIZE, -3400, -2000, 18}, {EVIDENCE_COLOUR, 0, 256, 217},
    {EVIDENCE_DIM, 0, 1280, -24},      {EVIDENCE_CLOSE, 0, 300, 132},
    {EVIDENCE_WHITE, -512, 0, 71},     {EVIDENCE_CROWD, 0, 2620, -21},
    {EVIDENCE_HIGH, 0, 160, 121},      {EVIDENCE_WIDE_HALO, 0, 512, 128},
    {EVIDENCE_WIDE_HOT, 0, 256, 145},  {EVIDENCE_DARK_2, 0, 700, 19},
    {EVIDENCE_DARK_4, 0, 500, 132},    {EVIDENCE_DARK_32, 400, 1600, 75},
    {EVIDENCE_DRAWN, 0, 256, -512}};

/* ----------------------------------------------------------------- contrast */

static int64_t max_of_3(const int64_t v[3])
{
    const int64_t most = v[0] > v[1] ? v[0] : v[1];

    return most > v[2] ? most : v[2];
}

/* Sets STOPS[0] to log2 of the max channel of RGB, and STOPS[1] to log2 of its
 * luminance, 1/256 stops. */
static void compute_log2_of_light(const int64_t rgb_q20[3], int32_t stops_q8[2])
{
    const int64_t y_q20 =
        (rgb_q20[0] * 54 + rgb_q20[1] * 183 + rgb_q20[2] * 19) >> 8;

    stops_q8[0] = glint_compute_light_log2_q8(max_of_3(rgb_q20) + FLOOR_Q20);
    stops_q8[1] = glint_compute_light_log2_q8(y_q20 + FLOOR_Q20);
}

/* Returns the contrast between a region, whose log2 of light is IN, and pixel X
 * of the current row, 1/256 stops: the larger of the differences in the largest
 * channel and in luminance. */
static int32_t compute_contrast_to_pixel(const struct glint_score *s,
                                         const int32_t in_q8[2], int x)
{
    int32_t rgb_q20[3], out_q8[2];
    int64_t wide_q20[3];

    glint_bright_read_pixel_light(s->bright, x, rgb_q20);
    for (int i = 0; i < 3; i++)
        wide_q20[i] = rgb_q20[i];
    compute_log2_of_light(wide_q20, out_q8);
    for (int i = 0; i < 2; i++)
        out_q8[i] = in_q8[i] - out_q8[i];
    return q_clamp_sat(out_q8[0] > out_q8[1] ? out_q8[0] : out_q8[1], LEAST_Q8,
                       MOST_Q8);
}

/* Sets (X, Y) to point I of an ellipse. The ellipse is inscribed in SUM's
 * bounding box after the box has been enlarged by D on all sides. */
static void compute_ellipse_point(const struct glint_region *sum, int32_t d,
                                  int i, int32_t *x, int32_t *y)
{
    static const int16_t sine_q14[SCORE_POINTS + SCORE_POINTS / 4] = {
        0,      6270,  11585, 15137,  16384,  15137,  11585,
        6270,   0,     -6270, -11585, -15137, -16384, -15137,
        -11585, -6270, 0,     6270,   11585,  15137};
    const int64_t w = sum->x1 - sum->x0 - 1 + 2 * (int64_t)d;
    const int64_t h = sum->y1 - sum->y0 - 1 + 2 * (int64_t)d;

    *x = q_narrow(sum->x0 - d +
                  q_shift(w * (16384 + sine_q14[i + SCORE_POINTS / 4]), 15));
    *y = q_narrow(sum->y0 - d + q_shift(h * (16384 + sine_q14[i]), 15));
}

/* Sets FOUND to the contrasts between a region and the points of an ellipse at
 * distance D from SUM's box. Only points within the picture count. Returns the
 * number of contrasts. */
static int list_ellipse_contrasts(const struct glint_score *s,
                                  const struct glint_region *sum, int32_t d,
                                  const int32_t in_q8[2],
                                  int32_t found_q8[SCORE_POINTS])
{
    int n = 0;

    for (int i = 0; i < SCORE_POINTS; i++) {
        int32_t x, y;

        compute_ellipse_point(sum, d, i, &x, &y);
        if (x < 0 || y < 0 || x >= s->width || y >= s->height)
            continue;
        glint_bright_select_row(s->bright, y);
        found_q8[n++] = compute_contrast_to_pixel(s, in_q8, x);
    }
    return n;
}

static int32_t compute_mean_contrast(const int32_t *v, int n)
{
    int32_t sum = 0;

    for (int i = 0; i < n; i++)
        sum += v[i];
    return n ? sum / n : 0;
}

static void sort_contrasts(int32_t *v, int n)
{
    for (int i = 1; i < n; i++)
        for (int j = i; j > 0 && v[j] < v[j - 1]; j--) {
            const int32_t old = v[j];

            v[j] = v[j - 1];
            v[j - 1] = old;
        }
}

/* Returns the distance between ring I and SUM's bounding box, pixels. It is a
 * fraction of the picture's side plus a fraction of the box's side. */
static int32_t compute_ring_distance(const struct glint_score *s,
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

/* The contrast of a region with the points of one ring around it. */
struct ring {
    int32_t mean_q8, lower_q8, upper_q8; /* mean and quartiles over the points,
                                            1/256 stops */
};

/* Sets RING to the contrasts at distance D pixels. Does not change RING if no
 * point of the ring is in the picture. */
static void measure_ring_contrast(struct ring *ring,
                                  const struct glint_score *s,
                                  const struct glint_region *sum, int32_t d,
                                  const int32_t in_q8[2])
{
    int32_t found_q8[SCORE_POINTS];
    const int n = list_ellipse_contrasts(s, sum, d, in_q8, found_q8);

    if (n == 0)
        return;
    sort_contrasts(found_q8, n);
    ring->mean_q8 = compute_mean_contrast(found_q8, n);
    ring->lower_q8 = found_q8[n / 4];
    ring->upper_q8 = found_q8[n - 1 - n / 4];
}

static void compute_mean_log2_of_light(const struct glint_region *sum,
                                       int32_t stops_q8[2])
{
    int64_t mean_q20[3];

    for (int i = 0; i < 3; i++)
        mean_q20[i] = sum->rgb_q14[i] * 64 / sum->area;
    compute_log2_of_light(mean_q20, stops_q8);
}

/* Returns VALUE times the degree to which C is a large region, 0 .. 1. */
static int32_t scale_by_largeness_q8(const struct glint_candidate *c,
                                     int32_t value_q8)
{
    const int64_t size_q8 = (int64_t)c->evidence_q8[EVIDENCE_SIZE];

    return value_q8 * q_clamp_sat(size_q8 + 2 * WIDE_Q8, 0, WIDE_Q8) / WIDE_Q8;
}

/* -------------------------------------------------------------------- shape */

/* Returns area / (2 pi r^2) of region SUM, at most 2, where r is the RMS
 * radius. It is 1 for a disc. 1/6 is added to r^2, which is r^2 of a single
 * pixel. */
static int32_t compute_disc_fill_q8(const struct glint_region *sum)
{
    const int64_t r_q8 = glint_region_compute_rms_radius_q8(sum);
    const int64_t disc_q16 = q_shift(
        (r_q8 * r_q8 + Q_CONST(1.0 / 6, 16)) * Q_CONST(6.2831853, 8), 8);

    return q_clamp_sat(((int64_t)sum->area << 24) / disc_q16, 0, 512);
}

/* Returns EVIDENCE_DRAWN, the degree to which region SUM is a full rectangle.
 * BOX is the fraction of its bounding box that it fills. */
static int32_t compute_box_filling_degree_q8(const struct glint_region *sum,
                                             int32_t box_q8)
{
    return sum->area < DRAWN_AREA
               ? 0
               : q_clamp_sat((int64_t)(box_q8 - DRAWN_BOX_Q8) * 64, 0, 256);
}

static int32_t compute_saturation_q8(const struct glint_region *sum)
{
    int64_t rim[3], least;

    for (int i = 0; i < 3; i++)
        rim[i] = 63 * sum->rim_rgb_q14[i] + sum->rgb_q14[i];
    least = rim[0] < rim[1] ? rim[0] : rim[1];
    least = least < rim[2] ? least : rim[2];
    return 256 - (int32_t)(least / (max_of_3(rim) / 256 + 1));
}

/* Returns PIXELS divided by the number of pixels of the picture. */
static int64_t compute_picture_fraction_q20(const struct glint_score *s,
                                            int64_t pixels)
{
    return (pixels << 20) / ((int64_t)s->width * s->height);
}

/* Returns EVIDENCE_DIM: 5 stops minus log2 of (white of LEVEL / median of the
 * picture), clamped to 0 .. 5 stops. Returns 0 if the white of LEVEL is where
 * codes clip. An underexposed night picture has lamps that do not clip. A
 * picture that is grey overall has grey objects instead of lamps. */
static int32_t compute_dim_white_evidence_q8(const struct glint_score *s,
                                             const struct glint_level *level)
{
    const int32_t *light_q20 = s->bright->curve->decode_q20;
    int half;

    if (level->clipped >= BRIGHT_CLIPPED)
        return 0;
    half = glint_white_find_top_quantile(s->white, 1);
    return q_clamp_sat(
        glint_compute_light_log2_q8(light_q20[half] + FLOOR_Q20) -
            glint_compute_light_log2_q8(light_q20[level->clipped]) + 5 * 256,
        0, 5 * 256);
}

/* Finds the brightness that 1 / 2^PART_LOG2 of the picture's pixels reach.
 * Returns log2 of (white / this brightness), 1/256 stops. */
static int32_t compute_below_white_q8(const struct glint_score *s,
                                      int part_log2)
{
    const int32_t *light_q20 = s->bright->curve->decode_q20;
    const int code = glint_white_find_top_quantile(s->white, part_log2);

    return -glint_compute_light_log2_q8(
        light_q20[code < BRIGHT_CLIPPED ? code : BRIGHT_CLIPPED] + FLOOR_Q20);
}

/* The values of EVIDENCE_DARK_2, EVIDENCE_DARK_4 and EVIDENCE_DARK_32, which
 * are equal for all regions of a picture. */
struct dark {
    int32_t part_q8[SCORE_PARTS];
};

static void measure_picture_darkness(struct dark *dark,
                                     const struct glint_score *s)
{
    static const int8_t part_log2[SCORE_PARTS] = {1, 2, 5};

    for (int i = 0; i < SCORE_PARTS; i++)
        dark->part_q8[i] = compute_below_white_q8(s, part_log2[i]);
}

static void measure_region_without_rings(struct glint_candidate *c,
                                         const struct glint_score *s)
{
    const struct glint_region *sum = &c->sum;
    const int64_t box = (int64_t)(sum->x1 - sum->x0) * (sum->y1 - sum->y0);
    const int32_t size_q8 =
        glint_compute_light_log2_q8(compute_picture_fraction_q20(s, sum->area));
    const int32_t large_q8 =
        q_clamp_sat((int64_t)size_q8 - SMALL_Q8, 0, LARGE_Q8 - SMALL_Q8);
    const int32_t tint_q8 =
        compute_saturation_q8(sum) * large_q8 / (LARGE_Q8 - SMALL_Q8);
    int32_t *e_q8 = c->evidence_q8;
    int32_t in_q8[2], x_q8, y_q8;

    compute_mean_log2_of_light(sum, in_q8);
    e_q8[EVIDENCE_WHITE] =
        in_q8[1] -
        glint_compute_light_log2_q8(
            s->bright->curve->decode_q20[s->level[c->level].clipped]);
    e_q8[EVIDENCE_DIM] = compute_dim_white_evidence_q8(s, &s->level[c->level]);
    e_q8[EVIDENCE_FILL] = compute_disc_fill_q8(sum);
    e_q8[EVIDENCE_BOX] = (int32_t)(((int64_t)sum->area << 8) / box);
    e_q8[EVIDENCE_DRAWN] =
        compute_box_filling_degree_q8(sum, e_q8[EVIDENCE_BOX]);
    e_q8[EVIDENCE_SIZE] = size_q8;
    e_q8[EVIDENCE_COLOUR] = compute_saturation_q8(sum) - tint_q8;
    e_q8[EVIDENCE_WIDE_HOT] =
        scale_by_largeness_q8(c, e_q8[EVIDENCE_WHITE] >= -2 ? 256 : 0);
    glint_region_compute_centroid(sum, &x_q8, &y_q8);
    e_q8[EVIDENCE_HIGH] = 256 - y_q8 / s->height;
}

/* -------------------------------------------------------------------- score */

static int32_t compute_score_from_evidence(const int32_t evidence_q8[EVIDENCES])
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

/* Returns the doubt (reason why a region may not be a lamp) that a low value of
 * MEASURE causes. Measures that are high only for some lamps cause no doubt. */
static enum glint_doubt get_doubt_of_evidence(int measure)
{
    switch (measure) {
    case EVIDENCE_AROUND:
    case EVIDENCE_CLOSE:
        return GLINT_DOUBT_AROUND;
    case EVIDENCE_HALO:
    case EVIDENCE_SPREAD:
        return GLINT_DOUBT_GLOW;
    case EVIDENCE_FILL:
    case EVIDENCE_BOX:
        return GLINT_DOUBT_SHAPE;
    case EVIDENCE_SIZE:
        return GLINT_DOUBT_SIZE;
    case EVIDENCE_WHITE:
        return GLINT_DOUBT_GREY;
    case EVIDENCE_CROWD:
        return GLINT_DOUBT_CROWD;
    case EVIDENCE_HIGH:
        return GLINT_DOUBT_LOW;
    case EVIDENCE_DRAWN:
        return GLINT_DOUBT_DRAWN;
    case EVIDENCE_COLOUR:
    case EVIDENCE_WIDE_HALO:
    case EVIDENCE_WIDE_HOT:
        return GLINT_DOUBT_NONE;
    default:
        return GLINT_DOUBT_DAY;
    }
}

enum glint_doubt glint_score_choose_doubt(const struct glint_candidate *c)
{
    int32_t loss_q16[EVIDENCES] = {0};
    int worst = EVIDENCE_AROUND;

    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        const struct term *t = &terms[i];
        const int32_t v_q8 =
            q_clamp_sat(c->evidence_q8[t->measure], t->least_q8, t->most_q8);

        loss_q16[t->measure] +=
            ((t->least_q8 + t->most_q8) / 2 - v_q8) * t->weight_q8;
    }
    for (int i = worst; i < EVIDENCES; i++)
        if (get_doubt_of_evidence(i) != GLINT_DOUBT_NONE &&
            loss_q16[i] > loss_q16[worst])
            worst = i;
    return get_doubt_of_evidence(worst);
}

/* Returns the number of the last ring on which MEASURE depends, or SCORE_RINGS
 * if it depends on none. */
static int find_last_ring_of_evidence(int measure)
{
    switch (measure) {
    case EVIDENCE_CLOSE:
    case EVIDENCE_SPREAD:
        return 0;
    case EVIDENCE_AROUND:
        return 1;
    case EVIDENCE_HALO:
        return 2;
    default:
        return SCORE_RINGS;
    }
}

/* Returns the max that the measures of ring FIRST and of later rings can add to
 * a score. */
static int32_t compute_max_score_from_rings(int first)
{
    int32_t sum_q16 = 0;

    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++) {
        const struct term *t = &terms[i];
        const int ring = find_last_ring_of_evidence(t->measure);

        if (ring >= first && ring < SCORE_RINGS && t->weight_q8 > 0)
            sum_q16 += (t->most_q8 - t->least_q8) * t->weight_q8;
    }
    return (sum_q16 >> 8) + 1;
}

/* Prepares C for an upper bound of its score before rings are read. Measures of
 * rings are set so low that they add nothing, as the caller adds their max by
 * compute_max_score_from_rings(). That function omits EVIDENCE_WIDE_HALO, so
 * this measure is set to its max. */
static void assume_best_ring_evidence(struct glint_candidate *c)
{
    for (int i = 0; i < EVIDENCES; i++)
        if (find_last_ring_of_evidence(i) < SCORE_RINGS)
            c->evidence_q8[i] = INT16_MIN; /* below all terms: adds 0 */
    c->evidence_q8[EVIDENCE_WIDE_HALO] = scale_by_largeness_q8(c, HALO_MOST_Q8);
}

/* Sets the measures of C that are known as soon as ring I has been measured. */
static void set_evidence_of_ring(struct glint_candidate *c,
                                 const struct ring *ring, int i)
{
    int32_t *e_q8 = c->evidence_q8;
    const int64_t halo_q8 = (int64_t)ring[i].mean_q8 - ring[0].mean_q8;

    switch (i) {
    case 0:
        e_q8[EVIDENCE_CLOSE] = ring->lower_q8;
        e_q8[EVIDENCE_SPREAD] = ring->upper_q8 - ring->lower_q8;
        break;
    case 1:
        e_q8[EVIDENCE_AROUND] = ring[1].lower_q8;
        break;
    default:
        e_q8[EVIDENCE_HALO] = q_narrow(halo_q8);
        e_q8[EVIDENCE_WIDE_HALO] =
            scale_by_largeness_q8(c, q_clamp_sat(halo_q8, 0, HALO_MOST_Q8));
    }
}

/* Returns the score of C. If is_brief of S is set, reading of rings stops when
 * the score can no longer reach -SCORE_DOUBT. MOST[I]: the max that ring I and
 * later rings can add to the score. */
static int32_t score_candidate_ring_by_ring(struct glint_candidate *c,
                                            const struct glint_score *s,
                                            const int32_t most_q8[SCORE_RINGS])
{
    struct ring ring[SCORE_RINGS] = {{0, 0, 0}};
    int32_t in_q8[2];

    assume_best_ring_evidence(c);
    compute_mean_log2_of_light(&c->sum, in_q8);
    for (int i = 0; i < SCORE_RINGS; i++) {
        const int32_t hoped_q8 =
            compute_score_from_evidence(c->evidence_q8) + most_q8[i];

        if (s->is_brief && hoped_q8 < -SCORE_DOUBT)
            return hoped_q8;
        if (i > 0)
            ring[i] = ring[i - 1];
        measure_ring_contrast(&ring[i], s, &c->sum,
                              compute_ring_distance(s, &c->sum, i), in_q8);
        set_evidence_of_ring(c, ring, i);
    }
    return compute_score_from_evidence(c->evidence_q8);
}

static void set_crowd_evidence(struct glint_candidate *candidate,
                               const int32_t *order, int n)
{
    int32_t n_at[SCORE_LEVELS] = {0};

    for (int i = 0; i < n; i++)
        n_at[candidate[order[i]].level] += !candidate[order[i]].faint;
    for (int i = 0; i < n; i++) {
        struct glint_candidate *c = &candidate[order[i]];

        c->evidence_q8[EVIDENCE_CROWD] =
            glint_compute_light_log2_q8((int64_t)n_at[c->level] << 20);
    }
}

void glint_score_score_candidates(const struct glint_score *score,
                                  struct glint_candidate *candidate,
                                  const int32_t *order, int n)
{
    int32_t most_q8[SCORE_RINGS];
    struct dark dark;

    for (int i = 0; i < SCORE_RINGS; i++)
        most_q8[i] = compute_max_score_from_rings(i);
    set_crowd_evidence(candidate, order, n);
    measure_picture_darkness(&dark, score);
    for (int i = 0; i < n; i++) {
        struct glint_candidate *c = &candidate[order[i]];

        for (int part = 0; part < SCORE_PARTS; part++)
            c->evidence_q8[EVIDENCE_DARK_2 + part] = dark.part_q8[part];
        measure_region_without_rings(c, score);
        c->score_q8 = score_candidate_ring_by_ring(c, score, most_q8);
    }
}

/* ------------------------------------------------------------------- choice */

/* Limits of ranks. The nested region of the highest rank is the lamp. */
enum {
    SURE_Q8 = 384
}; /* max score that is used for ranks; higher scores are
      clamped to it */

static int is_rank_higher(const void *ctx, int32_t a, int32_t b)
{
    const struct glint_candidate *p = (const struct glint_candidate *)ctx + a;
    const struct glint_candidate *q = (const struct glint_candidate *)ctx + b;

    if (p->rank_q8 != q->rank_q8)
        return p->rank_q8 > q->rank_q8;
    if (p->level != q->level)
        return p->level < q->level;
    return p->sum.first < q->sum.first;
}

/* Returns whether INNER belongs to a brighter level than OUTER and its bounding
 * box lies within that of OUTER. */
static int is_region_within(const struct glint_candidate *inner,
                            const struct glint_candidate *outer)
{
    const struct glint_region *in = &inner->sum, *out = &outer->sum;

    return inner->level > outer->level && in->x0 >= out->x0 &&
           in->x1 <= out->x1 && in->y0 >= out->y0 && in->y1 <= out->y1;
}

void glint_score_choose_among_nested(const struct glint_score *score,
                                     struct glint_candidate *candidate,
                                     int32_t *order, int n)
{
    for (int i = 0; i < n; i++) {
        struct glint_candidate *c = &candidate[order[i]];

        c->rank_q8 = (c->score_q8 < SURE_Q8 ? c->score_q8 : SURE_Q8) -
                     score->level[c->level].cost_q8;
    }
    glint_sort(order, n, is_rank_higher, candidate);
    for (int i = 0; i < n; i++) {
        const struct glint_candidate *c = &candidate[order[i]];

        for (int j = i + 1; j < n && !c->gone; j++) {
            struct glint_candidate *other = &candidate[order[j]];

            other->gone |= (uint8_t)(is_region_within(other, c) ||
                                     is_region_within(c, other));
        }
    }
}

int32_t glint_score_find_min_lamp_score(const struct glint_score *score,
                                        struct glint_candidate *candidate,
                                        int32_t *order, int n)
{
    int32_t best_q8 = INT32_MIN;
    int n_over = 0, n_lamps = 0;

    for (int i = 0; i < n; i++) {
        const struct glint_candidate *c = &candidate[order[i]];

        if (!c->faint && c->score_q8 > best_q8)
            best_q8 = c->score_q8;
        if (c->score_q8 >= 0 && !c->faint) {
            const int32_t old = order[n_over];

            order[n_over++] = order[i];
            order[i] = old;
        }
    }
    if (n_over == 0)
        return best_q8 >= -score->alone_q8 ? best_q8 : 0;
    glint_score_choose_among_nested(score, candidate, order, n_over);
    for (int i = 0; i < n_over; i++) {
        n_lamps += !candidate[order[i]].gone;
        candidate[order[i]].gone = 0;
    }
    return n_lamps >= SCORE_SEVERAL ? -SCORE_COMPANY : 0;
}
