/* SPDX-License-Identifier: MIT
 *
 * Draws starbursts as a pass (tile/pass.h): selects the lamps whose starburst
 * reaches a row of tiles, then those that reach the current tile, and adds
 * their light to each pixel row.
 */
#include "base/q.h"
#include "flare/draw_over.h"
#include "flare/state.h"
#include "star/parts.h"

/* Returns the distance in pixels up to which halo, core or smear of LAMP are
 * visible. */
static int compute_halo_and_core_reach(const struct glint_star *star,
                                       const struct glint_star_lamp *lamp)
{
    return q_larger(lamp->is_bare ? glint_star_compute_core_reach(star) : 0,
                    q_larger(lamp->halo_reach, lamp->smear_reach)) +
           2;
}

static int is_box_within_lamp_reach(const struct glint_star_lamp *lamp,
                                    struct glint_box box, int far)
{
    const int x = lamp->x_q8 >> 8, y = lamp->y_q8 >> 8;

    return box.x0 <= x + far && box.x1 >= x - far && box.y0 <= y + far &&
           box.y1 >= y - far;
}

static void *begin_tile_row(const void *self, struct glint_box row, int worker)
{
    const struct glint_star *star = self;
    struct glint_star_row *r = &star->worker[worker];

    r->n_near = 0;
    for (int i = 0; i < star->n_lamps; i++)
        if (is_box_within_lamp_reach(
                &star->lamp[i], row,
                q_larger(compute_halo_and_core_reach(star, &star->lamp[i]),
                         star->lamp[i].reach)))
            r->near[r->n_near++] = (uint16_t)i;
    return r;
}

static int select_tile_lamps(void *state, struct glint_box tile)
{
    struct glint_star_row *r = state;
    const struct glint_star *s = r->star;

    r->tile = tile;
    r->n_here = 0;
    for (int i = 0; i < r->n_near; i++) {
        const struct glint_star_lamp *lamp = &s->lamp[r->near[i]];

        if (is_box_within_lamp_reach(lamp, tile,
                                     compute_halo_and_core_reach(s, lamp)) ||
            glint_star_can_lines_reach_box(s, lamp, tile))
            r->here[r->n_here++] = r->near[i];
    }
    return r->n_here > 0;
}

static void add_lamps_to_row(const struct glint_star_row *r,
                             struct glint_star_stretch *row)
{
    const struct glint_star *s = r->star;

    for (int i = 0; i < r->n_here; i++) {
        const struct glint_star_lamp *lamp = &s->lamp[r->here[i]];

        glint_star_add_lines_row(s, lamp, row);
        glint_star_add_core_row(s, lamp, row);
        if (s->tables->smear)
            s->tables->smear->part(s, lamp, row);
    }
}

/* Writes the accumulated light of channel C of ROW to LIGHT, clamped to 16
 * bits, and resets it to 0 in ROW. Returns nonzero if any light was nonzero. */
static int move_accumulated_light_to_q16(const struct glint_star *star,
                                         const struct glint_star_stretch *row,
                                         int c, uint16_t *light_q16)
{
    /* Columns up to multiples of 8 have no light, and rows have room for them.
     */
    const int from = (row->lo - row->x0) & -8;
    const int end = (row->hi - row->x0 + 7) & -8;

    for (int i = 0; i < row->x1 - row->x0; i++)
        light_q16[i] = 0;
    return from < end ? star->kernels->move_light(row->light_q20[c] + from,
                                                  end - from, light_q16 + from)
                      : 0;
}

static int move_accumulated_light_to_q20(const struct glint_star_stretch *row,
                                         int c, int32_t *to_q20)
{
    int64_t *const light_q20 = row->light_q20[c];

    for (int i = 0; i < row->x1 - row->x0; i++)
        to_q20[i] = 0;
    for (int i = row->lo - row->x0; i < row->hi - row->x0; i++) {
        to_q20[i] = q_clamp_sat(light_q20[i], INT32_MIN, INT32_MAX);
        light_q20[i] = 0;
    }
    return row->lo < row->hi;
}

/* Begins the band at row Y of the tile: adds the halos of all lamps. */
static void begin_band(struct glint_star_row *r, int y)
{
    struct glint_star_band *const b = &r->band;

    b->y = y;
    b->y1 = r->tile.y1;
    b->x0 = b->hi = r->tile.x0;
    b->x1 = b->lo = r->tile.x1;
    for (int i = 0; i < r->n_here; i++)
        glint_star_add_halo_band(r->star, &r->star->lamp[r->here[i]], b);
}

static enum glint_given write_pixel_rows(void *state,
                                         const struct glint_pass_rows *rows)
{
    struct glint_star_row *r = state;
    const struct glint_star_band *const band = &r->band;
    int any = 0;

    for (int k = 0; k < rows->n; k++) {
        const int in_band = (rows->y + k) % GLINT_STAR_BAND;
        struct glint_star_stretch row = {.y = rows->y + k,
                                         .x0 = r->tile.x0,
                                         .x1 = r->tile.x1,
                                         .light_q20 = band->light_q20[in_band]};

        if (in_band == 0)
            begin_band(r, rows->y + k);
        row.lo = band->lo;
        row.hi = band->hi;
        add_lamps_to_row(r, &row);
        for (int c = 0; c < 3; c++)
            any |=
                r->star->is_linear
                    ? move_accumulated_light_to_q20(&row, c, rows->light_q20[c])
                    : move_accumulated_light_to_q16(r->star, &row, c,
                                                    rows->light->rgb_q16[c][k]);
    }
    return any ? GLINT_GIVES_LIGHT : GLINT_GIVES_NOTHING;
}

static struct glint_pass make_star_pass(const struct glint_star *star)
{
    return (struct glint_pass){star, begin_tile_row, select_tile_lamps,
                               write_pixel_rows};
}

/* ----------------------------------------------------------------- drawing */

struct draw {
    struct glint_flare *flare;
    struct glint_tiles tiles;
    struct glint_pass pass;
};

static void draw_tile_row_job(void *ctx, int job, int worker)
{
    const struct draw *d = ctx;

    glint_tiles_draw_row(&d->tiles, &d->pass, 1, job, worker,
                         &d->flare->worker[worker].tile);
}

/* Draws the starburst without the ghosts, at full resolution even if the flare
 * is drawn at half resolution. */
static void draw_star_without_flare(struct glint_star *star,
                                    struct glint_flare *flare,
                                    const struct glint_image *image)
{
    struct draw d = {flare, glint_flare_prepare_tiles(flare, image),
                     make_star_pass(star)};

    d.tiles.half = 0;
    d.tiles.quads = NULL;
    d.tiles.region =
        (struct glint_box){0, 0, flare->cfg.width, flare->cfg.height};
    glint_workers_run(flare->cfg.workers, glint_tiles_count_rows(&d.tiles),
                      draw_tile_row_job, &d);
}

struct glint_pass glint_star_make_pass(struct glint_star *star,
                                       const struct glint_image *image)
{
    star->is_linear = image && image->format == GLINT_LINEAR_Q20;
    return make_star_pass(star);
}

void glint_star_draw_alone(struct glint_star *star, struct glint_flare *flare,
                           const struct glint_image *image)
{
    glint_flare_reset_tile_state(flare);
    star->is_linear = image && image->format == GLINT_LINEAR_Q20;
    if (star->n_lamps > 0)
        draw_star_without_flare(star, flare, image);
}

void glint_star_draw(struct glint_star *star, struct glint_flare *flare,
                     const struct glint_image *image)
{
    const struct glint_pass pass = make_star_pass(star);
    const struct glint_flare_under under = {&pass, 1, &glint_blend, star->rows};

    star->is_linear = image && image->format == GLINT_LINEAR_Q20;
    if (star->n_lamps == 0) {
        glint_flare_draw(flare, image);
    } else if (flare->half) {
        glint_flare_draw(flare, image);
        draw_star_without_flare(star, flare, image);
    } else {
        glint_flare_draw_over_passes(flare, image, &under);
    }
}
