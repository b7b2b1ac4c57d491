/* SPDX-License-Identifier: MIT
 *
 * The tables of the library as JSON. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "desk/styles.h"
#include "glint/options.h"
#include "glint/prescription.h"
#include "web/glint_web.h"

static char *json; /* what is returned, [room] */
static size_t used, room;

/* Appends text; without memory what follows is left out, so that it is no
 * JSON. */
__attribute__((format(printf, 1, 2))) static void put(const char *format, ...)
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

/* Appends KEY and TEXT, which has no control characters. */
static void put_text(const char *key, const char *text)
{
    put("\"%s\":\"", key);
    for (; text && *text; text++)
        put(*text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
    put("\",");
}

static void put_number(const char *key, double value)
{
    if (isfinite(value))
        put("\"%s\":%.17g,", key, value);
    else
        put("\"%s\":null,", key);
}

static void begin(void)
{
    used = 0;
    put("[");
}

static const char *end(void)
{
    if (used && json[used - 1] == ',')
        used--;
    put("]");
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

    begin();
    for (int i = 0; (row = glint_option(i)) != NULL; i++) {
        put("{");
        put_text("name", row->name);
        put_text("value", row->value);
        put_text("accepts", row->accepts);
        put_text("help", row->help);
        put_text("text", row->text);
        put_number("low", row->low);
        put_number("high", row->high);
        put_number("initial", row->initial);
        put_text("type", types[row->type]);
        put_text("group", groups[row->group]);
        put("\"changes\":\"%s\"},", changes[row->changes]);
    }
    return end();
}

const char *web_styles(void)
{
    begin();
    for (const struct style *s = styles; s->name; s++) {
        put("{");
        put_text("name", s->name);
        put_text("about", s->about);
        put("\"set\":{");
        for (int i = 0; s->set[i].option; i++)
            put("%s\"%s\":\"%s\"", i ? "," : "", s->set[i].option,
                s->set[i].value);
        put("}},");
    }
    return end();
}

/* Appends the surfaces: radius, thickness, semi-diameter, index behind. */
static void put_surfaces(const struct glint_prescription *lens)
{
    put("\"surfaces\":[");
    for (int i = 0; i < lens->n_surfaces; i++) {
        const struct glint_surface *const s = &lens->surface[i];

        put("%s[%.6g,%.6g,%.6g,%.6g]", i ? "," : "", s->radius_mm,
            s->thickness_mm, s->semi_mm, glint_surface_index(s, 587.56));
    }
    put("]},");
}

const char *web_lenses(void)
{
    struct glint_prescription *const lens = malloc(sizeof *lens);
    struct glint_error error;
    struct glint_optics optics;

    begin();
    for (const struct web_lens *l = web_lens; lens && l->name; l++) {
        if (glint_prescription_parse(lens, l->text, strlen(l->text), l->name,
                                     &error) != GLINT_OK)
            continue;
        glint_optics_of(lens, &optics);
        put("{");
        put_text("name", l->name);
        put_text("folder", l->folder);
        put_text("source", lens->source);
        put_text("character", lens->character);
        put_number("f", lens->f_number);
        put_number("focal", optics.focal_mm);
        put_number("filmWidth", lens->film_width_mm);
        put_number("filmHeight", lens->film_height_mm);
        put_number("positions", lens->zoom.n_positions);
        put_number("stopAfter", lens->stop_after);
        put_number("stopThickness", lens->stop_thickness_mm);
        put_number("stopSemi", optics.stop_radius_mm);
        put_surfaces(lens);
    }
    free(lens);
    return end();
}
