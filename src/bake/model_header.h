/* SPDX-License-Identifier: MIT
 *
 * Makes the header of a model: what it says of its lens besides the ghosts. */
#ifndef GLINT_BAKE_MODEL_HEADER_H
#define GLINT_BAKE_MODEL_HEADER_H

#include "glint/bake.h"
#include "glint/model.h"
#include "glint/setup.h"

/* Fills HEADER except for ghosts and systems. GLINT_E_MEMORY. */
enum glint_status
glint_model_header_of(const struct glint_prescription *lens,
                      const struct glint_bake_options *options,
                      const struct glint_setup *setup,
                      struct glint_model_header *header);

#endif
