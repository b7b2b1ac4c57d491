/* SPDX-License-Identifier: MIT */
#include "lens_figures/spots.h"

#include <math.h>

#include "glint/glint.h"
#include "lens_figures/fans.h"

static const double spot_nm[SPOT_COLOURS] = {450, 546, 650};

double spots_nm(int colour)
{
    return spot_nm[colour];
}

/* Adds the rays of one ring that pass. The pupil's box is a square of -1 .. 1
 * here, and its corners are as far as the outermost ring. */
static void gather_ring(struct spots *s, const struct fan *fan, int colour,
                        int ring)
{
    const int n = ring == 0 ? 1 : 6 * ring;
    const double radius = sqrt(2) * ring / SPOT_RINGS;
    double hits[GLINT_MAX_EVENTS + 1][2];
    struct glint_ray ray;

    for (int i = 0; i < n; i++) {
        const double turn = 2 * GLINT_PI * i / n;
        const double u = radius * cos(turn), v = radius * sin(turn);

        if (fabs(u) > 1 || fabs(v) > 1 || !fan_ray(fan, u, v, &ray, hits))
            continue;
        s->colour[s->n] = colour;
        s->at[s->n][0] = ray.sensor_x_mm;
        s->at[s->n++][1] = ray.sensor_y_mm;
    }
}

static void measure(struct spots *s)
{
    double sum[2] = {0, 0}, square = 0;

    for (int i = 0; i < s->n; i++)
        for (int k = 0; k < 2; k++)
            sum[k] += s->at[i][k];
    for (int k = 0; k < 2; k++)
        s->middle[k] = s->n ? sum[k] / s->n : 0;
    s->radius_mm = 0;
    for (int i = 0; i < s->n; i++) {
        const double r =
            hypot(s->at[i][0] - s->middle[0], s->at[i][1] - s->middle[1]);

        square += r * r;
        s->radius_mm = fmax(s->radius_mm, r);
    }
    s->rms_mm = s->n ? sqrt(square / s->n) : 0;
}

void spots_gather(struct spots *s, const struct glint_prescription *lens,
                  double phi_deg, double theta_deg)
{
    struct fan fan;

    s->n = 0;
    for (int c = 0; c < SPOT_COLOURS; c++)
        if (fan_init(&fan, lens, NULL, spot_nm[c], phi_deg, theta_deg))
            for (int ring = 0; ring <= SPOT_RINGS; ring++)
                gather_ring(s, &fan, c, ring);
    measure(s);
}
