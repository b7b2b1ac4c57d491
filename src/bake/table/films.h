/* SPDX-License-Identifier: MIT
 *
 * Reads films of a lens table: words "none", "NM" and "NM/INDEX". */
#ifndef GLINT_BAKE_TABLE_FILMS_H
#define GLINT_BAKE_TABLE_FILMS_H

#include "bake/table/text.h"
#include "glint/prescription.h"

#define GLINT_MGF2_INDEX 1.38

extern const struct glint_text_range glint_film_index_range;

/* Reads WORD, "none" or "NM", as a film with the index of magnesium fluoride.
 * If it returns false the error is written. */
bool glint_film_of(const struct glint_text *text, const struct glint_word *word,
                   struct glint_film *film);

/* Reads films from the rest of the line, at least one word, to its end. If it
 * returns false the error is written. */
bool glint_films_read(struct glint_text *text,
                      struct glint_film films[GLINT_MAX_FILMS], int *n);

#endif
