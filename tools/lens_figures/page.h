/* SPDX-License-Identifier: MIT
 *
 * page.h - a page of lenses, each on a card: what it is, its section, its
 * flares. Where the browser runs scripts it finds by words and sorts.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_PAGE_H
#define GLINT_TOOLS_LENS_FIGURES_PAGE_H

#include <stdio.h>

#include "glint/bake.h"

struct page_card {
    const char *name;
    const struct glint_prescription *lens;
    double focal_mm;
    double squeeze;    /* of an anamorphic lens; else 1 */
    double corner_deg; /* off the axis, at a corner of the film */
    int n_ghosts;
};

void page_begin(FILE *file);

/* Writes the card's upper part. What is written to FILE next, as paragraphs,
 * stands below the section. */
void page_card_begin(FILE *file, const struct page_card *card);

void page_card_end(FILE *file);

void page_end(FILE *file);

#endif
