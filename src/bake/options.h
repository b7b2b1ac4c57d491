/* SPDX-License-Identifier: MIT
 *
 * What options of a bake come to. The defaults and the key are in glint/bake.h.
 */
#ifndef GLINT_BAKE_OPTIONS_H
#define GLINT_BAKE_OPTIONS_H

#include "glint/bake.h"

/* GLINT_E_ARGUMENT: one is out of range, and ERROR says which. */
enum glint_status glint_bake_check(const struct glint_bake_options *options,
                                   struct glint_error *error);

/* The field that is asked for, or a tenth more than the film's corners. */
double glint_bake_field_mm(const struct glint_prescription *lens,
                           const struct glint_bake_options *options);

#endif
