/* SPDX-License-Identifier: MIT
 *
 * Draws the cross section of a lens. Coordinates are mm: z along the axis from
 * the front vertex, x up in the plane of the section.
 */
#include "lens_pages/drawing.h"

#include <math.h>

#include "glint/glint.h"

/* Parallel rays through the lens or along a ghost's path, and their pupil, the
 * area of the front vertex plane where the rays start */
struct fan {
    struct glint_path path;
    struct glint_pupil pupil;
    double direction[3];
    double stop_radius_mm;
};

/* Rays start in rings around the centre of the pupil; each ring has six more
 * rays than the next inner one. */
enum {
    SPOT_COLOURS = 3,
    SPOT_RINGS = 16,
    SPOT_RAYS = 1 + 3 * SPOT_RINGS * (SPOT_RINGS + 1)
};

struct spots {
    int n;
    double at[SPOT_COLOURS * SPOT_RAYS]
             [2]; /* ray positions on the sensor, mm */
    int colour[SPOT_COLOURS * SPOT_RAYS];
    double middle[2]; /* centroid of the rays, mm */
    double rms_mm;    /* RMS distance of the rays from the centroid, mm */
    double radius_mm; /* max distance of a ray from the centroid, mm */
};

enum { DRAWING_FIELDS = 3 };

#define FIGURE_MARGIN_PX 24.0

#define FIGURE_NM 587.5618 /* wavelength of rays: the d line */

struct figure {
    const struct lens_drawing *drawing;
    FILE *file;
    double z0, z1, x1;   /* extent of the section: z0 .. z1, -x1 .. x1, mm */
    double scale;        /* pixels per millimetre */
    double left, middle; /* position of z = 0 and of x = 0, pixels */
    double height_px;
    double vertex[GLINT_MAX_SURFACES], stop_z, sensor_z;
    /* half the image size in the section's plane, as displayed, mm */
    double film_mm;
    double widen; /* displayed width / width on the sensor */
    int shown;
};

/* Initialises FAN for light at THETA_DEG in the plane at azimuth PHI_DEG about
 * the axis. The azimuth plane becomes the x-z plane of the rays. GHOST is NULL
 * for the direct path. Returns false if no light passes. */
static bool init_ray_fan(struct fan *fan, const struct glint_prescription *lens,
                         const struct glint_ghost *ghost, double nm,
                         double phi_deg, double theta_deg)
{
    const double theta = theta_deg * GLINT_PI / 180;
    struct glint_optics optics;

    glint_optics_of(lens, &optics);
    glint_path_init_at(&fan->path, lens, ghost, nm, phi_deg);
    fan->path.places_only = true;
    fan->direction[0] = sin(theta);
    fan->direction[1] = 0;
    fan->direction[2] = cos(theta);
    fan->stop_radius_mm = optics.stop_radius_mm;
    return glint_pupil_find(&fan->pupil, &fan->path, theta_deg,
                            optics.stop_radius_mm, NULL);
}

/* Returns the x, mm, in the front vertex plane at which ray (U, 0) starts. */
static double compute_ray_start_mm(const struct fan *fan, double u)
{
    const struct glint_pupil *p = &fan->pupil;

    return 0.5 * (p->x0_mm + p->x1_mm) + 0.5 * u * (p->x1_mm - p->x0_mm);
}

/* Traces the ray that starts at (U, V) of the pupil, -1 .. 1 each. Stores in
 * HITS the points at which it hits surfaces, as glint_trace() does. Returns
 * whether the ray passes. */
static bool trace_fan_ray(const struct fan *fan, double u, double v,
                          struct glint_ray *ray, double (*hits)[2])
{
    return glint_trace(&fan->path, compute_ray_start_mm(fan, u),
                       v * fan->pupil.y1_mm, fan->direction, ray,
                       hits) == GLINT_RAY_OK &&
           ray->rel_radius <= 1 &&
           hypot(ray->stop_x_mm, ray->stop_y_mm) <=
               fan->stop_radius_mm * (1 + 1e-9);
}

/* Sets U[0] and U[1] to the min and max U of rays (U, 0) that pass. Returns
 * false if no ray passes. */
static bool find_fan_edges(const struct fan *fan, double u[2])
{
    enum { STEPS = 100, HALVINGS = 12 };
    double hits[GLINT_MAX_EVENTS + 1][2];
    struct glint_ray ray;
    bool any = false;

    for (int i = -STEPS; i <= STEPS; i++) {
        const double at = (double)i / STEPS;

        if (!trace_fan_ray(fan, at, 0, &ray, hits))
            continue;
        if (!any)
            u[0] = at;
        u[1] = at;
        any = true;
    }
    for (int side = 0; any && side < 2; side++) {
        double out = (side ? 1.0 : -1.0) / STEPS;

        for (int i = 0; i < HALVINGS; i++) {
            out *= 0.5;
            if (trace_fan_ray(fan, u[side] + out, 0, &ray, hits))
                u[side] += out;
        }
    }
    return any;
}

static const double spot_nm[SPOT_COLOURS] = {450, 546, 650};

/* Traces the rays of one ring and adds to S the rays that reach the sensor. The
 * pupil's bounding box is the square -1 .. 1 in U and V; the outermost ring
 * passes through the corners of this square. */
static void gather_ring_rays(struct spots *s, const struct fan *fan, int colour,
                             int ring)
{
    const int n = ring == 0 ? 1 : 6 * ring;
    const double radius = sqrt(2) * ring / SPOT_RINGS;
    double hits[GLINT_MAX_EVENTS + 1][2];
    struct glint_ray ray;

    for (int i = 0; i < n; i++) {
        const double turn = 2 * GLINT_PI * i / n;
        const double u = radius * cos(turn), v = radius * sin(turn);

        if (fabs(u) > 1 || fabs(v) > 1 || !trace_fan_ray(fan, u, v, &ray, hits))
            continue;
        s->colour[s->n] = colour;
        s->at[s->n][0] = ray.sensor_x_mm;
        s->at[s->n++][1] = ray.sensor_y_mm;
    }
}

static void measure_spot_extent(struct spots *s)
{
    double sum[2] = {0, 0}, square = 0;

    for (int i = 0; i < s->n; i++)
        for (int k = 0; k < 2; k++)
            sum[k] += s->at[i][k];
    for (int k = 0; k < 2; k++)
        s->middle[k] = s->n ? sum[k] / s->n : 0;
    s->radius_mm = 0;
    for (int i = 0; i < s->n; i++) {
        const double r =
            hypot(s->at[i][0] - s->middle[0], s->at[i][1] - s->middle[1]);

        square += r * r;
        s->radius_mm = fmax(s->radius_mm, r);
    }
    s->rms_mm = s->n ? sqrt(square / s->n) : 0;
}

/* Fills S with rays through LENS, evenly distributed over its pupil, for light
 * at THETA_DEG in the plane at azimuth PHI_DEG. */
static void gather_field_spots(struct spots *s,
                               const struct glint_prescription *lens,
                               double phi_deg, double theta_deg)
{
    struct fan fan;

    s->n = 0;
    for (int c = 0; c < SPOT_COLOURS; c++)
        if (init_ray_fan(&fan, lens, NULL, spot_nm[c], phi_deg, theta_deg))
            for (int ring = 0; ring <= SPOT_RINGS; ring++)
                gather_ring_rays(s, &fan, c, ring);
    measure_spot_extent(s);
}

/* image height of the outermost field point, as a fraction of half the film;
 * below 1, so that all rays stay inside the film */
#define FIELD_ENDS 0.995

static const char *const field_colour[DRAWING_FIELDS] = {"#1f5fa8", "#2f8a3c",
                                                         "#c0392b"};

static double convert_z_to_px(const struct figure *f, double z)
{
    return f->left + f->scale * z;
}

static double convert_height_to_px(const struct figure *f, double x)
{
    return f->middle - f->scale * x;
}

/* Returns 1, 2 or 5 times a power of ten, at least VALUE. */
static double round_up_to_1_2_5(double value)
{
    const double power = pow(10, floor(log10(fmax(value, 1e-9))));
    const double share = value / power;

    return power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
}

/* Returns the distance from the image centre, mm, at which the lens images
 * light at THETA_DEG, or a negative value if no light arrives. */
static double compute_image_height_mm(const struct figure *f, double theta_deg)
{
    double hits[GLINT_MAX_EVENTS + 1][2];
    struct fan fan;
    struct glint_ray ray;

    if (!init_ray_fan(&fan, f->drawing->lens, NULL, FIGURE_NM,
                      f->drawing->plane_deg, theta_deg) ||
        !trace_fan_ray(&fan, 0, 0, &ray, hits))
        return -1;
    return fabs(ray.sensor_x_mm);
}

/* Returns the angle, degrees, of light that the lens images at a distance of
 * HEIGHT_MM from the image centre. Only the ray through the centre of the pupil
 * is traced. If no light arrives there, returns the largest angle that
 * passes. */
static double find_angle_of_image_height(const struct figure *f,
                                         double height_mm)
{
    double low = 0, high = 89;

    for (int i = 0; i < 18; i++) {
        const double middle = 0.5 * (low + high);
        const double found = compute_image_height_mm(f, middle);

        if (found >= 0 && found < height_mm)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Returns the angle of FIELD, 0 .. DRAWING_FIELDS - 1, in degrees. */
static double get_field_angle_deg(const struct figure *f, int field)
{
    static const double share[DRAWING_FIELDS] = {0, 0.7, 1};

    return find_angle_of_image_height(f,
                                      FIELD_ENDS * share[field] * f->film_mm);
}

enum { PROFILE = 24 };
#define WIDTH_PX  960.0
#define TITLE_PX  52.0
#define HEIGHT_PX 400.0 /* max height of the section */

/* --------------------------------------------------------------- positions */

/* Sets AT to the x, y and z of surface K at height X in the plane of the
 * section. */
static void find_section_point(const struct figure *f, int k, double x,
                               double at[3])
{
    const double phi = f->drawing->plane_deg;
    const double angle = phi * GLINT_PI / 180;

    if (!glint_surface_point(&f->drawing->lens->surface[k], phi, x * cos(angle),
                             x * sin(angle), at)) {
        at[0] = x;
        at[1] = at[2] = 0;
    }
    at[2] += f->vertex[k];
}

/* Sets AT to the z and x of HIT, the point where a ray meets EVENT, a surface
 * or the stop. HIT has the format of glint_trace(). */
static void find_surface_hit(const struct figure *f,
                             const struct glint_event *event,
                             const double hit[2], double at[2])
{
    const struct glint_prescription *lens = f->drawing->lens;
    double point[3] = {hit[0], hit[1], 0};

    if (event->kind == GLINT_STOP)
        at[0] = f->stop_z;
    else {
        /* glint_surface_point() expects a point in the frame of the surface.
         * Hits of aspheric surfaces are in this frame; those of other surfaces
         * are in the plane of the section. */
        if (!glint_surface_point(&lens->surface[event->surface],
                                 event->shaped ? f->drawing->plane_deg : 0,
                                 hit[0], hit[1], point))
            point[2] = 0;
        at[0] = f->vertex[event->surface] + point[2];
    }
    at[1] = point[0];
}

static void place_surface_vertices(struct figure *f)
{
    const struct glint_prescription *lens = f->drawing->lens;
    double z = lens->stop_after == 0 ? -lens->stop_thickness_mm : 0;

    for (int k = 0; k <= lens->n_surfaces; k++) {
        if (k == lens->stop_after) {
            f->stop_z = z;
            z += lens->stop_thickness_mm;
        }
        if (k == lens->n_surfaces)
            break;
        f->vertex[k] = z;
        z += lens->surface[k].thickness_mm;
    }
    f->sensor_z = z;
}

/* Sets half the image size in the plane of the section: half the diagonal for a
 * rotationally symmetric lens, else half the width or height. */
static void set_section_image_extent(struct figure *f)
{
    const struct glint_prescription *lens = f->drawing->lens;
    const bool along_x = f->drawing->plane_deg == 0;
    struct glint_optics optics;

    glint_optics_of(lens, &optics);
    f->widen = along_x ? optics.squeeze : 1;
    f->film_mm =
        glint_prescription_is_round(lens)
            ? 0.5 * hypot(lens->film_width_mm, lens->film_height_mm)
            : 0.5 * (along_x ? lens->film_width_mm : lens->film_height_mm);
}

/* Sets position and scale of F, whose drawing and file are already set. */
static void begin_lens_figure(struct figure *f)
{
    const struct glint_prescription *lens = f->drawing->lens;
    const double width = WIDTH_PX - 2 * FIGURE_MARGIN_PX;
    double length, least, at[3];

    place_surface_vertices(f);
    set_section_image_extent(f);
    least = fmin(0, f->stop_z);
    f->x1 = fmax(f->film_mm / f->widen, lens->stop_semi_mm);
    for (int k = 0; k < lens->n_surfaces; k++)
        for (int side = -1; side <= 1; side += 2) {
            find_section_point(f, k, side * lens->surface[k].semi_mm, at);
            f->x1 = fmax(f->x1, fabs(at[0]));
            least = fmin(least, at[2]);
        }
    length = f->sensor_z - least;
    f->x1 *= 1.12;
    f->z0 = least - 0.16 * length;
    f->z1 = f->sensor_z + 0.02 * length;
    f->scale = fmin(width / (f->z1 - f->z0), HEIGHT_PX / (2 * f->x1));
    /* The width that remains becomes space in front of the lens. */
    f->z0 = fmax(f->z1 - width / f->scale, least - 0.6 * length);
    f->height_px = 2 * f->x1 * f->scale;
    f->left = 0.5 * (WIDTH_PX - f->scale * (f->z1 - f->z0)) - f->scale * f->z0;
    f->middle = TITLE_PX + 0.5 * f->height_px;
}

/* ---------------------------------------------------------------- the lens */

/* Writes the points of surface K from its lower to its upper rim, or in the
 * opposite order if SENSE is -1. */
static void write_surface_profile(const struct figure *f, int k, int sense)
{
    const double semi = f->drawing->lens->surface[k].semi_mm;
    double at[3];

    for (int i = -PROFILE; i <= PROFILE; i++) {
        find_section_point(f, k, sense * semi * i / PROFILE, at);
        fprintf(f->file, "%.2f,%.2f ", convert_z_to_px(f, at[2]),
                convert_height_to_px(f, at[0]));
    }
}

/* Writes the edge of the glass between surfaces K and K + 1 at its upper rim
 * (SIDE 1) or lower rim (SIDE -1). The edge runs outwards to the wider of the
 * two rims, then parallel to the axis. */
static void write_glass_edge(const struct figure *f, int k, int side)
{
    const struct glint_surface *s = &f->drawing->lens->surface[k];
    double a[3], b[3], out;

    find_section_point(f, k, side * s[0].semi_mm, a);
    find_section_point(f, k + 1, side * s[1].semi_mm, b);
    out = side * fmax(side * a[0], side * b[0]);
    if (side > 0)
        fprintf(f->file, "%.2f,%.2f %.2f,%.2f ", convert_z_to_px(f, a[2]),
                convert_height_to_px(f, out), convert_z_to_px(f, b[2]),
                convert_height_to_px(f, out));
    else
        fprintf(f->file, "%.2f,%.2f %.2f,%.2f", convert_z_to_px(f, b[2]),
                convert_height_to_px(f, out), convert_z_to_px(f, a[2]),
                convert_height_to_px(f, out));
}

/* Draws the glass behind surface K, darker for a higher index. */
static void draw_glass_element(const struct figure *f, int k)
{
    const struct glint_surface *s = &f->drawing->lens->surface[k];
    const double shade = fmin(1, fmax(0, (s->nd - 1.4) / 0.6));

    fprintf(f->file,
            "<polygon fill=\"#%02x%02x%02x\" stroke=\"#26323f\" "
            "stroke-width=\"0.9\" stroke-linejoin=\"round\" points=\"",
            (unsigned)(232 - 62 * shade), (unsigned)(241 - 46 * shade),
            (unsigned)(250 - 26 * shade));
    write_surface_profile(f, k, 1);
    write_glass_edge(f, k, 1);
    write_surface_profile(f, k + 1, -1);
    write_glass_edge(f, k, -1);
    fprintf(f->file,
            "\"><title>surface %d; nd %.5g, Vd %.4g</title></polygon>\n", k,
            s->nd, s->vd);
}

static void draw_lens_barrel(const struct figure *f, int first, int last)
{
    const struct glint_prescription *lens = f->drawing->lens;
    const double wall = 3.5;
    double semi[2] = {0, 0}, a = 1e30, b = -1e30, at[3];

    for (int k = first; k <= last; k++)
        for (int side = 0; side < 2; side++) {
            find_section_point(f, k, (side ? 1 : -1) * lens->surface[k].semi_mm,
                               at);
            semi[side] = fmax(semi[side], fabs(at[0]));
            a = fmin(a, fmin(f->vertex[k], at[2]));
            b = fmax(b, fmax(f->vertex[k], at[2]));
        }
    for (int side = 0; side < 2; side++)
        fprintf(f->file,
                "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.1f\" "
                "fill=\"url(#hatch-%s)\" stroke=\"#777\" "
                "stroke-width=\"0.5\"/>\n",
                convert_z_to_px(f, a),
                side ? convert_height_to_px(f, semi[1]) - wall
                     : convert_height_to_px(f, -semi[0]),
                f->scale * (b - a), wall, lens->name);
}

static void draw_all_glass_elements(const struct figure *f)
{
    const struct glint_prescription *lens = f->drawing->lens;
    int first = -1;

    for (int k = 0; k < lens->n_surfaces; k++) {
        if (lens->surface[k].vd > 0) {
            first = first < 0 ? k : first;
            draw_glass_element(f, k);
        } else if (first >= 0) {
            draw_lens_barrel(f, first, k);
            first = -1;
        }
    }
}

static void draw_aperture_stop(const struct figure *f, double radius)
{
    const double end =
        fmax(f->drawing->lens->stop_semi_mm * 1.18, radius + 9 / f->scale);

    for (int side = -1; side <= 1; side += 2)
        fprintf(f->file,
                "<path d=\"M%.2f %.2f V%.2f M%.2f %.2f h6\" stroke=\"#111\" "
                "stroke-width=\"2.2\" fill=\"none\"/>\n",
                convert_z_to_px(f, f->stop_z),
                convert_height_to_px(f, side * radius),
                convert_height_to_px(f, side * end),
                convert_z_to_px(f, f->stop_z) - 3,
                convert_height_to_px(f, side * radius));
}

static void draw_surface_number(const struct figure *f, int k)
{
    double at[3];

    find_section_point(f, k, f->drawing->lens->surface[k].semi_mm, at);
    fprintf(f->file,
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" "
            "fill=\"#a2640c\">%d</text>\n",
            convert_z_to_px(f, at[2]), convert_height_to_px(f, at[0]) - 7, k);
}

static void draw_axis_and_sensor(const struct figure *f)
{
    const double film = f->film_mm / f->widen;

    fprintf(f->file,
            "<path d=\"M%.2f %.2f H%.2f\" stroke=\"#888\" stroke-width=\"0.6\" "
            "stroke-dasharray=\"12 3 2 3\"/>\n"
            "<path d=\"M%.2f %.2f V%.2f\" stroke=\"#111\" "
            "stroke-width=\"2\"/>\n",
            convert_z_to_px(f, f->z0), convert_height_to_px(f, 0),
            convert_z_to_px(f, f->z1), convert_z_to_px(f, f->sensor_z),
            convert_height_to_px(f, film), convert_height_to_px(f, -film));
}

enum { SPOT_PX = 170 };
#define BELOW_PX  40.0 /* distance from the section to the spot diagrams */
#define LEGEND_PX 48.0 /* space below the spot diagrams */

static const char *const spot_colour[SPOT_COLOURS] = {"#2a52d0", "#2f9a3c",
                                                      "#d0342a"};

/* Returns the height of the spot diagrams with legend and gap, pixels. */
static double compute_spot_diagrams_height_px(const struct figure *f)
{
    return f->drawing->spots ? BELOW_PX + SPOT_PX + LEGEND_PX : 0;
}

static double compute_spot_diagrams_top_px(const struct figure *f)
{
    return f->middle + 0.5 * f->height_px + BELOW_PX;
}

static double get_length_unit_factor(double mm)
{
    return mm < 1 ? 1e3 : 1;
}

static const char *get_length_unit_name(double mm)
{
    return mm < 1 ? "µm" : "mm";
}

static void draw_spot_diagram_box(const struct figure *f, double x, double y)
{
    fprintf(f->file,
            "<rect x=\"%.1f\" y=\"%.1f\" width=\"%d\" height=\"%d\" "
            "fill=\"#fff\" stroke=\"#888\" stroke-width=\"0.7\"/>\n"
            "<path d=\"M%.1f %.1f h%d M%.1f %.1f v%d\" stroke=\"#ddd\" "
            "stroke-width=\"0.6\"/>\n",
            x, y, SPOT_PX, SPOT_PX, x, y + 0.5 * SPOT_PX, SPOT_PX,
            x + 0.5 * SPOT_PX, y, SPOT_PX);
}

static void draw_spot_diagram(const struct figure *f, const struct spots *s,
                              int field, double theta)
{
    const double step = (WIDTH_PX - 2 * FIGURE_MARGIN_PX) / DRAWING_FIELDS;
    const double cx = FIGURE_MARGIN_PX + step * (field + 0.5);
    const double cy = compute_spot_diagrams_top_px(f) + 0.5 * SPOT_PX;
    const double half_mm = round_up_to_1_2_5(s->radius_mm);
    const double scale = 0.5 * SPOT_PX / half_mm;

    draw_spot_diagram_box(f, cx - 0.5 * SPOT_PX, cy - 0.5 * SPOT_PX);
    for (int c = 0; c < SPOT_COLOURS; c++) {
        fprintf(f->file, "<g fill=\"%s\">\n", spot_colour[c]);
        for (int k = 0; k < s->n; k++)
            if (s->colour[k] == c)
                fprintf(f->file, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\".8\"/>\n",
                        cx + scale * (s->at[k][1] - s->middle[1]),
                        cy - scale * (s->at[k][0] - s->middle[0]));
        fputs("</g>\n", f->file);
    }
    fprintf(f->file,
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" "
            "fill=\"%s\">%.1f°, RMS %.3g %s</text>\n"
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" "
            "fill=\"#444\">side %.4g %s</text>\n",
            cx, cy - 0.5 * SPOT_PX - 7, field_colour[field], theta,
            get_length_unit_factor(s->rms_mm) * s->rms_mm,
            get_length_unit_name(s->rms_mm), cx, cy + 0.5 * SPOT_PX + 15,
            get_length_unit_factor(half_mm) * 2 * half_mm,
            get_length_unit_name(half_mm));
}

/* Draws the legend of colours, bottom right below the spot diagrams. */
static void draw_colour_legend(const struct figure *f)
{
    const double y = compute_spot_diagrams_top_px(f) + SPOT_PX + 34;
    const double end = WIDTH_PX - FIGURE_MARGIN_PX;

    for (int c = 0; c < SPOT_COLOURS; c++) {
        const double x = end - 66 * (SPOT_COLOURS - c);

        fprintf(f->file,
                "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>"
                "<text x=\"%.1f\" y=\"%.1f\" fill=\"#444\">%.0f nm</text>\n",
                x, y - 4, spot_colour[c], x + 7, y, spot_nm[c]);
    }
}

/* Draws a spot diagram for each field below the section. */
static void draw_all_spot_diagrams(const struct figure *f)
{
    struct spots s;

    for (int i = 0; i < DRAWING_FIELDS; i++) {
        const double theta = get_field_angle_deg(f, i);

        gather_field_spots(&s, f->drawing->lens, f->drawing->plane_deg, theta);
        draw_spot_diagram(f, &s, i, theta);
    }
    draw_colour_legend(f);
}

void lens_drawing_set_defaults(struct lens_drawing *d,
                               const struct glint_prescription *lens)
{
    *d = (struct lens_drawing){
        .lens = lens, .ghost = -1, .angle_deg = -1, .rays = 7, .spots = true};
}

/* -------------------------------------------------------------------- rays */

/* Writes the path of a ray that starts at X mm in the front vertex plane. */
static void draw_ray_path(struct figure *f, const struct fan *fan, double x,
                          const struct glint_ray *ray, double (*hits)[2],
                          const char *colour)
{
    const double slope = fan->direction[0] / fan->direction[2];
    double back = f->z0;

    if (fabs(slope * back) > 4 * f->x1)
        back = -4 * f->x1 / fabs(slope);
    fprintf(f->file,
            "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.7\" "
            "stroke-linejoin=\"round\" d=\"M%.2f %.2f ",
            colour, convert_z_to_px(f, back),
            convert_height_to_px(f, x + slope * back));
    for (int e = 0; e < fan->path.n_events; e++) {
        const bool stop = fan->path.event[e].kind == GLINT_STOP;
        double at[2];

        /* The stop lies behind the front vertex but in front of the rim of the
         * glass. Only the extended ray crosses the stop, so no point is
         * drawn. */
        if (stop && f->drawing->lens->stop_after == 0 &&
            f->drawing->lens->stop_thickness_mm < 0)
            continue;
        find_surface_hit(f, &fan->path.event[e], hits[e], at);
        fprintf(f->file, "L%.2f %.2f ", convert_z_to_px(f, at[0]),
                convert_height_to_px(f, at[1]));
    }
    fprintf(f->file, "L%.2f %.2f\"/>\n", convert_z_to_px(f, f->sensor_z),
            convert_height_to_px(f, ray->sensor_x_mm / f->widen));
    f->shown++;
}

static void draw_ray_fan(struct figure *f, const struct fan *fan,
                         const char *colour)
{
    const int n = f->drawing->rays;
    double hits[GLINT_MAX_EVENTS + 1][2], edge[2];
    struct glint_ray ray;

    if (!find_fan_edges(fan, edge))
        return;
    for (int i = 0; i < n; i++) {
        const double share = n > 1 ? (double)i / (n - 1) : 0.5;
        const double u = edge[0] + share * (edge[1] - edge[0]);

        if (trace_fan_ray(fan, u, 0, &ray, hits))
            draw_ray_path(f, fan, compute_ray_start_mm(fan, u), &ray, hits,
                          colour);
    }
}

static void draw_field_rays(struct figure *f)
{
    struct fan fan;

    for (int i = DRAWING_FIELDS - 1; i >= 0; i--)
        if (init_ray_fan(&fan, f->drawing->lens, NULL, FIGURE_NM,
                         f->drawing->plane_deg, get_field_angle_deg(f, i)))
            draw_ray_fan(f, &fan, field_colour[i]);
}

static void draw_ghost_path(struct figure *f, const struct glint_ghost *ghost,
                            double theta)
{
    struct fan fan;

    if (init_ray_fan(&fan, f->drawing->lens, ghost, FIGURE_NM,
                     f->drawing->plane_deg, theta))
        draw_ray_fan(f, &fan, "#c0392b");
    for (int i = 0; i < 2; i++) {
        const int k = i ? ghost->j : ghost->i;

        fprintf(f->file, "<polyline fill=\"none\" stroke=\"#d0881b\" "
                         "stroke-width=\"2.4\" points=\"");
        write_surface_profile(f, k, 1);
        fprintf(f->file, "\"/>\n");
    }
}

/* -------------------------------------------------------------------- text */

static void write_svg_text(FILE *file, const char *text)
{
    for (; *text; text++)
        if (*text == '&' || *text == '<' || *text == '>')
            fprintf(file, "&#%d;", *text);
        else
            fputc(*text, file);
}

static void draw_figure_title(const struct figure *f,
                              const struct glint_optics *o, const char *path)
{
    const struct glint_prescription *lens = f->drawing->lens;
    char focus[64] = "", across[48] = "";

    if (fabs(o->squeeze - 1) > 1e-6)
        snprintf(across, sizeof across, " up and down, %.2f across",
                 o->focal_mm / o->squeeze);
    if (f->drawing->focus_m > 0)
        snprintf(focus, sizeof focus,
                 ", focused at %.4g m, light from infinity",
                 f->drawing->focus_m);
    fprintf(f->file,
            "<text x=\"%.0f\" y=\"22\" font-size=\"15\" "
            "font-weight=\"bold\">",
            FIGURE_MARGIN_PX);
    write_svg_text(f->file, lens->name);
    fprintf(f->file,
            "<tspan dx=\"10\" font-weight=\"normal\" font-size=\"12\">"
            "f = %.2f mm%s, f/%.3g%s%s</tspan></text>\n",
            o->focal_mm, across, lens->f_number, focus, path);
    fprintf(f->file, "<text x=\"%.0f\" y=\"40\" fill=\"#555\">",
            FIGURE_MARGIN_PX);
    write_svg_text(f->file, lens->source);
    fputs("</text>\n", f->file);
}

static void draw_scale_bar(const struct figure *f)
{
    const double mm = round_up_to_1_2_5(40 / f->scale);
    const double y = f->middle + 0.5 * f->height_px + 10;

    fprintf(f->file,
            "<path d=\"M%.1f %.1f h%.2f m0 -3 v6 m-%.2f -6 v6\" "
            "stroke=\"#333\" fill=\"none\" stroke-width=\"0.9\"/>\n"
            "<text x=\"%.1f\" y=\"%.1f\" fill=\"#333\">%g mm</text>\n",
            FIGURE_MARGIN_PX, y, mm * f->scale, mm * f->scale,
            FIGURE_MARGIN_PX + mm * f->scale + 6, y + 4, mm);
}

/* ------------------------------------------------------------------ figure */

static void open_svg_file(const struct figure *f)
{
    const double width = WIDTH_PX;
    const double height = f->middle + 0.5 * f->height_px + FIGURE_MARGIN_PX +
                          compute_spot_diagrams_height_px(f);

    fprintf(f->file,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" "
            "height=\"%.0f\" viewBox=\"0 0 %.0f %.0f\" "
            "font-family=\"Helvetica,Arial,sans-serif\" font-size=\"11\">\n"
            "<defs><pattern id=\"hatch-%s\" width=\"4\" height=\"4\" "
            "patternUnits=\"userSpaceOnUse\"><path d=\"M0 4 L4 0\" "
            "stroke=\"#777\" stroke-width=\"0.7\"/></pattern>\n"
            "<clipPath id=\"view-%s\"><rect x=\"%.1f\" y=\"%.1f\" "
            "width=\"%.1f\" height=\"%.1f\"/></clipPath></defs>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
            width, height, width, height, f->drawing->lens->name,
            f->drawing->lens->name, convert_z_to_px(f, f->z0),
            f->middle - 0.5 * f->height_px, f->scale * (f->z1 - f->z0),
            f->height_px);
}

/* Draws the rays to the sensor or along the ghost. PATH receives the ghost's
 * path as text. */
static void draw_rays_or_ghost(struct figure *f, char *path, size_t bytes)
{
    const struct lens_drawing *d = f->drawing;
    struct glint_ghost ghost[GLINT_MAX_GHOSTS];
    double theta = d->angle_deg;

    if (d->ghost < 0) {
        draw_field_rays(f);
        return;
    }
    glint_ghost_list(d->lens, ghost, GLINT_MAX_GHOSTS);
    if (theta < 0)
        theta = find_angle_of_image_height(f, 0.5 * f->film_mm);
    draw_ghost_path(f, &ghost[d->ghost], theta);
    snprintf(path, bytes, "; ghost %d, surfaces %d and %d, light at %.3g°",
             d->ghost, ghost[d->ghost].i, ghost[d->ghost].j, theta);
    draw_surface_number(f, ghost[d->ghost].i);
    draw_surface_number(f, ghost[d->ghost].j);
}

int lens_drawing_write(const struct lens_drawing *drawing, FILE *file)
{
    struct figure f = {.drawing = drawing, .file = file};
    struct glint_optics optics;
    char path[96] = "";

    glint_optics_of(drawing->lens, &optics);
    begin_lens_figure(&f);
    open_svg_file(&f);
    draw_axis_and_sensor(&f);
    draw_all_glass_elements(&f);
    fprintf(file, "<g clip-path=\"url(#view-%s)\">\n", drawing->lens->name);
    draw_rays_or_ghost(&f, path, sizeof path);
    fputs("</g>\n", file);
    draw_aperture_stop(&f, optics.stop_radius_mm);
    draw_figure_title(&f, &optics, path);
    draw_scale_bar(&f);
    if (drawing->spots)
        draw_all_spot_diagrams(&f);
    fputs("</svg>\n", file);
    return f.shown;
}
