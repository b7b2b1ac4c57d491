/* SPDX-License-Identifier: MIT
 *
 * Checks conics, aspheres, cylinders, torics, and shifted and tilted surfaces.
 * Parsed values must be right, and rays must equal rays of a second method and
 * analytic results.
 */
#include "bake/table/form.h"
#include "bake/trace/beam.h"
#include "support/lens_check.h"

static struct glint_optics optics;

#define LINE_D_NM 587.5618

static struct glint_prescription lens;
static struct glint_path path;

/* Parses a lens with the surface lines SURFACES. */
static enum glint_status parse_lens_of_surfaces(const char *surfaces,
                                                struct glint_error *error)
{
    char text[1500];

    snprintf(text, sizeof text,
             "name t\nf-number 20\nfilm 36 24\nstop 9 30\n%s\n", surfaces);
    return glint_prescription_parse(&lens, text, strlen(text), "t.lens", error);
}

static void load_lens_of_surfaces(const char *surfaces)
{
    struct glint_error error = {""};

    if (parse_lens_of_surfaces(surfaces, &error) != GLINT_OK)
        fail_msg("%s: %s", surfaces, error.text);
}

/* ------------------------------------------------ independent intersections */

/* Returns the sag by the definition of the surface, in long double and without
 * derivatives, independent of the library. */
static long double surface_sag(const struct glint_surface *s, long double x,
                               long double y)
{
    const struct glint_shape *const a = &s->shape;
    const long double along2 = a->bend == GLINT_BEND_ROUND ? x * x + y * y
                               : a->bend == GLINT_BEND_X   ? x * x
                                                           : y * y;
    const long double aside2 = a->bend == GLINT_BEND_X ? y * y : x * x;
    const long double r = s->radius_mm, k1 = 1 + (long double)a->conic;
    long double z = 0, power = along2;

    if (r != 0)
        z = along2 / r / (1 + sqrtl(1 - k1 * along2 / (r * r)));
    for (int k = 0; k < GLINT_SHAPE_TERMS; k++)
        z += a->term[k] * (power *= along2);
    if (a->bend != GLINT_BEND_ROUND && a->across_mm != 0) {
        const long double big = a->across_mm, side = big < 0 ? -1 : 1;

        z = big - side * sqrtl((big - z) * (big - z) - aside2);
    }
    return z;
}

struct line {
    long double at[3], way[3];
};

/* Transforms LINE from the axes of the lens to those of surface S, by
 * successive rotations. */
static struct line transform_to_surface_frame(const struct glint_surface *s,
                                              const struct line *line)
{
    const struct glint_shape *const a = &s->shape;
    const long double degree = acosl(-1) / 180;
    struct line out = *line;

    for (int k = 0; k < 2; k++)
        out.at[k] -= a->decentre_mm[k];
    out.at[2] -= a->pivot_mm;
    /* undo the rotation about y, then about x */
    for (int axis = 1; axis >= 0; axis--) {
        const long double t = (axis ? -1 : 1) * degree * a->tilt_deg[axis];
        /* the coordinate that this rotation mixes with z */
        const int other = 1 - axis;

        for (int v = 0; v < 2; v++) {
            long double *p = v ? out.way : out.at;
            const long double q = p[other], z = p[2];

            p[other] = q * cosl(t) + z * sinl(t);
            p[2] = z * cosl(t) - q * sinl(t);
        }
    }
    out.at[2] += a->pivot_mm;
    return out;
}

static long double gap_to_surface(const struct glint_surface *s,
                                  const struct line *l, long double t)
{
    return l->at[2] + t * l->way[2] -
           surface_sag(s, l->at[0] + t * l->way[0], l->at[1] + t * l->way[1]);
}

/* Finds the intersection nearest to the vertex plane: searches outwards in
 * small steps, then bisects. Returns false if there is none within the distance
 * REACH. */
static bool find_nearest_intersection(const struct glint_surface *s,
                                      const struct line *l, long double reach,
                                      long double *t)
{
    const long double plane = -l->at[2] / l->way[2];
    const int n = 4000;

    for (int k = 0; k < n; k++)
        for (int side = -1; side <= 1; side += 2) {
            long double low = plane + side * reach * k / n;
            long double high = plane + side * reach * (k + 1) / n;

            if (!(gap_to_surface(s, l, low) * gap_to_surface(s, l, high) <= 0))
                continue;
            for (int i = 0; i < 80; i++) {
                const long double middle = (low + high) / 2;

                if (gap_to_surface(s, l, low) * gap_to_surface(s, l, middle) <=
                    0)
                    high = middle;
                else
                    low = middle;
            }
            *t = low;
            return true;
        }
    return false;
}

/* Refracts the direction WAY at the surface by Snell's law in vector form. The
 * normal is computed from finite differences of the sag; RATIO is n / n'. */
static void refract_by_vector_snell(const struct glint_surface *s,
                                    const struct line *l, long double t,
                                    long double ratio, long double way[3])
{
    const long double x = l->at[0] + t * l->way[0];
    const long double y = l->at[1] + t * l->way[1], h = 1e-5L;
    long double n[3] = {
        -(surface_sag(s, x + h, y) - surface_sag(s, x - h, y)) / (2 * h),
        -(surface_sag(s, x, y + h) - surface_sag(s, x, y - h)) / (2 * h), 1};
    const long double size = sqrtl(n[0] * n[0] + n[1] * n[1] + 1);
    long double c = 0, out;

    for (int k = 0; k < 3; k++) {
        n[k] /= size;
        c += n[k] * l->way[k];
    }
    out = sqrtl(1 - ratio * ratio * (1 - c * c));
    for (int k = 0; k < 3; k++)
        way[k] = ratio * l->way[k] + (out - ratio * c) * n[k];
}

static uint32_t seed = 7;

static double random_uniform(double low, double high)
{
    seed = seed * 1664525u + 1013904223u;
    return low + (high - low) * (seed >> 8) / 0x1p24;
}

/* Compares library rays that start within SPAN of the axis with rays of the
 * second method (vector Snell). Returns the number of rays that hit the
 * surface. */
static int compare_rays_near_axis(const char *surfaces, double span)
{
    const struct glint_surface *const s = lens.surface;
    int met = 0;

    load_lens_of_surfaces(surfaces);
    glint_path_init(&path, &lens, NULL, LINE_D_NM);
    for (int i = 0; i < 60; i++) {
        const double tilt = random_uniform(0, 0.5),
                     turn = random_uniform(-3.1, 3.1);
        const double direction[3] = {sin(tilt) * cos(turn),
                                     sin(tilt) * sin(turn), cos(tilt)};
        const double x = random_uniform(-span, span),
                     y = random_uniform(-span, span);
        const struct line start = {{x, y, 0},
                                   {direction[0], direction[1], direction[2]}};
        const struct line own = transform_to_surface_frame(s, &start);
        double hits[4][2];
        struct glint_ray ray;
        long double t = 0, way[3], at[2];
        const bool there =
            find_nearest_intersection(s, &own, 3 * s->semi_mm, &t);
        enum glint_ray_status status;

        /* NAN remains if the ray misses the shaped surface. */
        hits[1][0] = (double)NAN;
        status = glint_trace(&path, x, y, direction, &ray, hits);
        for (int k = 0; k < 2; k++)
            at[k] = own.at[k] + t * own.way[k];
        if (!there && hypot(hits[1][0], hits[1][1]) < s->semi_mm)
            fail_msg("%s: met at %g, %g", surfaces, hits[1][0], hits[1][1]);
        if (!there || hypotl(at[0], at[1]) > s->semi_mm)
            /* Outside the rim, the library extrapolates the profile. */
            continue;
        assert_true(isfinite(hits[1][0]));
        if (status != GLINT_RAY_OK)
            continue;
        for (int k = 0; k < 2; k++)
            if (!(fabsl(at[k] - hits[1][k]) < 1e-9L))
                fail_msg("%s: %.12g, not %.12Lg", surfaces, hits[1][k], at[k]);
        met++;
        if (s->shape.tilt_deg[0] != 0 || s->shape.tilt_deg[1] != 0 ||
            s[1].radius_mm != 0)
            /* The check below needs an untilted surface and then a plane. */
            continue;
        refract_by_vector_snell(s, &own, t, 1 / (long double)s->nd, way);
        for (int k = 0; k < 2; k++) {
            const long double z =
                gap_to_surface(s, &own, t) + surface_sag(s, at[0], at[1]);
            const long double at_flat = at[k] + s->shape.decentre_mm[k] +
                                        (s->thickness_mm - z) / way[2] * way[k];

            if (!(fabsl(at_flat - hits[2][k]) < 1e-8L))
                fail_msg("%s: behind, %.12g, not %.12Lg", surfaces, hits[2][k],
                         at_flat);
        }
    }
    return met;
}

TEST(intersections_match_a_second_method)
{
    static const struct {
        const char *surfaces;
        double span;
    } cases[] = {
        {"surface 20 9 9 1.5 60\nshape conic -1\nsurface flat 90 30 air", 9},
        {"surface 20 9 9 1.5 60\nshape conic -30\nsurface flat 90 30 air", 9},
        {"surface 20 9 9 1.5 60\nshape conic 2\nsurface flat 90 30 air", 9},
        {"surface 10 9 9.9 1.7 60\nshape conic -0.02\nsurface flat 90 30 air",
         9},
        {"surface 1.962 1.2 0.95 1.54 56\nshape conic -0.12 A4 9e-3 A6 -2e-2 "
         "A8 4e-2 A10 -3e-2\nsurface flat 30 30 air",
         0.9},
        /* The profile has an inflection: the sag rises, then falls outside the
         * rim. */
        {"surface 6 2 2 1.54 56\nshape A4 -8e-3 A6 -1e-3\n"
         "surface flat 30 30 air",
         2},
        {"surface flat 2 2 1.54 56\nshape A4 2e-2\nsurface -30 30 20 air", 2},
        {"surface 30 9 9 1.5 60\nshape cylinder y\nsurface -60 90 30 air", 9},
        {"surface 30 9 9 1.5 60\nshape cylinder x conic -1.5 A4 1e-5\n"
         "surface -60 90 30 air",
         9},
        {"surface 30 9 9 1.5 60\nshape toric y 50\nsurface flat 90 30 air", 9},
        {"surface 30 9 9 1.5 60\nshape toric x 50 A4 -2e-5\n"
         "surface flat 90 29 air",
         8},
        {"group decentre 0.5 -0.3\nsurface 30 9 9 1.5 60\nend\n"
         "surface flat 90 30 air",
         8},
        {"group decentre 0.2 0.1 tilt 4 -3\nsurface 30 9 9 1.5 60\n"
         "shape conic -1\nend\nsurface flat 90 30 air",
         8}};

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const int met =
            compare_rays_near_axis(cases[k].surfaces, cases[k].span);

        if (met < 20)
            fail_msg("%s: only %d rays met", cases[k].surfaces, met);
    }
}

/* ------------------------------------------------------------ known optics */

/* Checks that a hyperboloid with the conic constant -n^2 behind a plane images
 * without spherical aberration. */
TEST(hyperboloid_has_a_point_focus)
{
    const double direction[3] = {0, 0, 1};
    struct glint_ray ray;

    load_lens_of_surfaces(
        "surface flat 12 14 1.5 60\nsurface -25 50 14 air\nshape conic -2.25");
    glint_optics_of(&lens, &optics);
    assert_true(fabs(optics.back_focal_mm - 50) < 1e-9);
    glint_path_init(&path, &lens, NULL, LINE_D_NM);
    for (int k = 0; k <= 14; k++) {
        assert_int_equal(
            glint_trace(&path, 0.8 * k, 0.5 * k, direction, &ray, NULL),
            GLINT_RAY_OK);
        assert_true(hypot(ray.sensor_x_mm, ray.sensor_y_mm) < 1e-11);
    }
}

TEST(surface_without_shape_is_a_sphere)
{
    const double direction[3] = {0.1, 0.05, sqrt(1 - 0.0125)};
    struct glint_ray ray, same;

    load_lens_of_surfaces("surface 30 9 9 1.5 60\nsurface -60 90 30 air");
    glint_path_init(&path, &lens, NULL, 532);
    assert_int_equal(glint_trace(&path, 3, 2, direction, &ray, NULL), 0);
    load_lens_of_surfaces(
        "surface 30 9 9 1.5 60\nshape conic 0 A4 0\nsurface -60 90 30 air");
    assert_false(glint_surface_is_shaped(&lens.surface[0]));
    glint_path_init(&path, &lens, NULL, 532);
    assert_int_equal(glint_trace(&path, 3, 2, direction, &same, NULL), 0);
    assert_memory_equal(&ray, &same, sizeof ray);
    /* a conic that differs from the sphere only by the rounding of a
     * parameter */
    load_lens_of_surfaces(
        "surface 30 9 9 1.5 60\nshape conic 1e-15\nsurface -60 90 30 air");
    glint_path_init(&path, &lens, NULL, 532);
    assert_int_equal(glint_trace(&path, 3, 2, direction, &same, NULL), 0);
    assert_true(fabs(ray.sensor_x_mm - same.sensor_x_mm) < 1e-11);
    assert_true(fabs(ray.energy - same.energy) < 1e-12);
}

/* The surface lines of two lens elements; A, B, C and D are the shape lines of
 * the four surfaces. */
#define TWO_LENSES(a, b, c, d)                            \
    "surface 30 5 9 1.5 60\n" a "surface -60 4 9 air\n" b \
    "surface -40 3 9 1.6 40\n" c "surface 80 90 30 air\n" d

/* Checks that the ghosts of spheres are the same, up to rounding, if the
 * spheres are written as conics or as torics with two equal radii. */
TEST(spheres_as_conics_or_torics_give_the_same_ghosts)
{
    static const char *const written[] = {
        TWO_LENSES("", "", "", ""),
        TWO_LENSES("shape conic 1e-15\n", "shape conic 1e-15\n",
                   "shape conic 1e-15\n", "shape conic 1e-15\n"),
        TWO_LENSES("shape toric x 30\n", "shape toric y -60\n",
                   "shape toric y -40\n", "shape toric x 80\n")};
    const double direction[3] = {0.1, 0.05, sqrt(1 - 0.0125)};
    struct glint_ghost ghost[GLINT_MAX_GHOSTS];
    struct glint_ray want[GLINT_MAX_GHOSTS], got;
    int n = 0;

    for (int w = 0; w < 3; w++) {
        load_lens_of_surfaces(written[w]);
        n = glint_ghost_list(&lens, ghost, GLINT_MAX_GHOSTS);
        assert_int_equal(n, 6);
        for (int k = 0; k < n; k++) {
            glint_path_init(&path, &lens, &ghost[k], 532);
            assert_int_equal(
                glint_trace(&path, 1, 2, direction, w ? &got : &want[k], NULL),
                GLINT_RAY_OK);
            if (!w)
                continue;
            assert_true(fabs(got.sensor_x_mm - want[k].sensor_x_mm) < 1e-9);
            assert_true(fabs(got.sensor_y_mm - want[k].sensor_y_mm) < 1e-9);
            assert_true(fabs(got.energy - want[k].energy) <
                        1e-9 * want[k].energy);
        }
    }
}

/* Checks an anamorphic attachment of two cylinders in front of a lens: its
 * focal lengths equal those of paraxial rays in each of the two planes of
 * symmetry. */
TEST(anamorphic_lens_has_two_focal_lengths)
{
    load_lens_of_surfaces(
        "surface -80 3 20 1.6 50\nshape cylinder x\nsurface flat 55 20 air\n"
        "surface 120 4 20 1.6 50\nshape cylinder x\nsurface flat 5 20 air\n"
        "surface 50 8 20 1.6 50\nsurface -50 60 20 air");
    assert_false(glint_prescription_is_round(&lens));
    glint_optics_of(&lens, &optics);
    glint_path_init(&path, &lens, NULL, LINE_D_NM);
    for (int plane = 0; plane < 2; plane++) {
        const double axis[3] = {0, 0, 1}, h = 1e-3;
        const double widened = plane ? 1 : optics.squeeze;
        const double focal = optics.focal_mm / widened;
        double hits[8][2], end;
        struct glint_ray ray;

        assert_int_equal(
            glint_trace(&path, plane ? 0 : h, plane ? h : 0, axis, &ray, hits),
            0);
        end = plane ? ray.sensor_y_mm : ray.sensor_x_mm / widened;
        assert_true(fabs((hits[6][plane] - end) / 60 * focal / h - 1) < 1e-6);
    }
    assert_true(fabs(optics.squeeze - 1) > 0.2);
}

/* Checks that glint_path_init_at() rotates the lens: light in the rotated
 * plane, at azimuth PHI, gives the same ray as the rotated light through the
 * unrotated lens. */
TEST(rotated_lens_equals_rotated_light)
{
    const double phi = 33, c = cos(phi * GLINT_PI / 180),
                 s = sin(phi * GLINT_PI / 180);
    const double turned[3] = {0.2, 0, sqrt(0.96)};
    const double plain[3] = {0.2 * c, 0.2 * s, sqrt(0.96)};
    struct glint_ray a, b;

    load_lens_of_surfaces(
        "surface -80 3 20 1.6 50\nshape cylinder x\nsurface flat 25 20 air\n"
        "group decentre 1 2 tilt 3 -2\n"
        "surface 50 9 20 1.6 50\nshape conic -1\nsurface -50 60 20 air\nend");
    glint_path_init_at(&path, &lens, NULL, 532, phi);
    assert_int_equal(glint_trace(&path, 3, 1, turned, &a, NULL), 0);
    glint_path_init(&path, &lens, NULL, 532);
    assert_int_equal(glint_trace(&path, 3 * c - s, 3 * s + c, plain, &b, NULL),
                     0);
    assert_true(fabs(a.sensor_x_mm * c - a.sensor_y_mm * s - b.sensor_x_mm) <
                1e-11);
    assert_true(fabs(a.sensor_x_mm * s + a.sensor_y_mm * c - b.sensor_y_mm) <
                1e-11);
    assert_true(fabs(a.stop_x_mm * c - a.stop_y_mm * s - b.stop_x_mm) < 1e-11);
}

/* ------------------------------------------------------------- shape lines */

TEST(rejects_wrong_shape_lines)
{
    static const char *const rows[][2] = {
        {"shape conic 1",
         "t.lens:5:1: a shape must follow the line of its surface"},
        {"surface 20 9 9 1.5 60\nshape", "t.lens:6:6: shape is missing"},
        {"surface 20 9 9 1.5 60\nshape A5 1",
         "t.lens:6:7: 'A5' is unknown; expected conic, A4, A6 .. A20, cylinder "
         "or toric"},
        {"surface 20 9 9 1.5 60\nshape conic -1\nshape conic -2",
         "t.lens:7:7: 'conic' occurs twice for this surface"},
        {"surface 20 9 9 1.5 60\nshape A4", "t.lens:6:9: aspheric term is "
                                            "missing"},
        {"surface 20 9 9 1.5 60\nshape A4 1e-2\nsurface flat 9 9 air\n",
         "t.lens:5:14: the aspheric terms add 65.61 mm of sag at the rim, "
         "which is too much"},
        {"surface 20 9 9 1.5 60\nshape conic 9\nsurface flat 9 9 air\n",
         "t.lens:5:14: semi-diameter 9 must be less than 6.32456, where the "
         "conic ends"},
        {"surface 20 9 9 1.5 60\nshape toric y 8\nsurface flat 9 9 air\n",
         "t.lens:5:14: semi-diameter 9 must be less than the radius 8 of the "
         "other section"},
        {"surface 20 9 9 1.5 60\nshape cylinder z",
         "t.lens:6:16: the axis of a cylinder or toric must be x or y"},
        {"surface 20 9 9 1.5 60\nshape cylinder x toric x 9",
         "t.lens:6:18: 'toric' occurs twice for this surface"},
        {"group", "t.lens:5:6: decentre or tilt is missing"},
        {"group tilt 50 0", "t.lens:5:12: tilt must be -45 .. 45, not 50"},
        {"group tilt 5 0\ngroup tilt 5 0",
         "t.lens:6:1: the group above has no line 'end'"},
        {"end", "t.lens:5:1: 'end' without a line 'group' above"},
        {"group tilt 1 0\nsurface 20 9 9 1.5 60\nsurface flat 9 9 air",
         "t.lens:5:1: the group has no line 'end'"}};

    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct glint_error error = {""};

        if (parse_lens_of_surfaces(rows[k][0], &error) == GLINT_OK ||
            strncmp(error.text, rows[k][1], strlen(rows[k][1])) != 0)
            fail_msg("%s: got '%s', not '%s'", rows[k][0], error.text,
                     rows[k][1]);
    }
}

/* Checks that glint_surface_point() at the position where a ray hits a surface
 * returns a point of the ray. */
TEST(points_lie_on_rays)
{
    static const char *const shapes[] = {
        "surface 30 9 9 1.5 60\nshape conic -2 A4 1e-5\nsurface flat 90 30 air",
        "group decentre 1 -2 tilt 7 -11\nsurface 30 9 9 1.5 60\n"
        "shape toric y 50 A4 1e-5\nsurface flat 90 30 air\nend",
        "group tilt 20 0\nsurface 40 9 9 1.5 60\nsurface flat 90 30 air\nend"};
    const double direction[3] = {0.1, 0, sqrt(1 - 0.01)};
    double hits[GLINT_MAX_EVENTS + 1][2], at[3];
    struct glint_ray ray;

    for (int i = 0; i < 3; i++)
        for (int phi = 0; phi < 360; phi += 40) {
            double t;

            load_lens_of_surfaces(shapes[i]);
            glint_path_init_at(&path, &lens, NULL, LINE_D_NM, phi);
            assert_int_equal(glint_trace(&path, 1.5, -2, direction, &ray, hits),
                             0);
            assert_true(glint_surface_point(&lens.surface[0], phi, hits[1][0],
                                            hits[1][1], at));
            t = at[2] / direction[2];
            assert_true(fabs(1.5 + t * direction[0] - at[0]) < 1e-9);
            assert_true(fabs(-2 - at[1]) < 1e-9);
        }
    /* The tilted sphere is a sphere with a rotated centre. */
    load_lens_of_surfaces(
        "group tilt 20 0\nsurface 40 9 9 1.5 60\nsurface flat 90 30 air\n"
        "end");
    for (int x = -8; x <= 8; x += 4) {
        const double turn = 20 * 3.14159265358979323846 / 180;

        assert_true(glint_surface_point(&lens.surface[0], 0, x, 3, at));
        assert_true(fabs(hypot(hypot(at[0], at[1] + 40 * sin(turn)),
                               at[2] - 40 * cos(turn)) -
                         40) < 1e-9);
    }
}

/* Checks a stop that lies behind the front vertex but around the glass, where
 * light has not been refracted yet. Rays must be the same as with a stop in the
 * same plane and no glass. */
TEST(stop_around_the_glass_gives_the_same_rays)
{
    static const char text[] = "name t\nf-number 4\nfilm 9 9\nstop %s\n"
                               "surface 10 3 7 1.5 60\nshape A4 1e-5\n"
                               "surface -30 12 7 air\n";
    const double way[3] = {0.3, 0, sqrt(1 - 0.09)};
    struct glint_error error = {""};
    struct glint_ray ray;
    char table[300];

    snprintf(table, sizeof table, text, "-0.4 3");
    parse_lens_text(&lens, table);
    glint_optics_of(&lens, &optics);
    assert_true(fabs(optics.entrance_z_mm - 0.4) < 1e-12);
    glint_path_init(&path, &lens, NULL, LINE_D_NM);
    assert_int_equal(glint_trace(&path, 1, 2, way, &ray, NULL), 0);
    assert_true(fabs(ray.stop_x_mm - (1 + 0.4 * 0.3 / way[2])) < 1e-14);
    assert_true(ray.stop_y_mm == 2);
    /* at 3 mm from the axis the surface is 0.46 mm behind its vertex */
    snprintf(table, sizeof table, text, "-0.5 3");
    assert_int_equal(
        glint_prescription_parse(&lens, table, strlen(table), "t.lens", &error),
        GLINT_E_LENS);
    assert_non_null(
        strstr(error.text, "t.lens:4:6: element overlaps the next"));
    snprintf(table, sizeof table, text, "-101 3");
    assert_int_equal(
        glint_prescription_parse(&lens, table, strlen(table), "t.lens", &error),
        GLINT_E_LENS);
    assert_non_null(strstr(error.text, "thickness must be -100 .. 100000"));
}

/* Checks that rays traced in a batch and rays traced one by one hit the same
 * points, bit-identical for every batch size. */
TEST(batches_equal_single_rays)
{
    struct glint_launch from[19];
    struct glint_ray many[19], one;
    enum glint_ray_status status[19];
    int traced = 0;

    load_lens_of_surfaces(
        "surface 20 6 9 1.5 60\nshape conic -2 A4 2e-5 A8 -3e-9\n"
        "surface -30 3 9 air\nsurface -25 2 9 1.6 40\nshape cylinder x\n"
        "surface flat 30 9 air\n");
    glint_path_init_at(&path, &lens, NULL, 532, 25);
    for (int k = 0; k < 19; k++)
        from[k] =
            (struct glint_launch){k - 9, 0.4 * k - 3, {0.05 * k - 0.3, 0, 0}};
    for (int k = 0; k < 19; k++)
        from[k].direction[2] =
            sqrt(1 - from[k].direction[0] * from[k].direction[0]);
    glint_trace_many(&path, 19, from, many, status, NULL);
    for (int k = 0; k < 19; k++) {
        assert_int_equal(glint_trace(&path, from[k].x_mm, from[k].y_mm,
                                     from[k].direction, &one, NULL),
                         status[k]);
        if (status[k] != GLINT_RAY_OK)
            continue;
        assert_memory_equal(&one, &many[k], sizeof one);
        traced++;
    }
    assert_true(traced > 10);
}

/* Checks rays for which the first root found need not be the nearest: rays as
 * steep as the surface profile, and rays outside the glass. Rays in batches
 * must agree with single rays. */
TEST(steep_rays_hit_the_nearest_intersection)
{
    static const char *const shapes[] = {
        "surface 10 9 9 1.5 60\nshape conic 0.2\nsurface flat 90 30 air",
        "surface 12 9 9 1.5 60\nshape A4 -4e-4 A6 4e-6\n"
        "surface flat 90 30 air",
        "surface 300 9 9 1.5 60\nshape A4 2e-3 A6 -2.5e-5\n"
        "surface flat 90 30 air",
    };
    int met = 0;

    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        load_lens_of_surfaces(shapes[i]);
        glint_path_init(&path, &lens, NULL, LINE_D_NM);
        for (int k = 0; k < 4000; k++) {
            const struct glint_form *const form = &path.form[0];
            const double tilt = random_uniform(0, 1.5),
                         turn = random_uniform(-3.1, 3.1);
            const double way[3] = {sin(tilt) * cos(turn), sin(tilt) * sin(turn),
                                   cos(tilt)};
            double at[3] = {random_uniform(-20, 20), random_uniform(-20, 20),
                            0};
            double normal[3], cosine;
            struct beam b = {.x = {at[0]},
                             .y = {at[1]},
                             .l = {way[0]},
                             .m = {way[1]},
                             .n = {way[2]}};

            glint_beam_move_to_form(&b, 1, form);
            if (!glint_form_intersect_ray(form, at, way, normal, &cosine)) {
                assert_true(b.status[0] > GLINT_RAY_OK);
                continue;
            }
            assert_true(b.status[0] == GLINT_RAY_OK);
            if (!(hypot(b.x[0] - at[0], b.y[0] - at[1]) < 1e-9))
                fail_msg("%s: (%g, %g), not (%g, %g)", shapes[i], b.x[0],
                         b.y[0], at[0], at[1]);
            met++;
        }
    }
    assert_true(met > 2000);
}
