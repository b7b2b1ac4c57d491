/* SPDX-License-Identifier: MIT */
#include "overlay/layers.h"

#include <stdlib.h>
#include <string.h>

#include "formats/picture.h"
#include "formats/oiio.h"
#include "options/numbered.h"
#include "posix/ending.h"
#include "posix/error.h"
#include "posix/output.h"

enum {
    FLARE,
    GHOSTS,
    STARBURST,
    VEIL,
    LAYERS,
    NAME_ROOM = NUMBERED_BYTES + 32
};

static const char *const names[LAYERS] = {"flare", "ghosts", "starburst",
                                          "veil"};

/* Sets NAME to the file name of LAYER in frame FRAME: PATH with the layer for
 * its %s and the number for its %d. LAYER may be NULL for a check of PATH.
 * Returns false if the name is too long or PATH has more than one %s or %d. */
static bool make_layer_file_name(char name[NAME_ROOM], const char *path,
                                 const char *layer, int frame)
{
    const char *const at = strstr(path, "%s");
    char whole[NAME_ROOM];
    int n;

    n = at ? snprintf(whole, sizeof whole, "%.*s%s%s", (int)(at - path), path,
                      layer ? layer : "layer", at + 2)
           : snprintf(whole, sizeof whole, "%s", path);
    if (n < 0 || n >= NUMBERED_BYTES)
        return false;
    if (!strchr(whole, '%')) {
        memcpy(name, whole, (size_t)n + 1);
        return true;
    }
    return numbered_is_pattern(whole) && numbered_make_name(name, whole, frame);
}

/* Returns whether the file type of NAME supports layers. An .exr file stores
 * all layers, or one. Other float formats store a single layer, so the path
 * needs a %s. */
static bool can_file_hold_layers(const struct layers *layers, const char *name)
{
    static const char *const kinds[] = {".exr", ".pfm", ".hdr", ".tif",
                                        ".tiff"};
    const int n = strstr(layers->path, "%s") ? 5 : 1;

    for (int i = 0; i < n; i++)
        if (glint_has_extension(name, kinds[i]))
            return true;
    return false;
}

int layers_check_file_names(const struct tool *tool,
                            const struct layers *layers, bool is_video)
{
    struct glint_error error = {""};
    char name[NAME_ROOM], other[NAME_ROOM];

    if (!layers->path)
        return EXIT_OK;
    if (!make_layer_file_name(name, layers->path, NULL, 0))
        return tool_usage(
            tool,
            "--layers: a name may have one %%s and one %%d or %%04d, not '%s'",
            layers->path);
    make_layer_file_name(other, layers->path, NULL, 1);
    if (is_video && strcmp(name, other) == 0)
        return tool_usage(tool, "--layers of a video or sequence needs a frame "
                                "number in its name, such as layers-%%04d.exr");
    if (!can_file_hold_layers(layers, name))
        return tool_usage(
            tool,
            "--layers: name an .exr for all layers, or one file per layer by "
            "%%s: fl.exr, fl-%%s.exr or fl-%%s.pfm, not '%s'",
            layers->path);
    if (tool_check_output(tool, name) != EXIT_OK)
        return EXIT_OUTPUT;
    if (glint_picture_check(name, GLINT_PICTURE_FLOAT, &error) == GLINT_OK)
        return EXIT_OK;
    tool_fail(tool, GLINT_E_OUTPUT, error.text);
    return EXIT_OUTPUT;
}

int layers_check_outputs(const struct tool *tool, const struct layers *layers,
                         const struct apart *files)
{
    struct apart all = *files;
    char name[NAME_ROOM];
    int code;

    file_conflicts_add_output(&all, "--layers", layers->path);
    code = file_conflicts_check_outputs(tool, &all);
    for (int k = 0; k < LAYERS && layers->path && code == EXIT_OK; k++) {
        if (!make_layer_file_name(name, layers->path, names[k], 0))
            break;
        all = *files;
        file_conflicts_add_output(&all, "--layers", name);
        code = file_conflicts_check_outputs(tool, &all);
    }
    return code;
}

/* ----------------------------------------------------------------- drawing */

/* Draws N_LAYERS layers of N samples each into RGB. The first layer is the sum
 * of the others, which are the components of the flare. */
static enum glint_status draw_all_layers(struct drawing *c, int n_layers,
                                         size_t n, float *rgb)
{
    static const unsigned part[] = {[GHOSTS] = GLINT_ENGINE_GHOSTS,
                                    [STARBURST] = GLINT_ENGINE_STAR,
                                    [VEIL] = GLINT_ENGINE_VEIL};
    const bool is_lit =
        c->run.n_lamps > 0 && drawing_get_exposure_factor(&c->run) > 0;
    enum glint_status status = GLINT_OK;
    struct glint_engine_report report;

    memset(rgb, 0, (size_t)n_layers * n * sizeof *rgb);
    /* The veil is drawn first, because it is computed from the flare that the
     * engine drew last. Drawing another component replaces this flare. */
    for (int k = n_layers - 1; k >= GHOSTS && status == GLINT_OK; k--)
        if (is_lit || k == VEIL)
            status = glint_engine_draw_layer(c->run.engine, c->run.lamp,
                                             c->run.n_lamps, part[k],
                                             rgb + (size_t)k * n, &report);
    for (int k = GHOSTS; k < n_layers; k++)
        for (size_t i = 0; i < n; i++)
            rgb[i] += rgb[(size_t)k * n + i];
    return status;
}

/* ----------------------------------------------------------------- writing */

static enum glint_status save_layer_file(const char *name,
                                         const struct glint_oiio_layers *layers,
                                         struct glint_error *error)
{
    const struct glint_float_image floats = {.width = layers->width,
                                             .height = layers->height,
                                             .rgb = layers->layer->rgb};
    const struct glint_oiio *oiio;
    enum glint_status status;
    void *data = NULL;
    size_t bytes = 0;

    if (glint_has_extension(name, ".pfm") && layers->n == 1)
        return glint_picture_save_float(name, &floats, error);
    status = glint_oiio_load(&oiio, error) ? GLINT_E_UNSUPPORTED : GLINT_OK;
    if (status == GLINT_OK)
        status = oiio->encode_layers(&data, &bytes, name, layers, error);
    if (status == GLINT_OK)
        status = glint_output_save_file(name, GLINT_OUTPUT_BINARY, data, bytes,
                                        error);
    free(data);
    return status;
}

static enum glint_status save_all_layers(const struct layers *layers,
                                         struct glint_oiio_layers *all,
                                         int frame, struct glint_error *error)
{
    const struct glint_oiio_layer *const first = all->layer;
    const bool is_apart = strstr(layers->path, "%s");
    const int files = is_apart ? all->n : 1;
    enum glint_status status = GLINT_OK;
    char name[NAME_ROOM];

    all->n = is_apart ? 1 : all->n;
    for (int k = 0; k < files && status == GLINT_OK; k++) {
        all->layer = first + k;
        status = make_layer_file_name(name, layers->path, first[k].name, frame)
                     ? save_layer_file(name, all, error)
                     : glint_error_report(error, GLINT_E_OUTPUT, layers->path,
                                          "the file name is too long");
    }
    return status;
}

int layers_write(const struct tool *tool, const struct layers *layers,
                 struct drawing *drawing)
{
    const struct settings *const s = &drawing->line.settings;
    const size_t n =
        3 * (size_t)drawing->run.view.width * (size_t)drawing->run.view.height;
    struct glint_oiio_layer layer[LAYERS];
    struct glint_oiio_layers all = {.width = drawing->run.view.width,
                                    .height = drawing->run.view.height,
                                    .n = settings_has_veil(s) ? LAYERS : VEIL,
                                    .is_half = !layers->is_float,
                                    .layer = layer};
    enum glint_status status = GLINT_E_MEMORY;
    struct glint_error error = {""};
    float *rgb;

    if (!layers->path)
        return EXIT_OK;
    rgb = malloc((size_t)all.n * n * sizeof *rgb);
    for (int k = 0; k < all.n && rgb; k++)
        layer[k] = (struct glint_oiio_layer){names[k], rgb + (size_t)k * n};
    if (rgb)
        status = draw_all_layers(drawing, all.n, n, rgb);
    if (status == GLINT_OK)
        status =
            save_all_layers(layers, &all, drawing->run.n_frames - 1, &error);
    free(rgb);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}
