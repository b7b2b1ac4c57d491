/* SPDX-License-Identifier: MIT */
#include "import/lines.h"

#include <string.h>

#include "options/tool.h"

void lines_begin(struct lines *l, const char *text, size_t bytes)
{
    *l = (struct lines){.at = text, .end = text + bytes};
}

/* Copies one line to TEXT; what is too long is cut off. */
static void copy_line(struct lines *l, char comment)
{
    size_t n = 0;
    bool said = false, quoted = false;

    l->number += !l->within;
    for (; l->at < l->end && *l->at != '\n'; l->at++) {
        quoted ^= *l->at == '"' || *l->at == '\'';
        if (l->divider && *l->at == l->divider && !said && !quoted)
            break;
        said |= comment && *l->at == comment;
        if (!said && n < sizeof l->text - 1)
            l->text[n++] = *l->at == '\r' || *l->at == '\0' ? ' ' : *l->at;
    }
    while (n > 0 && (l->text[n - 1] == ' ' || l->text[n - 1] == '\t'))
        n--;
    l->within = l->at < l->end && *l->at != '\n';
    l->at += l->at < l->end;
    l->text[n] = '\0';
}

static void divide(struct lines *l)
{
    char *at = l->text;

    l->n = 0;
    l->rest[0] = '\0';
    while (l->n < LINE_WORDS) {
        char quote;

        at += strspn(at, " \t");
        if (!*at)
            return;
        if (l->n == 1)
            memcpy(l->rest, at, strlen(at) + 1);
        quote = *at == '"' || *at == '\'' ? *at++ : '\0';
        l->word[l->n++] = at;
        at +=
            quote ? strcspn(at, quote == '"' ? "\"" : "'") : strcspn(at, " \t");
        if (*at)
            *at++ = '\0';
    }
}

bool lines_next(struct lines *l, char comment)
{
    while (l->at < l->end) {
        copy_line(l, comment);
        divide(l);
        if (l->n > 0)
            return true;
    }
    return false;
}

bool lines_number(struct imported *lens, const struct lines *l, int k,
                  const char *what, double *value)
{
    if (k >= l->n)
        return imported_fail(lens, l->number, "%s is missing", what);
    if (!tool_number(l->word[k], value))
        return imported_fail(lens, l->number, "%s '%.40s' is not a number",
                             what, l->word[k]);
    return true;
}

bool lines_is(const struct lines *l, const char *word)
{
    return strcmp(l->word[0], word) == 0;
}
