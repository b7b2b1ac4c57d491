/* SPDX-License-Identifier: MIT
 *
 * glint coat: reflectance of a coating by wavelength and angle.
 */
#include <errno.h>
#include <math.h>
#include <stdlib.h>

#include "overlay/apart.h"
#include "measure/plots/plot.h"
#include "model/table_file.h"
#include "model/coating.h"
#include "options/command_line.h"
#include "options/json_writer.h"
#include "options/tool.h"
#include "posix/ending.h"
#include "posix/output.h"

static const char help[] =
    "glint coat COATING [--glass ND,VD] [-o PLOT.svg] [options]\n"
    "glint coat LENS --surface K [--coating C] [-o PLOT.svg]\n"
    "\n"
    "Prints the reflectance of a coating for light from the air, by wavelength "
    "and\n"
    "angle: a table in percent of unpolarised light, and plots. Films absorb\n"
    "nothing: light from the glass at the refracted angle is reflected "
    "equally,\n"
    "and all other light is transmitted.\n"
    "\n"
    "COATING is none, v-coat[/NM], broadband-3[/NM], broadband-4[/NM] or\n"
    "NM[/INDEX[:QUARTERS]]..., films from the air on.\n"
    "\n"
    "  --glass ND[,VD]     glass below the coating (default 1.5168,64.17)\n"
    "  --surface K         surface of a lens, counted from 0 at the front\n"
    "  --coating C         coating of the lens; values of glint overlay\n"
    "  -o, --output FILE   write plots: unpolarised light by wavelength, and s "
    "and\n"
    "                      p by angle at 450, 550, 650 nm\n"
    "  --json              print one JSON object, with s and p\n";

enum { ANGLES = 5, STEPS = 40, MAX_TEXT = 160 };

static const double angle_deg[ANGLES] = {0, 15, 30, 45, 60};
static const double band_nm[2] = {380, 780};

struct coat {
    const char *output;
    /* index of the coated surface, 0 is the front; -1: no lens given */
    int surface;
    struct coating on_lens;
    double glass[2]; /* nd and Vd of the glass below the coating */
    struct glint_coating coating;
    char name[MAX_TEXT]; /* name of the coating or lens, for plot titles */
};

/* Reflectances, 0 .. 1, of s and p polarised light, and their mean. */
struct reflected {
    double s, p, both;
};

static struct reflected compute_reflectance(const struct coat *c, double nm,
                                            double degrees)
{
    struct glint_film_at film[GLINT_MAX_FILMS];
    const int n = glint_coating_at(&c->coating, nm, film);
    struct reflected r;

    glint_reflectance_sp(1, glint_index(c->glass[0], c->glass[1], nm),
                         cos(degrees * GLINT_PI / 180), film, n, &r.s, &r.p);
    r.both = 0.5 * (r.s + r.p);
    return r;
}

static double get_table_wavelength_nm(int k)
{
    return band_nm[0] + (band_nm[1] - band_nm[0]) * k / STEPS;
}

/* ----------------------------------------------------------- text and JSON */

static void print_reflectance_text(const struct coat *c)
{
    printf("%s, on index %g\n\n      nm", c->name, c->glass[0]);
    for (int a = 0; a < ANGLES; a++)
        printf("  %5g deg", angle_deg[a]);
    printf("\n");
    for (int k = 0; k <= STEPS; k += 2) {
        printf("%8.1f", get_table_wavelength_nm(k));
        for (int a = 0; a < ANGLES; a++)
            printf("  %7.3f %%",
                   100 * compute_reflectance(c, get_table_wavelength_nm(k),
                                             angle_deg[a])
                             .both);
        printf("\n");
    }
}

static void print_reflectance_json(const struct coat *c)
{
    struct json_writer json = {.to = stdout};

    json_write(&json, "{coating: %s, nd: %g, vd: %g, films: [", c->name,
               c->glass[0], c->glass[1]);
    for (int i = 0; i < c->coating.n_films; i++)
        json_write(&json, "[%g, %g]", c->coating.film[i].index,
                   c->coating.film[i].quarters);
    json_write(&json, "], reflected: [");
    for (int k = 0; k <= STEPS; k++)
        for (int a = 0; a < ANGLES; a++) {
            const struct reflected r = compute_reflectance(
                c, get_table_wavelength_nm(k), angle_deg[a]);

            json_write(&json, "{nm: %g, deg: %g, s: %.9g, p: %.9g}",
                       get_table_wavelength_nm(k), angle_deg[a], r.s, r.p);
        }
    json_write(&json, "]}\n");
}

/* ------------------------------------------------------------------- plots */

/* A curve of a plot: reflectance in percent over wavelength or angle. */
struct curve {
    const struct coat *c;
    /* quantity that is constant along the curve: angle, degrees (KIND 0), or
     * wavelength, nm (KIND 1, 2) */
    double fixed;
    /* 0: mean polarisation over wavelength; 1: s, 2: p over angle */
    int kind;
    double lo, hi;
};

static double compute_reflectance_percent(const struct curve *v, double x)
{
    const struct reflected r = v->kind ? compute_reflectance(v->c, v->fixed, x)
                                       : compute_reflectance(v->c, x, v->fixed);

    return 100 * (v->kind == 0 ? r.both : v->kind == 1 ? r.s : r.p);
}

static void fit_axes_to_curve(struct plot *plot, const struct curve *v)
{
    for (int i = 0; i <= 2 * STEPS; i++) {
        const double x = v->lo + (v->hi - v->lo) * i / (2 * STEPS);

        plot_extend_axes(plot, x, compute_reflectance_percent(v, x));
    }
}

static void draw_reflectance_curve(const struct plot *plot,
                                   const struct curve *v, const char *colour)
{
    enum { N = 200 };

    for (int i = 0; i < N; i++) {
        const double x0 = v->lo + (v->hi - v->lo) * i / N;
        const double x1 = v->lo + (v->hi - v->lo) * (i + 1) / N;

        plot_draw_line(plot, x0, compute_reflectance_percent(v, x0), x1,
                       compute_reflectance_percent(v, x1), colour,
                       v->kind != 2);
    }
}

static void plot_over_wavelength(const struct coat *c, struct plot *plot)
{
    struct curve v = {c, 0, 0, band_nm[0], band_nm[1]};
    char words[32];

    plot->x.words = "nm";
    plot->y.words = "% reflected, unpolarised";
    plot_extend_axes(plot, v.lo, 0);
    for (int a = 0; a < ANGLES; a++) {
        v.fixed = angle_deg[a];
        fit_axes_to_curve(plot, &v);
    }
    plot_draw_frame(plot);
    for (int a = 0; a < ANGLES; a++) {
        v.fixed = angle_deg[a];
        draw_reflectance_curve(plot, &v, plot_get_colour_of_series(a));
        snprintf(words, sizeof words, "%g degrees", v.fixed);
        plot_draw_legend_entry(plot, 's', plot_get_colour_of_series(a), words);
    }
}

static void plot_over_angle(const struct coat *c, struct plot *plot)
{
    static const double nm[3] = {450, 550, 650};
    static const char *const colour[3] = {"#1f6fb2", "#3a8f3a", "#c0281a"};
    char words[32];

    plot->x.words = "degrees";
    plot->y.words = "% reflected; thick lines: s, thin lines: p";
    for (int k = 0; k < 6; k++)
        fit_axes_to_curve(plot,
                          &(struct curve){c, nm[k / 2], 1 + k % 2, 0, 75});
    plot_draw_frame(plot);
    for (int k = 0; k < 6; k++)
        draw_reflectance_curve(plot,
                               &(struct curve){c, nm[k / 2], 1 + k % 2, 0, 75},
                               colour[k / 2]);
    for (int k = 0; k < 3; k++) {
        snprintf(words, sizeof words, "%g nm", nm[k]);
        plot_draw_legend_entry(plot, 's', colour[k], words);
    }
}

static void write_reflectance_plot(const struct coat *c, FILE *file)
{
    struct plot plot;

    plot_open(file, 2);
    plot_init(&plot, file, 0, c->name);
    plot_over_wavelength(c, &plot);
    plot_init(&plot, file, 1, "by angle");
    plot_over_angle(c, &plot);
    plot_close(file);
}

static int save_reflectance_plot(const struct tool *tool, const struct coat *c)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *file = glint_memory_file_open(&text, &bytes);

    if (file)
        write_reflectance_plot(c, file);
    return tool_save_text(tool, c->output, file, &text, &bytes);
}

/* ----------------------------------------------------------------- options */

static int parse_option(struct tool *tool, void *ctx, int c, const char *value)
{
    struct coat *o = ctx;
    bool good = true;

    if (c == 'o')
        o->output = value;
    else if (c == 's')
        good =
            tool_parse_integer(value, 0, GLINT_MAX_SURFACES - 1, &o->surface);
    else if (c == 'C')
        return coating_parse_option(tool, &o->on_lens, value);
    else if (c == 'g')
        good = tool_parse_numbers(value, o->glass, 2) > 0 &&
               o->glass[0] >= 1.01 && o->glass[0] <= 4 && o->glass[1] >= 0;
    else
        return tool_apply_option(tool, c, value);
    return good ? -1 : -2;
}

static int parse_options(struct tool *tool, int argc, char **argv,
                         struct coat *o)
{
    static const struct option options[] = {
        {"output", required_argument, NULL, 'o'},
        {"surface", required_argument, NULL, 's'},
        {"coating", required_argument, NULL, 'C'},
        {"glass", required_argument, NULL, 'g'},
        TOOL_COMMON_OPTIONS};
    struct apart files = {.n_read = 0};
    int code = tool_parse_options(
        tool, argc, argv, TOOL_COMMON_SHORT "o:", options, parse_option, o);

    if (code < 0)
        code = tool_check_inputs(tool, argc, argv, 1,
                                 "needs one coating or one lens");
    if (code >= 0)
        return code;
    if (o->output && !glint_has_extension(o->output, ".svg"))
        return tool_usage(tool, "the plot must be a .svg, not '%s'", o->output);
    if (o->output && o->surface >= 0)
        file_conflicts_add_input(&files, NULL, argv[optind]);
    file_conflicts_add_output(&files, "-o", o->output);
    code = file_conflicts_check_outputs(tool, &files);
    if (code == EXIT_OK && o->output)
        code = tool_check_output(tool, o->output);
    return code == EXIT_OK ? -1 : code;
}

/* ------------------------------------------------------------------ coating */

static int find_lens_coating(const struct tool *tool, const char *name,
                             struct coat *c)
{
    struct glint_prescription *lens = calloc(1, sizeof *lens);
    int code;

    if (!lens)
        return tool_fail(tool, GLINT_E_MEMORY, NULL);
    code = tool_read_lens(tool, name, lens);
    if (code == EXIT_OK && c->surface >= lens->n_surfaces)
        code = tool_usage(tool,
                          "--surface is out of range: %s has surfaces 0 to %d",
                          name, lens->n_surfaces - 1);
    if (code == EXIT_OK) {
        const struct glint_surface *s;

        coating_apply(&c->on_lens, lens);
        s = &lens->surface[c->surface];
        c->coating = s->coating;
        snprintf(c->name, sizeof c->name, "%.60s, surface %d", lens->name,
                 c->surface);
        /* If air is behind the surface, the coated glass is in front of it. */
        if (s->vd <= 0 && c->surface > 0)
            s--;
        else if (c->surface > 0 && s[-1].vd > 0)
            code = tool_usage(tool,
                              "surface %d of %s is cemented, so it has no "
                              "coating; choose another --surface",
                              c->surface, name);
        c->glass[0] = s->nd;
        c->glass[1] = s->vd;
    }
    free(lens);
    return code;
}

static int parse_coating_text(const struct tool *tool, const char *text,
                              struct coat *c)
{
    struct glint_coating read[GLINT_MAX_COATINGS];
    struct glint_error error;
    int n = 0;

    if (glint_coatings_parse(read, &n, text, &error) != GLINT_OK)
        return tool_usage(tool, "%s (a lens needs --surface K)", error.text);
    if (n != 1)
        return tool_usage(tool, "needs one coating, not %d", n);
    c->coating = read[0];
    snprintf(c->name, sizeof c->name, "%.150s", text);
    return EXIT_OK;
}

int cmd_coat(int argc, char **argv)
{
    struct tool tool = {.name = "coat", .help = help};
    struct coat c = {.surface = -1, .glass = {1.5168, 64.17}};
    int code = parse_options(&tool, argc, argv, &c);

    if (code >= 0)
        return code;
    code = c.surface < 0 ? parse_coating_text(&tool, argv[optind], &c)
                         : find_lens_coating(&tool, argv[optind], &c);
    if (code != EXIT_OK)
        return code;
    if (tool.json)
        print_reflectance_json(&c);
    else if (!tool.quiet)
        print_reflectance_text(&c);
    return c.output ? save_reflectance_plot(&tool, &c) : EXIT_OK;
}
