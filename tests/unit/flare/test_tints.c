/* SPDX-License-Identifier: MIT
 *
 * Tests tints of ghosts: the light of a ghost is proportional to its gain and
 * tint, muted ghosts are not planned, and tints of 1 change no bit.
 */
#include "base/real.h"
#include "support/model_builder.h"
#include "support/models/frame_parts.h"
#include "support/test.h"

enum { WIDTH = 160, HEIGHT = 120, SAMPLES = 3 * WIDTH * HEIGHT, GHOSTS = 16 };

struct fixture {
    struct model_image m;
    struct glint_lens lens;
    struct glint_wave wave[2];
    struct glint_light light;
    struct glint_flare_frame rays;
    struct glint_flare_config cfg;
    struct glint_tint tint[GHOSTS];
    struct glint_flare_stats stats;
    int32_t px_q20[SAMPLES];
    double sum[3]; /* light of the image in R, G, B; display white x pixels */
};

static struct fixture *open_model_with_tints(void)
{
    struct fixture *f = test_free_later(calloc(1, sizeof *f));

    f->m = model_make_three_ghosts();
    f->lens = model_open_image(&f->m);
    assert_true(f->lens.header->n_ghosts <= GHOSTS);
    set_frame_wavelengths(f->wave);
    f->light = make_axial_light();
    f->rays = make_frame_rays(&f->lens, f->wave, 32);
    f->cfg = make_frame_config(WIDTH, HEIGHT, 5);
    f->cfg.max_bundles = 16;
    f->cfg.max_vertices = 40000;
    f->cfg.max_primitives = 20000;
    f->cfg.max_refs = 40000;
    for (int i = 0; i < GHOSTS; i++)
        f->tint[i] = (struct glint_tint){{16384, 16384, 16384}, real_of(1, 0)};
    return f;
}

static void draw_tinted_ghosts(struct fixture *f)
{
    struct glint_image image = {
        .format = GLINT_LINEAR_Q20, .width = WIDTH, .height = HEIGHT};
    const size_t bytes = glint_flare_bytes(&f->cfg);
    struct glint_flare *flare;

    memset(f->px_q20, 0, sizeof f->px_q20);
    memset(f->sum, 0, sizeof f->sum);
    glint_image_place(&image, f->px_q20);
    assert_ok(glint_flare_init(&flare, &f->cfg, test_allocate(bytes), bytes));
    glint_flare_plan(flare, &f->rays, &f->light, 1);
    glint_flare_bin(flare, &f->stats);
    glint_flare_draw(flare, &image);
    for (int i = 0; i < SAMPLES; i++)
        f->sum[i % 3] += f->px_q20[i] * 0x1p-20;
}

static void assert_relatively_near(double got, double want)
{
    assert_true(fabs(got - want) <= 1e-3 * fabs(want));
}

TEST(gains_of_1_change_no_bit)
{
    static int32_t plain[SAMPLES];
    struct fixture *f = open_model_with_tints();

    draw_tinted_ghosts(f);
    assert_true(f->sum[0] > 1);
    memcpy(plain, f->px_q20, sizeof plain);
    f->rays.tints = f->tint;
    draw_tinted_ghosts(f);
    assert_memory_equal(plain, f->px_q20, sizeof plain);
}

TEST(gain_and_tint_scale_the_light)
{
    struct fixture *f = open_model_with_tints();
    double plain[3];

    draw_tinted_ghosts(f);
    memcpy(plain, f->sum, sizeof plain);
    f->rays.tints = f->tint;
    for (int i = 0; i < GHOSTS; i++)
        f->tint[i] = (struct glint_tint){{8192, 32768, 0}, real_of(3, 0)};
    draw_tinted_ghosts(f);
    assert_relatively_near(f->sum[0], 1.5 * plain[0]);
    assert_relatively_near(f->sum[1], 6 * plain[1]);
    assert_true(f->sum[2] == 0);
}

/* Draws each ghost with all others muted. Checks that the sum of their light is
 * that of all ghosts, and that nothing is planned when all are muted. */
TEST(muted_ghosts_add_no_light)
{
    struct fixture *f = open_model_with_tints();
    const int n = (int)f->lens.header->n_ghosts;
    double all, left = 0;
    int bundles;

    draw_tinted_ghosts(f);
    all = f->sum[0];
    bundles = f->stats.bundles;
    f->rays.tints = f->tint;
    for (int ghost = 0; ghost < n; ghost++) {
        for (int i = 0; i < n; i++)
            f->tint[i].gain = real_of(i == ghost, 0);
        draw_tinted_ghosts(f);
        left += f->sum[0];
        assert_true(f->stats.bundles <= bundles);
    }
    assert_relatively_near(left, all);
    for (int i = 0; i < n; i++)
        f->tint[i].gain = real_of(0, 0);
    draw_tinted_ghosts(f);
    assert_int_equal(f->stats.bundles, 0);
    assert_true(f->sum[0] == 0);
}

/* Checks a ghost whose light is below one code: a gain makes it visible. */
TEST(gain_makes_a_faint_ghost_visible)
{
    struct fixture *f = open_model_with_tints();

    f->light.power = real_of(1, -30);
    f->rays.faintest = real_of(1, -10);
    draw_tinted_ghosts(f);
    assert_int_equal(f->stats.bundles, 0);
    f->rays.tints = f->tint;
    for (int i = 0; i < GHOSTS; i++)
        f->tint[i].gain = real_of(1, 40);
    draw_tinted_ghosts(f);
    assert_true(f->stats.bundles > 0);
}
