/* SPDX-License-Identifier: MIT
 *
 * Functions for rows of a scattering matrix, shared by slab.c and all fits:
 * indices of entries, and progress.
 */
#ifndef GLINT_BAKE_TRANSLUCENT_ROWS_H
#define GLINT_BAKE_TRANSLUCENT_ROWS_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/scene/translucent_bake.h"

/* Returns the number of entries of a kernel of KERNEL texels per side. */
static inline int glint_scatter_count_entries(int kernel)
{
    return kernel * kernel;
}

/* Returns the row of texel X in channel C: [kernel * kernel]. */
static inline float *
glint_scatter_get_row(const struct glint_scatter_rows *rows, int x, int c)
{
    const size_t k2 = (size_t)glint_scatter_count_entries(rows->kernel);

    return rows->r + ((size_t)x * 3 + (size_t)c) * k2;
}

/* Range of a kernel's offsets around a texel that lead to texels inside the
 * map. */
struct glint_scatter_inside {
    /* along u and along v: first offset, and last offset + 1 */
    int u_from, u_to, v_from, v_to;
};
struct glint_scatter_inside
glint_scatter_find_offsets_inside(int side, int kernel, int x);

/* Returns the index of the texel to which entry D of the row of texel X leads;
 * -1: a place outside the map. */
int glint_scatter_get_target_texel(int side, int kernel, int x, int d);

/* Allocates ROWS for SIDE and KERNEL, filled with 0. SHARED: also allocates the
 * fractions of materials. Returns false if there is no memory; ROWS is then
 * empty. */
bool glint_scatter_allocate_rows(struct glint_scatter_rows *rows, int side,
                                 int kernel, bool shared);

/* Transposes ROWS: converts rows of the texels where light enters to rows of
 * the texels where light leaves, and vice versa. */
void glint_scatter_transpose_rows(struct glint_scatter_rows *rows);

/* Reports the progress DONE, 0 .. 1, to the caller's WATCH. Returns true if the
 * caller requests to stop. */
bool glint_watch_report_progress(const struct glint_watch *watch, double done);

/* A part of the work whose progress WHOLE reports: 0 .. 1 of the part are from
 * .. from + length of the whole. */
struct glint_watch_part {
    const struct glint_watch *whole;
    double from, length;
};

/* Returns a watch that reports the progress of PART to its whole. PART must
 * outlive it. */
struct glint_watch glint_watch_make_for_part(struct glint_watch_part *part);

/* Models that the run time can draw, except the albedo model: fitted by least
 * squares over the entries inside the map. Light that leaves the map is lost,
 * so rows at the rim would differ from all others. Each function sets the
 * members of FIT that its model uses, except the energy; all other members of
 * FIT but the albedo must be 0. In ROWS, and in the kernels h that these
 * functions set, light leaves at texel x, and offsets lead to the texel where
 * it entered. */
enum glint_status
glint_scatter_fit_clusters(const struct glint_scatter_rows *rows,
                           const struct glint_watch *watch,
                           struct glint_scatter_fit *fit);
enum glint_status
glint_scatter_fit_factors(const struct glint_scatter_rows *rows,
                          const struct glint_watch *watch,
                          struct glint_scatter_fit *fit);

#endif
