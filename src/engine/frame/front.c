/* SPDX-License-Identifier: MIT */
#include "engine/frame/front.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/setup/dust.h"
#include "engine/setup/entrance.h"
#include "engine/setup/iris.h"

enum { SIDE = GLINT_FRONT_SIDE, LEAST_CHORDS = 24, MOST_CHORDS = 96 };

/* ---------------------------------------------------------------- the front */

/* Returns the fraction of the front element that the mask covers at (X, Y), in
 * front radii. It is 1 minus the mask's nearest pixel, or 0 without a mask. */
static double read_mask_covered_fraction(const struct glint_front *f, double x,
                                         double y)
{
    const int i = (int)(0.5 * (x + 1) * f->mask_width);
    const int j = (int)(0.5 * (1 - y) * f->mask_height);

    return f->mask ? 1 - f->mask[(ptrdiff_t)j * f->mask_width + i] / 255. : 0;
}

/* Computes the fraction of each cell of DIRT that dirt covers, and the running
 * sums of these fractions along rows. The fraction is 0 outside the front
 * element's rim. */
static void sum_cover_along_rows(struct glint_front_dirt *dirt,
                                 const struct glint_front *f,
                                 const struct glint_dust *dust)
{
    for (int j = 0; j < SIDE; j++) {
        float *row = dirt->along + (ptrdiff_t)j * (SIDE + 1);
        const double y = (2 * j + 1.) / SIDE - 1;
        double sum = 0;

        row[0] = 0;
        for (int i = 0; i < SIDE; i++) {
            const double x = (2 * i + 1.) / SIDE - 1;

            if (x * x + y * y < 1)
                sum += 1 - glint_dust_compute_transmission(dust, x, y) *
                               (1 - read_mask_covered_fraction(f, x, y));
            row[i + 1] = (float)sum;
        }
    }
}

static const struct glint_front_method method;

static const char *check_front_config(const struct glint_front *f)
{
    if (!(f->dust >= 0 && f->dust <= 0.5))
        return "dust must cover 0 to 0.5 of the front element";
    if (f->mask && (f->mask_width < 2 || f->mask_height < 2))
        return "a mask must have at least 2 pixels per side";
    return NULL;
}

enum glint_status glint_front_make(struct glint_front_dirt **dirt,
                                   const struct glint_front *front,
                                   struct glint_error *error)
{
    const char *wrong = check_front_config(front);
    struct glint_dust *dust;
    struct glint_front_dirt *d;

    *dirt = NULL;
    if (wrong) {
        snprintf(error->text, sizeof error->text, "%s", wrong);
        return GLINT_E_ARGUMENT;
    }
    if (!(front->dust > 0) && !front->mask)
        return GLINT_OK;
    dust = malloc(sizeof *dust);
    d = malloc(sizeof *d + sizeof *d->along * SIDE * (SIDE + 1));
    if (dust && d) {
        d->method = &method;
        d->along = (float *)(void *)(d + 1);
        glint_dust_generate_specks(dust, front->dust, front->dust_seed);
        sum_cover_along_rows(d, front, dust);
        *dirt = d;
    } else {
        free(d);
        snprintf(error->text, sizeof error->text, "not enough memory");
    }
    free(dust);
    return *dirt ? GLINT_OK : GLINT_E_MEMORY;
}

void glint_front_free(struct glint_front_dirt *dirt)
{
    free(dirt);
}

/* ---------------------------------------------------------------- the stop */

/* The opening of the stop, divided into strips of equal height parallel to
 * x. */
struct chords {
    int n;
    double y[MOST_CHORDS], from[MOST_CHORDS], to[MOST_CHORDS]; /* stop radii */
    double all; /* sum of the lengths of all chords, stop radii */
};

/* Divides the stop of SETUP into strips, which are stored as chords. RADIUS is
 * the radius of the stop's image on the front element, in front radii. There is
 * one chord per row of cells of the front element, up to the max number. */
static void divide_stop_into_chords(struct chords *c,
                                    const struct glint_setup *setup,
                                    double radius)
{
    enum { STEPS = 512 };
    struct glint_iris_sides sides;

    glint_iris_compute_sides(&sides, setup);
    c->n = (int)fmin(fmax(radius * SIDE, LEAST_CHORDS), MOST_CHORDS);
    c->all = 0;
    for (int k = 0; k < c->n; k++) {
        int first = STEPS, last = -1;

        c->y[k] = (2 * k + 1.) / c->n - 1;
        for (int i = 0; i < STEPS; i++)
            if (glint_iris_compute_edge_distance(
                    &sides, (2 * i + 1.) / STEPS - 1, c->y[k]) >= 0) {
                first = i < first ? i : first;
                last = i;
            }
        c->from[k] = 2. * first / STEPS - 1;
        c->to[k] = first > last ? c->from[k] : 2. * (last + 1) / STEPS - 1;
        c->all += c->to[k] - c->from[k];
    }
}

/* Returns the integral of the covered fraction along a row of cells, from the
 * left end of ROW to X. X and the result are in cells. */
static double integrate_cover_along_row(const float *row, double x)
{
    const double at = fmin(fmax(x, 0), SIDE);
    const int i = (int)fmin(at, SIDE - 1);

    return (double)row[i] + (at - i) * (double)(row[i + 1] - row[i]);
}

/* Returns the integral of the covered fraction of row J along chord K, in
 * cells. The centre of the stop is at MIDDLE, in cells; SCALE is the number of
 * cells per stop radius. */
static double integrate_cover_along_chord(const struct glint_front_dirt *d,
                                          const struct chords *c, int k,
                                          double scale, double middle, int j)
{
    const float *row = d->along + (ptrdiff_t)j * (SIDE + 1);

    return j < 0 || j >= SIDE
               ? 0
               : integrate_cover_along_row(row, middle + scale * c->to[k]) -
                     integrate_cover_along_row(row,
                                               middle + scale * c->from[k]);
}

/* Returns the mean covered fraction over the beam of a pixel. The beam crosses
 * the front element in the shape of the stop, with the radius RADIUS and the
 * centre (X, Y), in front radii. */
static double compute_mean_stop_cover(const struct glint_front_dirt *d,
                                      const struct chords *c, double radius,
                                      double x, double y)
{
    const double half = 0.5 * SIDE, middle = (x + 1) * half;
    const double scale = radius * half;
    double sum = 0;

    for (int k = 0; k < c->n; k++) {
        const double at = (y + radius * c->y[k] + 1) * half - 0.5;
        const int j = (int)floor(fmin(fmax(at, -2), SIDE));
        const double low =
            integrate_cover_along_chord(d, c, k, scale, middle, j);
        const double high =
            integrate_cover_along_chord(d, c, k, scale, middle, j + 1);

        sum += low + (fmin(fmax(at, -2), SIDE) - j) * (high - low);
    }
    return sum / (c->all * scale);
}

/* --------------------------------------------------------------- the table */

/* A stop smaller than a cell is treated as one cell wide. */
static void set_front_optics(struct glint_front_optics *o,
                             const struct glint_setup *setup,
                             const struct glint_lens *lens,
                             const struct glint_view *view)
{
    const struct glint_entrance e = glint_entrance_find_pupil(setup, lens);
    const double front = fmax(e.front_mm, setup->optics.entrance_radius_mm);

    *o = (struct glint_front_optics){
        .tangent = glint_view_pixel_tangent(view, fabs(setup->optics.focal_mm)),
        .z = e.z_mm / front,
        .radius = fmax(setup->optics.entrance_radius_mm / front, 2. / SIDE),
        .width = view->width,
        .height = view->height,
        .n_blades = setup->n_blades,
        .rotation_deg = setup->blade_rotation_deg,
        .roundness = setup->iris.roundness};
}

/* Returns the coordinate, in front radii, at which the chief ray of a pixel
 * crosses the front element. AT is the pixel's coordinate; there are N pixels
 * along the axis. */
static double map_pixel_to_front(const struct glint_front_optics *o, double at,
                                 int n)
{
    return -o->z * o->tangent * (at - 0.5 * n);
}

/* Returns the distance, in nodes of the table and a power of two, between nodes
 * at which the cover is computed. 16 of these per radius of an out-of-focus
 * disc suffice. */
static int choose_cover_node_distance(const struct glint_front_optics *o)
{
    const double disc =
        o->radius / (fabs(o->z * o->tangent) * GLINT_VEIL_FRONT_PX * 16 + 1e-9);
    int n = 1;

    while (2 * n <= disc && n < 64)
        n *= 2;
    return n;
}

/* Computes the cover at every STEP-th node of the table, and interpolates it at
 * the nodes between them. */
static void compute_cover_at_nodes(double *covered, int n_x, int n_y,
                                   const struct glint_front_dirt *dirt,
                                   const struct glint_front_optics *o,
                                   const struct glint_setup *setup)
{
    const int step = choose_cover_node_distance(o);
    struct chords chords;

    divide_stop_into_chords(&chords, setup, o->radius);
    for (int j = 0; j < n_y; j += step)
        for (int i = 0; i < n_x; i += step)
            covered[j * n_x + i] = compute_mean_stop_cover(
                dirt, &chords, o->radius,
                map_pixel_to_front(o, GLINT_VEIL_FRONT_PX * i, o->width),
                -map_pixel_to_front(o, GLINT_VEIL_FRONT_PX * j, o->height));
    /* The value of the last computed node also applies to the nodes after
     * it. */
    for (int j = 0; j < n_y; j += step)
        for (int i = 0; i < n_x; i++) {
            const int from = i - i % step;
            const int to = from + step < n_x ? from + step : from;
            const double *row = covered + (ptrdiff_t)j * n_x;

            if (i != from)
                covered[j * n_x + i] =
                    row[from] + (row[to] - row[from]) * (i - from) / step;
        }
    for (int j = 0; j < n_y; j++)
        for (int i = 0; i < n_x && j % step; i++) {
            const int from = j - j % step;
            const int to = from + step < n_y ? from + step : from;
            const double low = covered[from * n_x + i];

            covered[j * n_x + i] =
                low + (covered[to * n_x + i] - low) * (j - from) / step;
        }
}

static void encode_cover_at_nodes(struct glint_front_table *t,
                                  const double *covered, uint16_t *part_q16)
{
    const int n = t->front.n_x * t->front.n_y;
    double sum = 0;

    t->most = 1e-9;
    for (int i = 0; i < n; i++) {
        sum += covered[i];
        t->most = fmax(t->most, covered[i]);
    }
    t->mean = sum / n;
    for (int i = 0; i < n; i++)
        part_q16[i] = (uint16_t)lrint(65535 * covered[i] / t->most);
}

static enum glint_status make_front_table(
    struct glint_front_table **table, const struct glint_front_dirt *dirt,
    const struct glint_front_optics *optics, const struct glint_setup *setup)
{
    const int n_x = GLINT_VEIL_FRONT_NODES(optics->width);
    const int n_y = GLINT_VEIL_FRONT_NODES(optics->height);
    const size_t n = (size_t)n_x * (size_t)n_y;
    double *covered = calloc(n, sizeof *covered);
    struct glint_front_table *t;

    *table = t = malloc(sizeof *t + n * sizeof(uint16_t));
    if (!t || !covered) {
        free(t);
        free(covered);
        *table = NULL;
        return GLINT_E_MEMORY;
    }
    t->bytes = sizeof *t + n * sizeof(uint16_t);
    t->front =
        (struct glint_veil_front){glint_veil_add_front_row, n_x, n_y,
                                  (const uint16_t *)(const void *)(t + 1)};
    compute_cover_at_nodes(covered, n_x, n_y, dirt, optics, setup);
    encode_cover_at_nodes(t, covered, (uint16_t *)(void *)(t + 1));
    free(covered);
    return GLINT_OK;
}

static const struct glint_front_method method = {
    set_front_optics, make_front_table, glint_veil_front};

double glint_front_sum_pixel_cover(const struct glint_front_dirt *dirt,
                                   const struct glint_front_optics *o,
                                   const struct glint_setup *setup, double x,
                                   double y, int steps)
{
    struct glint_iris_sides sides;
    double sum = 0;
    int n = 0;

    glint_iris_compute_sides(&sides, setup);
    for (int k = 0; k < steps * steps; k++) {
        const int row = k / steps;
        const double u = (2 * (k % steps) + 1.) / steps - 1;
        const double v = (2 * row + 1.) / steps - 1;
        const double at_x =
            (map_pixel_to_front(o, x, o->width) + o->radius * u + 1) * SIDE / 2;
        const double at_y =
            (-map_pixel_to_front(o, y, o->height) + o->radius * v + 1) * SIDE /
            2;
        const float *row_at;

        if (glint_iris_compute_edge_distance(&sides, u, v) < 0)
            continue;
        n++;
        if (at_x < 0 || at_x >= SIDE || at_y < 0 || at_y >= SIDE)
            continue;
        row_at = dirt->along + (ptrdiff_t)at_y * (SIDE + 1) + (ptrdiff_t)at_x;
        sum += (double)(row_at[1] - row_at[0]);
    }
    return n ? sum / n : 0;
}
