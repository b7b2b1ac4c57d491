/* SPDX-License-Identifier: MIT
 *
 * Reads and writes images for the examples: binary PPM of 8 bits.
 */
#ifndef GLINT_TOOLS_EXAMPLES_PPM_H
#define GLINT_TOOLS_EXAMPLES_PPM_H

#include <stdio.h>
#include <stdlib.h>

#include "glint/image.h"

/* Reads PATH into an sRGB image; the caller frees plane[0]. Returns 0, or 3
 * after printing the error. */
static inline int ppm_read(const char *path, struct glint_image *image)
{
    FILE *file = fopen(path, "rb");
    uint8_t *codes = NULL;
    int width = 0, height = 0;

    if (file && fscanf(file, "P6 %d %d 255", &width, &height) == 2 &&
        fgetc(file) != EOF && width > 0 && height > 0 &&
        width <= GLINT_MAX_SIDE && height <= GLINT_MAX_SIDE) {
        const size_t bytes = 3 * (size_t)width * (size_t)height;

        codes = malloc(bytes);
        if (codes && fread(codes, 1, bytes, file) != bytes) {
            free(codes);
            codes = NULL;
        }
    }
    if (file)
        fclose(file);
    if (!codes) {
        fprintf(stderr,
                "%s: cannot be read as a complete binary PPM of 8 bits\n",
                path);
        return 3;
    }
    *image = (struct glint_image){
        .format = GLINT_RGB24, .width = width, .height = height};
    glint_image_place(image, codes);
    return 0;
}

/* Writes IMAGE to standard output. Returns 0, or 6 on failure. */
static inline int ppm_write(const struct glint_image *image)
{
    const size_t bytes = 3 * (size_t)image->width * (size_t)image->height;

    printf("P6\n%d %d\n255\n", image->width, image->height);
    return fwrite(image->plane[0], 1, bytes, stdout) == bytes &&
                   fflush(stdout) == 0
               ? 0
               : 6;
}

#endif
