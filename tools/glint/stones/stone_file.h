/* SPDX-License-Identifier: MIT
 *
 * Baked translucent media: from texts, and from files. What a text describes is
 * computed once and kept in the cache, as models of lenses are. */
#ifndef GLINT_TOOLS_STONES_STONE_FILE_H
#define GLINT_TOOLS_STONES_STONE_FILE_H

#include "glint/scene/stone_bake.h"
#include "options/tool.h"

/* Errors of a translucent medium against its full rows, under lamps, shadows
 * and a ramp. */
struct stone_errors {
    double fit_db, baked_db;
    double kernel_loss;
    int tap_bits;
    double seconds; /* of processor time that it took */
};

struct stone_file {
    void *data; /* malloc'ed; STONE points into it */
    size_t bytes;
    struct glint_translucent stone;
    bool is_baked_now;
    struct stone_errors errors; /* of what was baked now */
};

/* Returns whether ARGUMENT is the text of a translucent medium, or a baked one
 * by how the file begins. */
bool stone_file_is_text(const char *argument);
bool stone_file_is_baked(const char *argument);

/* Opens the text or baked file PATH, unless it, or what a text names, is the
 * file that TOOL writes. OVER, unless NULL, replaces values of the text. AGAIN:
 * no kept translucent medium will do. On failure the reason is in ERROR. */
enum glint_status
stone_file_read(const struct tool *tool, const char *path,
                void (*over)(void *ctx, struct glint_stone_text *), void *ctx,
                bool anew, struct stone_file *file, struct glint_error *error);
void stone_file_close(struct stone_file *file);

/* Prints what is in FILE; with --json, as one object. */
void stone_file_print(const struct tool *tool, const struct stone_file *file);

/* glint bake of translucent media, as the commands of options/tool.h. */
int cmd_bake_stone(struct tool *tool, int argc, char **argv);

#endif
