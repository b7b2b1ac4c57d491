/* SPDX-License-Identifier: MIT
 *
 * lamp_keys.h - lists of lamps with names, and lamps between key frames.
 *
 * A heading that has "id" among its names gives the columns of a CSV in any
 * order: frame,id,x,y,power. An id is any text without commas. Without, lamps
 * are told apart by the order in which they stand within their frame. Columns
 * "shape" (minor over major axis), "turn" (degrees of that) and "level" (share
 * of the power that a lamp coming or going has) are 1, 0 and 1 where not said.
 *
 * Interpolated, a lamp is there from the first frame it stands in to the last:
 * x, y, size and colour go evenly from one row to its next, power by equal
 * stops, or evenly where one of both is 0.
 */
#ifndef GLINT_TOOLS_LAMP_FILES_LAMP_KEYS_H
#define GLINT_TOOLS_LAMP_FILES_LAMP_KEYS_H

#include <stdbool.h>
#include <stdint.h>

#include "lamp_files/lamp_list.h"

/* The fields "id" and, only by a heading, "shape", "turn" and "level". */
enum { LAMP_ID = 8, LAMP_SHAPE, LAMP_TURN, LAMP_LEVEL, LAMP_COLUMNS };

/* The field of each column; N 0: no heading said. */
struct lamp_columns {
    int n, field[LAMP_COLUMNS];
};

/* Reads HEADING, if it has an id. NULL, or what is wrong with it. */
const char *lamp_columns_read(struct lamp_columns *columns,
                              const char *heading);

/* Reads a row, which is changed, into the fields V, which hold defaults.
 * NULL, or what is wrong with it; values are not looked at. */
const char *lamp_columns_row(const struct lamp_columns *columns, char *row,
                             double *v);

/* A number for an id, not 0: one of 32 bits is itself, so that a list that was
 * saved has the ids of its source; other texts become one from LAMP_ID_TEXT. */
#define LAMP_ID_TEXT (UINT32_C(1) << 31)
uint32_t lamp_id_of(const char *text);

/* Links the rows of each lamp in order of frames. GLINT_E_MEMORY. */
enum glint_status lamp_keys_link(struct lamp_list *list);

/* Row I at FRAME, on its way to the next of the same lamp. False: it is not
 * there. */
bool lamp_keys_at(const struct lamp_list *list, int i, int frame,
                  struct lamp_row *row);

/* The ids of FRAME's lamps, in the order of lamp_list_frame. Lamps without one
 * get numbers above those of the list, by their places. */
void lamp_keys_ids(const struct lamp_list *list, int frame, uint32_t *id);

/* Whether FRAME has lamps with ids of which the one before, which has, too,
 * knows none: as after a cut. Of a thousand each it looks at no more. */
bool lamp_keys_is_cut(const struct lamp_list *list, int frame);

#endif
