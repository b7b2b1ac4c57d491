/* SPDX-License-Identifier: MIT */
#include "glint/quality.h"

#include <math.h>
#include <stddef.h>

#include "glint/light.h"

/* max number of lights at all quality levels; 128 lights cost less than three
 * times as much as 64 */
enum { MAX_LIGHTS = 128 };

/* Quality levels, the coarsest first: points on the Pareto front of time and
 * error that glint sweep measures over five lenses at 1280x720. Members are
 * parameters of struct glint_quality; grid is the fineness. tolerance: coarser
 * models save no time and cost 6 dB; finer ones cost only memory and time to
 * bake, so all levels above the default have them. dispersion has a separate
 * Pareto front (make colour-table); the four coarsest levels draw three
 * wavelengths (0). dim: levels below the default draw dim ghosts with the rays
 * of one wavelength, and merge near lights, which may be farther apart the
 * dimmer the ghost; this halves the time of a frame with many lights. still:
 * the four coarsest levels reuse traced rays while lamps of a video move by
 * less than a quarter of a pixel, with 55 dB or more (make reuse-table). cull:
 * levels from the default up leave out ghosts below an eighth of a code, of
 * which even hundreds together are invisible. */
/* clang-format off */
static const struct level {
    double quality, grid, quantum, snap, cull, dim, tolerance, dispersion, points;
    double still;
    bool half;
} level[] = {
    {0,      16, 8,      32,  1,  8,     1,    0,    1,  0.25, true},
    {0.0625, 64, 1,      4,   1,  8,     1,    0,    1,  0.25, true},
    {0.125,  20, 3,      8,   0.5,  4,   1,    0,    1,  0.25, false},
    {0.25,   32, 1,      4,   0.5,  1,   1,    0,    1,  0.25, false},
    {0.375,  40, 1,      4,   0.5,  0.25,   1,    2,  8.5,  0, false},
    {0.5,    64, 1,      4,   0.125,  0, 1,    1,   16,  0, false},
    {0.625,  96, 0.5,    2,   0.125,  0, 0.25, 1, 28.5,  0, false},
    {0.75,  160, 0.25,   1,   0.125,  0, 0.25, 0.5,  46,  0, false},
    {0.875, 192, 0.125,  0.5, 0.125,  0, 0.25, 0.5,  91,  0, false},
    {1,     256, 0.0625, 0,   0.125,  0, 0.25, 0.25, 151, 0, false},
};
/* clang-format on */

typedef char
    levels_fit[sizeof level / sizeof *level == GLINT_QUALITY_LEVELS ? 1 : -1];

const char *const glint_quality_name[GLINT_QUALITY_NAMES + 1] = {
    "least", "draft", "default", "high", "finest", NULL};

double glint_quality_named(int name)
{
    return (double)name / (GLINT_QUALITY_NAMES - 1);
}

/* Interpolates between A and B: returns A for PART = 0 and B for PART = 1. The
 * interpolation is geometric if both are above 0, else linear. */
static double interpolate_geometrically(double a, double b, double part)
{
    return a > 0 && b > 0 ? a * pow(b / a, part) : a + part * (b - a);
}

double glint_quality_place(double quality)
{
    int i = 0;
    double part;

    while (i < GLINT_QUALITY_LEVELS - 2 && level[i + 1].quality <= quality)
        i++;
    part = (quality - level[i].quality) /
           (level[i + 1].quality - level[i].quality);
    part = fmin(fmax(part, 0), 1);
    return level[i].half == level[i + 1].half ? i + part : i + (part >= 0.5);
}

/* Returns the settings at QUALITY, 0 .. 1, interpolated between two quality
 * levels. Settings that cannot be interpolated are those of the nearer level.
 * The model's tolerance is that of the finer level, as finer models cost no
 * time per frame. */
static struct level interpolate_quality_level(double quality)
{
    const double at = glint_quality_place(quality);
    const int below =
        at < GLINT_QUALITY_LEVELS - 1 ? (int)at : GLINT_QUALITY_LEVELS - 2;
    const struct level *a = &level[below], *b = &level[below + 1];
    struct level l = at - below < 0.5 ? *a : *b;

    l.tolerance = at > below ? b->tolerance : a->tolerance;
    l.grid = interpolate_geometrically(a->grid, b->grid, at - below);
    l.quantum = interpolate_geometrically(a->quantum, b->quantum, at - below);
    l.snap = interpolate_geometrically(a->snap, b->snap, at - below);
    l.cull = interpolate_geometrically(a->cull, b->cull, at - below);
    l.dim = interpolate_geometrically(a->dim, b->dim, at - below);
    l.points = interpolate_geometrically(a->points, b->points, at - below);
    l.still = interpolate_geometrically(a->still, b->still, at - below);
    if (a->dispersion > 0 && b->dispersion > 0)
        l.dispersion =
            interpolate_geometrically(a->dispersion, b->dispersion, at - below);
    return l;
}

int glint_quality_steps(double quantum)
{
    return quantum > 0 ? (int)lrint(fmin(4096, fmax(1, 100 * log(2) / quantum)))
                       : 0;
}

struct glint_quality glint_quality_at(double quality)
{
    const struct level l = interpolate_quality_level(quality);

    return (struct glint_quality){
        /* Fineness is a multiple of four cells. */
        .dials = {.fineness = 4 * (int)lrint(l.grid / 4),
                  .irradiance_steps = glint_quality_steps(l.quantum),
                  .snap_codes_q8 = (int)lrint(l.snap * 256),
                  .dispersion_q8 = (int)lrint(l.dispersion * 256),
                  .max_lights = MAX_LIGHTS,
                  .flags = l.half ? GLINT_DIAL_HALF : 0,
                  .cull_codes = l.cull,
                  .dim_codes = l.dim,
                  .still_px = l.still,
                  .dust_log2 = GLINT_SHADE_MOST_LOG2,
                  .area_points = l.points},
        .quantum = l.quantum,
        .tolerance = l.tolerance};
}

struct glint_dials glint_dials_at(int quality_q15)
{
    return glint_quality_at(quality_q15 * 0x1p-15).dials;
}

/* The error of outlines is assumed to be 0.1 pixels at fineness 64, and
 * inversely proportional to the square of the fineness. */
double glint_quality_for_error(double px)
{
    const double grid = 64 * sqrt(0.1 / px);
    int i = 0;

    while (i < 256 && (interpolate_quality_level(i / 256.).half ||
                       interpolate_quality_level(i / 256.).grid < grid))
        i++;
    return i / 256.;
}

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

static int max_int(int a, int b)
{
    return a > b ? a : b;
}

struct glint_dials glint_dials_coarser(struct glint_dials a,
                                       struct glint_dials b)
{
    return (struct glint_dials){
        .fineness = min_int(a.fineness, b.fineness),
        .irradiance_steps = min_int(a.irradiance_steps, b.irradiance_steps),
        .snap_codes_q8 = max_int(a.snap_codes_q8, b.snap_codes_q8),
        .dispersion_q8 = a.dispersion_q8 && b.dispersion_q8
                             ? max_int(a.dispersion_q8, b.dispersion_q8)
                             : 0,
        .max_lights = min_int(a.max_lights, b.max_lights),
        .flags = a.flags | b.flags,
        .cull_codes = fmax(a.cull_codes, b.cull_codes),
        .dim_codes = fmax(a.dim_codes, b.dim_codes),
        .still_px = fmax(a.still_px, b.still_px),
        .dust_log2 = min_int(a.dust_log2, b.dust_log2),
        .area_points = fmin(a.area_points, b.area_points)};
}
