/* SPDX-License-Identifier: MIT
 *
 * A recording in JSON, in the words of two spellings, one frame at a time by
 * jansson. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <jansson.h>

#include "bake/motion/split.h"

/* What the pieces of a recording are handed to. */
struct recording {
    const char *file_name;
    struct glint_motion_baker *baker;
    const struct glint_split_piece *piece;
    struct glint_error *error;
};

enum { STRUCTURE, SZERKEZET, FRAMES };

static const struct glint_split_key keys[] = {{"structure", false},
                                              {"szerkezet", false},
                                              {"frames", true},
                                              {NULL, false}};

/* Writes that the piece, its frame if it is one, is wrong at a line and column
 * of its text; 1, 1: at its beginning. */
static bool fail_at(const struct recording *r, int line, int column,
                    const char *format, ...)
{
    char cause[112], frame[32] = "";
    va_list args;

    va_start(args, format);
    vsnprintf(cause, sizeof cause, format, args);
    va_end(args);
    if (r->piece->key == FRAMES)
        snprintf(frame, sizeof frame, "frame %ld: ", r->piece->number);
    snprintf(r->error->text, sizeof r->error->text, "%.80s:%d:%d: %s%s",
             r->file_name, r->piece->line + line - 1,
             line > 1 ? column : r->piece->column + column - 1, frame, cause);
    for (char *c = r->error->text; *c; c++) /* what jansson quotes of a file */
        *c = (unsigned char)*c < ' ' ? '?' : *c;
    return false;
}

/* ------------------------------------------------------------------- numbers
 */

/* Returns the member of OBJECT that has one of two names, or NULL. */
static json_t *either(const json_t *object, const char *name, const char *other)
{
    json_t *const value = json_object_get(object, name);

    return value || !other ? value : json_object_get(object, other);
}

/* Sets X to the number NAME of OBJECT, which WHAT has. */
static bool number(const struct recording *r, const json_t *object,
                   const char *name, const char *other, const char *what,
                   double *x)
{
    const json_t *value = either(object, name, other);

    if (!value)
        return fail_at(r, 1, 1, "%s has no '%s'", what, name);
    *x = json_number_value(value);
    return json_is_number(value) ||
           fail_at(r, 1, 1, "'%s' of %s is no number", name, what);
}

/* Sets V to the vector NAME of OBJECT, zeros if there is none. */
static bool vector(const struct recording *r, const json_t *object,
                   const char *name, double v[3])
{
    const json_t *value = json_object_get(object, name);

    for (size_t k = 0; k < 3; k++) {
        v[k] = json_number_value(json_array_get(value, k));
        if (value && !json_is_number(json_array_get(value, k)))
            return fail_at(r, 1, 1, "'%s' takes three numbers", name);
    }
    return true;
}

/* ---------------------------------------------------------------------- body
 */

static bool take_body(const struct recording *r, const json_t *object)
{
    struct glint_motion_body body = {.n_sensors = 0};
    const json_t *sensors = either(object, "sensors", "erzosejtek");
    struct glint_error cause;

    if (!json_is_object(object))
        return fail_at(r, 1, 1, "the structure is no object");
    if (!number(r, object, "size", "meret", "the structure", &body.size) ||
        !number(r, object, "angleofview", "latoszog", "the structure",
                &body.angle_deg))
        return false;
    if (sensors && !json_is_array(sensors))
        return fail_at(r, 1, 1, "'sensors' is no array");
    if (json_array_size(sensors) > GLINT_MOTION_MAX_SENSORS)
        return fail_at(r, 1, 1, "more than %d sensors",
                       GLINT_MOTION_MAX_SENSORS);
    for (size_t i = 0; i < json_array_size(sensors); i++) {
        const json_t *sensor = json_array_get(sensors, i);

        if (!number(r, sensor, "theta", NULL, "a sensor", &body.theta[i]) ||
            !number(r, sensor, "phi", NULL, "a sensor", &body.phi[i]))
            return false;
        body.n_sensors++;
    }
    return glint_motion_baker_body(r->baker, &body, &cause) == GLINT_OK ||
           fail_at(r, 1, 1, "%s", cause.text);
}

/* -------------------------------------------------------------------- frames
 */

/* Sets the intensities of food I, if it has any: a number, or one for each
 * sensor. */
static bool take_intensities(const struct recording *r, const json_t *food,
                             int i, struct glint_motion_sight *s)
{
    const json_t *value = either(food, "i", "i1");
    const size_t n = json_is_array(value) ? json_array_size(value)
                     : value              ? 1
                                          : 0;

    if (n > GLINT_MOTION_MAX_SENSORS)
        return fail_at(r, 1, 1, "more than %d intensities",
                       GLINT_MOTION_MAX_SENSORS);
    if (i > 0 && (int)n != s->n_intensities)
        return fail_at(r, 1, 1, "foods have %d and %d intensities",
                       s->n_intensities, (int)n);
    s->n_intensities = (int)n;
    for (size_t k = 0; k < n; k++) {
        const json_t *one =
            json_is_array(value) ? json_array_get(value, k) : value;

        if (!json_is_number(one) && !json_is_boolean(one))
            return fail_at(r, 1, 1, "an intensity is no number");
        s->intensity[i][k] =
            json_is_number(one) ? json_number_value(one) : json_is_true(one);
    }
    return true;
}

static bool take_food(const struct recording *r, const json_t *food, int i,
                      struct glint_motion_sight *s)
{
    static const char *const axis[3] = {"x", "y", "z"};
    const json_t *reset = json_object_get(food, "reset");
    char what[24];

    snprintf(what, sizeof what, "food %d", i);
    if (!json_is_object(food))
        return fail_at(r, 1, 1, "%s is no object", what);
    for (int k = 0; k < 3; k++)
        if (!number(r, food, axis[k], NULL, what, &s->food[i][k]))
            return false;
    s->is_new[i] = json_is_true(reset) || json_number_value(reset) != 0;
    return take_intensities(r, food, i, s);
}

static bool read_frame(const struct recording *r, const json_t *object,
                       struct glint_motion_sight *s)
{
    const json_t *foods = either(object, "foods", "kajak");
    const json_t *of = json_object_get(object, "frame_num");

    *s = (struct glint_motion_sight){.number = -1};
    if (!json_is_object(object))
        return fail_at(r, 1, 1, "it is no object");
    if (of && (!json_is_integer(of) || json_integer_value(of) < 0))
        return fail_at(r, 1, 1, "'frame_num' is no whole number from 0 on");
    if (of)
        s->number = json_integer_value(of);
    if (!json_is_array(foods))
        return fail_at(r, 1, 1, "it has no array 'foods'");
    if (json_array_size(foods) > GLINT_MOTION_MAX_FOODS)
        return fail_at(r, 1, 1, "more than %d foods", GLINT_MOTION_MAX_FOODS);
    for (size_t i = 0; i < json_array_size(foods); i++)
        if (!take_food(r, json_array_get(foods, i), (int)i, s))
            return false;
    s->n_foods = (int)json_array_size(foods);
    return vector(r, object, "rv", s->rv) && vector(r, object, "tv", s->tv);
}

static enum glint_status take_frame(const struct recording *r,
                                    const json_t *object)
{
    struct glint_motion_sight sight;
    struct glint_error cause = {""};
    enum glint_status status;

    if (!read_frame(r, object, &sight))
        return GLINT_E_LENS;
    status = glint_motion_baker_frame(r->baker, &sight, &cause);
    if (status == GLINT_E_LENS)
        fail_at(r, 1, 1, "%s", cause.text);
    return status;
}

static enum glint_status take(void *ctx, const struct glint_split_piece *piece,
                              struct glint_error *error)
{
    struct recording *r = ctx;
    json_error_t wrong;
    json_t *value =
        json_loadb(piece->text, piece->bytes, JSON_DECODE_ANY, &wrong);
    enum glint_status status = GLINT_E_LENS;

    r->piece = piece;
    r->error = error;
    if (!value)
        fail_at(r, wrong.line > 0 ? wrong.line : 1,
                wrong.column > 0 ? wrong.column : 1, "%.100s", wrong.text);
    else if (piece->key == FRAMES)
        status = take_frame(r, value);
    else if (take_body(r, value))
        status = GLINT_OK;
    json_decref(value);
    return status;
}

enum glint_status glint_recording_read(struct glint_motion_baker *baker,
                                       const char *file_name,
                                       glint_recording_read_fn *read, void *ctx,
                                       struct glint_error *error)
{
    struct recording r = {.file_name = file_name, .baker = baker};

    return glint_split(file_name, read, ctx, keys, take, &r, error);
}
