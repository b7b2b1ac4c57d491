/* SPDX-License-Identifier: MIT
 *
 * Draws the light that dirt on the front element scatters: for each pixel, the
 * interpolated light of the cells times the fraction of its beam that dirt
 * covers. */
#include "base/q.h"
#include "veil/parts.h"

enum { PX = GLINT_VEIL_FRONT_PX, LANES = GLINT_VEIL_LANES };

void glint_veil_front(struct glint_veil *veil,
                      const struct glint_veil_front *front,
                      const struct glint_veil_spread *spreads, int n)
{
    int32_t max_q20 = 0;

    veil->front = front;
    veil->any_front =
        front && veil->front_q20 &&
        glint_veil_spread_light_to(veil, spreads, n, veil->front_q20);
    for (int i = 0; i < 3 * veil->n_x * veil->n_y && veil->any_front; i++)
        max_q20 = q_larger(max_q20, veil->front_q20[i]);
    /* sets the shift after which the brightest cell fits into 16 bits */
    veil->front_down = 4;
    while (max_q20 >> veil->front_down > 65534)
        veil->front_down++;
}

/* Interpolates the cover of the front element bilinearly for pixels X0 .. X1 -
 * 1 of row Y, and a few more. X0 must be a multiple of PX. Nodes lie at the top
 * left corners of every PX-th pixel. */
static void interpolate_front_cover(const struct glint_veil_front *front, int y,
                                    int x0, int x1, uint16_t *part_q16)
{
    const uint32_t low = 2 * (uint32_t)(y % PX) + 1, high = 2 * PX - low;
    const uint16_t *top = front->part_q16 + (ptrdiff_t)(y / PX) * front->n_x;
    const uint16_t *bottom = top + front->n_x;
    uint32_t node[GLINT_CODES_WIDTH / PX + 1] = {0};
    const int first = x0 / PX, n = (x1 - x0 + PX - 1) / PX;

    for (int i = 0; i <= n; i++)
        node[i] = top[first + i] * high + bottom[first + i] * low;
    for (int i = 0; i < n; i++)
        for (uint32_t k = 0; k < PX; k++)
            part_q16[PX * i + (int)k] =
                (uint16_t)((node[i] * (2 * PX - 1 - 2 * k) +
                            node[i + 1] * (2 * k + 1)) /
                           (4 * PX * PX));
}

/* Adds LIGHT times PART to N pixels. The unit of LIGHT is white 2^(DOWN - 16).
 */
static void add_cover_weighted_code_light(const uint16_t *restrict light,
                                          const uint16_t *restrict part_q16,
                                          int down, int n,
                                          uint16_t *restrict to_q16)
{
    const uint16_t most = (uint16_t)(65535 >> down);

    for (int x = 0; x < n; x++) {
        const uint16_t part =
            (uint16_t)((uint32_t)light[x] * part_q16[x] >> 16);
        const uint16_t more = (uint16_t)(part < most ? part << down : 65535);
        const uint16_t room = (uint16_t)(65535 - to_q16[x]);

        to_q16[x] = (uint16_t)(to_q16[x] + (more < room ? more : room));
    }
}

static void add_cover_weighted_linear_light(const int32_t *light_q20,
                                            const uint16_t *part_q16, int n,
                                            int32_t *to_q20)
{
    for (int x = 0; x < n; x++) /* both are at most 2^28 */
        to_q20[x] += (int32_t)q_shift((int64_t)light_q20[x] * part_q16[x], 16);
}

void glint_veil_add_front_row(const struct glint_veil_row *r,
                              const struct glint_pass_rows *rows, int k)
{
    const struct glint_veil *v = r->veil;
    const int n = r->tile.x1 - r->tile.x0, y = rows->y + k;
    uint16_t part_q16[GLINT_CODES_WIDTH + PX] = {0};
    uint16_t light[GLINT_CODES_WIDTH];
    int32_t light_q20[GLINT_CODES_WIDTH];

    interpolate_front_cover(v->front, y, r->tile.x0, r->tile.x1, part_q16);
    for (int c = 0; c < 3; c++)
        if (v->is_linear) {
            glint_veil_interpolate_row(r, v->front_q20, c, y, 0, NULL,
                                       light_q20);
            add_cover_weighted_linear_light(light_q20, part_q16, n,
                                            rows->light_q20[c]);
        } else {
            glint_veil_interpolate_row(r, v->front_q20, c, y, v->front_down,
                                       light, NULL);
            add_cover_weighted_code_light(light, part_q16, v->front_down - 4, n,
                                          rows->light->rgb_q16[c][k]);
        }
}
