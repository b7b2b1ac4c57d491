/* SPDX-License-Identifier: MIT
 *
 * layout.h - what files an item has, and where: plain, or as the loaders of
 * published data sets look for them.
 */
#ifndef GLINT_TOOLS_SYNTH_LAYOUT_H
#define GLINT_TOOLS_SYNTH_LAYOUT_H

#include "synth/draw.h"

enum { SYNTH_MAX_FILES = 6, SYNTH_PATH_BYTES = 4096 };

/* One file of each item. */
struct synth_file {
    const char *folder,
        *prefix;     /* "in/put/" and what comes before the number */
    unsigned layers; /* summed, a bit each of enum synth_layer; 0: the share
                        that lights cover */
    bool is_noisy;   /* as a sensor sees it */
};

struct synth_layout {
    const char *name, *type; /* type of file unless another is asked for */
    struct synth_file file[SYNTH_MAX_FILES]; /* up to one without a folder */
};

/* Returns the layout NAME, or NULL. */
const struct synth_layout *synth_layout_named(const char *name);

/* Sets PATH to FILE of item NUMBER in FOLDER. Returns false if that is too
 * long. */
bool synth_layout_path(char path[SYNTH_PATH_BYTES], const char *folder,
                       const struct synth_file *file, int number,
                       const char *type);

#endif
