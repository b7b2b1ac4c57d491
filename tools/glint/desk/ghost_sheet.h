/* SPDX-License-Identifier: MIT
 *
 * ghost_sheet.h - the single ghosts of a frame: as a file of ghost_file.h to
 * edit, and as a contact sheet. */
#ifndef GLINT_TOOLS_DESK_GHOST_SHEET_H
#define GLINT_TOOLS_DESK_GHOST_SHEET_H

#include "glint/explain.h"

/* The ghosts of a frame, in the order to list them, and the picture below. */
struct ghost_list {
    struct glint_explain *explain;
    const char *lens;
    const int *ghosts; /* [explain->n_ghosts] */
    int top;           /* max ghosts on a sheet */
    const struct glint_image *picture;
};

/* Writes to PATH all ghosts that are drawn or muted, with their fraction of the
 * light. Errors: GLINT_E_OUTPUT, GLINT_E_CLOSED. */
enum glint_status ghost_list_write(const struct ghost_list *list,
                                   const char *path, struct glint_error *error);

/* Saves to PATH a sheet of the first drawn ghosts, each over the dimmed picture
 * and exposed so that it is visible. Errors: GLINT_E_MEMORY, GLINT_E_OUTPUT. */
enum glint_status ghost_list_sheet(const struct ghost_list *list,
                                   const char *path, struct glint_error *error);

#endif
