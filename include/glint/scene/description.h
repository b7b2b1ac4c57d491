/* SPDX-License-Identifier: MIT
 *
 * glint/scene/description.h - parses the text of a scene into a description, in
 * double precision.
 *
 *     glint_description_parse(&scene, text, bytes, "shop.scene", &files,
 *                             &error);
 *     ...
 *     glint_description_free(&scene);
 *
 *   in   scene text (tools/examples/scenes/README.md); the files that it names
 *   out  camera, lights, materials, objects and triangles, all checked
 *
 * Positions are in scene units, colours are linear light with 1 = display
 * white, angles are in degrees if names end in _deg. Each object has its own
 * axes and origin; its pose rotates and moves it, and may change between
 * frames. */
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
    GLINT_DESCRIPTION_TEXT_LIGHTS = 16, /* max number of lights in a text */
    GLINT_DESCRIPTION_MAX_LIGHTS = 32,  /* max number of lights, including those
                                           of the environment */
    GLINT_DESCRIPTION_MAX_ENVIRONMENTS = 16,
    GLINT_DESCRIPTION_MAX_MATERIALS = 256,
    GLINT_DESCRIPTION_MAX_TEXTURES = 64,
    GLINT_DESCRIPTION_MAX_STONES = 16,
    GLINT_DESCRIPTION_MAX_OBJECTS = 1024,
    GLINT_DESCRIPTION_MAX_TRIANGLES = 1 << 20, /* max number of triangles of all
                                                  objects together */
    GLINT_DESCRIPTION_MAX_SIDE = 4096,      /* max side of a texture, texels */
    GLINT_DESCRIPTION_MAX_TEXELS = 1 << 26, /* max number of texels of all
                                               textures together */
    GLINT_DESCRIPTION_MAX_RATIO = 10,       /* max ratio of the alphas of
                                               brushed metal */
    GLINT_DESCRIPTION_MAX_MESH_BYTES = 1 << 27
};

/* Max coordinate and size of objects, in scene units, and min size. */
#define GLINT_DESCRIPTION_REACH 1e6
#define GLINT_DESCRIPTION_LEAST 1e-6

enum glint_described_field {
    /* A pinhole camera with the horizontal field of view fov_deg. */
    GLINT_DESCRIBED_FIELD,
    /* The picture shows 16 x 9 units at a distance of 10; the centres of its
     * corner pixels are at the corners of this area. */
    GLINT_DESCRIBED_CORNERS,
    /* The field of view of the lens that causes the flares, on its sensor. */
    GLINT_DESCRIBED_LENS
};

struct glint_described_camera {
    enum glint_described_field field;
    double fov_deg;
    double at[3];
    /* Orthogonal unit vectors. RIGHT depends on the handedness of the scene. */
    double right[3], up[3], forward[3];
};

enum glint_described_source { GLINT_DESCRIBED_SUN, GLINT_DESCRIBED_LAMP };

struct glint_described_light {
    /* Name in the text, or one that the parser generates: sun, lamp, lamp2,
     * ..., environment, environment2, ... */
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    enum glint_described_source kind;
    double at[3]; /* position of a lamp, or unit vector towards a sun */
    /* Sun: radiance of its disc. Lamp: irradiance / pi at distance 1, which is
     * the value of a white surface that faces the lamp. */
    double colour[3];
    double radius;     /* radius of a lamp, scene units; 0: a point */
    double radius_deg; /* half of the angular diameter of a sun */
};

struct glint_described_texture {
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    /* Picture of the texture: GLINT_RGB24, sRGB, sides are powers of two;
     * plane[0] is malloc'ed. */
    struct glint_image image;
};

enum glint_described_norm { GLINT_DESCRIBED_BOUNDED, GLINT_DESCRIBED_1992 };

struct glint_described_material {
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    double ambient, diffuse, specular; /* weights of the Phong terms; their sum
                                          is at most 1 */
    double power;                      /* exponent of the specular term */
    double colour[3];
    int texture; /* index of the texture; -1: none */
    /* Fraction of the light of the mirrored ray (reflect), and of the light of
     * the transmitted ray (pass). Both are added to the other terms; their sum
     * is at most 1. */
    double reflect, pass;
    double index; /* index of refraction; 1: rays are not refracted */
    /* true: the material is brushed metal; diffuse is 1, the other weights are
     * 0 */
    bool is_metal;
    double metal[3]; /* specular colour */
    /* Roughness of brushed metal in two directions. The first direction is
     * along circles around the y axis of spheres and meshes, or along the x
     * axis of planes. The second is perpendicular to it. */
    double alpha[2];
    enum glint_described_norm norm;
    /* true: the material is translucent; all weights are 0. If is_metal is set,
     * too, the brushed metal is a coat on the surface. */
    bool is_stone;
    int stone;    /* index of the translucent medium, if is_stone */
    bool fresnel; /* true: light that enters and leaves is reduced by Fresnel
                     reflection */
};

/* Scattering of light below a surface. */
struct glint_described_stone {
    uint8_t *data; /* a baked translucent medium, malloc'ed */
    size_t bytes;
};

/* Environment light. */
struct glint_described_environment {
    /* Name of the file without folder and extension. */
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    uint8_t *data; /* a baked environment, malloc'ed */
    size_t bytes;
    double turn_deg; /* rotation of the environment to the right, degrees */
    double scale;    /* factor on all light of the environment */
};

/* A recorded motion, and how it is shown. A body with sensors moves among food
 * items (landmarks that its sensors detect). Lengths are in units of the scene,
 * which equal the units of the recording. Elements of length 0 are not
 * shown. */
struct glint_described_motion {
    char name[GLINT_DESCRIPTION_NAME_BYTES];
    uint8_t *data; /* a baked motion, malloc'ed; NULL: there is no motion */
    size_t bytes;
    double reach;          /* max coordinate of the body and the food items */
    double size;           /* radius of the body; sensors lie on its surface */
    double sensors, foods; /* radii of the spheres of sensors and of food
                              items */
    double shells;         /* (radius of a shell) / (radius of the food item
                              that it surrounds) */
    double lines, box;     /* widths of lines and of the edges of the box */
    /* true: a sensor sees only food items whose intensity is above LEAST */
    bool both;
    double least;           /* threshold of intensity, 0 .. 1 */
    int body, sensor, food; /* index of the first object of each kind; -1:
                               none */
    int shell_material, line_material, box_material;
    /* Index of the sensor that is the camera, from 0; -1: none. */
    int camera;
    /* Bit mask, by index, of lamps that move with the body; their positions are
     * in the axes of the body. */
    uint32_t riders;
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
    /* Unit quaternion w, x, y, z: rotation from the object's own axes to the
     * scene's. */
    double turn[4];
    double radius; /* radius of a sphere, scene units */
    /* Fraction by which the object's shadow darkens a light, 0 .. 1 */
    double shadow;
    /* Normal of a plane: a unit vector in the object's own axes. */
    double normal[3];
    /* Fraction by which a shadow darkens the picture behind a plane; 0: the
     * plane is not a shadow catcher. */
    double catcher;
    /* Index of the material; -1 for a shadow catcher. A mesh uses this material
     * for triangles whose file names no other material. */
    int material;
    int first_triangle, n_triangles;
};

struct glint_described_triangle {
    double place[3][3]; /* positions of the corners, in the axes of the object;
                           counter-clockwise seen from outside, in left-handed
                           scenes clockwise */
    double normal[3][3];
    double uv[3][2]; /* texture coordinates of the corners; v runs up: 0 is the
                        last row of the texture */
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
    /* Lights of the scene cause flares where the camera sees them. */
    GLINT_DESCRIBED_FLARE_LIGHTS,
    /* Lights of the scene and highlights on objects cause flares. */
    GLINT_DESCRIBED_FLARE_HIGHLIGHTS
};

struct glint_description {
    bool left_handed;
    struct glint_described_camera camera;
    enum glint_described_background background;
    double background_colour[3];
    int n_environments; /* number of environments; the first is shown */
    /* Max number of lights over all environments. The last entries of LIGHT are
     * reserved for these lights; an environment with fewer lights leaves some
     * entries dark. */
    int n_environment_lights;
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
    struct glint_described_triangle *triangle; /* triangles of all objects,
                                                  object by object; malloc'ed */
    /* A warning of one line about the first unusual statement of the text; may
     * be empty. */
    char warning[256];
};

/* Callbacks that read the files that a text names; NAME is the name in the
 * text. Their results must be malloc'ed. On failure they write a line to
 * ERROR. */
struct glint_description_files {
    void *ctx;
    enum glint_status (*read)(void *ctx, const char *name, uint8_t **data,
                              size_t *bytes, struct glint_error *error);
    /* Reads a picture as GLINT_RGB24 in sRGB, without padding. */
    enum glint_status (*picture)(void *ctx, const char *name,
                                 struct glint_image *image,
                                 struct glint_error *error);
    /* Reads a baked environment. NULL: environments are not supported. */
    enum glint_status (*environment)(void *ctx, const char *name,
                                     uint8_t **data, size_t *bytes,
                                     struct glint_error *error);
    /* Reads a baked motion. NULL: motions are not supported. */
    enum glint_status (*motion)(void *ctx, const char *name, uint8_t **data,
                                size_t *bytes, struct glint_error *error);
    /* Reads a baked translucent medium. NULL: such media are not supported. */
    enum glint_status (*stone)(void *ctx, const char *name, uint8_t **data,
                               size_t *bytes, struct glint_error *error);
};

/* Parses a scene text. TEXT need not be terminated and may contain any bytes;
 * FILE_NAME is used only in error messages. On GLINT_E_LENS, ERROR states file,
 * line, column and cause. Also returns GLINT_E_MEMORY, or the status of a
 * failed callback of FILES. SCENE must be freed only after GLINT_OK. */
enum glint_status
glint_description_parse(struct glint_description *scene, const char *text,
                        size_t bytes, const char *file_name,
                        const struct glint_description_files *files,
                        struct glint_error *error);

void glint_description_free(struct glint_description *scene);

/* Sets TURN to the shortest rotation that maps the y axis to the unit vector
 * NORMAL; if NORMAL is (0, -1, 0), to half a turn about x. */
void glint_described_upright(const double normal[3], double turn[4]);

#ifdef __cplusplus
}
#endif

#endif
