/* SPDX-License-Identifier: MIT
 *
 * Draws a frame's flare from lamps: lamps -> grids of rays -> run-time half.
 *
 *     glint_frame_init(&frame, &setup, view, workers);    then set options
 *     glint_frame_draw(&frame, lamps, n, scale, &image, &report);
 *     glint_frame_finish(&frame);
 *
 * The run-time half gets one block of memory, exactly as large as the most
 * demanding frame so far needed. */
#ifndef GLINT_ENGINE_FRAME_FRAME_H
#define GLINT_ENGINE_FRAME_FRAME_H

#include <stdbool.h>

#include "engine/frame/budget.h"
#include "engine/frame/frame_star.h"
#include "engine/frame/frame_veil.h"
#include "glint/bake.h"
#include "glint/dials.h"
#include "glint/engine.h"
#include "glint/flare.h"

/* Merge distance of lights' images, pixels; the error of a model is larger. */
#define GLINT_FRAME_APART_PX 0.125
/* steps between wavelengths, in codes, that do not show */
#define GLINT_FRAME_STEP_CODES 2.0

/* Default limits of a frame drawn by a model: bytes, and millions of
 * instructions by glint_cost_to_minsn(), about ten seconds on one processor.
 * Each further light raises both by 1 / GLINT_FRAME_PER_LIGHT. */
#define GLINT_FRAME_MOST_BYTES ((size_t)384 << 20)
#define GLINT_FRAME_MOST_MINSN 30000.0
#define GLINT_FRAME_PER_LIGHT  16

struct glint_frame;

/* Two scales, as logarithms to base 2. */
struct glint_frame_scale {
    int likely; /* brings the brightest ghost near 32 times display white; a
                   pixel may reach 2048 */
    int most; /* the largest at which no light is clamped: the sum of all light
                 is below 2^24 */
};

/* Returns the scales, given log2 of the brightest ghost's mean light and
 * log2 of the flux of all ghosts together. */
struct glint_frame_scale glint_frame_compute_scale(int brightest_log2,
                                                   int together_log2);

/* A source of rays other than a model. */
struct glint_frame_rays {
    /* Draws a frame. TIMES receives the moments before plan, transfer, bin and
     * draw, and after draw. */
    enum glint_status (*draw)(struct glint_frame *frame,
                              const struct glint_lamp *lamps, int n_lamps,
                              double scale, const struct glint_image *image,
                              struct glint_flare_stats *stats, double times[5]);
    /* Predicts SCALE; {0, 0} if there is no light. GLINT_E_MEMORY: memory is
     * short, or LAMPS have more bundles than can be held. */
    enum glint_status (*scale)(struct glint_frame *frame,
                               const struct glint_lamp *lamps, int n_lamps,
                               struct glint_frame_scale *scale);
    /* Returns the number of bundles of the last frame. */
    int (*n_bundles)(const struct glint_frame *frame);
    int (*ghost)(const struct glint_frame *frame, int bundle);
    void (*finish)(struct glint_frame *frame);
    /* Moves to FRAME what FROM, a frame with the same lens, knows of its lamps.
     * Pictures of the same lamps then take less time, of any size. */
    void (*adopt)(struct glint_frame *frame, struct glint_frame *from);
};

/* Settings from which the next picture is planned. */
struct glint_frame_picture {
    bool for_codes; /* true: a linear picture is planned as if it were in codes
                     */
    bool can_half;  /* true: the last picture was in codes */
    bool is_still; /* true: glint_frame_set_area_sampling() raised the points */
    bool uniform;  /* true: all ghosts get the same grid */
    double code_light; /* light of one of its codes near black; 0: linear */
    int point_room; /* max number of lights from the points of area lamps; used
                       if it exceeds max_lights and there are at most max_lights
                       lamps */
};

/* Limits of a frame's memory and work. */
struct glint_frame_limits {
    bool reserved;       /* true: memory must not grow */
    bool is_full;        /* true: the block has reached its limit */
    bool is_held;        /* true: the last frame was drawn coarser because of
                            most_minsn */
    int most_primitives; /* primitives that reserved memory has room for with
                            one worker */
    size_t most_bytes;   /* limit of the block for one light, if it is not
                            reserved; 0: there is none */
    double most_minsn;   /* limit of a plan for one light; 0: there is none */
    double share;        /* factor on the limits of one light for all lights */
    double tight; /* memory that the last frame's grids would have needed before
                     they were made coarser, in bytes, or in primitives if
                     reserved; 0: they were not made coarser */
    size_t tight_bytes; /* bytes that the last frame's grids would have needed
                           without being coarser */
};

/* The lights and wavelengths of the last frame. */
struct glint_frame_lights {
    struct glint_wave wave[GLINT_SET_WAVES];
    struct glint_wave_sets sets;
    struct glint_light *light; /* [capacity] */
    int n, capacity;
    int n_apart;  /* lights that can be distinguished */
    int n_beyond; /* number of lights left out before merging, as they lie
                     outside the model's range */
    int n_more;   /* number of additional points of area lamps */
    /* Factors on the lights, or NULL. */
    const int32_t (*gain_q14)[3];
    struct glint_lamp *merged; /* [n]: lamps to be traced, if some merged */
    /* [n_given]: the lamps of which those to be traced are points, while exact
     * rays are drawn */
    const struct glint_lamp *given;
    int n_given;
    bool *seen; /* [GLINT_MAX_GHOSTS]: true for ghosts in the last frame */
};

/* The last plan made from a model. */
struct glint_frame_plan {
    struct glint_flare_frame rays;
    double scale; /* factor on the lights */
    /* Number of plans, number of plans whose edges were binned, and number
     * of rays that all plans probed. */
    int n_plans, n_binned;
    long long n_looked;
};

/* Brightness of ghosts for an opening, pixels per mm and three wavelengths;
 * allocated when dim ghosts are first requested. */
struct glint_frame_dim {
    struct glint_dim table;
    double opening, size;
    struct glint_wave wave[3];
};

struct glint_frame_memory {
    struct glint_flare *flare;
    void *traced;      /* state of the trace; NULL: there is none */
    void *mem, *block; /* memory taken, or NULL; its aligned part, or the block
                          that was given */
    size_t bytes;      /* bytes of the block */
};

/* Progress at which the ghosts of a picture by exact rays are found, 0 to 1. */
#define GLINT_FRAME_FOUND 0.5

struct glint_frame {
    const struct glint_setup *setup;
    /* Model of the lens; NULL: rays come from TRACE. */
    const struct glint_lens *lens;
    const struct glint_frame_rays *trace; /* not NULL if LENS is NULL */
    glint_progress_fn *progress;          /* of traced rays; NULL: silent */
    void *progress_ctx;
    glint_clock_fn *clock; /* NULL: nothing is timed */
    struct glint_view view;
    struct glint_flare_config cfg; /* sizes, tiles, stop, reuse; the frame sets
                                      the capacities itself */
    struct glint_dials dials;      /* may be changed between frames */
    struct glint_dials asked;      /* the dials before a budget changed them */
    double apart_px; /* merge distance of lights' images, pixels */
    int only_ghost;  /* index of the only ghost drawn; -1: all ghosts */
    /* As in struct glint_flare_frame; the caller's. The exposure is chosen as
     * if there were none. */
    const struct glint_tint *tints;
    /* Further knowledge of the lamps that are drawn, or NULL. */
    const struct glint_engine_lamp *known;
    struct glint_shade shade; /* the stop's, without its finest tables */
    struct glint_frame_picture picture;
    struct glint_frame_star star;
    struct glint_frame_veil veil;
    struct glint_still still;   /* only for models that are reused */
    struct glint_budget budget; /* adjusts the dials; only for models */
    struct glint_frame_limits limits;
    struct glint_frame_lights lights;
    struct glint_frame_plan plan;
    struct glint_frame_dim dim;
    struct glint_frame_memory memory;
};

void glint_frame_init(struct glint_frame *frame,
                      const struct glint_setup *setup, struct glint_view view,
                      struct glint_workers *workers);

/* Initialises FRAME with the requested options of LIKE, without its budget. */
void glint_frame_init_like(struct glint_frame *frame,
                           const struct glint_frame *like,
                           struct glint_view view);

/* Reserves BYTES for all following frames of up to N_LAMPS lamps each,
 * merged to N_DRAWN: drawing then allocates nothing. If a frame does not
 * fit, its grids become coarser; parts that still do not fit are left out
 * and counted. MEM: the caller's BYTES, aligned to 64, or NULL to allocate
 * them. Returns GLINT_E_MEMORY if memory is short, or if BYTES are too few
 * for one light. */
enum glint_status glint_frame_reserve_memory(struct glint_frame *frame,
                                             void *mem, size_t bytes,
                                             int n_lamps, int n_drawn);

/* Returns the min BYTES that glint_frame_reserve_memory() accepts for the
 * number of lights of its last call; nothing may be drawn afterwards. */
size_t glint_frame_compute_min_bytes(struct glint_frame *frame);

/* Draws a lamp a few times to measure the time per instruction on this machine,
 * for the budget. GLINT_E_MEMORY. */
enum glint_status glint_frame_calibrate_budget(struct glint_frame *frame);

/* Adds the flare of LAMPS, times SCALE, to IMAGE. GLINT_E_MEMORY. */
enum glint_status glint_frame_draw(struct glint_frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   double scale,
                                   const struct glint_image *image,
                                   struct glint_engine_report *report);

/* Returns the last plan of FRAME, for glint_cost_of(). */
struct glint_cost_plan
glint_frame_make_cost_plan(const struct glint_frame *frame);

/* Returns whether LAMP lies outside the max angle of FRAME's model. */
bool glint_frame_is_lamp_outside_model(const struct glint_frame *frame,
                                       const struct glint_lamp *lamp);

/* Returns the max angle off the axis of FRAME's model, degrees; 89 for exact
 * rays. */
double glint_frame_max_angle_deg(const struct glint_frame *frame);

/* Sets the sampling of area lamps in the next frame. IS_STILL: a still
 * picture gets more points per lamp (if MORE_POINTS) and a larger total (if
 * MORE_LIGHTS). The first frame that is not a still restores the numbers of
 * frame->asked. */
void glint_frame_set_area_sampling(struct glint_frame *frame, bool is_still,
                                   bool more_points, bool more_lights);

/* Applies changes of cfg since memory was allocated; allocates nothing. */
void glint_frame_apply_config(struct glint_frame *frame);

/* Draws the flare of LAMPS alone, times GAIN, into RGB, [height][width][3],
 * linear light. Internally, light is scaled by a power of two that gives faint
 * light as many steps as the brightest pixel allows. If that pixel is two
 * octaves fainter than the limit, or clamped, the frame is drawn again with
 * another scale, at most four times in total. GLINT_E_MEMORY. */
enum glint_status glint_frame_draw_flare_alone(
    struct glint_frame *frame, const struct glint_lamp *lamps, int n_lamps,
    double gain, float *rgb, struct glint_engine_report *report);

void glint_frame_finish(struct glint_frame *frame);

#endif
