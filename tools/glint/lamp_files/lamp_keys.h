/* SPDX-License-Identifier: MIT
 *
 * lamp_keys.h - lists of lamps with ids, and interpolation of lamps between key
 * frames.
 *
 * A heading that contains "id" names the columns of a CSV in any order:
 * frame,id,x,y,power. An id is any text without commas. Without ids, lamps are
 * identified by their order within a frame. Columns "shape" (minor / major
 * axis), "turn" (degrees of the major axis) and "level" (fraction of the power
 * of a lamp that fades in or out) are 1, 0 and 1 if missing; "seen" (pixels,
 * see struct lamp_row) is 0.
 *
 * With interpolation a lamp exists from its first frame to its last. Between
 * rows the power changes by equal stops per frame, or linearly if one of the
 * two is 0; all other values change linearly.
 */
#ifndef GLINT_TOOLS_LAMP_FILES_LAMP_KEYS_H
#define GLINT_TOOLS_LAMP_FILES_LAMP_KEYS_H

#include <stdbool.h>
#include <stdint.h>

#include "lamp_files/lamp_list.h"

/* Returns a nonzero number for the id TEXT. A 32-bit number is returned
 * unchanged, so that a saved list has the ids of its source; any other text
 * becomes a hash of at least LAMP_ID_TEXT. */
#define LAMP_ID_TEXT (UINT32_C(1) << 31)
uint32_t lamp_hash_id(const char *text);

/* Links the rows of each lamp, sorted by frame, through their member NEXT.
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status lamp_keys_link_rows(struct lamp_list *list);

/* Sets ROW to the lamp of row I at FRAME. Returns false if the lamp is not
 * there: row I is neither for FRAME nor for every frame, and FRAME is not
 * between row I and the lamp's next row. */
bool lamp_keys_interpolate_at(const struct lamp_list *list, int i, int frame,
                              struct lamp_row *row);

/* Returns whether FRAME is the first one after a cut: FRAME and the previous
 * frame both have lamps with ids, but no id in common. Compares at most
 * GLINT_ENGINE_MAX_LAMPS lamps of each frame. */
bool lamp_keys_is_cut(const struct lamp_list *list, int frame);

#endif
