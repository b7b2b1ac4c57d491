/* SPDX-License-Identifier: MIT
 *
 * Frames of a y4m video of any depth and layout: plain ones of 8 bits are drawn
 * on in place, to the planes of all others light is added.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_Y4M_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_Y4M_H

#include "overlay/overlay.h"
#include "video/y4m.h"

/* Returns the bytes of all planes of a frame of IN. */
size_t overlay_y4m_bytes(const struct glint_y4m_reader *in);

/* Puts the flare on the frame that IN has just read and shows as IMAGE. Returns
 * an exit code. */
int overlay_y4m_draw(struct tool *tool, struct overlay *o,
                     struct glint_y4m_reader *in,
                     const struct glint_image *image);

/* Frees the memory that overlay_y4m_draw() keeps in O. */
void overlay_y4m_close(struct overlay *o);

#endif
