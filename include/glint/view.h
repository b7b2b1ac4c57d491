/* SPDX-License-Identifier: MIT
 *
 * glint/view.h - converts between directions of lamps and pixels of a picture
 * on the sensor. */
#ifndef GLINT_VIEW_H
#define GLINT_VIEW_H

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_PI 3.14159265358979323846

/* A lamp: a light at infinity, possibly with an extent. */
struct glint_lamp {
    double theta_deg; /* angle off the axis, 0 .. 89.9 */
    double phi_deg;   /* angle about the axis: 0 = +x, 90 = up */
    /* Brightness of the lamp: the value that the pixels of its in-focus image
     * would have if the image covered one pixel, linear; 1 = display white. */
    double power;
    double rgb[3]; /* colour, linear BT.709; white is 1 1 1 */
    /* RMS semi-axes of the lamp's extent, the major axis first, as tangents of
     * angles off the axis (image / focal length); 0 0: a point. Only functions
     * that divide a lamp into points use them. In exact pictures and traced
     * bundles the lamp is one point. */
    double axis[2];
    double turn_deg; /* direction of the major axis, 0 = +x, 90 = up */
};

/* The projection of a lens. It states for each distance of an image from the
 * axis at which angle the light arrives. With rho = distance / focal length,
 * the angle off the axis is
 *
 *     theta = atan(rho) (1 + b[0] r^2 + b[1] r^4 + .. ),  r = min(rho, reach)
 *
 * If all members are 0, the projection is that of a pinhole, rho = tan(theta),
 * for all angles below 90 degrees. */
#define GLINT_PROJECTION_TERMS 4
struct glint_projection {
    double reach; /* max rho at which the lens was traced */
    double b[GLINT_PROJECTION_TERMS];
};

/* A picture on the sensor: centred, with square pixels. */
struct glint_view {
    int width, height;      /* size of the picture, pixels */
    double sensor_width_mm; /* width of the picture on the sensor, mm */
    /* Projection of the lens, for all lights of the picture. */
    struct glint_projection projection;
};

/* Returns the angle off the axis, 0 .. 89.9 degrees, of light that is imaged at
 * a distance of RHO focal lengths from the axis. */
double glint_projection_deg(const struct glint_projection *projection,
                            double rho);

/* Returns the distance from the axis, in focal lengths, at most 1e6, at which
 * light from the angle THETA_DEG is imaged. */
double glint_projection_rho(const struct glint_projection *projection,
                            double theta_deg);

/* Returns the largest view of WIDTH x HEIGHT pixels that fits into an image
 * area (film) of FILM_WIDTH_MM x FILM_HEIGHT_MM. */
struct glint_view glint_view_fit(int width, int height, double film_width_mm,
                                 double film_height_mm);

/* Returns the tangent of the angle that a pixel on the axis covers behind a
 * lens of focal length FOCAL_MM. */
double glint_view_pixel_tangent(const struct glint_view *view, double focal_mm);

/* Convert between the direction of a light, theta_deg and phi_deg of LAMP, and
 * the position (X, Y) of its image in VIEW behind a lens of focal length
 * FOCAL_MM. Pixels count from the top left corner, y down. */
void glint_view_to_angles(const struct glint_view *view, double focal_mm,
                          double x, double y, struct glint_lamp *lamp);
void glint_view_to_pixel(const struct glint_view *view, double focal_mm,
                         const struct glint_lamp *lamp, double *x, double *y);

#ifdef __cplusplus
}
#endif

#endif
