/* SPDX-License-Identifier: MIT
 *
 * glint lenses: lists the lenses that come with glint, or bakes all of them.
 */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "model/lens_files.h"
#include "options/json_writer.h"
#include "model/settings.h"
#include "model/model_cache.h"
#include "model/table_file.h"
#include "posix/output.h"
#include "model/opened_table.h"
#include "options/command_line.h"

static const char help[] =
    "glint lenses [WORD ...] [--names | --json | --models FOLDER]\n"
    "\n"
    "Lists the lenses of glint: the name for --lens, the focal length, the "
    "field\n"
    "angle at a corner of the film (90+: 90 degrees or more), the f-number, "
    "the\n"
    "film, the number of ghosts, and whether a model is baked. The first "
    "video\n"
    "with a lens bakes its model: seconds to minutes for narrow stops, minutes "
    "to\n"
    "an hour for wide stops, hours for anamorphic lenses. The list includes "
    ".lens\n"
    "files (lenses/README.md) in the folder $GLINT_LENSES.\n"
    "\n"
    "  --names           print the names only, one per line\n"
    "  WORD              list lenses whose name, source or character contains\n"
    "                    every WORD; upper and lower case are equal\n"
    "  --models FOLDER   bake missing models and write all models to FOLDER, "
    "as\n"
    "                    make install does\n"
    "  -o, --only NAME   list this lens; repeatable\n";

static const char help_end[] = COMMON_HELP;

enum { MAX_ONLY = 64 };

struct lenses {
    struct json_writer json;
    struct tool *tool;
    const char *folder; /* folder to write models to; NULL: none */
    const char *only[MAX_ONLY];
    int n_only, n, code;
    bool names; /* --names: whether only names are printed */
    char **words;
    int n_words;
};

struct entry {
    struct glint_prescription table;
    /* settings of a command line without options */
    struct settings settings;
    struct glint_optics optics;
    struct glint_ghost ghost[GLINT_MAX_GHOSTS];
    int n_ghosts;
    struct glint_bake_options options;
    bool is_baked;
};

static int load_lens_entry(const struct tool *tool, const char *name,
                           struct entry *e)
{
    int code;

    settings_set_photo_defaults(&e->settings);
    code = tool_read_lens(tool, name, &e->table);
    if (code != EXIT_OK)
        return code;
    coating_apply(&e->settings.coating, &e->table);
    glint_optics_of(&e->table, &e->optics);
    e->n_ghosts = glint_ghost_list(&e->table, e->ghost, GLINT_MAX_GHOSTS);
    e->options = opened_table_bake_options(&e->table, &e->settings);
    e->is_baked = model_is_cached(&e->table, &e->options);
    return EXIT_OK;
}

/* ------------------------------------------------------------------ tables */

/* Max half field of view, degrees, for which the corner angle is that of a
 * pinhole camera. For wider lenses 85 chief rays are traced. */
#define WIDE_DEG 40.0
/* max angle of a light that can be drawn, degrees */
#define WIDEST_DEG 89.9

static double compute_corner_field_angle_deg(const struct entry *e)
{
    const struct glint_prescription *l = &e->table;
    const double rho =
        0.5 * hypot(l->film_width_mm, l->film_height_mm) / e->optics.focal_mm;
    const double deg = 45 / atan(1) * atan(rho);
    struct glint_projection projection;
    struct glint_error error;
    double miss_deg;

    return deg > WIDE_DEG && glint_projection_of(&projection, l, &miss_deg,
                                                 &error) == GLINT_OK
               ? glint_projection_deg(&projection, rho)
               : deg;
}

static void print_entry_json(struct lenses *l, const char *name,
                             const struct entry *e)
{
    if (l->n++ == 0)
        json_write(&l->json, "{lenses: [");
    json_write(&l->json,
               "\n {name: %s, source: %s, character: %s, "
               "focal_length_mm: %.3f, squeeze: %.6g, f_number: %g, "
               "film_mm: [%g, %g], corner_deg: %.2f, ghosts: %d, baked: %c}",
               name, e->table.source, e->table.character, e->optics.focal_mm,
               e->optics.squeeze, e->table.f_number, e->table.film_width_mm,
               e->table.film_height_mm, compute_corner_field_angle_deg(e),
               e->n_ghosts, e->is_baked);
}

static void print_entry_text(struct lenses *l, const char *name,
                             const struct entry *e)
{
    const double corner = compute_corner_field_angle_deg(e);
    char film[32];

    if (l->n++ == 0)
        printf("%-24s %9s %7s %6s  %-9s %6s  %s\n", "lens", "focal mm",
               "corner", "f/", "film mm", "ghosts", "model");
    snprintf(film, sizeof film, "%.4gx%.4g", e->table.film_width_mm,
             e->table.film_height_mm);
    printf("%-24s %9.1f %4.0f%cdeg %5.3g  %-9s %6d  %s\n", name,
           e->optics.focal_mm, corner, corner < WIDEST_DEG ? ' ' : '+',
           e->table.f_number, film, e->n_ghosts,
           e->is_baked ? "baked" : "not yet");
    if (l->tool->verbose || l->n_words)
        printf("    %s%s%s\n", e->table.source,
               *e->table.character ? "\n    " : "", e->table.character);
}

/* ------------------------------------------------------------------ models */

static int save_model_to_folder(const struct tool *tool, const char *path,
                                const struct model_file *model)
{
    return tool_save_file(tool, path, GLINT_OUTPUT_BINARY, model->data,
                          model->bytes);
}

/* Writes the model of E to the folder, from the cache or by a bake. Does
 * nothing if the folder already contains the model. Returns an exit code. */
static int copy_or_bake_model(const struct lenses *l, const struct entry *e)
{
    const uint64_t key = glint_bake_key(&e->table, &e->options);
    struct model_file model = {.data = NULL};
    char path[1024];
    struct stat st;
    int code;

    if ((size_t)snprintf(path, sizeof path, "%s", l->folder) >= sizeof path ||
        !model_cache_append_name(path, sizeof path, e->table.name, key))
        return tool_usage(l->tool, "%s: the name is too long", l->folder);
    if (stat(path, &st) == 0)
        return EXIT_OK;
    code = model_open_cached(l->tool, &e->table, e->table.name, e->options,
                             &e->settings.coating, &model);
    if (code == EXIT_OK)
        code = save_model_to_folder(l->tool, path, &model);
    if (code == EXIT_OK && !l->tool->quiet)
        fprintf(stderr, "%s: %zu bytes\n", path, model.bytes);
    model_file_close(&model);
    return code;
}

/* ----------------------------------------------------------------- command */

static bool contains_search_word(const char *text, const char *word)
{
    const size_t n = strlen(word);

    for (; *text; text++)
        if (strncasecmp(text, word, n) == 0)
            return true;
    return false;
}

/* Returns whether name, source and character of the lens NAME contain all N
 * WORDS, ignoring case. */
static bool lens_has_words(const char *name,
                           const struct glint_prescription *lens, char **words,
                           int n)
{
    for (int i = 0; i < n; i++)
        if (!contains_search_word(name, words[i]) &&
            !contains_search_word(lens->source, words[i]) &&
            !contains_search_word(lens->character, words[i]))
            return false;
    return true;
}

static bool is_lens_requested(const struct lenses *l, const char *name)
{
    for (int i = 0; i < l->n_only; i++)
        if (strcmp(l->only[i], name) == 0)
            return true;
    return l->n_only == 0;
}

static bool print_lens_name(struct lenses *l, const char *name)
{
    l->n++;
    puts(name);
    return true;
}

/* Lists lens NAME, or writes its model to the folder. Returns false to end the
 * list. An error in a table is printed, and the list continues. */
static bool list_lens(void *ctx, const char *name)
{
    struct lenses *l = ctx;
    struct entry *e;
    int code;

    if (!is_lens_requested(l, name))
        return true;
    if (l->names && l->n_words == 0)
        return print_lens_name(l, name);
    e = calloc(1, sizeof *e);
    if (!e) {
        l->code = tool_fail(l->tool, GLINT_E_MEMORY, NULL);
        return true;
    }
    code = load_lens_entry(l->tool, name, e);
    if (code == EXIT_OK &&
        !lens_has_words(name, &e->table, l->words, l->n_words)) {
        free(e);
        return true;
    }
    if (code == EXIT_OK && l->names)
        print_lens_name(l, name);
    else if (code == EXIT_OK && l->folder) {
        code = copy_or_bake_model(l, e);
        l->n++;
    } else if (code == EXIT_OK)
        (l->tool->json ? print_entry_json : print_entry_text)(l, name, e);
    free(e);
    if (code != EXIT_OK)
        l->code = code;
    return code == EXIT_OK || code == EXIT_LENS;
}

static int report_no_matching_lens(const struct lenses *l)
{
    fputs(l->n_words ? "glint lenses: no lens has all of these words in its "
                       "name, source or character\n"
                     : "glint lenses: no lens was found; set $GLINT_LENSES to "
                       "a folder of lens tables\n",
          stderr);
    return EXIT_LENS;
}

static int print_lens_list(struct lenses *l)
{
    char path[1024];

    for (int i = 0; i < l->n_only; i++)
        if (!lens_find_file(l->only[i], path, sizeof path)) {
            tool_report_unknown_lens(l->tool, l->only[i]);
            return EXIT_LENS;
        }
    if (l->folder && mkdir(l->folder, 0777) != 0 && errno != EEXIST) {
        fprintf(stderr, "glint lenses: %s: %s\n", l->folder, strerror(errno));
        return EXIT_OUTPUT;
    }
    if (lens_files_visit_all(list_lens, l) < 0)
        return tool_fail(l->tool, GLINT_E_MEMORY, NULL);
    if (l->n == 0 && l->code == EXIT_OK)
        return report_no_matching_lens(l);
    if (l->tool->json && !l->folder && !l->names && l->n > 0)
        json_write(&l->json, "\n]}\n");
    return l->code;
}

static int parse_options(struct lenses *l, int argc, char **argv)
{
    static const struct option options[] = {
        {"models", required_argument, NULL, 'm'},
        {"only", required_argument, NULL, 'o'},
        {"names", no_argument, NULL, 'n'},
        TOOL_COMMON_OPTIONS};
    int c, code;

    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            NULL)) >= 0) {
        if (c == 'n')
            l->names = true;
        else if (c == 'm')
            l->folder = optarg;
        else if (c == 'o' && l->n_only == MAX_ONLY)
            return tool_usage(l->tool, "more than %d lenses", MAX_ONLY);
        else if (c == 'o')
            l->only[l->n_only++] = optarg;
        else if ((code = tool_apply_option(l->tool, c, optarg)) >= 0)
            return code;
    }
    l->words = argv + optind;
    l->n_words = argc - optind;
    if (l->names && (l->tool->json || l->folder))
        return tool_usage(l->tool, "--names excludes --json and --models");
    return -1;
}

int cmd_lenses(int argc, char **argv)
{
    struct tool tool = {.name = "lenses", .help = help, .help_end = help_end};
    struct lenses l = {.tool = &tool, .json = {.to = stdout}};
    int code = parse_options(&l, argc, argv);

    if (code < 0) {
        code = tool_start_threads(&tool);
        if (code == EXIT_OK)
            code = print_lens_list(&l);
        tool_stop_threads(&tool);
    }
    return code;
}
