/* SPDX-License-Identifier: MIT
 *
 * Frames of a y4m video in whatever depth and layout they come: those of 8 bits
 * are drawn on as they are, light is added to the planes of others.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_Y4M_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_Y4M_H

#include "overlay/overlay.h"
#include "video/y4m.h"

/* Bytes of IN's planes. */
size_t overlay_y4m_bytes(const struct glint_y4m_reader *in);

/* Puts the flare on the frame that IN has just read and shows as IMAGE. Returns
 * an exit code. */
int overlay_y4m_draw(struct tool *tool, struct overlay *o,
                     struct glint_y4m_reader *in,
                     const struct glint_image *image);

/* Frees what that keeps in O from frame to frame. */
void overlay_y4m_close(struct overlay *o);

#endif
