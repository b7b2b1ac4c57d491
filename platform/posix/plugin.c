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

static enum glint_status load_plugin_file(const void **face,
                                          const struct glint_plugin *plugin,
                                          const char *path,
                                          struct glint_error *error)
{
    void *const handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const int *version;

    /* The text of dlerror() names PATH, or a library that the plug-in needs. */
    if (!handle)
        return glint_error_report(
            error, access(path, F_OK) ? GLINT_E_UNSUPPORTED : GLINT_E_FORMAT,
            plugin->noun, "%s", dlerror());
    version = dlsym(handle, plugin->symbol);
    if (version && *version == plugin->version) {
        *face = version;
        return GLINT_OK;
    }
    dlclose(handle);
    return glint_error_report(
        error, GLINT_E_FORMAT, path,
        "is not %s of this version of glint; replace it by that of the package "
        "%.*s or of 'make %s'",
        plugin->noun, (int)strcspn(plugin->file, "."), plugin->file,
        plugin->target);
}

/* Loads the plug-in from DIR, unless STATUS is GLINT_OK. Returns STATUS if the
 * plug-in is not there or everybody may write to DIR. */
static enum glint_status load_from_directory(const void **face,
                                             const struct glint_plugin *plugin,
                                             const char *dir,
                                             enum glint_status status,
                                             struct glint_error *error)
{
    char path[PATH_BYTES + FILE_BYTES];
    struct stat st;

    snprintf(path, sizeof path, "%s%s", dir, plugin->file);
    if (!status || stat(dir, &st) < 0 || st.st_mode & S_IWOTH ||
        access(path, F_OK) < 0)
        return status;
    return load_plugin_file(face, plugin, path, error);
}

enum glint_status glint_plugin_load(const void **face,
                                    const struct glint_plugin *plugin,
                                    struct glint_error *error)
{
    const char *const stated = glint_process_get_setting(plugin->setting);
    enum glint_status status = GLINT_E_UNSUPPORTED;
    char own[PATH_BYTES];

    *face = NULL;
    if (stated && *stated)
        return load_plugin_file(face, plugin, stated, error);
    if (!find_own_directory(own))
        *own = '\0';
    report_missing_plugin(plugin, *own && is_outside_source_tree(own), error);
    if (*own) {
        status = load_from_directory(face, plugin, own, status, error);
        if (strlen(own) + sizeof INSTALLED <= sizeof own) {
            strcat(own, INSTALLED);
            status = load_from_directory(face, plugin, own, status, error);
        }
    }
#ifdef GLINT_PLUGIN_DIR
    status =
        load_from_directory(face, plugin, GLINT_PLUGIN_DIR "/", status, error);
#endif
    return status;
}
