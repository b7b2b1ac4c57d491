/* SPDX-License-Identifier: MIT
 *
 * Tests dim ghosts, which are drawn with the rays of one wavelength. Their
 * total light is preserved, none appears abruptly, and the image depends
 * neither on earlier frames nor on the number of workers.
 */
#include "support/shuffle.h"
#include "support/stage.h"
#include "support/test.h"

enum { W = 240, H = 160, BYTES = 3 * W * H, LIGHTS = 16 };

static struct stage stage;
static struct glint_lamp lamps[LIGHTS];
static uint8_t plain[BYTES], dim[BYTES], last[2][BYTES];

/* Sets one bright lamp and fainter ones, down to seven octaves below it, at
 * positions that depend on TIME. */
static void set_bright_and_faint_lamps(double time)
{
    for (int i = 0; i < LIGHTS; i++)
        lamps[i] = stage_make_lamp(3 + 1.1 * i + time, 50 * i + 3 * time,
                                   3e5 * exp2(-0.45 * i));
}

static void draw_lamps_image(double codes, uint8_t *picture)
{
    stage.frame.dials = glint_dials_at(1 << 13);
    stage.frame.dials.dim_codes = codes;
    memset(picture, 0, BYTES);
    assert_true(stage_draw_codes(&stage, lamps, LIGHTS, picture));
}

TEST_OPEN
{
    assert_true(stage_open_lens(&stage, "double-gauss-angenieux", W, H));
}

TEST_CLOSE
{
    stage_free(&stage);
}

static double sum_image_codes(const uint8_t *picture)
{
    double sum = 0;

    for (int i = 0; i < BYTES; i++)
        sum += picture[i];
    return sum;
}

static double compute_psnr(const uint8_t *a, const uint8_t *b)
{
    double sum = 0;

    for (int i = 0; i < BYTES; i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return 10 * log10(255. * 255 * BYTES / fmax(sum, 1));
}

/* Checks that larger values of dim_codes draw fewer ray bundles, and change the
 * image more against dim_codes 0, where each ghost has three wavelengths of its
 * own. The PSNR must stay above 40 dB, and the sum of codes within 1 %. */
TEST(larger_dim_codes_draw_fewer_bundles)
{
    int bundles;
    double before = 99;

    set_bright_and_faint_lamps(0);
    draw_lamps_image(0, plain);
    bundles = stage.drawn.stats.bundles;
    for (double codes = 0.5; codes <= 8; codes *= 4) {
        draw_lamps_image(codes, dim);
        assert_true(stage.drawn.stats.bundles < bundles);
        assert_true(fabs(sum_image_codes(dim) / sum_image_codes(plain) - 1) <
                    0.01);
        assert_true(compute_psnr(plain, dim) > 40);
        assert_true(compute_psnr(plain, dim) <= before);
        bundles = stage.drawn.stats.bundles;
        before = compute_psnr(plain, dim);
    }
}

/* Checks, while lights move for 300 frames, that dim ghosts increase the
 * largest change of the mean of 8 x 8 pixels per frame by less than half a
 * code. */
TEST(dim_ghosts_do_not_jump_in_motion)
{
    double worst[2] = {0, 0};

    for (int frame = 0; frame < 300; frame++) {
        set_bright_and_faint_lamps(0.01 * frame);
        for (int k = 0; k < 2; k++) {
            uint8_t *now = k ? dim : plain;

            draw_lamps_image(k ? 4 : 0, now);
            if (frame) {
                const double jump =
                    stage_max_block_difference(&stage, last[k], now);

                worst[k] = fmax(worst[k], jump);
            }
            memcpy(last[k], now, BYTES);
        }
    }
    print_message("block jumps: %.2f codes, with dim ghosts %.2f\n", worst[0],
                  worst[1]);
    assert_true(worst[1] < worst[0] + 0.5);
}

/* Sets four groups of four lamps, each group within a degree, at positions that
 * depend on TIME. Their powers have 3 % of random noise. */
static void set_lamp_groups(double time, uint64_t *noise)
{
    for (int i = 0; i < LIGHTS; i++)
        lamps[i] = stage_make_lamp(4 + 4 * (i / 4) + 0.2 * (i % 4) + time,
                                   90 * (i / 4) + 3 * (i % 4) + 3 * time,
                                   5e3 * exp2(-(i % 4)) *
                                       stage_random_uniform(noise, 0.97, 1.03));
}

/* Returns the total light of a linear image with the quality parameter
 * dim_codes set to CODES. Ghosts are planned as for an image of pixel codes,
 * but none is faint enough to be dropped. */
static double sum_image_light(double codes)
{
    static int32_t light_q20[3 * W * H];
    struct glint_image image =
        glint_image_over(light_q20, GLINT_LINEAR_Q20, W, H);
    double sum = 0;

    stage.frame.dials.dim_codes = codes;
    stage.frame.dials.cull_codes = 1e-3;
    stage.frame.picture.for_codes = true;
    memset(light_q20, 0, sizeof light_q20);
    assert_ok(
        glint_frame_draw(&stage.frame, lamps, LIGHTS, 1, &image, &stage.drawn));
    stage.frame.picture.for_codes = false;
    for (int i = 0; i < 3 * W * H; i++)
        sum += light_q20[i];
    return sum;
}

/* Checks that dim ghosts of neighbouring lights are merged. This must save more
 * than half of the ray bundles and preserve the total light within 6 %. Per
 * frame, the mean of 8 x 8 pixels may change by at most half a code more than
 * with separate ghosts. The frame statistics must agree. */
TEST(dim_ghosts_of_near_lights_are_merged)
{
    struct glint_account account;
    double worst[2] = {0, 0};
    int of[GLINT_OUTCOMES] = {0}, bundles[2];
    uint64_t noise = 1;

    for (int frame = 0; frame < 300; frame++) {
        set_lamp_groups(0.01 * frame, &noise);
        for (int k = 0; k < 2; k++) {
            uint8_t *now = k ? dim : plain;

            draw_lamps_image(k ? 4 : 0, now);
            bundles[k] = stage.drawn.stats.bundles;
            if (frame) {
                const double jump =
                    stage_max_block_difference(&stage, last[k], now);

                worst[k] = fmax(worst[k], jump);
            }
            memcpy(last[k], now, BYTES);
        }
        assert_true(2 * bundles[1] < bundles[0]);
        assert_true(compute_psnr(plain, dim) > 50);
        if (frame % 100 == 0)
            assert_true(fabs(sum_image_light(4) / sum_image_light(0) - 1) <
                        0.06);
    }
    print_message("of groups: %.2f codes, with dim ghosts %.2f\n", worst[0],
                  worst[1]);
    assert_true(worst[1] < worst[0] + 0.5);
    for (int light = 0; light < LIGHTS; light++)
        for (int ghost = 0; ghost < stage.of_model.n_ghosts; ghost++)
            for (int wave = 0; wave < 3; wave++) {
                glint_flare_account(stage.frame.memory.flare, ghost, light,
                                    wave, &account);
                of[account.outcome]++;
            }
    assert_int_equal(of[GLINT_OUTCOME_DRAWN] + of[GLINT_OUTCOME_EMPTY],
                     bundles[1]);
    assert_true(of[GLINT_OUTCOME_SHARED] > bundles[1] / 4);
}

/* Checks that an image is bit-identical with 1, 3 and 5 workers, and after
 * another frame. */
TEST(image_is_bit_identical_for_all_workers)
{
    struct shuffle shuffle;

    set_bright_and_faint_lamps(1.5);
    draw_lamps_image(4, plain);
    for (int n = 1; n <= 5; n += 2) {
        stage_set_view(&stage, W, H, 0);
        init_shuffled_workers(&shuffle, n, 7);
        stage.frame.cfg.workers = &shuffle.workers;
        if (n > 1) {
            set_bright_and_faint_lamps(0.7);
            draw_lamps_image(4, dim);
        }
        set_bright_and_faint_lamps(1.5);
        draw_lamps_image(4, dim);
        assert_memory_equal(plain, dim, BYTES);
        stage.frame.cfg.workers = NULL;
    }
}
