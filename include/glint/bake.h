/* SPDX-License-Identifier: MIT
 *
 * glint/bake.h - computes models from lens tables. Includes all headers of the
 * offline half.
 *
 *     glint_bake_defaults(&options);
 *     glint_bake(&lens, &options, &model, &bytes, &report, &error);
 */
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
    double band_nm[2]; /* shortest and longest wavelength, nm, 300 .. 1100 */
    double max_deg;    /* max angle of a light off the axis, degrees, above 0,
                          up to 89 */
    /* Radius around the sensor's centre within which the model is accurate, mm.
     * 0: 1.1 times the distance from the centre to the corners of the image
     * area (film) that the lens table states. */
    double field_mm;
    /* Factor on all tolerances, 0.1 .. 100. At 1, RMS errors of the brightest
     * ghosts are 0.04 pixels (of a picture 1920 pixels wide) for positions and
     * outlines, and 0.12 % for the energy. Errors of faint ghosts may reach
     * 0.07 pixels for positions, 0.4 pixels for outlines, and 1.2 % for the
     * energy. */
    double tolerance;
    /* Which ghosts of the lens are baked, [ghosts of the lens]; NULL: all. The
     * model has no polynomials for other ghosts. */
    const bool *ghosts;
    /* [n_beside], at most 2: the same lens at neighbouring zoom positions. The
     * model also includes light and barrels that matter only at these
     * positions. Models of several positions can then be interpolated.
     * glint_bake() returns GLINT_E_ARGUMENT if the entries are not positions of
     * this lens, or not symmetric about the axis. */
    const struct glint_prescription *beside;
    int n_beside;
    /* Worker threads; NULL: one thread. The output is the same for any number
     * of threads. */
    struct glint_workers *workers;
    /* Called after each fit with the estimated fraction of the work that is
     * done, which may decrease; may be NULL. */
    glint_progress_fn *progress;
    void *progress_ctx;
    /* Called by several workers at once: before each ghost with WORK 0, and
     * after each fit with the work of the fit. A fit has 1 or 2 units of work;
     * a unit is about 40 ms of processor time. The sum does not depend on the
     * number of workers. If ALLOW returns false, glint_bake() ends and returns
     * GLINT_E_UNSUPPORTED with an empty ERROR. NULL: no limit. */
    bool (*allow)(void *ctx, int work);
    void *allow_ctx;
};

void glint_bake_defaults(struct glint_bake_options *options);

/* Returns a hash of everything in LENS and OPTIONS that the model depends
 * on; a cache key. */
uint64_t glint_bake_key(const struct glint_prescription *lens,
                        const struct glint_bake_options *options);

/* Sets PROJECTION to the projection of LENS at the d line. It is fitted to
 * chief rays at whole degrees (smaller steps for narrow lenses) up to 85
 * degrees or the last ray that passes the lens. Sets *MISS_DEG to the max error
 * of the projection at these rays, degrees. Returns GLINT_E_LENS if LENS is not
 * round, or if hardly any light passes; then ERROR states the cause, and
 * PROJECTION is that of a pinhole. */
enum glint_status glint_projection_of(struct glint_projection *projection,
                                      const struct glint_prescription *lens,
                                      double *miss_deg,
                                      struct glint_error *error);

/* Results of a bake that are not stored in the model. */
struct glint_bake_report {
    /* Number of rays at which errors were measured; all of them pass the
     * lens. */
    int rays;
    /* number of further rays, which the model transmits although the lens
     * clearly blocks them: they miss a surface, or pass more than 3 % outside a
     * surface's semi-diameter or the stop's radius */
    int intruders;
    int unmet; /* number of systems whose errors exceed the tolerance */
};

/* Bakes LENS into the model file *MODEL[*BYTES] (format: glint/model.h),
 * which the caller frees. The same lens and options give the same bytes.
 * Returns GLINT_E_ARGUMENT if OPTIONS are out of range, and GLINT_E_LENS if
 * no light passes the lens or if integer overflow cannot be excluded by
 * proof; both set ERROR. May return GLINT_E_MEMORY. */
enum glint_status glint_bake(const struct glint_prescription *lens,
                             const struct glint_bake_options *options,
                             unsigned char **model, size_t *bytes,
                             struct glint_bake_report *report,
                             struct glint_error *error);

/* Appends NOTE to the model *MODEL[*BYTES] of glint_bake(), which may move.
 * Returns GLINT_E_MEMORY and changes nothing if there is no memory. */
enum glint_status glint_bake_add_note(const struct glint_model_note *note,
                                      unsigned char **model, size_t *bytes);

/* A model of a zoom lens, and its zoom position along_q30, 0 .. 2^30. */
struct glint_bake_model {
    unsigned char *data;
    size_t bytes;
    int32_t along_q30;
    /* the ghosts that were baked, as in glint_bake_options.ghosts; NULL at both
     * ends of the zoom, whose models have all ghosts */
    const bool *ghosts;
};

/* Joins N models of one zoom lens, sorted by ascending position from 0 to
 * 2^30, into the file *ZOOM[*BYTES] (format: glint/model.h), which the
 * caller frees. Returns GLINT_E_LENS if the models are not positions of one
 * lens; ERROR states the cause. May return GLINT_E_MEMORY. */
enum glint_status glint_bake_zoom(const struct glint_bake_model *model, int n,
                                  unsigned char **zoom, size_t *bytes,
                                  struct glint_error *error);

#ifdef __cplusplus
}
#endif

#endif
