/* SPDX-License-Identifier: MIT
 *
 * page.h - a page of lenses, each on a card: what it is, its section, its
 * flares. Where the browser runs scripts it finds by words and sorts.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_PAGE_H
#define GLINT_TOOLS_LENS_FIGURES_PAGE_H

#include "model/settings.h"

/* Cells of a row of figures.md, which lies beside the tables. */
struct measured {
    char f_number[24]; /* that the lens was baked for */
    char seconds[24];  /* of a processor; "over N" of a bake given up */
    char kb[24];       /* of the model; "" without one */
    char ms[24];       /* of a processor, a frame of 1080p; "" without */
};

struct page_card {
    const char *name;
    const struct glint_prescription *lens;
    double focal_mm;
    double squeeze;    /* of an anamorphic lens; else 1 */
    double corner_deg; /* off the axis, at a corner of the film */
    int n_ghosts;
};

/* Reads the figures of lens NAME. Returns false if none were measured. */
bool measured_find(const char *name, struct measured *measured);

/* Writes to FILE an <img> each of the flare of a lamp at 0.25, 0.5 and 0.8 of
 * the way to the film's corner. SETTINGS are those of a run without options,
 * NAME is the lens; its model should be baked, or rays are exact. MODEL_BYTES
 * receives how large that is, 0 if there is none. Returns an exit code, after
 * printing the reason on failure. */
int thumbnails_write(const struct tool *tool, const struct settings *settings,
                     const char *name, FILE *file, size_t *model_bytes);

void page_begin(FILE *file);

/* Writes the card's upper part. What is written to FILE next, as paragraphs,
 * stands below the section. */
void page_card_begin(FILE *file, const struct page_card *card);

void page_card_end(FILE *file);

void page_end(FILE *file);

#endif
