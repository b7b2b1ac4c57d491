/* SPDX-License-Identifier: MIT
 *
 * Tests models of lenses without rotational symmetry, which store only a
 * quarter or a half of all light directions. For lights from all sides, and
 * wavelengths that were not fitted, rays must land where exact rays do. Rays
 * computed by rows must equal single rays.
 */
#include "bake/skew/skew_fit.h"
#include "glint/bake.h"
#include "glint/transfer.h"
#include "support/rng.h"
#include "support/test.h"

#define MAX_DEG   12
#define TOLERANCE 1.5
#define PI        3.14159265358979323846

enum { ONE = 1 << 30, BUNDLES = 100, CELLS = 6, NODES = CELLS + 1 };

static struct glint_prescription lens;
static struct glint_lens model;
static struct glint_setup setup;
static unsigned char *data;

/* Bakes a doublet behind two additional surfaces. Its lens table contains, in
 * this order, BEFORE, the first surface, FIRST, the second surface, AFTER. */
static void bake_doublet_with_surfaces(const char *before, const char *first,
                                       const char *after)
{
    static const double rgb_nm[] = {650, 532, 450};
    struct glint_bake_options options;
    struct glint_bake_report report;
    struct glint_error error = {""};
    const char *reason = "";
    char text[900];
    size_t bytes;

    snprintf(text, sizeof text,
             "name skew\nf-number 10\nfilm 36 24\n%s"
             "surface 400 3 12 1.5168 64.17\n%ssurface flat 10 12 air\n%s"
             "stop 5 8\nsurface 61.47 6 12 1.5168 64.17\n"
             "surface -44.64 2.5 12 1.6727 32.2\n"
             "surface -129.94 95.95 12 air coating none\n",
             before, first, after);
    glint_bake_defaults(&options);
    options.max_deg = MAX_DEG;
    options.tolerance = TOLERANCE;
    if (glint_prescription_parse(&lens, text, strlen(text), "t.lens", &error) ||
        glint_setup_init(&setup, &lens, 0, 0, rgb_nm, 3, &error) ||
        glint_bake(&lens, &options, &data, &bytes, &report, &error))
        fail_msg("%s", error.text);
    if (glint_lens_open(&model, data, bytes, &reason))
        fail_msg("%s", reason);
    print_message("%s%s: %u bytes, %u systems\n", before, first,
                  (unsigned)bytes, (unsigned)model.header->n_systems);
    assert_true(report.intruders * 100 <= report.rays);
}

static void free_model(void)
{
    free(data);
    data = NULL;
}

/* A ray bundle of the model, the exact path of the same ghost, and sums of the
 * bundle's errors. */
struct meter {
    struct glint_transfer t;
    struct glint_path path;
    double direction[3];
    int n; /* number of compared rays that pass the lens */
    /* THROUGH: exact rays that pass; LOST: those of them outside the pupil
     * box */
    int through, lost;
    double places2, stops2, energies2;
    /* max distance between a grid vertex and its exact ray, pixels */
    double off;
};

static const struct glint_place place = {.cos_q30 = ONE,
                                         .sin_q30 = 0,
                                         .pixels_per_mm = {53 << 24, -24},
                                         .middle_x_q8 = 960 << 8,
                                         .middle_y_q8 = 540 << 8};

static double convert_output_to_double(const struct meter *m,
                                       const struct glint_outputs *o, int kind)
{
    return ldexp(o->at[kind], m->t.exponent[kind]);
}

/* Returns the distance between vertex V and the position where the exact ray
 * (X, Y) lands, pixels. */
static double compute_landing_distance_px(const struct glint_vertex *v,
                                          double x_mm, double y_mm)
{
    return hypot(v->x_q8 / 256.0 - 960 - 53 * x_mm,
                 540 - v->y_q8 / 256.0 - 53 * y_mm);
}

static bool ray_passes_stop(const struct meter *m, double x_mm, double y_mm,
                            struct glint_ray *ray)
{
    return glint_trace(&m->path, x_mm, y_mm, m->direction, ray, NULL) ==
               GLINT_RAY_OK &&
           ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <=
               setup.optics.stop_radius_mm &&
           hypot(ray->sensor_x_mm, ray->sensor_y_mm) <= 23;
}

/* Traces a grid of rays over the front element. Counts the rays that pass, and
 * those of them outside the pupil box. Without a ray bundle, all count as
 * outside. */
static void count_passing_rays(struct meter *m, bool has_bundle)
{
    const double x = m->t.sign, y = m->t.side ? -m->t.sign : m->t.sign;
    const double unit = ldexp(1, m->t.box_exponent);

    for (int k = 0; k < 49 * 49; k++) {
        const double at[2] = {(k % 49 - 24) / 2., (k / 49 - 24) / 2.};
        struct glint_ray ray;

        if (!ray_passes_stop(m, at[0], at[1], &ray))
            continue;
        m->through++;
        m->lost += !has_bundle ||
                   fabs(x * at[0] / unit - m->t.box[0]) > 1.001 * m->t.box[1] ||
                   fabs(y * at[1] / unit - m->t.box[3]) > 1.001 * m->t.box[2];
    }
}

/* Compares vertex V with the exact ray (I, J) of a grid. X and Y, 1 or -1,
 * mirror the coordinates of the lens to those of the model. */
static void compare_grid_ray(struct meter *m, int i, int j,
                             const struct glint_vertex *v)
{
    const double x = m->t.sign, y = m->t.side ? -m->t.sign : m->t.sign;
    const double u = 2.0 * i / CELLS - 1, w = 2.0 * j / CELLS - 1;
    const double unit = ldexp(1, m->t.box_exponent);
    const double stop = setup.optics.stop_radius_mm;
    struct glint_outputs o;
    struct glint_ray ray;

    if (!ray_passes_stop(m, x * unit * (m->t.box[0] + u * m->t.box[1]),
                         y * unit * (m->t.box[3] + w * m->t.box[2]), &ray))
        return;
    glint_transfer_ray(&m->t, (int32_t)lrint(u * 0x1p30),
                       (int32_t)lrint(w * 0x1p30), &o);
    m->places2 += pow(x * convert_output_to_double(m, &o, GLINT_OUT_SENSOR_X) -
                          ray.sensor_x_mm,
                      2) +
                  pow(y * convert_output_to_double(m, &o, GLINT_OUT_SENSOR_Y) -
                          ray.sensor_y_mm,
                      2);
    m->stops2 += pow(x * convert_output_to_double(m, &o, GLINT_OUT_STOP_X) -
                         ray.stop_x_mm / stop,
                     2) +
                 pow(y * convert_output_to_double(m, &o, GLINT_OUT_STOP_Y) -
                         ray.stop_y_mm / stop,
                     2);
    m->energies2 += pow(
        convert_output_to_double(m, &o, GLINT_OUT_ENERGY) / ray.energy - 1, 2);
    m->off = fmax(
        m->off, compute_landing_distance_px(
                    v, x * convert_output_to_double(m, &o, GLINT_OUT_SENSOR_X),
                    y * convert_output_to_double(m, &o, GLINT_OUT_SENSOR_Y)));
    m->n++;
}

/* Compares ray bundles of random ghosts, directions and wavelengths. */
static void compare_random_bundles(struct meter *m)
{
    static struct glint_vertex vertex[NODES * NODES];
    uint32_t seed = 7;

    /* The comparison does not support pupil parts, which have pupil boxes of
     * their own and are not ghosts of the table. */
    assert_int_equal(model.header->n_parts, 0);
    for (int k = 0; k < BUNDLES; k++) {
        const int ghost = rng_int_below(&seed, (int)model.header->n_ghosts);
        const double theta = MAX_DEG * 0.99 * rng_unit(&seed) * PI / 180;
        const double phi = 2 * PI * rng_unit(&seed);
        const double nm = 420 + 260 * rng_unit(&seed);
        const struct glint_azimuth azimuth = {
            (int32_t)lrint(cos(phi) * 0x1p30),
            (int32_t)lrint(sin(phi) * 0x1p30)};
        struct glint_place at = place;
        bool is_lit;

        m->direction[0] = sin(theta) * cos(phi);
        m->direction[1] = sin(theta) * sin(phi);
        m->direction[2] = cos(theta);
        glint_path_init(&m->path, &lens, &setup.ghost[ghost], nm);
        is_lit = glint_transfer_init_at(
            &m->t, &model, ghost, (int32_t)lrint(sin(theta) * 0x1p30), azimuth,
            (int32_t)lrint(0x1p24 * 1e6 / (nm * nm)));
        count_passing_rays(m, is_lit);
        if (!is_lit)
            continue;
        at.cos_q30 = m->t.sign * ONE;
        glint_transfer_grid(&m->t, &at, CELLS, vertex);
        for (int j = 0; j < NODES; j++)
            for (int i = 0; i < NODES; i++)
                compare_grid_ray(m, i, j, &vertex[j * NODES + i]);
    }
}

static void check_ray_errors(void)
{
    static struct meter m;
    double pixels, radii, share;

    m = (struct meter){.n = 0};
    compare_random_bundles(&m);
    assert_true(m.n > 500);
    print_message("%d of %d exact rays are invalid\n", m.lost, m.through);
    assert_true(m.through > 1000 && 1000 * m.lost < m.through);
    pixels = sqrt(m.places2 / m.n) * 1920 / 36;
    radii = sqrt(m.stops2 / m.n);
    share = sqrt(m.energies2 / m.n);
    print_message("%d rays: %.3f pixels, %.5f radii, %.4f of the energy, rows "
                  "within %.4f\n",
                  m.n, pixels, radii, share, m.off);
    assert_true(pixels < 1);
    assert_true(radii < 0.01);
    assert_true(share < 0.06);
    assert_true(m.off < 0.01);
}

TEST(cylinder_model_matches_exact_rays)
{
    bake_doublet_with_surfaces("", "shape cylinder x\n", "");
    assert_int_equal(model.header->basis,
                     GLINT_BASIS_LENS + GLINT_MIRRORS_X + GLINT_MIRRORS_Y);
    check_ray_errors();
    free_model();
}

TEST(decentred_toric_model_matches_exact_rays)
{
    bake_doublet_with_surfaces("group decentre 0.6 0\n", "shape toric y 300\n",
                               "end\n");
    assert_int_equal(model.header->basis, GLINT_BASIS_LENS + GLINT_MIRRORS_Y);
    check_ray_errors();
    free_model();
}

TEST(tilted_model_matches_exact_rays)
{
    bake_doublet_with_surfaces("group decentre 0 0.4 tilt 2 1\n", "", "end\n");
    assert_int_equal(model.header->basis, GLINT_BASIS_LENS);
    check_ray_errors();
    free_model();
}
