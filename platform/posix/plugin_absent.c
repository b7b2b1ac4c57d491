/* SPDX-License-Identifier: MIT
 *
 * Replaces plugin.c in static programs, which cannot load plug-ins. */
#include "posix/error.h"
#include "posix/plugin.h"

enum glint_status glint_plugin_load(const void **face,
                                    const struct glint_plugin *plugin,
                                    struct glint_error *error)
{
    *face = NULL;
    return glint_error_report(
        error, GLINT_E_UNSUPPORTED, plugin->file,
        "this glint is linked statically and cannot load plug-ins%s",
        plugin->without);
}
