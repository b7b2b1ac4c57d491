/* SPDX-License-Identifier: MIT
 *
 * Draws the flare of a frame: converts lamps to lights, plans the frame, and
 * calls the integer renderer (glint/flare.h).
 *
 *     glint_frame_init(&frame, &setup, view, workers);    then set options
 *     glint_frame_draw(&frame, lamps, n, scale, &image, &report);
 *     glint_frame_finish(&frame);
 *
 * The integer renderer gets one block of memory. It grows to the size that the
 * most demanding frame so far has needed. */
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

/* distance between the images of two lights, pixels, below which they are
 * merged; the error of a model is larger */
#define GLINT_FRAME_APART_PX 0.125
/* max step of brightness from one wavelength to the next that is invisible,
 * codes */
#define GLINT_FRAME_STEP_CODES 2.0

/* Default limits of a frame with one light that is drawn by a model: memory in
 * bytes, and work in millions of instructions (glint_cost_convert_to_minsn()),
 * about ten seconds on one processor. Each further light raises both limits by
 * 1 / GLINT_FRAME_PER_LIGHT. */
#define GLINT_FRAME_MOST_BYTES ((size_t)384 << 20)
#define GLINT_FRAME_MOST_MINSN 30000.0
#define GLINT_FRAME_PER_LIGHT  16

struct glint_frame;
struct glint_account;

/* Receives ACCOUNT, the statistics of the rays of GHOST for LIGHT: whether they
 * were drawn or why not, and their work. Both are indices in the frame. */
typedef void glint_frame_account_fn(void *ctx, int ghost, int light,
                                    const struct glint_account *account);

/* Factors by which the light of a flare is scaled before it is drawn in fixed
 * point, as log2. */
struct glint_frame_scale {
    int likely; /* brings the mean of the brightest ghost to about 32 times
                   display white, as single pixels may reach 2048 times white */
    int most;   /* max factor without clamping: the sum of all light stays below
                   2^24 times white */
};

/* Computes the scales from log2 of the brightest ghost's mean light and log2 of
 * the total flux of all ghosts. */
struct glint_frame_scale glint_frame_compute_scale(int brightest_log2,
                                                   int together_log2);

/* Functions that draw with another source of rays than a model: exact rays. */
struct glint_frame_rays {
    /* Draws a frame. TIMES receives the clock, in seconds, before planning,
     * tracing, binning and drawing, and after drawing. */
    enum glint_status (*draw)(struct glint_frame *frame,
                              const struct glint_lamp *lamps, int n_lamps,
                              double scale, const struct glint_image *image,
                              struct glint_flare_stats *stats, double times[5]);
    /* Predicts SCALE for LAMPS, or sets it to {0, 0} if there is no light.
     * Returns GLINT_E_MEMORY if memory is short or LAMPS have too many ray
     * bundles. */
    enum glint_status (*scale)(struct glint_frame *frame,
                               const struct glint_lamp *lamps, int n_lamps,
                               struct glint_frame_scale *scale);
    /* Returns the number of ray bundles of the last frame. */
    int (*n_bundles)(const struct glint_frame *frame);
    int (*ghost)(const struct glint_frame *frame, int bundle);
    void (*finish)(struct glint_frame *frame);
    /* Moves the cached rays of FROM to FRAME, a frame with the same lens. So
     * pictures of the same lamps, in any size, take less time. */
    void (*adopt)(struct glint_frame *frame, struct glint_frame *from);
    /* Calls REPORT for all pairs of a ghost and a light of the last frame. */
    void (*account)(const struct glint_frame *frame,
                    glint_frame_account_fn *report, void *ctx);
    /* Adds to IMAGE the part of the last frame that belongs to GHOST and LIGHT;
     * each may be -1 for all. */
    enum glint_status (*draw_part)(struct glint_frame *frame, int ghost,
                                   int light, const struct glint_image *image);
};

/* Settings with which the next picture is planned. */
struct glint_frame_picture {
    bool for_codes;    /* true: linear pictures are planned as if they had 8-bit
                          codes */
    bool can_half;     /* true: the last picture had 8-bit codes, so half
                          resolution is possible */
    bool is_still;     /* true: glint_frame_set_area_sampling() has raised the
                          number of points for a still picture */
    bool uniform;      /* true: all ghosts get grids of the same fineness */
    double code_light; /* linear light of one code near black; 0: the picture is
                          linear */
    int point_room;    /* max number of lights including the sample points of
                          area lamps; replaces a smaller max_lights in frames of
                          up to max_lights lamps */
};

/* Limits of the memory and the work of a frame. */
struct glint_frame_limits {
    bool reserved;       /* true: memory was reserved and must not grow */
    bool is_full;        /* true: the memory block has reached its limit */
    bool is_held;        /* true: a limit has reduced the quality of the last
                            frame */
    int most_primitives; /* number of edges (primitives) that fit into the
                            reserved memory with one worker */
    size_t most_bytes;   /* max size of a block that is not reserved, in bytes,
                            for a frame with one light; 0: no limit */
    double most_minsn;   /* max cost of a frame with one light, millions of
                            instructions; 0: no limit */
    double share;        /* limits for all lights of the frame / limits for one
                            light */
    /* memory that the last frame needed before its grids were last made
     * coarser; in bytes, or in edges if memory is reserved; 0: grids were not
     * made coarser */
    double tight;
    size_t tight_bytes; /* bytes that the last frame would have needed with its
                           original grids */
};

/* The lights and wavelengths of the last frame. */
struct glint_frame_lights {
    struct glint_wave wave[GLINT_SET_WAVES];
    struct glint_wave_sets sets;
    struct glint_light *light; /* [capacity] */
    int n, capacity;
    int n_apart;  /* number of lights after merging those too close to be
                     distinguished */
    int n_beyond; /* number of lamps skipped because they lie outside the
                     model's range of angles */
    int n_more;   /* number of additional points of area lamps */
    /* [n]: factors on the colours of the lights, or NULL */
    const int32_t (*gain_q14)[3];
    struct glint_lamp *merged; /* [n]: the lamps for which exact rays are
                                  traced, if lamps were sampled or merged */
    /* [n_given]: the lamps before sampling and merging; valid while exact rays
     * are drawn */
    const struct glint_lamp *given;
    int n_given;
    bool *seen; /* [GLINT_MAX_GHOSTS]: true for ghosts that the last frame has
                   drawn */
};

/* The last plan made from a model. */
struct glint_frame_plan {
    struct glint_flare_frame rays;
    double scale; /* factor on the powers of the lights */
    /* n_plans: number of plans of this frame. n_binned: number of plans whose
     * edges were binned. n_looked: number of rays that all plans have
     * probed. */
    int n_plans, n_binned;
    long long n_looked;
};

/* Table of the brightness of ghosts (flare/dim.h). It is valid for one opening
 * of the stop, one number of pixels per mm (size) and three wavelengths.
 * Allocated when dim ghosts are first drawn with shared rays. */
struct glint_frame_dim {
    struct glint_dim table;
    double opening, size;
    struct glint_wave wave[3];
};

struct glint_frame_memory {
    struct glint_flare *flare;
    void *traced;      /* state of the exact rays, or NULL */
    void *mem, *block; /* mem: allocated memory, or NULL if the caller provided
                          it; block: the aligned part of it that is in use */
    size_t bytes;      /* size of BLOCK, bytes */
};

/* Progress, 0 to 1, that is reported when exact rays have found the ghosts of a
 * picture. The remaining progress is for drawing. */
#define GLINT_FRAME_FOUND 0.5

struct glint_frame {
    const struct glint_setup *setup;
    /* model of the lens; NULL: exact rays are traced by the functions TRACE */
    const struct glint_lens *lens;
    const struct glint_frame_rays *trace; /* functions that draw with exact
                                             rays; not NULL if LENS is NULL */
    glint_progress_fn *progress;          /* reports the progress of exact rays,
                                             or NULL */
    void *progress_ctx;
    glint_clock_fn *clock; /* returns the time in seconds; NULL: no times are
                              measured */
    struct glint_view view;
    struct glint_flare_config cfg; /* configuration of the flare: the caller
                                      sets sizes, tiles, stop and reuse, the
                                      frame sets capacities */
    struct glint_dials dials;      /* quality parameters in use; may be changed
                                      between frames */
    struct glint_dials asked;      /* quality parameters that the caller
                                      requested, before a budget changes them */
    double apart_px; /* distance between the images of two lights, pixels, below
                        which they are merged */
    int only_ghost;  /* index of the only ghost drawn; -1: all ghosts */
    /* [ghost]: factors on the light of each ghost (struct glint_flare_frame),
     * owned by the caller; ignored when the exposure is chosen */
    const struct glint_tint *tints;
    /* the drawn lamps with the engine's data about them (track, visibility), in
     * the order of drawing; NULL: no such data */
    const struct glint_engine_lamp *known;
    struct glint_shade shade; /* transmission of the stop, without its finest
                                 mip levels, which the current quality does not
                                 use */
    struct glint_frame_picture picture;
    struct glint_frame_star star;
    struct glint_frame_veil veil;
    struct glint_still still; /* lights whose rays are reused while they hardly
                                 move; for models only */
    struct glint_budget budget; /* chooses quality parameters that fit a time
                                   per frame; for models only */
    struct glint_frame_limits limits;
    struct glint_frame_lights lights;
    struct glint_frame_plan plan;
    struct glint_frame_dim dim;
    struct glint_frame_memory memory;
};

void glint_frame_init(struct glint_frame *frame,
                      const struct glint_setup *setup, struct glint_view view,
                      struct glint_workers *workers);

/* Initialises FRAME for VIEW, with all options of frame LIKE except the
 * budget. */
void glint_frame_init_like(struct glint_frame *frame,
                           const struct glint_frame *like,
                           struct glint_view view);

/* Reserves BYTES bytes for all following frames of up to N_LAMPS lamps, which
 * are merged to N_DRAWN lights. Drawing then allocates nothing. If a frame does
 * not fit, its grids become coarser. Ray bundles that still do not fit are
 * counted, but not drawn. MEM: a block of BYTES, aligned to 64, or NULL to
 * allocate one. Returns GLINT_E_MEMORY if memory is short, or if BYTES does not
 * suffice for one light. */
enum glint_status glint_frame_reserve_memory(struct glint_frame *frame,
                                             void *mem, size_t bytes,
                                             int n_lamps, int n_drawn);

/* Returns the min BYTES that glint_frame_reserve_memory() accepts for the
 * number of lights of its last call. The frame cannot be drawn afterwards, as
 * this function changes its capacities. */
size_t glint_frame_compute_min_bytes(struct glint_frame *frame);

/* Draws one lamp a few times, and measures the time per predicted instruction
 * on this machine for the budget. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_calibrate_budget(struct glint_frame *frame);

/* Adds the flare of LAMPS to IMAGE, and sets REPORT. SCALE is a factor on the
 * powers of the lamps. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_frame_draw(struct glint_frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   double scale,
                                   const struct glint_image *image,
                                   struct glint_engine_report *report);

/* Returns the last plan of FRAME as input of the cost model
 * (glint_cost_of()). */
struct glint_cost_plan
glint_frame_make_cost_plan(const struct glint_frame *frame);

/* Returns whether LAMP lies outside the max angle of FRAME's model. */
bool glint_frame_is_lamp_outside_model(const struct glint_frame *frame,
                                       const struct glint_lamp *lamp);

/* Returns the max angle of a light off the axis in FRAME's model, degrees; 89
 * for exact rays. */
double glint_frame_get_max_angle_deg(const struct glint_frame *frame);

/* Sets the number of points that sample area lamps in the next frame. If
 * IS_STILL, the frame is a still picture: it gets more points per lamp if
 * MORE_POINTS, and more points in total if MORE_LIGHTS. Otherwise it gets the
 * requested numbers of frame->asked. */
void glint_frame_set_area_sampling(struct glint_frame *frame, bool is_still,
                                   bool more_points, bool more_lights);

/* Initialises the flare again with the current cfg, in the memory block that
 * the frame already has. */
void glint_frame_apply_config(struct glint_frame *frame);

/* Draws the flare of LAMPS without a picture: sets RGB, [height][width][3], to
 * the flare's linear light times GAIN. To resolve faint light finely, light is
 * scaled by the largest power of two that the brightest pixel allows. If that
 * pixel is clamped, or two octaves below the limit, the frame is drawn again
 * with another scale, at most four times in total. Returns GLINT_E_MEMORY on
 * failure. */
enum glint_status glint_frame_draw_flare_alone(
    struct glint_frame *frame, const struct glint_lamp *lamps, int n_lamps,
    double gain, float *rgb, struct glint_engine_report *report);

void glint_frame_finish(struct glint_frame *frame);

#endif
