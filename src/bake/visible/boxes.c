/* SPDX-License-Identifier: MIT */
#include "bake/visible/boxes.h"

#include <math.h>

#include "bake/trace/spot.h"
#include "engine/setup/degrees.h"

enum { ACROSS = 64 /* cells of the finest grid */ };

/* Columns and rows of a grid that hold rays which get through. */
struct extent {
    int i0, i1, j1;
};

static bool sample_box(const struct glint_visible *h,
                       const struct glint_path *path, double sine, int across,
                       int down, const struct glint_pupil *box,
                       struct extent *extent)
{
    struct glint_row row = {across + 1,
                            box->x0_mm,
                            (box->x1_mm - box->x0_mm) / across,
                            0,
                            {sine, 0, sqrt(1 - sine * sine)}};
    struct glint_ray ray[ACROSS + 1];
    enum glint_ray_status status[ACROSS + 1];

    *extent = (struct extent){across + 1, -1, -1};
    for (int j = 0; j <= down; j++) {
        row.y_mm = box->y1_mm * j / down;
        glint_trace_row(path, &row, ray, status, NULL);
        for (int i = 0; i <= across; i++) {
            if (status[i] != GLINT_RAY_OK || !glint_visible_passes(h, &ray[i]))
                continue;
            extent->i0 = i < extent->i0 ? i : extent->i0;
            extent->i1 = i > extent->i1 ? i : extent->i1;
            extent->j1 = j;
        }
    }
    return extent->i1 >= 0;
}

/* Shrinks BOX to those rays of a grid that get through, and a cell around them.
 * Returns whether there are any. */
bool glint_boxes_shrink(const struct glint_visible *h,
                        const struct glint_path *path, double sine, int across,
                        int down, struct glint_pupil *box)
{
    const double dx = (box->x1_mm - box->x0_mm) / across;
    const double dy = box->y1_mm / down, x0 = box->x0_mm;
    struct extent e;

    if (!sample_box(h, path, sine, across, down, box, &e))
        return false;
    box->x0_mm = x0 + fmax(e.i0 - 1, 0) * dx;
    box->x1_mm = x0 + fmin(e.i1 + 1, across) * dx;
    box->y1_mm = fmin(e.j1 + 1, down) * dy;
    return true;
}

/* Grows BOX on every side at which light still comes through, until none does.
 */
static bool enclose(const struct glint_visible *h,
                    const struct glint_path *path, double sine,
                    struct glint_pupil *box)
{
    enum { COARSE = 16, DOWN = 8, ROUNDS = 8 };

    for (int round = 0; round < ROUNDS; round++) {
        const double more = 0.5 * (box->x1_mm - box->x0_mm);
        struct extent e;

        if (!sample_box(h, path, sine, COARSE, DOWN, box, &e))
            return false;
        if (e.i0 > 0 && e.i1 < COARSE && e.j1 < DOWN)
            return true;
        box->x0_mm -= e.i0 == 0 ? more : 0;
        box->x1_mm += e.i1 == COARSE ? more : 0;
        box->y1_mm *= e.j1 == DOWN ? 1.5 : 1;
    }
    return false;
}

/* Moves the sides of BOX past which rays get through, as tips of crescents that
 * are thinner than its cells do. */
static void grow(const struct glint_visible *h, const struct glint_path *path,
                 double sine, struct glint_pupil *box)
{
    const struct glint_openings openings = {
        .path = path,
        .direction = {sine, 0, sqrt(1 - sine * sine)},
        .stop_mm = h->setup->optics.stop_radius_mm,
        .field_mm = h->field_mm};

    box->y0_mm = 0;
    box->mirrored = true;
    glint_spot_grow(&openings, box);
}

/* Shrinks BOX, which holds all rays that get through, to the box of these. */
static bool tighten(const struct glint_visible *h,
                    const struct glint_path *path, double sine,
                    struct glint_pupil *box)
{
    bool found = glint_boxes_shrink(h, path, sine, 24, 12, box) ||
                 glint_boxes_shrink(h, path, sine, ACROSS, 32, box);

    for (int round = 0; round < 5 && found; round++) {
        const double before = (box->x1_mm - box->x0_mm) * box->y1_mm;

        if (!glint_boxes_shrink(h, path, sine, 24, 12, box) ||
            (box->x1_mm - box->x0_mm) * box->y1_mm > 0.8 * before)
            break;
    }
    if (found && h->far)
        grow(h, path, sine, box);
    return found;
}

/* Returns by how much RAY misses: 1 or less is visible. */
static double miss_of(const struct glint_visible *h,
                      const struct glint_ray *ray)
{
    const double stop =
        hypot(ray->stop_x_mm, ray->stop_y_mm) / h->setup->optics.stop_radius_mm;
    const double field =
        hypot(ray->sensor_x_mm, ray->sensor_y_mm) / h->field_mm;

    return fmax(ray->rel_radius, fmax(stop, field));
}

/* Shrinks BOX to a cell and a half around the ray of a grid that misses by
 * least. Returns its miss; HUGE_VAL if all rays are lost. */
static double close_in(const struct glint_visible *h,
                       const struct glint_path *path, double sine,
                       struct glint_pupil *box)
{
    enum { DOWN = 32 };
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
            if (status[i] != GLINT_RAY_OK || miss_of(h, &ray[i]) >= least)
                continue;
            least = miss_of(h, &ray[i]);
            box->x0_mm = x0 + (i - 1.5) * dx;
            box->x1_mm = x0 + (i + 1.5) * dx;
            box->y1_mm = (j + 1.5) * dy;
        }
    }
    return least;
}

/* Finds a part of the pupil that a grid over BOX misses: if the field is far
 * smaller than the front, so is the part of the pupil through which it is seen.
 */
static bool seek(const struct glint_visible *h, const struct glint_path *path,
                 double sine, struct glint_pupil *box)
{
    enum { ROUNDS = 4 };

    if (h->field_mm > 0.1 * h->setup->lens->surface[0].semi_mm)
        return false;
    for (int round = 0; round < ROUNDS; round++)
        if (close_in(h, path, sine, box) <= 1)
            return enclose(h, path, sine, box);
    return false;
}

static double degrees_of(double sine)
{
    return asin(sine) * (180 / GLINT_PI);
}

bool glint_boxes_find(const struct glint_visible *h,
                      const struct glint_path *path, double sine,
                      struct glint_pupil *box)
{
    struct glint_pupil spot;

    if (!glint_pupil_find_within(box, path, degrees_of(sine),
                                 h->setup->optics.stop_radius_mm, h->field_mm,
                                 NULL))
        return false;
    spot = *box;
    if (tighten(h, path, sine, box))
        return true;
    *box = spot;
    return seek(h, path, sine, box) && tighten(h, path, sine, box);
}

struct glint_pupil glint_boxes_grown(const struct glint_pupil *near)
{
    const double more = 0.2 * (near->x1_mm - near->x0_mm);
    struct glint_pupil box = *near;

    box.x0_mm -= more;
    box.x1_mm += more;
    box.y1_mm *= 1.25;
    return box;
}

/* Finds the box at SINE, looking around NEAR first. */
bool glint_boxes_follow(const struct glint_visible *h,
                        const struct glint_path *path, double sine,
                        const struct glint_pupil *near, struct glint_pupil *box)
{
    *box = glint_boxes_grown(near);
    return (enclose(h, path, sine, box) && tighten(h, path, sine, box)) ||
           glint_boxes_find(h, path, sine, box);
}
