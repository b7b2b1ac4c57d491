/* SPDX-License-Identifier: MIT
 *
 * Where the materials of a stone are.
 */
#include <math.h>
#include <string.h>

#include "bake/translucent/slab.h"

enum { OCTAVES = 4 };

/* A number 0 .. 1 of a place of a lattice. */
static double hashed(uint32_t seed, int x, int y)
{
    uint32_t h = seed * UINT32_C(0x9e3779b1) ^
                 (uint32_t)x * UINT32_C(0x85ebca6b) ^
                 (uint32_t)y * UINT32_C(0xc2b2ae35);

    h = (h ^ h >> 15) * UINT32_C(0x2c1b3c6d);
    h = (h ^ h >> 12) * UINT32_C(0x297a2d39);
    return (h ^ h >> 15) / 4294967295.0;
}

static double smooth(double t)
{
    return t * t * (3 - 2 * t);
}

/* Noise of CELLS x CELLS cells over places 0 .. 1, which goes on at its edges;
 * 0 .. 1. */
static double noise(uint32_t seed, int cells, double u, double v)
{
    const int x = (int)floor(u * cells), y = (int)floor(v * cells);
    const int right = (x + 1) % cells, below = (y + 1) % cells;
    const double s = smooth(u * cells - x), t = smooth(v * cells - y);
    const double top =
        (1 - s) * hashed(seed, x, y) + s * hashed(seed, right, y);
    const double bottom =
        (1 - s) * hashed(seed, x, below) + s * hashed(seed, right, below);

    return (1 - t) * top + t * bottom;
}

/* Veins run where a wave across the stone, bent by noise, is near 0. The stone
 * goes on at its edges, since it meets itself around a ball: the wave has whole
 * numbers of halves along both. */
static double vein(uint32_t seed, double u, double v)
{
    enum { CELLS = 3, ALONG_U = 3, ALONG_V = 2 };
    double bent = 0, wave;

    for (int i = 0; i < OCTAVES; i++)
        bent += ldexp(noise(seed + (uint32_t)i, CELLS << i, u, v) - 0.5, -i);
    wave = fabs(sin((ALONG_U * u + ALONG_V * v) * 3.14159265358979 + 5 * bent));
    return wave >= 0.4 ? 1 : smooth(fmax(0, (wave - 0.1) / 0.3));
}

void glint_stone_shares(const struct glint_stone *stone, double *share)
{
    const int side = stone->side;

    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            double *to = &share[y * side + x];

            switch (stone->pattern) {
            case GLINT_STONE_CHESS:
                *to =
                    (x * stone->fields / side + y * stone->fields / side) % 2 ==
                    0;
                break;
            case GLINT_STONE_VEINS:
                *to = vein(stone->seed, (x + 0.5) / side, (y + 0.5) / side);
                break;
            case GLINT_STONE_MASK:
                *to = stone->mask[y * side + x];
                break;
            case GLINT_STONE_EVEN:
            default:
                *to = 1;
            }
        }
}
