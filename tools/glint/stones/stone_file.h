/* SPDX-License-Identifier: MIT
 *
 * Opens translucent media: bakes a text or reads a baked file. Baked texts are
 * cached like models of lenses.
 */
#ifndef GLINT_TOOLS_STONES_STONE_FILE_H
#define GLINT_TOOLS_STONES_STONE_FILE_H

#include "glint/scene/stone_bake.h"
#include "options/tool.h"

/* PSNR, dB, of the light that leaves a medium, compared with the light by the
 * measured or simulated responses of all texels (rows): for the fit, and for
 * the baked integers. The test light has lamps, shadows and a ramp. */
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

/* stone_file_is_text() returns whether ARGUMENT is the text of a translucent
 * medium. stone_file_is_baked() returns whether ARGUMENT begins with the magic
 * number of baked media. */
bool stone_file_is_text(const char *argument);
bool stone_file_is_baked(const char *argument);

/* Opens PATH, a text or a baked file. Rejects PATH, or a file that the text
 * names, if it is the output file of TOOL. OVER (may be NULL) is called after
 * the text was read, and may change its values. If REBAKE, a text is baked even
 * if its medium is cached. LEFT (may be NULL) is the remaining bake work, see
 * tool_count_bake_work(); the work of a bake is 8 for each number in the rows.
 * Sets ERROR to the reason of a failure. */
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
