/* SPDX-License-Identifier: MIT
 *
 * What a baked lens is, for people and, after --json, for programs.
 */
#ifndef GLINT_TOOLS_MODEL_MODEL_REPORT_H
#define GLINT_TOOLS_MODEL_MODEL_REPORT_H

#include "model/model_file.h"
#include "options/tool.h"

/* All that the file says; after -v each system. */
void model_report_info(const struct tool *tool, const struct model_file *model);

/* A model just made in SECONDS: the ghosts that miss a target (after -v all),
 * and the sums. Nothing after -q. */
void model_report_bake(const struct tool *tool, const struct glint_lens *lens,
                       double seconds, const struct glint_bake_report *report);

#endif
