/* SPDX-License-Identifier: MIT
 *
 * Stands in for realflare.c where there is no jansson.
 */
#include "import/imported.h"

bool import_realflare(struct imported *lens, const char *text, size_t bytes)
{
    (void)text;
    (void)bytes;
    return imported_fail(lens, 0, "glint was built without JSON (jansson)");
}
