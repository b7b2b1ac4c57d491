/* SPDX-License-Identifier: MIT
 *
 * The Fraunhofer pattern of a stop, in doubles: near the light summed exactly
 * over the spectrum, farther out without the fringes, which the spectrum
 * averages out.
 *
 *     glint_psf_init(&psf, n_blades, rotation_deg, airy_px);
 *     glint_psf_compute_light(&psf, x, y, rgb);           a point of the
 * picture glint_psf_finish(&psf);
 *
 * With F the transform of the stop of area A (both in stop radii), and a =
 * wavelength times f-number in pixels, light per pixel^2 is |F(x / 2a)|^2 / (4
 * a^2 A). F is a sum over straight edges, of length L, normal n, direction t
 * and middle m:
 *
 *     F(q) = sum i L (q n) / (2 pi |q|^2) sinc(q t L) exp(-2 pi i q m)
 *
 * Far out, edges that share no end add up by their squares. With u = q n, v = q
 * t in pixels, each edge gives L^2 u^2 / (4 pi^2 A r^4) sinc^2(v L / 2a), and
 * each pair of neighbours, which share an end, -a^2 / (2 pi^4 A r^4) u u' / (v
 * v'). */
#ifndef GLINT_ENGINE_STAR_PSF_H
#define GLINT_ENGINE_STAR_PSF_H

#include "engine/star/arcs.h"
#include "glint/light.h"
#include "glint/status.h"

enum {
    GLINT_PSF_WAVES = 41, /* wavelengths, 400 to 700 nm */
    GLINT_PSF_STEPS = 20, /* rows of a table per order of diffraction */
    GLINT_PSF_PROFILE = 2048
};

struct glint_psf {
    int n_blades; /* 0: circle */
    double rotation_deg;
    double soft; /* width of a soft edge, stop radii */
    int fans; /* 1: blades are round or soft and produce fans instead of lines
               */
    double round;           /* curvature of blades with fans */
    struct glint_arcs arcs; /* arcs of a stop with fans, without rotation */
    double (*far)[3];       /* [n_far][129]: light times r^2 of fans */
    int n_far;
    double airy_px; /* pixels: 550 nm times the f-number */
    /* Number of lines that edges produce, and number of parallel edges per
     * line, 1 or 2. */
    int n_lines, n_pair;
    double edge, area, perimeter; /* size of the stop of radius 1 */
    /* Normals of the lines, y down; edges in order. */
    double normal[GLINT_MAX_BLADES][2];
    double width_px; /* pixels from the middle of a profile to its first zero,
                        at 550 nm */
    double scale[GLINT_PSF_WAVES];     /* wavelength / 550 nm */
    double weight[GLINT_PSF_WAVES][3]; /* each channel sums to 1 */
    /* Sums of weight * scale, and of weight * scale^2. */
    double mean[3], square[3];
    /* Mean of sinc^2 over the spectrum at v = 32 width_px i /
     * GLINT_PSF_PROFILE. */
    double profile[GLINT_PSF_PROFILE + 1][3];
    double smooth[GLINT_PSF_PROFILE + 1][3]; /* profile averaged over fringes */
    int n_rows, n_columns; /* size of NEAR: GLINT_PSF_STEPS rows for each order
                              of diffraction, from the middle, and a column for
                              each angle from a line to half-way to the next */
    double (*near)[3];     /* [n_rows][n_columns]: light times airy_px^2 */
};

/* Computes the pattern of a stop. Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_psf_init(struct glint_psf *psf, int n_blades,
                                 double rotation_deg, double airy_px);
void glint_psf_finish(struct glint_psf *psf);

/* Makes the pattern of a stop with blades of curvature ROUND, 0 .. 1, and an
 * edge as soft as SOFT, 0 .. 1, as in struct glint_iris. ROUND below 0.01 with
 * SOFT below 0.002 is straight, ROUND from 0.98 on is a circle. */
enum glint_status glint_psf_init_iris(struct glint_psf *psf, int n_blades,
                                      double rotation_deg, double airy_px,
                                      double round, double soft);

/* Computes the table of fans; glint_fans_interpolate_light() returns their
 * light at orders of diffraction above 12. */
enum glint_status glint_fans_make_table(struct glint_psf *psf);
/* Sets RGB to the light of fans R pixels away, in a direction OFF from a
 * line. */
void glint_fans_interpolate_light(const struct glint_psf *psf, double r,
                                  double off, double rgb[3]);

/* Returns the factor of a soft edge of width SOFT on light at Q cycles per
 * stop radius: the square of the transform of its slope. */
double glint_psf_compute_soft_edge_factor(double soft, double q);

/* Returns the angle of line I, y down, 0 to below pi, rising. */
double glint_psf_line_angle(const struct glint_psf *psf, int i);

/* Sets RGB to the light of a line's profile V pixels across it, times r^4 /
 * u^2. */
void glint_psf_interpolate_profile(const struct glint_psf *psf, double v,
                                   double rgb[3]);

/* Sets RGB to the light far from the lamp, of profiles and corners. With
 * WINDOW, profiles have no fringes and are multiplied by 1 - WINDOW(V). */
typedef double glint_psf_window_fn(double v, const void *self);
void glint_psf_compute_far_light(const struct glint_psf *psf, double x,
                                 double y, glint_psf_window_fn *window,
                                 const void *self, double rgb[3]);

void glint_psf_compute_light(const struct glint_psf *psf, double x, double y,
                             double rgb[3]);

/* Returns the fraction of the light of channel C that lies farther out than R
 * pixels. */
double glint_psf_compute_light_beyond(const struct glint_psf *psf, double r,
                                      int c);

/* Returns |F(q)|^2 / A^2; q is in cycles per stop radius, x right, y up. */
double glint_psf_compute_pattern(int n_blades, double rotation_deg, double qx,
                                 double qy);

#endif
