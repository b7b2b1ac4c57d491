/* SPDX-License-Identifier: MIT */
#include "oiio/oiio.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "posix/error.h"
#include "posix/process.h"

#define PLUGIN     "glint-oiio.so"
#define PATH_BYTES 4096
#define INSTALLED                                                              \
    "../lib/glint/" /* place of plug-ins as seen from bin/, wherever both were \
                       moved */

/* Sets DIR to the directory of the executable, with its last slash. Returns
 * false if that is unknown. */
static bool find_own_directory(char dir[PATH_BYTES])
{
    const ssize_t n = readlink("/proc/self/exe", dir, PATH_BYTES - 1);
    char *slash;

    if (n < 0)
        return false;
    dir[n] = 0;
    slash = strrchr(dir, '/');
    if (!slash)
        return false;
    slash[1] = 0;
    return true;
}

/* Loads the plug-in PATH and returns its functions, or NULL with the cause in
 * ERROR. */
static const struct glint_oiio *load_from(const char *path,
                                          struct glint_error *error)
{
    void *const handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const struct glint_oiio *face;

    if (!handle) {
        /* dlerror() names PATH, or a library that it needs. */
        glint_error_report(error, GLINT_E_UNSUPPORTED, "the image plug-in",
                           "%s", dlerror());
        return NULL;
    }
    face = dlsym(handle, "glint_oiio_face");
    if (face && face->version == GLINT_OIIO_VERSION)
        return face;
    dlclose(handle);
    glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                       "is not the image plug-in of this glint");
    return NULL;
}

/* Loads the plug-in from DIR if it is there. Returns NULL also if everybody may
 * write to DIR. */
static const struct glint_oiio *load_from_directory(const char *dir,
                                                    struct glint_error *error)
{
    char path[PATH_BYTES + sizeof PLUGIN];
    struct stat st;

    snprintf(path, sizeof path, "%s%s", dir, PLUGIN);
    if (stat(dir, &st) < 0 || st.st_mode & S_IWOTH)
        return NULL;
    return access(path, F_OK) == 0 ? load_from(path, error) : NULL;
}

static const struct glint_oiio *search(struct glint_error *error)
{
    const char *const stated = glint_process_setting("GLINT_OIIO");
    const struct glint_oiio *face = NULL;
    char own[PATH_BYTES];

    glint_error_report(error, GLINT_E_UNSUPPORTED, PLUGIN,
                       "not found; with libopenimageio-dev installed, "
                       "'make oiio' builds it");
    if (stated && *stated)
        return load_from(stated, error);
    if (find_own_directory(own)) {
        face = load_from_directory(own, error);
        if (!face && strlen(own) + sizeof INSTALLED <= sizeof own) {
            strcat(own, INSTALLED);
            face = load_from_directory(own, error);
        }
    }
#ifdef GLINT_PLUGIN_DIR
    if (!face)
        face = load_from_directory(GLINT_PLUGIN_DIR "/", error);
#endif
    return face;
}

enum glint_status glint_oiio_load(const struct glint_oiio **oiio,
                                  struct glint_error *error)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static const struct glint_oiio *found; /* under LOCK; stays loaded */

    pthread_mutex_lock(&lock);
    if (!found)
        found = search(error);
    *oiio = found;
    pthread_mutex_unlock(&lock);
    return *oiio ? GLINT_OK : GLINT_E_UNSUPPORTED;
}
