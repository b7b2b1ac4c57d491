/* SPDX-License-Identifier: MIT
 *
 * Bakes a zoom lens at several positions into one model.
 *
 *   in   a table of several positions, how many to bake at least
 *   out  a model of all ghosts at these, evenly along the zoom, and of those
 *        ghosts that need it half-way between, again and again until pictures
 *        there are exact enough */
#ifndef GLINT_TOOLS_ZOOMS_ZOOM_BAKE_H
#define GLINT_TOOLS_ZOOMS_ZOOM_BAKE_H

#include "glint/bake.h"
#include "options/tool.h"

/* Default min PSNR, dB, of pictures half-way between positions, compared with
 * exact rays. */
#define ZOOM_BAKE_DB 45

struct zoom_bake {
    const struct glint_prescription *lens;    /* as read from its table */
    const struct glint_bake_options *options; /* without ghosts */
    double focus_m, f_number;                 /* 0: the table's */
    int positions;                            /* 2 or more */
    double halfway_db;                        /* min PSNR, dB; 0: no position is
                                                 added */
};

/* A baked model, whose data the caller frees, and its properties. */
struct zoom_baked {
    unsigned char *data;
    size_t bytes;
    int n_models; /* number of positions of any ghost */
    int n_bakes;  /* number of ghosts baked, over all positions */
    /* Min PSNR, dB, of pictures half-way between positions, and the focal
     * length, mm, at which it occurs; 0 if not measured. */
    double least_db, least_mm;
};

enum glint_status zoom_bake_run(struct tool *tool, const struct zoom_bake *bake,
                                struct zoom_baked *baked,
                                struct glint_error *error);

#endif
