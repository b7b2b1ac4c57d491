/* SPDX-License-Identifier: MIT
 *
 * Tests a ghost that is baked together with the same ghost at a nearby zoom
 * position. Its ranges of angles and pupil boxes must contain the light that is
 * visible at either position. Its model must contain the barrel apertures that
 * clip at either position.
 */
#include "bake/fit/zone_rays.h"
#include "bake/visible/visible.h"
#include "engine/setup/degrees.h"
#include "glint/transfer.h"
#include "support/lens_check.h"

static struct glint_error error;

enum {
    MAX_DEG = 9,
    GHOSTS = 7,
    CUT = 3,  /* index of a ghost that has no light above 7 degrees */
    UNCUT = 2 /* index of a ghost that no barrel aperture clips */
};

/* A zoom lens whose second group moves by 12 mm with its barrel apertures. The
 * first column is the position at the end of the zoom. */
static const char table[] = "name t\n"
                            "f-number 8\n"
                            "film 24 16\n"
                            "surface  60    4    11  1.52 60\n"
                            "surface -200   2/14 11  air\n"
                            "surface -80    2     7  1.62 36\n"
                            "surface  70   14/2   7  air\n"
                            "stop      4    6\n"
                            "surface   90   4     9  1.62 36\n"
                            "surface  -60  60     9  air\n";

static const double band_nm[2] = {400, 700};
static struct glint_prescription at[2];
static struct glint_setup setup[2];
static struct glint_visible alone[2], both[2];

TEST_OPEN
{
    static struct glint_prescription lens;
    static const double rgb_nm[] = {650, 532, 450};

    parse_lens_text(&lens, table);
    for (int k = 0; k < 2; k++) {
        set_lens_at_position(&at[k], &lens, 1 - k);
        assert_ok(glint_setup_init(&setup[k], &at[k], 0, 0, rgb_nm, 3, &error));
    }
    assert_int_equal(setup[0].n_ghosts, GHOSTS);
}

static void set_ghost_of_both_setups(int ghost)
{
    for (int k = 0; k < 2; k++)
        glint_visible_init(&alone[k], &setup[k], ghost, 16, band_nm);
    both[0] = alone[0];
    both[1] = alone[1];
    both[0].beside = &both[1];
    both[0].n_beside = 1;
}

static bool is_in_a_range(double (*range)[2], int n, double lo, double hi)
{
    for (int k = 0; k < n; k++)
        if (range[k][0] <= lo && hi <= range[k][1])
            return true;
    return false;
}

/* Checks that common ranges of angles cover every range of both positions, and
 * that they begin and end where a range of one position does. */
TEST(ranges_cover_those_of_both_positions)
{
    int wider = 0;

    for (int g = 1; g < 4; g++) {
        double of[3][GLINT_MAX_RANGES][2], last = -1;
        int n[3];

        set_ghost_of_both_setups(g);
        n[2] = glint_visible_find_ranges(&both[0], MAX_DEG, of[2]);
        for (int k = 0; k < 2; k++) {
            n[k] = glint_visible_find_ranges(&alone[k], MAX_DEG, of[k]);
            for (int i = 0; i < n[k]; i++)
                assert_true(
                    is_in_a_range(of[2], n[2], of[k][i][0], of[k][i][1]));
        }
        wider +=
            n[2] > 0 && !is_in_a_range(of[0], n[0], of[2][0][0], of[2][0][1]);
        for (int i = 0; i < n[2]; i++) {
            int begins = 0, ends = 0;

            assert_true(of[2][i][0] > last && of[2][i][1] > of[2][i][0]);
            last = of[2][i][1];
            for (int k = 0; k < 2; k++)
                for (int j = 0; j < n[k]; j++) {
                    begins += of[k][j][0] == of[2][i][0];
                    ends += of[k][j][1] == of[2][i][1];
                }
            assert_true(begins > 0 && ends > 0);
        }
    }
    assert_true(wider > 0);
}

/* Checks that adjacent ranges of angles are joined, and that ranges are
 * sorted. */
TEST(touching_ranges_are_joined)
{
    static const struct {
        double more[2], range[3][2];
        int n;
    } is[] = {{{0.0, 0.1}, {{0, 0.1}, {0.2, 0.3}, {0.6, 0.7}}, 3},
              {{0.4, 0.5}, {{0.2, 0.3}, {0.4, 0.5}, {0.6, 0.7}}, 3},
              {{0.8, 0.9}, {{0.2, 0.3}, {0.6, 0.7}, {0.8, 0.9}}, 3},
              {{0.1, 0.2}, {{0.1, 0.3}, {0.6, 0.7}}, 2},
              {{0.25, 0.4}, {{0.2, 0.4}, {0.6, 0.7}}, 2},
              {{0.65, 0.66}, {{0.2, 0.3}, {0.6, 0.7}}, 2},
              {{0.5, 0.9}, {{0.2, 0.3}, {0.5, 0.9}}, 2},
              {{0.25, 0.65}, {{0.2, 0.7}}, 1}};
    double full[GLINT_MAX_RANGES][2];

    for (size_t k = 0; k < sizeof is / sizeof *is; k++) {
        double range[GLINT_MAX_RANGES][2] = {{0.2, 0.3}, {0.6, 0.7}};

        assert_int_equal(glint_visible_add_range(range, 2, is[k].more),
                         is[k].n);
        assert_memory_equal(range, is[k].range,
                            (size_t)is[k].n * sizeof *range);
    }
    for (int k = 0; k < GLINT_MAX_RANGES; k++) {
        full[k][0] = 0.1 * k + 0.05;
        full[k][1] = 0.1 * k + 0.1;
    }
    assert_int_equal(glint_visible_add_range(full, GLINT_MAX_RANGES,
                                             (const double[2]){0, 0.01}),
                     GLINT_MAX_RANGES);
    assert_true(full[0][0] == 0.05);
    assert_int_equal(glint_visible_add_range(full, GLINT_MAX_RANGES,
                                             (const double[2]){0, 0.06}),
                     GLINT_MAX_RANGES);
    assert_true(full[0][0] == 0 && full[0][1] == 0.1);
}

/* Returns the index of the ray in RAYS that has the position of ray I of OF, or
 * -1 if there is none. */
static int find_ray_at_position(const struct glint_zone_rays *rays,
                                const struct glint_zone_rays *of, int i)
{
    for (int k = 0; k < rays->n; k++)
        if (rays->x[GLINT_U][k] == of->x[GLINT_U][i] &&
            rays->x[GLINT_V][k] == of->x[GLINT_V][i] &&
            rays->x[GLINT_S][k] == of->x[GLINT_S][i] &&
            rays->x[GLINT_W][k] == of->x[GLINT_W][i])
            return k;
    return -1;
}

static double compute_ray_margin(const struct glint_zone_rays *rays, int i)
{
    return fmax(rays->at[RAY_EXCESS][i], rays->at[RAY_FIELD][i]);
}

/* Checks rays that are traced for both positions: they land where they do at a
 * single position. Their distance outside the rims is the smaller of the
 * two. */
TEST(rays_land_as_at_a_single_position)
{
    static struct glint_visible_profile profile;
    static struct glint_zone_rays of[3];
    const double range[2] = {0, glint_sin_deg(4)};
    struct glint_zone zone;
    int own = 0, beside = 0;

    set_ghost_of_both_setups(CUT);
    glint_visible_find_profile(&both[0], range, &profile);
    glint_zone_init(&zone, &profile, range[0], range[1], false);
    for (int k = 0; k < 3; k++)
        glint_zone_trace_rays(&zone, k < 2 ? &alone[k] : &both[0], &of[k]);
    for (int i = 0; i < of[2].n; i++) {
        const int a = find_ray_at_position(&of[0], &of[2], i);
        const int b = find_ray_at_position(&of[1], &of[2], i);

        if (a < 0 || b < 0)
            continue;
        assert_true(of[2].at[RAY_SENSOR_X][i] == of[0].at[RAY_SENSOR_X][a]);
        if (compute_ray_margin(&of[0], a) < compute_ray_margin(&of[1], b)) {
            assert_true(of[2].at[RAY_EXCESS][i] == of[0].at[RAY_EXCESS][a] &&
                        of[2].at[RAY_FIELD][i] == of[0].at[RAY_FIELD][a]);
            own++;
        } else {
            assert_true(of[2].at[RAY_EXCESS][i] == of[1].at[RAY_EXCESS][b] &&
                        of[2].at[RAY_FIELD][i] == of[1].at[RAY_FIELD][b]);
            beside++;
        }
    }
    assert_true(own > 100 && beside > 100);
}

/* Checks that the pupil box for both positions contains the box of each, and is
 * no wider than both together. */
TEST(boxes_contain_those_of_both_positions)
{
    static struct glint_visible_profile of[3];
    const double range[2] = {0, glint_sin_deg(4)};
    int moved = 0;

    for (int g = 1; g < 4; g++) {
        set_ghost_of_both_setups(g);
        for (int k = 0; k < 2; k++)
            glint_visible_find_profile(&alone[k], range, &of[k]);
        glint_visible_find_profile(&both[0], range, &of[2]);
        if (of[0].n < GLINT_PROFILE || of[1].n < GLINT_PROFILE)
            continue;
        assert_int_equal(of[2].n, GLINT_PROFILE);
        for (int i = 0; i < GLINT_PROFILE; i++) {
            struct glint_pupil box = of[0].box[i];

            glint_visible_join_boxes(&box, &of[1].box[i]);
            assert_true(box.x0_mm == of[2].box[i].x0_mm &&
                        box.x1_mm == of[2].box[i].x1_mm &&
                        box.y1_mm == of[2].box[i].y1_mm);
            moved += box.x0_mm != of[0].box[i].x0_mm;
        }
    }
    assert_true(moved > 0);
}

/* Returns the number of green rays that pass GHOST at DEGREES in the model
 * DATA, or -1 if the model has no polynomials there. */
static int count_passing_green_rays(const unsigned char *data, size_t bytes,
                                    int ghost, double degrees)
{
    enum { ACROSS = 40 };
    struct glint_transfer t;
    struct glint_lens lens;
    const char *reason = "";
    int n = 0;

    if (glint_lens_open(&lens, data, bytes, &reason) != GLINT_OK)
        fail_msg("%s", reason);
    if (!glint_transfer_init(&t, &lens, ghost,
                             (int32_t)lrint(glint_sin_deg(degrees) * 0x1p30),
                             (int32_t)lrint(0x1p24 / (0.532 * 0.532))))
        return -1;
    for (int j = -ACROSS; j <= ACROSS; j++)
        for (int i = -ACROSS; i <= ACROSS; i++) {
            struct glint_outputs o;
            bool passes;

            glint_transfer_ray(&t, (int32_t)lrint((double)i / ACROSS * 0x1p30),
                               (int32_t)lrint((double)j / ACROSS * 0x1p30), &o);
            passes = hypot(ldexp(o.at[GLINT_OUT_STOP_X],
                                 t.exponent[GLINT_OUT_STOP_X]),
                           ldexp(o.at[GLINT_OUT_STOP_Y],
                                 t.exponent[GLINT_OUT_STOP_Y])) <= 1;
            for (int k = GLINT_OUT_BARREL_0; k < GLINT_OUT_KINDS; k++)
                passes &=
                    !(t.outputs >> k & 1) || ldexp(o.at[k], t.exponent[k]) <= 1;
            n += passes;
        }
    return n;
}

/* Checks that the model contains a barrel aperture that clips only at the other
 * position: the rear one, which is a fifth as wide there. */
TEST(barrel_of_the_other_position_is_chosen)
{
    static const double rgb_nm[] = {650, 532, 450};
    static struct glint_setup narrower;
    static struct glint_visible_profile profile;
    static glint_zone_sampling sampling;
    static struct glint_zone_rays rays;
    const double range[2] = {0, glint_sin_deg(4)};
    struct glint_prescription lens = at[0];
    struct glint_zone zone;
    int n[2];

    set_ghost_of_both_setups(UNCUT);
    lens.surface[lens.n_surfaces - 1].semi_mm *= 0.2;
    if (glint_setup_init(&narrower, &lens, 0, 0, rgb_nm, 3, &error) != GLINT_OK)
        fail_msg("%s", error.text);
    glint_visible_init(&both[1], &narrower, UNCUT, 16, band_nm);
    glint_visible_find_profile(&both[0], range, &profile);
    glint_zone_init(&zone, &profile, range[0], range[1], false);
    for (int k = 0; k < 2; k++) {
        glint_zone_choose_barrels(&zone, k ? &both[0] : &alone[0], 0.01,
                                  &sampling, &rays);
        n[k] = rays.n_barrels;
    }
    assert_int_equal(n[0], 0);
    assert_int_equal(n[1], 1);
}

/* Checks a ghost that is visible only at the other zoom position. A model baked
 * together with that position must have polynomials for the ghost, whose barrel
 * apertures must block all light at the model's own position. */
TEST(ghost_visible_at_the_other_position_is_baked)
{
    const bool ghosts[GHOSTS] = {[CUT] = true};
    struct glint_bake_options options;
    struct glint_bake_report report;
    unsigned char *data[3];
    size_t bytes[3];

    glint_bake_defaults(&options);
    options.max_deg = MAX_DEG;
    options.ghosts = ghosts;
    options.beside = &at[1];
    for (int k = 0; k < 3; k++) {
        options.n_beside = k == 2;
        if (glint_bake(&at[k % 2], &options, &data[k], &bytes[k], &report,
                       &error) != GLINT_OK)
            fail_msg("%s", error.text);
    }
    assert_int_equal(count_passing_green_rays(data[0], bytes[0], CUT, 8.5), -1);
    assert_true(count_passing_green_rays(data[1], bytes[1], CUT, 8.5) > 3000);
    assert_in_range(count_passing_green_rays(data[2], bytes[2], CUT, 8.5), 0,
                    3);
    assert_true(count_passing_green_rays(data[2], bytes[2], CUT, 2.5) > 1000);
    for (int k = 0; k < 3; k++)
        free(data[k]);
}

TEST(rejects_a_different_lens)
{
    struct glint_prescription other = at[1];
    struct glint_bake_options options;
    struct glint_bake_report report;
    unsigned char *data = NULL;
    size_t bytes;

    glint_bake_defaults(&options);
    other.n_surfaces -= 2;
    options.beside = &other;
    options.n_beside = 1;
    assert_int_equal(
        glint_bake(&at[0], &options, &data, &bytes, &report, &error),
        GLINT_E_ARGUMENT);
    assert_true(error.text[0] != 0 && !data);
    options.beside = NULL;
    assert_int_equal(
        glint_bake(&at[0], &options, &data, &bytes, &report, &error),
        GLINT_E_ARGUMENT);
}
