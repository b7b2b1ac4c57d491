/* SPDX-License-Identifier: MIT */
#include "engine/frame/light.h"

#include <math.h>

static const double degree = GLINT_PI / 180;

static struct glint_real normalise_rgb(const double rgb[3], int32_t rgb_q14[3])
{
    const double most = fmax(fabs(rgb[0]), fmax(fabs(rgb[1]), fabs(rgb[2])));

    for (int c = 0; c < 3; c++)
        rgb_q14[c] = most > 0 ? (int32_t)lrint(rgb[c] / most * 16384) : 0;
    return glint_real_of(most);
}

struct glint_wave glint_wave_from_nm(double nm, const double rgb[3],
                                     double unit_flux)
{
    struct glint_wave w;
    const double size = glint_real_value(normalise_rgb(rgb, w.rgb_q14));

    w.wave_q24 = (int32_t)lrint(1e6 / (nm * nm) * 0x1p24);
    w.weight = glint_real_of(size / unit_flux);
    return w;
}

struct glint_light glint_light_from_lamp(const struct glint_lamp *l,
                                         double scale)
{
    struct glint_light b;
    const double size = glint_real_value(normalise_rgb(l->rgb, b.rgb_q14));
    const double power = size * l->power * scale;

    b.sine_q30 = (int32_t)lrint(sin(l->theta_deg * degree) * 0x1p30);
    b.cosine_q30 = (int32_t)lrint(cos(l->theta_deg * degree) * 0x1p30);
    b.cos_q30 = (int32_t)lrint(cos(l->phi_deg * degree) * 0x1p30);
    b.sin_q30 = (int32_t)lrint(sin(l->phi_deg * degree) * 0x1p30);
    b.apart_q30 = 0;
    b.power = glint_real_of(isfinite(power) && power > 0 ? power : 0);
    return b;
}

struct glint_lamp glint_lamp_from_light(const struct glint_light *light)
{
    return (struct glint_lamp){
        .theta_deg = atan2(light->sine_q30, light->cosine_q30) / degree,
        .phi_deg = atan2(light->sin_q30, light->cos_q30) / degree,
        .power = glint_real_value(light->power),
        .rgb = {light->rgb_q14[0] * 0x1p-14, light->rgb_q14[1] * 0x1p-14,
                light->rgb_q14[2] * 0x1p-14}};
}

int glint_light_is_outside_model(const struct glint_lens *lens,
                                 const struct glint_light *light)
{
    return lens && light->sine_q30 > lens->header->sine_hi_q30;
}
