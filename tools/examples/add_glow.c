/* SPDX-License-Identifier: MIT
 *
 * add_glow IN.ppm X Y RADIUS >OUT.ppm - adds a warm glow around a point in
 * linear light. Links only glint's compositor.
 */
#include "glint/composite.h"
#include "glint/kernels.h"
#include "ppm.h"

/* Returns the square of X, 0 .. 1, rounded down. */
static uint16_t square_q16(uint16_t x_q16)
{
    return (uint16_t)((uint32_t)x_q16 * x_q16 >> 16);
}

/* Sets RGB to a glow around (X0, Y0), which is white at the centre and redder
 * at larger distances. Red falls to a quarter at RADIUS pixels. */
static void compute_glow_rgb(uint16_t *const rgb[3], int width, int height,
                             int x0, int y0, int radius)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const int64_t dx = x - x0, dy = y - y0;
            const int64_t one = (int64_t)radius * radius;
            const uint16_t near_q16 =
                (uint16_t)((one * 65535) / (one + dx * dx + dy * dy));
            const size_t at = (size_t)y * (size_t)width + (size_t)x;

            rgb[0][at] = square_q16(near_q16);
            rgb[1][at] = square_q16(rgb[0][at]);
            rgb[2][at] = square_q16(rgb[1][at]);
        }
}

static int add_glow(const struct glint_image *image, int x, int y, int radius)
{
    const size_t n = (size_t)image->width * (size_t)image->height;
    const size_t bytes = glint_composite_bytes();
    uint16_t *light = malloc(3 * n * sizeof *light);
    struct glint_composite *composite;
    void *mem = NULL;
    int code = 1;

    if (light && posix_memalign(&mem, 64, bytes) == 0 &&
        glint_composite_init(&composite, image, glint_sets_here(), 0, mem,
                             bytes) == GLINT_OK) {
        uint16_t *const rgb[3] = {light, light + n, light + 2 * n};
        const struct glint_layer layer = {{rgb[0], rgb[1], rgb[2]},
                                          image->width};

        compute_glow_rgb(rgb, image->width, image->height, x, y, radius);
        glint_composite_add(composite, image, &layer);
        code = 0;
    } else
        fprintf(stderr, "out of memory\n");
    free(light);
    free(mem);
    return code;
}

int main(int argc, char **argv)
{
    struct glint_image image;
    int code;

    if (argc != 5 || atoi(argv[4]) < 1 || atoi(argv[4]) > GLINT_MAX_SIDE) {
        fprintf(stderr, "add_glow IN.ppm X Y RADIUS >OUT.ppm\n");
        return 2;
    }
    code = ppm_read(argv[1], &image);
    if (code != 0)
        return code;
    code = add_glow(&image, atoi(argv[2]), atoi(argv[3]), atoi(argv[4]));
    if (code == 0)
        code = ppm_write(&image);
    free(image.plane[0]);
    return code;
}
