/* SPDX-License-Identifier: MIT
 *
 * Computes diffusion in a homogeneous translucent slab in two ways: as a sum of
 * modes, and in closed form, as a sum of image sources (multipole).
 */
#include <math.h>
#include <stdlib.h>

#include "bake/translucent/slab.h"

#define PI 3.14159265358979323846

enum {
    /* subdivisions of a texel per axis, for the entry of the source texel and
     * its eight neighbours */
    FINE = 16,
    COARSE = 4, /* subdivisions of a texel per axis for all other entries */
    /* number of pairs of image sources on either side of the slab; thin slabs
     * have up to MORE */
    IMAGES = 8,
    MORE = 32,
    /* min number of nodes per side of the periodic grid that approximates an
     * infinite one; at least four kernels wide */
    LATTICE = 256
};

/* Returns the ratio A of fluence to flux at a face of a medium with index of
 * refraction INDEX, due to internal reflection [Jensen01]. */
static double compute_fluence_flux_ratio(double index)
{
    const double back =
        -1.440 / (index * index) + 0.710 / index + 0.668 + 0.0636 * index;

    /* The empirical formula does not give the exact ratio 1 for index 1. */
    return index > 1 ? (1 + back) / (1 - back) : 1;
}

void glint_slab_init_mix(const struct glint_stone *stone, double share, int c,
                         struct glint_slab *slab)
{
    const struct glint_stone_material *m = stone->material;
    const double scatter =
        share * m[0].scatter[c] + (1 - share) * m[1].scatter[c];
    const double absorb = share * m[0].absorb[c] + (1 - share) * m[1].absorb[c];
    const double all = scatter + absorb;

    *slab = (struct glint_slab){
        .texel = stone->texel_mm,
        .slab = stone->slab_mm,
        .scatter = scatter,
        .absorb = absorb,
        .diffusion = 1 / (3 * all),
        .beyond = 2 * compute_fluence_flux_ratio(stone->index) / (3 * all),
        .depth = fmin(1 / all, stone->slab_mm),
        .albedo = scatter / all,
    };
}

double glint_slab_compute_wave_number(const struct glint_slab *slab, int n)
{
    return n * PI / (slab->slab + 2 * slab->beyond);
}

double glint_slab_compute_source(const struct glint_slab *slab, int n)
{
    return slab->albedo * 2 / (slab->slab + 2 * slab->beyond) *
           sin(glint_slab_compute_wave_number(slab, n) *
               (slab->depth + slab->beyond));
}

double glint_slab_compute_exit(const struct glint_slab *slab, int n)
{
    const double k = glint_slab_compute_wave_number(slab, n);

    return slab->diffusion * k * cos(k * slab->beyond);
}

/* Returns the solid angle, divided by 4 pi, of the rectangle from (0, 0) to (U,
 * V) seen from height Z above (0, 0). */
static double compute_rectangle_solid_angle(double u, double v, double z)
{
    return atan2(u * v, z * sqrt(u * u + v * v + z * z)) / (4 * PI);
}

/* Returns the flux from a point source at depth Z, which may be negative,
 * through a square of side STEP around (U, V) in the plane z = 0. LOSS:
 * attenuation, 1 / mm, applied at the square's centre. */
static double compute_flux_through_square(double u, double v, double z,
                                          double step, double loss)
{
    const double h = step / 2, depth = fabs(z);
    const double far = loss * sqrt(u * u + v * v + z * z);
    const double angle = compute_rectangle_solid_angle(u + h, v + h, depth) -
                         compute_rectangle_solid_angle(u - h, v + h, depth) -
                         compute_rectangle_solid_angle(u + h, v - h, depth) +
                         compute_rectangle_solid_angle(u - h, v - h, depth);

    return (z < 0 ? -1 : 1) * angle * (1 + far) * exp(-far);
}

/* Returns the flux through a square of side STEP around (U, V), summed over the
 * source and its images. PAIRS: pairs of images on either side of the slab. */
static double sum_image_fluxes(const struct glint_slab *s, int pairs, double u,
                               double v, double step)
{
    const double loss = sqrt(s->absorb / s->diffusion);
    const double period = 2 * (s->slab + 2 * s->beyond);
    double sum = 0;

    for (int i = -pairs; i <= pairs; i++)
        sum += compute_flux_through_square(u, v, i * period + s->depth, step,
                                           loss) -
               compute_flux_through_square(
                   u, v, i * period - s->depth - 2 * s->beyond, step, loss);
    return s->albedo * sum;
}

/* Returns the row entry at offset (X, Y) texels, averaged over source and
 * target texel. Offsets between points of two texels have a tent
 * distribution. */
static double compute_average_entry(const struct glint_slab *s, int pairs,
                                    int x, int y)
{
    const int parts = x <= 1 && y <= 1 ? FINE : COARSE;
    const double step = s->texel / parts;
    double sum = 0;

    for (int i = 1 - parts; i < parts; i++)
        for (int j = 1 - parts; j < parts; j++)
            sum += (parts - abs(i)) * (parts - abs(j)) *
                   sum_image_fluxes(s, pairs, x * s->texel + i * step,
                                    y * s->texel + j * step, step);
    return sum / (parts * parts);
}

void glint_slab_compute_closed_form(const struct glint_slab *slab, int kernel,
                                    double *entry)
{
    const int half = kernel / 2;
    const double reach = half * slab->texel / (slab->slab + 2 * slab->beyond);
    const int pairs = reach < MORE - IMAGES ? IMAGES + (int)reach : MORE;

    for (int y = 0; y <= half; y++)
        for (int x = 0; x <= y; x++) {
            const double e = compute_average_entry(slab, pairs, x, y);

            for (int i = 0; i < 8; i++) {
                const int u = i & 4 ? y : x, v = i & 4 ? x : y;

                entry[(half + (i & 2 ? -v : v)) * kernel + half +
                      (i & 1 ? -u : u)] = e;
            }
        }
}

/* Adds mode N of a periodic lattice of SIZE x SIZE nodes to ENTRY, by a Fourier
 * sum. WAVE[SIZE]: 4 sin^2(q / 2) of each wave number q. COSINE[half +
 * 1][SIZE]: cos(q u) of each offset u. ACROSS[half + 1]: scratch. */
static void add_lattice_mode(const struct glint_slab *s, int kernel, int size,
                             int n, const double *wave, const double *cosine,
                             double *across, double *entry)
{
    const int half = kernel / 2;
    const double k = glint_slab_compute_wave_number(s, n),
                 area = s->texel * s->texel;
    const double own = (s->diffusion * k * k + s->absorb) * area;
    const double power = glint_slab_compute_source(s, n) *
                         glint_slab_compute_exit(s, n) * area /
                         ((double)size * size);

    for (int p = 0; p < size; p++) {
        for (int v = 0; v <= half; v++) {
            across[v] = 0;
            for (int q = 0; q < size; q++)
                across[v] += cosine[v * size + q] /
                             (s->diffusion * (wave[p] + wave[q]) + own);
        }
        for (int y = 0; y < kernel; y++)
            for (int x = 0; x < kernel; x++)
                entry[y * kernel + x] += power * across[abs(y - half)] *
                                         cosine[abs(x - half) * size + p];
    }
}

bool glint_slab_compute_by_modes(const struct glint_slab *slab, int kernel,
                                 double *entry)
{
    const int size = 4 * kernel > LATTICE ? 4 * kernel : LATTICE;
    const int half = kernel / 2;
    double *wave =
        malloc((size_t)(size * (half + 2) + half + 1) * sizeof *wave);
    double *cosine, *across;

    if (!wave)
        return false;
    cosine = wave + size;
    across = cosine + size * (half + 1);
    for (int p = 0; p < size; p++) {
        wave[p] = 4 * pow(sin(PI * p / size), 2);
        for (int u = 0; u <= half; u++)
            cosine[u * size + p] = cos(2 * PI * p * u / size);
    }
    for (int i = 0; i < kernel * kernel; i++)
        entry[i] = 0;
    for (int n = 1; n <= GLINT_SLAB_MODES; n++)
        add_lattice_mode(slab, kernel, size, n, wave, cosine, across, entry);
    free(wave);
    return true;
}
