/* SPDX-License-Identifier: MIT
 *
 * keys.h - key frames: options that change during a video, in a CSV file.
 *
 *     frame,strength,f-number,x,y,ev
 *     0,0.5,4,100,80,14
 *     50,,11,600,80,
 *     75,0,,,,
 *
 * The heading names the columns, in any order: frame; the options exposure,
 * strength, gain, starburst, f-number and zoom; turn and round, the rotation in
 * degrees and the roundness of --stop's blades; and x, y, ev, a lamp as for
 * --light-at. An empty field sets no key. Between two keys of a column values
 * are interpolated linearly; before the first key and after the last they are
 * constant.
 */
#ifndef GLINT_TOOLS_DESK_KEYS_H
#define GLINT_TOOLS_DESK_KEYS_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/status.h"

enum key_column {
    KEYS_FRAME,
    KEYS_EXPOSURE,
    KEYS_STRENGTH,
    KEYS_GAIN,
    KEYS_STARBURST,
    KEYS_F_NUMBER,
    KEYS_TURN,
    KEYS_ROUND,
    KEYS_X,
    KEYS_Y,
    KEYS_EV,
    KEYS_ZOOM, /* zoom, mm or 0 .. 1, as in model_file_set_zoom() */
    KEYS_COLUMNS
};

struct key_value {
    int frame, line; /* frame number, and line number in the file, from 1 */
    double value;
};

/* the keys of each column, sorted by frame */
struct keys {
    struct key_value *key[KEYS_COLUMNS];
    int n[KEYS_COLUMNS];
};

/* Reads PATH. On GLINT_E_IO, GLINT_E_FORMAT or GLINT_E_MEMORY, ERROR names
 * file, line and cause, and KEYS is empty. */
enum glint_status key_frames_read_file(struct keys *keys, const char *path,
                                       struct glint_error *error);

/* Parses TEXT[BYTES] as key_frames_read_file() parses a file; NAME is used in
 * errors.
 */
enum glint_status key_frames_parse_text(struct keys *keys, const char *name,
                                        const char *text, size_t bytes,
                                        struct glint_error *error);

/* Returns the index of the column NAME, or -1 if there is none. */
int key_frames_find_column(const char *name);

bool key_frames_have_column(const struct keys *keys, enum key_column column);

/* Returns the value of COLUMN at FRAME, or OTHER if COLUMN has no keys. */
double key_frames_interpolate_at(const struct keys *keys,
                                 enum key_column column, int frame,
                                 double other);

void key_frames_free(struct keys *keys);

#endif
