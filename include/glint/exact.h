/* SPDX-License-Identifier: MIT
 *
 * glint/exact.h - the exact picture, the reference for all others. */
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
    int grid; /* cells per side of the grid over each ghost's pupil box, even */
    int only_ghost; /* index of the only ghost that is drawn; -1: all are */
    const struct glint_tint *tints; /* [ghosts of the setup]; NULL: none */
    struct glint_workers *workers;  /* parallel-for; changes no output */
    glint_progress_fn *progress;    /* NULL: silent */
    void *progress_ctx;
};

/* Draws the reference picture: every ray in double precision, each cell
 * clipped exactly by the stop and by every barrel's circle, coverage by
 * area, conserving energy. RGB is [height][width][3], row 0 on top, in the
 * unit of the lamps' power. Deterministic. GLINT_E_MEMORY: about 100 bytes
 * per cell of one ghost and 24 per pixel are needed, or lamps x ghosts x
 * wavelengths exceed 2^24. */
enum glint_status glint_exact_render(const struct glint_exact_config *cfg,
                                     double *rgb);

/* Exact rays for each picture: for struct glint_engine_camera. */
struct glint_frame_rays;
extern const struct glint_frame_rays glint_frame_traces;

#ifdef __cplusplus
}
#endif

#endif
