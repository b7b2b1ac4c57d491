/* SPDX-License-Identifier: MIT
 *
 * Compares images drawn by a model with images drawn by exact rays.
 */
#ifndef GLINT_TOOLS_MODEL_PICTURE_CHECK_H
#define GLINT_TOOLS_MODEL_PICTURE_CHECK_H

#include "glint/bake.h"
#include "glint/engine.h"
#include "model/coating.h"
#include "model/model_file.h"

/* Two engines for the same lens: one draws by a model, the other by exact
 * rays. */
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

/* PSNR of identical images, dB, as in glint/measure.h */
#define PICTURE_IDENTICAL_DB 999

/* Result of picture_check_run(): the light with the lowest PSNR */
struct picture_check {
    /* PSNR of the sRGB codes, dB, at the exposure of glint compare. Multiple of
     * 2^-8, like the angle, so that the model stores both exactly. */
    double psnr_db;
    double angle_deg; /* angle of the light off the axis, degrees */
    /* number of lights whose pictures were compared; pictures without any light
     * are not */
    int n;
};

/* Compares images by MODEL with images by exact rays, for up to ten lights: on
 * the axis of LENS, near the axis, and up to the corner of the film. Sets CHECK
 * to the light with the lowest PSNR. Wavelengths, angles and film are limited
 * to those of BAKED, the options with which the model was baked. */
enum glint_status picture_check_run(const struct tool *tool,
                                    const struct glint_prescription *lens,
                                    const struct glint_lens *model,
                                    const struct glint_bake_options *baked,
                                    struct picture_check *check,
                                    struct glint_error *error);

/* Compares images like picture_check_run(), for *N lights, at most
 * PICTURE_CHECK_LIGHTS, at random angles and azimuths in the field. The lights
 * are the same in each run. Sets *N to the number of lights whose images are
 * not black, and PSNR_DB[*N] to their PSNR, in rising order. */
enum { PICTURE_CHECK_LIGHTS = 16 };
enum glint_status picture_check_run_random(
    const struct tool *tool, const struct glint_prescription *lens,
    const struct glint_lens *model, const struct glint_bake_options *baked,
    int *n, double *psnr_db, struct glint_error *error);

/* Appends a note with COATING and the result of CHECK (NULL: not compared) to
 * the model DATA[BYTES], which may move. Returns GLINT_E_MEMORY and changes
 * nothing if there is no memory. */
enum glint_status picture_check_store(const struct picture_check *check,
                                      const struct coating *coating,
                                      unsigned char **data, size_t *bytes);

#endif
