/* SPDX-License-Identifier: MIT
 *
 * Finds the ranges of angles at which a ghost is visible. */
#include <math.h>

#include "bake/visible/boxes.h"
#include "engine/setup/degrees.h"

enum {
    SCAN_DEG = 1,
    BISECTIONS = 8,
    /* steps of the scan by which a range of angles is widened at most, on each
     * side, where only the ends of the band get through */
    FARTHER = 4
};

/* Returns whether light gets through at one of the first N of these
 * wavelengths, and its BOX. */
static bool passes_in(const struct glint_visible *h, double sine, int n,
                      struct glint_pupil *box)
{
    for (int k = 0; k < n; k++)
        if (glint_boxes_find(h, &h->position_path[glint_visible_colour[k]],
                             sine, box))
            return true;
    return false;
}

static bool passes(const struct glint_visible *h, double sine, int n)
{
    struct glint_pupil box;

    return passes_in(h, sine, n, &box);
}

/* Returns whether light of the middle of the band gets through; of shaped
 * lenses, whose rays take long, looks where it did a step before first. BOX is
 * that of the step before if INSIDE, and becomes this one's. */
static bool still_passes(const struct glint_visible *h, double sine,
                         bool inside, struct glint_pupil *box)
{
    if (h->shaped && inside) {
        struct glint_pupil near = glint_boxes_grown(box);

        if (glint_boxes_shrink(h, &h->position_path[glint_visible_colour[0]],
                               sine, 24, 12, &near)) {
            *box = near;
            return true;
        }
    }
    return passes_in(h, sine, 1, box);
}

/* Returns the last sine at which light of any of the three wavelengths gets
 * through, from WITH, where it does in the middle of the band, towards WITHOUT,
 * where it does not. */
static double edge(const struct glint_visible *h, double with, double without)
{
    for (int k = 0; k < FARTHER && without > 0 && without < 1; k++) {
        const double next = without + (without - with);

        if (!passes(h, without, 3))
            break;
        with = without;
        without = fmin(1, fmax(0, next));
    }
    for (int k = 0; k < BISECTIONS; k++) {
        const double middle = 0.5 * (with + without);

        if (passes(h, middle, 3))
            with = middle;
        else
            without = middle;
    }
    return with;
}

/* Ends range N - 1 of N at HI. Returns how many ranges there are then: an empty
 * range is dropped, and one that begins before the last one has ended is joined
 * to that. */
static int end_range(double (*range)[2], int n, double hi)
{
    double *last = range[n - 1];

    last[1] = hi;
    if (last[1] <= last[0])
        return n - 1;
    if (n == 1 || last[0] > range[n - 2][1])
        return n;
    range[n - 2][1] = last[1];
    return n - 1;
}

static int ranges_of(const struct glint_visible *visible, double max_deg,
                     double (*range)[2])
{
    const int steps = (int)ceil(max_deg / SCAN_DEG);
    struct glint_pupil box;
    double before = 0;
    bool inside = false;
    int n = 0;

    for (int k = 0; k <= steps; k++) {
        const double sine = glint_sin_deg(fmin(k * SCAN_DEG, max_deg));
        const bool now = still_passes(visible, sine, inside, &box);

        if (now && !inside && n == GLINT_MAX_RANGES)
            break;
        if (now && !inside)
            range[n++][0] = k ? edge(visible, sine, before) : 0;
        if (!now && inside)
            n = end_range(range, n, edge(visible, before, sine));
        inside = now;
        before = sine;
    }
    return inside ? end_range(range, n, before) : n;
}

int glint_visible_add_range(double (*range)[2], int n, const double more[2])
{
    double lo = more[0], hi = more[1];
    int kept = 0, at;

    for (int k = 0; k < n; k++) {
        const double from = range[k][0], to = range[k][1];

        if (to < lo || from > hi) {
            range[kept][0] = from;
            range[kept++][1] = to;
        } else {
            lo = fmin(lo, from);
            hi = fmax(hi, to);
        }
    }
    if (kept == GLINT_MAX_RANGES)
        return kept;
    for (at = kept; at > 0 && range[at - 1][0] > lo; at--) {
        range[at][0] = range[at - 1][0];
        range[at][1] = range[at - 1][1];
    }
    range[at][0] = lo;
    range[at][1] = hi;
    return kept + 1;
}

int glint_visible_ranges(const struct glint_visible *visible, double max_deg,
                         double (*range)[2])
{
    int n = ranges_of(visible, max_deg, range);

    for (int k = 0; k < visible->n_beside; k++) {
        double other[GLINT_MAX_RANGES][2];
        const int n_other = ranges_of(&visible->beside[k], max_deg, other);

        for (int i = 0; i < n_other; i++)
            n = glint_visible_add_range(range, n, other[i]);
    }
    return n;
}
