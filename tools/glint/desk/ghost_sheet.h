/* SPDX-License-Identifier: MIT
 *
 * ghost_sheet.h - the ghosts of a frame one by one: as a file for
 * ghost_file.h to begin from, and as a contact sheet to choose by.
 */
#ifndef GLINT_TOOLS_DESK_GHOST_SHEET_H
#define GLINT_TOOLS_DESK_GHOST_SHEET_H

#include "glint/explain.h"

/* The ghosts of a frame in the order to be listed in, and the picture under
 * them. */
struct ghost_list {
    struct glint_explain *explain;
    const char *lens;
    const int *ghosts; /* [explain->n_ghosts] */
    int top;           /* most ghosts on a sheet */
    const struct glint_image *picture;
};

/* Writes to PATH all ghosts that are drawn or muted, with their fraction of the
 * light. GLINT_E_OUTPUT, GLINT_E_CLOSED. */
enum glint_status ghost_list_write(const struct ghost_list *list,
                                   const char *path, struct glint_error *error);

/* Saves to PATH a sheet of the first ghosts that are drawn, each exposed so
 * that it shows, over the picture, dimmed. GLINT_E_MEMORY, GLINT_E_OUTPUT. */
enum glint_status ghost_list_sheet(const struct ghost_list *list,
                                   const char *path, struct glint_error *error);

#endif
