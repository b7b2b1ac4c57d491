/* SPDX-License-Identifier: MIT
 *
 * posix/plugin.h - loads plug-ins, libraries that glint loads when they are
 * first needed.
 *
 *     static const struct glint_plugin images = {"glint-oiio.so", ...};
 *     status = glint_plugin_load(&face, &images, &error);
 *
 * A plug-in exports one symbol, a struct of functions that begins with its
 * version, an int. A loaded plug-in is never unloaded. */
#ifndef GLINT_PLATFORM_POSIX_PLUGIN_H
#define GLINT_PLATFORM_POSIX_PLUGIN_H

#include "glint/status.h"

struct glint_plugin {
    /* File name of the library. Without ".so" it is also the name of the Debian
     * package of the plug-in. */
    const char *file;
    const char *setting; /* environment variable with the path of the library */
    const char *symbol;  /* name of the exported struct */
    const char *noun;    /* name in messages, such as "the image plug-in" */
    int version;         /* version of the interface; plug-ins of other versions
                            are rejected */
    /* Members for the message that is printed if the plug-in is missing. */
    /* consequence that is appended to the message: ", so that ...", or "" */
    const char *without;
    const char *library; /* Debian package needed to build it */
    const char *target;  /* make target that builds it */
};

/* Sets FACE to the struct that PLUGIN exports, or to NULL on failure. If the
 * environment variable plugin->setting is set, it names the library's file, and
 * no folder is searched. Otherwise searches three folders: the folder of the
 * program or host plug-in that contains this code; ../lib/glint relative to it;
 * and GLINT_PLUGIN_DIR, if that was defined when compiling. Skips folders that
 * everybody may write to. Returns GLINT_E_UNSUPPORTED if the plug-in is not
 * found, GLINT_E_FORMAT if a file is found that cannot be loaded or is not the
 * plug-in of this version. Not thread-safe. */
enum glint_status glint_plugin_load(const void **face,
                                    const struct glint_plugin *plugin,
                                    struct glint_error *error);

#endif
