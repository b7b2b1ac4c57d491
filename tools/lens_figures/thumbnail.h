/* SPDX-License-Identifier: MIT
 *
 * thumbnail.h - small pictures of a lens's flare, for pages.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_THUMBNAIL_H
#define GLINT_TOOLS_LENS_FIGURES_THUMBNAIL_H

#include <stdio.h>

#include "model/settings.h"

/* Writes to FILE an <img> each of the flare of a lamp at 0.25, 0.5 and 0.8 of
 * the way to the film's corner. SETTINGS are those of a run without options,
 * NAME is the lens; its model should be baked, or rays are exact. MODEL_BYTES
 * receives how large that is, 0 if there is none. Returns an exit code, after
 * printing the reason on failure. */
int thumbnails_write(const struct tool *tool, struct settings *settings,
                     const char *name, FILE *file, size_t *model_bytes);

#endif
