/* SPDX-License-Identifier: MIT
 *
 * The two parts of the check of a model: model.c, its header and ghosts, and
 * model_system.c, its systems.
 */
#ifndef GLINT_LENS_MODEL_CHECK_H
#define GLINT_LENS_MODEL_CHECK_H

#include "base/blob.h"
#include "glint/model.h"

/* limit of sums of magnitudes, and 1 in _q30 */
enum { MODEL_LIMIT = 1 << 30 };

struct glint_model_check {
    struct glint_blob blob;
    const struct glint_model_header *header;
    const struct glint_model_ghost *ghost;
    const struct glint_model_system *system;
};

extern const char glint_model_outside[]; /* "a table lies outside ..." */

/* Returns a text that says what is wrong with system S, or NULL. */
const char *glint_model_check_system(struct glint_model_check *check,
                                     const struct glint_model_system *s);

#endif
