/* SPDX-License-Identifier: MIT
 *
 * Interfaces of a scene's optional modules: tables of functions, so that
 * modules are linked only if a program names their address
 * (glint/scene/scene.h).
 */
#ifndef GLINT_SCENE_PARTS_H
#define GLINT_SCENE_PARTS_H

#include "scene/state.h"

struct glint_scene_meshes {
    /* Transforms the vertices of all meshes to camera coordinates and sorts
     * triangles into tiles; called by glint_scene_begin(). */
    void (*project)(struct glint_scene *scene, struct glint_scene_stats *stats);
    /* Rasterises triangle ID: writes its depth and id to the samples of the
     * worker's tile. */
    void (*look)(struct glint_scene_worker *w, uint32_t id);
    /* Intersects RAY with the mesh OBJECT, skipping triangle BUT_TRIANGLE.
     * On entry MET->t is the max distance. Sets MET and returns 1 if the ray
     * meets a triangle before that. If ANY is set, any intersection
     * suffices. */
    int (*meet)(const struct glint_scene *scene, uint32_t object,
                uint32_t but_triangle, const struct glint_scene_ray *ray,
                int any, struct glint_met *met);
    /* Intersects a primary ray of direction SEEN_Q30, in camera coordinates,
     * with TRIANGLE alone. A point slightly outside is clamped to the
     * triangle. */
    int (*hold)(const struct glint_scene *scene, uint32_t object,
                uint32_t triangle, const int32_t seen_q30[3],
                struct glint_met *met);
    int (*surface)(const struct glint_scene *scene, const struct glint_met *met,
                   struct glint_met_surface *surface);
    /* Returns whether triangles A and B of one object have the same material
     * and share a vertex and its normal. */
    int (*joins)(const struct glint_scene *scene, uint32_t a, uint32_t b);
    /* Finds the surface in the middle of a pixel by the fast path (quick.h). */
    int (*find)(struct glint_scene_worker *w, uint32_t id, int32_t x_q8,
                int32_t y_q8, struct glint_met_surface *surface);
};

struct glint_scene_textures {
    /* Multiplies RGB_Q15 by the texture of SURFACE. */
    void (*colour)(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface, int32_t rgb_q15[3]);
    /* Prepares the table CURVE that decodes texels. */
    void (*prepare)(struct glint_curve *curve);
};

struct glint_scene_bounces {
    /* Adds the reflected and transmitted light at SURFACE to SHADE. */
    void (*follow)(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface,
                   struct glint_met_shade *shade);
    /* Allocate memory for the background picture, and store a reduced IMAGE
     * in it. */
    void (*carve)(struct glint_scene *scene, struct glint_arena *arena);
    void (*look)(struct glint_scene *scene, const struct glint_image *image);
};

struct glint_scene_wards {
    /* Allocates the module's memory; returns NULL while ARENA only measures. */
    struct glint_ward_state *(*carve)(const struct glint_scene *scene,
                                      struct glint_arena *arena);
    /* Opens the environment and computes the lobes of all metals. */
    enum glint_status (*open)(struct glint_scene *scene);
    /* Recomputes the lobe of metal I. */
    void (*change)(const struct glint_scene *scene, uint32_t i);
    /* Selects environment I with its lights. */
    void (*show)(struct glint_scene *scene, uint32_t i);
    /* Sets the factor of the environment's light to SCALE. */
    void (*scale)(struct glint_scene *scene, struct glint_real scale);
    /* Rotates the environment by the angle whose cosine and sine are
     * TURN_Q30. */
    void (*turn)(struct glint_scene *scene, const int32_t turn_q30[2]);
    /* Returns the variation of SURFACE's normal within the pixel of RAY, as in
     * spread_q30 of struct glint_brushed. */
    int32_t (*spread)(const struct glint_scene *scene,
                      const struct glint_scene_ray *ray,
                      const struct glint_met_surface *surface);
    /* Finds the tangent frame of the metal of SURFACE; does not set its
     * spread. */
    void (*lie)(const struct glint_scene *scene,
                const struct glint_met_surface *surface,
                struct glint_brushed *brushed);
    /* Adds the environment light that SURFACE, of diffuse COLOUR_Q15, reflects
     * along RAY, times WEIGHT_Q15. BRUSHED must be NULL if it is not a
     * metal. */
    void (*reflect)(const struct glint_scene *scene,
                    const struct glint_scene_ray *ray,
                    const struct glint_met_surface *surface,
                    const struct glint_brushed *brushed,
                    const int32_t colour_q15[3], int32_t weight_q15,
                    int32_t rgb_q15[3]);
    /* Sets RGB_Q15 to the light that the metal of SURFACE reflects along RAY
     * from a light of LEVEL_Q15 in direction TOWARD_Q30, whose angular
     * radius is given by its sine. Returns 0, and sets nothing, if there is
     * no such light. */
    int (*shine)(const struct glint_scene *scene,
                 const struct glint_scene_ray *ray,
                 const struct glint_met_surface *surface,
                 const struct glint_brushed *brushed,
                 const int32_t toward_q30[3], const int32_t level_q15[3],
                 int32_t radius_q30, int32_t rgb_q15[3]);
    /* Sets RGB_Q15 to the environment's light from TOWARD_Q30, including its
     * bright lights, averaged over a spot of angular variance SPREAD_Q40. */
    void (*look)(const struct glint_scene *scene, const int32_t toward_q30[3],
                 int64_t spread_q40, int32_t rgb_q15[3]);
};

struct glint_scene_stones {
    /* Allocates the module's memory; returns NULL while ARENA only measures. */
    struct glint_stone_state *(*carve)(const struct glint_scene *scene,
                                       struct glint_arena *arena);
    /* Opens all translucent media. Only the model of SCENE is set at this
     * time. */
    enum glint_status (*open)(struct glint_scene *scene);
    /* Updates the state after a change of environment light. */
    void (*relight)(struct glint_scene *scene);
    /* Updates the maps for the current frame; returns the number of texels
     * computed. */
    int (*update)(struct glint_scene *scene);
    /* Adds the light that leaves SURFACE along RAY, times WEIGHT_Q15. Returns
     * the ratio of the coat's reflectance there to its reflectance at normal
     * incidence, q15, below 2^30; 0 if the material is not a translucent
     * medium. */
    int32_t (*add)(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface, int32_t weight_q15,
                   int32_t rgb_q15[3]);
};

struct glint_highlight_state;

struct glint_scene_highlights {
    /* Allocates the module's memory; returns NULL while ARENA only measures. */
    struct glint_highlight_state *(*carve)(const struct glint_scene *scene,
                                           struct glint_arena *arena);
    /* Forgets the highlights of the last picture. */
    void (*begin)(struct glint_highlight_state *bright);
    /* Adds light of object OBJECT in the pixel whose middle is (X, Y), pixels
     * q8 from the top left corner: the fraction SHARE_Q4 of RGB_Q15. */
    void (*note)(struct glint_highlight_state *bright, uint32_t object,
                 int32_t x_q8, int32_t y_q8, const int32_t rgb_q15[3],
                 int share_q4);
};

#endif
