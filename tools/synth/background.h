/* SPDX-License-Identifier: MIT
 *
 * background.h - the pictures that flares are put on.
 *
 *     synth_backgrounds_open(&tool, &list, words, n);   folders and files
 *     synth_background_load(&part, &list, &item, &ev, &error);
 */
#ifndef GLINT_TOOLS_SYNTH_BACKGROUND_H
#define GLINT_TOOLS_SYNTH_BACKGROUND_H

#include "glint/image.h"
#include "options/tool.h"
#include "synth/item.h"

struct synth_backgrounds {
    int n;
    char **path; /* [n], by the names behind the last slash */
};

/* Lists the pictures of WORDS[N], files, or folders whose pictures are told by
 * their endings, sorted by name. Returns an exit code: names have to differ. */
int synth_backgrounds_open(const struct tool *tool,
                           struct synth_backgrounds *list, char **words, int n);
void synth_backgrounds_close(struct synth_backgrounds *list);

/* Returns the name of PATH behind its last slash. */
const char *synth_background_name(const char *path);

/* Sets KEY to that of the bytes of the file PATH. */
enum glint_status synth_background_key(char key[20], const char *path,
                                       struct glint_error *error);

/* Sets RGB, [height][width][3], linear light, to the part of its background
 * that ITEM takes, and EV to the stops by which that was brought to ITEM's
 * level. GLINT_E_IO with ERROR: there is no such background, or its bytes are
 * not those of ITEM's key. Errors of glint_picture_load_float(). */
enum glint_status synth_background_load(const struct synth_backgrounds *list,
                                        const struct synth_item *item,
                                        float *rgb, double *ev,
                                        struct glint_error *error);

#endif
