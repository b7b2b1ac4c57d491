/* SPDX-License-Identifier: MIT
 *
 * --front-dust and --front-mask: what lies on the front element.
 */
#ifndef GLINT_TOOLS_MODEL_FRONT_OPTION_H
#define GLINT_TOOLS_MODEL_FRONT_OPTION_H

#include <stdbool.h>

#include "glint/setup.h"
#include "options/tool.h"

struct front_option {
    struct glint_front front;
    const char *mask_file;         /* NULL: none */
    struct glint_front_dirt *dirt; /* NULL: there is none */
};

/* Returns whether anything was requested. */
static inline bool front_option_asked(const struct front_option *option)
{
    return option->front.dust > 0 || option->mask_file;
}

/* Reads the mask and makes what was requested. */
int front_option_open(const struct tool *tool, struct front_option *option);

void front_option_close(struct front_option *option);

#endif
