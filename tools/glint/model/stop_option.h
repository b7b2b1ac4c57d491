/* SPDX-License-Identifier: MIT
 *
 * --stop, --stop-mask and --dust: shape, mask and dust of the aperture stop. */
#ifndef GLINT_TOOLS_MODEL_STOP_OPTION_H
#define GLINT_TOOLS_MODEL_STOP_OPTION_H

#include <stdbool.h>
#include <stdint.h>

#include "glint/setup.h"
#include "options/tool.h"

struct stop_option {
    int n_blades;
    double rotation_deg;
    struct glint_iris iris;
    bool is_asked;         /* the command line sets a shape */
    const char *mask_file; /* NULL: none */
};

/* A mask as it was read. luma is NULL if there is no mask. */
struct stop_mask {
    uint8_t *luma; /* [height][width] */
    int width, height;
};

/* Returns whether the stop has a soft edge, dust or a mask. */
bool stop_option_shades(const struct stop_option *stop);

/* Reads the luma of the picture in FILE into MASK, whose luma the caller frees;
 * luma is NULL on failure. Returns an exit code. */
int stop_mask_read(const struct tool *tool, const char *file,
                   struct stop_mask *mask);

/* Sets the iris of SETUP to STOP. *DIRT receives the dirt that the iris refers
 * to, which the caller frees, or NULL. */
enum glint_status stop_option_set(const struct stop_option *stop,
                                  struct glint_setup *setup,
                                  struct glint_dirt **dirt,
                                  struct glint_error *error);

#endif
