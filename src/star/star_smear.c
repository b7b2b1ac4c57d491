/* SPDX-License-Identifier: MIT
 *
 * Draws the light that dirt in the stop diffracts around a lamp (the smear),
 * from a table of nested squares (smeared.h). The disc of the lamp blurs this
 * light. Squares whose table steps are finer than half the disc's radius are
 * therefore replaced by coarser squares. */
#include "base/compiler.h"
#include "base/q.h"
#include "star/parts.h"

enum {
    HALF = GLINT_STAR_SMEAR_HALF,
    RINGS = GLINT_STAR_SMEAR_RINGS,
    /* STEPS_LOG2: log2 of the number of table steps per pixel in the first
     * square. FIRST_LOG2: half the side of the first square is 2^FIRST_LOG2
     * pixels _q8, or 8 pixels. */
    STEPS_LOG2 = 2,
    FIRST_LOG2 = 11
};

/* State for drawing one ring (the area between two nested squares) in one row
 * of pixels. */
struct span {
    const struct glint_star_smear *table;
    const struct glint_star_lamp *lamp;
    int64_t (*light_q20)[GLINT_CODES_WIDTH];
    int ring;
    /* light per unit of the table, per channel, _q20, times 2^shift */
    int32_t share[3];
    int shift; /* right shift for the product of SHARE and a table value */
};

static void set_smear_ring(struct span *s, int ring)
{
    const struct glint_real step = s->table->step[ring];

    s->ring = ring;
    for (int c = 0; c < 3; c++) /* both factors have 15 bits */
        s->share[c] =
            (int32_t)((int64_t)s->lamp->core[c] * (step.mantissa >> 16));
    s->shift = -(s->lamp->core_exponent + step.exponent + 16 + 20);
}

/* Adds the smear to the pixel at index AT of the row, whose middle lies at (DX,
 * DY) pixels from the lamp. */
static void add_smear_light_to_pixel(const struct span *s, int at,
                                     int64_t dx_q8, int64_t dy_q8)
{
    const int turn = dy_q8 < 0 ? -1 : 1, down = s->ring;
    /* position in the table, in table steps */
    const int64_t x_q8 =
        (turn * dx_q8 * (1 << STEPS_LOG2) >> down) + HALF * 256;
    const int64_t y_q8 = turn * dy_q8 * (1 << STEPS_LOG2) >> down;
    const int i = q_clamp_sat(x_q8 >> 8, 0, 2 * HALF - 1);
    const int j = q_clamp_sat(y_q8 >> 8, 0, HALF - 1);
    const int64_t a = x_q8 - i * 256, b = y_q8 - j * 256;
    const uint16_t(*low)[3] = &s->table->light[s->ring][j][i];
    const uint16_t(*high)[3] = &s->table->light[s->ring][j + 1][i];

    for (int c = 0; c < 3; c++) {
        const int64_t value =
            ((low[0][c] * (256 - a) + low[1][c] * a) * (256 - b) +
             (high[0][c] * (256 - a) + high[1][c] * a) * b) >>
            16;

        /* each sum stays below 2^46 */
        s->light_q20[c][at] +=
            s->shift >= 0 ? s->shift < 63 ? value * s->share[c] >> s->shift : 0
            : s->shift > -16 ? value * s->share[c] * (1 << -s->shift)
                             : INT64_C(1) << 50;
    }
}

/* Returns the index, at least LEAST, of the ring at the distance FAR =
 * max(|dx|, |dy|), pixels, from the lamp; RINGS or more if FAR is outside all
 * rings. */
static int find_smear_ring(int64_t far_q8, int least)
{
    const int bits = bit_length((uint64_t)far_q8) - FIRST_LOG2;

    return q_larger(bits > 0 ? bits : 0, least);
}

void glint_star_add_smear_row(const struct glint_star *star,
                              const struct glint_star_lamp *lamp,
                              struct glint_star_stretch *row)
{
    struct span s = {.table = star->tables->smear,
                     .lamp = lamp,
                     .light_q20 = row->light_q20,
                     .ring = RINGS}; /* invalid until the first pixel */
    const int64_t dy_q8 = (int64_t)row->y * 256 + 128 - lamp->y_q8;
    const int64_t high_q8 = dy_q8 < 0 ? -dy_q8 : dy_q8;
    const int middle = lamp->x_q8 >> 8;
    const int x0 = q_larger(row->x0, middle - lamp->smear_reach);
    const int x1 = q_smaller(row->x1, middle + lamp->smear_reach + 1);
    /* A table step of ring k is 2^k / 4 pixels wide. */
    const int wide = bit_length(lamp->inner_q16 >> 18);
    const int least = wide > 1 ? (wide + 1) / 2 : 0;

    if (x0 >= x1 || high_q8 >= (int64_t)lamp->smear_reach << 8)
        return;
    glint_star_mark_lit_columns(row, x0, x1);
    for (int x = x0; x < x1; x++) {
        const int64_t dx_q8 = (int64_t)x * 256 + 128 - lamp->x_q8;
        const int64_t wide_q8 = dx_q8 < 0 ? -dx_q8 : dx_q8;
        const int ring =
            find_smear_ring(wide_q8 > high_q8 ? wide_q8 : high_q8, least);

        if (ring >= RINGS)
            continue;
        if (ring != s.ring)
            set_smear_ring(&s, ring);
        add_smear_light_to_pixel(&s, x - row->x0, dx_q8, dy_q8);
    }
}
