/* SPDX-License-Identifier: MIT */
#include "measure/canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/measure.h"

/* ------------------------------------------------------------------ canvas */

/* Fills the background with a pattern of dark codes, 16 .. 87. */
static void fill_background(struct canvas *c)
{
    for (size_t i = 0; i < c->bytes; i++)
        c->fresh[i] = (uint8_t)(16 + i % 97 / 3 + (i >> 12) % 40);
}

enum glint_status canvas_init(struct canvas *c, enum glint_pixel_format format,
                              int width, int height)
{
    *c = (struct canvas){.image = {.format = format,
                                   .width = width,
                                   .height = height,
                                   .range = GLINT_RANGE_LIMITED,
                                   .matrix = GLINT_MATRIX_BT709,
                                   .transfer = GLINT_TONE_BT709},
                         .bytes = glint_image_bytes(format, width, height)};
    c->fresh = malloc(c->bytes);
    c->mem = malloc(c->bytes);
    if (!c->fresh || !c->mem) {
        canvas_free(c);
        return GLINT_E_MEMORY;
    }
    glint_image_place(&c->image, c->mem);
    fill_background(c);
    canvas_restore_background(c);
    return GLINT_OK;
}

void canvas_restore_background(struct canvas *c)
{
    memcpy(c->mem, c->fresh, c->bytes);
}

void canvas_free(struct canvas *c)
{
    free(c->fresh);
    free(c->mem);
    c->fresh = c->mem = NULL;
}

/* Adds LAYER[256] with saturation to each 256 bytes of PX. The layer stays
 * in the CPU cache, and compilers vectorise the loop. */
static void add_layer_to_pixels(uint8_t *restrict px,
                                const uint8_t *restrict layer, size_t bytes)
{
    for (size_t i = 0; i + 256 <= bytes; i += 256)
        for (size_t k = 0; k < 256; k++) {
            const uint8_t sum = (uint8_t)(px[i + k] + layer[k]);

            px[i + k] = sum < layer[k] ? 255 : sum;
        }
}

void canvas_time_memory_floor(struct canvas *c, int round)
{
    static uint8_t layer[256];
    double t0;

    layer[1]++;
    canvas_restore_background(c);
    t0 = tool_clock_s();
    add_layer_to_pixels(c->mem, layer, c->bytes);
    c->floor_ms[round] = 1e3 * (tool_clock_s() - t0);
}

/* ------------------------------------------------------------------- lamps */

static double compute_lamp_power(int i, int n)
{
    return 1.0 / (n > 64 ? 1 + i : n);
}

void canvas_set_lamps(struct glint_lamp *lamp, int n, double angle)
{
    for (int i = 0; i < n; i++)
        lamp[i] = (struct glint_lamp){i ? fmod(angle + 2.39 * i, 24) : angle,
                                      fmod(33 + 137.5 * i, 360),
                                      compute_lamp_power(i, n),
                                      {1, 1, 1},
                                      {0, 0},
                                      0};
}

/* ---------------------------------------------------------------- pictures */

void canvas_open_engine(const struct tool *tool, const struct opened_lens *lens,
                        const struct settings *asked, int width, int height,
                        struct glint_engine_config *cfg)
{
    opened_lens_configure_engine(tool, lens, asked, width, height, cfg);
    cfg->light.by_hand = 1;
    cfg->search.max_found = 0;
    cfg->drawing.is_fresh = 1;
}

enum glint_status canvas_compute_exposure(struct glint_engine *engine,
                                          const struct glint_lamp *lamp,
                                          int n_lamps, double *exposure)
{
    const struct glint_view *const view = glint_engine_view(engine);
    const size_t n = 3 * (size_t)view->width * (size_t)view->height;
    struct glint_float_image flare = {view->width, view->height,
                                      malloc(n * sizeof(float))};
    struct glint_engine_report report;
    enum glint_status status = GLINT_E_MEMORY;

    if (flare.rgb)
        status = glint_engine_render(engine, lamp, n_lamps, 1, GLINT_ENGINE_ALL,
                                     flare.rgb, &report);
    if (status == GLINT_OK)
        *exposure = glint_measure_exposure(&flare);
    free(flare.rgb);
    return status;
}

enum glint_status canvas_draw_exact(const struct tool *tool,
                                    const struct opened_lens *lens,
                                    const struct settings *s,
                                    const struct glint_lamp *lamp, int n_lamps,
                                    int grid, struct glint_float_image *to)
{
    const size_t n = 3 * (size_t)to->width * (size_t)to->height;
    struct glint_setup *setup = malloc(sizeof *setup);
    struct glint_engine_camera camera = opened_lens_make_camera(lens, s);
    struct glint_dirt *dirt = NULL;
    double *rgb = malloc(n * sizeof *rgb);
    struct tool_progress progress;
    struct glint_exact_config cfg = {
        .setup = setup,
        .view = opened_lens_compute_view(lens, s, to->width, to->height),
        .lamps = lamp,
        .n_lamps = n_lamps,
        .grid = grid,
        .only_ghost = settings_get_selected_ghost(s),
        .workers = tool->workers,
        .progress = tool_progress_show,
        .progress_ctx = &progress};
    struct glint_error error = {""};
    enum glint_status status = GLINT_E_MEMORY;

    tool_progress_start(&progress, tool, "exact");
    if (setup && rgb)
        status = glint_setup_init(setup, &lens->table, camera.n_blades,
                                  camera.blade_rotation_deg, s->wavelength_nm,
                                  s->n_wavelengths, &error);
    /* The exact image uses all wavelengths for every ghost. */
    camera.waves.kind = GLINT_WAVES_LIST;
    if (status == GLINT_OK)
        status = glint_engine_setup(setup, NULL, &camera, &dirt, &error);
    if (status == GLINT_OK)
        status = glint_exact_render(&cfg, rgb);
    for (size_t i = 0; i < n && status == GLINT_OK; i++)
        to->rgb[i] = (float)rgb[i];
    tool_progress_end(&progress);
    glint_dirt_free(dirt);
    free(setup);
    free(rgb);
    return status;
}

enum glint_status canvas_draw_flare_codes(struct glint_engine *engine,
                                          const struct glint_lamp *lamp,
                                          int n_lamps, double exposure,
                                          uint8_t *codes,
                                          struct glint_engine_report *report)
{
    const struct glint_view *const view = glint_engine_view(engine);
    struct glint_image layer = {
        .format = GLINT_RGB24, .width = view->width, .height = view->height};

    memset(codes, 0, 3 * (size_t)layer.width * (size_t)layer.height);
    glint_image_place(&layer, codes);
    return glint_engine_draw_at(engine, lamp, n_lamps, exposure, &layer,
                                report);
}

const char *canvas_describe_machine(void)
{
    static char line[128];
    FILE *const file = fopen("/proc/cpuinfo", "r");
    const char *name = NULL;

    while (file && !name && fgets(line, sizeof line, file))
        if (strncmp(line, "model name", 10) == 0)
            name = strchr(line, ':');
    if (file)
        fclose(file);
    for (char *c = line; *c; c++)
        *c = (char)(*c == ',' ? ' ' : *c == '\n' ? '\0' : *c);
    return name ? name + 2 : "unknown";
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

double canvas_find_median(const double *values, int n)
{
    double sorted[CANVAS_MAX];

    memcpy(sorted, values, (size_t)n * sizeof *values);
    qsort(sorted, (size_t)n, sizeof *sorted, compare_doubles);
    return 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
}
