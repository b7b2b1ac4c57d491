/* SPDX-License-Identifier: MIT
 *
 * Compares exact rays with rays of an independent program, with analytic
 * results, and with rays mirrored in a centred lens.
 */
#include <dirent.h>

#include "support/lens_check.h"

#define GOLDEN    "tests/data/golden"
#define N_GOLDEN  9
#define LINE_D_NM 587.5618

static const double pi = 3.14159265358979323846;

/* ------------------------------------------- rays of an independent program */

struct bundle {
    char lens[64];
    int ghost, n;
    double angle_deg, wavelength_nm;
};

static void parse_golden_file_name(struct bundle *bundle, const char *name)
{
    const char *dot = strstr(name, ".ghost");

    assert_non_null(dot);
    assert_true(dot - name < (ptrdiff_t)sizeof(bundle->lens));
    memset(bundle->lens, 0, sizeof(bundle->lens));
    memcpy(bundle->lens, name, (size_t)(dot - name));
    assert_int_equal(sscanf(dot, ".ghost%d.%lfdeg.%lfnm.n%d.csv",
                            &bundle->ghost, &bundle->angle_deg,
                            &bundle->wavelength_nm, &bundle->n),
                     4);
}

/* Returns the next comma-separated number and moves *AT behind it; NAN if the
 * column is empty. */
static double parse_next_csv_column(const char **at)
{
    char *end;
    double value = (double)NAN;

    if (**at != ',' && **at != '\n')
        value = strtod(*at, &end), *at = end;
    if (**at == ',')
        ++*at;
    return value;
}

/* Largest differences over all files: of positions, mm; of energies,
 * relative. */
static double worst_mm, worst_energy;

static void compare_lengths_mm(double got, double expected, const char *where)
{
    const double difference = fabs(got - expected);

    if (!(difference <= fmax(1e-7, 5e-9 * fabs(expected))))
        fail_msg("%s: %.12g mm, expected %.9g", where, got, expected);
    /* Positions below 100 mm have a resolution of 1e-7 mm or better in the
     * file. */
    if (fabs(expected) < 100.0)
        worst_mm = fmax(worst_mm, difference);
}

static void compare_ray_with_golden(const struct glint_ray *ray,
                                    const char *columns, const char *where)
{
    double energy;

    compare_lengths_mm(ray->stop_x_mm, parse_next_csv_column(&columns), where);
    compare_lengths_mm(ray->stop_y_mm, parse_next_csv_column(&columns), where);
    compare_lengths_mm(ray->sensor_x_mm, parse_next_csv_column(&columns),
                       where);
    compare_lengths_mm(ray->sensor_y_mm, parse_next_csv_column(&columns),
                       where);
    energy = parse_next_csv_column(&columns);
    if (!(fabs(ray->energy - energy) <= 1e-7 * energy))
        fail_msg("%s: energy %.12g, expected %.9g", where, ray->energy, energy);
    worst_energy = fmax(worst_energy, fabs(ray->energy / energy - 1.0));
    compare_lengths_mm(ray->rel_radius, parse_next_csv_column(&columns), where);
}

static int compare_bundle_with_golden(const struct bundle *bundle, FILE *file,
                                      const char *name)
{
    static struct glint_prescription lens;
    static struct glint_ghost ghosts[GLINT_MAX_GHOSTS];
    static struct glint_path path;
    const double angle = bundle->angle_deg * pi / 180.0;
    const double direction[3] = {sin(angle), 0.0, cos(angle)};
    char line[300], where[300];
    int ok = 0;

    load_lens(&lens, bundle->lens);
    assert_true(glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS) >
                bundle->ghost);
    glint_path_init(&path, &lens, &ghosts[bundle->ghost],
                    bundle->wavelength_nm);
    /* skip the header line */
    assert_non_null(fgets(line, sizeof(line), file));
    for (int i = 0; i < bundle->n * bundle->n; i++) {
        const double semi = lens.surface[0].semi_mm;
        const double step = 2.0 * semi / (bundle->n - 1);
        const double px = -semi + step * (i % bundle->n);
        const double py = -semi + step * (i / bundle->n);
        const char *at = line;
        struct glint_ray ray;
        enum glint_ray_status status;

        assert_non_null(fgets(line, sizeof(line), file));
        snprintf(where, sizeof(where), GOLDEN "/%s:%d", name, i + 2);
        compare_lengths_mm(px, parse_next_csv_column(&at), where);
        compare_lengths_mm(py, parse_next_csv_column(&at), where);
        status = glint_trace(&path, px, py, direction, &ray, NULL);
        if ((int)status != (int)parse_next_csv_column(&at))
            fail_msg("%s: status %d", where, (int)status);
        if (status != GLINT_RAY_OK)
            continue;
        compare_ray_with_golden(&ray, at, where);
        ok++;
    }
    return ok;
}

TEST(rays_match_other_program)
{
    DIR *folder = opendir(GOLDEN);
    const struct dirent *entry;
    struct bundle bundle;
    int n_files = 0, n_rays = 0;

    assert_non_null(folder);
    while ((entry = readdir(folder))) {
        char path[300];
        FILE *file;

        if (!strstr(entry->d_name, ".csv"))
            continue;
        parse_golden_file_name(&bundle, entry->d_name);
        snprintf(path, sizeof(path), GOLDEN "/%.250s", entry->d_name);
        file = fopen(path, "r");
        assert_non_null(file);
        n_rays += compare_bundle_with_golden(&bundle, file, entry->d_name);
        fclose(file);
        n_files++;
    }
    closedir(folder);
    print_message("%d files, %d rays: at most %.2g mm and %.2g of the energy "
                  "off\n",
                  n_files, n_rays, worst_mm, worst_energy);
    assert_int_equal(n_files, N_GOLDEN);
}

/* -------------------------------------------------------- events of a path */

/* Returns a lens of N uncoated surfaces, which lead alternately into glass of
 * refractive index 1.5 and into air, with the stop behind them. The parser
 * might reject it. */
static struct glint_prescription make_bare_lens(int n, const double *radius_mm,
                                                double thickness_mm)
{
    struct glint_prescription lens;

    memset(&lens, 0, sizeof(lens));
    lens.f_number = 16.0;
    lens.n_surfaces = n;
    for (int k = 0; k < n; k++)
        lens.surface[k] = (struct glint_surface){.radius_mm = radius_mm[k],
                                                 .thickness_mm = thickness_mm,
                                                 .semi_mm = 10.0,
                                                 .nd = k % 2 ? 1.0 : 1.5};
    lens.stop_after = n;
    lens.stop_thickness_mm = 50.0;
    lens.stop_semi_mm = 10.0;
    return lens;
}

static void expect_event_of_path(const struct glint_event *event,
                                 enum glint_event_kind kind, int surface,
                                 double advance_mm, double n_from, double n_to)
{
    assert_int_equal(event->kind, kind);
    assert_int_equal(event->surface, surface);
    assert_true(event->advance_mm == advance_mm);
    assert_true(event->n_from == n_from);
    assert_true(event->n_to == n_to);
}

/* Checks that the path of a ghost of two surfaces 5 mm apart, with the stop 5
 * mm behind them, has the expected five events (refractions, reflections, stop,
 * sensor). */
TEST(ghost_path_has_five_events)
{
    static const double radii[] = {40.0, -40.0};
    const struct glint_prescription lens = make_bare_lens(2, radii, 5.0);
    const struct glint_ghost ghost = {0, 1};
    struct glint_path path;

    glint_path_init(&path, &lens, &ghost, 550.0);
    assert_int_equal(path.n_events, 5);
    expect_event_of_path(&path.event[0], GLINT_REFRACT, 0, 0.0, 1.0, 1.5);
    expect_event_of_path(&path.event[1], GLINT_REFLECT, 1, 5.0, 1.5, 1.0);
    expect_event_of_path(&path.event[2], GLINT_REFLECT, 0, -5.0, 1.5, 1.0);
    expect_event_of_path(&path.event[3], GLINT_REFRACT, 1, 5.0, 1.5, 1.0);
    expect_event_of_path(&path.event[4], GLINT_STOP, -1, 5.0, 1.0, 1.0);
    assert_true(path.to_sensor_mm == 50.0);
}

TEST(direct_path_begins_at_a_front_stop)
{
    static const double radii[] = {40.0, -40.0};
    static const struct glint_ghost none = {-1, -1};
    struct glint_prescription lens = make_bare_lens(2, radii, 5.0);
    const double up[3] = {0.0, 0.6, 0.8};
    struct glint_path path, same;
    struct glint_ray ray;

    lens.stop_after = 0;
    lens.stop_thickness_mm = 8.0;
    glint_path_init(&path, &lens, NULL, 550.0);
    glint_path_init(&same, &lens, &none, 550.0);
    assert_int_equal(path.n_events, 3);
    assert_int_equal(same.n_events, 3);
    expect_event_of_path(&path.event[0], GLINT_STOP, -1, -8.0, 1.0, 1.0);
    expect_event_of_path(&path.event[1], GLINT_REFRACT, 0, 8.0, 1.0, 1.5);
    assert_true(path.to_sensor_mm == 5.0);
    /* The stop lies 8 mm in front of the vertex plane, so the library extends
     * the ray through (1, 2) backwards with its slope of 3/4. */
    assert_int_equal(glint_trace(&path, 1.0, 2.0, up, &ray, NULL),
                     GLINT_RAY_OK);
    assert_near(ray.stop_x_mm, 1.0, 1e-14);
    assert_near(ray.stop_y_mm, -4.0, 1e-14);
}

TEST(longest_path_fits_the_event_array)
{
    static double radii[GLINT_MAX_SURFACES];
    struct glint_prescription lens =
        make_bare_lens(GLINT_MAX_SURFACES, radii, 1);
    const struct glint_ghost ghost = {0, GLINT_MAX_SURFACES - 1};
    struct glint_path path;

    lens.stop_after = 30;
    glint_path_init(&path, &lens, &ghost, 550.0);
    assert_int_equal(path.n_events, GLINT_MAX_EVENTS + 1);
}

/* ---------------------------------------------------- rays computed by hand */

static enum glint_ray_status
trace_single_ray(const struct glint_prescription *lens, double py_mm,
                 const double direction[3], struct glint_ray *ray)
{
    struct glint_path path;

    glint_path_init(&path, lens, NULL, LINE_D_NM);
    return glint_trace(&path, 0.0, py_mm, direction, ray, NULL);
}

/* A plane-parallel plate, 5 mm thick, of refractive index 1.5: a ray of sine
 * 0.6 has sine 0.4 inside, rises by 5 tan(asin 0.4), and leaves the plate
 * parallel to its entry. */
TEST(plate_displaces_ray)
{
    static const double flat[2] = {0.0, 0.0};
    const struct glint_prescription lens = make_bare_lens(2, flat, 5.0);
    const double up[3] = {0.0, 0.6, 0.8};
    const double inside = 5.0 * 0.4 / sqrt(0.84);
    struct glint_ray ray;

    assert_int_equal(trace_single_ray(&lens, 1.0, up, &ray), GLINT_RAY_OK);
    assert_near(ray.stop_y_mm, 1.0 + inside + 5.0 * 0.75, 1e-14);
    assert_near(ray.sensor_y_mm, 1.0 + inside + 55.0 * 0.75, 1e-13);
    assert_true(ray.sensor_x_mm == 0.0);
    assert_near(ray.rel_radius, (1.0 + inside) / 10.0, 1e-15);
}

/* A surface of radius R = 1e7 mm differs from a plane by its sag, h^2 / 2R =
 * 1.8e-6 mm, and its tilt, h / R = 6e-7, at the height h = 6 mm. So the ray
 * lands lower on the sensor by (n - 1) h / R * ((5 - sag) / n + 55). */
TEST(surface_of_huge_radius_acts_as_a_plane)
{
    static const double huge[2] = {1e7, 0.0};
    const struct glint_prescription lens = make_bare_lens(2, huge, 5.0);
    const double along[3] = {0.0, 0.0, 1.0};
    const double height = 6.0;
    struct glint_ray ray;

    assert_int_equal(trace_single_ray(&lens, height, along, &ray),
                     GLINT_RAY_OK);
    assert_near(ray.sensor_y_mm,
                height - 0.5 * height / 1e7 * ((5.0 - 1.8e-6) / 1.5 + 55.0),
                1e-13);
    assert_int_equal(trace_single_ray(&lens, 0.0, along, &ray), GLINT_RAY_OK);
    assert_true(ray.sensor_y_mm == 0.0);
}

/* A sphere of radius 0.01 mm: a ray to its centre continues straight on;
 * rays 0.01 mm or more from the axis miss it. */
TEST(ray_to_the_centre_of_a_tiny_sphere_goes_straight)
{
    static const double tiny[1] = {0.01};
    const struct glint_prescription lens = make_bare_lens(1, tiny, 5.0);
    const double up[3] = {0.0, 0.6, 0.8}, along[3] = {0.0, 0.0, 1.0};
    struct glint_ray ray;

    assert_int_equal(trace_single_ray(&lens, -0.0075, up, &ray), GLINT_RAY_OK);
    assert_near(ray.stop_y_mm, -0.0075 + 0.75 * 5.0, 1e-12);
    assert_int_equal(trace_single_ray(&lens, 0.00999, along, &ray),
                     GLINT_RAY_OK);
    assert_int_equal(trace_single_ray(&lens, 0.01, along, &ray),
                     GLINT_RAY_MISSED);
    assert_int_equal(trace_single_ray(&lens, 0.02, along, &ray),
                     GLINT_RAY_MISSED);
}

/* The aplanatic points of a sphere: rays that converge to R + n R behind the
 * vertex meet at R + R / n, free of aberrations. With R = 10 and n = 1.5, rays
 * towards 25 meet at 16.667 at any angle. */
TEST(aplanatic_points_are_free_of_aberration)
{
    static const double radius[1] = {10.0};
    struct glint_prescription lens = make_bare_lens(1, radius, 5.0);
    struct glint_ray ray;

    lens.stop_thickness_mm = 35.0 / 3.0;
    for (int i = -20; i <= 20; i++) {
        const double sine = 0.02 * i, cosine = sqrt(1.0 - sine * sine);
        const double in[3] = {0.0, -sine, cosine};

        assert_int_equal(
            trace_single_ray(&lens, 25.0 * sine / cosine, in, &ray),
            GLINT_RAY_OK);
        assert_near(ray.sensor_y_mm, 0.0, 1e-13);
    }
}

/* From glass to air, 45 degrees exceed the critical angle of 41.8. */
TEST(reflects_totally_beyond_the_critical_angle)
{
    static const double curved[2] = {0.0, -10.0};
    const struct glint_prescription lens = make_bare_lens(2, curved, 5.0);
    const double along[3] = {0.0, 0.0, 1.0};
    struct glint_ray ray = {7.0, 7.0, 7.0, 7.0, 7.0, 7.0};

    assert_int_equal(trace_single_ray(&lens, 10.0 * sqrt(0.5), along, &ray),
                     GLINT_RAY_TOTAL_REFLECTION);
    assert_true(ray.stop_x_mm == 7.0 && ray.rel_radius == 7.0);
    /* an angle with a sine of exactly 2/3 is critical; a ray with a slightly
     * smaller sine passes */
    assert_int_equal(trace_single_ray(&lens, 6.66, along, &ray), GLINT_RAY_OK);
}

/* A ghost of a plate: light reflected twice inside it is displaced three times
 * as far as light that crosses it once. Its energy is (1 - R)^2 R^2 with the
 * reflectance R = ((1.5 - 1) / 2.5)^2. */
TEST(plate_ghost_is_displaced_three_times)
{
    static const double flat[2] = {0.0, 0.0};
    static const struct glint_ghost ghost = {0, 1};
    const struct glint_prescription lens = make_bare_lens(2, flat, 5.0);
    const double up[3] = {0.0, 0.6, 0.8}, along[3] = {0.0, 0.0, 1.0};
    const double inside = 5.0 * 0.4 / sqrt(0.84);
    struct glint_path path;
    struct glint_ray ray;
    double hits[5][2];

    glint_path_init(&path, &lens, &ghost, 550.0);
    assert_int_equal(glint_trace(&path, 0.0, 0.0, up, &ray, hits),
                     GLINT_RAY_OK);
    assert_near(ray.sensor_y_mm, 3.0 * inside + 55.0 * 0.75, 1e-13);
    assert_near(hits[0][1], 0.0, 0.0);
    assert_near(hits[1][1], inside, 1e-14);
    assert_near(hits[2][1], 2.0 * inside, 1e-14);
    assert_near(hits[3][1], 3.0 * inside, 1e-14);
    assert_near(hits[4][1], ray.stop_y_mm, 0.0);
    assert_int_equal(glint_trace(&path, 0.0, 0.0, along, &ray, NULL),
                     GLINT_RAY_OK);
    assert_near(ray.energy, 0.96 * 0.96 * 0.04 * 0.04, 1e-16);
}

/* Checks that rays that run backwards or sideways, or are not finite, are
 * reported as missed. */
TEST(invalid_rays_are_missed)
{
    static const double flat[2] = {0.0, 0.0};
    const struct glint_prescription lens = make_bare_lens(2, flat, 5.0);
    const double along[3] = {0.0, 0.0, 1.0}, back[3] = {0.0, 0.0, -1.0};
    const double across[3] = {1.0, 0.0, 0.0},
                 none[3] = {(double)NAN, (double)NAN, (double)NAN};
    struct glint_ray ray;

    assert_int_equal(trace_single_ray(&lens, 0.0, back, &ray),
                     GLINT_RAY_MISSED);
    assert_int_equal(trace_single_ray(&lens, 0.0, across, &ray),
                     GLINT_RAY_MISSED);
    assert_int_equal(trace_single_ray(&lens, 0.0, none, &ray),
                     GLINT_RAY_MISSED);
    assert_int_equal(trace_single_ray(&lens, (double)NAN, along, &ray),
                     GLINT_RAY_MISSED);
    assert_int_equal(trace_single_ray(&lens, HUGE_VAL, along, &ray),
                     GLINT_RAY_MISSED);
    assert_int_equal(trace_single_ray(&lens, 1e200, along, &ray),
                     GLINT_RAY_MISSED);
}

/* ---------------------------------------------------------- batches of rays */

/* Checks that N rays traced in a batch, and their intersections with surfaces,
 * are bit-identical to rays traced one by one. Entries of surfaces that a ray
 * does not reach must stay unchanged. */
static void expect_batch_equals_single_rays(const struct glint_path *path,
                                            int n,
                                            const struct glint_launch *from)
{
    enum { MOST = 40 };
    static double all[MOST * (GLINT_MAX_EVENTS + 1)][2];
    static double hits[GLINT_MAX_EVENTS + 1][2];
    struct glint_ray ray[MOST], one;
    enum glint_ray_status status[MOST];

    assert_true(n <= MOST);
    memset(all, 0, sizeof all);
    glint_trace_many(path, n, from, ray, status, all);
    for (int k = 0; k < n; k++) {
        memset(hits, 0, sizeof hits);
        assert_int_equal(glint_trace(path, from[k].x_mm, from[k].y_mm,
                                     from[k].direction, &one, hits),
                         status[k]);
        if (status[k] == GLINT_RAY_OK)
            assert_memory_equal(&one, &ray[k], sizeof one);
        assert_memory_equal(hits, all + k * path->n_events,
                            (size_t)path->n_events * sizeof *hits);
    }
}

TEST(batch_equals_single_rays)
{
    static const char *const names[] = {"heliar-tronnier", "canon-zoom-short"};
    static struct glint_prescription lens;
    static struct glint_ghost ghosts[GLINT_MAX_GHOSTS];
    struct glint_path path;

    for (int l = 0; l < 2; l++) {
        load_lens(&lens, names[l]);
        const int n = glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);

        for (int k = 0; k < 4 * n; k++) {
            const int count = 1 + k % 40;
            struct glint_launch from[40];

            glint_path_init(&path, &lens, &ghosts[k % n], 400 + k % 300);
            path.places_only = k / n % 2;
            for (int i = 0; i < count; i++) {
                const double sine = 0.02 * (i % 30) - 0.1;

                from[i] = (struct glint_launch){
                    1.1 * (i % 9 - 4) + 0.01 * k,
                    1.7 * (i / 9),
                    {sine, 0, i == 7 ? -1 : sqrt(1 - sine * sine)}};
            }
            expect_batch_equals_single_rays(&path, count, from);
        }
    }
}

TEST(row_equals_single_rays)
{
    static struct glint_prescription lens;
    const struct glint_ghost ghost = {1, 4};
    const struct glint_row row = {21, -5, 0.4, 2.5, {0.1, 0, sqrt(0.99)}};
    struct glint_ray ray[21], one;
    enum glint_ray_status status[21];
    struct glint_path path;

    load_lens(&lens, "heliar-tronnier");
    glint_path_init(&path, &lens, &ghost, 532);
    glint_trace_row(&path, &row, ray, status, NULL);
    for (int k = 0; k < 21; k++) {
        assert_int_equal(
            glint_trace(&path, -5 + 0.4 * k, 2.5, row.direction, &one, NULL),
            status[k]);
        if (status[k] == GLINT_RAY_OK)
            assert_memory_equal(&one, &ray[k], sizeof one);
    }
}

/* A row of 5 rays and parts of other rows share a batch. */
TEST(grid_equals_rows)
{
    static struct glint_prescription lens;
    const struct glint_ghost ghost = {1, 4};
    const struct glint_row row = {5, -5, 2, 0, {0.1, 0, sqrt(0.99)}};
    const double y_mm[] = {0, 1.5, 4};
    struct glint_ray ray[15], one[5];
    enum glint_ray_status status[15], of_one[5];
    struct glint_path path;

    load_lens(&lens, "heliar-tronnier");
    glint_path_init(&path, &lens, &ghost, 532);
    glint_trace_grid(&path, &row, 3, y_mm, ray, status, NULL);
    for (int j = 0; j < 3; j++) {
        struct glint_row at = row;

        at.y_mm = y_mm[j];
        glint_trace_row(&path, &at, one, of_one, NULL);
        for (int i = 0; i < 5; i++) {
            assert_int_equal(of_one[i], status[5 * j + i]);
            if (of_one[i] == GLINT_RAY_OK)
                assert_memory_equal(&one[i], &ray[5 * j + i], sizeof *one);
        }
    }
}

/* -------------------------------------------------------------- symmetries */

TEST(axis_goes_straight)
{
    static const char *const names[] = {"heliar-tronnier", "canon-zoom-long",
                                        "itoh-zoom-short"};
    const double along[3] = {0.0, 0.0, 1.0};
    static struct glint_prescription lens;
    static struct glint_ghost ghosts[GLINT_MAX_GHOSTS];
    struct glint_path path;
    struct glint_ray ray;

    for (int l = 0; l < 3; l++) {
        load_lens(&lens, names[l]);
        const int n = glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);

        for (int k = -1; k < n; k++) {
            glint_path_init(&path, &lens, k < 0 ? NULL : &ghosts[k], 532.0);
            assert_int_equal(glint_trace(&path, 0.0, 0.0, along, &ray, NULL),
                             GLINT_RAY_OK);
            assert_true(ray.sensor_x_mm == 0.0 && ray.sensor_y_mm == 0.0);
            assert_true(ray.stop_x_mm == 0.0 && ray.stop_y_mm == 0.0);
            assert_true(ray.rel_radius == 0.0);
            assert_true(ray.energy > 0.0 && ray.energy < 1.0);
        }
    }
}

/* Checks that a ray and its mirror image in the plane y = 0 are
 * bit-identical except for the sign of y. */
static void expect_mirrored_ray_is_identical(const struct glint_path *path,
                                             double px, double py,
                                             const double d[3])
{
    const double flipped[3] = {d[0], -d[1], d[2]};
    struct glint_ray a, b;
    const enum glint_ray_status status = glint_trace(path, px, py, d, &a, NULL);

    assert_int_equal(glint_trace(path, px, -py, flipped, &b, NULL), status);
    if (status != GLINT_RAY_OK)
        return;
    assert_true(a.stop_x_mm == b.stop_x_mm);
    assert_true(a.stop_y_mm == -b.stop_y_mm);
    assert_true(a.sensor_x_mm == b.sensor_x_mm);
    assert_true(a.sensor_y_mm == -b.sensor_y_mm);
    assert_true(a.energy == b.energy);
    assert_true(a.rel_radius == b.rel_radius);
}

/* Checks that a ray rotated by 90 degrees hits the rotated position,
 * bit-identical. */
static void expect_rotated_ray_is_identical(const struct glint_path *path,
                                            double px, double py,
                                            const double d[3])
{
    const double turned[3] = {-d[1], d[0], d[2]};
    struct glint_ray a, b;
    const enum glint_ray_status status = glint_trace(path, px, py, d, &a, NULL);

    assert_int_equal(glint_trace(path, -py, px, turned, &b, NULL), status);
    if (status != GLINT_RAY_OK)
        return;
    assert_true(b.sensor_x_mm == -a.sensor_y_mm);
    assert_true(b.sensor_y_mm == a.sensor_x_mm);
    assert_true(a.energy == b.energy);
    assert_true(a.rel_radius == b.rel_radius);
}

TEST(mirrored_and_rotated_rays_are_bit_identical)
{
    static struct glint_prescription lens;
    static struct glint_ghost ghosts[GLINT_MAX_GHOSTS];
    const double d[3] = {0.36 * 0.28, 0.48 * 0.28, sqrt(1 - 0.36 * 0.0784)};
    struct glint_path path;
    int n;

    load_lens(&lens, "nikon-zoom-short");
    n = glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);
    for (int k = -1; k < n; k++) {
        glint_path_init(&path, &lens, k < 0 ? NULL : &ghosts[k], 450.0);
        for (int i = 0; i < 81; i++) {
            const double px = 3.7 * (i % 9 - 4), py = 3.7 * (i / 9 - 4);

            expect_mirrored_ray_is_identical(&path, px, py, d);
            expect_rotated_ray_is_identical(&path, px, py, d);
        }
    }
}

/* Checks that a distant point at angle T is imaged f tan T from the axis, by a
 * narrow pencil near the axis, with the focal length f = 49.992 mm stated in
 * the table. */
TEST(distant_point_is_imaged_at_f_tan_theta)
{
    static struct glint_prescription lens;
    struct glint_optics optics;
    struct glint_ray ray;
    const double sine = 1e-4;
    const double up[3] = {0.0, sine, sqrt(1.0 - sine * sine)};

    load_lens(&lens, "double-gauss-angenieux");
    glint_optics_of(&lens, &optics);
    for (int i = -4; i <= 4; i++) {
        assert_int_equal(trace_single_ray(&lens, 0.01 * i, up, &ray),
                         GLINT_RAY_OK);
        assert_near(ray.sensor_y_mm, 49.992 * 1e-4, 2e-7);
    }
    /* The chief ray passes through the centre of the stop. */
    assert_int_equal(
        trace_single_ray(&lens, -optics.entrance_z_mm * sine, up, &ray),
        GLINT_RAY_OK);
    assert_near(ray.stop_y_mm, 0.0, 1e-9);
    /* A ray at the rim of the entrance pupil passes the rim of the stop, whose
     * radius is 1.3200 mm in the table, except for aberrations. */
    assert_int_equal(trace_single_ray(&lens, optics.entrance_radius_mm,
                                      (const double[3]){0.0, 0.0, 1.0}, &ray),
                     GLINT_RAY_OK);
    assert_near(ray.stop_y_mm, 1.32, 0.002);
}
