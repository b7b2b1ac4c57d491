/* SPDX-License-Identifier: MIT
 *
 * Replaces openlensflare.c in builds without expat: its format is rejected with
 * a message.
 */
#include "import/imported.h"

bool import_openlensflare(struct imported *lens, const char *text, size_t bytes)
{
    (void)text;
    (void)bytes;
    return imported_report_error(lens, 0,
                                 "glint was built without XML (expat)");
}
