/* SPDX-License-Identifier: MIT
 *
 * Draws the halo of a starburst, the smooth component of the far field. A table
 * holds log2 of the light; its rows are distances from the lamp, its columns
 * distances from the nearest line. */
#include "base/log2.h"
#include "star/parts.h"

enum { SQUARE = GLINT_STAR_BAND, NODES = GLINT_STAR_NODES };

/* A square of SQUARE x SQUARE pixels in which the halo of one lamp is drawn. It
 * begins at multiples of SQUARE, so that pictures do not depend on tiles. */
struct square {
    const struct glint_star *star;
    const struct glint_star_lamp *lamp;
    int x, y;     /* first pixel */
    int n_x, n_y; /* number of pixels inside the tile */
    int64_t (*light_q20)[3][GLINT_CODES_WIDTH]; /* row of the first pixel */
    int line; /* the line nearest to all pixels, or -1: several */
    int at;   /* column of the first pixel in these rows */
    /* Nodes at the top left pixels of the parts of the square. Bit i of
     * known[j] states whether node[j][i] is set. */
    uint16_t known[NODES];
    struct glint_star_node (*node)[NODES];
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
    const int32_t clamped_q16 = q_clamp_sat(x_q16, 0, (last << 16) - 1);

    return (struct place){clamped_q16 >> 16, clamped_q16 >> 1 & 32767};
}

/* Returns the index of the line nearest to pixel X of a row that is DY below
 * the lamp. The sector of a line is the set of pixels nearest to it. Lines are
 * sorted by angle. In a row below the lamp, sectors therefore follow each other
 * from right to left; above the lamp, from left to right. */
static int find_nearest_line(const struct square *s, int x, int64_t dy_q8)
{
    const struct glint_star_tables *t = s->star->tables;
    int line = t->first;

    for (int k = 0; k < t->n_lines; k++) {
        const int64_t border_q8 =
            s->lamp->x_q8 + (dy_q8 * t->line[line].border_q16 >> 16);
        const int64_t border = (border_q8 + 127) >> 8;

        if (dy_q8 >= 0 ? x >= border : x < border)
            break;
        line = line + 1 < t->n_lines ? line + 1 : 0;
    }
    return line;
}

/* Sets AT to the logarithms of the halo of LAMP per channel, interpolated
 * between rows, columns and, unless their weight is 0, the lamp's two tables.
 */
static void interpolate_halo_table(const struct glint_star_lamp *lamp,
                                   struct place row, struct place column,
                                   uint32_t at_q11[3])
{
    const uint32_t down = (uint32_t)row.part_q15;
    const uint32_t right = (uint32_t)column.part_q15;
    const uint32_t both = down * right >> 15;
    const uint32_t all_q15[4] = {32768 + both - down - right, right - both,
                                 down - both, both};
    const uint32_t next_q15 = (uint32_t)lamp->halo_part_q15;
    const glint_star_halo_row *table = lamp->halo;
    uint32_t weight_q15[4], sum_q26[3] = {0, 0, 0};

    for (int k = 0; k < 4; k++)
        weight_q15[k] = all_q15[k] - (all_q15[k] * next_q15 >> 15);
    for (int i = 0; i < (next_q15 > 0 ? 2 : 1); i++) {
        const uint16_t(*const near)[3] = &table[row.at][column.at];
        const uint16_t(*const far)[3] = &table[row.at + 1][column.at];

        for (int c = 0; c < 3; c++)
            sum_q26[c] += weight_q15[0] * near[0][c] +
                          weight_q15[1] * near[1][c] +
                          weight_q15[2] * far[0][c] + weight_q15[3] * far[1][c];
        table = lamp->next_halo;
        for (int k = 0; k < 4; k++)
            weight_q15[k] = all_q15[k] - weight_q15[k];
    }
    for (int c = 0; c < 3; c++)
        at_q11[c] = sum_q26[c] >> 15;
}

/* Sets N to the halo at pixel (X, Y). */
static OUT_OF_LINE void compute_node(const struct square *s, int x, int y,
                                     struct glint_star_node *n)
{
    const struct glint_star_tables *t = s->star->tables;
    const int64_t dx_q8 = (int64_t)x * 256 + 128 - s->lamp->x_q8;
    const int64_t dy_q8 = (int64_t)y * 256 + 128 - s->lamp->y_q8;
    const int line = s->line >= 0 ? s->line : find_nearest_line(s, x, dy_q8);
    const int64_t v_q8 =
        (dy_q8 * t->line[line].cos_q30 - dx_q8 * t->line[line].sin_q30) >> 30;
    uint64_t r2_q16 = (uint64_t)(dx_q8 * dx_q8 + dy_q8 * dy_q8);
    int32_t r2_log2_q16, column_q16, log2_of_q16;
    struct place row, column;
    uint32_t at_q11[3];

    n->side = 2 * line + (v_q8 < 0);
    n->v_q8 = v_q8 < 0 ? -v_q8 : v_q8;
    r2_q16 = r2_q16 > s->lamp->inner_q16 ? r2_q16 : s->lamp->inner_q16;
    r2_log2_q16 = q_log2_q16(r2_q16) - 16 * 65536;
    /* log2 of 1 + 4 v / reach */
    column_q16 =
        q_log2_q16((uint64_t)(n->v_q8 * 4 + t->reach_q8)) - t->reach_log2_q16;
    row = compute_table_index((r2_log2_q16 - 4 * 65536) * 2,
                              GLINT_STAR_HALO_ROWS - 1);
    column = compute_table_index(column_q16 * 4, GLINT_STAR_HALO_COLUMNS - 1);
    interpolate_halo_table(s->lamp, row, column, at_q11);
    for (int c = 0; c < 3; c++) {
        log2_of_q16 = 32 * (int32_t)at_q11[c] + t->halo_log2_q16 +
                      s->lamp->halo_log2_q16[c] - r2_log2_q16 + 4 * 65536;
        n->light_q20[c] = q_exp2_q16(q_smaller(log2_of_q16, 34 * 65536));
    }
}

static inline const struct glint_star_node *get_node(struct square *s, int i,
                                                     int j)
{
    struct glint_star_node *const n = &s->node[j][i];

    if (!(s->known[j] >> i & 1)) {
        compute_node(s, s->x + i, s->y + j, n);
        s->known[j] |= (uint16_t)(1 << i);
    }
    return n;
}

/* ---------------------------------------------------------- interpolation */

/* Returns whether no line crosses the part of N x N pixels with the corners
 * CORNER, and the lamp is at least 4 N pixels from its middle. The halo then
 * falls monotonically with the distances from lamp and line, except at borders
 * between sectors. */
static int is_part_clear(const struct square *s,
                         const struct glint_star_node *const corner[4], int i,
                         int j, int n)
{
    const int64_t dx = (s->x + i + n / 2) - (s->lamp->x_q8 >> 8);
    const int64_t dy = (s->y + j + n / 2) - (s->lamp->y_q8 >> 8);
    const int64_t min_v_q8 = 512 * n - s->star->tables->reach_q8 / 4;
    int is_same = 1, is_far = 1;

    for (int k = 0; k < 4; k++) {
        is_same &=
            corner[k]->side == corner[0]->side && corner[k]->v_q8 >= min_v_q8;
        /* A line that crosses the part is within its diagonal of each corner.
         */
        is_far &= corner[k]->v_q8 > 384 * n;
    }
    return (is_same || is_far) && dx * dx + dy * dy >= 16 * n * n;
}

/* Returns whether the halo may be interpolated between the corners: whether at
 * MIDDLE this is wrong by at most 1/128, or by a quarter of the faintest
 * visible light. */
static int is_part_bilinear(const struct square *s,
                            const struct glint_star_node *const corner[4],
                            const struct glint_star_node *middle)
{
    const int64_t faintest_q20 = s->star->faintest_q20;

    for (int c = 0; c < 3; c++) {
        const int64_t exact_q20 = middle->light_q20[c];
        const int64_t max_error_q20 =
            exact_q20 >> 5 > faintest_q20 ? exact_q20 >> 5 : faintest_q20;
        int64_t error_q20 = -4 * exact_q20;

        for (int k = 0; k < 4; k++)
            error_q20 += corner[k]->light_q20[c];
        if (error_q20 > max_error_q20 || error_q20 < -max_error_q20)
            return 0;
    }
    return 1;
}

static int is_node_visible(const struct square *s,
                           const struct glint_star_node *n)
{
    int is_visible = 0;

    for (int c = 0; c < 3; c++)
        is_visible |= n->light_q20[c] > s->star->faintest_q20;
    return is_visible;
}

/* Adds light, interpolated bilinearly between CORNER (top left, top right,
 * bottom left, bottom right), to the part of N x N pixels at (I, J). */
static void add_interpolated_part(const struct square *s,
                                  const struct glint_star_node *const corner[4],
                                  int i, int j, int n)
{
    const int shift = n == 8 ? 6 : n == 4 ? 4 : 2;
    const int n_x = q_smaller(n, s->n_x - i), n_y = q_smaller(n, s->n_y - j);

    for (int y = 0; y < n_y; y++)
        for (int c = 0; c < 3; c++) {
            int64_t *const to_q20 = &s->light_q20[j + y][c][s->at + i];
            const int64_t left =
                corner[0]->light_q20[c] * (n - y) + corner[2]->light_q20[c] * y;
            const int64_t right =
                corner[1]->light_q20[c] * (n - y) + corner[3]->light_q20[c] * y;
            uint64_t sum = (uint64_t)(left * n);

            for (int x = 0; x < n_x; x++) {
                to_q20[x] += (int64_t)(sum >> shift);
                sum += (uint64_t)(right - left);
            }
        }
}

static void add_node_to_pixel(struct square *s, int i, int j)
{
    const struct glint_star_node *n;

    if (i >= s->n_x || j >= s->n_y)
        return;
    n = get_node(s, i, j);
    for (int c = 0; c < 3; c++)
        s->light_q20[j][c][s->at + i] += n->light_q20[c];
}

/* Draws the part of N x N pixels at (I, J) if it can be interpolated or is
 * invisible. Returns 0 if it has to be divided. */
static int draw_part(struct square *s, int i, int j, int n)
{
    const struct glint_star_node *const corner[4] = {
        get_node(s, i, j), get_node(s, i + n, j), get_node(s, i, j + n),
        get_node(s, i + n, j + n)};
    const struct glint_star_node *middle;
    int is_visible;

    if (!is_part_clear(s, corner, i, j, n))
        return 0;
    middle = get_node(s, i + n / 2, j + n / 2);
    is_visible = is_node_visible(s, middle);
    for (int k = 0; k < 4; k++)
        is_visible |= is_node_visible(s, corner[k]);
    if (is_visible) {
        if (!is_part_bilinear(s, corner, middle))
            return 0;
        add_interpolated_part(s, corner, i, j, n);
    }
    return 1;
}

static void draw_divided_part(struct square *s, int i, int j, int n)
{
    for (int y = j; y < j + n; y += n / 2)
        for (int x = i; x < i + n; x += n / 2)
            if (n == 2)
                add_node_to_pixel(s, x, y);
            else if (!draw_part(s, x, y, n / 2))
                draw_divided_part(s, x, y, n / 2);
}

/* ------------------------------------------------------------------- bands */

/* Moves S to the next square to the right, whose left nodes are the right nodes
 * of S. */
static void move_square_right(struct square *s)
{
    for (int j = 0; j < NODES; j++) {
        s->node[j][0] = s->node[j][SQUARE];
        s->known[j] = s->known[j] >> SQUARE & 1;
    }
    s->x += SQUARE;
    s->at += SQUARE;
}

/* Returns by how much |X| exceeds LIMIT, at least 0. */
static int64_t compute_excess(int64_t x, int64_t limit)
{
    const int64_t excess = (x < 0 ? -x : x) - limit;

    return excess > 0 ? excess : 0;
}

/* Returns the line nearest to all nodes of the square, or -1 if they have
 * several. */
static int find_common_line(const struct square *s)
{
    const int64_t dy_q8 = (int64_t)s->y * 256 + 128 - s->lamp->y_q8;
    const int64_t end_q8 = dy_q8 + SQUARE * 256;
    const int line = find_nearest_line(s, s->x, dy_q8);

    return (dy_q8 >= 0) == (end_q8 >= 0) &&
                   find_nearest_line(s, s->x + SQUARE, dy_q8) == line &&
                   find_nearest_line(s, s->x, end_q8) == line &&
                   find_nearest_line(s, s->x + SQUARE, end_q8) == line
               ? line
               : -1;
}

/* Returns 1 only if the halo is invisible in the whole square. */
static int is_square_invisible(const struct square *s)
{
    const struct glint_star_tables *t = s->star->tables;
    const int64_t half_q8 = SQUARE * 128;
    const int64_t dx_q8 = (int64_t)s->x * 256 + half_q8 - s->lamp->x_q8;
    const int64_t dy_q8 = (int64_t)s->y * 256 + half_q8 - s->lamp->y_q8;
    const int64_t near_x_q8 = compute_excess(dx_q8, half_q8);
    const int64_t near_y_q8 = compute_excess(dy_q8, half_q8);
    uint64_t r2_q16 = (uint64_t)(near_x_q8 * near_x_q8 + near_y_q8 * near_y_q8);
    int32_t width_q8;

    r2_q16 = r2_q16 > s->lamp->inner_q16 ? r2_q16 : s->lamp->inner_q16;
    width_q8 = s->lamp->halo_width_q8[compute_table_index(
                                          (q_log2_q16(r2_q16) - 20 * 65536) * 2,
                                          GLINT_STAR_HALO_ROWS - 1)
                                          .at];
    for (int k = 0; k < t->n_lines; k++) {
        const int64_t v_q8 =
            (dy_q8 * t->line[k].cos_q30 - dx_q8 * t->line[k].sin_q30) >> 30;

        /* up to half a diagonal closer at the corners */
        if ((v_q8 < 0 ? -v_q8 : v_q8) - 3 * half_q8 / 2 <= width_q8)
            return 0;
    }
    return 1;
}

void glint_star_add_halo_band(const struct glint_star *star,
                              const struct glint_star_lamp *lamp,
                              struct glint_star_band *band)
{
    struct square s = {.star = star,
                       .lamp = lamp,
                       .y = band->y,
                       .n_y = q_smaller(SQUARE, band->y1 - band->y),
                       .light_q20 = band->light_q20,
                       .node = band->node};
    const int64_t far = lamp->halo_reach;
    const int dy = lamp->y_q8 >> 8;
    const int64_t near = q_clamp_sat(dy, band->y, band->y + SQUARE) - dy;
    const int64_t left2 = far * far - near * near;
    int half, x0, x1;

    if (left2 <= 0)
        return;
    half = (int)q_root((uint64_t)left2) + 1;
    x0 = q_larger(band->x0, ((lamp->x_q8 >> 8) - half) & -SQUARE);
    x1 = q_smaller(band->x1, (lamp->x_q8 >> 8) + half + 1);
    if (x0 >= x1)
        return;
    band->lo = q_smaller(band->lo, x0);
    band->hi =
        q_larger(band->hi, q_smaller(band->x1, (x1 + SQUARE - 1) & -SQUARE));
    s.x = x0;
    s.at = x0 - band->x0;
    for (; s.x < x1; move_square_right(&s)) {
        s.n_x = q_smaller(SQUARE, band->x1 - s.x);
        if (is_square_invisible(&s))
            continue;
        s.line = find_common_line(&s);
        if (!draw_part(&s, 0, 0, SQUARE))
            draw_divided_part(&s, 0, 0, SQUARE);
    }
}
