/* SPDX-License-Identifier: MIT
 *
 * glint compare: how far two pictures in linear light are apart.
 */
#include <stdlib.h>

#include "measure.h"
#include "plain/picture.h"
#include "tool.h"

static const char help[] =
    "glint compare REFERENCE TEST [--fit] [--exposed] [--json]\n"
    "\n"
    "Compares two pictures in linear light (.pfm; others are taken for sRGB)\n"
    "of one size: exposes both so that the 99.9th\n"
    "percentile of the reference's luminance is 1, clips, encodes to 8-bit\n"
    "sRGB, and prints PSNR, SSIM of luma (8 x 8 blocks), the 99th percentile\n"
    "of the absolute difference in codes, and the ratio of the flux.\n"
    "\n"
    "  --fit       multiply TEST by the factor that fits best first\n"
    "  --exposed   TEST was drawn at that exposure, as a .ppm with\n"
    "              --exposure of its logarithm to the base 2\n";

static void print(const struct tool *tool, const struct measure *m)
{
    printf(tool->json ? "{\"psnr_db\": %.3f, \"ssim\": %.6f, \"p99\": %g, "
                        "\"flux\": %.6f, \"factor\": %.9g, \"exposure\": "
                        "%.9g}\n"
                      : "PSNR %.2f dB  SSIM %.5f  p99 %g codes  flux %.4f  "
                        "factor %.6g  exposure %.6g\n",
           m->psnr_db, m->ssim, m->p99, m->flux, m->factor, m->exposure);
}

/* Takes back that IMAGE was exposed as REFERENCE will be. */
static void unexpose(const struct glint_float_image *reference,
                     struct glint_float_image *image)
{
    const size_t n = 3 * (size_t)image->width * (size_t)image->height;
    const float exposure = (float)measure_exposure(reference);

    for (size_t i = 0; i < n; i++)
        image->rgb[i] /= exposure;
}

static int compare(const struct tool *tool, const char *const *name, bool fit,
                   bool exposed)
{
    struct glint_float_image image[2] = {{0, 0, NULL}, {0, 0, NULL}};
    struct glint_error error = {""};
    struct measure m;
    int code = EXIT_OK;

    for (int i = 0; i < 2 && code == EXIT_OK; i++) {
        const enum glint_status status =
            glint_picture_load_float(name[i], &image[i], &error);

        if (status != GLINT_OK)
            code = tool_fail(tool, status, error.text);
    }
    if (code == EXIT_OK && (image[0].width != image[1].width ||
                            image[0].height != image[1].height)) {
        fprintf(stderr, "glint compare: %s is %dx%d, %s is %dx%d\n", name[0],
                image[0].width, image[0].height, name[1], image[1].width,
                image[1].height);
        code = EXIT_INPUT;
    }
    if (code == EXIT_OK && exposed)
        unexpose(&image[0], &image[1]);
    if (code == EXIT_OK) {
        if (measure_compare(&image[0], &image[1], fit, &m))
            print(tool, &m);
        else
            code = tool_fail(tool, GLINT_E_MEMORY, NULL);
    }
    free(image[0].rgb);
    free(image[1].rgb);
    return code;
}

int cmd_compare(int argc, char **argv)
{
    static const struct option options[] = {{"fit", no_argument, NULL, 'f'},
                                            {"exposed", no_argument, NULL, 'e'},
                                            TOOL_COMMON_OPTIONS};
    struct tool tool = {.name = "compare", .help = help};
    bool fit = false, exposed = false;
    int c, code;

    while ((c = getopt_long(argc, argv, TOOL_COMMON_SHORT, options, NULL)) >=
           0) {
        fit |= c == 'f';
        exposed |= c == 'e';
        if (c == 'f' || c == 'e')
            continue;
        code = tool_option(&tool, c, optarg);
        if (code >= 0)
            return code;
    }
    if (fit && exposed)
        return tool_usage(&tool, "--fit and --exposed do not go together");
    if (optind + 2 != argc)
        return tool_usage(&tool, "takes two pictures");
    return compare(&tool, (const char *const[]){argv[optind], argv[optind + 1]},
                   fit, exposed);
}
