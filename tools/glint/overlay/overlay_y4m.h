/* SPDX-License-Identifier: MIT
 *
 * Draws on the frames of a y4m video of any bit depth and layout. Plain 8-bit
 * frames are drawn on in place. In all other formats light is added to the
 * sample planes.
 */
#ifndef GLINT_TOOLS_OVERLAY_OVERLAY_Y4M_H
#define GLINT_TOOLS_OVERLAY_OVERLAY_Y4M_H

#include "overlay/overlay.h"
#include "video/y4m.h"

/* Returns the bytes of a frame of IN, all planes together. */
size_t overlay_y4m_frame_bytes(const struct glint_y4m_reader *in);

/* Draws the flare on the frame that IN read last. IMAGE is an 8-bit copy or
 * view of this frame. Returns an exit code. */
int overlay_y4m_draw(struct tool *tool, struct overlay *o,
                     struct glint_y4m_reader *in,
                     const struct glint_image *image);

/* Frees the buffers that overlay_y4m_draw() stored in O. */
void overlay_y4m_close(struct overlay *o);

#endif
