/* SPDX-License-Identifier: MIT
 *
 * One row of a table of measurements: a lens and values of parameters. The
 * metrics measured with them are printed as JSON.
 */
#ifndef GLINT_TOOLS_MEASURE_ROW_H
#define GLINT_TOOLS_MEASURE_ROW_H

#include "glint/bake.h"
#include "model/opened_lens.h"

struct figure_row {
    struct tool *tool;
    struct json_writer json;
    int n;
    char **assignment;   /* the texts PARAMETER=VALUE passed to row_parse(), [n]
                          * */
    const char *metrics; /* names of metrics, separated by commas */
    const char *lens;    /* path of a lens table or model */
    struct settings settings;
    struct opened_lens opened;
    /* the lens table; for a model only its name is set */
    struct glint_prescription table;
    int width, height, n_lights;
    double theta, phi; /* direction of the first light, degrees */
    /* power of all lights, stops above white at exposure 1; NAN: the exposure
     * is computed by the brightness of the flare */
    double stops;
    int dust_log2; /* log2 of the cells per side of dust tables; 0: set by the
                      quality */
    int grid;      /* cells per side of the exact picture's rays */
    int rounds;    /* number of frames drawn; times are the minimum over them */
    /* linear: the flare in linear light; codes: in sRGB codes on black; frame:
     * drawn in place onto a dim YUYV frame, as glint bench does. */
    const char *picture;
    /* "PARAMETER=VALUE;...": pictures in codes are compared with the same row
     * with these parameters; NULL: with exact rays */
    const char *reference;
    double bake_stop; /* f-number to bake a model for; tables with a narrower
                         stop use their own. Below 0: use the cached model. */
    double nm[GLINT_MAX_WAVELENGTHS]; /* wavelengths of the ray metrics */
    int n_nm;
    double step_deg; /* step between angles of the ray metrics */
};

/* Sets ROW to the defaults, then by N texts PARAMETER=VALUE: members above by
 * name, or options of the engine. ASSIGNMENT must outlive ROW. Returns an exit
 * code. */
int row_parse(struct figure_row *row, struct tool *tool, int n,
              char **assignment);

/* Measures ROW and prints a JSON object. Returns an exit code. */
int row_measure(struct figure_row *row);

/* Write the errors of the model against exact rays (rays.c), and the positions
 * of lights and ghosts by the lens's projection (places.c). Return an exit
 * code. */
#define ROW_RAYS                                                             \
    "rays,sensor_p99,sensor_p99_ghosts,stop_rms,stop_rms_ghosts,energy_p99," \
    "energy_p99_ghosts,lost,lost_light,ghosts_seen,ghosts_miss,angles_seen," \
    "angles_miss,stop_x_rms,stop_y_rms,sensor_x_rms,sensor_y_rms,energy_rms"
#define ROW_PLACES                                                             \
    "traced_deg,miss_deg,half_tan,half_lens,half_light,half_ghosts,half_most," \
    "corner_tan,corner_lens,corner_light,corner_ghosts,corner_most"
int row_measure_ray_errors(struct figure_row *row);
int row_measure_ghost_positions(struct figure_row *row);

#endif
