/* SPDX-License-Identifier: MIT
 *
 * One row of a figure: a lens and values of parameters, and the metrics that
 * are measured with them and printed as JSON.
 */
#ifndef GLINT_TOOLS_MEASURE_ROW_H
#define GLINT_TOOLS_MEASURE_ROW_H

#include "glint/bake.h"
#include "model/opened_lens.h"

struct figure_row {
    struct tool *tool;
    struct json_writer json;
    int n;
    char **assignment;   /* [n], as row_open() was given */
    const char *metrics; /* names with commas: what to measure */
    const char *lens;    /* table or model */
    struct settings settings;
    struct opened_lens opened;
    struct glint_prescription table; /* of the lens; of a model only its name */
    int width, height, n_lights;
    double theta, phi; /* direction of the first light, degrees */
    double stops;      /* powers of all lights over white, at an exposure of 1;
                          NAN: the exposure makes the flare white */
    int dust_log2;     /* cells per side of tables of dust; 0: by quality */
    int grid;          /* cells per side of the exact picture's rays */
    int rounds;        /* frames drawn; times are the least of them */
    /* linear: the flare in linear light; codes: in sRGB codes on black; frame:
     * drawn in place onto a dim YUYV frame, as glint bench does. */
    const char *picture;
    /* "PARAMETER=VALUE;...": pictures in codes are compared with the same row
     * with these; NULL: with exact rays. */
    const char *reference;
    double bake_stop; /* f-number to bake a model for here; narrower tables keep
                         theirs. Below 0: the model is the cached one. */
    double nm[GLINT_MAX_WAVELENGTHS]; /* of metrics of rays */
    int n_nm;
    double step_deg; /* between angles of metrics of rays */
};

/* Sets ROW to the defaults and to N texts PARAMETER=VALUE, which it keeps:
 * those above by name, or options of the engine. Returns an exit code. */
int row_open(struct figure_row *row, struct tool *tool, int n,
             char **assignment);

/* Measures ROW and prints a JSON object. Returns an exit code. */
int row_measure(struct figure_row *row);

/* Returns whether one of NAMES, with commas, is among the metrics. */
bool row_wants(const struct figure_row *row, const char *names);

/* Write how far the model is from exact rays (rays.c), and where lights and
 * ghosts are by the lens's projection (places.c). Return an exit code. */
#define ROW_RAYS                                                             \
    "rays,sensor_p99,sensor_p99_ghosts,stop_rms,stop_rms_ghosts,energy_p99," \
    "energy_p99_ghosts,lost,lost_light,ghosts_seen,ghosts_miss,angles_seen," \
    "angles_miss,stop_x_rms,stop_y_rms,sensor_x_rms,sensor_y_rms,energy_rms"
#define ROW_PLACES                                                             \
    "traced_deg,miss_deg,half_tan,half_lens,half_light,half_ghosts,half_most," \
    "corner_tan,corner_lens,corner_light,corner_ghosts,corner_most"
int row_rays(struct figure_row *row);
int row_places(struct figure_row *row);

#endif
