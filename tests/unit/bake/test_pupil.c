/* SPDX-License-Identifier: MIT
 *
 * Checks that the pupil box contains every unblocked ray that a dense scan of
 * the front element finds.
 */
#include "bake/trace/spot.h"
#include "support/lens_check.h"

enum { SCAN = 240 };

static struct glint_prescription lens;
static struct glint_optics optics;
static struct glint_ghost ghosts[GLINT_MAX_GHOSTS];

/* Returns whether a ray passes all openings, by tracing this single ray. */
static bool ray_passes_all_openings(const struct glint_path *path, double x,
                                    double y, const double direction[3],
                                    struct glint_ray *ray)
{
    return glint_trace(path, x, y, direction, ray, NULL) == GLINT_RAY_OK &&
           ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <= optics.stop_radius_mm;
}

static bool is_ray_in_pupil_box(const struct glint_pupil *box, double x,
                                double y)
{
    return x >= box->x0_mm && x <= box->x1_mm && y <= box->y1_mm;
}

/* Compares the pupil box of GHOST at THETA_DEG and the wavelength NM with a
 * dense scan of rays. NEAR: the search starts at the box found at 532 nm, and
 * that box, extended, is compared as well. Adds the number of unblocked rays to
 * *N_SEEN. */
static void check_pupil_box_by_scan(int ghost, double theta_deg, double nm,
                                    bool near, int *n_seen)
{
    const double t = theta_deg * 3.14159265358979 / 180;
    const double direction[3] = {sin(t), 0, cos(t)};
    const double semi = lens.surface[0].semi_mm * 1.1;
    struct glint_pupil box, middle = {0}, extended;
    struct glint_path path;
    bool found, can_extend;

    glint_path_init(&path, &lens, &ghosts[ghost], 532);
    near = near && glint_pupil_find(&middle, &path, theta_deg,
                                    optics.stop_radius_mm, NULL);
    glint_path_init(&path, &lens, &ghosts[ghost], nm);
    found = glint_pupil_find(&box, &path, theta_deg, optics.stop_radius_mm,
                             near ? &middle : NULL);
    extended = middle;
    can_extend = near && glint_pupil_extend(&extended, &path, direction,
                                            optics.stop_radius_mm);
    for (int j = 0; j <= SCAN / 2; j++)
        for (int i = 0; i <= SCAN; i++) {
            const double x = semi * (2.0 * i / SCAN - 1);
            const double y = semi * 2.0 * j / SCAN;
            struct glint_ray ray;

            if (!ray_passes_all_openings(&path, x, y, direction, &ray))
                continue;
            ++*n_seen;
            if (!found || !is_ray_in_pupil_box(&box, x, y))
                fail_msg("ghost %d at %g degrees: (%g, %g) passes outside "
                         "the box",
                         ghost, theta_deg, x, y);
            if (near && !(can_extend && is_ray_in_pupil_box(&extended, x, y)))
                fail_msg("ghost %d at %g degrees: (%g, %g) passes outside "
                         "the extended box",
                         ghost, theta_deg, x, y);
            assert_true(ray.energy <= 1.5 * box.energy);
            assert_true(ray.sensor_x_mm >= box.sensor_mm[0] - 1e-6 ||
                        box.sensor_mm[1] > box.sensor_mm[0]);
        }
}

static void check_pupil_boxes_of_lens(const char *name, int step)
{
    static const double angles[] = {0, 3, 7.5, 12, 25};
    int n_ghosts, n_seen = 0;

    load_lens(&lens, name);
    glint_optics_of(&lens, &optics);
    n_ghosts = glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);
    for (int ghost = 0; ghost < n_ghosts; ghost += step)
        for (int a = 0; a < 5; a++)
            check_pupil_box_by_scan(ghost, angles[a], a & 1 ? 450 : 650, a != 2,
                                    &n_seen);
    assert_true(n_seen > 1000);
}

TEST(heliar_boxes_match_a_scan)
{
    check_pupil_boxes_of_lens("heliar-tronnier", 1);
}

TEST(angenieux_boxes_match_a_scan)
{
    check_pupil_boxes_of_lens("double-gauss-angenieux", 3);
}

TEST(itoh_boxes_match_a_scan)
{
    check_pupil_boxes_of_lens("itoh-zoom-long", 7);
}

/* Checks a ghost whose light enters the front element through a spot of 1/20
 * mm. */
TEST(finds_a_ghost_that_enters_through_a_spot)
{
    load_lens(&lens, "nikon-zoom-short");
    glint_optics_of(&lens, &optics);
    glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);
    for (int k = 0; k < 19; k++) {
        const double t = 0.5 * k * 3.14159265358979 / 180;
        const double direction[3] = {sin(t), 0, cos(t)};
        struct glint_pupil box;
        struct glint_path path;
        struct glint_ray ray;

        glint_path_init(&path, &lens, &ghosts[87], 532);
        assert_true(glint_pupil_find(&box, &path, 0.5 * k,
                                     optics.stop_radius_mm, NULL));
        assert_true(box.x1_mm - box.x0_mm < 0.1 && box.y1_mm < 0.1);
        assert_true(ray_passes_all_openings(
            &path, 0.5 * (box.x0_mm + box.x1_mm), 0, direction, &ray));
    }
}

static void load_fisheye_ghost_path(struct glint_path *path, int ghost,
                                    double nm)
{
    struct glint_error error = {""};

    load_lens(&lens, "wide/fisheye-zuiko-8");
    assert_ok(glint_prescription_set_f_number(&lens, 11, &error));
    glint_optics_of(&lens, &optics);
    glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);
    glint_path_init(path, &lens, &ghosts[ghost], nm);
}

/* Checks ghosts of a fisheye that enter the front element, 80 mm wide, through
 * spots of 1/20 mm. All rays around the spots are invalid. At each wavelength,
 * the search must find a spot next to the spot of the previous wavelength. */
TEST(finds_spots_of_a_fisheye)
{
    static const struct {
        int ghost;
        double deg;
    } spot[] = {{3, 61.13}, {6, 57.17}, {15, 12.74}, {15, 78.87}};

    for (int k = 0; k < 4; k++) {
        const double t = spot[k].deg * 3.14159265358979 / 180;
        const double direction[3] = {sin(t), 0, cos(t)};
        double before = 0;

        for (int nm = 400; nm <= 700; nm += 50) {
            struct glint_pupil box;
            struct glint_path path;
            struct glint_ray ray;
            int n = 0;

            load_fisheye_ghost_path(&path, spot[k].ghost, nm);
            assert_true(glint_pupil_find(&box, &path, spot[k].deg,
                                         optics.stop_radius_mm, NULL));
            assert_true(box.x1_mm - box.x0_mm < 0.3 && box.y1_mm < 0.1);
            for (int i = 0; i <= SCAN; i++)
                n += ray_passes_all_openings(
                    &path, box.x0_mm + (box.x1_mm - box.x0_mm) * i / SCAN, 0,
                    direction, &ray);
            assert_true(n > SCAN / 2);
            assert_true(nm == 400 || fabs(box.x0_mm - before) < 1);
            before = box.x0_mm;
        }
    }
}

/* Checks a crescent-shaped pupil whose tips are thinner than the cells of the
 * search grid. */
TEST(finds_thin_tips_of_a_crescent)
{
    const double t = 12.74 * 3.14159265358979 / 180;
    const double direction[3] = {sin(t), 0, cos(t)};

    for (int nm = 400; nm <= 700; nm += 50) {
        struct glint_pupil box;
        struct glint_path path;
        struct glint_ray ray;
        int n = 0;

        load_fisheye_ghost_path(&path, 51, nm);
        assert_true(
            glint_pupil_find(&box, &path, 12.74, optics.stop_radius_mm, NULL));
        for (int j = 0; j <= SCAN; j++)
            for (int i = 0; i <= SCAN; i++) {
                const double x = -9 + 7.0 * i / SCAN, y = 3.0 * j / SCAN;

                if (!ray_passes_all_openings(&path, x, y, direction, &ray))
                    continue;
                n++;
                assert_true(x >= box.x0_mm && x <= box.x1_mm && y <= box.y1_mm);
            }
        assert_true(n > 1000);
    }
}

/* Checks that a ghost has no pupil box at 85 degrees, where no light of the
 * ghost reaches the stop. */
TEST(blocked_ghost_has_no_box)
{
    struct glint_pupil box;
    struct glint_path path;

    load_lens(&lens, "canon-zoom-long");
    glint_optics_of(&lens, &optics);
    glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);
    glint_path_init(&path, &lens, &ghosts[0], 532);
    assert_false(
        glint_pupil_find(&box, &path, 85, optics.stop_radius_mm, NULL));
}

/* Checks that a pupil box, whose side K was moved inwards by a fifth of the
 * box, grows to contain all unblocked rays, and that no other side moves
 * inwards. */
static void check_shrunk_pupil_box_grows(const struct glint_path *path,
                                         const double direction[3],
                                         const struct glint_pupil *whole, int k)
{
    const struct glint_openings openings = {
        .path = path,
        .direction = {direction[0], direction[1], direction[2]},
        .stop_mm = optics.stop_radius_mm,
        .field_mm = HUGE_VAL};
    const double wide = whole->x1_mm - whole->x0_mm, high = whole->y1_mm;
    struct glint_pupil p = *whole;
    struct glint_ray ray;

    p.mirrored = false;
    p.y0_mm = -high;
    p.x0_mm += k == 0 ? 0.2 * wide : 0;
    p.x1_mm -= k == 1 ? 0.2 * wide : 0;
    p.y0_mm += k == 2 ? 0.4 * high : 0;
    p.y1_mm -= k == 3 ? 0.4 * high : 0;
    assert_true(glint_spot_grow_pupil(&openings, &p));
    for (int j = -SCAN / 8; j <= SCAN / 8; j++)
        for (int i = 0; i <= SCAN / 4; i++) {
            const double x = whole->x0_mm + wide * i * 4 / SCAN;
            const double y = high * j * 8 / SCAN;

            if (ray_passes_all_openings(path, x, y, direction, &ray) &&
                (x < p.x0_mm || x > p.x1_mm || y < p.y0_mm || y > p.y1_mm))
                fail_msg("side %d: %g, %g mm is outside", k, x, y);
        }
}

TEST(shrunk_sides_grow_back)
{
    const double t = 12.74 * 3.14159265358979 / 180;
    const double direction[3] = {sin(t), 0, cos(t)};
    struct glint_pupil whole;
    struct glint_path path;

    load_fisheye_ghost_path(&path, 51, 550);
    assert_true(
        glint_pupil_find(&whole, &path, 12.74, optics.stop_radius_mm, NULL));
    for (int k = 0; k < 4; k++)
        check_shrunk_pupil_box_grows(&path, direction, &whole, k);
}
