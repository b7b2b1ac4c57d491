/* SPDX-License-Identifier: MIT
 *
 * Opens translucent media: bakes a text or reads a baked file. The bake of a
 * text is cached, as models of lenses are. */
#ifndef GLINT_TOOLS_STONES_STONE_FILE_H
#define GLINT_TOOLS_STONES_STONE_FILE_H

#include "glint/scene/stone_bake.h"
#include "options/tool.h"

/* Errors of a translucent medium compared with its full measured rows, under
 * lamps, shadows and a ramp. */
struct stone_errors {
    double fit_db, baked_db;
    double kernel_loss;
    int tap_bits;
    double seconds; /* processor time of the bake */
};

struct stone_file {
    void *data; /* malloc'ed; STONE points into it */
    size_t bytes;
    struct glint_translucent stone;
    bool is_baked_now;
    struct stone_errors errors; /* of the bake, if is_baked_now */
};

/* Return whether ARGUMENT is the text of a translucent medium, or a file that
 * begins as baked translucent media do. */
bool stone_file_is_text(const char *argument);
bool stone_file_is_baked(const char *argument);

/* Opens the text or baked file PATH. Rejects it if PATH, or a file that the
 * text names, is the output file of TOOL. OVER, unless NULL, is called to
 * override values of the text. If ANEW, bakes the text even if it is cached. On
 * failure the reason is in ERROR. */
enum glint_status
stone_file_read(const struct tool *tool, const char *path,
                void (*over)(void *ctx, struct glint_stone_text *), void *ctx,
                bool anew, struct stone_file *file, struct glint_error *error);
void stone_file_close(struct stone_file *file);

/* Prints the contents of FILE; with --json, as one object. */
void stone_file_print(const struct tool *tool, const struct stone_file *file);

/* The command glint bake for translucent media; see options/tool.h. */
int cmd_bake_stone(struct tool *tool, int argc, char **argv);

#endif
