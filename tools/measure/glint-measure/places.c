/* SPDX-License-Identifier: MIT
 *
 * Measures how far lights and ghosts move if a pixel's direction is computed by
 * the lens's real projection instead of the arc tangent of its position
 * (pinhole). Lights are at the corner of the film and half-way to it; a ghost's
 * position is the mean of its rays.
 */
#include <math.h>
#include <stdlib.h>

#include "measure/glint-measure/row.h"

enum {
    RAYS = 24, /* number of rays of a ghost in x and in y */
    TRACED_DEG = 85
};

/* A lens and its projection. */
struct places {
    struct glint_setup setup;
    struct glint_projection projection;
    double miss_deg;
    double field_mm;
};

/* x_mm: mean position of a ghost's rays on the sensor, mm; light: energy of the
 * rays */
struct ghost {
    double x_mm, light;
};

/* Traces GHOST for a light at THETA_DEG and returns its mean position; the
 * member light is 0 if no ray passes. */
static struct ghost find_ghost_position(const struct figure_row *row,
                                        const struct places *r, int ghost,
                                        double theta_deg)
{
    const double stop = r->setup.optics.stop_radius_mm;
    const double theta = theta_deg * GLINT_PI / 180;
    const double d[3] = {sin(theta), 0, cos(theta)};
    struct ghost sum = {0, 0};
    struct glint_pupil p;
    struct glint_path path;
    double cell;

    glint_path_init(&path, &row->table, &r->setup.ghost[ghost], 588);
    if (!glint_pupil_find_within(&p, &path, theta_deg, stop, r->field_mm, NULL))
        return sum;
    cell = (p.x1_mm - p.x0_mm) * (p.y1_mm - p.y0_mm) / (RAYS * RAYS);
    for (int k = 0; k < RAYS * RAYS; k++) {
        const int row_of = k / RAYS;
        const double u = (k % RAYS + 0.5) / RAYS;
        const double v = (row_of + 0.5) / RAYS;
        struct glint_ray ray;

        if (glint_trace(&path, p.x0_mm + u * (p.x1_mm - p.x0_mm),
                        p.y0_mm + v * (p.y1_mm - p.y0_mm), d, &ray,
                        NULL) != GLINT_RAY_OK ||
            ray.rel_radius > 1 || hypot(ray.stop_x_mm, ray.stop_y_mm) > stop ||
            hypot(ray.sensor_x_mm, ray.sensor_y_mm) > r->field_mm)
            continue;
        sum.x_mm += ray.energy * cell * ray.sensor_x_mm;
        sum.light += ray.energy * cell;
    }
    sum.x_mm /= fmax(sum.light, 1e-300);
    return sum;
}

/* Writes the metrics for a light whose image is MM millimetres from the axis.
 * WHERE: prefix of the metrics' names. */
static void write_ghost_position(struct figure_row *row, const struct places *r,
                                 const char *where, double mm)
{
    const double focal = fabs(r->setup.optics.focal_mm);
    const double px = 1920 / row->table.film_width_mm;
    const double by_tan = atan(mm / focal) * (180 / GLINT_PI);
    const double by_lens = glint_projection_deg(&r->projection, mm / focal);
    double moved = 0, light = 0, most = 0;

    json_write(&row->json, "%s_tan: %.4f", where, by_tan);
    if (by_lens > TRACED_DEG)
        return;
    for (int k = 0; k < r->setup.n_ghosts; k++) {
        const struct ghost a = find_ghost_position(row, r, k, by_tan);
        const struct ghost b = find_ghost_position(row, r, k, by_lens);
        const double by = fabs(b.x_mm - a.x_mm) * px;

        if (!(a.light > 0 && b.light > 0))
            continue;
        moved += b.light * by;
        light += b.light;
        most = fmax(most, by);
    }
    json_write(&row->json, "%s_lens: %.4f, %s_light: %.4f", where, by_lens,
               where, px * (focal * tan(by_lens * (GLINT_PI / 180)) - mm));
    if (light > 0)
        json_write(&row->json, "%s_ghosts: %.4f, %s_most: %.4f", where,
                   moved / light, where, most);
}

int row_measure_ghost_positions(struct figure_row *row)
{
    static const double nm[] = {588};
    struct places *const r = calloc(1, sizeof *r);
    struct glint_error error = {""};
    enum glint_status status;
    double corner;

    if (!r)
        return tool_fail(row->tool, GLINT_E_MEMORY, NULL);
    status = glint_setup_init(&r->setup, &row->table, 0, 0, nm, 1, &error);
    /* Only rotationally symmetric lenses have a projection. */
    if (status == GLINT_OK && glint_prescription_is_round(&row->table)) {
        status = glint_projection_of(&r->projection, &row->table, &r->miss_deg,
                                     &error);
        corner =
            0.5 * hypot(row->table.film_width_mm, row->table.film_height_mm);
        r->field_mm = 1.1 * corner;
    } else {
        corner = 0;
    }
    if (status == GLINT_OK && corner > 0) {
        json_write(&row->json,
                   "focal_mm: %.4f, traced_deg: %.1f, miss_deg: %.6f",
                   r->setup.optics.focal_mm,
                   glint_projection_deg(&r->projection, r->projection.reach),
                   r->miss_deg);
        write_ghost_position(row, r, "half", 0.5 * corner);
        write_ghost_position(row, r, "corner", corner);
    }
    free(r);
    return status == GLINT_OK ? EXIT_OK
                              : tool_fail(row->tool, status, error.text);
}
