/* SPDX-License-Identifier: MIT
 *
 * find_lamps PICTURE.ppm - prints the positions of the lamps in a picture.
 * Links only glint's lamp finder.
 */
#include "glint/lamps.h"
#include "ppm.h"

enum { MOST = 32 };

static int print_lamps(const struct glint_image *image)
{
    struct glint_lamp_finder_config cfg;
    struct glint_lamp_finder *finder;
    struct glint_spot spot[MOST];
    void *mem = NULL;
    size_t bytes;
    int n;

    glint_lamp_finder_defaults(&cfg, image->width, image->height);
    bytes = glint_lamp_finder_bytes(&cfg);
    if (posix_memalign(&mem, 64, bytes) != 0 ||
        glint_lamp_finder_init(&finder, &cfg, mem, bytes) != GLINT_OK) {
        fprintf(stderr, "out of memory\n");
        free(mem);
        return 1;
    }
    n = glint_lamp_finder_find(finder, image, spot, MOST);
    for (int i = 0; i < n; i++)
        printf("%.2f,%.2f,%.3f\n", spot[i].x_q8 / 256.0, spot[i].y_q8 / 256.0,
               (double)spot[i].flux_q16 / 65536);
    free(mem);
    return 0;
}

int main(int argc, char **argv)
{
    struct glint_image image;
    int code;

    if (argc != 2) {
        fprintf(stderr, "find_lamps PICTURE.ppm\n");
        return 2;
    }
    code = ppm_read(argv[1], &image);
    if (code == 0) {
        code = print_lamps(&image);
        free(image.plane[0]);
    }
    return code;
}
