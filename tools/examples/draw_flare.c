/* SPDX-License-Identifier: MIT
 *
 * draw_flare MODEL IN.ppm X Y STOPS >OUT.ppm - draws the ghosts of a white lamp
 * at a pixel, STOPS stops brighter than white. Written for an embedded board:
 * it uses no malloc and no floating point (make lint checks this). All memory
 * is static. It links only the renderer of 8-bit pictures.
 */
#include <stdio.h>
#include <stdlib.h>

#include "glint/flare.h"
#include "glint/kernels.h"

enum { MAX_MODEL = 2 << 20, MAX_PICTURE = 12 << 20, MAX_FLARE = 16 << 20 };

/* On a board the model would be in ROM and the image in the camera's buffer. */
static uint32_t model[MAX_MODEL / sizeof(uint32_t)];
static uint8_t picture[MAX_PICTURE];
#ifdef __GNUC__
__attribute__((aligned(64)))
#endif
static uint8_t flare_memory[MAX_FLARE];

/* Reads the file PATH into BLOCK. Returns the number of bytes, or 0 if the file
 * cannot be read or has ROOM bytes or more. */
static size_t load_file(const char *path, void *block, size_t room)
{
    FILE *file = fopen(path, "rb");
    size_t bytes = 0;

    if (file) {
        bytes = fread(block, 1, room, file);
        if (bytes == room || ferror(file))
            bytes = 0;
        fclose(file);
    }
    return bytes;
}

/* Skips one white-space character at *AT, parses the number behind it, and
 * moves *AT past the number. */
static int parse_number(const uint8_t **at)
{
    int n = 0;

    for (++*at; **at >= '0' && **at <= '9' && n <= GLINT_MAX_SIDE; ++*at)
        n = 10 * n + (**at - '0');
    return n;
}

/* Sets IMAGE to the pixels of the PPM file in picture, BYTES long. Returns
 * whether the file is a complete binary 8-bit PPM without comments. */
static int find_ppm_pixels(struct glint_image *image, size_t bytes)
{
    const uint8_t *at = picture + 2;

    if (picture[0] != 'P' || picture[1] != '6')
        return 0;
    *image = (struct glint_image){.format = GLINT_RGB24};
    image->width = parse_number(&at);
    image->height = parse_number(&at);
    if (parse_number(&at) != 255 || image->width < 1 || image->height < 1 ||
        image->width > GLINT_MAX_SIDE || image->height > GLINT_MAX_SIDE)
        return 0;
    at++;
    glint_image_place(image, picture + (at - picture));
    return bytes == (size_t)(at - picture) +
                        3 * (size_t)image->width * (size_t)image->height;
}

/* Adds the flare of LIGHT to IMAGE. Returns 1, or 0 if flare_memory is too
 * small. */
static int draw_flare(const struct glint_lens *lens,
                      const struct glint_image *image,
                      const struct glint_light *light)
{
    struct glint_wave wave[GLINT_FLARE_WAVES];
    struct glint_flare_config config;
    struct glint_flare_frame frame;
    struct glint_flare_stats stats;
    struct glint_flare *flare;

    glint_flare_defaults(&config, image->width, image->height);
    glint_flare_capacities(&config, lens, 1, GLINT_FLARE_WAVES);
    config.sets = glint_sets_here();
    glint_flare_frame_defaults(&frame, lens);
    glint_flare_waves(wave, lens);
    frame.wave = wave;
    frame.n_waves = GLINT_FLARE_WAVES;
    frame.pixels_per_mm =
        glint_flare_pixels_per_mm(lens, image->width, image->height);
    if (glint_flare_init(&flare, &config, flare_memory, sizeof flare_memory) !=
        GLINT_OK)
        return 0;
    glint_flare_plan(flare, &frame, light, 1);
    glint_flare_bin(flare, &stats);
    glint_flare_draw(flare, image);
    return 1;
}

/* Returns the centre of the pixel with the number TEXT. A number outside
 * -GLINT_MAX_SIDE .. 2 * GLINT_MAX_SIDE counts as the latter, far outside the
 * largest picture. */
static int32_t parse_pixel_centre_q8(const char *text)
{
    const int pixel = atoi(text);

    return pixel > -GLINT_MAX_SIDE && pixel < 2 * GLINT_MAX_SIDE
               ? pixel * 256 + 128
               : 512 * GLINT_MAX_SIDE;
}

static int print_error(int code, const char *what)
{
    fprintf(stderr, "draw_flare: %s\n", what);
    return code;
}

int main(int argc, char **argv)
{
    const char *reason = "cannot be read, or has more than 2 MiB";
    const int stops = argc == 6 ? atoi(argv[5]) : 61;
    struct glint_lens lens;
    struct glint_image image;
    struct glint_light light;
    size_t bytes;

    if (stops < -60 || stops > 60)
        return print_error(2, "MODEL IN.ppm X Y STOPS >OUT.ppm");
    bytes = load_file(argv[1], model, sizeof model);
    if (!bytes || glint_lens_open(&lens, model, bytes, &reason) != GLINT_OK)
        return print_error(5, reason);
    bytes = load_file(argv[2], picture, sizeof picture);
    if (!find_ppm_pixels(&image, bytes))
        return print_error(3, "not a binary 8-bit PPM, or larger than 12 MiB");
    light = glint_light_from_pixel(&lens, image.width, image.height,
                                   parse_pixel_centre_q8(argv[3]),
                                   parse_pixel_centre_q8(argv[4]));
    light.power.exponent += stops;
    if (!draw_flare(&lens, &image, &light))
        return print_error(
            1, "a picture of this size needs more than 16 MiB of memory");
    return fwrite(picture, 1, bytes, stdout) == bytes && !fflush(stdout) ? 0
                                                                         : 6;
}
