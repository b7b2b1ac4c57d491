/* SPDX-License-Identifier: MIT
 *
 * Checks the options of a bake and works out the field. The defaults and the
 * key are in glint/bake.h. */
#ifndef GLINT_BAKE_OPTIONS_H
#define GLINT_BAKE_OPTIONS_H

#include "glint/bake.h"

/* Checks OPTIONS. GLINT_E_ARGUMENT: one is out of range, and ERROR says which.
 */
enum glint_status glint_bake_check(const struct glint_bake_options *options,
                                   struct glint_error *error);

/* Returns the field that is asked for, or a tenth more than to the film's
 * corners. */
double glint_bake_field_mm(const struct glint_prescription *lens,
                           const struct glint_bake_options *options);

#endif
