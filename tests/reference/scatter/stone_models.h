/* SPDX-License-Identifier: MIT
 *
 * stone_models: models of scattering side by side,
 * as a page with pictures, a table and curves.
 */
#ifndef REFERENCE_SCATTER_STONE_MODELS_H
#define REFERENCE_SCATTER_STONE_MODELS_H

#include "reference/scatter/translucent_report.h"
#include "options/tool.h"

enum { STONE_MODELS = 17 };

struct stone_model {
    const char *words; /* for people */
    const char *file;  /* name of its picture */
    int series;        /* models of one kind, more and more terms */
    struct glint_scatter_candidate asked;
    struct glint_scatter_judgement judged;
};

struct stone_models {
    const char *name;
    int side, kernel;
    double *light; /* [side * side][3] what the full rows show */
    double peak;   /* the largest of it */
    double worst;  /* the largest error of a texel of any model */
    struct stone_model model[STONE_MODELS];
};

/* Judges all models of ROWS, shows progress, and writes report.html, report.md,
 * curves.svg and a PNG for each model to FOLDER, which it makes. Returns an
 * exit code. */
int stone_models_report(const struct tool *tool, const char *name,
                        struct glint_scatter_rows *rows, const char *folder);

/* stone_page.c: write the files but for the pictures. */
void stone_page_html(const struct stone_models *m, FILE *file);
void stone_page_md(const struct stone_models *m, FILE *file);
void stone_page_svg(const struct stone_models *m, FILE *file);

#endif
