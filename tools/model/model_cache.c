/* SPDX-License-Identifier: MIT */
#include "model/model_cache.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "model/lens_files.h"
#include "posix/error.h"
#include "posix/input.h"
#include "posix/output.h"
#include "posix/process.h"

enum { PATH_BYTES = 1024, MAX_BYTES = 1 << 28 };

/* PATH becomes where models are kept. False: nowhere. */
static bool cache_folder(char *path, size_t bytes)
{
    const char *cache = glint_process_setting("XDG_CACHE_HOME");
    const char *home = glint_process_setting("HOME");
    int n = 0;

    if (cache && cache[0] == '/')
        n = snprintf(path, bytes, "%s/glint", cache);
    else if (home && home[0] == '/')
        n = snprintf(path, bytes, "%s/.cache/glint", home);
    return n > 0 && (size_t)n < bytes;
}

bool model_cache_name(char *path, size_t bytes, const char *lens, uint64_t key)
{
    const size_t used = strlen(path);
    char safe[GLINT_NAME_BYTES];

    snprintf(safe, sizeof safe, "%s", lens);
    for (char *c = safe; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr("-_.", *c))
            *c = '_';
    return (size_t)snprintf(path + used, bytes - used, "/%s-%08lx%08lx.glint",
                            safe, (unsigned long)(key >> 32),
                            (unsigned long)(key & 0xffffffff)) < bytes - used;
}

static bool model_path(char *path, size_t bytes, const char *lens, uint64_t key)
{
    return cache_folder(path, bytes) &&
           model_cache_name(path, bytes, lens, key);
}

static uint64_t key_of(const struct glint_lens *lens)
{
    return lens->header->key[0] | (uint64_t)lens->header->key[1] << 32;
}

/* A regular file that nobody could have written but us or the machine's owner.
 */
static bool is_ours(const struct stat *st)
{
    return S_ISREG(st->st_mode) &&
           (st->st_uid == geteuid() || st->st_uid == 0) &&
           !(st->st_mode & S_IWOTH);
}

static uint8_t *read_ours(const char *path, size_t *bytes)
{
    struct glint_input in = {.fd = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY |
                                                  O_NOFOLLOW | O_NONBLOCK),
                             .name = path};
    struct glint_error error;
    uint8_t *data = NULL;
    struct stat st;

    *bytes = 0;
    if (in.fd < 0)
        return NULL;
    if (fstat(in.fd, &st) < 0 || !is_ours(&st) ||
        glint_input_append(&in, &data, bytes, MAX_BYTES, &error) != GLINT_OK) {
        free(data);
        data = NULL;
    }
    glint_input_close(&in);
    return data;
}

/* What was installed is as good as the program itself, whoever did it. */
static uint8_t *read_installed(const char *path, size_t *bytes)
{
    struct glint_error error;
    uint8_t *data = NULL;

    return glint_input_slurp(&data, bytes, path, MAX_BYTES, &error) == GLINT_OK
               ? data
               : NULL;
}

/* A kept model that is whole and the right one. */
static bool load(const char *path, uint64_t key,
                 uint8_t *(*read)(const char *path, size_t *bytes),
                 struct model_file *model)
{
    uint8_t *data;
    const char *reason;

    *model = (struct model_file){.data = NULL};
    data = read(path, &model->bytes);
    if (!data)
        return false;
    model->data = data;
    if (glint_lens_open(&model->lens, data, model->bytes, &reason) ==
            GLINT_OK &&
        key_of(&model->lens) == key)
        return true;
    model_file_close(model);
    return false;
}

/* One that was installed with the lenses. */
static bool load_installed(const char *lens, uint64_t key,
                           struct model_file *model)
{
    char path[PATH_BYTES];

    for (int i = 0; lens_folder(i, "models", path, sizeof path); i++)
        if (model_cache_name(path, sizeof path, lens, key) &&
            load(path, key, read_installed, model))
            return true;
    return false;
}

bool model_is_cached(const struct glint_prescription *lens,
                     const struct glint_bake_options *options)
{
    const uint64_t key = glint_bake_key(lens, options);
    struct model_file model = {.data = NULL};
    char path[PATH_BYTES];
    const bool is = load_installed(lens->name, key, &model) ||
                    (model_path(path, sizeof path, lens->name, key) &&
                     load(path, key, read_ours, &model));

    model_file_close(&model);
    return is;
}

/* Makes the folders above PATH. */
static void make_folders(char *path)
{
    for (char *c = path + 1; *c; c++)
        if (*c == '/') {
            *c = 0;
            mkdir(path, 0755); /* if it fails, so will writing the file */
            *c = '/';
        }
}

bool model_cache_path(char *path, size_t bytes, const char *file)
{
    size_t used;

    if (!cache_folder(path, bytes))
        return false;
    used = strlen(path);
    if ((size_t)snprintf(path + used, bytes - used, "/%s", file) >=
        bytes - used)
        return false;
    make_folders(path);
    return true;
}

/* Nothing is written through links, into FIFOs and the like; a file that others
 * may write to goes, and with it its permission bits. */
static enum glint_status clear_way(const char *path, struct glint_error *error)
{
    struct stat st;

    if (lstat(path, &st) < 0)
        return GLINT_OK;
    if (!S_ISREG(st.st_mode))
        return glint_error_report(error, GLINT_E_OUTPUT, path,
                                  "is no file; remove it");
    if (!is_ours(&st))
        unlink(path); /* if it fails, so will replacing it */
    return GLINT_OK;
}

static void keep(const struct tool *tool, char *path,
                 const struct model_file *model)
{
    struct glint_error error = {""};
    struct glint_output out;
    enum glint_status status;

    make_folders(path);
    status = clear_way(path, &error);
    if (status == GLINT_OK)
        status = glint_output_open(&out, path, GLINT_OUTPUT_BINARY, &error);
    if (status == GLINT_OK)
        status = glint_output_finish(&out, model->data, model->bytes, &error);
    if (status != GLINT_OK && !tool->quiet)
        fprintf(stderr, "glint %s: the model is not kept: %s\n", tool->name,
                error.text);
}

int model_cached(const struct tool *tool, const struct glint_prescription *lens,
                 struct glint_bake_options options, struct model_file *model)
{
    const uint64_t key = glint_bake_key(lens, &options);
    char path[PATH_BYTES];
    const bool kept = model_path(path, sizeof path, lens->name, key);
    struct glint_error error = {""};
    struct glint_bake_report report;
    struct tool_progress progress;
    unsigned char *data = NULL;
    enum glint_status status;
    const char *reason = "";

    if (load_installed(lens->name, key, model) ||
        (kept && load(path, key, read_ours, model)))
        return EXIT_OK;
    if (!tool->quiet)
        fprintf(stderr, "glint %s: baking %s, once%s%s\n", tool->name,
                lens->name, kept ? ", for " : "", kept ? path : "");
    options.workers = tool->workers;
    options.progress = tool_progress_show;
    options.progress_ctx = &progress;
    tool_progress_start(&progress, tool, "bake");
    status = glint_bake(lens, &options, &data, &model->bytes, &report, &error);
    tool_progress_end(&progress);
    model->data = data;
    if (status == GLINT_OK) {
        status = glint_lens_open(&model->lens, data, model->bytes, &reason);
        if (status != GLINT_OK)
            snprintf(error.text, sizeof error.text, "%s: %.70s", lens->name,
                     reason);
    }
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text[0] ? error.text : NULL);
    if (kept)
        keep(tool, path, model);
    return EXIT_OK;
}
