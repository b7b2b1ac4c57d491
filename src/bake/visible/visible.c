/* SPDX-License-Identifier: MIT */
#include "bake/visible/visible.h"

#include <math.h>

#include "bake/table/form.h"
#include "bake/trace/spot.h"
#include "engine/setup/degrees.h"

const int glint_visible_colour[GLINT_VISIBLE_COLOURS] = {
    GLINT_VISIBLE_WAVES / 2, 0, GLINT_VISIBLE_WAVES - 1};

static double compute_wave_number(const struct glint_visible *visible, double w)
{
    return 0.5 * (visible->wave_lo + visible->wave_hi) +
           0.5 * w * (visible->wave_hi - visible->wave_lo);
}

void glint_visible_init_path(const struct glint_visible *visible, double w,
                             struct glint_path *path)
{
    glint_path_init(path, visible->setup->lens,
                    &visible->setup->ghost[visible->ghost],
                    1e3 / sqrt(compute_wave_number(visible, w)));
}

static void init_band_paths(struct glint_visible *visible)
{
    for (int k = 0; k < GLINT_VISIBLE_WAVES; k++) {
        glint_visible_init_path(visible,
                                -cos(GLINT_PI * k / (GLINT_VISIBLE_WAVES - 1)),
                                &visible->path[k]);
        visible->position_path[k] = visible->path[k];
        visible->position_path[k].places_only = true;
    }
}

void glint_visible_init(struct glint_visible *visible,
                        const struct glint_setup *setup, int ghost,
                        double field_mm, const double band_nm[2])
{
    visible->setup = setup;
    visible->ghost = ghost;
    visible->field_mm = field_mm;
    visible->wide = setup->lens->f_number < GLINT_WIDE;
    visible->far = visible->shaped = false;
    for (int k = 0; k < setup->lens->n_surfaces; k++)
        visible->shaped |= glint_surface_is_shaped(&setup->lens->surface[k]);
    visible->shaped &=
        visible->wide && glint_prescription_is_round(setup->lens);
    visible->wave_lo = 1e6 / (band_nm[1] * band_nm[1]);
    visible->wave_hi = 1e6 / (band_nm[0] * band_nm[0]);
    visible->n_beside = 0;
    init_band_paths(visible);
}

void glint_visible_set_max_angle(struct glint_visible *visible, double max_deg)
{
    visible->far = max_deg > GLINT_FAR &&
                   glint_prescription_is_round(visible->setup->lens);
    visible->wide |= visible->far;
}

void glint_visible_narrow_band(struct glint_visible *visible,
                               const struct glint_visible *whole, double w0,
                               double w1)
{
    visible->setup = whole->setup;
    visible->ghost = whole->ghost;
    visible->field_mm = whole->field_mm;
    visible->wide = whole->wide;
    visible->far = whole->far;
    visible->shaped = whole->shaped;
    visible->wave_lo = compute_wave_number(whole, w0);
    visible->wave_hi = compute_wave_number(whole, w1);
    init_band_paths(visible);
    visible->n_beside = whole->n_beside;
    for (int k = 0; k < whole->n_beside; k++)
        glint_visible_narrow_band(&visible->beside[k], &whole->beside[k], w0,
                                  w1);
}

bool glint_visible_is_ray_visible(const struct glint_visible *visible,
                                  const struct glint_ray *ray)
{
    const double stop = visible->setup->optics.stop_radius_mm;
    const double x = ray->stop_x_mm, y = ray->stop_y_mm;
    const double sx = ray->sensor_x_mm, sy = ray->sensor_y_mm;

    return ray->rel_radius <= 1 && x * x + y * y <= stop * stop &&
           sx * sx + sy * sy <= visible->field_mm * visible->field_mm;
}

void glint_visible_join_boxes(struct glint_pupil *a,
                              const struct glint_pupil *b)
{
    a->x0_mm = fmin(a->x0_mm, b->x0_mm);
    a->x1_mm = fmax(a->x1_mm, b->x1_mm);
    a->y1_mm = fmax(a->y1_mm, b->y1_mm);
}

/* -------------------------------------------------------------------- boxes */

/* max numbers of cells of a grid */
enum { ACROSS = 64, DOWN = 32 };

/* the unblocked rays of a grid: first and last column, last row */
struct extent {
    int i0, i1, j1;
};

static void extend_by_grid_ray(struct extent *e, int i, int j)
{
    e->i0 = i < e->i0 ? i : e->i0;
    e->i1 = i > e->i1 ? i : e->i1;
    e->j1 = j > e->j1 ? j : e->j1;
}

/* Finds the unblocked rays of a grid over BOX with ACROSS x DOWN cells. Rows
 * are traced from the last one on, and only rays that can extend EXTENT: those
 * outside the columns found so far. Returns false if all rays are blocked. */
static bool trace_box_grid(const struct glint_visible *h,
                           const struct glint_path *path, double sine,
                           int across, int down, const struct glint_pupil *box,
                           struct extent *extent)
{
    enum { SOME = 16 };
    const double step_mm = (box->x1_mm - box->x0_mm) / across;
    const double cosine = sqrt(1 - sine * sine);
    struct glint_launch from[SOME];
    struct glint_ray ray[SOME];
    enum glint_ray_status status[SOME];
    int at[SOME], n = 0;

    *extent = (struct extent){across + 1, -1, -1};
    for (int k = (across + 1) * (down + 1) - 1; k >= 0; k--) {
        const int i = k % (across + 1), j = k / (across + 1);

        if (i < extent->i0 || i > extent->i1) {
            at[n] = k;
            from[n++] = (struct glint_launch){box->x0_mm + i * step_mm,
                                              box->y1_mm * j / down,
                                              {sine, 0, cosine}};
        }
        if (n < SOME && k > 0)
            continue;
        glint_trace_many(path, n, from, ray, status, NULL);
        for (int r = 0; r < n; r++)
            if (status[r] == GLINT_RAY_OK &&
                glint_visible_is_ray_visible(h, &ray[r]))
                extend_by_grid_ray(extent, at[r] % (across + 1),
                                   at[r] / (across + 1));
        n = 0;
    }
    return extent->i1 >= 0;
}

/* Shrinks BOX to the unblocked rays of a grid over it, with a margin of one
 * cell. Returns false if all rays are blocked. */
static bool shrink_box_to_visible(const struct glint_visible *h,
                                  const struct glint_path *path, double sine,
                                  int across, int down, struct glint_pupil *box)
{
    const double dx = (box->x1_mm - box->x0_mm) / across;
    const double dy = box->y1_mm / down, x0 = box->x0_mm;
    struct extent e;

    if (!trace_box_grid(h, path, sine, across, down, box, &e))
        return false;
    box->x0_mm = x0 + fmax(e.i0 - 1, 0) * dx;
    box->x1_mm = x0 + fmin(e.i1 + 1, across) * dx;
    box->y1_mm = fmin(e.j1 + 1, down) * dy;
    return true;
}

/* Enlarges BOX on each side where unblocked rays reach its edge, until none do.
 * Returns false if this takes too many rounds, or if all rays are blocked. */
static bool grow_box_to_visible(const struct glint_visible *h,
                                const struct glint_path *path, double sine,
                                struct glint_pupil *box)
{
    enum { COARSE = 16, ROUNDS = 8 };

    for (int round = 0; round < ROUNDS; round++) {
        const double more = 0.5 * (box->x1_mm - box->x0_mm);
        struct extent e;

        if (!trace_box_grid(h, path, sine, COARSE, COARSE / 2, box, &e))
            return false;
        if (e.i0 > 0 && e.i1 < COARSE && e.j1 < COARSE / 2)
            return true;
        box->x0_mm -= e.i0 == 0 ? more : 0;
        box->x1_mm += e.i1 == COARSE ? more : 0;
        box->y1_mm *= e.j1 == COARSE / 2 ? 1.5 : 1;
    }
    return false;
}

/* Moves sides of BOX outwards where unblocked rays pass outside it. Such rays
 * exist if the visible region has tips, like a crescent, thinner than a cell of
 * the box's grid. */
static void grow_box_at_tips(const struct glint_visible *h,
                             const struct glint_path *path, double sine,
                             struct glint_pupil *box)
{
    const struct glint_openings openings = {
        .path = path,
        .direction = {sine, 0, sqrt(1 - sine * sine)},
        .stop_mm = h->setup->optics.stop_radius_mm,
        .field_mm = h->field_mm};

    box->y0_mm = 0;
    box->mirrored = true;
    glint_spot_grow_pupil(&openings, box);
}

/* Shrinks BOX, which must contain all unblocked rays, to their bounding box.
 * Returns false if all rays are blocked. */
static bool find_tight_visible_box(const struct glint_visible *h,
                                   const struct glint_path *path, double sine,
                                   struct glint_pupil *box)
{
    bool found = shrink_box_to_visible(h, path, sine, 24, 12, box) ||
                 shrink_box_to_visible(h, path, sine, ACROSS, DOWN, box);

    for (int round = 0; round < 5 && found; round++) {
        const double before = (box->x1_mm - box->x0_mm) * box->y1_mm;

        if (!shrink_box_to_visible(h, path, sine, 24, 12, box) ||
            (box->x1_mm - box->x0_mm) * box->y1_mm > 0.8 * before)
            break;
    }
    if (found && h->far)
        grow_box_at_tips(h, path, sine, box);
    return found;
}

/* Returns how far RAY is from being visible: the max of its distance from the
 * axis / radius, over the stop, all barrels and the field. The value is at most
 * 1 for visible rays. */
static double compute_ray_miss_ratio(const struct glint_visible *h,
                                     const struct glint_ray *ray)
{
    const double stop =
        hypot(ray->stop_x_mm, ray->stop_y_mm) / h->setup->optics.stop_radius_mm;
    const double field =
        hypot(ray->sensor_x_mm, ray->sensor_y_mm) / h->field_mm;

    return fmax(ray->rel_radius, fmax(stop, field));
}

/* Shrinks BOX to 1.5 cells around the ray of its grid with the smallest
 * compute_ray_miss_ratio(). Returns this ratio, or HUGE_VAL if all rays are
 * invalid. */
static double shrink_box_to_nearest_ray(const struct glint_visible *h,
                                        const struct glint_path *path,
                                        double sine, struct glint_pupil *box)
{
    const double dx = (box->x1_mm - box->x0_mm) / ACROSS;
    const double dy = box->y1_mm / DOWN, x0 = box->x0_mm;
    struct glint_row row = {
        ACROSS + 1, x0, dx, 0, {sine, 0, sqrt(1 - sine * sine)}};
    struct glint_ray ray[ACROSS + 1];
    enum glint_ray_status status[ACROSS + 1];
    double least = HUGE_VAL;

    for (int j = 0; j <= DOWN; j++) {
        row.y_mm = dy * j;
        glint_trace_row(path, &row, ray, status, NULL);
        for (int i = 0; i <= ACROSS; i++) {
            if (status[i] != GLINT_RAY_OK ||
                compute_ray_miss_ratio(h, &ray[i]) >= least)
                continue;
            least = compute_ray_miss_ratio(h, &ray[i]);
            box->x0_mm = x0 + (i - 1.5) * dx;
            box->x1_mm = x0 + (i + 1.5) * dx;
            box->y1_mm = (j + 1.5) * dy;
        }
    }
    return least;
}

/* Sets BOX to visible rays that the grid over BOX misses, as they lie between
 * its rays. They exist if the field is much smaller than the front element:
 * then the visible region of the pupil is small, too. Returns false if it finds
 * none. */
static bool find_region_missed_by_grid(const struct glint_visible *h,
                                       const struct glint_path *path,
                                       double sine, struct glint_pupil *box)
{
    enum { ROUNDS = 4 };

    if (h->field_mm > 0.1 * h->setup->lens->surface[0].semi_mm)
        return false;
    for (int round = 0; round < ROUNDS; round++)
        if (shrink_box_to_nearest_ray(h, path, sine, box) <= 1)
            return grow_box_to_visible(h, path, sine, box);
    return false;
}

static double convert_sine_to_degrees(double sine)
{
    return asin(sine) * (180 / GLINT_PI);
}

/* Finds the box of unblocked rays at the angle with sine SINE. Searches the
 * complete pupil. Returns false if all rays are blocked. */
static bool find_visible_box(const struct glint_visible *h,
                             const struct glint_path *path, double sine,
                             struct glint_pupil *box)
{
    struct glint_pupil spot;

    if (!glint_pupil_find_within(box, path, convert_sine_to_degrees(sine),
                                 h->setup->optics.stop_radius_mm, h->field_mm,
                                 NULL))
        return false;
    spot = *box;
    if (find_tight_visible_box(h, path, sine, box))
        return true;
    *box = spot;
    return find_region_missed_by_grid(h, path, sine, box) &&
           find_tight_visible_box(h, path, sine, box);
}

/* Returns NEAR enlarged by 20 % on each side. */
static struct glint_pupil enlarge_box_by_margin(const struct glint_pupil *near)
{
    const double more = 0.2 * (near->x1_mm - near->x0_mm);
    struct glint_pupil box = *near;

    box.x0_mm -= more;
    box.x1_mm += more;
    box.y1_mm *= 1.25;
    return box;
}

/* Finds the box of unblocked rays at the angle with sine SINE. Searches around
 * NEAR first, then the complete pupil. */
static bool find_box_near_previous(const struct glint_visible *h,
                                   const struct glint_path *path, double sine,
                                   const struct glint_pupil *near,
                                   struct glint_pupil *box)
{
    *box = enlarge_box_by_margin(near);
    return (grow_box_to_visible(h, path, sine, box) &&
            find_tight_visible_box(h, path, sine, box)) ||
           find_visible_box(h, path, sine, box);
}

/* ------------------------------------------------------------------ profile */

enum {
    /* number of angles after which the complete pupil is searched again,
     * instead of the region around the last box */
    AFRESH = 4,
    /* AFRESH of lenses with non-spherical surfaces, as tracing them is slow */
    AFRESH_SHAPED = 12
};

/* Extrapolates to the box of the next angle: BOX, moved by RATIO times its
 * displacement from the box BEFORE. */
static struct glint_pupil extrapolate_box(const struct glint_pupil *before,
                                          const struct glint_pupil *box,
                                          double ratio)
{
    const double step =
        0.5 * ratio * (box->x0_mm + box->x1_mm - before->x0_mm - before->x1_mm);
    struct glint_pupil p = *box;

    p.x0_mm += step;
    p.x1_mm += step;
    return p;
}

/* boxes of visible light, by angle and wavelength index */
struct box_samples {
    bool seen[GLINT_PROFILE][GLINT_VISIBLE_WAVES];
    struct glint_pupil box[GLINT_PROFILE][GLINT_VISIBLE_WAVES];
};

/* Finds the boxes at wavelength index WAVE for the angles that WANTED marks. */
static void find_boxes_of_wave(const struct glint_visible *h,
                               const double *sine, const bool *wanted, int wave,
                               struct box_samples *g)
{
    const struct glint_path *path = &h->position_path[wave];
    struct glint_pupil box = {.y1_mm = 0}, before = box;
    /* number of consecutive angles with a box, up to the previous angle */
    int have = 0;

    for (int k = 0; k < GLINT_PROFILE; k++) {
        const double *s = sine + k;
        struct glint_pupil near = box;
        bool now;

        if (!wanted[k]) {
            have = 0;
            continue;
        }
        if (have > 1)
            near = extrapolate_box(&before, &box,
                                   (s[0] - s[-1]) / (s[-1] - s[-2]));
        before = box;
        now = have ? find_box_near_previous(h, path, *s, &near, &box)
                   : find_visible_box(h, path, *s, &box);
        if (have && k % (h->shaped ? AFRESH_SHAPED : AFRESH) == 0 &&
            find_visible_box(h, path, *s, &near)) {
            if (now)
                glint_visible_join_boxes(&near, &box);
            box = near;
            now = true;
        }
        have = now ? have + 1 : 0;
        g->seen[k][wave] = now;
        g->box[k][wave] = box;
    }
}

static void append_angle_to_profile(struct glint_visible_profile *p,
                                    double sine, const struct box_samples *g,
                                    int k)
{
    const int first = p->n_samples;

    for (int wave = 0; wave < GLINT_VISIBLE_WAVES; wave++)
        if (g->seen[k][wave])
            p->sample[p->n_samples++] = (struct glint_box_sample){
                sine, -cos(GLINT_PI * wave / (GLINT_VISIBLE_WAVES - 1)),
                g->box[k][wave]};
    if (p->n_samples == first)
        return;
    p->sine[p->n] = sine;
    p->box[p->n] = p->sample[first].box;
    for (int i = first + 1; i < p->n_samples; i++)
        glint_visible_join_boxes(&p->box[p->n], &p->sample[i].box);
    p->n++;
}

/* Finds the boxes of one ghost at the angles SINE. Tries three wavelengths
 * first. If ALONE, there are no neighbouring zoom positions, so the ghost is
 * visible at each angle at some wavelength. Then all wavelengths are tried
 * where the first three have no light. */
static void find_boxes_at_angles(const struct glint_visible *h, bool alone,
                                 const double *sine, struct box_samples *g)
{
    bool wanted[GLINT_PROFILE];

    *g = (struct box_samples){.seen = {{false}}};
    for (int k = 0; k < GLINT_PROFILE; k++)
        wanted[k] = true;
    for (int i = 0; i < 3; i++)
        find_boxes_of_wave(h, sine, wanted, glint_visible_colour[i], g);
    /* If light passes at only one or two of the three wavelengths, the boxes of
     * the wavelengths between may differ from theirs. */
    for (int k = 0; k < GLINT_PROFILE; k++) {
        const int n = g->seen[k][glint_visible_colour[0]] +
                      g->seen[k][glint_visible_colour[1]] +
                      g->seen[k][glint_visible_colour[2]];

        wanted[k] = n < 3 && (n > 0 || alone);
    }
    for (int wave = 1; wave < GLINT_VISIBLE_WAVES - 1; wave++)
        if (wave != GLINT_VISIBLE_WAVES / 2)
            find_boxes_of_wave(h, sine, wanted, wave, g);
}

/* Extends each box of A to contain the box of B at the same angle and
 * wavelength. */
static void join_box_samples(struct box_samples *a, const struct box_samples *b)
{
    for (int k = 0; k < GLINT_PROFILE; k++)
        for (int wave = 0; wave < GLINT_VISIBLE_WAVES; wave++) {
            if (a->seen[k][wave] && b->seen[k][wave])
                glint_visible_join_boxes(&a->box[k][wave], &b->box[k][wave]);
            else if (b->seen[k][wave])
                a->box[k][wave] = b->box[k][wave];
            a->seen[k][wave] |= b->seen[k][wave];
        }
}

void glint_visible_find_profile(const struct glint_visible *visible,
                                const double range[2],
                                struct glint_visible_profile *profile)
{
    struct box_samples g, other;
    double sine[GLINT_PROFILE];

    for (int k = 0; k < GLINT_PROFILE; k++) {
        const double t = sin(0.5 * GLINT_PI * k / (GLINT_PROFILE - 1));

        sine[k] = range[0] + t * (range[1] - range[0]);
    }
    find_boxes_at_angles(visible, visible->n_beside == 0, sine, &g);
    for (int k = 0; k < visible->n_beside; k++) {
        find_boxes_at_angles(&visible->beside[k], false, sine, &other);
        join_box_samples(&g, &other);
    }
    profile->n = profile->n_samples = 0;
    for (int k = 0; k < GLINT_PROFILE; k++)
        append_angle_to_profile(profile, sine[k], &g, k);
}

/* ------------------------------------------------------------------- ranges */

enum {
    SCAN_DEG = 1,
    BISECTIONS = 8,
    /* Max number of scan steps by which an angle range is extended beyond the
     * last angle with light at mid band. There light may still pass at the ends
     * of the band. */
    FARTHER = 4
};

/* Returns whether light passes at one of the first N wavelengths of
 * glint_visible_colour, and sets BOX to the box at that wavelength. NEAR is the
 * box at a nearby angle, around which light is searched first, or NULL. */
static bool find_box_at_any_colour(const struct glint_visible *h, double sine,
                                   int n, const struct glint_pupil *near,
                                   struct glint_pupil *box)
{
    for (int k = 0; k < n && near; k++) {
        struct glint_pupil around = enlarge_box_by_margin(near);

        if (shrink_box_to_visible(h, &h->position_path[glint_visible_colour[k]],
                                  sine, 24, 12, &around)) {
            *box = around;
            return true;
        }
    }
    for (int k = 0; k < n; k++)
        if (find_visible_box(h, &h->position_path[glint_visible_colour[k]],
                             sine, box))
            return true;
    return false;
}

/* Finds the end of an angle range by bisection: the last sine, from WITH
 * towards WITHOUT, at which light of any of the three wavelengths passes. At
 * mid band, light passes at WITH, in BOX, but not at WITHOUT. */
static double find_end_of_angle_range(const struct glint_visible *h,
                                      double with, double without,
                                      const struct glint_pupil *box)
{
    struct glint_pupil last = *box, found;

    for (int k = 0; k < FARTHER && without > 0 && without < 1; k++) {
        const double next = without + (without - with);

        if (!find_box_at_any_colour(h, without, 3, &last, &found))
            break;
        last = found;
        with = without;
        without = fmin(1, fmax(0, next));
    }
    for (int k = 0; k < BISECTIONS; k++) {
        const double middle = 0.5 * (with + without);

        if (find_box_at_any_colour(h, middle, 3, &last, &found)) {
            last = found;
            with = middle;
        } else {
            without = middle;
        }
    }
    return with;
}

/* Sets the end of the last of N ranges to HI. Removes the range if it is empty,
 * and merges it with the range before it if they overlap. Returns the new
 * number of ranges. */
static int end_angle_range(double (*range)[2], int n, double hi)
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

static int find_angle_ranges(const struct glint_visible *visible,
                             double max_deg, double (*range)[2])
{
    const int steps = (int)ceil(max_deg / SCAN_DEG);
    struct glint_pupil last = {.y1_mm = 0}, box;
    double before = 0;
    bool inside = false;
    int n = 0;

    for (int k = 0; k <= steps; k++) {
        const double sine = glint_sin_deg(fmin(k * SCAN_DEG, max_deg));
        const bool now = find_box_at_any_colour(visible, sine, 1,
                                                inside ? &last : NULL, &box);

        if (now && !inside && n == GLINT_MAX_RANGES)
            break;
        if (now && !inside)
            range[n++][0] =
                k ? find_end_of_angle_range(visible, sine, before, &box) : 0;
        if (!now && inside)
            n = end_angle_range(
                range, n,
                find_end_of_angle_range(visible, before, sine, &last));
        last = now ? box : last;
        inside = now;
        before = sine;
    }
    return inside ? end_angle_range(range, n, before) : n;
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

int glint_visible_find_ranges(const struct glint_visible *visible,
                              double max_deg, double (*range)[2])
{
    int n = find_angle_ranges(visible, max_deg, range);

    for (int k = 0; k < visible->n_beside; k++) {
        double other[GLINT_MAX_RANGES][2];
        const int n_other =
            find_angle_ranges(&visible->beside[k], max_deg, other);

        for (int i = 0; i < n_other; i++)
            n = glint_visible_add_range(range, n, other[i]);
    }
    return n;
}
