/* SPDX-License-Identifier: MIT
 *
 * Checks the options of a bake and computes the header of a model: the data of
 * the lens except its ghosts. Defaults and key are declared in
 * glint/bake.h.
 */
#ifndef GLINT_BAKE_MODEL_HEADER_H
#define GLINT_BAKE_MODEL_HEADER_H

#include "glint/bake.h"
#include "glint/model.h"
#include "glint/setup.h"

/* Checks OPTIONS. Returns GLINT_E_ARGUMENT if one is out of range; ERROR names
 * it. */
enum glint_status
glint_bake_check_options(const struct glint_bake_options *options,
                         struct glint_error *error);

/* Returns the radius of the image circle within which the model must be
 * accurate, mm: options.field_mm, or if that is 0, 1.1 times the distance from
 * the axis to the film's corners. */
double glint_bake_get_field_radius_mm(const struct glint_prescription *lens,
                                      const struct glint_bake_options *options);

/* Fills all of HEADER except the tables of ghosts and systems. May return
 * GLINT_E_MEMORY. */
enum glint_status
glint_model_set_header(const struct glint_prescription *lens,
                       const struct glint_bake_options *options,
                       const struct glint_setup *setup,
                       struct glint_model_header *header);

#endif
