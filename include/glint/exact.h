/* SPDX-License-Identifier: MIT
 *
 * glint/exact.h - the exact picture, by which all others are measured. */
#ifndef GLINT_EXACT_H
#define GLINT_EXACT_H

#include "glint/light.h"
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
    int grid; /* cells a side of the grid over each ghost's pupil box, even */
    int only_ghost; /* index of the only ghost that is drawn; -1: all are */
    const struct glint_tint *tints; /* [ghosts of the setup]; NULL: none */
    struct glint_workers *workers;  /* does not change the picture */
    glint_progress_fn *progress;    /* NULL: silent */
    void *progress_ctx;
};

/* Draws the reference picture: every ray in double, each cell clipped exactly
 * by the stop and by every barrel's own circle, coverage by area, energy
 * conserving. RGB is [height][width][3], row 0 on top, in the unit of the
 * lamps' power. GLINT_E_MEMORY: about 100 bytes per cell of one ghost and 24
 * per pixel are needed, or lamps times ghosts times wavelengths are more than
 * 2^24. Deterministic. */
enum glint_status glint_exact_render(const struct glint_exact_config *cfg,
                                     double *rgb);

/* Rays that are traced for each picture: for struct glint_engine_camera. */
struct glint_frame_rays;
extern const struct glint_frame_rays glint_frame_traces;

#ifdef __cplusplus
}
#endif

#endif
