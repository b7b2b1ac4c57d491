/* SPDX-License-Identifier: MIT
 *
 * Exact pictures, which take long and so are kept where models are.
 */
#ifndef GLINT_TOOLS_LAB_SWEEP_EXACT_H
#define GLINT_TOOLS_LAB_SWEEP_EXACT_H

#include "lab/canvas.h"

/* Draws TO as canvas_exact() does, or loads it where it is kept. TO->rgb is the
 * caller's memory. */
enum glint_status sweep_exact(const struct tool *tool,
                              const struct settings *settings,
                              const struct glint_lamp *lamp, int n_lamps,
                              int grid, struct glint_float_image *to);

#endif
