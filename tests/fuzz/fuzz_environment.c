/* SPDX-License-Identifier: MIT
 *
 * Opens random bytes as a baked environment, with valid magic, version, size
 * and checksum, and parses them as the text of an environment. All tables of an
 * accepted file must have the sizes of its header.
 *
 *     make fuzz FUZZ=environment SECONDS=60
 */
#include <math.h>

#include "fuzz/fuzz.h"
#include "glint/scene/environment_bake.h"

/* Reads every byte that a lookup may read, so that sanitizers detect
 * overreads. */
static void read_all_texels(const struct glint_environment *e)
{
    const unsigned char *byte;
    volatile unsigned sum = 0;

    for (uint32_t k = 0; k < e->header->n_levels; k++) {
        const size_t texels = (size_t)1 << (2 * e->level[k].side_log2);

        byte = e->texel[k];
        for (size_t i = 0; i < 4 * texels; i++)
            sum += byte[i];
    }
    for (size_t i = 0; i < 1024; i++)
        sum += e->irradiance[i];
    for (uint32_t i = 0; i < e->header->n_lights; i++)
        require(e->light[i].radius_q30 >= 0 &&
                e->light[i].rgb[2].mantissa >= 0);
}

static void open_environment_blob(const uint8_t *data, size_t size)
{
    unsigned char *copy = fuzz_blob(data, size, GLINT_ENVIRONMENT_MAGIC,
                                    GLINT_ENVIRONMENT_VERSION);
    struct glint_environment environment;
    const char *reason = NULL;

    if (glint_environment_open(&environment, copy, size, &reason) == GLINT_OK)
        read_all_texels(&environment);
    else
        require(reason && *reason);
    free(copy);
}

static void parse_environment_text(const uint8_t *data, size_t size)
{
    struct glint_environment_options o;
    char source[GLINT_ENVIRONMENT_FILE_BYTES];
    struct glint_error error = {""};

    if (glint_environment_parse(&o, source, (const char *)data, size, "x",
                                &error) == GLINT_OK)
        require(source[0] && isfinite(o.scale) && o.scale > 0 &&
                fabs(o.turn_deg) <= 360 && o.max_lights <= 16);
    else
        require(error.text[0]);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    open_environment_blob(data, size);
    parse_environment_text(data, size);
    return 0;
}
