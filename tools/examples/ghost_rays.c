/* SPDX-License-Identifier: MIT
 *
 * ghost_rays MODEL GHOST SINE - prints the points at which a fan of rays of a
 * ghost meets the sensor. SINE is the sine of the angle between the light and
 * the axis. Links only glint's transfer polynomials.
 */
#include <math.h>

#include "glint/transfer.h"
#include "model.h"

enum { FAN = 9 };

/* Prints a fan of rays of GHOST in the meridional plane, at the middle
 * wavelength. */
static int print_ray_fan(const struct glint_lens *lens, int ghost, double sine)
{
    static struct glint_transfer transfer; /* static, as it is too large for
                                              small stacks */
    const struct glint_model_header *h = lens->header;
    const int32_t wave_q24 = h->wave_lo_q24 / 2 + h->wave_hi_q24 / 2;

    if (!glint_transfer_init(&transfer, lens, ghost, (int32_t)(sine * 0x1p30),
                             wave_q24)) {
        printf("no ray gets through\n");
        return 0;
    }
    printf("u,x_mm,stop_x,energy\n");
    for (int i = 0; i < FAN; i++) {
        const int32_t u_q30 = (i - FAN / 2) * ((1 << 30) / (FAN / 2));
        struct glint_outputs out;

        glint_transfer_ray(&transfer, u_q30, 0, &out);
        printf("%.2f,%.5f,%.5f,%.3g\n", u_q30 * 0x1p-30,
               ldexp(out.at[GLINT_OUT_SENSOR_X],
                     transfer.exponent[GLINT_OUT_SENSOR_X]),
               ldexp(out.at[GLINT_OUT_STOP_X],
                     transfer.exponent[GLINT_OUT_STOP_X]),
               ldexp(out.at[GLINT_OUT_ENERGY],
                     transfer.exponent[GLINT_OUT_ENERGY]));
    }
    return 0;
}

int main(int argc, char **argv)
{
    struct glint_lens lens;
    void *data;
    int code = 5;

    if (argc != 4 || !(atof(argv[3]) >= 0 && atof(argv[3]) < 1)) {
        fprintf(stderr, "ghost_rays MODEL GHOST SINE\n");
        return 2;
    }
    data = model_read(argv[1], &lens);
    if (!data)
        return 5;
    if (atoi(argv[2]) < 0 || atoi(argv[2]) >= (int)lens.header->n_ghosts)
        fprintf(stderr, "%s: has ghosts 0 to %d\n", argv[1],
                (int)lens.header->n_ghosts - 1);
    else
        code = print_ray_fan(&lens, atoi(argv[2]), atof(argv[3]));
    free(data);
    return code;
}
