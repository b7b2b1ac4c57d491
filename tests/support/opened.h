/* SPDX-License-Identifier: MIT
 *
 * The Heliar lens, opened with default settings as a command does, with its
 * model. Run from the root of the tree.
 *
 *     TEST_GROUP(opened_heliar, opened_close);
 */
#ifndef GLINT_TESTS_OPENED_H
#define GLINT_TESTS_OPENED_H

#include "support/settings_frame.h"
#include "options/tool.h"
#include "support/test.h"

static struct opened opened;
static struct tool tool = {.name = "test", .quiet = true, .n_threads = 1};

static inline void opened_heliar(void)
{
    settings_defaults(&opened.settings);
    assert_ok(tool_start(&tool));
    assert_ok(opened_lens_open(&tool, &opened.lens, &opened.settings,
                               "lenses/heliar-tronnier.lens"));
}

static inline void opened_close(void)
{
    opened_lens_close(&opened.lens);
    tool_finish(&tool);
}

#endif
