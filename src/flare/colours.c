/* SPDX-License-Identifier: MIT
 *
 * Computes the three default wavelengths of a frame, and their colours and
 * weights. It uses integers, for programs without floating point. */
#include "base/real.h"
#include "glint/flare.h"

/* Returns the flux of the lens's direct image (the light that is not
 * reflected), mm^2, with FRAC fraction bits. W_Q30 is the wavelength as a
 * position in the wavelength range of model H, -1 .. 1. Each coefficient of the
 * polynomial is clamped to 2^27, so that sums stay below 2^30. */
static int32_t compute_direct_image_flux(const struct glint_model_header *h,
                                         int32_t w_q30, int frac)
{
    int32_t flux = 0;

    for (int k = GLINT_FLUX_TERMS - 1; k >= 0; k--)
        flux = q_mul(flux, w_q30, 30) +
               (int32_t)real_integer(h->direct_flux[k], frac, 1 << 27);
    return flux;
}

void glint_flare_waves(struct glint_wave wave[GLINT_FLARE_WAVES],
                       const struct glint_lens *lens)
{
    static const int32_t wave_q24[GLINT_FLARE_WAVES] = {
        Q_CONST(1 / (0.650 * 0.650), 24), Q_CONST(1 / (0.532 * 0.532), 24),
        Q_CONST(1 / (0.450 * 0.450), 24)};
    const struct glint_model_header *h = lens->header;
    /* number of fraction bits with which the polynomial's constant term has 27
     * bits */
    const int frac = -4 - h->direct_flux[0].exponent;
    const int32_t band_q24 = h->wave_hi_q24 - h->wave_lo_q24;

    for (int i = 0; i < GLINT_FLARE_WAVES; i++) {
        const int64_t off_q24 = q_clamp_sat(2 * (int64_t)wave_q24[i] -
                                                h->wave_lo_q24 - h->wave_hi_q24,
                                            -band_q24, band_q24);
        const int32_t w_q30 = q_narrow(q_divide(off_q24 * (1 << 30), band_q24));
        const int32_t flux = compute_direct_image_flux(h, w_q30, frac);

        wave[i] = (struct glint_wave){.wave_q24 = wave_q24[i]};
        wave[i].rgb_q14[i] = 1 << 14;
        if (flux > 0)
            wave[i].weight =
                real_of(q_divide(INT64_C(1) << 60, flux), frac - 60);
    }
}
