/* SPDX-License-Identifier: MIT
 *
 * Bakes a zoom lens at several positions into one model.
 *
 * Input: a table of several positions, and the min number of positions to bake.
 * Output: a model of all ghosts at these positions, evenly spaced along the
 * zoom, and of ghosts with large errors at positions between, where the steps
 * are halved until images are exact enough.
 */
#ifndef GLINT_TOOLS_ZOOMS_ZOOM_BAKE_H
#define GLINT_TOOLS_ZOOMS_ZOOM_BAKE_H

#include "glint/bake.h"
#include "model/coating.h"
#include "options/tool.h"

/* Default min PSNR of images halfway between positions against exact rays,
 * dB */
#define ZOOM_BAKE_DB 45

struct zoom_bake {
    /* zoom lens, as read from its table */
    const struct glint_prescription *lens;
    const struct coating *coating; /* coating of LENS */
    /* bake options; the choice of ghosts in them is ignored */
    const struct glint_bake_options *options;
    /* focus distance, m, and f-number; 0: those of the table */
    double focus_m, f_number;
    int positions; /* number of evenly spaced positions, at least 2 */
    /* min PSNR in the middle between positions, dB; 0: no positions are
     * added */
    double halfway_db;
};

/* A baked zoom model and its properties. The caller frees the data. */
struct zoom_baked {
    unsigned char *data;
    size_t bytes;
    int n_models; /* number of positions at which any ghost is baked */
    int n_bakes;  /* number of ghosts baked, summed over positions */
    /* min PSNR in the middle between positions, dB, and the focal length where
     * it occurs, mm; 0: not measured */
    double least_db, least_mm;
};

enum glint_status zoom_bake_positions(struct tool *tool,
                                      const struct zoom_bake *bake,
                                      struct zoom_baked *baked,
                                      struct glint_error *error);

#endif
