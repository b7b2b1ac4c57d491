/* SPDX-License-Identifier: MIT
 *
 * Replaces json.c in builds without jansson: its formats are rejected with a
 * message.
 */
#include "import/imported.h"

static bool reject_json_format(struct imported *lens)
{
    return imported_report_error(lens, 0,
                                 "glint was built without JSON (jansson)");
}

bool import_realflare(struct imported *lens, const char *text, size_t bytes)
{
    (void)text;
    (void)bytes;
    return reject_json_format(lens);
}

bool import_lentil(struct imported *lens, const char *text, size_t bytes)
{
    (void)text;
    (void)bytes;
    return reject_json_format(lens);
}
