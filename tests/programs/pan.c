/* SPDX-License-Identifier: MIT
 *
 * pan IN FRAMES WxH > OUT.y4m - makes a video of a camera that pans over a
 * photograph, with the noise of a small sensor. The video shows real lamps, and
 * their motion is known. Frame n of N shows the window at x = (width - W) n /
 * N, y = middle + a slow oscillation. The noise is the same in every run.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/rng.h"
#include "formats/picture.h"
#include "video/y4m.h"
#include "options/tool.h"

/* Returns the sum of three uniform random numbers, -6 .. 6 codes. */
static int random_noise(uint32_t *state)
{
    return (int)((rng_bits32(state) >> 16) % 5 + (rng_bits32(state) >> 16) % 5 +
                 (rng_bits32(state) >> 16) % 5) -
           6;
}

static uint8_t clamp_code(double x)
{
    return (uint8_t)(x < 0 ? 0 : x > 255 ? 255 : x + 0.5);
}

/* Converts the window of FROM at (X0, Y0) to TO, BT.601 limited range, with
 * noise on luma. */
static void convert_window_to_ycc(const struct glint_image *from, int x0,
                                  int y0, const struct glint_image *to,
                                  uint32_t *state)
{
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            const uint8_t *p = from->plane[0] +
                               (y0 + y) * from->stride_bytes[0] + 3 * (x0 + x);
            const double r = p[0], g = p[1], b = p[2];
            const double luma = 0.299 * r + 0.587 * g + 0.114 * b;

            to->plane[0][y * to->stride_bytes[0] + x] =
                clamp_code(16 + luma * 219 / 255 + random_noise(state));
            if (x & 1 || y & 1)
                continue;
            to->plane[1][y / 2 * to->stride_bytes[1] + x / 2] =
                clamp_code(128 + (b - luma) / 1.772 * 224 / 255);
            to->plane[2][y / 2 * to->stride_bytes[2] + x / 2] =
                clamp_code(128 + (r - luma) / 1.402 * 224 / 255);
        }
}

static int write_pan_video(const struct glint_image *photo, int n, int width,
                           int height)
{
    struct glint_error error = {""};
    struct glint_image frame = {
        .format = GLINT_I420, .width = width, .height = height};
    void *mem = malloc(glint_image_bytes(GLINT_I420, width, height));
    struct glint_y4m_header header;
    struct glint_y4m_writer out;
    uint32_t state = 1;
    enum glint_status status;

    glint_y4m_header_init(&header, width, height, GLINT_I420, 25, 1);
    status = mem ? glint_y4m_writer_open(&out, "-", &header, &error)
                 : GLINT_E_MEMORY;
    if (status == GLINT_OK)
        glint_image_place(&frame, mem);
    for (int i = 0; i < n && status == GLINT_OK; i++) {
        const int room = photo->height - height;
        const int x = (photo->width - width) * i / n;
        const int y = (int)(0.5 * room * (1 + 0.5 * sin(i / 12.0)));

        convert_window_to_ycc(photo, x, y, &frame, &state);
        status = glint_y4m_writer_put(&out, &frame, "", &error);
    }
    if (status == GLINT_OK)
        status = glint_y4m_writer_commit(&out, &error);
    free(mem);
    if (status != GLINT_OK && status != GLINT_E_CLOSED)
        fprintf(stderr, "pan: %s\n", error.text);
    return status == GLINT_OK || status == GLINT_E_CLOSED ? 0 : 1;
}

int main(int argc, char **argv)
{
    struct glint_error error = {""};
    struct glint_image photo;
    int n, width, height, code;

    if (argc != 4 || !tool_parse_integer(argv[2], 1, 100000, &n) ||
        !tool_parse_size(argv[3], &width, &height)) {
        fprintf(stderr, "usage: pan IN FRAMES WxH > OUT.y4m\n");
        return 2;
    }
    if (glint_picture_load(argv[1], &photo, &error) != GLINT_OK) {
        fprintf(stderr, "pan: %s\n", error.text);
        return 3;
    }
    if (photo.width < width || photo.height < height) {
        fprintf(stderr, "pan: %s is smaller than the window\n", argv[1]);
        return 2;
    }
    code = write_pan_video(&photo, n, width, height);
    glint_picture_free(&photo);
    return code;
}
