/* SPDX-License-Identifier: MIT
 *
 * Writes a model: header, ghosts, systems, and behind them what they point to.
 */
#ifndef GLINT_BAKE_WRITE_MODEL_H
#define GLINT_BAKE_WRITE_MODEL_H

#include "bake/measure_model.h"
#include "bake/fit/quantise.h"
#include "glint/setup.h"

/* A model in the making; owned. */
struct glint_draft {
    unsigned char *data;
    size_t bytes, room;
    bool out_of_memory;
};

/* Lays out FITTED and QUANTISED [n_ghosts]; the errors are 0, size and CRC are
 * not set yet. GLINT_E_MEMORY. */
enum glint_status
glint_draft_write(struct glint_draft *draft, const struct glint_setup *setup,
                  const struct glint_model_header *header,
                  const struct glint_fitted_ghost *fitted,
                  struct glint_quantised_system *const *quantised);

/* The draft as a lens, not checked. */
struct glint_lens glint_draft_lens(const struct glint_draft *draft);

/* Notes what was measured of SYSTEM. */
void glint_draft_note(struct glint_draft *draft, int system,
                      const struct glint_measured *measured);

/* Sets size and CRC: the model is done. */
void glint_draft_close(struct glint_draft *draft);

#endif
