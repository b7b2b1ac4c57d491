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
    bool is_asked;           /* the line names a shape */
    struct glint_dirt *dirt; /* of the setup that was made last */
    const char *mask_file;   /* NULL: none */
    uint8_t *mask;
};

/* Returns whether the stop has more than an outline. */
bool stop_option_shades(const struct stop_option *stop);

/* Reads the luma of the picture in FILE, HEIGHT rows of WIDTH, into *MASK,
 * which the caller frees; NULL after a failure. */
int stop_mask_read(const struct tool *tool, const char *file, uint8_t **mask,
                   int *width, int *height);

/* Reads the mask that was requested. */
int stop_option_open(const struct tool *tool, struct stop_option *stop);

/* Gives SETUP the iris of STOP. *DIRT receives what it refers to, or NULL. */
enum glint_status stop_option_set(const struct stop_option *stop,
                                  struct glint_setup *setup,
                                  struct glint_dirt **dirt,
                                  struct glint_error *error);

void stop_option_close(struct stop_option *stop);

#endif
