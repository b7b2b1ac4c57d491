/* SPDX-License-Identifier: MIT
 *
 * Interfaces of a scene's optional modules: tables of functions. A program
 * links a module only if it names the module's table (glint/scene/scene.h). */
#ifndef GLINT_SCENE_PARTS_H
#define GLINT_SCENE_PARTS_H

#include "scene/state.h"

struct glint_scene_meshes {
    /* Transforms the vertices of all meshes to camera coordinates and sorts
     * triangles into tiles; called by glint_scene_begin(). */
    void (*project)(struct glint_scene *scene, struct glint_scene_stats *stats);
    /* Rasterises triangle ID: writes the triangle's depth and id to those
     * samples of the worker's tile that see it. */
    void (*look)(struct glint_scene_worker *w, uint32_t id);
    /* Intersects RAY with mesh OBJECT, except with its triangle BUT_TRIANGLE.
     * On entry MET->t is the max distance, steps. If the ray hits a triangle
     * nearer than that, sets MET to the nearest intersection and returns 1. If
     * ANY is set, stops at the first intersection found. */
    int (*meet)(const struct glint_scene *scene, uint32_t object,
                uint32_t but_triangle, const struct glint_scene_ray *ray,
                int any, struct glint_met *met);
    /* Intersects a primary ray, of direction SEEN_Q30 in camera coordinates,
     * with TRIANGLE alone. A ray that passes slightly outside is clamped to the
     * triangle. */
    int (*hold)(const struct glint_scene *scene, uint32_t object,
                uint32_t triangle, const int32_t seen_q30[3],
                struct glint_met *met);
    int (*surface)(const struct glint_scene *scene, const struct glint_met *met,
                   struct glint_met_surface *surface);
    /* Returns whether triangles A and B of one object have the same material
     * and share a vertex with the same normal, so that one shaded point serves
     * both. */
    int (*joins)(const struct glint_scene *scene, uint32_t a, uint32_t b);
    /* Finds the surface that the middle of a pixel sees, by the fast path for
     * shading (quick.h). */
    int (*find)(struct glint_scene_worker *w, uint32_t id, int32_t x_q8,
                int32_t y_q8, struct glint_met_surface *surface);
};

struct glint_scene_textures {
    /* Multiplies RGB_Q15 by the texture's colour at SURFACE. */
    void (*colour)(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface, int32_t rgb_q15[3]);
    /* Fills CURVE, the table that decodes texels to linear light. */
    void (*prepare)(struct glint_curve *curve);
};

struct glint_scene_bounces {
    /* Adds to SHADE the light that SURFACE reflects and transmits from other
     * objects and the background. */
    void (*follow)(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface,
                   struct glint_met_shade *shade);
    /* carve allocates memory for the background picture, and look stores IMAGE
     * there at reduced resolution. */
    void (*carve)(struct glint_scene *scene, struct glint_arena *arena);
    void (*look)(struct glint_scene *scene, const struct glint_image *image);
};

struct glint_scene_wards {
    /* Allocates the module's memory; returns NULL if ARENA only counts
     * bytes. */
    struct glint_ward_state *(*carve)(const struct glint_scene *scene,
                                      struct glint_arena *arena);
    /* Opens the files of all environments, shows the first, and computes the
     * lobes of all metals. */
    enum glint_status (*open)(struct glint_scene *scene);
    /* Recomputes the reflection lobe of metal I after a change of its
     * parameters. */
    void (*change)(const struct glint_scene *scene, uint32_t i);
    /* Selects environment I and replaces the scene's last lights by its
     * lights. */
    void (*show)(struct glint_scene *scene, uint32_t i);
    /* Sets the factor of all light of the environment to SCALE. */
    void (*scale)(struct glint_scene *scene, struct glint_real scale);
    /* Rotates the environment about the vertical axis by the angle of cosine
     * and sine TURN_Q30. */
    void (*turn)(struct glint_scene *scene, const int32_t turn_q30[2]);
    /* Returns how much SURFACE's normal varies within the pixel of RAY, as the
     * value for spread_q30 of struct glint_brushed. */
    int32_t (*spread)(const struct glint_scene *scene,
                      const struct glint_scene_ray *ray,
                      const struct glint_met_surface *surface);
    /* Sets the tangent frame of BRUSHED, the brushed metal at SURFACE, and its
     * spread_q30 to -1. */
    void (*lie)(const struct glint_scene *scene,
                const struct glint_met_surface *surface,
                struct glint_brushed *brushed);
    /* Adds to the light of RAY the environment light that SURFACE, of diffuse
     * COLOUR_Q15, reflects, times WEIGHT_Q15. BRUSHED must be NULL unless the
     * material is a metal. */
    void (*reflect)(const struct glint_scene *scene,
                    const struct glint_scene_ray *ray,
                    const struct glint_met_surface *surface,
                    const struct glint_brushed *brushed,
                    const int32_t colour_q15[3], int32_t weight_q15,
                    int32_t rgb_q15[3]);
    /* Sets RGB_Q15 to the light that the metal of SURFACE reflects along RAY
     * from one light source. TOWARD_Q30 is the direction of the source,
     * LEVEL_Q15 its light; its angular radius is given by its sine. Returns 0,
     * and sets nothing, if no light is reflected. */
    int (*shine)(const struct glint_scene *scene,
                 const struct glint_scene_ray *ray,
                 const struct glint_met_surface *surface,
                 const struct glint_brushed *brushed,
                 const int32_t toward_q30[3], const int32_t level_q15[3],
                 int32_t radius_q30, int32_t rgb_q15[3]);
    /* Sets RGB_Q15 to the environment's light from direction TOWARD_Q30,
     * including its bright lights, averaged over a spot of angular variance
     * SPREAD_Q40, radians^2. */
    void (*look)(const struct glint_scene *scene, const int32_t toward_q30[3],
                 int64_t spread_q40, int32_t rgb_q15[3]);
};

struct glint_scene_stones {
    /* Allocates the module's memory; returns NULL if ARENA only counts
     * bytes. */
    struct glint_stone_state *(*carve)(const struct glint_scene *scene,
                                       struct glint_arena *arena);
    /* Opens the files of all translucent media. Of SCENE only the model is set
     * yet. */
    enum glint_status (*open)(struct glint_scene *scene);
    /* Recomputes the upper bound of the environment's irradiance. */
    void (*relight)(struct glint_scene *scene);
    /* Recomputes the light maps for the current frame; returns the number of
     * texels computed. */
    int (*update)(struct glint_scene *scene);
    /* Adds the light that leaves the translucent medium at SURFACE along RAY,
     * times WEIGHT_Q15. Returns the coat's reflectance for RAY / its
     * reflectance at normal incidence, q15, below 2^30; 1 without a coat; 0 if
     * the material is not a translucent medium. */
    int32_t (*add)(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface, int32_t weight_q15,
                   int32_t rgb_q15[3]);
};

struct glint_highlight_state;

struct glint_scene_highlights {
    /* Allocates the module's memory; returns NULL if ARENA only counts
     * bytes. */
    struct glint_highlight_state *(*carve)(const struct glint_scene *scene,
                                           struct glint_arena *arena);
    /* Clears the sums of light of the previous picture. */
    void (*begin)(struct glint_highlight_state *bright);
    /* Adds light RGB_Q15 of object OBJECT, over an area of SHARE_Q4 pixels
     * around (X, Y), to the sums of the square there. (X, Y) is in pixels q8
     * from the top left corner. */
    void (*note)(struct glint_highlight_state *bright, uint32_t object,
                 int32_t x_q8, int32_t y_q8, const int32_t rgb_q15[3],
                 int share_q4);
};

#endif
