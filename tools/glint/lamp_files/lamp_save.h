/* SPDX-License-Identifier: MIT
 *
 * lamp_save.h - saves the lamps of a run as a list for --lights.
 *
 *     lamp_save_open(&save, "lamps.csv", &error);
 *     lamp_save_write_row(&save, &row);  each lamp of a frame
 *     lamp_save_finish(&save, &error);   or lamp_save_abort
 *
 * Numbers are written with all digits, so that reading restores them exactly.
 * The file appears only when it is complete.
 */
#ifndef GLINT_TOOLS_LAMP_FILES_LAMP_SAVE_H
#define GLINT_TOOLS_LAMP_FILES_LAMP_SAVE_H

#include "lamp_files/lamp_list.h"
#include "posix/output.h"

struct lamp_save {
    bool is_open;
    struct glint_output out;
    enum glint_status status; /* first write error so far, or GLINT_OK */
    struct glint_error error;
};

enum glint_status lamp_save_open(struct lamp_save *save, const char *path,
                                 struct glint_error *error);

/* Writes ROW. Skips lamps that are more than a million pixels away, because
 * lists do not accept them. lamp_save_finish() reports errors. */
void lamp_save_write_row(struct lamp_save *save, const struct lamp_row *row);

/* Completes the list and renames the file to its path, or returns the first
 * write error. Does nothing if SAVE is closed. */
enum glint_status lamp_save_finish(struct lamp_save *save,
                                   struct glint_error *error);
void lamp_save_abort(struct lamp_save *save);

#endif
