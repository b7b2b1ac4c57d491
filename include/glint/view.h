/* SPDX-License-Identifier: MIT
 *
 * glint/view.h - lamps as angles, and the picture on the sensor.
 */
#ifndef GLINT_VIEW_H
#define GLINT_VIEW_H

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_PI 3.14159265358979323846

/* A light at infinity. */
struct glint_lamp {
    double theta_deg; /* angle off the axis, 0 .. 89.9 */
    double phi_deg;   /* angle about the axis: 0 = +x, 90 = up */
    double power;  /* value that the lamp's in-focus image would have if it were
                      spread over one pixel, linear; 1 = display white */
    double rgb[3]; /* colour, linear BT.709; white is 1 1 1 */
    double axis[2];  /* RMS semi-axes of its extent, the major one first, in
                        tangents of angles off the axis (image over focal
                        length); 0 0: a point. Only functions that make many
                        points of a lamp use it; the exact picture and traced
                        bundles take the lamp for one point. */
    double turn_deg; /* direction of the major axis, 0 = +x, 90 = up */
};

/* Where a lens images what lies off the axis. With rho, the image's distance
 * from the axis over the focal length, light comes from the angle
 *
 *     theta = atan(rho) (1 + b[0] r^2 + b[1] r^4 + .. ),  r = min(rho, reach)
 *
 * All zeros: as through a pinhole, rho = tan(theta), and no less than 90
 * degrees are seen. */
#define GLINT_PROJECTION_TERMS 4
struct glint_projection {
    double reach; /* rho up to which the lens was traced */
    double b[GLINT_PROJECTION_TERMS];
};

/* The place of a picture on the sensor: centred, with square pixels. */
struct glint_view {
    int width, height;      /* pixels */
    double sensor_width_mm; /* mm that the whole width of the picture takes */
    struct glint_projection projection; /* of all lights of the picture */
};

/* Returns the angle off the axis, 0 .. 89.9 degrees, of light that is imaged
 * RHO focal lengths from it. */
double glint_projection_deg(const struct glint_projection *projection,
                            double rho);

/* Returns how many focal lengths from the axis light from THETA_DEG is imaged,
 * at most 1e6. */
double glint_projection_rho(const struct glint_projection *projection,
                            double theta_deg);

/* Returns the largest view of WIDTH x HEIGHT that fits the film. */
struct glint_view glint_view_fit(int width, int height, double film_width_mm,
                                 double film_height_mm);

/* Returns the tangent of the angle that a pixel on the axis covers behind a
 * lens of FOCAL_MM. */
double glint_view_pixel_tangent(const struct glint_view *view, double focal_mm);

/* Convert between the direction of a light, theta_deg and phi_deg of LAMP, and
 * its image's place (X, Y) in VIEW behind a lens of FOCAL_MM. Pixels count from
 * the top left corner, y down. */
void glint_view_to_angles(const struct glint_view *view, double focal_mm,
                          double x, double y, struct glint_lamp *lamp);
void glint_view_to_pixel(const struct glint_view *view, double focal_mm,
                         const struct glint_lamp *lamp, double *x, double *y);

#ifdef __cplusplus
}
#endif

#endif
