/* SPDX-License-Identifier: MIT
 *
 * Draws the lines of a starburst. Each edge of the stop diffracts light at
 * right angles to itself. The light forms a line through the lamp, which is
 * drawn as a strip of pixels.
 *
 * A strip covers the pixels in which the line is visible. Light falls with the
 * square of the distance from the lamp, so the strip is narrower in each
 * distance zone than in the previous one. Each zone ends at four times the
 * distance of the previous one. */
#include "base/q.h"
#include "star/parts.h"

/* Returns X 2^-SHIFT, clamped to 2^50. X must be below 2^48; SHIFT may be
 * negative. */
static int64_t shift_right_clamped(uint64_t x, int shift)
{
    const uint64_t most = UINT64_C(1) << 50;

    if (shift >= 0)
        return shift < 64 ? (int64_t)(x >> shift) : 0;
    return (int64_t)(bit_length(x) - shift > 50 ? (x ? most : 0) : x << -shift);
}

/* A range of pixels of one row: columns x0 .. x1 - 1. */
struct stretch {
    int x0, x1;
};

static struct stretch intersect_pixel_ranges(struct stretch a, struct stretch b)
{
    return (struct stretch){q_larger(a.x0, b.x0), q_smaller(a.x1, b.x1)};
}

/* State for drawing one line of one lamp in one row of pixels. */
struct strip {
    const struct glint_star *star;
    const struct glint_star_lamp *lamp;
    const struct glint_star_line *line;
    int dy_q8;
    struct glint_star_stretch *row;
};

/* Looks up 1 / R2, where R2 is in pixels^2: the result times 2^(1 - *BITS). */
static uint32_t look_up_inverse_square(const struct glint_star *star,
                                       uint64_t r2_q16, int *bits)
{
    const int n = bit_length(r2_q16);
    /* mantissa, 2^15 .. 2^16 - 1 */
    const uint32_t m =
        (uint32_t)(n > 16 ? r2_q16 >> (n - 16) : r2_q16 << (16 - n));
    const uint32_t at = (m - 32768) >> 8, part = m & 255;
    const uint32_t *v = star->inverse_q31 + at;

    *bits = n;
    return v[0] - ((v[0] - v[1]) * part >> 8);
}

static void add_line_light_to_pixel(const struct strip *s, int x, int64_t v_q16)
{
    const int at = (int)(v_q16 >> 16), part_q8 = (int)(v_q16 >> 8 & 255);
    const int64_t dx_q8 = (int64_t)x * 256 + 128 - s->lamp->x_q8;
    uint64_t r2_q16 =
        (uint64_t)(dx_q8 * dx_q8) + (uint64_t)((int64_t)s->dy_q8 * s->dy_q8);
    const uint64_t v_q8 = (uint64_t)(v_q16 * s->lamp->pixels_q16 >> 24);
    const uint16_t *p = s->line->profile[at];
    uint32_t inverse, less_q16;
    int bits;

    r2_q16 = r2_q16 > s->lamp->inner_q16 ? r2_q16 : s->lamp->inner_q16;
    inverse = look_up_inverse_square(s->star, r2_q16, &bits);
    /* (v / r)^2, _q16 */
    less_q16 = (uint32_t)((v_q8 * v_q8 * inverse) >> (bits - 1));
    less_q16 = less_q16 < 65536 ? less_q16 : 65536;
    inverse = (uint32_t)((uint64_t)inverse * (65536 - less_q16) >> 16);
    for (int c = 0; c < 3; c++) {
        const int32_t steps = p[c] + ((p[c + 3] - p[c]) * part_q8 >> 8);

        s->row->light_q20[c][x - s->row->x0] += shift_right_clamped(
            (uint64_t)((uint32_t)s->lamp->line[c] * (uint32_t)steps) * inverse,
            bits - 21 - s->lamp->line_exponent);
    }
}

/* Adds the line's light to those pixels of HERE that are less than SEEN profile
 * steps from the line's centre. */
static void add_line_light_to_pixel_range(const struct strip *s,
                                          struct stretch here, int seen)
{
    const int64_t step_q16 = s->lamp->per_pixel_q16;
    const int64_t dx_q8 = (int64_t)here.x0 * 256 + 128 - s->lamp->x_q8;
    /* computed without rounding, so that the result does not depend on tile
     * borders */
    int64_t v_q38 =
        s->dy_q8 * (int64_t)s->line->cos_q30 - dx_q8 * s->line->sin_q30;
    const int64_t end_q16 = (int64_t)seen << 16;
    const int64_t along_q38 = (int64_t)s->line->sin_q30 * 256;

    if (here.x0 >= here.x1)
        return;
    glint_star_mark_lit_columns(s->row, here.x0, here.x1);
    for (int x = here.x0; x < here.x1; x++, v_q38 -= along_q38) {
        const int64_t v_q16 = (v_q38 >> 22) * step_q16 >> 16;
        const int64_t size_q16 = v_q16 < 0 ? -v_q16 : v_q16;

        if (size_q16 < end_q16)
            add_line_light_to_pixel(s, x, size_q16);
    }
}

/* Returns the range of pixels of the row that lie within SEEN profile steps of
 * the line's centre. */
static struct stretch find_pixels_near_line(const struct strip *s, int seen)
{
    const int64_t middle_q8 = (int64_t)s->dy_q8 * s->line->cot_q16 >> 16;
    const int64_t v_q8 = ((int64_t)seen * s->lamp->pixels_q16 >> 8) + 1;
    const int64_t half_q8 = (v_q8 * s->line->across_q16 >> 16) + 256;
    const int64_t at_q8 = s->lamp->x_q8 + middle_q8;

    return (struct stretch){
        q_clamp_sat((at_q8 - half_q8) >> 8, INT32_MIN / 2, INT32_MAX / 2),
        q_clamp_sat((at_q8 + half_q8 + 256) >> 8, INT32_MIN / 2,
                    INT32_MAX / 2)};
}

static void add_line_strip(const struct strip *s, struct stretch here)
{
    const struct glint_star_lamp *lamp = s->lamp;
    const int x = lamp->x_q8 >> 8, dy = s->row->y - (lamp->y_q8 >> 8);
    const int down = dy < 0 ? -dy : dy;

    for (int i = lamp->n_zones - 1; i >= 0 && down < lamp->start[i + 1]; i--) {
        const int near = lamp->start[i], far = lamp->start[i + 1];
        struct stretch row;

        if (lamp->seen[i] == 0)
            continue;
        row = intersect_pixel_ranges(here,
                                     find_pixels_near_line(s, lamp->seen[i]));
        if (row.x0 >= row.x1)
            continue;
        if (down >= near) {
            add_line_light_to_pixel_range(
                s,
                intersect_pixel_ranges(row,
                                       (struct stretch){x - far + 1, x + far}),
                lamp->seen[i]);
        } else {
            add_line_light_to_pixel_range(
                s,
                intersect_pixel_ranges(
                    row, (struct stretch){x - far + 1, x - near + 1}),
                lamp->seen[i]);
            add_line_light_to_pixel_range(
                s,
                intersect_pixel_ranges(row,
                                       (struct stretch){x + near, x + far}),
                lamp->seen[i]);
        }
    }
}

void glint_star_add_lines_row(const struct glint_star *star,
                              const struct glint_star_lamp *lamp,
                              struct glint_star_stretch *row)
{
    struct strip s = {.star = star,
                      .lamp = lamp,
                      .dy_q8 = row->y * 256 + 128 - lamp->y_q8,
                      .row = row};

    for (int k = 0; k < star->tables->n_lines; k++) {
        s.line = &star->tables->line[k];
        add_line_strip(&s, (struct stretch){row->x0, row->x1});
    }
}

/* Returns the distance max(|dx|, |dy|) in pixels from pixel (X, Y) to box B; 0
 * if the pixel is inside. */
static int compute_distance_to_box(struct glint_box b, int x, int y)
{
    const int dx = q_larger(b.x0 - x, x - (b.x1 - 1));
    const int dy = q_larger(b.y0 - y, y - (b.y1 - 1));

    return q_larger(q_larger(dx, dy), 0);
}

int glint_star_can_lines_reach_box(const struct glint_star *star,
                                   const struct glint_star_lamp *lamp,
                                   struct glint_box box)
{
    const int64_t x_q8 = 128 * (int64_t)(box.x0 + box.x1) - lamp->x_q8;
    const int64_t y_q8 = 128 * (int64_t)(box.y0 + box.y1) - lamp->y_q8;
    const int64_t half_q8 = 128 * (int64_t)(box.x1 - box.x0 + box.y1 - box.y0);
    const int near =
        compute_distance_to_box(box, lamp->x_q8 >> 8, lamp->y_q8 >> 8);
    int zone = 0, seen;

    if (near >= lamp->reach)
        return 0;
    while (zone < lamp->n_zones - 1 && near >= lamp->start[zone + 1])
        zone++;
    seen = lamp->seen[zone];
    for (int k = 0; k < star->tables->n_lines && seen; k++) {
        const struct glint_star_line *l = &star->tables->line[k];
        const int64_t v_q8 = (y_q8 * l->cos_q30 - x_q8 * l->sin_q30) >> 30;
        const int64_t max_q8 =
            half_q8 + ((int64_t)seen * lamp->pixels_q16 >> 8) + 256;

        if (v_q8 < max_q8 && v_q8 > -max_q8)
            return 1;
    }
    return 0;
}
