/* SPDX-License-Identifier: MIT */
#include "overlay/look.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/lamp_keys.h"
#include "engine/frame/area.h"
#include "overlay/show_lights.h"
#include "model/response_cache.h"
#include "options/takes.h"

/* ------------------------------------------------------------------ options */

void look_defaults(struct look *look)
{
    *look = (struct look){.lens = "nikon-zoom-short",
                          .headroom_ev = -1,
                          .threshold_ev = {-0.1, -0.15},
                          .white = 1};
    scene_defaults(&look->scene);
    look->scene.coating.kind = COATING_MIXED;
    look->scene.waves = SCENE_WAVES_AUTO;
    glint_strength_defaults(&look->strength);
}

/* Stops by which a region extends below what makes it a lamp, if not told. */
#define EXTENDS_EV 0.05

/* Of a lamp by hand, over a white pixel: a street lamp in a night picture. */
#define DEFAULT_EV 16

static bool take_threshold(const char *text, double threshold_ev[2])
{
    double v[2];
    const int n = tool_numbers(text, v, 2);

    if (n == 1)
        v[1] = fmax(v[0] - EXTENDS_EV, -20);
    if (n == 0 || !(v[0] <= 0) || !(v[1] >= -20 && v[1] <= v[0]))
        return false;
    memcpy(threshold_ev, v, sizeof v);
    return true;
}

static bool take_light(struct look *look, const char *text)
{
    struct glint_lamp *lamp = &look->hand[look->n_hand];

    if (look->n_hand == SCENE_MAX_LAMPS || !scene_lamp(text, lamp))
        return false;
    look->scene.max_deg = fmax(look->scene.max_deg, lamp->theta_deg);
    look->n_hand++;
    return true;
}

/* "X,Y[,EV]" */
static bool take_light_at(struct look *look, const char *text)
{
    double v[3] = {0, 0, DEFAULT_EV};
    const int n = tool_numbers(text, v, 3);
    const struct lamp_row row = {.frame = -1,
                                 .x = v[0],
                                 .y = v[1],
                                 .power = exp2(v[2]),
                                 .rgb = {1, 1, 1},
                                 .shape = 1,
                                 .level = 1,
                                 .next = -1};

    return n >= 2 && fabs(v[0]) <= 1e6 && fabs(v[1]) <= 1e6 && v[2] >= -40 &&
           v[2] <= 90 && look->at.n < SCENE_MAX_LAMPS &&
           lamp_list_add(&look->at, &row) == GLINT_OK;
}

static bool take(struct look *look, int option, const char *value)
{
    static const char *const layers[] = {"composite", "flare", "flare-alpha",
                                         NULL};
    static const char *const shows[] = {"lights", NULL};
    int layer;

    switch (option) {
    case OPT_LENS:
        look->lens = value;
        return true;
    case OPT_LIGHTS:
        look->lights_file = strcmp(value, "auto") == 0 ? NULL : value;
        return true;
    case OPT_LIGHT:
        return take_light(look, value);
    case OPT_THRESHOLD:
        return take_threshold(value, look->threshold_ev);
    case OPT_HEADROOM:
        return tool_number(value, &look->headroom_ev) &&
               look->headroom_ev >= 0 && look->headroom_ev <= 40;
    case OPT_NO_TRACKING:
        return look->no_tracking = true;
    case OPT_LIGHT_AT:
        return take_light_at(look, value);
    case OPT_SAVE_LIGHTS:
        look->save_file = value;
        return *value != '\0';
    case OPT_INTERPOLATE:
        return look->interpolate = true;
    case OPT_SHOW:
        return look->show_lights = tool_word(value, shows) == 0;
    case OPT_STRENGTH:
        look->scene.has_exposure = false;
        return tool_number(value, &look->strength.asked) &&
               look->strength.asked >= 0 && look->strength.asked <= 100;
    default:
        layer = tool_word(value, layers);
        look->flare_only = layer >= 1;
        look->flare_alpha = layer == 2;
        return layer >= 0;
    }
}

/* False: OPTION is the other dial for the same. */
static bool take_dial(struct look *look, int option)
{
    if (option != OPT_STRENGTH && option != OPT_EXPOSURE)
        return true;
    if (look->dial && look->dial != option)
        return false;
    look->dial = option;
    return true;
}

void look_options_end(struct look *look)
{
    look->dial = 0;
}

int look_option(const struct tool *tool, struct look *look, int option,
                const char *value)
{
    static const struct option names[] = {LOOK_OPTIONS};
    const int code = take_dial(look, option)
                         ? scene_option(tool, &look->scene, option, value)
                         : tool_usage(tool, "--strength chooses the exposure; "
                                            "give one of it and --exposure");

    if (code != -2 || option < OPT_LENS || option >= OPT_LOOK_LAST)
        return code;
    if (take(look, option, value))
        return -1;
    return tool_refuse(tool, names[option - OPT_LENS].name, value);
}

/* ------------------------------------------------------------------- making */

/* Rows of a file, those on their way, and those by pixel. */
static enum glint_status open_list(struct look *look, struct glint_error *error)
{
    enum glint_status status = GLINT_OK;

    if (look->lights_file)
        status = lamp_list_read(&look->list, look->lights_file, error);
    if (status == GLINT_OK && look->interpolate)
        status = lamp_keys_link(&look->list);
    for (int i = 0; i < look->at.n && status == GLINT_OK; i++)
        status = lamp_list_add(&look->list, &look->at.row[i]);
    look->is_listed = look->lights_file || look->at.n > 0;
    return status;
}

int look_open(const struct tool *tool, struct look *look)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    const int code = scene_open(tool, &look->scene, look->lens);
    size_t n;

    if (code != EXIT_OK)
        return code;
    status = open_list(look, &error);
    if (status == GLINT_OK && look->save_file)
        status = lamp_save_open(&look->save, look->save_file, &error);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    n = (size_t)look->n_hand + (size_t)look->list.n + GLINT_LAMP_DETECTOR_MAX;
    look->lamp = malloc(n * sizeof *look->lamp);
    look->level = malloc(n * sizeof *look->level);
    look->id = malloc(n * sizeof *look->id);
    return look->lamp && look->level && look->id
               ? EXIT_OK
               : tool_fail(tool, GLINT_E_MEMORY, NULL);
}

/* Lamps to look for: a picture has many that hardly show. */
static int finder_max(const struct look *look)
{
    const int asked = look->scene.max_lights ? look->scene.max_lights : 16;

    return asked < GLINT_LAMP_DETECTOR_MAX ? asked : GLINT_LAMP_DETECTOR_MAX;
}

static void unsize(struct look *look)
{
    if (look->sized) {
        glint_lamp_detector_close(&look->finder);
        glint_frame_finish(&look->frame);
    }
    look->sized = false;
}

static enum glint_status open_finder(struct look *look, int width, int height)
{
    struct glint_lamp_finder_config cfg;

    glint_lamp_finder_defaults(&cfg, width, height);
    cfg.threshold_high_q8 = (int32_t)floor(256 * look->threshold_ev[0] + 0.5);
    cfg.threshold_low_q8 = (int32_t)floor(256 * look->threshold_ev[1] + 0.5);
    look->finder.headroom_ev = look->headroom_ev;
    look->finder.max = finder_max(look);
    return glint_lamp_detector_open(&look->finder, &cfg);
}

/* While lamps change places, those that fade are drawn with those that rise. */
static enum glint_status reserve(struct look *look)
{
    const int n_by_hand = look->n_hand + look->list.n;

    return glint_frame_reserve(&look->frame, NULL, look->reserve_bytes,
                               n_by_hand + GLINT_LAMP_DETECTOR_MAX,
                               n_by_hand + 2 * look->finder.max);
}

int look_size(const struct tool *tool, struct look *look, int width, int height)
{
    enum glint_status status;
    int code;

    unsize(look);
    look->view = scene_view(&look->scene, width, height);
    look->strength.follows = false;
    code = scene_frame(tool, &look->scene, look->view, &look->frame);
    if (code != EXIT_OK)
        return code;
    look->sized = true;
    status = response_cached(tool, look->scene.lens.name, &look->frame,
                             look->reserve_bytes, &look->response);
    if (status == GLINT_OK)
        status = open_finder(look, width, height);
    if (tool->verbose && !tool->quiet && !look->is_listed && look->n_hand == 0)
        fprintf(stderr, "%s: lamps from %g stops of white, down to %g\n",
                tool->name, look->threshold_ev[0], look->threshold_ev[1]);
    if (status == GLINT_OK && look->reserve_bytes)
        status = reserve(look);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, NULL);
}

void look_replace(struct look *look, const struct look *fresh)
{
    const struct lamp_save save = look->save;
    const int n_frames = look->n_frames;

    look->save.is_open = false; /* goes on */
    look_close(look);
    *look = *fresh;
    if (save.is_open) {
        lamp_save_abort(&look->save);
        look->save = save;
        look->n_frames = n_frames;
    }
    /* what is made by size points here, and is made anew */
    if (look->scene.setup.lens)
        look->scene.setup.lens = &look->scene.lens;
}

int look_finish(const struct tool *tool, struct look *look)
{
    struct glint_error error = {""};
    const enum glint_status status = lamp_save_finish(&look->save, &error);

    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

void look_close(struct look *look)
{
    unsize(look);
    lamp_save_abort(&look->save);
    lamp_list_free(&look->list);
    lamp_list_free(&look->at);
    free(look->lamp);
    look->lamp = NULL;
    free(look->level);
    look->level = NULL;
    free(look->id);
    look->id = NULL;
    scene_close(&look->scene);
}

/* ------------------------------------------------------------------ drawing */

/* Where lamp I is: as it was found, for what is written is read again. */
static struct lamp_row row_of(const struct look *look, int i)
{
    const bool found = !look->is_listed && look->n_hand == 0;
    const struct glint_lamp *lamp = &look->lamp[i];
    const double *axis = lamp->axis;
    const double focal = look->scene.setup.optics.focal_mm;
    const double pixels = look->view.width * fabs(focal) /
                          look->view.sensor_width_mm; /* per tangent */
    struct lamp_row row = {.frame = look->n_frames,
                           .power = lamp->power,
                           .size = pixels * hypot(axis[0], axis[1]),
                           .shape = axis[0] > 0 ? axis[1] / axis[0] : 1,
                           .turn = lamp->turn_deg,
                           .level = look->level[i],
                           .id = look->id[i],
                           .next = -1};

    memcpy(row.rgb, lamp->rgb, sizeof row.rgb);
    if (found) {
        const struct glint_lamp_track *track = &look->finder.track[i];

        row.x = track->x_q8 / 256.0;
        row.y = track->y_q8 / 256.0;
    } else
        glint_view_to_pixel(&look->view, look->scene.setup.optics.focal_mm,
                            lamp, &row.x, &row.y);
    return row;
}

static void save_lamps(struct look *look)
{
    for (int i = 0; look->save.is_open && i < look->n_lamps; i++) {
        const struct lamp_row row = row_of(look, i);

        lamp_save_row(&look->save, &row);
    }
}

static int set_lamps(struct look *look, const struct glint_image *image,
                     int32_t elapsed_us)
{
    const double focal = look->scene.setup.optics.focal_mm;
    int n = look->n_hand;

    memcpy(look->lamp, look->hand, (size_t)n * sizeof *look->lamp);
    for (int i = 0; i < n; i++) {
        look->level[i] = 1;
        look->id[i] = (look->is_listed ? LAMP_ID_TEXT : 1) + (uint32_t)i;
    }
    if (look->is_listed) {
        lamp_keys_ids(&look->list, look->n_frames, look->id + n);
        n += lamp_list_frame(&look->list, look->n_frames, &look->view, focal,
                             look->lamp + n, look->level + n, look->list.n);
    }
    look->is_followed = elapsed_us > 0 && !look->no_tracking;
    if (look->is_listed || n > 0)
        return n;
    n = glint_lamp_detector_frame(&look->finder, image,
                                  look->no_tracking ? 0 : elapsed_us,
                                  &look->view, focal, look->lamp);
    for (int i = 0; i < n; i++) {
        look->level[i] = look->finder.track[i].level_q15 / 32768.0;
        look->id[i] = look->finder.track[i].id;
    }
    return n;
}

int look_lamps(struct look *look, const struct glint_image *image,
               int32_t elapsed_us)
{
    look->n_lamps = set_lamps(look, image, elapsed_us);
    save_lamps(look);
    return look->n_lamps;
}

/* Whether codes are luma and chroma, or grey: then black may be 16. */
static bool is_luma(enum glint_pixel_format format)
{
    return format != GLINT_RGB24 && format != GLINT_BGR24 &&
           format != GLINT_XRGB8888 && format != GLINT_RGB565;
}

/* The codes of black that bytes of plane PLANE have in turn. */
static void black_of(const struct glint_image *image, int plane,
                     uint8_t code[2])
{
    const bool limited =
        is_luma(image->format) && image->range == GLINT_RANGE_LIMITED;

    code[0] = code[1] = plane > 0 ? 128 : limited ? 16 : 0;
    if (image->format == GLINT_YUYV)
        code[1] = 128;
    else if (image->format == GLINT_UYVY)
        code[0] = 128;
}

/* Black, in the codes of IMAGE. */
static void blacken(const struct glint_image *image)
{
    for (int p = 0; p < glint_image_planes(image->format); p++) {
        const int rows =
            glint_image_plane_height(image->format, p, image->height);
        const size_t bytes =
            glint_image_row_bytes(image->format, p, image->width);
        uint8_t code[2];

        black_of(image, p, code);
        for (int y = 0; y < rows; y++) {
            uint8_t *row = image->plane[p] + y * image->stride_bytes[p];

            for (size_t i = 0; i < bytes; i++)
                row[i] = code[i & 1];
        }
    }
}

/* Draws the lights over IMAGE: as found, else where they are, by number. */
void look_mark(const struct look *look, const struct glint_image *image)
{
    const bool found = !look->is_listed && look->n_hand == 0;

    for (int i = 0; i < look->n_lamps; i++) {
        const struct lamp_row row = row_of(look, i);
        const uint32_t id = row.id < LAMP_ID_TEXT ? row.id : (uint32_t)i + 1;
        struct glint_lamp_track track = {.id = id, .state = GLINT_LAMP_STEADY};

        if (!(fabs(row.x) < 1 << 20 && fabs(row.y) < 1 << 20))
            continue;
        if (found)
            track = look->finder.track[i];
        track.x_q8 = (int32_t)(row.x * 256);
        track.y_q8 = (int32_t)(row.y * 256);
        show_light_of(image, &track, row.power);
    }
    show_legend(image, found && look->is_followed);
}

double look_scale(const struct look *look)
{
    return look->strength.scale;
}

void look_expose(struct look *look, int32_t elapsed_us)
{
    const bool is_new =
        look->no_tracking ||
        (look->is_listed ? lamp_keys_is_cut(&look->list, look->n_frames)
                         : glint_lamp_tracker_was_cut(look->finder.tracks));
    const struct glint_strength_lamps lamps = {
        look->lamp, look->level, look->n_lamps,
        (double)look->view.width * look->view.height * look->white};

    save_lamps(look);
    look->strength.is_physical = look->scene.has_exposure;
    look->strength.exposure_ev = look->scene.exposure_ev;
    look->strength.gain = look->scene.gain;
    glint_strength_expose(&look->strength, &look->response, &lamps,
                          is_new ? 0 : elapsed_us);
}

void look_find(struct look *look, const struct glint_image *image,
               int32_t elapsed_us)
{
    const struct scene *scene = &look->scene;
    const double start = tool_seconds();

    look->n_lamps = set_lamps(look, image, elapsed_us);
    /* there is time for a picture by itself */
    if (elapsed_us == 0 && !scene->area_samples_asked && scene->budget_ms == 0)
        look->frame.dials.area_points =
            1 + GLINT_AREA_STILL * (scene->dials.area_points - 1);
    look->find_ms = 1e3 * (tool_seconds() - start);
}

enum glint_status look_draw(struct look *look, const struct glint_image *image,
                            int32_t elapsed_us)
{
    enum glint_status status;
    double found;

    look_find(look, image, elapsed_us);
    look_expose(look, elapsed_us);
    found = tool_seconds();
    if (look->flare_only)
        blacken(image);
    status = glint_frame_draw(&look->frame, look->lamp,
                              look_scale(look) > 0 ? look->n_lamps : 0,
                              look_scale(look), image, &look->report);
    look->report.lights = look->n_lamps;
    look->flare_ms = 1e3 * (tool_seconds() - found);
    if (look->show_lights)
        look_mark(look, image);
    look->n_frames++;
    return status;
}
