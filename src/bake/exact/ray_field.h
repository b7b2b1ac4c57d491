/* SPDX-License-Identifier: MIT
 *
 * Traces exact rays of one ghost for a few directions and wavelengths and
 * interpolates between them.
 *
 *   in   a ghost, a small range of directions, wavelengths
 *   out  vertices of the ghost's grid for any direction and wavelength in these
 *        ranges
 *
 * For all traced directions and wavelengths the rays start at the same grid of
 * pupil points. Vertices are interpolated between them by polynomials of second
 * degree. So the points of an area lamp, neighbouring lamps and all wavelengths
 * use the same rays. In a round (rotationally symmetric) lens, rays depend only
 * on the angle off the axis, apart from a rotation by the azimuth. So lamps at
 * the same angle use the same rays at any azimuth.
 *
 * A direction is given by two coordinates. Round lenses: the angle in degrees,
 * and 0. Others: the x and y components of the direction, in the frame of the
 * field's azimuth. */
#ifndef GLINT_BAKE_EXACT_RAY_FIELD_H
#define GLINT_BAKE_EXACT_RAY_FIELD_H

#include <stdbool.h>
#include <stddef.h>

#include "glint/bundle.h"
#include "glint/setup.h"
#include "glint/trace.h"
#include "glint/view.h"

enum {
    RAY_FIELD_CUTS = 8,
    /* max number of wavelengths for which rays are traced */
    RAY_FIELD_NODES = 7,
    RAY_FIELD_SAMPLES = RAY_FIELD_NODES + 5 + 4
};

/* A range of light directions: middle and half size in both coordinates. Round
 * lenses only use the first coordinate. */
struct ray_patch {
    double phi_deg; /* azimuth, degrees, of the frame in which directions are
                       given; 0 for round lenses */
    double middle[2], half[2];
};

struct ray_field_config {
    const struct glint_setup *setup;
    struct glint_view view;
    bool round;    /* true: the lens is rotationally symmetric */
    int max_cells; /* max number of cells per side of a grid, 1 .. 1024 */
    bool uniform;  /* true: all ghosts get max_cells cells per side */
    bool draft;    /* true: fields are measured with fewer rays */
    /* wavelengths, nm: both ends of the band and one near its middle */
    double wave_nm[3];
};

/* A direction and a wavelength for which the grid of rays is traced. */
struct ray_sample {
    double nm, at[2];
};

/* Measurements of the rays of one ghost that do not depend on the size of the
 * picture. */
struct ray_measures {
    /* bend_mm, outline_mm, round_mm: second differences as in struct
     * glint_sampling, mm; step: distance between rays, stop radii */
    double bend_mm, outline_mm, round_mm, step;
    int n_inside;
    /* cell_flux: max flux of a cell of a coarse grid, mm^2; density: max flux
     * per mm^2 of the sensor. Both are at irradiance 1; HUGE_VAL: unknown. */
    double cell_flux, density;
    /* RMS difference of sqrt(flux per mm^2) between neighbouring cells of a
     * grid of one cell, at irradiance 1: per pupil width, weighted by area on
     * the sensor */
    double root_slope;
    /* interpolation errors, as member sag of struct ray_field, for a grid of
     * one cell and a circular stop */
    double sag[3];
};

struct ray_field {
    int ghost;
    const struct ray_patch *patch;
    /* range of directions, within patch, between which rays are interpolated;
     * set by glint_ray_field_choose_samples() */
    struct ray_patch range;
    /* is_measured: glint_ray_field_measure() has measured the field; is_open:
     * light of the ghost reaches the sensor */
    bool is_measured, is_open;
    struct ray_measures measures;
    /* part of the pupil through which visible rays enter;
     * glint_ray_field_choose_grid() adds a margin */
    struct glint_pupil pupil;
    int n_cells; /* number of grid cells per side */
    /* min number of cells per side of the grid; with fewer cells the rays could
     * miss the opening of the stop */
    int least_cells;
    bool folds;
    /* n_cuts: number of barrels that block rays; cut_event: their indices among
     * the events of the ray path */
    int n_cuts, cut_event[RAY_FIELD_CUTS];
    double energy_unit; /* energy of a ray that a vertex stores as 65536 */
    /* flux that reaches the sensor at irradiance 1: pupil area, mm^2, times ray
     * energy */
    double flux;
    /* upper bound of the flux per mm^2 on a pixel of the sensor, at irradiance
     * 1; HUGE_VAL: unknown */
    double peak_mm2;
    /* [k]: interpolation error: mean of the linear interpolation in a cell
     * minus the function (1 + r^2) / 2, where r is the distance from the centre
     * in radii. k = 0: first barrel; 1: max over the other barrels; 2: curved
     * stop. */
    double sag[3];
    /* distance on the sensor between the same rays at both ends of the band of
     * wavelengths, RMS over the rays, mm */
    double apart_mm;
    int n_nodes, n_samples;
    double node_nm[RAY_FIELD_NODES];
    struct ray_sample sample[RAY_FIELD_SAMPLES];
};

/* Measures the ghost of FIELD: the part of its pupil through which visible rays
 * enter, the barrels that block its rays, and its brightness. Ghost and patch
 * of FIELD must be set. The result does not depend on the view and on max_cells
 * of CFG. */
void glint_ray_field_measure(const struct ray_field_config *cfg,
                             struct ray_field *field);

/* Chooses the number of grid cells of FIELD for the view of CFG, and enlarges
 * its pupil by one pixel. FIELD must be measured and open. With max_cells = 64,
 * positions are wrong by 0.01 px (RMS) and outlines by 0.1 px. With n times as
 * many cells per side, both errors are divided by n^2. */
void glint_ray_field_choose_grid(const struct ray_field_config *cfg,
                                 struct ray_field *field);

/* Multiplies the number of cells per side by BY, at most 1. Used for faint
 * ghosts. */
void glint_ray_field_coarsen_grid(const struct ray_field_config *cfg,
                                  struct ray_field *field, double by);

/* Raises the number of cells per side to N, if it is smaller, within the limit
 * of max_cells. Used for bright ghosts, whose cells would be visible. */
void glint_ray_field_refine_grid(const struct ray_field_config *cfg,
                                 struct ray_field *field, double n);

/* Chooses the directions and wavelengths for which rays are traced. RANGE: all
 * directions that are needed, within the patch of FIELD; NM[N]: all wavelengths
 * that are needed, ascending. */
void glint_ray_field_choose_samples(struct ray_field *field,
                                    const struct ray_patch *range,
                                    const double *nm, int n);

/* Returns the bytes of memory that glint_ray_field_trace_rays() needs. */
size_t glint_ray_field_compute_bytes(const struct ray_field_config *cfg,
                                     const struct ray_field *field);

/* Traces the rays of FIELD for all chosen directions and wavelengths into
 * MEM. */
void glint_ray_field_trace_rays(const struct ray_field_config *cfg,
                                const struct ray_field *field, void *mem);

/* Weights by which a traced field is interpolated at one direction and
 * wavelength. */
struct ray_place {
    const struct ray_field *field;
    const void *mem;
    float weight[RAY_FIELD_SAMPLES];
    double cosine, sine; /* rotation from the direction frame to the picture */
};

/* Sets PLACE to the weights that interpolate FIELD at direction AT and
 * wavelength NM. MEM has the traced rays of FIELD. The ghost is rotated by
 * PHI_DEG. */
void glint_ray_place_set_weights(struct ray_place *place,
                                 const struct ray_field *field, const void *mem,
                                 const double at[2], double nm, double phi_deg);

/* Interpolates row J of the grid and writes its vertices to ROW. */
void glint_ray_place_interpolate_row(const struct ray_field_config *cfg,
                                     const struct ray_place *place, int j,
                                     struct glint_vertex *row);

/* Sets DIRECTION to the unit vector of the direction with the patch coordinates
 * AT. */
void glint_ray_compute_direction(const struct ray_field_config *cfg,
                                 const double at[2], double direction[3]);

#endif
