/* SPDX-License-Identifier: MIT
 *
 * Measures the light of lamps that an 8-bit proxy of a deeper picture clips. */
#ifndef GLINT_TOOLS_OVERLAY_LAMP_EXCESS_H
#define GLINT_TOOLS_OVERLAY_LAMP_EXCESS_H

#include "formats/samples.h"
#include "glint/engine.h"
#include "lamp_files/lamp_list.h"

/* Corrects power, position and colour of N lamps that were found in an 8-bit
 * proxy of SAMPLES, for a lens of FOCAL_MM, by the light above WHITE, the light
 * of the proxy's code 255. If there is no memory, the lamps are unchanged. */
void add_lamp_excess(struct glint_engine_lamp *lamp, int n,
                     const struct glint_samples *samples, double white,
                     const struct glint_view *view, double focal_mm);

#endif
