/* SPDX-License-Identifier: MIT
 *
 * --stop-mask and --front-mask: reads an image by which the light at the stop,
 * or at the front element, is multiplied.
 */
#ifndef GLINT_TOOLS_MODEL_STOP_MASK_H
#define GLINT_TOOLS_MODEL_STOP_MASK_H

#include <stdint.h>

#include "options/tool.h"

/* A mask in memory. luma is NULL if there is no mask. */
struct stop_mask {
    uint8_t *luma; /* luma codes, [height][width] */
    int width, height;
};

/* Reads the luma of the image FILE into MASK; the caller frees its luma,
 * which is NULL on failure. Returns an exit code. */
int stop_mask_read_image(const struct tool *tool, const char *file,
                         struct stop_mask *mask);

#endif
