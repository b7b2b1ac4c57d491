/* SPDX-License-Identifier: MIT
 *
 * Predicts the cost of drawing a frame from its plan. The cost is the estimated
 * number of operations of each kind times the cost of one operation. */
#ifndef GLINT_ENGINE_FRAME_COST_H
#define GLINT_ENGINE_FRAME_COST_H

#include <stdbool.h>

#include "glint/dials.h"
#include "glint/explain.h"
#include "glint/flare.h"

struct glint_cost {
    double count[GLINT_COST_KINDS];
};

/* A planned frame, as input of the cost model, before its edges are sorted into
 * tiles. */
struct glint_cost_plan {
    const struct glint_flare *flare;
    int width, height;  /* size of the picture */
    double n_looked_at; /* number of rays that the plan probed */
    int every;     /* every EVERY-th ray bundle is evaluated, as a sample; 0 or
                      1: all bundles */
    bool can_half; /* true: the picture has 8-bit codes, so half resolution is
                      possible */
    bool can_dim;  /* true: three wavelengths are drawn, so the wavelengths of
                      dim ghosts may share rays */
    double code;   /* linear light of one code near black; 0: the picture is
                      linear */
    double n_star; /* number of pixels lit by stars */
    double n_veil; /* cost of the veil / cost of drawing one pixel */
    /* transmission of a stop with a soft edge, dust or masks, with all mip
     * levels; NULL: uniform */
    const struct glint_shade *shade;
    struct glint_dials dials; /* quality parameters with which the frame was
                                 planned */
};

/* Predicts the counts of operations of PLAN for the quality parameters THEN.
 * The fineness of THEN must be within a factor of 4 of the planned fineness.
 * Outside this range, the effect of the size limits of grids is
 * mispredicted. */
struct glint_cost glint_cost_of(const struct glint_cost_plan *plan,
                                const struct glint_dials *then);

/* Converts counts of operations to millions of instructions on a processor with
 * 8 lanes of 32 bits; the weights were fitted to counts by callgrind. The time
 * of a frame is this number times the time per million instructions on this
 * machine. */
double glint_cost_convert_to_minsn(const struct glint_cost *cost);

#endif
