/* SPDX-License-Identifier: MIT
 *
 * Checks the options of a bake, and makes the header of a model: what it says
 * of its lens besides the ghosts. The defaults and the key are in glint/bake.h.
 */
#ifndef GLINT_BAKE_MODEL_HEADER_H
#define GLINT_BAKE_MODEL_HEADER_H

#include "glint/bake.h"
#include "glint/model.h"
#include "glint/setup.h"

/* Checks OPTIONS. Returns GLINT_E_ARGUMENT if an option is out of range; ERROR
 * then states which. */
enum glint_status glint_bake_check(const struct glint_bake_options *options,
                                   struct glint_error *error);

/* Returns the field that is requested, or a tenth more than to the film's
 * corners. */
double glint_bake_field_mm(const struct glint_prescription *lens,
                           const struct glint_bake_options *options);

/* Fills HEADER except for ghosts and systems. GLINT_E_MEMORY. */
enum glint_status
glint_model_header_of(const struct glint_prescription *lens,
                      const struct glint_bake_options *options,
                      const struct glint_setup *setup,
                      struct glint_model_header *header);

#endif
