/* SPDX-License-Identifier: MIT
 *
 * page.h - writes an HTML page of lenses with one card each: data, section and
 * flares. If scripts are enabled, the page can search and sort.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_PAGE_H
#define GLINT_TOOLS_LENS_FIGURES_PAGE_H

#include "model/settings.h"

/* Row of a lens in figures.md, a file in the folder of lens tables */
struct measured {
    char f_number[24]; /* f-number of the bake */
    char seconds[24];  /* processor time of the bake; "over N" if it was
                          aborted */
    char kb[24];       /* size of the model; "" if there is none */
    char ms[24];       /* processor time of a 1080p frame; "" if there is no
                          model */
};

struct page_card {
    const char *name;
    const struct glint_prescription *lens;
    double focal_mm;
    double squeeze;    /* squeeze of an anamorphic lens, else 1 */
    double corner_deg; /* angle off the axis at a corner of the film */
    int n_ghosts;
};

/* Reads the row of lens NAME; without one, f_number is "". Returns
 * GLINT_E_MEMORY if there is no memory to read the file. */
enum glint_status page_read_measured_times(const char *name,
                                           struct measured *measured);

/* Writes to FILE three <img>: flares of a lamp at 0.25, 0.5 and 0.8 of the
 * distance from the centre to a corner of the film. SETTINGS must be the
 * defaults. NAME is the lens, whose rays are traced exactly if no model is
 * cached. Sets *MODEL_BYTES to the size of the model, or 0. Returns an exit
 * code, after printing the reason on failure. */
int page_write_thumbnails(const struct tool *tool,
                          const struct settings *settings, const char *name,
                          FILE *file, size_t *model_bytes);

void page_write_head(FILE *file);

/* Writes the upper part of a card. Text that the caller then writes to FILE
 * appears below the section. */
void page_begin_card(FILE *file, const struct page_card *card);

void page_end_card(FILE *file);

void page_write_end(FILE *file);

#endif
