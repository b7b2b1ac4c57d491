/* SPDX-License-Identifier: MIT
 *
 * What a baked lens is, for glint info.
 */
#ifndef GLINT_TOOLS_INFO_MODEL_H
#define GLINT_TOOLS_INFO_MODEL_H

#include "tool.h"

/* Prints the model at PATH as TOOL's options say. Returns the exit code. */
int info_model(const struct tool *tool, const char *path);

#endif
