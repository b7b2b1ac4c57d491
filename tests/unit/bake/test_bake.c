/* SPDX-License-Identifier: MIT
 *
 * Tests complete baked models. Their bytes do not depend on the number of
 * workers, the order of jobs or repetition. They contain every visible ghost,
 * and the errors stated in them are true.
 */
#include "bake/measure_model.h"
#include "bake/fit/zone_rays.h"
#include "bake/fit/quantise.h"
#include "engine/frame/frame_parts.h"
#include "glint/pool.h"
#include "glint/transfer.h"
#include "support/lens_check.h"
#include "support/shuffle.h"

#define TOLERANCE 20
#define MAX_DEG   12

struct baked {
    unsigned char *data;
    size_t bytes;
    struct glint_bake_report report;
    struct glint_lens lens;
};

static struct glint_prescription heliar;
static struct glint_setup setup;
static struct glint_bake_options options;
static struct baked model;
static double field_mm;

static void bake_and_open_model(struct baked *b,
                                const struct glint_prescription *lens,
                                const struct glint_bake_options *o)
{
    struct glint_error error;
    const char *reason = "";

    *b = (struct baked){.data = NULL};
    if (glint_bake(lens, o, &b->data, &b->bytes, &b->report, &error))
        fail_msg("%s", error.text);
    if (glint_lens_open(&b->lens, b->data, b->bytes, &reason))
        fail_msg("%s", reason);
}

TEST_OPEN
{
    load_setup(&setup, &heliar, "heliar-tronnier");
    glint_bake_defaults(&options);
    options.tolerance = TOLERANCE;
    options.max_deg = MAX_DEG;
    bake_and_open_model(&model, &heliar, &options);
    field_mm = glint_real_value(model.lens.header->field_mm);
}

TEST_CLOSE
{
    free(model.data);
}

struct work {
    int sum, most;
};

static bool count_work_up_to_limit(void *ctx, int more)
{
    struct work *const w = ctx;

    return __atomic_add_fetch(&w->sum, more, __ATOMIC_RELAXED) <= w->most;
}

/* Bakes on N workers with a limit of MOST polynomial fits, and checks that the
 * status is WANT. Returns the number of fits done. */
static int bake_with_work_limit(int most, int n, enum glint_status want)
{
    struct glint_bake_options o = options;
    struct work work = {0, most};
    struct glint_bake_report report;
    struct glint_error error;
    unsigned char *data = NULL;
    size_t bytes;

    assert_ok(glint_pool_create(&o.workers, n));
    o.allow = count_work_up_to_limit;
    o.allow_ctx = &work;
    assert_true(glint_bake(&heliar, &o, &data, &bytes, &report, &error) ==
                want);
    assert_true((data != NULL) == (want == GLINT_OK));
    free(data);
    glint_pool_destroy(o.workers);
    return work.sum;
}

/* Checks that the number of polynomial fits of a bake does not depend on the
 * number of workers, and that the bake fails if its limit is one fit too
 * low. */
TEST(work_is_limited)
{
    const int all = bake_with_work_limit(1 << 30, 1, GLINT_OK);

    assert_true(all > 9);
    assert_true(bake_with_work_limit(all, 3, GLINT_OK) == all);
    bake_with_work_limit(all - 1, 3, GLINT_E_UNSUPPORTED);
    bake_with_work_limit(5, 1, GLINT_E_UNSUPPORTED);
}

/* Parses a lens of one element. Its two surfaces are the only pair that
 * reflects a ghost. */
static void parse_singlet(struct glint_prescription *lens)
{
    parse_lens_text(lens, "name singlet\n"
                          "source none\n"
                          "f-number 8\n"
                          "film 36 24\n"
                          "surface 51.68 5 12 1.5168 64.17\n"
                          "surface flat 2 12 air\n"
                          "stop 94 10\n");
}

#define FAST_SINGLET                  \
    "name fast\n"                     \
    "source none\n"                   \
    "f-number 1.8\n"                  \
    "film 36 24\n"                    \
    "surface 28 18 17 1.5168 64.17\n" \
    "surface flat 2 17 air\n"         \
    "stop 46 17\n"

/* Parses and bakes the lens of TEXT; if TEXT is NULL, bakes LENS. */
static void bake_text(struct baked *b, struct glint_prescription *lens,
                      const char *text, double tolerance, double max_deg)
{
    struct glint_bake_options o = options;

    if (text)
        parse_lens_text(lens, text);
    o.tolerance = tolerance;
    o.max_deg = max_deg;
    bake_and_open_model(b, lens, &o);
}

static void parse_doublet(struct glint_prescription *lens)
{
    parse_lens_text(lens, "name doublet\n"
                          "source none\n"
                          "f-number 5.6\n"
                          "film 36 24\n"
                          "surface 61.47 6 13 1.5168 64.17\n"
                          "surface -44.64 2.5 13 1.6727 32.21\n"
                          "surface -129.94 2 13 air\n"
                          "stop 93 10\n");
}

/* ------------------------------------------------------ bytes of the model */

static void check_models_are_identical(const struct glint_prescription *lens,
                                       const struct glint_bake_options *o,
                                       const struct baked *expected,
                                       int workers, uint32_t seed)
{
    struct glint_bake_options shuffled = *o;
    struct shuffle shuffle;
    struct baked b;

    init_shuffled_workers(&shuffle, workers, seed);
    shuffled.workers = workers ? &shuffle.workers : NULL;
    bake_and_open_model(&b, lens, &shuffled);
    assert_int_equal(b.bytes, expected->bytes);
    assert_memory_equal(b.data, expected->data, b.bytes);
    assert_memory_equal(&b.report, &expected->report, sizeof b.report);
    free(b.data);
}

TEST(model_does_not_depend_on_workers)
{
    check_models_are_identical(&heliar, &options, &model, 3, 11);
}

TEST(repeated_bake_is_identical)
{
    static struct glint_prescription lens;
    struct baked b;

    parse_singlet(&lens);
    bake_and_open_model(&b, &lens, &options);
    assert_int_equal(b.lens.header->n_ghosts, 1);
    assert_true(b.lens.header->n_systems >= 1);
    check_models_are_identical(&lens, &options, &b, 0, 5);
    free(b.data);
}

/* ------------------------------------------------------------ model header */

TEST(header_describes_the_lens)
{
    const struct glint_model_header *h = model.lens.header;
    const uint64_t key = glint_bake_key(&heliar, &options);

    assert_string_equal(h->name, "heliar-tronnier");
    assert_near(glint_real_value(h->focal_mm), setup.optics.focal_mm, 1e-6);
    assert_near(glint_real_value(h->stop_radius_mm),
                setup.optics.stop_radius_mm, 1e-8);
    assert_near(glint_real_value(h->front_mm), 14.5, 1e-7);
    assert_near(field_mm, 0.55 * hypot(36, 24), 1e-6);
    assert_near(h->sine_hi_q30 * 0x1p-30, sin(MAX_DEG * 3.14159265358979 / 180),
                1e-9);
    assert_near(1e3 / sqrt(h->wave_lo_q24 * 0x1p-24), 700, 1e-3);
    assert_near(1e3 / sqrt(h->wave_hi_q24 * 0x1p-24), 400, 1e-3);
    assert_int_equal(h->key[0], (uint32_t)key);
    assert_int_equal(h->key[1], (uint32_t)(key >> 32));
    assert_int_equal(h->n_surfaces, 8);
    assert_int_equal(h->n_ghosts, 13);
    for (int k = 0; k < 13; k++) {
        assert_int_equal(model.lens.ghost[k].i, setup.ghost[k].i);
        assert_int_equal(model.lens.ghost[k].j, setup.ghost[k].j);
    }
}

/* Checks that the polynomial of the direct image's flux deviates from the
 * traced flux by at most 5e-5 of it. */
TEST(flux_polynomial_matches_traced_flux)
{
    static const double nm[] = {400, 450, 532, 650, 700};
    const struct glint_model_header *h = model.lens.header;
    static struct glint_setup five;
    struct glint_error error;

    assert_ok(glint_setup_init(&five, &heliar, 0, 0, nm, 5, &error));
    for (int k = 0; k < 5; k++) {
        const double lo = 1 / (700.0 * 700), hi = 1 / (400.0 * 400);
        const double w = (2 / (nm[k] * nm[k]) - lo - hi) / (hi - lo);
        double sum = 0;

        for (int i = 5; i >= 0; i--)
            sum = sum * w + glint_real_value(h->direct_flux[i]);
        assert_near(sum / five.direct_flux[k], 1, 5e-5);
    }
}

/* ---------------------------------------------------------- visible ghosts */

static bool is_ghost_covered_by_model(const struct glint_lens *lens, int ghost,
                                      double theta_deg, double nm)
{
    static struct glint_transfer t;
    const double sine = sin(theta_deg * 3.14159265358979323846 / 180);

    return glint_transfer_init(&t, lens, ghost, (int32_t)lrint(sine * 0x1p30),
                               (int32_t)lrint(0x1p24 * 1e6 / (nm * nm)));
}

/* Checks that the model contains each ghost that the pupil search finds. */
TEST(every_found_ghost_is_in_the_model)
{
    static const double deg[] = {0, 3, 7, 11};
    int seen = 0, lost_in_field = 0;

    for (int g = 0; g < setup.n_ghosts; g++)
        for (int k = 0; k < 4; k++) {
            struct glint_path path;
            struct glint_pupil box;

            glint_path_init(&path, &heliar, &setup.ghost[g], 532);
            if (!glint_pupil_find_within(&box, &path, deg[k],
                                         setup.optics.stop_radius_mm, field_mm,
                                         NULL))
                continue;
            seen++;
            if (!is_ghost_covered_by_model(&model.lens, g, deg[k], 532)) {
                print_error("ghost %d at %g degrees is missing\n", g, deg[k]);
                lost_in_field++;
            }
        }
    assert_in_range(seen, 45, 52);
    assert_int_equal(lost_in_field, 0);
    assert_false(
        is_ghost_covered_by_model(&model.lens, 0, MAX_DEG + 0.01, 532));
}

/* ------------------------------------------------------------- pupil parts */

/* Sets UV to the ray's coordinates in the pupil box of pupil part T. Returns
 * whether the part contains the ray. */
static bool is_ray_in_pupil_part(const struct glint_transfer *t, double x_mm,
                                 double y_mm, double uv[2])
{
    const double unit = ldexp(1, t->box_exponent);

    uv[0] = (x_mm / unit - t->box[0]) / t->box[1];
    uv[1] = y_mm / unit / t->box[2];
    return fabs(uv[0]) <= 1 && fabs(uv[1]) <= 1 &&
           fabs(uv[1]) >= ldexp(glint_transfer_v(t, 0, 1), -30);
}

/* Returns how many of the N parts of a pupil contain the ray that starts at (X,
 * Y), mm. Sets *OFF to the distance on the sensor, mm, between RAY and the
 * position by the last of these parts. */
static int count_pupil_parts_with_ray(const struct glint_transfer *part, int n,
                                      double x_mm, double y_mm,
                                      const struct glint_ray *ray, double *off)
{
    int found = 0;

    for (int k = 0; k < n; k++) {
        struct glint_outputs out;
        double uv[2];

        if (!is_ray_in_pupil_part(&part[k], x_mm, y_mm, uv))
            continue;
        found++;
        glint_transfer_ray(&part[k], (int32_t)lrint(ldexp(uv[0], 30)),
                           (int32_t)lrint(ldexp(uv[1], 30)), &out);
        *off = hypot(ldexp(out.at[GLINT_OUT_SENSOR_X],
                           part[k].exponent[GLINT_OUT_SENSOR_X]) -
                         ray->sensor_x_mm,
                     ldexp(out.at[GLINT_OUT_SENSOR_Y],
                           part[k].exponent[GLINT_OUT_SENSOR_Y]) -
                         ray->sensor_y_mm);
    }
    return found;
}

/* Checks that a frame whose setup has the ghosts of the table, FAST, plans the
 * ray bundles of all pupil regions of model B before it chooses its scale. */
static void check_planned_pupil_regions(const struct baked *b,
                                        const struct glint_setup *fast)
{
    const struct glint_view view = {
        .width = 60, .height = 40, .sensor_width_mm = 36};
    const struct glint_lamp lamp = {.power = 1, .rgb = {1, 1, 1}};
    struct glint_frame_scale scale;
    struct glint_frame frame;

    glint_frame_init(&frame, fast, view, NULL);
    frame.lens = &b->lens;
    assert_ok(glint_frame_predict_scale(&frame, &lamp, 1, &scale));
    assert_true(frame.cfg.max_bundles >= (int)b->lens.header->n_ghosts);
    glint_frame_finish(&frame);
}

/* A triplet's ghost (surfaces 0 and 3) has rays that fold in the stop plane, so
 * the ghost's pupil is divided into parts. Checks that each unblocked ray lies
 * in exactly one part, except on borders between parts, and that no part is
 * empty. */
TEST(each_ray_lies_in_one_pupil_part)
{
    enum { GHOST = 2, MOST = 32, ANGLES = 8, SIDE = 61 };
    static struct glint_transfer part[MOST];
    static struct glint_prescription lens;
    static struct glint_setup fast;
    const double nm = 480;
    struct glint_error error;
    int shared_deg = 0, n_rays = 0;
    struct baked b;

    if (getenv("GLINT_QUICK") && *getenv("GLINT_QUICK"))
        /* Skipped under sanitizers, where it takes 30 s; other tests run the
         * same code. */
        skip();
    load_lens(&lens, "../tests/lenses/cooke-triplet");
    bake_text(&b, &lens, NULL, 1, 0.5);
    assert_ok(glint_setup_init(&fast, &lens, 0, 0, &nm, 1, &error));
    assert_int_equal(fast.ghost[GHOST].j, 3);
    assert_in_range(b.lens.header->n_parts, 1, MOST - 1);
    check_planned_pupil_regions(&b, &fast);
    for (int a = 0; a < ANGLES; a++) {
        const double sine = sin(0.499 * a / (ANGLES - 1) * 0.0174532925199433);
        const double direction[3] = {sine, 0, sqrt(1 - sine * sine)};
        struct glint_path path;
        int n = 0;

        for (int k = 0; k < (int)b.lens.header->n_ghosts; k++)
            n += b.lens.ghost[k].i == 0 && b.lens.ghost[k].j == 3 &&
                 glint_transfer_init(&part[n], &b.lens, k,
                                     (int32_t)lrint(sine * 0x1p30),
                                     (int32_t)lrint(0x1p24 * 1e6 / (nm * nm)));
        shared_deg += n > 1;
        glint_path_init(&path, &lens, &fast.ghost[GHOST], nm);
        for (int k = 0; k < SIDE * SIDE; k++) {
            const double x = 9.4 * (2.0 * (k % SIDE) / (SIDE - 1) - 1.001);
            const double y = 9.4 * (2.0 * (k / SIDE) / (SIDE - 1) - 1.001);
            struct glint_ray ray;
            double off = 0;

            if (glint_trace(&path, x, y, direction, &ray, NULL) ||
                ray.rel_radius > 0.999 ||
                hypot(ray.stop_x_mm, ray.stop_y_mm) >
                    0.999 * fast.optics.stop_radius_mm ||
                hypot(ray.sensor_x_mm, ray.sensor_y_mm) > 0.99 * 0.55 * 43.2666)
                continue;
            n_rays++;
            assert_int_equal(
                count_pupil_parts_with_ray(part, n, x, y, &ray, &off), 1);
            assert_true(off < 0.1 * 36 / 1920);
        }
    }
    assert_true(n_rays > 1000);
    assert_true(shared_deg > 0);
    free(b.data);
}

/* Two barrel apertures clip this ghost. Their outlines are only 0.0008 stop
 * radii apart, so the model needs the second one only at a smaller
 * tolerance. */
TEST(near_second_barrel_needs_a_small_tolerance)
{
    static const double band_nm[2] = {400, 700};
    static const double range[2] = {0.29, 0.305};
    static struct glint_prescription lens;
    static struct glint_setup zoom;
    static struct glint_visible visible;
    static struct glint_visible_profile profile;
    static glint_zone_sampling sampling;
    static struct glint_zone_rays rays;
    struct glint_error error;
    struct glint_zone zone;

    load_lens(&lens, "canon-zoom-long");
    assert_ok(glint_setup_init(&zoom, &lens, 0, 0, band_nm, 2, &error));
    glint_visible_init(&visible, &zoom, 71, 23.8, band_nm);
    glint_visible_find_profile(&visible, range, &profile);
    glint_zone_init(&zone, &profile, range[0], range[1], false);
    glint_zone_choose_barrels(&zone, &visible, 1e-3, &sampling, &rays);
    assert_int_equal(rays.n_barrels, 1);
    assert_true(rays.missed_cut <= 1e-3);
    glint_zone_choose_barrels(&zone, &visible, 2.5e-4, &sampling, &rays);
    assert_int_equal(rays.n_barrels, 2);
    assert_true(rays.missed_cut <= 2.5e-4);
}

/* Near total reflection this ghost ends inside all barrels. Checks that its
 * polynomials do not continue it. */
TEST(totally_reflected_rays_are_blocked)
{
    static struct glint_prescription lens;
    static bool ghosts[GLINT_MAX_GHOSTS];
    struct glint_bake_options o;
    struct glint_error error;
    struct baked b;

    load_lens(&lens, "wide/double-gauss-canon-28");
    assert_ok(glint_prescription_set_f_number(&lens, 11, &error));
    glint_bake_defaults(&o);
    o.max_deg = 38;
    o.tolerance = 4;
    ghosts[13] = true;
    o.ghosts = ghosts;
    bake_and_open_model(&b, &lens, &o);
    print_message("%d of %d rays leak\n", b.report.intruders, b.report.rays);
    assert_true(b.report.intruders < b.report.rays / 500);
    free(b.data);
}

/* A zone is a range of field angles with polynomials of its own. Checks that a
 * zone restricted to a part of its pupil keeps its pupil box, expressed in the
 * coordinates of the part. */
TEST(cut_zone_keeps_its_box)
{
    struct glint_zone zone = {.lo = 0.1, .hi = 0.2}, cut;
    const struct glint_zone_part part = {-0.25, 0.5, 0.75, -0.5, 0.75, 3};
    uint32_t seed = 3;

    for (int k = 0; k < GLINT_BOX_TERMS; k++) {
        zone.middle[k] = rng_signed(&seed);
        zone.half_x[k] = rng_signed(&seed);
        zone.half_y[k] = rng_signed(&seed);
    }
    cut = zone;
    glint_zone_cut_to_part(&cut, &part);
    assert_int_equal(cut.annulus, 3);
    for (int k = 0; k < 100; k++) {
        const double u = rng_signed(&seed), s = rng_signed(&seed),
                     w = rng_signed(&seed);
        const double whole_w = 0.125 + 0.625 * w, whole_u = 0.125 + 0.375 * u;

        assert_near(
            glint_zone_evaluate_round_box_polynomial(cut.middle, s, w) +
                u * glint_zone_evaluate_round_box_polynomial(cut.half_x, s, w),
            glint_zone_evaluate_round_box_polynomial(zone.middle, s, whole_w) +
                whole_u * glint_zone_evaluate_round_box_polynomial(zone.half_x,
                                                                   s, whole_w),
            1e-12);
        assert_near(glint_zone_evaluate_round_box_polynomial(cut.half_y, s, w),
                    0.75 * glint_zone_evaluate_round_box_polynomial(zone.half_y,
                                                                    s, whole_w),
                    1e-12);
    }
}

/* A zone is a range of field angles with polynomials of its own. Checks a zone
 * whose pupil box and wavelength band are larger than its ghost: cropping the
 * zone removes only regions without light. */
TEST(cropping_removes_only_invisible_regions)
{
    const double range[2] = {sin(0.1), sin(0.2)};
    static struct glint_visible visible, narrow;
    static struct glint_visible_profile profile;
    const struct glint_zone_part whole = {-1, 1, 1, -1, 1, false};
    struct glint_zone_part part = whole;
    struct glint_zone zone;
    uint32_t seed = 8;
    int seen = 0;

    glint_visible_init(&visible, &setup, 7, field_mm, options.band_nm);
    glint_visible_narrow_band(&narrow, &visible, -0.5, 1);
    assert_near(narrow.wave_lo,
                visible.wave_lo + 0.25 * (visible.wave_hi - visible.wave_lo),
                1e-12);
    assert_near(narrow.wave_hi, visible.wave_hi, 1e-12);
    glint_visible_find_profile(&visible, range, &profile);
    glint_zone_init(&zone, &profile, range[0], range[1], true);
    for (int k = 0; k < GLINT_BOX_TERMS; k++) {
        zone.half_x[k] *= 3;
        zone.half_y[k] *= 2;
    }
    assert_in_range((long)(100 * glint_zone_crop_part(&zone, &visible, &part)),
                    10, 45);
    for (int k = 0; k < 4000; k++) {
        const double u = rng_signed(&seed), v = fabs(rng_signed(&seed)),
                     s = rng_signed(&seed), w = rng_signed(&seed);
        const double sine =
            0.5 * (range[0] + range[1]) + 0.5 * s * (range[1] - range[0]);
        const double direction[3] = {sine, 0, sqrt(1 - sine * sine)};
        struct glint_path path;
        struct glint_ray ray;

        glint_visible_init_path(&visible, w, &path);
        if (glint_trace(
                &path,
                glint_zone_evaluate_round_box_polynomial(zone.middle, s, w) +
                    u * glint_zone_evaluate_round_box_polynomial(zone.half_x, s,
                                                                 w),
                v * glint_zone_evaluate_round_box_polynomial(zone.half_y, s, w),
                direction, &ray, NULL) ||
            !glint_visible_is_ray_visible(&visible, &ray))
            continue;
        seen++;
        assert_true(u >= part.u0 && u <= part.u1 && v <= part.top);
        assert_true(w >= part.w0 && w <= part.w1);
    }
    assert_true(seen > 100);
}

/* ----------------------------------------------- errors of the polynomials */

enum { TRIED = GLINT_OUT_ENERGY + 1, BUNDLES = 300, PER_BUNDLE = 12 };

struct tally {
    long n;
    double sum2[TRIED], energy_error[BUNDLES * PER_BUNDLE],
        energy[BUNDLES * PER_BUNDLE], most;
};

static bool ray_passes_rims_stop_and_field(const struct glint_ray *ray)
{
    return ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <=
               setup.optics.stop_radius_mm &&
           hypot(ray->sensor_x_mm, ray->sensor_y_mm) <= field_mm;
}

static void add_ray_errors(struct tally *tally, const struct glint_transfer *t,
                           const struct glint_path *path,
                           const double direction[3], uint32_t *seed)
{
    const int32_t u_q30 = (int32_t)rng_xorshift(seed) / 2;
    const int32_t v_q30 = (int32_t)rng_xorshift(seed) / 2;
    const double unit = ldexp(1, t->box_exponent),
                 stop = setup.optics.stop_radius_mm;
    const double x = unit * (t->box[0] + t->box[1] * (u_q30 * 0x1p-30));
    const double y = unit * t->box[2] * (v_q30 * 0x1p-30);
    struct glint_outputs out;
    struct glint_ray ray;

    if (glint_trace(path, x, y, direction, &ray, NULL) ||
        !ray_passes_rims_stop_and_field(&ray))
        return;
    glint_transfer_ray(t, u_q30, v_q30, &out);
    {
        const double truth[TRIED] = {ray.sensor_x_mm, ray.sensor_y_mm,
                                     ray.stop_x_mm / stop, ray.stop_y_mm / stop,
                                     ray.energy};

        for (int kind = 0; kind < TRIED; kind++) {
            const double unit_of = kind <= GLINT_OUT_SENSOR_Y ? 1920 / 36.0 : 1;
            const double error =
                unit_of *
                (ldexp(out.at[kind], t->exponent[kind]) - truth[kind]);

            tally->sum2[kind] += error * error;
            tally->energy_error[tally->n] = error;
        }
        tally->energy[tally->n++] = ray.energy;
        tally->most = fmax(tally->most, ray.energy);
    }
}

/* Sets RMS to the errors of the polynomials of SYSTEM of GHOST, in the units of
 * the model file, without using src/bake/measure_model.c. Returns the number of
 * rays measured. */
static long measure_system_errors(const struct glint_lens *lens, int ghost,
                                  int system, double rms[TRIED])
{
    static struct glint_transfer t;
    static struct tally tally;
    const struct glint_model_system *s = &lens->system[system];
    uint32_t seed = 4711 + (uint32_t)system;

    tally = (struct tally){.n = 0};
    for (int k = 0; k < BUNDLES; k++) {
        const double a = rng_xorshift(&seed) * 0x1p-32;
        const double b = rng_xorshift(&seed) * 0x1p-32;
        const int32_t sine_q30 =
            s->sine_lo_q30 + 1 +
            (int32_t)(a * (s->sine_hi_q30 - s->sine_lo_q30 - 2));
        const int32_t wave_q24 =
            s->wave_lo_q24 + (int32_t)(b * (s->wave_hi_q24 - s->wave_lo_q24));
        const double sine = sine_q30 * 0x1p-30;
        const double direction[3] = {sine, 0, sqrt(1 - sine * sine)};
        struct glint_path path;

        assert_true(glint_transfer_init(&t, lens, ghost, sine_q30, wave_q24));
        assert_ptr_equal(t.system, s);
        glint_path_init(&path, &heliar, &setup.ghost[ghost],
                        1e3 / sqrt(wave_q24 * 0x1p-24));
        for (int i = 0; i < PER_BUNDLE; i++)
            add_ray_errors(&tally, &t, &path, direction, &seed);
    }
    tally.sum2[GLINT_OUT_ENERGY] = 0;
    for (long k = 0; k < tally.n; k++) {
        const double share =
            tally.energy_error[k] / fmax(tally.energy[k], 0.1 * tally.most);

        tally.sum2[GLINT_OUT_ENERGY] += share * share;
    }
    for (int kind = 0; kind < TRIED; kind++)
        rms[kind] = tally.n ? sqrt(tally.sum2[kind] / (double)tally.n) : 0;
    return tally.n;
}

static const struct glint_model_output *outputs_of(const struct baked *b,
                                                   int system)
{
    return (const void *)(b->data + b->lens.system[system].output_at);
}

static double read_error_stated_in_model(uint16_t stored)
{
    return ldexp((double)glint_model_error_q20(stored), -20);
}

/* Checks that the errors stated in a model are within 30 % of those that
 * measure_system_errors() measures. */
TEST(stated_errors_match_measured_errors)
{
    for (int g = 0; g < setup.n_ghosts; g++)
        for (uint32_t k = 0; k < model.lens.ghost[g].n_systems; k++) {
            const int system = (int)(model.lens.ghost[g].first_system + k);
            const struct glint_model_output *o = outputs_of(&model, system);
            double rms[TRIED];

            assert_true(measure_system_errors(&model.lens, g, system, rms) >
                        300);
            for (int kind = 0; kind < TRIED; kind++) {
                const double said = read_error_stated_in_model(o[kind].rms);

                if (fabs(rms[kind] - said) > 0.3 * said)
                    fail_msg("system %d: output %d is off by %g, the file says "
                             "%g",
                             system, kind, rms[kind], said);
                assert_true(o[kind].p50 <= o[kind].p99);
                assert_true(o[kind].p99 <= o[kind].max);
                assert_true(o[kind].rms <= o[kind].max);
            }
        }
}

/* Checks that the errors of a model are at most 1.6 times the tolerances with
 * which it was baked. */
TEST(errors_stay_near_the_tolerances)
{
    static const double aim[TRIED] = {0.08, 0.08, 4.5e-4, 4.5e-4, 1.2e-2};

    assert_int_equal(model.report.unmet, 0);
    assert_true(model.report.rays > 300 * (int)model.lens.header->n_systems);
    assert_true(model.report.intruders < model.report.rays / 1000);
    for (uint32_t k = 0; k < model.lens.header->n_systems; k++) {
        const struct glint_model_output *o = outputs_of(&model, (int)k);

        for (int kind = 0; kind < TRIED; kind++)
            assert_true(read_error_stated_in_model(o[kind].rms) <=
                        1.6 * TOLERANCE * aim[kind]);
    }
}

/* Checks that the errors of lights near the axis, whose ghosts fold into rings,
 * decrease with the square of the tolerance. */
TEST(errors_near_the_axis_fall_with_squared_tolerance)
{
    const double tolerance = 0.25, aim_px = 0.04;
    struct glint_prescription lens;
    struct baked b;

    bake_text(&b, &lens, FAST_SINGLET, tolerance, 4);
    assert_int_equal(b.lens.system[0].sine_lo_q30, 0);
    assert_true(
        read_error_stated_in_model(outputs_of(&b, 0)[GLINT_OUT_SENSOR_X].rms) <
        1.6 * tolerance * tolerance * aim_px);
    free(b.data);
}

/* A film of this refractive index reflects nothing at its design wavelength.
 * Checks that the fit follows the resulting zero of the ghost's energy. */
TEST(fit_follows_a_zero_of_the_energy)
{
    struct glint_prescription lens;
    struct baked b;

    bake_text(&b, &lens, FAST_SINGLET "coating 532 1.2316\n", 0.1, 0.5);
    for (uint32_t k = 0; k < b.lens.header->n_systems; k++) {
        assert_true(read_error_stated_in_model(
                        outputs_of(&b, (int)k)[GLINT_OUT_ENERGY].rms) < 1e-3);
    }
    free(b.data);
}

/* Checks that a wrong coefficient raises the errors stated in the model and the
 * measured errors, so that the tests above can fail. */
TEST(wrong_coefficient_is_detected)
{
    static const struct glint_fitted_system no_barrels;
    static const double band_nm[2] = {400, 700};
    static struct glint_visible visible;
    struct baked b = model;
    const struct glint_model_output *o;
    struct glint_measured before, after;
    double rms[TRIED];
    int32_t *coef;
    uint32_t largest = 0;

    b.data = malloc(model.bytes);
    assert_non_null(b.data);
    memcpy(b.data, model.data, model.bytes);
    b.lens.header = (const void *)b.data;
    b.lens.ghost = (const void *)(b.data + b.lens.header->ghost_at);
    b.lens.system = (const void *)(b.data + b.lens.header->system_at);
    glint_visible_init(&visible, &setup, 0, field_mm, band_nm);
    glint_measure_system_errors(&visible, &b.lens, 0, &no_barrels, &before);
    o = outputs_of(&b, 0);
    assert_near(read_error_stated_in_model(o->rms) / before.of[0].rms, 1, 1e-3);
    coef = (void *)(b.data + o->coef_at);
    for (uint32_t k = 1; k < o->n_terms; k++)
        largest = labs(coef[k]) > labs(coef[largest]) ? k : largest;
    coef[largest] = -coef[largest];
    glint_measure_system_errors(&visible, &b.lens, 0, &no_barrels, &after);
    measure_system_errors(&b.lens, 0, 0, rms);
    assert_true(after.of[0].rms > 50 * before.of[0].rms);
    assert_true(after.of[0].max > 50 * before.of[0].max);
    assert_true(rms[0] > 50 * before.of[0].rms);
    /* only the polynomial of sensor x is wrong, so the error of y is
     * unchanged */
    assert_near(after.of[1].rms, before.of[1].rms, 0);
    free(b.data);
}

/* --------------------------------------------------- key, rejected options */

static void check_model_key_differs(const struct glint_prescription *lens,
                                    const struct glint_bake_options *o)
{
    assert_true(glint_bake_key(lens, o) != glint_bake_key(&heliar, &options));
}

TEST(key_depends_on_every_parameter)
{
    struct glint_prescription lens = heliar;
    struct glint_bake_options o = options;
    double *const of_lens[] = {&lens.f_number, &lens.film_width_mm,
                               &lens.film_height_mm, &lens.stop_thickness_mm};
    double *const of_options[] = {&o.band_nm[0], &o.band_nm[1], &o.max_deg,
                                  &o.field_mm, &o.tolerance};

    assert_true(glint_bake_key(&lens, &o) == glint_bake_key(&heliar, &options));
    for (size_t k = 0; k < sizeof of_lens / sizeof *of_lens; k++) {
        lens = heliar;
        *of_lens[k] = nextafter(*of_lens[k], 1000);
        check_model_key_differs(&lens, &o);
    }
    for (int s = 0; s < heliar.n_surfaces; s++)
        for (int k = 0; k < 7; k++) {
            struct glint_surface *f = &lens.surface[s];
            double *const form[] = {&f->radius_mm, &f->semi_mm, &f->nd, &f->vd};
            double *const rest[] = {&f->thickness_mm, &f->coating.nm,
                                    &f->coating.film->index};
            double *const x = k < 4 ? form[k] : rest[k - 4];
            lens = heliar;
            *x = nextafter(*x, 1000);
            check_model_key_differs(&lens, &o);
        }
    lens = heliar;
    lens.stop_after--;
    check_model_key_differs(&lens, &o);
    lens = heliar;
    lens.name[0]++;
    check_model_key_differs(&lens, &o);
    lens = heliar;
    for (size_t k = 0; k < sizeof of_options / sizeof *of_options; k++) {
        o = options;
        *of_options[k] = nextafter(*of_options[k], 1000);
        check_model_key_differs(&lens, &o);
    }
    /* These fields do not affect the model, so its key does not depend on
     * them. */
    o = options;
    o.workers = (void *)&lens;
    o.progress_ctx = &lens;
    lens.source[0]++;
    assert_true(glint_bake_key(&lens, &o) == glint_bake_key(&heliar, &options));
}

TEST(rejects_numbers_out_of_range)
{
    static const double numbers[] = {(double)NAN, -1, 1e9, HUGE_VAL, -HUGE_VAL};

    for (int k = 0; k < 5 * 5 + 2; k++) {
        struct glint_bake_options o = options;
        double *const of_options[] = {&o.band_nm[0], &o.band_nm[1], &o.max_deg,
                                      &o.field_mm, &o.tolerance};
        struct glint_bake_report report = {7, 7, 7};
        unsigned char *data = NULL;
        struct glint_error error = {"?"};
        size_t bytes = 7;

        if (k < 25)
            *of_options[k / 5] = numbers[k % 5];
        else if (k == 25)
            o.max_deg = 0;
        else
            o.band_nm[1] = o.band_nm[0];
        assert_int_equal(
            glint_bake(&heliar, &o, &data, &bytes, &report, &error),
            GLINT_E_ARGUMENT);
        assert_true(strlen(error.text) > 10);
        assert_null(data);
        assert_int_equal(bytes, 7);
        assert_int_equal(report.rays, 7);
    }
}

/* ---------------------------------------------- unusual lenses and options */

TEST(lens_without_ghosts_gives_an_empty_model)
{
    static struct glint_prescription lens;
    struct baked b;

    parse_singlet(&lens);
    lens.n_surfaces = 1; /* the sensor lies in the glass */
    lens.stop_after = 1;
    bake_and_open_model(&b, &lens, &options);
    assert_int_equal(b.lens.header->n_ghosts, 0);
    assert_int_equal(b.lens.header->n_systems, 0);
    assert_int_equal(b.report.rays, 0);
    free(b.data);
}

TEST(loosest_tolerance_keeps_a_term)
{
    static struct glint_prescription lens;
    struct glint_bake_options o = options;
    struct baked b;

    parse_singlet(&lens);
    o.tolerance = 100;
    bake_and_open_model(&b, &lens, &o);
    for (uint32_t k = 0; k < b.lens.header->n_systems; k++)
        assert_in_range(outputs_of(&b, (int)k)->n_terms, 1,
                        GLINT_MAX_MODEL_TERMS);
    free(b.data);
}

/* Checks a field of only 1e-3 mm, where a ghost may be visible at angle 0 only:
 * its range of angles must not be empty. */
TEST(ranges_of_a_tiny_field_have_width)
{
    static const double band_nm[2] = {400, 700};
    static struct glint_prescription lens;
    static struct glint_setup doublet;
    static struct glint_visible visible;
    double range[GLINT_MAX_RANGES][2];
    struct glint_error error;

    parse_doublet(&lens);
    assert_ok(glint_setup_init(&doublet, &lens, 0, 0, band_nm, 2, &error));
    for (int g = 0; g < doublet.n_ghosts; g++) {
        int n;

        glint_visible_init(&visible, &doublet, g, 1e-3, band_nm);
        n = glint_visible_find_ranges(&visible, 15, range);
        for (int k = 0; k < n; k++)
            assert_true(range[k][1] > range[k][0]);
    }
}

/* Checks ghosts whose light enters the front element through a spot of 1/20 mm:
 * their ranges extend to the angles at which the ghosts vanish. */
TEST(ranges_of_spots_extend_to_where_ghosts_vanish)
{
    static const struct {
        int ghost;
        double end_deg;
    } spot[] = {{85, 16}, {87, 9.5}};
    static const double band_nm[2] = {400, 700};
    static struct glint_prescription lens;
    static struct glint_setup zoom;
    static struct glint_visible visible;
    double range[GLINT_MAX_RANGES][2];
    struct glint_error error;

    load_lens(&lens, "nikon-zoom-short");
    assert_ok(glint_setup_init(&zoom, &lens, 0, 0, band_nm, 2, &error));
    for (size_t i = 0; i < sizeof spot / sizeof *spot; i++) {
        glint_visible_init(&visible, &zoom, spot[i].ghost, 23.8, band_nm);
        assert_int_equal(glint_visible_find_ranges(&visible, 60, range), 1);
        assert_near(range[0][0], 0, 1e-12);
        assert_true(range[0][1] > sin(spot[i].end_deg * 0.0174532925));
    }
}
