/* SPDX-License-Identifier: MIT
 *
 * --coating: anti-reflection films on the air-glass surfaces of a lens table.
 */
#ifndef GLINT_TOOLS_MODEL_COATING_H
#define GLINT_TOOLS_MODEL_COATING_H

#include "options/tool.h"

enum coating_kind { COATING_MIXED, COATING_TABLE, COATING_DEALT };

struct coating {
    /* source of the films; by default mixed */
    enum coating_kind kind;
    const char *text; /* value of --coating; NULL: the default */
    /* whether --coating is on the command line, even with the default value */
    bool given;
    int n_coatings;
    struct glint_coating coating[GLINT_MAX_COATINGS];
};

#define COATING_HELP                                                          \
    "  --coating C         coatings of surfaces between air and glass: "      \
    "mixed, films\n"                                                          \
    "                      that differ from surface to surface (default); "   \
    "table,\n"                                                                \
    "                      those of the table; none; or a list, repeated\n"   \
    "                      from the front on: v-coat[/NM], "                  \
    "broadband-3[/NM],\n"                                                     \
    "                      broadband-4[/NM], NM[/INDEX[:QUARTERS]]...[,...] " \
    "with\n"                                                                  \
    "                      100 to 5000 nm, index 1.01 to 4 (1.38), films "    \
    "from\n"                                                                  \
    "                      the air on\n"

/* Parses TEXT, the value of --coating, into COATING. Returns -1, or an exit
 * code after printing the error. */
int coating_parse_option(const struct tool *tool, struct coating *coating,
                         const char *text);

/* Prints COATING: "none", or "550 nm, index 1.38" and further layers, if
 * any. */
void coating_print(FILE *file, const struct glint_coating *coating);

/* Returns the value of --coating that gives COATING. */
const char *coating_get_text(const struct coating *coating);

void coating_apply(const struct coating *coating,
                   struct glint_prescription *lens);

/* Rejects --coating for the model PATH, which was baked with its own coatings:
 * prints a usage error and returns its exit code. Returns EXIT_OK if the option
 * was not given. */
int coating_reject_option_for_model(const struct tool *tool,
                                    const struct coating *coating,
                                    const char *path);

#endif
