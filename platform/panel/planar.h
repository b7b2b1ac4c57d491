/* SPDX-License-Identifier: MIT
 *
 * panel/planar.h - any 8-bit picture as planes of Y', Cb, Cr, for files.
 *
 * Samples of packed and half-packed formats are moved, not computed.
 * RGB becomes GLINT_I444 by the matrix and range of the result, rounded to the
 * nearest code.
 */
#ifndef GLINT_PLATFORM_PANEL_PLANAR_H
#define GLINT_PLATFORM_PANEL_PLANAR_H

#include <stddef.h>

#include "glint/image.h"
#include "panel/row_rgb.h"

/* Returns the format of planes that keeps all samples of FORMAT, which is not
 * GLINT_LINEAR_Q20: GLINT_GREY, _I420, _I422 or _I444. */
enum glint_pixel_format glint_planar_format(enum glint_pixel_format format);

/* Fills the planes of TO, which has FROM's size and glint_planar_format(), from
 * FROM. ROW is work memory for that width. */
void glint_planar_write(const struct glint_image *to,
                        const struct glint_image *from,
                        struct glint_row_rgb *row);

#endif
