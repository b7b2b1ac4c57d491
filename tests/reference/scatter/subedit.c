/* SPDX-License-Identifier: MIT
 *
 * Models scattering as the geometric mean of two radial profiles P, those of
 * the texels i and o where light enters and leaves [Song09].
 *
 * Logarithms make the mean a sum: ln R'(i, o) = (ln P_i(r) + ln P_o(r)) / 2. In
 * each round, every profile is solved with all others fixed, then moved half of
 * the way to its solution. Profiles are interpolated linearly in the distance
 * r.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reference/scatter/rebuild.h"

enum { VALUES = 12, ROUNDS = 8 };

/* min argument of a logarithm, as a fraction of the largest entry */
#define FLOOR 1e-7

struct subedit {
    const struct glint_scatter_rows *rows;
    int c;
    double floor;
    /* [texels][VALUES]: logarithms of the profiles in this and the next
     * round */
    double *profile, *next;
    /* [kernel * kernel]: radius of each kernel entry, 0 .. VALUES - 1 */
    double *radius;
};

static double interpolate_profile(const double *profile, double radius)
{
    const int low = radius < VALUES - 1 ? (int)radius : VALUES - 2;
    const double t = radius - low;

    return (1 - t) * profile[low] + t * profile[low + 1];
}

/* Sets the radius of each kernel entry: 0 at the centre, VALUES - 1 at the
 * corners. */
static void set_entry_radii(const struct subedit *p)
{
    const int n = p->rows->kernel, half = n / 2;
    const double most = half > 0 ? sqrt(2) * half : 1;

    for (int d = 0; d < n * n; d++) {
        const int u = d % n - half, v = d / n - half;

        p->radius[d] = fmin(VALUES - 1, (VALUES - 1) * hypot(u, v) / most);
    }
}

/* Solves the next profile of texel X. Given the profile of its own texel, each
 * entry of the row of X requires a value of the profile of X at the entry's
 * radius. The new value at a radius is the mean of these. ALONE: ignores the
 * profiles of other texels. */
static void solve_radial_profile(const struct subedit *p, int x, bool alone)
{
    const float *row = glint_scatter_get_row(p->rows, x, p->c);
    double sum[VALUES] = {0}, weight[VALUES] = {0};

    for (int d = 0; d < glint_scatter_count_entries(p->rows->kernel); d++) {
        const int to = glint_scatter_get_target_texel(p->rows->side,
                                                      p->rows->kernel, x, d);
        const int low = (int)fmin(p->radius[d], VALUES - 2);
        const double t = p->radius[d] - low;
        double value;

        if (to < 0)
            continue;
        value = log(fmax((double)row[d], p->floor));
        if (!alone)
            value = 2 * value -
                    interpolate_profile(p->profile + VALUES * to, p->radius[d]);
        sum[low] += (1 - t) * value;
        weight[low] += 1 - t;
        sum[low + 1] += t * value;
        weight[low + 1] += t;
    }
    for (int i = 0; i < VALUES; i++) {
        const double before = p->profile[VALUES * x + i];
        const double now = weight[i] > 1e-9 ? sum[i] / weight[i]
                           : i > 0          ? p->next[VALUES * x + i - 1]
                                            : before;

        p->next[VALUES * x + i] = alone ? now : (before + now) / 2;
    }
}

static void rebuild_channel_by_profiles(const struct subedit *p, double *row,
                                        struct glint_scatter_rows *rebuilt)
{
    for (int x = 0; x < p->rows->side * p->rows->side; x++) {
        for (int d = 0; d < glint_scatter_count_entries(p->rows->kernel); d++) {
            const int to = glint_scatter_get_target_texel(
                p->rows->side, p->rows->kernel, x, d);

            row[d] = to < 0 ? 0
                            : exp((interpolate_profile(p->profile + VALUES * x,
                                                       p->radius[d]) +
                                   interpolate_profile(p->profile + VALUES * to,
                                                       p->radius[d])) /
                                  2);
        }
        glint_store_rebuilt_row(rebuilt, x, p->c, row);
    }
}

static enum glint_status rebuild_channels(struct subedit *p, double *row,
                                          const struct glint_watch *watch,
                                          struct glint_scatter_rows *rebuilt)
{
    const int texels = p->rows->side * p->rows->side;

    set_entry_radii(p);
    for (p->c = 0; p->c < 3; p->c++) {
        for (int i = 0; i < ROUNDS; i++) {
            double *other;

            if (glint_watch_report_progress(watch,
                                            (p->c + (double)i / ROUNDS) / 3))
                return GLINT_E_CLOSED;
            for (int x = 0; x < texels; x++)
                solve_radial_profile(p, x, i == 0);
            other = p->profile;
            p->profile = p->next;
            p->next = other;
        }
        rebuild_channel_by_profiles(p, row, rebuilt);
    }
    return GLINT_OK;
}

enum glint_status glint_rebuild_radial_profiles(
    const struct glint_scatter_rows *rows, struct glint_scatter_candidate *o,
    const struct glint_watch *watch, struct glint_scatter_rows *rebuilt)
{
    const size_t values = VALUES * (size_t)rows->side * (size_t)rows->side;
    const size_t k2 = (size_t)glint_scatter_count_entries(rows->kernel);
    struct subedit p = {.rows = rows,
                        .floor = FLOOR * glint_scatter_largest_entry(rows)};
    double *memory = calloc(2 * values + 2 * k2, sizeof *memory);
    enum glint_status status = GLINT_E_MEMORY;

    (void)o;
    if (!(p.floor > 0)) {
        free(memory);
        return GLINT_OK; /* a black medium: the rebuilt rows stay 0 */
    }
    if (memory) {
        p.profile = memory;
        p.next = memory + values;
        p.radius = p.next + values;
        status = rebuild_channels(&p, p.radius + k2, watch, rebuilt);
    }
    free(memory);
    return status;
}
