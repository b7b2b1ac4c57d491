/* SPDX-License-Identifier: MIT
 *
 * State of an engine; shared by engine.c and engine_iris.c. */
#ifndef GLINT_ENGINE_ENGINE_PARTS_H
#define GLINT_ENGINE_ENGINE_PARTS_H

#include <stdbool.h>

#include "engine/detector.h"
#include "engine/frame/frame.h"
#include "engine/strength.h"
#include "glint/engine.h"
#include "glint/setup.h"

typedef enum glint_status glint_setup_iris_fn(struct glint_setup *setup,
                                              const struct glint_iris *iris,
                                              struct glint_dirt **dirt,
                                              struct glint_error *error);

/* The stop that pictures are drawn through. */
struct glint_engine_shape {
    int n_blades;
    double rotation_deg, f_number; /* 0: that which the model was baked for */
    struct glint_iris iris;
    /* glint_setup_iris(), once an iris was asked for; a program that asks for
     * none does not link it. */
    glint_setup_iris_fn *set_iris;
};

struct glint_engine {
    struct glint_setup setup;
    struct glint_engine_shape shape; /* what SETUP was made for */
    struct glint_dirt *dirt;         /* that of SETUP, or NULL */
    /* Frees what lies on the frame's front element; NULL: nothing does. A
     * program that asks for none does not link it. */
    void (*free_front)(struct glint_front_dirt *dirt);
    struct glint_front_dirt *front;
    struct glint_frame frame;
    struct glint_lamp_detector detector;
    struct glint_response response;
    struct glint_strength strength;
    double starburst;
    double excess[GLINT_LAMP_DETECTOR_MAX];  /* what each lamp found has above
                                                the light that is seen of it */
    double seen_px[GLINT_LAMP_DETECTOR_MAX]; /* extent, in pixels, of each lamp
                                                found */
    bool has_arena; /* true: drawing takes no memory of its own */
    int n_found;
    int32_t elapsed_us; /* between the last two pictures; 0: not known */
    bool is_timed;      /* true: between the next picture and the last */
    bool is_searched;   /* true: lamps were looked for in the next picture */
    struct glint_lamp lamp[GLINT_LAMP_DETECTOR_MAX];
    double level[GLINT_LAMP_DETECTOR_MAX]; /* level of each lamp found */
};

/* Gives ENGINE another stop; with MEASURE, measures anew how bright flares are.
 * After a failure the stop stays as it is. */
enum glint_status glint_engine_reshape(struct glint_engine *engine,
                                       const struct glint_engine_shape *shape,
                                       bool measure, struct glint_error *error);

#endif
