/* SPDX-License-Identifier: MIT */
#include "bake/fit/zone_fit.h"

enum {
    FEW_TERMS = 64,
    MANY_TERMS = 96, /* terms of each output of places in thorough fits */
    PATIENCE = 36    /* number of terms after which a hopeless fit stops */
};

static const struct glint_degrees position_degrees = {
    .most = {GLINT_MAX_POWER, 8, 5, 4},
    .weight = {1, 1, 1, 2},
    .total = 12,
    .terms = FEW_TERMS};

static const struct glint_degrees energy_degrees = {.most = {6, 4, 4, 8},
                                                    .weight = {1, 1, 1, 1},
                                                    .total = 10,
                                                    .terms = FEW_TERMS};

/* Terms of thorough fits of energies that change a lot over the pupil, and of
 * all energies of wide stops, as films make them swing with angle and
 * wavelength at once. */
static const struct glint_degrees steep_degrees = {.most = {8, 6, 4, 8},
                                                   .weight = {1, 1, 1, 1},
                                                   .total = 12,
                                                   .terms = MANY_TERMS};

/* Terms of skew zones, whose powers of s, p and w are below
 * GLINT_LENS_POWERS and GLINT_LENS_WAVE_POWERS. */
static const struct glint_degrees skew_degrees = {
    .most = {GLINT_MAX_POWER, 8, 5, 4, 5},
    .weight = {1, 1, 1, 2, 1},
    .total = 10,
    .terms = MANY_TERMS};
static const struct glint_degrees skew_energy_degrees = {
    .most = {8, 8, 4, 6, 4},
    .weight = {1, 1, 1, 1, 1},
    .total = 10,
    .terms = MANY_TERMS};

struct glint_degrees glint_zone_degrees(const struct glint_zone_task *task,
                                        enum glint_channel kind, bool steep)
{
    const bool energy = kind == GLINT_OUT_ENERGY, wide = task->visible->wide;
    const bool skew = task->zone->skew;
    struct glint_degrees degrees =
        skew      ? energy ? skew_energy_degrees : skew_degrees
        : !energy ? position_degrees
        : task->thorough && (wide || steep) ? steep_degrees
                                            : energy_degrees;

    if (task->thorough && !energy)
        degrees.terms = MANY_TERMS;
    degrees.hopeless = energy ? 0 : task->hopeless;
    degrees.patience = PATIENCE;
    degrees.leaps = wide;
    degrees.parity =
        skew ? -1 : kind == GLINT_OUT_SENSOR_Y || kind == GLINT_OUT_STOP_Y;
    return degrees;
}
