/* SPDX-License-Identifier: MIT
 *
 * Merges many lights into few, such that their ghosts move as little as
 * possible.
 *
 *   in   lights in any order
 *   out  fewer, with the same light from nearly the same directions
 *
 * Method: lights are sorted along a Z-order curve through the plane of their
 * direction sines, and only neighbours on the curve are compared. A curve
 * separates some lights that are close in the plane, so each round shifts the
 * curve.
 *
 * Lights too close to be distinguished are merged first. Then, while there are
 * too many lights, the pairs of lowest cost are merged. If two lights of flux a
 * and b at a distance d are merged, they move by d b / (a + b) and d a / (a +
 * b), which shifts the outlines of all their ghosts. The squared error of a
 * shifted outline is taken as the square of its light times the shift; the sum
 * over both lights, a b d, is the cost of merging them. So faint lights are
 * merged over long distances while bright lights hardly move. Each round merges
 * only a fraction of the surplus, the cheapest pairs that it finds, so that
 * costs rise slowly.
 *
 * Lights are merged in place, in O(n log n) for all rounds together, as each
 * round leaves fewer lights. The result does not depend on the order of the
 * input, as the sort compares all members of a light. Between
 * prepare_lights_for_merging() and finish_merged_lights(), rgb_q14 of a light
 * has HELD additional fraction bits; otherwise the colour of a faint light
 * would be lost in rounding when it merges with a bright light. */
#include "base/q.h"
#include "base/real.h"
#include "base/sort.h"
#include "flare/dim.h"
#include "glint/flare.h"

enum {
    CURVES = 3, /* number of rounds, each with another Z-order curve, that merge
                   lights too close to be distinguished */
    PART = 4,   /* a round merges 1 / PART of the lights that are too many */
    BINS = 64,  /* number of bins of the histogram of merge costs */
    HELD = GLINT_LIGHT_HELD,
    WORDS = 10 /* number of 32-bit words of struct glint_light by which lights
                  are sorted */
};

#define ONE_Q30 (INT32_C(1) << 30)

/* -------------------------------------------------------------- directions */

struct direction {
    int32_t x_q30, y_q30, z_q30;
};

static struct direction compute_light_direction(const struct glint_light *b)
{
    return (struct direction){q_mul(b->sine_q30, b->cos_q30, 30),
                              q_mul(b->sine_q30, b->sin_q30, 30),
                              b->cosine_q30};
}

uint64_t glint_light_compute_squared_distance_q60(const struct glint_light *a,
                                                  const struct glint_light *b)
{
    const struct direction p = compute_light_direction(a),
                           q = compute_light_direction(b);
    const int64_t x = (int64_t)p.x_q30 - q.x_q30;
    const int64_t y = (int64_t)p.y_q30 - q.y_q30;
    const int64_t z = (int64_t)p.z_q30 - q.z_q30;

    return (uint64_t)(x * x) + (uint64_t)(y * y) + (uint64_t)(z * z);
}

/* Sets the azimuth of light B to that of the vector (X, Y), and returns the
 * vector's length. A length of 0 means a light on the axis, for which any
 * azimuth is correct. */
static int64_t set_light_azimuth(struct glint_light *b, int32_t x_q30,
                                 int32_t y_q30)
{
    const uint32_t size = (uint32_t)(x_q30 < 0 ? -x_q30 : x_q30) |
                          (uint32_t)(y_q30 < 0 ? -y_q30 : y_q30);
    /* Short vectors are scaled up to preserve precision. */
    const int up = 30 - bit_length(size);
    const int64_t scale = INT64_C(1) << (up > 0 ? up : 0);
    const int64_t x = x_q30 * scale, y = y_q30 * scale;
    const int64_t length = q_root((uint64_t)(x * x + y * y));

    b->cos_q30 =
        length ? q_clamp_sat(x * ONE_Q30 / length, -ONE_Q30, ONE_Q30) : ONE_Q30;
    b->sin_q30 =
        length ? q_clamp_sat(y * ONE_Q30 / length, -ONE_Q30, ONE_Q30) : 0;
    return (length + scale / 2) / scale;
}

/* Sets the direction of light B to that of the vector D, which need not have
 * unit length. */
static void set_light_direction(struct glint_light *b,
                                const struct direction *d)
{
    const int64_t off = set_light_azimuth(b, d->x_q30, d->y_q30), z = d->z_q30;
    const int64_t length = q_root((uint64_t)(off * off + z * z));

    /* The mean of opposite directions has length 0. */
    b->sine_q30 =
        length ? q_clamp_sat(off * ONE_Q30 / length, 0, ONE_Q30) : ONE_Q30;
    b->cosine_q30 = length ? q_clamp_sat(z * ONE_Q30 / length, 0, ONE_Q30) : 0;
}

/* ------------------------------------------------------------------- order */

/* An array of lights to sort, and the sort order. */
struct order {
    struct glint_light *light;
    int by_power; /* 1: the brightest first; 0: along a curve */
    /* Corner at which the curve begins, in the plane of the sines of
     * directions, as offsets below (-1, -1), _q30. */
    uint32_t x0, y0;
};

static void list_light_members_as_words(const struct glint_light *b,
                                        int32_t *word)
{
    word[0] = b->power.exponent;
    word[1] = b->power.mantissa;
    for (int c = 0; c < 3; c++)
        word[2 + c] = b->rgb_q14[c];
    word[5] = b->sine_q30;
    word[6] = b->cosine_q30;
    word[7] = b->cos_q30;
    word[8] = b->sin_q30;
    word[9] = b->apart_q30;
}

/* Returns whether A comes before B in the order of falling power. Lights of
 * equal power are ordered by their other members, so that the order is
 * unique. */
static int is_brighter_light(const struct glint_light *a,
                             const struct glint_light *b)
{
    int32_t p[WORDS], q[WORDS];

    list_light_members_as_words(a, p);
    list_light_members_as_words(b, q);
    for (int i = 0; i < WORDS; i++)
        if (p[i] != q[i])
            return p[i] > q[i];
    return 0;
}

/* Returns the coordinate V, -1 .. 1, relative to -1 - ZERO, where the curve
 * begins. */
static uint32_t compute_curve_offset(int32_t v_q30, uint32_t zero)
{
    return (uint32_t)v_q30 + (uint32_t)ONE_Q30 + zero;
}

static int is_light_before_in_order(const void *order, int i, int j)
{
    const struct order *const o = order;
    const struct glint_light *const a = &o->light[i], *const b = &o->light[j];
    const struct direction p = compute_light_direction(a),
                           q = compute_light_direction(b);
    const uint32_t px = compute_curve_offset(p.x_q30, o->x0),
                   qx = compute_curve_offset(q.x_q30, o->x0);
    const uint32_t py = compute_curve_offset(p.y_q30, o->y0),
                   qy = compute_curve_offset(q.y_q30, o->y0);
    const uint32_t dx = px ^ qx, dy = py ^ qy;

    if (o->by_power || (dx | dy) == 0)
        return is_brighter_light(a, b);
    /* The Z-order curve compares the highest bit in which x or y differ. If the
     * highest bits of both have the same weight, the bit of y decides. */
    return dx < dy && dx < (dx ^ dy) ? py < qy : px < qx;
}

static void swap_lights(void *order, int i, int j)
{
    const struct order *const o = order;
    const struct glint_light old = o->light[i];

    o->light[i] = o->light[j];
    o->light[j] = old;
}

static void sort_lights(struct order *o, int n)
{
    const struct glint_heap heap = {is_light_before_in_order, swap_lights, o};

    glint_heap_sort(&heap, n);
}

/* Sorts N lights along the curve of round ROUND. The curve's corner is shifted
 * by a multiple of irrational numbers, so that no two curves separate the same
 * neighbours. */
static void sort_lights_along_curve(struct glint_light *b, int n, int round)
{
    const uint32_t k = (uint32_t)round;
    struct order o = {b, 0, k * UINT32_C(1640531527) >> 2,
                      k * UINT32_C(2654435769) % UINT32_C(0x3fffffff)};

    sort_lights(&o, n);
}

/* ----------------------------------------------------------------- merging */

void glint_light_merge(struct glint_light *a, const struct glint_light *b)
{
    const struct glint_real power = real_plus(a->power, b->power);
    const int64_t share_q30 =
        power.mantissa ? real_integer(real_over(b->power, power), 30, ONE_Q30)
                       : 0;
    const struct direction p = compute_light_direction(a),
                           q = compute_light_direction(b);
    const struct direction mean = {
        q_narrow(p.x_q30 +
                 q_shift(((int64_t)q.x_q30 - p.x_q30) * share_q30, 30)),
        q_narrow(p.y_q30 +
                 q_shift(((int64_t)q.y_q30 - p.y_q30) * share_q30, 30)),
        q_narrow(p.z_q30 +
                 q_shift(((int64_t)q.z_q30 - p.z_q30) * share_q30, 30))};
    int64_t rgb[3], most = 0;

    for (int c = 0; c < 3; c++) {
        rgb[c] =
            a->rgb_q14[c] +
            q_shift(((int64_t)b->rgb_q14[c] - a->rgb_q14[c]) * share_q30, 30);
        most = rgb[c] > most ? rgb[c] : -rgb[c] > most ? -rgb[c] : most;
    }
    for (int c = 0; c < 3; c++)
        a->rgb_q14[c] = most ? q_narrow(rgb[c] * (1 << (14 + HELD)) / most) : 0;
    a->power = real_times(power, real_of(most, -14 - HELD));
    if (b->apart_q30 > a->apart_q30)
        a->apart_q30 = b->apart_q30;
    set_light_direction(a, &mean);
}

/* Returns the binary exponent of (a b d)^2, the squared cost of merging the
 * lights A and B with fluxes a and b at a distance d. */
static int compute_merge_cost_log2(const struct glint_light *a,
                                   const struct glint_light *b)
{
    const uint64_t d2_q59 =
        glint_light_compute_squared_distance_q60(a, b) >> 1 | 1;
    const struct glint_real light = real_times(a->power, b->power);

    return real_times(real_times(light, light), real_of((int64_t)d2_q59, -59))
        .exponent;
}

/* The condition under which two lights that are neighbours on the curve are
 * merged. */
struct rule {
    uint64_t near2_q60; /* max squared distance of two lights that are merged;
                           0: COST is the condition */
    int cost; /* max log2 of the squared cost of merging two lights; used if
                 near2_q60 is 0 */
    int most; /* number of lights at which merging stops */
};

static int can_lights_merge(const struct rule *r, const struct glint_light *a,
                            const struct glint_light *b)
{
    return r->near2_q60
               ? glint_light_compute_squared_distance_q60(a, b) <= r->near2_q60
               : compute_merge_cost_log2(a, b) <= r->cost;
}

/* Merges neighbours in the list of N lights that satisfy rule R. Returns the
 * number of lights left. */
static int merge_neighbouring_lights(struct glint_light *b, int n,
                                     const struct rule *r)
{
    int last = 0, left = n;

    for (int i = 1; i < n; i++)
        if (left > r->most && can_lights_merge(r, &b[last], &b[i])) {
            glint_light_merge(&b[last], &b[i]);
            left--;
        } else
            b[++last] = b[i];
    return left;
}

/* Returns the cost limit at which one round merges 1 / PART of the N - MOST
 * surplus lights. The limit is exact to 1 / BINS of the range of costs. */
static int find_next_merge_cost_limit(const struct glint_light *b, int n,
                                      int most)
{
    int count[BINS] = {0}, low = INT32_MAX, high = INT32_MIN, width, bin = 0;
    int wanted = (n - most + PART - 1) / PART;

    for (int i = 1; i < n; i++) {
        const int cost = compute_merge_cost_log2(&b[i - 1], &b[i]);

        low = cost < low ? cost : low;
        high = cost > high ? cost : high;
    }
    width = (int)(((int64_t)high - low) / BINS) + 1;
    for (int i = 1; i < n; i++)
        count[(compute_merge_cost_log2(&b[i - 1], &b[i]) - low) / width]++;
    while (bin < BINS - 1 && (wanted -= count[bin]) > 0)
        bin++;
    return low + (bin + 1) * width - 1;
}

/* Removes lights without power or colour. Adds HELD fraction bits to the
 * colours of the remaining lights. Returns the number of lights left. */
static int prepare_lights_for_merging(struct glint_light *b, int n)
{
    int kept = 0;

    for (int i = 0; i < n; i++) {
        const int32_t *rgb = b[i].rgb_q14;

        if (b[i].power.mantissa <= 0 || (rgb[0] | rgb[1] | rgb[2]) == 0)
            continue;
        b[kept] = b[i];
        for (int c = 0; c < 3; c++)
            b[kept].rgb_q14[c] *= 1 << HELD;
        kept++;
    }
    return kept;
}

static void finish_merged_lights(struct glint_light *b, int n)
{
    struct order brightest_first = {.light = b, .by_power = 1};

    for (int i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            b[i].rgb_q14[c] = q_narrow(q_shift(b[i].rgb_q14[c], HELD));
    sort_lights(&brightest_first, n);
}

int glint_lights_merge(struct glint_light *lights, int n_lights,
                       int32_t near_q30, int most, int *n_apart)
{
    struct rule rule = {
        .near2_q60 = (uint64_t)near_q30 * (uint64_t)near_q30 + 1, .most = 1};
    int n = prepare_lights_for_merging(lights, n_lights), round = 0;

    for (; round < CURVES && n > 1; round++) {
        sort_lights_along_curve(lights, n, round);
        n = merge_neighbouring_lights(lights, n, &rule);
    }
    *n_apart = n;
    rule = (struct rule){.most = most > 1 ? most : 1};
    for (; n > rule.most; round++) {
        sort_lights_along_curve(lights, n, round);
        rule.cost = find_next_merge_cost_limit(lights, n, rule.most);
        n = merge_neighbouring_lights(lights, n, &rule);
    }
    finish_merged_lights(lights, n);
    return n;
}
