/* SPDX-License-Identifier: MIT
 *
 * The light of lamps that an 8-bit proxy of a deeper picture clips.
 */
#ifndef GLINT_TOOLS_OVERLAY_LAMP_EXCESS_H
#define GLINT_TOOLS_OVERLAY_LAMP_EXCESS_H

#include "formats/samples.h"
#include "glint/engine.h"
#include "lamp_files/lamp_list.h"

/* Sets power, place and colour of N lamps that were found in a proxy of
 * SAMPLES, seen through a lens of FOCAL_MM, with the light beyond WHITE, that
 * of the proxy's code 255. Without memory the lamps stay as found. */
void add_lamp_excess(struct glint_engine_lamp *lamp, int n,
                     const struct glint_samples *samples, double white,
                     const struct glint_view *view, double focal_mm);

#endif
