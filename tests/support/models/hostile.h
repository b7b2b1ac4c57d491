/* SPDX-License-Identifier: MIT
 *
 * Models with valid checksums whose contents would cost too much work or
 * memory, or overflow. Each is drawn at random from its family; those that
 * glint_lens_open() accepts must be drawn within bounds of work and memory.
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
    HOSTILE_WHOLE, /* 2016 ghosts, each as large as the frame */
    /* as many ghosts that go across the frame up to nine times each way, cut by
     * barrels */
    HOSTILE_FOLDS,
    HOSTILE_LOST,    /* invalid rays: all, or stripes of them; more cells than
                        an int can count */
    HOSTILE_SYSTEMS, /* thousands of systems of one ghost */
    HOSTILE_NUMBERS, /* coefficients at the largest sums, any exponents */
    HOSTILE_POINTS,  /* boxes of no size */
    HOSTILE_HUGE,    /* boxes at the largest size, any exponents */
    HOSTILE_WINDOWS, /* stop positions that leave no window, or hardly one */
    HOSTILE_HEADERS, /* numbers of the header at the ends of their ranges */
    HOSTILE_COLOURS, /* outlines that lie far apart by wavelength */
    HOSTILE_SUMS,    /* rounding carries sums of coefficients past 2^30 - 1 */
    HOSTILE_TEXTS,   /* names with bytes that terminals obey, or without end */
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
    double opening; /* radius of the stop over that of the model's */
    struct glint_lamp lamp[HOSTILE_LAMPS];
    int n_lamps;
    bool linear; /* the picture is in linear light */
};

/* What became of the frame of a scene. */
enum hostile_outcome {
    HOSTILE_REFUSED, /* The check of models or the setup refuses the model;
                        there is no frame. */
    HOSTILE_EMPTY,   /* The frame shows nothing. */
    HOSTILE_DRAWN,
    HOSTILE_COARSER, /* drawn coarser, to keep within the bound of work */
    HOSTILE_LESS,    /* drawn without some bundles, for the bound of memory */
    HOSTILE_OUTCOMES
};

struct hostile_result {
    enum hostile_outcome outcome;
    double minsn, most_minsn; /* work by counts, and its bound: millions of
                                 instructions */
    double bytes, most_bytes; /* memory that drawing took, and its bound */
    int plans;
    const char *reason; /* why the model was refused */
};

/* Draws SCENE in 640x360 with the default bounds and sets RESULT. Returns false
 * if drawing failed, which no model may cause. */
bool hostile_draw(const struct hostile_scene *scene,
                  struct hostile_result *result);

/* Makes SCENE with model NUMBER, 0 to HOSTILE_EACH - 1, of FAMILY. Some
 * families are edited copies of BAKED. The caller frees scene->model.data. */
void hostile_make(struct hostile_scene *scene, enum hostile_family family,
                  int number, const struct glint_lens *baked);

#endif
