/* SPDX-License-Identifier: MIT
 *
 * projection_table LENS... - how far lights and ghosts move where a light at a
 * pixel comes from the angle that the lens images there, rather than from the
 * arc tangent of its place, as a Markdown table. Lights are at the corner of
 * the film and half-way to it; a ghost is where the mean of its rays lands.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "engine/setup/degrees.h"
#include "glint/bake.h"
#include "model/table_file.h"

enum {
    RAYS = 24, /* of a ghost, across and down */
    TRACED_DEG = 85
};

/* One lens, and what is known of it. */
struct row {
    struct glint_prescription lens;
    struct glint_setup setup;
    struct glint_projection projection;
    double miss_deg;
    double field_mm;
};

/* Where a ghost is. */
struct ghost {
    double x_mm, light;
};

/* Finds GHOST of light at THETA_DEG; without light it is nowhere. */
static struct ghost find(const struct row *r, int ghost, double theta_deg)
{
    const double stop = r->setup.optics.stop_radius_mm;
    const double d[3] = {glint_sin_deg(theta_deg), 0, glint_cos_deg(theta_deg)};
    struct ghost sum = {0, 0};
    struct glint_pupil p;
    struct glint_path path;
    double cell;

    glint_path_init(&path, &r->lens, &r->setup.ghost[ghost], 588);
    if (!glint_pupil_find_within(&p, &path, theta_deg, stop, r->field_mm, NULL))
        return sum;
    cell = (p.x1_mm - p.x0_mm) * (p.y1_mm - p.y0_mm) / (RAYS * RAYS);
    for (int k = 0; k < RAYS * RAYS; k++) {
        const double u = (k % RAYS + 0.5) / RAYS;
        const double v = ((double)(k / RAYS) + 0.5) / RAYS;
        struct glint_ray ray;

        if (glint_trace(&path, p.x0_mm + u * (p.x1_mm - p.x0_mm),
                        p.y0_mm + v * (p.y1_mm - p.y0_mm), d, &ray,
                        NULL) != GLINT_RAY_OK ||
            ray.rel_radius > 1 || hypot(ray.stop_x_mm, ray.stop_y_mm) > stop ||
            hypot(ray.sensor_x_mm, ray.sensor_y_mm) > r->field_mm)
            continue;
        sum.x_mm += ray.energy * cell * ray.sensor_x_mm;
        sum.light += ray.energy * cell;
    }
    sum.x_mm /= fmax(sum.light, 1e-300);
    return sum;
}

/* Prints what changes for a light whose image is MM from the axis. */
static void print_place(const struct row *r, double mm)
{
    const double focal = fabs(r->setup.optics.focal_mm);
    const double px = 1920 / r->lens.film_width_mm;
    const double by_tan = atan(mm / focal) * (180 / GLINT_PI);
    const double by_lens = glint_projection_deg(&r->projection, mm / focal);
    double moved = 0, light = 0, most = 0;
    int seen = 0;

    if (by_lens > TRACED_DEG) {
        printf(" %.2f | beyond %d | | | |", by_tan, TRACED_DEG);
        return;
    }

    for (int k = 0; k < r->setup.n_ghosts; k++) {
        const struct ghost a = find(r, k, by_tan), b = find(r, k, by_lens);
        const double by = fabs(b.x_mm - a.x_mm) * px;

        if (!(a.light > 0 && b.light > 0))
            continue;
        moved += b.light * by;
        light += b.light;
        most = fmax(most, by);
        seen++;
    }
    printf(" %.2f | %.2f | %.1f |", by_tan, by_lens,
           px * (focal * tan(by_lens * (GLINT_PI / 180)) - mm));
    if (seen)
        printf(" %.1f | %.1f |", moved / light, most);
    else
        printf(" | |");
}

static bool print_row(struct row *r, const char *path)
{
    static const double nm[] = {588};
    static const struct tool tool = {.name = "projection_table"};
    struct glint_error error = {""};
    double corner;

    if (tool_lens(&tool, path, &r->lens) != EXIT_OK)
        return false;
    /* Lenses that are not round have no projection. */
    if (!glint_prescription_is_round(&r->lens))
        return true;
    if (glint_setup_init(&r->setup, &r->lens, 0, 0, nm, 1, &error) !=
            GLINT_OK ||
        glint_projection_of(&r->projection, &r->lens, &r->miss_deg, &error) !=
            GLINT_OK) {
        fprintf(stderr, "projection_table: %s\n", error.text);
        return false;
    }
    corner = 0.5 * hypot(r->lens.film_width_mm, r->lens.film_height_mm);
    r->field_mm = 1.1 * corner;
    printf(
        "| %s | %.2f | %.0f | %.4f |", r->lens.name, r->setup.optics.focal_mm,
        glint_projection_deg(&r->projection, r->projection.reach), r->miss_deg);
    print_place(r, 0.5 * corner);
    print_place(r, corner);
    printf("\n");
    fflush(stdout);
    return true;
}

int main(int argc, char **argv)
{
    struct row *row = calloc(1, sizeof *row);
    bool fine = row && argc > 1;

    if (argc < 2)
        fprintf(stderr, "usage: projection_table LENS...\n");
    printf(
        "| lens | focal length, mm | traced to, degrees | off by | half-way: "
        "angle by tan | by the lens | light, px | ghosts, px | at most | "
        "corner: by tan | by the lens | light, px | ghosts, px | at most |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int k = 1; k < argc && fine; k++)
        fine = print_row(row, argv[k]);
    free(row);
    return fine ? 0 : 1;
}
