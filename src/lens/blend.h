/* SPDX-License-Identifier: MIT
 *
 * Polynomials of a bundle between two positions of a zoom. */
#ifndef GLINT_LENS_BLEND_H
#define GLINT_LENS_BLEND_H

#include "glint/transfer.h"

enum {
    GLINT_BLEND_BARRELS = GLINT_OUT_KINDS - GLINT_OUT_BARREL_0,
    GLINT_BLEND_PLACES = 6
};

/* A transfer that is interpolated with another position's, output by output:
 * PART of that, 1 - PART of its own. PART below 0, down to -1, extrapolates
 * away from the other. */
struct glint_zoom_mix {
    struct glint_transfer *to;
    int32_t part_q30;
    /* From the box of this position, and then of the other, to the mixed one
     * and back: how much farther the other box's middle lies along u and how
     * much wider and higher it is, in half widths and half heights; all 0 where
     * that is more than a few. */
    struct glint_blend_move {
        int32_t along_q24, wider_q24, higher_q24;
    } move[2];
    int far; /* whether it is */
    /* Where rays of this position, and of the other, pass the stop: of the
     * middle of the box, and how that changes with u and v, in stop radii. */
    struct glint_blend_stop {
        int32_t middle, across, up;
        int32_t x_exponent, y_exponent;
    } stop[2];
    /* Values, _q16, of the barrels of this position and of the other one at
     * places of their own box, and then at places of the pupil that are in
     * both; N of the other's. */
    int32_t barrel_q16[2][GLINT_BLEND_BARRELS][2][GLINT_BLEND_PLACES];
    int n_others, n_mixed;
    /* Barrels that each of the other's is mixed with, and all that are mixed or
     * were added, as bits. */
    uint32_t partners[GLINT_BLEND_BARRELS];
    uint32_t taken;
};

/* An output of the other position, after substituting angle and wavelength. */
struct glint_blend_output {
    uint8_t kind, head;
    int32_t exponent;
    int32_t (*row)[GLINT_TABLE_WIDTH];
    uint8_t degree_u, degree_v;
};

/* The transfer holds the box of the other position; mixes it with BOX of the
 * unit 2^EXPONENT, its own. Returns 0 if PART is below 0 and both lie too far
 * apart for that. */
int glint_blend_box(struct glint_zoom_mix *blend, const int32_t box[3],
                    int32_t exponent);

/* Returns output KIND of T itself. */
struct glint_blend_output glint_blend_of(struct glint_transfer *t, int kind);

/* Returns the value, _q16, of the polynomial of O at a place of its box. A
 * barrel that is so far away that it is clamped cuts nothing or all; units
 * coarser than 2^-16, which no barrel's is, are not distinguished. */
int32_t glint_blend_value_q16(const struct glint_blend_output *o, int64_t u_q24,
                              int64_t v_q24);

/* Registers O, if it is a barrel; outputs come by rising kind. */
void glint_blend_look(struct glint_zoom_mix *blend,
                      const struct glint_blend_output *o);

/* Finds the partner of each registered barrel. */
void glint_blend_pair(struct glint_zoom_mix *blend);

/* Adds barrel O to T in a free place. Returns its number, or -1. */
int glint_blend_put(struct glint_transfer *t,
                    const struct glint_blend_output *o);

/* Mixes O in. Outputs come by rising kind. */
void glint_blend_output(struct glint_zoom_mix *blend,
                        const struct glint_blend_output *o);

/* Opens the barrels that the other position lacks. */
void glint_blend_end(const struct glint_zoom_mix *blend);

/* Dims the energy of T to SHARE. */
void glint_blend_fade(struct glint_transfer *t, int32_t share_q30);

#endif
