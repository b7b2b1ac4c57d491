/* SPDX-License-Identifier: MIT
 *
 * glint/scene/scene.h - draws a baked scene onto pictures, in integers.
 *
 *     glint_scene_open(&model, data, bytes, &reason);        once
 *     bytes = glint_scene_bytes(&cfg, &model);
 *     glint_scene_init(&scene, &cfg, &model, mem, bytes);
 *     glint_scene_set_pose(scene, object, at, turn_q30);     each frame
 *     glint_scene_begin(scene, &stats);
 *     glint_scene_look_around(scene, &image);                a camera's
 *     glint_scene_draw(scene, &image);
 *     n = glint_scene_lights(scene, lights);                 for the flare
 *
 * Objects replace the pixels they cover; rims are blended in linear light. All
 * memory is the caller's, passed to init; drawing never allocates and cannot
 * fail. Triangles for which a capacity is too small are left out with their
 * whole object and counted. No result depends on the number of workers, the
 * order of jobs or the tile size.
 *
 * Spheres, planes, Phong and shadows are built in. All other parts are listed
 * in glint_scene_parts and linked only by programs that name them. */
#ifndef GLINT_SCENE_SCENE_H
#define GLINT_SCENE_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/real.h"
#include "glint/scene/model.h"
#include "glint/status.h"
#include "glint/workers.h"

#ifdef __cplusplus
extern "C" {
#endif

struct glint_scene_meshes;
struct glint_scene_textures;
struct glint_scene_bounces;
struct glint_scene_wards;
struct glint_scene_stones;
struct glint_scene_highlights;
struct glint_scene_motions;
extern const struct glint_scene_meshes glint_scene_meshes;
extern const struct glint_scene_textures glint_scene_textures;
extern const struct glint_scene_bounces glint_scene_bounces;
extern const struct glint_scene_wards glint_scene_wards;
extern const struct glint_scene_stones glint_scene_stones;
extern const struct glint_scene_highlights glint_scene_highlights;
extern const struct glint_scene_motions glint_scene_motions;

/* Parts of the run time; NULL: absent; models that need it are rejected. */
struct glint_scene_parts {
    const struct glint_scene_meshes *meshes;
    const struct glint_scene_textures *textures;
    const struct glint_scene_bounces *bounces; /* reflection, passing through */
    const struct glint_scene_wards *wards;     /* environments, brushed metal */
    const struct glint_scene_stones *stones;   /* translucent objects */
    /* highlights (glint/scene/highlights.h); no model needs them */
    const struct glint_scene_highlights *highlights;
    const struct glint_scene_motions *motions; /* recorded motion */
};

struct glint_scene_config {
    struct glint_workers *workers; /* must outlive the scene; NULL: one thread.
                                      The output is the same for any number of
                                      threads */
    unsigned sets; /* instruction sets, glint_sets_here() or fewer; 0: plain C
                      (kernels.h). Changes no output */
    int width, height; /* size of the picture, 1 .. GLINT_MAX_SIDE */
    int tile_log2;     /* log2 of the side of a tile in pixels, 3 .. 6. Changes
                          no output */
    int edge_samples;  /* 1, 4, 8 or 16: samples of a pixel */
    int shadow_points; /* 1, 4 or 16: points of a light that has an extent */
    int half_shading;  /* 1: blocks of 2 x 2 pixels whose samples all see one
                          object are shaded once, in their middle */
    int ward_samples;  /* 1 .. 32: lookups of an environment for a place on
                          brushed metal */
    int highlights;    /* 0 .. 8: that are found at most; -1: as many as the
                          model says */
    int dither;        /* 1: 8-bit output is dithered, deterministically */
    /* For GLINT_CAMERA_LENS: the focal length in pixels, 2^10 .. 2^40 _q16. */
    int64_t focal_q16;
    /* Entries in the lists of all tiles, one for each triangle and tile; the
     * statistics say what a frame needed. */
    int max_refs;
    struct glint_scene_parts parts;
};

struct glint_scene_stats {
    int objects;   /* that may be seen */
    int triangles; /* of these objects */
    int refs, need_refs;
    int dropped_objects; /* left out for want of max_refs */
};

struct glint_scene; /* opaque, in the caller's memory */

/* Sets CFG to good starting values for pictures of WIDTH x HEIGHT, with no
 * parts. */
void glint_scene_defaults(struct glint_scene_config *cfg, int width,
                          int height);

/* Returns the exact number of bytes that glint_scene_init() needs, or 0 if CFG
 * is out of range or MODEL needs a part that CFG does not name. */
size_t glint_scene_bytes(const struct glint_scene_config *cfg,
                         const struct glint_scene_model *model);

/* Returns the first part that MODEL needs and PARTS do not name: "meshes",
 * "textures", "bounces", "wards", "stones" or "motions"; NULL: none. */
const char *glint_scene_lacks(const struct glint_scene_parts *parts,
                              const struct glint_scene_model *model);

/* Places a scene in MEM[BYTES], aligned to 64, which needs no finish. MODEL is
 * copied; the file that it points into must outlive the scene. GLINT_E_MEMORY:
 * BYTES is too small. GLINT_E_UNSUPPORTED: MODEL needs a part that CFG does not
 * name. GLINT_E_FORMAT: its environment or a translucent medium is damaged, as
 * glint_environment_open() and glint_translucent_open() say. */
enum glint_status glint_scene_init(struct glint_scene **scene,
                                   const struct glint_scene_config *cfg,
                                   const struct glint_scene_model *model,
                                   void *mem, size_t bytes);

/* Moves object OBJECT: point p of it to AT + TURN p. GLINT_E_ARGUMENT: the
 * object would leave +-GLINT_SCENE_SPAN, or TURN_Q30, w x y z, is not a unit
 * quaternion. */
enum glint_status glint_scene_set_pose(struct glint_scene *scene, int object,
                                       const int32_t at[3],
                                       const int32_t turn_q30[4]);

/* Moves the camera; AXIS_Q30 are its unit vectors to the right, up and ahead,
 * at right angles. GLINT_E_ARGUMENT: out of range. */
enum glint_status glint_scene_set_camera(struct glint_scene *scene,
                                         const int32_t at[3],
                                         const int32_t axis_q30[3][3]);

/* Moves light LIGHT: a lamp to AT, steps; a sun to the unit vector AT, _q30.
 * GLINT_E_ARGUMENT: out of range. */
enum glint_status glint_scene_set_light(struct glint_scene *scene, int light,
                                        const int32_t at[3]);

/* Parameters of a material that may change between frames. */
struct glint_scene_look {
    int32_t rgb_q15[3]; /* ambient and diffuse colour, 0 .. 32768 */
    /* Of brushed metal, as struct glint_scene_ward; of others 0. */
    int32_t specular_q15[3], alpha_q24[2];
};

/* Sets LOOK to the current appearance of material MATERIAL, by its index;
 * GLINT_E_ARGUMENT: there is none. */
enum glint_status glint_scene_get_look(const struct glint_scene *scene,
                                       int material,
                                       struct glint_scene_look *look);

/* Changes the appearance, from the next frame on, without a bake; a metal's
 * lobe is rebuilt. The smaller alpha is raised to a tenth of the other.
 * GLINT_E_ARGUMENT: out of range, or a metal's members of another material. */
enum glint_status glint_scene_set_look(struct glint_scene *scene, int material,
                                       const struct glint_scene_look *look);

/* Makes object OBJECT, where its triangles have none of their own, of material
 * MATERIAL. GLINT_E_ARGUMENT: there is no such one, or it is translucent and
 * the object has no map for it. */
enum glint_status glint_scene_set_material(struct glint_scene *scene,
                                           int object, int material);

/* Sets the radius of ball OBJECT to RADIUS, steps. GLINT_E_ARGUMENT: it is not
 * a ball, or that is below 1 or leaves +-GLINT_SCENE_SPAN. */
enum glint_status glint_scene_set_radius(struct glint_scene *scene, int object,
                                         int32_t radius);

/* Shows environment ENVIRONMENT of the model, turned and as bright as the model
 * has it: nothing is baked, allocated or checked, metals' lobes are rebuilt.
 * GLINT_E_ARGUMENT: there is none. */
enum glint_status glint_scene_set_environment(struct glint_scene *scene,
                                              int environment);

/* Makes SCALE the factor of all the light of the environment that is shown.
 * GLINT_E_ARGUMENT: it is not above 0, or there is no environment. */
enum glint_status glint_scene_scale_environment(struct glint_scene *scene,
                                                struct glint_real scale);

/* Turns the environment to the right, with its lights: TURN_Q30 are cosine and
 * sine, as of the model's header. GLINT_E_ARGUMENT: they are none, or there is
 * no environment. */
enum glint_status glint_scene_turn_environment(struct glint_scene *scene,
                                               const int32_t turn_q30[2]);

/* Keeps a reduced copy of IMAGE, of the size of the configuration, as the
 * background of rays from mirrors and glass that meet nothing: as it is ahead,
 * repeated elsewhere. NULL: black, the default. Costs nothing if no visible
 * material reflects or transmits. Must be called between begin and draw, which
 * changes IMAGE. */
void glint_scene_look_around(struct glint_scene *scene,
                             const struct glint_image *image);

/* Shows or hides object OBJECT. */
void glint_scene_show(struct glint_scene *scene, int object, int is_shown);

/* ---------------------------------------------------------- recorded motion */

/* What is shown of a recorded motion. */
enum glint_scene_kind {
    GLINT_KIND_BODY,
    GLINT_KIND_SENSORS,
    GLINT_KIND_FOODS,
    GLINT_KIND_SHELLS, /* about foods that are seen */
    GLINT_KIND_LINES,  /* from these to the sensors that see them */
    GLINT_KIND_BOX,    /* of all frames */
    GLINT_KINDS
};

/* Returns how many frames the motion of SCENE has, 0 if it has no motion. */
uint32_t glint_scene_frames(const struct glint_scene *scene);

/* Moves body, sensors, foods, attached lamps, and a camera in a sensor to frame
 * FRAME, or to the last frame: the result does not depend on earlier frames. A
 * scene begins at frame 0. */
void glint_scene_seek(struct glint_scene *scene, uint32_t frame);

/* Puts the camera into sensor SENSOR, with its field of view; -1: back to where
 * the scene has it. GLINT_E_ARGUMENT: there is no such sensor, or its field is
 * too wide for the picture's shape. */
enum glint_status glint_scene_enter(struct glint_scene *scene, int sensor);

/* Shows or hides all of KIND. */
void glint_scene_show_kind(struct glint_scene *scene,
                           enum glint_scene_kind kind, int is_shown);

/* Sets radius or width of all of KIND; of the body also how far sensors are
 * from its middle. GLINT_E_ARGUMENT: not within 1 .. GLINT_SCENE_SPAN / 4
 * steps, or there is no such thing. */
enum glint_status glint_scene_size_kind(struct glint_scene *scene,
                                        enum glint_scene_kind kind,
                                        int32_t steps);

/* Returns which sensors see food FOOD now, by bits. */
uint32_t glint_scene_seen_by(const struct glint_scene *scene, uint32_t food);

/* ------------------------------------------------------------------- frame */

/* Prepares a frame: visible objects, and their tiles. Must precede draw and
 * lights; may be called again. */
void glint_scene_begin(struct glint_scene *scene,
                       struct glint_scene_stats *stats);

/* Computes the light below translucent surfaces where it may be visible and has
 * changed; returns the number of texels. Draw calls it if the program did not
 * since begin. */
int glint_scene_spread(struct glint_scene *scene);

/* Draws the scene onto IMAGE, which has the size of the configuration, and
 * stores the cover for glint_scene_cover(). May be called again. */
void glint_scene_draw(struct glint_scene *scene,
                      const struct glint_image *image);

/* Returns the fraction, 0 .. 256, of a disc of the picture drawn last that the
 * scene hides, shadows on catchers not counted: (X, Y) in pixels from the top
 * left corner of the picture, to 8 x 8 pixels. */
int glint_scene_cover(const struct glint_scene *scene, int32_t x_q8,
                      int32_t y_q8, int32_t radius_q8);

/* A light of the scene as the camera sees it. */
struct glint_scene_lamp {
    int light;          /* its index */
    int share;          /* of 16 points of its disc, how many are not hidden */
    int32_t x_q8, y_q8; /* pixels from the top left corner, y down */
    int32_t radius_q8;  /* pixels, 0 .. 2^22 */
    /* Light of each channel in the picture, display white times pixels, of the
     * whole disc: what is seen of it is share / 16. */
    struct glint_real rgb[3];
};

/* Sets LAMPS[GLINT_SCENE_MAX_LIGHTS] to the lights ahead of the camera, at most
 * 16384 pixels from the picture's middle, the hidden ones, too, and returns
 * their number; 0 if the scene shows the lens no lights. Objects hide lights
 * wholly, also those that let light through. */
int glint_scene_lights(const struct glint_scene *scene,
                       struct glint_scene_lamp *lamps);

#ifdef __cplusplus
}
#endif

#endif
