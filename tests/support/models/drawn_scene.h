/* SPDX-License-Identifier: MIT
 *
 * Scene texts as integers draw them, for tests, and how near that is to the
 * reference renderer. */
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

/* Reads TEXT, bakes it and makes room for its pictures; fails the test where
 * one of these is refused. TOOL is kept. */
void drawn_open(struct drawn *d, const char *text,
                const struct glint_description_files *files,
                const struct scene_dials *dials, const struct tool *tool);
void drawn_close(struct drawn *d);

/* Draws over black: LIGHT_Q20[HEIGHT][WIDTH][3]. */
void drawn_draw(struct drawn *d, int width, int height, int32_t *light_q20);

/* Returns the PSNR of TEXT, drawn with one point of a pixel, to the reference,
 * of light up to 1, where neighbours are alike; that must be a third of 160 x
 * 90 pixels. */
double drawn_near_twin(const char *text,
                       const struct glint_description_files *files);

#endif
