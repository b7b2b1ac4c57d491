/* SPDX-License-Identifier: MIT
 *
 * Converts the accumulated differences of a tile to light, by a running sum
 * along each row. edge.h describes the method. */
#include <stddef.h>

#include "flare/edges/edge.h"

void glint_sums_read_linear_row(const struct glint_edge_sums *sums, int channel,
                                int row, int32_t *light_q20)
{
    const int at = (channel << sums->tile_log2) + row;
    uint64_t *change_q36 = sums->wide + (ptrdiff_t)at * sums->stride;
    uint64_t light_q36 = (uint64_t)sums->carry[at];
    const int n = sums->tile.x1 - sums->tile.x0;

    for (int x = 0; x < n; x++) {
        light_q36 += change_q36[x];
        change_q36[x] = 0;
        light_q20[x] = q_clamp_sat(((int64_t)light_q36 >> 16) +
                                       ((int64_t)light_q36 >> 15 & 1),
                                   INT32_MIN, INT32_MAX);
    }
    sums->carry[at] = (int64_t)(light_q36 + change_q36[n]);
    change_q36[n] = 0;
    sums->touched[channel] &= ~(UINT64_C(1) << row);
}

/* Returns the number of fraction bits that a sum has in addition to 16. */
static int get_extra_fraction_bits(const struct glint_edge_sums *s)
{
    return s->fine ? 12 : 8;
}

static uint16_t round_sum_to_q16(int64_t sum, int more)
{
    return (uint16_t)q_clamp_sat((sum >> more) + (sum >> (more - 1) & 1), 0,
                                 65535);
}

static void accumulate_wide_row(uint64_t *change, int64_t *carry, int n,
                                int more, uint16_t *light_q16)
{
    uint64_t sum = (uint64_t)*carry;

    for (int x = 0; x < n; x++) {
        sum += change[x];
        change[x] = 0;
        light_q16[x] = round_sum_to_q16((int64_t)sum, more);
    }
    *carry = (int64_t)sum;
}

int glint_sums_is_row_dark(const struct glint_edge_sums *sums, int row)
{
    const int side = 1 << sums->tile_log2;
    const int64_t *carry = sums->carry + row;
    const uint64_t touched =
        sums->touched[0] | sums->touched[1] | sums->touched[2];

    return !(touched >> row & 1) &&
           (carry[0] | carry[side] | carry[2 * side]) == 0;
}

/* Fills a row without edges with the light that is carried in from the left.
 * Returns whether that light is above 0. */
static int fill_row_with_constant_light(int64_t carry, int n, int more,
                                        uint16_t *light_q16)
{
    const uint16_t light = round_sum_to_q16(carry, more);

    for (int x = 0; x < n; x++)
        light_q16[x] = light;
    return light > 0;
}

int glint_sums_read_code_row(const struct glint_edge_sums *sums, int channel,
                             int row, const struct glint_kernels *kernels,
                             uint16_t *light_q16)
{
    const int at = (channel << sums->tile_log2) + row;
    const ptrdiff_t first = (ptrdiff_t)at * sums->stride;
    const int n = sums->tile.x1 - sums->tile.x0;
    const int padded = (n + GLINT_LANES - 1) & -GLINT_LANES;
    uint32_t carry = (uint32_t)sums->carry[at];

    if (!(sums->touched[channel] >> row & 1))
        return fill_row_with_constant_light(
            sums->carry[at], padded, get_extra_fraction_bits(sums), light_q16);
    sums->touched[channel] &= ~(UINT64_C(1) << row);
    if (!sums->in_narrow) {
        accumulate_wide_row(sums->wide + first, &sums->carry[at], padded,
                            get_extra_fraction_bits(sums), light_q16);
        if (padded == n) {
            sums->carry[at] += (int64_t)sums->wide[first + n];
            sums->wide[first + n] = 0;
        }
        return 1;
    }
    kernels->run_sum(sums->narrow + first, &carry, light_q16, padded,
                     get_extra_fraction_bits(sums));
    if (padded == n) {
        carry += sums->narrow[first + n];
        sums->narrow[first + n] = 0;
    }
    sums->carry[at] = (int32_t)carry;
    return 1;
}
