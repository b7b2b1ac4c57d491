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
 * -1 if it leads outside the map. */
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

/* A part of a longer work whose progress WHOLE reports. The part is the
 * interval from .. from + length of the work, which is 0 .. 1. */
struct glint_watch_part {
    const struct glint_watch *whole;
    double from, length;
};

/* Returns a watch for PART alone, which converts its progress to that of the
 * whole work. PART must outlive the watch. */
struct glint_watch glint_watch_make_for_part(struct glint_watch_part *part);

/* Fit models that the run time can draw, except the albedo model. They are
 * fitted by least squares to the entries inside the map only: light that leaves
 * the map is lost, so rows at the rim differ from all others. Each function
 * sets the members of FIT that its model uses, except the energy. On entry, all
 * members of FIT but the albedo must be 0. In ROWS and in the resulting kernels
 * h, light leaves at texel x, and offsets lead to the texel where it
 * entered. */
enum glint_status
glint_scatter_fit_clusters(const struct glint_scatter_rows *rows,
                           const struct glint_watch *watch,
                           struct glint_scatter_fit *fit);
enum glint_status
glint_scatter_fit_factors(const struct glint_scatter_rows *rows,
                          const struct glint_watch *watch,
                          struct glint_scatter_fit *fit);

#endif
