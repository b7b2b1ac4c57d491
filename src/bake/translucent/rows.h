/* SPDX-License-Identifier: MIT
 *
 * Shared by all that work on rows: places of entries, progress. */
#ifndef GLINT_BAKE_TRANSLUCENT_ROWS_H
#define GLINT_BAKE_TRANSLUCENT_ROWS_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/scene/translucent_bake.h"

/* Entries of a kernel. */
static inline int glint_scatter_kernel2(int kernel)
{
    return kernel * kernel;
}

/* Row of texel X, channel C: [kernel * kernel]. */
static inline float *glint_scatter_row(const struct glint_scatter_rows *rows,
                                       int x, int c)
{
    const size_t k2 = (size_t)glint_scatter_kernel2(rows->kernel);

    return rows->r + ((size_t)x * 3 + (size_t)c) * k2;
}

/* The offsets of a kernel that stay within the square from texel X. */
struct glint_scatter_inside {
    int u_from, u_to, v_from, v_to; /* the _to members are one past the last */
};
struct glint_scatter_inside glint_scatter_inside(int side, int kernel, int x);

/* Index of the texel that entry D of texel X leads to, or -1. */
int glint_scatter_target(int side, int kernel, int x, int d);

/* Allocates ROWS for SIDE and KERNEL, all 0, with shares if SHARED. Returns
 * false if there is no memory; ROWS is then empty. */
bool glint_scatter_open(struct glint_scatter_rows *rows, int side, int kernel,
                        bool shared);

/* Transposes ROWS: rows of texels where light enters become rows of texels
 * where light leaves, and vice versa. */
void glint_scatter_turn(struct glint_scatter_rows *rows);

/* Returns true if the work is to end; DONE is its fraction, 0 .. 1. */
bool glint_watch_ends(const struct glint_watch *watch, double done);

/* A part of the work of WATCH: the fractions FROM .. FROM + LENGTH. */
struct glint_watch_part {
    const struct glint_watch *whole;
    double from, length;
};

/* Returns a watch of PART, which must outlive it. */
struct glint_watch glint_watch_of(struct glint_watch_part *part);

/* The fits that a run time can draw, beside albedo: least squares over the
 * entries inside the square. Light outside is lost anyway, and would make rows
 * at the rim differ from all others. Each function fills the members of FIT
 * that its model uses, except the energy; FIT must be all 0 but for albedo. In
 * ROWS, and in the h that these functions set, light leaves at texel x, and
 * offsets lead to where the light came from. */
enum glint_status glint_scatter_clusters(const struct glint_scatter_rows *rows,
                                         const struct glint_watch *watch,
                                         struct glint_scatter_fit *fit);
enum glint_status glint_scatter_factors(const struct glint_scatter_rows *rows,
                                        const struct glint_watch *watch,
                                        struct glint_scatter_fit *fit);

#endif
