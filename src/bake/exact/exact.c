/* SPDX-License-Identifier: MIT
 *
 * Renders a picture with exactly traced rays, as a reference for measuring the
 * errors of models.
 *
 *   in   every visible piece of every cell (cells.h) as a polygon with a flux
 *   out  linear light per pixel, by the exact area that polygons cover
 *
 * Method: the signed area to the right of each polygon edge is added to a
 * difference buffer; at the end one running sum along each row gives the
 * picture. Work is split into rows of rays and bands of pixels; every pixel
 * receives its contributions in a fixed order, so the result does not depend on
 * the number of threads. */
#include "glint/exact.h"
#include "glint/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/trace/cells.h"

/* height of a band, pixel rows; only the last band may have fewer rows */
enum { BAND = 32 };
/* max number of bundles, which are combinations of a ghost, a lamp and a
 * wavelength; tracing more would take years */
enum { MAX_BUNDLES = 1 << 24 };

/* A bundle of rays: one ghost, lamp and wavelength. */
struct bundle {
    const struct glint_lamp *lamp;
    int ghost, wavelength;
    bool seen;
    /* grid of rays of the bundle; its path and nodes are set when the bundle is
     * drawn */
    struct glint_cells cells;
};

struct picture {
    const struct glint_exact_config *cfg;
    struct bundle *bundle;
    int n_bundles;
    struct glint_cells cells; /* cells of the bundle being drawn */
    struct glint_path *path;
    /* [n + 1][2]: min and max y of each row of grid nodes, pixels */
    double *row_y;
    /* [height][3][width + 2]: differences along each row of pixels */
    double *difference;
    /* [channel]: flux of a triangle (half a cell of the grid) whose rays have
     * energy 1 */
    double weight[3];
};

static double *get_difference_row(const struct picture *p, int y, int channel)
{
    const size_t stride = (size_t)p->cfg->view.width + 2;

    return p->difference + ((size_t)y * 3 + (size_t)channel) * stride;
}

/* ------------------------------------------------------------------ deposit */

/* Adds one polygon edge, clipped to one pixel row, to the differences of that
 * row. AMOUNT is light per area times the signed height of the edge. The edge
 * extends from X0 to X1, pixels, X0 <= X1. Every pixel to the right of X1 gets
 * all of AMOUNT. */
static void add_edge_to_row(double *row, double x0, double x1, double amount)
{
    const int first = (int)x0;
    const int last = (int)ceil(x1) - 1;
    double before = 0;

    if (last <= first) { /* The edge lies within one pixel. */
        const double right = 1 - (0.5 * (x0 + x1) - first);

        row[first] += amount * right;
        row[first + 1] += amount * (1 - right);
        return;
    }
    for (int i = first; i <= last; i++) {
        /* left end of the edge within pixel i */
        const double a = i == first ? x0 : i;
        const double b = i == last ? x1 : i + 1;
        const double slope = amount / (x1 - x0);
        const double come = slope * (a - x0), go = slope * (b - x0);
        /* Each pixel gets the height that the edge has covered left of the
         * pixel, plus the area of the trapezium on the right of the edge within
         * the pixel. */
        const double area = come + (go - come) * (i + 1 - 0.5 * (a + b));

        row[i] += area - before;
        before = area;
        if (i == last)
            row[i + 1] += amount - before;
    }
}

struct band {
    int y0, y1;
    double width;
};

static void add_polygon_edge(const struct picture *p, const struct band *band,
                             const double a[2], const double b[2],
                             const double *light)
{
    const double sign = a[1] < b[1] ? 1 : -1;
    const double *low = sign > 0 ? a : b, *high = sign > 0 ? b : a;
    const double slope = (high[0] - low[0]) / (high[1] - low[1]);
    const int first = (int)low[1];
    double x = low[0];

    if (a[1] == b[1])
        return;
    for (int y = first; y < band->y1 && y < high[1]; y++) {
        const double y0 = fmax(low[1], y), y1 = fmin(high[1], y + 1);
        double next = y1 == high[1] ? high[0] : low[0] + slope * (y1 - low[1]);

        next = fmin(band->width, fmax(0, next));
        for (int c = 0; c < 3; c++)
            if (light[c] != 0)
                add_edge_to_row(get_difference_row(p, y, c), fmin(x, next),
                                fmax(x, next), sign * light[c] * (y1 - y0));
        x = next;
    }
}

/* Clips polygon P[N] to the half plane SIGN * coordinate <= LIMIT, where AXIS
 * selects x (0) or y (1) and SIGN is 1 or -1. Returns the new number of
 * corners. */
static int clip_polygon_to_line(double (*p)[2], int n, int axis, double sign,
                                double limit)
{
    double kept[GLINT_MAX_PIECE + 8][2];
    int m = 0;

    for (int i = 0; i < n; i++) {
        const double *a = p[i], *b = p[i + 1 < n ? i + 1 : 0];
        const double fa = limit - sign * a[axis], fb = limit - sign * b[axis];

        if (fa >= 0) {
            kept[m][0] = a[0];
            kept[m++][1] = a[1];
        }
        if ((fa >= 0) != (fb >= 0)) {
            const double t = fa / (fa - fb);

            kept[m][!axis] = a[!axis] + t * (b[!axis] - a[!axis]);
            kept[m++][axis] = sign * limit;
        }
    }
    memcpy(p, kept, (size_t)m * sizeof *p);
    return m;
}

static double compute_signed_area(double (*p)[2], int n)
{
    double sum = 0;

    for (int i = 0; i < n; i++) {
        const double *a = p[i], *b = p[i + 1 < n ? i + 1 : 0];

        sum += (a[0] - p[0][0]) * (b[1] - p[0][1]) -
               (a[1] - p[0][1]) * (b[0] - p[0][0]);
    }
    return 0.5 * sum;
}

/* Adds FLUX to the pixel at AT. It is for polygons of area 0 in the picture, as
 * at the fold of a caustic. */
static void add_flux_to_pixel(const struct picture *p, const struct band *band,
                              const double at[2], const double *flux)
{
    if (at[0] < 0 || at[0] >= band->width || at[1] < band->y0 ||
        at[1] >= band->y1)
        return;
    for (int c = 0; c < 3; c++) {
        double *row = get_difference_row(p, (int)at[1], c);

        row[(int)at[0]] += flux[c];
        row[(int)at[0] + 1] -= flux[c];
    }
}

static void draw_cell_piece(const struct picture *p, const struct band *band,
                            struct glint_piece *piece)
{
    double polygon[GLINT_MAX_PIECE + 8][2];
    double light[3], area;
    double low[2], high[2];
    int n = piece->n;

    memcpy(polygon, piece->xy, (size_t)n * sizeof *polygon);
    for (int k = 0; k < 2; k++) {
        low[k] = high[k] = polygon[0][k];
        for (int i = 1; i < n; i++) {
            low[k] = fmin(low[k], polygon[i][k]);
            high[k] = fmax(high[k], polygon[i][k]);
        }
    }
    if (high[1] <= band->y0 || low[1] >= band->y1 || high[0] <= 0 ||
        low[0] >= band->width)
        return;
    area = compute_signed_area(polygon, n);
    for (int c = 0; c < 3; c++)
        light[c] = p->weight[c] * piece->share * piece->energy;
    if (fabs(area) < 1e-12) {
        add_flux_to_pixel(p, band, polygon[0], light);
        return;
    }
    /* Each edge of the polygon adds its height to all pixels on its right. The
     * sign of the height is the direction of the edge, up or down. */
    for (int c = 0; c < 3; c++)
        light[c] /= -area;
    if (low[1] < band->y0)
        n = clip_polygon_to_line(polygon, n, 1, -1, -band->y0);
    if (high[1] > band->y1)
        n = clip_polygon_to_line(polygon, n, 1, 1, band->y1);
    if (low[0] < 0)
        n = clip_polygon_to_line(polygon, n, 0, -1, 0);
    if (high[0] > band->width)
        n = clip_polygon_to_line(polygon, n, 0, 1, band->width);
    for (int i = 0; i < n; i++)
        add_polygon_edge(p, band, polygon[i], polygon[i + 1 < n ? i + 1 : 0],
                         light);
}

/* --------------------------------------------------------------------- jobs */

/* Converts the positions of one row of nodes from mm on the sensor to
 * pixels. */
static void convert_row_to_pixels(struct picture *p, int row)
{
    const struct glint_view *view = &p->cfg->view;
    const double scale = view->width / view->sensor_width_mm;
    const int nodes = p->cells.n + 1, stride = p->cells.stride;
    double *node = p->cells.node + (size_t)row * (size_t)(nodes * stride);
    double *range = p->row_y + 2 * row;

    range[0] = HUGE_VAL;
    range[1] = -HUGE_VAL;
    for (int i = 0; i < nodes; i++, node += stride) {
        if (node[NODE_STATE] == 0)
            continue;
        node[NODE_X] = 0.5 * view->width + scale * node[NODE_X];
        node[NODE_Y] = 0.5 * view->height - scale * node[NODE_Y];
        range[0] = fmin(range[0], node[NODE_Y]);
        range[1] = fmax(range[1], node[NODE_Y]);
    }
}

/* Traces row JOB of the rays. For a rotationally symmetric lens it also sets
 * the mirror image of the row. */
static void trace_ray_row(void *ctx, int job, int worker)
{
    struct picture *p = ctx;

    (void)worker;
    glint_cells_trace_row(&p->cells, job);
    convert_row_to_pixels(p, job);
    if (p->path->round && job != p->cells.n - job)
        convert_row_to_pixels(p, p->cells.n - job);
}

static void draw_pixel_band(void *ctx, int job, int worker)
{
    struct picture *p = ctx;
    const int height = p->cfg->view.height, n = p->cells.n;
    const int end = (job + 1) * BAND;
    const struct band band = {job * BAND, end < height ? end : height,
                              p->cfg->view.width};
    struct glint_piece piece;

    (void)worker;
    for (int j = 0; j < n; j++) {
        const double *range = p->row_y + 2 * j;

        if (fmin(range[0], range[2]) >= band.y1 ||
            fmax(range[1], range[3]) <= band.y0)
            continue;
        for (int k = 0; k < 2 * n; k++) {
            if (!glint_cells_overlap_range(&p->cells, k / 2, j, band.y0,
                                           band.y1))
                continue;
            glint_cells_clip_triangle(&p->cells, k / 2, j, k & 1, &piece);
            if (piece.n)
                draw_cell_piece(p, &band, &piece);
        }
    }
}

/* ------------------------------------------------------------------ picture */

static void init_bundle_path(const struct picture *p, const struct bundle *b,
                             struct glint_path *path)
{
    const struct glint_setup *s = p->cfg->setup;

    glint_path_init_at(path, s->lens, &s->ghost[b->ghost],
                       s->wavelength_nm[b->wavelength], b->lamp->phi_deg);
}

static void init_bundle_cells(void *ctx, int job, int worker)
{
    struct picture *p = ctx;
    struct bundle *b = &p->bundle[job];
    struct glint_path path;

    (void)worker;
    init_bundle_path(p, b, &path);
    b->seen =
        glint_cells_init(&b->cells, p->cfg->setup, &path, b->lamp->theta_deg,
                         b->lamp->phi_deg, p->cfg->grid);
}

static enum glint_status list_ray_bundles(struct picture *p)
{
    const struct glint_exact_config *c = p->cfg;
    const int ghosts = c->setup->n_ghosts, waves = c->setup->n_wavelengths;
    const uint64_t n = (uint64_t)c->n_lamps * (uint64_t)(ghosts * waves);
    const size_t most =
        /* The size of the array is limited to half of the address space, for
         * 32-bit addresses. */
        SIZE_MAX / 2 / sizeof *p->bundle;
    const int all = n < MAX_BUNDLES ? (int)n : MAX_BUNDLES;

    if (n <= MAX_BUNDLES && n < most)
        p->bundle = calloc((size_t)n + 1, sizeof *p->bundle);
    if (!p->bundle)
        return GLINT_E_MEMORY;
    for (int k = 0; k < all; k++) {
        const int ghost = k / waves % ghosts;

        if ((c->only_ghost < 0 || c->only_ghost == ghost) &&
            (!c->tints || c->tints[ghost].gain.mantissa > 0))
            p->bundle[p->n_bundles++] =
                (struct bundle){.lamp = &c->lamps[k / waves / ghosts],
                                .ghost = ghost,
                                .wavelength = k % waves};
    }
    glint_workers_run(c->workers, p->n_bundles, init_bundle_cells, p);
    return GLINT_OK;
}

static enum glint_status draw_ray_bundle(struct picture *p,
                                         const struct bundle *b)
{
    const struct glint_exact_config *c = p->cfg;
    const struct glint_setup *s = c->setup;
    double flux;

    init_bundle_path(p, b, p->path);
    p->cells = b->cells;
    p->cells.path = p->path;
    p->cells.node = malloc(glint_cells_compute_bytes(&p->cells));
    if (!p->cells.node)
        return GLINT_E_MEMORY;
    flux = b->lamp->power * p->cells.direction[2] * 0.5 *
           glint_cells_compute_cell_area(&p->cells) /
           s->unit_flux[b->wavelength];
    for (int k = 0; k < 3; k++)
        p->weight[k] =
            flux * s->rgb[b->wavelength][k] * b->lamp->rgb[k] *
            (c->tints ? glint_tint_factor(&c->tints[b->ghost], k) : 1);
    glint_workers_run(c->workers, glint_cells_count_traced_rows(&p->cells),
                      trace_ray_row, p);
    glint_workers_run(c->workers, (c->view.height + BAND - 1) / BAND,
                      draw_pixel_band, p);
    free(p->cells.node);
    return GLINT_OK;
}

static enum glint_status draw_all_bundles(struct picture *p)
{
    const struct glint_exact_config *c = p->cfg;
    enum glint_status status = list_ray_bundles(p);

    for (int k = 0; k < p->n_bundles && status == GLINT_OK; k++) {
        if (p->bundle[k].seen)
            status = draw_ray_bundle(p, &p->bundle[k]);
        if (c->progress)
            c->progress(c->progress_ctx, (k + 1.0) / p->n_bundles);
    }
    free(p->bundle);
    return status;
}

/* Sets RGB to the light of each pixel: the running sum of the differences along
 * its row. */
static void integrate_differences(const struct picture *p, double *rgb)
{
    const int width = p->cfg->view.width;

    for (int y = 0; y < p->cfg->view.height; y++)
        for (int c = 0; c < 3; c++) {
            const double *row = get_difference_row(p, y, c);
            double sum = 0;

            for (int x = 0; x < width; x++) {
                sum += row[x];
                rgb[((size_t)y * (size_t)width + (size_t)x) * 3 + (size_t)c] =
                    sum;
            }
        }
}

enum glint_status glint_exact_render(const struct glint_exact_config *cfg,
                                     double *rgb)
{
    const size_t width = (size_t)cfg->view.width;
    const size_t height = (size_t)cfg->view.height;
    struct picture p = {.cfg = cfg};
    enum glint_status status = GLINT_E_MEMORY;

    p.path = malloc(sizeof *p.path);
    p.row_y = malloc(((size_t)cfg->grid + 1) * 2 * sizeof *p.row_y);
    p.difference = calloc(height * 3 * (width + 2), sizeof *p.difference);
    if (p.path && p.row_y && p.difference)
        status = draw_all_bundles(&p);
    if (status == GLINT_OK)
        integrate_differences(&p, rgb);
    free(p.path);
    free(p.row_y);
    free(p.difference);
    return status;
}
