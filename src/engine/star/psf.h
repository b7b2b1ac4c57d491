/* SPDX-License-Identifier: MIT
 *
 * Computes the Fraunhofer diffraction pattern of a stop (its point spread
 * function), in doubles. Near the lamp it is summed exactly over the spectrum.
 * Farther out it is computed without fringes, as the spectrum averages them
 * out.
 *
 *     glint_psf_init(&psf, n_blades, rotation_deg, airy_px);
 *     glint_psf_compute_light(&psf, x, y, rgb);     at a point of the picture
 *     glint_psf_finish(&psf);
 *
 * With F the transform of the stop of area A (both in stop radii), and a =
 * wavelength times f-number in pixels, light per pixel^2 is |F(x / 2a)|^2 / (4
 * a^2 A). F is a sum over straight edges, of length L, normal n, direction t
 * and middle m:
 *
 *     F(q) = sum i L (q n) / (2 pi |q|^2) sinc(q t L) exp(-2 pi i q m)
 *
 * Far from the lamp the intensities of edges that share no corner are added.
 * With u = q n, v = q t in pixels, each edge contributes L^2 u^2 / (4 pi^2 A
 * r^4) sinc^2(v L / 2a), and each pair of neighbouring edges, which share a
 * corner, -a^2 / (2 pi^4 A r^4) u u' / (v v'). */
#ifndef GLINT_ENGINE_STAR_PSF_H
#define GLINT_ENGINE_STAR_PSF_H

#include <stdbool.h>

#include "engine/star/arcs.h"
#include "glint/light.h"
#include "glint/status.h"

enum {
    GLINT_PSF_WAVES = 41, /* number of wavelengths, 400 to 700 nm */
    GLINT_PSF_STEPS = 20, /* number of table rows per order of diffraction */
    GLINT_PSF_PROFILE = 2048
};

struct glint_psf {
    int n_blades; /* number of blades; 0: circle */
    double rotation_deg;
    double soft; /* width of the soft edge of the stop, stop radii; 0: hard edge
                  */
    bool draft;  /* true: tables have fewer columns or samples */
    int fans;    /* 1: blades are round or have a soft edge, and diffract light
                    into fans instead of lines */
    double round;           /* curvature of blades with fans, 1 / stop radius */
    struct glint_arcs arcs; /* arcs of a stop with fans; the stop's rotation is
                               not included */
    double (*far)[3];       /* [n_far][129]: table of the light of fans times
                               r^2 */
    int n_far;
    double airy_px; /* 550 nm times the f-number, pixels */
    /* n_lines: number of lines of the starburst; n_pair: number of parallel
     * edges per line, 1 or 2 */
    int n_lines, n_pair;
    double edge, area, perimeter; /* length of an edge, area and perimeter of
                                     the stop of radius 1 */
    /* [edge]: unit normal of an edge, along which the edge diffracts its line
     * of light; y down */
    double normal[GLINT_MAX_BLADES][2];
    double width_px; /* distance from the middle of a line's profile to its
                        first zero at 550 nm, pixels */
    double scale[GLINT_PSF_WAVES];     /* wavelength / 550 nm */
    double weight[GLINT_PSF_WAVES][3]; /* colour of each wavelength; each
                                          channel sums to 1 */
    /* sums over the wavelengths: mean: of weight * scale; square: of weight *
     * scale^2 */
    double mean[3], square[3];
    /* [i]: profile of a line at v = 32 width_px i / GLINT_PSF_PROFILE: mean of
     * sinc^2 over the spectrum */
    double profile[GLINT_PSF_PROFILE + 1][3];
    double smooth[GLINT_PSF_PROFILE + 1][3]; /* [i]: mean of the profile over
                                                one fringe */
    int n_rows, n_columns; /* size of NEAR: GLINT_PSF_STEPS rows per order of
                              diffraction, beginning at the centre; columns for
                              angles from a line to half-way to the next */
    double (*near)[3];     /* [n_rows][n_columns]: table of the light near the
                              lamp, times airy_px^2 */
};

/* Computes the pattern of a stop with straight blades and a hard edge. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status glint_psf_init(struct glint_psf *psf, int n_blades,
                                 double rotation_deg, double airy_px);
void glint_psf_finish(struct glint_psf *psf);

/* Computes the pattern of a stop with blades of curvature ROUND, 0 .. 1, and an
 * edge of softness SOFT, 0 .. 1, as in struct glint_iris. ROUND below 0.01 with
 * SOFT below 0.002 is treated as straight, ROUND from 0.98 on as a circle.
 * DRAFT: computes coarser tables, for pictures of draft quality. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status glint_psf_init_iris(struct glint_psf *psf, int n_blades,
                                      double rotation_deg, double airy_px,
                                      double round, double soft, bool draft);

/* Computes the table for glint_psf_compute_light(), which glint_psf_init()
 * makes but glint_psf_init_iris() does not. Returns GLINT_E_MEMORY on failure.
 */
enum glint_status glint_psf_make_near_table(struct glint_psf *psf);

/* Computes the table of fans, for orders of diffraction above 12. Returns
 * GLINT_E_MEMORY on failure. */
enum glint_status glint_fans_make_table(struct glint_psf *psf);
/* The light of fans at one distance from the lamp. */
struct glint_fans_row {
    const double (*light)[3]; /* the row of the table below the distance */
    double part;         /* position between this row and the next, 0 .. 1 */
    double per_r2, step; /* 1 / r^2; angle between lines, radians */
};

/* Returns the row for R pixels from the lamp. */
struct glint_fans_row glint_fans_find_row(const struct glint_psf *psf,
                                          double r);
/* Sets RGB to the light of fans at an angle OFF from a line. */
void glint_fans_interpolate_light(const struct glint_fans_row *row, double off,
                                  double rgb[3]);

/* Returns the factor by which a soft edge reduces the light at Q cycles per
 * stop radius. SOFT is the width of the edge, stop radii. The factor is the
 * squared Fourier transform of the edge's slope. */
double glint_psf_compute_soft_edge_factor(double soft, double q);

/* Returns the angle of line I, radians, y down: 0 <= angle < pi, rising with I.
 */
double glint_psf_compute_line_angle(const struct glint_psf *psf, int i);

/* Sets RGB to the profile of a line, V pixels from the line's centre; 0 if the
 * stop is a circle or diffracts fans. The profile is light times r^4 / u^2,
 * where r is the distance from the lamp and u its component along the line. */
void glint_psf_interpolate_profile(const struct glint_psf *psf, double v,
                                   double rgb[3]);

/* Sets RGB to the far-field light at (X, Y), pixels from the lamp: lines,
 * corners and fans. If WINDOW is not NULL, lines have their smooth profiles,
 * multiplied by 1 - WINDOW(V). */
typedef double glint_psf_window_fn(double v, const void *self);
void glint_psf_compute_far_light(const struct glint_psf *psf, double x,
                                 double y, glint_psf_window_fn *window,
                                 const void *self, double rgb[3]);

void glint_psf_compute_light(const struct glint_psf *psf, double x, double y,
                             double rgb[3]);

/* Returns the fraction of the light of channel C that lies more than R pixels
 * from the lamp. */
double glint_psf_compute_light_beyond(const struct glint_psf *psf, double r,
                                      int c);

/* Returns |F(q)|^2 / A^2, the pattern relative to its centre, at one
 * wavelength. q = (QX, QY) is in cycles per stop radius, x to the right, y
 * up. */
double glint_psf_compute_pattern(int n_blades, double rotation_deg, double qx,
                                 double qy);

#endif
