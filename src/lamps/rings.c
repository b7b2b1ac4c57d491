/* SPDX-License-Identifier: MIT */
#include "lamps/rings.h"

#include "base/divide.h"
#include "base/q.h"
#include "base/sort.h"

#define WHITE_Q20 LINEAR_WHITE_Q20
#define ONE_Q16   (1 << 16)
/* linear light of about sRGB code 231, from which pixels count as partly
 * clipped */
#define CLIP_FIRST Q_CONST(0.80, 20)
/* linear light of about sRGB code 253, from which pixels count as fully clipped
 */
#define CLIP_LAST     Q_CONST(0.98, 20)
#define RIM_LIGHT     Q_CONST(0.95, 20)
#define MAX_BLACK_Q20 Q_CONST(15.0 / 16, 20)

enum {
    SECTORS = 8,
    BORDERS = 4,
    SAMPLES = 32, /* max number of samples along the radius of the inner disc */
    RADII = 16,   /* number of lines from the middle of a core across its rim */
    RADIUS_STEPS = 64, /* number of samples of such a line per core radius */
    RIM_RADIUS = 32, /* min radius, pixels, of a core whose rim is measured; an
                        eighth of this radius exceeds the blur of a lens */
    RINGS = GLINT_PROFILE_RINGS,
    LEVELS = GLINT_PROFILE_LEVELS,
    NEAR = GLINT_PROFILE_NEAR
};

/* ------------------------------------------------------------------- window */

/* The border line between a spot and a neighbouring spot. Pixels on the far
 * side belong to the neighbour. */
struct border {
    int x, y;      /* vector from the spot to the neighbour, pixels */
    int64_t limit; /* max dot product of a pixel's offset with (x, y) for pixels
                      on the spot's side of the line */
    /* distance of the line from the middle of the spot, pixels */
    int32_t at_q8;
};

struct window {
    struct glint_bright *bright;
    struct border border[BORDERS]; /* the borders nearest to the spot, sorted by
                                      distance */
    int n_borders;
    int width, height;
    int x, y;   /* pixel in the middle of the window */
    int radius; /* radius of the inner disc, pixels; the outer radius of ring i
                   is radius << i */
    int step;   /* distance between samples in the inner disc, pixels; step << i
                   in ring i */
};

/* A sampled pixel. SHARE is the number of pixels that it represents; DX, DY is
 * its offset from the middle of the window, pixels. */
struct sample {
    int32_t rgb_q20[3];
    int dx, dy, share, ring;
};

typedef void sample_fn(void *ctx, const struct sample *sample);

/* Returns the window around SPOT, without borders. The radius of the inner disc
 * is twice the spot's RMS radius, which covers a disc or a tube, plus 3 pixels
 * for the blur of the lens. */
static struct window make_spot_window(const struct glint_image *image,
                                      const struct glint_spot *spot)
{
    const int most =
        image->width > image->height ? image->width : image->height;
    const int64_t reach_q8 =
        (int64_t)(spot->size_q8 > 0 ? spot->size_q8 : 0) * 2 + 3 * 256;
    struct window w = {.width = image->width, .height = image->height};

    w.x = q_clamp_sat(spot->x_q8 >> 8, 0, image->width - 1);
    w.y = q_clamp_sat(spot->y_q8 >> 8, 0, image->height - 1);
    w.radius = q_clamp_sat(reach_q8 >> 8, 3, most);
    w.step = (w.radius + SAMPLES - 1) / SAMPLES;
    return w;
}

static int is_inside_borders(const struct window *w, int dx, int dy)
{
    for (int i = 0; i < w->n_borders; i++) {
        const struct border *b = &w->border[i];

        if ((int64_t)dx * b->x + (int64_t)dy * b->y > b->limit)
            return 0;
    }
    return 1;
}

/* Calls SEE for the samples of a row at the x offsets X0, X0 + STEP ... X1.
 * Skips samples off-screen or outside the borders. */
static void visit_row_samples(const struct window *w, int x0, int x1,
                              struct sample *at, int step, sample_fn *see,
                              void *ctx)
{
    for (int dx = x0; dx <= x1; dx += step) {
        const int x = w->x + dx;

        if (x < 0 || x >= w->width || !is_inside_borders(w, dx, at->dy))
            continue;
        glint_bright_read_pixel_light(w->bright, x, at->rgb_q20);
        at->dx = dx;
        see(ctx, at);
    }
}

/* Returns the largest x offset from the centre, a multiple of STEP, that lies
 * within a disc of radius RADIUS in the row DY pixels below its centre; -1 if
 * the row misses the disc. */
static int find_last_sample_offset(int radius, int dy, int step)
{
    const int64_t left = (int64_t)radius * radius - (int64_t)dy * dy;

    return left < 0 ? -1 : (int)q_root((uint64_t)left) / step * step;
}

/* Calls SEE for each sample of ring RING; ring 0 is the inner disc. */
static void visit_ring_samples(const struct window *w, int ring, sample_fn *see,
                               void *ctx)
{
    const int step = w->step << ring, outer = w->radius << ring;
    const int inner = ring ? w->radius << (ring - 1) : -1;
    struct sample at = {.share = step * step, .ring = ring};

    for (int dy = -(outer / step * step); dy <= outer; dy += step) {
        const int end = find_last_sample_offset(outer, dy, step);
        const int gap =
            inner < 0 ? -1 : find_last_sample_offset(inner, dy, step);

        if (w->y + dy < 0 || w->y + dy >= w->height)
            continue;
        glint_bright_select_row(w->bright, w->y + dy);
        at.dy = dy;
        if (gap < 0) {
            visit_row_samples(w, -end, end, &at, step, see, ctx);
        } else {
            visit_row_samples(w, -end, -gap - step, &at, step, see, ctx);
            visit_row_samples(w, gap + step, end, &at, step, see, ctx);
        }
    }
}

/* --------------------------------------------------------------- neighbours */

static int32_t compute_spot_rim_radius_q8(const struct glint_spot *spot)
{
    return q_clamp_sat(spot->size_q8, 0, GLINT_MAX_SIDE << 8) * 3 / 2 + 256;
}

/* Adds BORDER to W if it is among the nearest BORDERS borders. */
static void insert_border_if_near(struct window *w, struct border border)
{
    int at = w->n_borders;

    if (at == BORDERS && w->border[--at].at_q8 <= border.at_q8)
        return;
    for (; at > 0 && w->border[at - 1].at_q8 > border.at_q8; at--)
        w->border[at] = w->border[at - 1];
    w->border[at] = border;
    w->n_borders += w->n_borders < BORDERS;
}

/* Adds the border line between SPOT and OTHER to W, if it crosses the window.
 * The line is half way between the rims of both spots. */
static void add_border_to_neighbour(struct window *w,
                                    const struct glint_spot *spot,
                                    const struct glint_spot *other)
{
    const int x = (other->x_q8 >> 8) - w->x, y = (other->y_q8 >> 8) - w->y;
    const int64_t d2 = (int64_t)x * x + (int64_t)y * y;
    const int64_t far = (int64_t)w->radius << RINGS;
    int64_t d_q8, at_q8;

    if (other->faint || d2 == 0 || d2 >= 4 * far * far)
        return;
    d_q8 = q_root((uint64_t)d2 << 16);
    at_q8 = (d_q8 + compute_spot_rim_radius_q8(spot) -
             compute_spot_rim_radius_q8(other)) /
            2;
    at_q8 = at_q8 < 256 ? 256 : at_q8 > d_q8 ? d_q8 : at_q8;
    if (at_q8 < far << 8)
        insert_border_if_near(
            w, (struct border){x, y, at_q8 * d_q8 >> 16, (int32_t)at_q8});
}

static int is_spot_left_of(const void *ctx, int32_t a, int32_t b)
{
    const struct glint_spot *spots = ctx;

    return spots[a].x_q8 != spots[b].x_q8 ? spots[a].x_q8 < spots[b].x_q8
                                          : a < b;
}

/* Adds to W the borders between the I-th spot from the left and its neighbours.
 */
static void find_spot_borders(struct window *w, const struct glint_rings *rings,
                              const struct glint_spot *spots, int n, int i)
{
    const struct glint_spot *spot = &spots[rings->by_x[i]];
    const int64_t far_q8 = (int64_t)w->radius << (RINGS + 9);

    for (int j = i - 1; j >= 0; j--) {
        const struct glint_spot *other = &spots[rings->by_x[j]];

        if ((int64_t)spot->x_q8 - other->x_q8 > far_q8)
            break;
        add_border_to_neighbour(w, spot, other);
    }
    for (int j = i + 1; j < n; j++) {
        const struct glint_spot *other = &spots[rings->by_x[j]];

        if ((int64_t)other->x_q8 - spot->x_q8 > far_q8)
            break;
        add_border_to_neighbour(w, spot, other);
    }
}

/* --------------------------------------------------------------- background */

struct sectors {
    int64_t rgb_q20[SECTORS][3];
    int64_t n[SECTORS];
};

static void add_sample_to_sector(void *ctx, const struct sample *s)
{
    struct sectors *sectors = ctx;
    const int x = s->dx < 0 ? -s->dx : s->dx, y = s->dy < 0 ? -s->dy : s->dy;
    const int i = (s->dx < 0) | (s->dy < 0) << 1 | (x < y) << 2;

    for (int c = 0; c < 3; c++)
        sectors->rgb_q20[i][c] += s->rgb_q20[c];
    sectors->n[i]++;
}

/* The mean light of one channel in a sector, and the sector's number of
 * samples. */
struct part {
    int32_t mean_q20;
    int64_t n;
};

static void sort_sectors_by_light(struct part *part, int n)
{
    for (int i = 1; i < n; i++)
        for (int j = i; j > 0 && part[j - 1].mean_q20 > part[j].mean_q20; j--) {
            const struct part old = part[j];

            part[j] = part[j - 1];
            part[j - 1] = old;
        }
}

/* Returns the mean light of the samples of a ring between two quantiles, FROM /
 * 8 and TO / 8. PART: the N sectors of the ring, sorted by mean light; ALL:
 * number of samples. */
static int32_t compute_mean_of_quantiles(const struct part *part, int n,
                                         int64_t all, int from, int to)
{
    int64_t sum = 0, at = 0;

    for (int i = 0; i < n; i++) {
        const int64_t end = at + 8 * part[i].n;
        const int64_t low = at > from * all ? at : from * all;
        const int64_t high = end < to * all ? end : to * all;

        if (high > low)
            sum += part[i].mean_q20 * (high - low);
        at = end;
    }
    return all ? (int32_t)q_divide(sum, (to - from) * all) : 0;
}

/* Sets the background light of channel C from the sectors of the outermost
 * ring, sorted by light: its mean to that of the middle half of the samples,
 * its spread to the mean of the last quarter of that half minus that of the
 * first. */
static void set_channel_background(struct glint_profile_channel *of,
                                   const struct sectors *sectors, int c)
{
    struct part part[SECTORS];
    int64_t all = 0, apart_q20;
    int n = 0;

    for (int i = 0; i < SECTORS; i++)
        if (sectors->n[i]) {
            part[n].mean_q20 =
                (int32_t)q_divide(sectors->rgb_q20[i][c], sectors->n[i]);
            part[n++].n = sectors->n[i];
            all += sectors->n[i];
        }
    sort_sectors_by_light(part, n);
    of->black_q20 = compute_mean_of_quantiles(part, n, all, 2, 6);
    if (of->black_q20 > MAX_BLACK_Q20)
        of->black_q20 = MAX_BLACK_Q20;
    of->scale_q16 =
        (int32_t)q_divide(INT64_C(1) << 36, WHITE_Q20 - of->black_q20);
    apart_q20 = compute_mean_of_quantiles(part, n, all, 5, 6) -
                compute_mean_of_quantiles(part, n, all, 2, 3);
    of->spread_q16 = (int32_t)(apart_q20 * of->scale_q16 >> 20);
}

/* --------------------------------------------------------------------- sums */

static int32_t compute_clipped_fraction_q8(int32_t light_q20)
{
    if (light_q20 <= CLIP_FIRST)
        return 0;
    return light_q20 >= CLIP_LAST ? 256
                                  : ((light_q20 - CLIP_FIRST) >> 4) * 256 /
                                        ((CLIP_LAST - CLIP_FIRST) >> 4);
}

/* Counts a sample that has light U and represents SHARE pixels, in its
 * brightness level. Adds SHARE to the level's pixels, and a fraction of SHARE
 * to the level's area. add_brighter_levels_to_areas() later adds the pixels of
 * brighter levels to the area. */
static void count_sample_in_level(struct glint_profile_channel *of,
                                  int32_t u_q16, int share, int ring)
{
    const int level = u_q16 >= ONE_Q16 ? 0 : 17 - bit_length((uint64_t)u_q16);

    if (level > LEVELS || (ring > 1 && level <= NEAR))
        return;
    of->n[level] += share;
    if (level > 0)
        of->area_q8[level] +=
            ((((int64_t)u_q16 << level) - ONE_Q16) >> 8) * share;
}

/* Adds sample S to the moments of the core. The unit of length is a step, the
 * distance between samples of the inner disc. */
static void add_sample_to_core_moments(struct glint_profile_sums *sums,
                                       int32_t u_q16, const struct sample *s)
{
    const int64_t w_q16 = ((int64_t)u_q16 * u_q16) >> 16;
    const int dx = s->dx / sums->step, dy = s->dy / sums->step;

    sums->w_q16 += w_q16;
    sums->moment_q16[0] += w_q16 * dx;
    sums->moment_q16[1] += w_q16 * dy;
    sums->square_q16[0] += w_q16 * dx * dx;
    sums->square_q16[1] += w_q16 * dy * dy;
    sums->square_q16[2] += w_q16 * dx * dy;
}

/* ---------------------------------------------------------------------- rim */

/* Returns the largest channel, linear light, of the pixel at offset (X, Y) from
 * the window's middle. Returns -1 if the pixel belongs to another spot or is
 * off-screen. */
static int32_t read_max_channel(const struct window *w, int32_t x_q8,
                                int32_t y_q8)
{
    const int dx = (x_q8 + 128) >> 8, dy = (y_q8 + 128) >> 8;
    int32_t rgb_q20[3];

    if (w->x + dx < 0 || w->x + dx >= w->width || w->y + dy < 0 ||
        w->y + dy >= w->height || !is_inside_borders(w, dx, dy))
        return -1;
    glint_bright_select_row(w->bright, w->y + dy);
    glint_bright_read_pixel_light(w->bright, w->x + dx, rgb_q20);
    return q_larger(q_larger(rgb_q20[0], rgb_q20[1]), rgb_q20[2]);
}

/* Returns the drop of light along line I at the rim of a core of radius RADIUS,
 * as a fraction of white. Returns 0 if the rim is near the middle, as in a core
 * that is a ring, or -1 if the drop cannot be measured. */
static int32_t measure_light_drop_at_rim(const struct window *w, int i,
                                         int32_t radius_q8)
{
    static const int16_t sine_q14[RADII + RADII / 4] = {
        0,      6270,  11585, 15137,  16384,  15137,  11585,
        6270,   0,     -6270, -11585, -15137, -16384, -15137,
        -11585, -6270, 0,     6270,   11585,  15137};
    const int32_t x_q14 = sine_q14[i + RADII / 4], y_q14 = sine_q14[i];
    int32_t at_q8 = 0, light_q20;

    do {
        at_q8 += radius_q8 / RADIUS_STEPS;
        light_q20 = read_max_channel(w, q_mul(at_q8, x_q14, 14),
                                     q_mul(at_q8, y_q14, 14));
    } while (light_q20 >= RIM_LIGHT && at_q8 < 3 * radius_q8);
    if (light_q20 < 0 || light_q20 >= RIM_LIGHT)
        return -1;
    if (at_q8 < radius_q8 / 4)
        return 0;
    at_q8 += q_larger(at_q8, radius_q8 / 2) / 8;
    light_q20 =
        read_max_channel(w, q_mul(at_q8, x_q14, 14), q_mul(at_q8, y_q14, 14));
    return light_q20 < 0 ? -1
                         : q_clamp_sat(WHITE_Q20 - light_q20, 0, WHITE_Q20);
}

/* Returns the radius of a disc that has the area of the core, which is the max
 * over the channels of the clipped area. */
static int32_t compute_core_radius_q8(const struct glint_profile_sums *sums)
{
    int64_t area_q8 = 0;

    for (int c = 0; c < 3; c++)
        if (sums->of[c].area_q8[0] > area_q8)
            area_q8 = sums->of[c].area_q8[0];
    return (int32_t)q_root((uint64_t)(area_q8 * Q_CONST(0.31831, 8)));
}

static int32_t
compute_median_rim_drop_q15(const struct window *w,
                            const struct glint_profile_sums *sums)
{
    const int32_t radius_q8 = compute_core_radius_q8(sums);
    int32_t lost_q20[RADII];
    int n = 0;

    if (radius_q8 < RIM_RADIUS << 8)
        return 0;
    for (int i = 0; i < RADII; i++) {
        const int32_t lost = measure_light_drop_at_rim(w, i, radius_q8);
        int at = n;

        if (lost < 0)
            continue;
        for (n++; at > 0 && lost_q20[at - 1] > lost; at--)
            lost_q20[at] = lost_q20[at - 1];
        lost_q20[at] = lost;
    }
    return n < RADII / 2 ? 0 : lost_q20[n / 2] >> 5;
}

/* -------------------------------------------------------------------- light */

static void add_sample_to_sums(void *ctx, const struct sample *s)
{
    struct glint_profile_sums *sums = ctx;
    int32_t u_q16[3], most_q16 = 0, clip_q8 = 0;

    for (int c = 0; c < 3; c++) {
        struct glint_profile_channel *of = &sums->of[c];
        const int32_t over_q20 = s->rgb_q20[c] - of->black_q20;
        const int32_t clipped = compute_clipped_fraction_q8(s->rgb_q20[c]);

        u_q16[c] = (int32_t)((int64_t)over_q20 * of->scale_q16 >> 20);
        if (s->ring == 0)
            of->area_q8[0] += (int64_t)clipped * s->share;
        if (u_q16[c] > 0)
            count_sample_in_level(of, u_q16[c], s->share, s->ring);
        clip_q8 = clipped > clip_q8 ? clipped : clip_q8;
        most_q16 = u_q16[c] > most_q16 ? u_q16[c] : most_q16;
    }
    if (most_q16 <= 0)
        return;
    for (int c = 0; c < 3; c++) {
        struct glint_profile_channel *of = &sums->of[c];
        const int64_t weighed_q16 =
            ((s->rgb_q20[c] - of->black_q20) >> 4) * (int64_t)most_q16 >> 16;

        of->fringe_q16 += weighed_q16 * (256 - clip_q8) * s->share >> 8;
        of->white_q16 += weighed_q16 * clip_q8 * s->share >> 8;
    }
    if (s->ring == 0)
        add_sample_to_core_moments(sums, most_q16, s);
}

/* Adds the number of pixels of all brighter levels to the area of each
 * level. */
static void add_brighter_levels_to_areas(struct glint_profile_channel *of)
{
    int64_t n = 0;

    for (int k = 1; k <= LEVELS; k++) {
        n += of->n[k - 1];
        of->area_q8[k] += n << 8;
    }
}

void glint_rings_begin_picture(struct glint_rings *rings,
                               const struct glint_image *image,
                               const struct glint_spot *spots, int n)
{
    glint_bright_begin_picture(&rings->bright, image);
    for (int i = 0; i < n; i++)
        rings->by_x[i] = i;
    glint_sort(rings->by_x, n, is_spot_left_of, spots);
}

void glint_rings_sum_spot_light(struct glint_profile_sums *sums,
                                struct glint_rings *rings,
                                const struct glint_spot *spots, int n, int i)
{
    struct glint_bright *bright = &rings->bright;
    struct window w = make_spot_window(bright->image, &spots[rings->by_x[i]]);
    struct sectors sectors = {{{0}}, {0}};

    w.bright = bright;
    find_spot_borders(&w, rings, spots, n, i);
    *sums = (struct glint_profile_sums){.step = w.step};
    visit_ring_samples(&w, RINGS, add_sample_to_sector, &sectors);
    for (int c = 0; c < 3; c++) {
        struct glint_profile_channel *of = &sums->of[c];
        int64_t step_q20;

        set_channel_background(of, &sectors, c);
        step_q20 = glint_bright_compute_code_step_q20(bright, c, of->black_q20);
        of->step_q16 = (int32_t)(step_q20 * of->scale_q16 >> 20);
    }
    for (int ring = 0; ring <= RINGS; ring++)
        visit_ring_samples(&w, ring, add_sample_to_sums, sums);
    sums->rim_q15 = compute_median_rim_drop_q15(&w, sums);
    for (int c = 0; c < 3; c++)
        add_brighter_levels_to_areas(&sums->of[c]);
}
