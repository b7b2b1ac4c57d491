/* SPDX-License-Identifier: MIT
 *
 * Prints the results of engine/explain.h as tables, JSON and a picture. */
#ifndef GLINT_TOOLS_COMMAND_EXPLAIN_H
#define GLINT_TOOLS_COMMAND_EXPLAIN_H

#include "glint/explain.h"

/* Returns OUTCOME as a phrase for tables. */
const char *explain_outcome_reason(enum glint_outcome outcome);

/* Inputs of the frame: lens, given lights, and type of picture */
struct explain_title {
    const char *lens;
    const struct glint_engine_lamp *lamp;
    int n_lamps;
    bool linear;
    int top; /* max ghosts and lights to list, and ghosts to mark */
    const struct glint_engine_report *report;
    /* engine that searched the picture for lamps; NULL: none */
    const struct glint_engine *engine;
};

void explain_print_tables(const struct glint_explain *explain,
                          const struct explain_title *title);
void explain_write_json(const struct glint_explain *explain,
                        const struct explain_title *title);

/* Sets MARKED to a new picture, whose plane[0] the caller frees: PICTURE
 * dimmed, with tiles that have flare shaded and the first ghosts outlined and
 * numbered, above a legend. Returns GLINT_E_MEMORY on failure. */
enum glint_status explain_draw_marks(struct glint_explain *explain,
                                     const struct explain_title *title,
                                     const struct glint_image *picture,
                                     struct glint_image *marked);

#endif
