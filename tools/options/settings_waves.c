/* SPDX-License-Identifier: MIT */
#include "options/settings_waves.h"

/* Wavelengths of exact rays for "auto": they have no plan that could choose for
 * each ghost. */
enum { EXACT_WAVES = 9 };

void settings_choose_waves(struct settings *s)
{
    double rgb[GLINT_MAX_WAVELENGTHS][3], share[GLINT_MAX_WAVELENGTHS];

    if (s->waves == GLINT_WAVES_AUTO && s->options.rays == GLINT_RAYS_EXACT) {
        s->waves = GLINT_WAVES_COUNT;
        s->n_wavelengths = EXACT_WAVES;
    }
    if (s->waves == GLINT_WAVES_COUNT)
        glint_spectrum(s->n_wavelengths, s->wavelength_nm, rgb, share);
}

void settings_weigh(struct settings *s)
{
    if (s->waves == GLINT_WAVES_COUNT)
        glint_setup_weigh(&s->setup);
    /* A model of the sparse basis holds its three wavelengths and no others. */
    else if (s->waves == GLINT_WAVES_AUTO && s->model.data &&
             s->model.lens.header->basis != GLINT_BASIS_SPARSE)
        glint_setup_spread(&s->setup, &s->model.lens);
}
