/* SPDX-License-Identifier: MIT
 *
 * Functions shared by all code for rows of a scattering matrix: indices of
 * entries, progress.
 */
#ifndef GLINT_BAKE_TRANSLUCENT_ROWS_H
#define GLINT_BAKE_TRANSLUCENT_ROWS_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/scene/translucent_bake.h"

/* Returns the number of entries of a kernel of KERNEL texels per side. */
static inline int glint_scatter_kernel2(int kernel)
{
    return kernel * kernel;
}

/* Returns the row of texel X in channel C: [kernel * kernel]. */
static inline float *glint_scatter_row(const struct glint_scatter_rows *rows,
                                       int x, int c)
{
    const size_t k2 = (size_t)glint_scatter_kernel2(rows->kernel);

    return rows->r + ((size_t)x * 3 + (size_t)c) * k2;
}

/* Range of a kernel's offsets around a texel that lie inside the square. */
struct glint_scatter_inside {
    /* first offset and one past the last one, along u and along v */
    int u_from, u_to, v_from, v_to;
};
struct glint_scatter_inside glint_scatter_inside(int side, int kernel, int x);

/* Returns the index of the texel to which entry D of texel X leads; -1: it lies
 * outside the square. */
int glint_scatter_target(int side, int kernel, int x, int d);

/* Allocates ROWS for SIDE and KERNEL, filled with 0. SHARED: also allocates the
 * fractions of materials. Returns false if there is no memory; ROWS is then
 * empty. */
bool glint_scatter_open(struct glint_scatter_rows *rows, int side, int kernel,
                        bool shared);

/* Transposes ROWS: rows of texels where light enters become rows of texels
 * where light leaves, and vice versa. */
void glint_scatter_turn(struct glint_scatter_rows *rows);

/* Reports the progress DONE, 0 .. 1, to WATCH. Returns true if the work must
 * stop. */
bool glint_watch_ends(const struct glint_watch *watch, double done);

/* A part of the work that WHOLE watches: its progress runs from from to from +
 * length. */
struct glint_watch_part {
    const struct glint_watch *whole;
    double from, length;
};

/* Returns a watch that reports the progress of PART, which must outlive it. */
struct glint_watch glint_watch_of(struct glint_watch_part *part);

/* Fits that the run time can draw, apart from the albedo model: least squares
 * over the entries inside the square. Light outside is lost, and would make
 * rows at the rim differ from all others. Each function sets the members of FIT
 * that its model uses, except the energy; FIT must be 0 apart from the albedo.
 * In ROWS, and in the kernels h that these functions set, light leaves at texel
 * x, and offsets lead to the texel where it entered. */
enum glint_status glint_scatter_clusters(const struct glint_scatter_rows *rows,
                                         const struct glint_watch *watch,
                                         struct glint_scatter_fit *fit);
enum glint_status glint_scatter_factors(const struct glint_scatter_rows *rows,
                                        const struct glint_watch *watch,
                                        struct glint_scatter_fit *fit);

#endif
