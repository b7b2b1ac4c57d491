/* SPDX-License-Identifier: MIT
 *
 * Chooses a few wavelengths that represent the visible spectrum, and their
 * colours.
 *
 *   in   how many
 *   out  the wavelengths, and the colour of each
 *
 * Method: light is known at the chosen wavelengths and interpolated between
 * them by cubics through the four nearest. The colour of a wavelength is the
 * integral of the observer's colour times that wavelength's interpolation
 * weight, as a sum over 31 wavelengths. An outline that moves with the
 * wavelength is drawn as one step per wavelength. The sum of squared
 * differences to the smooth colour gradient is smallest if wavelengths are
 * placed with a density proportional to the cube root of the squared colour per
 * unit of 1 / wavelength^2. */
#include "engine/setup/spectrum.h"

#include <math.h>
#include <string.h>

#include "glint/setup.h"

enum {
    N_ALL = 31,
    FIRST_NM = 400,
    LAST_NM = 700,
    STEP_NM = 10,
    /* distance, nm, to which cubics are extrapolated outside the outermost
     * wavelengths */
    BEYOND_NM = 15,
    POINTS = 4
};

/* Returns the value at NM of a Gaussian lobe with the sigma BELOW on the left
 * of CENTRE and the sigma ABOVE on the right. */
static double evaluate_gaussian_lobe(double nm, double centre, double below,
                                     double above)
{
    const double t = (nm - centre) / (nm < centre ? below : above);

    return exp(-0.5 * t * t);
}

/* Sets XYZ to the colour matching functions of the CIE 1931 2 degree observer
 * at NM, by the multi-lobe fit of [Wyman13], table 1; the error is within 1 %
 * of the functions' peaks. */
static void evaluate_cie_observer(double nm, double xyz[3])
{
    xyz[0] = 1.056 * evaluate_gaussian_lobe(nm, 599.8, 37.9, 31.0) +
             0.362 * evaluate_gaussian_lobe(nm, 442.0, 16.0, 26.7) -
             0.065 * evaluate_gaussian_lobe(nm, 501.1, 20.4, 26.2);
    xyz[1] = 0.821 * evaluate_gaussian_lobe(nm, 568.8, 46.9, 40.5) +
             0.286 * evaluate_gaussian_lobe(nm, 530.9, 16.3, 31.1);
    xyz[2] = 1.217 * evaluate_gaussian_lobe(nm, 437.0, 11.8, 36.0) +
             0.681 * evaluate_gaussian_lobe(nm, 459.0, 26.0, 13.8);
}

static void convert_xyz_to_bt709(const double xyz[3], double rgb[3])
{
    static const double m[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                   {-0.9692660, 1.8760108, 0.0415560},
                                   {0.0556434, -0.2040259, 1.0572252}};

    for (int c = 0; c < 3; c++)
        rgb[c] = m[c][0] * xyz[0] + m[c][1] * xyz[1] + m[c][2] * xyz[2];
}

void glint_observer_compute_rgb(double nm, double rgb[3])
{
    double xyz[3];

    evaluate_cie_observer(nm, xyz);
    convert_xyz_to_bt709(xyz, rgb);
}

/* Sets RGB to the colours of N_ALL wavelengths that sample the spectrum, scaled
 * so that a flat spectrum is white.
 */
static void compute_all_colours(double rgb[N_ALL][3])
{
    for (int j = 0; j < N_ALL; j++)
        glint_observer_compute_rgb(FIRST_NM + STEP_NM * j, rgb[j]);
    for (int c = 0; c < 3; c++) {
        double sum = 0;

        for (int j = 0; j < N_ALL; j++)
            sum += rgb[j][c];
        for (int j = 0; j < N_ALL; j++)
            rgb[j][c] /= sum;
    }
}

/* Returns the density with which wavelengths are placed at NM. Only ratios of
 * densities matter. */
static double compute_wavelength_density(double nm)
{
    double rgb[3], squares = 0;

    glint_observer_compute_rgb(nm, rgb);
    for (int c = 0; c < 3; c++)
        squares += rgb[c] * rgb[c];
    return cbrt(squares / (nm * nm * nm)); /* The derivative of 1 / nm^2 is
                                              proportional to nm^-3. */
}

/* Places N wavelengths: each at the median of one of N ranges of the spectrum
 * with equal integrals of the density. */
static void place_wavelengths(int n, double *wavelength_nm)
{
    double sum = 0, passed = 0;
    int i = 0;

    for (int nm = FIRST_NM; nm < LAST_NM; nm++)
        sum += compute_wavelength_density(nm + 0.5);
    for (int nm = FIRST_NM; nm < LAST_NM; nm++) {
        const double here = compute_wavelength_density(nm + 0.5);

        for (; i < n && sum * (i + 0.5) / n < passed + here; i++)
            wavelength_nm[i] = nm + (sum * (i + 0.5) / n - passed) / here;
        passed += here;
    }
}

/* Returns the index of the first of the four wavelengths from which a value at
 * NM is interpolated. */
static int find_first_interpolated_wavelength(int n,
                                              const double *wavelength_nm,
                                              double nm)
{
    int i = 0;

    while (i < n && wavelength_nm[i] < nm)
        i++;
    i -= POINTS / 2;
    i = i < n - POINTS ? i : n - POINTS;
    return i > 0 ? i : 0;
}

/* Returns the weight of wavelength K in a value that is interpolated at NM by a
 * Lagrange polynomial. */
static double compute_lagrange_weight(int n, const double *wavelength_nm, int k,
                                      double nm)
{
    const double at = fmin(fmax(nm, wavelength_nm[0] - BEYOND_NM),
                           wavelength_nm[n - 1] + BEYOND_NM);
    const int first = find_first_interpolated_wavelength(n, wavelength_nm, at);
    double share = 1;

    if (k < first || k >= first + POINTS)
        return 0;
    for (int i = first; i < n && i < first + POINTS; i++)
        if (i != k)
            share *=
                (at - wavelength_nm[i]) / (wavelength_nm[k] - wavelength_nm[i]);
    return share;
}

void glint_spectrum(int n, double *wavelength_nm, double (*rgb)[3],
                    double *share)
{
    double all[N_ALL][3];

    compute_all_colours(all);
    place_wavelengths(n, wavelength_nm);
    for (int k = 0; k < n; k++) {
        share[k] = rgb[k][0] = rgb[k][1] = rgb[k][2] = 0;
        for (int j = 0; j < N_ALL; j++) {
            const double part = compute_lagrange_weight(n, wavelength_nm, k,
                                                        FIRST_NM + STEP_NM * j);

            share[k] += part / N_ALL;
            for (int c = 0; c < 3; c++)
                rgb[k][c] += part * all[j][c];
        }
    }
}

double glint_largest_channel(const double rgb[3])
{
    return fmax(rgb[0], fmax(rgb[1], rgb[2]));
}

int glint_waves_list(const struct glint_waves *waves,
                     double nm[GLINT_MAX_WAVELENGTHS])
{
    static const double standard[] = {650, 532, 450};
    double rgb[GLINT_MAX_WAVELENGTHS][3], share[GLINT_MAX_WAVELENGTHS];

    switch (waves->kind) {
    case GLINT_WAVES_LIST:
        memcpy(nm, waves->nm, sizeof waves->nm);
        return waves->n;
    case GLINT_WAVES_COUNT:
        glint_spectrum(waves->n, nm, rgb, share);
        return waves->n;
    default:
        memcpy(nm, standard, sizeof standard);
        return 3;
    }
}
