/* SPDX-License-Identifier: MIT */
#include "tile/blend.h"

#include "base/q.h"

/* Returns LIGHT (1 - COVER): the light that passes a layer of cover COVER in
 * front of it. */
static int64_t attenuate_light(int64_t light, int cover_q8)
{
    return q_shift(light * (GLINT_COVER_ALL - cover_q8), 8);
}

/* ---------------------------------------------------------------- blending */

static void blend_code_light(const struct glint_pass_rows *rows, int row,
                             int n_x, const struct glint_blend_rows *s,
                             int covers)
{
    for (int c = 0; c < 3; c++) {
        uint16_t *to_q16 = rows->light->rgb_q16[c][row];
        const uint16_t *more_q16 = s->light.rgb_q16[c][row];

        for (int x = 0; x < n_x && !covers; x++) {
            const int32_t light_q16 = to_q16[x] + more_q16[x];

            to_q16[x] = (uint16_t)(light_q16 > 65535 ? 65535 : light_q16);
        }
        for (int x = 0; x < n_x && covers; x++)
            to_q16[x] = (uint16_t)q_clamp_sat(
                attenuate_light(to_q16[x], s->next.cover_q8[row][x]) +
                    more_q16[x],
                0, 65535);
    }
}

static void blend_linear_light(const struct glint_pass_rows *rows, int n_x,
                               const struct glint_blend_rows *s, int covers)
{
    for (int c = 0; c < 3; c++)
        for (int x = 0; x < n_x; x++)
            rows->light_q20[c][x] = q_clamp_sat(
                attenuate_light(rows->light_q20[c][x],
                                covers ? s->next.cover_q8[0][x] : 0) +
                    s->light_q20[c][x],
                INT32_MIN, INT32_MAX);
}

/* Combines the cover of the current pass with the total cover of the passes
 * behind it: 1 - (1 - total) (1 - cover). COVERED is 0 if no earlier pass gave
 * cover, so that the total is not initialised yet. */
static void add_pass_cover_to_total(struct glint_blend_rows *s, int row,
                                    int n_x, int covered)
{
    uint16_t *to_q8 = s->cover.cover_q8[row];

    for (int x = 0; x < n_x; x++) {
        const int64_t shows_q8 =
            covered ? GLINT_COVER_ALL - to_q8[x] : GLINT_COVER_ALL;

        to_q8[x] =
            (uint16_t)(GLINT_COVER_ALL -
                       attenuate_light(shows_q8, s->next.cover_q8[row][x]));
    }
}

static enum glint_given blend_pass(const struct glint_pass *pass, void *state,
                                   const struct glint_pass_rows *rows,
                                   enum glint_given given, int n_x,
                                   struct glint_blend_rows *scratch)
{
    struct glint_pass_rows next = {
        rows->y, rows->n, &scratch->light, {0}, &scratch->next};
    enum glint_given more;

    for (int c = 0; c < 3; c++)
        next.light_q20[c] = scratch->light_q20[c];
    more = pass->rows(state, &next);
    if (more == GLINT_GIVES_NOTHING)
        return given;
    for (int row = 0; row < rows->n; row++) {
        if (rows->light_q20[0])
            blend_linear_light(rows, n_x, scratch, more == GLINT_GIVES_COVER);
        else
            blend_code_light(rows, row, n_x, scratch,
                             more == GLINT_GIVES_COVER);
        if (more == GLINT_GIVES_COVER)
            add_pass_cover_to_total(scratch, row, n_x,
                                    given == GLINT_GIVES_COVER);
    }
    return more > given ? more : given;
}

/* ------------------------------------------------------------------- cover */

/* Copies each of PART cover values of a row at half resolution to 2 x 2
 * pixels. */
static void upsample_cover_row(const uint16_t *from_q8, int part,
                               struct glint_cover_rows *to)
{
    for (int i = 0; i < 2 * part; i++)
        to->cover_q8[0][i] = to->cover_q8[1][i] = from_q8[i / 2];
}

static void attenuate_picture_row(const struct glint_tiles *tiles,
                                  struct glint_box tile, int y,
                                  struct glint_tile_scratch *scratch)
{
    enum { PART = GLINT_CODES_WIDTH / 2 };
    struct glint_cover_rows *wide = &scratch->blend->next;

    for (int at = tile.x0; at < tile.x1; at += PART) {
        const int part = q_smaller(PART, tile.x1 - at);
        const int x = at << tiles->half, top = y << tiles->half;
        const int n_x = q_smaller(part << tiles->half, tiles->width - x);
        const int n_y = q_smaller(1 + tiles->half, tiles->height - top);
        const uint16_t *from_q8 =
            scratch->blend->cover.cover_q8[0] + at - tile.x0;

        if (tiles->half) {
            upsample_cover_row(from_q8, part, wide);
            from_q8 = wide->cover_q8[0];
        }
        if (tiles->image->format != GLINT_LINEAR_Q20)
            glint_hide_background_of_run(tiles->resolve, tiles->image, x, top,
                                         n_x, n_y, wide, NULL,
                                         &scratch->codes->rows);
        for (int k = 0; k < n_y && tiles->image->format == GLINT_LINEAR_Q20;
             k++)
            glint_hide_background_of_linear_run(tiles->image, x, top + k, n_x,
                                                from_q8);
    }
}

const struct glint_blend glint_blend = {
    blend_pass, glint_hide_background_of_run, attenuate_picture_row};
