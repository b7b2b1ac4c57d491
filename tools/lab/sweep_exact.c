/* SPDX-License-Identifier: MIT */
#include "lab/sweep_exact.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "model/model_cache.h"
#include "formats/picture.h"

static uint64_t mix(uint64_t hash, const void *data, size_t bytes)
{
    const uint8_t *p = data;

    for (size_t i = 0; i < bytes; i++)
        hash = (hash ^ p[i]) * UINT64_C(0x100000001b3);
    return hash;
}

/* Returns a key of all that the picture depends on, but for the tracer
 * itself. */
static uint64_t key_of(const struct settings *s, const struct glint_lamp *lamp,
                       int n_lamps, int grid,
                       const struct glint_float_image *to)
{
    const int only_ghost = settings_only_ghost(s);
    const struct glint_view view = settings_view(s, to->width, to->height);
    const struct stop_option stop = settings_stop_shape(s);
    struct glint_bake_options options;
    uint64_t hash;

    glint_bake_defaults(&options);
    hash = glint_bake_key(&s->lens, &options);
    hash = mix(hash, &to->width, sizeof to->width);
    hash = mix(hash, &to->height, sizeof to->height);
    hash = mix(hash, &view.sensor_width_mm, sizeof view.sensor_width_mm);
    hash = mix(hash, &stop.n_blades, sizeof stop.n_blades);
    hash = mix(hash, &stop.rotation_deg, sizeof stop.rotation_deg);
    if (stop.iris.roundness > 0 || stop_option_shades(&stop)) {
        const struct glint_iris *i = &stop.iris;
        const double iris[] = {i->roundness, i->softness, i->dust,
                               i->dust_seed};

        hash = mix(hash, iris, sizeof iris);
        hash = i->mask ? mix(hash, i->mask,
                             (size_t)i->mask_width * (size_t)i->mask_height)
                       : hash;
    }
    hash = mix(hash, s->wavelength_nm,
               (size_t)s->n_wavelengths * sizeof *s->wavelength_nm);
    hash = mix(hash, &only_ghost, sizeof only_ghost);
    hash = mix(hash, &s->options.balance, sizeof s->options.balance);
    hash = mix(hash, &grid, sizeof grid);
    return mix(hash, lamp, (size_t)n_lamps * sizeof *lamp);
}

static bool load(const char *path, struct glint_float_image *to)
{
    struct glint_float_image kept = {0, 0, NULL};
    struct glint_error error = {""};
    bool same;

    if (access(path, R_OK) != 0 ||
        glint_picture_load_float(path, &kept, &error) != GLINT_OK)
        return false;
    same = kept.width == to->width && kept.height == to->height;
    if (same)
        memcpy(to->rgb, kept.rgb,
               3 * (size_t)to->width * (size_t)to->height * sizeof(float));
    free(kept.rgb);
    return same;
}

enum glint_status sweep_exact(const struct tool *tool,
                              const struct settings *settings,
                              const struct glint_lamp *lamp, int n_lamps,
                              int grid, struct glint_float_image *to)
{
    const uint64_t key = key_of(settings, lamp, n_lamps, grid, to);
    struct glint_error error = {""};
    char file[64], path[1024];
    enum glint_status status;
    bool kept;

    snprintf(file, sizeof file, "exact-%08lx%08lx.pfm",
             (unsigned long)(key >> 32), (unsigned long)(key & 0xffffffff));
    kept = model_cache_path(path, sizeof path, file);
    if (kept && load(path, to))
        return GLINT_OK;
    status = canvas_exact(tool, settings, lamp, n_lamps, grid, to);
    if (status == GLINT_OK && kept &&
        glint_picture_save_float(path, to, &error) != GLINT_OK && !tool->quiet)
        fprintf(stderr, "glint %s: the exact picture is not kept: %s\n",
                tool->name, error.text);
    return status;
}
