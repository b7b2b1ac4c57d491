/* SPDX-License-Identifier: MIT
 *
 * --stop, --stop-mask and --dust: the stop that lights are seen through.
 */
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
    bool is_asked;         /* the line names a shape */
    const char *mask_file; /* NULL: none */
};

/* A mask that was read; luma NULL: none. */
struct stop_mask {
    uint8_t *luma; /* [height][width] */
    int width, height;
};

/* Returns whether the stop has more than an outline. */
bool stop_option_shades(const struct stop_option *stop);

/* Reads the luma of the picture in FILE into MASK, whose luma the caller frees;
 * NULL after a failure. Returns an exit code. */
int stop_mask_read(const struct tool *tool, const char *file,
                   struct stop_mask *mask);

/* Gives SETUP the iris of STOP. *DIRT receives what it refers to, or NULL. */
enum glint_status stop_option_set(const struct stop_option *stop,
                                  struct glint_setup *setup,
                                  struct glint_dirt **dirt,
                                  struct glint_error *error);

#endif
