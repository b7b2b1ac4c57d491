/* SPDX-License-Identifier: MIT
 *
 * Reads random bytes as PPM, PGM or PFM. Of an accepted image, every sample
 * must be readable, the file must be larger than its samples, and writing the
 * image must succeed.
 *
 *     make fuzz FUZZ=pnm SECONDS=60
 */
#include "formats/pnm.h"
#include "fuzz/fuzz.h"

/* global, so that the compiler cannot remove the reads */
unsigned glint_fuzz_sink;

static void open_null_output(struct glint_output *out)
{
    struct glint_error error;

    require(!glint_output_open(out, "/dev/null", GLINT_OUTPUT_BINARY, &error));
}

static void parse_pnm_input(const uint8_t *data, size_t size)
{
    struct glint_image image;
    struct glint_error error;
    struct glint_output out;
    size_t n;

    if (glint_pnm_read(&image, data, size, "fuzz", &error)) {
        require(!memcmp(error.text, "fuzz: ", 6));
        return;
    }
    n = glint_image_bytes(image.format, image.width, image.height);
    require(n > 0 && n < size);
    for (size_t i = 0; i < n; i++)
        glint_fuzz_sink += image.plane[0][i];
    if (image.format == GLINT_RGB24) {
        open_null_output(&out);
        require(!glint_pnm_write(&out, &image, &error));
        require(!glint_output_commit(&out, &error));
    }
    free(image.plane[0]);
}

static void parse_pfm_input(const uint8_t *data, size_t size)
{
    struct glint_float_image floats;
    struct glint_error error;
    struct glint_output out;

    if (glint_pfm_read(&floats, data, size, "fuzz", &error)) {
        require(!memcmp(error.text, "fuzz: ", 6));
        return;
    }
    require(floats.width >= 1 && floats.width <= GLINT_MAX_SIDE);
    require(floats.height >= 1 && floats.height <= GLINT_MAX_SIDE);
    require(4 * (size_t)floats.width * (size_t)floats.height < size);
    open_null_output(&out);
    require(!glint_pfm_write(&out, &floats, &error));
    require(!glint_output_commit(&out, &error));
    free(floats.rgb);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    parse_pnm_input(data, size);
    parse_pfm_input(data, size);
    return 0;
}
