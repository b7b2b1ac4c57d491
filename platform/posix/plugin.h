/* SPDX-License-Identifier: MIT
 *
 * posix/plugin.h - libraries that glint loads when they are first needed.
 *
 *     static const struct glint_plugin images = {"glint-oiio.so", ...};
 *     const struct glint_oiio *face = glint_plugin_load(&images, &error);
 *
 * A plug-in has one symbol, a struct of functions that begins with an int, its
 * version. A loaded plug-in is never unloaded.
 */
#ifndef GLINT_PLATFORM_POSIX_PLUGIN_H
#define GLINT_PLATFORM_POSIX_PLUGIN_H

#include "glint/status.h"

struct glint_plugin {
    const char *file; /* file name of the library; without .so, the name of its
                         Debian package */
    const char *setting; /* environment variable with the path of the library */
    const char *symbol;  /* name of the exported struct */
    const char *noun;    /* name in messages, as "the image plug-in" */
    int version;         /* Plug-ins of other versions are refused. */
    /* The members below are for the message that the plug-in is not found. */
    const char *without; /* consequence, as ", so that ...", or "" */
    const char *library; /* Debian package needed to build it */
    const char *target;  /* make target that builds it */
};

/* Returns the struct of PLUGIN. If the environment variable plugin->setting is
 * set, it names the file, and no folder is searched. Else searches the folder
 * of the program, or host plug-in, that contains this code; ../lib/glint from
 * there; and GLINT_PLUGIN_DIR, if that was defined when compiling. Skips
 * folders that everybody may write to. Returns NULL, with the cause in ERROR,
 * if the plug-in is not found or refused. Not thread-safe. */
const void *glint_plugin_load(const struct glint_plugin *plugin,
                              struct glint_error *error);

#endif
