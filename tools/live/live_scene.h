/* SPDX-License-Identifier: MIT
 *
 * live_scene.h - a night street with a lamp that goes round, for live without a
 * camera: sky, houses with lit windows, a lamp with a halo, noise of a sensor.
 *
 * Frame N of a seed and size is the same picture anywhere.
 */
#ifndef GLINT_TOOLS_LIVE_LIVE_SCENE_H
#define GLINT_TOOLS_LIVE_LIVE_SCENE_H

#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"

struct live_scene {
    struct glint_image image; /* I420 of limited range; of the last frame */

    /* Private. */
    uint32_t seed;
    uint8_t *still; /* luma without lamp and noise */
    void *mem;
};

/* Sides of 16 .. 8192 pixels. GLINT_E_MEMORY. */
enum glint_status live_scene_open(struct live_scene *scene, int width,
                                  int height, uint32_t seed);

/* Draws frame N into scene->image; at PER_SECOND the lamp goes round in eight
 * seconds. */
void live_scene_draw(struct live_scene *scene, int64_t n, double per_second);

void live_scene_close(struct live_scene *scene);

#endif
