/* SPDX-License-Identifier: MIT
 *
 * Draws the halo of a starburst, the smooth component of the far field. A table
 * holds log2 of the light; its rows are distances from the lamp, its columns
 * distances from the nearest line. */
#include "base/log2.h"
#include "star/parts.h"

/* State while the halo of one lamp is drawn in one row of pixels. */
struct span {
    const struct glint_star *star;
    const struct glint_star_lamp *lamp;
    int64_t dy_q8;
    struct glint_star_stretch *row;
};

/* A fractional index into a table: the integer index AT, and the weight of
 * entry AT + 1.
 */
struct place {
    int at, part_q15;
};

/* Splits X into index and weight, clamped so that the index is below LAST. */
static struct place compute_table_index(int32_t x_q16, int last)
{
    const int32_t held_q16 = q_clamp_sat(x_q16, 0, (last << 16) - 1);

    return (struct place){held_q16 >> 16, held_q16 >> 1 & 32767};
}

static int32_t interpolate_int32(int32_t a, int32_t b, int part_q15)
{
    return a + ((b - a) * part_q15 >> 15);
}

/* A pixel at which the halo is evaluated: its column (x), its distance from the
 * lamp along x (dx) and from the nearest line (v), and its light. */
struct node {
    int x;
    int64_t dx_q8, v_q8;
    int64_t light_q20[3];
};

static struct node make_halo_node(const struct span *s,
                                  const struct glint_star_line *line, int x)
{
    struct node n = {.x = x, .dx_q8 = (int64_t)x * 256 + 128 - s->lamp->x_q8};

    n.v_q8 = (s->dy_q8 * line->cos_q30 - n.dx_q8 * line->sin_q30) >> 30;
    return n;
}

/* Interpolates channel C of the table HALO bilinearly at ROW and COLUMN. */
static int32_t interpolate_halo_table(const glint_star_halo_row *halo,
                                      struct place row, struct place column,
                                      int c)
{
    const uint16_t(*near)[3] = &halo[row.at][column.at];
    const uint16_t(*far)[3] = &halo[row.at + 1][column.at];

    return interpolate_int32(
        interpolate_int32(near[0][c], near[1][c], column.part_q15),
        interpolate_int32(far[0][c], far[1][c], column.part_q15), row.part_q15);
}

static void compute_node_light(const struct span *s, struct node *n)
{
    const struct glint_star_tables *t = s->star->tables;
    const int64_t v_q8 = n->v_q8 < 0 ? -n->v_q8 : n->v_q8;
    uint64_t r2_q16 = (uint64_t)(n->dx_q8 * n->dx_q8 + s->dy_q8 * s->dy_q8);
    int32_t r2_log2_q16, column_q16, log2_of_q16;
    struct place row, column;

    r2_q16 = r2_q16 > s->lamp->inner_q16 ? r2_q16 : s->lamp->inner_q16;
    r2_log2_q16 = q_log2_q16(r2_q16) - 16 * 65536;
    /* log2 of 1 + 4 v / reach */
    column_q16 =
        q_log2_q16((uint64_t)(v_q8 * 4 + t->reach_q8)) - t->reach_log2_q16;
    row = compute_table_index((r2_log2_q16 - 4 * 65536) * 2,
                              GLINT_STAR_HALO_ROWS - 1);
    column = compute_table_index(column_q16 * 4, GLINT_STAR_HALO_COLUMNS - 1);
    for (int c = 0; c < 3; c++) {
        int32_t at = interpolate_halo_table(s->lamp->halo, row, column, c);

        if (s->lamp->halo_part_q15 > 0)
            at = interpolate_int32(
                at, interpolate_halo_table(s->lamp->next_halo, row, column, c),
                s->lamp->halo_part_q15);
        log2_of_q16 = 32 * at;
        log2_of_q16 += t->halo_log2_q16 + s->lamp->halo_log2_q16[c] -
                       r2_log2_q16 + 4 * 65536;
        n->light_q20[c] = q_exp2_q16(q_smaller(log2_of_q16, 34 * 65536));
    }
}

/* Adds light to the STEP pixels from A to the pixel before B, interpolated
 * linearly between the light at A and at B. */
static void add_interpolated_run(const struct span *s, const struct node *a,
                                 const struct node *b, int step)
{
    const int shift = step == 8 ? 3 : step == 4 ? 2 : 0;

    for (int c = 0; c < 3; c++) {
        int64_t *const to_q20 = &s->row->light_q20[c][a->x - s->row->x0];
        const int64_t slope = b->light_q20[c] - a->light_q20[c];

        for (int i = 0; i < step; i++)
            to_q20[i] += a->light_q20[c] + (i * slope >> shift);
    }
}

static int64_t compute_min_magnitude_in_interval(int64_t a, int64_t b)
{
    const int64_t p = a < 0 ? -a : a, q = b < 0 ? -b : b;

    return (a < 0) != (b < 0) ? 0 : p < q ? p : q;
}

/* Returns whether the halo between A and B, which are n pixels apart, may be
 * interpolated linearly. Let r be the distance from the lamp and v the distance
 * from the line. Light falls with r^-3 and v^-2. So linear interpolation is too
 * bright by fractions of at most 1.5 n^2 / r^2 and 0.75 n^2 / v^2. The test
 * limits these to 0.01 and 0.02. */
static int is_halo_nearly_linear(const struct span *s, const struct node *a,
                                 const struct node *b)
{
    const int64_t far_q8 = (int64_t)(b->x - a->x) << 8;
    const int64_t dx_q8 = compute_min_magnitude_in_interval(a->dx_q8, b->dx_q8);

    return compute_min_magnitude_in_interval(a->v_q8, b->v_q8) >= 6 * far_q8 &&
           dx_q8 * dx_q8 + s->dy_q8 * s->dy_q8 >= 144 * far_q8 * far_q8;
}

/* Returns the number of pixels from FROM, up to X1 at most, over which the halo
 * is interpolated linearly: 8, 4 or 1. A run of 8 or 4 begins at a multiple of
 * its length, so that pictures do not depend on tile borders. */
static int choose_interpolated_run_length(const struct span *s,
                                          const struct glint_star_line *line,
                                          const struct node *from, int x1)
{
    for (int n = 8; n >= 4; n >>= 1) {
        struct node to;

        if ((from->x & (n - 1)) != 0 || from->x + n > x1)
            continue;
        to = make_halo_node(s, line, from->x + n);
        if (is_halo_nearly_linear(s, from, &to))
            return n;
    }
    return 1;
}

/* Adds the halo to pixels X0 .. X1 - 1, all of which are nearest to LINE. */
static void add_halo_of_sector(const struct span *s,
                               const struct glint_star_line *line, int x0,
                               int x1)
{
    struct node at = make_halo_node(s, line, x0);

    if (x0 < x1)
        compute_node_light(s, &at);
    for (int n; at.x < x1;) {
        struct node next;

        n = choose_interpolated_run_length(s, line, &at, x1);
        next = make_halo_node(s, line, at.x + n);
        if (next.x < x1 || n > 1)
            compute_node_light(s, &next);
        add_interpolated_run(s, &at, &next, n);
        at = next;
    }
}

/* Adds the halo to pixels X0 .. X1 - 1, sector by sector. A sector is the set
 * of pixels that are nearest to one line. Lines are sorted by angle. In a row
 * below the lamp, their sectors therefore follow each other from right to left;
 * above the lamp, from left to right. */
static void add_halo_of_all_sectors(const struct span *s, int x0, int x1)
{
    const struct glint_star_tables *t = s->star->tables;
    const int below = s->dy_q8 >= 0;
    int line = t->first, at = below ? x1 : x0;

    for (int k = 0; k < t->n_lines; k++) {
        const int64_t border_q8 =
            s->lamp->x_q8 + (s->dy_q8 * t->line[line].border_q16 >> 16);
        const int here = q_clamp_sat((border_q8 + 127) >> 8, x0, x1);

        if (below && here < at) {
            add_halo_of_sector(s, &t->line[line], here, at);
            at = here;
        } else if (!below && here > at) {
            add_halo_of_sector(s, &t->line[line], at, here);
            at = here;
        }
        line = line + 1 < t->n_lines ? line + 1 : 0;
    }
    if (below)
        add_halo_of_sector(s, &t->line[line], x0, at);
    else
        add_halo_of_sector(s, &t->line[line], at, x1);
}

void glint_star_add_halo_row(const struct glint_star *star,
                             const struct glint_star_lamp *lamp,
                             struct glint_star_stretch *row)
{
    const struct span s = {star, lamp, (int64_t)row->y * 256 + 128 - lamp->y_q8,
                           row};
    const int64_t dy = s.dy_q8 / 256, far = lamp->halo_reach;
    const int64_t left2 = far * far - dy * dy;
    int half, middle, x0, x1;

    if (left2 <= 0)
        return;
    half = (int)q_root((uint64_t)left2) + 1;
    middle = lamp->x_q8 >> 8;
    x0 = q_larger(row->x0, middle - half);
    x1 = q_smaller(row->x1, middle + half + 1);
    if (x0 >= x1)
        return;
    glint_star_mark_lit_columns(row, x0, x1);
    add_halo_of_all_sectors(&s, x0, x1);
}
