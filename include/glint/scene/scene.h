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
 * Objects replace the pixels that they cover; pixels at their edges are blended
 * in linear light. The caller passes all memory to glint_scene_init(); drawing
 * never allocates and cannot fail. If the lists of tiles have no capacity for
 * the triangles of an object, the object is left out and counted. No result
 * depends on the number of workers, the order of jobs or the tile size.
 *
 * Spheres, planes, Phong shading and shadows are built in. All other modules
 * are pointers in struct glint_scene_parts, so that only programs that use a
 * module link it. */
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

/* Optional modules. Each member points to the global variable of the same name,
 * or is NULL: then models that need the module are rejected. */
struct glint_scene_parts {
    const struct glint_scene_meshes *meshes;
    const struct glint_scene_textures *textures;
    const struct glint_scene_bounces *bounces; /* reflection and transmission */
    const struct glint_scene_wards *wards;     /* environments, brushed metal */
    const struct glint_scene_stones *stones;   /* translucent objects */
    /* highlights (glint/scene/highlights.h); no model needs this module */
    const struct glint_scene_highlights *highlights;
    const struct glint_scene_motions *motions; /* recorded motion */
};

struct glint_scene_config {
    /* Worker threads; must outlive the scene; NULL: one thread. The output is
     * the same for any number of threads. */
    struct glint_workers *workers;
    unsigned sets; /* instruction sets, glint_sets_here() or a subset; 0: plain
                      C (kernels.h). The output is the same for all sets */
    int width, height; /* size of the picture, 1 .. GLINT_MAX_SIDE */
    int tile_log2; /* log2 of the side of a tile in pixels, 3 .. 6. The output
                      is the same for any side */
    int edge_samples; /* 1, 4, 8 or 16: samples per pixel */
    /* Number of sample points on a light that is not a point: 1, 4 or 16. A
     * shadow ray is traced to each of them. */
    int shadow_points;
    /* 1: blocks of 2 x 2 pixels whose samples all see the same object are
     * shaded once, in their middle. */
    int half_shading;
    /* Number of lookups in the environment per shaded point of brushed metal, 1
     * .. 32. */
    int ward_samples;
    /* Max number of highlights that are found, 0 .. 8; -1: the number in the
     * model. */
    int highlights;
    /* For GLINT_CAMERA_LENS: the focal length in pixels, 2^10 .. 2^40 _q16. */
    int64_t focal_q16;
    /* Max number of entries in the lists of all tiles. A triangle needs one
     * entry in each tile that it touches. The statistics report how many
     * entries a frame needed. */
    int max_refs;
    struct glint_scene_parts parts;
};

struct glint_scene_stats {
    int objects;   /* number of objects that may be visible */
    int triangles; /* number of triangles of these objects */
    int refs, need_refs;
    int dropped_objects; /* number of objects left out because max_refs is too
                            small */
};

struct glint_scene; /* opaque, in the caller's memory */

/* Sets CFG to defaults for pictures of WIDTH x HEIGHT, without optional
 * modules. */
void glint_scene_defaults(struct glint_scene_config *cfg, int width,
                          int height);

/* Returns the exact number of bytes that glint_scene_init() needs, or 0 if CFG
 * is out of range or MODEL needs a module that CFG lacks. */
size_t glint_scene_bytes(const struct glint_scene_config *cfg,
                         const struct glint_scene_model *model);

/* Returns the name of the first module that MODEL needs and PARTS lacks:
 * "meshes", "textures", "bounces", "wards", "stones" or "motions". Returns NULL
 * if there is no such module. */
const char *glint_scene_lacks(const struct glint_scene_parts *parts,
                              const struct glint_scene_model *model);

/* Places a scene in MEM[BYTES], aligned to 64; it needs no cleanup. MODEL is
 * copied; the file that it points into must outlive the scene. Returns
 * GLINT_E_MEMORY if BYTES is too small. Returns GLINT_E_UNSUPPORTED if MODEL
 * needs a module that CFG lacks. Returns GLINT_E_FORMAT if an environment,
 * translucent medium or motion of MODEL is damaged, GLINT_E_ARGUMENT if CFG or
 * the alignment is wrong. */
enum glint_status glint_scene_init(struct glint_scene **scene,
                                   const struct glint_scene_config *cfg,
                                   const struct glint_scene_model *model,
                                   void *mem, size_t bytes);

/* Sets the pose of object OBJECT: its point p moves to AT + TURN p. Returns
 * GLINT_E_ARGUMENT if the object would leave +-GLINT_SCENE_SPAN, or TURN_Q30, w
 * x y z, is not a unit quaternion. */
enum glint_status glint_scene_set_pose(struct glint_scene *scene, int object,
                                       const int32_t at[3],
                                       const int32_t turn_q30[4]);

/* Moves the camera to AT, steps. AXIS_Q30 are its orthogonal unit vectors to
 * the right, up and ahead. Returns GLINT_E_ARGUMENT if a parameter is out of
 * range. */
enum glint_status glint_scene_set_camera(struct glint_scene *scene,
                                         const int32_t at[3],
                                         const int32_t axis_q30[3][3]);

/* Moves light LIGHT. For a lamp, AT is its position, steps; for a sun, AT is
 * the unit vector towards it, _q30. Returns GLINT_E_ARGUMENT if a parameter is
 * out of range. */
enum glint_status glint_scene_set_light(struct glint_scene *scene, int light,
                                        const int32_t at[3]);

/* Parameters of a material that may change between frames. */
struct glint_scene_look {
    /* Ambient and diffuse colour, each channel 0 .. 32768. */
    int32_t rgb_q15[3];
    /* Brushed metal only, as in struct glint_scene_ward; 0 for other
     * materials. */
    int32_t specular_q15[3], alpha_q24[2];
};

/* Sets LOOK to the current appearance of the material with index MATERIAL.
 * Returns GLINT_E_ARGUMENT if there is no such material. */
enum glint_status glint_scene_get_look(const struct glint_scene *scene,
                                       int material,
                                       struct glint_scene_look *look);

/* Changes the appearance of a material from the next frame on, without baking
 * again; the lobe of brushed metal is rebuilt. If one alpha is below a tenth of
 * the other, it is raised to a tenth. Returns GLINT_E_ARGUMENT if LOOK is out
 * of range, or has members for brushed metal and the material is not brushed
 * metal. */
enum glint_status glint_scene_set_look(struct glint_scene *scene, int material,
                                       const struct glint_scene_look *look);

/* Sets the material of object OBJECT to MATERIAL. Triangles with a material of
 * their own keep it. Returns GLINT_E_ARGUMENT if there is no such object or
 * material, or the material is translucent and the object has no map for it. */
enum glint_status glint_scene_set_material(struct glint_scene *scene,
                                           int object, int material);

/* Sets the radius of sphere OBJECT to RADIUS, steps. Returns GLINT_E_ARGUMENT
 * if OBJECT is not a sphere, RADIUS is below 1, or the sphere would leave
 * +-GLINT_SCENE_SPAN. */
enum glint_status glint_scene_set_radius(struct glint_scene *scene, int object,
                                         int32_t radius);

/* Shows environment ENVIRONMENT of the model, with the turn and the brightness
 * in the model. Nothing is baked, allocated or checked; lobes of brushed metals
 * are rebuilt. Returns GLINT_E_ARGUMENT if there is no such environment. */
enum glint_status glint_scene_set_environment(struct glint_scene *scene,
                                              int environment);

/* Sets the factor on all light of the environment that is shown to SCALE.
 * Returns GLINT_E_ARGUMENT if SCALE is not above 0, or there is no
 * environment. */
enum glint_status glint_scene_scale_environment(struct glint_scene *scene,
                                                struct glint_real scale);

/* Rotates the environment and its lights to the right. TURN_Q30 are cosine and
 * sine of the angle, as in struct glint_scene_environment. Returns
 * GLINT_E_ARGUMENT if TURN_Q30 is not a unit vector, or there is no
 * environment. */
enum glint_status glint_scene_turn_environment(struct glint_scene *scene,
                                               const int32_t turn_q30[2]);

/* Stores a reduced copy of IMAGE as the background for reflected and refracted
 * rays that hit no object. Rays that run ahead see IMAGE unchanged; rays in
 * other directions see it mirrored. IMAGE has the size of the configuration;
 * NULL, the default, is black. Costs nothing if no material reflects or
 * refracts, or no object is visible. Must be called after glint_scene_begin()
 * and before glint_scene_draw() changes IMAGE. */
void glint_scene_look_around(struct glint_scene *scene,
                             const struct glint_image *image);

/* Shows or hides object OBJECT. */
void glint_scene_show(struct glint_scene *scene, int object, int is_shown);

/* ---------------------------------------------------------- recorded motion */

/* Visible elements of a recorded motion. */
enum glint_scene_kind {
    GLINT_KIND_BODY,
    GLINT_KIND_SENSORS,
    GLINT_KIND_FOODS,
    GLINT_KIND_SHELLS, /* shells around food items that a sensor sees */
    GLINT_KIND_LINES,  /* lines from these food items to the sensors that see
                          them */
    GLINT_KIND_BOX,    /* the bounding box of all frames */
    GLINT_KINDS
};

/* Returns the number of frames of SCENE's motion, 0 if it has no motion. */
uint32_t glint_scene_frames(const struct glint_scene *scene);

/* Moves all elements of the recorded motion to their positions in frame FRAME:
 * body, sensors, food items, attached lamps, and a camera in a sensor. If FRAME
 * exceeds the last frame, the last frame is used. The result does not depend on
 * earlier calls. A scene begins at frame 0. */
void glint_scene_seek(struct glint_scene *scene, uint32_t frame);

/* Moves the camera into sensor SENSOR, with the field of view of the sensor;
 * -1: back to the camera of the scene. Returns GLINT_E_ARGUMENT if there is no
 * such sensor, or its field of view is too wide for the aspect ratio of the
 * picture. */
enum glint_status glint_scene_enter(struct glint_scene *scene, int sensor);

/* Shows or hides all elements of KIND. */
void glint_scene_show_kind(struct glint_scene *scene,
                           enum glint_scene_kind kind, int is_shown);

/* Sets the radius or width of all elements of KIND; for the body, also the
 * distance of sensors from its middle. Returns GLINT_E_ARGUMENT if STEPS is not
 * within 1 .. GLINT_SCENE_SPAN / 4, there is no motion, or KIND is sensors or
 * food items and there are none. */
enum glint_status glint_scene_size_kind(struct glint_scene *scene,
                                        enum glint_scene_kind kind,
                                        int32_t steps);

/* Returns a bit mask of the sensors that see food item FOOD in the current
 * frame. */
uint32_t glint_scene_seen_by(const struct glint_scene *scene, uint32_t food);

/* ------------------------------------------------------------------- frame */

/* Prepares a frame: finds the visible objects and their tiles. Must be called
 * before glint_scene_draw() and glint_scene_lights(); may be called again. */
void glint_scene_begin(struct glint_scene *scene,
                       struct glint_scene_stats *stats);

/* Computes the light below translucent surfaces where it may be visible and has
 * changed; returns the number of texels computed. glint_scene_draw() calls this
 * function if the program did not call it after glint_scene_begin(). */
int glint_scene_spread(struct glint_scene *scene);

/* Draws the scene onto IMAGE, which must have the size of the configuration,
 * and stores coverage for glint_scene_cover(). May be called again. */
void glint_scene_draw(struct glint_scene *scene,
                      const struct glint_image *image);

/* Returns the fraction of a disc that objects hide in the picture drawn last,
 * in 256ths. (X, Y) is the middle of the disc, pixels from the top left corner.
 * The resolution is 8 x 8 pixels. Shadows on shadow catchers do not count. */
int glint_scene_cover(const struct glint_scene *scene, int32_t x_q8,
                      int32_t y_q8, int32_t radius_q8);

/* A light of the scene as the camera sees it. */
struct glint_scene_lamp {
    int light; /* index of the light in the model */
    /* Number of visible points among 16 sample points on the disc of the
     * light. */
    int share;
    /* Middle of the disc, pixels from the top left corner, y down. */
    int32_t x_q8, y_q8;
    int32_t radius_q8; /* radius of the disc, pixels, 0 .. 2^22 */
    /* Light of the whole disc in the picture, per channel, display white times
     * pixels. The visible fraction is share / 16. */
    struct glint_real rgb[3];
};

/* Sets LAMPS[GLINT_SCENE_MAX_LIGHTS] to the lights ahead of the camera, at most
 * 16384 pixels from the middle of the picture, including hidden lights; returns
 * their number. Returns 0 if flares are off in the scene. Objects hide lights
 * completely, even if they transmit light. */
int glint_scene_lights(const struct glint_scene *scene,
                       struct glint_scene_lamp *lamps);

#ifdef __cplusplus
}
#endif

#endif
