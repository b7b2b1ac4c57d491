/* SPDX-License-Identifier: MIT
 *
 * Optional modules of a scene, linked by address (glint/scene/scene.h): the
 * functions that the rest calls. */
#ifndef GLINT_SCENE_PARTS_H
#define GLINT_SCENE_PARTS_H

#include "scene/state.h"

struct glint_scene_meshes {
    /* Moves the vertices of all meshes into the camera and lists triangles by
     * tiles; run by glint_scene_begin(). */
    void (*project)(struct glint_scene *scene, struct glint_scene_stats *stats);
    /* Draws the depth and ids of triangle ID into the samples of a tile. */
    void (*look)(struct glint_scene_worker *w, uint32_t id);
    /* MET->t is the limit, and is set if something is nearer. ANY: it need not
     * be the nearest. Returns whether it is. */
    int (*meet)(const struct glint_scene *scene, uint32_t object,
                uint32_t but_triangle, const struct glint_scene_ray *ray,
                int any, struct glint_met *met);
    /* The same for a ray of the picture towards SEEN_Q30, in camera
     * coordinates, held inside TRIANGLE. */
    int (*hold)(const struct glint_scene *scene, uint32_t object,
                uint32_t triangle, const int32_t seen_q30[3],
                struct glint_met *met);
    int (*surface)(const struct glint_scene *scene, const struct glint_met *met,
                   struct glint_met_surface *surface);
    /* Returns whether triangles A and B, ids of one object, are of one
     * material and share a vertex, and its normal. */
    int (*joins)(const struct glint_scene *scene, uint32_t a, uint32_t b);
    /* Surfaces in the middle of pixels, the quick way (quick.h). */
    int (*find)(struct glint_scene_worker *w, uint32_t id, int32_t x_q8,
                int32_t y_q8, struct glint_met_surface *surface);
};

struct glint_scene_textures {
    /* Multiplies RGB_Q15 by the texture of SURFACE. */
    void (*colour)(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface, int32_t rgb_q15[3]);
    /* Makes the table that it decodes by. */
    void (*prepare)(struct glint_curve *curve);
};

struct glint_scene_bounces {
    /* Adds reflected and transmitted light of SURFACE. */
    void (*follow)(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface,
                   struct glint_met_shade *shade);
    /* Allocate memory for the background picture, and store IMAGE there. */
    void (*carve)(struct glint_scene *scene, struct glint_arena *arena);
    void (*look)(struct glint_scene *scene, const struct glint_image *image);
};

struct glint_scene_wards {
    /* Allocates the memory of the module; NULL while it is measured. */
    struct glint_ward_state *(*carve)(const struct glint_scene *scene,
                                      struct glint_arena *arena);
    /* Opens the environment and makes the lobes of all metals. */
    enum glint_status (*open)(struct glint_scene *scene);
    /* Makes the lobe of metal I again. */
    void (*change)(const struct glint_scene *scene, uint32_t i);
    /* Shows environment I, with its lights. */
    void (*show)(struct glint_scene *scene, uint32_t i);
    /* Makes SCALE the factor of its light. */
    void (*scale)(struct glint_scene *scene, struct glint_real scale);
    /* Turns it. */
    void (*turn)(struct glint_scene *scene, const int32_t turn_q30[2]);
    /* Returns by how much the normal of SURFACE turns within the pixel of RAY,
     * as struct glint_brushed has it. */
    int32_t (*spread)(const struct glint_scene *scene,
                      const struct glint_scene_ray *ray,
                      const struct glint_met_surface *surface);
    /* Finds the tangent frame of the metal of SURFACE, without its spread. */
    void (*lie)(const struct glint_scene *scene,
                const struct glint_met_surface *surface,
                struct glint_brushed *brushed);
    /* Adds what SURFACE, of diffuse COLOUR_Q15, leaves along RAY of the
     * environment light, times WEIGHT_Q15. BRUSHED is NULL if it is not a
     * metal. */
    void (*reflect)(const struct glint_scene *scene,
                    const struct glint_scene_ray *ray,
                    const struct glint_met_surface *surface,
                    const struct glint_brushed *brushed,
                    const int32_t colour_q15[3], int32_t weight_q15,
                    int32_t rgb_q15[3]);
    /* Sets RGB_Q15 to what the metal of SURFACE leaves along RAY of a light of
     * LEVEL_Q15 from TOWARD_Q30, of an angular radius of that sine. Returns 0,
     * and sets nothing, if it is nothing. */
    int (*shine)(const struct glint_scene *scene,
                 const struct glint_scene_ray *ray,
                 const struct glint_met_surface *surface,
                 const struct glint_brushed *brushed,
                 const int32_t toward_q30[3], const int32_t level_q15[3],
                 int32_t radius_q30, int32_t rgb_q15[3]);
    /* Sets RGB_Q15 to the environment's light, with its bright lights, from
     * TOWARD_Q30, in the mean of a spot of that angular variance. */
    void (*look)(const struct glint_scene *scene, const int32_t toward_q30[3],
                 int64_t spread_q40, int32_t rgb_q15[3]);
};

struct glint_scene_stones {
    /* Allocates the memory of the module; NULL while it is measured. */
    struct glint_stone_state *(*carve)(const struct glint_scene *scene,
                                       struct glint_arena *arena);
    /* Opens all translucent media; before that, of SCENE the model alone is
     * there. */
    enum glint_status (*open)(struct glint_scene *scene);
    /* Notes what there is of environment light, which has changed. */
    void (*relight)(struct glint_scene *scene);
    /* Updates the maps for the frame that was begun; returns the number of
     * texels computed. */
    int (*update)(struct glint_scene *scene);
    /* Adds what comes out of SURFACE along RAY, times WEIGHT_Q15. Returns how
     * many times what it does straight ahead its coat mirrors there, q15, below
     * 2^30; 0 if its material is not a translucent medium. */
    int32_t (*add)(const struct glint_scene *scene,
                   const struct glint_scene_ray *ray,
                   const struct glint_met_surface *surface, int32_t weight_q15,
                   int32_t rgb_q15[3]);
};

struct glint_highlight_state;

struct glint_scene_highlights {
    /* Allocates the memory of the module; NULL while it is measured. */
    struct glint_highlight_state *(*carve)(const struct glint_scene *scene,
                                           struct glint_arena *arena);
    /* Begins a picture. */
    void (*begin)(struct glint_highlight_state *bright);
    /* Adds light of object OBJECT in the pixel whose middle is (X, Y), pixels
     * q8 from the top left corner: SHARE_Q4 of RGB_Q15. */
    void (*note)(struct glint_highlight_state *bright, uint32_t object,
                 int32_t x_q8, int32_t y_q8, const int32_t rgb_q15[3],
                 int share_q4);
};

#endif
