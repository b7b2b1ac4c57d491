/* SPDX-License-Identifier: MIT
 *
 * Cache of lens responses: files beside the baked models. If no file can be
 * written, nothing is cached.
 */
#ifndef GLINT_TOOLS_MODEL_RESPONSE_CACHE_H
#define GLINT_TOOLS_MODEL_RESPONSE_CACHE_H

#include "glint/engine.h"
#include "options/tool.h"

/* Returns the cache. If TOOL is verbose, the cache prints for each entry
 * whether it was read or measured. TOOL must outlive the cache. */
struct glint_engine_cache response_cache(const struct tool *tool);

#endif
