/* SPDX-License-Identifier: MIT */
#include "bake/scene/near.h"

#include <stdio.h>
#include <string.h>

static int least(int a, int b, int c)
{
    const int ab = a < b ? a : b;

    return ab < c ? ab : c;
}

/* Returns how many letters have to be inserted, left out or changed to get from
 * WORD to CANDIDATE; GLINT_NEAR_CHARS if either has that many. */
static int distance(const struct glint_word *word, const char *candidate)
{
    const int m = (int)strlen(candidate);
    int row[GLINT_NEAR_CHARS];

    if (word->length >= GLINT_NEAR_CHARS || m >= GLINT_NEAR_CHARS)
        return GLINT_NEAR_CHARS;
    for (int k = 0; k <= m; k++)
        row[k] = k;
    for (int i = 1; i <= word->length; i++) {
        int corner = row[0]; /* of the row before, one letter back */

        row[0] = i;
        for (int k = 1; k <= m; k++) {
            const int above = row[k];

            row[k] = least(above + 1, row[k - 1] + 1,
                           corner + (word->start[i - 1] != candidate[k - 1]));
            corner = above;
        }
    }
    return row[m];
}

struct glint_near glint_near_begin(struct glint_word word)
{
    return (struct glint_near){word, NULL, GLINT_NEAR_CHARS};
}

void glint_near_offer(struct glint_near *near, const char *candidate)
{
    const int d = distance(&near->word, candidate);
    const int most = (int)strlen(candidate) / 3;

    if (d < near->distance && d <= (most > 1 ? most : 1)) {
        near->distance = d;
        near->best = candidate;
    }
}

const char *glint_near_text(const struct glint_near *near,
                            char text[GLINT_NEAR_BYTES])
{
    text[0] = '\0';
    if (near->best)
        snprintf(text, GLINT_NEAR_BYTES, "; did you mean '%s'?", near->best);
    return text;
}
