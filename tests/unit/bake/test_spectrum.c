/* SPDX-License-Identifier: MIT
 *
 * Checks the few wavelengths that represent a spectrum: a flat spectrum is
 * white, and the colours of smooth spectra are close to those of 31
 * wavelengths.
 */
#include "engine/setup/spectrum.h"
#include "glint/bake.h"
#include "support/test.h"

enum { ALL = 31 };

static double nm[GLINT_MAX_WAVELENGTHS], share[GLINT_MAX_WAVELENGTHS];
static double rgb[GLINT_MAX_WAVELENGTHS][3];

/* Sets ALL to the RGB responses of the standard observer at 400 .. 700 nm, each
 * channel divided by its sum. */
static void set_observer_responses(double all[ALL][3])
{
    double sum[3] = {0, 0, 0};

    for (int j = 0; j < ALL; j++) {
        glint_observer_compute_rgb(400 + 10 * j, all[j]);
        for (int c = 0; c < 3; c++)
            sum[c] += all[j][c];
    }
    for (int j = 0; j < ALL; j++)
        for (int c = 0; c < 3; c++)
            all[j][c] /= sum[c];
}

TEST(wavelengths_are_sorted_and_visible)
{
    for (int n = 1; n <= GLINT_MAX_WAVELENGTHS; n++) {
        glint_spectrum(n, nm, rgb, share);
        for (int i = 0; i < n; i++) {
            assert_true(nm[i] >= 400 && nm[i] <= 700);
            assert_true(i == 0 || nm[i] > nm[i - 1] + 2);
            for (int c = 0; c < 3; c++)
                assert_true(fabs(rgb[i][c]) < 2);
        }
    }
    /* three wavelengths are blue, green and orange */
    glint_spectrum(3, nm, rgb, share);
    assert_true(nm[0] > 430 && nm[0] < 460 && nm[1] > 520 && nm[1] < 560 &&
                nm[2] > 590 && nm[2] < 630);
}

TEST(flat_spectrum_is_white)
{
    for (int n = 1; n <= GLINT_MAX_WAVELENGTHS; n++) {
        double sum[4] = {0, 0, 0, 0};

        glint_spectrum(n, nm, rgb, share);
        for (int i = 0; i < n; i++) {
            for (int c = 0; c < 3; c++)
                sum[c] += rgb[i][c];
            sum[3] += share[i];
        }
        for (int c = 0; c < 4; c++)
            assert_true(fabs(sum[c] - 1) < 1e-9);
    }
}

/* Returns the product of the reflectances of two coated glass surfaces at
 * wavelength AT, nm, as in a ghost. */
static double compute_ghost_reflectance(double first_nm, double second_nm,
                                        double index, double at)
{
    const double pi = 3.14159265358979323846;
    const struct glint_film_at first = {1.38, pi * first_nm / at};
    const struct glint_film_at second = {1.38, pi * second_nm / at};

    return glint_reflectance(1, index, 1, &first, 1) *
           glint_reflectance(1, index, 1, &second, 1);
}

/* Returns the largest error of a ghost's colour, of any channel, when N
 * wavelengths represent the spectrum; relative to the largest channel. */
static double compute_colour_error(int n, double first_nm, double second_nm,
                                   double index)
{
    double all[ALL][3], few[3] = {0, 0, 0}, true_rgb[3] = {0, 0, 0};
    double most = 0, wrong = 0;

    set_observer_responses(all);
    glint_spectrum(n, nm, rgb, share);
    for (int c = 0; c < 3; c++) {
        for (int j = 0; j < ALL; j++)
            true_rgb[c] +=
                all[j][c] * compute_ghost_reflectance(first_nm, second_nm,
                                                      index, 400 + 10 * j);
        for (int i = 0; i < n; i++)
            few[c] += rgb[i][c] * compute_ghost_reflectance(first_nm, second_nm,
                                                            index, nm[i]);
        most = fmax(most, true_rgb[c]);
        wrong = fmax(wrong, fabs(few[c] - true_rgb[c]));
    }
    return wrong / most;
}

/* Checks that ghosts of quarter-wave and half-wave films have the right
 * colours, whose errors decrease as the number of wavelengths grows. */
TEST(coating_colours_converge)
{
    static const double film[] = {430, 460, 520, 560, 640, 680, 1080};
    static const struct {
        int n;
        double mean, worst;
    } bound[] = {{3, 0.06, 0.25},  {4, 0.03, 0.1},    {6, 0.03, 0.1},
                 {10, 0.01, 0.06}, {17, 0.004, 0.03}, {28, 0.002, 0.01}};
    enum { FILMS = sizeof film / sizeof *film };

    for (size_t b = 0; b < sizeof bound / sizeof *bound; b++) {
        double sum = 0, worst = 0;
        int count = 0;

        for (int i = 0; i < FILMS; i++)
            for (int j = i; j < FILMS; j++)
                for (double index = 1.5; index < 1.8; index += 0.12) {
                    const double e = compute_colour_error(bound[b].n, film[i],
                                                          film[j], index);

                    sum += e;
                    worst = fmax(worst, e);
                    count++;
                }
        print_message("%d wavelengths: colours off by %.4f, at most %.4f\n",
                      bound[b].n, sum / count, worst);
        assert_true(sum / count < bound[b].mean);
        assert_true(worst < bound[b].worst);
    }
}

/* Returns the error of N wavelengths at an outline that dispersion widens: the
 * height of the colour steps, as the largest difference in any channel from
 * 3000 wavelengths. */
static double compute_step_error(int n)
{
    enum { FINE = 3000 };
    double edge[3] = {0, 0, 0}, total[3] = {0, 0, 0}, step[3] = {0, 0, 0};
    double worst = 0;
    int next = 0;

    glint_spectrum(n, nm, rgb, share);
    for (int i = 0; i <= FINE; i++) {
        double at[3];

        glint_observer_compute_rgb(400 + 0.1 * i, at);
        for (int c = 0; c < 3; c++)
            total[c] += at[c];
    }
    for (int i = 0; i <= FINE; i++) {
        const double here = 400 + 0.1 * i;
        double at[3];

        glint_observer_compute_rgb(here, at);
        for (; next < n && nm[next] <= here; next++)
            for (int c = 0; c < 3; c++)
                step[c] += rgb[next][c];
        for (int c = 0; c < 3; c++) {
            edge[c] += at[c] / total[c];
            worst = fmax(worst, fabs(edge[c] - step[c]));
        }
    }
    return worst;
}

TEST(more_wavelengths_make_smaller_colour_steps)
{
    assert_true(compute_step_error(3) < 0.8);
    assert_true(compute_step_error(5) < 0.5);
    assert_true(compute_step_error(9) < 0.3);
    assert_true(compute_step_error(17) < 0.22);
    assert_true(compute_step_error(31) < 0.15);
}
