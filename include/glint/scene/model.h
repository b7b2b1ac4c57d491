/* SPDX-License-Identifier: MIT
 *
 * glint/scene/model.h - the file of a baked scene, used in place.
 *
 *     status = glint_scene_open(&model, data, bytes, &reason);    once
 *
 * A baked scene is one block of 32-bit words that is used in place, in ROM or a
 * mapped file: nothing is copied or allocated. After glint_scene_open() has
 * accepted a file, drawing cannot fail.
 *
 * Lengths are in steps. One unit of the scene is 2^unit_log2 steps. The baker
 * chooses unit_log2 so that everything lies within GLINT_SCENE_SPAN steps of
 * the origin and small objects are many steps wide; nothing else in the file
 * depends on it. Space is left-handed: for a camera that is not rotated, x is
 * right, y up and z away. The baker mirrors a right-handed scene: it negates z
 * and reverses the order of triangles' vertices.
 *
 * Light is linear BT.709, 1 = display white. A white surface with diffuse
 * weight 1 that faces a light of 1 has the value 1 in the picture; its
 * irradiance is pi.
 *
 * Environment light is a section of the file, a baked environment
 * (glint/scene/environment.h). Each of its bright lights is also a sun of the
 * scene. A scene may have several environments; one at a time is shown,
 * initially the first.
 *
 * The file: little-endian 32-bit words; offsets ("_at") are bytes from the
 * start of the file, multiples of 4. Header first, then in any order what it
 * points to. No two sections share bytes; the offset of an empty section is the
 * end of the file. Members named zero are 0. */
#ifndef GLINT_SCENE_MODEL_H
#define GLINT_SCENE_MODEL_H

#include <stddef.h>
#include <stdint.h>

#include "glint/real.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_SCENE_MAGIC   UINT32_C(0x53544e47) /* "GNTS" */
#define GLINT_SCENE_VERSION 6
#define GLINT_SCENE_NONE    UINT32_C(0xffffffff) /* stands for no index */

enum {
    /* Limit of coordinates, steps: the magnitude of every coordinate is
     * smaller. */
    GLINT_SCENE_SPAN = 1 << 28,
    GLINT_SCENE_MAX_OBJECTS = 4095,
    GLINT_SCENE_MAX_LIGHTS = 32, /* max number of lights, including those of the
                                    environment */
    GLINT_SCENE_MAX_ENVIRONMENTS = 16,
    GLINT_SCENE_MAX_MATERIALS = 4096,
    GLINT_SCENE_MAX_TEXTURES = 256,
    GLINT_SCENE_MAX_MESHES = 4096,
    /* Max number of maps of translucent objects, and of translucent media. */
    GLINT_SCENE_MAX_SKINS = 64,
    /* Max number of triangles of all objects together; a mesh counts once for
     * each object that uses it. */
    GLINT_SCENE_MAX_TRIANGLES = 1 << 20,
    GLINT_SCENE_MAX_CELLS = 256,   /* max number of cells of a mesh's grid
                                      along each axis */
    GLINT_SCENE_TEXTURE_LOG2 = 12, /* log2 of the max side of a texture */
    GLINT_SCENE_NAME = 32
};

enum glint_scene_camera_kind {
    GLINT_CAMERA_FIELD,   /* square pixels; the left and right borders of the
                             picture are at -tan_x and tan_x; samples are at
                             centres of pixels */
    GLINT_CAMERA_CORNERS, /* the centres of the corner pixels are at (+-tan_x,
                             +-tan_y) */
    /* Square pixels. The focal length is focal_q16 of struct
     * glint_scene_config, so that the camera can have the focal length of the
     * lens that causes the flares. */
    GLINT_CAMERA_LENS
};

/* A pinhole camera. A point P has the camera coordinates (x, y, z) = axis (P -
 * at). Its image is x / z to the right of the middle of the picture and y / z
 * above it. */
struct glint_scene_camera {
    uint32_t kind;          /* enum glint_scene_camera_kind */
    int32_t at[3];          /* position, steps */
    int32_t axis_q30[3][3]; /* unit vectors: to the right, up, ahead */
    /* Tangents of the angles from the middle to the edge of the picture, 2^12
     * .. 2^30: of half its width and (GLINT_CAMERA_CORNERS) of half its height;
     * 0 if cameras of this kind do not use the member. */
    int32_t tan_x_q24, tan_y_q24;
};

enum glint_scene_background {
    GLINT_BACKGROUND_CAMERA, /* the picture onto which the scene is drawn */
    GLINT_BACKGROUND_COLOUR,
    GLINT_BACKGROUND_ENVIRONMENT
};

enum glint_scene_light_kind {
    GLINT_LIGHT_SUN, /* parallel rays */
    GLINT_LIGHT_LAMP /* a sphere at a finite distance */
};

struct glint_scene_light {
    char name[GLINT_SCENE_NAME]; /* terminated */
    uint32_t kind;               /* enum glint_scene_light_kind */
    int32_t at[3];               /* position of a lamp, steps; 0 for a sun */
    int32_t toward_q30[3];       /* unit vector towards a sun; 0 for a lamp */
    /* Sun: sine of its angular radius, _q30, 0 .. 2^29. Lamp: its radius,
     * steps, 0 .. GLINT_SCENE_SPAN. 0: a point. */
    int32_t radius;
    /* Light: R, G, B of a white surface that faces the light (for a lamp: at a
     * distance of one unit of the scene); each is 0 or more. The radiance of
     * the light's disc is rgb / (sine of its angular radius)^2. */
    struct glint_real rgb[3];
};

/* A picture in sRGB codes, repeated in both directions. Its levels follow each
 * other; each is half as wide and high as the previous level, at least 1 texel;
 * the last level is one texel. The middle of texel (i, j), counted from the
 * upper left corner, is at u = (i + 1/2) / width, v = (j + 1/2) / height. */
struct glint_scene_texture {
    uint32_t width_log2, height_log2; /* log2 of the sides of the first level, 0
                                         .. GLINT_SCENE_TEXTURE_LOG2 */
    uint32_t texel_at; /* uint8 R, G, B of each texel, row by row, padded to
                          whole words at the end of the last level */
};

/* The light from a surface to the camera:
 *
 *     ambient colour + sum of lights (diffuse colour (N.L) + specular (R.V)^k)
 *     light + reflect (what the mirrored ray sees) + pass (what is behind it)
 *
 * with R the light mirrored at the surface [Tutorial], [Phong75]. Environment
 * light adds the diffuse colour times the value of a white surface under that
 * light. Brushed metal has Ward's lobe, over all environment light, instead of
 * (R.V)^k. */
struct glint_scene_material {
    char name[GLINT_SCENE_NAME]; /* terminated */
    /* Weights, 0 .. 32768. The sum of ambient, diffuse and specular is at most
     * 32768; so is the sum of reflect and pass. */
    int32_t ambient_q15, diffuse_q15, specular_q15;
    int32_t reflect_q15, pass_q15;
    int32_t rgb_q15[3]; /* colour, each channel 0 .. 32768; multiplied by the
                           texture */
    int32_t power_q8;   /* exponent k of the specular term, 2^8 .. 2^20 */
    /* Refractive index of the medium inside the surface, 2^14 .. 2^18; 2^16:
     * rays are not refracted. */
    int32_t index_q16;
    uint32_t texture; /* index of the texture, or GLINT_SCENE_NONE */
    uint32_t ward;    /* index of brushed metal (specular_q15 must be 0), or
                         GLINT_SCENE_NONE */
};

/* Brushed metal. For spheres and meshes the first alpha is along circles around
 * the y axis of the object, for planes along the x axis of the object; the
 * second alpha is perpendicular to it. */
struct glint_scene_ward {
    int32_t specular_q15[3]; /* specular colour, each channel 0 .. 32768 */
    int32_t alpha_q24[2];    /* roughness in two directions, .001 .. 1, that is
                                2^14 .. 2^24 */
    uint32_t norm;           /* enum glint_ward_norm of glint/scene/ward.h */
};

/* A translucent medium. Light that enters spreads below the surface; light that
 * leaves is multiplied by the colour of the material. The surface may have a
 * coat, which is the brushed metal of the material. Ambient, diffuse and
 * specular weights are 0. */
struct glint_scene_stone {
    uint32_t material;
    /* Offset and size of a baked translucent medium
     * (glint/scene/translucent.h); the size is a multiple of 4. */
    uint32_t file_at, file_bytes;
    uint32_t fresnel; /* 1: light that enters and leaves is reduced by Fresnel
                         reflection at the surface; 0: all light passes */
};

/* The light map of a translucent object, which states for each texel to which
 * point of the surface it belongs. */
struct glint_scene_skin {
    /* Indices of the object (a sphere or a mesh with texture coordinates; at
     * most one map per object) and of its translucent medium. */
    uint32_t object, stone;
    /* Mesh: uint32 [side][side]: index of the triangle at or nearest to each
     * texel, or GLINT_SCENE_NONE. Texel (i, j) is at u = (i + 1/2) / side, v =
     * (j + 1/2) / side. Sphere: int32 _q30, two tables of cosines and sines.
     * The first, [2 side][2], has the longitude of each column; longitude 0 is
     * in front of a camera that is not rotated. The second, [side][2], has the
     * angle between each row and the upper pole. */
    uint32_t texel_at;
    /* Mesh: 1 if the backs of its triangles are never visible. Else 0. */
    uint32_t closed;
};

struct glint_scene_triangle {
    /* Vertices; clockwise as seen from outside. */
    uint32_t vertex[3];
    /* Index of its material, or GLINT_SCENE_NONE: the material of the
     * object. */
    uint32_t material;
};

/* Triangles, and a grid of cubes that finds the triangles that a ray can
 * hit. */
struct glint_scene_mesh {
    uint32_t n_vertices, n_triangles;
    uint32_t vertex_at;   /* int32 [n_vertices][3], steps */
    uint32_t uv_at;       /* int32 _q16 [n_vertices][2], +-2^24; 0: no uv */
    uint32_t normal_at;   /* int32 _q30 [n_vertices][3], unit vectors; 0: flat
                             shading */
    uint32_t triangle_at; /* struct glint_scene_triangle [n_triangles] */
    /* A sphere that encloses all vertices: |centre| + radius is at most
     * GLINT_SCENE_SPAN / 2. */
    int32_t centre[3], radius;
    /* The lowest corner of cell (i, j, k) is origin + (i, j, k) 2^cell_log2.
     * Cells are numbered with x fastest, then y, then z. The grid contains all
     * vertices. */
    int32_t origin[3];  /* lowest corner of the grid, steps, within
                           +-GLINT_SCENE_SPAN */
    uint32_t cell_log2; /* log2 of the side of a cell, steps, 2 .. 28 */
    uint32_t cells[3];  /* number of cells along each axis, 1 ..
                           GLINT_SCENE_MAX_CELLS; the far corner of the grid is
                           within GLINT_SCENE_SPAN */
    /* Cell c lists triangles ref[start[c]] .. ref[start[c + 1] - 1] in rising
     * order: all triangles whose bounding box, enlarged by GLINT_SCENE_MARGIN
     * steps on each side, touches the cell. glint_scene_open() rejects
     * incomplete lists. */
    uint32_t start_at; /* offset of START: uint32 [cells + 1]; START[0] is 0 */
    uint32_t ref_at;   /* offset of REF: uint32 [start[cells]] */
};

enum {
    GLINT_SCENE_MARGIN = 16
}; /* margin by which the bounding boxes of triangles are enlarged in the lists
      of a grid, steps */

enum glint_scene_object_kind {
    GLINT_OBJECT_SPHERE,
    GLINT_OBJECT_PLANE, /* a plane through AT; its normal is the rotated y axis;
                           u runs along x, v along -z, 1 per unit of the
                           scene */
    GLINT_OBJECT_MESH
};

struct glint_scene_object {
    char name[GLINT_SCENE_NAME]; /* terminated */
    uint32_t kind;               /* enum glint_scene_object_kind */
    uint32_t material;
    uint32_t mesh;  /* index of the mesh; 0 if the object is not a mesh */
    int32_t radius; /* sphere: 1 .. GLINT_SCENE_SPAN / 2 steps; else 0 */
    /* Fraction by which a shadow darkens the picture onto which the scene is
     * drawn, 1 .. 32768, for a shadow catcher. A shadow catcher is a plane that
     * only receives shadows. 0: the object is not a shadow catcher. */
    int32_t catcher_q15;
    uint32_t hidden; /* 1: the object is not shown */
    /* The initial pose: point p of the object is at AT + TURN p. */
    int32_t at[3];       /* position, steps; the whole object must be within
                            GLINT_SCENE_SPAN */
    int32_t turn_q30[4]; /* unit quaternion w, x, y, z */
    /* Fraction of a light that the object lets through to the surfaces in its
     * shadow, 0 .. 32768. 0: the shadow is black; 32768: there is none. Unless
     * it is 0 for all objects, shadows of suns are found by rays, not by a
     * grid. */
    int32_t unblocked_q15;
};

struct glint_scene_environment {
    char name[GLINT_SCENE_NAME]; /* terminated */
    /* Offset and size of a baked environment; the size is a multiple of 4. */
    uint32_t file_at, file_bytes;
    /* Cosine and sine of the angle by which the environment is rotated to the
     * right. */
    int32_t turn_q30[2];
    struct glint_real scale; /* factor on all light of the environment, above
                                0 */
};

enum glint_scene_detect {
    GLINT_DETECT_ANGLE, /* a sensor sees all food items within its angle of
                           view */
    GLINT_DETECT_BOTH   /* a sensor sees food items within its angle of view
                           that are also brighter than a threshold */
};

/* A recorded motion, and how it is shown. A body with sensors moves among food
 * items (landmarks that its sensors detect). The file of the motion
 * (glint/scene/motion.h) follows this struct; its axes are those of the scene's
 * text. */
struct glint_scene_motion {
    char name[GLINT_SCENE_NAME]; /* terminated */
    /* Index of the body, of the first sensor and of the first food item, or
     * GLINT_SCENE_NONE. All are spheres. There are as many sensors and food
     * items as in the file of the motion. */
    uint32_t body, sensor, food;
    int32_t size;  /* radius of the body, steps; sensors lie on its surface */
    int32_t shell; /* radius of the shell around a food item that a sensor sees,
                      steps; 0: no shells */
    int32_t line;  /* width of the lines from food items to the sensors that see
                      them, steps; 0: no lines */
    int32_t box;   /* width of the edges of the bounding box of all frames,
                      steps; 0: no box */
    /* Indices of materials: of shells, for which only the fraction of
     * transmitted light matters; of lines and of the box, for which only the
     * colour matters. */
    uint32_t shell_material, line_material, box_material;
    uint32_t detect; /* enum glint_scene_detect */
    uint32_t least;  /* threshold of intensity for GLINT_DETECT_BOTH, 255ths */
    /* Index of the sensor that is the camera, or GLINT_SCENE_NONE. */
    uint32_t camera;
    /* Bit mask, by index, of lamps that move with the body; their positions are
     * in the axes of the body. */
    uint32_t riders;
    uint32_t bytes; /* size of the file of the motion, a multiple of 4 */
    uint32_t zero;
};

/* Handedness of the axes in the scene's text, which also applies to the poses
 * that programs pass. The file is always left-handed (z runs away from the
 * camera). */
enum glint_scene_hand { GLINT_HAND_LEFT, GLINT_HAND_RIGHT };

/* The header of the file. It begins with the members that the headers of all
 * baked files have (src/base/blob.h). */
struct glint_scene_header {
    uint32_t magic, version;
    uint32_t bytes;   /* bytes of the whole file */
    uint32_t crc32;   /* checksum of all bytes after this word, as in struct
                         glint_model_header */
    uint32_t variant; /* enum glint_scene_hand */
    /* Key (hash) of the scene's text and of all files that it names, low word
     * first. */
    uint32_t key[2];
    char name[64]; /* name of the scene, terminated */
    /* Log2 of the steps in one unit of the scene, -28 .. 60. */
    int32_t unit_log2;
    uint32_t shadow;           /* 1: lights cast shadows */
    uint32_t background;       /* enum glint_scene_background */
    int32_t background_q15[3]; /* colour of GLINT_BACKGROUND_COLOUR, 0 .. 2^30;
                                  else 0 */
    struct glint_scene_camera camera;
    uint32_t flare;      /* 1: lights of the scene cause flares; else 0 */
    uint32_t highlights; /* max highlights that cause flares, 0 ..
                            8 */
    /* Number of entries and offset of each array of structs. */
    uint32_t n_lights, light_at;             /* struct glint_scene_light */
    uint32_t n_textures, texture_at;         /* struct glint_scene_texture */
    uint32_t n_materials, material_at;       /* struct glint_scene_material */
    uint32_t n_meshes, mesh_at;              /* struct glint_scene_mesh */
    uint32_t n_objects, object_at;           /* struct glint_scene_object */
    uint32_t n_wards, ward_at;               /* struct glint_scene_ward */
    uint32_t n_environments, environment_at; /* struct
                                                glint_scene_environment */
    /* Max number of bright lights over all environments. As many suns, at the
     * end of the list of lights, stand for the bright lights of the environment
     * that is shown. */
    uint32_t n_environment_lights;
    uint32_t n_motions, motion_at; /* 0 or 1 struct glint_scene_motion */
    uint32_t n_stones, stone_at;   /* struct glint_scene_stone */
    uint32_t n_skins, skin_at;     /* struct glint_scene_skin */
};

/* An opened file: points into the data of the file, which must outlive it. */
struct glint_scene_model {
    const struct glint_scene_header *header;
    const struct glint_scene_light *light;
    const struct glint_scene_texture *texture;
    const struct glint_scene_material *material;
    const struct glint_scene_mesh *mesh;
    const struct glint_scene_object *object;
    const struct glint_scene_ward *ward;
    const struct glint_scene_environment *environment;
    const struct glint_scene_motion *motion; /* NULL: the scene has no motion */
    const struct glint_scene_stone *stone;
    const struct glint_scene_skin *skin;
};

/* Checks DATA[BYTES], aligned to 4 bytes, and points MODEL into DATA, which
 * must outlive MODEL. The time is proportional to BYTES plus the triangles of
 * all objects. On GLINT_E_FORMAT, *REASON states what is wrong, in static
 * text. */
enum glint_status glint_scene_open(struct glint_scene_model *model,
                                   const void *data, size_t bytes,
                                   const char **reason);

/* Returns the index of the first object with the name NAME, or -1. */
int glint_scene_find(const struct glint_scene_model *model, const char *name);

/* Return the index of the first material, or environment, with the name NAME,
 * or -1. */
int glint_scene_find_material(const struct glint_scene_model *model,
                              const char *name);
int glint_scene_find_environment(const struct glint_scene_model *model,
                                 const char *name);

#ifdef __cplusplus
}
#endif

#endif
