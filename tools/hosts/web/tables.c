/* SPDX-License-Identifier: MIT
 *
 * Writes tables as JSON for the page: options, styles and lenses.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "desk/styles.h"
#include "glint/options.h"
#include "glint/prescription.h"
#include "web/glint_web.h"

static char *json; /* JSON text to return, [room] */
static size_t used, room;

/* Appends a formatted text. If there is no memory, omits this and all later
 * texts; the result is then not valid JSON. */
__attribute__((format(printf, 1, 2))) static void append(const char *format,
                                                         ...)
{
    va_list arguments;

    if (room - used < 4096) {
        char *const more = realloc(json, 2 * room + 65536);

        if (!more)
            return;
        json = more;
        room = 2 * room + 65536;
    }
    va_start(arguments, format);
    used += (size_t)vsnprintf(json + used, 4096, format, arguments);
    va_end(arguments);
}

/* Appends KEY and TEXT, which must not contain control characters. */
static void append_json_text(const char *key, const char *text)
{
    append("\"%s\":\"", key);
    for (; text && *text; text++)
        append(*text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
    append("\",");
}

static void append_json_number(const char *key, double value)
{
    if (isfinite(value))
        append("\"%s\":%.17g,", key, value);
    else
        append("\"%s\":null,", key);
}

static void begin_json(void)
{
    used = 0;
    append("[");
}

static const char *end_json(void)
{
    if (used && json[used - 1] == ',')
        used--;
    append("]");
    return json;
}

const char *web_options(void)
{
    static const char *const types[] = {"real", "integer", "flag", "word",
                                        "text"};
    static const char *const groups[] = {
        "lamps", "artist", "scene", "shading", "lens", "brightness", "speed"};
    static const char *const changes[] = {"create", "resize", "frame"};
    const struct glint_option *row;

    begin_json();
    for (int i = 0; (row = glint_option(i)) != NULL; i++) {
        if (!web_has_option(row))
            continue;
        append("{");
        append_json_text("name", row->name);
        append_json_text("value", row->value);
        append_json_text("accepts", row->accepts);
        append_json_text("help", row->help);
        append_json_text("text", row->text);
        append_json_number("low", row->low);
        append_json_number("high", row->high);
        append_json_number("initial", row->initial);
        append_json_text("type", types[row->type]);
        append_json_text("group", groups[row->group]);
        append("\"changes\":\"%s\"},", changes[row->changes]);
    }
    return end_json();
}

const char *web_styles(void)
{
    begin_json();
    for (const struct style *s = styles; s->name; s++) {
        append("{");
        append_json_text("name", s->name);
        append_json_text("about", s->about);
        append("\"set\":{");
        for (int i = 0; s->set[i].option; i++)
            append("%s\"%s\":\"%s\"", i ? "," : "", s->set[i].option,
                   s->set[i].value);
        append("}},");
    }
    return end_json();
}

/* Appends radius, thickness, semi-diameter and the index behind it of each
 * surface. */
static void append_lens_surfaces(const struct glint_prescription *lens)
{
    append("\"surfaces\":[");
    for (int i = 0; i < lens->n_surfaces; i++) {
        const struct glint_surface *const s = &lens->surface[i];

        append("%s[%.6g,%.6g,%.6g,%.6g]", i ? "," : "", s->radius_mm,
               s->thickness_mm, s->semi_mm, glint_surface_index(s, 587.56));
    }
    append("]},");
}

const char *web_lenses(void)
{
    struct glint_prescription *const lens = malloc(sizeof *lens);
    struct glint_error error;
    struct glint_optics optics;

    begin_json();
    for (const struct web_lens *l = web_lens; lens && l->name; l++) {
        if (glint_prescription_parse(lens, l->text, strlen(l->text), l->name,
                                     &error) != GLINT_OK)
            continue;
        glint_optics_of(lens, &optics);
        append("{");
        append_json_text("name", l->name);
        append_json_text("folder", l->folder);
        append_json_text("source", lens->source);
        append_json_text("character", lens->character);
        append_json_number("f", lens->f_number);
        append_json_number("widest", glint_prescription_widest(lens));
        append_json_number("focal", optics.focal_mm);
        append_json_number("filmWidth", lens->film_width_mm);
        append_json_number("filmHeight", lens->film_height_mm);
        append_json_number("positions", lens->zoom.n_positions);
        append_json_number("stopAfter", lens->stop_after);
        append_json_number("stopThickness", lens->stop_thickness_mm);
        append_json_number("stopSemi", optics.stop_radius_mm);
        append_lens_surfaces(lens);
    }
    free(lens);
    return end_json();
}
