/* SPDX-License-Identifier: MIT */
#include "model/model_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "posix/input.h"

#define MAX_MODEL_BYTES ((size_t)256 << 20)

bool tool_is_file_name(const char *argument)
{
    static const char *const endings[] = {".lens", ".glint", ".env", ".motion"};
    const char *const dot = strrchr(argument, '.');
    bool is_file = strchr(argument, '/') != NULL;

    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
        is_file = is_file || strcmp(dot, endings[i]) == 0;
    return is_file;
}

bool tool_is_model(const char *path)
{
    unsigned char b[4] = {0};
    struct stat st;
    FILE *file;

    if (!tool_is_file_name(path))
        return false;
    /* A pipe can be read once only. */
    if (stat(path, &st) < 0 || !S_ISREG(st.st_mode))
        return false;
    file = fopen(path, "rb");
    if (!file)
        return false;
    if (fread(b, 1, sizeof b, file) < sizeof b)
        b[0] = 0;
    fclose(file);
    return (b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 |
            (uint32_t)b[3] << 24) == GLINT_MODEL_MAGIC;
}

int tool_model(const struct tool *tool, const char *path,
               struct model_file *model)
{
    struct glint_error error = {""};
    uint8_t *data = NULL;
    const char *reason;
    enum glint_status status;

    *model = (struct model_file){.data = NULL};
    status =
        glint_input_slurp(&data, &model->bytes, path, MAX_MODEL_BYTES, &error);
    model->data = data; /* malloc aligns it */
    if (status == GLINT_OK) {
        status =
            glint_lens_open(&model->lens, model->data, model->bytes, &reason);
        if (status == GLINT_OK)
            return EXIT_OK;
        snprintf(error.text, sizeof error.text, "%.180s: %.70s", path, reason);
    }
    tool_fail(tool, status, error.text);
    model_file_close(model);
    return status == GLINT_E_MEMORY ? EXIT_RUNTIME : EXIT_LENS;
}

void model_file_close(struct model_file *model)
{
    free(model->data);
    *model = (struct model_file){.data = NULL};
}

double model_real_of(struct glint_real x)
{
    return ldexp(x.mantissa, x.exponent);
}
