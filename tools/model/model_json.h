/* SPDX-License-Identifier: MIT
 *
 * Reports on baked lenses as JSON. Part of model_report.h.
 */
#ifndef GLINT_TOOLS_MODEL_MODEL_JSON_H
#define GLINT_TOOLS_MODEL_MODEL_JSON_H

#include "model/model_file.h"
#include "options/tool.h"

void model_json_info(const struct tool *tool, const struct model_file *model);
void model_json_bake(const struct glint_lens *lens, double seconds,
                     const struct glint_bake_report *report);

#endif
