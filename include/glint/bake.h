/* SPDX-License-Identifier: MIT
 *
 * glint/bake.h - lens tables to models; and all of the offline half.
 *
 *     glint_bake_defaults(&options);
 *     glint_bake(&lens, &options, &model, &bytes, &report, &error);
 */
#ifndef GLINT_BAKE_H
#define GLINT_BAKE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/exact.h"
#include "glint/prescription.h"
#include "glint/setup.h"
#include "glint/status.h"
#include "glint/trace.h"
#include "glint/traced_bundle.h"
#include "glint/view.h"
#include "glint/workers.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_bake_options {
    int basis;         /* enum glint_basis */
    double band_nm[2]; /* shortest and longest wavelength, 300 .. 1100 */
    double max_deg;    /* largest angle of a light, above 0, up to 89 */
    double field_mm;   /* radius on the sensor within which light counts; 0: a
                          tenth more than the film's corners */
    double tolerance;  /* scale of all errors aimed at, 0.1 .. 100; at 1 the
                          root mean squares for ghosts that are as bright as
                          counts are 0.03 pixels of a film 1920 wide, as much
                          for the outline, and 0.06 % of energy; for faint
                          ones up to 0.056 and 0.3 pixels and 0.6 % */
    struct glint_workers *workers; /* never changes the model */
    glint_progress_fn *progress;   /* NULL: silent */
    void *progress_ctx;
};

void glint_bake_defaults(struct glint_bake_options *options);

/* A model is known by this key of LENS and OPTIONS. */
uint64_t glint_bake_key(const struct glint_prescription *lens,
                        const struct glint_bake_options *options);

/* The figures of a bake that its model does not tell. */
struct glint_bake_report {
    int rays;      /* measured */
    int intruders; /* measured rays that pass the model though the real lens
                      cuts them, by more than 3 % of a radius */
    int unmet;     /* number of systems that miss the tolerance */
};

/* Bakes LENS into *MODEL of *BYTES, to be freed by the caller: a file as in
 * glint/model.h. The same lens and options give the same bytes.
 * GLINT_E_ARGUMENT, GLINT_E_LENS (no light gets through, or the proof that no
 * integer overflows fails) with ERROR, GLINT_E_MEMORY. */
enum glint_status glint_bake(const struct glint_prescription *lens,
                             const struct glint_bake_options *options,
                             unsigned char **model, size_t *bytes,
                             struct glint_bake_report *report,
                             struct glint_error *error);

#ifdef __cplusplus
}
#endif

#endif
