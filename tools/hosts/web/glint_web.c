/* SPDX-License-Identifier: MIT */
#include "web/glint_web.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/tones.h"
#include "glint/area.h"
#include "glint/bake.h"
#include "glint/engine.h"
#include "glint/explain.h"
#include "glint/options.h"
#include "glint/quality.h"
#include "model/ghost_file.h"
#include "overlay/grey.h"

/* default roundness of the aperture blades, as in glint overlay; --stop may set
 * another one */
#define PHOTO_ROUNDNESS 0.2

/* number of the name of a quality, as in glint_quality_name: draft */
enum { DRAFT = 1 };

static struct {
    struct glint_error error;
    struct glint_options options;
    char *text[GLINT_N_OPTIONS]; /* values of text options */

    struct glint_prescription table;
    struct glint_tint *tints; /* of the option ghosts; NULL: none */
    struct glint_dirt *dirt;
    struct glint_setup setup;
    struct glint_projection projection;

    struct glint_engine *engine;
    int width, height;
    struct glint_engine_lamp found[GLINT_ENGINE_MAX_LAMPS];
    struct glint_engine_lamp lamp[GLINT_ENGINE_MAX_LAMPS];
    int n_found;
    double row[GLINT_ENGINE_MAX_LAMPS][WEB_COLUMNS];
} web;

/* Records REASON for web_error(). Returns 0. */
static int record_error(const char *reason)
{
    snprintf(web.error.text, sizeof web.error.text, "%s", reason);
    return 0;
}

static int record_status(enum glint_status status)
{
    if (status != GLINT_OK && !web.error.text[0])
        record_error(glint_status_text(status));
    return status == GLINT_OK;
}

void *web_take(size_t bytes)
{
    return malloc(bytes);
}

void web_free(void *mem)
{
    free(mem);
}

const char *web_error(void)
{
    return web.error.text;
}

/* ------------------------------------------------------------------ options */

void web_reset(void)
{
    for (int i = 0; i < GLINT_N_OPTIONS; i++) {
        free(web.text[i]);
        web.text[i] = NULL;
    }
    glint_options_defaults(&web.options);
}

bool web_has_option(const struct glint_option *row)
{
    return row == glint_option(GLINT_OPTION_OF_ghosts) ||
           (row->scope != GLINT_OPTION_PROGRAM &&
            row != glint_option(GLINT_OPTION_OF_rays));
}

static const struct web_lens *find_web_lens(const char *name)
{
    const struct web_lens *lens = web_lens;

    while (lens->name && strcmp(lens->name, name) != 0)
        lens++;
    return lens->name ? lens : NULL;
}

int web_set(const char *name, const char *text)
{
    const struct glint_option *const row = glint_option_named(name);
    struct glint_error why = {""};
    char *copy;

    web.error.text[0] = '\0';
    if (!row || !web_has_option(row)) {
        snprintf(web.error.text, sizeof web.error.text, "no option %s", name);
        return 0;
    }
    if (strcmp(name, "lens") == 0 && !find_web_lens(text))
        return record_error("no lens has this name");
    copy = strdup(text);
    if (!copy)
        return record_error("no memory");
    if (glint_options_set_text(&web.options, name, copy, &why) != GLINT_OK) {
        snprintf(web.error.text, sizeof web.error.text, "%s is %.160s, not %s",
                 name, why.text, text);
        free(copy);
        return 0;
    }
    free(web.text[row - glint_option(0)]);
    web.text[row - glint_option(0)] = copy;
    return 1;
}

/* --------------------------------------------------------------------- lens */

static void close_web_engine(void)
{
    glint_engine_destroy(web.engine);
    web.engine = NULL;
    web.n_found = 0;
    glint_dirt_free(web.dirt);
    web.dirt = NULL;
    free(web.tints);
    web.tints = NULL;
}

/* Applies the films of --coating to the table. */
static int apply_coating_option(void)
{
    struct glint_coating coating[GLINT_MAX_COATINGS];
    const char *const text = web.options.coating;
    int n;

    if (strcmp(text, "table") == 0)
        return 1;
    if (strcmp(text, "mixed") != 0) {
        if (!record_status(glint_coatings_parse(coating, &n, text, &web.error)))
            return 0;
        glint_prescription_coat(&web.table, coating, n);
    } else if (web.table.n_mixed) {
        glint_prescription_coat(&web.table, web.table.mixed, web.table.n_mixed);
    } else {
        n = glint_coatings_mixed(coating);
        glint_prescription_coat(&web.table, coating, n);
    }
    return 1;
}

static int move_zoom_groups(void)
{
    const struct glint_options *const o = &web.options;
    enum glint_status status = GLINT_OK;
    double along = o->zoom;

    if (GLINT_OPTION_GIVEN(o, zoom) && along > 1)
        status =
            glint_prescription_zoom_to(&web.table, o->zoom, &along, &web.error);
    if (status == GLINT_OK && GLINT_OPTION_GIVEN(o, zoom))
        status = glint_prescription_zoom(&web.table, along, &web.error);
    if (status == GLINT_OK && o->focus > 0)
        status = glint_prescription_focus(&web.table, o->focus, &web.error);
    return record_status(status);
}

/* Sets the table to the lens of the options, with their zoom, focus, coating
 * and f-number. */
static int open_web_lens(void)
{
    const struct glint_options *const o = &web.options;
    const struct web_lens *const from = find_web_lens(o->lens);

    if (!from)
        return record_error("no lens has this name");
    return record_status(glint_prescription_parse(&web.table, from->text,
                                                  strlen(from->text),
                                                  from->name, &web.error)) &&
           move_zoom_groups() && apply_coating_option() &&
           (!(o->f_number > 0) || record_status(glint_prescription_set_f_number(
                                      &web.table, o->f_number, &web.error)));
}

/* ------------------------------------------------------------------- engine */

/* Sets CAMERA from the options and computes the lens's setup. The aperture has
 * the blades that glint overlay uses for photographs, unless the options or the
 * table define others. */
static int set_up_camera(struct glint_engine_camera *camera)
{
    const bool draft = web.options.quality <= glint_quality_named(DRAFT);
    double nm[GLINT_MAX_WAVELENGTHS];
    int n;

    if (!web.options.stop && web.table.stop_is_circle) {
        camera->n_blades = 0;
        camera->iris.roundness = 0;
    }
    n = glint_waves_list(&camera->waves, nm);
    return record_status((draft ? glint_setup_init_draft : glint_setup_init)(
               &web.setup, &web.table, camera->n_blades,
               camera->blade_rotation_deg, nm, n, &web.error)) &&
           record_status(glint_engine_setup(&web.setup, NULL, camera, &web.dirt,
                                            &web.error));
}

/* Sets the tints of ghosts that the option ghosts defines. */
static int apply_ghosts_option(void)
{
    const char *const text = web.options.ghosts;

    return !text || record_status(ghost_file_parse(&web.tints, "ghosts", text,
                                                   strlen(text), &web.setup,
                                                   web.table.name, &web.error));
}

int web_size(int width, int height)
{
    const struct glint_options *const o = &web.options;
    struct glint_engine_config cfg;
    double miss_deg;

    web.error.text[0] = '\0';
    close_web_engine();
    if (!open_web_lens())
        return 0;
    web.projection = (struct glint_projection){0, {0}};
    if (o->projection == GLINT_PROJECTION_LENS &&
        !record_status(glint_projection_of(&web.projection, &web.table,
                                           &miss_deg, &web.error)))
        return 0;
    glint_engine_defaults(&cfg, width, height);
    cfg.camera.iris.roundness = PHOTO_ROUNDNESS;
    glint_engine_configure(&cfg, o);
    if (!set_up_camera(&cfg.camera) || !apply_ghosts_option())
        return 0;
    cfg.search.more_lamps = GLINT_ENGINE_MAX_LAMPS;
    cfg.camera.setup = &web.setup;
    cfg.camera.rays = &glint_frame_traces;
    cfg.camera.tints = web.tints;
    cfg.camera.projection = &web.projection;
    if (!(cfg.camera.sensor_width_mm > 0)) {
        cfg.camera.sensor_width_mm = web.table.film_width_mm;
        cfg.camera.sensor_height_mm = web.table.film_height_mm;
    }
    web.width = width;
    web.height = height;
    return record_status(glint_engine_create(&web.engine, &cfg, &web.error));
}

static struct glint_image wrap_pixels_as_image(uint8_t *pixels)
{
    return glint_image_over(pixels, GLINT_XBGR8888, web.width, web.height);
}

double *web_lamps(void)
{
    return web.row[0];
}

/* Sets ROW to the values of LAMP, in the units of the file that glint overlay
 * --save-lights writes. */
static void write_lamp_row(double row[WEB_COLUMNS],
                           const struct glint_engine_lamp *lamp)
{
    const struct glint_view *const view = glint_engine_view(web.engine);
    const double *const axis = lamp->lamp.axis;
    const double pixels =
        view->width * fabs(web.setup.optics.focal_mm) /
        view->sensor_width_mm; /* pixels per unit of the tangent of the field
                                * angle */

    row[WEB_X] = lamp->track.x_q8 / 256.0;
    row[WEB_Y] = lamp->track.y_q8 / 256.0;
    row[WEB_POWER] = lamp->lamp.power;
    memcpy(row + WEB_RED, lamp->lamp.rgb, sizeof lamp->lamp.rgb);
    row[WEB_SIZE] = pixels * hypot(axis[0], axis[1]);
    row[WEB_SHAPE] = axis[0] > 0 ? axis[1] / axis[0] : 1;
    row[WEB_TURN] = lamp->lamp.turn_deg;
    row[WEB_LEVEL] = lamp->level;
    row[WEB_SEEN] = fmax(lamp->seen_px, 0);
}

/* Returns the lamp that ROW describes, in the units of the file that glint
 * overlay --lights reads. */
static struct glint_engine_lamp read_lamp_row(const double row[WEB_COLUMNS],
                                              uint32_t id)
{
    const struct glint_view *const view = glint_engine_view(web.engine);
    const double focal_mm = web.setup.optics.focal_mm;
    const double size =
        row[WEB_SIZE] * glint_view_pixel_tangent(view, focal_mm);
    struct glint_lamp lamp = {.power = row[WEB_POWER]};
    struct glint_engine_lamp known;

    glint_view_to_angles(view, focal_mm, row[WEB_X], row[WEB_Y], &lamp);
    memcpy(lamp.rgb, row + WEB_RED, sizeof lamp.rgb);
    glint_area_set_round(&lamp, size);
    if (row[WEB_SHAPE] != 1) {
        lamp.axis[0] = row[WEB_SIZE] *
                       glint_view_pixel_tangent(view, focal_mm) /
                       sqrt(1 + row[WEB_SHAPE] * row[WEB_SHAPE]);
        lamp.axis[1] = row[WEB_SHAPE] * lamp.axis[0];
        lamp.turn_deg = row[WEB_TURN];
    }
    known = glint_engine_lamp_of(&lamp, id);
    known.level = row[WEB_LEVEL];
    known.seen_px = row[WEB_SEEN];
    return known;
}

/* Returns the picture PIXELS, or a grey copy of a monochrome photograph, as
 * glint overlay finds lamps in it and draws on it. The caller frees *COPY. */
static struct glint_image choose_image(uint8_t *pixels, uint8_t **copy)
{
    const struct glint_image image = wrap_pixels_as_image(pixels);

    *copy = grey_is_monochrome(&image)
                ? malloc((size_t)web.width * (size_t)web.height)
                : NULL;
    return *copy ? grey_copy_green(&image, *copy) : image;
}

int web_find(uint8_t *pixels)
{
    struct glint_image image;
    uint8_t *copy;

    if (!web.engine)
        return 0;
    image = choose_image(pixels, &copy);
    web.n_found = glint_engine_find(web.engine, &image, 0, web.found,
                                    GLINT_ENGINE_MAX_LAMPS);
    free(copy);
    for (int i = 0; i < web.n_found; i++)
        write_lamp_row(web.row[i], &web.found[i]);
    return web.n_found;
}

int web_doubtful(int i, double xy[2])
{
    struct glint_spot spot;

    if (!web.engine || !glint_engine_doubtful(web.engine, i, &spot))
        return 0;
    xy[0] = spot.x_q8 / 256.0;
    xy[1] = spot.y_q8 / 256.0;
    return 1;
}

/* Returns whether the values in ROW are in the ranges that glint overlay
 * --lights accepts. */
static bool is_lamp_row_valid(const double row[WEB_COLUMNS])
{
    return fabs(row[WEB_X]) <= 1e6 && fabs(row[WEB_Y]) <= 1e6 &&
           glint_lamp_power_is_valid(row[WEB_POWER], row + WEB_RED) &&
           fmin(row[WEB_RED], fmin(row[WEB_GREEN], row[WEB_BLUE])) >= 0 &&
           row[WEB_SIZE] >= 0 && row[WEB_SIZE] <= 1e6 && row[WEB_SHAPE] >= 0 &&
           row[WEB_SHAPE] <= 1 && row[WEB_LEVEL] > 0 && row[WEB_LEVEL] <= 1 &&
           row[WEB_SEEN] >= 0 && row[WEB_SEEN] <= 1e6 &&
           isfinite(row[WEB_TURN]);
}

/* Sets web.lamp to the first N rows, or to the lamps found if N is WEB_FOUND,
 * and applies the options of light. Returns the number of lamps, or -1 on
 * failure. */
static int prepare_lamps(int n)
{
    struct glint_engine_config cfg;

    if (!web.engine)
        return record_error("there is no engine") - 1;
    if (n < WEB_FOUND || n > GLINT_ENGINE_MAX_LAMPS)
        return record_error("the number of lamps must be 0 to 1024") - 1;
    web.error.text[0] = '\0';
    if (n == WEB_FOUND) {
        n = web.n_found;
        memcpy(web.lamp, web.found, (size_t)n * sizeof *web.lamp);
    } else
        for (int i = 0; i < n; i++) {
            if (!is_lamp_row_valid(web.row[i]))
                return record_error("a lamp is out of range") - 1;
            web.lamp[i] = read_lamp_row(web.row[i], (uint32_t)i + 1);
        }
    glint_engine_configure(&cfg, &web.options);
    glint_engine_set_light(web.engine, &cfg.light);
    glint_engine_elapsed(web.engine, 0);
    return n;
}

int web_draw(uint8_t *pixels, int n)
{
    const int n_lamps = prepare_lamps(n);
    struct glint_engine_report report;
    const struct glint_image whole = wrap_pixels_as_image(pixels);
    enum glint_status status;
    struct glint_image image;
    uint8_t *copy;

    if (n_lamps < 0)
        return 0;
    image = choose_image(pixels, &copy);
    status = glint_engine_draw(web.engine, web.lamp, n_lamps, &image, &report);
    if (copy)
        grey_add_difference(&whole, &image);
    free(copy);
    return record_status(status);
}

/* ------------------------------------------------------------------ 16 bits */

/* Draws the flare of N lamps on the picture PIXELS into RGB, linear light. */
static enum glint_status draw_flare_alone(uint8_t *pixels, int n, float *rgb)
{
    const struct glint_image image = wrap_pixels_as_image(pixels);
    struct glint_engine_report report;
    const enum glint_status status =
        glint_engine_expose(web.engine, web.lamp, n, &image, 1);

    memset(rgb, 0, 12 * (size_t)web.width * (size_t)web.height);
    if (status != GLINT_OK ||
        (!glint_engine_has_veil(web.engine) &&
         (n == 0 || !(glint_engine_exposed(web.engine)->scale > 0))))
        return status;
    return glint_engine_draw_layer(web.engine, web.lamp, n,
                                   GLINT_ENGINE_ALL | GLINT_ENGINE_CODES_16,
                                   rgb, &report);
}

/* Writes CODE, 0 .. 1, to TO as 16 bits; returns the address after it. */
static uint8_t *write_code(uint8_t *to, double code)
{
    const unsigned value = (unsigned)(fmin(code, 1) * 65535 + 0.5);

    to[0] = (uint8_t)(value >> 8);
    to[1] = (uint8_t)value;
    return to + 2;
}

/* the curve of sRGB, and the light of its 8-bit codes */
struct tones {
    struct glint_tone_curve srgb;
    float light[256];
};

/* Writes the sum of the pixel PX and the light RGB. */
static uint8_t *write_sum(uint8_t *to, const uint8_t *px, const float *rgb,
                          const struct tones *tones)
{
    for (int c = 0; c < 3; c++) {
        const double sum = (double)tones->light[px[c]] + (double)rgb[c];
        const double code = px[c] / 255.0;

        to = write_code(
            to, rgb[c] > 0
                    ? fmax(glint_tone_curve_encode(&tones->srgb, sum), code)
                    : code);
    }
    return to;
}

/* Writes the light RGB divided by its largest channel, which becomes alpha. */
static uint8_t *write_with_alpha(uint8_t *to, const float *rgb,
                                 const struct tones *tones)
{
    const float max = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
    const double alpha = (double)fminf(max, 1);

    for (int c = 0; c < 3; c++)
        to = write_code(
            to, rgb[c] > 0 ? glint_tone_curve_encode(
                                 &tones->srgb, (double)rgb[c] * (1 / alpha))
                           : 0);
    return write_code(to, fmax(alpha, 0));
}

int web_draw_deep(uint8_t *pixels, int n, int alone, uint8_t *samples)
{
    const size_t count = (size_t)web.width * (size_t)web.height;
    const struct glint_image image = wrap_pixels_as_image(pixels);
    const bool is_grey = !alone && grey_is_monochrome(&image);
    int n_lamps = prepare_lamps(n);
    enum glint_status status;
    struct tones tones;
    float *rgb;

    if (n_lamps < 0)
        return 0;
    rgb = malloc(3 * count * sizeof *rgb);
    if (!rgb)
        return record_error("no memory");
    if (n == WEB_FOUND) /* in colour, as glint overlay finds them at 16 bits */
        n_lamps = glint_engine_find(web.engine, &image, 0, web.lamp,
                                    GLINT_ENGINE_MAX_LAMPS);
    glint_tone_curve_set(&tones.srgb, GLINT_TONE_IS_SRGB, 0);
    for (int i = 0; i < 256; i++)
        tones.light[i] = (float)glint_tone_curve_decode(&tones.srgb, i / 255.0);
    status = draw_flare_alone(pixels, n_lamps, rgb);
    if (is_grey)
        grey_convert_light(rgb, count);
    for (size_t i = 0; i < count && status == GLINT_OK; i++)
        samples = alone
                      ? write_with_alpha(samples, rgb + 3 * i, &tones)
                      : write_sum(samples, pixels + 4 * i, rgb + 3 * i, &tones);
    free(rgb);
    return record_status(status);
}

int web_ghosts(double (*rows)[WEB_GHOST_COLUMNS], int max)
{
    const struct glint_explain_config config = {.gain = 0};
    int order[GLINT_MAX_GHOSTS], n = 0;
    struct glint_explain explain;

    if (!web.engine)
        return record_error("there is no engine") - 1;
    web.error.text[0] = '\0';
    if (!record_status(glint_explain_open(&explain, web.engine, &config))) {
        glint_explain_close(&explain);
        return -1;
    }
    glint_explain_sort(&explain, order);
    for (; n < max && n < explain.n_ghosts; n++) {
        const struct glint_explain_part *const p = &explain.ghost[order[n]];
        const double row[] = {order[n], p->share, p->x0, p->y0, p->x1, p->y1};

        if (!(p->flux > 0))
            break;
        memcpy(rows[n], row, sizeof row);
    }
    glint_explain_close(&explain);
    return n;
}
