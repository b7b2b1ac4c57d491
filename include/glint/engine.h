/* SPDX-License-Identifier: MIT
 *
 * glint/engine.h - pictures in, pictures with flares out: lamps are found and
 * followed, and their ghosts drawn behind a lens at a suitable exposure.
 *
 *     glint_engine_defaults(&cfg, width, height);           once
 *     cfg.model = &lens;                                    glint_lens_open()
 *     glint_engine_create(&engine, &cfg, &error);
 *     n = glint_engine_find(engine, &image, elapsed_us, lamps, max);
 *     glint_engine_draw(engine, lamps, n, &image, &report);  each picture
 *     glint_engine_destroy(engine);
 *
 * The engine of glint overlay and glint live, for programs with floating point
 * and malloc: libglint-engine.a on top of libglint.a. It needs neither an
 * operating system nor libglint-bake.a; the caller passes a clock. Without
 * malloc, use glint/flare.h alone.
 *
 * A picture goes through three stages: find (detect and follow lamps), expose
 * (choose the brightness of the flare) and draw. A program may change the lamps
 * between the stages, or replace them. */
#ifndef GLINT_ENGINE_H
#define GLINT_ENGINE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/dials.h"
#include "glint/flare.h"
#include "glint/image.h"
#include "glint/lamp_tracker.h"
#include "glint/model.h"
#include "glint/setup.h"
#include "glint/status.h"
#include "glint/view.h"
#include "glint/workers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns seconds since any moment; never falls. */
typedef double glint_clock_fn(void);

enum { GLINT_ENGINE_MAX_LAMPS = 1024 }; /* max lamps found in a picture */

/* ------------------------------------------------------------------- lamps */

/* A lamp of a picture. glint_engine_lamp_of() makes one for a program.
 */
struct glint_engine_lamp {
    struct glint_lamp lamp; /* its power includes level */
    uint32_t id;            /* constant while the lamp is followed */
    /* Level, above 0, at most 1: rises and fades with the track, and falls
     * while something hides the lamp. */
    double level;
    double share;   /* visible fraction, above 0: GLINT_ENGINE_HIDDEN if all is
                       hidden */
    double seen_px; /* RMS radius, pixels, of the spot of a lamp that the
                       picture clips; 0: not clipped; -1: the picture does not
                       show the lamp */
    int is_found;   /* not 0: TRACK is the lamp's track */
    struct glint_lamp_track track;
    double excess; /* light of the lamp in excess of what the picture shows; set
                      by glint_engine_expose() */
};

/* Returns LAMP at full level, as if the picture did not clip it. */
struct glint_engine_lamp glint_engine_lamp_of(const struct glint_lamp *lamp,
                                              uint32_t id);

/* ------------------------------------------------------------ configuration */

/* Lens, stop and sensor. */
struct glint_frame_rays; /* opaque: a source of rays */
struct glint_engine_camera {
    /* n_blades: sides of the stop, 3 .. 64, or 0 for a circle;
     * blade_rotation_deg: angle of its first corner; f_number: 0 for the
     * model's, its widest opening. */
    int n_blades;
    double blade_rotation_deg, f_number;
    double sensor_width_mm,
        sensor_height_mm; /* sensor size, mm; 0: size of the model's film */
    const struct glint_projection
        *projection; /* copied; NULL: pinhole projection */
    /* A setup of the caller instead of the stop above; must outlive the engine.
     * The caller calls glint_engine_update_stop() when it changes. NULL: the
     * engine makes one from the model. */
    const struct glint_setup *setup;
    /* Source of rays without a model, for the lens of SETUP:
     * glint_frame_traces of libglint-bake.a. NULL: a model is required. */
    const struct glint_frame_rays *rays;
    const struct glint_tint *tints; /* [ghosts of the setup], or NULL; must
                                       outlive the engine */
    /* Dirt on the front element, from glint_front_make(), or NULL; must outlive
     * the engine. */
    const struct glint_front_dirt *front;
};

/* How a picture is searched for lamps. */
struct glint_engine_search {
    /* Thresholds in stops from the picture's white, -20 .. 0: a lamp must
     * reach the first, and extends down to the second, which is not higher. */
    double threshold_ev[2];
    double headroom_ev; /* stops by which clipped pixels exceed white; below 0:
                           estimated from the halo of each lamp */
    int max_found;  /* 1 .. GLINT_ENGINE_MAX_LAMPS; 0: no search, and no memory
                       for it */
    int more_lamps; /* lamps besides those found that glint_engine_draw() may be
                       given, 0 or more */
    int max_drawn;  /* lamps that an arena has capacity for; more are merged. 0:
                       2 * max_found + more_lamps, as fading lamps are drawn
                       besides rising ones */
};

/* How bright the flare is. */
struct glint_engine_light {
    /* strength, 0 .. 100: at 0.5 the brightest part of the flare is about a
     * quarter of white, whatever lamps and lens; src/engine/strength.h has
     * the rule. If by_hand is not 0, exposure_ev in stops is used instead.
     * Both are multiplied by gain. */
    double strength, exposure_ev, gain;
    int by_hand;
    /* Factor on the star around each lamp (light that the stop's edges
     * diffract): 1, the default: its physical brightness at strength 0.5 or
     * exposure 0; 0: no star. */
    double starburst;
    /* Veiling glare index and haze: the fractions of all light that the
     * lens, and dirt on its front, scatter. 0, the default: none; together
     * at most GLINT_MOST_VEIL. */
    double veil, haze;
};

/* Parts of a flare. CORES: stars include the lamps' cores, for layers
 * without the picture. CODES: light is planned as for pictures of 8 bits, at
 * about half the cost. */
enum glint_engine_part {
    GLINT_ENGINE_GHOSTS = 1,
    GLINT_ENGINE_STAR = 2,
    GLINT_ENGINE_VEIL = 4,
    GLINT_ENGINE_ALL = 7,
    GLINT_ENGINE_CORES = 8,
    GLINT_ENGINE_CODES = 16
};

/* How it is drawn. */
struct glint_engine_drawing {
    struct glint_dials dials;
    double budget_ms;  /* milliseconds per frame, which the engine holds by
                          adjusting the dials; 0: no budget */
    double most_minsn; /* limit of a frame of one light, in millions of
                          instructions, above which it is drawn coarser; each
                          further light adds a 16th; 0: no limit */
    double apart_px;   /* merge distance: lights whose images are nearer are
                          merged */
    int tile_log2;     /* log2 of the side of tiles, 3 .. 6 */
    int dither;        /* not 0: ordered dither in pictures of 8 bits */
    unsigned parts;    /* of enum glint_engine_part: what is drawn */
    int only_ghost;    /* index of the only ghost drawn; -1: all ghosts */
    int is_fresh; /* not 0: the previous plan is never reused, even if no lamp
                     has moved */
    /* Limits of still pictures, which have more points per wide lamp and
     * more lights by default; 0: defaults. */
    int keep_points, keep_lights;
    glint_progress_fn *progress; /* of exact rays, until the first picture is
                                    drawn; NULL: silent */
    void *progress_ctx;
};

/* Caches measurements of lenses between runs of a program. KEY identifies
 * the entry; NAME is the lens's. */
struct glint_engine_cache {
    /* Reads DATA, [BYTES]; returns 0 if there is no entry of that NAME and
     * KEY. */
    int (*read)(void *ctx, const char *name, uint64_t key, void *data,
                size_t bytes);
    void (*write)(void *ctx, const char *name, uint64_t key, const void *data,
                  size_t bytes);
    void *ctx;
};

/* New members are added only at the end: a program built with an older
 * library gets the defaults of those it does not know. */
struct glint_engine_config {
    size_t size;       /* sizeof this struct in the program, set by
                          glint_engine_defaults() */
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    const struct glint_lens *model; /* must outlive the engine; the caller sets
                                       it */
    struct glint_workers *workers;  /* must outlive the engine; NULL: one
                                       thread. The output is the same for any
                                       number of threads */
    unsigned sets; /* instruction sets, as in glint/flare.h; 0: plain C */
    glint_clock_fn *clock; /* may be NULL: then reports have no times, and no
                              budget is held */
    struct glint_engine_camera camera;
    struct glint_engine_search search;
    struct glint_engine_light light;
    struct glint_engine_drawing drawing;

    /* Memory for drawing. If arena_bytes is 0, the engine allocates what a
     * frame needs, and more when a frame needs more. Otherwise arena_bytes
     * is the limit: without a budget, grids become coarser until the visible
     * ghosts fit; what still does not fit is left out and counted; lamps
     * above max_drawn are merged. ARENA, aligned to 64, is kept; NULL: the
     * engine allocates it. Stars need about 50 KB for tables and 0.3 KB per
     * lamp in addition, once, when the engine is made. If arena_has_all is
     * not 0, arena_bytes includes these and a veil, and still pictures need
     * more while they are exposed. */
    void *arena;
    size_t arena_bytes;
    int arena_has_all;

    const struct glint_engine_cache *cache; /* NULL: no cache */
};

/* Sets the first SIZE bytes of the defaults; programs call
 * glint_engine_defaults(). */
void glint_engine_defaults_sized(struct glint_engine_config *cfg, size_t size,
                                 int width, int height);

/* Sets CFG to the defaults of glint overlay, except for straight blades: blades
 * of overlay have a roundness of 0.2, see glint_engine_iris(). The caller still
 * sets the model and the workers. */
static inline void glint_engine_defaults(struct glint_engine_config *cfg,
                                         int width, int height)
{
    glint_engine_defaults_sized(cfg, sizeof *cfg, width, height);
}

/* Sets the members of CFG for light, drawing, search, f-number, sensor and
 * memory from OPTIONS (glint/options.h). Members of light and drawing
 * without a set option get the option's default. */
struct glint_options;
void glint_engine_configure(struct glint_engine_config *cfg,
                            const struct glint_options *options);

/* ------------------------------------------------------------------ reports */

/* Light of a flare alone, without the picture: linear R, G, B, 1 = display
 * white. */
struct glint_response_light {
    double peak[3]; /* mean of the brightest 1/1000 of the pixels, of 46 pixels
                       at most */
    double mean[3]; /* mean of all pixels */
};

/* How the last picture was exposed. */
struct glint_engine_exposure {
    double scale; /* factor on the powers of lamps; 0: nothing is drawn */
    struct glint_response_light light; /* of the flare, with that factor */
    int is_drawn; /* not 0: the light was measured in a drawn flare */
    int is_new;   /* not 0: lamps and exposure restart, as after a cut */
};

struct glint_engine_report {
    struct glint_flare_stats stats;
    int lights;        /* lamps given */
    int beyond_lights; /* lamps farther off the axis than the model's range */
    int apart_lights;  /* distinct lights, at least apart_px from each other */
    int drawn_lights;  /* lights drawn, after merging because of their number */
    int ghosts, tiles; /* ghosts seen, and tiles of the picture */
    int held_samples;  /* samples of a linear picture that saturated */
    size_t arena_bytes; /* bytes of memory given to the run-time half */
    size_t peak_bytes;  /* bytes of these that this frame used */
    size_t need_bytes;  /* bytes that would have drawn everything in this
                           picture, with grids as fine as requested */
    size_t star_bytes; /* additional bytes of stars, for their tables and lamps,
                          and of a veil */
    int coarsened;     /* not 0: the plan passed a limit and was made coarser
                        */
    int tight;         /* not 0: that was the limit of memory */
    int plans, binned; /* number of plans until one was within the limits and
                          fitted, and of those that were binned */
    long long looked;  /* number of rays that the plans looked at */
    double plan_ms, trace_ms, bin_ms, draw_ms;
    /* Prediction and quality with a budget; otherwise 0 and -1. */
    double predicted_ms, quality;
    struct glint_dials dials; /* dials that the budget chose */
    int blurred;  /* not 0: dust or a mask was drawn with coarser tables */
    int unveiled; /* not 0: the budget left out the veil */
    double calibrated_minsn; /* millions of instructions of the frame that
                                predictions are based on, or 0 */
    double scale;            /* factor on the powers of lamps */
};

/* ------------------------------------------------------------------- engine */

struct glint_engine; /* opaque */

/* Makes an engine; CFG is copied. Draws small pictures to measure the
 * brightness of the lens's flares. With ERROR: GLINT_E_ARGUMENT, also if CFG
 * is of a newer library than this one; GLINT_E_LENS, GLINT_E_MEMORY. */
enum glint_status glint_engine_create(struct glint_engine **engine,
                                      const struct glint_engine_config *cfg,
                                      struct glint_error *error);
/* Frees ENGINE, or does nothing if ENGINE is NULL. */
void glint_engine_destroy(struct glint_engine *engine);

/* Returns where the pictures lie on the sensor. */
const struct glint_view *glint_engine_view(const struct glint_engine *engine);

/* Set option NAME of glint/options.h for the pictures to come, to a number or
 * to a text as on a command line: strength or exposure, of which the last one
 * counts, gain, starburst, f-number as glint_engine_stop(). GLINT_E_ARGUMENT
 * with ERROR: there is no such option, it does not accept the value, or it is
 * fixed when an engine is made; the engine stays as it is. GLINT_E_MEMORY. */
enum glint_status glint_engine_set(struct glint_engine *engine,
                                   const char *name, double value,
                                   struct glint_error *error);
enum glint_status glint_engine_set_text(struct glint_engine *engine,
                                        const char *name, const char *text,
                                        struct glint_error *error);

/* Sets the light of the pictures to come. */
void glint_engine_set_light(struct glint_engine *engine,
                            const struct glint_engine_light *light);

/* Changes the dials of the following pictures, and returns the dials in use:
 * with a budget, the dials it chose. */
void glint_engine_set_dials(struct glint_engine *engine,
                            struct glint_dials dials);
struct glint_dials glint_engine_dials(const struct glint_engine *engine);

/* Draws only ghost GHOST in the following pictures, by its index; -1: all. */
void glint_engine_set_only_ghost(struct glint_engine *engine, int ghost);

/* Changes the budget of an engine that has one. */
void glint_engine_set_budget(struct glint_engine *engine, double budget_ms);

/* Sets the f-number of the following pictures, at least the model's, and,
 * unless the exposure is by hand, measures the brightness of the lens's flares
 * again. GLINT_E_ARGUMENT with ERROR: the stop stays as it is. GLINT_E_MEMORY.
 * Not for an engine with a setup of the caller. */
enum glint_status glint_engine_stop(struct glint_engine *engine,
                                    double f_number, struct glint_error *error);

/* Sets the stop of the following pictures, as in struct glint_setup:
 * N_BLADES, 0 or 3 .. 64, the angle of its first corner, and IRIS, whose
 * mask is kept. F-number and exposure stay: a flare's light is relative to
 * the light that the stop transmits. May be called before each picture:
 * without dust or a mask it costs less than a millisecond. GLINT_E_ARGUMENT
 * with ERROR: the stop stays as it is. GLINT_E_MEMORY. Not for an engine
 * with a setup of the caller. */
enum glint_status glint_engine_iris(struct glint_engine *engine, int n_blades,
                                    double rotation_deg,
                                    const struct glint_iris *iris,
                                    struct glint_error *error);

/* Reads the caller's setup again for the following pictures, after its stop
 * or its model's zoom changed; the exposure stays. */
void glint_engine_update_stop(struct glint_engine *engine);

/* --------------------------------------------------------------------- find */

/* Finds the lamps of IMAGE, in any format but GLINT_LINEAR_Q20, which comes
 * ELAPSED_US after the last picture. Lamps are followed from picture to
 * picture, and rise and fade. ELAPSED_US 0: IMAGE is a still picture;
 * glint_engine_expose() then first draws its flare at reduced size to
 * measure its brightness, unless there is a budget or an arena without
 * arena_has_all. Writes at most MAX lamps, the strongest first; returns
 * their number. */
int glint_engine_find(struct glint_engine *engine,
                      const struct glint_image *image, int32_t elapsed_us,
                      struct glint_engine_lamp *lamps, int max);

/* Begins a picture without a search; it comes ELAPSED_US after the last one. */
void glint_engine_elapsed(struct glint_engine *engine, int32_t elapsed_us);

/* Declares a cut before the next picture: its exposure restarts. */
void glint_engine_mark_cut(struct glint_engine *engine);

/* Forgets the lamps that were followed. */
void glint_engine_forget_lamps(struct glint_engine *engine);

/* Sets SPOT to region I, from 0, the brightest first, of those that were
 * rejected as lamps in the last picture searched, though they may be some, with
 * the reason; returns 0 if there are no so many. */
int glint_engine_doubtful(const struct glint_engine *engine, int i,
                          struct glint_spot *spot);

/* Visible fraction of a completely hidden lamp: not 0, so that power / share
 * is still the power of the lamp. */
#define GLINT_ENGINE_HIDDEN 1e-18

/* Multiplies power and share of each of N LAMPS by the fraction that SCENE,
 * as drawn last, leaves visible, and appends the lights of SCENE that flare,
 * at most GLINT_SCENE_MAX_LIGHTS. Returns the number of lamps; *HIDDEN
 * receives the number of completely hidden ones. Only programs that call
 * this link the scene library. */
struct glint_scene;
int glint_engine_add_scene(const struct glint_engine *engine,
                           const struct glint_scene *scene,
                           struct glint_engine_lamp *lamps, int n, int *hidden);

/* Multiplies the level of each of N LAMPS by its share, so that the exposure
 * does not brighten partly hidden lamps. IS_STILL: a still picture, where
 * completely hidden lamps get power 0. */
void glint_engine_apply_shares(struct glint_engine_lamp *lamps, int n,
                               int is_still);

/* Returns the focal length in pixels, for scenes whose camera is the lens. */
double glint_engine_focal_px(const struct glint_engine *engine);

/* ------------------------------------------------------------ expose and draw
 */

/* Sets the brightness of the flare of N LAMPS on IMAGE, whose code white is
 * WHITE (1, except for a proxy of a picture with more light), and reduces
 * lamps that are still too bright for that. glint_engine_draw() calls it
 * with WHITE 1 if the program did not. GLINT_E_ARGUMENT, GLINT_E_MEMORY. */
enum glint_status glint_engine_expose(struct glint_engine *engine,
                                      struct glint_engine_lamp *lamps, int n,
                                      const struct glint_image *image,
                                      double white);

/* Returns the exposure of the last picture. */
const struct glint_engine_exposure *
glint_engine_exposed(const struct glint_engine *engine);

/* Adds the flare of N LAMPS to IMAGE, those found last or any others: at
 * most GLINT_ENGINE_MAX_LAMPS + more_lamps, or more_lamps without a search.
 * The exposure continues from the previous picture if the time since then is
 * known; otherwise IMAGE is a still picture, as with ELAPSED_US 0. N 0
 * leaves IMAGE unchanged, except for a veil. GLINT_E_ARGUMENT: IMAGE has
 * another size, or N is out of range. GLINT_E_MEMORY. */
enum glint_status glint_engine_draw(struct glint_engine *engine,
                                    struct glint_engine_lamp *lamps, int n,
                                    const struct glint_image *image,
                                    struct glint_engine_report *report);

/* Draws PARTS of the flare of the lamps exposed last into RGB,
 * [height][width][3], linear light, row 0 on top. The veil is of the picture
 * that glint_engine_draw() drew, and must be the first layer. GLINT_E_ARGUMENT,
 * GLINT_E_MEMORY. */
enum glint_status glint_engine_draw_layer(struct glint_engine *engine,
                                          const struct glint_engine_lamp *lamps,
                                          int n, unsigned parts, float *rgb,
                                          struct glint_engine_report *report);

/* Adds the flare of N LAMPS, times SCALE, to IMAGE, whatever the exposure.
 * Must not be called between the stages of a picture, nor must
 * glint_engine_render(). GLINT_E_ARGUMENT, GLINT_E_MEMORY. */
enum glint_status glint_engine_draw_at(struct glint_engine *engine,
                                       const struct glint_lamp *lamps, int n,
                                       double scale,
                                       const struct glint_image *image,
                                       struct glint_engine_report *report);

/* Draws PARTS of the flare of N LAMPS without a picture, times GAIN, into
 * RGB as glint_engine_draw_layer() does, whatever the exposure.
 * GLINT_E_MEMORY.
 */
enum glint_status glint_engine_render(struct glint_engine *engine,
                                      const struct glint_lamp *lamps, int n,
                                      double gain, unsigned parts, float *rgb,
                                      struct glint_engine_report *report);

/* Sets LIGHT to the light of the flare of N LAMPS at a factor of 1 on their
 * powers, measured in a picture of about 640 x 360 pixels. The peak is the
 * 99.99th percentile. GLINT_E_MEMORY. */
enum glint_status glint_engine_measure(const struct glint_engine *engine,
                                       const struct glint_engine_lamp *lamps,
                                       int n,
                                       struct glint_response_light *light);

/* Sets LIGHT to the light of RGB, N pixels. */
void glint_response_around(const float *rgb, size_t n,
                           struct glint_response_light *light);

/* Returns whether veil or haze is drawn. */
int glint_engine_has_veil(const struct glint_engine *engine);

#ifdef __cplusplus
}
#endif

#endif
