/* SPDX-License-Identifier: MIT
 *
 * Reports on baked lenses, as text or, with --json, as JSON.
 */
#ifndef GLINT_TOOLS_MODEL_MODEL_REPORT_H
#define GLINT_TOOLS_MODEL_MODEL_REPORT_H

#include "model/model_file.h"
#include "options/tool.h"

/* Prints all that the file holds, with -v also each system. */
void model_report_info(const struct tool *tool, const struct model_file *model);

/* Prints the report of a model baked in SECONDS: the ghosts that miss a target
 * (with -v all), and sums; as text nothing with -q. */
void model_report_bake(const struct tool *tool, const struct glint_lens *lens,
                       double seconds, const struct glint_bake_report *report);

#endif
