/* SPDX-License-Identifier: MIT
 *
 * Converts units of a frame: angles to pixels, and codes to light. Computes the
 * powers of two by which light may be scaled, and counts pupil regions. */
#include <math.h>

#include "engine/frame/frame_parts.h"

double glint_frame_compute_pixels_per_tangent(const struct glint_frame *f)
{
    return fabs(f->setup->optics.focal_mm * f->view.width /
                f->view.sensor_width_mm);
}

double glint_frame_get_light_near_black(const struct glint_frame *f,
                                        const struct glint_image *image,
                                        double codes)
{
    return !image || !is_planned_for_codes(f, image)
               ? 0
               : codes / 255 /
                     (image->transfer == GLINT_TONE_SRGB ? 12.92 : 4.5);
}

int glint_frame_count_pupil_regions(const struct glint_frame *f)
{
    return f->lens ? (int)f->lens->header->n_ghosts : f->setup->n_ghosts;
}

struct glint_frame_scale glint_frame_compute_scale(int brightest_log2,
                                                   int together_log2)
{
    const int most = 23 - together_log2, likely = 5 - brightest_log2;

    return (struct glint_frame_scale){likely < most ? likely : most, most};
}
