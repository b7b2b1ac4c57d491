/* SPDX-License-Identifier: MIT */
#include "options/suggest.h"

#include <stdio.h>
#include <string.h>

static int min_of_three(int a, int b, int c)
{
    const int ab = a < b ? a : b;

    return ab < c ? ab : c;
}

/* Returns the edit distance from A to B: the min number of characters to
 * insert, remove, change, or swap with the next one. Returns SUGGEST_CHARS if A
 * or B has SUGGEST_CHARS characters or more. */
static int compute_edit_distance(const char *a, const char *b)
{
    const int n = (int)strlen(a), m = (int)strlen(b);
    int rows[3][SUGGEST_CHARS]; /* rows i - 2, i - 1 and i of the matrix of edit
                                 * distances */

    if (n >= SUGGEST_CHARS || m >= SUGGEST_CHARS)
        return SUGGEST_CHARS;
    for (int k = 0; k <= m; k++)
        rows[0][k] = k;
    for (int i = 1; i <= n; i++) {
        const int *before = rows[(i + 1) % 3], *last = rows[(i - 1) % 3];
        int *row = rows[i % 3];

        row[0] = i;
        for (int k = 1; k <= m; k++) {
            row[k] = min_of_three(last[k] + 1, row[k - 1] + 1,
                                  last[k - 1] + (a[i - 1] != b[k - 1]));
            if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
                row[k] = min_of_three(row[k], before[k - 2] + 1, row[k]);
        }
    }
    return rows[n % 3][m];
}

void suggest_begin(struct suggest *s, const char *word)
{
    *s = (struct suggest){.word = word, .distance = SUGGEST_CHARS};
}

void suggest_add_candidate(struct suggest *s, const char *candidate, size_t n)
{
    char text[SUGGEST_CHARS];
    int distance;

    if (n == 0 || n >= sizeof text)
        return;
    memcpy(text, candidate, n);
    text[n] = '\0';
    distance = compute_edit_distance(s->word, text);
    if (distance > 1 && strlen(s->word) >= 3 && strstr(text, s->word))
        distance = 1;
    if (distance >= s->distance)
        return;
    s->distance = distance;
    memcpy(s->best, text, n + 1);
}

const char *suggest_find_best(const struct suggest *s)
{
    const int allowed = (int)strlen(s->best) / 3;

    return s->distance <= (allowed > 1 ? allowed : 1) ? s->best : NULL;
}

const char *suggest_from_words(struct suggest *s)
{
    if (!suggest_find_best(s))
        return "";
    snprintf(s->words, sizeof s->words, "; did you mean '%s'?", s->best);
    return s->words;
}
