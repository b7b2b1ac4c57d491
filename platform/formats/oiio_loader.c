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
    static const void *found; /* functions of the loaded plug-in, or NULL;
                                 guarded by LOCK */
    enum glint_status status = GLINT_OK;

    pthread_mutex_lock(&lock);
    if (!found)
        status = glint_plugin_load(&found, &plugin, error);
    *oiio = found;
    if (*oiio)
        glint_at_death_set_library_report((*oiio)->report_abort);
    pthread_mutex_unlock(&lock);
    return status;
}
