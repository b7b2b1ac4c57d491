/* SPDX-License-Identifier: MIT
 *
 * Opens the Heliar lens and its model with the coatings of its table and
 * otherwise the default settings of commands.
 * Run from the root of the tree.
 *
 *     TEST_GROUP(open_heliar_lens, close_opened_lens);
 */
#ifndef GLINT_TESTS_OPENED_H
#define GLINT_TESTS_OPENED_H

#include "support/settings_frame.h"
#include "support/test.h"

static struct opened opened;
static struct tool tool = {.name = "test", .quiet = true, .n_threads = 1};

static inline void open_heliar_lens(void)
{
    settings_set_defaults(&opened.settings);
    opened.settings.coating.kind = COATING_TABLE;
    assert_ok(tool_start_threads(&tool));
    assert_ok(opened_lens_open(&tool, &opened.lens, &opened.settings,
                               "lenses/heliar-tronnier.lens"));
}

static inline void close_opened_lens(void)
{
    opened_lens_close(&opened.lens);
    tool_stop_threads(&tool);
}

#endif
