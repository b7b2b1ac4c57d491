/* SPDX-License-Identifier: MIT
 *
 * Draws scene texts with the integer renderer, and compares with the reference
 * renderer.
 */
#ifndef GLINT_TESTS_SUPPORT_MODELS_DRAWN_SCENE_H
#define GLINT_TESTS_SUPPORT_MODELS_DRAWN_SCENE_H

#include "glint/scene/bake.h"
#include "scenes/scene_frame.h"

struct drawn {
    struct glint_description *description;
    unsigned char *data;
    size_t bytes;
    struct glint_scene_model model;
    struct scene_frame frame;
};

/* Parses and bakes TEXT and allocates its images; fails the test on an
 * error. TOOL must outlive D. */
void drawn_open_scene(struct drawn *d, const char *text,
                      const struct glint_description_files *files,
                      const struct scene_dials *dials, const struct tool *tool);
void drawn_close_scene(struct drawn *d);

/* Draws the scene on black into LIGHT_Q20[HEIGHT][WIDTH][3]. */
void drawn_draw_image(struct drawn *d, int width, int height,
                      int32_t *light_q20);

/* Returns the PSNR, dB, of TEXT drawn by the integer renderer against the
 * reference renderer, one sample per pixel, light clamped to 1. Compares only
 * pixels whose neighbours show the same object, and checks that at least a
 * third of the 160 x 90 pixels are such. */
double drawn_psnr_to_reference(const char *text,
                               const struct glint_description_files *files);

#endif
