/* SPDX-License-Identifier: MIT
 *
 * live_input.h - where live frames come from: a camera, or what stands in for
 * one where there is none:
 *   /dev/videoN, N   a camera (linux/v4l2.h)
 *   FILE.y4m         a video at its own rate, to its end; frames that are late
 *                    are left out, as of a camera
 *   -                a y4m pipe, each frame as it comes
 *   test             a lamp over a night street (live_scene.h)
 *
 * What stands in fills the parts of CAMERA that live reads: source, format,
 * card, path.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_INPUT_H
#define GLINT_TOOLS_LIVE_LIVE_INPUT_H

#include "linux/v4l2.h"
#include "live/live_scene.h"
#include "formats/y4m.h"

enum live_input_kind {
    LIVE_INPUT_CAMERA,
    LIVE_INPUT_FILE,
    LIVE_INPUT_PIPE,
    LIVE_INPUT_TEST
};

struct live_input {
    struct glint_v4l2 camera; /* first: its source is this */
    enum live_input_kind kind;

    /* Private. */
    struct glint_y4m_reader y4m;
    struct live_scene scene;
    int timer; /* of frames; -1: none */
    int64_t n; /* the next frame */
};

enum live_input_kind live_input_kind(const char *device);

/* Tells what can be told before there is a lens. GLINT_E_DEVICE, _IO. */
enum glint_status live_input_look(const char *name, struct glint_error *error);

/* Opens what WISH names; IO and N_BUFFERS are a camera's, SEED the test's. Once
 * a stand-in has come to its end, next fails with GLINT_E_CLOSED. */
enum glint_status live_input_open(struct live_input *input,
                                  const struct glint_v4l2_config *wish,
                                  enum glint_v4l2_io io, int n_buffers,
                                  uint32_t seed, struct glint_error *error);

#endif
