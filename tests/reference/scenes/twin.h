/* SPDX-License-Identifier: MIT
 *
 * Reference renderer of scenes, in double precision. It follows the same light
 * paths as the integer renderer, ray by ray; tests compare the integer renderer
 * with it.
 *
 *     reference_open(&twin, &scene);
 *     reference_render_image(&twin, &view, workers, pixels);
 *     reference_close(&twin);
 *
 *   in   a description; the size of the picture
 *   out  for each pixel the light of objects, and the fraction of the
 *        background that they cover
 *
 * Method: each pixel has several primary rays. A hit gets Phong's terms of all
 * lights that are not occluded. It starts one mirrored ray, and one transmitted
 * ray, which passes through at most eight surfaces. Hits of these rays get the
 * same light, but start no mirrored rays. twin_around.c adds environment light.
 * Rays are intersected with triangles by [Moller97], with spheres and planes by
 * their equations; a bounding sphere of each 16 triangles saves tests. A ray
 * skips the object that it starts from, or only the triangle if the object is a
 * mesh.
 */
#ifndef GLINT_TOOLS_SCENES_TWIN_H
#define GLINT_TOOLS_SCENES_TWIN_H

#include "glint/scene/description.h"
#include "glint/scene/environment.h"
#include "glint/scene/translucent_bake.h"
#include "glint/workers.h"

struct twin_map;

/* The texels of a texture, in linear light. */
struct twin_texels {
    int width, height;
    float *rgb; /* [height][width][3], linear */
};

/* A bounding sphere, in the coordinates of the triangles. */
struct twin_bound {
    double centre[3], radius;
};

struct twin {
    const struct glint_description *scene;
    struct twin_bound *bound; /* of each 16 consecutive triangles */
    /* shadow rays per light: 1, 4 or 16; reference_open() sets 1 */
    int shadow_points;
    /* Number of samples of a Ward lobe; reference_open() sets 8. 1 to 32: the
     * same samples as in the run time. More than 32: samples read the finest
     * mipmap level, so they cover the lobe without blur, and differ from ray to
     * ray. */
    int ward_samples;
    /* tangent of the angle that a pixel subtends; set by
     * reference_render_image() */
    double pixel_tan;
    struct glint_environment around;
    struct twin_texels texels[GLINT_DESCRIPTION_MAX_TEXTURES];
    /* [n_objects]: light maps of translucent objects; NULL: the scene has no
     * translucent object */
    struct twin_map *map;
    /* [n_stones]: exact scattering rows, which replace the baked fits for
     * meshes; they must have the resolution of the fits. NULL, as set by
     * reference_open(): the baked fits are used. */
    const struct glint_scatter_rows *rows;
};

struct twin_ray {
    double from[3], toward[3]; /* unit vector */
    /* object that the ray skips, -1: none; if it is a mesh, the ray skips only
     * skip_triangle */
    int skip_object;
    int skip_triangle;
    bool is_in_ball; /* true: the ray starts on the ball skip_object, runs
                        through it, and hits its far side */
};

/* The point where a ray hits an object. */
struct twin_hit {
    double t;
    double place[3];
    /* geometric normal, unit vector, on the side of the ray's origin */
    double normal[3];
    /* shading normal, interpolated from the vertices of a mesh */
    double shading[3];
    double uv[2]; /* texture coordinates; V points up */
    /* indices; triangle and material are -1 if there is none */
    int object, triangle, material;
    bool inside; /* true: the ray hits a sphere or mesh from inside */
};

/* A pixel: rgb + (1 - cover) * background. */
struct twin_pixel {
    float rgb[3], cover;
};

struct twin_view {
    int width, height;
    /* focal length in pixels of a camera with the lens's field of view */
    double focal_px;
    int samples; /* rays per pixel are samples x samples; 1 .. 64 */
};

/* Prepares SCENE, which must outlive TWIN. May return GLINT_E_MEMORY. */
enum glint_status reference_open(struct twin *twin,
                                 const struct glint_description *scene);
void reference_close(struct twin *twin);

/* Sets RAY to the ray through the point (X, Y) of the picture, in pixels
 * from its upper left corner. The centre of pixel I is at I + 1/2, with
 * `camera corners` at I. */
void reference_make_camera_ray(const struct twin *twin,
                               const struct twin_view *view, double x, double y,
                               struct twin_ray *ray);

/* Finds the nearest object, except shadow catchers, that RAY hits before the
 * distance MOST. Returns whether there is one. */
bool reference_intersect_scene(const struct twin *twin,
                               const struct twin_ray *ray, double most,
                               struct twin_hit *hit);

/* Returns the fraction of a light at distance MOST along RAY that the shadows
 * of objects leave. */
double reference_compute_unblocked_light(const struct twin *twin,
                                         const struct twin_ray *ray,
                                         double most);

/* Like reference_intersect_scene(), for a single object, which may be a shadow
 * catcher. */
bool reference_intersect_object(const struct twin *twin, int object,
                                const struct twin_ray *ray, double most,
                                struct twin_hit *hit);

/* Completes HIT on object O. On entry, hit->triangle is the triangle, and
 * hit->uv the barycentric weights of its second and third corner. */
void reference_complete_triangle_hit(const struct twin *twin,
                                     const struct glint_described_object *o,
                                     struct twin_hit *hit);

/* Computes the light of LIGHT at HIT. Sets TOWARD to the direction of LIGHT,
 * RGB to the light that a white surface facing LIGHT would reflect, and SHARE
 * to the visible fraction of LIGHT. Returns the cosine between TOWARD and the
 * shading normal. */
double reference_compute_light_at_hit(const struct twin *twin,
                                      const struct twin_hit *hit,
                                      const struct glint_described_light *light,
                                      double toward[3], double rgb[3],
                                      double *share);

/* Returns the light that the primary ray RAY sees. Requires the light maps of
 * translucent objects, which reference_render_image() computes. */
struct twin_pixel reference_trace_ray(const struct twin *twin,
                                      const struct twin_ray *ray);

/* Sets the pixel size of TWIN from VIEW; reference_render_image() does this
 * itself. */
void reference_set_pixel_size(struct twin *twin, const struct twin_view *view);

/* Allocates and computes the bounding spheres of the triangles; called by
 * reference_open(). */
enum glint_status reference_bound_triangles(struct twin *twin);

/* Draws PIXELS[height][width]. */
void reference_render_image(const struct twin *twin,
                            const struct twin_view *view,
                            struct glint_workers *workers,
                            struct twin_pixel *pixels);

#endif
