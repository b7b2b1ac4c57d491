/* SPDX-License-Identifier: MIT
 *
 * glint/scene/model.h - a baked scene: its file, used where it lies.
 *
 *     status = glint_scene_open(&model, data, bytes, &reason);    once
 *
 * A baked scene is one block of 32-bit words that is used where it lies, in ROM
 * or a mapped file: nothing is copied, nothing is allocated. After
 * glint_scene_open() has accepted it drawing cannot fail, whatever the file
 * holds.
 *
 * Lengths are in steps. One unit of the scene is 2^unit_log2 steps, and the
 * baker chooses that so that everything lies within GLINT_SCENE_SPAN steps of
 * the origin and small objects have many: nothing else in the file depends on
 * it. Space is left-handed: seen by a camera that is not turned, x is right, y
 * up and z away. A right-handed scene is mirrored by the baker: z changes its
 * sign, and triangles their order.
 *
 * Light is linear BT.709, 1 = display white. A weight of 1, white, that faces a
 * light of 1 shows 1: the light's irradiance is pi then.
 *
 * Environment light is a baked environment (glint/scene/environment.h),
 * a section of the file; of its bright lights each is a sun of the scene, too.
 * There may be several, of which one at a time is shown, at first the first.
 *
 * The file: little-endian 32-bit words; offsets ("_at") are bytes from the
 * start of the file, multiples of 4. Header first, then in any order what it
 * points to. No two sections share bytes; an
 * empty one points at the end of the file. Members named zero are 0. */
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
#define GLINT_SCENE_VERSION 5
#define GLINT_SCENE_NONE    UINT32_C(0xffffffff) /* no texture, no material */

enum {
    GLINT_SCENE_SPAN = 1 << 28, /* steps: every coordinate is below */
    GLINT_SCENE_MAX_OBJECTS = 4095,
    GLINT_SCENE_MAX_LIGHTS = 32, /* with those of the environment */
    GLINT_SCENE_MAX_ENVIRONMENTS = 16,
    GLINT_SCENE_MAX_MATERIALS = 4096,
    GLINT_SCENE_MAX_TEXTURES = 256,
    GLINT_SCENE_MAX_MESHES = 4096,
    GLINT_SCENE_MAX_SKINS = 64,          /* and translucent media */
    GLINT_SCENE_MAX_TRIANGLES = 1 << 20, /* of all objects together; a mesh
                                            counts once for each object */
    GLINT_SCENE_MAX_CELLS = 256,         /* of a grid, along each axis */
    GLINT_SCENE_TEXTURE_LOG2 = 12,       /* log2 of the largest side */
    GLINT_SCENE_NAME = 32
};

enum glint_scene_camera_kind {
    GLINT_CAMERA_FIELD,   /* square pixels; the picture's sides are tan_x from
                             the middle; samples at pixels' centres */
    GLINT_CAMERA_CORNERS, /* the middles of the corner pixels are tan_x and
                             tan_y from the middle */
    GLINT_CAMERA_LENS     /* square pixels; the focal length in pixels is given
                             to the run time: that of the lens of the flare */
};

/* A pinhole. A point at P is seen where the ray through its camera coordinates
 * (x, y, z) = axis (P - at) leaves the picture: x / z to the right, y / z up.
 */
struct glint_scene_camera {
    uint32_t kind;          /* enum glint_scene_camera_kind */
    int32_t at[3];          /* steps */
    int32_t axis_q30[3][3]; /* unit vectors: to the right, up, ahead */
    /* Tangents from the middle, 2^12 .. 2^30: half the picture's width and, of
     * corners, height; 0 if the kind has none. */
    int32_t tan_x_q24, tan_y_q24;
};

enum glint_scene_background {
    GLINT_BACKGROUND_CAMERA, /* the picture that is drawn onto */
    GLINT_BACKGROUND_COLOUR,
    GLINT_BACKGROUND_ENVIRONMENT
};

enum glint_scene_light_kind {
    GLINT_LIGHT_SUN, /* parallel rays */
    GLINT_LIGHT_LAMP /* a ball in space */
};

struct glint_scene_light {
    char name[GLINT_SCENE_NAME]; /* terminated */
    uint32_t kind;               /* enum glint_scene_light_kind */
    int32_t at[3];               /* lamp: its place, steps; else 0 */
    int32_t toward_q30[3];       /* sun: unit vector to it; else 0 */
    /* Sun: sine of its angular radius, 0 .. 2^29, q30. Lamp: its radius, steps,
     * 0 .. GLINT_SCENE_SPAN. 0: a point. */
    int32_t radius;
    /* R, G, B of a white surface that faces it, each 0 or more: of a lamp at
     * distance 1, in units of the scene. The radiance of the disc is this over
     * sine^2 of its angular radius. */
    struct glint_real rgb[3];
};

/* A picture in codes of sRGB, repeated in both directions. Levels follow each
 * other, each half as wide and high as the one before, at least 1; the last is
 * one texel. The middle of texel (i, j), counted from the upper left corner,
 * is at u = (i + 1/2) / width, v = (j + 1/2) / height. */
struct glint_scene_texture {
    uint32_t width_log2, height_log2; /* 0 .. GLINT_SCENE_TEXTURE_LOG2 */
    uint32_t texel_at; /* uint8 R, G, B of each texel, row by row, padded to
                          whole words at the end of the last level */
};

/* What a surface sends to the eye:
 *
 *     ambient colour + sum of lights (diffuse colour (N.L) + specular (R.V)^k)
 *     light + reflect (what the mirrored ray sees) + pass (what is behind it)
 *
 * with R the light mirrored at the surface [Tutorial], [Phong75]. Environment
 * light adds diffuse colour times what it shows a white surface. In place
 * of (R.V)^k brushed metal has Ward's lobe, over all of that light. */
struct glint_scene_material {
    char name[GLINT_SCENE_NAME]; /* terminated */
    /* Weights, 0 .. 32768; those of one line sum to 32768 at most. */
    int32_t ambient_q15, diffuse_q15, specular_q15;
    int32_t reflect_q15, pass_q15;
    int32_t rgb_q15[3]; /* colour, each 0 .. 32768; times the texture's */
    int32_t power_q8;   /* k, 2^8 .. 2^20 */
    /* Index of refraction of what the surface encloses, 2^14 .. 2^18; 2^16:
     * rays pass straight on. */
    int32_t index_q16;
    uint32_t texture; /* or GLINT_SCENE_NONE */
    uint32_t ward;    /* brushed metal, whose specular_q15 is 0; or
                         GLINT_SCENE_NONE */
};

/* Brushed metal. Of a ball and a mesh the first alpha is that around the y axis
 * of the object, of a plane along its x axis; the other at right angles. */
struct glint_scene_ward {
    int32_t specular_q15[3]; /* 0 .. 32768 */
    int32_t alpha_q24[2];    /* .001 .. 1, 2^14 .. 2^24 */
    uint32_t norm;           /* enum glint_ward_norm of glint/scene/ward.h */
};

/* A translucent medium: light that gets in spreads below the
 * surface, and what comes out times the material's colour is all that it shows
 * but for its coat, which is the material's brushed metal. Diffuse, ambient and
 * specular are 0.
 */
struct glint_scene_stone {
    uint32_t material;
    uint32_t file_at, file_bytes; /* a baked translucent medium
                                     (glint/scene/translucent.h), whole words */
    uint32_t fresnel; /* 1: the surface lets through what its index does, each
                         way; 0: all light */
};

/* The map of an object that is translucent: which place of it each
 * texel is. */
struct glint_scene_skin {
    uint32_t object, stone; /* a ball or a mesh with uv, once */
    /* Mesh: uint32 [side][side], the triangle of each texel, of those around it
     * the nearest one, or GLINT_SCENE_NONE. Texel (i, j) is at u = (i + 1/2) /
     * side, v = (j + 1/2) / side.
     * Ball: int32 _q30 [2 side][2], then [side][2], units: cosine and sine of
     * the longitude of each column, 0 ahead of a camera that is not turned, and
     * of the angle from the upper pole of each row. */
    uint32_t texel_at;
    uint32_t closed; /* mesh: 1: its backs are not to be seen; else 0 */
};

struct glint_scene_triangle {
    /* Vertices; clockwise as seen from outside. */
    uint32_t vertex[3];
    uint32_t material; /* or GLINT_SCENE_NONE: the object's */
};

/* Triangles, and a grid of cubes over them that states which of them a ray can
 * meet. */
struct glint_scene_mesh {
    uint32_t n_vertices, n_triangles;
    uint32_t vertex_at;   /* int32 [n_vertices][3], steps */
    uint32_t uv_at;       /* int32 _q16 [n_vertices][2], +-2^24; or 0: none */
    uint32_t normal_at;   /* int32 _q30 [n_vertices][3], unit; or 0: flat */
    uint32_t triangle_at; /* struct glint_scene_triangle [n_triangles] */
    /* A ball that holds all vertices: |centre| + radius is at most
     * GLINT_SCENE_SPAN / 2. */
    int32_t centre[3], radius;
    /* Cell (i, j, k) has the corner origin + (i, j, k) 2^cell_log2. Cells are
     * numbered by x first, then y, then z. The grid holds all vertices. */
    int32_t origin[3];  /* steps, within +-GLINT_SCENE_SPAN */
    uint32_t cell_log2; /* 2 .. 28 */
    uint32_t cells[3];  /* 1 .. GLINT_SCENE_MAX_CELLS; the grid's far corner,
                           too, is within GLINT_SCENE_SPAN */
    /* Cell c lists triangles ref[start[c]] .. ref[start[c + 1] - 1]: all whose
     * box, larger by GLINT_SCENE_MARGIN steps each way, touches it, rising;
     * glint_scene_open() refuses lists that lack one. */
    uint32_t start_at; /* uint32 [cells + 1]; the first is 0 */
    uint32_t ref_at;   /* uint32 [start[cells]] */
};

enum { GLINT_SCENE_MARGIN = 16 }; /* steps */

enum glint_scene_object_kind {
    GLINT_OBJECT_SPHERE,
    GLINT_OBJECT_PLANE, /* through AT, its normal the turned y axis; u goes
                           along x, v along -z, 1 a unit of the scene */
    GLINT_OBJECT_MESH
};

struct glint_scene_object {
    char name[GLINT_SCENE_NAME]; /* terminated */
    uint32_t kind;               /* enum glint_scene_object_kind */
    uint32_t material;
    uint32_t mesh;  /* index; 0 if it is none */
    int32_t radius; /* sphere: 1 .. GLINT_SCENE_SPAN / 2 steps; else 0 */
    /* Plane: it only takes shadows, on the picture that is drawn onto, and
     * hides this fraction of what a light does not reach, 1 .. 32768; else 0.
     */
    int32_t catcher_q15;
    uint32_t hidden; /* 1: it is not there */
    /* The pose at the start: a point p of the object is at at + turn p. */
    int32_t at[3];       /* steps; with what it is of it within
                            GLINT_SCENE_SPAN */
    int32_t turn_q30[4]; /* unit quaternion w, x, y, z */
};

struct glint_scene_environment {
    char name[GLINT_SCENE_NAME];  /* terminated */
    uint32_t file_at, file_bytes; /* a baked environment, whole words */
    /* Cosine and sine of the angle by which it is turned to the right. */
    int32_t turn_q30[2];
    struct glint_real scale; /* factor of all its light, above 0 */
};

enum glint_scene_detect {
    GLINT_DETECT_ANGLE, /* a food is seen that lies within the sensor's angle */
    GLINT_DETECT_BOTH   /* and is brighter than a threshold */
};

/* How a recorded motion is shown; a file of glint/scene/motion.h follows. Its
 * axes are those of the scene's text. */
struct glint_scene_motion {
    char name[GLINT_SCENE_NAME]; /* terminated */
    /* The first object of each kind, all balls, or GLINT_SCENE_NONE: the body,
     * as many sensors and as many foods as the motion has. */
    uint32_t body, sensor, food;
    int32_t size;  /* of the body, on which sensors stand; steps */
    int32_t shell; /* radius of the shell about a food that is seen, steps; 0:
                      none */
    int32_t line;  /* width of lines to sensors that see it, steps; 0: no
                      lines */
    int32_t box;   /* the same of the edges of the box of all frames */
    /* Of shells, which let their fraction pass; of lines and box, whose colour
     * alone counts. */
    uint32_t shell_material, line_material, box_material;
    uint32_t detect; /* enum glint_scene_detect */
    uint32_t least;  /* threshold in 255ths */
    uint32_t camera; /* sensor that the camera is in, or GLINT_SCENE_NONE */
    uint32_t riders; /* lamps, by bits of their index, that ride on the body:
                        they are at places of its axes */
    uint32_t bytes;  /* of the motion's file, whole words */
    uint32_t zero;
};

/* Which way z runs in the text that the scene was baked from, where poses come
 * from; in the file it always runs away. */
enum glint_scene_hand { GLINT_HAND_LEFT, GLINT_HAND_RIGHT };

/* Begins as every baked file does (src/base/blob.h). */
struct glint_scene_header {
    uint32_t magic, version;
    uint32_t bytes;      /* bytes of the whole file */
    uint32_t crc32;      /* checksum of all bytes after this word: polynomial
                            0xedb88320, reflected, begun and ended with all ones */
    uint32_t variant;    /* enum glint_scene_hand */
    uint32_t key[2];     /* key of all texts and the files they name, low word
                            first */
    char name[64];       /* name of the scene, terminated */
    int32_t unit_log2;   /* -28 .. 60: one unit is 2^unit_log2 steps */
    uint32_t shadow;     /* 1: lights throw shadows */
    uint32_t background; /* enum glint_scene_background */
    int32_t background_q15[3]; /* colour, 0 .. 2^30; else 0 */
    struct glint_scene_camera camera;
    uint32_t flare;                    /* 1: the lens sees the lights, else 0 */
    uint32_t highlights;               /* as lights of the flare, 0 .. 8 */
    uint32_t n_lights, light_at;       /* struct glint_scene_light */
    uint32_t n_textures, texture_at;   /* struct glint_scene_texture */
    uint32_t n_materials, material_at; /* struct glint_scene_material */
    uint32_t n_meshes, mesh_at;        /* struct glint_scene_mesh */
    uint32_t n_objects, object_at;     /* struct glint_scene_object */
    uint32_t n_wards, ward_at;         /* struct glint_scene_ward */
    uint32_t n_environments, environment_at; /* struct of that name */
    /* Suns at the end of the lights that are those of the environment that is
     * shown: as many as the one of the most has. */
    uint32_t n_environment_lights;
    uint32_t n_motions, motion_at; /* 0 or 1 struct glint_scene_motion */
    uint32_t n_stones, stone_at;   /* struct glint_scene_stone */
    uint32_t n_skins, skin_at;     /* struct glint_scene_skin */
};

/* An opened file: points into the file's data, which must outlive it. */
struct glint_scene_model {
    const struct glint_scene_header *header;
    const struct glint_scene_light *light;
    const struct glint_scene_texture *texture;
    const struct glint_scene_material *material;
    const struct glint_scene_mesh *mesh;
    const struct glint_scene_object *object;
    const struct glint_scene_ward *ward;
    const struct glint_scene_environment *environment;
    const struct glint_scene_motion *motion; /* NULL: there is none */
    const struct glint_scene_stone *stone;
    const struct glint_scene_skin *skin;
};

/* Checks DATA[BYTES], aligned to 4 bytes, and points MODEL into DATA, which
 * must outlive MODEL. Time is in proportion to BYTES and the objects'
 * triangles. GLINT_E_FORMAT: *REASON states what is wrong, in static text. */
enum glint_status glint_scene_open(struct glint_scene_model *model,
                                   const void *data, size_t bytes,
                                   const char **reason);

/* Returns the index of the first object of that name, or -1. */
int glint_scene_find(const struct glint_scene_model *model, const char *name);

/* The same of materials, and of environments. */
int glint_scene_find_material(const struct glint_scene_model *model,
                              const char *name);
int glint_scene_find_environment(const struct glint_scene_model *model,
                                 const char *name);

#ifdef __cplusplus
}
#endif

#endif
