/* SPDX-License-Identifier: MIT
 *
 * lamp_save.h - the lamps of a run as a list that --lights takes.
 *
 *     lamp_save_open(&save, "lamps.csv", &error);
 *     lamp_save_row(&save, frame, &row);                each lamp of a frame
 *     lamp_save_finish(&save, &error);                  or lamp_save_abort
 *
 * Numbers are written so that they are read as the same. The file is whole or
 * not there.
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

/* What fails is reported by finish. Lamps beyond what a list takes, a million
 * pixels away, are left out. */
void lamp_save_row(struct lamp_save *save, const struct lamp_row *row);

/* Does nothing when closed. */
enum glint_status lamp_save_finish(struct lamp_save *save,
                                   struct glint_error *error);
void lamp_save_abort(struct lamp_save *save);

#endif
