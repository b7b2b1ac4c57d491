/* SPDX-License-Identifier: MIT
 *
 * Reads items of a data set from lines of JSON, parsed by jansson.
 */
#include <math.h>
#include <string.h>

#include <jansson.h>

#include "posix/error.h"
#include "synth/item.h"

static enum glint_status report_bad_member(struct glint_error *error,
                                           const char *name, const char *cause)
{
    return glint_error_report(error, GLINT_E_FORMAT, "item", "'%s' %s", name,
                              cause);
}

static enum glint_status store_json_member(const struct synth_field *field,
                                           const json_t *value, void *to,
                                           struct glint_error *error)
{
    char cause[80];
    char *const at = (char *)to + field->at;
    const char *text;
    bool is_whole;
    double x = 0;

    if (!value)
        return report_bad_member(error, field->name, "is not there");
    if (field->text_bytes) {
        text = json_string_value(value);
        if (!text || strlen(text) >= field->text_bytes)
            return report_bad_member(error, field->name,
                                     "is not a text, or is too long");
        memcpy(at, text, strlen(text) + 1);
        return GLINT_OK;
    }
    is_whole = field->law == SYNTH_WHOLE || field->law == SYNTH_COUNTED;
    x = json_number_value(value);
    if (!json_is_number(value) || x < field->least || x > field->most ||
        (is_whole && x != floor(x))) {
        snprintf(cause, sizeof cause, "must be %s, %.10g to %.10g",
                 is_whole ? "a whole number" : "a number", field->least,
                 field->most);
        return report_bad_member(error, field->name, cause);
    }
    *(double *)(void *)at = x;
    return GLINT_OK;
}

static enum glint_status store_json_members(const struct synth_field *field,
                                            int n, const json_t *object,
                                            void *to, struct glint_error *error)
{
    enum glint_status status = GLINT_OK;

    for (int k = 0; k < n && status == GLINT_OK; k++)
        status = store_json_member(
            &field[k], json_object_get(object, field[k].name), to, error);
    return status;
}

static enum glint_status read_json_item(struct synth_item *item,
                                        const json_t *line,
                                        struct glint_error *error)
{
    const json_t *const lights = json_object_get(line, "lights");
    enum glint_status status =
        store_json_members(synth_field, SYNTH_FIELDS, line, item, error);

    if (status == GLINT_OK && json_array_size(lights) != (size_t)item->n_lights)
        return report_bad_member(
            error, "lights", "the number of lights differs from 'n_lights'");
    for (int i = 0; i < (int)item->n_lights && status == GLINT_OK; i++)
        status = store_json_members(synth_light_field, SYNTH_LIGHT_FIELDS,
                                    json_array_get(lights, (size_t)i),
                                    &item->light[i], error);
    return status;
}

enum glint_status synth_item_parse_json(struct synth_item *item,
                                        const char *line,
                                        struct glint_error *error)
{
    json_error_t why;
    json_t *const read = json_loads(line, JSON_REJECT_DUPLICATES, &why);
    enum glint_status status;

    *item = (struct synth_item){.number = 0};
    if (!read)
        return glint_error_report(error, GLINT_E_FORMAT, "item",
                                  "column %d: %s", why.column, why.text);
    status = read_json_item(item, read, error);
    json_decref(read);
    return status;
}
