/* SPDX-License-Identifier: MIT
 *
 * Models that mean no good, with right checksums: each is drawn at random from
 * its family, and what glint_lens_open() lets through is to take bounded work
 * and memory.
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
    HOSTILE_WHOLE,   /* 2016 ghosts, each as large as the frame */
    HOSTILE_FOLDS,   /* the same, folded nine times each way, cut by barrels */
    HOSTILE_LOST,    /* rays that are lost: all, or stripes of them */
    HOSTILE_SYSTEMS, /* thousands of systems, or of knots, of one ghost */
    HOSTILE_NUMBERS, /* coefficients at the largest sums, any exponents */
    HOSTILE_POINTS,  /* boxes of no size */
    HOSTILE_HUGE,    /* boxes at the largest size, any exponents */
    HOSTILE_WINDOWS, /* stop positions that leave no window, or hardly one */
    HOSTILE_HEADERS, /* numbers of the header at the ends of their ranges */
    HOSTILE_COLOURS, /* outlines that lie far apart by wavelength */
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
    double opening; /* radius of the stop, in those of the model's */
    struct glint_lamp lamp[HOSTILE_LAMPS];
    int n_lamps;
    bool linear; /* the picture is in linear light */
};

/* What became of a scene's frame. */
enum hostile_outcome {
    HOSTILE_REFUSED, /* by the check of models, or by a setup: no frame */
    HOSTILE_EMPTY,   /* nothing is to be seen */
    HOSTILE_DRAWN,
    HOSTILE_COARSER, /* held to the bound of work */
    HOSTILE_LESS,    /* held to the bound of memory */
    HOSTILE_OUTCOMES
};

struct hostile_result {
    enum hostile_outcome outcome;
    double minsn, most_minsn; /* work, counted, and its bound: millions of
                                 instructions */
    double bytes, most_bytes; /* memory that drawing took, and its bound */
    int plans;
    const char *reason; /* why it was refused */
};

/* Draws SCENE, 640x360, with the bounds that frames have unless others are set.
 * False: it failed, which no model may cause. */
bool hostile_draw(const struct hostile_scene *scene,
                  struct hostile_result *result);

/* Model NUMBER, 0 to HOSTILE_EACH - 1, of FAMILY: some edit BAKED. */
void hostile_make(struct hostile_scene *scene, enum hostile_family family,
                  int number, const struct glint_lens *baked);

#endif
