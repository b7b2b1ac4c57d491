/* SPDX-License-Identifier: MIT
 *
 * Measures the error of a model against exact rays. Every ghost is compared at
 * the angles of the accuracy table and every STEP degrees up to the model's max
 * angle, at every wavelength. Rays start on a grid over the bounding box of the
 * rays that pass the stop and all surface rims; only rays that land in the
 * image circle count. A ray that no polynomial of the model covers counts as an
 * error of FAR pixels in percentiles, and is left out of root mean squares.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "measure/glint-measure/row.h"

#define FAR       1e3 /* error of a ray that the model does not cover, pixels */
#define SENSOR_PX 0.25 /* target: 99th percentile of the error, pixels */
#define STOP_RMS  8e-4 /* target: RMS error, stop radii */

enum {
    ACROSS = 40, /* number of grid steps in x */
    /* number of grid steps in y over the half y >= 0; the other half is
     * symmetric */
    DOWN = 20,
    BINS = 400,
    BINS_A_DECADE = 50,
    MOST_ANGLES = 2000,
    MOST_PARTS = 64
};

/* Histogram of errors; bin K begins at 1e-5 * 10^(K / BINS_A_DECADE) */
struct tally {
    double rays, lost;
    /* light of all rays, and of the rays that the model does not cover: energy
     * * mm^2 of pupil */
    double light, light_lost;
    double sensor[BINS], energy[BINS];
    /* sum of squared errors of each output; errors of energy are weighted by
     * the ray's light */
    double sum2[GLINT_OUT_ENERGY + 1];
};

struct task {
    const struct figure_row *row;
    struct glint_optics optics;
    const struct glint_lens *model;
    const struct glint_model_header *header;
    struct glint_ghost ghost[GLINT_MAX_GHOSTS];
    int n_ghosts;
    double angle[MOST_ANGLES];
    int n_angles;
    /* radius of the image circle, mm: half of the image's diagonal, or the
     * radius of the model's field if that is smaller */
    double picture_mm;
};

/* ------------------------------------------------------------------ tallies */

static int find_error_histogram_bin(double error)
{
    const int bin = (int)(BINS_A_DECADE * log10(fmax(error, 1e-5) / 1e-5));

    return bin < BINS ? bin : BINS - 1;
}

static void add_ray_error(struct tally *t, const double error[], double light)
{
    t->rays++;
    t->light += light;
    t->sensor[find_error_histogram_bin(
        hypot(error[GLINT_OUT_SENSOR_X], error[GLINT_OUT_SENSOR_Y]))]++;
    t->energy[find_error_histogram_bin(fabs(error[GLINT_OUT_ENERGY]))]++;
    for (int kind = 0; kind <= GLINT_OUT_ENERGY; kind++)
        t->sum2[kind] +=
            error[kind] * error[kind] * (kind == GLINT_OUT_ENERGY ? light : 1);
}

static void add_uncovered_ray(struct tally *t, double light)
{
    t->rays++;
    t->lost++;
    t->light += light;
    t->light_lost += light;
    t->sensor[find_error_histogram_bin(FAR)]++;
    t->energy[find_error_histogram_bin(1)]++;
}

static void merge_tally(struct tally *t, const struct tally *from,
                        double weight)
{
    t->rays += weight * from->rays;
    t->lost += weight * from->lost;
    t->light += weight * from->light;
    t->light_lost += weight * from->light_lost;
    for (int k = 0; k < BINS; k++) {
        t->sensor[k] += weight * from->sensor[k];
        t->energy[k] += weight * from->energy[k];
    }
    for (int kind = 0; kind <= GLINT_OUT_ENERGY; kind++)
        t->sum2[kind] += weight * from->sum2[kind];
}

/* Returns the 99th percentile of the N errors counted in BIN, rounded up to the
 * end of its bin. */
static double compute_p99(const double bin[BINS], double n)
{
    double above = 0;
    int k = BINS;

    while (k > 0 && above + bin[k - 1] <= 0.01 * n)
        above += bin[--k];
    return n > 0 ? 1e-5 * pow(10, (double)k / BINS_A_DECADE) : 0;
}

static double compute_sensor_p99_px(const struct tally *t)
{
    return compute_p99(t->sensor, t->rays);
}

static double compute_rms(const struct tally *t, int kind)
{
    const double n =
        kind == GLINT_OUT_ENERGY ? t->light - t->light_lost : t->rays - t->lost;

    return n > 0 ? sqrt(t->sum2[kind] / n) : 0;
}

static double compute_stop_rms(const struct tally *t)
{
    return hypot(compute_rms(t, GLINT_OUT_STOP_X),
                 compute_rms(t, GLINT_OUT_STOP_Y));
}

static bool does_tally_miss_target(const struct tally *t)
{
    return compute_sensor_p99_px(t) > SENSOR_PX ||
           compute_stop_rms(t) > STOP_RMS;
}

/* --------------------------------------------------------------------- rays */

/* The polynomial systems of one ghost, one per part of its pupil, at one
 * angle and wavelength. */
struct parts {
    int n;
    struct glint_transfer part[MOST_PARTS];
};

static void find_ghost_parts(const struct task *t, int ghost, double angle_deg,
                             double nm, struct parts *parts)
{
    const int32_t sine_q30 =
        (int32_t)lrint(ldexp(sin(angle_deg * GLINT_PI / 180), 30));
    const int32_t wave_q24 = (int32_t)lrint(ldexp(1e6 / (nm * nm), 24));
    const struct glint_lens *l = t->model;

    parts->n = 0;
    for (int k = ghost; k < (int)t->header->n_ghosts && parts->n < MOST_PARTS;
         k++)
        if (l->ghost[k].i == l->ghost[ghost].i &&
            l->ghost[k].j == l->ghost[ghost].j)
            parts->n += glint_transfer_init(&parts->part[parts->n], l, k,
                                            sine_q30, wave_q24) != 0;
}

/* Sets AT to the outputs of the model for the ray from (X, Y). Returns false if
 * no polynomial covers (X, Y). */
static bool evaluate_model_ray(const struct parts *parts, double x_mm,
                               double y_mm, double at[GLINT_OUT_KINDS])
{
    for (int k = 0; k < parts->n; k++) {
        const struct glint_transfer *p = &parts->part[k];
        const double unit = ldexp(1, p->box_exponent);
        const double u = (x_mm / unit - p->box[0]) / p->box[1];
        const double v = (y_mm / unit - p->box[3]) / p->box[2];
        struct glint_outputs out;

        if (fabs(u) > 1 || v > 1 || v < ldexp(glint_transfer_v(p, 0, 1), -30))
            continue;
        glint_transfer_ray(p, (int32_t)lrint(ldexp(u, 30)),
                           (int32_t)lrint(ldexp(v, 30)), &out);
        for (int kind = 0; kind < GLINT_OUT_KINDS; kind++)
            at[kind] = ldexp(out.at[kind], p->exponent[kind]);
        return true;
    }
    return false;
}

static bool is_ray_visible(const struct task *t, const struct glint_ray *ray)
{
    return ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <= t->optics.stop_radius_mm &&
           hypot(ray->sensor_x_mm, ray->sensor_y_mm) <= t->picture_mm;
}

static void compare_ray_with_model(const struct task *t,
                                   const struct parts *parts, double x_mm,
                                   double y_mm, const struct glint_ray *ray,
                                   double light, struct tally *tally)
{
    const double px = 1920 / t->row->table.film_width_mm;
    const double stop = t->optics.stop_radius_mm;
    double at[GLINT_OUT_KINDS] = {0};

    if (!evaluate_model_ray(parts, x_mm, y_mm, at)) {
        add_uncovered_ray(tally, light);
        return;
    }
    at[GLINT_OUT_SENSOR_X] = px * (at[GLINT_OUT_SENSOR_X] - ray->sensor_x_mm);
    at[GLINT_OUT_SENSOR_Y] = px * (at[GLINT_OUT_SENSOR_Y] - ray->sensor_y_mm);
    at[GLINT_OUT_STOP_X] -= ray->stop_x_mm / stop;
    at[GLINT_OUT_STOP_Y] -= ray->stop_y_mm / stop;
    at[GLINT_OUT_ENERGY] = at[GLINT_OUT_ENERGY] / ray->energy - 1;
    add_ray_error(tally, at, light);
}

static void compare_ray_bundle(const struct task *t, int ghost,
                               double angle_deg, double nm, struct tally *tally)
{
    static struct parts parts;
    const double angle = angle_deg * GLINT_PI / 180;
    struct glint_row row = {.n = ACROSS + 1,
                            .direction = {sin(angle), 0, cos(angle)}};
    struct glint_ray ray[ACROSS + 1];
    enum glint_ray_status status[ACROSS + 1];
    struct glint_pupil box;
    struct glint_path path;
    double cell;

    glint_path_init(&path, &t->row->table, &t->ghost[ghost], nm);
    path.places_only = true;
    if (!glint_pupil_find_within(
            &box, &path, angle_deg, t->optics.stop_radius_mm,
            model_convert_real_to_double(t->header->field_mm), NULL))
        return;
    path.places_only = false;
    find_ghost_parts(t, ghost, angle_deg, nm, &parts);
    row.x0_mm = box.x0_mm;
    row.step_mm = (box.x1_mm - box.x0_mm) / ACROSS;
    cell = row.step_mm * box.y1_mm / DOWN;
    for (int j = 0; j <= DOWN; j++) {
        row.y_mm = box.y1_mm * j / DOWN;
        glint_trace_row(&path, &row, ray, status, NULL);
        for (int i = 0; i <= ACROSS; i++)
            if (status[i] == GLINT_RAY_OK && is_ray_visible(t, &ray[i]))
                compare_ray_with_model(t, &parts, row.x0_mm + i * row.step_mm,
                                       row.y_mm, &ray[i], cell * ray[i].energy,
                                       tally);
    }
}

/* ------------------------------------------------------------------- ghosts */

/* light of all ghosts at one angle: total, and light of rays that the model
 * does not cover */
struct light {
    double all, lost;
};

/* Compares all rays of GHOST with the model. Adds their errors to SUM and their
 * light to LIGHT. Adds to ANGLES[0] the number of angles at which the ghost is
 * visible, and to ANGLES[1] the number at which its error exceeds the
 * target. */
static void compare_ghost_rays(const struct task *t, int ghost,
                               struct tally *sum, int angles[2],
                               struct light *light)
{
    for (int k = 0; k < t->n_angles; k++) {
        struct tally here = {0};

        for (int w = 0; w < t->row->n_nm; w++)
            compare_ray_bundle(t, ghost, t->angle[k], t->row->nm[w], &here);
        merge_tally(sum, &here, 1);
        angles[0] += here.rays > 0;
        angles[1] += does_tally_miss_target(&here);
        light[k].all += here.light;
        light[k].lost += here.light_lost;
    }
}

static void write_rms_metric(struct figure_row *row, const struct tally *t)
{
    json_write(
        &row->json,
        "stop_x_rms: %.6g, stop_y_rms: %.6g, sensor_x_rms: %.6g, "
        "sensor_y_rms: %.6g, energy_rms: %.6g",
        compute_rms(t, GLINT_OUT_STOP_X), compute_rms(t, GLINT_OUT_STOP_Y),
        compute_rms(t, GLINT_OUT_SENSOR_X), compute_rms(t, GLINT_OUT_SENSOR_Y),
        compute_rms(t, GLINT_OUT_ENERGY));
}

static void compare_all_ghosts(struct figure_row *row, const struct task *t)
{
    static struct tally all, equally;
    static struct light light[MOST_ANGLES];
    /* max over angles of the fraction of light that the model does not cover, 0
     * .. 1 */
    double lost = 0;
    int ghosts = 0, missing = 0, angles[2] = {0, 0};

    for (int g = 0; g < t->n_ghosts; g++) {
        struct tally sum = {0};

        compare_ghost_rays(t, g, &sum, angles, light);
        if (sum.rays == 0)
            continue;
        ghosts++;
        missing += does_tally_miss_target(&sum);
        merge_tally(&all, &sum, 1);
        merge_tally(&equally, &sum, 1 / sum.rays);
    }
    for (int k = 0; k < t->n_angles; k++)
        lost = fmax(lost, light[k].lost / fmax(1e-30, light[k].all));
    json_write(&row->json,
               "rays: %.0f, sensor_p99: %.6g, sensor_p99_ghosts: %.6g, "
               "stop_rms: %.6g, stop_rms_ghosts: %.6g, energy_p99: %.6g, "
               "energy_p99_ghosts: %.6g, lost: %.6g, lost_light: %.6g, "
               "ghosts_seen: %d, ghosts_miss: %d, angles_seen: %d, "
               "angles_miss: %d",
               all.rays, compute_sensor_p99_px(&all),
               compute_sensor_p99_px(&equally), compute_stop_rms(&all),
               compute_stop_rms(&equally), compute_p99(all.energy, all.rays),
               compute_p99(equally.energy, equally.rays),
               all.lost / fmax(1, all.rays), lost, ghosts, missing, angles[0],
               angles[1]);
    write_rms_metric(row, &all);
}

/* ------------------------------------------------------------------- angles */

static void add_field_angle(struct task *t, double angle_deg)
{
    const double most =
        asin(fmin(1, ldexp(t->header->sine_hi_q30, -30))) * (180 / GLINT_PI);

    if (angle_deg <= most && t->n_angles < MOST_ANGLES)
        t->angle[t->n_angles++] = angle_deg;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static void set_field_angles(struct task *t, double step_deg)
{
    static const double listed[] = {0, 2.5, 5.3, 7.6, 10, 13.7, 17.3, 20};

    for (int k = 0; k < 8; k++)
        add_field_angle(t, listed[k]);
    for (int k = 1; k < MOST_ANGLES && k * step_deg < 90; k++)
        add_field_angle(t, k * step_deg);
    qsort(t->angle, (size_t)t->n_angles, sizeof *t->angle, compare_doubles);
}

int row_measure_ray_errors(struct figure_row *row)
{
    struct task *const t = calloc(1, sizeof *t);
    const struct glint_model_header *h;

    if (!t)
        return tool_fail(row->tool, GLINT_E_MEMORY, NULL);
    t->row = row;
    t->model = &row->opened.model.lens;
    h = t->header = t->model->header;
    t->n_ghosts = glint_ghost_list(&row->table, t->ghost, GLINT_MAX_GHOSTS);
    if (strcmp(h->name, row->table.name) != 0 ||
        (int)h->n_ghosts < t->n_ghosts) {
        free(t);
        return tool_fail(row->tool, GLINT_E_LENS,
                         "the model is of another lens");
    }
    t->picture_mm =
        fmin(model_convert_real_to_double(h->field_mm),
             0.5 * hypot(row->table.film_width_mm, row->table.film_height_mm));
    glint_optics_of(&row->table, &t->optics);
    set_field_angles(t, row->step_deg);
    compare_all_ghosts(row, t);
    free(t);
    return EXIT_OK;
}
