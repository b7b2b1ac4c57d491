/* SPDX-License-Identifier: MIT
 *
 * Cache of lens responses (brightness of a lens's flare by angle), in the
 * folder of baked models. If no file can be written, responses are measured in
 * every run.
 */
#ifndef GLINT_TOOLS_MODEL_RESPONSE_CACHE_H
#define GLINT_TOOLS_MODEL_RESPONSE_CACHE_H

#include "glint/engine.h"
#include "options/tool.h"

/* Returns the callbacks of the cache. TOOL must outlive them. With -v the cache
 * prints for each response whether it was read or measured. */
struct glint_engine_cache response_cache_callbacks(const struct tool *tool);

#endif
