/* SPDX-License-Identifier: MIT
 *
 * Checks that fits of scattering rows recover known models, preserve light and
 * reject invalid options, and that the linear solvers of the fits are right.
 */
#include <dlfcn.h>

#include "bake/translucent/linear.h"
#include "bake/translucent/slab.h"
#include "support/lens_check.h"
#include "support/rng.h"

enum { SIDE = 20, KERNEL = 7, K2 = KERNEL * KERNEL, TEXELS = SIDE * SIDE };

static const enum glint_scatter_model models[] = {
    GLINT_SCATTER_CLUSTERED, GLINT_SCATTER_FACTORED, GLINT_SCATTER_ALBEDO};

static void make_checkerboard_rows(struct glint_scatter_rows *rows, int side,
                                   int kernel)
{
    struct glint_stone stone;
    struct glint_error error;

    glint_stone_defaults(&stone);
    stone.side = side;
    stone.kernel = kernel;
    stone.fields = side >= 16 ? side / 12 : 1;
    assert_ok(glint_scatter_compute(&stone, NULL, rows, &error));
}

static void fit_rows_by_model(struct glint_scatter_rows *rows,
                              enum glint_scatter_model model,
                              struct glint_scatter_fit *fit)
{
    struct glint_scatter_options options;

    glint_scatter_defaults(&options, model);
    assert_ok(glint_scatter_fit(rows, &options, NULL, fit));
}

/* Returns entry D of kernel J of the synthetic rows. Kernels are not symmetric,
 * so that mirroring them changes the result. */
static double compute_synthetic_kernel_entry(int j, int d)
{
    const int u = d % KERNEL - KERNEL / 2, v = d / KERNEL - KERNEL / 2;

    return j ? exp(-0.3 * (u + 1) * (u + 1) - 0.1 * v * v)
             : exp(-0.1 * u * u - 0.5 * (v - 1) * (v - 1));
}

/* Sets ROWS to sums of synthetic kernels, multiplied by WEIGHT of the texel
 * where light leaves and by IN of the texel where light enters the medium. */
static void make_synthetic_rows(struct glint_scatter_rows *rows,
                                double (*weight)[2], const double *in)
{
    assert_true(glint_scatter_allocate_rows(rows, SIDE, KERNEL, false));
    for (int x = 0; x < TEXELS; x++)
        for (int c = 0; c < 3; c++)
            for (int d = 0; d < K2; d++) {
                const int to =
                    glint_scatter_get_target_texel(SIDE, KERNEL, x, d);

                if (to >= 0)
                    glint_scatter_get_row(rows, x, c)[d] =
                        (float)(in[x] * (c + 1) *
                                (weight[to][0] *
                                     compute_synthetic_kernel_entry(0, d) +
                                 weight[to][1] *
                                     compute_synthetic_kernel_entry(1, d)));
            }
}

/* Checks that each model fits, without error, the synthetic rows that it can
 * represent, including kernels that are not symmetric. */
TEST(synthetic_rows_are_fitted_by_their_model)
{
    uint32_t seed = 5;
    static const double bound[3] = {4e-3, 1e-6, 1e-5};
    double weight[TEXELS][2], in[TEXELS];

    for (int m = 0; m < 3; m++) {
        struct glint_scatter_options options = {models[m], m == 2 ? 1 : 2, 2};
        struct glint_scatter_rows rows;
        struct glint_scatter_fit fit;

        for (int x = 0; x < TEXELS; x++) {
            const bool first = m == 2 || (x % SIDE < SIDE / 2);

            weight[x][0] = 0.5 + rng_unit(&seed);
            weight[x][1] = 0.5 + rng_unit(&seed);
            if (m != 1) {
                weight[x][0] *= first;
                weight[x][1] *= !first;
            }
            in[x] = m == 0 ? 0.5 + rng_unit(&seed) : 1;
        }
        make_synthetic_rows(&rows, weight, in);
        assert_ok(glint_scatter_fit(&rows, &options, NULL, &fit));
        /* the alternating fit stops before it has converged, and floats have
         * seven digits */
        assert_true(fit.error.rmse < (bound[m]));
        glint_scatter_fit_close(&fit);
        glint_scatter_close(&rows);
    }
}

/* Checks that a fit scatters light as the entries of its rows do, and that
 * uniform light gives the albedo of the data. Row factors times column factors
 * must give the kernel h. */
TEST(fit_scatters_light_like_its_entries)
{
    struct glint_scatter_rows rows, same;
    double light[3 * TEXELS], even[3 * TEXELS], want[3 * TEXELS],
        got[3 * TEXELS];

    make_checkerboard_rows(&rows, SIDE, KERNEL);
    assert_true(glint_scatter_allocate_rows(&same, SIDE, KERNEL, false));
    glint_scatter_test_light(SIDE, light);
    for (int m = 0; m < 3; m++) {
        struct glint_scatter_fit fit;

        fit_rows_by_model(&rows, models[m], &fit);
        for (int x = 0; x < TEXELS; x++)
            for (int c = 0; c < 3; c++)
                for (int d = 0; d < K2; d++)
                    glint_scatter_get_row(&same, x, c)[d] =
                        (float)glint_scatter_entry(&fit, x, c, d);
        glint_scatter_light_rows(&same, light, want);
        glint_scatter_light(&fit, light, got);
        for (int i = 0; i < 3 * TEXELS; i++) {
            assert_near(got[i], want[i], 1e-5);
            even[i] = 1;
        }
        glint_scatter_light(&fit, even, got);
        glint_scatter_light_rows(&rows, even, want);
        for (int i = 0; i < 3 * TEXELS; i++)
            assert_near(got[i], want[i], 1e-5);
        for (int d = 0; fit.row && d < K2; d++) {
            double h = 0;

            for (int q = 0; q < fit.rank; q++)
                h += fit.column[q * KERNEL + d / KERNEL] *
                     fit.row[q * KERNEL + d % KERNEL];
            assert_near(h, fit.h[d], 1e-12);
        }
        glint_scatter_fit_close(&fit);
    }
    glint_scatter_close(&rows);
    glint_scatter_close(&same);
}

/* Checks that fits of a checkerboard of two marbles reach a PSNR of 44 dB under
 * lamps and shadows, well above the 40 dB that the run time must reach, and
 * that more terms and higher ranks have smaller errors. */
TEST(psnr_is_sufficient)
{
    static const int parts[4][2] = {{1, 3}, {3, 3}, {5, 1}, {5, 3}};
    struct glint_scatter_rows rows;
    struct glint_scatter_fit fit;
    double db[4];

    make_checkerboard_rows(&rows, 48, 15);
    fit_rows_by_model(&rows, GLINT_SCATTER_CLUSTERED, &fit);
    assert_true(fit.error.light_db > 44 && fit.error.entry_db > 44);
    glint_scatter_fit_close(&fit);
    for (int i = 0; i < 4; i++) {
        const struct glint_scatter_options o = {GLINT_SCATTER_FACTORED,
                                                parts[i][0], parts[i][1]};

        assert_ok(glint_scatter_fit(&rows, &o, NULL, &fit));
        db[i] = fit.error.light_db;
        glint_scatter_fit_close(&fit);
    }
    assert_true(db[0] < db[1] && db[1] < db[3] && db[2] < db[3]);
    assert_true(db[3] > 46);
    glint_scatter_close(&rows);
}

/* Checks black media, a single texel, and kernels wider than the medium:
 * results are finite, and exact where the model can represent the data. */
TEST(extreme_media_give_finite_results)
{
    static const int shape[3][2] = {{1, 9}, {3, 13}, {9, 1}};

    for (int i = 0; i < 6; i++)
        for (int m = 0; m < 3; m++) {
            const int side = shape[i % 3][0], kernel = shape[i % 3][1];
            struct glint_scatter_rows rows;
            struct glint_scatter_fit fit;

            if (i < 3)
                make_checkerboard_rows(&rows, side, kernel);
            else
                assert_true(
                    glint_scatter_allocate_rows(&rows, side, kernel, false));
            fit_rows_by_model(&rows, models[m], &fit);
            assert_true(isfinite(fit.error.rmse) && fit.error.albedo < 0.5);
            for (int d = 0; d < 3 * kernel * kernel; d++)
                assert_true(isfinite(fit.h[d]));
            for (int x = 0; fit.out && x < 3 * side * side; x++)
                assert_true(isfinite(fit.out[x]));
            if (i >= 3 || side == 1)
                assert_true(fit.error.rmse < 1e-6);
            glint_scatter_fit_close(&fit);
            glint_scatter_close(&rows);
        }
}

static bool cancel_at_third_call(void *ctx)
{
    return ++*(int *)ctx > 2;
}

TEST(rejects_invalid_options)
{
    static const struct glint_scatter_options bad[] = {
        {GLINT_SCATTER_CLUSTERED, 0, 1}, {GLINT_SCATTER_CLUSTERED, 21, 1},
        {GLINT_SCATTER_FACTORED, 5, 0},  {GLINT_SCATTER_FACTORED, 5, 9},
        {GLINT_SCATTER_ALBEDO, 2, 1},    {(enum glint_scatter_model)3, 1, 1},
    };
    struct glint_scatter_rows rows;
    struct glint_scatter_fit fit;

    make_checkerboard_rows(&rows, 8, 5);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(glint_scatter_fit(&rows, &bad[i], NULL, &fit),
                         GLINT_E_ARGUMENT);
        assert_null(fit.h);
    }
    for (int m = 0; m < 2; m++) {
        int asked = 0;
        const struct glint_watch watch = {NULL, cancel_at_third_call, &asked};
        struct glint_scatter_options o;

        glint_scatter_defaults(&o, models[m]);
        assert_int_equal(glint_scatter_fit(&rows, &o, &watch, &fit),
                         GLINT_E_CLOSED);
        assert_null(fit.h);
    }
    glint_scatter_close(&rows);
}

enum { TALL = 120, WIDE = 40, TERMS = 9 };

static void read_fitted_row(const void *ctx, int i, double *to)
{
    memcpy(to, (const double *)ctx + i * WIDE, WIDE * sizeof *to);
}

/* Sets A to a random matrix whose singular values decrease by half from one to
 * the next. */
static void make_matrix_with_halving_values(double *a)
{
    uint32_t seed = 9;

    memset(a, 0, TALL * WIDE * sizeof *a);
    for (int j = 0; j < WIDE; j++) {
        double left[TALL], right[WIDE];

        for (int i = 0; i < TALL; i++)
            left[i] = rng_unit(&seed) - 0.5;
        for (int i = 0; i < WIDE; i++)
            right[i] = rng_unit(&seed) - 0.5;
        for (int i = 0; i < TALL * WIDE; i++)
            a[i] += ldexp(left[i / WIDE] * right[i % WIDE], -j);
    }
}

typedef int dgesdd_fn(int layout, char job, int m, int n, double *a, int lda,
                      double *s, double *u, int ldu, double *vt, int ldvt);

/* Checks that singular values and vectors equal those of LAPACK's dgesdd within
 * 1e-10. */
TEST(decomposition_matches_lapack)
{
    double a[TALL * WIDE], copy[TALL * WIDE], s[WIDE], u[TALL * WIDE],
        vt[WIDE * WIDE];
    const struct glint_tall m = {TALL, WIDE, read_fitted_row, a};
    void *library = dlopen("liblapacke.so.3", RTLD_NOW);
    struct glint_terms terms;
    dgesdd_fn *dgesdd;

    if (!library) {
        fprintf(stderr, "terms of LAPACK are skipped: no liblapacke\n");
        skip();
    }
    *(void **)&dgesdd = dlsym(library, "LAPACKE_dgesdd");
    assert_non_null(dgesdd);
    make_matrix_with_halving_values(a);
    memcpy(copy, a, sizeof a);
    assert_int_equal(
        dgesdd(101, 'S', TALL, WIDE, copy, WIDE, s, u, WIDE, vt, WIDE), 0);
    assert_true(glint_compute_leading_terms(&m, TERMS, &terms));
    for (int j = 0; j < TERMS; j++) {
        /* The sign of a pair of vectors is arbitrary. */
        const double sign = u[j] * terms.left[j * TALL] < 0 ? -1 : 1;

        assert_near(terms.value[j], s[j], 1e-10 * s[0]);
        for (int i = 0; i < TALL; i++)
            assert_near(sign * terms.left[j * TALL + i], u[i * WIDE + j],
                        1e-10 * s[0] / s[j]);
        for (int i = 0; i < WIDE; i++)
            assert_near(sign * terms.right[j * WIDE + i], vt[j * WIDE + i],
                        1e-10 * s[0] / s[j]);
    }
    glint_terms_free(&terms);
    dlclose(library);
}

/* Checks the singular values of a matrix that has equal values and zeros among
 * them, and that the vectors of the values above 0 are orthogonal to all
 * others. */
TEST(decomposition_is_orthogonal_and_optimal)
{
    double a[TALL * WIDE] = {0};
    const struct glint_tall m = {TALL, WIDE, read_fitted_row, a};
    struct glint_terms terms;

    a[0] = a[WIDE + 1] = a[2 * WIDE + 2] = 3;
    a[3 * WIDE + 3] = -0.5;
    assert_true(glint_compute_leading_terms(&m, 6, &terms));
    for (int j = 0; j < 6; j++)
        assert_near(terms.value[j], j < 3 ? 3 : j == 3 ? 0.5 : 0, 1e-12);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 4; j++) {
            double left = 0, right = 0;

            for (int x = 0; x < TALL; x++)
                left += terms.left[i * TALL + x] * terms.left[j * TALL + x];
            for (int x = 0; x < WIDE; x++)
                right += terms.right[i * WIDE + x] * terms.right[j * WIDE + x];
            assert_near(left, i == j, 1e-10);
            assert_near(right, i == j, 1e-10);
        }
    glint_terms_free(&terms);
}

/* Checks the solution of a regular system, and of a singular one in which one
 * direction is undetermined. */
TEST(solves_regular_and_singular_systems)
{
    double a[9] = {4, 2, 1, 2, 5, 3, 1, 3, 6}, b[3] = {7, 10, 10};
    double open[4] = {1, 1, 1, 1}, c[2] = {2, 2};

    glint_solve_symmetric_system(a, 3, b);
    for (int i = 0; i < 3; i++)
        assert_near(b[i], 1, 1e-14);
    glint_solve_symmetric_system(open, 2, c);
    assert_near(c[0] + c[1], 2, 1e-14);
}
