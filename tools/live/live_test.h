/* SPDX-License-Identifier: MIT
 *
 * live_test.h - live frames without a camera: a night street with sky, houses
 * with lit windows, a lamp with a halo that goes round, and sensor noise; or
 * nothing, black, for scenes that are drawn over it.
 *
 * Frame N of a seed and size is the same picture anywhere.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_TEST_H
#define GLINT_TOOLS_LIVE_LIVE_TEST_H

#include "live/live_timed.h"

struct live_test {
    struct live_timed timed;
    struct glint_image image; /* the last frame, I420 of limited range */
    uint32_t seed;
    bool is_black;
    uint8_t *still; /* luma without lamp and noise */
    void *mem;
};

/* Opens the test picture. WISH may give a size of 16 to GLINT_PANEL_SIDE pixels
 * a side, rate, range and matrix. SEED is for the noise; IS_BLACK: there is
 * nothing. The lamp goes round in eight seconds. On failure TEST is closed.
 * GLINT_E_UNSUPPORTED, GLINT_E_MEMORY, GLINT_E_DEVICE. */
enum glint_status live_test_open(struct live_test *test,
                                 const struct glint_v4l2_config *wish,
                                 uint32_t seed, bool is_black,
                                 struct glint_error *error);

#endif
