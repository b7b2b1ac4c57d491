/* SPDX-License-Identifier: MIT
 *
 * Private data of an engine, one struct per stage: optics, lamp search,
 * exposure, drawing. Shared by the files engine*.c. */
#ifndef GLINT_ENGINE_ENGINE_PARTS_H
#define GLINT_ENGINE_ENGINE_PARTS_H

#include <stdbool.h>

#include "engine/detector.h"
#include "engine/frame/frame.h"
#include "engine/strength.h"
#include "glint/engine.h"
#include "glint/setup.h"

/* Pointers to glint_setup_iris(), glint_front_make() and glint_front_free(), so
 * that only programs that need them link these functions. */
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
    /* &own, or the caller's setup */
    const struct glint_setup *setup;
    struct glint_setup own;
    struct glint_engine_camera camera; /* camera settings from which OWN was
                                          made */
    struct glint_dirt *dirt; /* dust and masks in the stop of OWN; NULL: none */
    struct glint_front_dirt *own_front;
    /* dirt on the front element, either OWN_FRONT or the caller's; NULL:
     * none */
    const struct glint_front_dirt *front;
};

struct glint_engine_finding {
    struct glint_lamp_detector detector;
    struct glint_lamp found[GLINT_LAMP_DETECTOR_MAX];
    int32_t elapsed_us; /* time between the last picture and the next, us; 0:
                           unknown, or a still picture */
    bool is_searched;   /* true: the lamps of the next picture have been
                           searched */
    bool is_cut; /* true: the next picture does not continue the video, as after
                    a cut */
};

/* The light of one lamp that clipping removed from the last picture, in white
 * times pixels. */
struct glint_engine_before {
    uint32_t id;
    double excess;
};

struct glint_engine_exposing {
    struct glint_engine_light light;
    struct glint_response response;
    struct glint_strength strength;
    struct glint_engine_exposure last;
    bool by_drawing; /* true: still pictures are exposed by drawing their flare
                        at reduced size and measuring it */
    bool is_done;    /* true: the next picture has been exposed */
    struct glint_engine_before *before;
    double *part; /* [n_before]: factor on the light of the ghosts of each lamp
                     of the last picture, chosen by the exposure
                     (engine/strength.h) */
    int n_before;
};

struct glint_engine_painting {
    struct glint_frame frame;
    struct glint_lamp *lamp; /* [most_lamps]: the lamps whose ghosts are drawn
                              */
    unsigned parts;
    bool keep_points, keep_lights;
};

struct glint_engine {
    struct glint_engine_optics optics;
    struct glint_engine_finding find;
    struct glint_engine_exposing expose;
    struct glint_engine_painting paint;
    int most_lamps; /* max number of lamps per picture */
};

/* Copies the options stop and dust of O to the stop of CAMERA. Options that are
 * not set change nothing. */
struct glint_options;
void glint_engine_configure_stop(struct glint_engine_camera *camera,
                                 const struct glint_options *o);

/* Replaces the stop of ENGINE by that of CAMERA, and makes a new setup. If
 * MEASURE is true, measures the lens response (brightness of the flare by
 * angle) again. On failure the stop is unchanged, and ERROR has the reason. */
enum glint_status
glint_engine_change_stop(struct glint_engine *engine,
                         const struct glint_engine_camera *camera, bool measure,
                         struct glint_error *error);

/* Selects what the engine draws next. PARTS: GLINT_ENGINE_ flags of the parts
 * of the flare; STAR: factor on the brightness of starbursts; VEIL: false
 * disables the veil. */
void glint_engine_select_parts(struct glint_engine *engine, unsigned parts,
                               double star, bool veil);

/* Returns whether ENGINE can draw N lamps on IMAGE: N is in range, and IMAGE
 * has the size of the engine's pictures. */
bool glint_engine_can_draw_on_image(const struct glint_engine *engine,
                                    const struct glint_image *image, int n);

/* Copies N LAMPS to the array from which ghosts are drawn, and returns that
 * array. The powers of the copies are multiplied by the factors on ghosts that
 * the exposure has chosen. */
const struct glint_lamp *
glint_engine_copy_ghost_lamps(struct glint_engine *engine,
                              const struct glint_engine_lamp *lamps, int n);

#endif
