/* SPDX-License-Identifier: MIT
 *
 * Opens random bytes as a baked translucent medium, with valid magic, version,
 * size and checksum, and scatters light in it; then parses the bytes as the
 * text of a medium. No sum may leave its range.
 *
 *     make fuzz FUZZ=stone SECONDS=60
 */
#include <math.h>

#include "fuzz/fuzz.h"
#include "glint/scene/stone_bake.h"

/* Scatters uniform light, then a chequered pattern, in a small map of the
 * translucent medium. */
static void scatter_light_in_small_map(const struct glint_translucent *t)
{
    const size_t side = (size_t)1 << t->header->side_log2;
    const size_t n = 3 * side * side;
    double *light = malloc(2 * n * sizeof *light);

    require(light != NULL);
    for (size_t i = 0; i < n; i++)
        light[i] = i % 7 < 4 ? 1 : .01;
    require(glint_stone_light(t, light, light + n) == GLINT_OK);
    for (size_t i = n; i < 2 * n; i++)
        require(light[i] >= 0 && light[i] <= 1);
    free(light);
}

static void open_translucent_blob(const uint8_t *data, size_t size)
{
    unsigned char *copy = fuzz_blob(data, size, GLINT_TRANSLUCENT_MAGIC,
                                    GLINT_TRANSLUCENT_VERSION);
    struct glint_translucent stone;
    const char *reason = NULL;

    if (glint_translucent_open(&stone, copy, size, &reason) != GLINT_OK)
        require(reason && *reason);
    else if (stone.header->side_log2 == GLINT_TRANSLUCENT_LEAST_LOG2)
        scatter_light_in_small_map(&stone);
    free(copy);
}

static void parse_medium_text(const uint8_t *data, size_t size)
{
    struct glint_stone_text t;
    struct glint_error error = {""};

    if (glint_stone_parse(&t, (const char *)data, size, "x", &error) ==
        GLINT_OK)
        require(t.stone.side >= 32 && t.stone.side <= 256 &&
                t.stone.kernel % 2 == 1 && isfinite(t.stone.texel_mm) &&
                t.fit.kernels >= 1 && t.fit.rank >= 1);
    else
        require(error.text[0]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    open_translucent_blob(data, size);
    parse_medium_text(data, size);
    return 0;
}
