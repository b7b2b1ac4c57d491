/* SPDX-License-Identifier: MIT */
#include "model/model_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "posix/ending.h"
#include "posix/input.h"

#define MAX_MODEL_BYTES ((size_t)256 << 20)

bool tool_is_file_name(const char *argument)
{
    static const char *const endings[] = {".lens", ".glint", ".env", ".motion"};
    bool is_file = strchr(argument, '/') != NULL;

    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        is_file = is_file || glint_has_extension(argument, endings[i]);
    return is_file;
}

static uint32_t read_file_magic(const unsigned char *b)
{
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 |
           (uint32_t)b[3] << 24;
}

bool tool_is_model(const char *path)
{
    unsigned char b[4] = {0};
    struct stat st;
    FILE *file;

    if (!tool_is_file_name(path))
        return false;
    /* A pipe can be read only once, so it is not opened here. */
    if (stat(path, &st) < 0 || !S_ISREG(st.st_mode))
        return false;
    file = fopen(path, "rb");
    if (!file)
        return false;
    if (fread(b, 1, sizeof b, file) < sizeof b)
        b[0] = 0;
    fclose(file);
    return read_file_magic(b) == GLINT_MODEL_MAGIC ||
           read_file_magic(b) == GLINT_ZOOM_MAGIC;
}

static enum glint_status open_model_data(struct model_file *model,
                                         const char **reason)
{
    enum glint_status status;

    if (model->bytes < 4 || read_file_magic(model->data) != GLINT_ZOOM_MAGIC)
        return glint_lens_open(&model->lens, model->data, model->bytes, reason);
    *reason = "no memory";
    model->zoom = malloc(sizeof *model->zoom);
    if (!model->zoom)
        return GLINT_E_MEMORY;
    status = glint_zoom_open(model->zoom, model->data, model->bytes, reason);
    model->lens = model->zoom->lens;
    return status;
}

int tool_open_model(const struct tool *tool, const char *path,
                    struct model_file *model)
{
    struct glint_error error = {""};
    uint8_t *data = NULL;
    const char *reason;
    enum glint_status status;

    *model = (struct model_file){.data = NULL};
    status = glint_input_read_whole_file(&data, &model->bytes, path,
                                         MAX_MODEL_BYTES, &error);
    model->data = data; /* malloc() has aligned the data, as models require */
    if (status == GLINT_OK) {
        status = open_model_data(model, &reason);
        if (status == GLINT_OK)
            return EXIT_OK;
        snprintf(error.text, sizeof error.text, "%.180s: %.70s", path, reason);
    }
    tool_fail(tool, status, error.text);
    model_file_close(model);
    return status == GLINT_E_MEMORY ? EXIT_RUNTIME : EXIT_LENS;
}

static double compute_focal_length_at_position(struct glint_zoom_lens *z,
                                               int32_t along_q30)
{
    glint_zoom_set(z, along_q30);
    return model_convert_real_to_double(z->header.focal_mm);
}

int model_file_count_positions(const struct glint_zoom_lens *zoom)
{
    int n = 0;

    for (int k = 0; k < zoom->n_models; k++)
        n += !zoom->has[k];
    return n;
}

enum glint_status model_file_set_zoom(struct model_file *model, double zoom,
                                      struct glint_error *error)
{
    const int32_t whole_q30 = INT32_C(1) << 30;
    /* Tolerance for focal lengths, because those engraved on lenses are
     * rounded. */
    const double slack = 1.002;
    struct glint_zoom_lens *const z = model->zoom;
    const int32_t before_q30 = z->now_q30;
    const double first = compute_focal_length_at_position(z, 0),
                 last = compute_focal_length_at_position(z, whole_q30);
    int32_t low = 0, high = whole_q30;

    glint_zoom_set(z, before_q30);
    if (zoom >= 0 && zoom <= 1) {
        glint_zoom_set(z, (int32_t)lrint(zoom * whole_q30));
        return GLINT_OK;
    }
    if (!(zoom * slack >= fmin(first, last) &&
          zoom <= fmax(first, last) * slack)) {
        snprintf(error->text, sizeof error->text,
                 "%s zooms from %.4g mm to %.4g mm, not to %.4g mm",
                 z->header.name, first, last, zoom);
        return GLINT_E_ARGUMENT;
    }
    while (high - low > 1) {
        const int32_t middle = low + (high - low) / 2;

        if ((compute_focal_length_at_position(z, middle) < zoom) ==
            (last > first))
            low = middle;
        else
            high = middle;
    }
    glint_zoom_set(
        z, fabs(zoom - first) < fabs(zoom - last) && low == 0 ? 0 : high);
    return GLINT_OK;
}

/* Returns whether TEXT[BYTES] is terminated and printable. */
static bool is_printable_text(const char *text, size_t bytes)
{
    size_t n = 0;

    while (n < bytes && text[n] >= ' ' && text[n] <= '~')
        n++;
    return n < bytes && text[n] == '\0';
}

const struct glint_model_note *model_get_note(const struct glint_lens *lens)
{
    /* The header of a zoom lens is a copy outside the file. */
    const struct glint_model_header *const h =
        lens->zoom ? lens->zoom->model[0].header : lens->header;
    const struct glint_model_note *note;

    if (h->bytes % 4 || h->bytes < sizeof *h + sizeof *note)
        return NULL;
    note = (const void *)((const char *)h + h->bytes - sizeof *note);
    return note->magic == GLINT_MODEL_NOTE_MAGIC && note->n <= 1000 &&
                   note->psnr_q8 <= 999 << 8 && note->angle_q8 <= 90 << 8 &&
                   is_printable_text(note->coating, sizeof note->coating)
               ? note
               : NULL;
}

void model_file_close(struct model_file *model)
{
    free(model->zoom);
    free(model->data);
    *model = (struct model_file){.data = NULL};
}

double model_convert_real_to_double(struct glint_real x)
{
    return ldexp(x.mantissa, x.exponent);
}
