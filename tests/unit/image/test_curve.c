/* SPDX-License-Identifier: MIT
 *
 * Compares transfer curves, and the codes after adding light, with results
 * computed by libm, and colour matrices with the colours in the standards.
 */
#include "image/curve.h"

#include "kernels/kernels.h"
#include "image/mix.h"
#include "support/test.h"

static const enum glint_tone transfers[2] = {GLINT_TONE_SRGB, GLINT_TONE_BT709};

/* Returns the linear light of code value V, both 0 .. 1, by IEC 61966-2-1 or
 * the inverse of ITU-R BT.709. */
static double decode_value(enum glint_tone transfer, double v)
{
    if (transfer == GLINT_TONE_SRGB)
        return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    return v < 0.081 ? v / 4.5 : pow((v + 0.099) / 1.099, 1 / 0.45);
}

static double encode_light(enum glint_tone transfer, double light)
{
    if (transfer == GLINT_TONE_SRGB)
        return light <= 0.04045 / 12.92 ? 12.92 * light
                                        : 1.055 * pow(light, 1 / 2.4) - 0.055;
    return light < 0.018 ? 4.5 * light : 1.099 * pow(light, 0.45) - 0.099;
}

TEST(codes_match_hand_computation)
{
    struct glint_curve curve;

    glint_curve_init(&curve, GLINT_TONE_SRGB);
    assert_int_equal(curve.decode_q20[0], 0);
    /* code 10: 10 / 255 / 12.92 */
    assert_int_equal(curve.decode_q20[10], 3183);
    assert_int_equal(curve.decode_q20[128], 226346); /* 0.2158605 */
    assert_int_equal(curve.decode_q20[255], 1 << 20);
    glint_curve_init(&curve, GLINT_TONE_BT709);
    assert_int_equal(curve.decode_q20[0], 0);
    /* BT.709 code 20 is 20 / 255 / 4.5 in linear light. */
    assert_int_equal(curve.decode_q20[20], 18276);
    assert_int_equal(curve.decode_q20[255], 1 << 20);
}

TEST(decoding_matches_the_standards)
{
    for (int t = 0; t < 2; t++) {
        struct glint_curve curve;

        glint_curve_init(&curve, transfers[t]);
        for (int i = 0; i < 256; i++) {
            const double want = decode_value(transfers[t], i / 255.0) * 0x1p20;

            assert_true(fabs(curve.decode_q20[i] - want) <= 0.51);
            assert_true(i == 0 ||
                        curve.decode_q20[i] - curve.decode_q20[i - 1] >= 318);
        }
    }
}

TEST(decoding_is_monotone)
{
    for (int t = 0; t < 2; t++) {
        struct glint_curve curve;

        glint_curve_init(&curve, transfers[t]);
        for (int32_t v = 0; v < CODE_WHITE_Q7; v++)
            assert_true(curve_decode_to_light(&curve, v) <
                        curve_decode_to_light(&curve, v + 1));
    }
}

/* Errors of codes after light was added to each code, against exact results
 * that are not rounded. */
struct errors {
    double worst, squares;
    int n;
};

static struct errors measure_curve_errors(enum glint_tone transfer)
{
    const int16_t round[8] = {64, 64, 64, 64, 64, 64, 64, 64};
    struct errors e = {0, 0, 0};

    for (int code = 0; code < 256; code++)
        for (int first = 1; first < 65536; first += 7 * GLINT_LANES) {
            uint8_t lit[GLINT_LANES];
            uint16_t light[GLINT_LANES];

            for (int i = 0; i < GLINT_LANES; i++) {
                light[i] = (uint16_t)(first + i < 65535 ? first + i : 65535);
                lit[i] = (uint8_t)code;
            }
            glint_add_code_c(lit, light, GLINT_LANES,
                             glint_get_tone_constants(transfer), round);
            for (int i = 0; i < GLINT_LANES; i++) {
                const double sum =
                    decode_value(transfer, code / 255.0) + light[i] / 65535.0;
                const double want = 255 * encode_light(transfer, fmin(1, sum));
                const double error = fabs(lit[i] - want);

                e.worst = fmax(e.worst, error);
                if (sum < 1) {
                    e.squares += error * error;
                    e.n++;
                }
            }
        }
    return e;
}

/* Checks that codes after adding light are right within 0.62 code, and within
 * 0.3 code RMS; rounding alone causes 0.5 and 0.289. */
TEST(added_light_is_within_rounding)
{
    for (int t = 0; t < 2; t++) {
        const struct errors e = measure_curve_errors(transfers[t]);
        const double rms = sqrt(e.squares / e.n);

        print_message("codes under light are within %.3f, %.4f RMS\n", e.worst,
                      rms);
        assert_true(e.worst <= 0.62);
        assert_true(rms <= 0.3);
    }
}

static void assert_ycc_gives_rgb(const struct glint_ycc *ycc, int y, int cb,
                                 int cr, int r, int g, int b, int within)
{
    int32_t rgb_q7[3];

    convert_ycc_to_rgb(ycc, y, cb, cr, rgb_q7);
    assert_true(abs(rgb_q7[0] - r * 128) <= within);
    assert_true(abs(rgb_q7[1] - g * 128) <= within);
    assert_true(abs(rgb_q7[2] - b * 128) <= within);
}

/* Checks the conversion of the 100 % colour bars of the standards. Their
 * published codes are rounded, so 1.5 codes are allowed. */
TEST(colour_bars_convert_within_rounding)
{
    struct glint_ycc ycc;

    glint_ycc_init(&ycc, GLINT_MATRIX_BT601, GLINT_RANGE_LIMITED);
    assert_ycc_gives_rgb(&ycc, 16, 128, 128, 0, 0, 0, 0);
    assert_ycc_gives_rgb(&ycc, 235, 128, 128, 255, 255, 255, 0);
    assert_ycc_gives_rgb(&ycc, 81, 90, 240, 255, 0, 0, 192);
    assert_ycc_gives_rgb(&ycc, 145, 54, 34, 0, 255, 0, 192);
    assert_ycc_gives_rgb(&ycc, 41, 240, 110, 0, 0, 255, 192);
    glint_ycc_init(&ycc, GLINT_MATRIX_BT709, GLINT_RANGE_LIMITED);
    assert_ycc_gives_rgb(&ycc, 235, 128, 128, 255, 255, 255, 0);
    assert_ycc_gives_rgb(&ycc, 63, 102, 240, 255, 0, 0, 192);
    assert_ycc_gives_rgb(&ycc, 173, 42, 26, 0, 255, 0, 192);
    assert_ycc_gives_rgb(&ycc, 32, 240, 118, 0, 0, 255, 192);
    glint_ycc_init(&ycc, GLINT_MATRIX_BT601, GLINT_RANGE_FULL);
    assert_ycc_gives_rgb(&ycc, 0, 128, 128, 0, 0, 0, 0);
    assert_ycc_gives_rgb(&ycc, 255, 128, 128, 255, 255, 255, 0);
    assert_ycc_gives_rgb(&ycc, 76, 85, 255, 255, 0, 0, 192);
}

/* Checks that the rows of the matrices sum to Y_Q15 for luma and to 0 for
 * chroma, and that the product of both matrices is 1. */
static void check_matrices_are_inverse(const struct glint_ycc *ycc, int y_q15)
{
    for (int i = 0; i < 3; i++) {
        const int32_t *row = ycc->to_ycc_q15[i];

        assert_int_equal(row[0] + row[1] + row[2], i == 0 ? y_q15 : 0);
        for (int j = 0; j < 3; j++) {
            double sum = 0;

            for (int k = 0; k < 3; k++)
                sum += row[k] * 0x1p-15 * ycc->to_rgb_q16[k][j] * 0x1p-16;
            assert_true(fabs(sum - (i == j)) < 1e-4);
        }
    }
}

TEST(ycc_matrices_are_inverse)
{
    struct glint_ycc ycc;

    for (int m = 0; m < 2; m++) {
        const enum glint_matrix matrix =
            m ? GLINT_MATRIX_BT709 : GLINT_MATRIX_BT601;

        glint_ycc_init(&ycc, matrix, GLINT_RANGE_FULL);
        check_matrices_are_inverse(&ycc, 1 << 15);
        glint_ycc_init(&ycc, matrix, GLINT_RANGE_LIMITED);
        check_matrices_are_inverse(&ycc, 28142); /* 219 / 255 */
    }
}
