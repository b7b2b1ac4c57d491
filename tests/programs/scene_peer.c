/* SPDX-License-Identifier: MIT
 *
 * scene_peer PEER OURS - how far two pictures of a scene are apart, in codes of
 * 8 bits: a .ppm has 16 bits of linear light, a .pfm floats.
 *
 * Silhouettes and edges of shadows are left out: pixels of which a neighbour
 * differs by more than EDGE codes in either picture. Prints the share left, the
 * mean and largest difference of these, the share beyond one code, and the
 * PSNR. Exits with 1 where one pixel of 10000 of these is more than a code off.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/picture.h"
#include "formats/pnm.h"
#include "posix/input.h"

enum { EDGE = 12 };

/* A picture as codes with fractions. */
struct codes {
    int width, height;
    double *at; /* [height][width][3] */
};

static double encode(double light)
{
    const double x = fmin(fmax(light, 0), 1);

    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055);
}

static int read_peer(const char *path, struct codes *codes)
{
    struct glint_error error = {""};
    struct glint_pnm_header header;
    uint8_t *data = NULL;
    size_t bytes = 0, n;

    if (glint_input_slurp(&data, &bytes, path, 1 << 28, &error) != GLINT_OK ||
        glint_pnm_header_read(&header, data, bytes, path, &error) != GLINT_OK ||
        header.maximum != 65535 || header.channels != 3) {
        fprintf(stderr, "scene_peer: %s: %s\n", path, error.text);
        free(data);
        return 0;
    }
    n = 3 * (size_t)header.width * (size_t)header.height;
    *codes = (struct codes){header.width, header.height,
                            malloc(n * sizeof *codes->at)};
    for (size_t i = 0; codes->at && i < n; i++) {
        const uint8_t *s = data + header.bytes + 2 * i;

        codes->at[i] = encode((256 * s[0] + s[1]) / 65535.0);
    }
    free(data);
    return codes->at != NULL;
}

static int read_ours(const char *path, struct codes *codes)
{
    struct glint_error error = {""};
    struct glint_float_image image = {0, 0, NULL};
    size_t n;

    if (glint_picture_load_float(path, &image, &error) != GLINT_OK) {
        fprintf(stderr, "scene_peer: %s\n", error.text);
        return 0;
    }
    n = 3 * (size_t)image.width * (size_t)image.height;
    *codes = (struct codes){image.width, image.height,
                            malloc(n * sizeof *codes->at)};
    for (size_t i = 0; codes->at && i < n; i++)
        codes->at[i] = encode((double)image.rgb[i]);
    free(image.rgb);
    return codes->at != NULL;
}

static int read_any(const char *path, struct codes *codes)
{
    const char *const dot = strrchr(path, '.');

    return (dot && strcmp(dot, ".ppm") == 0 ? read_peer : read_ours)(path,
                                                                     codes);
}

/* Returns whether a neighbour of the pixel X, Y differs from it. */
static int is_edge(const struct codes *codes, int x, int y)
{
    for (int k = 0; k < 9; k++) {
        const int i = x + k % 3 - 1, j = y + k / 3 - 1;

        if (i < 0 || j < 0 || i >= codes->width || j >= codes->height)
            continue;
        for (int c = 0; c < 3; c++) {
            const double *at = codes->at + c;

            if (fabs(at[3 * ((ptrdiff_t)y * codes->width + x)] -
                     at[3 * ((ptrdiff_t)j * codes->width + i)]) > EDGE)
                return 1;
        }
    }
    return 0;
}

static int compare(const struct codes *a, const struct codes *b)
{
    const int n = a->width * a->height;
    double sum = 0, squares = 0, worst = 0;
    int kept = 0, beyond = 0;

    for (int i = 0; i < n; i++) {
        double most = 0;

        if (is_edge(a, i % a->width, i / a->width) ||
            is_edge(b, i % a->width, i / a->width))
            continue;
        for (int c = 0; c < 3; c++) {
            const double d = fabs(a->at[3 * i + c] - b->at[3 * i + c]);

            sum += d;
            squares += d * d;
            most = fmax(most, d);
        }
        kept++;
        beyond += most > 1;
        worst = fmax(worst, most);
    }
    printf("%.2f %.5f %.4f %.5f %.2f\n", 100.0 * kept / n, sum / (3.0 * kept),
           worst, 100.0 * beyond / kept,
           10 * log10(255 * 255 / (squares / (3.0 * kept))));
    return kept > n / 2 && beyond * 10000.0 <= kept;
}

int main(int argc, char **argv)
{
    struct codes peer = {0, 0, NULL}, ours = {0, 0, NULL};
    int good = argc == 3 && read_any(argv[1], &peer) &&
               read_any(argv[2], &ours) && peer.width == ours.width &&
               peer.height == ours.height && compare(&peer, &ours);

    if (argc != 3)
        fprintf(stderr, "scene_peer PEER OURS\n");
    free(peer.at);
    free(ours.at);
    return good ? 0 : 1;
}
