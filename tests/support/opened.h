/* SPDX-License-Identifier: MIT
 *
 * The Heliar as a command opens it by default, with its model and settings. Run
 * from the root of the tree.
 *
 *     TEST_GROUP(opened_heliar, opened_close);
 */
#ifndef GLINT_TESTS_OPENED_H
#define GLINT_TESTS_OPENED_H

#include "support/settings_frame.h"
#include "options/tool.h"

static struct opened opened;
static struct tool tool = {.name = "test", .quiet = true, .n_threads = 1};

static inline int opened_heliar(void **state)
{
    (void)state;
    settings_defaults(&opened.settings);
    return tool_start(&tool) != EXIT_OK ||
           opened_lens_open(&tool, &opened.lens, &opened.settings,
                            "lenses/heliar-tronnier.lens") != EXIT_OK;
}

static inline int opened_close(void **state)
{
    (void)state;
    opened_lens_close(&opened.lens);
    tool_finish(&tool);
    return 0;
}

#endif
