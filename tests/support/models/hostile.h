/* SPDX-License-Identifier: MIT
 *
 * Models with valid checksums whose contents would cost too much work or
 * memory, or overflow. Each belongs to a family and is otherwise random.
 * Frames of models that glint_lens_open() accepts must be drawn within the
 * limits of work and memory.
 *
 *     hostile_make_scene(&scene, HOSTILE_FOLDS, 3, &baked);
 *     glint_lens_open(&lens, scene.model.data, scene.model.bytes, &reason);
 */
#ifndef GLINT_TESTS_HOSTILE_H
#define GLINT_TESTS_HOSTILE_H

#include "engine/frame/frame.h"
#include "support/model_builder.h"

enum hostile_family {
    HOSTILE_WHOLE, /* 2016 ghosts, each as large as the frame */
    /* 2016 ghosts that are clipped by barrel apertures and fold across the
     * frame up to nine times in x and y */
    HOSTILE_FOLDS,
    /* models whose rays are invalid, either all rays or stripes of them; or
     * models with more grid cells than an int can count */
    HOSTILE_LOST,
    HOSTILE_SYSTEMS, /* a ghost with thousands of polynomial systems */
    /* coefficients with the largest valid sums of magnitudes, and any
     * exponents */
    HOSTILE_NUMBERS,
    HOSTILE_POINTS,  /* pupil boxes of size 0 */
    HOSTILE_HUGE,    /* pupil boxes of the largest size, with any exponents */
    HOSTILE_WINDOWS, /* stop positions: empty or tiny pupil windows */
    HOSTILE_HEADERS, /* header fields at the ends of their ranges */
    /* ghost outlines whose position differs much between wavelengths */
    HOSTILE_COLOURS,
    HOSTILE_SUMS, /* coefficients whose sums exceed 2^30 - 1 after rounding */
    /* names with terminal control bytes, or without a terminating 0 */
    HOSTILE_TEXTS,
    HOSTILE_FAMILIES
};

enum {
    HOSTILE_EACH = 10,
    HOSTILE_LAMPS = 16,
    HOSTILE_WIDTH = 640,
    HOSTILE_HEIGHT = 360
};

extern const char *const hostile_name[HOSTILE_FAMILIES];

struct hostile_scene {
    struct model_image model;
    double opening; /* stop radius divided by the stop radius of the model */
    struct glint_lamp lamp[HOSTILE_LAMPS];
    int n_lamps;
    bool linear; /* true: draws linear light; false: pixel codes */
};

/* Outcome of drawing a hostile scene. */
enum hostile_outcome {
    HOSTILE_REFUSED, /* the validity check or the setup rejected the model */
    HOSTILE_EMPTY,   /* frame without light */
    HOSTILE_DRAWN,
    /* the scene was drawn with coarser grids, which the work limit required */
    HOSTILE_COARSER,
    /* the scene was drawn without some ghosts, for lack of memory */
    HOSTILE_LESS,
    HOSTILE_OUTCOMES
};

struct hostile_result {
    enum hostile_outcome outcome;
    /* estimated work and its limit, millions of instructions */
    double minsn, most_minsn;
    /* memory used for drawing and its limit, bytes */
    double bytes, most_bytes;
    int plans;
    const char *reason; /* why the model was rejected */
};

/* Draws SCENE at 640x360 with the default limits and sets RESULT. Returns false
 * if drawing failed, which must not happen for any model. */
bool hostile_draw_scene(const struct hostile_scene *scene,
                        struct hostile_result *result);

/* Sets SCENE to model NUMBER, 0 .. HOSTILE_EACH - 1, of FAMILY. Some families
 * are edited copies of the model BAKED. The caller frees scene->model.data. */
void hostile_make_scene(struct hostile_scene *scene, enum hostile_family family,
                        int number, const struct glint_lens *baked);

#endif
