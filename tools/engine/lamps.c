/* SPDX-License-Identifier: MIT */
#include "engine/lamps.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/area.h"
#include "options/lamp_keys.h"
#include "posix/error.h"
#include "posix/input.h"
#include "options/tool.h"

enum { FIELDS = 8 };

static const char *const names[FIELDS + 2] = {
    "frame", "x", "y", "power", "r", "g", "b", "size", "id", NULL};

static struct lamp_row row_of(const double *v)
{
    return (struct lamp_row){.frame = (int)v[0],
                             .x = v[1],
                             .y = v[2],
                             .power = v[3],
                             .rgb = {v[4], v[5], v[6]},
                             .size = v[7],
                             .shape = v[LAMP_SHAPE],
                             .turn = v[LAMP_TURN],
                             .level = v[LAMP_LEVEL],
                             .id = (uint32_t)v[LAMP_ID],
                             .next = -1};
}

static bool frame_ok(double frame)
{
    return frame == -1 || (frame >= 0 && frame < 1e9 && frame == floor(frame));
}

bool lamp_power_ok(double power, const double rgb[3])
{
    const double most = fmax(rgb[0], fmax(rgb[1], rgb[2]));

    return power >= 0 && power <= LAMP_MAX_POWER && most <= LAMP_MAX_POWER &&
           power * most <= LAMP_MAX_POWER;
}

/* NULL, or what is wrong with the values of a row. */
static const char *check_row(const double *v)
{
    if (!frame_ok(v[0]))
        return "frame must be a whole number from 0, or *";
    if (fabs(v[1]) > 1e6 || fabs(v[2]) > 1e6)
        return "x and y must be within a million pixels";
    for (int c = 4; c < 7; c++)
        if (v[c] < 0)
            return "r, g and b must not be negative";
    if (!lamp_power_ok(v[3], v + 4))
        return "power, also times r, g or b, must be 0 to 1e30";
    if (!(v[LAMP_LEVEL] > 0 && v[LAMP_LEVEL] <= 1))
        return "level must be above 0 and up to 1";
    if (!(v[LAMP_SHAPE] >= 0 && v[LAMP_SHAPE] <= 1))
        return "shape must be 0 to 1";
    return v[7] >= 0 && v[7] <= 1e6 ? NULL
                                    : "size must be 0 to a million pixels";
}

/* "frame,x,y,power[,r,g,b[,size]]" */
static const char *parse_csv(char *line, const struct lamp_columns *columns,
                             double *v)
{
    char *comma = strchr(line, ',');
    int n;

    if (columns->n > 0) {
        const char *cause = lamp_columns_row(columns, line, v);

        return cause ? cause : check_row(v);
    }
    if (!comma)
        return "expected frame,x,y,power[,r,g,b[,size]]";
    *comma = '\0';
    if (strcmp(line, "*") == 0 || *line == '\0')
        v[0] = -1;
    else if (!tool_number(line, &v[0]))
        return "the frame is not a number";
    n = tool_numbers(comma + 1, v + 1, FIELDS - 1);
    return n == 3 || n == 6 || n == 7
               ? check_row(v)
               : "expected 4, 7 or 8 numbers separated by commas";
}

static char *skip(char *at)
{
    while (isspace((unsigned char)*at))
        at++;
    return at;
}

/* One "key": number; *AT moves behind it. */
static const char *parse_member(char **at, double *v, unsigned *given)
{
    char *key = skip(*at), *end, *number;
    int field;

    if (*key++ != '"' || !(end = strchr(key, '"')))
        return "expected a \"key\"";
    *end = '\0';
    field = tool_word(key, names);
    if (field < 0)
        return "a key is none of frame x y power r g b size id";
    number = skip(end + 1);
    if (*number++ != ':')
        return "expected : after a key";
    number = skip(number);
    if (field == LAMP_ID && *number == '"' && (end = strchr(number + 1, '"'))) {
        *end = '\0';
        v[LAMP_ID] = lamp_id_of(number + 1);
        *at = end + 1;
    } else if (field == 0 && strncmp(number, "\"*\"", 3) == 0) {
        v[0] = -1;
        *at = number + 3;
    } else {
        v[field] = strtod(number, at);
        if (*at == number || !isfinite(v[field]))
            return "a value is not a number";
        if (field == LAMP_ID && (v[field] < 0 || v[field] > UINT32_MAX))
            return "id must be a text, or 0 to 4294967295";
    }
    *given |= 1u << field;
    return NULL;
}

/* A flat object of numbers. */
static const char *parse_json(char *line, double *v)
{
    unsigned given = 0;
    char *at = line + 1; /* behind the brace */

    for (;;) {
        const char *cause = parse_member(&at, v, &given);

        if (cause)
            return cause;
        at = skip(at);
        if (*at == '}')
            break;
        if (*at++ != ',')
            return "expected , or }";
    }
    if (*skip(at + 1))
        return "something follows the object";
    return (given & 0xe) == 0xe ? check_row(v) : "x, y and power are needed";
}

static bool is_heading(const char *line)
{
    return strncmp(line, "frame", 5) == 0;
}

enum glint_status lamp_list_add(struct lamp_list *list,
                                const struct lamp_row *row)
{
    if (list->n == list->room) {
        const int room = list->room ? 2 * list->room : 64;
        struct lamp_row *more = realloc(list->row, (size_t)room * sizeof *more);

        if (!more)
            return GLINT_E_MEMORY;
        list->row = more;
        list->room = room;
    }
    list->row[list->n++] = *row;
    return GLINT_OK;
}

static enum glint_status parse_text(struct lamp_list *list, char *text,
                                    const char *path, struct glint_error *error)
{
    struct lamp_columns columns = {.n = 0};
    int number = 1;

    for (char *next; text; text = next, number++) {
        double v[LAMP_COLUMNS] = {-1, 0, 0, 1, 1, 1, 1, 0, 0, 1, 0, 1};
        const char *cause = NULL;
        struct lamp_row row;
        char *line;

        next = strchr(text, '\n');
        if (next)
            *next++ = '\0';
        line = skip(text);
        for (size_t n = strlen(line); n && isspace((unsigned char)line[n - 1]);)
            line[--n] = '\0';
        if (!*line || *line == '#')
            continue;
        if (number == 1 && is_heading(line)) {
            cause = lamp_columns_read(&columns, line);
            if (!cause)
                continue;
        } else
            cause = *line == '{' ? parse_json(line, v)
                                 : parse_csv(line, &columns, v);
        if (cause)
            return glint_error_report(error, GLINT_E_FORMAT, path, "%d: %s",
                                      number, cause);
        if (list->n == LAMP_LIST_MAX_ROWS)
            return glint_error_report(error, GLINT_E_FORMAT, path,
                                      "%d: more than %d lights", number,
                                      LAMP_LIST_MAX_ROWS);
        row = row_of(v);
        if (lamp_list_add(list, &row) != GLINT_OK)
            return glint_error_report(error, GLINT_E_MEMORY, path,
                                      "%d: no memory", number);
    }
    return GLINT_OK;
}

enum glint_status lamp_list_parse(struct lamp_list *list, const char *text,
                                  size_t bytes, const char *name,
                                  struct glint_error *error)
{
    enum glint_status status;
    char *copy;

    *list = (struct lamp_list){NULL, 0, 0};
    if (bytes && memchr(text, '\0', bytes))
        return glint_error_report(error, GLINT_E_FORMAT, name,
                                  "not a text file");
    copy = calloc(bytes + 1, 1);
    if (!copy)
        return glint_error_report(error, GLINT_E_MEMORY, name, "no memory");
    if (bytes)
        memcpy(copy, text, bytes);
    status = parse_text(list, copy, name, error);
    free(copy);
    if (status != GLINT_OK)
        lamp_list_free(list);
    return status;
}

enum glint_status lamp_list_read(struct lamp_list *list, const char *path,
                                 struct glint_error *error)
{
    uint8_t *data = NULL;
    size_t bytes = 0;
    enum glint_status status =
        glint_input_slurp(&data, &bytes, path, 1 << 28, error);

    *list = (struct lamp_list){NULL, 0, 0};
    if (status != GLINT_OK)
        return status;
    status = lamp_list_parse(list, (const char *)data, bytes, path, error);
    free(data);
    return status;
}

void lamp_list_free(struct lamp_list *list)
{
    free(list->row);
    *list = (struct lamp_list){NULL, 0, 0};
}

/* On the axis. */
static double tangent_of_pixel(const struct glint_view *view, double focal_mm)
{
    return view->sensor_width_mm / view->width / fabs(focal_mm);
}

/* Round unless its SHAPE is not 1. */
static void set_shape(struct glint_lamp *lamp, const struct lamp_row *r,
                      double tangent)
{
    const double major = r->size * tangent / sqrt(1 + r->shape * r->shape);

    area_set_round(lamp, r->size * tangent);
    if (r->shape == 1)
        return;
    lamp->axis[0] = major;
    lamp->axis[1] = r->shape * major;
    lamp->turn_deg = r->turn;
}

int lamp_list_frame(const struct lamp_list *list, int frame,
                    const struct glint_view *view, double focal_mm,
                    struct glint_lamp *lamps, double *level, int max)
{
    int n = 0;

    for (int i = 0; i < list->n && n < max; i++) {
        struct lamp_row r;

        if (!lamp_keys_at(list, i, frame, &r))
            continue;
        glint_view_to_angles(view, focal_mm, r.x, r.y, &lamps[n]);
        lamps[n].power = r.power;
        memcpy(lamps[n].rgb, r.rgb, sizeof r.rgb);
        set_shape(&lamps[n], &r, tangent_of_pixel(view, focal_mm));
        if (level)
            level[n] = r.level;
        n++;
    }
    return n;
}

/* ------------------------------------------------------------------- finder */

/* Some more tracks than are shown, so that those that come up are known. */
static int tracks_for(int max)
{
    const int wanted = max < 64 ? 128 : 2 * max;

    return wanted < LAMP_FINDER_MAX ? wanted : LAMP_FINDER_MAX;
}

/* BYTES rounded up to what init wants its memory aligned to. */
static size_t padded(size_t bytes)
{
    return (bytes + 63) & ~(size_t)63;
}

/* Takes one block and places everything in it. */
static enum glint_status place(struct lamp_finder *f,
                               const struct glint_lamp_finder_config *lights,
                               const struct glint_lamp_tracker_config *tracks)
{
    const size_t lights_bytes = padded(glint_lamp_finder_bytes(lights));
    const size_t tracks_bytes = padded(glint_lamp_tracker_bytes(tracks));
    const size_t profile_bytes = padded(glint_profile_bytes());
    const size_t spot_bytes = padded(LAMP_FINDER_MAX * sizeof *f->spot);
    enum glint_status status;
    uint8_t *at;

    if (lights_bytes == 0 || tracks_bytes == 0)
        return GLINT_E_ARGUMENT;
    if (posix_memalign(&f->mem, 64,
                       lights_bytes + tracks_bytes + profile_bytes +
                           spot_bytes +
                           (size_t)f->max_tracks * sizeof *f->track) != 0)
        return GLINT_E_MEMORY;
    at = f->mem;
    status = glint_lamp_finder_init(&f->lights, lights, at, lights_bytes);
    if (status == GLINT_OK)
        status = glint_lamp_tracker_init(&f->tracks, tracks, at + lights_bytes,
                                         tracks_bytes);
    at += lights_bytes + tracks_bytes;
    if (status == GLINT_OK)
        status = glint_profile_init(&f->profile, at, profile_bytes);
    at += profile_bytes;
    f->spot = (struct glint_spot *)(void *)at;
    f->track = (struct glint_lamp_track *)(void *)(at + spot_bytes);
    return status;
}

enum glint_status lamp_finder_open(struct lamp_finder *finder,
                                   const struct glint_lamp_finder_config *cfg)
{
    struct glint_lamp_finder_config lights = *cfg;
    struct glint_lamp_tracker_config tracks;
    enum glint_status status;

    finder->mem = NULL;
    finder->n_tracks = 0;
    finder->max_tracks = tracks_for(finder->max);
    lights.keep_faint = 1;
    glint_lamp_tracker_defaults(&tracks, cfg->width, cfg->height);
    tracks.max_tracks = finder->max_tracks;
    tracks.max_shown = finder->max;
    status = place(finder, &lights, &tracks);
    if (status != GLINT_OK)
        lamp_finder_close(finder);
    return status;
}

void lamp_finder_close(struct lamp_finder *finder)
{
    free(finder->mem);
    finder->mem = NULL;
}

void lamp_finder_restart(struct lamp_finder *finder)
{
    glint_lamp_tracker_restart(finder->tracks);
}

static struct glint_lamp_track still(const struct glint_spot *spot, uint32_t id)
{
    return (struct glint_lamp_track){
        .id = id,
        .state = GLINT_LAMP_STEADY,
        .x_q8 = spot->x_q8,
        .y_q8 = spot->y_q8,
        .size_q8 = spot->size_q8,
        .level_q15 = 1 << 15,
        .flux_q16 = spot->flux_q16,
        .power_q16 = spot->power_q16,
        .axis_q8 = {spot->axis_q8[0], spot->axis_q8[1]},
        .cos_q15 = spot->cos_q15,
        .sin_q15 = spot->sin_q15,
        .rgb_q15 = {spot->rgb_q15[0], spot->rgb_q15[1], spot->rgb_q15[2]}};
}

/* Clipped pixels count 2^headroom: in units of 2^8 below that, for tracks hold
 * no more than 2^42. */
static void set_power(struct lamp_finder *f, struct glint_spot *spot)
{
    const double each = 65536 * (exp2(f->headroom_ev) - 1);

    f->scale = exp2(fmax(f->headroom_ev - 8, 0));
    spot->power_q16 = (int64_t)fmin(
        ((double)spot->flux_q16 + spot->n_clipped * each) / f->scale, 0x1p42);
}

/* Finds spots, and what is behind as many of the strongest as are followed: in
 * a city by night a thousand would cost several times what finding them does.
 */
static int find(struct lamp_finder *f, const struct glint_image *image, int max)
{
    const int n = glint_lamp_finder_find(f->lights, image, f->spot, max);

    glint_profile_measure(f->profile, image, f->spot,
                          n < f->max_tracks ? n : f->max_tracks);
    f->scale = 1;
    for (int i = 0; i < n && f->headroom_ev >= 0; i++)
        set_power(f, &f->spot[i]);
    return n;
}

/* The lights of IMAGE by itself. */
static int find_still(struct lamp_finder *f, const struct glint_image *image)
{
    const int n = find(f, image, f->max);
    int n_lights = 0;

    for (; n_lights < n && !f->spot[n_lights].faint; n_lights++)
        f->track[n_lights] = still(&f->spot[n_lights], (uint32_t)n_lights + 1);
    return n_lights;
}

static double power_of(const struct lamp_finder *f,
                       const struct glint_lamp_track *track)
{
    return track->level_q15 / 32768.0 * (double)track->power_q16 / 65536 *
           f->scale;
}

static void set_extent(struct glint_lamp *lamp,
                       const struct glint_lamp_track *track, double tangent)
{
    for (int k = 0; k < 2; k++)
        lamp->axis[k] = track->axis_q8[k] / 256.0 * tangent;
    lamp->turn_deg =
        atan2(-track->sin_q15, track->cos_q15) * 180 / 3.14159265358979323846;
}

int lamp_finder_frame(struct lamp_finder *finder,
                      const struct glint_image *image, int32_t elapsed_us,
                      const struct glint_view *view, double focal_mm,
                      struct glint_lamp *lamps)
{
    struct lamp_finder *f = finder;

    if (elapsed_us > 0) {
        const int n = find(f, image, LAMP_FINDER_MAX);

        f->n_tracks = glint_lamp_tracker_step(f->tracks, f->spot, n, elapsed_us,
                                              f->track, f->max_tracks);
    } else {
        f->n_tracks = find_still(f, image);
    }
    for (int i = 0; i < f->n_tracks; i++) {
        const struct glint_lamp_track *track = &f->track[i];

        glint_view_to_angles(view, focal_mm, track->x_q8 / 256.0,
                             track->y_q8 / 256.0, &lamps[i]);
        set_extent(&lamps[i], track, tangent_of_pixel(view, focal_mm));
        lamps[i].power = power_of(f, track);
        for (int c = 0; c < 3; c++)
            lamps[i].rgb[c] = track->rgb_q15[c] / 32768.0;
    }
    return f->n_tracks;
}
