/* SPDX-License-Identifier: MIT */
#include "options/dials.h"

#include <stddef.h>
#include <string.h>

#define AT(field) offsetof(struct scene, field)

/* Finest first. Together are those that are worth combining: raster, apart and
 * lights give up more than they save, wavelengths colour, and tile changes no
 * picture. */
/* clang-format off */
const struct dial dials[] = {
    {"grid", "fineness of grids", DIAL_INT, AT(grid), 64, false, false,
     9, 5, {256, 192, 128, 96, 64, 48, 32, 24, 16}, {128, 64, 40, 24, 16}},
    {"quantum", "steps of irradiance, %", DIAL_DOUBLE, AT(quantum), 1, false, false,
     8, 4, {0, 0.25, 0.5, 1, 2, 4, 8, 16}, {0.25, 1, 3, 8}},
    {"cull", "what is left out, codes", DIAL_DOUBLE, AT(cull), 0.125, false, false,
     7, 2, {0, 0.0625, 0.125, 0.25, 0.5, 1, 2}, {0.125, 0.5}},
    {"whole", "edges on whole pixels, codes", DIAL_DOUBLE, AT(whole_codes), 4, false, false,
     6, 2, {0, 1, 2, 4, 8, 16}, {1, 4}},
    {"half", "half as many pixels each way", DIAL_BOOL, AT(half), 0, false, false,
     2, 2, {0, 1}, {0, 1}},
    {"tolerance", "errors of the model", DIAL_DOUBLE, AT(tolerance), 1, true, false,
     3, 0, {0.25, 1, 4}, {1}},
    {"wavelengths", "wavelengths", DIAL_INT, AT(n_wavelengths), 3, true, false,
     2, 0, {3, 1}, {3}},
    {"raster", "by cells", DIAL_INT, AT(raster), 0, false, false,
     2, 0, {0, 1}, {0}},
    {"tile", "log2 of a tile's side", DIAL_INT, AT(tile_log2), 6, false, false,
     3, 0, {6, 5, 4}, {6}},
    {"apart", "lights nearer are one, pixels", DIAL_DOUBLE, AT(apart_px), 0.125, false, true,
     4, 0, {0.125, 0.5, 2, 8}, {0.125}},
    {"max_lights", "lights that are drawn", DIAL_INT, AT(max_lights), 128, false, true,
     4, 0, {128, 16, 8, 4}, {128}},
};
/* clang-format on */
const int n_dials = sizeof dials / sizeof *dials;

typedef char
    glint_dials_fit[sizeof dials / sizeof *dials <= MAX_DIALS ? 1 : -1];

void dial_set(struct scene *scene, const struct dial *dial, double value)
{
    void *const at = (char *)scene + dial->at;
    const int whole = (int)value;
    const bool on = value != 0;

    if (dial->kind == DIAL_INT)
        memcpy(at, &whole, sizeof whole);
    else if (dial->kind == DIAL_BOOL)
        memcpy(at, &on, sizeof on);
    else
        memcpy(at, &value, sizeof value);
    /* one wavelength is the middle one, and grey */
    if (dial->at == AT(n_wavelengths))
        scene->wavelength_nm[0] = whole == 1 ? 532 : 650;
}

double dial_get(const struct scene *scene, const struct dial *dial)
{
    const void *const at = (const char *)scene + dial->at;
    int whole;
    bool on;
    double value;

    if (dial->kind == DIAL_INT)
        return memcpy(&whole, at, sizeof whole), whole;
    if (dial->kind == DIAL_BOOL)
        return memcpy(&on, at, sizeof on), on;
    return memcpy(&value, at, sizeof value), value;
}
