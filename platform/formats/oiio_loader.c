/* SPDX-License-Identifier: MIT */
#include "formats/oiio.h"

#include <pthread.h>

#include "posix/at_death.h"
#include "posix/plugin.h"

enum glint_status glint_oiio_load(const struct glint_oiio **oiio,
                                  struct glint_error *error)
{
    static const struct glint_plugin plugin = {
        "glint-oiio.so",      "GLINT_OIIO",
        "glint_oiio_face",    "the image plug-in",
        GLINT_OIIO_VERSION,   "",
        "libopenimageio-dev", "oiio"};
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static const struct glint_oiio *found; /* functions of the loaded plug-in,
                                              or NULL; guarded by LOCK */

    pthread_mutex_lock(&lock);
    if (!found) {
        found = glint_plugin_load(&plugin, error);
        if (found)
            glint_at_death_set_library_report(found->report_abort);
    }
    *oiio = found;
    pthread_mutex_unlock(&lock);
    return *oiio ? GLINT_OK : GLINT_E_UNSUPPORTED;
}
