/* SPDX-License-Identifier: MIT
 *
 * Plans and traces bundles of exact rays for the run-time half, in place of a
 * model's. */
#include <math.h>
#include <stdlib.h>

#include "engine/setup/degrees.h"
#include "bake/trace/sampling.h"
#include "glint/traced_bundle.h"
#include "lens/grid.h"

/* cells a side of the sampling that decides on barrels and grid */
enum { SAMPLING = 24 };
/* If fewer rays than FEW_INSIDE get through, sampling tells too little to
 * choose the grid, which then gets CELLS_A_RADIUS cells per stop radius. */
enum { FEW_INSIDE = 6, CELLS_A_RADIUS = 4 };

/* Returns whether the ghost's box on the sensor, turned by the light's azimuth,
 * meets the picture. */
static bool in_view(const struct glint_traced_bundle_config *cfg,
                    const struct glint_traced_bundle *traced)
{
    const double *s = traced->pupil.sensor_mm;
    const double half_w = 0.5 * cfg->view.sensor_width_mm;
    const double half_h = half_w * cfg->view.height / cfg->view.width;
    const double c = glint_cos_deg(traced->lamp->phi_deg);
    const double d = glint_sin_deg(traced->lamp->phi_deg);
    const double x = 0.5 * (s[0] + s[1]);
    const double w = 0.5 * (s[1] - s[0]), h = fmax(-s[2], s[3]);

    return fabs(x * c) - fabs(c) * w - fabs(d) * h < half_w &&
           fabs(x * d) - fabs(d) * w - fabs(c) * h < half_h;
}

/* Grows the pupil by a pixel on each side: a pixel whose centre lies just
 * outside of the ghost still gets the light on its inner half. */
static void add_rim(const struct glint_traced_bundle_config *cfg,
                    struct glint_traced_bundle *traced)
{
    struct glint_pupil *p = &traced->pupil;
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

/* Returns the cells a side by the rule of lens/grid.h, but not so few that they
 * could step over the stop. If a rim next to total reflection comes through,
 * too, the pupil is the whole front, of which the opening may be a hundredth.
 */
static int cells_of(const struct glint_traced_bundle_config *cfg,
                    const struct glint_sampling *s)
{
    const double pixels = cfg->view.width / cfg->view.sensor_width_mm;
    const double curvature =
        cfg->setup->n_blades == 0 ? 1 : cfg->setup->iris.roundness;
    const double round = curvature * s->round_mm;
    const double outline = fmax(s->outline_mm, round);
    const double bend = fmax(s->bend_mm, 0.1 * outline);
    const double finer = cfg->max_cells / 64.0;
    const double most = glint_grid_most(cfg->max_cells, s->folds);
    const double n = fmin(most, finer * sqrt(bend * pixels / (8 * 0.01)));
    const double least =
        s->n_inside < FEW_INSIDE
            ? fmin(4 * cfg->max_cells, CELLS_A_RADIUS * s->step)
            : GLINT_LEAST_CELLS;

    if (cfg->uniform)
        return cfg->max_cells;
    return glint_grid_fours((int)ceil(
        fmin(GLINT_MAX_CELLS, fmax(fmax(GLINT_LEAST_CELLS, least), n))));
}

static void light_direction(const struct glint_traced_bundle *traced,
                            double direction[3])
{
    direction[0] = glint_sin_deg(traced->lamp->theta_deg);
    direction[1] = 0;
    direction[2] = glint_cos_deg(traced->lamp->theta_deg);
}

/* Chooses the barrels that cut. The one that makes up most of the outline comes
 * first, as the maximum over the others may have kinks. */
static void choose_cuts(struct glint_traced_bundle *traced,
                        struct glint_sampling *sampling)
{
    for (traced->n_cuts = 0; traced->n_cuts < GLINT_TRACED_CUTS;
         traced->n_cuts++) {
        int most = 0;

        for (int k = 1; k < sampling->n_cuts; k++)
            if (sampling->cut_weight[k] > sampling->cut_weight[most])
                most = k;
        if (sampling->n_cuts == 0 || sampling->cut_weight[most] == 0)
            break;
        sampling->cut_weight[most] = 0;
        traced->cut_event[traced->n_cuts] = sampling->cut_event[most];
    }
}

void glint_traced_bundle_plan(const struct glint_traced_bundle_config *cfg,
                              struct glint_traced_bundle *traced,
                              const struct glint_traced_bundle *near)
{
    const struct glint_setup *s = cfg->setup;
    struct glint_sampling sampling;
    struct glint_path path;
    double direction[3];

    glint_path_init_at(&path, s->lens, &s->ghost[traced->ghost],
                       s->wavelength_nm[traced->wavelength],
                       traced->lamp->phi_deg);
    traced->n_cells = 0;
    traced->found = glint_pupil_find(
        &traced->pupil, &path, traced->lamp->theta_deg,
        s->optics.stop_radius_mm, near && near->found ? &near->pupil : NULL);
    /* room above the largest energy that the search for the pupil saw */
    traced->energy_unit = 1.5 * traced->pupil.energy;
    if (traced->found && in_view(cfg, traced)) {
        light_direction(traced, direction);
        glint_sampling_run(&sampling, &path, &traced->pupil, direction,
                           s->optics.stop_radius_mm, SAMPLING);
        choose_cuts(traced, &sampling);
        traced->n_cells = cells_of(cfg, &sampling);
        add_rim(cfg, traced);
    }
}

/* Sets the colour of the bundle, with a largest channel of 1; returns what that
 * was before. Saturated lamps exceed the range of the format by far. */
static double colour_of(const struct glint_traced_bundle_config *cfg,
                        const struct glint_traced_bundle *traced, double rgb[3])
{
    const double *wave = cfg->setup->rgb[traced->wavelength];
    double largest = 0;

    for (int c = 0; c < 3; c++) {
        rgb[c] = wave[c] * traced->lamp->rgb[c];
        if (cfg->tints)
            rgb[c] *= glint_tint_factor(&cfg->tints[traced->ghost], c);
        largest = fmax(largest, fabs(rgb[c]));
    }
    for (int c = 0; c < 3 && largest > 0; c++)
        rgb[c] /= largest;
    return largest;
}

void glint_traced_bundle_make(const struct glint_traced_bundle_config *cfg,
                              const struct glint_traced_bundle *traced,
                              struct glint_bundle *bundle)
{
    const struct glint_setup *s = cfg->setup;
    const struct glint_pupil *p = &traced->pupil;
    const double n = traced->n_cells;
    const double area = (p->x1_mm - p->x0_mm) / n * (glint_pupil_height(p) / n);
    double rgb[3];
    const double flux = colour_of(cfg, traced, rgb) * cfg->scale *
                        traced->lamp->power *
                        glint_cos_deg(traced->lamp->theta_deg) * area *
                        traced->energy_unit / s->unit_flux[traced->wavelength];
    int exponent = 0;
    const double mantissa =
        flux > 0 && isfinite(flux) ? frexp(flux, &exponent) : 0;

    bundle->n_cells = traced->n_cells;
    bundle->flux_q31 = (int32_t)floor(mantissa * 0x1p31);
    bundle->flux_exponent = exponent;
    for (int c = 0; c < 3; c++)
        bundle->rgb_q14[c] = (int32_t)lrint(rgb[c] * 16384);
}

/* Returns (1 + r^2) / 2 at the barrel of event K. */
static double barrel_value(const struct glint_path *path, int k,
                           double (*hits)[2])
{
    const double semi = path->event[k].semi_mm;
    const double x = hits[k][0] / semi, y = hits[k][1] / semi;

    return 0.5 * (1 + x * x + y * y);
}

static void barrel_values(const struct glint_traced_bundle *traced,
                          const struct glint_path *path, double (*hits)[2],
                          double value[2])
{
    value[0] = value[1] = 0;
    for (int k = 0; k < traced->n_cuts; k++) {
        double *into = &value[k > 0];

        *into = fmax(*into, barrel_value(path, traced->cut_event[k], hits));
    }
}

/* The place where a ray lands, as the vertex will hold it. */
struct landing {
    double x, y, stop_x, stop_y, energy, barrel[2];
};

/* Returns whether a vertex can hold the values: geometry never saturates. */
static bool in_range(const struct landing *l)
{
    return fabs(l->x) < 0x1p20 && fabs(l->y) < 0x1p20 &&
           fabs(l->stop_x) < 0x1p14 && fabs(l->stop_y) < 0x1p14 &&
           l->barrel[0] < 0x1p14 && l->barrel[1] < 0x1p14;
}

static void quantise(const struct landing *l, struct glint_vertex *v)
{
    if (!in_range(l))
        return;
    v->x_q8 = (int32_t)lrint(l->x * 256);
    v->y_q8 = (int32_t)lrint(l->y * 256);
    v->stop_x_q16 = (int32_t)lrint(l->stop_x * 65536);
    v->stop_y_q16 = (int32_t)lrint(l->stop_y * 65536);
    for (int k = 0; k < 2; k++)
        v->barrel_q16[k] = (int32_t)lrint(l->barrel[k] * 65536);
    v->energy_q16 = (int32_t)lrint(l->energy * 65536);
}

/* Returns where a ray lands, turned from the light's frame to the picture;
 * MIRROR is -1 for its mirror image on the other side of the light's plane,
 * else 1. */
static struct landing land(const struct glint_traced_bundle_config *cfg,
                           const struct glint_traced_bundle *traced,
                           const struct glint_ray *ray, double mirror)
{
    const double scale = cfg->view.width / cfg->view.sensor_width_mm;
    const double stop = cfg->setup->optics.stop_radius_mm;
    const double c = glint_cos_deg(traced->lamp->phi_deg);
    const double s = glint_sin_deg(traced->lamp->phi_deg);
    const double sensor_y = mirror * ray->sensor_y_mm;
    const double stop_y = mirror * ray->stop_y_mm;

    return (struct landing){.x = 0.5 * cfg->view.width +
                                 scale * (ray->sensor_x_mm * c - sensor_y * s),
                            .y = 0.5 * cfg->view.height -
                                 scale * (ray->sensor_x_mm * s + sensor_y * c),
                            .stop_x = (ray->stop_x_mm * c - stop_y * s) / stop,
                            .stop_y = (ray->stop_x_mm * s + stop_y * c) / stop,
                            .energy =
                                fmin(1, ray->energy / traced->energy_unit)};
}

static void trace_row(const struct glint_traced_bundle_config *cfg,
                      const struct glint_traced_bundle *traced,
                      const struct glint_path *path, int j,
                      struct glint_vertex *row, struct glint_vertex *mirrored)
{
    const struct glint_pupil *p = &traced->pupil;
    const int n = traced->n_cells;
    double direction[3];

    light_direction(traced, direction);
    for (int i = 0; i <= n; i++) {
        double hits[GLINT_MAX_EVENTS + 1][2];
        struct landing here, there;
        struct glint_ray ray;

        row[i].energy_q16 = mirrored[i].energy_q16 = -1;
        if (glint_trace(path, p->x0_mm + (p->x1_mm - p->x0_mm) * i / n,
                        path->round ? p->y1_mm * (2.0 * j - n) / n
                                    : p->y0_mm + (p->y1_mm - p->y0_mm) * j / n,
                        direction, &ray, hits) != GLINT_RAY_OK)
            continue;
        here = land(cfg, traced, &ray, 1);
        barrel_values(traced, path, hits, here.barrel);
        quantise(&here, &row[i]);
        if (row == mirrored)
            continue;
        there = land(cfg, traced, &ray, -1);
        barrel_values(traced, path, hits, there.barrel);
        quantise(&there, &mirrored[i]);
    }
}

void glint_traced_bundle_trace(const struct glint_traced_bundle_config *cfg,
                               const struct glint_traced_bundle *traced,
                               struct glint_vertex *vertex)
{
    const struct glint_setup *s = cfg->setup;
    const int n = traced->n_cells;
    struct glint_path path;

    glint_path_init_at(&path, s->lens, &s->ghost[traced->ghost],
                       s->wavelength_nm[traced->wavelength],
                       traced->lamp->phi_deg);
    for (int j = 0; j <= (path.round ? n / 2 : n); j++)
        trace_row(cfg, traced, &path, j, vertex + (size_t)j * (size_t)(n + 1),
                  vertex + (size_t)(path.round ? n - j : j) * (size_t)(n + 1));
}
