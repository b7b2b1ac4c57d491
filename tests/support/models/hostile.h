/* SPDX-License-Identifier: MIT
 *
 * Hostile models: files with valid checksums that would cost too much work or
 * memory, or overflow. Each is random within its family. Those that
 * glint_lens_open() accepts must be drawn within the limits of work and memory.
 *
 *     hostile_make(&scene, HOSTILE_FOLDS, 3, &baked);
 *     glint_lens_open(&lens, scene.model.data, scene.model.bytes, &reason);
 *     free(scene.model.data);
 */
#ifndef GLINT_TESTS_HOSTILE_H
#define GLINT_TESTS_HOSTILE_H

#include "engine/frame/frame.h"
#include "support/model_builder.h"

enum hostile_family {
    HOSTILE_WHOLE, /* 2016 ghosts, each fills the frame */
    /* 2016 folded ghosts that cross the frame up to nine times in each
     * direction, clipped by barrels */
    HOSTILE_FOLDS,
    HOSTILE_LOST,    /* invalid rays: all, or stripes of them */
    HOSTILE_SYSTEMS, /* thousands of polynomial systems per ghost */
    HOSTILE_NUMBERS, /* coefficients with the max sums, any exponents */
    HOSTILE_POINTS,  /* bounding boxes of size 0 */
    HOSTILE_HUGE,    /* bounding boxes of the max size, any exponents */
    HOSTILE_WINDOWS, /* stop positions with no window, or a tiny one */
    HOSTILE_HEADERS, /* numbers of the header at the ends of their ranges */
    HOSTILE_COLOURS, /* outlines that differ widely by wavelength */
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
    double opening; /* radius of the stop / radius of the model's stop */
    struct glint_lamp lamp[HOSTILE_LAMPS];
    int n_lamps;
    bool linear; /* the picture is in linear light */
};

/* The result of drawing a scene. */
enum hostile_outcome {
    /* The model or its setup is invalid; there is no frame. */
    HOSTILE_REFUSED,
    HOSTILE_EMPTY, /* The frame shows nothing. */
    HOSTILE_DRAWN,
    HOSTILE_COARSER, /* drawn with coarser grids, within the limit of work */
    HOSTILE_LESS, /* drawn without some bundles, within the limit of memory */
    HOSTILE_OUTCOMES
};

struct hostile_result {
    enum hostile_outcome outcome;
    /* work by counts, and its limit, millions of instructions */
    double minsn, most_minsn;
    double bytes, most_bytes; /* memory of the frame, and its limit */
    int plans;
    const char *reason; /* error message if the model is invalid */
};

/* Draws SCENE at 640x360 with the default limits and sets RESULT. Returns
 * false if drawing failed, which no model may cause. */
bool hostile_draw(const struct hostile_scene *scene,
                  struct hostile_result *result);

/* Makes SCENE with model NUMBER, 0 to HOSTILE_EACH - 1, of FAMILY. Some
 * families are edited copies of BAKED. The caller frees scene->model.data. */
void hostile_make(struct hostile_scene *scene, enum hostile_family family,
                  int number, const struct glint_lens *baked);

#endif
