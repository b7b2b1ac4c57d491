/* SPDX-License-Identifier: MIT
 *
 * A baked translucent medium: its integers beside the fit in doubles, and files
 * that are refused.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/blob.h"
#include "glint/kernels.h"
#include "linux/sets.h"
#include "scene/translucent/spread.h"
#include "support/models/stone_builder.h"
#include "support/models/psnr.h"
#include "support/rng.h"
#include "support/test.h"

static const enum glint_scatter_model models[] = {
    GLINT_SCATTER_CLUSTERED, GLINT_SCATTER_FACTORED, GLINT_SCATTER_ALBEDO};

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
    assert_ok(glint_stone_light(&b->stone, light, light + 2 * n));
    for (size_t i = 0; i < n; i++)
        light[n + i] = fmax(light[n + i], 0);
    db = peak_psnr(light + 2 * n, light + n, n);
    free(light);
    return db;
}

TEST(close_to_fit)
{
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

/* Bakes B again, of RANK; returns how close it comes then. */
static double close_of_rank(struct built_stone *b, int rank)
{
    struct glint_error error;
    const char *reason;

    free(b->data);
    b->data = NULL;
    b->text.fit.rank = rank;
    assert_ok(glint_stone_bake(&b->fit, &b->text, "test", 7, &b->data,
                               &b->bytes, &b->report, &error));
    assert_ok(glint_translucent_open(&b->stone, b->data, b->bytes, &reason));
    return close_by(b);
}

/* Two products are as good as four where light changes slowly: the largest
 * singular values of entries alone have 51 dB, and 37 by one. */
TEST(ranks)
{
    for (int m = 0; m < 3; m += 2) {
        struct built_stone b;
        double db[2];

        build_stone(&b, models[m], 128, 29, .9);
        db[0] = close_of_rank(&b, 2);
        db[1] = close_of_rank(&b, 1);
        print_message("model %d: rank 2 %.1f dB, rank 1 %.1f\n", m, db[0],
                      db[1]);
        assert_true(db[0] > 60 && db[1] > 45 && db[1] < db[0]);
        free_stone(&b);
    }
}

/* ---------------------------------------------------------------- refusals */

/* What is done to the words of a whole translucent medium, before its checksum
 * is set. */
typedef void damage_fn(struct glint_translucent_header *h, unsigned char *data);

static int16_t *taps_of(const struct glint_translucent_header *h,
                        unsigned char *data)
{
    return (int16_t *)(void *)(data + h->tap_at);
}

/* Each tap has the bits that it may have; the sum is too large. */
static void widen_column(struct glint_translucent_header *h,
                         unsigned char *data)
{
    for (uint32_t k = 0; k < h->kernel * h->rank * h->n_planes; k++)
        taps_of(h,
                data)[(2 * (k / h->kernel) + 1) * h->kernel + k % h->kernel] =
            k % 2 ? 2047 : -2047;
}

static void widen_row(struct glint_translucent_header *h, unsigned char *data)
{
    for (uint32_t k = 0; k < h->kernel; k++)
        taps_of(h, data)[k] = k % 2 ? 2047 : -2047;
}

static void lose_shift(struct glint_translucent_header *h, unsigned char *data)
{
    uint32_t *shift = (uint32_t *)(void *)(data + h->shift_at);

    shift[0]--;
}

static void raise_shift(struct glint_translucent_header *h, unsigned char *data)
{
    uint32_t *shift = (uint32_t *)(void *)(data + h->shift_at);

    shift[3 * h->n_planes * h->rank - 1] = 17;
}

static void raise_tap(struct glint_translucent_header *h, unsigned char *data)
{
    taps_of(h, data)[0] = -32768;
}

static void raise_cluster(struct glint_translucent_header *h,
                          unsigned char *data)
{
    data[h->cluster_at + 100] = (unsigned char)h->n_planes;
}

static void raise_transmittance(struct glint_translucent_header *h,
                                unsigned char *data)
{
    uint16_t *table = (uint16_t *)(void *)(data + h->transmit_at);

    table[GLINT_TRANSLUCENT_COSINES] = 32769;
}

static void raise_gain(struct glint_translucent_header *h, unsigned char *data)
{
    (void)data;
    h->gain[2] = (struct glint_real){1 << 30, -30};
}

static void raise_planes(struct glint_translucent_header *h,
                         unsigned char *data)
{
    (void)data;
    h->n_planes = GLINT_TRANSLUCENT_MOST_PLANES + 1;
}

static void make_even(struct glint_translucent_header *h, unsigned char *data)
{
    (void)data;
    h->kernel--;
}

static void move_taps(struct glint_translucent_header *h, unsigned char *data)
{
    (void)data;
    h->tap_at = h->bytes - 4;
}

/* Every sum that the loops rely on is looked at, as are their places. */
TEST(refused)
{
    static const struct {
        damage_fn *damage;
        const char *reason;
    } row[] = {
        {widen_column, "the columns of a plane of the stone do not fit"},
        {widen_row, "the rows of a plane of the stone do not fit"},
        {lose_shift, "the rows of a plane of the stone do not fit"},
        {raise_shift, "the rows of a plane of the stone do not fit"},
        {raise_tap, "a tap of the stone has too many bits"},
        {raise_cluster, "a texel's cluster is out of range"},
        {raise_transmittance, "the stone's transmittance is not 0 .. 1"},
        {raise_gain, "the stone's gain is not normalised, or not 0 .. 1"},
        {raise_planes, "the stone has too many planes or ranks"},
        {make_even, "the stone's side or kernel is out of range"},
        {move_taps, "a table lies outside the stone"}};

    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const char *reason = "nothing";
        struct built_stone b;

        build_stone(&b, GLINT_SCATTER_CLUSTERED, 32, 29, .9);
        row[i].damage((struct glint_translucent_header *)(void *)b.data,
                      b.data);
        glint_blob_seal(b.data, b.bytes);
        assert_int_equal(
            glint_translucent_open(&b.stone, b.data, b.bytes, &reason),
            GLINT_E_FORMAT);
        assert_string_equal(reason, row[i].reason);
        free_stone(&b);
    }
}
