/* SPDX-License-Identifier: MIT
 *
 * lamp_list.h - lists of lamps in files, by frame.
 */
#ifndef GLINT_TOOLS_LAMP_FILES_LAMP_LIST_H
#define GLINT_TOOLS_LAMP_FILES_LAMP_LIST_H

#include <stdbool.h>

#include "glint/glint.h"

enum { LAMP_LIST_MAX_ROWS = 1 << 20 };

#define LAMP_MAX_POWER 1e30 /* Such a lamp is finite in all outputs. */

/* Returns whether POWER is 0 .. LAMP_MAX_POWER, and RGB and POWER * RGB are at
 * most that. */
bool lamp_power_ok(double power, const double rgb[3]);

/* One line of a list. X and Y are pixels from the top left corner, also
 * outside the picture. */
struct lamp_row {
    int frame; /* -1: every frame */
    double x, y, power, rgb[3];
    double size;  /* RMS radius, pixels; 0: a point */
    double shape; /* minor axis of the lamp over its major one, 0 .. 1 */
    double turn;  /* degrees of the major axis from +x; 90 is up */
    double level; /* fraction of the power that a lamp coming or going has */
    double seen;  /* pixels: RMS radius of the lamp and of the light around it,
                     in a picture that clips it; 0: not clipped */
    uint32_t id;  /* 0: none */
    int next;     /* index of the lamp's next row, by lamp_keys_link(), or -1 */
};

struct lamp_list {
    struct lamp_row *row;
    int n;
};

/* Reads PATH: CSV "frame,x,y,power[,r,g,b[,size]]" with an optional line of
 * names, also with "id" as lamp_keys.h has it, or JSON lines with these keys;
 * frame "*" or absent is every frame. At most LAMP_LIST_MAX_ROWS rows. ERROR
 * names file, line and cause. */
enum glint_status lamp_list_read(struct lamp_list *list, const char *path,
                                 struct glint_error *error);

/* Reads TEXT[BYTES] as lamp_list_read() reads a file. NAME is for errors. */
enum glint_status lamp_list_parse(struct lamp_list *list, const char *text,
                                  size_t bytes, const char *name,
                                  struct glint_error *error);
void lamp_list_free(struct lamp_list *list);

/* Appends ROW to LIST. GLINT_E_MEMORY. */
enum glint_status lamp_list_add(struct lamp_list *list,
                                const struct lamp_row *row);

/* Sets LAMPS to the lamps of FRAME, at most MAX; if the list is linked, also to
 * those that move from an earlier row to a later one. Returns how many. Lamps
 * without an id get numbers above all ids of the list that are below
 * LAMP_ID_TEXT, by their places. */
int lamp_list_frame(const struct lamp_list *list, int frame,
                    const struct glint_view *view, double focal_mm,
                    struct glint_engine_lamp *lamps, int max);

#endif
