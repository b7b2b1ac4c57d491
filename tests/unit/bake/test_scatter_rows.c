/* SPDX-License-Identifier: MIT
 *
 * Compares rows of the scattering matrix of a translucent medium with a closed
 * form and with measured rows. Checks that rows are reciprocal and return no
 * more light than they receive. C1 and C2 in names are claims of
 * tests/figures/scenes/translucent.md.
 */
#include "bake/translucent/slab.h"
#include "support/lens_check.h"

static struct glint_error error;

enum { SIDE = 24, KERNEL = 13, K2 = KERNEL * KERNEL };

static struct glint_stone make_medium(enum glint_stone_pattern pattern)
{
    struct glint_stone stone;

    glint_stone_defaults(&stone);
    stone.side = SIDE;
    stone.kernel = KERNEL;
    stone.pattern = pattern;
    stone.fields = 3;
    return stone;
}

static void compute_scatter_rows(const struct glint_stone *stone,
                                 struct glint_scatter_rows *rows)
{
    assert_ok(glint_scatter_compute(stone, NULL, rows, &error));
}

static double sum_row_entries(const struct glint_scatter_rows *rows, int x,
                              int c)
{
    double sum = 0;

    for (int d = 0; d < rows->kernel * rows->kernel; d++)
        sum += (double)glint_scatter_get_row(rows, x, c)[d];
    return sum;
}

/* Returns the radiant exitance at distance R by [Jensen01], equation 4, with
 * additional image sources for the far face of the slab. */
static double compute_radiant_exitance(const struct glint_slab *s, double r)
{
    const double loss = sqrt(s->absorb / s->diffusion);
    double sum = 0;

    for (int i = -12; i <= 12; i++) {
        const double period = 2 * i * (s->slab + 2 * s->beyond);
        const double z[2] = {period + s->depth,
                             period - s->depth - 2 * s->beyond};

        for (int k = 0; k < 2; k++) {
            const double far = sqrt(r * r + z[k] * z[k]);

            sum += (k ? -1 : 1) * z[k] * (loss * far + 1) * exp(-loss * far) /
                   (far * far * far);
        }
    }
    return s->albedo * sum / (4 * 3.14159265358979);
}

/* Checks rows of a homogeneous medium, away from its rim, against a closed
 * form. Entries from two texels off the centre on, and row sums, must be right
 * within 2 %. Computed by a sum of modes alone, entries must be right from
 * three texels on. */
TEST(homogeneous_rows_match_the_closed_form)
{
    const struct glint_stone stone = make_medium(GLINT_STONE_EVEN);
    struct glint_scatter_rows rows;
    double modes[K2];

    compute_scatter_rows(&stone, &rows);
    for (int c = 0; c < 3; c++) {
        const int x = SIDE / 2 * SIDE + SIDE / 2;
        const double area = stone.texel_mm * stone.texel_mm;
        struct glint_slab slab;
        double closed[K2], sum = 0;

        glint_slab_init_mix(&stone, 1, c, &slab);
        glint_slab_compute_closed_form(&slab, KERNEL, closed);
        assert_true(glint_slab_compute_by_modes(&slab, KERNEL, modes));
        for (int u = 2; u <= KERNEL / 2; u++) {
            const int d = K2 / 2 + u;
            const double want =
                area * compute_radiant_exitance(&slab, u * stone.texel_mm);
            const float *row = glint_scatter_get_row(&rows, x, c);

            /* The light of an entry is a mean over a texel, which exceeds the
             * value at the texel's centre. */
            assert_near(closed[d], want, (u < 4 ? 0.3 : 0.06) * want);
            assert_near((double)row[d], closed[d], 0.02 * closed[d]);
            if (u >= 3)
                assert_near(modes[d], closed[d], 0.02 * closed[d]);
        }
        for (int d = 0; d < K2; d++)
            sum += closed[d];
        assert_near(sum_row_entries(&rows, x, c), sum, 0.02 * sum);
    }
    glint_scatter_close(&rows);
}

/* Checks that the total light that leaves a semi-infinite medium equals that of
 * the dipole model, [Jensen01], equation 6. */
TEST(total_light_matches_the_dipole)
{
    struct glint_stone stone = make_medium(GLINT_STONE_EVEN);
    struct glint_slab slab;
    double loss, want,
        sum = 0, *entry = test_free_later(malloc(63 * 63 * sizeof *entry));

    stone.slab_mm = 1000;
    stone.texel_mm = 3;
    stone.material[0] =
        (struct glint_stone_material){{2, 2, 2}, {0.02, 0.02, 0.02}};
    glint_slab_init_mix(&stone, 1, 0, &slab);
    glint_slab_compute_closed_form(&slab, 63, entry);
    loss = sqrt(slab.absorb / slab.diffusion);
    want =
        slab.albedo / 2 *
        (exp(-loss * slab.depth) + exp(-loss * (slab.depth + 2 * slab.beyond)));
    for (int d = 0; d < 63 * 63; d++)
        sum += entry[d];
    assert_near(sum, want, 0.005 * want);
}

/* Checks that rows are reciprocal, that no entry is negative, and that no row
 * sums to more than 1. */
TEST(c1_reciprocal)
{
    static const enum glint_stone_pattern pattern[] = {GLINT_STONE_CHESS,
                                                       GLINT_STONE_VEINS};

    for (int i = 0; i < 2; i++) {
        const struct glint_stone stone = make_medium(pattern[i]);
        struct glint_scatter_rows rows, turned;
        const size_t bytes = (size_t)SIDE * SIDE * 3 * K2 * sizeof(float);

        compute_scatter_rows(&stone, &rows);
        compute_scatter_rows(&stone, &turned);
        glint_scatter_transpose_rows(&turned);
        for (size_t e = 0; e < bytes / sizeof(float); e++) {
            assert_true(rows.r[e] >= 0);
            assert_near((double)rows.r[e], (double)turned.r[e], 1e-7);
        }
        for (int x = 0; x < SIDE * SIDE; x++)
            for (int c = 0; c < 3; c++)
                assert_true(sum_row_entries(&rows, x, c) <= 1);
        glint_scatter_close(&rows);
        glint_scatter_close(&turned);
    }
}

/* Checks that offsets in a row are relative to the lit texel, that entries
 * outside the square are 0, and that measured rows are read unchanged. */
TEST(c2_places)
{
    enum { S = 3, N = 5, WIDE = S * N };
    float rgb[WIDE * WIDE * 3];
    const struct glint_float_image picture = {WIDE, WIDE, rgb};
    const struct glint_float_image narrow = {WIDE - 1, WIDE, rgb};
    struct glint_scatter_rows rows;
    long long held;

    for (int i = 0; i < WIDE * WIDE * 3; i++)
        rgb[i] = (float)(i + 1);
    rgb[(2 * WIDE + 2) * 3] = -1;
    rgb[(2 * WIDE + 3) * 3 + 1] = (float)NAN;
    assert_ok(glint_scatter_read(&picture, S, N, &rows, &held, &error));
    assert_int_equal(held, 2);
    for (int x = 0; x < S * S; x++)
        for (int d = 0; d < N * N; d++) {
            const int u = x % S + d % N - 2, v = x / S + d / N - 2;
            const int to = glint_scatter_get_target_texel(S, N, x, d);
            const int at = (x / S * N + d / N) * WIDE + x % S * N + d % N;
            const float *from = rgb + 3 * at;

            assert_int_equal(to, u >= 0 && v >= 0 && u < S && v < S ? v * S + u
                                                                    : -1);
            for (int c = 0; c < 3; c++)
                assert_true(glint_scatter_get_row(&rows, x, c)[d] ==
                            (to >= 0 && from[c] >= 0 ? from[c] : 0));
        }
    glint_scatter_close(&rows);
    assert_int_equal(glint_scatter_read(&narrow, S, N, &rows, &held, &error),
                     GLINT_E_UNSUPPORTED);
    assert_int_equal(glint_scatter_read(&picture, S, 4, &rows, &held, &error),
                     GLINT_E_ARGUMENT);
}

/* Checks that a lamp on one texel gives the light of that texel's row. */
TEST(c2_light)
{
    const struct glint_stone stone = make_medium(GLINT_STONE_VEINS);
    double light[SIDE * SIDE * 3] = {0}, seen[SIDE * SIDE * 3];
    struct glint_scatter_rows rows;
    const int x = 2 * SIDE + 5;

    compute_scatter_rows(&stone, &rows);
    light[3 * x + 1] = 2;
    glint_scatter_light_rows(&rows, light, seen);
    for (int d = 0; d < K2; d++) {
        const int to = glint_scatter_get_target_texel(SIDE, KERNEL, x, d);

        if (to >= 0)
            assert_near(seen[3 * to + 1],
                        2 * (double)glint_scatter_get_row(&rows, x, 1)[d],
                        1e-12);
    }
    assert_true(seen[3 * (x + KERNEL)] == 0 && seen[3 * x] == 0);
    glint_scatter_close(&rows);
}

/* Checks materials at the ends of their parameter ranges, single and in pairs,
 * in thin and thick slabs. Entries must be finite and not negative, row sums at
 * most 1, and strongly absorbing media dark. */
TEST(extreme_materials_give_valid_rows)
{
    static const double end[4][2] = {
        {1e-3, 0}, {1e3, 0}, {1e-3, 1e3}, {1e3, 1e3}};
    static const double slab[2] = {0.1, 1000}, texel[2] = {0.01, 100};

    for (int i = 0; i < 16; i++) {
        struct glint_stone stone = make_medium(GLINT_STONE_CHESS);
        struct glint_scatter_rows rows;

        stone.side = 6;
        /* A kernel of 7 texels extends beyond the square of 6 texels, wherever
         * it is centred. */
        stone.kernel = 7;
        stone.slab_mm = slab[(i ^ i >> 2) & 1];
        stone.texel_mm = texel[(i >> 1 ^ i >> 2) & 1];
        for (int c = 0; c < 3; c++) {
            stone.material[0].scatter[c] = end[i & 3][0];
            stone.material[0].absorb[c] = end[i & 3][1];
            stone.material[1].scatter[c] = end[i >> 2][0];
            stone.material[1].absorb[c] = end[i >> 2][1];
        }
        compute_scatter_rows(&stone, &rows);
        for (int x = 0; x < 36; x++)
            for (int c = 0; c < 3; c++) {
                const double sum = sum_row_entries(&rows, x, c);

                assert_true(sum >= 0 && sum <= 1 + 1e-6);
                if ((i & 3) == 2 && i >> 2 == 2)
                    assert_true(sum < 1e-5);
                for (int d = 0; d < 49; d++)
                    assert_true(glint_scatter_get_row(&rows, x, c)[d] >= 0);
            }
        glint_scatter_close(&rows);
    }
}

TEST(medium_of_one_texel_has_one_entry)
{
    struct glint_stone stone = make_medium(GLINT_STONE_CHESS);
    struct glint_scatter_rows rows;

    stone.side = stone.fields = 1;
    compute_scatter_rows(&stone, &rows);
    for (int d = 0; d < K2; d++)
        assert_true(d == K2 / 2 ? rows.r[d] > 0 : rows.r[d] == 0);
    glint_scatter_close(&rows);
}

TEST(rejects_invalid_media)
{
    struct glint_scatter_rows rows;

    for (int i = 0; i < 9; i++) {
        struct glint_stone stone = make_medium(GLINT_STONE_CHESS);

        if (i < 2)
            stone.side = i ? 257 : 0;
        if (i == 2)
            stone.kernel = 12;
        if (i == 3)
            stone.material[1].scatter[2] = 0;
        if (i == 4)
            stone.material[0].absorb[0] = NAN;
        if (i == 5)
            stone.fields = 25;
        if (i == 6)
            stone.pattern = GLINT_STONE_MASK;
        if (i == 7)
            stone.index = 0.9;
        if (i == 8)
            stone.texel_mm = INFINITY;
        error.text[0] = 0;
        assert_int_equal(glint_scatter_compute(&stone, NULL, &rows, &error),
                         GLINT_E_ARGUMENT);
        assert_true(error.text[0] && !rows.r && !rows.share);
    }
}

/* Counts calls, and checks that DONE is a fraction that increases with each. */
static void count_progress_calls(void *ctx, double done)
{
    double *seen = ctx;

    assert_true(done > seen[0] && done < 1 + 1e-9);
    seen[0] = done;
    seen[1]++;
}

static bool cancel_after_limit(void *ctx)
{
    const double *seen = ctx;

    return seen[1] > seen[2];
}

/* Checks that the computation reports progress, and can be cancelled without
 * memory leaks. */
TEST(reports_progress)
{
    const struct glint_stone stone = make_medium(GLINT_STONE_CHESS);
    double seen[3] = {0, 0, 1e9};
    const struct glint_watch watch = {count_progress_calls, cancel_after_limit,
                                      seen};
    struct glint_scatter_rows rows;

    assert_ok(glint_scatter_compute(&stone, &watch, &rows, &error));
    assert_true(seen[0] > 1 - 1e-9 && seen[1] > 100);
    glint_scatter_close(&rows);
    for (seen[2] = 1; seen[2] < 1000; seen[2] *= 8) {
        seen[0] = seen[1] = 0;
        assert_int_equal(glint_scatter_compute(&stone, &watch, &rows, &error),
                         GLINT_E_CLOSED);
        assert_null(rows.r);
    }
}
