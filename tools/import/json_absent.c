/* SPDX-License-Identifier: MIT
 *
 * Replaces json.c in builds without jansson: its formats are refused.
 */
#include "import/imported.h"

static bool absent(struct imported *lens)
{
    return imported_fail(lens, 0, "glint was built without JSON (jansson)");
}

bool import_realflare(struct imported *lens, const char *text, size_t bytes)
{
    (void)text;
    (void)bytes;
    return absent(lens);
}

bool import_lentil(struct imported *lens, const char *text, size_t bytes)
{
    (void)text;
    (void)bytes;
    return absent(lens);
}
