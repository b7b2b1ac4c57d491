/* SPDX-License-Identifier: MIT
 *
 * Parses a file NAME.environment line by line: the panorama picture, the map
 * size, and how lights are extracted from the map. */
#include <string.h>

#include "bake/scene/clauses.h"
#include "glint/scene/environment_bake.h"

static const struct glint_text_line lines[] = {{"source", false},
                                               {"size", false},
                                               {"lights", false},
                                               {"turn", false},
                                               {"scale", false}};

enum { N_LINES = sizeof lines / sizeof *lines };

static bool read_source_name(struct glint_text *text, char *source)
{
    const struct glint_word word = glint_text_get_rest(text);

    if (!word.length)
        return glint_text_set_error(text, word.place,
                                    "the file name is missing: source PICTURE");
    memcpy(source, word.start, (size_t)word.length);
    source[word.length] = '\0';
    return true;
}

static bool read_lights_line(struct glint_text *text,
                             struct glint_environment_options *o)
{
    struct glint_clause clause[] = {
        {"radius", 1, .1, 20, .value = &o->light_deg},
        {"above", 1, 2, 1000, .value = &o->light_above},
        {0}};
    double n;

    if (!glint_numbers_read(text, "lights", 1, 0, GLINT_ENVIRONMENT_MAX_LIGHTS,
                            &n))
        return false;
    o->max_lights = (int)n;
    return glint_clauses_read(text, "lights", clause);
}

static bool read_map_size(struct glint_text *text,
                          struct glint_environment_options *o)
{
    static const char *const sizes[] = {"16",  "32",  "64",   "128",
                                        "256", "512", "1024", NULL};
    const int i = glint_choice_read(text, "size",
                                    "16, 32, 64, 128, 256, 512 or 1024", sizes);

    o->side_log2 = GLINT_ENVIRONMENT_LEAST_LOG2 + i;
    return i >= 0;
}

static bool read_environment_line(struct glint_text *text, int which,
                                  struct glint_environment_options *o,
                                  char *source)
{
    switch (which) {
    case 0:
        return read_source_name(text, source);
    case 1:
        return read_map_size(text, o);
    case 2:
        return read_lights_line(text, o);
    case 3:
        return glint_numbers_read(text, "turn", 1, -360, 360, &o->turn_deg);
    default:
        return glint_numbers_read(text, "scale", 1, 1e-6, 1e6, &o->scale);
    }
}

enum glint_status
glint_environment_parse(struct glint_environment_options *options,
                        char source[GLINT_ENVIRONMENT_FILE_BYTES],
                        const char *data, size_t bytes, const char *file_name,
                        struct glint_error *error)
{
    struct glint_text text;
    int first[N_LINES] = {0};
    bool good;

    glint_environment_defaults(options);
    source[0] = '\0';
    good = glint_text_open(&text, data, bytes, file_name, error);
    while (good && glint_text_next_line(&text)) {
        int i;

        good = glint_line_read_first_word(&text, lines, N_LINES, first, &i) &&
               (i < 0 || (read_environment_line(&text, i, options, source) &&
                          glint_line_check_end(&text, lines[i].word)));
    }
    if (good && !source[0])
        good = glint_text_set_error(&text, glint_text_get_end_place(&text),
                                    "the line 'source FILE' is missing");
    return good ? GLINT_OK : GLINT_E_LENS;
}
