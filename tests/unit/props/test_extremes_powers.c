/* SPDX-License-Identifier: MIT
 *
 * Tests extreme powers: from 1e-6 of white to a thousand suns, a power of
 * zero, and invalid numbers in files.
 */
#include <unistd.h>

#include "lamp_files/lamp_list.h"
#include "support/extreme.h"
#include "support/stage.h"
#include "support/test.h"

enum { W = 240, H = 160, N = 3 * W * H };

static struct stage heliar;
static float test[N], one[N];
static uint8_t codes[2][N];

TEST_OPEN
{
    assert_true(stage_open_lens(&heliar, "heliar-tronnier", W, H));
}

/* ------------------------------------------------------------- linear light */

/* Checks that linear images are proportional to the power of the lamp, at a
 * scale that is a power of two. For powers of two each image equals that of
 * power 1 bit by bit. For powers of ten, irradiance rounds to other steps of 1
 * %: pixels may deviate by half a step, their sum by 0.1 %. */
TEST(image_is_linear_in_power)
{
    const struct glint_lamp lamp = stage_make_lamp(7.5, 33, 1);
    double apart = 0, flux = 0, of_one;

    assert_true(stage_draw_linear(&heliar, &lamp, 1, one));
    of_one = stage_sum_image(&heliar, one);
    assert_true(of_one > 0);
    for (int k = -20; k <= 30; k += 5) {
        const struct glint_lamp other = stage_make_lamp(7.5, 33, exp2(k));

        assert_true(stage_draw_linear(&heliar, &other, 1, test));
        for (int i = 0; i < N; i++)
            apart =
                fmax(apart, fabs((double)test[i] * exp2(-k) - (double)one[i]));
    }
    for (int k = -6; k <= 9; k++) {
        const struct glint_lamp other = stage_make_lamp(7.5, 33, pow(10, k));

        assert_true(stage_draw_linear(&heliar, &other, 1, test));
        flux = fmax(
            flux,
            fabs(stage_sum_image(&heliar, test) / pow(10, k) / of_one - 1));
    }
    assert_at_most("powers: 2^-20 to 2^30 in linear light, bits", apart, 0, "");
    assert_at_most("powers: 1e-6 to 1e9 in linear light, flux", flux, 0.001,
                   "");
}

/* ------------------------------------------------------------- pixel codes */

/* Raises the power by factors of 4 (above 1e9 by 10 000), from below one code
 * to saturation. Checks that no sample becomes darker than the background or
 * than at the previous power; a sum that wraps would make it darker. The
 * brightest light must make every pixel that it reaches white. */
TEST(more_power_never_darkens_codes)
{
    uint64_t r = 5;
    int fallen = 0, white = 0, lit = 0;
    static uint8_t ground[N], last[N];

    for (int i = 0; i < N; i++)
        last[i] = ground[i] = (uint8_t)stage_random_bits(&r);
    for (double power = 1e-6; power < 1e31; power *= power < 1e9 ? 4 : 1e4) {
        const struct glint_lamp lamp = stage_make_lamp(7.5, 33, power);

        memcpy(codes[0], ground, N);
        assert_true(stage_draw_codes(&heliar, &lamp, 1, codes[0]));
        for (int i = 0; i < N; i++) {
            fallen += codes[0][i] < ground[i] || codes[0][i] < last[i];
            last[i] = codes[0][i];
        }
    }
    /* At the last power, 1e29, every pixel that light reaches is white, except
     * for pixels on edges. */
    for (int i = 0; i < N; i++) {
        lit += last[i] != ground[i];
        white += last[i] == 255 && ground[i] != 255;
    }
    print_message("%d of %d samples lit\n", lit, N);
    assert_true(lit > N / 4);
    assert_at_most("powers: 1e-6 to 1e30, codes that fell", fallen, 0,
                   "samples");
    assert_at_least("powers: 1e30, lit samples that are white",
                    (double)white / lit, 0.999, "");
}

/* Checks that a power of 0, 1e-300, below 0, NaN or infinite draws nothing,
 * alone or next to another light, as pixel codes and as linear light. */
TEST(invalid_powers_draw_nothing)
{
    const double none[] = {
        0, -1, -1e9, (double)NAN, (double)INFINITY, -(double)INFINITY, 1e-300};
    struct glint_lamp pair[2] = {stage_make_lamp(7.5, 33, 100)};
    int changed = 0;

    memset(codes[1], 0, N);
    assert_true(stage_draw_codes(&heliar, pair, 1, codes[1]));
    for (int k = 0; k < 7; k++) {
        pair[1] = stage_make_lamp(4, -80, none[k]);
        memset(codes[0], 0, N);
        assert_true(stage_draw_codes(&heliar, pair + 1, 1, codes[0]));
        for (int i = 0; i < N; i++)
            changed += codes[0][i] != 0;
        assert_true(stage_draw_codes(&heliar, pair, 2, codes[0]));
        for (int i = 0; i < N; i++)
            changed += codes[0][i] != codes[1][i];
        assert_true(stage_draw_linear(&heliar, pair + 1, 1, test));
        for (int i = 0; i < N; i++)
            changed += test[i] != 0;
    }
    assert_at_most("powers: 0, negative, NaN, infinite: samples changed",
                   changed, 0, "samples");
}

/* -------------------------------------------------------- files with lamps */

static enum glint_status read_lamp_list_text(const char *text,
                                             struct lamp_list *list,
                                             struct glint_error *error)
{
    char path[] = "/tmp/glint-powers-XXXXXX";
    const int fd = mkstemp(path);
    enum glint_status status;

    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, strlen(text)), (int)strlen(text));
    close(fd);
    status = lamp_list_read(list, path, error);
    remove(path);
    return status;
}

/* Checks that a file with a lamp power that cannot be drawn is rejected with
 * the line number. */
TEST(rejects_invalid_powers_in_files)
{
    static const char *const bad[] = {"nan",       "inf",   "-inf", "-1",
                                      "1e999",     "1e400", "",     "x",
                                      "0x10p9999", "1e31"};
    static const char *const good[] = {
        "0", "1e-6", "1e9", "1e30", "1e-320", "0.000000000000000001"};
    char text[200];
    struct lamp_list list;
    struct glint_error error;
    int wrong = 0;

    for (int k = 0; k < 10; k++)
        for (int json = 0; json < 2; json++) {
            snprintf(text, sizeof text,
                     json ? "{\"x\":1,\"y\":2,\"power\":1}\n"
                            "{\"x\":1,\"y\":2,\"power\":%s}\n"
                          : "0,1,2,1\n0,1,2,%s\n",
                     bad[k]);
            memset(&error, 0, sizeof error);
            if (read_lamp_list_text(text, &list, &error) == GLINT_OK) {
                print_message("taken: %s", text);
                lamp_list_free(&list);
                wrong++;
            } else if (!strstr(error.text, ":2: ")) {
                print_message("no line: %s\n", error.text);
                wrong++;
            }
        }
    for (int k = 0; k < 6; k++) {
        snprintf(text, sizeof text, "0,1,2,%s\n", good[k]);
        if (read_lamp_list_text(text, &list, &error) != GLINT_OK) {
            print_message("refused: %s: %s\n", text, error.text);
            wrong++;
        } else {
            wrong += !isfinite(list.row[0].power);
            lamp_list_free(&list);
        }
    }
    assert_at_most("powers: in files, wrongly taken or refused", wrong, 0,
                   "texts");
}

TEST_CLOSE
{
    stage_free(&heliar);
}
