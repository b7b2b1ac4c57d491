/* SPDX-License-Identifier: MIT
 *
 * Opens translucent media: bakes a text or reads a baked file. Baked texts are
 * cached like models of lenses.
 */
#ifndef GLINT_TOOLS_STONES_STONE_FILE_H
#define GLINT_TOOLS_STONES_STONE_FILE_H

#include "glint/scene/stone_bake.h"
#include "options/tool.h"

/* PSNR, dB, of a translucent medium against all of its measured or simulated
 * rows, under lamps, shadows and a ramp: of the fit, and of the baked
 * integers */
struct stone_errors {
    double fit_db, baked_db;
    double kernel_loss;
    int tap_bits;
    double seconds; /* processor time of the bake, s */
};

struct stone_file {
    void *data; /* contents of the baked medium, owned; STONE points into it */
    size_t bytes;
    struct glint_translucent stone;
    bool is_baked_now;
    struct stone_errors errors; /* errors of the bake, if is_baked_now */
};

/* Return whether ARGUMENT is the text of a translucent medium, or a file
 * that begins with the magic number of baked media. */
bool stone_file_is_text(const char *argument);
bool stone_file_is_baked(const char *argument);

/* Opens the text or baked file PATH. Rejects PATH, or a file that the text
 * names, if it is the output file of TOOL. OVER, unless NULL, is called to
 * override values of the text. REBAKE: bakes the text even if it is cached.
 * LEFT, unless NULL, is the remaining bake work, see tool_count_bake_work(); a
 * bake costs 8 for each number in its scatter rows. ERROR receives the reason
 * of a failure. */
enum glint_status
stone_file_read(const struct tool *tool, const char *path,
                void (*over)(void *ctx, struct glint_stone_text *), void *ctx,
                bool rebake, int64_t *left, struct stone_file *file,
                struct glint_error *error);
void stone_file_close(struct stone_file *file);

/* Prints the contents of FILE; with --json, as one object. */
void stone_file_print_contents(const struct tool *tool,
                               const struct stone_file *file);

/* The command glint bake for translucent media; see options/tool.h. */
int cmd_bake_stone(struct tool *tool, int argc, char **argv);

#endif
