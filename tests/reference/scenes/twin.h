/* SPDX-License-Identifier: MIT
 *
 * The reference renderer of scenes, in double precision: the same light along
 * the same paths, ray by ray, for comparison with pictures of the integer
 * scene.
 *
 *     twin_open(&twin, &scene);
 *     twin_render(&twin, &view, workers, pixels);
 *     twin_close(&twin);
 *
 *   in   a description; the size of the picture
 *   out  of each pixel the light of objects, and the fraction of what is behind
 *        that they hide
 *
 * Method: primary rays at points of each pixel; at a hit Phong's terms of all
 * lights that no object hides, then one ray that is mirrored, and one straight
 * on or refracted through eight surfaces at most. What these meet is lit
 * likewise, but mirrors nothing; twin_around.c has environment light.
 * Triangles by [Moller97] in a tree of boxes, spheres and planes by their
 * equations. A ray skips the object it starts from, or of a mesh the triangle.
 */
#ifndef GLINT_TOOLS_SCENES_TWIN_H
#define GLINT_TOOLS_SCENES_TWIN_H

#include "glint/scene/description.h"
#include "glint/scene/environment.h"
#include "glint/scene/translucent_bake.h"
#include "glint/workers.h"

struct twin_node;
struct twin_map;

/* Light of the texels of a texture. */
struct twin_texels {
    int width, height;
    float *rgb; /* [height][width][3], linear */
};

struct twin {
    const struct glint_description *scene;
    int shadow_points; /* 1, 4 or 16 of a light's disc; twin_open() sets 1 */
    /* 1 to 32 of brushed metal's lobe, as the run time takes them; it sets 8.
     * More: so many of the whole lobe, turned again for each ray, from the
     * finest level. */
    int ward_samples;
    double pixel_tan; /* tangent of a pixel; twin_render() sets it */
    struct glint_environment around;
    struct twin_texels texels[GLINT_DESCRIPTION_MAX_TEXTURES];
    /* Trees over the triangles of each object, one after the other. */
    struct twin_node *node;
    int *root;            /* of each object; -1: it has no triangles */
    int *order;           /* triangles in the order of the leaves */
    struct twin_map *map; /* [n_objects] of what is translucent; or NULL */
    /* [n_stones] what light on meshes spreads by, instead of what was baked of
     * them, as many texels each way; NULL: as baked. twin_open() sets NULL. */
    const struct glint_scatter_rows *rows;
};

struct twin_ray {
    double from[3], toward[3]; /* unit */
    int skip_object;           /* -1: none; of meshes only skip_triangle */
    int skip_triangle;
};

/* Where a ray meets an object. */
struct twin_hit {
    double t;
    double place[3];
    double normal[3];  /* unit, on the side that the ray comes from */
    double shading[3]; /* the same, rounded off by the normals of a mesh */
    double uv[2];      /* V runs up */
    int object, triangle, material; /* triangle and material may be -1 */
    bool inside;                    /* of a sphere or mesh: the ray leaves it */
};

/* A pixel: rgb + (1 - cover) * background. */
struct twin_pixel {
    float rgb[3], cover;
};

struct twin_view {
    int width, height;
    double focal_px; /* focal length of a camera that has the lens's field */
    int samples;     /* points of a pixel along each side, 1 .. 64 */
};

/* Prepares SCENE, which is kept. GLINT_E_MEMORY. */
enum glint_status twin_open(struct twin *twin,
                            const struct glint_description *scene);
void twin_close(struct twin *twin);

/* Sets RAY to that of the point X, Y of the picture, in pixels from its upper
 * left corner (of `camera corners` pixel I is at I, else at I + 1/2). */
void twin_camera_ray(const struct twin *twin, const struct twin_view *view,
                     double x, double y, struct twin_ray *ray);

/* Finds the nearest thing but catchers that RAY meets before MOST; returns
 * whether there is one. */
bool twin_meet(const struct twin *twin, const struct twin_ray *ray, double most,
               struct twin_hit *hit);

/* Returns whether RAY meets any object but catchers before MOST. */
bool twin_is_hidden(const struct twin *twin, const struct twin_ray *ray,
                    double most);

/* The same of one object alone, catchers too. */
bool twin_meet_object(const struct twin *twin, int object,
                      const struct twin_ray *ray, double most,
                      struct twin_hit *hit);

/* Sets what is left of a HIT of object O whose triangle is known, and whose uv
 * are the fractions of its second and third corner. */
void twin_finish_triangle(const struct twin *twin,
                          const struct glint_described_object *o,
                          struct twin_hit *hit);

/* Sets TOWARD to the direction of LIGHT from HIT, RGB to what a white surface
 * shows there that faces it, SHARE to how much of it reaches HIT; returns the
 * cosine from the shading normal. */
double twin_light(const struct twin *twin, const struct twin_hit *hit,
                  const struct glint_described_light *light, double toward[3],
                  double rgb[3], double *share);

/* Returns what RAY, a primary one, sees. twin_render() has worked out maps. */
struct twin_pixel twin_see(const struct twin *twin, const struct twin_ray *ray);

/* Tells TWIN how wide pixels of VIEW are, as twin_render() does. */
void twin_aim(struct twin *twin, const struct twin_view *view);

/* Draws PIXELS[height][width]. */
void twin_render(const struct twin *twin, const struct twin_view *view,
                 struct glint_workers *workers, struct twin_pixel *pixels);

/* twin_tree.c: trees of boxes. */
enum glint_status twin_grow(struct twin *twin);
bool twin_meet_mesh(const struct twin *twin, int object,
                    const struct twin_ray *local, double most,
                    struct twin_hit *hit);

#endif
