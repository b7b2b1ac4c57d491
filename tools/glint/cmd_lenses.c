/* SPDX-License-Identifier: MIT
 *
 * glint lenses: lists the lenses that come with glint, or bakes all of them.
 */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "lens_pages/page.h"
#include "lens_pages/search.h"
#include "model/lens_files.h"
#include "options/json_writer.h"
#include "model/settings.h"
#include "model/model_cache.h"
#include "model/table_file.h"
#include "posix/output.h"
#include "model/opened_table.h"
#include "options/command_line.h"

static const char help[] =
    "glint lenses [WORD ...] [--names | --json | --html FILE [--rays exact]]\n"
    "             [--models FOLDER]\n"
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
    "  --html FILE       write a page that can be searched and sorted: a "
    "drawing\n"
    "                    of each lens; for baked lenses the flare of a lamp "
    "at\n"
    "                    three angles and the bytes of the model; measured "
    "bake\n"
    "                    and frame times of figures.md in the tables' folder\n"
    "  --rays exact      with --html: draw flares of lenses without a model "
    "by\n"
    "                    exact rays, seconds to a minute per lens\n"
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
    /* --rays exact: whether flares of lenses without a model are drawn by exact
     * rays */
    bool exact;
    char **words;
    int n_words;
    const char *html; /* HTML page to write, or NULL */
    FILE *page;
    struct tool_progress progress; /* progress of writing the HTML page */
    /* number of lens files, and of lens files already processed */
    int n_files, n_looked;
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

/* --------------------------------------------------------------- HTML page */

/* Sets SETTINGS for thumbnails of E: the defaults, or, without a model, exact
 * rays on coarse grids, which suffice for their size. */
static void set_thumbnail_settings(struct settings *settings,
                                   const struct entry *e)
{
    settings_set_photo_defaults(settings);
    if (e->is_baked)
        return;
    settings->options.rays = GLINT_RAYS_EXACT;
    settings_set_quality(settings, 0.25);
}

/* Writes thumbnails of the flare of E, or a note if E has no model and --rays
 * exact is not given. */
static void write_flare_thumbnails(struct lenses *l, const char *name,
                                   const struct entry *e)
{
    struct settings *settings = calloc(1, sizeof *settings);
    size_t bytes = 0;

    if (!e->is_baked && !l->exact)
        fputs("<p class=\"less\">no model yet: one is baked for the first "
              "video</p>",
              l->page);
    else if (!settings)
        l->code = tool_fail(l->tool, GLINT_E_MEMORY, NULL);
    else {
        set_thumbnail_settings(settings, e);
        fputs("<p>", l->page);
        if (page_write_thumbnails(l->tool, settings, name, l->page, &bytes) !=
            EXIT_OK)
            l->code = EXIT_RUNTIME;
        else if (e->is_baked)
            fprintf(l->page, "</p><p class=\"less\">model of %zu bytes</p>",
                    bytes);
        else
            fputs("</p><p class=\"less\">exact rays, as there is no model "
                  "yet</p>",
                  l->page);
    }
    free(settings);
}

static void print_measured_times(struct lenses *l, const char *name)
{
    FILE *const page = l->page;
    struct measured m;

    if (page_read_measured_times(name, &m) != GLINT_OK)
        l->code = tool_fail(l->tool, GLINT_E_MEMORY, NULL);
    else if (!*m.f_number)
        fputs("<p class=\"less\">bake and frame times not measured yet</p>",
              page);
    else if (!*m.kb)
        fprintf(page, "<p class=\"less\">measured for f/%s: bake %s s</p>",
                m.f_number, m.seconds);
    else
        fprintf(page,
                "<p class=\"less\">measured for f/%s: bake %s s, model %s "
                "KB%s%s%s</p>",
                m.f_number, m.seconds, m.kb, *m.ms ? ", 1080p frame " : "",
                m.ms, *m.ms ? " ms" : "");
}

static void print_lens_card(struct lenses *l, const char *name,
                            const struct entry *e)
{
    const struct page_card card = {.name = name,
                                   .lens = &e->table,
                                   .focal_mm = e->optics.focal_mm,
                                   .squeeze = e->optics.squeeze,
                                   .corner_deg =
                                       compute_corner_field_angle_deg(e),
                                   .n_ghosts = e->n_ghosts};

    if (l->n++ == 0)
        page_write_head(l->page);
    page_begin_card(l->page, &card);
    write_flare_thumbnails(l, name, e);
    print_measured_times(l, name);
    page_end_card(l->page);
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

    if (l->page)
        tool_progress_show(&l->progress, (double)l->n_looked++ / l->n_files);
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
        (l->page         ? print_lens_card
         : l->tool->json ? print_entry_json
                         : print_entry_text)(l, name, e);
    free(e);
    if (code != EXIT_OK)
        l->code = code;
    return code == EXIT_OK || code == EXIT_LENS;
}

static bool stop_at_first_lens(void *ctx, const char *name)
{
    (void)ctx;
    (void)name;
    return false;
}

/* Prints which search words no lens contains. Returns an exit code. */
static int report_no_matching_lens(const struct lenses *l)
{
    if (l->n_words)
        return lens_report_unknown_words(l->tool, l->words, l->n_words);
    fprintf(stderr, "glint lenses: no lens was found; set $GLINT_LENSES to a "
                    "folder of lens tables\n");
    return EXIT_LENS;
}

/* Writes the list to the HTML page L->html; leaves the file unchanged if the
 * list is empty. */
static int write_lens_page(struct lenses *l)
{
    char *text = NULL;
    size_t bytes = 0;
    int n = -1, code;

    l->page = glint_memory_file_open(&text, &bytes);
    if (l->page) {
        l->n_files = lens_files_visit_all(stop_at_first_lens, l);
        tool_progress_start(&l->progress, l->tool, "lenses");
        n = lens_files_visit_all(list_lens, l);
        tool_progress_end(&l->progress);
        page_write_end(l->page);
        if (n < 0 || l->n == 0)
            fclose(l->page);
    }
    if (n < 0 || l->n == 0) {
        free(text);
        return n < 0                ? tool_fail(l->tool, GLINT_E_MEMORY, NULL)
               : l->code == EXIT_OK ? report_no_matching_lens(l)
                                    : l->code;
    }
    code = tool_save_text(l->tool, l->html, l->page, &text, &bytes);
    return code == EXIT_OK ? l->code : code;
}

static int print_lens_list(struct lenses *l)
{
    const int code = lens_check_requested_names(l->only, l->n_only);

    if (code != EXIT_OK)
        return code;
    if (l->html)
        return write_lens_page(l);
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
        {"html", required_argument, NULL, 'H'},
        {"rays", required_argument, NULL, 'r'},
        TOOL_COMMON_OPTIONS};
    static const char *const rays[] = {"model", "exact", NULL};
    int c, code;

    while ((c = tool_getopt(argc, argv, "o:" TOOL_COMMON_SHORT, options,
                            NULL)) >= 0) {
        if (c == 'n')
            l->names = true;
        else if (c == 'm')
            l->folder = optarg;
        else if (c == 'H')
            l->html = optarg;
        else if (c == 'r' && tool_find_word_index(optarg, rays) < 0)
            return tool_report_bad_value(l->tool, "rays", optarg);
        else if (c == 'r')
            l->exact = tool_find_word_index(optarg, rays) == 1;
        else if (c == 'o' && l->n_only == MAX_ONLY)
            return tool_usage(l->tool, "more than %d lenses", MAX_ONLY);
        else if (c == 'o')
            l->only[l->n_only++] = optarg;
        else if ((code = tool_apply_option(l->tool, c, optarg)) >= 0)
            return code;
    }
    l->words = argv + optind;
    l->n_words = argc - optind;
    if (l->exact && !l->html)
        return tool_usage(l->tool, "--rays exact needs --html");
    if (l->html && (l->tool->json || l->folder || l->names))
        return tool_usage(l->tool,
                          "--html excludes --json, --models and --names");
    if (l->names && (l->tool->json || l->folder))
        return tool_usage(l->tool, "--names excludes --json and --models");
    if (!l->html)
        return -1;
    code = tool_check_ending(l->tool, l->html, ".html", "a page");
    if (code == EXIT_OK)
        code = tool_check_output(l->tool, l->html);
    return code == EXIT_OK ? -1 : code;
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
