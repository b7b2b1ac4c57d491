/* SPDX-License-Identifier: MIT
 *
 * glint/engine.h - adds lens flares to pictures: finds and tracks the lamps in
 * each picture, chooses an exposure, and draws the lamps' ghosts.
 *
 *     glint_engine_defaults(&cfg, width, height);           once
 *     cfg.model = &lens;                                    glint_lens_open()
 *     glint_engine_create(&engine, &cfg, &error);
 *     n = glint_engine_find(engine, &image, elapsed_us, lamps, max);
 *     glint_engine_draw(engine, lamps, n, &image, &report);  each picture
 *     glint_engine_destroy(engine);
 *
 * The programs glint overlay and glint live use this engine. It needs floating
 * point and malloc: libglint-engine.a on top of libglint.a. It needs neither an
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

/* Returns the time in seconds since an arbitrary moment; must never
 * decrease. */
typedef double glint_clock_fn(void);

enum { GLINT_ENGINE_MAX_LAMPS = 1024 }; /* max lamps found in a picture */

/* ------------------------------------------------------------------- lamps */

/* A lamp of a picture: found by glint_engine_find(), or made by the program
 * with glint_engine_lamp_of(). */
struct glint_engine_lamp {
    /* The lamp. Its power is already multiplied by level. */
    struct glint_lamp lamp;
    uint32_t id; /* number of the lamp, constant while it is
                    tracked */
    /* Factor that fades the lamp in and out, above 0, at most 1; already
     * multiplied into its power. It rises when tracking begins and falls when
     * the lamp vanishes. glint_engine_apply_shares() lowers it for partly
     * hidden lamps. */
    double level;
    /* Visible fraction of the lamp, above 0. GLINT_ENGINE_HIDDEN stands for a
     * completely hidden lamp. */
    double share;
    /* RMS radius of the lamp's spot, pixels, if the lamp is clipped in the
     * picture. 0: the lamp is not clipped; -1: the lamp is not in the
     * picture. */
    double seen_px;
    /* 1: the lamp was found in a picture, and TRACK is its track; else 0. */
    int is_found;
    struct glint_lamp_track track;
    /* Light of the lamp that the picture does not show because pixels are
     * clipped; set by glint_engine_expose(). */
    double excess;
};

/* Returns LAMP with full level, fully visible and not clipped by the
 * picture. */
struct glint_engine_lamp glint_engine_lamp_of(const struct glint_lamp *lamp,
                                              uint32_t id);

/* ------------------------------------------------------------ configuration */

struct glint_frame_rays; /* opaque: traces exact rays */
/* Opaque: computes the shape of the stop, and the dirt on the front element. */
struct glint_engine_stops;

/* Code for dust, for masks and for stops whose blades are not straight and
 * clean. Programs that name this variable link the code. */
extern const struct glint_engine_stops glint_engine_all_stops;

/* Lens, stop and sensor. */
struct glint_engine_camera {
    /* Number of blades of the stop, 3 .. 64, or 0 for a circle; angle of the
     * stop's first corner, degrees; f-number, where 0 selects the f-number of
     * the model, which is the widest opening. */
    int n_blades;
    double blade_rotation_deg, f_number;
    /* Shape of the stop, dust and mask; needs STOPS unless all 0. Its mask must
     * outlive the engine. */
    struct glint_iris iris;
    struct glint_waves waves;                 /* wavelengths; default: AUTO */
    int balance;                              /* not 0: colours are balanced by
                                                 glint_setup_balance() */
    double sensor_width_mm, sensor_height_mm; /* size of the sensor, mm; 0: size
                                                 of the model's film */
    const struct glint_projection
        *projection; /* projection of the lens, copied; NULL: pinhole
                        projection */
    /* A setup that the caller made, for example with glint_engine_setup(). It
     * replaces the stop and colours above and must outlive the engine. The
     * caller calls glint_engine_update_stop() after changing the setup. NULL:
     * the engine makes a setup from the model. */
    const struct glint_setup *setup;
    /* Method to trace exact rays through the lens of SETUP if there is no
     * model: &glint_frame_traces of libglint-bake.a. NULL: a model is
     * required. */
    const struct glint_frame_rays *rays;
    /* Tints of the ghosts and their parts, [ghosts of the model, parts
     * included; without a model, ghosts of the setup], or NULL; must outlive
     * the engine. */
    const struct glint_tint *tints;
    /* Dirt on the front element, made by glint_front_make(); must outlive the
     * engine. NULL: the engine makes the dirt from front_dirt, of which it
     * copies the mask. Unless front_dirt is all 0, this needs STOPS. */
    const struct glint_front_dirt *front;
    struct glint_front front_dirt;
    /* &glint_engine_all_stops, which glint_engine_configure() sets. NULL: the
     * stop has straight, clean blades, and the front element is clean. */
    const struct glint_engine_stops *stops;
    uint64_t reserved[15]; /* must be 0 */
};

/* Parameters of the search for lamps. */
struct glint_engine_search {
    /* Thresholds, in stops relative to the picture's white, -20 .. 0. The
     * brightest pixels of a lamp must reach the first; a lamp extends to the
     * pixels that reach the second, which must not be higher than the first. */
    double threshold_ev[2];
    double headroom_ev; /* number of stops by which clipped pixels are brighter
                           than white; below 0: estimated from the halo of each
                           lamp */
    /* Max number of lamps that are found, 1 .. GLINT_ENGINE_MAX_LAMPS; 0: no
     * search, and no memory is allocated for it. */
    int max_found;
    /* Max number of lamps, 0 or more, that the program passes to
     * glint_engine_draw() in addition to the lamps found. */
    int more_lamps;
    /* Max number of lamps for which an arena has memory; if there are more,
     * lamps are merged. 0: 2 * max_found + more_lamps, because lamps that fade
     * out are drawn in addition to lamps that appear. */
    int max_drawn;
    uint64_t reserved[16]; /* must be 0 */
};

/* Brightness of the flare. */
struct glint_engine_light {
    /* Strength of the flare, 0 .. 100. At 0.5 the brightest pixels of the flare
     * are about a quarter of white for any lamps and lens;
     * src/engine/strength.h states the rule. If by_hand is not 0, exposure_ev
     * (in stops) is used instead of strength. gain is a factor on the resulting
     * light. */
    double strength, exposure_ev, gain;
    int by_hand;
    /* Factor on the star around each lamp (light diffracted by the edges of the
     * stop). 1, the default: the physical brightness at strength 0.5 or
     * exposure 0; 0: no star. */
    double starburst;
    /* Veiling glare index and haze: the fractions of all light that are
     * scattered by the lens and by dirt on its front. 0, the default: no
     * scattered light; the sum is at most GLINT_MOST_VEIL. */
    double veil, haze;
    uint64_t reserved[16]; /* must be 0 */
};

/* Bits that select the components of a flare, and three flags. CORES: stars
 * include the cores of the lamps, for layers that are drawn without the
 * picture. CODES: accuracy that suffices for pictures of 8 bits, at about half
 * the cost. CODES_16: accuracy that suffices for pictures of 16 bits: the same
 * as CODES has in a picture that is four stops brighter. */
enum glint_engine_part {
    GLINT_ENGINE_GHOSTS = 1,
    GLINT_ENGINE_STAR = 2,
    GLINT_ENGINE_VEIL = 4,
    GLINT_ENGINE_ALL = 7,
    GLINT_ENGINE_CORES = 8,
    GLINT_ENGINE_CODES = 16,
    GLINT_ENGINE_CODES_16 = 32
};

/* How the flare is drawn. */
struct glint_engine_drawing {
    struct glint_dials dials;
    /* Max milliseconds per frame; the engine adjusts the quality parameters to
     * stay below it; 0: no budget. */
    double budget_ms;
    /* Max predicted cost of a frame with one light, in millions of
     * instructions; costlier frames are drawn coarser. Each further light adds
     * a 16th to the limit. 0: no limit. */
    double most_minsn;
    /* Merge distance, pixels: lights are merged if their images are closer
     * together. */
    double apart_px;
    int tile_log2; /* log2 of the side of tiles, 3 .. 6 */
    /* Bits of enum glint_engine_part: the components that are drawn. */
    unsigned parts;
    int only_ghost; /* index of the only ghost that is drawn; -1: all
                       ghosts */
    /* Not 0: each picture is planned again, even if no lamp has moved. */
    int is_fresh;
    /* Not 0: still pictures are drawn with area_points (keep_points) or
     * max_lights (keep_lights) of DIALS. 0: still pictures get more points per
     * wide lamp, or more lights, than frames of a video. */
    int keep_points, keep_lights;
    /* Receives the progress of tracing exact rays until the first picture is
     * drawn; may be NULL. */
    glint_progress_fn *progress;
    void *progress_ctx;
    uint64_t reserved[16]; /* must be 0 */
};

/* Callbacks that cache measurements of lenses between runs of a program. KEY
 * identifies an entry; NAME is the name of the lens. */
struct glint_engine_cache {
    /* Sets DATA[BYTES] to the entry of NAME and KEY; returns 0 if there is no
     * such entry. */
    int (*read)(void *ctx, const char *name, uint64_t key, void *data,
                size_t bytes);
    void (*write)(void *ctx, const char *name, uint64_t key, const void *data,
                  size_t bytes);
    void *ctx;
};

/* Compatibility: a program keeps working with a newer library. Members that the
 * program does not know get their defaults. For this, a new member of a group,
 * or of struct glint_dials, replaces one of its reserved members, and its
 * default is 0. New members of this struct are added at its end. */
struct glint_engine_config {
    size_t size;       /* sizeof this struct in the program, set by
                          glint_engine_defaults() */
    int width, height; /* size of the pictures, pixels, 1 .. GLINT_MAX_SIDE */
    /* The lens model, which the caller sets; must outlive the engine. */
    const struct glint_lens *model;
    /* Worker threads; must outlive the engine; NULL: one thread. The output is
     * the same for any number of threads. */
    struct glint_workers *workers;
    unsigned sets; /* instruction sets, as in glint/flare.h; 0: plain C */
    /* May be NULL: reports then have no times, and the budget is ignored. */
    glint_clock_fn *clock;
    struct glint_engine_camera camera;
    struct glint_engine_search search;
    struct glint_engine_light light;
    struct glint_engine_drawing drawing;

    /* Memory for drawing. If arena_bytes is 0, the engine allocates as much as
     * a frame needs, and allocates again when a later frame needs more.
     * Otherwise arena_bytes is the limit. Without a budget, grids then become
     * coarser until the visible ghosts fit; ghosts that still do not fit are
     * left out and counted; lamps above max_drawn are merged. ARENA must be
     * aligned to 64 bytes and outlive the engine; NULL: the engine allocates
     * it. Stars need about 50 KB for tables and 0.3 KB per lamp in addition,
     * which are allocated once, when the engine is made. If arena_has_all is
     * not 0, arena_bytes includes the memory for stars and a veil, and ARENA
     * must be NULL. Still pictures need more memory while they are exposed. */
    void *arena;
    size_t arena_bytes;
    int arena_has_all;

    /* Used only by glint_engine_create(); NULL: no cache. */
    const struct glint_engine_cache *cache;
};

/* Sets the first SIZE bytes of CFG to the defaults; programs call
 * glint_engine_defaults() instead. */
void glint_engine_defaults_sized(struct glint_engine_config *cfg, size_t size,
                                 int width, int height);

/* Sets CFG to the defaults of glint overlay, with one exception: blades are
 * straight, while those of overlay have an iris.roundness of 0.2. The caller
 * still sets the model and the workers. */
static inline void glint_engine_defaults(struct glint_engine_config *cfg,
                                         int width, int height)
{
    glint_engine_defaults_sized(cfg, sizeof *cfg, width, height);
}

/* Sets the members of CFG for light, drawing, search, camera and memory from
 * OPTIONS (glint/options.h). A member gets its default if its option is not
 * set. Exceptions are the shape of the stop, its dust and front_dirt, which
 * then do not change. */
struct glint_options;
void glint_engine_configure(struct glint_engine_config *cfg,
                            const struct glint_options *options);

/* Makes SETUP from MODEL with the stop and the colours of CAMERA, as an engine
 * does. If MODEL is NULL, the caller has made SETUP from a lens table by
 * glint_setup_init() with the blades and wavelengths of CAMERA. Sets *DIRT to
 * the dirt that SETUP refers to, which the caller frees after SETUP by
 * glint_dirt_free(), or to NULL. Returns GLINT_E_ARGUMENT, GLINT_E_LENS or
 * GLINT_E_MEMORY and sets ERROR on failure. */
enum glint_status glint_engine_setup(struct glint_setup *setup,
                                     const struct glint_lens *model,
                                     const struct glint_engine_camera *camera,
                                     struct glint_dirt **dirt,
                                     struct glint_error *error);

/* ------------------------------------------------------------------ reports */

/* Light of a flare without the picture: linear R, G, B, 1 = display white. */
struct glint_response_light {
    /* Mean of the brightest 1/1000 of the pixels, at most 46 pixels, for each
     * channel. */
    double peak[3];
    double mean[3]; /* per channel, the mean of all pixels */
};

/* Exposure of the last picture. */
struct glint_engine_exposure {
    double scale; /* factor on the powers of lamps; 0: nothing is drawn */
    /* Light of the flare with powers multiplied by scale. */
    struct glint_response_light light;
    /* Not 0: the light was measured by drawing the flare of this picture at
     * reduced size. */
    int is_drawn;
    /* Not 0: the exposure restarted in this picture, as it does after a cut. */
    int is_new;
};

struct glint_engine_report {
    struct glint_flare_stats stats;
    int lights; /* number of lamps passed to the engine */
    /* Number of lamps farther off the axis than the model's range. */
    int beyond_lights;
    /* Number of lights left after merging lights closer than apart_px. */
    int apart_lights;
    /* Number of lights drawn. If max_lights was exceeded, more lights were
     * merged. */
    int drawn_lights;
    int ghosts, tiles; /* number of ghosts drawn, and number of tiles that
                          contain light */
    /* Number of samples of a linear picture that were clamped. */
    int held_samples;
    size_t arena_bytes; /* bytes of the arena that was passed to libglint */
    size_t peak_bytes;  /* bytes of arena_bytes that this frame used */
    /* Bytes that would have sufficed to draw this picture completely, with
     * grids as fine as requested. */
    size_t need_bytes;
    /* Bytes allocated outside the arena: for the tables and lamps of stars and
     * for a veil. */
    size_t star_bytes;
    /* Not 0: the plan exceeded a limit, and coarser grids were planned. */
    int coarsened;
    int tight; /* not 0: the exceeded limit was the memory limit */
    /* Number of plans that were made until one was within the limits, and
     * number of these plans that were binned. */
    int plans, binned;
    long long looked; /* number of rays that the plans traced to estimate
                         ghosts */
    double plan_ms, trace_ms, bin_ms, draw_ms;
    /* With a budget: the predicted time and the quality that was chosen.
     * Without a budget: 0 and -1. */
    double predicted_ms, quality;
    /* With a budget: the quality parameters that were chosen to meet it;
     * otherwise 0. */
    struct glint_dials dials;
    int blurred;  /* not 0: dust or a mask was drawn from coarser tables */
    int unveiled; /* not 0: the veil was not drawn, to meet the budget */
    /* Cost on which predictions are based, measured for an earlier frame, in
     * millions of instructions, or 0. */
    double calibrated_minsn;
    double scale; /* factor on the powers of lamps */
};

/* ------------------------------------------------------------------- engine */

struct glint_engine; /* opaque */

/* Makes an engine; CFG is copied. Draws small pictures to measure the
 * brightness of the flares of the lens. Returns GLINT_E_ARGUMENT if CFG is
 * invalid or belongs to a newer version of the library. May return GLINT_E_LENS
 * or GLINT_E_MEMORY. All set ERROR. */
enum glint_status glint_engine_create(struct glint_engine **engine,
                                      const struct glint_engine_config *cfg,
                                      struct glint_error *error);
/* Frees ENGINE, or does nothing if ENGINE is NULL. */
void glint_engine_destroy(struct glint_engine *engine);

/* Returns the view: size and projection of the pictures, and their width on the
 * sensor. */
const struct glint_view *glint_engine_view(const struct glint_engine *engine);

/* Set option NAME of glint/options.h for the following pictures, to a number or
 * to a text as on a command line. NAME is strength, exposure, gain, starburst,
 * f-number (as by glint_engine_stop()), stop or dust (as by
 * glint_engine_iris()). If both strength and exposure are set, the last one
 * applies. Returns GLINT_E_ARGUMENT and sets ERROR if there is no such option,
 * it does not accept the value, or it is fixed when an engine is made; the
 * engine is unchanged. May return GLINT_E_MEMORY. */
enum glint_status glint_engine_set(struct glint_engine *engine,
                                   const char *name, double value,
                                   struct glint_error *error);
enum glint_status glint_engine_set_text(struct glint_engine *engine,
                                        const char *name, const char *text,
                                        struct glint_error *error);

/* Sets the brightness of the flares of the following pictures. */
void glint_engine_set_light(struct glint_engine *engine,
                            const struct glint_engine_light *light);

/* Set the quality parameters of the following pictures; return the quality
 * parameters in use. With a budget, these are the parameters that were chosen
 * to meet it. */
void glint_engine_set_dials(struct glint_engine *engine,
                            struct glint_dials dials);
struct glint_dials glint_engine_dials(const struct glint_engine *engine);

/* Restricts the following pictures to the ghost with index GHOST; -1: all
 * ghosts are drawn. */
void glint_engine_set_only_ghost(struct glint_engine *engine, int ghost);

/* Changes the time budget of the following pictures; no-op if the engine was
 * made without a budget. */
void glint_engine_set_budget(struct glint_engine *engine, double budget_ms);

/* Sets the f-number of the following pictures, which must not be below the
 * f-number of the model. Unless the exposure is set by hand, measures the
 * brightness of the flares of the lens again. Returns GLINT_E_ARGUMENT and sets
 * ERROR if F_NUMBER is out of range, or the engine uses a setup of the caller;
 * the stop is unchanged. May return GLINT_E_MEMORY. */
enum glint_status glint_engine_stop(struct glint_engine *engine,
                                    double f_number, struct glint_error *error);

/* Sets the stop of the following pictures, as in struct glint_setup: N_BLADES,
 * 0 or 3 .. 64, the angle of its first corner, and IRIS, whose mask must
 * outlive the engine. F-number and exposure stay the same: the light of a flare
 * is relative to the light that the stop transmits. May be called before each
 * picture: without dust or a mask it costs less than a millisecond. Returns
 * GLINT_E_ARGUMENT and sets ERROR if a parameter is out of range, or the engine
 * uses a setup of the caller; the stop is unchanged. May return
 * GLINT_E_MEMORY. */
enum glint_status glint_engine_iris(struct glint_engine *engine, int n_blades,
                                    double rotation_deg,
                                    const struct glint_iris *iris,
                                    struct glint_error *error);

/* Reads the setup of the caller again, for the following pictures, after its
 * stop or the zoom of its model changed; the exposure does not change. */
void glint_engine_update_stop(struct glint_engine *engine);

/* --------------------------------------------------------------------- find */

/* Finds the lamps of IMAGE, ELAPSED_US after the last picture. Any format but
 * GLINT_LINEAR_Q20 is accepted. Lamps are tracked from picture to picture, and
 * rise and fade. If ELAPSED_US is 0, IMAGE is a still picture:
 * glint_engine_expose() then first draws the flare at reduced size to measure
 * its brightness, unless there is a budget or an arena without arena_has_all.
 * Writes at most MAX lamps, the strongest first; returns their number. */
int glint_engine_find(struct glint_engine *engine,
                      const struct glint_image *image, int32_t elapsed_us,
                      struct glint_engine_lamp *lamps, int max);

/* Starts a picture without a search for lamps, ELAPSED_US after the last
 * picture; 0: a still picture. */
void glint_engine_elapsed(struct glint_engine *engine, int32_t elapsed_us);

/* Reports a cut before the next picture: the exposure restarts. */
void glint_engine_mark_cut(struct glint_engine *engine);

/* Removes all tracked lamps, as after a cut. */
void glint_engine_forget_lamps(struct glint_engine *engine);

/* Lets ENGINE continue the video of FROM, for example with another lens: moves
 * the tracked lamps and the exposure to ENGINE, so that lamps do not fade in
 * again, and the brightness settles over time. FROM may only be destroyed
 * afterwards. Returns GLINT_E_ARGUMENT, without a change, if the engines differ
 * in picture size or in the numbers of lamps of their configurations. */
enum glint_status glint_engine_continue(struct glint_engine *engine,
                                        struct glint_engine *from);

/* Sets SPOT to doubtful region I, from 0, of the last picture that was
 * searched. A doubtful region looks like a lamp but was rejected. SPOT->doubt
 * is the reason. Regions are sorted by decreasing brightness. Returns 0 if
 * there is no region I. */
int glint_engine_doubtful(const struct glint_engine *engine, int i,
                          struct glint_spot *spot);

/* Value of the visible fraction of a completely hidden lamp. It is not 0, so
 * that the lamp's own power can still be computed as power / fraction. */
#define GLINT_ENGINE_HIDDEN 1e-18

/* Multiplies power and share of each of N LAMPS by the fraction of the lamp
 * that SCENE, as drawn last, leaves visible, and appends the lights of SCENE
 * that cause flares, at most GLINT_SCENE_MAX_LIGHTS. Returns the number of
 * lamps; sets *HIDDEN to the number of completely hidden lamps. Only programs
 * that call this function link the scene library. */
struct glint_scene;
int glint_engine_add_scene(const struct glint_engine *engine,
                           const struct glint_scene *scene,
                           struct glint_engine_lamp *lamps, int n, int *hidden);

/* Multiplies the level of each of N LAMPS by its share, so that the exposure
 * does not brighten partly hidden lamps. If IS_STILL is not 0, the picture is a
 * still, and completely hidden lamps get power 0. */
void glint_engine_apply_shares(struct glint_engine_lamp *lamps, int n,
                               int is_still);

/* Returns the focal length in pixels, for scenes whose camera is the lens. */
double glint_engine_focal_px(const struct glint_engine *engine);

/* --------------------------------------------------------- expose and draw */

/* Chooses the brightness of the flare of N LAMPS on IMAGE. Dims the ghosts of
 * lamps that appeared while the exposure has not adapted to them yet. WHITE is
 * the linear light of the code of white: 1, or more if IMAGE is a proxy of a
 * picture with more light than white. glint_engine_draw() calls this function
 * with WHITE 1 if the program did not. May return GLINT_E_ARGUMENT or
 * GLINT_E_MEMORY. */
enum glint_status glint_engine_expose(struct glint_engine *engine,
                                      struct glint_engine_lamp *lamps, int n,
                                      const struct glint_image *image,
                                      double white);

/* Returns the exposure of the last picture. */
const struct glint_engine_exposure *
glint_engine_exposed(const struct glint_engine *engine);

/* Adds the flare of N LAMPS to IMAGE. LAMPS need not be the lamps found; N is
 * at most GLINT_ENGINE_MAX_LAMPS + more_lamps, or more_lamps without a search.
 * The exposure continues from the previous picture if glint_engine_find() or
 * glint_engine_elapsed() was called with the time since that picture; otherwise
 * IMAGE is a still picture. If N is 0, only a veil changes IMAGE. Returns
 * GLINT_E_ARGUMENT if the size of IMAGE is wrong, or N is out of range. May
 * return GLINT_E_MEMORY. */
enum glint_status glint_engine_draw(struct glint_engine *engine,
                                    struct glint_engine_lamp *lamps, int n,
                                    const struct glint_image *image,
                                    struct glint_engine_report *report);

/* Draws the components PARTS of the flare of N LAMPS, with the exposure of the
 * last picture, into RGB, [height][width][3], linear light, row 0 on top. The
 * veil is computed from the picture that glint_engine_draw() drew, and must be
 * the first layer. May return GLINT_E_ARGUMENT or GLINT_E_MEMORY. */
enum glint_status glint_engine_draw_layer(struct glint_engine *engine,
                                          const struct glint_engine_lamp *lamps,
                                          int n, unsigned parts, float *rgb,
                                          struct glint_engine_report *report);

/* Adds the flare of N LAMPS, times SCALE, to IMAGE, independent of the
 * exposure. Neither this function nor glint_engine_render() may be called
 * between the stages (find, expose, draw) of a picture. May return
 * GLINT_E_ARGUMENT or GLINT_E_MEMORY. */
enum glint_status glint_engine_draw_at(struct glint_engine *engine,
                                       const struct glint_lamp *lamps, int n,
                                       double scale,
                                       const struct glint_image *image,
                                       struct glint_engine_report *report);

/* Draws the components PARTS of the flare of N LAMPS, times GAIN, into RGB as
 * glint_engine_draw_layer() does, but without a picture and independent of the
 * exposure. May return GLINT_E_MEMORY. */
enum glint_status glint_engine_render(struct glint_engine *engine,
                                      const struct glint_lamp *lamps, int n,
                                      double gain, unsigned parts, float *rgb,
                                      struct glint_engine_report *report);

/* Sets LIGHT to the light of the flare of N LAMPS with unchanged powers,
 * measured in a picture of about 640 x 360 pixels. The peak is the 99.99th
 * percentile. May return GLINT_E_MEMORY. */
enum glint_status glint_engine_measure(struct glint_engine *engine,
                                       const struct glint_engine_lamp *lamps,
                                       int n,
                                       struct glint_response_light *light);

/* Sets LIGHT to the peak and mean light of the N pixels in RGB. */
void glint_response_around(const float *rgb, size_t n,
                           struct glint_response_light *light);

/* Returns whether the engine draws veil or haze. */
int glint_engine_has_veil(const struct glint_engine *engine);

#ifdef __cplusplus
}
#endif

#endif
