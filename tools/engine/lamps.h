/* SPDX-License-Identifier: MIT
 *
 * Where the lamps of a frame come from: a list in a file, or the picture.
 */
#ifndef GLINT_TOOLS_ENGINE_LAMPS_H
#define GLINT_TOOLS_ENGINE_LAMPS_H

#include <stdbool.h>

#include "glint/glint.h"

enum { LAMP_LIST_MAX_ROWS = 1 << 20, LAMP_FINDER_MAX = 1024 };

#define LAMP_MAX_POWER 1e30 /* of a lamp: still finite in every output */

/* POWER and each of POWER * RGB, which are not negative, are no more. */
bool lamp_power_ok(double power, const double rgb[3]);

/* One line of a list. X and Y are pixels from the top left corner, also outside
 * of the picture. */
struct lamp_row {
    int frame; /* -1: every frame */
    double x, y, power, rgb[3];
    double size;  /* RMS radius, pixels; 0: a point */
    double shape; /* its minor axis over the major one, */
    double turn;  /* which lies so many degrees from +x, up being 90 */
    double level; /* share of the power that a lamp coming or going has */
    uint32_t id;  /* 0: not said */
    int next;     /* the row that lamp_keys_link() found to follow, or -1 */
};

struct lamp_list {
    struct lamp_row *row;
    int n, room;
};

/* Reads PATH: CSV "frame,x,y,power[,r,g,b[,size]]" with an optional line of
 * names, also with "id" as lamp_keys.h has it, or JSON lines with these keys;
 * frame "*" or absent is every frame. At most LAMP_LIST_MAX_ROWS rows. ERROR
 * names file, line and cause. */
enum glint_status lamp_list_read(struct lamp_list *list, const char *path,
                                 struct glint_error *error);

/* The same from memory. NAME is for errors. */
enum glint_status lamp_list_parse(struct lamp_list *list, const char *text,
                                  size_t bytes, const char *name,
                                  struct glint_error *error);
void lamp_list_free(struct lamp_list *list);

/* Adds a row. GLINT_E_MEMORY. */
enum glint_status lamp_list_add(struct lamp_list *list,
                                const struct lamp_row *row);

/* The lamps of frame FRAME, also those on their way to a later one where the
 * list is linked, at most MAX; returns how many. LEVEL: of each, or NULL. */
int lamp_list_frame(const struct lamp_list *list, int frame,
                    const struct glint_view *view, double focal_mm,
                    struct glint_lamp *lamps, double *level, int max);

/* Finds lamps in pictures of one size, and follows them where these are a
 * video. What it needs is taken by open. */
struct lamp_finder {
    double headroom_ev; /* how far over white clipped pixels really are; below
                           0: as the profile of each lamp has it */
    int max;            /* lamps a picture, 1 .. LAMP_FINDER_MAX */

    /* Of the last frame, as found, the strongest first; untracked ones are
     * numbered from 1. */
    struct glint_lamp_track *track;
    int n_tracks;

    /* Private. */
    struct glint_lamp_finder *lights;
    struct glint_lamp_tracker *tracks;
    struct glint_profile *profile;
    double scale;            /* of the power of tracks */
    struct glint_spot *spot; /* [LAMP_FINDER_MAX] */
    int max_tracks;
    void *mem;
};

/* Sets headroom_ev and max before. CFG says what a light is; keep_faint is the
 * finder's own. */
enum glint_status lamp_finder_open(struct lamp_finder *finder,
                                   const struct glint_lamp_finder_config *cfg);
void lamp_finder_close(struct lamp_finder *finder);

/* Writes the lamps of IMAGE, which comes ELAPSED_US after the one before:
 * rising and fading as glint/lamp_tracker.h has it, so a few more than max may
 * be there for a while. 0: a picture by itself. LAMPS has room for
 * LAMP_FINDER_MAX. */
int lamp_finder_frame(struct lamp_finder *finder,
                      const struct glint_image *image, int32_t elapsed_us,
                      const struct glint_view *view, double focal_mm,
                      struct glint_lamp *lamps);

/* The next frame has nothing to do with the last: another camera, a jump. */
void lamp_finder_restart(struct lamp_finder *finder);

#endif
