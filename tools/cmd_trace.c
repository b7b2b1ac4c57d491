/* SPDX-License-Identifier: MIT
 *
 * glint trace: exact rays as a table.
 */
#include <stdlib.h>
#include <string.h>
#include <math.h>

#include "tool.h"

static const char help[] =
    "glint trace LENS --ghost K --angle DEG --wavelength NM --grid N [--csv]\n"
    "\n"
    "Prints one line a ray, over an N x N grid that spans the clear square of\n"
    "the front element, x fastest:\n"
    "  px,py,status,stop_x,stop_y,sensor_x,sensor_y,energy,rel_radius\n"
    "in mm. Status 0 ok, 1 missed a surface, 2 total reflection; the columns\n"
    "after it are empty then. The light lies in the x-z plane.\n"
    "\n"
    "  --ghost K        number of the ghost as 'glint info' counts; -1 is the\n"
    "                   direct path\n"
    "  --angle DEG      off the axis, below 90 (default 0)\n"
    "  --wavelength NM  default 532\n"
    "  --grid N         1 to 4096 rays a side (default 17)\n"
    "  --csv            the format above; there is no other\n";

struct options {
    int ghost, grid;
    double angle_deg, wavelength_nm;
};

static int parse(struct tool *tool, int argc, char **argv, struct options *o)
{
    static const struct option options[] = {
        {"ghost", required_argument, NULL, 'g'},
        {"angle", required_argument, NULL, 'a'},
        {"wavelength", required_argument, NULL, 'w'},
        {"grid", required_argument, NULL, 'n'},
        {"csv", no_argument, NULL, 'c'},
        TOOL_COMMON_OPTIONS};
    int c, code;

    while ((c = getopt_long(argc, argv, TOOL_COMMON_SHORT, options, NULL)) >=
           0) {
        bool ok = true;

        if (c == 'g')
            ok = tool_integer(optarg, -1, GLINT_MAX_GHOSTS, &o->ghost);
        else if (c == 'a')
            ok = tool_number(optarg, &o->angle_deg) && fabs(o->angle_deg) < 90;
        else if (c == 'w')
            ok = tool_number(optarg, &o->wavelength_nm) &&
                 o->wavelength_nm >= 300 && o->wavelength_nm <= 1100;
        else if (c == 'n')
            ok = tool_integer(optarg, 1, 4096, &o->grid);
        else if (c != 'c' && (code = tool_option(tool, c, optarg)) >= 0)
            return code;
        if (!ok)
            return tool_usage(tool, "'%s' is out of range", optarg);
    }
    if (optind + 1 != argc)
        return tool_usage(tool, "takes one lens");
    return -1;
}

static void print_rays(const struct options *o,
                       const struct glint_prescription *lens,
                       const struct glint_path *path)
{
    const double angle = o->angle_deg * 3.14159265358979323846 / 180;
    const double direction[3] = {sin(angle), 0, cos(angle)};
    const double semi = lens->surface[0].semi_mm;
    const int last = o->grid - 1;

    printf("px,py,status,stop_x,stop_y,sensor_x,sensor_y,energy,rel_radius\n");
    for (int k = 0; k < o->grid * o->grid && !ferror(stdout); k++) {
        const int i = k % o->grid, j = k / o->grid;
        const double x = last ? semi * (2.0 * i - last) / last : 0;
        const double y = last ? semi * (2.0 * j - last) / last : 0;
        struct glint_ray ray;
        const enum glint_ray_status status =
            glint_trace(path, x, y, direction, &ray, NULL);

        printf("%.12g,%.12g,%d,", x, y, (int)status);
        if (status == GLINT_RAY_OK)
            printf("%.12g,%.12g,%.12g,%.12g,%.12g,%.12g\n", ray.stop_x_mm,
                   ray.stop_y_mm, ray.sensor_x_mm, ray.sensor_y_mm, ray.energy,
                   ray.rel_radius);
        else
            printf(",,,,,\n");
    }
}

int cmd_trace(int argc, char **argv)
{
    static struct glint_prescription lens;
    static struct glint_ghost ghosts[GLINT_MAX_GHOSTS];
    static struct glint_path path;
    struct tool tool = {.name = "trace", .help = help};
    struct options o = {0, 17, 0, 532};
    int n, code = parse(&tool, argc, argv, &o);

    if (code < 0)
        code = tool_lens(&tool, argv[optind], &lens);
    else
        return code;
    if (code != EXIT_OK)
        return code;
    n = glint_ghost_list(&lens, ghosts, GLINT_MAX_GHOSTS);
    if (o.ghost >= n)
        return tool_usage(&tool, "%s has %d ghosts, there is no %d", lens.name,
                          n, o.ghost);
    glint_path_init(&path, &lens, o.ghost < 0 ? NULL : &ghosts[o.ghost],
                    o.wavelength_nm);
    print_rays(&o, &lens, &path);
    return EXIT_OK;
}
