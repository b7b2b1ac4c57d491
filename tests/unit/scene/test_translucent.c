/* SPDX-License-Identifier: MIT
 *
 * Compares light scattered by the integers of a baked translucent medium with
 * light scattered by the fit in double precision, and checks that invalid
 * files are rejected.
 */
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

/* Returns the PSNR, dB, of light scattered by the integers of B against light
 * scattered by its fit, under lamps and shadows. */
static double compute_psnr(const struct built_stone *b)
{
    const size_t n = 3 * (size_t)(b->fit.side * b->fit.side);
    double *light = test_free_later(calloc(3 * n, sizeof *light));
    double db;

    glint_scatter_test_light(b->fit.side, light);
    glint_scatter_light(&b->fit, light, light + n);
    assert_ok(glint_stone_light(&b->stone, light, light + 2 * n));
    for (size_t i = 0; i < n; i++)
        light[n + i] = fmax(light[n + i], 0);
    db = peak_psnr(light + 2 * n, light + n, n);
    return db;
}

TEST(integers_are_close_to_their_fit)
{
    for (int m = 0; m < 3; m++) {
        struct built_stone b;
        double db;

        build_translucent_model(&b, models[m], 128, 29, .9);
        db = compute_psnr(&b);
        print_message("model %d: %.1f dB, taps of %d bits, ranks lose %.4f\n",
                      m, db, b.report.tap_bits, b.report.kernel_loss);
        assert_true(db > 45);
        free_translucent_model(&b);
    }
}

/* Bakes B again with RANK products per kernel and returns the PSNR. */
static double bake_and_measure_psnr_of_rank(struct built_stone *b, int rank)
{
    struct glint_error error;
    const char *reason;

    free(b->data);
    b->data = NULL;
    b->text.fit.rank = rank;
    assert_ok(glint_stone_bake(&b->fit, &b->text, "test", 7, &b->data,
                               &b->bytes, &b->report, &error));
    assert_ok(glint_translucent_open(&b->stone, b->data, b->bytes, &reason));
    return compute_psnr(b);
}

/* Checks that two products per kernel approximate better than one where light
 * varies slowly: above 60 and 45 dB. */
TEST(more_products_approximate_better)
{
    for (int m = 0; m < 3; m += 2) {
        struct built_stone b;
        double db[2];

        build_translucent_model(&b, models[m], 128, 29, .9);
        db[0] = bake_and_measure_psnr_of_rank(&b, 2);
        db[1] = bake_and_measure_psnr_of_rank(&b, 1);
        print_message("model %d: rank 2 %.1f dB, rank 1 %.1f\n", m, db[0],
                      db[1]);
        assert_true(db[0] > 60 && db[1] > 45 && db[1] < db[0]);
        free_translucent_model(&b);
    }
}

/* ---------------------------------------------------------- rejected files */

/* Damages the file of an intact translucent medium; the test seals the checksum
 * afterwards. */
typedef void damage_fn(struct glint_translucent_header *h, unsigned char *data);

static int16_t *address_of_kernel_taps(const struct glint_translucent_header *h,
                                       unsigned char *data)
{
    return (int16_t *)(void *)(data + h->tap_at);
}

/* Sets column taps (kernel entries) that are in range, but with too large a
 * sum. */
static void set_too_large_column_taps(struct glint_translucent_header *h,
                                      unsigned char *data)
{
    for (uint32_t k = 0; k < h->kernel * h->rank * h->n_planes; k++)
        address_of_kernel_taps(
            h, data)[(2 * (k / h->kernel) + 1) * h->kernel + k % h->kernel] =
            k % 2 ? 2047 : -2047;
}

static void set_too_large_row_taps(struct glint_translucent_header *h,
                                   unsigned char *data)
{
    for (uint32_t k = 0; k < h->kernel; k++)
        address_of_kernel_taps(h, data)[k] = k % 2 ? 2047 : -2047;
}

static void decrement_shift(struct glint_translucent_header *h,
                            unsigned char *data)
{
    uint32_t *shift = (uint32_t *)(void *)(data + h->shift_at);

    shift[0]--;
}

static void set_shift_out_of_range(struct glint_translucent_header *h,
                                   unsigned char *data)
{
    uint32_t *shift = (uint32_t *)(void *)(data + h->shift_at);

    shift[3 * h->n_planes * h->rank - 1] = 17;
}

static void set_tap_out_of_range(struct glint_translucent_header *h,
                                 unsigned char *data)
{
    address_of_kernel_taps(h, data)[0] = -32768;
}

static void set_cluster_out_of_range(struct glint_translucent_header *h,
                                     unsigned char *data)
{
    data[h->cluster_at + 100] = (unsigned char)h->n_planes;
}

static void set_transmittance_out_of_range(struct glint_translucent_header *h,
                                           unsigned char *data)
{
    uint16_t *table = (uint16_t *)(void *)(data + h->transmit_at);

    table[GLINT_TRANSLUCENT_COSINES] = 32769;
}

static void set_gain_out_of_range(struct glint_translucent_header *h,
                                  unsigned char *data)
{
    (void)data;
    h->gain[2] = (struct glint_real){1 << 30, -30};
}

static void set_planes_out_of_range(struct glint_translucent_header *h,
                                    unsigned char *data)
{
    (void)data;
    h->n_planes = GLINT_TRANSLUCENT_MOST_PLANES + 1;
}

static void set_even_kernel_size(struct glint_translucent_header *h,
                                 unsigned char *data)
{
    (void)data;
    h->kernel--;
}

static void move_taps_beyond_end(struct glint_translucent_header *h,
                                 unsigned char *data)
{
    (void)data;
    h->tap_at = h->bytes - 4;
}

/* Checks that every sum and offset that the inner loops rely on is validated on
 * opening. */
TEST(rejects_every_invalid_field)
{
    static const struct {
        damage_fn *damage;
        const char *reason;
    } row[] = {
        {set_too_large_column_taps, "damaged translucent medium: the column "
                                    "coefficients of a kernel are too large"},
        {set_too_large_row_taps, "damaged translucent medium: the row "
                                 "coefficients of a kernel are too large"},
        {decrement_shift, "damaged translucent medium: the row coefficients of "
                          "a kernel are too large"},
        {set_shift_out_of_range, "damaged translucent medium: the row "
                                 "coefficients of a kernel are too large"},
        {set_tap_out_of_range,
         "damaged translucent medium: a kernel coefficient has too many bits"},
        {set_cluster_out_of_range, "damaged translucent medium: a texel refers "
                                   "to a cluster that does not exist"},
        {set_transmittance_out_of_range,
         "damaged translucent medium: its transmittance is not 0 .. 1"},
        {set_gain_out_of_range, "damaged translucent medium: its gain is not "
                                "normalised, or not 0 .. 1"},
        {set_planes_out_of_range, "damaged translucent medium: it has too many "
                                  "kernels or terms per kernel"},
        {set_even_kernel_size, "damaged translucent medium: its texel count or "
                               "kernel size is out of range"},
        {move_taps_beyond_end,
         "damaged translucent medium: a table lies outside the file"}};

    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const char *reason = "nothing";
        struct built_stone b;

        build_translucent_model(&b, GLINT_SCATTER_CLUSTERED, 32, 29, .9);
        row[i].damage((struct glint_translucent_header *)(void *)b.data,
                      b.data);
        glint_blob_set_size_and_checksum(b.data, b.bytes);
        assert_int_equal(
            glint_translucent_open(&b.stone, b.data, b.bytes, &reason),
            GLINT_E_FORMAT);
        assert_string_equal(reason, row[i].reason);
        free_translucent_model(&b);
    }
}
