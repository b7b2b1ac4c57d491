/* SPDX-License-Identifier: MIT
 *
 * Finds the region of the entrance pupil through which a ghost's visible rays
 * pass. A grid of rays covers the front element. A cell is marked if a visible
 * ray may pass inside it. The test uses the bounding box of the stop positions
 * and relative radii of its corners, enlarged by a margin because rays bend
 * between corners. Finer grids then cover the marked cells until the region no
 * longer shrinks. If no cell is marked, the light's plane is searched for a
 * small spot (spot.h).
 *
 * Limit: a visible region smaller than 1/64 of the front element can be missed.
 * This happens if rays around it bend by more than the margin, and if it is
 * elongated or lies off the light's plane.
 */
#include "glint/trace.h"

#include <math.h>
#include <string.h>

#include "bake/table/form.h"
#include "bake/trace/spot.h"
#include "engine/setup/degrees.h"

enum { ACROSS = 64, DOWN = 32, ROUNDS = 8, TURNS = 16 };

/* numbers of cells in later rounds, which cover a smaller region */
enum { NEXT_ACROSS = 24, NEXT_DOWN = 12 };
/* numbers of cells and rounds of glint_pupil_find_roughly() */
enum { ROUGH_ACROSS = 16, ROUGH_DOWN = 8, ROUGH_ROUNDS = 4 };

/* A pupil is enlarged on each side by this fraction of its size, so that it
 * contains the pupils of nearby wavelengths and directions. */
#define EXTEND 0.125

struct search {
    /* openings that visible rays must pass; its path is the member places */
    struct glint_openings openings;
    /* copy of path with places_only set, for tracing without energies */
    struct glint_path places;
    const struct glint_path *path;
    int across, down; /* numbers of cells across and down in this round */
    /* rays of the grid, [down + 1][across + 1] */
    struct glint_ray ray[(DOWN + 1) * (ACROSS + 1)];
    enum glint_ray_status status[(DOWN + 1) * (ACROSS + 1)];
    /* region that the grid of this round covers */
    struct glint_pupil grid;
    /* true: the ray is a corner of a marked cell, in which light may pass */
    bool kept[DOWN + 1][ACROSS + 1];
};

static double compute_grid_column_x(const struct search *s,
                                    const struct glint_pupil *p, int i)
{
    return p->x0_mm + (p->x1_mm - p->x0_mm) * i / s->across;
}

static double compute_grid_row_y(const struct search *s,
                                 const struct glint_pupil *p, double j)
{
    return p->y0_mm + (p->y1_mm - p->y0_mm) * j / s->down;
}

/* Returns the index of ray I in row J of the grid. */
static int get_ray_index(const struct search *s, int i, int j)
{
    return j * (s->across + 1) + i;
}

/* Traces N rows of the grid of rays over the pupil region P along PATH, from
 * row J on. */
static void trace_grid_rows(struct search *s, const struct glint_pupil *p,
                            const struct glint_path *path, int j, int n)
{
    const double *d = s->openings.direction;
    const struct glint_row row = {s->across + 1,
                                  p->x0_mm,
                                  (p->x1_mm - p->x0_mm) / s->across,
                                  0,
                                  {d[0], d[1], d[2]}};
    const int first = get_ray_index(s, 0, j);
    double y_mm[DOWN + 1];

    for (int k = 0; k < n; k++)
        y_mm[k] = compute_grid_row_y(s, p, j + k);
    glint_trace_grid(path, &row, n, y_mm, s->ray + first, s->status + first,
                     NULL);
}

struct bounds {
    int n;
    /* min and max, over rays, of these values: stop x, stop y, relative radius,
     * sensor x, sensor y */
    double low[5], high[5];
};

static inline void add_ray_to_bounds(struct bounds *b,
                                     const struct glint_ray *ray)
{
    const double v[5] = {ray->stop_x_mm, ray->stop_y_mm, ray->rel_radius,
                         ray->sensor_x_mm, ray->sensor_y_mm};

    if (b->n++ == 0) {
        memcpy(b->low, v, sizeof v);
        memcpy(b->high, v, sizeof v);
        return;
    }
    for (int k = 0; k < 5; k++) {
        b->low[k] = b->low[k] < v[k] ? b->low[k] : v[k];
        b->high[k] = b->high[k] > v[k] ? b->high[k] : v[k];
    }
}

static double compute_distance_to_zero(double low, double high)
{
    return low > 0 ? low : high < 0 ? -high : 0;
}

/* Returns whether the rectangle LOW .. HIGH, (x, y), has a point within RADIUS
 * of (0, 0). */
static bool is_circle_reached(const double *low, const double *high,
                              double radius)
{
    const double x = compute_distance_to_zero(low[0], high[0]);
    const double y = compute_distance_to_zero(low[1], high[1]);

    return x * x + y * y <= radius * radius;
}

/* Returns whether an unblocked ray may pass within a cell. B: bounds of the
 * valid rays at its corners. The margin is doubled if a corner is invalid. */
static bool can_cell_pass_light(const struct search *s, const struct bounds *b)
{
    const double more = b->n == 4 ? 0.5 : 1;
    double low[5], high[5];

    if (b->n == 0)
        return false;
    for (int k = 0; k < 5; k++) {
        const double grow = more * (b->high[k] - b->low[k]);

        low[k] = b->low[k] - grow;
        high[k] = b->high[k] + grow;
    }
    return low[2] <= 1 && is_circle_reached(low, high, s->openings.stop_mm) &&
           is_circle_reached(low + 3, high + 3, s->openings.field_mm);
}

/* Marks the corners of cell (I, J) and extends BOX by the cell. CELL: bounds of
 * the rays at its corners, by which the sensor range of FOUND is extended. */
static void mark_visible_cell(struct search *s, int i, int j,
                              const struct bounds *cell, struct bounds *box,
                              struct glint_pupil *found)
{
    const int at[4] = {i, i + 1, j, j + 1};
    double *sensor = found->sensor_mm;

    for (int k = 0; k < 4; k += 2) {
        const double lo = at[k], hi = at[k + 1];

        box->low[k] = box->n ? fmin(box->low[k], lo) : lo;
        box->high[k] = box->n ? fmax(box->high[k], hi) : hi;
    }
    for (int k = 0; k < 2; k++) {
        const double lo = cell->low[3 + k], hi = cell->high[3 + k];

        sensor[2 * k] = box->n ? fmin(sensor[2 * k], lo) : lo;
        sensor[2 * k + 1] = box->n ? fmax(sensor[2 * k + 1], hi) : hi;
    }
    box->n++;
    for (int k = 0; k < 4; k++)
        s->kept[j + (k >> 1)][i + (k & 1)] = true;
}

/* Extends the sensor range of P by its mirror image about y = 0. */
static void mirror_sensor_range(struct glint_pupil *p)
{
    p->sensor_mm[3] = fmax(fabs(p->sensor_mm[2]), fabs(p->sensor_mm[3]));
    p->sensor_mm[2] = -p->sensor_mm[3];
}

/* Shrinks P to the cells that may contain an unblocked ray. Returns whether
 * there are any. */
static bool shrink_to_visible_cells(struct search *s, struct glint_pupil *p)
{
    struct glint_pupil found = *p;
    struct bounds box = {.n = 0};

    s->grid = *p;
    memset(s->kept, 0, sizeof s->kept);
    trace_grid_rows(s, p, &s->places, 0, s->down + 1);
    for (int j = 0; j < s->down; j++)
        for (int i = 0; i < s->across; i++) {
            struct bounds cell;

            cell.n = 0; /* the arrays stay unset, which is faster */
            for (int k = 0; k < 4; k++) {
                const int at = get_ray_index(s, i + (k & 1), j + (k >> 1));

                if (s->status[at] == GLINT_RAY_OK)
                    add_ray_to_bounds(&cell, &s->ray[at]);
            }
            if (can_cell_pass_light(s, &cell))
                mark_visible_cell(s, i, j, &cell, &box, &found);
        }
    if (box.n == 0)
        return false;
    found.x0_mm = compute_grid_column_x(s, p, (int)box.low[0]);
    found.x1_mm = compute_grid_column_x(s, p, (int)box.high[0]);
    found.y1_mm = compute_grid_row_y(s, p, box.high[2]);
    if (s->path->round)
        mirror_sensor_range(&found);
    else
        found.y0_mm = compute_grid_row_y(s, p, box.low[2]);
    *p = found;
    return true;
}

/* Returns the distance in z of the front element's rim from its vertex plane,
 * mm. A slanted ray through the rim crosses that plane outside the rim by up to
 * this distance times the tangent of its angle. */
static double compute_front_rim_depth(const struct glint_path *path,
                                      const struct glint_event *front)
{
    const double h = front->semi_mm, c = front->curvature;
    double slope[2], most = 0;

    if (!front->shaped)
        return c * h * h / (1 + sqrt(fmax(0, 1 - c * c * h * h)));
    for (int k = 0; k < TURNS; k++)
        most = fmax(most, fabs(glint_form_compute_sag(
                              &path->form[front->surface],
                              h * glint_cos_deg(360.0 / TURNS * k),
                              h * glint_sin_deg(360.0 / TURNS * k), slope)));
    return most;
}

/* Returns the max displacement of the front element's rim by its decentre and
 * tilt, mm. */
static double compute_max_rim_displacement(const struct glint_path *path,
                                           const struct glint_event *front)
{
    const struct glint_form *f = &path->form[front->surface];

    return front->shaped && !f->level
               ? fabs(f->shift[0]) + fabs(f->shift[1]) + fabs(f->shift[2])
               : 0;
}

static struct glint_pupil
compute_front_element_box(const struct glint_path *path,
                          const struct glint_event *front,
                          const double direction[3])
{
    const double off = compute_max_rim_displacement(path, front),
                 h = front->semi_mm + off;
    const double deep = fabs(compute_front_rim_depth(path, front)) + off;
    const double x = h + deep * fabs(direction[0] / direction[2]);
    const double y = h + deep * fabs(direction[1] / direction[2]);

    return (struct glint_pupil){.x0_mm = -x,
                                .x1_mm = x,
                                .y0_mm = path->round ? 0 : -y,
                                .y1_mm = y,
                                .mirrored = path->round};
}

/* Returns the max energy at the marked corners of the last grid. */
static double find_max_energy(struct search *s)
{
    double most = 0;

    for (int j = 0; j <= s->down; j++) {
        if (!memchr(s->kept[j], 1, sizeof s->kept[j]))
            continue;
        trace_grid_rows(s, &s->grid, s->path, j, 1);
        for (int i = 0; i <= s->across; i++) {
            const int at = get_ray_index(s, i, j);

            if (s->kept[j][i] && s->status[at] == GLINT_RAY_OK)
                most = fmax(most, s->ray[at].energy);
        }
    }
    return most;
}

static double compute_box_area(const struct glint_pupil *p)
{
    return (p->x1_mm - p->x0_mm) * (p->y1_mm - p->y0_mm);
}

/* Returns BOX enlarged on each side by the fraction PART of its size. A
 * fraction of the size of FRONT is added, because boxes may be very thin. */
static struct glint_pupil enlarge_pupil_box(const struct glint_pupil *box,
                                            double part,
                                            const struct glint_pupil *front)
{
    const double more =
        part * (box->x1_mm - box->x0_mm) + 0.01 * (front->x1_mm - front->x0_mm);

    const double half = part * (box->y1_mm - box->y0_mm);
    const double rim = 0.02 * front->y1_mm;

    return (struct glint_pupil){
        .x0_mm = fmax(front->x0_mm, box->x0_mm - more),
        .x1_mm = fmin(front->x1_mm, box->x1_mm + more),
        .y0_mm = fmax(front->y0_mm, box->y0_mm - half - rim),
        .y1_mm = fmin(front->y1_mm, box->y1_mm + half + rim),
        .mirrored = front->mirrored};
}

/* Shrinks P by several grids, the first one with ACROSS x DOWN cells. Returns
 * whether any ray passes. */
static bool shrink_pupil_in_rounds(struct search *s, struct glint_pupil *p,
                                   int across, int down)
{
    bool found = true;

    for (int round = 0; round < ROUNDS && found; round++) {
        const double before = compute_box_area(p);

        s->across = round ? NEXT_ACROSS : across;
        s->down = round ? NEXT_DOWN : down;
        found = shrink_to_visible_cells(s, p);
        if (round > 0 && compute_box_area(p) > 0.8 * before)
            break;
    }
    /* Only positions decide which cells are marked, so energies are traced for
     * the last grid only. */
    if (found)
        p->energy = find_max_energy(s);
    return found;
}

/* Finds a visible region that all rays of the first grid missed. Searches the
 * light's plane through the middle of the front element. */
static bool find_visible_spot(struct search *s, const struct glint_pupil *front,
                              struct glint_pupil *p)
{
    double x[2];

    if (!glint_spot_find_passing_range(&s->openings, front, x))
        return false;
    *p = (struct glint_pupil){.x0_mm = x[0],
                              .x1_mm = x[1],
                              .y0_mm = front->mirrored ? 0 : x[0] - x[1],
                              .y1_mm = x[1] - x[0],
                              .mirrored = front->mirrored};
    glint_spot_grow_pupil(&s->openings, p);
    return shrink_pupil_in_rounds(s, p, NEXT_ACROSS, NEXT_DOWN);
}

/* Finds the visible region within P and sets P to it. If no ray within P
 * passes, searches the front element FRONT for a small spot. NEAR: P is an
 * estimate of the region, so that coarse grids suffice. */
static bool find_visible_region(struct search *s,
                                const struct glint_pupil *front,
                                struct glint_pupil *p, bool near)
{
    struct glint_pupil wider;

    if (!shrink_pupil_in_rounds(s, p, near ? NEXT_ACROSS : ACROSS,
                                near ? NEXT_DOWN : DOWN))
        return find_visible_spot(s, front, p);
    /* Where rays bend by more than the margin, some visible rays enter outside
     * the marked cells. */
    wider = *p;
    if (glint_spot_grow_pupil(&s->openings, &wider) &&
        shrink_pupil_in_rounds(s, &wider, NEXT_ACROSS, NEXT_DOWN))
        *p = wider;
    return true;
}

bool glint_pupil_find(struct glint_pupil *pupil, const struct glint_path *path,
                      double theta_deg, double stop_radius_mm,
                      const struct glint_pupil *near)
{
    return glint_pupil_find_within(pupil, path, theta_deg, stop_radius_mm,
                                   HUGE_VAL, near);
}

bool glint_pupil_find_within(struct glint_pupil *pupil,
                             const struct glint_path *path, double theta_deg,
                             double stop_radius_mm, double field_mm,
                             const struct glint_pupil *near)
{
    const double direction[3] = {glint_sin_deg(theta_deg), 0,
                                 glint_cos_deg(theta_deg)};

    return glint_pupil_find_towards(pupil, path, direction, stop_radius_mm,
                                    field_mm, near);
}

/* Prepares S for PATH and sets WHOLE to the whole front element. Returns false
 * if PATH has no surface. */
static bool begin_pupil_search(struct search *s, const struct glint_path *path,
                               const double direction[3], double stop_mm,
                               double field_mm, struct glint_pupil *whole)
{
    const struct glint_event *front = NULL;

    for (int k = 0; k < path->n_events && !front; k++)
        if (path->event[k].kind != GLINT_STOP)
            front = &path->event[k];
    if (!front)
        return false;
    s->openings = (struct glint_openings){
        .path = &s->places,
        .direction = {direction[0], direction[1], direction[2]},
        .stop_mm = stop_mm,
        .field_mm = field_mm};
    s->path = path;
    s->places = *path;
    s->places.places_only = true;
    *whole = compute_front_element_box(path, front, direction);
    return true;
}

bool glint_pupil_find_towards(struct glint_pupil *pupil,
                              const struct glint_path *path,
                              const double direction[3], double stop_radius_mm,
                              double field_mm, const struct glint_pupil *near)
{
    struct search s; /* 150 KB on the stack; see GLINT_BAKE_STACK_BYTES */
    struct glint_pupil whole, p;
    bool found;

    if (!begin_pupil_search(&s, path, direction, stop_radius_mm, field_mm,
                            &whole))
        return false;
    p = near ? enlarge_pupil_box(near, 0.5, &whole) : whole;
    found = find_visible_region(&s, &whole, &p, near);
    if (found)
        *pupil = p;
    return found;
}

bool glint_pupil_find_roughly(struct glint_pupil *pupil,
                              const struct glint_path *path,
                              const double direction[3], double stop_radius_mm)
{
    struct search s;
    struct glint_pupil p;
    double before = HUGE_VAL;

    if (!begin_pupil_search(&s, path, direction, stop_radius_mm, HUGE_VAL, &p))
        return false;
    s.across = ROUGH_ACROSS;
    s.down = ROUGH_DOWN;
    for (int round = 0;
         round < ROUGH_ROUNDS && compute_box_area(&p) < 0.8 * before; round++) {
        before = compute_box_area(&p);
        if (!shrink_to_visible_cells(&s, &p))
            return false;
    }
    p.energy = 0;
    *pupil = p;
    return true;
}

/* Returns whether A reaches a side of B at which B ends inside FRONT. */
static bool is_box_side_reached(const struct glint_pupil *a,
                                const struct glint_pupil *b,
                                const struct glint_pupil *front)
{
    return (a->x0_mm <= b->x0_mm && b->x0_mm > front->x0_mm) ||
           (a->x1_mm >= b->x1_mm && b->x1_mm < front->x1_mm) ||
           (!a->mirrored && a->y0_mm <= b->y0_mm && b->y0_mm > front->y0_mm) ||
           (a->y1_mm >= b->y1_mm && b->y1_mm < front->y1_mm);
}

static void extend_pupil_to_contain(struct glint_pupil *all,
                                    const struct glint_pupil *p)
{
    all->x0_mm = fmin(all->x0_mm, p->x0_mm);
    all->x1_mm = fmax(all->x1_mm, p->x1_mm);
    all->y0_mm = fmin(all->y0_mm, p->y0_mm);
    all->y1_mm = fmax(all->y1_mm, p->y1_mm);
    all->energy = fmax(all->energy, p->energy);
    for (int k = 0; k < 4; k += 2) {
        all->sensor_mm[k] = fmin(all->sensor_mm[k], p->sensor_mm[k]);
        all->sensor_mm[k + 1] =
            fmax(all->sensor_mm[k + 1], p->sensor_mm[k + 1]);
    }
}

bool glint_pupil_extend(struct glint_pupil *pupil,
                        const struct glint_path *path,
                        const double direction[3], double stop_radius_mm)
{
    struct search s;
    struct glint_pupil whole, grown, p;

    if (!begin_pupil_search(&s, path, direction, stop_radius_mm, HUGE_VAL,
                            &whole))
        return false;
    grown = p = enlarge_pupil_box(pupil, EXTEND, &whole);
    s.across = NEXT_ACROSS;
    s.down = NEXT_DOWN;
    if (shrink_to_visible_cells(&s, &p) &&
        !is_box_side_reached(&p, &grown, &whole)) {
        p.energy = pupil->energy;
        extend_pupil_to_contain(pupil, &p);
        return true;
    }
    p = enlarge_pupil_box(pupil, 0.5, &whole);
    if (!find_visible_region(&s, &whole, &p, true))
        return false;
    extend_pupil_to_contain(pupil, &p);
    return true;
}
