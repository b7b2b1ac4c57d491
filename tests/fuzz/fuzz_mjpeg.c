/* SPDX-License-Identifier: MIT
 *
 * Decodes random bytes as an MJPEG frame of up to 256 x 128 pixels. A valid
 * frame must decode to the same samples again after a frame truncated in the
 * middle.
 *
 *     make fuzz FUZZ=mjpeg SECONDS=60
 */
#include "fuzz/fuzz.h"
#include "jpeg/mjpeg.h"

/* Returns a hash of all samples; reading them reveals uninitialised ones to
 * memory checkers. */
static uint32_t hash_samples(const struct glint_image *image)
{
    uint32_t hash = 2166136261U;

    for (int p = 0; p < glint_image_planes(image->format); p++) {
        const int across =
            (int)glint_image_row_bytes(image->format, p, image->width);
        const int down =
            glint_image_plane_height(image->format, p, image->height);

        for (int y = 0; y < down; y++)
            for (int x = 0; x < across; x++)
                hash =
                    (hash ^ image->plane[p][y * image->stride_bytes[p] + x]) *
                    16777619U;
    }
    return hash;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct glint_mjpeg *decoder;
    struct glint_image image, again;
    struct glint_error error;
    enum glint_status status;
    uint32_t hash;

    require(!glint_mjpeg_open(&decoder, "fuzz", 256, 128, &error));
    status = glint_mjpeg_decode(decoder, data, size, &image, &error);
    if (status == GLINT_OK) {
        require(image.width >= 1 && image.width <= 256);
        require(image.height >= 1 && image.height <= 128);
        hash = hash_samples(&image);
        glint_mjpeg_decode(decoder, data, size / 2, &again, &error);
        require(!glint_mjpeg_decode(decoder, data, size, &again, &error));
        require(again.format == image.format && hash_samples(&again) == hash);
    } else
        require(error.text[0]);
    glint_mjpeg_close(decoder);
    return 0;
}
