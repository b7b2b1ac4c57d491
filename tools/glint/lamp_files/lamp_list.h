/* SPDX-License-Identifier: MIT
 *
 * lamp_list.h - reads lists of lamps per frame from files. */
#ifndef GLINT_TOOLS_LAMP_FILES_LAMP_LIST_H
#define GLINT_TOOLS_LAMP_FILES_LAMP_LIST_H

#include <stdbool.h>

#include "glint/glint.h"

enum { LAMP_LIST_MAX_ROWS = 1 << 20 };

/* One line of a list. X and Y are pixels from the top left corner; they may
 * be off-screen. */
struct lamp_row {
    int frame; /* frame number; -1: every frame */
    double x, y, power, rgb[3];
    double size;  /* RMS radius, pixels; 0: a point */
    double shape; /* (minor axis) / (major axis), 0 .. 1 */
    double turn;  /* direction of the major axis, degrees from +x; 90 is up */
    /* fraction of the power that a lamp has while it fades in or out, else 1 */
    double level;
    /* RMS radius of the lamp with its glare, pixels, in an image in which the
     * lamp is clipped; 0: not clipped */
    double seen;
    uint32_t id; /* id of the lamp; 0: none */
    /* index of the lamp's next row, set by lamp_keys_link_rows(); -1: none */
    int next;
};

struct lamp_list {
    struct lamp_row *row;
    int n;
};

/* Reads PATH: CSV "frame,x,y,power[,r,g,b[,size]]" with an optional heading,
 * which may contain "id" (see lamp_keys.h), or JSON lines with these keys. A
 * frame that is "*" or missing means every frame. Reads at most
 * LAMP_LIST_MAX_ROWS rows. ERROR names file, line and cause. */
enum glint_status lamp_list_read(struct lamp_list *list, const char *path,
                                 struct glint_error *error);

/* Parses TEXT[BYTES] like lamp_list_read(); NAME is the file's name in errors.
 */
enum glint_status lamp_list_parse(struct lamp_list *list, const char *text,
                                  size_t bytes, const char *name,
                                  struct glint_error *error);
void lamp_list_free(struct lamp_list *list);

/* Appends ROW to LIST. Returns GLINT_E_MEMORY on failure. */
enum glint_status lamp_list_add(struct lamp_list *list,
                                const struct lamp_row *row);

/* Sets LAMPS to the lamps of FRAME, at most MAX. In a list with linked rows,
 * lamps between two rows are interpolated. Returns the number of lamps. A lamp
 * without an id gets an id from its index in LAMPS. This id exceeds all ids
 * below LAMP_ID_TEXT in the list. */
int lamp_list_get_frame(const struct lamp_list *list, int frame,
                        const struct glint_view *view, double focal_mm,
                        struct glint_engine_lamp *lamps, int max);

#endif
