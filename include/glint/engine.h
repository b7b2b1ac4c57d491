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
 * This is what glint overlay and glint live draw with, for programs on machines
 * with floating point and malloc: libglint-engine.a over libglint.a. It needs
 * neither an operating system nor libglint-bake.a; the caller passes a clock.
 * Without malloc, use glint/flare.h alone.
 *
 * A picture goes through three stages: find (lamps of the picture), expose (how
 * bright their flare is) and draw. A program may change the lamps between the
 * stages, or put its own in their place. */
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

enum { GLINT_ENGINE_MAX_LAMPS = 1024 }; /* lamps found in a picture, at most */

/* ------------------------------------------------------------------- lamps */

/* A lamp of a picture. glint_engine_lamp_of() makes one that a program places.
 */
struct glint_engine_lamp {
    struct glint_lamp lamp; /* its power includes level */
    uint32_t id;            /* stays while the lamp is followed */
    /* How far it has risen, above 0, at most 1: rises and fades with the track,
     * and falls with what hides it. */
    double level;
    double share;   /* fraction of it that nothing in front hides, above 0:
                       GLINT_ENGINE_HIDDEN if all is hidden */
    double seen_px; /* RMS radius, pixels, of the spot of a lamp that the
                       picture clips; 0: the picture does not clip it; -1: the
                       picture does not show it at all */
    int is_found;   /* not 0: TRACK is what was seen of it */
    struct glint_lamp_track track;
    double excess; /* light that the lamp has above what the picture shows of
                      it; set by glint_engine_expose() */
};

/* Returns LAMP as one that is there with all its light and that the picture
 * does not clip. */
struct glint_engine_lamp glint_engine_lamp_of(const struct glint_lamp *lamp,
                                              uint32_t id);

/* ------------------------------------------------------------ configuration */

/* Lens, stop and sensor. */
struct glint_frame_rays; /* opaque: a source of rays */
struct glint_engine_camera {
    /* n_blades: sides of the stop, 3 .. 64, or 0 for a circle;
     * blade_rotation_deg: angle of its first corner; f_number: 0 for that which
     * the model was baked for, the widest allowed. */
    int n_blades;
    double blade_rotation_deg, f_number;
    double sensor_width_mm, sensor_height_mm;  /* 0: those of the model's film
                                                */
    const struct glint_projection *projection; /* copied; NULL: a pinhole's */
    /* A lens that the caller has made ready, instead of the stop above; kept,
     * and called up by glint_engine_update_stop() when it changes. NULL: the
     * engine makes one of the model. */
    const struct glint_setup *setup;
    /* What draws without a model, from the lens of SETUP: glint_frame_traces of
     * libglint-bake.a. NULL: there has to be a model. */
    const struct glint_frame_rays *rays;
    const struct glint_tint *tints; /* [ghosts of the setup]; kept; NULL: none
                                     */
    /* What lies on the front element, of glint_front_make(); kept; NULL:
     * nothing. */
    const struct glint_front_dirt *front;
};

/* How a picture is searched for lamps. */
struct glint_engine_search {
    /* In stops from the picture's white: how bright a lamp must be, and down to
     * what brightness it extends; -20 .. 0, the second no higher. */
    double threshold_ev[2];
    double headroom_ev; /* stops by which clipped pixels exceed white; below 0:
                           as the halo of each lamp tells */
    int max_found;      /* 1 .. GLINT_ENGINE_MAX_LAMPS; 0: lamps are not looked
                           for, and nothing is taken for that */
    int more_lamps; /* lamps beside those found that glint_engine_draw() may be
                       given, 0 or more */
    int max_drawn;  /* lamps that an arena has room for, beyond which they are
                       merged; 0: 2 * max_found + more_lamps, as lamps that fade
                       are drawn beside those that rise */
};

/* How bright the flare is. */
struct glint_engine_light {
    /* strength, 0 .. 100: at 0.5 its brightest part is about a quarter of
     * white, whatever the lamps and the lens; src/engine/strength.h has the
     * rule. If by_hand is not 0, exposure_ev stops are used instead. Both are
     * multiplied by gain. */
    double strength, exposure_ev, gain;
    int by_hand;
    /* Factor on the star around each lamp, of light that the stop's edges
     * diffract: 1, the default, is its physical brightness at strength 0.5 or
     * exposure 0; 0: there is no star. */
    double starburst;
    /* Fractions of all light that the lens, and dirt on its front, spread:
     * veiling glare index and haze. 0, the default: none; together at most
     * GLINT_MOST_VEIL. */
    double veil, haze;
};

/* Parts of a flare. CORES: stars are drawn with the lamps themselves, for
 * layers that no picture of the lamps lies under. CODES: light is planned as
 * for pictures of 8 bits, at about half the cost. */
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
    double budget_ms;  /* milliseconds a frame, which the engine keeps to by
                          turning the dials; 0: there is no budget */
    double most_minsn; /* limit of a frame of one light, in millions of
                          instructions, beyond which it is drawn coarser; each
                          further light adds a 16th; 0: no limit */
    double apart_px;   /* lights whose images are nearer are merged */
    int tile_log2;     /* log2 of the side of tiles, 3 .. 6 */
    int dither;        /* not 0: ordered dither in pictures of 8 bits */
    unsigned parts;    /* of enum glint_engine_part: what is drawn */
    int only_ghost;    /* index of the only ghost drawn; -1: all are */
    int is_fresh; /* not 0: plans of the picture before are never reused, even
                     if no lamp has moved */
    /* Still pictures have more points of lamps of visible extent and
     * more lights, unless these are not 0. */
    int keep_points, keep_lights;
    glint_progress_fn *progress; /* of exact rays, until the first picture is
                                    drawn; NULL: silent */
    void *progress_ctx;
};

/* Keeps measurements of lenses from one run of a program to the next. KEY tells
 * them apart; NAME is the lens's. */
struct glint_engine_cache {
    /* Reads DATA, [BYTES]; returns 0 if there is no such entry. */
    int (*read)(void *ctx, const char *name, uint64_t key, void *data,
                size_t bytes);
    void (*write)(void *ctx, const char *name, uint64_t key, const void *data,
                  size_t bytes);
    void *ctx;
};

/* Members are added at its end alone: a program made for an older library has
 * the defaults of those that it does not know. */
struct glint_engine_config {
    size_t size;       /* bytes of this struct in the program, set by
                          glint_engine_defaults() */
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    const struct glint_lens *model; /* kept; the caller sets it */
    struct glint_workers *workers;  /* kept; NULL: serial. Changes no output */
    unsigned sets; /* instruction sets, as in glint/flare.h; 0: plain C */
    glint_clock_fn *clock; /* kept; NULL: reports have no times, and no budget
                              is kept */
    struct glint_engine_camera camera;
    struct glint_engine_search search;
    struct glint_engine_light light;
    struct glint_engine_drawing drawing;

    /* Memory for drawing. If arena_bytes is 0 the engine takes exactly what a
     * frame needs, and more when a frame needs more. Else it keeps to
     * arena_bytes: without a budget grids become coarser until what is seen
     * fits, what still does not is left out and counted, and lamps are merged
     * beyond max_drawn. ARENA, aligned to 64, is kept; NULL:
     * the engine allocates it. Stars take some 50 KB for their tables and 0.3
     * KB for each of their lamps besides, once, when the engine is made, unless
     * arena_has_all is not 0: then arena_bytes is for these and a veil, too,
     * and stills take some more while they are exposed. */
    void *arena;
    size_t arena_bytes;
    int arena_has_all;

    const struct glint_engine_cache *cache; /* NULL: nothing is kept */
};

/* The first SIZE bytes of what glint_engine_defaults() sets, which programs
 * call. */
void glint_engine_defaults_sized(struct glint_engine_config *cfg, size_t size,
                                 int width, int height);

/* Sets CFG to the values that glint overlay draws with, but for straight
 * blades: its own have a roundness of 0.2, which glint_engine_iris() gives. The
 * caller still sets the model and the workers. */
static inline void glint_engine_defaults(struct glint_engine_config *cfg,
                                         int width, int height)
{
    glint_engine_defaults_sized(cfg, sizeof *cfg, width, height);
}

/* Sets what OPTIONS, of glint/options.h, say of light, drawing, search,
 * f-number, sensor and memory. All of light and drawing is set, also what no
 * option says. */
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
    int beyond_lights; /* lamps of these farther off the axis than the model
                          goes */
    int apart_lights;  /* distinct lights, at least apart_px from each other */
    int drawn_lights;  /* lights drawn, after merging because of their number */
    int ghosts, tiles; /* ghosts seen, and tiles of the picture */
    int held_samples;  /* samples of a linear picture that saturated */
    size_t arena_bytes; /* bytes that the run-time half was given */
    size_t peak_bytes;  /* bytes of these that this frame used */
    size_t need_bytes;  /* bytes that would have drawn everything in this very
                           picture, and with grids as fine as requested */
    size_t star_bytes;  /* bytes besides that stars hold, for their tables and
                           lamps, and a veil */
    int coarsened;      /* not 0: the plan passed a limit and was made coarser
                         */
    int tight;          /* not 0: that was the limit of memory */
    int plans, binned;  /* number of plans until one was within the limits and
                           had room, and of those that were binned */
    long long looked;   /* number of rays that the plans looked at */
    double plan_ms, trace_ms, bin_ms, draw_ms;
    /* Prediction and quality with a budget; else 0 and -1. */
    double predicted_ms, quality;
    struct glint_dials dials; /* dials that the budget chose */
    int blurred;  /* not 0: dust or a mask was drawn from coarser tables */
    int unveiled; /* not 0: the budget left out the veil */
    double calibrated_minsn; /* millions of instructions of the frame that
                                predictions are based on, or 0 */
    double scale;            /* factor on the powers of lamps */
};

/* ------------------------------------------------------------------- engine */

struct glint_engine; /* opaque */

/* Makes an engine; CFG is copied. Draws small pictures to measure how bright
 * flares of the lens are. With ERROR: GLINT_E_ARGUMENT, also if CFG is of a
 * newer library than this one; GLINT_E_LENS, GLINT_E_MEMORY. */
enum glint_status glint_engine_create(struct glint_engine **engine,
                                      const struct glint_engine_config *cfg,
                                      struct glint_error *error);
/* Frees ENGINE, which may be NULL. */
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

/* Changes the dials for the pictures to come, and returns those that are set:
 * with a budget, what it chose. */
void glint_engine_set_dials(struct glint_engine *engine,
                            struct glint_dials dials);
struct glint_dials glint_engine_dials(const struct glint_engine *engine);

/* Draws in the pictures to come ghost GHOST alone, by its index; -1: all. */
void glint_engine_set_only_ghost(struct glint_engine *engine, int ghost);

/* Changes the budget of an engine that has one. */
void glint_engine_set_budget(struct glint_engine *engine, double budget_ms);

/* Sets the f-number of the pictures to come, at least that which the model was
 * baked for, and, unless the exposure is by hand, measures again how bright
 * flares of the lens are. GLINT_E_ARGUMENT with ERROR: the stop stays as it is.
 * GLINT_E_MEMORY. Not for
 * an engine with a setup of the caller's. */
enum glint_status glint_engine_stop(struct glint_engine *engine,
                                    double f_number, struct glint_error *error);

/* Sets the stop of the pictures to come, as in struct glint_setup: N_BLADES, 0
 * or 3 .. 64, the angle of its first corner, and IRIS, whose mask is kept. The
 * f-number stays, and so does the exposure, as a flare is counted over the
 * light that the stop lets through. May be called before each picture: without
 * dust or a mask it takes less than a millisecond. GLINT_E_ARGUMENT with ERROR:
 * the stop stays as it is. GLINT_E_MEMORY. Not for an engine with a setup of
 * the caller's. */
enum glint_status glint_engine_iris(struct glint_engine *engine, int n_blades,
                                    double rotation_deg,
                                    const struct glint_iris *iris,
                                    struct glint_error *error);

/* Has the pictures to come drawn with the caller's setup as it is now, after
 * its stop or its model's zoom changed; the exposure stays. */
void glint_engine_update_stop(struct glint_engine *engine);

/* Sets what lies on the front element in the pictures to come: dust, scratches
 * and smudges, or a mask, which is copied. It spreads light as haze does.
 * GLINT_E_ARGUMENT with ERROR, or GLINT_E_MEMORY: all stays as it is. */
struct glint_front;
enum glint_status glint_engine_front(struct glint_engine *engine,
                                     const struct glint_front *front,
                                     struct glint_error *error);

/* --------------------------------------------------------------------- find */

/* Finds the lamps of IMAGE, in any format but GLINT_LINEAR_Q20, which comes
 * ELAPSED_US after the last picture: lamps are followed from picture to
 * picture, and rise and fade. If ELAPSED_US is 0, IMAGE is a still picture;
 * glint_engine_expose() then draws its flare small first, to see how bright it
 * is, unless there is a budget or an arena that has not all. Writes at most MAX
 * lamps, the strongest first; returns how many. */
int glint_engine_find(struct glint_engine *engine,
                      const struct glint_image *image, int32_t elapsed_us,
                      struct glint_engine_lamp *lamps, int max);

/* Begins a picture without glint_engine_find(): it comes ELAPSED_US after the
 * last one. */
void glint_engine_elapsed(struct glint_engine *engine, int32_t elapsed_us);

/* Declares a cut before the next picture: its exposure does not follow. */
void glint_engine_mark_cut(struct glint_engine *engine);

/* Forgets the lamps that were followed. */
void glint_engine_forget_lamps(struct glint_engine *engine);

/* Sets SPOT to the brightest that was not taken for a lamp in the last picture
 * that was searched, though it may be one; returns 0 if there is none. */
int glint_engine_doubtful(const struct glint_engine *engine,
                          struct glint_spot *spot);

/* Fraction of a lamp that is hidden completely: not 0, so that power over share
 * is still the power of the lamp. */
#define GLINT_ENGINE_HIDDEN 1e-18

/* Multiplies power and fraction of each of N LAMPS by the fraction that SCENE,
 * as drawn last, leaves visible, and appends the lights of SCENE that flare, at
 * most GLINT_SCENE_MAX_LIGHTS. Returns the number of lamps; *HIDDEN receives
 * how many of them are hidden completely. Only programs that call this link the
 * scene library. */
struct glint_scene;
int glint_engine_add_scene(const struct glint_engine *engine,
                           const struct glint_scene *scene,
                           struct glint_engine_lamp *lamps, int n, int *hidden);

/* Multiplies the level of each of N LAMPS by its fraction, so that the exposure
 * does not brighten what is left of hidden lamps. IS_STILL: a still
 * picture, where lamps that are hidden completely get power 0. */
void glint_engine_apply_shares(struct glint_engine_lamp *lamps, int n,
                               int is_still);

/* Returns the focal length in pixels, for scenes whose camera is the lens. */
double glint_engine_focal_px(const struct glint_engine *engine);

/* ------------------------------------------------------------ expose and draw
 */

/* Sets how bright the flare of N LAMPS is on IMAGE, of which code white is
 * WHITE, 1 but for a proxy of a picture with more light, and lowers lamps that
 * are still too bright for that. glint_engine_draw() does so by itself with
 * WHITE 1. GLINT_E_ARGUMENT, GLINT_E_MEMORY. */
enum glint_status glint_engine_expose(struct glint_engine *engine,
                                      struct glint_engine_lamp *lamps, int n,
                                      const struct glint_image *image,
                                      double white);

/* Returns how the last picture was exposed. */
const struct glint_engine_exposure *
glint_engine_exposed(const struct glint_engine *engine);

/* Adds the flare of N LAMPS, at most GLINT_ENGINE_MAX_LAMPS + more_lamps, or
 * more_lamps if none are looked for, to IMAGE: those found last or any others.
 * The exposure follows that of the picture before where the time since that is
 * known; else, as of ELAPSED_US 0, IMAGE is a still picture. N 0 leaves
 * IMAGE as it is, but for a veil. GLINT_E_ARGUMENT: IMAGE has another size, or
 * N is out of range. GLINT_E_MEMORY. */
enum glint_status glint_engine_draw(struct glint_engine *engine,
                                    struct glint_engine_lamp *lamps, int n,
                                    const struct glint_image *image,
                                    struct glint_engine_report *report);

/* Draws PARTS of the flare of the lamps that were exposed last into RGB,
 * [height][width][3], linear light, row 0 on top. The veil alone is that of the
 * picture that glint_engine_draw() drew, and has to be the first layer.
 * GLINT_E_ARGUMENT, GLINT_E_MEMORY. */
enum glint_status glint_engine_draw_layer(struct glint_engine *engine,
                                          const struct glint_engine_lamp *lamps,
                                          int n, unsigned parts, float *rgb,
                                          struct glint_engine_report *report);

/* Adds the flare of N LAMPS, times SCALE, to IMAGE, whatever the exposure. This
 * and glint_engine_render() are not for between the stages of a picture.
 * GLINT_E_ARGUMENT, GLINT_E_MEMORY. */
enum glint_status glint_engine_draw_at(struct glint_engine *engine,
                                       const struct glint_lamp *lamps, int n,
                                       double scale,
                                       const struct glint_image *image,
                                       struct glint_engine_report *report);

/* Draws PARTS of the flare of N LAMPS, which no picture shows, times GAIN into
 * RGB as glint_engine_draw_layer() does, whatever the exposure. GLINT_E_MEMORY.
 */
enum glint_status glint_engine_render(struct glint_engine *engine,
                                      const struct glint_lamp *lamps, int n,
                                      double gain, unsigned parts, float *rgb,
                                      struct glint_engine_report *report);

/* Sets LIGHT to that of the flare of N LAMPS at a factor of 1 on their powers,
 * measured in a small picture: of about 640 x 360 pixels, of which the peak is
 * the value that 1/10000 reach. GLINT_E_MEMORY. */
enum glint_status glint_engine_measure(const struct glint_engine *engine,
                                       const struct glint_engine_lamp *lamps,
                                       int n,
                                       struct glint_response_light *light);

/* Sets LIGHT to that of RGB, N pixels. */
void glint_response_around(const float *rgb, size_t n,
                           struct glint_response_light *light);

/* Returns whether light is spread over the pictures. */
int glint_engine_has_veil(const struct glint_engine *engine);

/* Returns whether LAMP is farther off the axis than the model goes. */
int glint_engine_is_beyond(const struct glint_engine *engine,
                           const struct glint_lamp *lamp);

#ifdef __cplusplus
}
#endif

#endif
