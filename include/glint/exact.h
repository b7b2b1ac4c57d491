/* SPDX-License-Identifier: MIT
 *
 * glint/exact.h - the exact picture: what all others are measured by.
 */
#ifndef GLINT_EXACT_H
#define GLINT_EXACT_H

#include "glint/setup.h"
#include "glint/status.h"
#include "glint/view.h"
#include "glint/workers.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_exact_config {
    const struct glint_setup *setup;
    struct glint_view view;
    const struct glint_lamp *lamps;
    int n_lamps;
    int grid;       /* cells a side over each ghost's pupil box, even */
    int only_ghost; /* -1: all */
    struct glint_workers *workers; /* never changes the picture */
    glint_progress_fn *progress;   /* NULL: silent */
    void *progress_ctx;
};

/* The reference picture: every ray in double, each cell clipped exactly by the
 * stop and by every barrel's own circle, coverage by area, energy conserving.
 * RGB is [height][width][3], row 0 on top; values are what the lamps' POWER
 * says. GLINT_E_MEMORY: it needs about 100 bytes per cell of one ghost and 24
 * per pixel, or lamps times ghosts times wavelengths are more than 2^24.
 * Deterministic. */
enum glint_status glint_exact_render(const struct glint_exact_config *cfg,
                                     double *rgb);

#ifdef __cplusplus
}
#endif

#endif
