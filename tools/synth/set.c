/* SPDX-License-Identifier: MIT */
#include "synth/set.h"

#include <dirent.h>
#include <fnmatch.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "desk/sheet.h"
#include "glint/measure.h"
#include "formats/picture.h"
#include "posix/error.h"
#include "posix/input.h"
#include "posix/output.h"

static int too_long(const struct tool *tool, const struct synth_set *set)
{
    return tool_usage(tool, "-o %s is too long a name", set->folder);
}

static bool line_path(char path[SYNTH_PATH_BYTES], const struct synth_set *set,
                      int number)
{
    static const struct synth_file lines = {"items/", "", 0, false};

    return synth_layout_path(path, set->folder, &lines, number, "json");
}

/* Writes TEXT as the file PATH, whole. */
static int write_text(const struct tool *tool, const char *path,
                      const char *text, size_t bytes)
{
    struct glint_output out;
    struct glint_error error = {""};
    enum glint_status status =
        glint_output_open(&out, path, GLINT_OUTPUT_TEXT, &error);

    if (status == GLINT_OK)
        status = glint_output_finish(&out, text, bytes, &error);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

/* ------------------------------------------------------------------ folders */

/* Makes the folder PATH and those above it, up to the last slash. */
static int make_folder(const struct tool *tool, char *path)
{
    struct glint_error error;

    for (char *at = path + 1; (at = strchr(at, '/')); at++) {
        *at = '\0';
        if (mkdir(path, 0777) < 0 && errno != EEXIST)
            return tool_fail(tool,
                             glint_error_report(&error, GLINT_E_OUTPUT, path,
                                                "%s", strerror(errno)),
                             error.text);
        *at = '/';
    }
    return EXIT_OK;
}

int synth_set_folders(const struct tool *tool, const struct synth_set *set)
{
    char path[SYNTH_PATH_BYTES];
    int code = EXIT_OK;

    for (int i = 0;
         i < SYNTH_MAX_FILES && set->layout->file[i].folder && code == EXIT_OK;
         i++) {
        if (!synth_layout_path(path, set->folder, &set->layout->file[i], 0,
                               set->type))
            return too_long(tool, set);
        code = make_folder(tool, path);
    }
    if (code != EXIT_OK)
        return code;
    return line_path(path, set, 0) ? make_folder(tool, path)
                                   : too_long(tool, set);
}

int synth_set_apart(const struct tool *tool, const struct synth_set *set)
{
    char path[SYNTH_PATH_BYTES];

    snprintf(path, sizeof path, "%s/synth.json", set->folder);
    if (access(path, F_OK) != 0)
        return EXIT_OK;
    return tool_usage(tool,
                      "a set was begun in %s (%s): name another folder for "
                      "--item",
                      set->folder, path);
}

/* Refuses a count below the items that SET has: a set is never made smaller,
 * and its manifest would no longer say what is there. */
static int check_count(const struct tool *tool, const struct synth_set *set)
{
    char path[SYNTH_PATH_BYTES];
    const struct dirent *entry;
    long last = -1;
    DIR *dir;

    snprintf(path, sizeof path, "%s/items", set->folder);
    dir = opendir(path);
    while (dir && (entry = readdir(dir))) {
        char *end;
        const long number = strtol(entry->d_name, &end, 10);

        if (end > entry->d_name && strcmp(end, ".json") == 0 && number > last)
            last = number;
    }
    if (dir)
        closedir(dir);
    if (set->count == 0 || last < set->count) /* 0 draws nothing */
        return EXIT_OK;
    return tool_usage(tool,
                      "%s has items up to %ld, and --count %d would leave some "
                      "out: take --count %ld or more, or name another folder",
                      set->folder, last, set->count, last + 1);
}

int synth_set_begin(const struct tool *tool, const struct synth_set *set,
                    const char *settings)
{
    enum { MOST_BYTES = 1 << 26 };
    char path[SYNTH_PATH_BYTES];
    struct glint_error error = {""};
    enum glint_status status;
    uint8_t *kept = NULL;
    size_t bytes = 0;
    bool is_same;
    int code = synth_set_folders(tool, set);

    snprintf(path, sizeof path, "%s/synth.json", set->folder);
    if (code != EXIT_OK)
        return code;
    if (access(path, F_OK) != 0)
        return EXIT_OK;
    status = glint_input_slurp(&kept, &bytes, path, MOST_BYTES, &error);
    is_same = status == GLINT_OK && bytes == strlen(settings) &&
              memcmp(kept, settings, bytes) == 0;
    free(kept);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    return is_same ? check_count(tool, set)
                   : tool_usage(tool,
                                "%s was begun with other options or "
                                "backgrounds (%s): go on with those, or name "
                                "another folder",
                                set->folder, path);
}

int synth_set_keep(const struct tool *tool, const struct synth_set *set,
                   const char *settings)
{
    char path[SYNTH_PATH_BYTES];

    snprintf(path, sizeof path, "%s/synth.json", set->folder);
    return access(path, F_OK) == 0
               ? EXIT_OK
               : write_text(tool, path, settings, strlen(settings));
}

/* -------------------------------------------------------------------- items */

bool synth_set_has(const struct synth_set *set, int number)
{
    const struct synth_file *const file = set->layout->file;
    char path[SYNTH_PATH_BYTES];
    bool is_there = line_path(path, set, number) && access(path, F_OK) == 0;

    for (int i = 0; i < SYNTH_MAX_FILES && file[i].folder && is_there; i++)
        is_there =
            synth_layout_path(path, set->folder, &file[i], number, set->type) &&
            access(path, F_OK) == 0;
    return is_there;
}

/* Writes FILE of ITEM; RGB is room for its light. */
static enum glint_status put_file(const struct synth_set *set,
                                  const struct synth_file *file,
                                  const struct synth_item *item,
                                  const struct synth_drawing *d, float *rgb,
                                  struct glint_error *error)
{
    const size_t n = 3 * (size_t)d->width * (size_t)d->height;
    const struct glint_float_image light = {d->width, d->height, rgb};
    struct glint_image image = {
        .format = GLINT_RGB24, .width = d->width, .height = d->height};
    char path[SYNTH_PATH_BYTES];
    enum glint_status status;
    uint8_t *codes;

    synth_layout_path(path, set->folder, file, (int)item->number, set->type);
    if (file->layers)
        synth_sum(d, file->layers, rgb);
    if (file->is_noisy)
        synth_noise(item, rgb);
    if (file->layers) {
        codes = glint_measure_encode(&light, 1);
    } else if ((codes = malloc(n))) {
        for (size_t i = 0; i < n; i++) /* a share, not light */
            codes[i] = (uint8_t)(d->cover[i] * 255 + 0.5F);
    }
    if (!codes)
        return GLINT_E_MEMORY;
    glint_image_place(&image, codes);
    status = glint_picture_save(path, &image, error);
    free(codes);
    return status;
}

int synth_set_put(const struct tool *tool, const struct synth_set *set,
                  const struct synth_item *item,
                  const struct synth_result *result,
                  const struct synth_drawing *drawing)
{
    const size_t n = 3 * (size_t)drawing->width * (size_t)drawing->height;
    const struct synth_file *const file = set->layout->file;
    float *const rgb = malloc(n * sizeof *rgb);
    char *const line = synth_item_print(item, result);
    char path[SYNTH_PATH_BYTES];
    struct glint_error error = {""};
    enum glint_status status = rgb && line ? GLINT_OK : GLINT_E_MEMORY;
    int code = EXIT_OK;

    for (int i = 0; i < SYNTH_MAX_FILES && file[i].folder && status == GLINT_OK;
         i++)
        status = put_file(set, &file[i], item, drawing, rgb, &error);
    free(rgb);
    line_path(path, set, (int)item->number);
    if (status != GLINT_OK)
        code = tool_fail(tool, status, error.text);
    else if (line)
        code = write_text(tool, path, line, strlen(line));
    free(line);
    return code;
}

/* ---------------------------------------------------------------- manifests */

/* Appends the file PATH to OUT. */
static enum glint_status append(struct glint_output *out, const char *path,
                                struct glint_error *error)
{
    uint8_t part[4096]; /* a line of three lights has 1.5 KiB */
    struct glint_input in;
    enum glint_status status = glint_input_open(&in, path, error);
    ptrdiff_t n = 0;

    while (status == GLINT_OK &&
           (n = glint_input_some(&in, part, sizeof part)) > 0)
        status = glint_output_write(out, part, (size_t)n, error);
    if (n < 0)
        status =
            glint_error_report(error, GLINT_E_IO, path, "%s", strerror(errno));
    glint_input_close(&in);
    return status;
}

/* Writes the lines of items FIRST, FIRST + STEP ... to NAME. Does nothing, and
 * sets IS_WHOLE to false, if one is not there. */
static int write_lines(const struct tool *tool, const struct synth_set *set,
                       const char *name, int first, int step, bool *is_whole)
{
    char path[SYNTH_PATH_BYTES], line[SYNTH_PATH_BYTES];
    struct glint_error error = {""};
    struct glint_output out;
    enum glint_status status;

    *is_whole = true;
    for (int i = first; i < set->count && *is_whole; i += step)
        *is_whole = synth_set_has(set, i);
    if (!*is_whole)
        return EXIT_OK;
    snprintf(path, sizeof path, "%s/%s", set->folder, name);
    status = glint_output_open(&out, path, GLINT_OUTPUT_TEXT, &error);
    for (int i = first; i < set->count && status == GLINT_OK; i += step) {
        line_path(line, set, i);
        status = append(&out, line, &error);
    }
    if (status == GLINT_OK)
        status = glint_output_commit(&out, &error);
    else
        glint_output_abort(&out);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

/* Removes the manifests of shards. */
static void remove_parts(const struct synth_set *set)
{
    char path[SYNTH_PATH_BYTES];
    DIR *const dir = opendir(set->folder);
    const struct dirent *entry;

    while (dir && (entry = readdir(dir)))
        if (fnmatch("manifest-[0-9]*-of-[0-9]*.jsonl", entry->d_name, 0) == 0 &&
            snprintf(path, sizeof path, "%s/%s", set->folder, entry->d_name) <
                (int)sizeof path)
            unlink(path);
    if (dir)
        closedir(dir);
}

int synth_set_end(const struct tool *tool, const struct synth_set *set,
                  bool *is_whole)
{
    char name[64];
    bool is_done = true;
    int code = check_count(tool, set); /* another process may have more */

    *is_whole = false;
    snprintf(name, sizeof name, "manifest-%d-of-%d.jsonl", set->shard,
             set->shards);
    if (code == EXIT_OK && set->shards > 1)
        code = write_lines(tool, set, name, set->shard, set->shards, &is_done);
    if (code == EXIT_OK && is_done)
        code = write_lines(tool, set, "manifest.jsonl", 0, 1, is_whole);
    if (code == EXIT_OK && *is_whole)
        remove_parts(set);
    return code;
}

/* ------------------------------------------------------------------- sheets */

/* Copies the picture PATH into TO, from its column LEFT on. */
static enum glint_status paste(const char *path, const struct glint_image *to,
                               int left, struct glint_error *error)
{
    struct glint_image image = {.plane = {NULL}};
    const enum glint_status status = glint_picture_load(path, &image, error);

    for (int y = 0; status == GLINT_OK && y < image.height && y < to->height &&
                    left + image.width <= to->width;
         y++)
        memcpy(to->plane[0] + y * to->stride_bytes[0] + 3 * (size_t)left,
               image.plane[0] + y * image.stride_bytes[0],
               3 * (size_t)image.width);
    glint_picture_free(&image);
    return status;
}

int synth_set_sheet(const struct tool *tool, const struct synth_set *set,
                    const struct synth_item *size, const char *path, int n)
{
    const int width = (int)size->width;
    char file[SYNTH_PATH_BYTES], caption[16];
    struct glint_error error = {""};
    struct sheet sheet = {.columns = 0};
    enum glint_status status;
    int columns = 0;

    while (columns < 3 && set->layout->file[columns].folder)
        columns++;
    status = sheet_open(&sheet, n, columns * width, (int)size->height, 1);
    for (int k = 0; k < n && status == GLINT_OK; k++) {
        const struct glint_image to = sheet_picture(&sheet, k);

        for (int i = 0; i < columns && status == GLINT_OK; i++) {
            synth_layout_path(file, set->folder, &set->layout->file[i], k,
                              set->type);
            status = paste(file, &to, i * width, &error);
        }
        snprintf(caption, sizeof caption, "%06d", k);
        sheet_caption(&sheet, k, caption);
    }
    if (status == GLINT_OK)
        status = glint_picture_save(path, &sheet.image, &error);
    sheet_close(&sheet);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}
