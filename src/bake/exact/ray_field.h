/* SPDX-License-Identifier: MIT
 *
 * The exact rays of one ghost for all directions and wavelengths near by.
 *
 *   in   a ghost, a small range of directions, wavelengths
 *   out  vertices of its grid for any direction and wavelength in them
 *
 * One grid of pupil points is traced from a few directions and at a few
 * wavelengths; every vertex is a polynomial of the second degree in between.
 * So the points of an area lamp, lamps near each other and wavelengths share
 * rays. In the light's frame the rays of a round lens depend on the angle off
 * the axis alone: lamps at one angle share them at any azimuth.
 *
 * A direction is a pair of coordinates: of a round lens the angle in degrees
 * and 0, of others the components x and y of the direction in the frame of the
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
    RAY_FIELD_NODES = 7, /* wavelengths traced, if there are more than these */
    RAY_FIELD_SAMPLES = RAY_FIELD_NODES + 5 + 4
};

/* A range of directions: its middle and half its size. Of a round lens only
 * the first component is used. */
struct ray_patch {
    double phi_deg; /* azimuth of the frame; of a round lens 0 */
    double middle[2], half[2];
};

struct ray_field_config {
    const struct glint_setup *setup;
    struct glint_view view;
    bool round;    /* the lens is round */
    int max_cells; /* fineness of the grids, 1 .. 1024 */
    bool uniform;  /* true: all ghosts get max_cells cells per side */
    /* nm: the ends of the wavelengths and one near the middle. */
    double wave_nm[3];
};

/* One wavelength or direction that was traced. */
struct ray_sample {
    double nm, at[2];
};

/* What the rays of a field tell, whatever the size of the picture. */
struct ray_sight {
    /* From struct glint_sampling, mm. */
    double bend_mm, outline_mm, round_mm, step;
    int n_inside;
    /* Largest flux of a cell of a coarse grid, mm^2, and largest flux per mm^2
     * of the sensor, for irradiance 1; HUGE_VAL: not known. */
    double cell_flux, density;
    double
        sag[3]; /* as of a field with one cell per side; of a circular stop */
};

struct ray_field {
    int ghost;
    const struct ray_patch *patch;
    /* Directions between which rays are interpolated, all within PATCH: set by
     * glint_ray_field_choose(). */
    struct ray_patch range;
    /* Set by glint_ray_field_look(): */
    bool is_looked, is_open; /* is_open: light of the ghost gets through */
    struct ray_sight sight;
    struct glint_pupil pupil; /* without a rim until glint_ray_field_fit() */
    int n_cells;              /* cells per side */
    int least_cells;          /* fewest that do not step over the opening */
    bool folds;
    int n_cuts, cut_event[RAY_FIELD_CUTS]; /* as chosen by the sampling */
    double
        energy_unit; /* ray energy that energy 65536 of a vertex stands for */
    double flux;     /* mm^2 of pupil times energy that get through */
    double peak_mm2; /* bound of the flux per mm^2 of a pixel of the sensor for
                        irradiance 1; HUGE_VAL: not known */
    /* Mean height by which straight lines between the rays of a cell lie above
     * (1 + r^2) / 2 of two barrels and of a round stop, which is bent. */
    double sag[3];
    double apart_mm; /* RMS distance on the sensor between the outermost
                        wavelengths */
    int n_nodes, n_samples;
    double node_nm[RAY_FIELD_NODES];
    struct ray_sample sample[RAY_FIELD_SAMPLES];
};

/* Looks at FIELD, whose ghost and patch are set: finds the part of the pupil,
 * the barrels that cut, and how bright the ghost is. Does not depend on the
 * view and the fineness of CFG. */
void glint_ray_field_look(const struct ray_field_config *cfg,
                          struct ray_field *field);

/* Sets the grid of FIELD, which was looked at and is open, for the view of CFG,
 * and adds a rim of a pixel to its pupil. With max_cells 64 light is off by
 * 0.01 px (RMS), outlines by 0.1 px; with n times as many cells, by n^2 times
 * less. */
void glint_ray_field_fit(const struct ray_field_config *cfg,
                         struct ray_field *field);

/* Makes the grid BY times as fine, BY at most 1, for a faint ghost. */
void glint_ray_field_coarsen(const struct ray_field_config *cfg,
                             struct ray_field *field, double by);

/* Chooses the samples for the directions RANGE, which lie within the patch of
 * FIELD, and for the wavelengths NM[N], which rise. */
void glint_ray_field_choose(struct ray_field *field,
                            const struct ray_patch *range, const double *nm,
                            int n);

/* Returns the bytes that glint_ray_field_trace() fills. */
size_t glint_ray_field_bytes(const struct ray_field_config *cfg,
                             const struct ray_field *field);

/* Traces all samples into MEM. */
void glint_ray_field_trace(const struct ray_field_config *cfg,
                           const struct ray_field *field, void *mem);

/* One direction and wavelength of a traced field. */
struct ray_place {
    const struct ray_field *field;
    const void *mem;
    float weight[RAY_FIELD_SAMPLES];
    double cosine, sine; /* from the frame to the picture */
};

/* Sets PLACE to direction AT and wavelength NM in FIELD, turned by PHI_DEG. */
void glint_ray_place_set(struct ray_place *place, const struct ray_field *field,
                         const void *mem, const double at[2], double nm,
                         double phi_deg);

/* Sets ROW to row J of the vertices. */
void glint_ray_place_row(const struct ray_field_config *cfg,
                         const struct ray_place *place, int j,
                         struct glint_vertex *row);

/* Sets FROM to the direction at AT. */
void glint_ray_direction(const struct ray_field_config *cfg, const double at[2],
                         double direction[3]);

#endif
