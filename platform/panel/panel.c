/* SPDX-License-Identifier: MIT */
#include "panel/panel.h"

#include <stdlib.h>
#include <string.h>

#include "posix/error.h"

/* ----------------------------------------------------------------- geometry */

static int at_least_1(int side)
{
    return side < 1 ? 1 : side;
}

/* Has all of the picture shown, as large as fits the panel in its shape. */
static void fit(struct glint_panel *p)
{
    const struct glint_panel_config *const c = &p->cfg;

    p->seen = (struct glint_panel_area){0, 0, c->image_width, c->image_height};
    p->shown.width = c->width;
    p->shown.height = c->height;
    if (c->width * c->image_height > c->height * c->image_width)
        p->shown.width =
            at_least_1((c->height * c->image_width + c->image_height / 2) /
                       c->image_height);
    else
        p->shown.height = at_least_1(
            (c->width * c->image_height + c->image_width / 2) / c->image_width);
}

/* Has the middle of the picture shown, pixel by pixel. */
static void centre(struct glint_panel *p)
{
    const struct glint_panel_config *const c = &p->cfg;
    const int width = c->image_width < c->width ? c->image_width : c->width;
    const int height =
        c->image_height < c->height ? c->image_height : c->height;

    p->seen = (struct glint_panel_area){(c->image_width - width) / 2,
                                        (c->image_height - height) / 2, width,
                                        height};
    p->shown.width = width;
    p->shown.height = height;
}

static void place(struct glint_panel *p)
{
    if (p->cfg.fit == GLINT_PANEL_FIT)
        fit(p);
    else
        centre(p);
    p->shown.x = (p->cfg.width - p->shown.width) / 2;
    p->shown.y = (p->cfg.height - p->shown.height) / 2;
}

/* Returns the pixel of FROM pixels whose centre is nearest to that of pixel I
 * of TO pixels along the same side. */
static int nearest(int i, int from, int to)
{
    return (2 * i + 1) * from / (2 * to);
}

/* ------------------------------------------------------------------- memory */

/* Rounds BYTES up to a multiple of 64, so that arrays one after the other are
 * aligned as by malloc. */
static size_t round_up(size_t bytes)
{
    return (bytes + 63) & ~(size_t)63;
}

static enum glint_status take_memory(struct glint_panel *p,
                                     struct glint_error *error)
{
    const int widest =
        p->cfg.width > p->cfg.image_width ? p->cfg.width : p->cfg.image_width;
    const size_t line = round_up(4 * (size_t)widest);
    const size_t map = round_up(sizeof *p->from_x * (size_t)p->cfg.width);
    const size_t rgb = round_up(glint_row_rgb_bytes(widest));
    uint8_t *const mem =
        malloc(2 * line + map + rgb + glint_row_pack_bytes(widest));

    if (!mem)
        return glint_error_report(error, GLINT_E_MEMORY, "panel",
                                  "no memory for a row of %d pixels", widest);
    p->mem = mem;
    p->line = mem;
    p->scaled = mem + line;
    p->from_x = (uint16_t *)(void *)(mem + 2 * line);
    glint_row_rgb_init(&p->rgb, mem + 2 * line + map, widest);
    glint_row_pack_init(&p->pack, &p->cfg.layout, p->cfg.dither,
                        mem + 2 * line + map + rgb, widest);
    return GLINT_OK;
}

static bool is_side(int side)
{
    return side >= 1 && side <= GLINT_PANEL_SIDE;
}

enum glint_status glint_panel_open(struct glint_panel *panel,
                                   const struct glint_panel_config *cfg,
                                   struct glint_error *error)
{
    enum glint_status status;

    *panel = (struct glint_panel){.cfg = *cfg};
    if (!is_side(cfg->width) || !is_side(cfg->height) ||
        !is_side(cfg->image_width) || !is_side(cfg->image_height))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, "panel",
                                  "sides must be 1 to %d pixels",
                                  GLINT_PANEL_SIDE);
    if (!glint_pixel_layout_is_valid(&cfg->layout))
        return glint_error_report(error, GLINT_E_UNSUPPORTED, "panel",
                                  "its pixels are not packed true colour of "
                                  "16, 24 or 32 bits");
    place(panel);
    status = take_memory(panel, error);
    if (status)
        return status;
    for (int x = 0; x < panel->shown.width; x++)
        panel->from_x[x] =
            (uint16_t)nearest(x, panel->seen.width, panel->shown.width);
    if (panel->shown.width == panel->seen.width)
        panel->from_x = NULL;
    return GLINT_OK;
}

void glint_panel_close(struct glint_panel *panel)
{
    free(panel->mem);
    panel->mem = NULL;
}

/* ------------------------------------------------------------------ drawing */

void glint_panel_clear(struct glint_panel *panel, uint8_t *mem,
                       ptrdiff_t stride)
{
    const int width = panel->cfg.width;
    const size_t bytes = (size_t)width * (size_t)panel->cfg.layout.bytes;
    const uint8_t *const black[] = {panel->scaled, panel->scaled,
                                    panel->scaled};

    memset(panel->scaled, 0, (size_t)width);
    glint_row_pack_write(&panel->pack, panel->line, black, 0, width);
    for (int y = 0; y < panel->cfg.height; y++)
        memcpy(mem + y * stride, panel->line, bytes);
}

static void spread_2(uint16_t *restrict to, const uint16_t *restrict from,
                     const uint16_t *restrict from_x, int n)
{
    for (int i = 0; i < n; i++)
        to[i] = from[from_x[i]];
}

static void spread_3(uint8_t *restrict to, const uint8_t *restrict from,
                     const uint16_t *restrict from_x, int n)
{
    for (int i = 0; i < n; i++) {
        const uint8_t *const px = from + 3 * from_x[i];

        to[3 * i] = px[0];
        to[3 * i + 1] = px[1];
        to[3 * i + 2] = px[2];
    }
}

static void spread_4(uint32_t *restrict to, const uint32_t *restrict from,
                     const uint16_t *restrict from_x, int n)
{
    for (int i = 0; i < n; i++)
        to[i] = from[from_x[i]];
}

/* Returns row Y of the picture as the panel shows it, packed. TO_Y, its row
 * among those shown, is for dithering. */
static const uint8_t *make_row(struct glint_panel *p,
                               const struct glint_image *image, int y, int to_y)
{
    const int from = p->seen.x & ~1, cut = p->seen.x - from;
    const int n = p->seen.width + cut, bytes = p->cfg.layout.bytes;

    glint_row_rgb_read(&p->rgb, image, from, y, n);
    glint_row_pack_write(&p->pack, p->line, p->rgb.channel, to_y, n);
    if (!p->from_x)
        return p->line + cut * bytes;
    if (bytes == 2)
        spread_2((void *)p->scaled, (const void *)p->line, p->from_x,
                 p->shown.width);
    else if (bytes == 3)
        spread_3(p->scaled, p->line, p->from_x, p->shown.width);
    else
        spread_4((void *)p->scaled, (const void *)p->line, p->from_x,
                 p->shown.width);
    return p->scaled;
}

void glint_panel_draw(struct glint_panel *panel,
                      const struct glint_image *image, uint8_t *mem,
                      ptrdiff_t stride)
{
    const struct glint_panel_area *const to = &panel->shown;
    const int bytes = panel->cfg.layout.bytes;
    const uint8_t *row = NULL;
    int made = -1;

    for (int y = 0; y < to->height; y++) {
        const int from_y =
            panel->seen.y + nearest(y, panel->seen.height, to->height);

        if (!row || from_y != made || panel->pack.dither)
            row = make_row(panel, image, from_y, y);
        made = from_y;
        memcpy(mem + (to->y + y) * stride + to->x * bytes, row,
               (size_t)to->width * (size_t)bytes);
    }
}
