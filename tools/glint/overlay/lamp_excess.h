/* SPDX-License-Identifier: MIT
 *
 * Measures the light of lamps that is clipped in the 8-bit proxy of a picture
 * with more bits. */
#ifndef GLINT_TOOLS_OVERLAY_LAMP_EXCESS_H
#define GLINT_TOOLS_OVERLAY_LAMP_EXCESS_H

#include "formats/samples.h"
#include "glint/engine.h"
#include "lamp_files/lamp_list.h"

/* Corrects power, position and colour of LAMP[N], which were detected in a
 * proxy, an 8-bit copy of SAMPLES. Adds to each lamp its light above WHITE, the
 * linear light of the proxy's code 255. FOCAL_MM is the focal length of the
 * lens. Without memory nothing changes. */
void add_lamp_excess(struct glint_engine_lamp *lamp, int n,
                     const struct glint_samples *samples, double white,
                     const struct glint_view *view, double focal_mm);

#endif
