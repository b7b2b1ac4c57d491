/* SPDX-License-Identifier: MIT
 *
 * glint synth: data sets for flare removal.
 */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "formats/picture.h"
#include "model/lens_files.h"
#include "options/command_line.h"
#include "synth/set.h"

static const char help[] =
    "glint synth BACKGROUNDS... -o FOLDER [options]\n"
    "glint synth BACKGROUNDS... -o FOLDER --item LINE\n"
    "\n"
    "Draws pairs to train flare removal with: pictures of BACKGROUNDS, files\n"
    "or folders, with the flares of random lights behind real lenses, as a\n"
    "sensor sees them, and what they should become. Light is added before it\n"
    "is clipped. FOLDER gets input, gt (with the lights themselves), flare\n"
    "and mask (where lights are), and manifest.jsonl, a line an item. The\n"
    "same options give the same bytes, in one run or in shards; a run that\n"
    "was killed is begun again and goes on.\n"
    "\n"
    "  -o, --output FOLDER\n"
    "  --count N           items (default 100); more later go on, fewer are\n"
    "                      refused; 0: bakes the lenses only\n"
    "  --seed S            another set for each (default 0)\n"
    "  --shard I/N         items I, I + N, I + 2N ...; I from 0\n"
    "  --size WxH          of the pictures, sides of 16 to 8192 (default\n"
    "                      512x512)\n"
    "  --lenses LIST       names or files with commas, or all, which bakes "
    "for\n"
    "                      minutes (default heliar-tronnier,\n"
    "                      double-gauss-angenieux,nikon-zoom-short)\n"
    "  --coating C         of all lenses, as of glint overlay (default mixed)\n"
    "  --range NAME=LO,HI  what a number is drawn from; repeatable; list: "
    "prints\n"
    "                      names, ranges and laws\n"
    "  --layout L          plain | flare7k | bracketflare | wu2021: folders\n"
    "                      and names as the loaders of these look for them\n"
    "  --type T            ppm, png, jpg ... (default ppm of plain, else png)\n"
    "  --item LINE         that line of a manifest alone, the same bytes\n"
    "  --sheet FILE        at the end, a picture of the first 40 items\n"
    "  --quality Q         0 to 1, as of glint render (default 0.5)\n";

static const char help_end[] =
    "  -j, --threads N     for each picture (default: all processors); shards\n"
    "                      share out more evenly. Never changes a result\n"
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
    OPT_SHEET,
    OPT_QUALITY_OF,
    SHEET_ITEMS = 40,
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
    {"sheet", required_argument, NULL, OPT_SHEET},
    {"quality", required_argument, NULL, OPT_QUALITY_OF},
    TOOL_COMMON_OPTIONS};

struct synth {
    struct synth_set set;
    struct synth_ranges ranges;
    struct synth_backgrounds backgrounds;
    char (*keys)[20]; /* [backgrounds.n]; empty: not read yet */
    struct synth_lenses lenses;
    int n_lenses;
    char lens[SYNTH_MAX_LENSES][64];
    struct synth_item all; /* what every item has */
    struct synth_drawing drawing;
    const char *line, *sheet;
};

/* ------------------------------------------------------------------ options */

/* Takes TEXT, "I/N". */
static bool take_shard(struct synth_set *set, const char *text)
{
    char first[16];
    const size_t n = strcspn(text, "/");

    if (n >= sizeof first || text[n] != '/')
        return false;
    memcpy(first, text, n);
    first[n] = '\0';
    return tool_integer(text + n + 1, 1, MAX_COUNT, &set->shards) &&
           tool_integer(first, 0, set->shards - 1, &set->shard);
}

static bool add_lens(void *ctx, const char *name)
{
    struct synth *const s = ctx;

    if (s->n_lenses == SYNTH_MAX_LENSES || strlen(name) >= sizeof *s->lens)
        return false;
    snprintf(s->lens[s->n_lenses++], sizeof *s->lens, "%s", name);
    return true;
}

/* Takes TEXT, names with commas, or "all". */
static bool take_lenses(struct synth *s, const char *text)
{
    char name[64];

    s->n_lenses = 0;
    if (strcmp(text, "all") == 0)
        return lens_files_each(add_lens, s) > 0;
    for (;;) {
        const size_t n = strcspn(text, ",");

        if (n == 0 || n >= sizeof name)
            return false;
        memcpy(name, text, n);
        name[n] = '\0';
        if (!add_lens(s, name))
            return false;
        if (!text[n])
            return true;
        text += n + 1;
    }
}

static bool take_size(struct synth_item *item, const char *text)
{
    int width, height;

    if (!tool_size(text, &width, &height) || width < 16 || height < 16 ||
        width > 8192 || height > 8192)
        return false;
    item->width = width;
    item->height = height;
    return true;
}

static bool take_quality(struct synth_item *item, const char *text)
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

static int take_coating(const struct tool *tool, struct synth *s,
                        const char *text)
{
    struct coating probe = {.given = false};
    const int code = coating_take(tool, &probe, text);

    if (code < 0 && strlen(text) >= sizeof s->all.coating)
        return tool_usage(tool, "--coating is too long a list");
    snprintf(s->all.coating, sizeof s->all.coating, "%s", text);
    return code;
}

static int take_range(const struct tool *tool, struct synth *s,
                      const char *text)
{
    struct glint_error why = {""};

    if (strcmp(text, "list") == 0) {
        synth_ranges_print(stdout, &s->ranges);
        return EXIT_OK;
    }
    return synth_ranges_take(&s->ranges, text, &why)
               ? -1
               : tool_usage(tool, "--range: %s", why.text);
}

static int take(struct tool *tool, struct synth *s, int c)
{
    switch (c) {
    case 'o':
        s->set.folder = optarg;
        return -1;
    case OPT_COUNT:
        return tool_integer(optarg, 0, MAX_COUNT, &s->set.count)
                   ? -1
                   : tool_refuse(tool, "count", optarg);
    case OPT_SHARD:
        return take_shard(&s->set, optarg) ? -1
                                           : tool_refuse(tool, "shard", optarg);
    case OPT_SIZE:
        return take_size(&s->all, optarg) ? -1
                                          : tool_refuse(tool, "size", optarg);
    case OPT_LENSES:
        return take_lenses(s, optarg) ? -1
                                      : tool_refuse(tool, "lenses", optarg);
    case OPT_COATING_OF:
        return take_coating(tool, s, optarg);
    case OPT_RANGE:
        return take_range(tool, s, optarg);
    case OPT_LAYOUT:
        s->set.layout = synth_layout_named(optarg);
        return s->set.layout ? -1 : tool_refuse(tool, "layout", optarg);
    case OPT_TYPE:
        s->set.type = optarg;
        return -1;
    case OPT_ITEM:
        s->line = optarg;
        return -1;
    case OPT_SHEET:
        s->sheet = optarg;
        return -1;
    case OPT_QUALITY_OF:
        return take_quality(&s->all, optarg)
                   ? -1
                   : tool_refuse(tool, "quality", optarg);
    default:
        return tool_option(tool, c, optarg);
    }
}

/* Takes the layout's type if none was asked for, and checks whether pictures of
 * the type can be written. */
static int take_type(const struct tool *tool, struct synth *s)
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
        return tool_usage(tool, "--layout %s: %s; or take --type ppm",
                          s->set.layout->name, error.text);
    return tool_usage(tool, "--type %s: %s", s->set.type,
                      *error.text ? error.text : "no type of picture");
}

static int parse(struct tool *tool, int argc, char **argv, struct synth *s)
{
    int c, code;

    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            NULL)) >= 0) {
        code = take(tool, s, c);
        if (code >= 0)
            return code;
    }
    if (optind == argc)
        return tool_usage(tool, "needs backgrounds, pictures or folders of "
                                "such");
    if (!s->set.folder || !*s->set.folder)
        return tool_usage(tool, "needs -o FOLDER");
    code = take_type(tool, s);
    return code == EXIT_OK ? -1 : code;
}

/* -------------------------------------------------------------------- items */

/* Returns a line of what all items are drawn with, malloc'ed, or NULL. */
static char *settings_of(const struct synth *s, int seed)
{
    char *text = NULL;
    size_t bytes = 0;
    struct json_writer json = {.to = open_memstream(&text, &bytes)};

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
    synth_ranges_json(&json, &s->ranges);
    json_write(&json, "}, backgrounds: [");
    for (int i = 0; i < s->backgrounds.n; i++)
        json_write(&json, "%s", synth_background_name(s->backgrounds.path[i]));
    json_write(&json, "]}\n");
    if (fclose(json.to) == 0)
        return text;
    free(text);
    return NULL;
}

/* Sets ITEM to item NUMBER. */
static int choose(const struct tool *tool, struct synth *s, int number,
                  struct synth_item *item)
{
    struct glint_error error = {""};
    enum glint_status status = GLINT_OK;
    int k;

    *item = s->all;
    synth_item_draw(item, &s->ranges, tool->seed, number);
    snprintf(item->lens, sizeof item->lens, "%s",
             s->lens[synth_item_choose(item, "lens", s->n_lenses)]);
    k = synth_item_choose(item, "background", s->backgrounds.n);
    snprintf(item->background, sizeof item->background, "%s",
             synth_background_name(s->backgrounds.path[k]));
    if (!s->keys[k][0])
        status =
            synth_background_key(s->keys[k], s->backgrounds.path[k], &error);
    memcpy(item->background_key, s->keys[k], sizeof s->keys[k]);
    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);
}

static int make(const struct tool *tool, struct synth *s,
                const struct synth_item *item)
{
    struct synth_result result;
    const int code = synth_draw(tool, &s->lenses, &s->backgrounds, item,
                                &s->drawing, &result);

    return code == EXIT_OK
               ? synth_set_put(tool, &s->set, item, &result, &s->drawing)
               : code;
}

static int start_drawing(const struct tool *tool, struct synth *s,
                         const struct synth_item *item)
{
    const enum glint_status status =
        synth_drawing_init(&s->drawing, (int)item->width, (int)item->height);

    return status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, NULL);
}

/* Draws the item of --item. */
static int run_line(const struct tool *tool, struct synth *s)
{
    struct glint_error error = {""};
    struct synth_item item;
    const enum glint_status status = synth_item_read(&item, s->line, &error);
    int code =
        status == GLINT_OK ? EXIT_OK : tool_fail(tool, status, error.text);

    if (code == EXIT_OK && strcmp(item.glint, GLINT_VERSION) != 0 &&
        !tool->quiet)
        fprintf(stderr,
                "glint synth: the item is glint %s's; this is %s, which may "
                "draw it a little differently\n",
                item.glint, GLINT_VERSION);
    if (code == EXIT_OK)
        code = synth_set_apart(tool, &s->set);
    if (code == EXIT_OK)
        code = synth_set_folders(tool, &s->set);
    if (code == EXIT_OK)
        code = start_drawing(tool, s, &item);
    return code == EXIT_OK ? make(tool, s, &item) : code;
}

/* Opens every lens, so that what has to be baked is baked before there are
 * items, and what is no lens is said. */
static int open_lenses(const struct tool *tool, struct synth *s)
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

/* Draws the items of the shard that are not there yet. */
static int run_items(const struct tool *tool, struct synth *s)
{
    const struct synth_set *const set = &s->set;
    struct tool_progress progress;
    struct synth_item item;
    int code = EXIT_OK, left = 0, done = 0;

    for (int i = set->shard; i < set->count; i += set->shards)
        left += !synth_set_has(set, i);
    tool_progress_start(&progress, tool, "synth");
    for (int i = set->shard; i < set->count && code == EXIT_OK;
         i += set->shards) {
        if (synth_set_has(set, i))
            continue;
        code = choose(tool, s, i, &item);
        if (code == EXIT_OK)
            code = make(tool, s, &item);
        tool_progress_show(&progress, (double)++done / left);
    }
    tool_progress_end(&progress);
    return code;
}

static int run_set(const struct tool *tool, struct synth *s)
{
    bool is_whole = false;
    char *settings;
    int code;

    settings = settings_of(s, tool->seed);
    if (!settings)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    code = synth_set_begin(tool, &s->set, settings);
    if (code == EXIT_OK)
        code = open_lenses(tool, s);
    if (code == EXIT_OK)
        code = synth_set_keep(tool, &s->set, settings);
    free(settings);
    if (code == EXIT_OK)
        code = start_drawing(tool, s, &s->all);
    if (code == EXIT_OK)
        code = run_items(tool, s);
    if (code == EXIT_OK && s->set.count > 0)
        code = synth_set_end(tool, &s->set, &is_whole);
    if (code == EXIT_OK && !tool->quiet && s->set.count > 0)
        fprintf(stderr, "glint synth: %s: %s %d items\n", s->set.folder,
                is_whole ? "all" : "this shard, not yet all, of", s->set.count);
    if (code == EXIT_OK && s->sheet && is_whole)
        code = synth_set_sheet(tool, &s->set, &s->all, s->sheet,
                               s->set.count < SHEET_ITEMS ? s->set.count
                                                          : SHEET_ITEMS);
    return code;
}

static void close_all(struct synth *s)
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
        .layout = synth_layout_named("plain"), .count = 100, .shards = 1};
    s->all = (struct synth_item){.width = 512,
                                 .height = 512,
                                 .quality = 0.5,
                                 .glint = GLINT_VERSION,
                                 .coating = "mixed"};
    synth_ranges_defaults(&s->ranges);
    take_lenses(s, default_lenses);
    code = parse(&tool, argc, argv, s);
    if (code < 0) {
        code = synth_backgrounds_open(&tool, &s->backgrounds, argv + optind,
                                      argc - optind);
        s->keys = calloc((size_t)s->backgrounds.n + 1, sizeof *s->keys);
        if (code == EXIT_OK && !s->keys)
            code = tool_fail(&tool, GLINT_E_MEMORY, NULL);
        if (code == EXIT_OK)
            code = tool_start(&tool);
        if (code == EXIT_OK)
            code = s->line ? run_line(&tool, s) : run_set(&tool, s);
        tool_finish(&tool);
    }
    close_all(s);
    return code;
}
