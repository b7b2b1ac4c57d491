/* SPDX-License-Identifier: MIT
 *
 * Responses of lenses, measured when first needed and kept beside the models.
 *
 * An entry is found by a key of the model, of the parts of a scene that its
 * brightness depends on, and of this program's version. It is some 800 bytes;
 * one that is damaged, or of another format, is measured and written anew.
 * Where no file can be written, nothing is kept, nor is it for exact rays,
 * which have no model.
 */
#ifndef GLINT_TOOLS_MODEL_RESPONSE_CACHE_H
#define GLINT_TOOLS_MODEL_RESPONSE_CACHE_H

#include "engine/response.h"
#include "options/tool.h"

/* Sets RESPONSE to that of glint_response_measure() for LIKE with BYTES of
 * memory: read where it is kept, else measured and kept. LENS is the name of
 * the lens. If TOOL is verbose, prints which it was. GLINT_E_MEMORY. */
enum glint_status response_cached(const struct tool *tool, const char *lens,
                                  const struct glint_frame *like, size_t bytes,
                                  struct glint_response *response);

#endif
