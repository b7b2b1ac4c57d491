/* SPDX-License-Identifier: MIT */
#include "lens_figures/thumbnail.h"

#include <math.h>
#include <stdlib.h>

#include "engine/measure.h"
#include "glint/glint.h"
#include "lab/sweep.h"

enum { ANGLES = 3, WIDE = 168, MOST_HIGH = 168 };

static const double share[ANGLES] = {0.25, 0.5, 0.8};

/* How much brighter than by the star's light, which is most of a frame's. */
#define BRIGHTER 3.0

/* Returns the angle at SHARE of the half diagonal, by f tan T, which places
 * lamps in pictures. */
static double angle_deg(const struct settings *s, double at)
{
    const double half =
        0.5 * hypot(s->lens.film_width_mm, s->lens.film_height_mm);

    return atan(at * half / s->setup.optics.focal_mm) * 180 / GLINT_PI;
}

static enum glint_status draw(struct glint_frame *frame, double theta_deg,
                              struct glint_float_image *image, FILE *file)
{
    const struct glint_lamp lamp = {
        .theta_deg = theta_deg, .phi_deg = 33, .power = 1, .rgb = {1, 1, 1}};
    struct glint_frame_report report;
    uint8_t *codes;
    const enum glint_status status =
        glint_frame_draw_alone(frame, &lamp, 1, 1, image->rgb, &report);

    if (status != GLINT_OK)
        return status;
    codes =
        glint_measure_encode(image, BRIGHTER * glint_measure_exposure(image));
    if (!codes)
        return GLINT_E_MEMORY;
    fprintf(file, "<img alt=\"lamp at %.1f degrees\" src=\"", theta_deg);
    sweep_png(file, codes, image->width, image->height);
    fputs("\">", file);
    free(codes);
    return GLINT_OK;
}

static int draw_all(const struct tool *tool, const struct settings *s,
                    FILE *file)
{
    const double tall =
        ceil(WIDE * s->lens.film_height_mm / s->lens.film_width_mm);
    struct glint_float_image image = {
        .width = WIDE, .height = (int)fmin(fmax(tall, 8), MOST_HIGH)};
    enum glint_status status = GLINT_E_MEMORY;
    struct glint_frame frame;
    int code;

    image.rgb =
        calloc(3 * (size_t)image.width * (size_t)image.height, sizeof(float));
    code = settings_frame(tool, s, settings_view(s, image.width, image.height),
                          &frame);
    if (code == EXIT_OK && image.rgb)
        status = GLINT_OK;
    for (int i = 0; i < ANGLES && status == GLINT_OK; i++)
        status = draw(&frame, angle_deg(s, share[i]), &image, file);
    glint_frame_finish(&frame);
    free(image.rgb);
    return code != EXIT_OK || status == GLINT_OK
               ? code
               : tool_fail(tool, status, NULL);
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
