/* SPDX-License-Identifier: MIT
 *
 * keys.h - options that change over a video, by key frames in a CSV.
 *
 *     frame,strength,f-number,x,y,ev
 *     0,0.5,4,100,80,14
 *     50,,11,600,80,
 *     75,0,,,,
 *
 * The heading names the columns, in any order: frame; exposure, strength, gain,
 * starburst, f-number and zoom as the options of these names accept them; turn
 * and round: the rotation in degrees and the curvature of --stop's blades, and
 * x, y, ev: a lamp as of --light-at. An empty field is no key. Between two keys
 * of a column values change evenly; before the first and after the last they
 * stay.
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
    KEYS_ZOOM, /* as model_file_zoom() */
    KEYS_COLUMNS
};

struct key_value {
    int frame, line; /* line of the file, from 1 */
    double value;
};

/* The keys of each column, with rising frames. */
struct keys {
    struct key_value *key[KEYS_COLUMNS];
    int n[KEYS_COLUMNS];
};

/* Reads PATH. ERROR names file, line and cause. GLINT_E_IO, GLINT_E_FORMAT,
 * GLINT_E_MEMORY: KEYS is empty. */
enum glint_status keys_read(struct keys *keys, const char *path,
                            struct glint_error *error);

/* Does as keys_read() with TEXT[BYTES]; NAME is for errors. */
enum glint_status keys_parse(struct keys *keys, const char *name,
                             const char *text, size_t bytes,
                             struct glint_error *error);

/* Returns the column NAME; -1: there is none. */
int keys_column(const char *name);

/* Returns whether COLUMN has keys. */
bool keys_has(const struct keys *keys, enum key_column column);

/* Returns COLUMN at FRAME, or OTHER if it has no keys. */
double keys_at(const struct keys *keys, enum key_column column, int frame,
               double other);

void keys_free(struct keys *keys);

#endif
