/* SPDX-License-Identifier: MIT
 *
 * What a fresh model is like, for people and for programs.
 */
#ifndef GLINT_TOOLS_MODEL_REPORT_H
#define GLINT_TOOLS_MODEL_REPORT_H

#include "glint/glint.h"

void model_report_text(const struct glint_lens *lens, double seconds,
                       const struct glint_bake_report *report, bool all);
void model_report_json(const struct glint_lens *lens, double seconds,
                       const struct glint_bake_report *report);

#endif
