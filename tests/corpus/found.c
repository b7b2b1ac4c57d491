/* SPDX-License-Identifier: MIT
 *
 * found PICTURE.ppm... - prints, as CSV, the lamps that the engine would light
 * in a still picture at its defaults: the picture, then x, y, RMS radius,
 * pixels and light of each lamp. Lamps after the 128th are merged with lamps
 * near them.
 */
#include "glint/lamps.h"
#include "ppm.h"

enum { MOST = 128 };

static int print_found_lamps(const char *name, const struct glint_image *image)
{
    struct glint_lamp_finder_config cfg;
    struct glint_lamp_finder *finder;
    struct glint_spot spot[MOST];
    void *mem = NULL;
    size_t bytes;
    int n;

    glint_lamp_finder_defaults(&cfg, image->width, image->height);
    cfg.keep_faint = 1; /* as the engine does */
    bytes = glint_lamp_finder_bytes(&cfg);
    if (posix_memalign(&mem, 64, bytes) != 0 ||
        glint_lamp_finder_init(&finder, &cfg, mem, bytes) != GLINT_OK) {
        fprintf(stderr, "%s: no finder for this size\n", name);
        free(mem);
        return 1;
    }
    n = glint_lamp_finder_find(finder, image, spot, MOST);
    for (int i = 0; i < n; i++) {
        if (spot[i].faint)
            continue;
        printf("%s,%.2f,%.2f,%.2f,%d,%.3f\n", name, spot[i].x_q8 / 256.0,
               spot[i].y_q8 / 256.0, spot[i].size_q8 / 256.0, (int)spot[i].area,
               (double)spot[i].flux_q16 / 65536);
    }
    free(mem);
    return 0;
}

int main(int argc, char **argv)
{
    struct glint_image image;
    int code = 0;

    puts("file,x,y,size,area,light");
    for (int i = 1; i < argc && code == 0; i++) {
        code = ppm_read(argv[i], &image);
        if (code == 0) {
            code = print_found_lamps(argv[i], &image);
            free(image.plane[0]);
        }
    }
    return code;
}
