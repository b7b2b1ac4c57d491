/* SPDX-License-Identifier: MIT
 *
 * measured.h - what lenses of the library cost, as library-table measured it.
 */
#ifndef GLINT_TOOLS_LENS_FIGURES_MEASURED_H
#define GLINT_TOOLS_LENS_FIGURES_MEASURED_H

#include <stdbool.h>

/* Cells of a row of figures.md, which lies beside the tables. */
struct measured {
    char f_number[24]; /* that the lens was baked for */
    char seconds[24];  /* of a processor; "over N" of a bake given up */
    char kb[24];       /* of the model; "" without one */
    char ms[24];       /* of a processor, a frame of 1080p; "" without */
};

/* Reads the figures of lens NAME. Returns false if none were measured. */
bool measured_find(const char *name, struct measured *measured);

#endif
