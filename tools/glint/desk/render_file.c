/* SPDX-License-Identifier: MIT */
#include "desk/render_file.h"

#include <stdio.h>
#include <stdlib.h>

#include "formats/picture.h"

int render_file_check_codes(const struct tool *tool, const char *path)
{
    struct glint_error error = {""};

    if (tool_check_output(tool, path) != EXIT_OK)
        return EXIT_OUTPUT;
    if (glint_picture_check(path, GLINT_PICTURE_8BIT, &error) == GLINT_OK)
        return EXIT_OK;
    tool_fail(tool, GLINT_E_OUTPUT, error.text);
    return EXIT_OUTPUT;
}

int render_file_check_path(const struct tool *tool, const char *path,
                           bool *is_linear)
{
    struct glint_error error = {""};

    *is_linear =
        glint_picture_check(path, GLINT_PICTURE_FLOAT, &error) == GLINT_OK;
    return *is_linear ? tool_check_output(tool, path)
                      : render_file_check_codes(tool, path);
}

int render_file_save(const struct tool *tool, const char *path, bool is_linear,
                     const struct glint_float_image *image, double exposure)
{
    struct glint_image codes = {
        .format = GLINT_RGB24, .width = image->width, .height = image->height};
    struct glint_error error = {""};
    enum glint_status status = GLINT_E_MEMORY;
    uint8_t *mem = NULL;

    if (is_linear) {
        status = glint_picture_save_float(path, image, &error);
    } else if ((mem = glint_measure_encode(
                    image,
                    exposure > 0 ? exposure : glint_measure_exposure(image)))) {
        glint_image_place(&codes, mem);
        status = glint_picture_save(path, &codes, &error);
    }
    free(mem);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

void render_file_print_summary(const struct tool *tool, const char *path,
                               int width, int height, const char *what,
                               double seconds)
{
    if (!tool->quiet && !tool->json)
        fprintf(stderr, "%s: %dx%d, %s; %.0f ms\n", path, width, height, what,
                1e3 * seconds);
}
