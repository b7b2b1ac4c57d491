/* SPDX-License-Identifier: MIT
 *
 * glint/engine.h - pictures in, pictures with flares out: lamps are found and
 * followed, and their ghosts behind a baked lens drawn at a suitable exposure.
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
 * Where there is no malloc, glint/flare.h draws by itself. */
#ifndef GLINT_ENGINE_H
#define GLINT_ENGINE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/dials.h"
#include "glint/image.h"
#include "glint/model.h"
#include "glint/status.h"
#include "glint/view.h"
#include "glint/workers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns seconds since any moment; never falls. */
typedef double glint_clock_fn(void);

enum { GLINT_ENGINE_MAX_LAMPS = 1024 }; /* lamps of one picture, at most */

struct glint_engine_config {
    int width, height; /* size of the pictures, 1 .. GLINT_MAX_SIDE */
    const struct glint_lens *model; /* kept; the caller sets it */
    struct glint_workers *workers;  /* kept; NULL: serial. Changes no output */
    unsigned sets; /* instruction sets, as in glint/flare.h; 0: plain C */
    glint_clock_fn *clock; /* kept; NULL: reports have no times, and no budget
                              is kept */

    /* The camera. n_blades: sides of the stop, 3 .. 64, or 0 for a circle;
     * blade_rotation_deg: angle of its first corner; f_number: 0 for that which
     * the model was baked for, the widest allowed; width and height of the
     * sensor: 0 for those of the model's film. */
    int n_blades;
    double blade_rotation_deg, f_number, sensor_width_mm, sensor_height_mm;

    /* How a picture is searched. threshold_ev, in stops from the picture's
     * white: how bright a lamp must be, and down to what brightness it extends.
     * headroom_ev: stops by which clipped pixels exceed white; below 0: as the
     * halo of each lamp tells. */
    double threshold_ev[2], headroom_ev;
    int max_found; /* 1 .. GLINT_ENGINE_MAX_LAMPS / 2 */

    /* How bright the flare is. strength, 0 .. 100: at 0.5 its brightest part is
     * about a quarter of white, whatever the lamps and the lens;
     * engine/strength.h has the rule. If by_hand is not 0, exposure_ev stops
     * are used instead. Both are multiplied by gain. */
    double strength, exposure_ev, gain;
    int by_hand;

    /* Factor on the star around each lamp, of light that the stop's edges
     * diffract: 1, the default, is its physical brightness at strength 0.5 or
     * exposure 0; 0: there is no star. */
    double starburst;

    /* Shares of all light that the lens, and dirt on its front, spread: veiling
     * glare index and haze. 0, the default: none; together at most
     * GLINT_MOST_VEIL. */
    double veil, haze;

    struct glint_dials dials;
    double budget_ms; /* milliseconds a frame, which the engine keeps to by
                         turning the dials; 0: there is no budget */

    /* Memory for drawing. If arena_bytes is 0 the engine takes exactly what a
     * frame needs, and more when a frame needs more. Else it keeps to
     * arena_bytes: without a budget grids become coarser until what is seen
     * fits, what still does not is left out and counted, and at most 2 *
     * max_found lights are drawn. ARENA, aligned to 64, is kept; NULL: the
     * engine allocates it. Stars take some 50 KB for their tables and 0.3 KB
     * for each of their lamps besides, once, when the engine is made. */
    void *arena;
    size_t arena_bytes;
};

struct glint_engine_report {
    int lamps;        /* number of lamps given */
    int lamps_beyond; /* lamps of these farther off the axis than the model goes
                       */
    int lights;       /* lights drawn, after lamps that are too near or too many
                         merged */
    /* Number of ghosts seen, and of bundles of rays drawn. */
    int ghosts, bundles;
    int dropped_bundles; /* bundles left out for want of memory */
    int dropped_cells;   /* cells left out of ghosts that were drawn, as rays of
                            them were lost */
    size_t bytes;        /* size of the memory for drawing */
    size_t need_bytes;   /* size that would have drawn everything in this very
                            picture, and with grids as fine as asked for */
    double scale;        /* factor on the powers of lamps */
    double plan_ms, bin_ms, draw_ms;
    double quality; /* quality that the budget chose; below 0: there is no
                       budget */
};

struct glint_engine; /* opaque */

/* Sets CFG to the values that glint overlay draws with, but for straight
 * blades: its own have a roundness of 0.2, which glint_engine_iris() gives. The
 * caller still sets the model and the workers. */
void glint_engine_defaults(struct glint_engine_config *cfg, int width,
                           int height);

/* Makes an engine; CFG is copied. Draws small pictures to measure how bright
 * flares of the lens are. With ERROR: GLINT_E_ARGUMENT, GLINT_E_LENS,
 * GLINT_E_MEMORY. */
enum glint_status glint_engine_create(struct glint_engine **engine,
                                      const struct glint_engine_config *cfg,
                                      struct glint_error *error);
/* Frees ENGINE, which may be NULL. */
void glint_engine_destroy(struct glint_engine *engine);

/* Changes the dials for the frames to come. */
void glint_engine_turn(struct glint_engine *engine, struct glint_dials dials);

/* Sets the f-number of the pictures to come, at least that which the model was
 * baked for, and measures anew how bright flares of the lens are.
 * GLINT_E_ARGUMENT with ERROR: the stop stays as it is. GLINT_E_MEMORY. */
enum glint_status glint_engine_stop(struct glint_engine *engine,
                                    double f_number, struct glint_error *error);

/* Sets the stop of the pictures to come, as in struct glint_setup: N_BLADES, 0
 * or 3 .. 64, the angle of its first corner, and IRIS, whose mask is kept. The
 * f-number stays, and so does the exposure, as a flare is counted over the
 * light that the stop lets through. May be called before each picture: without
 * dust or a mask it takes less than a millisecond. GLINT_E_ARGUMENT with ERROR:
 * the stop stays as it is. GLINT_E_MEMORY. */
struct glint_iris;
enum glint_status glint_engine_iris(struct glint_engine *engine, int n_blades,
                                    double rotation_deg,
                                    const struct glint_iris *iris,
                                    struct glint_error *error);

/* Sets what lies on the front element in the pictures to come: dust, scratches
 * and smudges, or a mask, which is copied. It spreads light as haze does.
 * GLINT_E_ARGUMENT with ERROR, or GLINT_E_MEMORY: all stays as it is. */
struct glint_front;
enum glint_status glint_engine_front(struct glint_engine *engine,
                                     const struct glint_front *front,
                                     struct glint_error *error);

/* Finds the lamps of IMAGE, in any format but GLINT_LINEAR_Q20, which comes
 * ELAPSED_US after the last picture: lamps are followed from picture to
 * picture, and rise and fade. If ELAPSED_US is 0, IMAGE is a picture by itself;
 * glint_engine_draw() then draws its flare small first, to see how bright it
 * is, unless there is an arena or a budget. Writes at most MAX lamps, the
 * strongest first; returns how many. */
int glint_engine_find(struct glint_engine *engine,
                      const struct glint_image *image, int32_t elapsed_us,
                      struct glint_lamp *lamps, int max);

/* Says that the next picture, on which no lamps are looked for, comes
 * ELAPSED_US after the last one, as to glint_engine_find(). */
void glint_engine_elapsed(struct glint_engine *engine, int32_t elapsed_us);

/* Adds the flare of N LAMPS, at most GLINT_ENGINE_MAX_LAMPS, to IMAGE: those
 * found last or any others. The exposure follows that of the picture before
 * where the time since that is known; else, as of ELAPSED_US 0, IMAGE is a
 * picture by itself. N 0 leaves IMAGE as it is. GLINT_E_ARGUMENT: IMAGE has
 * another size, or N is out of range. GLINT_E_MEMORY. */
enum glint_status glint_engine_draw(struct glint_engine *engine,
                                    const struct glint_lamp *lamps, int n,
                                    const struct glint_image *image,
                                    struct glint_engine_report *report);

#ifdef __cplusplus
}
#endif

#endif
