/* SPDX-License-Identifier: MIT
 *
 * Resamples a panorama to an octahedron map.
 *
 * Each pixel is subdivided into points at most half a texel apart. Each point
 * adds its light to the texel in which it lies. So a texel averages the area
 * that it covers, and energy is preserved. If the picture is coarser than the
 * map, some texels have no points. They get the light of the pixel at their
 * centre.
 */
#include "bake/environment/sphere.h"

#include <math.h>

#include "glint/view.h"

enum shape { LATITUDES, CUBE, NO_SHAPE };

struct panorama {
    const struct glint_float_image *picture;
    enum shape shape;
    /* rotation of the panorama about the y axis: cosine and sine of the
     * angle */
    double turn[2];
    /* scale: factor on all light; largest: max finite sample of the picture */
    double scale, largest;
};

static enum shape detect_panorama_shape(const struct glint_float_image *picture)
{
    if (picture->width == 2 * picture->height)
        return LATITUDES;
    return 2 * picture->width == 3 * picture->height && picture->height > 1
               ? CUBE
               : NO_SHAPE;
}

/* Rotates X to the right about the y axis. BY: cosine and sine of the angle. */
static void rotate_vector_about_y(const double by[2], double x[3])
{
    const double across = by[0] * x[0] + by[1] * x[2];

    x[2] = by[0] * x[2] - by[1] * x[0];
    x[0] = across;
}

/* Sets TOWARD to the direction of picture coordinates (X, Y), pixels. Returns
 * the solid angle of a pixel there, sr. */
static double compute_pixel_direction(const struct panorama *p, double x,
                                      double y, double toward[3])
{
    const int w = p->picture->width, h = p->picture->height, face = h / 2;
    double size;

    if (p->shape == LATITUDES) {
        const double east = 2 * GLINT_PI * (x / w - .5);
        const double up = GLINT_PI * (.5 - y / h);

        toward[0] = cos(up) * sin(east);
        toward[1] = sin(up);
        toward[2] = cos(up) * cos(east);
        size = 2 * GLINT_PI / w * GLINT_PI / h * cos(up);
    } else {
        /* The picture shows the cube's faces as seen from its centre, with y
         * up. The -y and +y faces are oriented such that their edges meet the
         * +z face, as is usual in cube files. */
        const int axis = (int)fmin(x / face, 2), sign = y < face ? 1 : -1;
        const double a = 2 * (x / face - axis) - 1;
        const double b = 2 * (y / face - (sign < 0)) - 1;
        const double length = sqrt(1 + a * a + b * b);
        const double at[3][3] = {
            {sign, -b, -sign * a}, {a, sign, sign * b}, {sign * a, -b, sign}};

        for (int k = 0; k < 3; k++)
            toward[k] = at[axis][k] / length;
        size = 4. / face / face / (length * length * length);
    }
    rotate_vector_about_y(p->turn, toward);
    return size;
}

/* Sets LIGHT to the scaled colour of pixel I; negative and NaN samples become
 * 0, infinite ones the max finite sample. */
static void read_pixel_light(const struct panorama *p, size_t i,
                             double light[3])
{
    for (int c = 0; c < 3; c++) {
        const double x = (double)p->picture->rgb[3 * i + (size_t)c];

        if (isnan(x) || x < 0)
            light[c] = 0;
        else
            light[c] = p->scale * fmin(x, p->largest);
    }
}

static void count_invalid_pixels(struct panorama *p,
                                 struct glint_environment_report *report)
{
    const float *rgb = p->picture->rgb;
    const size_t n = (size_t)p->picture->width * (size_t)p->picture->height;

    for (size_t i = 0; i < n; i++) {
        bool negative = false, finite = true;

        for (size_t c = 3 * i; c < 3 * i + 3; c++) {
            negative |= rgb[c] < 0 && isfinite(rgb[c]);
            finite &= isfinite(rgb[c]) != 0;
            if (isfinite(rgb[c]))
                p->largest = fmax(p->largest, (double)rgb[c]);
        }
        report->negative += negative;
        report->not_finite += !finite;
    }
}

static void resample_pixel(const struct panorama *p, int x, int y, int points,
                           struct glint_sphere *sphere)
{
    double light[3], toward[3], u, v;

    read_pixel_light(p, (size_t)y * (size_t)p->picture->width + (size_t)x,
                     light);
    for (int i = 0; i < points * points; i++) {
        const int across = i % points, down = i / points;
        const double size =
            compute_pixel_direction(p, x + (across + .5) / points,
                                    y + (down + .5) / points, toward) /
            (points * points);
        struct glint_sphere_texel *t;

        glint_sphere_locate_direction(toward, &u, &v);
        t = &sphere->texel[glint_sphere_get_texel_index(
            sphere->side, (int)fmin(u * sphere->side, sphere->side - 1),
            (int)fmin(v * sphere->side, sphere->side - 1))];
        for (int c = 0; c < 3; c++)
            t->light[c] += size * light[c];
        t->weight += size;
    }
}

/* Sets texel T, in which no point lies, to the picture's pixel at T's
 * centre. */
static void fill_empty_texel(const struct panorama *p,
                             struct glint_sphere_texel *t)
{
    const double back[2] = {p->turn[0], -p->turn[1]};
    const int w = p->picture->width, h = p->picture->height, face = h / 2;
    double d[3] = {t->toward[0], t->toward[1], t->toward[2]};
    double x, y;

    rotate_vector_about_y(back, d);
    if (p->shape == LATITUDES) {
        x = w * (.5 + atan2(d[0], d[2]) / (2 * GLINT_PI));
        y = h * (.5 - asin(fmin(fmax(d[1], -1), 1)) / GLINT_PI);
    } else {
        int axis = 0;
        double sign, a, b;

        for (int k = 1; k < 3; k++)
            axis = fabs(d[k]) > fabs(d[axis]) ? k : axis;
        sign = d[axis] < 0 ? -1 : 1;
        a = axis == 0 ? -sign * d[2] : axis == 1 ? d[0] : sign * d[0];
        b = axis == 1 ? sign * d[2] : -d[1];
        x = face * (axis + .5 + .5 * a / fabs(d[axis]));
        y = face * ((sign < 0) + .5 + .5 * b / fabs(d[axis]));
    }
    read_pixel_light(p,
                     (size_t)fmin(fmax(y, 0), h - 1) * (size_t)w +
                         (size_t)fmin(fmax(x, 0), w - 1),
                     t->light);
}

bool glint_sphere_project_panorama(
    struct glint_sphere *sphere, const struct glint_float_image *picture,
    const struct glint_environment_options *options,
    struct glint_environment_report *report)
{
    const double angle = options->turn_deg * GLINT_PI / 180;
    struct panorama p = {.picture = picture,
                         .shape = detect_panorama_shape(picture),
                         .turn = {cos(angle), sin(angle)},
                         .scale = options->scale};
    /* An octahedron map of side x side texels has texels of at least 2 / side
     * radians. Points are at most half of that apart. */
    const int across =
        p.shape == CUBE ? 4 * picture->height / 2 : picture->width;
    const int points = (int)ceil(2 * GLINT_PI * sphere->side / (double)across);
    const size_t n = (size_t)sphere->side * (size_t)sphere->side;
    const double side = sphere->side;

    if (p.shape == NO_SHAPE)
        return false;
    report->width = picture->width;
    report->height = picture->height;
    count_invalid_pixels(&p, report);
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++)
            resample_pixel(&p, x, y, points, sphere);
    for (size_t i = 0; i < n; i++) {
        struct glint_sphere_texel *t = &sphere->texel[i];
        double unused[3];

        if (t->weight > 0) {
            for (int c = 0; c < 3; c++)
                t->light[c] /= t->weight;
        } else {
            fill_empty_texel(&p, t);
            t->weight = glint_sphere_compute_texel_direction(sphere->side,
                                                             (int)i, unused) /
                        (side * side);
        }
    }
    return true;
}
