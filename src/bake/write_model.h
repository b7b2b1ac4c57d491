/* SPDX-License-Identifier: MIT
 *
 * Writes a model file: header, ghosts, systems, and the tables that these point
 * to.
 */
#ifndef GLINT_BAKE_WRITE_MODEL_H
#define GLINT_BAKE_WRITE_MODEL_H

#include "bake/measure_model.h"
#include "bake/fit/quantise.h"
#include "bake/table/draft.h"
#include "glint/setup.h"

/* Writes the header, the ghosts and their systems from FITTED and QUANTISED,
 * both [n_ghosts]. The errors are set to 0; size and checksum are not set. May
 * return GLINT_E_MEMORY. */
enum glint_status
glint_draft_write_model(struct glint_draft *draft,
                        const struct glint_setup *setup,
                        const struct glint_model_header *header,
                        const struct glint_fitted_ghost *fitted,
                        struct glint_quantised_system *const *quantised);

/* Returns the model in DRAFT as a lens that points into it, without
 * validation. */
struct glint_lens glint_draft_get_lens(const struct glint_draft *draft);

/* Writes MEASURED to the draft as the errors of system number SYSTEM. */
void glint_draft_write_errors(struct glint_draft *draft, int system,
                              const struct glint_measured *measured);

#endif
