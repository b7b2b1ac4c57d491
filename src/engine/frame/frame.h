/* SPDX-License-Identifier: MIT
 *
 * A frame's flare, end to end: lamps -> grids of rays -> run-time half.
 *
 *     glint_frame_init(&frame, &setup, view, workers);    then set options
 *     glint_frame_draw(&frame, lamps, n, scale, &image, &report);
 *     glint_frame_finish(&frame);
 *
 * The run-time half gets one block of memory, exactly as large as the most
 * demanding frame so far needed.
 */
#ifndef GLINT_ENGINE_FRAME_FRAME_H
#define GLINT_ENGINE_FRAME_FRAME_H

#include <stdbool.h>

#include "engine/frame/budget.h"
#include "engine/frame/frame_star.h"
#include "glint/bake.h"
#include "glint/dials.h"
#include "glint/engine.h"
#include "glint/flare.h"

#define GLINT_FRAME_APART_PX                           \
    0.125 /* a model is less exact than lights so near \
           */
#define GLINT_FRAME_STEP_CODES \
    2.0 /* steps between wavelengths that do not show */

/* Bounds of what a frame of a model may take, unless others are set: bytes, and
 * millions of instructions as glint_cost_minsn() has them, some ten seconds of
 * one processor. Each light further may take 1 / GLINT_FRAME_PER_LIGHT of them
 * more. */
#define GLINT_FRAME_MOST_BYTES ((size_t)384 << 20)
#define GLINT_FRAME_MOST_MINSN 30000.0
#define GLINT_FRAME_PER_LIGHT  16

struct glint_frame;

/* Powers of two, as their logarithms. */
struct glint_frame_scale {
    int likely; /* brings the brightest ghost near 32 times display white, of
                   the 2048 that a pixel may reach */
    int most;   /* no light is cut down: together it is below 2^24 */
};

/* Makes a scale of the brightest ghost's mean light and the flux of all
 * together. */
struct glint_frame_scale glint_frame_scale_of(int brightest_log2,
                                              int together_log2);

/* Rays that no model gives. */
struct glint_frame_rays {
    /* TIMES: the moments between plan, transfer, bin and draw, and before and
     * after. */
    enum glint_status (*draw)(struct glint_frame *frame,
                              const struct glint_lamp *lamps, int n_lamps,
                              double scale, const struct glint_image *image,
                              struct glint_flare_stats *stats, double times[5]);
    /* SCALE becomes {0, 0} where there is no light. GLINT_E_MEMORY: it is not
     * known, or LAMPS have more bundles than can be held. */
    enum glint_status (*scale)(struct glint_frame *frame,
                               const struct glint_lamp *lamps, int n_lamps,
                               struct glint_frame_scale *scale);
    /* Returns the number of bundles of the last frame. */
    int (*n_bundles)(const struct glint_frame *frame);
    int (*ghost)(const struct glint_frame *frame, int bundle);
    void (*finish)(struct glint_frame *frame);
};

/* Traced for each frame: of libglint-bake, for programs that link it. */
extern const struct glint_frame_rays glint_frame_traces;

struct glint_frame {
    const struct glint_setup *setup;
    /* Model of the lens, or NULL where rays are traced: */
    const struct glint_lens *lens;
    const struct glint_frame_rays *trace; /* then this is not */
    glint_clock_fn *clock;                /* NULL: nothing is timed */
    struct glint_view view;
    struct glint_flare_config cfg; /* sizes, tiles, weights, merging, stop;
                                      capacities are the frame's own */
    struct glint_dials dials;      /* may be turned between frames */
    struct glint_dials asked;      /* the same before a budget turned them */
    int point_room;  /* lights that points of wide lamps may come to, where it
                        is more than the dial and lamps are no more than that */
    double apart_px; /* lights whose images are nearer are one */
    bool for_codes;  /* a linear picture is planned as if for codes */
    bool can_half;   /* the last picture was in codes, by edges */
    bool uniform;    /* the same grid for all ghosts */
    int only_ghost;  /* -1: all */
    int16_t *mask;   /* distances of the stop's outline, unless NULL */
    struct glint_frame_star star;
    struct glint_budget budget; /* turns the dials; only for models */
    bool reserved;              /* memory is what it is */
    size_t most_bytes; /* bound of the block for one light, where it is not
                          reserved; 0: any */
    bool is_full;      /* the block has as many as it may */
    double most_minsn; /* bound of a plan for one light; 0: any */
    bool is_held;      /* the last frame was coarser for it */

    struct glint_wave wave[GLINT_SET_WAVES];
    struct glint_wave_sets sets;
    struct glint_light *light;
    int n_lights, light_capacity;
    int n_apart;  /* lights that can be told apart */
    int n_beyond; /* left out before: the model ends before them */
    int n_more;   /* lights that are further points of a lamp */
    /* Frame that was planned last from a model. */
    struct glint_flare_frame rays;
    double scale; /* factor of the lights of the last frame */
    bool *seen;   /* ghosts in the last frame, [GLINT_MAX_GHOSTS] */

    /* Lamps to trace, where some merged; [n_lights]. */
    struct glint_lamp *merged;
    void *traced; /* state that the trace keeps, NULL: none */
    struct glint_flare *flare;
    void *mem, *block; /* taken, unless NULL; the aligned part of it, or what
                          was given */
    size_t bytes;      /* bytes of the block */
};

struct glint_frame_report {
    struct glint_flare_stats stats;
    int lights;        /* lights given */
    int beyond_lights; /* lights of these farther out than the model goes */
    int apart_lights;  /* lights that can be told apart */
    int drawn_lights;  /* after merging more, for their number */
    int ghosts, tiles;
    int held_samples;   /* samples of a linear picture that saturated */
    size_t arena_bytes; /* bytes that the run-time half was given */
    size_t peak_bytes;  /* bytes that this frame took of these */
    size_t need_bytes;  /* bytes that would have drawn all of it, exactly */
    bool coarsened;     /* its plan passed the bound of work */
    double plan_ms, trace_ms, bin_ms, draw_ms;
    /* Prediction and quality with a budget; else 0 and -1. */
    double predicted_ms, quality;
    double calibrated_minsn; /* million instructions that predictions rest on,
                                or 0 */
};

void glint_frame_init(struct glint_frame *frame,
                      const struct glint_setup *setup, struct glint_view view,
                      struct glint_workers *workers);

/* The same with the options of LIKE, as they were asked for, but without its
 * mask and its budget. */
void glint_frame_like(struct glint_frame *frame, const struct glint_frame *like,
                      struct glint_view view);

/* Takes BYTES for all frames to come, of up to N_LAMPS lamps each, of which
 * N_DRAWN are drawn and more merge: nothing is allocated while drawing, and
 * what does not fit is left out and counted. MEM: as many that were taken
 * already, aligned to 64, which stay the caller's; or NULL. GLINT_E_MEMORY:
 * there are not so many, or they do not hold one light. */
enum glint_status glint_frame_reserve(struct glint_frame *frame, void *mem,
                                      size_t bytes, int n_lamps, int n_drawn);

/* Reads the stop from a mask of NODES^2 distances rather than its sides; RASTER
 * is one that takes it. */
enum glint_status glint_frame_use_mask(struct glint_frame *frame,
                                       const struct glint_raster *raster,
                                       int nodes);

/* Draws a lamp a few times to see what an instruction takes here, for the
 * budget. GLINT_E_MEMORY. */
enum glint_status glint_frame_calibrate(struct glint_frame *frame);

/* Adds the flare of LAMPS, times SCALE, to IMAGE. GLINT_E_MEMORY. */
enum glint_status glint_frame_draw(struct glint_frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   double scale,
                                   const struct glint_image *image,
                                   struct glint_frame_report *report);

/* Returns the last plan of FRAME, for glint_cost_of(). */
struct glint_cost_plan glint_frame_plan(const struct glint_frame *frame);

/* Returns whether LAMP is farther off the axis than FRAME's model goes. */
bool glint_frame_is_beyond(const struct glint_frame *frame,
                           const struct glint_lamp *lamp);

/* Takes over what changed in cfg since memory was taken; no more of it is. */
void glint_frame_retune(struct glint_frame *frame);

/* Draws the flare of LAMPS alone, times GAIN, into RGB, [height][width][3],
 * linear light. The scale within is a power of two that leaves the faint as
 * many steps as the brightest pixel allows: where that is fainter than the plan
 * could predict, the frame is drawn twice. GLINT_E_MEMORY. */
enum glint_status glint_frame_draw_alone(struct glint_frame *frame,
                                         const struct glint_lamp *lamps,
                                         int n_lamps, double gain, float *rgb,
                                         struct glint_frame_report *report);

void glint_frame_finish(struct glint_frame *frame);

#endif
