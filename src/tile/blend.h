/* SPDX-License-Identifier: MIT
 *
 * How several passes come together, and cover the picture.
 *
 *   light = light (1 - cover of the next) + light of the next
 *   cover = 1 - (1 - cover) (1 - cover of the next)
 */
#ifndef GLINT_TILE_BLEND_H
#define GLINT_TILE_BLEND_H

#include "tile/pass.h"

/* Scratch of a worker: what the next pass gives, and all cover so far. */
struct glint_blend_rows {
    struct glint_light_rows light;
    int32_t light_q20[3][GLINT_CODES_WIDTH];
    struct glint_cover_rows cover, next;
};

/* So that drawing links it only where it is named. */
struct glint_blend {
    /* Has PASS draw ROWS of N_X pixels in front of what was GIVEN; returns what
     * both give together. */
    enum glint_given (*add)(const struct glint_pass *pass, void *state,
                            const struct glint_pass_rows *rows,
                            enum glint_given given, int n_x,
                            struct glint_blend_rows *scratch);
    /* As glint_resolve_stretch(), under COVER. */
    void (*stretch)(const struct glint_resolve *resolve,
                    const struct glint_image *image, int x, int y, int n_x,
                    int n_y, const struct glint_cover_rows *cover,
                    struct glint_light_rows *light,
                    struct glint_resolve_rows *rows);
    /* Covers what the rows are of a picture that is linear, or drawn at half
     * resolution, before light is added. */
    void (*hide)(const struct glint_tiles *tiles, struct glint_box tile, int y,
                 struct glint_tile_scratch *scratch);
};
extern const struct glint_blend glint_blend;

#endif
