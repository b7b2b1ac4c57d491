/* SPDX-License-Identifier: MIT
 *
 * Compares pictures of a model with pictures by exact rays.
 */
#ifndef GLINT_TOOLS_MODEL_PICTURE_CHECK_H
#define GLINT_TOOLS_MODEL_PICTURE_CHECK_H

#include "glint/bake.h"
#include "glint/engine.h"
#include "glint/model.h"
#include "options/tool.h"

/* Min PSNR of a model that is called accurate, dB. */
#define PICTURE_CHECK_DB 50.0

/* Engines that draw the same lights by a model and by exact rays. */
struct picture_pair {
    struct glint_engine *model, *exact;
};

/* Opens engines for pictures of VIEW with the lens of SETUP and its MODEL. Call
 * picture_pair_close() even after an error. */
enum glint_status picture_pair_open(struct picture_pair *pair,
                                    const struct glint_setup *setup,
                                    const struct glint_lens *model,
                                    const struct glint_view *view,
                                    struct glint_error *error);
void picture_pair_close(struct picture_pair *pair);

/* The largest difference between model and exact rays. */
struct picture_check {
    double psnr_db;   /* PSNR of the sRGB codes, dB; exposed as by glint
                       * compare; 999: all pictures are identical */
    double angle_deg; /* angle of the light off the axis, degrees */
    int n;            /* number of lights whose pictures were compared */
};

/* Draws the ghosts of up to ten single lights on the axis, near it and up to
 * the corner of the film of LENS, by MODEL and by exact rays, and sets CHECK to
 * the picture with the smallest PSNR. Wavelengths, angles and film lie within
 * those of BAKED, the options of the model. */
enum glint_status picture_check_run(const struct tool *tool,
                                    const struct glint_prescription *lens,
                                    const struct glint_lens *model,
                                    const struct glint_bake_options *baked,
                                    struct picture_check *check,
                                    struct glint_error *error);

#endif
