/* SPDX-License-Identifier: MIT
 *
 * How many frames a GIF has, as one frame is a picture and more are a video. */
#ifndef GLINT_PLATFORM_FORMATS_GIF_H
#define GLINT_PLATFORM_FORMATS_GIF_H

/* Returns the number of frames of the GIF NAME, which it reads; 0 if NAME is no
 * GIF. */
int glint_gif_frames(const char *name);

#endif
