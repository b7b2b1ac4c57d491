/* SPDX-License-Identifier: MIT
 *
 * Reference renderer of scenes, in double precision. It follows the same light
 * paths as the integer renderer, ray by ray, and serves as its reference.
 *
 *     twin_open(&twin, &scene);
 *     twin_render(&twin, &view, workers, pixels);
 *     twin_close(&twin);
 *
 *   in   a description; the size of the picture
 *   out  for each pixel the light of objects, and the fraction of the
 *        background that they cover
 *
 * Method: several primary rays per pixel. At a hit, Phong's terms of all lights
 * that are not occluded, then one mirrored ray, and one transmitted ray through
 * at most eight surfaces. Hits of these rays are lit likewise, but do not
 * mirror. twin_around.c adds environment light. Triangles are intersected by
 * [Moller97] in a tree of bounding boxes, spheres and planes by their
 * equations. A ray skips the object that it starts from, or for a mesh the
 * triangle.
 */
#ifndef GLINT_TOOLS_SCENES_TWIN_H
#define GLINT_TOOLS_SCENES_TWIN_H

#include "glint/scene/description.h"
#include "glint/scene/environment.h"
#include "glint/scene/translucent_bake.h"
#include "glint/workers.h"

struct twin_node;
struct twin_map;

/* The texels of a texture, in linear light. */
struct twin_texels {
    int width, height;
    float *rgb; /* [height][width][3], linear */
};

struct twin {
    const struct glint_description *scene;
    int shadow_points; /* rays per light: 1, 4 or 16; twin_open() sets 1 */
    /* Samples of a Ward lobe. 1 to 32: the samples of the run time;
     * twin_open() sets 8. More: this number of samples of the whole lobe
     * from the finest mipmap level, shifted for each ray. */
    int ward_samples;
    /* tangent of the angle of a pixel; twin_render() sets it */
    double pixel_tan;
    struct glint_environment around;
    struct twin_texels texels[GLINT_DESCRIPTION_MAX_TEXTURES];
    /* Trees of bounding boxes over the triangles of each object,
     * consecutively. */
    struct twin_node *node;
    int *root;  /* root node of each object; -1: it has no triangles */
    int *order; /* indices of triangles, in the order of the leaves */
    struct twin_map *map; /* [n_objects]: maps of translucent objects; NULL:
                             there are none */
    /* [n_stones]: scattering rows for meshes, used instead of the baked
     * fits, at the same resolution. NULL, set by twin_open(): uses the baked
     * fits. */
    const struct glint_scatter_rows *rows;
};

struct twin_ray {
    double from[3], toward[3]; /* unit vector */
    int skip_object; /* index of an object to skip, -1: none; of a mesh only
                        skip_triangle is skipped */
    int skip_triangle;
};

/* The point where a ray hits an object. */
struct twin_hit {
    double t;
    double place[3];
    double normal[3];  /* unit vector, on the side of the ray's origin */
    double shading[3]; /* normal interpolated from the vertices of a mesh */
    double uv[2];      /* texture coordinates; V points up */
    /* indices; triangle and material may be -1 */
    int object, triangle, material;
    bool inside; /* true: the ray leaves a sphere or mesh */
};

/* A pixel: rgb + (1 - cover) * background. */
struct twin_pixel {
    float rgb[3], cover;
};

struct twin_view {
    int width, height;
    double focal_px; /* focal length in pixels of a camera with the lens's field
                        of view */
    int samples;     /* rays per pixel along each side, 1 .. 64 */
};

/* Prepares SCENE, which must outlive TWIN. May return GLINT_E_MEMORY. */
enum glint_status twin_open(struct twin *twin,
                            const struct glint_description *scene);
void twin_close(struct twin *twin);

/* Sets RAY to the ray through the point (X, Y) of the picture, in pixels
 * from its upper left corner. The centre of pixel I is at I + 1/2, with
 * `camera corners` at I. */
void twin_camera_ray(const struct twin *twin, const struct twin_view *view,
                     double x, double y, struct twin_ray *ray);

/* Finds the nearest object, except shadow catchers, that RAY hits before the
 * distance MOST. Returns whether there is one. */
bool twin_meet(const struct twin *twin, const struct twin_ray *ray, double most,
               struct twin_hit *hit);

/* Returns whether RAY hits any object, except shadow catchers, before the
 * distance MOST. */
bool twin_is_hidden(const struct twin *twin, const struct twin_ray *ray,
                    double most);

/* Like twin_meet(), for a single object, which may be a shadow catcher. */
bool twin_meet_object(const struct twin *twin, int object,
                      const struct twin_ray *ray, double most,
                      struct twin_hit *hit);

/* Completes HIT on object O, of which the triangle is set, and uv holds the
 * barycentric coordinates of its second and third corner. */
void twin_finish_triangle(const struct twin *twin,
                          const struct glint_described_object *o,
                          struct twin_hit *hit);

/* Sets TOWARD to the direction from HIT to LIGHT, RGB to the light that a
 * white surface facing it would reflect, SHARE to the visible fraction of
 * LIGHT. Returns the cosine between TOWARD and the shading normal. */
double twin_light(const struct twin *twin, const struct twin_hit *hit,
                  const struct glint_described_light *light, double toward[3],
                  double rgb[3], double *share);

/* Returns the light that the primary ray RAY sees. Requires the maps of
 * translucent objects, which twin_render() computes. */
struct twin_pixel twin_see(const struct twin *twin, const struct twin_ray *ray);

/* Sets the pixel size of TWIN from VIEW, as twin_render() does. */
void twin_aim(struct twin *twin, const struct twin_view *view);

/* Draws PIXELS[height][width]. */
void twin_render(const struct twin *twin, const struct twin_view *view,
                 struct glint_workers *workers, struct twin_pixel *pixels);

/* twin_tree.c: trees of bounding boxes. */
enum glint_status twin_grow(struct twin *twin);
bool twin_meet_mesh(const struct twin *twin, int object,
                    const struct twin_ray *local, double most,
                    struct twin_hit *hit);

#endif
