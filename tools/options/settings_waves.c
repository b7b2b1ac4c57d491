/* SPDX-License-Identifier: MIT */
#include "options/settings_waves.h"

#include <math.h>
#include <string.h>

/* Wavelengths of exact rays for "auto": they have no plan that could choose for
 * each ghost. */
enum { EXACT_WAVES = 9 };

bool settings_take_waves(struct settings *s, const char *text)
{
    double nm[GLINT_MAX_WAVELENGTHS];
    const int n = tool_numbers(text, nm, GLINT_MAX_WAVELENGTHS);
    const bool is_count = n == 1 && nm[0] >= 1 &&
                          nm[0] <= GLINT_MAX_WAVELENGTHS &&
                          nm[0] == floor(nm[0]);

    if (strcmp(text, "auto") == 0) {
        s->waves = SETTINGS_WAVES_AUTO;
        return true;
    }
    for (int i = 0; i < n && !is_count; i++)
        if (nm[i] < 300 || nm[i] > 1100)
            return false;
    if (n == 0)
        return false;
    s->waves = is_count ? SETTINGS_WAVES_COUNT : SETTINGS_WAVES_LIST;
    s->n_wavelengths = is_count ? (int)nm[0] : n;
    memcpy(s->wavelength_nm, nm, sizeof nm);
    return true;
}

void settings_choose_waves(struct settings *s)
{
    double rgb[GLINT_MAX_WAVELENGTHS][3], share[GLINT_MAX_WAVELENGTHS];

    if (s->waves == SETTINGS_WAVES_AUTO && s->rays == SETTINGS_RAYS_EXACT) {
        s->waves = SETTINGS_WAVES_COUNT;
        s->n_wavelengths = EXACT_WAVES;
    }
    if (s->waves == SETTINGS_WAVES_COUNT)
        glint_spectrum(s->n_wavelengths, s->wavelength_nm, rgb, share);
}

void settings_weigh(struct settings *s)
{
    if (s->waves == SETTINGS_WAVES_COUNT)
        glint_setup_weigh(&s->setup);
    /* A model of the sparse basis holds its three wavelengths and no others. */
    else if (s->waves == SETTINGS_WAVES_AUTO && s->model.data &&
             s->model.lens.header->basis != GLINT_BASIS_SPARSE)
        glint_setup_spread(&s->setup, &s->model.lens);
}
