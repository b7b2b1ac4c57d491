/* SPDX-License-Identifier: MIT */
#include "bake/scene/clauses.h"

#include <stdio.h>
#include <string.h>

/* ---------------------------------------------------------- mistyped words */

/* NEAR_CHARS: words of this many letters or more get no spelling hint.
 * NEAR_BYTES: size of a hint, bytes. */
enum { NEAR_CHARS = 32, NEAR_BYTES = 64 };

/* State of the search for the known word that is most similar to a mistyped
 * one. */
struct near {
    struct glint_word word;
    const char *best; /* most similar candidate so far, or NULL */
    int distance;
};

static int get_min_of_three(int a, int b, int c)
{
    const int ab = a < b ? a : b;

    return ab < c ? ab : c;
}

/* Returns the edit distance from WORD to CANDIDATE, or NEAR_CHARS if either has
 * NEAR_CHARS letters or more. */
static int compute_edit_distance(const struct glint_word *word,
                                 const char *candidate)
{
    const int m = (int)strlen(candidate);
    int row[NEAR_CHARS];

    if (word->length >= NEAR_CHARS || m >= NEAR_CHARS)
        return NEAR_CHARS;
    for (int k = 0; k <= m; k++)
        row[k] = k;
    for (int i = 1; i <= word->length; i++) {
        /* distance in the table's previous row and previous column */
        int corner = row[0];

        row[0] = i;
        for (int k = 1; k <= m; k++) {
            const int above = row[k];

            row[k] = get_min_of_three(
                above + 1, row[k - 1] + 1,
                corner + (word->start[i - 1] != candidate[k - 1]));
            corner = above;
        }
    }
    return row[m];
}

static struct near begin_similar_word_search(const struct glint_word *word)
{
    return (struct near){*word, NULL, NEAR_CHARS};
}

static void compare_candidate_word(struct near *near, const char *candidate)
{
    const int d = compute_edit_distance(&near->word, candidate);
    const int most = (int)strlen(candidate) / 3;

    if (d < near->distance && d <= (most > 1 ? most : 1)) {
        near->distance = d;
        near->best = candidate;
    }
}

/* Writes "; did you mean 'BEST'?" to TEXT, or "" if no candidate is similar
 * enough: it may differ in one letter, or in 1/3 of its letters. */
static const char *write_spelling_hint(const struct near *near,
                                       char text[NEAR_BYTES])
{
    text[0] = '\0';
    if (near->best)
        snprintf(text, NEAR_BYTES, "; did you mean '%s'?", near->best);
    return text;
}

/* ----------------------------------------------------------------- clauses */

/* Writes the keywords of CLAUSE as a list: "at, radius and material". */
static void list_clause_words(const struct glint_clause *clause, char *text,
                              size_t bytes)
{
    size_t used = 0;

    for (int i = 0; clause[i].word && used < bytes; i++)
        used += (size_t)snprintf(text + used, bytes - used, "%s%s",
                                 !i                   ? ""
                                 : clause[i + 1].word ? ", "
                                                      : " and ",
                                 clause[i].word);
}

static bool reject_unknown_word(struct glint_text *text, const char *line,
                                const struct glint_clause *clause,
                                const struct glint_word *word)
{
    struct near near = begin_similar_word_search(word);
    char quote[GLINT_QUOTE_BYTES], mean[NEAR_BYTES], words[120];

    glint_word_quote(word, quote);
    for (int i = 0; clause[i].word; i++)
        compare_candidate_word(&near, clause[i].word);
    write_spelling_hint(&near, mean);
    list_clause_words(clause, words, sizeof words);
    return glint_text_set_error(text, word->place, "%s accepts %s, not '%s'%s",
                                line, words, quote, mean);
}

bool glint_numbers_read(struct glint_text *text, const char *what, int n,
                        double min, double max, double *value)
{
    const struct glint_text_range range = {what, min, max};

    for (int i = 0; i < n; i++) {
        const struct glint_word word = glint_text_next_word(text);

        if (!word.length && n > 1)
            return glint_text_set_error(
                text, word.place, "%s needs %d numbers, got %d", what, n, i);
        if (!glint_text_parse_value(text, &word, &range, &value[i]))
            return false;
    }
    return true;
}

static bool read_clause_values(struct glint_text *text,
                               struct glint_clause *clause,
                               const struct glint_word *word)
{
    if (clause->place.line)
        return glint_text_set_error(text, word->place, "a second '%s'",
                                    clause->word);
    clause->place = word->place;
    if (!clause->name)
        return glint_numbers_read(text, clause->word, clause->n, clause->min,
                                  clause->max, clause->value);
    *clause->name = glint_text_next_word(text);
    return clause->name->length > 0 ||
           glint_text_set_error(text, clause->name->place,
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

        while (c->word && !glint_word_equals(&word, c->word))
            c++;
        if (!c->word)
            return reject_unknown_word(text, line, clause, &word);
        if (!read_clause_values(text, c, &word))
            return false;
    }
    for (const struct glint_clause *c = clause; c->word; c++)
        if (c->required && !c->place.line)
            return glint_text_set_error(text, word.place, "%s needs '%s'", line,
                                        c->word);
    return true;
}

/* ------------------------------------------------------------------- lines */

bool glint_line_read_first_word(struct glint_text *text,
                                const struct glint_text_line *lines, int n,
                                int *first, int *index)
{
    const struct glint_word word = glint_text_next_word(text);
    char quote[GLINT_QUOTE_BYTES], mean[NEAR_BYTES];
    struct near near = begin_similar_word_search(&word);
    int i = 0;

    *index = -1;
    if (!word.length)
        return true;
    while (i < n && !glint_word_equals(&word, lines[i].word))
        compare_candidate_word(&near, lines[i++].word);
    if (i == n)
        return glint_text_set_error(text, word.place, "unknown word '%s'%s",
                                    glint_word_quote(&word, quote),
                                    write_spelling_hint(&near, mean));
    if (first[i] && !lines[i].many)
        return glint_text_set_error(text, word.place,
                                    "a second %s; the first is on line %d",
                                    lines[i].word, first[i]);
    first[i] = word.place.line;
    *index = i;
    return true;
}

bool glint_name_find_index(struct glint_text *text,
                           const struct glint_word *word, const char *what,
                           const char *names, size_t stride, int n, int *index)
{
    struct near near = begin_similar_word_search(word);
    char quote[GLINT_QUOTE_BYTES], mean[NEAR_BYTES];

    for (*index = 0; *index < n; ++*index, names += stride) {
        if (glint_word_equals(word, names))
            return true;
        compare_candidate_word(&near, names);
    }
    return glint_text_set_error(
        text, word->place, "no %s '%s' is defined above this line%s", what,
        glint_word_quote(word, quote), write_spelling_hint(&near, mean));
}

int glint_choice_read(struct glint_text *text, const char *line,
                      const char *list, const char *const *names)
{
    const struct glint_word word = glint_text_next_word(text);
    char quote[GLINT_QUOTE_BYTES];

    for (int i = 0; names[i]; i++)
        if (glint_word_equals(&word, names[i]))
            return i;
    glint_text_set_error(text, word.place, "%s accepts %s%s%s%s", line, list,
                         word.length ? ", not '" : "",
                         word.length ? glint_word_quote(&word, quote) : "",
                         word.length ? "'" : "");
    return -1;
}

bool glint_name_copy(struct glint_text *text, const struct glint_word *word,
                     char *name, int bytes)
{
    bool good = word->length > 0 && word->length < bytes;

    for (int i = 0; good && i < word->length; i++) {
        const char c = word->start[i];
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');

        good = letter ||
               (i > 0 && ((c >= '0' && c <= '9') || c == '-' || c == '_'));
    }
    if (!good)
        return glint_text_set_error(
            text, word->place,
            "a name must be a letter followed by at most %d "
            "letters, digits, - and _",
            bytes - 2);
    memcpy(name, word->start, (size_t)word->length);
    name[word->length] = '\0';
    return true;
}

bool glint_name_read(struct glint_text *text, const char *what, char *name,
                     int bytes)
{
    const struct glint_word word = glint_text_next_word(text);

    if (!word.length)
        return glint_text_set_error(text, word.place,
                                    "the name of the %s is "
                                    "missing",
                                    what);
    return glint_name_copy(text, &word, name, bytes);
}

bool glint_line_check_end(struct glint_text *text, const char *line)
{
    const struct glint_word word = glint_text_next_word(text);
    char quote[GLINT_QUOTE_BYTES];

    return !word.length ||
           glint_text_set_error(text, word.place,
                                "'%s' is one value too many for %s",
                                glint_word_quote(&word, quote), line);
}
