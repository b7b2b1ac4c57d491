/* SPDX-License-Identifier: MIT
 *
 * glint/bake.h - computes models from lens tables; includes all of the offline
 * half.
 *
 *     glint_bake_defaults(&options);
 *     glint_bake(&lens, &options, &model, &bytes, &report, &error); */
#ifndef GLINT_BAKE_H
#define GLINT_BAKE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/exact.h"
#include "glint/prescription.h"
#include "glint/setup.h"
#include "glint/status.h"
#include "glint/trace.h"
#include "glint/view.h"
#include "glint/workers.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_bake_options {
    double band_nm[2]; /* shortest and longest wavelength, 300 .. 1100 */
    double max_deg;    /* largest angle of a light, above 0, up to 89 */
    double field_mm;   /* radius about the sensor's centre within which light
                          counts; 0: a tenth more than the film's corners */
    /* Scale of all tolerances, 0.1 .. 100. At 1, ghosts as bright as those that
     * set an exposure are fitted to root mean square errors of 0.04 pixels of a
     * film 1920 wide for places and outlines, and of 0.12 % for the energy;
     * faint ghosts to at most 0.07 pixels for places, 0.4 for outlines, and 1.2
     * %. */
    double tolerance;
    /* [ghosts of the lens]: true: bake this ghost; NULL: all. Ghosts that
     * are not baked have no systems in the model. */
    const bool *ghosts;
    /* [n_beside], at most 2: the lens at neighbouring zoom positions. Light
     * that is visible or cut there is part of the model, so that models of
     * positions can be interpolated. GLINT_E_ARGUMENT if it is another lens
     * or not symmetric about its axis. */
    const struct glint_prescription *beside;
    int n_beside;
    struct glint_workers
        *workers; /* parallel-for; NULL: serial. Changes no output */
    /* called after each fit with an estimated fraction, which may fall; may be
     * NULL. */
    glint_progress_fn *progress;
    void *progress_ctx;
};

void glint_bake_defaults(struct glint_bake_options *options);

/* Returns a hash of everything in LENS and OPTIONS that the model depends
 * on; a cache key. */
uint64_t glint_bake_key(const struct glint_prescription *lens,
                        const struct glint_bake_options *options);

/* Sets PROJECTION to the projection of LENS at the d line, from chief rays at
 * whole degrees (finer for narrow lenses) up to 85 degrees or the last ray that
 * gets through. MISS_DEG receives the max error of the polynomial at them.
 * GLINT_E_LENS: LENS is not round, or hardly any light gets through; ERROR
 * states which, and PROJECTION becomes a pinhole's. */
enum glint_status glint_projection_of(struct glint_projection *projection,
                                      const struct glint_prescription *lens,
                                      double *miss_deg,
                                      struct glint_error *error);

/* Results of a bake that are not in its model. */
struct glint_bake_report {
    int rays; /* number of rays measured: those that get through the lens */
    /* number of further rays that the model transmits although the lens
     * clearly blocks them: they miss a surface, or lie more than 3 % outside
     * a surface's semi-diameter or the stop's radius */
    int intruders;
    int unmet; /* number of systems that miss the tolerance */
};

/* Bakes LENS into *MODEL[*BYTES], a file as in glint/model.h, which the
 * caller frees. The same lens and options give the same bytes. With ERROR:
 * GLINT_E_ARGUMENT; GLINT_E_LENS if no light gets through or the overflow
 * proof fails. GLINT_E_MEMORY. */
enum glint_status glint_bake(const struct glint_prescription *lens,
                             const struct glint_bake_options *options,
                             unsigned char **model, size_t *bytes,
                             struct glint_bake_report *report,
                             struct glint_error *error);

/* A model of a zoom lens at one position, 0 .. 2^30. */
struct glint_bake_model {
    unsigned char *data;
    size_t bytes;
    int32_t along_q30;
    const bool *ghosts; /* the option "ghosts" it was baked with; NULL at both
                           ends of the zoom */
};

/* Joins N models of one lens, by rising position from 0 to 2^30, into a file
 * as in glint/model.h, *ZOOM[*BYTES], which the caller frees. GLINT_E_LENS:
 * they are not positions of one lens; ERROR states why. GLINT_E_MEMORY. */
enum glint_status glint_bake_zoom(const struct glint_bake_model *model, int n,
                                  unsigned char **zoom, size_t *bytes,
                                  struct glint_error *error);

#ifdef __cplusplus
}
#endif

#endif
