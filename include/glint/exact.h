/* SPDX-License-Identifier: MIT
 *
 * glint/exact.h - draws pictures by exact ray tracing, as the reference for all
 * other methods. */
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
    int grid; /* number of cells per side of the ray grid over each ghost's
                 pupil, even */
    int only_ghost; /* index of the only ghost that is drawn; -1: all ghosts */
    /* Tints of the ghosts, [ghosts of the setup]; NULL: no ghost is tinted. */
    const struct glint_tint *tints;
    /* Worker threads; NULL: one thread. The output is the same for any number
     * of threads. */
    struct glint_workers *workers;
    glint_progress_fn *progress; /* receives the progress; may be NULL */
    void *progress_ctx;
};

/* Draws the reference picture to RGB, [height][width][3], row 0 on top, in the
 * unit of the lamps' power. Every ray is traced in double precision. Each cell
 * of the ray grid is clipped exactly by the stop and by the circles of all
 * barrels, and its light is distributed over pixels by area, so that energy is
 * conserved. The result is deterministic. Returns GLINT_E_MEMORY if there is no
 * memory for about 100 bytes per cell of one ghost and 24 bytes per pixel, or
 * if lamps x ghosts x wavelengths exceed 2^24. */
enum glint_status glint_exact_render(const struct glint_exact_config *cfg,
                                     double *rgb);

/* Ray source that traces exact rays for each picture, for
 * glint_engine_camera.rays. */
struct glint_frame_rays;
extern const struct glint_frame_rays glint_frame_traces;

#ifdef __cplusplus
}
#endif

#endif
