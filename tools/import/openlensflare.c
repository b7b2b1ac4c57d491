/* SPDX-License-Identifier: MIT
 *
 * Reads XML files of OpenLensFlare and LensFlareFramework: an <opticalSystem>
 * of <element>s, parsed by expat.
 *
 * A <height> is a semi-diameter, multiplied by <heightMultiplier> if the file
 * has one; the stop's <height> is a diameter, not multiplied.
 */
#include <expat.h>
#include <math.h>
#include <string.h>

#include "import/imported.h"
#include "options/tool.h"

enum { HEIGHT, THICKNESS, RADIUS, INDEX, ABBE, ELEMENT_VALUES };
static const char *const element_words[ELEMENT_VALUES] = {
    "height", "thickness", "radius", "refractiveIndex", "abbeNumber"};

enum { F_NUMBER, FOCAL, WIDTH, FILM_HEIGHT, MULTIPLIER, SYSTEM_VALUES };
static const char *const system_words[SYSTEM_VALUES] = {
    "fnumber", "effectiveFocalLength", "filmWidth", "filmHeight",
    "heightMultiplier"};

struct reader {
    struct imported *lens;
    XML_Parser parser;
    int depth;       /* number of open XML elements */
    bool in_element; /* whether the parser is inside <element> */
    /* coated: whether a coating has been read; ended: whether the sensor has
     * been read */
    bool coated, ended;
    int line; /* line number of <element> */
    char kind[24], text[IMPORT_TEXT];
    size_t bytes;
    double value[ELEMENT_VALUES], system[SYSTEM_VALUES];
    bool has[ELEMENT_VALUES], system_has[SYSTEM_VALUES];
};

static int get_parser_line(const struct reader *r)
{
    return (int)XML_GetCurrentLineNumber(r->parser);
}

static void stop_parser_on_error(struct reader *r, bool good)
{
    if (!good)
        XML_StopParser(r->parser, XML_FALSE);
}

static void XMLCALL handle_start_tag(void *data, const char *name,
                                     const char **pairs)
{
    struct reader *r = data;

    (void)pairs;
    r->bytes = 0;
    if (r->depth++ == 0 && strcmp(name, "opticalSystem") != 0)
        stop_parser_on_error(r, imported_report_error(
                                    r->lens, get_parser_line(r),
                                    "<%.40s> is not an <opticalSystem>", name));
    if (strcmp(name, "element") == 0) {
        r->in_element = true;
        r->line = get_parser_line(r);
        r->kind[0] = '\0';
        memset(r->has, 0, sizeof r->has);
    }
}

static void XMLCALL handle_element_text(void *data, const char *text, int n)
{
    struct reader *r = data;

    for (int i = 0; i < n && r->bytes < sizeof r->text - 1; i++)
        r->text[r->bytes++] = text[i] == '\n' ? ' ' : text[i];
}

static void XMLCALL reject_doctype(void *data, const char *name,
                                   const char *system, const char *public_id,
                                   int has_internal)
{
    struct reader *r = data;

    (void)name;
    (void)system;
    (void)public_id;
    (void)has_internal;
    stop_parser_on_error(
        r, imported_report_error(r->lens, get_parser_line(r),
                                 "<!DOCTYPE> is not allowed in lens files"));
}

/* Stores the <element> that was just closed: a surface, the stop or the
 * sensor. */
static bool store_closed_element(struct reader *r)
{
    const bool stop = strcmp(r->kind, "apertureStop") == 0;
    struct imported_surface *s;

    if (r->ended)
        return imported_report_error(r->lens, r->line,
                                     "an element behind the sensor");
    if (strcmp(r->kind, "sensor") == 0)
        return r->ended = true;
    if (!stop && strcmp(r->kind, "lensSpherical") != 0)
        return imported_report_error(
            r->lens, r->line,
            "elements of type '%s' are not supported; "
            "lensSpherical, apertureStop and sensor are",
            r->kind);
    for (int i = 0; i < ELEMENT_VALUES; i++)
        if (!r->has[i] && !(stop && i == RADIUS))
            return imported_report_error(r->lens, r->line, "<%s> is missing",
                                         element_words[i]);
    s = imported_add_surface(r->lens, r->line);
    if (!s)
        return false;
    s->stop = stop;
    s->radius = stop ? 0 : r->value[RADIUS];
    s->thickness = r->value[THICKNESS];
    s->semi = r->value[HEIGHT];
    s->nd = r->value[INDEX];
    s->vd = s->nd == 1 ? 0 : r->value[ABBE];
    return true;
}

/* If NAME is in WORDS[N], stores the number in r->text in the value of the
 * same index. Sets *DONE to whether NAME is in WORDS. */
static bool parse_element_value(struct reader *r, const char *name, int n,
                                const char *const *words, double *values,
                                bool *has, bool *done)
{
    *done = false;
    for (int i = 0; i < n && !*done; i++) {
        if (strcmp(words[i], name) != 0)
            continue;
        *done = has[i] = true;
        if (!tool_parse_number(r->text, &values[i]))
            return imported_report_error(r->lens, get_parser_line(r),
                                         "<%s> '%.40s' is not a number", name,
                                         r->text);
    }
    return true;
}

static bool parse_end_tag(struct reader *r, const char *name)
{
    static const char *const ignored[] = {"opticalSystem", "elements", "mask",
                                          "maskFT", "fieldOfView"};
    bool done;

    if (strcmp(name, "element") == 0) {
        r->in_element = false;
        return store_closed_element(r);
    }
    if (!(r->in_element
              ? parse_element_value(r, name, ELEMENT_VALUES, element_words,
                                    r->value, r->has, &done)
              : parse_element_value(r, name, SYSTEM_VALUES, system_words,
                                    r->system, r->system_has, &done)))
        return false;
    if (done)
        return true;
    if (r->in_element && strcmp(name, "type") == 0) {
        snprintf(r->kind, sizeof r->kind, "%.23s", r->text);
        return true;
    }
    if (!r->in_element && strcmp(name, "name") == 0) {
        snprintf(r->lens->title, sizeof r->lens->title, "%.230s", r->text);
        return true;
    }
    if (strncmp(name, "coating", 7) == 0)
        return r->coated = true;
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++)
        if (strcmp(ignored[i], name) == 0)
            return true;
    return imported_note_unread_word(r->lens, get_parser_line(r), name);
}

static void XMLCALL handle_end_tag(void *data, const char *name)
{
    struct reader *r = data;

    r->depth--;
    while (r->bytes > 0 && strchr(" \t\r", r->text[r->bytes - 1]))
        r->bytes--;
    r->text[r->bytes] = '\0';
    memmove(r->text, r->text + strspn(r->text, " \t\r"),
            strlen(r->text + strspn(r->text, " \t\r")) + 1);
    stop_parser_on_error(r, parse_end_tag(r, name));
    r->bytes = 0;
}

static bool finish_lens(struct reader *r)
{
    struct imported *lens = r->lens;

    if (lens->n < 2)
        return imported_report_no_surfaces(lens);
    if (r->system_has[F_NUMBER])
        lens->f_number = r->system[F_NUMBER];
    if (r->system_has[FOCAL])
        lens->nominal = r->system[FOCAL];
    if (lens->film_mm[0] <= 0 && r->system_has[WIDTH] &&
        r->system_has[FILM_HEIGHT]) {
        lens->film_mm[0] = r->system[WIDTH];
        lens->film_mm[1] = r->system[FILM_HEIGHT];
    }
    for (int k = 0; k < lens->n && r->system_has[MULTIPLIER]; k++)
        lens->surface[k].semi *=
            lens->surface[k].stop ? 0.5 : r->system[MULTIPLIER];
    return !r->coated || imported_add_note(lens, 0, "coatings are ignored");
}

bool import_openlensflare(struct imported *lens, const char *text, size_t bytes)
{
    struct reader r = {.lens = lens};
    enum XML_Status status;

    /* Overrides the encoding that the file declares: numbers are ASCII, and
     * other characters become question marks. */
    r.parser = XML_ParserCreate("ISO-8859-1");
    if (!r.parser)
        return imported_report_error(lens, 0, "out of memory");
    XML_SetUserData(r.parser, &r);
    XML_SetElementHandler(r.parser, handle_start_tag, handle_end_tag);
    XML_SetCharacterDataHandler(r.parser, handle_element_text);
    XML_SetStartDoctypeDeclHandler(r.parser, reject_doctype);
    status = XML_Parse(r.parser, text, (int)bytes, XML_TRUE);
    if (status != XML_STATUS_OK && !lens->error[0])
        imported_report_error(lens, get_parser_line(&r), "%.150s",
                              XML_ErrorString(XML_GetErrorCode(r.parser)));
    XML_ParserFree(r.parser);
    return status == XML_STATUS_OK && !lens->error[0] && finish_lens(&r);
}
