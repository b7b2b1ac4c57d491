/* SPDX-License-Identifier: MIT
 *
 * A baked stone: its integers beside the fit in doubles, bits, models and sizes
 * at their extremes, strips and rows by themselves, and files that are refused.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/blob.h"
#include "glint/kernels.h"
#include "linux/sets.h"
#include "scene/translucent/spread.h"
#include "support/models/stone_builder.h"
#include "support/rng.h"

static const enum glint_scatter_model models[] = {
    GLINT_SCATTER_CLUSTERED, GLINT_SCATTER_FACTORED, GLINT_SCATTER_ALBEDO};

/* Returns by how many decibels A and B, N each, differ; the peak is B's. */
static double psnr(const double *a, const double *b, size_t n)
{
    double square = 0, peak = 0;

    for (size_t i = 0; i < n; i++) {
        square += (a[i] - b[i]) * (a[i] - b[i]);
        peak = fmax(peak, fabs(b[i]));
    }
    return square > 0 ? 10 * log10(peak * peak * (double)n / square) : 999;
}

/* Returns how close the integers of B come to its fit, under lamps and shadows.
 */
static double close_by(const struct built_stone *b)
{
    const size_t n = 3 * (size_t)(b->fit.side * b->fit.side);
    double *light = calloc(3 * n, sizeof *light);
    double db;

    assert_non_null(light);
    glint_scatter_test_light(b->fit.side, light);
    glint_scatter_light(&b->fit, light, light + n);
    assert_int_equal(glint_stone_light(&b->stone, light, light + 2 * n),
                     GLINT_OK);
    for (size_t i = 0; i < n; i++)
        light[n + i] = fmax(light[n + i], 0);
    db = psnr(light + 2 * n, light + n, n);
    free(light);
    return db;
}

static void test_close_to_fit(void **state)
{
    (void)state;
    for (int m = 0; m < 3; m++) {
        struct built_stone b;
        double db;

        build_stone(&b, models[m], 128, 29, .9);
        db = close_by(&b);
        print_message("model %d: %.1f dB, taps of %d bits, ranks lose %.4f\n",
                      m, db, b.report.tap_bits, b.report.kernel_loss);
        assert_true(db > 45);
        free_stone(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_close_to_fit),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
