/* SPDX-License-Identifier: MIT
 *
 * Films of a lens table: words "none", "NM" and "NM/INDEX".
 */
#ifndef GLINT_BAKE_TABLE_FILMS_H
#define GLINT_BAKE_TABLE_FILMS_H

#include "bake/table/text.h"
#include "glint/prescription.h"

#define GLINT_MGF2_INDEX 1.38

extern const struct glint_text_range glint_film_index_range;

/* WORD as a film without its index, which is magnesium fluoride's. False: the
 * error is written. */
bool glint_film_of(const struct glint_text *text, const struct glint_word *word,
                   struct glint_film *film);

/* All words that are left of the line, one or more. */
bool glint_films_read(struct glint_text *text,
                      struct glint_film films[GLINT_MAX_FILMS], int *n);

#endif
