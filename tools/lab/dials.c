/* SPDX-License-Identifier: MIT */
#include "lab/dials.h"

#include <math.h>

/* Values go from the finest on. The last list of each dial has the values that
 * are combined with those of other dials. Some dials are not combined: apart
 * and max_lights lose more than they save, wavelengths loses colour, each
 * tolerance takes a bake, and tile changes no picture. */
/* clang-format off */
const struct dial dials[] = {
    {"grid", "fineness of grids", DIAL_GRID, 64, false, false,
     9, 5, {256, 192, 128, 96, 64, 48, 32, 24, 16}, {128, 64, 40, 24, 16}},
    {"quantum", "steps of irradiance, %", DIAL_QUANTUM, 1, false, false,
     8, 4, {0, 0.25, 0.5, 1, 2, 4, 8, 16}, {0.25, 1, 3, 8}},
    {"cull", "what is left out, codes", DIAL_CULL, 0.125, false, false,
     7, 2, {0, 0.0625, 0.125, 0.25, 0.5, 1, 2}, {0.125, 0.5}},
    {"dim", "dim ghosts share rays, codes", DIAL_DIM, 0, false, true,
     7, 0, {0, 0.5, 1, 2, 4, 8, 16}, {0}},
    {"whole", "edges on whole pixels, codes", DIAL_WHOLE, 4, false, false,
     6, 2, {0, 1, 2, 4, 8, 16}, {1, 4}},
    {"half", "half as many pixels each way", DIAL_HALF, 0, false, false,
     2, 2, {0, 1}, {0, 1}},
    {"tolerance", "errors of the model", DIAL_TOLERANCE, 1, true, false,
     3, 0, {0.25, 1, 4}, {1}},
    {"wavelengths", "wavelengths", DIAL_WAVELENGTHS, 3, true, false,
     2, 0, {3, 1}, {3}},
    {"tile", "log2 of a tile's side", DIAL_TILE, 6, false, false,
     3, 0, {6, 5, 4}, {6}},
    {"apart", "lights nearer are one, pixels", DIAL_APART, 0.125, false, true,
     4, 0, {0.125, 0.5, 2, 8}, {0.125}},
    {"max_lights", "lights that are drawn", DIAL_MAX_LIGHTS, 128, false, true,
     4, 0, {128, 16, 8, 4}, {128}},
};
/* clang-format on */
const int n_dials = sizeof dials / sizeof *dials;

typedef char
    glint_dials_fit[sizeof dials / sizeof *dials <= MAX_DIALS ? 1 : -1];

void dial_set(struct settings *s, const struct dial *dial, double value)
{
    const int whole = (int)value;

    switch (dial->id) {
    case DIAL_GRID:
        s->dials.fineness = whole;
        /* no limit of work, which would make grids coarser */
        s->options.work = 0;
        GLINT_OPTION_GIVEN(&s->options, work) = true;
        break;
    case DIAL_QUANTUM:
        s->quantum = value;
        s->dials.irradiance_steps = glint_quality_steps(value);
        break;
    case DIAL_CULL:
        s->dials.cull_codes = value;
        break;
    case DIAL_DIM:
        s->dials.dim_codes = value;
        break;
    case DIAL_WHOLE:
        s->dials.snap_codes_q8 = (int)lrint(value * 256);
        break;
    case DIAL_HALF:
        s->dials.flags &= ~(unsigned)GLINT_DIAL_HALF;
        s->dials.flags |= value != 0 ? GLINT_DIAL_HALF : 0;
        break;
    case DIAL_TOLERANCE:
        s->tolerance = value;
        break;
    case DIAL_WAVELENGTHS: /* 1: the middle wavelength alone, in grey */
        s->n_wavelengths = whole;
        s->wavelength_nm[0] = whole == 1 ? 532 : 650;
        break;
    case DIAL_TILE:
        s->options.tile = whole - 3;
        break;
    case DIAL_APART:
        s->options.apart = value;
        break;
    case DIAL_MAX_LIGHTS:
        s->options.max_lights = whole;
        break;
    }
}

double dial_get(const struct settings *s, const struct dial *dial)
{
    switch (dial->id) {
    case DIAL_GRID:
        return s->dials.fineness;
    case DIAL_QUANTUM:
        return s->quantum;
    case DIAL_CULL:
        return s->dials.cull_codes;
    case DIAL_DIM:
        return s->dials.dim_codes;
    case DIAL_WHOLE:
        return s->dials.snap_codes_q8 / 256.0;
    case DIAL_HALF:
        return (s->dials.flags & GLINT_DIAL_HALF) != 0;
    case DIAL_TOLERANCE:
        return s->tolerance;
    case DIAL_WAVELENGTHS:
        return s->n_wavelengths;
    case DIAL_TILE:
        return s->options.tile + 3;
    case DIAL_APART:
        return s->options.apart;
    case DIAL_MAX_LIGHTS:
        return s->options.max_lights;
    }
    return 0;
}
