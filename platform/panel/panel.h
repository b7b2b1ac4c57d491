/* SPDX-License-Identifier: MIT
 *
 * panel/panel.h - pictures for a panel of packed true-colour pixels.
 *
 *     glint_panel_open(&panel, &cfg, &error);         takes all memory
 *     glint_panel_clear(&panel, mem, stride);         once: black everywhere
 *     glint_panel_draw(&panel, &image, mem, stride);  each frame
 *     glint_panel_close(&panel);
 *
 * A picture of another size than the panel is scaled to fit, in its shape, by
 * taking for each pixel of the panel the nearest one of the picture; or it is
 * centred as it is, and its sides are cut off where they do not fit. Draw does
 * not touch the parts of the panel beside the picture.
 *
 * Each row is made in cached memory (panel/row_rgb.h, panel/row_pack.h) and
 * then copied, so the panel's own memory is only written, and in order: it may
 * be write-combining. Rows that show the same row of the picture are made once.
 */
#ifndef GLINT_PLATFORM_PANEL_PANEL_H
#define GLINT_PLATFORM_PANEL_PANEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"
#include "panel/row_pack.h"
#include "panel/row_rgb.h"
#include "source_sink.h"

enum glint_panel_fit { GLINT_PANEL_FIT, GLINT_PANEL_CENTRE };

struct glint_panel_config {
    /* Sizes of panel and picture, 1 .. GLINT_PANEL_SIDE. */
    int width, height;
    struct glint_pixel_layout layout;
    int image_width, image_height;
    enum glint_panel_fit fit;
    bool dither; /* pixels of 16 bits are dithered */
};

struct glint_panel {
    struct glint_panel_config cfg;
    /* Shown: the area of the panel that the picture covers. Seen: the part of
     * the picture that is shown there. */
    struct glint_panel_area {
        int x, y, width, height;
    } shown, seen;

    /* Private. */
    struct glint_row_rgb rgb;
    struct glint_row_pack pack;
    uint16_t *from_x; /* pixel of the seen part for each pixel shown; NULL: the
                         same */
    uint8_t *line;    /* a row of the seen part, packed */
    uint8_t *scaled;  /* a row as it is shown, packed */
    void *mem;        /* memory of all private arrays; NULL: closed */
};

/* Prepares PANEL for CFG and takes all memory. GLINT_E_UNSUPPORTED: a layout
 * that is not valid, or a size out of range. GLINT_E_MEMORY. On failure PANEL
 * is closed. */
enum glint_status glint_panel_open(struct glint_panel *panel,
                                   const struct glint_panel_config *cfg,
                                   struct glint_error *error);

/* Fills the panel at MEM, whose rows are STRIDE bytes apart, with opaque
 * black. */
void glint_panel_clear(struct glint_panel *panel, uint8_t *mem,
                       ptrdiff_t stride);

/* Draws IMAGE, of the configured size and any 8-bit format, to the panel at
 * MEM. */
void glint_panel_draw(struct glint_panel *panel,
                      const struct glint_image *image, uint8_t *mem,
                      ptrdiff_t stride);

/* Frees the memory of PANEL, unless it is closed already. */
void glint_panel_close(struct glint_panel *panel);

#endif
