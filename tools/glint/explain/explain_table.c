/* SPDX-License-Identifier: MIT
 *
 * Prints the explanation of a frame as tables of at most 100 columns, and as
 * JSON.
 */
#include <math.h>
#include <stdio.h>

#include "explain/explain.h"
#include "model/model_summary.h"
#include "options/json_writer.h"
#include "options/tool.h"

enum { WIDE = 100 };

static const struct {
    const char *word, *reason;
} outcomes[GLINT_OUTCOMES] = {
    [GLINT_OUTCOME_DRAWN] = {"drawn", "drawn"},
    [GLINT_OUTCOME_EMPTY] = {"empty", "its outline changes no pixel"},
    [GLINT_OUTCOME_OTHER] = {"other", "not requested, or muted"},
    [GLINT_OUTCOME_BEYOND] = {"beyond",
                              "light outside the angles of the model"},
    [GLINT_OUTCOME_CLOSED] = {"closed", "no light gets through at this angle"},
    [GLINT_OUTCOME_BLOCKED] = {"blocked",
                               "stop and barrels block all its rays"},
    [GLINT_OUTCOME_DARK] = {"dark", "the light has none of this wavelength"},
    [GLINT_OUTCOME_OUTSIDE] = {"outside", "outside the picture"},
    [GLINT_OUTCOME_FAINT] = {"faint", "too faint to change a pixel code"},
    [GLINT_OUTCOME_NO_ROOM] = {"no_room",
                               "the memory limit is reached (--memory)"},
    [GLINT_OUTCOME_OTHER_SET] = {"other_set",
                                 "drawn with another set of wavelengths"},
    [GLINT_OUTCOME_SHARED] = {"shared",
                              "drawn with the rays of a nearby light"},
};

const char *explain_outcome_reason(enum glint_outcome outcome)
{
    return outcomes[outcome].reason;
}

static double compute_direction_angle_deg(double y, double x)
{
    return atan2(y, x) * 180 / GLINT_PI;
}

static int count_visible_ghosts(const struct glint_explain *e)
{
    int n = 0;

    for (int i = 0; i < e->n_ghosts; i++)
        n += e->ghost[i].lit > 0;
    return n;
}

/* ------------------------------------------------------------------- table */

static void print_percent(double x)
{
    if (x != 0 && fabs(x) < 0.0005)
        printf("%8s", "<0.05");
    else
        printf("%8.1f", 100 * x);
}

/* Prints the columns that all tables have, and a line feed. Only models have
 * costs. */
static void print_light_columns(const struct glint_explain *e,
                                const struct glint_explain_part *p)
{
    print_percent(p->share);
    printf(" %10.3g", p->brightest);
    if (e->lens)
        print_percent(p->cost);
    printf("\n");
}

static void print_table_heading(const struct glint_explain *e, const char *what)
{
    printf("\n%s  light%%  brightest%s\n", what, e->lens ? "   cost%" : "");
}

static void print_explanation_title(const struct glint_explain *e,
                                    const struct explain_title *t)
{
    printf("%s, %dx%d, by %s, %s\n", t->lens, e->view->width, e->view->height,
           e->lens ? "a model" : "exact rays",
           t->linear ? "light in units of the lamps' power"
                     : "white has brightness 1");
    if (e->n_lights > t->n_lamps)
        printf("%d light%s drawn as %d points", t->n_lamps,
               t->n_lamps == 1 ? "" : "s", e->n_lights);
    else
        printf("%d of %d light%s drawn", e->n_lights, t->n_lamps,
               t->n_lamps == 1 ? "" : "s");
    printf("; %d of %d ghosts light a pixel, together %.1f%% of the picture\n",
           count_visible_ghosts(e), e->n_ghosts,
           100.0 * e->all.lit / e->view->width / e->view->height);
}

/* Returns the direction of lamp LAMP, the mean of its lights weighted by their
 * power, and sets *N to their number. A single light keeps its direction. */
static struct glint_lamp find_lamp_direction(const struct glint_explain *e,
                                             int lamp, int *n)
{
    double x = 0, y = 0, z = 0;

    *n = 0;
    for (int i = 0; i < e->n_lights; i++) {
        const struct glint_light *const b = &e->lights[i];
        const double power = glint_real_value(b->power);

        if (e->lamp_of[i] != lamp)
            continue;
        x += power * b->sine_q30 * b->cos_q30 / b->cosine_q30;
        y += power * b->sine_q30 * b->sin_q30 / b->cosine_q30;
        z += power * 0x1p30;
        (*n)++;
    }
    return (struct glint_lamp){.theta_deg =
                                   compute_direction_angle_deg(hypot(x, y), z),
                               .phi_deg = compute_direction_angle_deg(y, x)};
}

/* Prints a row per lamp. A lamp of visible extent is drawn as several lights,
 * its points. */
static void print_lamp_rows(const struct glint_explain *e,
                            const struct explain_title *t)
{
    print_table_heading(e, "light  centre, pixels    angle  azimuth points");
    for (int i = 0; i < e->n_lamps && i < t->top; i++) {
        int n_points;
        const struct glint_lamp lamp = find_lamp_direction(e, i, &n_points);
        char centre[64];
        double x, y;

        glint_view_to_pixel(e->view, e->setup->optics.focal_mm, &lamp, &x, &y);
        snprintf(centre, sizeof centre, "%.0f,%.0f", x, y);
        printf("%5d %15s %8.3f %8.1f %6d", i + 1, centre, lamp.theta_deg,
               lamp.phi_deg, n_points);
        print_light_columns(e, &e->lamp[i]);
    }
    if (e->n_lamps > t->top)
        printf("      and %d more (--top)\n", e->n_lamps - t->top);
}

/* Prints a row per wavelength if all ghosts are drawn with the same ones. */
static void print_wavelength_rows(const struct glint_explain *e)
{
    if (e->set_size || e->n_waves == 0)
        return;
    print_table_heading(e, "wavelength");
    for (int i = 0; i < e->n_waves; i++) {
        printf("%7.1f nm", e->setup->wavelength_nm[i]);
        print_light_columns(e, &e->wave[i]);
    }
}

static void print_ghost_rows(const struct glint_explain *e,
                             const struct explain_title *t, const int *ghosts)
{
    int n = 0;

    if (e->n_lamps > 1)
        printf("\nsize and centre span the images that a ghost forms of all "
               "lights\n");
    print_table_heading(e, "ghost surfaces  size, pixels       centre");
    for (int i = 0; i < e->n_ghosts; i++) {
        const struct glint_explain_part *p = &e->ghost[ghosts[i]];
        const struct glint_ghost *g = &e->setup->ghost[ghosts[i]];
        char pair[32], size[32], centre[32];

        if (p->lit == 0 || n++ >= t->top)
            continue;
        snprintf(pair, sizeof pair, "%d-%d", g->i, g->j);
        snprintf(size, sizeof size, "%dx%d", p->x1 - p->x0 + 1,
                 p->y1 - p->y0 + 1);
        snprintf(centre, sizeof centre, "%d,%d", (p->x0 + p->x1 + 1) / 2,
                 (p->y0 + p->y1 + 1) / 2);
        printf("%5d %8s %13s %12s", ghosts[i], pair, size, centre);
        print_light_columns(e, p);
    }
    if (n > t->top)
        printf("      and %d more (--top)\n", n - t->top);
}

/* Prints the numbers of the ghosts with OUTCOME, as many as fit into ROOM
 * characters, and a line feed. */
static void print_ghost_numbers(const struct glint_explain *e,
                                enum glint_outcome outcome, int room)
{
    for (int i = 0; i < e->n_ghosts; i++) {
        char number[16];
        const int n = snprintf(number, sizeof number, " %d", i);

        if (e->ghost[i].of[outcome] == 0)
            continue;
        if (n + 4 > room) {
            printf(" ...");
            break;
        }
        fputs(number, stdout);
        room -= n;
    }
    printf("\n");
}

/* Prints the ghosts with OUTCOME, if there are any. */
static void print_ghosts_with_outcome(const struct glint_explain *e,
                                      enum glint_outcome outcome)
{
    int n = 0;

    for (int i = 0; i < e->n_ghosts; i++)
        n += e->ghost[i].of[outcome] > 0;
    if (e->all.of[outcome] == 0)
        return;
    printf("%-41s %7d ", outcomes[outcome].reason, n);
    print_ghost_numbers(e, outcome, WIDE - 50);
}

static void print_ghosts_left_out(const struct glint_explain *e)
{
    printf("\n%-41s %7s\n",
           e->n_lights > 1 ? "not drawn, for one light or more" : "not drawn",
           "ghosts");
    for (int outcome = GLINT_OUTCOME_EMPTY; outcome < GLINT_OUTCOMES; outcome++)
        if (outcome != GLINT_OUTCOME_SHARED)
            print_ghosts_with_outcome(e, (enum glint_outcome)outcome);
    if (e->all.of[GLINT_OUTCOME_SHARED])
        printf("\n%-41s %7s\n", "drawn, but faint, for one light or more",
               "ghosts");
    print_ghosts_with_outcome(e, GLINT_OUTCOME_SHARED);
}

static void print_invalid_lights(const struct glint_explain *e,
                                 const struct explain_title *t)
{
    const struct glint_engine_report *r = t->report;
    int n = 0, dark = 0;

    for (int i = 0; i < t->n_lamps; i++) {
        if (glint_explain_is_beyond(e, &t->lamp[i].lamp)) {
            if (n++ < t->top)
                printf("light at %.3f degrees: outside the model, whose max "
                       "angle is %.1f (bake --max-angle)\n",
                       t->lamp[i].lamp.theta_deg,
                       model_convert_sine_to_deg(e->lens->header->sine_hi_q30));
        } else
            dark += !(t->lamp[i].lamp.power > 0);
    }
    if (n > t->top)
        printf("and %d more lights outside the model (--top)\n", n - t->top);
    if (dark)
        printf("%d light%s no power\n", dark, dark == 1 ? " has" : "s have");
    n = t->n_lamps - r->beyond_lights - dark;
    if (e->n_lights && r->apart_lights < n)
        printf("%d lights were merged to %d because they coincide (--apart)\n",
               n, r->apart_lights);
    if (r->stats.held_cells)
        printf("the brightness of some pixels was limited to about 2048 times "
               "white\n");
    if (r->drawn_lights < r->apart_lights)
        printf("%d lights were merged into %d (--max-lights)\n",
               r->apart_lights, r->drawn_lights);
}

static const char *const doubts[] = {
    [GLINT_DOUBT_NONE] = "a lamp",
    [GLINT_DOUBT_DIM] = "too few of its pixels reach --threshold",
    [GLINT_DOUBT_AROUND] = "its surroundings are nearly as bright",
    [GLINT_DOUBT_GLOW] = "light does not fall off evenly around it",
    [GLINT_DOUBT_SHAPE] = "it is not round",
    [GLINT_DOUBT_SIZE] = "it is small",
    [GLINT_DOUBT_GREY] = "it is darker than white",
    [GLINT_DOUBT_CROWD] = "many other regions are as bright",
    [GLINT_DOUBT_DAY] = "the picture is bright or dull",
    [GLINT_DOUBT_LOW] = "it lies low in the picture",
    [GLINT_DOUBT_DRAWN] = "it fills its bounding box, as windows and bars do"};

static void print_rejected_lamps(const struct explain_title *t)
{
    struct glint_spot spot;

    for (int i = 0;
         i < t->top && t->engine && glint_engine_doubtful(t->engine, i, &spot);
         i++)
        printf("%snot a lamp: %d pixels at %.0f,%.0f: %s\n", i ? "" : "\n",
               spot.area, spot.x_q8 / 256.0, spot.y_q8 / 256.0,
               doubts[spot.doubt]);
}

static void write_rejected_json(struct json_writer *json,
                                const struct explain_title *t)
{
    struct glint_spot spot;

    json_write(json, "rejected: [");
    for (int i = 0;
         i < t->top && t->engine && glint_engine_doubtful(t->engine, i, &spot);
         i++)
        json_write(json, "{x: %.2f, y: %.2f, pixels: %d, reason: %s}",
                   spot.x_q8 / 256.0, spot.y_q8 / 256.0, spot.area,
                   doubts[spot.doubt]);
    json_write(json, "]");
}

void explain_print_tables(const struct glint_explain *e,
                          const struct explain_title *t)
{
    int ghosts[GLINT_MAX_GHOSTS];

    glint_explain_sort(e, ghosts);
    print_explanation_title(e, t);
    if (e->n_lights) {
        print_lamp_rows(e, t);
        print_wavelength_rows(e);
        print_ghost_rows(e, t, ghosts);
        print_ghosts_left_out(e);
    }
    print_invalid_lights(e, t);
    print_rejected_lamps(t);
}

/* -------------------------------------------------------------------- JSON */

static void write_bundles_json(struct json_writer *json,
                               const struct glint_explain_part *p)
{
    json_write(json, "bundles: %d, drawn: %d, left_out: {",
               glint_explain_bundles(p), glint_explain_drawn(p));
    for (int outcome = GLINT_OUTCOME_EMPTY; outcome < GLINT_OUTCOMES; outcome++)
        if (p->of[outcome])
            json_write(json, "%s: %d", outcomes[outcome].word, p->of[outcome]);
    json_write(
        json,
        "}, cells: %d, terms: %d, barrels: %d, vertices: %lld, "
        "edges: %lld, rows: %lld, refs: %lld, lit_pixels: %d, "
        "tiles: %d, box: [%d, %d, %d, %d], flux: %.6g, light_share: %.6g, "
        "brightest: %.6g, work_share: %.6g",
        p->cells, p->terms, p->barrels, p->vertices, p->edges, p->rows, p->refs,
        p->lit, p->tiles, p->x0, p->y0, p->x1, p->y1, p->flux, p->share,
        p->brightest, p->cost);
}

static void write_lights_json(struct json_writer *json,
                              const struct glint_explain *e,
                              const struct explain_title *t)
{
    json_write(json, "lights: [");
    for (int i = 0; i < e->n_lights; i++) {
        const struct glint_light *b = &e->lights[i];

        json_write(json, "{lamp: %d, angle_deg: %.6g, azimuth_deg: %.6g",
                   e->lamp_of[i] + 1,
                   compute_direction_angle_deg(b->sine_q30, b->cosine_q30),
                   compute_direction_angle_deg(b->sin_q30, b->cos_q30));
        write_bundles_json(json, &e->light[i]);
        json_write(json, "}");
    }
    json_write(json, "], beyond_model_deg: [");
    for (int i = 0; i < t->n_lamps; i++)
        if (glint_explain_is_beyond(e, &t->lamp[i].lamp))
            json_write(json, "%.6g", t->lamp[i].lamp.theta_deg);
    json_write(json, "]");
    if (e->lens)
        json_write(json, ", model_max_deg: %.6g",
                   model_convert_sine_to_deg(e->lens->header->sine_hi_q30));
}

static void write_title_json(struct json_writer *json,
                             const struct glint_explain *e,
                             const struct explain_title *t)
{
    json_write(json,
               "{lens: %s, rays: %s, width: %d, height: %d, picture: %s, "
               "lights_given: %d, lights_apart: %d, all_tiles: %d, "
               "held_cells: %d, held_samples: %d, frame: {",
               t->lens, e->lens ? "model" : "exact", e->view->width,
               e->view->height, t->linear ? "linear" : "codes", t->n_lamps,
               t->report->apart_lights, e->n_tiles, t->report->stats.held_cells,
               t->report->held_samples);
    write_bundles_json(json, &e->all);
    json_write(json, "}, work: {instructions: %.0f", e->all.work);
    for (int i = 0; i < GLINT_COST_KINDS; i++)
        json_write(json, "%s: %.6g",
                   i == GLINT_COST_LIT ? "pixels" : glint_cost_weight[i].name,
                   e->all.work > 0 ? e->stage[i] / e->all.work : 0);
    json_write(json, "}, barrels: [");
    for (int n = 0; n < GLINT_EXPLAIN_BARRELS; n++)
        json_write(json, "%d", e->barrels[n]);
    json_write(json, "]");
}

void explain_write_json(const struct glint_explain *e,
                        const struct explain_title *t)
{
    struct json_writer json = {.to = stdout};
    int ghosts[GLINT_MAX_GHOSTS];

    glint_explain_sort(e, ghosts);
    write_title_json(&json, e, t);
    write_lights_json(&json, e, t);
    write_rejected_json(&json, t);
    json_write(&json, "wavelengths: [");
    for (int i = 0; i < e->n_waves; i++) {
        if (e->set_size)
            json_write(&json, "{of: %d", e->set_size[i]);
        else
            json_write(&json, "{nm: %g", e->setup->wavelength_nm[i]);
        write_bundles_json(&json, &e->wave[i]);
        json_write(&json, "}");
    }
    json_write(&json, "], ghosts: [");
    for (int i = 0; i < e->n_ghosts; i++) {
        const struct glint_ghost *g = &e->setup->ghost[ghosts[i]];

        json_write(&json, "{ghost: %d, pair: [%d, %d]", ghosts[i], g->i, g->j);
        write_bundles_json(&json, &e->ghost[ghosts[i]]);
        json_write(&json, "}");
    }
    json_write(&json, "]}\n");
}
