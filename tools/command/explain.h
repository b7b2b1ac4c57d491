/* SPDX-License-Identifier: MIT
 *
 * What engine/explain.h found, as tables, JSON and a picture.
 */
#ifndef GLINT_TOOLS_COMMAND_EXPLAIN_H
#define GLINT_TOOLS_COMMAND_EXPLAIN_H

#include "engine/explain.h"

/* What OUTCOME means, as a phrase for tables and a word for programs. */
const char *explain_reason(enum glint_outcome outcome);
const char *explain_word(enum glint_outcome outcome);

/* Lights as they were given, and what the picture is. */
struct explain_title {
    const char *lens;
    const struct glint_lamp *lamp;
    int n_lamps;
    bool linear;
    enum glint_explain_order order;
    int top; /* ghosts that are listed, and marked */
    const struct glint_frame_report *report;
};

void explain_print(const struct glint_explain *explain,
                   const struct explain_title *title);
void explain_json(const struct glint_explain *explain,
                  const struct explain_title *title);

/* A new picture, to be freed: PICTURE dimmed, its touched tiles shaded, the
 * first ghosts outlined and numbered, and a legend below. GLINT_E_MEMORY. */
enum glint_status explain_mark(struct glint_explain *explain,
                               const struct explain_title *title,
                               const struct glint_image *picture,
                               struct glint_image *marked);

#endif
