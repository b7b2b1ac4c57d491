/* SPDX-License-Identifier: MIT
 *
 * Where the lamps of a frame come from: a list in a file, or the picture.
 */
#ifndef GLINT_TOOLS_LAMPS_H
#define GLINT_TOOLS_LAMPS_H

#include "glint/glint.h"

enum { LAMP_LIST_MAX_ROWS = 1 << 20, LAMP_FINDER_MAX = 1024 };

/* One line of a list. X and Y are pixels from the top left corner, also outside
 * of the picture. */
struct lamp_row {
    int frame; /* -1: every frame */
    double x, y, power, rgb[3], size;
};

struct lamp_list {
    struct lamp_row *row;
    int n;
};

/* Reads PATH: CSV "frame,x,y,power[,r,g,b[,size]]" with an optional line of
 * names, or JSON lines with these keys; frame "*" or absent is every frame. At
 * most LAMP_LIST_MAX_ROWS rows.
 * ERROR names file, line and cause. */
enum glint_status lamp_list_read(struct lamp_list *list, const char *path,
                                 struct glint_error *error);
void lamp_list_free(struct lamp_list *list);

/* The lamps of frame FRAME, at most MAX; returns how many. */
int lamp_list_frame(const struct lamp_list *list, int frame,
                    const struct glint_view *view, double focal_mm,
                    struct glint_lamp *lamps, int max);

/* Finds lamps in pictures of one size. */
struct lamp_finder {
    struct glint_lights_config cfg;
    struct glint_lights *lights;
    void *mem;
    double headroom_ev; /* how far over white clipped pixels really are */
    int max;            /* lamps a frame, 1 .. LAMP_FINDER_MAX */
};

/* CFG's thresholds 0: the defaults. */
enum glint_status lamp_finder_open(struct lamp_finder *finder,
                                   const struct glint_lights_config *cfg);
void lamp_finder_close(struct lamp_finder *finder);

int lamp_finder_frame(struct lamp_finder *finder,
                      const struct glint_image *image,
                      const struct glint_view *view, double focal_mm,
                      struct glint_lamp *lamps);

#endif
