/* SPDX-License-Identifier: MIT
 *
 * glint compare: measures the difference of two images.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/measure.h"
#include "formats/picture.h"
#include "options/json_writer.h"
#include "model/settings.h"
#include "options/command_line.h"

static const char help[] =
    "glint compare REFERENCE TEST [options]\n"
    "\n"
    "Prints the difference of two pictures of one size: PSNR, SSIM of luma (8 "
    "x 8\n"
    "blocks), the 99th percentile of the absolute difference in codes, and "
    "the\n"
    "ratio of the flux. Two pictures in codes (.ppm .png .jpg ...) are "
    "compared\n"
    "code by code. If one of them has floats (.pfm .exr .hdr), both are read "
    "as\n"
    "linear light, exposed so that the 99.9th percentile of the reference's\n"
    "luminance is 1, clipped, and encoded to 8-bit sRGB first. Equal pictures "
    "are\n"
    "reported as identical; their PSNR is inf, null in JSON.\n"
    "\n"
    "  --exposure EV   exposure of both in stops; auto: by the percentile of "
    "the\n"
    "                  reference; default: 0 for two pictures in codes, else "
    "auto\n"
    "  --fit           first multiply TEST by the factor with the least "
    "error\n";

static const char help_end[] = COMMON_HELP;

struct asked {
    const char *name[2];
    bool fit;
    /* has_ev: whether --exposure is a number of stops; is_auto: whether it is
     * "auto". If both are false, the image types determine the exposure. */
    bool has_ev, is_auto;
    double ev;
};

/* ------------------------------------------------------------------- result */

static bool are_images_identical(const struct glint_float_image image[2])
{
    const size_t n = 3 * (size_t)image[0].width * (size_t)image[0].height;

    return memcmp(image[0].rgb, image[1].rgb, n * sizeof(float)) == 0;
}

static void print_comparison_json(const struct glint_measure *m, bool identical)
{
    json_write(&(struct json_writer){.to = stdout},
               "{psnr_db: %.3f, ssim: %.6f, p99: %g, flux: %.6f, "
               "factor: %.9g, exposure: %.9g, identical: %c}\n",
               m->psnr_db == 999 ? (double)NAN : m->psnr_db, m->ssim, m->p99,
               m->flux, m->factor, m->exposure, identical);
}

static void print_comparison_text(const struct glint_measure *m, bool identical)
{
    const char *words = identical ? "identical: "
                        : m->psnr_db == 999
                            ? "are visually identical at this exposure: "
                        : m->same_codes ? "the same codes: "
                                        : "";

    if (m->psnr_db == 999)
        printf("%sPSNR inf dB", words);
    else
        printf("%sPSNR %.2f dB", words, m->psnr_db);
    printf("  SSIM %.5f  p99 %g codes  flux %.4f  factor %.6g  exposure %.6g\n",
           m->ssim, m->p99, m->flux, m->factor, m->exposure);
}

/* ---------------------------------------------------------------- comparing */

/* Returns whether image NAME may contain floats: by its extension, or because a
 * pipe ("-") has no extension. */
static bool may_contain_floats(const char *name)
{
    return glint_picture_is_float(name) || strcmp(name, "-") == 0;
}

static double choose_exposure(const struct asked *a,
                              const struct glint_float_image *reference)
{
    const bool codes =
        !may_contain_floats(a->name[0]) && !may_contain_floats(a->name[1]);

    if (a->has_ev)
        return exp2(a->ev);
    return codes && !a->is_auto ? 1 : glint_measure_exposure(reference);
}

static int measure_image_difference(const struct tool *tool,
                                    const struct asked *a,
                                    struct glint_float_image image[2])
{
    const double exposure = choose_exposure(a, &image[0]);
    const bool identical = are_images_identical(image);
    struct glint_measure m;

    if (!glint_measure_at(&image[0], &image[1], a->fit, exposure, &m))
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    if (tool->json)
        print_comparison_json(&m, identical);
    else
        print_comparison_text(&m, identical);
    return EXIT_OK;
}

static int compare_image_files(const struct tool *tool, const struct asked *a)
{
    struct glint_float_image image[2] = {{0, 0, NULL}, {0, 0, NULL}};
    struct glint_error error = {""};
    int code = EXIT_OK;

    for (int i = 0; i < 2 && code == EXIT_OK; i++) {
        const enum glint_status status =
            glint_picture_load_float(a->name[i], &image[i], &error);

        if (status != GLINT_OK)
            code = tool_fail(tool, status, error.text);
    }
    if (code == EXIT_OK && (image[0].width != image[1].width ||
                            image[0].height != image[1].height)) {
        fprintf(stderr,
                "glint compare: %s is %dx%d, %s is %dx%d; pictures of equal "
                "size are needed\n",
                a->name[0], image[0].width, image[0].height, a->name[1],
                image[1].width, image[1].height);
        code = EXIT_INPUT;
    }
    if (code == EXIT_OK)
        code = measure_image_difference(tool, a, image);
    free(image[0].rgb);
    free(image[1].rgb);
    return code;
}

/* ------------------------------------------------------------------ options */

static bool parse_exposure(struct asked *a, const char *text)
{
    a->is_auto = strcmp(text, "auto") == 0;
    a->has_ev = !a->is_auto;
    return a->is_auto ||
           (tool_parse_number(text, &a->ev) && fabs(a->ev) <= 100);
}

static int parse_option(struct tool *tool, void *ctx, int c, const char *value)
{
    struct asked *const a = ctx;

    if (c == 'x')
        return parse_exposure(a, value) ? -1 : -2;
    if (c != 'f')
        return tool_apply_option(tool, c, value);
    a->fit = true;
    return -1;
}

int cmd_compare(int argc, char **argv)
{
    static const struct option options[] = {
        {"fit", no_argument, NULL, 'f'},
        {"exposure", required_argument, NULL, 'x'},
        TOOL_COMMON_OPTIONS};
    struct tool tool = {.name = "compare", .help = help, .help_end = help_end};
    struct asked a = {.fit = false};
    int code = tool_parse_options(&tool, argc, argv, TOOL_COMMON_SHORT, options,
                                  parse_option, &a);

    if (code < 0)
        code = tool_check_inputs(&tool, argc, argv, 2, "expects two pictures");
    if (code >= 0)
        return code;
    a.name[0] = argv[optind];
    a.name[1] = argv[optind + 1];
    return compare_image_files(&tool, &a);
}
