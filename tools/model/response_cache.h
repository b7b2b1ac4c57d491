/* SPDX-License-Identifier: MIT
 *
 * Responses of lenses, measured when first needed and kept beside the models.
 *
 * An entry is found by a key of the model, of what of a scene counts for its
 * brightness, and of this program's version. It is some 800 bytes; one that is
 * damaged, or of another make, is measured and written anew. Where nothing can
 * be kept, nothing is. Of exact rays, which have no model, nothing is kept.
 */
#ifndef GLINT_TOOLS_MODEL_RESPONSE_CACHE_H
#define GLINT_TOOLS_MODEL_RESPONSE_CACHE_H

#include "engine/response.h"
#include "options/tool.h"

/* Gives what glint_response_measure() gives for LIKE, which is measured once;
 * LENS is its name. Tells TOOL which it was, if verbose. GLINT_E_MEMORY. */
enum glint_status response_cached(const struct tool *tool, const char *lens,
                                  const struct glint_frame *like, size_t bytes,
                                  struct glint_response *response);

#endif
