/* SPDX-License-Identifier: MIT
 *
 * A frame's flare, end to end: lamps -> grids of rays -> run-time half.
 *
 *     frame_init(&frame, &setup, view, workers);    then set options
 *     frame_draw(&frame, lamps, n, scale, &image, &report);
 *     frame_finish(&frame);
 *
 * The run-time half gets one block of memory, exactly as large as the most
 * demanding frame so far needed.
 */
#ifndef GLINT_TOOLS_ENGINE_FRAME_H
#define GLINT_TOOLS_ENGINE_FRAME_H

#include <stdbool.h>

#include "engine/budget.h"
#include "engine/cost.h"
#include "glint/dials.h"
#include "glint/glint.h"

#define FRAME_APART_PX   0.125 /* a model is less exact than lights so near */
#define FRAME_STEP_CODES 2.0   /* steps between wavelengths that do not show */

struct frame {
    const struct glint_setup *setup;
    const struct glint_lens *lens; /* its model; NULL: exact rays */
    struct glint_view view;
    struct glint_flare_config cfg; /* sizes, tiles, weights, merging, stop;
                                      capacities are the frame's own */
    struct glint_dials dials;      /* may be turned between frames */
    double apart_px;               /* lights whose images are nearer are one */
    bool for_codes;       /* a linear picture is planned as if for codes */
    bool can_half;        /* the last picture was in codes, by edges */
    bool uniform;         /* the same grid for all ghosts */
    int only_ghost;       /* -1: all */
    int16_t *mask;        /* of the stop, unless NULL */
    struct budget budget; /* of models; turns the dials */
    bool reserved;        /* memory is what it is */

    struct glint_wave wave[GLINT_SET_WAVES];
    struct glint_wave_sets sets;
    struct glint_light *beam;
    int n_beams, max_beams;
    int n_apart;  /* lights that can be told apart */
    int n_beyond; /* left out before: the model ends before them */
    int n_more;   /* beams that are further points of a lamp */
    struct glint_flare_frame rays; /* of the last frame, with a model */
    double scale;                  /* by which its lights were multiplied */
    bool *seen; /* ghosts in the last frame, [GLINT_MAX_GHOSTS] */

    /* exact rays */
    struct glint_lamp *merged; /* lamps, where some merged; [n_beams] */
    struct glint_feed *feed;
    int n_feeds, max_feeds;
    int n_dropped;                  /* bundles beyond what a frame may take */
    struct glint_vertex **vertices; /* of each feed, in the flare's block */
    struct glint_flare *flare;
    void *mem;
    size_t bytes;
};

struct frame_report {
    struct glint_flare_stats stats;
    int lights;        /* as given */
    int beyond_lights; /* of these, farther out than the model goes */
    int apart_lights;  /* that can be told apart */
    int drawn_lights;  /* after merging more, for their number */
    int ghosts, tiles;
    int held_samples;   /* of a linear picture, saturated */
    size_t arena_bytes; /* what the run-time half was given */
    size_t peak_bytes;  /* what its largest frame took of it */
    double plan_ms, trace_ms, bin_ms, draw_ms;
    double predicted_ms, quality; /* with a budget, else 0 and -1 */
    double calibrated_minsn;      /* that predictions rest on, or 0 */
};

void frame_init(struct frame *frame, const struct glint_setup *setup,
                struct glint_view view, struct glint_workers *workers);

/* Takes BYTES for all frames to come, of up to N_LAMPS lamps each, of which
 * N_DRAWN are drawn and more merge: nothing is allocated while drawing, and
 * what does not fit is left out and counted. GLINT_E_MEMORY: there are not so
 * many, or they do not hold one light. */
enum glint_status frame_reserve(struct frame *frame, size_t bytes, int n_lamps,
                                int n_drawn);

/* Reads the stop from a mask of NODES^2 distances rather than its sides. */
enum glint_status frame_use_mask(struct frame *frame, int nodes);

/* Adds the flare of LAMPS, times SCALE, to IMAGE. GLINT_E_MEMORY. */
enum glint_status frame_draw(struct frame *frame,
                             const struct glint_lamp *lamps, int n_lamps,
                             double scale, const struct glint_image *image,
                             struct frame_report *report);

/* What FRAME planned last, for cost_of(). */
struct cost_plan frame_plan(const struct frame *frame);

/* Whether LAMP is farther off the axis than FRAME's model goes. */
bool frame_is_beyond(const struct frame *frame, const struct glint_lamp *lamp);

/* Draws the flare of LAMPS alone, times GAIN, into RGB, [height][width][3],
 * linear light. The scale within is a power of two that leaves the faint as
 * many steps as the brightest pixel allows: where that is fainter than the plan
 * could tell, the frame is drawn twice. GLINT_E_MEMORY. */
enum glint_status frame_draw_alone(struct frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   double gain, float *rgb,
                                   struct frame_report *report);

/* Takes over what changed in cfg since memory was taken; no more of it is. */
void frame_retune(struct frame *frame);

void frame_finish(struct frame *frame);

#endif
