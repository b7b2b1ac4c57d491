/* SPDX-License-Identifier: MIT */
#include "synth/background.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "formats/picture.h"
#include "posix/error.h"
#include "posix/input.h"
#include "model/names.h"

/* ------------------------------------------------------------------ listing */

const char *synth_background_name(const char *path)
{
    const char *const slash = strrchr(path, '/');

    return slash ? slash + 1 : path;
}

static bool is_picture(const char *name)
{
    static const char *const ending[] = {
        ".ppm", ".pgm",  ".pnm",  ".pfm", ".png", ".jpg", ".jpeg", ".tif",
        ".bmp", ".webp", ".tiff", ".exr", ".hdr", ".tga", NULL};
    const char *const dot = strrchr(name, '.');

    for (int i = 0; dot && name[0] != '.' && ending[i]; i++)
        if (strcasecmp(dot, ending[i]) == 0)
            return true;
    return false;
}

static bool add(struct synth_backgrounds *list, const char *folder,
                const char *name)
{
    const size_t bytes = strlen(folder) + strlen(name) + 2;
    char **const more =
        realloc(list->path, ((size_t)list->n + 1) * sizeof *more);
    char *const path = malloc(bytes);

    if (more)
        list->path = more;
    if (!more || !path) {
        free(path);
        return false;
    }
    snprintf(path, bytes, "%s%s%s", folder, *folder ? "/" : "", name);
    list->path[list->n++] = path;
    return true;
}

static int add_folder(const struct tool *tool, struct synth_backgrounds *list,
                      const char *folder)
{
    const int before = list->n;
    DIR *const dir = opendir(folder);
    const struct dirent *entry;
    struct glint_error error;
    bool is_room = true;

    if (!dir)
        return tool_fail(
            tool,
            glint_error_report(&error, GLINT_E_IO, folder, "cannot be read"),
            error.text);
    while (is_room && (entry = readdir(dir)))
        if (is_picture(entry->d_name))
            is_room = add(list, folder, entry->d_name);
    closedir(dir);
    if (!is_room)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    if (list->n == before)
        return tool_fail(tool,
                         glint_error_report(&error, GLINT_E_IO, folder,
                                            "holds no pictures (.ppm, .png, "
                                            ".jpg ...)"),
                         error.text);
    return EXIT_OK;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(synth_background_name(*(char *const *)a),
                  synth_background_name(*(char *const *)b));
}

int synth_backgrounds_open(const struct tool *tool,
                           struct synth_backgrounds *list, char **words, int n)
{
    struct glint_error error;
    struct stat st;
    int code = EXIT_OK;

    *list = (struct synth_backgrounds){.n = 0};
    for (int i = 0; i < n && code == EXIT_OK; i++)
        if (stat(words[i], &st) < 0)
            code = tool_fail(tool,
                             glint_error_report(&error, GLINT_E_IO, words[i],
                                                "%s", strerror(errno)),
                             error.text);
        else if (S_ISDIR(st.st_mode))
            code = add_folder(tool, list, words[i]);
        else if (!add(list, "", words[i]))
            code = tool_fail(tool, GLINT_E_MEMORY, NULL);
    if (code != EXIT_OK)
        return code;
    qsort(list->path, (size_t)list->n, sizeof *list->path, by_name);
    for (int i = 0; i < list->n; i++) {
        if (strlen(synth_background_name(list->path[i])) >= SYNTH_NAME_BYTES)
            return tool_usage(tool, "%s: its name is too long", list->path[i]);
        if (i > 0 && by_name(&list->path[i - 1], &list->path[i]) == 0)
            return tool_usage(tool,
                              "%s and %s have one name, by which a manifest "
                              "would not tell them apart",
                              list->path[i - 1], list->path[i]);
    }
    return EXIT_OK;
}

void synth_backgrounds_close(struct synth_backgrounds *list)
{
    for (int i = 0; i < list->n; i++)
        free(list->path[i]);
    free(list->path);
}

/* ------------------------------------------------------------------ loading */

enum { MOST_BYTES = 1 << 30 };

enum glint_status synth_background_key(char key[20], const char *path,
                                       struct glint_error *error)
{
    uint64_t number = TOOL_KEY_BEGIN;
    uint8_t *data = NULL;
    size_t bytes;
    const enum glint_status status =
        glint_input_slurp(&data, &bytes, path, MOST_BYTES, error);

    if (status == GLINT_OK) {
        tool_key_mix(&number, data, bytes);
        snprintf(key, 20, "%016" PRIx64, number);
    }
    free(data);
    return status;
}

/* Sets TO to the light of FROM at (X, Y), pixels, between the four centres
 * around it. */
static void light_between(const struct glint_float_image *from, double x,
                          double y, double to[3])
{
    const double u = fmin(fmax(x - 0.5, 0), from->width - 1);
    const double v = fmin(fmax(y - 0.5, 0), from->height - 1);
    const int left = (int)u, top = (int)v;
    const int right = left + 1 < from->width ? left + 1 : left;
    const int low = top + 1 < from->height ? top + 1 : top;
    const float *const row = from->rgb + 3 * (size_t)top * (size_t)from->width;
    const float *const next = from->rgb + 3 * (size_t)low * (size_t)from->width;

    for (int c = 0; c < 3; c++) {
        const double a = row[3 * left + c], b = row[3 * right + c];
        const double d = next[3 * left + c], e = next[3 * right + c];
        const double over = a + (b - a) * (u - left);

        to[c] = over + (d + (e - d) * (u - left) - over) * (v - top);
    }
}

/* Takes the part of FROM that ITEM asks for: means of as many points a side of
 * each pixel as it covers pixels of FROM. */
static void take_part(const struct glint_float_image *from,
                      const struct synth_item *item, float *rgb)
{
    const int width = (int)item->width, height = (int)item->height;
    const double step = item->crop * fmin((double)from->width / width,
                                          (double)from->height / height);
    const double left = item->crop_x * (from->width - step * width);
    const double top = item->crop_y * (from->height - step * height);
    const int n = (int)fmin(ceil(step), 64);

    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const int column = item->mirrored > 0 ? width - 1 - x : x;
            float *const to = rgb + 3 * ((size_t)y * (size_t)width + (size_t)x);
            double sum[3] = {0, 0, 0}, one[3];

            for (int k = 0; k < n * n; k++) {
                const int across = k % n, down = k / n;

                light_between(from, left + step * (column + (across + 0.5) / n),
                              top + step * (y + (down + 0.5) / n), one);
                for (int c = 0; c < 3; c++)
                    sum[c] += one[c];
            }
            for (int c = 0; c < 3; c++)
                to[c] = (float)fmax(sum[c] / (n * n), 0);
        }
}

/* Brings the mean light of RGB to LEVEL, by no more stops than there may be;
 * returns these. */
static double bring(float *rgb, size_t n, double level)
{
    double sum = 0, ev;

    for (size_t i = 0; i < n; i++)
        sum += fmin(rgb[i], 1);
    ev = fmin(fmax(log2(level / fmax(sum / (double)n, 1e-6)), SYNTH_LEAST_EV),
              SYNTH_MOST_EV);
    for (size_t i = 0; i < n; i++)
        rgb[i] *= (float)exp2(ev);
    return ev;
}

/* Returns the path of ITEM's background, or NULL. */
static const char *find(const struct synth_backgrounds *list,
                        const struct synth_item *item)
{
    for (int i = 0; i < list->n; i++)
        if (strcmp(synth_background_name(list->path[i]), item->background) == 0)
            return list->path[i];
    return NULL;
}

enum glint_status synth_background_load(const struct synth_backgrounds *list,
                                        const struct synth_item *item,
                                        float *rgb, double *ev,
                                        struct glint_error *error)
{
    const char *const path = find(list, item);
    struct glint_float_image image = {.rgb = NULL};
    char key[20] = "";
    enum glint_status status;

    if (!path)
        return glint_error_report(error, GLINT_E_IO, item->background,
                                  "is not among the backgrounds");
    status = synth_background_key(key, path, error);
    if (status == GLINT_OK && strcmp(key, item->background_key) != 0)
        return glint_error_report(error, GLINT_E_IO, path,
                                  "is not the picture that the item was drawn "
                                  "on: its key is %s, not %s",
                                  key, item->background_key);
    if (status == GLINT_OK)
        status = glint_picture_load_float(path, &image, error);
    if (status != GLINT_OK)
        return status;
    take_part(&image, item, rgb);
    free(image.rgb);
    *ev =
        bring(rgb, 3 * (size_t)item->width * (size_t)item->height, item->level);
    return GLINT_OK;
}
