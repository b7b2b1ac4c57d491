/* SPDX-License-Identifier: MIT
 *
 * glint synth: writes data sets for training flare removal.
 *
 * Several processes can write to the folder of a set, be killed, and continue.
 * Every file is written under a temporary name and renamed when it is complete.
 * The item's description, items/NUMBER.json, is written last. An item exists if
 * its description and all its images exist. The manifest contains all
 * descriptions in order; it is written when all items exist.
 */
#include <dirent.h>
#include <errno.h>
#include <fnmatch.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "glint/measure.h"
#include "formats/picture.h"
#include "model/lens_files.h"
#include "options/command_line.h"
#include "posix/input.h"
#include "synth/draw.h"
#include "posix/output.h"

enum { SYNTH_MAX_FILES = 6, SYNTH_PATH_BYTES = 4096 };

/* An output file that each item of the data set has */
struct synth_file {
    /* folder, and beginning of the file name, before the item number */
    const char *folder, *prefix;
    /* layers to sum, one bit per enum synth_layer; 0: coverage of each pixel by
     * lights */
    unsigned layers;
    bool is_noisy; /* whether sensor noise is added */
};

struct synth_layout {
    const char *name, *type; /* name of the layout, and its default file type */
    /* files of each item; ends with an entry whose folder is NULL */
    struct synth_file file[SYNTH_MAX_FILES];
};

struct synth_set {
    const char *folder, *type;
    const struct synth_layout *layout;
    /* this process draws the items shard, shard + shards, ... up to count -
     * 1 */
    int count, shard, shards;
};

#define BASE   (1u << SYNTH_BASE)
#define SOURCE (1u << SYNTH_SOURCE)
#define GLARE  (1u << SYNTH_GLARE)
#define GHOSTS (1u << SYNTH_GHOSTS)

static const struct synth_layout layouts[] = {
    {"plain",
     "ppm",
     {{"input/", "", BASE | SOURCE | GLARE | GHOSTS, true},
      {"gt/", "", BASE | SOURCE, false},
      {"flare/", "", GLARE | GHOSTS, false},
      {"mask/", "", 0, false}}},
    /* Layout of [Dai22]: flares on black, which the data loader of [Dai22] adds
     * to other images, and pairs for testing */
    {"flare7k",
     "png",
     {{"Flare7K/Scattering_Flare/Compound_Flare/", "", SOURCE | GLARE, false},
      {"Flare7K/Scattering_Flare/Light_Source/", "", SOURCE, false},
      {"Flare7K/Reflective_Flare/", "", GHOSTS, false},
      {"test_data/synthetic/input/", "input_", BASE | SOURCE | GLARE | GHOSTS,
       true},
      {"test_data/synthetic/gt/", "gt_", BASE | SOURCE, false},
      {"test_data/synthetic/mask/", "mask_", 0, false}}},
    /* Layout of the test set of [Dai23]: pairs that differ in ghosts only */
    {"bracketflare",
     "png",
     {{"test/lq/", "", BASE | SOURCE | GHOSTS, true},
      {"test/gt/", "", BASE | SOURCE, false},
      {"test/flare/", "", GHOSTS, false},
      {"test/mask/", "", 0, false}}},
    /* Layout of [Wu21]: flares on black, and scenes to which the programs of
     * [Wu21] add the flares */
    {"wu2021",
     "png",
     {{"lens-flare/simulated/", "", SOURCE | GLARE | GHOSTS, false},
      {"scenes/", "", BASE, false}}},
};

static const struct synth_layout *find_layout_by_name(const char *name)
{
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        if (strcmp(layouts[i].name, name) == 0)
            return &layouts[i];
    return NULL;
}

/* Sets PATH to the path of FILE for item NUMBER in FOLDER. Returns false if
 * PATH is too long. */
static bool make_item_file_path(char path[SYNTH_PATH_BYTES], const char *folder,
                                const struct synth_file *file, int number,
                                const char *type)
{
    return snprintf(path, SYNTH_PATH_BYTES, "%s/%s%s%06d.%s", folder,
                    file->folder, file->prefix, number,
                    type) < SYNTH_PATH_BYTES;
}

static int report_long_folder_name(const struct tool *tool,
                                   const struct synth_set *set)
{
    return tool_usage(tool, "-o %s: the name is too long", set->folder);
}

static bool make_description_path(char path[SYNTH_PATH_BYTES],
                                  const struct synth_set *set, int number)
{
    static const struct synth_file lines = {"items/", "", 0, false};

    return make_item_file_path(path, set->folder, &lines, number, "json");
}

/* ------------------------------------------------------------------ folders */

/* Creates the folders in PATH, which precede its last slash. Returns an exit
 * code. */
static int create_folder(const struct tool *tool, char *path)
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

static int create_set_folders(const struct tool *tool,
                              const struct synth_set *set)
{
    char path[SYNTH_PATH_BYTES];
    int code = EXIT_OK;

    for (int i = 0;
         i < SYNTH_MAX_FILES && set->layout->file[i].folder && code == EXIT_OK;
         i++) {
        if (!make_item_file_path(path, set->folder, &set->layout->file[i], 0,
                                 set->type))
            return report_long_folder_name(tool, set);
        code = create_folder(tool, path);
    }
    if (code != EXIT_OK)
        return code;
    return make_description_path(path, set, 0)
               ? create_folder(tool, path)
               : report_long_folder_name(tool, set);
}

/* Rejects --item into a folder with a set, because the file would overwrite an
 * item of the set. */
static int check_folder_contains_no_set(const struct tool *tool,
                                        const struct synth_set *set)
{
    char path[SYNTH_PATH_BYTES];

    snprintf(path, sizeof path, "%s/synth.json", set->folder);
    if (access(path, F_OK) != 0)
        return EXIT_OK;
    return tool_usage(
        tool, "%s already contains a set (%s): name another folder for --item",
        set->folder, path);
}

/* Rejects a count that would omit existing items of SET from its manifest.
 * Returns an exit code. */
static int check_item_count(const struct tool *tool,
                            const struct synth_set *set)
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
    /* With a count of 0 no items are drawn. */
    if (set->count == 0 || last < set->count)
        return EXIT_OK;
    return tool_usage(tool,
                      "%s has items up to %ld, and --count %d would leave some "
                      "out: use --count %ld or more, or name another folder",
                      set->folder, last, set->count, last + 1);
}

/* Creates the folders of SET. SETTINGS is a JSON line with the settings of all
 * items. Returns an exit code: EXIT_USAGE if the folder contains a set with
 * other settings, or with more items than SET's count. */
static int open_item_set(const struct tool *tool, const struct synth_set *set,
                         const char *settings)
{
    enum { MOST_BYTES = 1 << 26 };
    char path[SYNTH_PATH_BYTES];
    struct glint_error error = {""};
    enum glint_status status;
    uint8_t *kept = NULL;
    size_t bytes = 0;
    bool is_same;
    int code = create_set_folders(tool, set);

    snprintf(path, sizeof path, "%s/synth.json", set->folder);
    if (code != EXIT_OK)
        return code;
    if (access(path, F_OK) != 0)
        return EXIT_OK;
    status =
        glint_input_read_whole_file(&kept, &bytes, path, MOST_BYTES, &error);
    is_same = status == GLINT_OK && bytes == strlen(settings) &&
              memcmp(kept, settings, bytes) == 0;
    free(kept);
    if (status != GLINT_OK)
        return tool_fail(tool, status, error.text);
    return is_same ? check_item_count(tool, set)
                   : tool_usage(tool,
                                "%s was made with other options or backgrounds "
                                "(%s): use those, or name another folder",
                                set->folder, path);
}

/* Writes SETTINGS to synth.json, unless the file exists. Returns an exit code.
 */
static int write_set_settings(const struct tool *tool,
                              const struct synth_set *set, const char *settings)
{
    char path[SYNTH_PATH_BYTES];

    snprintf(path, sizeof path, "%s/synth.json", set->folder);
    return access(path, F_OK) == 0
               ? EXIT_OK
               : tool_save_file(tool, path, GLINT_OUTPUT_TEXT, settings,
                                strlen(settings));
}

/* -------------------------------------------------------------------- items */

static bool is_item_complete(const struct synth_set *set, int number)
{
    const struct synth_file *const file = set->layout->file;
    char path[SYNTH_PATH_BYTES];
    bool is_there =
        make_description_path(path, set, number) && access(path, F_OK) == 0;

    for (int i = 0; i < SYNTH_MAX_FILES && file[i].folder && is_there; i++)
        is_there = make_item_file_path(path, set->folder, &file[i], number,
                                       set->type) &&
                   access(path, F_OK) == 0;
    return is_there;
}

static enum glint_status write_item_file(const struct synth_set *set,
                                         const struct synth_file *file,
                                         const struct synth_item *item,
                                         const struct synth_drawing *d,
                                         float *rgb, struct glint_error *error)
{
    const size_t n = 3 * (size_t)d->width * (size_t)d->height;
    const struct glint_float_image light = {d->width, d->height, rgb};
    struct glint_image image = {
        .format = GLINT_RGB24, .width = d->width, .height = d->height};
    char path[SYNTH_PATH_BYTES];
    enum glint_status status;
    uint8_t *codes;

    make_item_file_path(path, set->folder, file, (int)item->number, set->type);
    if (file->layers)
        synth_sum_layers(d, file->layers, rgb);
    if (file->is_noisy)
        synth_add_noise(item, rgb);
    if (file->layers) {
        codes = glint_measure_encode(&light, 1);
    } else if ((codes = malloc(n))) {
        /* a coverage fraction is not light, so it is stored without the sRGB
         * curve */
        for (size_t i = 0; i < n; i++)
            codes[i] = (uint8_t)(d->cover[i] * 255 + 0.5F);
    }
    if (!codes)
        return GLINT_E_MEMORY;
    glint_image_place(&image, codes);
    status = glint_picture_save(path, &image, error);
    free(codes);
    return status;
}

/* Writes the files of ITEM, then its description. Returns an exit code. */
static int write_item_files(const struct tool *tool,
                            const struct synth_set *set,
                            const struct synth_item *item,
                            const struct synth_result *result,
                            const struct synth_drawing *drawing)
{
    const size_t n = 3 * (size_t)drawing->width * (size_t)drawing->height;
    const struct synth_file *const file = set->layout->file;
    float *const rgb = malloc(n * sizeof *rgb);
    char *const line = synth_item_format_json(item, result);
    char path[SYNTH_PATH_BYTES];
    struct glint_error error = {""};
    enum glint_status status = rgb && line ? GLINT_OK : GLINT_E_MEMORY;
    int code = EXIT_OK;

    for (int i = 0; i < SYNTH_MAX_FILES && file[i].folder && status == GLINT_OK;
         i++)
        status = write_item_file(set, &file[i], item, drawing, rgb, &error);
    free(rgb);
    make_description_path(path, set, (int)item->number);
    if (status != GLINT_OK)
        code = tool_fail(tool, status, error.text);
    else if (line)
        code =
            tool_save_file(tool, path, GLINT_OUTPUT_TEXT, line, strlen(line));
    free(line);
    return code;
}

/* ---------------------------------------------------------------- manifests */

static enum glint_status append_file_to_stream(struct glint_output *out,
                                               const char *path,
                                               struct glint_error *error)
{
    uint8_t part[4096]; /* size of a read; a description with three lights
                           has 1.5 KiB */
    struct glint_input in;
    enum glint_status status = glint_input_open_file(&in, path, error);
    ptrdiff_t n = 0;

    while (status == GLINT_OK &&
           (n = glint_input_read_available(&in, part, sizeof part)) > 0)
        status = glint_output_write(out, part, (size_t)n, error);
    if (n < 0)
        status =
            glint_error_report(error, GLINT_E_IO, path, "%s", strerror(errno));
    glint_input_close(&in);
    return status;
}

/* Writes the descriptions of items FIRST, FIRST + STEP, ... to the file NAME
 * and sets *IS_WHOLE to true. If an item is missing, writes nothing and sets
 * *IS_WHOLE to false. */
static int write_item_descriptions(const struct tool *tool,
                                   const struct synth_set *set,
                                   const char *name, int first, int step,
                                   bool *is_whole)
{
    char path[SYNTH_PATH_BYTES], line[SYNTH_PATH_BYTES];
    struct glint_error error = {""};
    struct glint_output out;
    enum glint_status status;

    *is_whole = true;
    for (int i = first; i < set->count && *is_whole; i += step)
        *is_whole = is_item_complete(set, i);
    if (!*is_whole)
        return EXIT_OK;
    snprintf(path, sizeof path, "%s/%s", set->folder, name);
    status = glint_output_open(&out, path, GLINT_OUTPUT_TEXT, &error);
    for (int i = first; i < set->count && status == GLINT_OK; i += step) {
        make_description_path(line, set, i);
        status = append_file_to_stream(&out, line, &error);
    }
    status = glint_output_commit_or_abort(&out, status, &error);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

static void remove_shard_manifests(const struct synth_set *set)
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

/* Writes the manifest of this shard if all items of the shard exist. If all
 * items of the set exist, replaces the manifests of all shards by that of the
 * set and sets *IS_WHOLE to true. Returns an exit code. */
static int write_shard_manifest(const struct tool *tool,
                                const struct synth_set *set, bool *is_whole)
{
    char name[64];
    bool is_done = true;
    /* Another process may have drawn more items since the first check. */
    int code = check_item_count(tool, set);

    *is_whole = false;
    snprintf(name, sizeof name, "manifest-%d-of-%d.jsonl", set->shard,
             set->shards);
    if (code == EXIT_OK && set->shards > 1)
        code = write_item_descriptions(tool, set, name, set->shard, set->shards,
                                       &is_done);
    if (code == EXIT_OK && is_done)
        code = write_item_descriptions(tool, set, "manifest.jsonl", 0, 1,
                                       is_whole);
    if (code == EXIT_OK && *is_whole)
        remove_shard_manifests(set);
    return code;
}

static const char help[] =
    "glint synth BACKGROUNDS... -o FOLDER [options]\n"
    "glint synth BACKGROUNDS... -o FOLDER --item LINE\n"
    "\n"
    "Draws pairs of pictures to train flare removal with. An input is a "
    "picture\n"
    "of BACKGROUNDS (files or folders) with the flares of random lights "
    "behind\n"
    "real lenses; light is added before the sensor clips it. FOLDER gets "
    "input,\n"
    "gt (the picture with the lights but without flare), flare, mask (where "
    "the\n"
    "lights are), and manifest.jsonl, one line per item. The same options "
    "give\n"
    "the same bytes, in one run or in shards. A run that was killed continues "
    "if\n"
    "it is started again.\n"
    "\n"
    "  -o, --output FOLDER\n"
    "  --count N           number of items (default 100); a larger N continues "
    "a\n"
    "                      set, a smaller N is rejected; 0: bake the lenses "
    "only\n"
    "  --seed S            seed of the random numbers (default 0)\n"
    "  --shard I/N         draw items I, I + N, I + 2N ...; I from 0\n"
    "  --size WxH          size of the pictures, sides of 16 to 8192 (default\n"
    "                      512x512)\n"
    "  --lenses LIST       names or files separated by commas, or all, which "
    "bakes\n"
    "                      for minutes (default heliar-tronnier,\n"
    "                      double-gauss-angenieux,nikon-zoom-short)\n"
    "  --coating C         coating of all lenses; values of glint overlay\n"
    "                      (default mixed)\n"
    "  --range NAME=LO,HI  range of a random parameter; repeatable; list: "
    "print\n"
    "                      names, ranges and distributions\n"
    "  --layout L          plain | flare7k | bracketflare | wu2021: folders "
    "and\n"
    "                      names that the loaders of these data sets expect\n"
    "  --type T            ppm, png, jpg ... (default ppm for plain, else "
    "png)\n"
    "  --item LINE         draw this line of a manifest alone, with the same "
    "bytes\n"
    "  --quality Q         0 to 1, the --quality of glint render (default "
    "0.5)\n";

static const char help_end[] =
    "  -j, --threads N     threads for each picture (default: all "
    "processors);\n"
    "                      shards scale better. The result does not depend on "
    "N\n"
    "  --kernels K   --json   -q   -v   --help   --version\n";

static const char default_lenses[] =
    "heliar-tronnier,double-gauss-angenieux,nikon-zoom-short";

enum {
    OPT_COUNT = 2000,
    OPT_SHARD,
    OPT_SIZE,
    OPT_LENSES,
    OPT_COATING_OF,
    OPT_RANGE,
    OPT_LAYOUT,
    OPT_TYPE,
    OPT_ITEM,
    OPT_QUALITY_OF,
    MAX_COUNT = 100000000
};

static const struct option options[] = {
    {"output", required_argument, NULL, 'o'},
    {"count", required_argument, NULL, OPT_COUNT},
    {"shard", required_argument, NULL, OPT_SHARD},
    {"size", required_argument, NULL, OPT_SIZE},
    {"lenses", required_argument, NULL, OPT_LENSES},
    {"coating", required_argument, NULL, OPT_COATING_OF},
    {"range", required_argument, NULL, OPT_RANGE},
    {"layout", required_argument, NULL, OPT_LAYOUT},
    {"type", required_argument, NULL, OPT_TYPE},
    {"item", required_argument, NULL, OPT_ITEM},
    {"quality", required_argument, NULL, OPT_QUALITY_OF},
    TOOL_COMMON_OPTIONS};

struct synth {
    struct synth_set set;
    struct synth_ranges ranges;
    struct synth_backgrounds backgrounds;
    /* hashes of the backgrounds, [backgrounds.n]; empty: not computed yet */
    char (*keys)[20];
    struct synth_lenses lenses;
    int n_lenses;
    char lens[SYNTH_MAX_LENSES][64];
    struct synth_item all; /* settings that are the same for all items */
    struct synth_drawing drawing;
    const char *line;
};

/* ------------------------------------------------------------------ options */

/* Parses the shard TEXT, "I/N". */
static bool parse_shard_number(struct synth_set *set, const char *text)
{
    char first[16];
    const size_t n = strcspn(text, "/");

    if (n >= sizeof first || text[n] != '/')
        return false;
    memcpy(first, text, n);
    first[n] = '\0';
    return tool_parse_integer(text + n + 1, 1, MAX_COUNT, &set->shards) &&
           tool_parse_integer(first, 0, set->shards - 1, &set->shard);
}

static bool add_lens_name(void *ctx, const char *name)
{
    struct synth *const s = ctx;

    if (s->n_lenses == SYNTH_MAX_LENSES || strlen(name) >= sizeof *s->lens)
        return false;
    snprintf(s->lens[s->n_lenses++], sizeof *s->lens, "%s", name);
    return true;
}

/* Parses TEXT, lens names separated by commas, or "all". */
static bool parse_lens_list(struct synth *s, const char *text)
{
    char name[64];

    s->n_lenses = 0;
    if (strcmp(text, "all") == 0)
        return lens_files_visit_all(add_lens_name, s) > 0;
    for (;;) {
        const size_t n = strcspn(text, ",");

        if (n == 0 || n >= sizeof name)
            return false;
        memcpy(name, text, n);
        name[n] = '\0';
        if (!add_lens_name(s, name))
            return false;
        if (!text[n])
            return true;
        text += n + 1;
    }
}

static bool parse_image_size(struct synth_item *item, const char *text)
{
    int width, height;

    if (!tool_parse_size(text, &width, &height) || width < 16 || height < 16 ||
        width > 8192 || height > 8192)
        return false;
    item->width = width;
    item->height = height;
    return true;
}

static bool parse_quality(struct synth_item *item, const char *text)
{
    struct glint_options probe;
    struct glint_error error;

    glint_options_defaults(&probe);
    if (glint_options_set_text(&probe, "quality", text, &error) != GLINT_OK ||
        probe.rays == GLINT_RAYS_EXACT)
        return false;
    item->quality = probe.quality;
    return true;
}

static int parse_coating(const struct tool *tool, struct synth *s,
                         const char *text)
{
    struct coating probe = {.given = false};
    const int code = coating_parse_option(tool, &probe, text);

    if (code < 0 && strlen(text) >= sizeof s->all.coating)
        return tool_usage(tool, "the list of --coating is too long");
    snprintf(s->all.coating, sizeof s->all.coating, "%s", text);
    return code;
}

static int parse_parameter_range(const struct tool *tool, struct synth *s,
                                 const char *text)
{
    struct glint_error why = {""};

    if (strcmp(text, "list") == 0) {
        synth_ranges_print(stdout, &s->ranges);
        return EXIT_OK;
    }
    return synth_ranges_parse(&s->ranges, text, &why)
               ? -1
               : tool_usage(tool, "--range: %s", why.text);
}

static int parse_option(struct tool *tool, void *ctx, int c, const char *value)
{
    struct synth *const s = ctx;
    bool good = true;

    switch (c) {
    case 'o':
        s->set.folder = value;
        break;
    case OPT_COUNT:
        good = tool_parse_integer(value, 0, MAX_COUNT, &s->set.count);
        break;
    case OPT_SHARD:
        good = parse_shard_number(&s->set, value);
        break;
    case OPT_SIZE:
        good = parse_image_size(&s->all, value);
        break;
    case OPT_LENSES:
        good = parse_lens_list(s, value);
        break;
    case OPT_COATING_OF:
        return parse_coating(tool, s, value);
    case OPT_RANGE:
        return parse_parameter_range(tool, s, value);
    case OPT_LAYOUT:
        s->set.layout = find_layout_by_name(value);
        good = s->set.layout != NULL;
        break;
    case OPT_TYPE:
        s->set.type = value;
        break;
    case OPT_ITEM:
        s->line = value;
        break;
    case OPT_QUALITY_OF:
        good = parse_quality(&s->all, value);
        break;
    default:
        return tool_apply_option(tool, c, value);
    }
    return good ? -1 : -2;
}

/* Sets the layout's file type if none was requested, and checks that images
 * of the type can be written. */
static int set_layout_file_type(const struct tool *tool, struct synth *s)
{
    const bool is_asked = s->set.type != NULL;
    struct glint_error error = {""};
    char name[64];

    if (!is_asked)
        s->set.type = s->set.layout->type;
    snprintf(name, sizeof name, "input.%.50s", s->set.type);
    if (!strpbrk(s->set.type, "/%") &&
        glint_picture_check(name, GLINT_PICTURE_8BIT, &error) == GLINT_OK)
        return EXIT_OK;
    if (!is_asked)
        return tool_usage(tool, "--layout %s: %s; or use --type ppm",
                          s->set.layout->name, error.text);
    return tool_usage(tool, "--type %s: %s", s->set.type,
                      *error.text ? error.text : "not a picture type");
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct synth *s)
{
    int code = tool_parse_options(tool, argc, argv, "o:" TOOL_COMMON_SHORT,
                                  options, parse_option, s);

    if (code >= 0)
        return code;
    if (optind == argc)
        return tool_usage(
            tool, "needs backgrounds: pictures, or folders of pictures");
    if (!s->set.folder || !*s->set.folder)
        return tool_usage(tool, "needs -o FOLDER");
    code = set_layout_file_type(tool, s);
    return code == EXIT_OK ? -1 : code;
}

/* -------------------------------------------------------------------- items */

/* Returns the settings shared by all items as a JSON line, which the caller
 * frees; NULL without memory. */
static char *format_set_settings(const struct synth *s, int seed)
{
    char *text = NULL;
    size_t bytes = 0;
    struct json_writer json = {.to = glint_memory_file_open(&text, &bytes)};

    if (!json.to)
        return NULL;
    json_write(&json,
               "{glint: %s, seed: %d, width: %.0f, height: %.0f, "
               "quality: %.6f, layout: %s, type: %s, coating: %s, lenses: [",
               GLINT_VERSION, seed, s->all.width, s->all.height, s->all.quality,
               s->set.layout->name, s->set.type, s->all.coating);
    for (int i = 0; i < s->n_lenses; i++)
        json_write(&json, "%s", s->lens[i]);
    json_write(&json, "], ranges: {");
    synth_ranges_write_json(&json, &s->ranges);
    json_write(&json, "}, backgrounds: [");
    for (int i = 0; i < s->backgrounds.n; i++)
        json_write(&json, "%s",
                   synth_background_file_name(s->backgrounds.path[i]));
    json_write(&json, "]}\n");
    if (glint_memory_file_close(json.to))
        return text;
    free(text);
    return NULL;
}

static int choose_item_parameters(const struct tool *tool, struct synth *s,
                                  int number, struct synth_item *item)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    int k;

    *item = s->all;
    synth_item_randomise(item, &s->ranges, tool->seed, number);
    snprintf(item->lens, sizeof item->lens, "%s",
             s->lens[synth_item_draw_random_index(item, "lens", s->n_lenses)]);
    k = synth_item_draw_random_index(item, "background", s->backgrounds.n);
    snprintf(item->background, sizeof item->background, "%s",
             synth_background_file_name(s->backgrounds.path[k]));
    if (!s->keys[k][0])
        status =
            synth_hash_background(s->keys[k], s->backgrounds.path[k], &error);
    memcpy(item->background_key, s->keys[k], sizeof s->keys[k]);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

static int draw_item(const struct tool *tool, struct synth *s,
                     const struct synth_item *item)
{
    struct synth_result result;
    const int code = synth_draw_item(tool, &s->lenses, &s->backgrounds, item,
                                     &s->drawing, &result);

    return code == EXIT_OK
               ? write_item_files(tool, &s->set, item, &result, &s->drawing)
               : code;
}

static int init_item_drawing(const struct tool *tool, struct synth *s,
                             const struct synth_item *item)
{
    const enum glint_status status =
        synth_drawing_init(&s->drawing, (int)item->width, (int)item->height);

    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, NULL);
}

static int draw_described_item(const struct tool *tool, struct synth *s)
{
    struct glint_error error = {""};
    struct synth_item item;
    const enum glint_status status =
        synth_item_parse_json(&item, s->line, &error);
    int code =
        status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);

    if (code == EXIT_OK && strcmp(item.glint, GLINT_VERSION) != 0 &&
        !tool->quiet)
        fprintf(stderr,
                "glint synth: the item was drawn by glint %s; this is glint "
                "%s, which may draw it slightly differently\n",
                item.glint, GLINT_VERSION);
    if (code == EXIT_OK)
        code = check_folder_contains_no_set(tool, &s->set);
    if (code == EXIT_OK)
        code = create_set_folders(tool, &s->set);
    if (code == EXIT_OK)
        code = init_item_drawing(tool, s, &item);
    return code == EXIT_OK ? draw_item(tool, s, &item) : code;
}

/* Opens every lens before the first item is drawn, so that models are baked and
 * wrong names are reported early. */
static int open_all_lenses(const struct tool *tool, struct synth *s)
{
    int code = EXIT_OK;

    for (int i = 0; i < s->n_lenses && code == EXIT_OK; i++) {
        struct synth_item item = s->all;
        struct synth_lens *ignored;

        snprintf(item.lens, sizeof item.lens, "%s", s->lens[i]);
        code = synth_lens_open(tool, &s->lenses, &item, &ignored);
    }
    return code;
}

/* Draws all items of the shard that do not exist yet. */
static int draw_missing_items(const struct tool *tool, struct synth *s)
{
    const struct synth_set *const set = &s->set;
    struct tool_progress progress;
    struct synth_item item;
    int code = EXIT_OK, left = 0, done = 0;

    for (int i = set->shard; i < set->count; i += set->shards)
        left += !is_item_complete(set, i);
    tool_progress_start(&progress, tool, "synth");
    for (int i = set->shard; i < set->count && code == EXIT_OK;
         i += set->shards) {
        if (is_item_complete(set, i))
            continue;
        code = choose_item_parameters(tool, s, i, &item);
        if (code == EXIT_OK)
            code = draw_item(tool, s, &item);
        tool_progress_show(&progress, (double)++done / left);
    }
    tool_progress_end(&progress);
    return code;
}

static int draw_item_set(const struct tool *tool, struct synth *s)
{
    bool is_whole = false;
    char *settings;
    int code;

    settings = format_set_settings(s, tool->seed);
    if (!settings)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    code = open_item_set(tool, &s->set, settings);
    if (code == EXIT_OK)
        code = open_all_lenses(tool, s);
    if (code == EXIT_OK)
        code = write_set_settings(tool, &s->set, settings);
    free(settings);
    if (code == EXIT_OK)
        code = init_item_drawing(tool, s, &s->all);
    if (code == EXIT_OK)
        code = draw_missing_items(tool, s);
    if (code == EXIT_OK && s->set.count > 0)
        code = write_shard_manifest(tool, &s->set, &is_whole);
    if (code == EXIT_OK && !tool->quiet && s->set.count > 0)
        fprintf(stderr, "glint synth: %s: %s %d items\n", s->set.folder,
                is_whole
                    ? "all"
                    : "all items of this shard, but not yet of all shards, of",
                s->set.count);
    return code;
}

static void close_synth(struct synth *s)
{
    synth_lenses_close(&s->lenses);
    synth_backgrounds_close(&s->backgrounds);
    synth_drawing_finish(&s->drawing);
    free(s->keys);
    free(s);
}

int cmd_synth(int argc, char **argv)
{
    struct tool tool = {.name = "synth", .help = help, .help_end = help_end};
    struct synth *const s = calloc(1, sizeof *s);
    int code;

    if (!s)
        return tool_fail(&tool, GLINT_E_MEMORY, NULL);
    s->set = (struct synth_set){
        .layout = find_layout_by_name("plain"), .count = 100, .shards = 1};
    s->all = (struct synth_item){.width = 512,
                                 .height = 512,
                                 .quality = 0.5,
                                 .glint = GLINT_VERSION,
                                 .coating = "mixed"};
    synth_ranges_set_defaults(&s->ranges);
    parse_lens_list(s, default_lenses);
    code = parse_options(&tool, argc, argv, s);
    if (code < 0) {
        code = synth_backgrounds_open(&tool, &s->backgrounds, argv + optind,
                                      argc - optind);
        s->keys = calloc((size_t)s->backgrounds.n + 1, sizeof *s->keys);
        if (code == EXIT_OK && !s->keys)
            code = tool_fail(&tool, GLINT_E_MEMORY, NULL);
        if (code == EXIT_OK)
            code = tool_start_threads(&tool);
        if (code == EXIT_OK)
            code = s->line ? draw_described_item(&tool, s)
                           : draw_item_set(&tool, s);
        tool_stop_threads(&tool);
    }
    close_synth(s);
    return code;
}
