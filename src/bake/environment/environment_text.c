/* SPDX-License-Identifier: MIT
 *
 * Reads the text of an environment line by line. */
#include <string.h>

#include "bake/scene/clauses.h"
#include "bake/scene/near.h"
#include "glint/scene/environment_bake.h"

static const char *const words[] = {"source", "size",  "levels", "lights",
                                    "turn",   "scale", NULL};

/* Reads one of NAMES, NULL at the end, and returns its index or -1. */
static int read_name(struct glint_text *text, const char *line,
                     const char *list, const char *const *names)
{
    const struct glint_word word = glint_text_next_word(text);
    char quote[GLINT_QUOTE_BYTES];

    for (int i = 0; names[i]; i++)
        if (glint_word_is(&word, names[i]))
            return i;
    glint_text_fail(text, word.place, "%s takes %s%s%s%s", line, list,
                    word.length ? ", not '" : "",
                    word.length ? glint_word_quote(&word, quote) : "",
                    word.length ? "'" : "");
    return -1;
}

static bool read_source(struct glint_text *text, char *source)
{
    const struct glint_word word = glint_text_rest(text);

    if (!word.length)
        return glint_text_fail(text, word.place,
                               "the name of the picture is missing");
    memcpy(source, word.start, (size_t)word.length);
    source[word.length] = '\0';
    return true;
}

static bool read_lights(struct glint_text *text,
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

static bool read_size(struct glint_text *text,
                      struct glint_environment_options *o)
{
    static const char *const sizes[] = {"16",  "32",  "64",   "128",
                                        "256", "512", "1024", NULL};
    const int i =
        read_name(text, "size", "16, 32, 64, 128, 256, 512 or 1024", sizes);

    o->side_log2 = GLINT_ENVIRONMENT_LEAST_LOG2 + i;
    return i >= 0;
}

static bool read_line(struct glint_text *text, int which,
                      struct glint_environment_options *o, char *source)
{
    static const char *const levels[] = {"gauss", "mip", NULL};
    int i = 0;

    switch (which) {
    case 0:
        return read_source(text, source);
    case 1:
        return read_size(text, o);
    case 2:
        i = read_name(text, "levels", "gauss or mip", levels);
        o->levels = i == 1 ? GLINT_ENVIRONMENT_MIP : GLINT_ENVIRONMENT_GAUSS;
        break;
    case 3:
        return read_lights(text, o);
    case 4:
        return glint_numbers_read(text, "turn", 1, -360, 360, &o->turn_deg);
    default:
        return glint_numbers_read(text, "scale", 1, 1e-6, 1e6, &o->scale);
    }
    return i >= 0;
}

static bool unknown(struct glint_text *text, const struct glint_word *word)
{
    struct glint_near near = glint_near_begin(*word);
    char quote[GLINT_QUOTE_BYTES], mean[GLINT_NEAR_BYTES];

    for (int i = 0; words[i]; i++)
        glint_near_offer(&near, words[i]);
    return glint_text_fail(text, word->place, "unknown word '%s'%s",
                           glint_word_quote(word, quote),
                           glint_near_text(&near, mean));
}

enum glint_status
glint_environment_parse(struct glint_environment_options *options,
                        char source[GLINT_ENVIRONMENT_FILE_BYTES],
                        const char *data, size_t bytes, const char *file_name,
                        struct glint_error *error)
{
    struct glint_text text;
    int first[sizeof words / sizeof *words] = {0};
    bool good;

    glint_environment_defaults(options);
    source[0] = '\0';
    good = glint_text_open(&text, data, bytes, file_name, error);
    while (good && glint_text_next_line(&text)) {
        const struct glint_word word = glint_text_next_word(&text);
        int i = 0;

        if (!word.length)
            continue;
        while (words[i] && !glint_word_is(&word, words[i]))
            i++;
        if (!words[i])
            good = unknown(&text, &word);
        else if (first[i])
            good = glint_text_fail(&text, word.place,
                                   "a second %s; the first is on line %d",
                                   words[i], first[i]);
        else
            good = read_line(&text, i, options, source) &&
                   glint_line_ends(&text, words[i]);
        first[i] = word.place.line;
    }
    if (good && !source[0])
        good = glint_text_fail(&text, glint_text_end(&text),
                               "there is no picture: source FILE");
    return good ? GLINT_OK : GLINT_E_LENS;
}
