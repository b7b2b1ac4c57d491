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

/* Writes header, ghosts, and systems from FITTED and QUANTISED [n_ghosts].
 * Sets errors to 0; does not set size and checksum. May return
 * GLINT_E_MEMORY. */
enum glint_status
glint_draft_write(struct glint_draft *draft, const struct glint_setup *setup,
                  const struct glint_model_header *header,
                  const struct glint_fitted_ghost *fitted,
                  struct glint_quantised_system *const *quantised);

/* Returns a view of the draft as a lens, without validation. */
struct glint_lens glint_draft_lens(const struct glint_draft *draft);

/* Writes MEASURED as the errors of system SYSTEM. */
void glint_draft_note(struct glint_draft *draft, int system,
                      const struct glint_measured *measured);

#endif
