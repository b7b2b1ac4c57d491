/* SPDX-License-Identifier: MIT
 *
 * Compares the polynomials that describe the projection of a lens with traced
 * chief rays, and checks their inverses.
 */
#include "engine/setup/degrees.h"
#include "support/lens_check.h"

static struct glint_projection
compute_projection(struct glint_prescription *lens, const char *name,
                   double *miss_deg)
{
    struct glint_projection p;
    struct glint_error error = {""};

    load_lens(lens, name);
    if (glint_projection_of(&p, lens, miss_deg, &error) != GLINT_OK)
        fail_msg("%s", error.text);
    return p;
}

TEST(view_without_projection_is_a_pinhole)
{
    const struct glint_projection none = {.reach = 0};

    for (int deg = 0; deg < 90; deg++) {
        const double tangent = glint_sin_deg(deg) / glint_cos_deg(deg);

        assert_true(glint_projection_rho(&none, deg) == tangent);
        assert_true(glint_projection_deg(&none, tangent) ==
                    atan(tangent) * (180 / GLINT_PI));
    }
}

/* Checks that converting an angle to an image position and back gives the
 * angle, inside and outside the traced range. */
TEST(angles_convert_to_positions_and_back)
{
    static const char *const names[] = {"heliar-tronnier", "phone/phone-six",
                                        "wide/fisheye-nikkor-6",
                                        "wide/retrofocus-nikkor-28"};
    struct glint_prescription lens;
    double miss_deg;

    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        const struct glint_projection p =
            compute_projection(&lens, names[k], &miss_deg);
        double before = -1;

        for (int i = 0; i <= 200; i++) {
            const double rho = 0.01 * i * p.reach;
            const double deg = glint_projection_deg(&p, rho);

            assert_true(deg > before || deg >= 89.9);
            before = deg;
            if (deg < 89.9)
                assert_near(glint_projection_rho(&p, deg), rho, 1e-9);
        }
    }
}

TEST(pixel_directions_are_imaged_to_the_pixel)
{
    struct glint_prescription lens;
    struct glint_view view;
    double miss_deg;

    view = glint_view_fit(1920, 1080, 18.58, 13.93);
    view.projection =
        compute_projection(&lens, "wide/fisheye-nikkor-6", &miss_deg);
    for (int k = 0; k < 50; k++) {
        const double at[2] = {700 + 10.3 * k, 100 + 17.1 * k};
        struct glint_lamp lamp;
        double x, y;

        glint_view_to_angles(&view, 6.296, at[0], at[1], &lamp);
        glint_view_to_pixel(&view, 6.296, &lamp, &x, &y);
        assert_near(x, at[0], 1e-6);
        assert_near(y, at[1], 1e-6);
    }
}

/* Checks the error of the polynomials, and that each lens has its known type of
 * projection. */
TEST(projections_have_their_known_types)
{
    struct glint_prescription lens;
    struct glint_projection p;
    double miss_deg;

    /* equidistant within 0.1, the usual projection of fisheyes of 220
     * degrees */
    p = compute_projection(&lens, "wide/fisheye-nikkor-6", &miss_deg);
    assert_true(miss_deg < 0.1);
    for (int deg = 10; deg <= 80; deg += 10)
        assert_near(glint_projection_rho(&p, deg) / (deg * GLINT_PI / 180), 1,
                    0.1);
    /* A camera lens has about 1 % of distortion. */
    p = compute_projection(&lens, "normal/double-gauss-nikkor-50", &miss_deg);
    assert_true(miss_deg < 0.005);
    assert_near(glint_projection_rho(&p, 20) / tan(20 * GLINT_PI / 180), 1,
                0.03);
    assert_true(glint_projection_rho(&p, 20) != tan(20 * GLINT_PI / 180));
}

/* Checks the polynomials at angles between the whole degrees to which they were
 * fitted. */
TEST(chief_rays_between_degrees_fit)
{
    const double degrees[] = {3.5, 11.5, 19.5};
    struct glint_prescription lens;
    struct glint_optics optics;
    struct glint_path path;
    double miss_deg;
    const struct glint_projection p =
        compute_projection(&lens, "heliar-tronnier", &miss_deg);

    glint_optics_of(&lens, &optics);
    glint_path_init(&path, &lens, NULL, 588);
    for (int k = 0; k < 3; k++) {
        const double d[3] = {glint_sin_deg(degrees[k]), 0,
                             glint_cos_deg(degrees[k])};
        double x = 0, before = 0, stop = 0;
        struct glint_ray ray;

        /* Finds the chief ray by the secant method, starting at the centre of
         * the front element. */
        for (int i = 0; i < 20; i++) {
            const double now = x;

            if (glint_trace(&path, x, 0, d, &ray, NULL) != GLINT_RAY_OK)
                fail_msg("%g degrees: a ray is invalid", degrees[k]);
            if (fabs(ray.stop_x_mm) < 1e-12)
                break;
            x = i ? x - ray.stop_x_mm * (x - before) / (ray.stop_x_mm - stop)
                  : x - 0.1;
            before = now;
            stop = ray.stop_x_mm;
        }
        assert_near(glint_projection_deg(&p, ray.sensor_x_mm / optics.focal_mm),
                    degrees[k], 0.01);
    }
}

TEST(rejects_lenses_without_a_projection)
{
    struct glint_prescription lens;
    struct glint_projection p;
    struct glint_error error = {""};
    double miss_deg;

    load_lens(&lens, "anamorphic/anamorphic-schneider");
    assert_int_equal(glint_projection_of(&p, &lens, &miss_deg, &error),
                     GLINT_E_LENS);
    assert_non_null(strstr(error.text, "not rotationally symmetric"));
}
