/* SPDX-License-Identifier: MIT */
#include "synth/draw.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "glint/area.h"
#include "glint/measure.h"
#include "formats/picture.h"
#include "posix/input.h"
#include "model/names.h"

/* ------------------------------------------------------------------ listing */

const char *synth_background_file_name(const char *path)
{
    const char *const slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

static bool is_picture_name(const char *name)
{
    static const char *const ending[] = {
        ".ppm", ".pgm",  ".pnm",  ".pfm", ".png", ".jpg", ".jpeg", ".tif",
        ".bmp", ".webp", ".tiff", ".exr", ".hdr", ".tga", NULL};
    const char *const dot = strrchr(name, '.');

    for (int i = 0; dot && name[0] != '.' && ending[i]; i++)
        if (strcasecmp(dot, ending[i]) == 0)
            return true;
    return false;
}

static bool add_background_path(struct synth_backgrounds *list,
                                const char *folder, const char *name)
{
    const size_t bytes = strlen(folder) + strlen(name) + 2;
    char **const more =
        realloc(list->path, ((size_t)list->n + 1) * sizeof *more);
    char *const path = malloc(bytes);

    if (more)
        list->path = more;
    if (!more || !path) {
        free(path);
        return false;
    }
    snprintf(path, bytes, "%s%s%s", folder, *folder ? "/" : "", name);
    list->path[list->n++] = path;
    return true;
}

static int add_background_folder(const struct tool *tool,
                                 struct synth_backgrounds *list,
                                 const char *folder)
{
    const int before = list->n;
    DIR *const dir = opendir(folder);
    const struct dirent *entry;
    struct glint_error error;
    bool is_room = true;

    if (!dir)
        return tool_fail(
            tool,
            glint_error_report(&error, GLINT_E_IO, folder, "cannot be read"),
            error.text);
    while (is_room && (entry = readdir(dir)))
        if (is_picture_name(entry->d_name))
            is_room = add_background_path(list, folder, entry->d_name);
    closedir(dir);
    if (!is_room)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    if (list->n == before)
        return tool_fail(
            tool,
            glint_error_report(&error, GLINT_E_IO, folder,
                               "contains no pictures (.ppm, .png, .jpg ...)"),
            error.text);
    return EXIT_OK;
}

static int compare_background_names(const void *a, const void *b)
{
    return strcmp(synth_background_file_name(*(char *const *)a),
                  synth_background_file_name(*(char *const *)b));
}

int synth_backgrounds_open(const struct tool *tool,
                           struct synth_backgrounds *list, char **words, int n)
{
    struct glint_error error;
    struct stat st;
    int code = EXIT_OK;

    *list = (struct synth_backgrounds){.n = 0};
    for (int i = 0; i < n && code == EXIT_OK; i++)
        if (stat(words[i], &st) < 0)
            code = tool_fail(tool,
                             glint_error_report(&error, GLINT_E_IO, words[i],
                                                "%s", strerror(errno)),
                             error.text);
        else if (S_ISDIR(st.st_mode))
            code = add_background_folder(tool, list, words[i]);
        else if (!add_background_path(list, "", words[i]))
            code = tool_fail(tool, GLINT_E_MEMORY, NULL);
    if (code != EXIT_OK)
        return code;
    qsort(list->path, (size_t)list->n, sizeof *list->path,
          compare_background_names);
    for (int i = 0; i < list->n; i++) {
        if (strlen(synth_background_file_name(list->path[i])) >=
            SYNTH_NAME_BYTES)
            return tool_usage(tool, "%s: its name is too long", list->path[i]);
        if (i > 0 &&
            compare_background_names(&list->path[i - 1], &list->path[i]) == 0)
            return tool_usage(tool,
                              "%s and %s have the same name, so that the "
                              "manifest could not distinguish them",
                              list->path[i - 1], list->path[i]);
    }
    return EXIT_OK;
}

void synth_backgrounds_close(struct synth_backgrounds *list)
{
    for (int i = 0; i < list->n; i++)
        free(list->path[i]);
    free(list->path);
}

/* ------------------------------------------------------------------ loading */

enum { MOST_BYTES = 1 << 30 };

enum glint_status synth_hash_background(char key[20], const char *path,
                                        struct glint_error *error)
{
    uint64_t number = TOOL_KEY_BEGIN;
    uint8_t *data = NULL;
    size_t bytes;
    const enum glint_status status =
        glint_input_read_whole_file(&data, &bytes, path, MOST_BYTES, error);

    if (status == GLINT_OK) {
        tool_hash_into_key(&number, data, bytes);
        snprintf(key, 20, "%016" PRIx64, number);
    }
    free(data);
    return status;
}

/* Sets TO to the light of FROM at (X, Y), in pixels, interpolated bilinearly
 * between pixel centres. */
static void interpolate_light(const struct glint_float_image *from, double x,
                              double y, double to[3])
{
    const double u = fmin(fmax(x - 0.5, 0), from->width - 1);
    const double v = fmin(fmax(y - 0.5, 0), from->height - 1);
    const int left = (int)u, top = (int)v;
    const int right = left + 1 < from->width ? left + 1 : left;
    const int low = top + 1 < from->height ? top + 1 : top;
    const float *const row = from->rgb + 3 * (size_t)top * (size_t)from->width;
    const float *const next = from->rgb + 3 * (size_t)low * (size_t)from->width;

    for (int c = 0; c < 3; c++) {
        const double a = row[3 * left + c], b = row[3 * right + c];
        const double d = next[3 * left + c], e = next[3 * right + c];
        const double over = a + (b - a) * (u - left);

        to[c] = over + (d + (e - d) * (u - left) - over) * (v - top);
    }
}

/* Resamples the crop of FROM, which ITEM defines, to RGB. A pixel of RGB is the
 * mean of N x N points, where N is the ratio of the pixel sizes, rounded up, at
 * most 64. */
static void resample_cropped_background(const struct glint_float_image *from,
                                        const struct synth_item *item,
                                        float *rgb)
{
    const int width = (int)item->width, height = (int)item->height;
    const double step = item->crop * fmin((double)from->width / width,
                                          (double)from->height / height);
    const double left = item->crop_x * (from->width - step * width);
    const double top = item->crop_y * (from->height - step * height);
    const int n = (int)fmin(ceil(step), 64);

    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const int column = item->mirrored > 0 ? width - 1 - x : x;
            float *const to = rgb + 3 * ((size_t)y * (size_t)width + (size_t)x);
            double sum[3] = {0, 0, 0}, one[3];

            for (int k = 0; k < n * n; k++) {
                const int across = k % n, down = k / n;

                interpolate_light(from,
                                  left + step * (column + (across + 0.5) / n),
                                  top + step * (y + (down + 0.5) / n), one);
                for (int c = 0; c < 3; c++)
                    sum[c] += one[c];
            }
            for (int c = 0; c < 3; c++)
                to[c] = (float)fmax(sum[c] / (n * n), 0);
        }
}

/* Scales RGB[N] by the ratio of LEVEL to the mean of its samples, each clamped
 * to at most 1. Returns the factor in stops, which is limited to
 * SYNTH_LEAST_EV .. SYNTH_MOST_EV. */
static double scale_to_mean_level(float *rgb, size_t n, double level)
{
    double sum = 0, ev;

    for (size_t i = 0; i < n; i++)
        sum += fmin(rgb[i], 1);
    ev = fmin(fmax(log2(level / fmax(sum / (double)n, 1e-6)), SYNTH_LEAST_EV),
              SYNTH_MOST_EV);
    for (size_t i = 0; i < n; i++)
        rgb[i] *= (float)exp2(ev);
    return ev;
}

static const char *find_background_path(const struct synth_backgrounds *list,
                                        const struct synth_item *item)
{
    for (int i = 0; i < list->n; i++)
        if (strcmp(synth_background_file_name(list->path[i]),
                   item->background) == 0)
            return list->path[i];
    return NULL;
}

/* Sets RGB[height][width][3], linear light, to the crop of the background that
 * ITEM defines, and EV to the stops by which the crop was scaled to ITEM's
 * level. Returns GLINT_E_IO with ERROR if there is no such background or the
 * file's hash differs from ITEM's, or the errors of
 * glint_picture_load_float(). */
static enum glint_status load_background(const struct synth_backgrounds *list,
                                         const struct synth_item *item,
                                         float *rgb, double *ev,
                                         struct glint_error *error)
{
    const char *const path = find_background_path(list, item);
    struct glint_float_image image = {.rgb = NULL};
    char key[20] = "";
    enum glint_status status;

    if (!path)
        return glint_error_report(
            error, GLINT_E_IO, item->background,
            "is not one of the background pictures of this command");
    status = synth_hash_background(key, path, error);
    if (status == GLINT_OK && strcmp(key, item->background_key) != 0)
        return glint_error_report(error, GLINT_E_IO, path,
                                  "is not the picture that the item was drawn "
                                  "on (hash %s, not %s): use the original file",
                                  key, item->background_key);
    if (status == GLINT_OK)
        status = glint_picture_load_float(path, &image, error);
    if (status != GLINT_OK)
        return status;
    resample_cropped_background(&image, item, rgb);
    free(image.rgb);
    *ev = scale_to_mean_level(
        rgb, 3 * (size_t)item->width * (size_t)item->height, item->level);
    return GLINT_OK;
}

enum glint_status synth_drawing_init(struct synth_drawing *d, int width,
                                     int height)
{
    const size_t n = 3 * (size_t)width * (size_t)height;
    float *const mem = calloc((SYNTH_LAYERS + 1) * n, sizeof *mem);

    *d = (struct synth_drawing){.width = width, .height = height};
    for (int i = 0; mem && i < SYNTH_LAYERS; i++)
        d->layer[i] = mem + (size_t)i * n;
    d->cover = mem ? mem + SYNTH_LAYERS * n : NULL;
    return mem ? GLINT_OK : GLINT_E_MEMORY;
}

void synth_drawing_finish(struct synth_drawing *d)
{
    free(d->layer[0]);
}

static struct glint_float_image
wrap_pixels_as_image(const struct synth_drawing *d, float *rgb)
{
    return (struct glint_float_image){d->width, d->height, rgb};
}

/* ------------------------------------------------------------------- lenses */

static int open_lens_by_name(const struct tool *tool, struct synth_lens *lens,
                             const struct synth_item *item)
{
    struct settings *const s = &lens->settings;
    const struct glint_optics *const optics = &lens->opened.setup.optics;
    const char *end;
    char quality[40];
    int code = -1;

    snprintf(lens->name, sizeof lens->name, "%s", item->lens);
    snprintf(lens->coating, sizeof lens->coating, "%s", item->coating);
    lens->quality = item->quality;
    settings_set_defaults(s);
    snprintf(quality, sizeof quality, "%.6f", item->quality);
    settings_set_quality(s, glint_option_number(quality, &end));
    s->camera.waves.kind = GLINT_WAVES_AUTO;
    /* "mixed" is the default; a model keeps the coatings of its bake. */
    if (!tool_is_model(item->lens) || strcmp(item->coating, "mixed") != 0)
        code = coating_parse_option(tool, &s->coating, item->coating);
    if (code < 0)
        code = opened_lens_open(tool, &lens->opened, s, item->lens);
    if (code == EXIT_OK)
        lens->widest =
            fabs(optics->focal_mm) / (2 * optics->entrance_radius_mm);
    return code;
}

int synth_lens_open(const struct tool *tool, struct synth_lenses *lenses,
                    const struct synth_item *item, struct synth_lens **lens)
{
    for (int i = 0; i < lenses->n; i++) {
        *lens = lenses->lens[i];
        if (strcmp((*lens)->name, item->lens) == 0 &&
            strcmp((*lens)->coating, item->coating) == 0 &&
            (*lens)->quality == item->quality)
            return EXIT_OK;
    }
    if (lenses->n == SYNTH_MAX_LENSES)
        return tool_usage(tool, "accepts at most %d lenses", SYNTH_MAX_LENSES);
    *lens = calloc(1, sizeof **lens);
    if (!*lens)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    /* The lens is added to the list even if opening fails, so that it is closed
     * later. */
    lenses->lens[lenses->n++] = *lens;
    return open_lens_by_name(tool, *lens, item);
}

void synth_lenses_close(struct synth_lenses *lenses)
{
    for (int i = 0; i < lenses->n; i++) {
        opened_lens_close(&lenses->lens[i]->opened);
        free(lenses->lens[i]);
    }
}

/* Sets the stop of LENS, and the dirt on its front element, to the values in
 * ITEM. */
static int set_lens_stop_and_dirt(const struct tool *tool,
                                  struct synth_lens *lens,
                                  const struct synth_item *item,
                                  struct synth_result *result)
{
    struct settings *const s = &lens->settings;
    struct glint_engine_camera *const camera = &s->camera;
    struct glint_error error = {""};
    enum glint_status status;

    s->has_stop = true;
    camera->n_blades = (int)item->blades;
    camera->blade_rotation_deg = item->rotation;
    camera->iris.roundness = item->roundness;
    camera->iris.softness = item->softness;
    camera->iris.dust = item->dust;
    camera->iris.dust_seed = (int)item->dust_seed;
    camera->front_dirt.dust = item->front_dust;
    camera->front_dirt.dust_seed = (int)item->front_dust_seed;
    result->f_number = lens->widest * exp2(item->stops_down / 2);
    /* If stops_down is 0, the f-number is not set. A rounded f-number might
     * open wider than the stop of the model. */
    s->options.f_number = item->stops_down > 0 ? result->f_number : 0;
    status = opened_lens_set_stop(&lens->opened, s, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    result->focal_mm = lens->opened.setup.optics.focal_mm;
    return opened_lens_set_front_dirt(tool, &lens->opened, camera, NULL);
}

/* ------------------------------------------------------------------- lights */

/* Sets RGB to the colour of a black body of KELVIN [Planck01], scaled so
 * that the largest component is 1. */
static void set_black_body_colour(double kelvin, double rgb[3])
{
    enum { WAVES = 16 };
    double nm[WAVES], colour[WAVES][3], share[WAVES], most = 0;

    glint_spectrum(WAVES, nm, colour, share);
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int i = 0; i < WAVES; i++) {
        /* c2 = h c / k = 1.438777e7 nm K */
        const double light =
            pow(nm[i] / 550, -5) / expm1(1.438777e7 / (nm[i] * kelvin));

        for (int c = 0; c < 3; c++)
            rgb[c] += colour[i][c] * light;
    }
    for (int c = 0; c < 3; c++)
        most = fmax(most, rgb[c] = fmax(rgb[c], 0));
    for (int c = 0; c < 3; c++)
        rgb[c] /= most;
}

/* Sets LAMP to the lights of ITEM, with their relative powers. */
static void set_lamps_of_item(const struct synth_item *item,
                              const struct synth_lens *lens,
                              struct glint_lamp *lamp,
                              struct synth_result *result)
{
    const struct glint_view view = opened_lens_compute_view(
        &lens->opened, &lens->settings, (int)item->width, (int)item->height);
    const double focal = lens->opened.setup.optics.focal_mm;

    result->sensor_width_mm = view.sensor_width_mm;
    for (int i = 0; i < (int)item->n_lights; i++) {
        const struct synth_light *const light = &item->light[i];

        lamp[i] = (struct glint_lamp){.power = light->power};
        glint_view_to_angles(&view, focal, light->x * item->width,
                             light->y * item->height, &lamp[i]);
        set_black_body_colour(light->kelvin, lamp[i].rgb);
        /* The RMS extent of a disc along an axis is half of its radius. */
        glint_area_set_round(&lamp[i],
                             0.5 * light->radius * item->height *
                                 glint_view_pixel_tangent(&view, focal));
        result->theta_deg[i] = lamp[i].theta_deg;
        result->phi_deg[i] = lamp[i].phi_deg;
        memcpy(result->rgb[i], lamp[i].rgb, sizeof lamp[i].rgb);
    }
}

/* Draws the discs of ITEM's lights into the source layer and the coverage. */
static void draw_light_discs(const struct synth_item *item,
                             const struct glint_lamp *lamp,
                             struct synth_drawing *d,
                             struct synth_result *result)
{
    float *const source = d->layer[SYNTH_SOURCE];

    memset(source, 0, 3 * (size_t)d->width * (size_t)d->height * sizeof(float));
    memset(d->cover, 0,
           3 * (size_t)d->width * (size_t)d->height * sizeof(float));
    for (int i = 0; i < (int)item->n_lights; i++) {
        const double radius = item->light[i].radius * item->height;
        const double x = item->light[i].x * item->width;
        const double y = item->light[i].y * item->height;

        result->power[i] = lamp[i].power;
        /* A light that causes flare is drawn at least twice as bright as
         * white. */
        result->white[i] =
            fmax(result->power[i] / (GLINT_PI * radius * radius), 2);
        for (int row = 0; row < d->height; row++)
            for (int column = 0; column < d->width; column++) {
                const size_t at =
                    3 * ((size_t)row * (size_t)d->width + (size_t)column);
                const double in =
                    radius + 0.5 - hypot(column + 0.5 - x, row + 0.5 - y);
                const double cover = fmin(fmax(in, 0), 1);

                for (int c = 0; c < 3 && cover > 0; c++) {
                    source[at + (size_t)c] +=
                        (float)(cover * result->white[i] * lamp[i].rgb[c]);
                    d->cover[at + (size_t)c] =
                        fmaxf(d->cover[at + (size_t)c], (float)cover);
                }
            }
    }
}

/* ------------------------------------------------------------------- flares */

/* Draws one part of the flare (enum glint_engine_part) to RGB. */
static int draw_flare_part(const struct tool *tool,
                           const struct synth_lens *lens,
                           const struct synth_item *item,
                           const struct glint_lamp *lamp, unsigned part,
                           float *rgb)
{
    struct glint_engine_report report;
    struct glint_engine_config cfg;
    struct glint_engine *engine;
    struct glint_error error = {""};
    enum glint_status status;

    opened_lens_configure_engine(tool, &lens->opened, &lens->settings,
                                 (int)item->width, (int)item->height, &cfg);
    cfg.drawing.parts = part;
    cfg.light.haze = item->haze;
    cfg.light.starburst = 1;
    cfg.light.by_hand = 1;
    cfg.search.max_found = 0;
    cfg.drawing.is_fresh = 1;
    status = glint_engine_create(&engine, &cfg, &error);
    if (status == GLINT_OK)
        status = glint_engine_render(engine, lamp, (int)item->n_lights, 1, part,
                                     rgb, &report);
    glint_engine_destroy(engine);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

/* Returns the power of the lights at which the brightest 0.1 % of the ghosts'
 * pixels have the light LEVEL. IMAGE shows the ghosts at power 1. The power is
 * reduced if the mean light would exceed SYNTH_MOST_MEAN times LEVEL, because
 * wide ghosts that fill the image would hide everything else. */
static double compute_light_power(const struct glint_float_image *image,
                                  double level)
{
    const size_t n = 3 * (size_t)image->width * (size_t)image->height;
    const double by_peak = level * glint_measure_exposure(image);
    double sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += (double)image->rgb[i];
    return fmin(by_peak,
                sum > 0 ? level * SYNTH_MOST_MEAN * (double)n / sum : by_peak);
}

static void scale_pixels(float *rgb, size_t n, double factor)
{
    for (size_t i = 0; i < n; i++)
        rgb[i] = (float)((double)rgb[i] * factor);
}

static int draw_flare(const struct tool *tool, const struct synth_lens *lens,
                      const struct synth_item *item, struct synth_drawing *d,
                      struct synth_result *result)
{
    const size_t n = 3 * (size_t)d->width * (size_t)d->height;
    float *const ghosts = d->layer[SYNTH_GHOSTS];
    float *const glare = d->layer[SYNTH_GLARE];
    /* The layer of the sources serves as scratch memory, because it is drawn
     * last. */
    float *const spare = d->layer[SYNTH_SOURCE];
    struct glint_float_image image = wrap_pixels_as_image(d, ghosts);
    struct glint_lamp lamp[SYNTH_MAX_LIGHTS] = {{.power = 0}};
    double power;
    int code;

    set_lamps_of_item(item, lens, lamp, result);
    code = draw_flare_part(tool, lens, item, lamp, GLINT_ENGINE_GHOSTS, ghosts);
    if (code != EXIT_OK)
        return code;
    power = compute_light_power(&image, item->ghost_level);
    scale_pixels(ghosts, n, power);
    /* Haze is quantised to 1e-6 of white, so lamps must have their final
     * power. */
    for (int i = 0; i < (int)item->n_lights; i++)
        lamp[i].power *= power;
    memset(glare, 0, n * sizeof *glare);
    if (item->star > 0)
        code =
            draw_flare_part(tool, lens, item, lamp, GLINT_ENGINE_STAR, glare);
    scale_pixels(glare, n, item->star);
    if (code == EXIT_OK && (item->haze > 0 || item->front_dust > 0)) {
        code =
            draw_flare_part(tool, lens, item, lamp, GLINT_ENGINE_VEIL, spare);
        for (size_t i = 0; i < n && code == EXIT_OK; i++)
            glare[i] += spare[i];
    }
    if (code == EXIT_OK)
        draw_light_discs(item, lamp, d, result);
    return code;
}

int synth_draw_item(const struct tool *tool, struct synth_lenses *lenses,
                    const struct synth_backgrounds *backgrounds,
                    const struct synth_item *item, struct synth_drawing *d,
                    struct synth_result *result)
{
    struct glint_error error = {""};
    struct synth_lens *lens = NULL;
    enum glint_status status;
    int code;

    *result = (struct synth_result){.f_number = 0};
    code = synth_lens_open(tool, lenses, item, &lens);
    if (code != EXIT_OK || !lens)
        return code;
    code = set_lens_stop_and_dirt(tool, lens, item, result);
    if (code == EXIT_OK)
        code = draw_flare(tool, lens, item, d, result);
    if (code != EXIT_OK)
        return code;
    status = load_background(backgrounds, item, d->layer[SYNTH_BASE],
                             &result->background_ev, &error);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

/* ------------------------------------------------------------------ sensors */

void synth_sum_layers(const struct synth_drawing *d, unsigned layers,
                      float *rgb)
{
    const size_t n = 3 * (size_t)d->width * (size_t)d->height;

    memset(rgb, 0, n * sizeof *rgb);
    for (int k = 0; k < SYNTH_LAYERS; k++)
        for (size_t i = 0; layers >> k & 1 && i < n; i++)
            rgb[i] += d->layer[k][i];
}

/* Returns a nearly Gaussian random number of mean 0 and variance 1, a sum of
 * twelve uniform numbers, the same on every machine. */
static double draw_normal_random_number(uint64_t *state)
{
    int64_t sum = 0;

    for (int i = 0; i < 3; i++) {
        const uint64_t bits = synth_draw_random_bits(state);

        for (int k = 0; k < 64; k += 16)
            sum += (int64_t)(bits >> k & 0xffff);
    }
    return ((double)sum - 12 * 32767.5) * 0x1p-16;
}

void synth_add_noise(const struct synth_item *item, float *rgb)
{
    const size_t n = 3 * (size_t)item->width * (size_t)item->height;
    uint64_t state = synth_item_init_random_state(item, "noise");

    for (size_t i = 0; i < n; i++) {
        const double light = rgb[i];

        rgb[i] = (float)(light + draw_normal_random_number(&state) *
                                     sqrt(light / item->full_well +
                                          item->read_noise * item->read_noise));
    }
}
