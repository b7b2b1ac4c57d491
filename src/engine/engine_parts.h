/* SPDX-License-Identifier: MIT
 *
 * State of an engine, by stage; shared by the files of engine*.c. */
#ifndef GLINT_ENGINE_ENGINE_PARTS_H
#define GLINT_ENGINE_ENGINE_PARTS_H

#include <stdbool.h>

#include "engine/detector.h"
#include "engine/frame/frame.h"
#include "engine/strength.h"
#include "glint/engine.h"
#include "glint/setup.h"

/* glint_setup_iris(), glint_front_make() and glint_front_free(). */
struct glint_engine_stops {
    enum glint_status (*set_iris)(struct glint_setup *setup,
                                  const struct glint_iris *iris,
                                  struct glint_dirt **dirt,
                                  struct glint_error *error);
    enum glint_status (*make_front)(struct glint_front_dirt **dirt,
                                    const struct glint_front *front,
                                    struct glint_error *error);
    void (*free_front)(struct glint_front_dirt *dirt);
};

struct glint_engine_optics {
    const struct glint_setup *setup; /* OWN, or the caller's */
    struct glint_setup own;
    struct glint_engine_camera camera; /* what OWN was made for */
    struct glint_dirt *dirt;           /* that of OWN, or NULL */
    struct glint_front_dirt *own_front;
    const struct glint_front_dirt *front; /* OWN_FRONT, the caller's, or NULL */
};

struct glint_engine_finding {
    struct glint_lamp_detector detector;
    struct glint_lamp found[GLINT_LAMP_DETECTOR_MAX];
    int32_t elapsed_us; /* between the next picture and the last; 0: not known
                         */
    bool is_searched;   /* lamps were looked for in the next picture */
    bool is_cut;        /* the next picture restarts */
};

/* Light of the lamps of the last picture in excess of what it showed. */
struct glint_engine_before {
    uint32_t id;
    double excess;
};

struct glint_engine_exposing {
    struct glint_engine_light light;
    struct glint_response response;
    struct glint_strength strength;
    struct glint_engine_exposure last;
    bool by_drawing; /* the exposure of stills is measured in a small drawing of
                        their flare */
    bool is_done;    /* the next picture is exposed */
    struct glint_engine_before *before;
    int n_before;
};

struct glint_engine_painting {
    struct glint_frame frame;
    struct glint_lamp *lamp; /* [most_lamps]: those of the picture */
    unsigned parts;
    bool keep_points, keep_lights;
};

struct glint_engine {
    struct glint_engine_optics optics;
    struct glint_engine_finding find;
    struct glint_engine_exposing expose;
    struct glint_engine_painting paint;
    int most_lamps; /* that a picture may have */
};

/* Sets the stop of CAMERA by the options stop and dust of O that are set. */
struct glint_options;
void glint_engine_configure_stop(struct glint_engine_camera *camera,
                                 const struct glint_options *o);

/* Sets another stop of ENGINE, which makes its own setup; with MEASURE,
 * measures the brightness of flares again. After an error, stop and brightness
 * are unchanged. */
enum glint_status glint_engine_reshape(struct glint_engine *engine,
                                       const struct glint_engine_camera *camera,
                                       bool measure, struct glint_error *error);

/* Enables PARTS of the flare, for the light that is set and with VEIL, and
 * disables all others. */
void glint_engine_choose(struct glint_engine *engine, unsigned parts,
                         double star, bool veil);

/* Returns whether ENGINE can draw N lamps on IMAGE. */
bool glint_engine_fits(const struct glint_engine *engine,
                       const struct glint_image *image, int n);

/* Copies N LAMPS to where they are drawn from; returns these. */
const struct glint_lamp *
glint_engine_plain(struct glint_engine *engine,
                   const struct glint_engine_lamp *lamps, int n);

#endif
