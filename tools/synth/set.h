/* SPDX-License-Identifier: MIT
 *
 * set.h - the folder of a data set, which any number of processes fill, are
 * killed at, and go on with.
 *
 *     synth_set_begin(&tool, &set, settings);    the same folder, the same set
 *     if (!synth_set_has(&set, number))
 *         synth_set_put(&tool, &set, &item, &result, &drawing);
 *     synth_set_end(&tool, &set);                manifests
 *
 * Every file is written beside its place and moved there when it is whole. The
 * item's line, items/NUMBER.json, comes last. An item is there if its line and
 * all its pictures are. A manifest is all lines in their order, and is there
 * once all items are. */
#ifndef GLINT_TOOLS_SYNTH_SET_H
#define GLINT_TOOLS_SYNTH_SET_H

#include "synth/layout.h"

struct synth_set {
    const char *folder, *type;
    const struct synth_layout *layout;
    int count, shard, shards; /* items shard, shard + shards ... below count */
};

/* Makes the folders of SET. SETTINGS, a line, says what all items are drawn
 * with. Returns an exit code: EXIT_USAGE if the folder was begun with others,
 * or has items beyond SET's count. */
int synth_set_begin(const struct tool *tool, const struct synth_set *set,
                    const char *settings);

/* Writes SETTINGS to synth.json, once nothing is wrong with them. */
int synth_set_keep(const struct tool *tool, const struct synth_set *set,
                   const char *settings);

/* Refuses a folder where a set was begun: a line's item would take the place of
 * one of its own. */
int synth_set_apart(const struct tool *tool, const struct synth_set *set);

/* Makes the folders of SET alone. */
int synth_set_folders(const struct tool *tool, const struct synth_set *set);

/* Returns whether item NUMBER is there, whole. */
bool synth_set_has(const struct synth_set *set, int number);

/* Writes the files of ITEM, and its line. Returns an exit code. */
int synth_set_put(const struct tool *tool, const struct synth_set *set,
                  const struct synth_item *item,
                  const struct synth_result *result,
                  const struct synth_drawing *drawing);

/* Writes the manifest of a shard whose items are all there, and that of all
 * once all are; the shards' are gone then. Sets IS_WHOLE to whether they are.
 * Returns an exit code. */
int synth_set_end(const struct tool *tool, const struct synth_set *set,
                  bool *is_whole);

/* Writes to PATH a contact sheet of the first N items, which have the size of
 * SIZE. Returns an exit code. */
int synth_set_sheet(const struct tool *tool, const struct synth_set *set,
                    const struct synth_item *size, const char *path, int n);

#endif
