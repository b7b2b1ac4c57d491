/* SPDX-License-Identifier: MIT
 *
 * ghost_rays MODEL GHOST SINE - where a fan of rays of a ghost lands, for a
 * light whose angle off the axis has that sine. Links of glint the transfer
 * alone.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "glint/lens.h"

enum { FAN = 9 };

/* The whole file, to be freed. NULL: it cannot be read. */
static void *read_all(const char *path, size_t *bytes)
{
    FILE *file = fopen(path, "rb");
    char *data = NULL;
    long size = -1;

    if (file && fseek(file, 0, SEEK_END) == 0)
        size = ftell(file);
    if (size > 0 && fseek(file, 0, SEEK_SET) == 0)
        data = malloc((size_t)size);
    if (data && fread(data, 1, (size_t)size, file) != (size_t)size) {
        free(data);
        data = NULL;
    }
    if (file)
        fclose(file);
    *bytes = (size_t)size;
    return data;
}

/* Of the middle of the band, in the plane of the light. */
static int print_fan(const struct glint_lens *lens, int ghost, double sine)
{
    static struct glint_transfer transfer; /* too large for small stacks */
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
    const char *reason = "cannot be read";
    struct glint_lens lens;
    size_t bytes;
    void *data;
    int code = 5;

    if (argc != 4 || !(atof(argv[3]) >= 0 && atof(argv[3]) < 1)) {
        fprintf(stderr, "ghost_rays MODEL GHOST SINE\n");
        return 2;
    }
    data = read_all(argv[1], &bytes);
    if (!data || glint_lens_open(&lens, data, bytes, &reason) != GLINT_OK)
        fprintf(stderr, "%s: %s\n", argv[1], reason);
    else if (atoi(argv[2]) < 0 || atoi(argv[2]) >= (int)lens.header->n_ghosts)
        fprintf(stderr, "%s: has ghosts 0 to %d\n", argv[1],
                (int)lens.header->n_ghosts - 1);
    else
        code = print_fan(&lens, atoi(argv[2]), atof(argv[3]));
    free(data);
    return code;
}
