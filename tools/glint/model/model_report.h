/* SPDX-License-Identifier: MIT
 *
 * Reports on baked lenses, as text or, with --json, as JSON.
 */
#ifndef GLINT_TOOLS_MODEL_MODEL_REPORT_H
#define GLINT_TOOLS_MODEL_MODEL_REPORT_H

#include "model/model_file.h"
#include "model/picture_check.h"
#include "options/tool.h"

/* Prints a summary of the model; with -v also each polynomial system. */
void model_report_print_info(const struct tool *tool,
                             const struct model_file *model);

/* Prints the report of a model that took SECONDS to bake: the ghosts that
 * miss an error target (with -v all ghosts), and totals. With -q it prints
 * no text, only JSON. */
void model_report_print_bake(const struct tool *tool,
                             const struct glint_lens *lens, double seconds,
                             const struct glint_bake_report *report,
                             const struct picture_check *check);

#endif
