/* SPDX-License-Identifier: MIT
 *
 * lamp_save.h - the lamps of a run as a list that --lights takes.
 *
 *     lamp_save_open(&save, "lamps.csv", &error);
 *     lamp_save_row(&save, &row);                       each lamp of a frame
 *     lamp_save_finish(&save, &error);                  or lamp_save_abort
 *
 * Numbers are written with all digits, so that they read back the same. The
 * file appears whole or not at all.
 */
#ifndef GLINT_TOOLS_LAMP_FILES_LAMP_SAVE_H
#define GLINT_TOOLS_LAMP_FILES_LAMP_SAVE_H

#include "lamp_files/lamp_list.h"
#include "posix/output.h"

struct lamp_save {
    bool is_open;
    struct glint_output out;
    enum glint_status status; /* first failure of writing, else GLINT_OK */
    struct glint_error error;
};

enum glint_status lamp_save_open(struct lamp_save *save, const char *path,
                                 struct glint_error *error);

/* Writes ROW, unless it is more than a million pixels away, which lists do not
 * take. lamp_save_finish() reports failures. */
void lamp_save_row(struct lamp_save *save, const struct lamp_row *row);

/* Ends the list and puts the file in place, or returns the first failure of
 * writing. Does nothing if SAVE is closed. */
enum glint_status lamp_save_finish(struct lamp_save *save,
                                   struct glint_error *error);
void lamp_save_abort(struct lamp_save *save);

#endif
