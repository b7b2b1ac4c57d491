/* SPDX-License-Identifier: MIT */
#include "model/model_cache.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "model/cache_file.h"
#include "model/lens_files.h"
#include "model/picture_check.h"
#include "posix/input.h"

enum { MAX_BYTES = 1 << 28 };

bool model_cache_append_name(char *path, size_t bytes, const char *lens,
                             uint64_t key)
{
    return cache_file_append_name(path, bytes, lens, key, "glint");
}

static bool make_model_path(char *path, size_t bytes, const char *lens,
                            uint64_t key)
{
    return cache_file_find_folder(path, bytes) &&
           model_cache_append_name(path, bytes, lens, key);
}

static uint64_t compute_model_key(const struct glint_lens *lens)
{
    return lens->header->key[0] | (uint64_t)lens->header->key[1] << 32;
}

static uint8_t *read_cached_model(const char *path, size_t *bytes)
{
    return cache_file_read(path, MAX_BYTES, bytes);
}

/* Reads an installed model. The file may belong to any user, because it is
 * trusted as much as the program itself. */
static uint8_t *read_installed_model(const char *path, size_t *bytes)
{
    struct glint_error error;
    uint8_t *data = NULL;

    return glint_input_read_whole_file(&data, bytes, path, MAX_BYTES, &error) ==
                   GLINT_OK
               ? data
               : NULL;
}

/* Reads the file PATH by calling READ, and opens it as a model. Returns false
 * if the file is missing or damaged, or if the model has another key than
 * KEY. */
static bool load_model_with_key(const char *path, uint64_t key,
                                uint8_t *(*read)(const char *path,
                                                 size_t *bytes),
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
        compute_model_key(&model->lens) == key)
        return true;
    model_file_close(model);
    return false;
}

/* Opens the model of LENS that was installed with the lenses. Returns false if
 * there is none. */
static bool load_installed_model(const char *lens, uint64_t key,
                                 struct model_file *model)
{
    char path[CACHE_PATH_BYTES];

    for (int i = 0; lens_find_folder(i, "models", path, sizeof path); i++)
        if (model_cache_append_name(path, sizeof path, lens, key) &&
            load_model_with_key(path, key, read_installed_model, model))
            return true;
    return false;
}

bool model_is_cached(const struct glint_prescription *lens,
                     const struct glint_bake_options *options)
{
    const uint64_t key = glint_bake_key(lens, options);
    struct model_file model = {.data = NULL};
    char path[CACHE_PATH_BYTES];
    const bool is = load_installed_model(lens->name, key, &model) ||
                    (make_model_path(path, sizeof path, lens->name, key) &&
                     load_model_with_key(path, key, read_cached_model, &model));

    model_file_close(&model);
    return is;
}

bool model_cache_make_path(char *path, size_t bytes, const char *file)
{
    size_t used;

    if (!cache_file_find_folder(path, bytes))
        return false;
    used = strlen(path);
    if ((size_t)snprintf(path + used, bytes - used, "/%s", file) >=
        bytes - used)
        return false;
    cache_file_make_folders(path);
    return true;
}

static void write_cached_model(const struct tool *tool, char *path,
                               const struct model_file *model)
{
    struct glint_error error = {""};

    if (cache_file_write(path, model->data, model->bytes, &error) != GLINT_OK &&
        !tool->quiet)
        fprintf(stderr, "glint %s: the model cannot be cached: %s\n",
                tool->name, error.text);
}

bool model_is_lens_from_file(const struct glint_prescription *lens,
                             const char *file)
{
    char own[CACHE_PATH_BYTES];
    struct stat a, b;

    return tool_is_file_name(file) &&
           (!lens_find_file(lens->name, own, sizeof own) || stat(own, &a) < 0 ||
            stat(file, &b) < 0 || a.st_ino != b.st_ino || a.st_dev != b.st_dev);
}

/* Adds WORK to the total bake work, CTX, and may be called by several threads.
 * Returns false if the total exceeds MODEL_CACHE_WORK. */
static bool count_bake_work(void *ctx, int work)
{
    return __atomic_add_fetch((int *)ctx, work, __ATOMIC_RELAXED) <=
           MODEL_CACHE_WORK;
}

/* Prints that baking FILE exceeds MODEL_CACHE_WORK. Returns an exit code. */
static int report_too_much_work(const struct tool *tool, const char *file)
{
    tool_error(
        tool,
        "%.200s: baking takes more than about 30 s of processor time; "
        "bake it with glint bake, which has no limit, and name the model "
        "as the lens",
        file);
    return EXIT_LENS;
}

/* Compares pictures by MODEL with pictures by exact rays of LENS, and stores
 * the result and COATING in MODEL. If they cannot be compared, MODEL stays
 * without a result. May return GLINT_E_MEMORY, so that the result does not
 * depend on memory. */
static enum glint_status
check_model_pictures(const struct tool *tool,
                     const struct glint_prescription *lens,
                     const struct glint_bake_options *options,
                     const struct coating *coating, struct model_file *model)
{
    unsigned char *data = model->data;
    struct picture_check check;
    struct glint_error error;
    const char *reason;
    enum glint_status status =
        picture_check_run(tool, lens, &model->lens, options, &check, &error);

    if (status == GLINT_E_MEMORY ||
        picture_check_store(status == GLINT_OK ? &check : NULL, coating, &data,
                            &model->bytes) != GLINT_OK)
        return GLINT_E_MEMORY;
    model->data = data;
    return glint_lens_open(&model->lens, data, model->bytes, &reason);
}

/* Bakes the model of LENS into MODEL and writes it to the cache file PATH
 * (NULL: no cache). FILE is the lens as named on the command line. Returns an
 * exit code. */
static int bake_model(const struct tool *tool,
                      const struct glint_prescription *lens, const char *file,
                      struct glint_bake_options options,
                      const struct coating *coating, char *path,
                      struct model_file *model)
{
    int work = 0;
    struct glint_error error = {""};
    struct glint_bake_report report;
    struct tool_progress progress;
    unsigned char *data = NULL;
    enum glint_status status;
    const char *reason = "";

    if (!tool->quiet)
        fprintf(stderr, "glint %s: baking %s, once%s%s\n", tool->name,
                lens->name, path ? ", for " : "", path ? path : "");
    options.workers = tool->workers;
    options.progress = tool_progress_show;
    options.progress_ctx = &progress;
    options.allow =
        model_is_lens_from_file(lens, file) ? count_bake_work : NULL;
    options.allow_ctx = &work;
    tool_progress_start(&progress, tool, "bake");
    status = glint_bake(lens, &options, &data, &model->bytes, &report, &error);
    tool_progress_end(&progress);
    model->data = data;
    if (status == GLINT_E_UNSUPPORTED && work > MODEL_CACHE_WORK)
        return report_too_much_work(tool, file);
    if (status == GLINT_OK) {
        status = glint_lens_open(&model->lens, data, model->bytes, &reason);
        if (status != GLINT_OK)
            snprintf(error.text, sizeof error.text, "%s: %.70s", lens->name,
                     reason);
    }
    if (status == GLINT_OK)
        status = check_model_pictures(tool, lens, &options, coating, model);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text[0] ? error.text : NULL);
    if (path)
        write_cached_model(tool, path, model);
    return EXIT_OK;
}

static int report_bake_refused(const struct tool *tool,
                               const struct glint_prescription *lens)
{
    tool_error(tool,
               "%s has no model, and a reload does not bake; run glint bake, "
               "or restart",
               lens->name);
    return EXIT_LENS;
}

struct wait {
    const struct tool *tool;
    const char *lens;
};

static void report_bake_wait(void *ctx)
{
    const struct wait *const w = ctx;

    if (!w->tool->quiet)
        fprintf(stderr, "glint %s: waiting for another process that bakes %s\n",
                w->tool->name, w->lens);
}

int model_open_cached(const struct tool *tool,
                      const struct glint_prescription *lens, const char *file,
                      struct glint_bake_options options,
                      const struct coating *coating, struct model_file *model)
{
    const uint64_t key = glint_bake_key(lens, &options);
    struct wait wait = {tool, lens->name};
    char path[CACHE_PATH_BYTES];
    int lock, code = EXIT_OK;

    if (load_installed_model(lens->name, key, model))
        return EXIT_OK;
    if (!make_model_path(path, sizeof path, lens->name, key))
        return tool->no_bake ? report_bake_refused(tool, lens)
                             : bake_model(tool, lens, file, options, coating,
                                          NULL, model);
    if (load_model_with_key(path, key, read_cached_model, model))
        return EXIT_OK;
    if (tool->no_bake)
        return report_bake_refused(tool, lens);
    /* After a wait for the lock the model may be in the cache, baked by another
     * process. */
    lock = cache_file_lock(path, key, report_bake_wait, &wait);
    if (!load_model_with_key(path, key, read_cached_model, model))
        code = bake_model(tool, lens, file, options, coating, path, model);
    cache_file_unlock(lock);
    return code;
}
