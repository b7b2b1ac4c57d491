/* SPDX-License-Identifier: MIT
 *
 * Splits a long JSON text while it is read: of the object that it is, hands out
 * the value of each key that is asked for, and of arrays each element by
 * itself. Commas before a closing bracket are taken out. */
#ifndef GLINT_BAKE_MOTION_SPLIT_H
#define GLINT_BAKE_MOTION_SPLIT_H

#include "glint/scene/motion_bake.h"

/* A piece of the text. */
struct glint_split_piece {
    int key;          /* index into the keys asked for */
    const char *text; /* [bytes] */
    size_t bytes;
    long number;      /* of the element, from 0; 0 if it is none */
    int line, column; /* of its first byte, from 1 */
};

struct glint_split_key {
    const char *name;
    bool by_elements; /* it is an array */
};

/* Takes PIECE; on failure writes what is wrong to ERROR, with its place. */
typedef enum glint_status glint_split_fn(void *ctx,
                                         const struct glint_split_piece *piece,
                                         struct glint_error *error);

/* Splits what READ gives with CTX; KEY ends with a name that is NULL. What it
 * hands to TAKE, with TO, is at most 1 MiB. GLINT_E_LENS: ERROR says
 * FILE:LINE:COLUMN: cause; GLINT_E_IO, GLINT_E_MEMORY. */
enum glint_status glint_split(const char *file_name,
                              glint_recording_read_fn *read, void *ctx,
                              const struct glint_split_key *key,
                              glint_split_fn *take, void *to,
                              struct glint_error *error);

#endif
