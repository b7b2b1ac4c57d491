/* SPDX-License-Identifier: MIT
 *
 * Finds the word that a mistyped one of a text may have meant. */
#ifndef GLINT_BAKE_SCENE_NEAR_H
#define GLINT_BAKE_SCENE_NEAR_H

#include <stddef.h>

#include "bake/table/text.h"

enum { GLINT_NEAR_CHARS = 32 };

struct glint_near {
    struct glint_word word;
    const char *best; /* nearest candidate so far, or NULL */
    int distance;
};

/* Begins with WORD; offers CANDIDATE, which outlives NEAR. */
struct glint_near glint_near_begin(struct glint_word word);
void glint_near_offer(struct glint_near *near, const char *candidate);

/* Writes "; did you mean 'BEST'?" to TEXT, or nothing if no candidate is near:
 * at most a third of its letters are inserted, left out or changed. */
#define GLINT_NEAR_BYTES 64
const char *glint_near_text(const struct glint_near *near,
                            char text[GLINT_NEAR_BYTES]);

#endif
