/* SPDX-License-Identifier: MIT */
#include "bake/exact/ray_field.h"

#include <math.h>
#include <string.h>

#include "bake/trace/sampling.h"
#include "engine/setup/degrees.h"
#include "lens/grid.h"

/* Cells per side of two coarse grids of rays. SAMPLING: the grid from which the
 * barrels and the number of grid cells are chosen. LOOKS: the grid with which
 * the brightness of a ghost is measured. DRAFT_SAMPLING, DRAFT_LOOKS: the same
 * for drafts. */
enum { SAMPLING = 24, LOOKS = 16, DRAFT_SAMPLING = 12, DRAFT_LOOKS = 8 };

/* In drafts, the pupil of one direction and wavelength is enlarged on each side
 * by this fraction of its size, to contain the pupils of the others. */
#define DRAFT_MARGIN 0.05
/* FEW_INSIDE: min number of visible rays in the grid SAMPLING from which the
 * number of grid cells can be computed. CELLS_A_RADIUS: number of cells per
 * stop radius if fewer rays are visible. */
enum { FEW_INSIDE = 6, CELLS_A_RADIUS = 4 };
/* number of rays that one call of the tracer traces */
enum { SOME = 16 };
/* Channels of a node: X, Y: position in pixels; STOP_X, STOP_Y: position in
 * stop radii; both are in the light's frame. BARREL_0, BARREL_1: as in struct
 * glint_vertex. ENERGY: energy / energy_unit. */
enum { X, Y, STOP_X, STOP_Y, BARREL_0, BARREL_1, ENERGY, CHANNELS };
enum { MOST_SIDE = GLINT_MAX_CELLS + 1 };

/* Smaller weights of samples count as 0: where a weight is 0, its rounding
 * error depends on the C library, and so would the rays that are invalid. */
#define LEAST_WEIGHT 1e-6F

#define MOST_SAG (1.0 / 16)

void glint_ray_compute_direction(const struct ray_field_config *cfg,
                                 const double at[2], double direction[3])
{
    direction[0] = cfg->round ? glint_sin_deg(at[0]) : at[0];
    direction[1] = cfg->round ? 0 : at[1];
    direction[2] = cfg->round
                       ? glint_cos_deg(at[0])
                       : sqrt(fmax(0, 1 - at[0] * at[0] - at[1] * at[1]));
}

static void init_field_path(const struct ray_field_config *cfg,
                            const struct ray_field *field, double nm,
                            struct glint_path *path)
{
    const struct glint_setup *s = cfg->setup;

    glint_path_init_at(path, s->lens, &s->ghost[field->ghost], nm,
                       field->patch->phi_deg);
}

/* --------------------------------------------------------------------- look */

/* Returns the curvature of the stop's edges: 0 for straight blades, 1 for a
 * circular stop. */
static double compute_stop_curvature(const struct ray_field_config *cfg)
{
    return cfg->setup->n_blades == 0 ? 1 : cfg->setup->iris.roundness;
}

/* Returns the number of cells per side by the rule of lens/grid.h, but at least
 * LEAST_CELLS. With fewer cells the rays could miss the opening of the stop.
 * Near total reflection the pupil box may be the complete front element, while
 * the light enters through 1 % of it. */
static int choose_cell_count(const struct ray_field_config *cfg,
                             const struct ray_measures *s, bool folds,
                             int *least_cells)
{
    const double pixels = cfg->view.width / cfg->view.sensor_width_mm;
    const double round = compute_stop_curvature(cfg) * s->round_mm;
    const double outline = fmax(s->outline_mm, round);
    const double bend = fmax(s->bend_mm, 0.1 * outline);
    const double finer = cfg->max_cells / 64.0;
    const double most = glint_grid_get_max_cells(cfg->max_cells, folds);
    const double n = fmin(most, finer * sqrt(bend * pixels / (8 * 0.01)));
    const double least =
        s->n_inside < FEW_INSIDE
            ? fmin(4 * cfg->max_cells, CELLS_A_RADIUS * s->step)
            : GLINT_LEAST_CELLS;

    *least_cells = cfg->uniform ? cfg->max_cells : (int)ceil(least);
    if (cfg->uniform)
        return cfg->max_cells;
    return glint_grid_round_up_to_four((int)ceil(
        fmin(GLINT_MAX_CELLS, fmax(fmax(GLINT_LEAST_CELLS, least), n))));
}

static bool is_barrel_listed(const struct ray_field *field, int event)
{
    for (int k = 0; k < field->n_cuts; k++)
        if (field->cut_event[k] == event)
            return true;
    return false;
}

/* Adds the barrels that block rays to those of FIELD. The first is the barrel
 * that forms most of the outline. It has a channel of its own, because the max
 * over several barrels may have kinks. */
static void list_blocking_barrels(struct ray_field *field,
                                  struct glint_sampling *sampling)
{
    while (field->n_cuts < RAY_FIELD_CUTS) {
        int most = 0;

        for (int k = 1; k < sampling->n_cuts; k++)
            if (sampling->cut_weight[k] > sampling->cut_weight[most])
                most = k;
        if (sampling->n_cuts == 0 || sampling->cut_weight[most] == 0)
            break;
        sampling->cut_weight[most] = 0;
        if (!is_barrel_listed(field, sampling->cut_event[most]))
            field->cut_event[field->n_cuts++] = sampling->cut_event[most];
    }
}

/* Adds the barrels that block rays at the ends of the band only. Near an angle
 * at which a barrel begins to vignette, it blocks blue rays but not green
 * ones. */
static void list_barrels_of_band_ends(const struct ray_field_config *cfg,
                                      struct ray_field *field,
                                      const double direction[3])
{
    struct glint_sampling sampling;
    struct glint_path path;

    for (int k = 0; k < 3; k += 2) {
        init_field_path(cfg, field, cfg->wave_nm[k], &path);
        glint_sampling_trace_grid(&sampling, &path, &field->pupil, direction,
                                  cfg->setup->optics.stop_radius_mm, SAMPLING);
        list_blocking_barrels(field, &sampling);
    }
}

/* Merges MORE, the sampling of another direction, into ALL. */
static void merge_sampling(struct glint_sampling *all,
                           const struct glint_sampling *more)
{
    for (int k = 0; k < more->n_cuts; k++) {
        int i = 0;

        while (i < all->n_cuts && all->cut_event[i] != more->cut_event[k])
            i++;
        if (i == all->n_cuts) {
            if (i == GLINT_MAX_EVENTS)
                continue;
            all->cut_event[all->n_cuts] = more->cut_event[k];
            all->cut_weight[all->n_cuts++] = 0;
        }
        all->cut_weight[i] += more->cut_weight[k];
    }
    all->bend_mm = fmax(all->bend_mm, more->bend_mm);
    all->outline_mm = fmax(all->outline_mm, more->outline_mm);
    all->round_mm = fmax(all->round_mm, more->round_mm);
    if (more->n_inside > all->n_inside) {
        all->n_inside = more->n_inside;
        all->step = more->step;
    }
    all->folds |= more->folds;
}

/* Sets AT to the direction in the middle of side K (0 .. 3) of PATCH. Returns
 * false if PATCH has no extent towards that side. */
static bool get_patch_side_middle(const struct ray_field_config *cfg,
                                  const struct ray_patch *patch, int k,
                                  double at[2])
{
    at[0] = patch->middle[0] + (k == 0 ? -1 : k == 1) * patch->half[0];
    at[1] = patch->middle[1] + (k == 2 ? -1 : k == 3) * patch->half[1];
    return k < (cfg->round ? 2 : 4) && patch->half[k / 2] > 0;
}

/* Enlarges the pupil of the ghost such that the ghost grows by one pixel on
 * each side. Pixels whose centre lies just outside the ghost still receive
 * light. */
static void enlarge_pupil_by_pixel(const struct ray_field_config *cfg,
                                   struct glint_pupil *p)
{
    double *s = p->sensor_mm;
    const double pixel = cfg->view.sensor_width_mm / cfg->view.width;
    const double x = fmin(0.5, pixel / (s[1] - s[0] + 1e-9));
    const double y = fmin(0.5, pixel / (s[3] - s[2] + 1e-9));
    const double wide = x * (p->x1_mm - p->x0_mm), across = x * (s[1] - s[0]);
    const double high = y * (s[3] - s[2]);

    p->x0_mm -= wide;
    p->x1_mm += wide;
    if (p->mirrored) {
        p->y1_mm *= 1 + 2 * y;
        s[2] *= 1 + 2 * y;
        s[3] *= 1 + 2 * y;
    } else {
        const double more = y * (p->y1_mm - p->y0_mm);

        p->y0_mm -= more;
        p->y1_mm += more;
        s[2] -= high;
        s[3] += high;
    }
    s[0] -= across;
    s[1] += across;
}

/* a coarse grid of rays over the pupil, at one wavelength */
struct coarse_grid {
    int side, rows; /* numbers of cells across and of rows of rays */
    double cell_mm2;
    struct glint_ray ray[LOOKS + 1][LOOKS + 1];
    bool traced[LOOKS + 1][LOOKS + 1], inside[LOOKS + 1][LOOKS + 1];
    /* barrel values as in struct glint_vertex */
    double barrel[LOOKS + 1][LOOKS + 1][2];
};

/* Returns (1 + r^2) / 2 at the barrel of event K, where r is the ray's distance
 * from the axis in barrel radii. */
static double compute_barrel_value(const struct glint_path *path, int k,
                                   double (*hits)[2])
{
    const double semi = path->event[k].semi_mm;
    const double x = hits[k][0] / semi, y = hits[k][1] / semi;

    return 0.5 * (1 + x * x + y * y);
}

/* Sets VALUE[0] to the value of the field's first barrel and VALUE[1] to the
 * max over the other barrels of the field. A value without a barrel is 0. */
static void compute_barrel_values(const struct ray_field *field,
                                  const struct glint_path *path,
                                  double (*hits)[2], double value[2])
{
    value[0] = value[1] = 0;
    for (int k = 0; k < field->n_cuts; k++) {
        double *into = &value[k > 0];

        *into =
            fmax(*into, compute_barrel_value(path, field->cut_event[k], hits));
    }
}

/* Sets entry (I, J) of COARSE_GRID from a traced ray. */
static void set_coarse_ray(const struct ray_field_config *cfg,
                           const struct ray_field *field,
                           const struct glint_path *path, int i, int j,
                           enum glint_ray_status status,
                           const struct glint_ray *ray, double (*hits)[2],
                           struct coarse_grid *coarse_grid)
{
    const bool traced = status == GLINT_RAY_OK;

    coarse_grid->traced[j][i] = traced;
    coarse_grid->inside[j][i] = traced && ray->rel_radius <= 1 &&
                                hypot(ray->stop_x_mm, ray->stop_y_mm) <=
                                    cfg->setup->optics.stop_radius_mm;
    if (!traced)
        return;
    coarse_grid->ray[j][i] = *ray;
    compute_barrel_values(field, path, hits, coarse_grid->barrel[j][i]);
}

static void trace_coarse_grid(const struct ray_field_config *cfg,
                              const struct ray_field *field, double nm,
                              struct coarse_grid *coarse_grid)
{
    const struct glint_pupil *p = &field->pupil;
    const int side = cfg->draft ? DRAFT_LOOKS : LOOKS;
    const int rows = p->mirrored ? side / 2 + 1 : side + 1;
    double hits[SOME * (GLINT_MAX_EVENTS + 1)][2];
    struct glint_launch from[SOME];
    struct glint_ray ray[SOME];
    enum glint_ray_status status[SOME];
    struct glint_path path;
    double d[3];
    int n = 0;

    init_field_path(cfg, field, nm, &path);
    glint_ray_compute_direction(cfg, field->patch->middle, d);
    coarse_grid->side = side;
    coarse_grid->rows = rows;
    coarse_grid->cell_mm2 =
        (p->x1_mm - p->x0_mm) * (p->y1_mm - p->y0_mm) / (side * (rows - 1));
    for (int at = 0; at < rows * (side + 1); at += n) {
        for (n = 0; n < SOME && at + n < rows * (side + 1); n++) {
            const int i = (at + n) % (side + 1), j = (at + n) / (side + 1);

            from[n] = (struct glint_launch){
                p->x0_mm + i * ((p->x1_mm - p->x0_mm) / side),
                p->y0_mm + (p->y1_mm - p->y0_mm) * j / (rows - 1),
                {d[0], d[1], d[2]}};
        }
        glint_trace_many(&path, n, from, ray, status, hits);
        for (int k = 0; k < n; k++)
            set_coarse_ray(cfg, field, &path, (at + k) % (side + 1),
                           (at + k) / (side + 1), status[k], &ray[k],
                           hits + k * path.n_events, coarse_grid);
    }
}

/* Returns the area, mm^2, of the cell with the corners A, B, C, D on the
 * sensor; A and D are opposite. */
static double compute_cell_area(const struct glint_ray *a,
                                const struct glint_ray *b,
                                const struct glint_ray *c,
                                const struct glint_ray *d)
{
    return 0.5 * fabs((d->sensor_x_mm - a->sensor_x_mm) *
                          (c->sensor_y_mm - b->sensor_y_mm) -
                      (d->sensor_y_mm - a->sensor_y_mm) *
                          (c->sensor_x_mm - b->sensor_x_mm));
}

/* Adds the flux of cell (I, J) to FLUX. Raises two members of MEASURES: the max
 * flux per cell, and the max flux per mm^2 on the sensor. */
static void add_cell_flux(const struct coarse_grid *l, int i, int j,
                          double *flux, struct ray_measures *measures)
{
    const struct glint_ray *a = &l->ray[j][i], *b = a + 1;
    const struct glint_ray *c = &l->ray[j + 1][i], *d = c + 1;
    const int n = l->inside[j][i] + l->inside[j][i + 1] + l->inside[j + 1][i] +
                  l->inside[j + 1][i + 1];
    double energy, area;

    if (n == 0)
        return;
    energy = fmax(l->inside[j][i] ? a->energy : 0,
                  l->inside[j][i + 1] ? b->energy : 0);
    energy = fmax(energy, l->inside[j + 1][i] ? c->energy : 0);
    energy = fmax(energy, l->inside[j + 1][i + 1] ? d->energy : 0);
    *flux += energy * l->cell_mm2 * n / 4;
    measures->cell_flux = fmax(measures->cell_flux, energy * l->cell_mm2);
    if (!(l->traced[j][i] && l->traced[j][i + 1] && l->traced[j + 1][i] &&
          l->traced[j + 1][i + 1])) {
        measures->density = measures->cell_flux = HUGE_VAL;
        return;
    }
    area = compute_cell_area(a, b, c, d);
    measures->density =
        fmax(measures->density, energy * l->cell_mm2 / fmax(area, 1e-12));
}

/* Sums over pairs of neighbouring rays: squared distances between their
 * positions in the stop, stop radii^2, and second differences of both barrel
 * values. */
struct difference_sums {
    int n_steps, n_bends;
    double step2, bend[2];
};

/* Adds the squared distance in the stop between ray (I, J) and its neighbour (I
 * + DI, J + DJ). Adds the second difference of the barrel values at ray (I, J)
 * in the same direction. */
static void add_second_differences(const struct coarse_grid *l, int i, int j,
                                   int di, int dj, double stop_mm,
                                   struct difference_sums *b)
{
    const struct glint_ray *here = &l->ray[j][i], *next;

    if (i + di > l->side || j + dj >= l->rows || !l->inside[j][i] ||
        !l->traced[j + dj][i + di])
        return;
    next = &l->ray[j + dj][i + di];
    b->step2 += ((next->stop_x_mm - here->stop_x_mm) *
                     (next->stop_x_mm - here->stop_x_mm) +
                 (next->stop_y_mm - here->stop_y_mm) *
                     (next->stop_y_mm - here->stop_y_mm)) /
                (stop_mm * stop_mm);
    b->n_steps++;
    if (i < di || j < dj || !l->traced[j - dj][i - di])
        return;
    for (int k = 0; k < 2; k++)
        b->bend[k] += l->barrel[j + dj][i + di][k] - 2 * l->barrel[j][i][k] +
                      l->barrel[j - dj][i - di][k];
    b->n_bends++;
}

/* Sets the sags of MEASURES, which are the interpolation errors of a grid of
 * one cell. A sag is (D + E) / 12, where D and E are the second differences
 * along rows and columns. */
static void compute_barrel_sags(struct ray_measures *measures, double stop_mm,
                                const struct coarse_grid *l)
{
    const double by = l->side;

    measures->sag[0] = measures->sag[1] = measures->sag[2] = 0;
    for (int way = 0; way < 2; way++) {
        struct difference_sums b = {0, 0, 0, {0, 0}};

        for (int j = 0; j < l->rows; j++)
            for (int i = 0; i <= l->side; i++)
                add_second_differences(l, i, j, !way, way, stop_mm, &b);
        for (int k = 0; k < 2 && b.n_bends; k++)
            measures->sag[k] += b.bend[k] / b.n_bends * by * by / 12;
        if (b.n_steps)
            measures->sag[2] += b.step2 / b.n_steps * by * by / 12;
    }
}

/* Returns the area on the sensor, mm^2, of cell (I, J), or 0 if a ray of it is
 * blocked. Sets ROOT to the root of the cell's flux per mm^2. */
static double compute_open_cell(const struct coarse_grid *l, int i, int j,
                                double *root)
{
    const struct glint_ray *a = &l->ray[j][i], *b = a + 1;
    const struct glint_ray *c = &l->ray[j + 1][i], *d = c + 1;
    double area;

    if (!(l->inside[j][i] && l->inside[j][i + 1] && l->inside[j + 1][i] &&
          l->inside[j + 1][i + 1]))
        return 0;
    area = compute_cell_area(a, b, c, d);
    *root = sqrt(0.25 * (a->energy + b->energy + c->energy + d->energy) *
                 l->cell_mm2 / fmax(area, 1e-12));
    return area;
}

/* Sets the root_slope of MEASURES. Cells on which light piles up are small, so
 * they hardly count. */
static void compute_root_slope(struct ray_measures *measures,
                               const struct coarse_grid *l)
{
    double squares = 0, areas = 0;

    for (int way = 0; way < 2; way++)
        for (int j = 0; j + 1 + way < l->rows; j++)
            for (int i = 0; i + !way < l->side; i++) {
                double here = 0, next = 0;
                const double area =
                    fmin(compute_open_cell(l, i, j, &here),
                         compute_open_cell(l, i + !way, j + way, &next));

                if (area > 0) {
                    squares += area * (next - here) * (next - here);
                    areas += area;
                }
            }
    measures->root_slope = areas > 0 ? l->side * sqrt(squares / areas) : 0;
}

/* Adds the light of GRID at one wavelength to the flux and brightness of FIELD.
 * Returns the max energy of a visible ray, at least MOST. */
static double add_grid_light(const struct coarse_grid *grid,
                             struct ray_field *field, double most)
{
    double flux = 0;

    for (int j = 0; j + 1 < grid->rows; j++)
        for (int i = 0; i < grid->side; i++)
            add_cell_flux(grid, i, j, &flux, &field->measures);
    for (int j = 0; j < grid->rows; j++)
        for (int i = 0; i <= grid->side; i++)
            if (grid->inside[j][i])
                most = fmax(most, grid->ray[j][i].energy);
    field->flux = fmax(field->flux, (field->pupil.mirrored ? 2 : 1) * flux);
    return most;
}

/* Returns the distance on the sensor, mm, RMS over the rays, between the same
 * rays of A and B. */
static double compute_grid_distance(const struct coarse_grid *a,
                                    const struct coarse_grid *b)
{
    double squares = 0;
    int n = 0;

    for (int j = 0; j < a->rows; j++)
        for (int i = 0; i <= a->side; i++)
            if (a->traced[j][i] && b->traced[j][i] &&
                (a->inside[j][i] || b->inside[j][i])) {
                const double x =
                    a->ray[j][i].sensor_x_mm - b->ray[j][i].sensor_x_mm;
                const double y =
                    a->ray[j][i].sensor_y_mm - b->ray[j][i].sensor_y_mm;

                squares += x * x + y * y;
                n++;
            }
    return n ? sqrt(squares / n) : HUGE_VAL;
}

/* Measures FIELD: its flux, brightness, interpolation errors (sags), and how
 * far its colours separate on the sensor. */
static void measure_brightness(const struct ray_field_config *cfg,
                               struct ray_field *field)
{
    struct ray_measures *const measures = &field->measures;
    struct coarse_grid look[3];
    double most = field->pupil.energy;

    field->flux = measures->cell_flux = measures->density = 0;
    for (int w = 0; w < 3; w++) {
        trace_coarse_grid(cfg, field, cfg->wave_nm[w], &look[w]);
        most = add_grid_light(&look[w], field, most);
    }
    field->apart_mm = compute_grid_distance(&look[0], &look[2]);
    compute_barrel_sags(measures, cfg->setup->optics.stop_radius_mm, &look[1]);
    compute_root_slope(measures, &look[1]);
    field->energy_unit = 1.5 * most;
    /* In this case all rays of the coarse grid miss the opening of the stop. */
    if (field->flux == 0) {
        field->flux = (cfg->draft ? most : field->pupil.energy) *
                      (field->pupil.x1_mm - field->pupil.x0_mm) *
                      glint_pupil_height(&field->pupil);
        measures->density = measures->cell_flux = HUGE_VAL;
    }
}

/* Finds the part of the pupil of a draft: for the middle of the patch and of
 * the band of wavelengths, from coarse grids, with a margin for the others. */
static bool find_draft_pupil(const struct ray_field_config *cfg,
                             struct ray_field *field, struct glint_path *path)
{
    struct glint_pupil *const p = &field->pupil;
    double d[3], more;

    init_field_path(cfg, field, cfg->wave_nm[1], path);
    glint_ray_compute_direction(cfg, field->patch->middle, d);
    if (!glint_pupil_find_roughly(p, path, d,
                                  cfg->setup->optics.stop_radius_mm))
        return false;
    more = DRAFT_MARGIN * (p->x1_mm - p->x0_mm);
    p->x0_mm -= more;
    p->x1_mm += more;
    more = DRAFT_MARGIN * (p->y1_mm - p->y0_mm);
    p->y0_mm -= p->mirrored ? 0 : more;
    p->y1_mm += more;
    return true;
}

/* Finds the part of the pupil through which visible rays enter, for all
 * directions of the patch and all wavelengths. Returns false if no light
 * passes. */
static bool find_pupil_of_whole_patch(const struct ray_field_config *cfg,
                                      struct ray_field *field,
                                      struct glint_path *path)
{
    const struct ray_patch *patch = field->patch;
    const double stop_mm = cfg->setup->optics.stop_radius_mm;
    bool found = false;
    double at[2], d[3];

    for (int k = 0; k < 7; k++) {
        const double nm = cfg->wave_nm[k == 1 ? 0 : k == 2 ? 2 : 1];

        memcpy(at, patch->middle, sizeof at);
        if (k > 2 && !get_patch_side_middle(cfg, patch, k - 3, at))
            continue;
        init_field_path(cfg, field, nm, path);
        glint_ray_compute_direction(cfg, at, d);
        if (found)
            glint_pupil_extend(&field->pupil, path, d, stop_mm);
        else
            found = glint_pupil_find_towards(&field->pupil, path, d, stop_mm,
                                             HUGE_VAL, NULL);
    }
    return found;
}

void glint_ray_field_measure(const struct ray_field_config *cfg,
                             struct ray_field *field)
{
    const struct ray_patch *patch = field->patch;
    const double stop_mm = cfg->setup->optics.stop_radius_mm;
    struct glint_sampling sampling, more;
    struct glint_path path;
    double at[2], d[3];

    field->is_measured = true;
    field->is_open = cfg->draft ? find_draft_pupil(cfg, field, &path)
                                : find_pupil_of_whole_patch(cfg, field, &path);
    if (!field->is_open)
        return;
    init_field_path(cfg, field, cfg->wave_nm[1], &path);
    glint_ray_compute_direction(cfg, patch->middle, d);
    glint_sampling_trace_grid(&sampling, &path, &field->pupil, d, stop_mm,
                              cfg->draft ? DRAFT_SAMPLING : SAMPLING);
    for (int k = 0; k < 4 && !cfg->draft; k++)
        if (get_patch_side_middle(cfg, patch, k, at)) {
            glint_ray_compute_direction(cfg, at, d);
            glint_sampling_trace_grid(&more, &path, &field->pupil, d, stop_mm,
                                      SAMPLING);
            merge_sampling(&sampling, &more);
        }
    field->n_cuts = 0;
    list_blocking_barrels(field, &sampling);
    if (!cfg->draft) {
        glint_ray_compute_direction(cfg, patch->middle, d);
        list_barrels_of_band_ends(cfg, field, d);
    }
    field->folds = sampling.folds;
    field->measures = (struct ray_measures){.bend_mm = sampling.bend_mm,
                                            .outline_mm = sampling.outline_mm,
                                            .round_mm = sampling.round_mm,
                                            .step = sampling.step,
                                            .n_inside = sampling.n_inside};
    measure_brightness(cfg, field);
    field->is_open = field->energy_unit > 0; /* in drafts, rays of the coarse
                                                grid may miss the stop */
}

void glint_ray_field_choose_grid(const struct ray_field_config *cfg,
                                 struct ray_field *field)
{
    const struct ray_measures *const s = &field->measures;
    const double pixel = cfg->view.sensor_width_mm / cfg->view.width;
    const double curvature = compute_stop_curvature(cfg);
    double n;

    field->n_cells =
        choose_cell_count(cfg, s, field->folds, &field->least_cells);
    n = field->n_cells;
    for (int k = 0; k < 3; k++)
        field->sag[k] = fmin(
            fmax((k == 2 ? curvature : 1) * s->sag[k] / (n * n), 0), MOST_SAG);
    field->peak_mm2 = (field->folds ? 8 : 1) *
                      fmin(s->density, s->cell_flux / (pixel * pixel));
    enlarge_pupil_by_pixel(cfg, &field->pupil);
}

static void set_cell_count(struct ray_field *field, int n)
{
    const double ratio = (double)field->n_cells / n;

    for (int k = 0; k < 3; k++)
        field->sag[k] = fmin(field->sag[k] * ratio * ratio, MOST_SAG);
    field->n_cells = n;
}

void glint_ray_field_coarsen_grid(const struct ray_field_config *cfg,
                                  struct ray_field *field, double by)
{
    const int n = glint_grid_round_up_to_four(
        (int)ceil(fmax(field->least_cells, by * field->n_cells)));

    if (!cfg->uniform && n < field->n_cells)
        set_cell_count(field, n);
}

void glint_ray_field_refine_grid(const struct ray_field_config *cfg,
                                 struct ray_field *field, double n)
{
    const int most = glint_grid_get_max_cells(cfg->max_cells, field->folds);
    const int cells = glint_grid_round_up_to_four(
        (int)ceil(fmin(n, most < GLINT_MAX_CELLS ? most : GLINT_MAX_CELLS)));

    if (!cfg->uniform && cells > field->n_cells)
        set_cell_count(field, cells);
}

/* ------------------------------------------------------------------ samples */

static void add_ray_sample(struct ray_field *f, double nm, double x, double y)
{
    f->sample[f->n_samples++] =
        (struct ray_sample){nm,
                            {f->range.middle[0] + x * f->range.half[0],
                             f->range.middle[1] + y * f->range.half[1]}};
}

void glint_ray_field_choose_samples(struct ray_field *f,
                                    const struct ray_patch *range,
                                    const double *nm, int n)
{
    const int wide = (range->half[0] > 0) + 2 * (range->half[1] > 0);

    f->range = *range;
    f->n_nodes = n < RAY_FIELD_NODES ? n : RAY_FIELD_NODES;
    f->n_samples = 0;
    for (int i = 0; i < f->n_nodes; i++) {
        const double lo = 1 / (nm[0] * nm[0]);
        const double hi = 1 / (nm[n - 1] * nm[n - 1]);

        f->node_nm[i] = n == f->n_nodes
                            ? nm[i]
                            : 1 / sqrt(lo + (hi - lo) * i / (f->n_nodes - 1));
        add_ray_sample(f, f->node_nm[i], 0, 0);
    }
    if (wide == 0)
        return;
    add_ray_sample(f, f->node_nm[f->n_nodes / 2], -1, 0);
    add_ray_sample(f, f->node_nm[f->n_nodes / 2], 1, 0);
    if (wide > 1) {
        add_ray_sample(f, f->node_nm[f->n_nodes / 2], 0, -1);
        add_ray_sample(f, f->node_nm[f->n_nodes / 2], 0, 1);
        add_ray_sample(f, f->node_nm[f->n_nodes / 2], 1, 1);
    }
    for (int k = 0; k < 2 && f->n_nodes > 2; k++) {
        const double end = f->node_nm[k ? f->n_nodes - 1 : 0];

        add_ray_sample(f, end, 1, 0);
        if (wide > 1)
            add_ray_sample(f, end, 0, 1);
    }
}

static int count_traced_rows(const struct ray_field *f)
{
    return f->pupil.mirrored ? f->n_cells / 2 + 1 : f->n_cells + 1;
}

static size_t count_traced_nodes(const struct ray_field *f)
{
    return (size_t)count_traced_rows(f) * (size_t)(f->n_cells + 1);
}

size_t glint_ray_field_compute_bytes(const struct ray_field_config *cfg,
                                     const struct ray_field *field)
{
    (void)cfg;
    return count_traced_nodes(field) * (size_t)field->n_samples *
           (CHANNELS * sizeof(float) + 1);
}

/* -------------------------------------------------------------------- trace */

/* Sets the channels of NODE from RAY. Returns false if a value exceeds the
 * range of a vertex, as a clamped position would be wrong. */
static bool set_node_channels(const struct ray_field_config *cfg,
                              const struct ray_field *field,
                              const struct glint_path *path,
                              const struct glint_ray *ray, double (*hits)[2],
                              float *node)
{
    const double scale = cfg->view.width / cfg->view.sensor_width_mm;
    const double stop_mm = cfg->setup->optics.stop_radius_mm;
    double value[CHANNELS] = {ray->sensor_x_mm * scale,
                              ray->sensor_y_mm * scale,
                              ray->stop_x_mm / stop_mm,
                              ray->stop_y_mm / stop_mm,
                              0,
                              0,
                              ray->energy / field->energy_unit};

    compute_barrel_values(field, path, hits, value + BARREL_0);
    for (int k = 0; k < CHANNELS; k++)
        node[k] = (float)value[k];
    return fabs(value[X]) < 0x1p19 && fabs(value[Y]) < 0x1p19 &&
           fabs(value[STOP_X]) < 0x1p13 && fabs(value[STOP_Y]) < 0x1p13 &&
           value[BARREL_0] < 0x1p13 && value[BARREL_1] < 0x1p13;
}

/* Returns the start of ray I in row J of the grid of FIELD, for light along
 * D. */
static struct glint_launch launch_node_ray(const struct ray_field *field,
                                           const double d[3], int i, int j)
{
    const struct glint_pupil *p = &field->pupil;
    const int n = field->n_cells;
    const double step_mm = (p->x1_mm - p->x0_mm) / n;

    return (struct glint_launch){
        (p->x0_mm + (i - i % 8) * step_mm) + i % 8 * step_mm,
        p->mirrored ? p->y1_mm * (2.0 * j - n) / n
                    : p->y0_mm + (p->y1_mm - p->y0_mm) * j / n,
        {d[0], d[1], d[2]}};
}

/* Traces all rays of the grid of FIELD, for light along D, to NODE. Marks rays
 * in INVALID that do not reach the sensor. */
static void trace_node_grid(const struct ray_field_config *cfg,
                            const struct ray_field *field,
                            const struct glint_path *path, const double d[3],
                            float *node, unsigned char *invalid)
{
    const int row = field->n_cells + 1, all = (int)count_traced_nodes(field);
    double hits[SOME * (GLINT_MAX_EVENTS + 1)][2];
    struct glint_launch from[SOME];
    struct glint_ray ray[SOME];
    enum glint_ray_status status[SOME];
    int n = 0;

    for (int at = 0; at < all; at += n) {
        for (n = 0; n < SOME && at + n < all; n++)
            from[n] = launch_node_ray(field, d, (at + n) % row, (at + n) / row);
        glint_trace_many(path, n, from, ray, status, hits);
        for (int k = 0; k < n; k++) {
            float *const to = node + (size_t)(at + k) * CHANNELS;

            if (status[k] == GLINT_RAY_OK &&
                set_node_channels(cfg, field, path, &ray[k],
                                  hits + k * path->n_events, to))
                continue;
            invalid[at + k] = 1;
            memset(to, 0, CHANNELS * sizeof *to);
        }
    }
}

void glint_ray_field_trace_rays(const struct ray_field_config *cfg,
                                const struct ray_field *field, void *mem)
{
    const size_t nodes = count_traced_nodes(field);
    float *node = mem;
    unsigned char *invalid =
        (unsigned char *)(node + (size_t)field->n_samples * nodes * CHANNELS);
    struct glint_path path;

    memset(invalid, 0, (size_t)field->n_samples * nodes);
    for (int s = 0; s < field->n_samples; s++) {
        double d[3];

        if (s == 0 || field->sample[s].nm != field->sample[s - 1].nm)
            init_field_path(cfg, field, field->sample[s].nm, &path);
        glint_ray_compute_direction(cfg, field->sample[s].at, d);
        trace_node_grid(cfg, field, &path, d,
                        node + (size_t)s * nodes * CHANNELS,
                        invalid + (size_t)s * nodes);
    }
}

/* -------------------------------------------------------------------- place */

/* Returns Lagrange's weight at X of node K of the three nodes AT. */
static double compute_lagrange_weight(double x, const double at[3], int k)
{
    const double a = at[(k + 1) % 3], b = at[(k + 2) % 3];

    return (x - a) * (x - b) / ((at[k] - a) * (at[k] - b));
}

/* Adds, times BY, the weights that interpolate a value at wavelength NM from
 * the values at the traced wavelengths. */
static void add_wavelength_weights(struct ray_place *p, double nm, double by)
{
    const struct ray_field *f = p->field;
    const int n = f->n_nodes;
    double at[3];
    int first = 0;

    for (int i = 0; i < n; i++)
        if (f->node_nm[i] == nm) {
            p->weight[i] += (float)by;
            return;
        }
    if (n < 3) {
        p->weight[0] += (float)by;
        return;
    }
    while (first + 3 < n &&
           fabs(f->node_nm[first] - nm) > fabs(f->node_nm[first + 3] - nm))
        first++;
    for (int k = 0; k < 3; k++)
        at[k] = 1 / (f->node_nm[first + k] * f->node_nm[first + k]);
    for (int k = 0; k < 3; k++)
        p->weight[first + k] +=
            (float)(by * compute_lagrange_weight(1 / (nm * nm), at, k));
}

/* Corrects the weights at both ends of the band of wavelengths. There a
 * direction offset T changes positions by another amount than at the middle
 * wavelength. */
static void add_band_end_weights(struct ray_place *p, const double t[2],
                                 double nm, int first, bool both)
{
    const struct ray_field *f = p->field;
    const int mid = f->n_nodes / 2, last = f->n_nodes - 1;
    const double node[3] = {f->node_nm[0], f->node_nm[mid], f->node_nm[last]};
    double at[3];

    for (int k = 0; k < 3; k++)
        at[k] = 1 / (node[k] * node[k]);
    for (int k = 0; k < 2; k++) {
        const double w = compute_lagrange_weight(1 / (nm * nm), at, 2 * k);

        for (int axis = 0; axis < (both ? 2 : 1); axis++) {
            const float by = (float)(w * t[axis]);

            p->weight[first++] += by;
            p->weight[k ? last : 0] -= by;
            p->weight[f->n_nodes + (axis ? 3 : 1)] -= by;
            p->weight[mid] += by;
        }
    }
}

void glint_ray_place_set_weights(struct ray_place *p, const struct ray_field *f,
                                 const void *mem, const double at[2], double nm,
                                 double phi_deg)
{
    const struct ray_patch *range = &f->range;
    const int mid = f->n_nodes / 2, n = f->n_nodes;
    const bool both = range->half[1] > 0;
    double t[2] = {0, 0}, sum = 0;

    *p = (struct ray_place){.field = f,
                            .mem = mem,
                            .cosine = glint_cos_deg(phi_deg),
                            .sine = glint_sin_deg(phi_deg)};
    for (int k = 0; k < 2; k++)
        if (range->half[k] > 0)
            t[k] = (at[k] - range->middle[k]) / range->half[k];
    add_wavelength_weights(p, nm, 1);
    if (f->n_samples == n)
        return;
    {
        const double cross = both ? t[0] * t[1] : 0;
        const double w[5] = {
            0.5 * t[0] * (t[0] - 1), 0.5 * t[0] * (t[0] + 1) - cross,
            0.5 * t[1] * (t[1] - 1), 0.5 * t[1] * (t[1] + 1) - cross, cross};

        for (int k = 0; k < (both ? 5 : 2); k++) {
            p->weight[n + k] += (float)w[k];
            sum += w[k];
        }
        p->weight[mid] -= (float)sum;
    }
    if (n > 2)
        add_band_end_weights(p, t, nm, n + (both ? 5 : 2), both);
}

/* Sets ROW to row J of the grid, interpolated: the weighted sum over all traced
 * samples. Marks rays in INVALID that do not reach the sensor in a sample that
 * has weight: near total reflection red rays do, and blue ones do not. */
static void interpolate_node_row(const struct ray_place *p, int j, float *row,
                                 unsigned char *invalid)
{
    const struct ray_field *f = p->field;
    const size_t nodes = count_traced_nodes(f), side = (size_t)f->n_cells + 1;
    const float *from = (const float *)p->mem + (size_t)j * side * CHANNELS;
    const unsigned char *from_invalid =
        (const unsigned char *)((const float *)p->mem +
                                (size_t)f->n_samples * nodes * CHANNELS) +
        (size_t)j * side;

    memset(row, 0, side * CHANNELS * sizeof *row);
    memset(invalid, 0, side);
    for (int s = 0; s < f->n_samples; s++) {
        const float w = p->weight[s];
        const bool has_weight = fabsf(w) > LEAST_WEIGHT;

        for (size_t i = 0; has_weight && i < side * CHANNELS; i++)
            row[i] += w * from[i];
        for (size_t i = 0; has_weight && i < side; i++)
            invalid[i] |= from_invalid[i];
        from += nodes * CHANNELS;
        from_invalid += nodes;
    }
}

void glint_ray_place_interpolate_row(const struct ray_field_config *cfg,
                                     const struct ray_place *p, int j,
                                     struct glint_vertex *row)
{
    const struct ray_field *f = p->field;
    const int n = f->n_cells;
    const bool mirror = f->pupil.mirrored && 2 * j > n;
    const int from = mirror ? n - j : j;
    const float c = (float)p->cosine, s = (float)p->sine;
    const float half_w = 0.5f * (float)cfg->view.width;
    const float half_h = 0.5f * (float)cfg->view.height;
    const float nearer = 65536 * (1 - (float)f->sag[2]);
    unsigned char invalid[MOST_SIDE];
    float value[MOST_SIDE * CHANNELS];

    interpolate_node_row(p, from, value, invalid);
    for (int i = 0; i <= n; i++) {
        const float *v = value + (size_t)i * CHANNELS;
        const float y = mirror ? -v[Y] : v[Y];
        const float stop_y = mirror ? -v[STOP_Y] : v[STOP_Y];
        const float energy = v[ENERGY] < 1 ? v[ENERGY] : 1;

        row[i].energy_q16 = -1;
        if (invalid[i])
            continue;
        row[i].x_q8 = (int32_t)lrintf(256 * (half_w + (v[X] * c - y * s)));
        row[i].y_q8 = (int32_t)lrintf(256 * (half_h - (v[X] * s + y * c)));
        row[i].stop_x_q16 =
            (int32_t)lrintf(nearer * (v[STOP_X] * c - stop_y * s));
        row[i].stop_y_q16 =
            (int32_t)lrintf(nearer * (v[STOP_X] * s + stop_y * c));
        row[i].barrel_q16[0] =
            (int32_t)lrintf(65536 * (v[BARREL_0] - (float)f->sag[0]));
        row[i].barrel_q16[1] =
            (int32_t)lrintf(65536 * (v[BARREL_1] - (float)f->sag[1]));
        row[i].energy_q16 = (int32_t)lrintf(65536 * (energy > 0 ? energy : 0));
    }
}
