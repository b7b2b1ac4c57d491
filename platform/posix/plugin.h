/* SPDX-License-Identifier: MIT
 *
 * posix/plugin.h - libraries that glint loads when something first needs them.
 *
 *     static const struct glint_plugin images = {"glint-oiio.so", ...};
 *     const struct glint_oiio *face = glint_plugin_load(&images, &error);
 *
 * A plug-in has one symbol, a struct of functions that begins with an int, its
 * version. What is loaded stays.
 */
#ifndef GLINT_PLATFORM_POSIX_PLUGIN_H
#define GLINT_PLATFORM_POSIX_PLUGIN_H

#include "glint/status.h"

struct glint_plugin {
    const char *file; /* the library, with .so; its Debian package, without */
    const char *setting; /* variable of the environment that names its place */
    const char *symbol;  /* the struct's */
    const char *noun;    /* "the image plug-in" */
    int version;         /* Others are refused. */
    /* For the message if it is not found: */
    const char *without; /* consequence, as ", so that ...", or "" */
    const char *library; /* development package that it is built with */
    const char *target;  /* target of make */
};

/* Returns the struct of PLUGIN. Looks at its setting, which names the file and
 * then is the only place; beside the program, or the plug-in of a host, that
 * contains this code; in ../lib/glint from there; and in GLINT_PLUGIN_DIR,
 * where that was defined when compiling. A folder that everybody may write to
 * is none. Returns NULL if it is not found or refused, with the cause in ERROR.
 * Not for two threads at a time. */
const void *glint_plugin_load(const struct glint_plugin *plugin,
                              struct glint_error *error);

#endif
