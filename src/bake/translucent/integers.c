/* SPDX-License-Identifier: MIT
 *
 * Scatters light with the run time's integer code, for comparison with fits in
 * doubles.
 */
#include <math.h>
#include <stdlib.h>

#include "glint/scene/stone_bake.h"
#include "scene/translucent/spread.h"

enum { CHANNELS = 3, FULL = 32767 };

/* Sets the integer light of S, per texel, to IRRADIANCE. Returns the integer
 * that represents irradiance 1. */
static double set_integer_light(const struct glint_spread *s,
                                const double *irradiance)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    double most = 0;

    for (size_t i = 0; i < CHANNELS * n; i++)
        most = fmax(most, irradiance[i]);
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < CHANNELS; c++)
            s->light[c][i] =
                (int16_t)(most > 0
                              ? lrint(fmax(irradiance[CHANNELS * i + c], 0) /
                                      most * FULL)
                              : 0);
    return most > 0 ? FULL / most : 1;
}

enum glint_status glint_stone_light(const struct glint_translucent *stone,
                                    const double *irradiance, double *radiosity)
{
    const int side = 1 << stone->header->side_log2;
    const size_t n = (size_t)side * (size_t)side;
    struct glint_arena arena = glint_arena_begin_measuring();
    struct glint_spread s = {.stone = stone,
                             .convolve = glint_convolve_c,
                             .width = side,
                             .height = side};
    struct glint_spread_scratch scratch;
    void *mem;

    glint_spread_carve(&arena, stone, side);
    mem = malloc(arena.used + GLINT_ALIGN + 2 * CHANNELS * n * sizeof(int16_t));
    if (!mem)
        return GLINT_E_MEMORY;
    arena = glint_arena_init_in_memory((uint8_t *)mem + GLINT_ALIGN -
                                           (uintptr_t)mem % GLINT_ALIGN,
                                       arena.used);
    scratch = glint_spread_carve(&arena, stone, side);
    for (size_t c = 0; c < CHANNELS; c++) {
        s.light[c] = (int16_t *)(void *)(arena.base + arena.used) + 2 * c * n;
        s.map[c] = s.light[c] + n;
    }
    {
        const double one = set_integer_light(&s, irradiance);

        for (int c = 0; c < CHANNELS; c++)
            for (int x = 0; x < side; x += GLINT_STRIP)
                glint_spread_light_in_strip(&s, c, x, 0, side, &scratch);
        for (size_t i = 0; i < n; i++)
            for (size_t c = 0; c < CHANNELS; c++)
                radiosity[CHANNELS * i + c] = s.map[c][i] / one;
    }
    free(mem);
    return GLINT_OK;
}
