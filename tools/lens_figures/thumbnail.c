/* SPDX-License-Identifier: MIT */
#include "lens_figures/thumbnail.h"

#include <math.h>
#include <stdlib.h>

#include "glint/measure.h"
#include "glint/glint.h"
#include "lab/plots/plot.h"

enum { ANGLES = 3, WIDE = 168, MOST_HIGH = 168 };

static const double share[ANGLES] = {0.25, 0.5, 0.8};

/* Ghosts are exposed as pictures of them alone are, but no more than so many
 * times what would show the star beside them: where ghosts are faint it would
 * fill the picture. */
#define BRIGHTER 40.0

/* Returns the angle at SHARE of the half diagonal, by f tan T, which places
 * lamps in pictures. */
static double angle_deg(const struct settings *s, double at)
{
    const double half =
        0.5 * hypot(s->lens.film_width_mm, s->lens.film_height_mm);

    return atan(at * half / s->setup.optics.focal_mm) * 180 / GLINT_PI;
}

static enum glint_status draw(struct glint_engine *engine, double theta_deg,
                              struct glint_float_image *image, float *star,
                              FILE *file)
{
    const struct glint_lamp lamp = {
        .theta_deg = theta_deg, .phi_deg = 33, .power = 1, .rgb = {1, 1, 1}};
    const size_t n = 3 * (size_t)image->width * (size_t)image->height;
    struct glint_engine_report report;
    uint8_t *codes;
    double exposure;
    enum glint_status status = glint_engine_render(
        engine, &lamp, 1, 1, GLINT_ENGINE_GHOSTS, image->rgb, &report);

    if (status == GLINT_OK)
        status = glint_engine_render(engine, &lamp, 1, 1, GLINT_ENGINE_STAR,
                                     star, &report);
    if (status != GLINT_OK)
        return status;
    exposure = glint_measure_exposure(image);
    for (size_t i = 0; i < n; i++)
        image->rgb[i] += star[i];
    codes = glint_measure_encode(
        image, fmin(exposure, BRIGHTER * glint_measure_exposure(image)));
    if (!codes)
        return GLINT_E_MEMORY;
    fprintf(file,
            "<img alt=\"lamp at %.1f degrees\" title=\"lamp at %.1f degrees\" "
            "src=\"",
            theta_deg, theta_deg);
    html_png(file, codes, image->width, image->height);
    fputs("\">", file);
    free(codes);
    return GLINT_OK;
}

static int draw_all(const struct tool *tool, struct settings *s, FILE *file)
{
    const double tall =
        ceil(WIDE * s->lens.film_height_mm / s->lens.film_width_mm);
    struct glint_float_image image = {
        .width = WIDE, .height = (int)fmin(fmax(tall, 8), MOST_HIGH)};
    const size_t n = 3 * (size_t)image.width * (size_t)image.height;
    enum glint_status status = GLINT_E_MEMORY;
    struct glint_engine_config cfg;
    struct glint_engine *engine = NULL;
    struct glint_error error = {""};
    float *star = calloc(n, sizeof *star);

    image.rgb = calloc(n, sizeof *image.rgb);
    settings_engine(tool, s, image.width, image.height, &cfg);
    cfg.light.by_hand = 1;
    cfg.light.starburst = 1;
    cfg.search.max_found = 0;
    if (image.rgb && star)
        status = glint_engine_create(&engine, &cfg, &error);
    for (int i = 0; i < ANGLES && status == GLINT_OK; i++)
        status = draw(engine, angle_deg(s, share[i]), &image, star, file);
    glint_engine_destroy(engine);
    free(star);
    free(image.rgb);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

int thumbnails_write(const struct tool *tool, struct settings *settings,
                     const char *name, FILE *file, size_t *model_bytes)
{
    int code = settings_open(tool, settings, name);

    *model_bytes = settings->model.bytes;
    if (code == EXIT_OK)
        code = draw_all(tool, settings, file);
    settings_close(settings);
    return code;
}
