/* SPDX-License-Identifier: MIT */
#include "bake/scene/clauses.h"

#include <stdio.h>
#include <string.h>

#include "bake/scene/near.h"

/* Lists the words of CLAUSE: "at, radius and material". */
static void list(const struct glint_clause *clause, char *text, size_t bytes)
{
    size_t used = 0;

    for (int i = 0; clause[i].word && used < bytes; i++)
        used += (size_t)snprintf(text + used, bytes - used, "%s%s",
                                 !i                   ? ""
                                 : clause[i + 1].word ? ", "
                                                      : " and ",
                                 clause[i].word);
}

static bool refuse(struct glint_text *text, const char *line,
                   const struct glint_clause *clause,
                   const struct glint_word *word)
{
    struct glint_near near = glint_near_begin(*word);
    char quote[GLINT_QUOTE_BYTES], mean[GLINT_NEAR_BYTES], words[120];

    glint_word_quote(word, quote);
    for (int i = 0; clause[i].word; i++)
        glint_near_offer(&near, clause[i].word);
    glint_near_text(&near, mean);
    list(clause, words, sizeof words);
    return glint_text_fail(text, word->place, "%s takes %s, not '%s'%s", line,
                           words, quote, mean);
}

bool glint_numbers_read(struct glint_text *text, const char *what, int n,
                        double min, double max, double *value)
{
    const struct glint_text_range range = {what, min, max};

    for (int i = 0; i < n; i++) {
        const struct glint_word word = glint_text_next_word(text);

        if (!word.length && n > 1)
            return glint_text_fail(text, word.place,
                                   "%s takes %d numbers, here are %d", what, n,
                                   i);
        if (!glint_text_value_of(text, &word, &range, &value[i]))
            return false;
    }
    return true;
}

static bool read_clause(struct glint_text *text, struct glint_clause *clause,
                        const struct glint_word *word)
{
    if (clause->place.line)
        return glint_text_fail(text, word->place, "a second '%s'",
                               clause->word);
    clause->place = word->place;
    if (!clause->name)
        return glint_numbers_read(text, clause->word, clause->n, clause->min,
                                  clause->max, clause->value);
    *clause->name = glint_text_next_word(text);
    return clause->name->length > 0 ||
           glint_text_fail(text, clause->name->place,
                           "the name of a %s is "
                           "missing",
                           clause->word);
}

bool glint_clauses_read(struct glint_text *text, const char *line,
                        struct glint_clause *clause)
{
    struct glint_word word;

    while ((word = glint_text_next_word(text)).length) {
        struct glint_clause *c = clause;

        while (c->word && !glint_word_is(&word, c->word))
            c++;
        if (!c->word)
            return refuse(text, line, clause, &word);
        if (!read_clause(text, c, &word))
            return false;
    }
    for (const struct glint_clause *c = clause; c->word; c++)
        if (c->required && !c->place.line)
            return glint_text_fail(text, word.place, "%s needs '%s'", line,
                                   c->word);
    return true;
}

bool glint_name_read(struct glint_text *text, const char *what, char *name,
                     int bytes)
{
    const struct glint_word word = glint_text_next_word(text);
    bool good = word.length > 0 && word.length < bytes;

    if (!word.length)
        return glint_text_fail(text, word.place,
                               "the name of the %s is "
                               "missing",
                               what);
    for (int i = 0; good && i < word.length; i++) {
        const char c = word.start[i];
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');

        good = letter ||
               (i > 0 && ((c >= '0' && c <= '9') || c == '-' || c == '_'));
    }
    if (!good)
        return glint_text_fail(text, word.place,
                               "a name is a letter and at most %d letters, "
                               "digits, - and _",
                               bytes - 2);
    memcpy(name, word.start, (size_t)word.length);
    name[word.length] = '\0';
    return true;
}

bool glint_line_ends(struct glint_text *text, const char *line)
{
    const struct glint_word word = glint_text_next_word(text);
    char quote[GLINT_QUOTE_BYTES];

    return !word.length ||
           glint_text_fail(text, word.place, "'%s' is more than %s takes",
                           glint_word_quote(&word, quote), line);
}
