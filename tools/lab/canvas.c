/* SPDX-License-Identifier: MIT */
#include "lab/canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/stop_option.h"

/* ------------------------------------------------------------------ canvas */

/* Fills the fresh picture with a pattern of dim codes, 16 .. 87. */
static void paint(struct canvas *c)
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
        canvas_finish(c);
        return GLINT_E_MEMORY;
    }
    glint_image_place(&c->image, c->mem);
    paint(c);
    canvas_fresh(c);
    return GLINT_OK;
}

void canvas_fresh(struct canvas *c)
{
    memcpy(c->mem, c->fresh, c->bytes);
}

void canvas_finish(struct canvas *c)
{
    free(c->fresh);
    free(c->mem);
    c->fresh = c->mem = NULL;
}

/* Adds LAYER[256], which stays in the cache, to every 256 bytes of PX,
 * saturating, in a loop that compilers vectorise. */
static void add_layer(uint8_t *restrict px, const uint8_t *restrict layer,
                      size_t bytes)
{
    for (size_t i = 0; i + 256 <= bytes; i += 256)
        for (size_t k = 0; k < 256; k++) {
            const uint8_t sum = (uint8_t)(px[i + k] + layer[k]);

            px[i + k] = sum < layer[k] ? 255 : sum;
        }
}

double canvas_floor_ms(struct canvas *c)
{
    static uint8_t layer[256];
    double t0;

    layer[1]++;
    canvas_fresh(c);
    t0 = tool_seconds();
    add_layer(c->mem, layer, c->bytes);
    return 1e3 * (tool_seconds() - t0);
}

/* ------------------------------------------------------------------- lamps */

static double power_of(int i, int n)
{
    return 1.0 / (n > 64 ? 1 + i : n);
}

void canvas_lamps(struct glint_lamp *lamp, int n, double angle)
{
    for (int i = 0; i < n; i++)
        lamp[i] = (struct glint_lamp){i ? fmod(angle + 2.39 * i, 24) : angle,
                                      fmod(33 + 137.5 * i, 360),
                                      power_of(i, n),
                                      {1, 1, 1},
                                      {0, 0},
                                      0};
}

/* ---------------------------------------------------------------- pictures */

enum glint_status canvas_exact(const struct tool *tool,
                               const struct settings *s,
                               const struct glint_lamp *lamp, int n_lamps,
                               int grid, struct glint_float_image *to)
{
    const size_t n = 3 * (size_t)to->width * (size_t)to->height;
    struct glint_setup *setup = malloc(sizeof *setup);
    const struct stop_option stop = settings_stop_shape(s);
    struct glint_dirt *dirt = NULL;
    double *rgb = malloc(n * sizeof *rgb);
    struct tool_progress progress;
    struct glint_exact_config cfg = {
        .setup = setup,
        .view = settings_view(s, to->width, to->height),
        .lamps = lamp,
        .n_lamps = n_lamps,
        .grid = grid,
        .only_ghost = settings_only_ghost(s),
        .workers = tool->workers,
        .progress = tool_progress_show,
        .progress_ctx = &progress};
    struct glint_error error = {""};
    enum glint_status status = GLINT_E_MEMORY;

    tool_progress_start(&progress, tool, "exact");
    if (setup && rgb)
        status =
            glint_setup_init(setup, &s->lens, stop.n_blades, stop.rotation_deg,
                             s->wavelength_nm, s->n_wavelengths, &error);
    if (status == GLINT_OK)
        status = stop_option_set(&stop, setup, &dirt, &error);
    if (status == GLINT_OK && s->options.balance)
        glint_setup_balance(setup);
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

enum glint_status canvas_codes(struct glint_frame *frame,
                               const struct glint_lamp *lamp, int n_lamps,
                               double exposure, uint8_t *codes,
                               struct glint_engine_report *report)
{
    struct glint_image layer = {.format = GLINT_RGB24,
                                .width = frame->cfg.width,
                                .height = frame->cfg.height};

    memset(codes, 0, 3 * (size_t)layer.width * (size_t)layer.height);
    glint_image_place(&layer, codes);
    return glint_frame_draw(frame, lamp, n_lamps, exposure, &layer, report);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

double canvas_median(const double *values, int n)
{
    double sorted[CANVAS_MAX];

    memcpy(sorted, values, (size_t)n * sizeof *values);
    qsort(sorted, (size_t)n, sizeof *sorted, by_size);
    return 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
}
