/* SPDX-License-Identifier: MIT
 *
 * Reads a recorded motion in JSON, with English or Hungarian member names. As
 * recordings may be long, the text is split into pieces, such as single frames.
 * jansson parses each piece after trailing commas are removed.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "glint/scene/motion_bake.h"

enum { CHUNK = 1 << 16, MOST_BYTES = 1 << 20, MOST_DEEP = 64, NAME_BYTES = 32 };

/* members of the recording that are read; other members are skipped */
enum { STRUCTURE, SZERKEZET, FRAMES, KEYS };

static const char *const keys[KEYS] = {"structure", "szerkezet", "frames"};

struct recording {
    const char *file_name;
    struct glint_motion_baker *baker;
    glint_recording_read_fn *read;
    void *ctx;
    struct glint_error *error;
    enum glint_status status;
    char chunk[CHUNK];
    size_t at, n;
    int c; /* the next byte of the text; -1: end of the text */
    int line, column;
    /* index in keys of the member whose value is being read */
    int key;
    /* line and column, from 1, of the first byte of the current piece */
    int piece_line, piece_column;
    /* index of the current frame; -1: not within a frame */
    long number;
    /* true: consumed characters are appended to text */
    bool is_kept;
    char *text; /* the text of the current piece; owned */
    size_t bytes, capacity;
};

/* ------------------------------------------------------------------- bytes */

static bool set_error_at_byte(struct recording *r, const char *format, ...)
{
    char cause[128];
    va_list args;

    if (r->status != GLINT_OK)
        return false;
    va_start(args, format);
    vsnprintf(cause, sizeof cause, format, args);
    va_end(args);
    snprintf(r->error->text, sizeof r->error->text, "%.80s:%d:%d: %s",
             r->file_name, r->line, r->column, cause);
    r->status = GLINT_E_LENS;
    return false;
}

/* Loads the next byte into r->c without consuming it. */
static void load_next_byte(struct recording *r)
{
    if (r->at == r->n && r->status == GLINT_OK) {
        const long n = r->read(r->ctx, r->chunk, sizeof r->chunk);

        r->at = 0;
        r->n = n > 0 ? (size_t)n : 0;
        if (n < 0) {
            snprintf(r->error->text, sizeof r->error->text,
                     "%.120s: cannot be read", r->file_name);
            r->status = GLINT_E_IO;
        }
    }
    r->c = r->at < r->n ? (unsigned char)r->chunk[r->at] : -1;
}

static bool set_error_at_end(struct recording *r)
{
    if (r->number >= 0)
        return set_error_at_byte(r, "the file ends within frame %ld",
                                 r->number);
    return set_error_at_byte(r, "the file ends within the recording");
}

static bool append_char_to_piece(struct recording *r, char c)
{
    if (r->bytes == MOST_BYTES)
        return set_error_at_byte(
            r, "a frame or the structure is longer than 1 MiB");
    if (r->bytes == r->capacity) {
        const size_t capacity = r->capacity ? 2 * r->capacity : 4096;
        char *const text = realloc(r->text, capacity);

        if (!text) {
            r->status = GLINT_E_MEMORY;
            return false;
        }
        r->text = text;
        r->capacity = capacity;
    }
    r->text[r->bytes++] = c;
    return true;
}

/* Consumes the byte r->c and appends it to the current piece, if any. */
static bool consume_next_byte(struct recording *r)
{
    if (r->c < 0)
        return set_error_at_end(r);
    if (r->is_kept && !append_char_to_piece(r, (char)r->c))
        return false;
    if (r->c == '\n') {
        r->line++;
        r->column = 1;
    } else {
        r->column++;
    }
    r->at++;
    load_next_byte(r);
    return r->status == GLINT_OK;
}

static bool consume_blanks(struct recording *r)
{
    while (r->c == ' ' || r->c == '\t' || r->c == '\n' || r->c == '\r')
        if (!consume_next_byte(r))
            return false;
    return r->status == GLINT_OK;
}

static bool consume_expected_char(struct recording *r, char c)
{
    if (r->c < 0)
        return set_error_at_end(r);
    if (r->c != c)
        return set_error_at_byte(r, "expected '%c' here", c);
    return consume_next_byte(r);
}

/* ------------------------------------------------------------------ values */

/* Consumes a string. Copies its first bytes to NAME[NAME_BYTES] unless NAME is
 * NULL. */
static bool consume_json_string(struct recording *r, char *name)
{
    size_t n = 0;

    if (!consume_expected_char(r, '"'))
        return false;
    while (r->c != '"') {
        if (r->c >= 0 && r->c < ' ')
            return set_error_at_byte(
                r, "a string must end on its line, with '\"'");
        if (name && n + 1 < NAME_BYTES && r->c >= 0)
            name[n++] = (char)r->c;
        if ((r->c == '\\' && !consume_next_byte(r)) || !consume_next_byte(r))
            return false;
    }
    if (name)
        name[n] = '\0';
    return consume_next_byte(r);
}

/* Replaces a trailing comma at the end of the current piece by a space. */
static void remove_trailing_comma(struct recording *r)
{
    size_t i = r->bytes;

    while (r->is_kept && i > 0 && (unsigned char)r->text[i - 1] <= ' ')
        i--;
    if (r->is_kept && i > 0 && r->text[i - 1] == ',')
        r->text[i - 1] = ' ';
}

/* Consumes a value of any type. Checks only that brackets match; jansson checks
 * the rest. */
static bool consume_json_value(struct recording *r)
{
    char close[MOST_DEEP];
    int deep = 0;

    if (!consume_blanks(r))
        return false;
    if (r->c == ',' || r->c == '}' || r->c == ']')
        return set_error_at_byte(r, "expected a JSON value here");
    do {
        if (r->c == '"') {
            if (!consume_json_string(r, NULL))
                return false;
            continue;
        }
        if (r->c == '{' || r->c == '[') {
            if (deep == MOST_DEEP)
                return set_error_at_byte(
                    r, "brackets are nested more than %d levels deep",
                    MOST_DEEP);
            close[deep++] = r->c == '{' ? '}' : ']';
        } else if (r->c == '}' || r->c == ']') {
            if (deep == 0)
                /* This bracket or comma is not part of the value: it follows a
                 * number or word. */
                return true;
            if (r->c != close[--deep])
                return set_error_at_byte(r,
                                         "'%c' does not match the opening '%c'",
                                         r->c, close[deep] == '}' ? '{' : '[');
            remove_trailing_comma(r);
        } else if (deep == 0 && (r->c == ',' || r->c <= ' ')) {
            return r->c >= 0 || set_error_at_end(r);
        }
        if (!consume_next_byte(r))
            return false;
    } while (deep > 0 || (r->c != ',' && r->c > ' ' && r->c != ':'));
    return true;
}

/* Sets an error at LINE and COLUMN of the current piece, both counted from 1.
 * Adds the frame's index to the text if the piece is a frame. Returns false. */
static bool set_error_in_piece(const struct recording *r, int line, int column,
                               const char *format, ...)
{
    char cause[112], frame[32] = "";
    va_list args;

    va_start(args, format);
    vsnprintf(cause, sizeof cause, format, args);
    va_end(args);
    if (r->key == FRAMES)
        snprintf(frame, sizeof frame, "frame %ld: ", r->number);
    snprintf(r->error->text, sizeof r->error->text, "%.80s:%d:%d: %s%s",
             r->file_name, r->piece_line + line - 1,
             line > 1 ? column : r->piece_column + column - 1, frame, cause);
    /* jansson quotes the file in its error texts: replaces control
     * characters */
    for (char *c = r->error->text; *c; c++)
        *c = (unsigned char)*c < ' ' ? '?' : *c;
    return false;
}

/* ----------------------------------------------------------------- numbers */

/* Returns the member NAME of OBJECT, or else its member OTHER (the Hungarian
 * name); NULL if it has neither. */
static json_t *get_json_member(const json_t *object, const char *name,
                               const char *other)
{
    json_t *const value = json_object_get(object, name);

    return value || !other ? value : json_object_get(object, other);
}

/* Sets X to the number in the member NAME or OTHER of OBJECT. WHAT names the
 * object in error texts. */
static bool read_number_member(const struct recording *r, const json_t *object,
                               const char *name, const char *other,
                               const char *what, double *x)
{
    const json_t *value = get_json_member(object, name, other);

    if (!value)
        return set_error_in_piece(r, 1, 1, "%s has no '%s'", what, name);
    *x = json_number_value(value);
    return json_is_number(value) ||
           set_error_in_piece(r, 1, 1, "'%s' of %s is not a number", name,
                              what);
}

/* Sets V to the three numbers in the member NAME of OBJECT, or to 0 if it has
 * no such member. */
static bool read_vector_member(const struct recording *r, const json_t *object,
                               const char *name, double v[3])
{
    const json_t *value = json_object_get(object, name);

    for (size_t k = 0; k < 3; k++) {
        v[k] = json_number_value(json_array_get(value, k));
        if (value && !json_is_number(json_array_get(value, k)))
            return set_error_in_piece(
                r, 1, 1, "'%s' needs three numbers [x, y, z]", name);
    }
    return true;
}

/* -------------------------------------------------------------------- body */

static bool read_structure_object(const struct recording *r,
                                  const json_t *object)
{
    struct glint_motion_body body = {.n_sensors = 0};
    const json_t *sensors = get_json_member(object, "sensors", "erzosejtek");
    struct glint_error cause;

    if (!json_is_object(object))
        return set_error_in_piece(r, 1, 1,
                                  "the structure is not a JSON object");
    if (!read_number_member(r, object, "size", "meret", "the structure",
                            &body.size) ||
        !read_number_member(r, object, "angleofview", "latoszog",
                            "the structure", &body.angle_deg))
        return false;
    if (sensors && !json_is_array(sensors))
        return set_error_in_piece(r, 1, 1, "'sensors' is not an array");
    if (json_array_size(sensors) > GLINT_MOTION_MAX_SENSORS)
        return set_error_in_piece(r, 1, 1, "more than %d sensors",
                                  GLINT_MOTION_MAX_SENSORS);
    for (size_t i = 0; i < json_array_size(sensors); i++) {
        const json_t *sensor = json_array_get(sensors, i);

        if (!read_number_member(r, sensor, "theta", NULL, "a sensor",
                                &body.theta[i]) ||
            !read_number_member(r, sensor, "phi", NULL, "a sensor",
                                &body.phi[i]))
            return false;
        body.n_sensors++;
    }
    return glint_motion_baker_body(r->baker, &body, &cause) == GLINT_OK ||
           set_error_in_piece(r, 1, 1, "%s", cause.text);
}

/* ------------------------------------------------------------------ frames */

/* Sets the intensities of food I: none, one number, or one number per
 * sensor. */
static bool read_food_intensities(const struct recording *r, const json_t *food,
                                  int i, struct glint_motion_sight *s)
{
    const json_t *value = get_json_member(food, "i", "i1");
    const size_t n = json_is_array(value) ? json_array_size(value)
                     : value              ? 1
                                          : 0;

    if (n > GLINT_MOTION_MAX_SENSORS)
        return set_error_in_piece(r, 1, 1, "more than %d intensities",
                                  GLINT_MOTION_MAX_SENSORS);
    if (i > 0 && (int)n != s->n_intensities)
        return set_error_in_piece(
            r, 1, 1,
            "food items have different numbers of intensities: %d and %d",
            s->n_intensities, (int)n);
    s->n_intensities = (int)n;
    for (size_t k = 0; k < n; k++) {
        const json_t *one =
            json_is_array(value) ? json_array_get(value, k) : value;

        if (!json_is_number(one) && !json_is_boolean(one))
            return set_error_in_piece(r, 1, 1, "an intensity is not a number");
        s->intensity[i][k] =
            json_is_number(one) ? json_number_value(one) : json_is_true(one);
    }
    return true;
}

static bool read_food_object(const struct recording *r, const json_t *food,
                             int i, struct glint_motion_sight *s)
{
    static const char *const axis[3] = {"x", "y", "z"};
    const json_t *reset = json_object_get(food, "reset");
    char what[24];

    snprintf(what, sizeof what, "food %d", i);
    if (!json_is_object(food))
        return set_error_in_piece(r, 1, 1, "%s is not an object", what);
    for (int k = 0; k < 3; k++)
        if (!read_number_member(r, food, axis[k], NULL, what, &s->food[i][k]))
            return false;
    s->is_new[i] = json_is_true(reset) || json_number_value(reset) != 0;
    return read_food_intensities(r, food, i, s);
}

static bool read_frame_object(const struct recording *r, const json_t *object,
                              struct glint_motion_sight *s)
{
    const json_t *foods = get_json_member(object, "foods", "kajak");
    const json_t *of = json_object_get(object, "frame_num");

    *s = (struct glint_motion_sight){.number = -1};
    if (!json_is_object(object))
        return set_error_in_piece(r, 1, 1, "the frame is not a JSON object");
    if (of && (!json_is_integer(of) || json_integer_value(of) < 0))
        return set_error_in_piece(r, 1, 1,
                                  "'frame_num' is not a whole number from 0");
    if (of)
        s->number = json_integer_value(of);
    if (!json_is_array(foods))
        return set_error_in_piece(r, 1, 1, "the frame has no array 'foods'");
    if (json_array_size(foods) > GLINT_MOTION_MAX_FOODS)
        return set_error_in_piece(r, 1, 1, "more than %d foods",
                                  GLINT_MOTION_MAX_FOODS);
    for (size_t i = 0; i < json_array_size(foods); i++)
        if (!read_food_object(r, json_array_get(foods, i), (int)i, s))
            return false;
    s->n_foods = (int)json_array_size(foods);
    return read_vector_member(r, object, "rv", s->rv) &&
           read_vector_member(r, object, "tv", s->tv);
}

static enum glint_status bake_frame_object(const struct recording *r,
                                           const json_t *object)
{
    struct glint_motion_sight sight;
    struct glint_error cause = {""};
    enum glint_status status;

    if (!read_frame_object(r, object, &sight))
        return GLINT_E_LENS;
    status = glint_motion_baker_frame(r->baker, &sight, &cause);
    if (status == GLINT_E_LENS)
        set_error_in_piece(r, 1, 1, "%s", cause.text);
    return status;
}

/* -------------------------------------------------------------------- keys */

/* Reads the value of member KEY, or one frame, with jansson. A value has at
 * most 1 MiB. */
static bool read_member_value(struct recording *r, int key)
{
    json_error_t wrong;
    json_t *value;

    if (!consume_blanks(r))
        return false;
    r->key = key;
    r->piece_line = r->line;
    r->piece_column = r->column;
    r->is_kept = true;
    r->bytes = 0;
    if (!consume_json_value(r))
        return false;
    r->is_kept = false;
    value = json_loadb(r->text, r->bytes, JSON_DECODE_ANY, &wrong);
    r->status = GLINT_E_LENS;
    if (!value)
        set_error_in_piece(r, wrong.line > 0 ? wrong.line : 1,
                           wrong.column > 0 ? wrong.column : 1, "%.100s",
                           wrong.text);
    else if (key == FRAMES)
        r->status = bake_frame_object(r, value);
    else if (read_structure_object(r, value))
        r->status = GLINT_OK;
    json_decref(value);
    return r->status == GLINT_OK;
}

/* Consumes blanks and a comma before the next item. Sets DONE to whether CLOSE,
 * which ends the list, follows; it is not consumed, and a comma before it is
 * allowed. */
static bool consume_list_separator(struct recording *r, char close, bool *done)
{
    if (!consume_blanks(r))
        return false;
    *done = r->c == close;
    if (*done)
        return true;
    if (r->c >= 0 && r->c != ',')
        return set_error_at_byte(r, "expected ',' or '%c' here", close);
    if (!consume_next_byte(r) || !consume_blanks(r))
        return false;
    *done = r->c == close;
    return true;
}

static bool read_all_frames(struct recording *r)
{
    bool done;

    if (!consume_expected_char(r, '[') || !consume_blanks(r))
        return false;
    done = r->c == ']';
    for (r->number = 0; !done; r->number++)
        if (!read_member_value(r, FRAMES) ||
            !consume_list_separator(r, ']', &done))
            return false;
    r->number = -1;
    return consume_next_byte(r);
}

static bool read_recording_member(struct recording *r, unsigned *seen)
{
    char name[NAME_BYTES];
    int key = 0;

    if (!consume_json_string(r, name) || !consume_blanks(r) ||
        !consume_expected_char(r, ':') || !consume_blanks(r))
        return false;
    while (key < KEYS && strcmp(keys[key], name) != 0)
        key++;
    if (key == KEYS)
        return consume_json_value(r);
    if (*seen >> key & 1)
        return set_error_at_byte(r, "a second '%s'", name);
    *seen |= 1u << key;
    return key == FRAMES ? read_all_frames(r) : read_member_value(r, key);
}

static bool read_recording(struct recording *r)
{
    unsigned seen = 0;
    bool done;

    if (!consume_blanks(r) || !consume_expected_char(r, '{') ||
        !consume_blanks(r))
        return false;
    done = r->c == '}';
    while (!done)
        if (!read_recording_member(r, &seen) ||
            !consume_list_separator(r, '}', &done))
            return false;
    r->at++;
    r->column++;
    load_next_byte(r);
    if (!consume_blanks(r))
        return false;
    return r->c < 0 || set_error_at_byte(
                           r, "unexpected text after the end of the recording");
}

enum glint_status glint_recording_read(struct glint_motion_baker *baker,
                                       const char *file_name,
                                       glint_recording_read_fn *read, void *ctx,
                                       struct glint_error *error)
{
    struct recording *r = calloc(1, sizeof *r);
    enum glint_status status;

    error->text[0] = '\0';
    if (!r)
        return GLINT_E_MEMORY;
    r->file_name = file_name;
    r->baker = baker;
    r->read = read;
    r->ctx = ctx;
    r->error = error;
    r->line = r->column = 1;
    r->number = -1;
    load_next_byte(r);
    read_recording(r);
    status = r->status;
    free(r->text);
    free(r);
    return status;
}
