/* SPDX-License-Identifier: MIT */
#include "engine/star/smear_table.h"

#include <math.h>
#include <stdlib.h>

#include "glint/setup.h"

enum {
    RINGS = GLINT_STAR_SMEAR_RINGS,
    HALF = GLINT_STAR_SMEAR_HALF,
    SIDE = 2 * HALF + 1,
    NODES = (HALF + 1) * SIDE
};

void glint_smear_compute_light(const struct glint_smear *smear,
                               const struct glint_psf *psf, double airy_px,
                               double x, double y, double half, double rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int w = 0; w < GLINT_PSF_WAVES; w++) {
        const double twice = 2 * airy_px * psf->scale[w];
        const double light = glint_smear_compute_mean(
                                 smear, x / twice, -y / twice, half / twice) /
                             (twice * twice);

        for (int c = 0; c < 3; c++)
            rgb[c] += psf->weight[w][c] * light;
    }
}

double glint_smear_compute_light_beyond(const struct glint_smear *smear,
                                        const struct glint_psf *psf,
                                        double airy_px, double r, int c)
{
    double within = 0;

    for (int w = 0; w < GLINT_PSF_WAVES; w++)
        within +=
            psf->weight[w][c] * glint_smear_integrate_within(
                                    smear, r / (2 * airy_px * psf->scale[w]));
    return 1 - smear->clear - within;
}

/* Returns the distance between table nodes of ring K, pixels. */
static double compute_ring_step_px(int k)
{
    return exp2(k) * GLINT_STAR_SMEAR_PX / HALF;
}

/* Sets LIGHT to the light at all table nodes of ring K, and returns its max
 * over nodes and channels. */
static double compute_ring_light(const struct glint_smear *smear,
                                 const struct glint_psf *psf, double airy_px,
                                 int k, double (*light)[3])
{
    const double step = compute_ring_step_px(k);
    double most = 0;

    for (int i = 0; i < NODES; i++) {
        const int row = i / SIDE;

        glint_smear_compute_light(smear, psf, airy_px, step * (i % SIDE - HALF),
                                  step * row, 0.5 * fmax(step, 1), light[i]);
        most = fmax(most, glint_largest_channel(light[i]));
    }
    return most;
}

typedef double colour[3]; /* red, green, blue */

enum glint_status glint_smear_make_table(struct glint_star_smear *t,
                                         const struct glint_smear *smear,
                                         const struct glint_psf *psf,
                                         double airy_px)
{
    colour *const light = malloc(NODES * sizeof *light);
    const enum glint_status status = light ? GLINT_OK : GLINT_E_MEMORY;

    for (int k = 0; k < RINGS && light; k++) {
        const double most =
            fmax(compute_ring_light(smear, psf, airy_px, k, light), 0x1p-60);

        t->step[k] = glint_real_of(most / 65535);
        for (int i = 0; i < 3 * NODES; i++) {
            const int row = i / (3 * SIDE);

            t->light[k][row][i / 3 % SIDE][i % 3] =
                (uint16_t)lrint(65535 * fmax(light[i / 3][i % 3], 0) / most);
        }
    }
    free(light);
    return status;
}

void glint_smear_evaluate_table(const struct glint_star_smear *t, double x,
                                double y, double rgb[3])
{
    const double turn = y < 0 ? -1 : 1;
    const double far = fmax(fabs(x), fabs(y));
    int k = 0, i, j;
    double at_x, at_y, a, b;

    rgb[0] = rgb[1] = rgb[2] = 0;
    while (k < RINGS && far >= exp2(k) * GLINT_STAR_SMEAR_PX)
        k++;
    if (k == RINGS)
        return;
    at_x = turn * x / compute_ring_step_px(k) + HALF;
    at_y = turn * y / compute_ring_step_px(k);
    i = (int)fmin(fmax(at_x, 0), 2 * HALF - 1);
    j = (int)fmin(at_y, HALF - 1);
    a = at_x - i;
    b = at_y - j;
    for (int c = 0; c < 3; c++)
        rgb[c] = ((1 - b) * ((1 - a) * t->light[k][j][i][c] +
                             a * t->light[k][j][i + 1][c]) +
                  b * ((1 - a) * t->light[k][j + 1][i][c] +
                       a * t->light[k][j + 1][i + 1][c])) *
                 glint_real_value(t->step[k]);
}
