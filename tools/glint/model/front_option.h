/* SPDX-License-Identifier: MIT
 *
 * --front-dust and --front-mask: dirt on the front element. */
#ifndef GLINT_TOOLS_MODEL_FRONT_OPTION_H
#define GLINT_TOOLS_MODEL_FRONT_OPTION_H

#include <stdbool.h>

#include "glint/setup.h"
#include "options/tool.h"

struct front_option {
    struct glint_front front;
    const char *mask_file; /* NULL: none */
};

/* Returns whether anything was requested. */
static inline bool front_option_asked(const struct front_option *option)
{
    return option->front.dust > 0 || option->mask_file;
}

/* Sets *DIRT to the requested dirt, after reading the mask's file; the caller
 * frees it. *DIRT is NULL if none was requested. Returns an exit code. */
int front_option_open(const struct tool *tool,
                      const struct front_option *option,
                      struct glint_front_dirt **dirt);

#endif
