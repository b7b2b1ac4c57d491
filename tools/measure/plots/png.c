/* SPDX-License-Identifier: MIT
 *
 * PNG as a data: URI, encoded by the image plug-in.
 */
#include <stdlib.h>
#include <string.h>

#include "measure/plots/plot.h"
#include "formats/oiio.h"

static void write_base64(FILE *file, const uint8_t *data, size_t n)
{
    static const char digit[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

    for (size_t i = 0; i < n; i += 3) {
        const uint32_t v = (uint32_t)data[i] << 16 |
                           (uint32_t)(i + 1 < n ? data[i + 1] : 0) << 8 |
                           (uint32_t)(i + 2 < n ? data[i + 2] : 0);

        fputc(digit[v >> 18], file);
        fputc(digit[v >> 12 & 63], file);
        fputc(i + 1 < n ? digit[v >> 6 & 63] : '=', file);
        fputc(i + 2 < n ? digit[v & 63] : '=', file);
    }
}

bool html_can_write_png(void)
{
    const struct glint_oiio *oiio;
    struct glint_error error;

    return glint_oiio_load(&oiio, &error) == GLINT_OK;
}

void html_write_png(FILE *file, const uint8_t *rgb, int width, int height)
{
    const size_t row = 3 * (size_t)width, n = row * (size_t)height;
    struct glint_oiio_pixels pixels = {.width = width, .height = height};
    const struct glint_oiio *oiio;
    struct glint_error error;
    void *data = NULL;
    size_t bytes = 0;

    if (glint_oiio_load(&oiio, &error) != GLINT_OK || !(pixels.rgb = malloc(n)))
        return;
    memcpy(pixels.rgb, rgb, n);
    if (oiio->encode(&data, &bytes, "x.png", &pixels, (ptrdiff_t)row, &error) ==
        GLINT_OK) {
        fputs("data:image/png;base64,", file);
        write_base64(file, data, bytes);
        free(data);
    }
    free(pixels.rgb);
}
