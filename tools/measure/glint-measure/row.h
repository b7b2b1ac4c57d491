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
    /* the lens table; only its name is set if the lens is a model */
    struct glint_prescription table;
    int width, height, n_lights;
    double theta, phi; /* direction of the first light, degrees */
    /* power of all lights, stops above white at exposure 1; NAN: the exposure
     * is computed from the brightness of the flare instead */
    double stops;
    /* log2 of the number of cells per side of dust tables; 0: the quality
     * determines it */
    int dust_log2;
    int grid;   /* cells per side of the grid of rays for the exact image */
    int rounds; /* number of frames drawn; the min of their times is reported */
    /* Type of the image. "linear": the flare in linear light; "codes": the
     * flare in sRGB codes on black; "frame": the flare drawn in place onto a
     * dim YUYV frame, as in glint bench. */
    const char *picture;
    /* Parameters "PARAMETER=VALUE;..." of the reference image with which images
     * of type "codes" are compared. NULL: the reference image has exact
     * rays. */
    const char *reference;
    /* f-number to bake a model for; tables with a smaller max aperture use
     * their own f-number. Below 0: use the cached model. */
    double bake_stop;
    /* wavelengths at which model and exact rays are compared, nm */
    double nm[GLINT_MAX_WAVELENGTHS];
    int n_nm;
    double step_deg; /* step between angles of this comparison */
};

/* Sets ROW to the defaults, then applies the N texts PARAMETER=VALUE in
 * ASSIGNMENT. A parameter is the name of a member above or of an engine option.
 * ASSIGNMENT must outlive ROW. Returns an exit code. */
int row_parse(struct figure_row *row, struct tool *tool, int n,
              char **assignment);

/* Measures ROW and prints a JSON object. Returns an exit code. */
int row_measure(struct figure_row *row);

/* row_measure_ray_errors() (rays.c) writes the errors of the model against
 * exact rays. row_measure_ghost_positions() (places.c) writes how far lights
 * and ghosts shift if the lens's projection replaces that of a pinhole. Both
 * return an exit code. */
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
