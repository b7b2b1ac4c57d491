/* SPDX-License-Identifier: MIT
 *
 * glint/scene/description.h - a scene as described by its text, in double
 * precision.
 *
 *     glint_description_parse(&scene, text, bytes, "shop.scene", &files,
 * &error);
 *     ...
 *     glint_description_free(&scene);
 *
 *   in   scene text, tools/examples/scenes/README.md; the files that it names
 *   out  camera, lights, materials, objects and triangles, all checked
 *
 * Places are in scene units, colours linear light with 1 = display white,
 * angles in degrees where names say so. Objects lie about their own origin
 * and are turned and moved to their place, which frames may change. */
#ifndef GLINT_SCENE_DESCRIPTION_H
#define GLINT_SCENE_DESCRIPTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "glint/image.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    GLINT_DESCRIPTION_NAME_BYTES = 32,
    GLINT_DESCRIPTION_TEXT_LIGHTS = 16, /* lines of a text */
    GLINT_DESCRIPTION_MAX_LIGHTS = 32,  /* with those of the environment */
    GLINT_DESCRIPTION_MAX_ENVIRONMENTS = 16,
    GLINT_DESCRIPTION_MAX_MATERIALS = 256,
    GLINT_DESCRIPTION_MAX_TEXTURES = 64,
    GLINT_DESCRIPTION_MAX_STONES = 16,
    GLINT_DESCRIPTION_MAX_OBJECTS = 1024,
    GLINT_DESCRIPTION_MAX_TRIANGLES = 1 << 20, /* of all objects together */
    GLINT_DESCRIPTION_MAX_SIDE = 4096,         /* texels of a texture */
    GLINT_DESCRIPTION_MAX_RATIO = 10,          /* of alphas of brushed metal */
    GLINT_DESCRIPTION_MAX_MESH_BYTES = 1 << 27
};

/* Largest coordinate and size of objects, in scene units, and the smallest
 * size. */
#define GLINT_DESCRIPTION_REACH 1e6
#define GLINT_DESCRIPTION_LEAST 1e-6

enum glint_described_field {
    GLINT_DESCRIBED_FIELD,   /* fov_deg across the picture */
    GLINT_DESCRIBED_CORNERS, /* of row A6: 16 x 9 at a distance of 10, samples
                             at the corners of pixels */
    GLINT_DESCRIBED_LENS /* field of view of the flare lens and its sensor */
};

struct glint_described_camera {
    enum glint_described_field field;
    double fov_deg;
    double at[3];
    /* Orthogonal unit vectors. Handedness affects only RIGHT. */
    double right[3], up[3], forward[3];
};

enum glint_described_source { GLINT_DESCRIBED_SUN, GLINT_DESCRIBED_LAMP };

struct glint_described_light {
    /* sun, lamp, lamp2, ..., environment, environment2, ... */
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    enum glint_described_source kind;
    double at[3]; /* lamp: place; sun: unit vector towards it */
    /* Sun: radiance of its disc. Lamp: what a white surface shows that faces
     * it at distance 1, its irradiance over pi. */
    double colour[3];
    double radius;     /* lamp: scene units, 0: a point */
    double radius_deg; /* sun: half of its angle */
};

struct glint_described_texture {
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    /* GLINT_RGB24, sRGB, sides powers of two; plane[0] is malloc'ed. */
    struct glint_image image;
};

enum glint_described_norm { GLINT_DESCRIBED_BOUNDED, GLINT_DESCRIBED_1992 };

struct glint_described_material {
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    double ambient, diffuse, specular; /* sum at most 1 */
    double power;                      /* exponent of the specular term */
    double colour[3];
    int texture; /* -1: none */
    /* Fractions of what a mirrored ray sees and of what is behind, which come
     * on top; their sum is at most 1. */
    double reflect, pass;
    double index; /* of refraction; 1: straight on */
    /* Brushed metal: diffuse is 1, the other weights are 0. */
    bool is_metal;
    double metal[3]; /* specular colour */
    double alpha[2]; /* around the y axis of balls and meshes, along the x axis
                        of planes; and at right angles */
    enum glint_described_norm norm;
    /* Translucent: all weights are 0, brushed metal is its coat. */
    bool is_stone;
    int stone;    /* if it is */
    bool fresnel; /* what its index mirrors gets neither in nor out */
};

/* What light does below a surface. */
struct glint_described_stone {
    uint8_t *data; /* a baked translucent medium, malloc'ed */
    size_t bytes;
};

/* Environment light. */
struct glint_described_environment {
    /* Of its file, without folder and what follows the last dot. */
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    uint8_t *data; /* a baked environment, malloc'ed */
    size_t bytes;
    double turn_deg; /* to the right */
    double scale;    /* factor of all its light */
};

/* A recorded motion, and how it is shown. Lengths are in units of the scene,
 * which are those of the recording; 0: such objects are not there. */
struct glint_described_motion {
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    uint8_t *data; /* a baked motion, malloc'ed; NULL: there is none */
    size_t bytes;
    double reach;           /* of the body's places and the foods */
    double size;            /* of the body, on which sensors stand */
    double sensors, foods;  /* radii */
    double shells;          /* radius over that of the food */
    double lines, box;      /* widths */
    bool both;              /* intensities count, too: those above LEAST */
    double least;           /* 0 .. 1 */
    int body, sensor, food; /* first object of each kind; -1: none */
    int shell_material, line_material, box_material;
    int camera;      /* the sensor that the camera is in, from 0; -1: none */
    uint32_t riders; /* lights, by bits, whose places are on the body */
};

enum glint_described_kind {
    GLINT_DESCRIBED_SPHERE,
    GLINT_DESCRIBED_TRIANGLE,
    GLINT_DESCRIBED_PLANE,
    GLINT_DESCRIBED_MESH
};

struct glint_described_object {
    enum glint_described_kind kind;
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    double at[3];
    double turn[4];   /* unit quaternion w, x, y, z: from its own axes to the
                         scene's */
    double radius;    /* sphere */
    double normal[3]; /* plane: unit vector, in its own axes */
    double catcher;   /* plane: fraction of light that its shadows take from the
                         picture behind it, 0: no catcher */
    int material;     /* -1: a catcher has none; of a mesh: of the triangles
                         whose file names no other */
    int first_triangle, n_triangles;
};

struct glint_described_triangle {
    double place[3][3]; /* of the corners, in the axes of the object;
                           counter-clockwise from outside, of left-handed
                           scenes clockwise */
    double normal[3][3];
    double uv[3][2]; /* v runs up a texture: 0 is its last row */
    bool has_normals, has_uv;
    int object, material;
};

enum glint_described_background {
    GLINT_BEHIND_CAMERA,
    GLINT_BEHIND_COLOUR,
    GLINT_BEHIND_ENVIRONMENT
};

enum glint_described_flare {
    GLINT_DESCRIBED_FLARE_OFF,
    GLINT_DESCRIBED_FLARE_LIGHTS, /* lights of the scene that the camera sees */
    GLINT_DESCRIBED_FLARE_HIGHLIGHTS /* these and what glints on objects */
};

struct glint_description {
    bool left_handed;
    struct glint_described_camera camera;
    enum glint_described_background background;
    double background_colour[3];
    int n_environments;       /* the first is shown */
    int n_environment_lights; /* at the end of LIGHT: as many as the one of the
                                 most has; the last ones may be dark */
    struct glint_described_environment
        environment[GLINT_DESCRIPTION_MAX_ENVIRONMENTS];
    struct glint_described_motion motion;
    bool has_shadows;
    enum glint_described_flare flare;
    int n_highlights;

    int n_lights, n_textures, n_materials, n_objects, n_triangles;
    struct glint_described_light light[GLINT_DESCRIPTION_MAX_LIGHTS];
    struct glint_described_texture texture[GLINT_DESCRIPTION_MAX_TEXTURES];
    struct glint_described_material material[GLINT_DESCRIPTION_MAX_MATERIALS];
    int n_stones;
    struct glint_described_stone stone[GLINT_DESCRIPTION_MAX_STONES];
    struct glint_described_object object[GLINT_DESCRIPTION_MAX_OBJECTS];
    struct glint_described_triangle *triangle; /* malloc'ed, object by object */
    char warning[256]; /* a line on what is odd but allowed; may be empty */
};

/* Readers of the files that a text names; NAME is as in the text. Their results
 * are malloc'ed. On failure they write a line to ERROR. */
struct glint_description_files {
    void *ctx;
    enum glint_status (*read)(void *ctx, const char *name, uint8_t **data,
                              size_t *bytes, struct glint_error *error);
    /* As GLINT_RGB24 in sRGB, without padding. */
    enum glint_status (*picture)(void *ctx, const char *name,
                                 struct glint_image *image,
                                 struct glint_error *error);
    /* As a baked environment; NULL: there are none. */
    enum glint_status (*environment)(void *ctx, const char *name,
                                     uint8_t **data, size_t *bytes,
                                     struct glint_error *error);
    /* As a baked motion; NULL: there are none. */
    enum glint_status (*motion)(void *ctx, const char *name, uint8_t **data,
                                size_t *bytes, struct glint_error *error);
    /* As a baked translucent medium; NULL: there are none. */
    enum glint_status (*stone)(void *ctx, const char *name, uint8_t **data,
                               size_t *bytes, struct glint_error *error);
};

/* Reads a scene text. TEXT need not be terminated and may hold anything;
 * FILE_NAME only names it in errors. GLINT_E_LENS: ERROR states file, line,
 * column and cause; also what FILES return, and GLINT_E_MEMORY. SCENE is to be
 * freed on GLINT_OK alone. */
enum glint_status
glint_description_parse(struct glint_description *scene, const char *text,
                        size_t bytes, const char *file_name,
                        const struct glint_description_files *files,
                        struct glint_error *error);

void glint_description_free(struct glint_description *scene);

/* Sets TURN to the shortest turn that takes the y axis to the unit vector
 * NORMAL; of the one downwards, half a turn about x. */
void glint_described_upright(const double normal[3], double turn[4]);

#ifdef __cplusplus
}
#endif

#endif
