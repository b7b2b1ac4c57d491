/* SPDX-License-Identifier: MIT
 *
 * ghost_sheet.h - lists the single ghosts of a frame: in an editable file
 * (ghost_file.h), and as a contact sheet of images.
 */
#ifndef GLINT_TOOLS_DESK_GHOST_SHEET_H
#define GLINT_TOOLS_DESK_GHOST_SHEET_H

#include "glint/explain.h"

/* The ghosts of a frame in the order of the list, and the image over which the
 * ghosts are drawn. */
struct ghost_list {
    struct glint_explain *explain;
    const char *lens;
    /* indices of ghosts, [explain->n_ghosts], in the order of the list */
    const int *ghosts;
    int top; /* max ghosts on a sheet */
    const struct glint_image *picture;
};

/* Writes to PATH all ghosts that are drawn or muted, each with its fraction
 * of the total light. Errors: GLINT_E_OUTPUT, GLINT_E_CLOSED. */
enum glint_status ghost_list_write_file(const struct ghost_list *list,
                                        const char *path,
                                        struct glint_error *error);

/* Saves to PATH a contact sheet of the first drawn ghosts, each over the
 * dimmed image and exposed to be visible. Errors: GLINT_E_MEMORY,
 * GLINT_E_OUTPUT. */
enum glint_status ghost_list_save_sheet(const struct ghost_list *list,
                                        const char *path,
                                        struct glint_error *error);

#endif
