/* SPDX-License-Identifier: MIT */
#include "import/lines.h"

#include <math.h>
#include <string.h>

#include "options/tool.h"

void lines_init(struct lines *l, struct imported *lens, const char *text,
                size_t bytes)
{
    *l = (struct lines){.lens = lens, .at = text, .end = text + bytes};
}

/* Returns the quote that closes the one at AT, or NULL if AT is not a quote
 * or the quote is not closed on its line. */
static const char *find_closing_quote(const char *at, const char *end)
{
    const char quote = *at;

    if (quote != '"' && quote != '\'')
        return NULL;
    for (at++; at < end && *at && *at != '\n'; at++)
        if (*at == quote)
            return at;
    return NULL;
}

/* Copies a line without its comment to l->text. Returns false if the line is
 * too long. */
static bool copy_line_without_comment(struct lines *l, char comment)
{
    /* position of the closing quote; NULL outside quotes */
    const char *quoted = NULL;
    size_t n = 0;
    bool said = false, fits = true;
    char before = ' ';

    l->number += !l->within;
    for (; l->at < l->end && *l->at != '\n'; before = *l->at++) {
        const char c = *l->at == '\r' || *l->at == '\0' ? ' ' : *l->at;

        if (!quoted && !said && !l->tabs && (before == ' ' || before == '\t'))
            quoted = find_closing_quote(l->at, l->end);
        if (!quoted && !said && l->divider && c == l->divider)
            break;
        said |= !quoted && comment && c == comment;
        if (quoted == l->at)
            quoted = NULL;
        if (said)
            continue;
        fits &= n < sizeof l->text - 1;
        if (fits)
            l->text[n++] = c;
    }
    while (n > 0 && (l->text[n - 1] == ' ' || l->text[n - 1] == '\t'))
        n--;
    l->within = l->at < l->end && *l->at != '\n';
    l->at += l->at < l->end;
    l->text[n] = '\0';
    return fits;
}

/* Splits the line at each tab. Words may be empty; an empty line has no
 * words. */
static void split_at_tabs(struct lines *l)
{
    const bool said = *l->text != '\0';
    char *at = l->text;

    l->n = 0;
    while (said && l->n < LINE_WORDS) {
        char *const tab = at + strcspn(at, "\t");
        char *end = tab;
        const bool more = *tab != '\0';

        at += strspn(at, " ");
        while (end > at && end[-1] == ' ')
            end--;
        *tab = *end = '\0';
        l->word[l->n++] = at;
        if (!more)
            return;
        at = tab + 1;
    }
}

static void split_line(struct lines *l)
{
    char *at = l->text;

    l->n = 0;
    l->rest[0] = '\0';
    while (l->n < LINE_WORDS) {
        const char *quote;

        at += strspn(at, " \t");
        if (!*at)
            return;
        if (l->n == 1)
            memcpy(l->rest, at, strlen(at) + 1);
        quote = find_closing_quote(at, l->text + sizeof l->text);
        at += quote != NULL;
        l->word[l->n++] = at;
        at += quote ? (size_t)(quote - at) : strcspn(at, " \t");
        if (*at)
            *at++ = '\0';
    }
}

bool lines_read_next(struct lines *l, char comment)
{
    while (l->at < l->end) {
        if (!copy_line_without_comment(l, comment))
            return imported_report_error(l->lens, l->number,
                                         "the line is longer than %d bytes",
                                         LINE_CHARS - 1);
        if (l->tabs)
            split_at_tabs(l);
        else
            split_line(l);
        if (l->n > 0)
            return true;
    }
    return false;
}

bool lines_parse_number(const struct lines *l, int k, const char *what,
                        double *value)
{
    if (k >= l->n)
        return imported_report_error(l->lens, l->number, "%s is missing", what);
    if (!tool_parse_number(l->word[k], value))
        return imported_report_error(
            l->lens, l->number, "%s '%.40s' is not a number%s", what,
            l->word[k],
            strchr(l->word[k], ',')
                ? ": write decimals with a point, not a comma"
                : "");
    return true;
}

bool lines_first_word_is(const struct lines *l, const char *word)
{
    return strcmp(l->word[0], word) == 0;
}

bool lines_parse_curvature(const struct lines *l, int k, double *radius)
{
    if (!lines_parse_number(l, k, "curvature", radius))
        return false;
    *radius = *radius == 0 ? 0 : 1 / *radius;
    return true;
}

bool lines_parse_fields(const struct lines *l, double *most)
{
    double value;

    for (int k = 1; k < l->n; k++) {
        if (!lines_parse_number(l, k, "field", &value))
            return false;
        *most = fmax(*most, fabs(value));
    }
    return true;
}

bool lines_reject_mirror(const struct lines *l)
{
    return imported_report_error(l->lens, l->number,
                                 "mirrors are not supported");
}
