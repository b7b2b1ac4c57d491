/* SPDX-License-Identifier: MIT */
#include "bake/trace/cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/trace/sampling.h"
#include "engine/setup/degrees.h"
#include "engine/setup/dirt.h"

/* cells per side of the grid of rays that determines which barrels block
 * rays */
enum { SAMPLING = 96 };

static void find_blocking_barrels(struct glint_cells *c)
{
    struct glint_sampling sampling;

    glint_sampling_trace_grid(&sampling, c->path, &c->pupil, c->direction,
                              c->setup->optics.stop_radius_mm, SAMPLING);
    c->n_cuts =
        sampling.n_cuts < GLINT_MAX_CUTS ? sampling.n_cuts : GLINT_MAX_CUTS;
    for (int k = 0; k < c->n_cuts; k++)
        c->cut_event[k] = sampling.cut_event[k];
}

bool glint_cells_init(struct glint_cells *cells,
                      const struct glint_setup *setup,
                      const struct glint_path *path, double theta_deg,
                      double phi_deg, int n)
{
    cells->setup = setup;
    cells->path = path;
    cells->direction[0] = glint_sin_deg(theta_deg);
    cells->direction[1] = 0;
    cells->direction[2] = glint_cos_deg(theta_deg);
    cells->cos_phi = glint_cos_deg(phi_deg);
    cells->sin_phi = glint_sin_deg(phi_deg);
    cells->n = n;
    cells->node = NULL;
    if (!glint_pupil_find(&cells->pupil, path, theta_deg,
                          setup->optics.stop_radius_mm, NULL))
        return false;
    find_blocking_barrels(cells);
    glint_iris_compute_sides(&cells->sides, setup);
    cells->stride = NODE_CUT + 2 * cells->n_cuts;
    return true;
}

size_t glint_cells_compute_bytes(const struct glint_cells *cells)
{
    return (size_t)(cells->n + 1) * (size_t)(cells->n + 1) *
           (size_t)cells->stride * sizeof *cells->node;
}

static double *get_ray_node(const struct glint_cells *c, int i, int j)
{
    return c->node +
           ((size_t)j * (size_t)(c->n + 1) + (size_t)i) * (size_t)c->stride;
}

int glint_cells_count_traced_rows(const struct glint_cells *cells)
{
    return (cells->path->round ? cells->n / 2 : cells->n) + 1;
}

double glint_cells_compute_cell_area(const struct glint_cells *cells)
{
    const struct glint_pupil *p = &cells->pupil;

    return (p->x1_mm - p->x0_mm) / cells->n *
           (glint_pupil_height(p) / cells->n);
}

static double compute_stop_inradius(const struct glint_setup *s)
{
    return s->n_blades ? cos(GLINT_PI / s->n_blades) : 1;
}

/* Sets NODE from RAY and its HITS. MIRROR: 1, or -1 for the ray's mirror image
 * on the other side of the light's plane. */
static void set_ray_node(const struct glint_cells *c,
                         const struct glint_ray *ray, double (*hits)[2],
                         double mirror, double *node)
{
    const double stop_mm = c->setup->optics.stop_radius_mm;
    const double sensor_y = mirror * ray->sensor_y_mm;
    const double stop_y = mirror * ray->stop_y_mm;
    bool clear;

    node[NODE_X] = ray->sensor_x_mm * c->cos_phi - sensor_y * c->sin_phi;
    node[NODE_Y] = ray->sensor_x_mm * c->sin_phi + sensor_y * c->cos_phi;
    node[NODE_STOP_X] =
        (ray->stop_x_mm * c->cos_phi - stop_y * c->sin_phi) / stop_mm;
    node[NODE_STOP_Y] =
        (ray->stop_x_mm * c->sin_phi + stop_y * c->cos_phi) / stop_mm;
    node[NODE_ENERGY] = ray->energy;
    clear = hypot(node[NODE_STOP_X], node[NODE_STOP_Y]) <
            compute_stop_inradius(c->setup);
    for (int k = 0; k < c->n_cuts; k++) {
        const int e = c->cut_event[k];
        const double semi = c->path->event[e].semi_mm;

        node[NODE_CUT + 2 * k] = hits[e][0] / semi;
        node[NODE_CUT + 2 * k + 1] = mirror * hits[e][1] / semi;
        clear &= hypot(hits[e][0], hits[e][1]) < semi;
    }
    node[NODE_STATE] = clear ? 2 : 1;
}

/* Returns the start of ray I of a row at height Y_MM. Positions are computed
 * from that of every eighth ray, as pictures' bytes depend on their last bit.
 */
static struct glint_launch launch_row_ray(const struct glint_cells *c, int i,
                                          double y_mm)
{
    const double x0_mm = c->pupil.x0_mm, *d = c->direction;
    const double step_mm = (c->pupil.x1_mm - x0_mm) / c->n;

    return (struct glint_launch){(x0_mm + (i - i % 8) * step_mm) +
                                     i % 8 * step_mm,
                                 y_mm,
                                 {d[0], d[1], d[2]}};
}

void glint_cells_trace_row(const struct glint_cells *cells, int row)
{
    enum { SOME = 16 };
    const struct glint_pupil *p = &cells->pupil;
    const int n = cells->n;
    const double y_mm = cells->path->round
                            ? p->y1_mm * (2.0 * row - n) / n
                            : p->y0_mm + (p->y1_mm - p->y0_mm) * row / n;
    double hits[SOME * (GLINT_MAX_EVENTS + 1)][2];
    struct glint_launch from[SOME];
    struct glint_ray ray[SOME];
    enum glint_ray_status status[SOME];

    for (int i = 0; i <= n; i++) {
        double *node = get_ray_node(cells, i, row);
        double *mirrored =
            get_ray_node(cells, i, cells->path->round ? n - row : row);
        const int k = i % SOME, left = n + 1 - i;
        double(*h)[2] = hits + k * cells->path->n_events;

        for (int m = 0; k == 0 && m < SOME && m < left; m++)
            from[m] = launch_row_ray(cells, i + m, y_mm);
        if (k == 0)
            glint_trace_many(cells->path, left < SOME ? left : SOME, from, ray,
                             status, hits);
        node[NODE_STATE] = mirrored[NODE_STATE] = 0;
        if (status[k] != GLINT_RAY_OK)
            continue;
        set_ray_node(cells, &ray[k], h, 1, node);
        if (mirrored != node)
            set_ray_node(cells, &ray[k], h, -1, mirrored);
    }
}

/* --------------------------------------------------------------------- clip */

/* A triangle of the grid, and the polygon UV[N] that remains of it after
 * clipping. UV are barycentric coordinates: the weights of the second and the
 * third corner. */
struct shape {
    const double *corner[3];
    int n;
    double uv[GLINT_MAX_PIECE][2];
};

static double interpolate_node_channel(const struct shape *s, int index,
                                       const double uv[2])
{
    const double a = s->corner[0][index];

    return a + (s->corner[1][index] - a) * uv[0] +
           (s->corner[2][index] - a) * uv[1];
}

/* A clip boundary in the plane c of two channels, first and first + 1. The
 * visible side is the half plane normal . c <= limit or, if disc is true, the
 * disc |scale c + middle| <= 1. */
struct cut {
    int first;
    bool disc;
    double normal[2], limit, scale, middle[2];
};

/* Sets AT to the point UV of the triangle, mapped such that the disc of CUT
 * becomes the unit disc. */
static void map_point_to_cut_disc(const struct shape *s, const struct cut *cut,
                                  const double uv[2], double at[2])
{
    for (int k = 0; k < 2; k++)
        at[k] = cut->scale * interpolate_node_channel(s, cut->first + k, uv) +
                cut->middle[k];
}

static double compute_cut_value(const struct shape *s, const struct cut *cut,
                                const double uv[2])
{
    double at[2];

    if (cut->disc) {
        map_point_to_cut_disc(s, cut, uv, at);
        return 1 - (at[0] * at[0] + at[1] * at[1]);
    }
    return cut->limit -
           cut->normal[0] * interpolate_node_channel(s, cut->first, uv) -
           cut->normal[1] * interpolate_node_channel(s, cut->first + 1, uv);
}

/* Returns the fraction of the way from A to B at which the boundary CUT is
 * crossed. FA and FB: compute_cut_value() at A and B, which have different
 * signs. */
static double find_cut_crossing(const struct shape *s, const struct cut *cut,
                                const double a[2], const double b[2], double fa,
                                double fb)
{
    double from[2], to[2], dx, dy, qa, qb, root, t;

    if (!cut->disc)
        return fa / (fa - fb);
    map_point_to_cut_disc(s, cut, a, from);
    map_point_to_cut_disc(s, cut, b, to);
    dx = to[0] - from[0];
    dy = to[1] - from[1];
    qa = dx * dx + dy * dy;
    qb = from[0] * dx + from[1] * dy;
    root = sqrt(fmax(0, qb * qb + qa * fa)); /* fa = 1 - |from|^2 */
    t = fa > 0 ? (root - qb) / qa : (-root - qb) / qa;
    return fmin(1, fmax(0, t));
}

static void clip_polygon_by_cut(struct shape *s, const struct cut *cut)
{
    double kept[GLINT_MAX_PIECE][2];
    double value[GLINT_MAX_PIECE];
    bool outside = false;
    int n = 0;

    for (int i = 0; i < s->n; i++) {
        value[i] = compute_cut_value(s, cut, s->uv[i]);
        outside |= value[i] < 0;
    }
    if (!outside)
        return;
    for (int i = 0; i < s->n && n < GLINT_MAX_PIECE - 2; i++) {
        const int j = i + 1 < s->n ? i + 1 : 0;
        const double *a = s->uv[i], *b = s->uv[j];

        if (value[i] >= 0) {
            kept[n][0] = a[0];
            kept[n++][1] = a[1];
        }
        if ((value[i] >= 0) != (value[j] >= 0)) {
            const double t =
                find_cut_crossing(s, cut, a, b, value[i], value[j]);

            kept[n][0] = a[0] + t * (b[0] - a[0]);
            kept[n++][1] = a[1] + t * (b[1] - a[1]);
        }
    }
    s->n = n;
    for (int i = 0; i < n; i++) {
        s->uv[i][0] = kept[i][0];
        s->uv[i][1] = kept[i][1];
    }
}

static void clip_polygon_by_all_cuts(const struct glint_cells *c,
                                     struct shape *s)
{
    const struct glint_iris_sides *const sides = &c->sides;

    for (int k = 0; k < c->n_cuts && s->n; k++)
        clip_polygon_by_cut(
            s,
            &(struct cut){.first = NODE_CUT + 2 * k, .disc = true, .scale = 1});
    if (sides->n == 0)
        clip_polygon_by_cut(
            s, &(struct cut){.first = NODE_STOP_X, .disc = true, .scale = 1});
    for (int side = 0; side < sides->n && s->n; side++) {
        const double *n = sides->normal[side];

        clip_polygon_by_cut(
            s, &(struct cut){.first = NODE_STOP_X,
                             .disc = sides->arcs,
                             .normal = {n[0], n[1]},
                             .limit = sides->apothem,
                             .scale = sides->round,
                             .middle = {sides->off * n[0], sides->off * n[1]}});
    }
}

static double compute_polygon_area(const double (*p)[2], int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++) {
        const double *a = p[i], *b = p[i + 1 < n ? i + 1 : 0];

        sum += a[0] * b[1] - a[1] * b[0];
    }
    return 0.5 * sum;
}

/* Sets CORNER to the nodes of triangle HALF (0 or 1) of cell (I, J). Returns
 * false if the ray of a corner is invalid. The diagonals of the cells are
 * mirrored about the light's plane, so that a symmetric light gives a symmetric
 * picture. */
static bool get_triangle_corners(const struct glint_cells *c, int i, int j,
                                 int half, const double **corner)
{
    static const int order[2][2][3] = {{{0, 1, 2}, {0, 2, 3}},
                                       {{3, 2, 1}, {3, 1, 0}}};
    const double *q[4] = {get_ray_node(c, i, j), get_ray_node(c, i + 1, j),
                          get_ray_node(c, i + 1, j + 1),
                          get_ray_node(c, i, j + 1)};
    const int *pick = order[2 * j >= c->n][half];

    for (int k = 0; k < 3; k++) {
        corner[k] = q[pick[k]];
        /* NOLINTNEXTLINE: all nodes are set: traced, or mirrored */
        if (corner[k][NODE_STATE] == 0)
            return false;
    }
    return true;
}

/* Sets S to the visible part of triangle HALF of cell (I, J). Returns false if
 * nothing is visible. */
static bool clip_triangle(const struct glint_cells *c, int i, int j, int half,
                          struct shape *s)
{
    s->n = 3;
    memcpy(s->uv, (const double[3][2]){{0, 0}, {1, 0}, {0, 1}},
           3 * sizeof *s->uv);
    if (!get_triangle_corners(c, i, j, half, s->corner))
        return false;
    if (s->corner[0][NODE_STATE] != 2 || s->corner[1][NODE_STATE] != 2 ||
        s->corner[2][NODE_STATE] != 2)
        clip_polygon_by_all_cuts(c, s);
    return s->n >= 3;
}

/* Returns the area of S as a fraction of its triangle. */
static double compute_visible_share(const struct shape *s)
{
    return fabs(2 * compute_polygon_area((const double(*)[2])s->uv, s->n));
}

/* Returns the mean energy over S, including the transmission of the stop. */
static double compute_mean_energy(const struct glint_cells *c,
                                  const struct shape *s)
{
    double middle[2] = {0, 0};

    for (int k = 0; k < s->n; k++) {
        middle[0] += s->uv[k][0] / s->n;
        middle[1] += s->uv[k][1] / s->n;
    }
    return interpolate_node_channel(s, NODE_ENERGY, middle) *
           glint_dirt_compute_transmission(
               c->setup, interpolate_node_channel(s, NODE_STOP_X, middle),
               interpolate_node_channel(s, NODE_STOP_Y, middle));
}

void glint_cells_clip_triangle(const struct glint_cells *cells, int i, int j,
                               int half, struct glint_piece *piece)
{
    struct shape s;

    piece->n = 0;
    if (!clip_triangle(cells, i, j, half, &s))
        return;
    piece->n = s.n;
    for (int k = 0; k < s.n; k++) {
        piece->xy[k][0] = interpolate_node_channel(&s, NODE_X, s.uv[k]);
        piece->xy[k][1] = interpolate_node_channel(&s, NODE_Y, s.uv[k]);
    }
    piece->share = compute_visible_share(&s);
    piece->energy = compute_mean_energy(cells, &s);
}

bool glint_cells_overlap_range(const struct glint_cells *cells, int i, int j,
                               double low, double high)
{
    bool above = true, below = true;

    for (int k = 0; k < 4; k++) {
        const double *node = get_ray_node(cells, i + (k & 1), j + (k >> 1));

        above &= node[NODE_STATE] == 0 || node[NODE_Y] <= low;
        below &= node[NODE_STATE] == 0 || node[NODE_Y] >= high;
    }
    return !above && !below;
}

double glint_direct_compute_flux(const struct glint_setup *setup,
                                 double wavelength_nm, int n)
{
    struct glint_cells cells;
    struct glint_path path;
    struct shape s;
    double sum = 0;

    glint_path_init(&path, setup->lens, NULL, wavelength_nm);
    if (!glint_cells_init(&cells, setup, &path, 0, 0, n))
        return 0;
    cells.node = malloc(glint_cells_compute_bytes(&cells));
    if (!cells.node)
        return -1;
    for (int j = 0; j < glint_cells_count_traced_rows(&cells); j++)
        glint_cells_trace_row(&cells, j);
    for (int k = 0; k < 2 * cells.n * cells.n; k++) {
        /* NOLINTNEXTLINE: n > 0 */
        if (clip_triangle(&cells, k / 2 % cells.n, k / 2 / cells.n, k & 1, &s))
            sum += compute_visible_share(&s) * compute_mean_energy(&cells, &s);
    }
    free(cells.node);
    return sum * 0.5 * glint_cells_compute_cell_area(&cells);
}
