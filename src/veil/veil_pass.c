/* SPDX-License-Identifier: MIT
 *
 * Draws a veil as a pass (tile/pass.h): interpolates the light of the cells for
 * each pixel.
 */
#include "base/q.h"
#include "flare/draw_over.h"
#include "flare/state.h"
#include "veil/parts.h"

static void *begin_tile_row(const void *self, struct glint_box row, int worker)
{
    const struct glint_veil *veil = self;

    (void)row;
    return &veil->worker[worker];
}

static int begin_veil_tile(void *state, struct glint_box tile)
{
    struct glint_veil_row *r = state;

    r->tile = tile;
    return r->veil->any || r->veil->any_front;
}

/* Interpolates channel C of N cells, from column FIRST on, vertically at pixel
 * row Y. Sets LIGHT to the result, in units of white 2^(DOWN - 20), clamped to
 * MOST. */
static void interpolate_cells_vertically(const struct glint_veil *v,
                                         const int32_t *cell_q20, int c, int y,
                                         int first, int n, int down,
                                         int32_t most,
                                         int32_t light[GLINT_VEIL_CELLS])
{
    const struct glint_veil_axis *axis = &v->down;
    const int cell = axis->cell[y];
    const int32_t *row_q20[3];
    int64_t share_q16[3];

    for (int k = 0; k < 3; k++) {
        share_q16[k] = axis->share_q16[k][y];
        row_q20[k] =
            cell_q20 + first +
            (c * v->n_y + glint_veil_neighbour_index(cell, k - 1, v->n_y)) *
                v->n_x;
    }
    /* cells are at most 2^28, so that sums are below 2^45 */
    for (int x = 0; x < n; x++)
        light[x] = q_clamp_sat(q_shift(row_q20[0][x] * share_q16[0] +
                                           row_q20[1][x] * share_q16[1] +
                                           row_q20[2][x] * share_q16[2],
                                       16 + down),
                               0, most);
}

/* Returns the upper 16 bits of the product; compilers vectorise this form to
 * one instruction. */
static inline uint16_t multiply_high(uint16_t a, uint16_t b)
{
    return (uint16_t)((uint32_t)a * b >> 16);
}

/* Interpolates between three neighbouring cells with LIGHT, 0 .. 65534, for the
 * N pixels from X on; also writes pixels up to the end of the last vector.
 * Truncation loses 2^-17 per product on average; 2^-16 is added where there is
 * light to compensate for part of it. */
static void interpolate_code_pixels(const struct glint_veil_axis *axis, int x,
                                    int n, const int32_t light_q16[3],
                                    uint16_t *restrict to_q16)
{
    enum { LANES = GLINT_VEIL_LANES };
    const uint16_t *restrict s0_q16 = axis->share_q16[0] + x;
    const uint16_t *restrict s1_q16 = axis->share_q16[1] + x;
    const uint16_t *restrict s2_q16 = axis->share_q16[2] + x;
    uint16_t near_q16[4][LANES]; /* light of the three cells and the correction,
                                    each repeated in all lanes */

    for (int k = 0; k < LANES; k++) {
        for (int i = 0; i < 3; i++)
            near_q16[i][k] = (uint16_t)light_q16[i];
        near_q16[3][k] = (light_q16[0] | light_q16[1] | light_q16[2]) > 0;
    }
    for (int at = 0; at < n; at += LANES)
        for (int k = 0; k < LANES; k++)
            to_q16[at + k] =
                (uint16_t)(multiply_high(s0_q16[at + k], near_q16[0][k]) +
                           multiply_high(s1_q16[at + k], near_q16[1][k]) +
                           multiply_high(s2_q16[at + k], near_q16[2][k]) +
                           near_q16[3][k]);
}

static void interpolate_linear_pixels(const struct glint_veil_axis *axis, int x,
                                      int n, const int32_t light_q20[3],
                                      int32_t *to_q20)
{
    for (int i = 0; i < n; i++)
        to_q20[i] = (int32_t)q_shift(
            (int64_t)light_q20[0] * axis->share_q16[0][x + i] +
                (int64_t)light_q20[1] * axis->share_q16[1][x + i] +
                (int64_t)light_q20[2] * axis->share_q16[2][x + i],
            16);
}

void glint_veil_interpolate_row(const struct glint_veil_row *r,
                                const int32_t *cell_q20, int c, int y, int down,
                                uint16_t *to, int32_t *to_q20)
{
    const struct glint_veil *v = r->veil;
    const struct glint_veil_axis *axis = &v->across;
    const int x0 = r->tile.x0, x1 = r->tile.x1;
    const int first = glint_veil_neighbour_index(axis->cell[x0], -1, v->n_x);
    const int last = glint_veil_neighbour_index(axis->cell[x1 - 1], 1, v->n_x);
    int32_t light[GLINT_VEIL_CELLS];
    uint16_t row[GLINT_CODES_WIDTH + GLINT_VEIL_LANES] = {0};

    interpolate_cells_vertically(v, cell_q20, c, y, first, last - first + 1,
                                 down, to ? 65534 : 1 << 28, light);
    for (int x = x0, next; x < x1; x = next) {
        const int cell = axis->cell[x];
        const int32_t *at = light + cell - first;
        const int32_t near[3] = {at[cell > 0 ? -1 : 0], at[0],
                                 at[cell < v->n_x - 1]};

        next = q_smaller(x1, axis->start[cell + 1]);
        if (to)
            interpolate_code_pixels(axis, x, next - x, near, row + x - x0);
        else
            interpolate_linear_pixels(axis, x, next - x, near, to_q20 + x - x0);
    }
    for (int x = 0; x < x1 - x0 && to; x++)
        to[x] = row[x];
}

static enum glint_given write_pixel_rows(void *state,
                                         const struct glint_pass_rows *rows)
{
    const struct glint_veil_row *r = state;
    const struct glint_veil *v = r->veil;

    for (int k = 0; k < rows->n; k++) {
        const int y = rows->y + k;

        /* pictures in codes saturate at white, so 16 bits are enough */
        for (int c = 0; c < 3; c++)
            if (v->is_linear)
                glint_veil_interpolate_row(r, v->cell_q20, c, y, 0, NULL,
                                           rows->light_q20[c]);
            else
                glint_veil_interpolate_row(r, v->cell_q20, c, y, 4,
                                           rows->light->rgb_q16[c][k], NULL);
        if (v->any_front)
            v->front->row(r, rows, k);
    }
    return GLINT_GIVES_LIGHT;
}

/* ----------------------------------------------------------------- drawing */

struct draw {
    struct glint_flare *flare;
    struct glint_tiles tiles;
    const struct glint_pass *pass;
    int n;
};

static void draw_tile_row_job(void *ctx, int job, int worker)
{
    const struct draw *d = ctx;

    glint_tiles_draw_row(&d->tiles, d->pass, d->n, job, worker,
                         &d->flare->worker[worker].tile);
}

/* Draws N passes at full resolution, even if the flare is drawn at half
 * resolution. */
static void draw_full_resolution_passes(struct glint_veil *veil,
                                        struct glint_flare *flare,
                                        const struct glint_image *image,
                                        const struct glint_pass *pass, int n)
{
    struct draw d = {flare, glint_flare_prepare_tiles(flare, image), pass, n};

    d.tiles.half = 0;
    d.tiles.quads = NULL;
    d.tiles.blend = &glint_blend;
    d.tiles.region =
        (struct glint_box){0, 0, flare->cfg.width, flare->cfg.height};
    for (int i = 0; i < veil->cfg.n_workers; i++)
        flare->worker[i].tile.blend = &veil->rows[i];
    glint_workers_run(flare->cfg.workers, glint_tiles_count_rows(&d.tiles),
                      draw_tile_row_job, &d);
}

void glint_veil_draw(struct glint_veil *veil, const struct glint_pass *over,
                     struct glint_flare *flare, const struct glint_image *image)
{
    const struct glint_pass passes[2] = {
        {veil, begin_tile_row, begin_veil_tile, write_pixel_rows},
        over ? *over : (struct glint_pass){0}};
    const struct glint_flare_under under = {passes, over ? 2 : 1, &glint_blend,
                                            veil->rows};

    veil->is_linear = image && image->format == GLINT_LINEAR_Q20;
    if (flare->half) {
        glint_flare_draw(flare, image);
        draw_full_resolution_passes(veil, flare, image, passes, under.n);
    } else {
        glint_flare_draw_over_passes(flare, image, &under);
    }
}

void glint_veil_draw_alone(struct glint_veil *veil, struct glint_flare *flare,
                           const struct glint_image *image)
{
    const struct glint_pass pass = {veil, begin_tile_row, begin_veil_tile,
                                    write_pixel_rows};

    veil->is_linear = image && image->format == GLINT_LINEAR_Q20;
    glint_flare_reset_tile_state(flare);
    draw_full_resolution_passes(veil, flare, image, &pass, 1);
}
