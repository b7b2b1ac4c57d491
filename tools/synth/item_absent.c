/* SPDX-License-Identifier: MIT
 *
 * Replaces item_json.c in builds without jansson: items cannot be read.
 */
#include "posix/error.h"
#include "synth/item.h"

enum glint_status synth_item_parse_json(struct synth_item *item,
                                        const char *line,
                                        struct glint_error *error)
{
    (void)item;
    (void)line;
    return glint_error_report(error, GLINT_E_UNSUPPORTED, "item",
                              "--item needs jansson, but glint was built "
                              "without jansson; install libjansson-dev and "
                              "build glint again");
}
