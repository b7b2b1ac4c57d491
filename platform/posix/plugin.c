/* SPDX-License-Identifier: MIT */
#include "posix/plugin.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "posix/error.h"
#include "posix/process.h"

#define PATH_BYTES 4096
#define FILE_BYTES 64
#define INSTALLED                                                      \
    "../lib/glint/" /* folder of plug-ins relative to bin/ of the same \
                       installation */

/* Sets DIR to the folder of the program or library that contains this code,
 * with a trailing slash. Returns false if the folder is unknown. */
static bool find_own_directory(char dir[PATH_BYTES])
{
    char *slash;

    if (!glint_process_find_own_file(dir, PATH_BYTES))
        return false;
    slash = strrchr(dir, '/');
    slash[1] = 0;
    return true;
}

/* Returns whether DIR is outside a source tree. In a source tree DIR is build/
 * or a folder in it, and lenses/ is beside build/. */
static bool is_outside_source_tree(const char *dir)
{
    char up[PATH_BYTES + FILE_BYTES], up_twice[PATH_BYTES + FILE_BYTES];

    snprintf(up, sizeof up, "%s../lenses", dir);
    snprintf(up_twice, sizeof up_twice, "%s../../lenses", dir);
    return access(up, F_OK) != 0 && access(up_twice, F_OK) != 0;
}

static void report_missing_plugin(const struct glint_plugin *plugin,
                                  bool installed, struct glint_error *error)
{
    if (installed)
        glint_error_report(error, GLINT_E_UNSUPPORTED, plugin->file,
                           "not found%s; it is in the package %.*s, or "
                           "install %s and then glint again",
                           plugin->without, (int)strcspn(plugin->file, "."),
                           plugin->file, plugin->library);
    else
        glint_error_report(
            error, GLINT_E_UNSUPPORTED, plugin->file,
            "not found%s; with %s installed, 'make %s' builds it",
            plugin->without, plugin->library, plugin->target);
}

static const void *load_plugin_file(const struct glint_plugin *plugin,
                                    const char *path, struct glint_error *error)
{
    void *const handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const int *face;

    if (!handle) {
        /* The text of dlerror() names PATH, or a library that the plug-in
         * needs. */
        glint_error_report(error, GLINT_E_UNSUPPORTED, plugin->noun, "%s",
                           dlerror());
        return NULL;
    }
    face = dlsym(handle, plugin->symbol);
    if (face && *face == plugin->version)
        return face;
    dlclose(handle);
    glint_error_report(error, GLINT_E_UNSUPPORTED, path,
                       "is not %s of this version of glint", plugin->noun);
    return NULL;
}

/* Loads the plug-in from DIR. Returns NULL if it is not there or everybody may
 * write to DIR. */
static const void *load_from_directory(const struct glint_plugin *plugin,
                                       const char *dir,
                                       struct glint_error *error)
{
    char path[PATH_BYTES + FILE_BYTES];
    struct stat st;

    snprintf(path, sizeof path, "%s%s", dir, plugin->file);
    if (stat(dir, &st) < 0 || st.st_mode & S_IWOTH)
        return NULL;
    return access(path, F_OK) == 0 ? load_plugin_file(plugin, path, error)
                                   : NULL;
}

const void *glint_plugin_load(const struct glint_plugin *plugin,
                              struct glint_error *error)
{
    const char *const stated = glint_process_get_setting(plugin->setting);
    const void *face = NULL;
    char own[PATH_BYTES];

    if (stated && *stated)
        return load_plugin_file(plugin, stated, error);
    if (!find_own_directory(own))
        *own = '\0';
    report_missing_plugin(plugin, *own && is_outside_source_tree(own), error);
    if (*own) {
        face = load_from_directory(plugin, own, error);
        if (!face && strlen(own) + sizeof INSTALLED <= sizeof own) {
            strcat(own, INSTALLED);
            face = load_from_directory(plugin, own, error);
        }
    }
#ifdef GLINT_PLUGIN_DIR
    if (!face)
        face = load_from_directory(plugin, GLINT_PLUGIN_DIR "/", error);
#endif
    return face;
}
