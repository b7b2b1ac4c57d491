/* SPDX-License-Identifier: MIT
 *
 * Builds baked scenes in memory.
 *
 *     scene_begin_header(&s);
 *     m = scene_add_material(&s, "red");
 *     scene_add_sphere(&s, "ball", m, 0, 0, 1000, 100);
 *     scene_seal_checksum(&s);           after every change
 *     glint_scene_open(&model, s.data, s.bytes, &reason);
 *
 * Members may be changed until the scene is sealed. Functions scene_add_...()
 * return the index of what they add.
 */
#ifndef GLINT_TESTS_SCENE_BUILDER_H
#define GLINT_TESTS_SCENE_BUILDER_H

#include "glint/scene/model.h"
#include "glint/scene/scene.h"

enum { SCENE_PARTS = 64, SCENE_BYTES = 1 << 22 };

struct scene_file {
    struct glint_scene_header header;
    struct glint_scene_light light[GLINT_SCENE_MAX_LIGHTS];
    struct glint_scene_texture texture[4];
    struct glint_scene_material material[SCENE_PARTS];
    struct glint_scene_mesh mesh[SCENE_PARTS];
    struct glint_scene_object object[SCENE_PARTS];
    struct glint_scene_ward ward[4];
    struct glint_scene_stone stone[4];
    struct glint_scene_skin skin[4];
    size_t tables; /* offset of the first of the six tables, bytes */
    size_t bytes;
    uint32_t data[SCENE_BYTES / 4];
};

/* Returns an allocated copy of the mesh text *TEXT, a const char *, whatever
 * the NAME: a function of struct glint_description_files. */
enum glint_status scene_read_mesh_text(void *text, const char *name,
                                       uint8_t **data, size_t *bytes,
                                       struct glint_error *error);

/* Makes an empty scene, to be drawn onto an image. The camera is at the origin,
 * looks along z, and has a field of view of 90 degrees. A scene unit is 2^16
 * steps; a step is the resolution of baked coordinates. */
void scene_begin_header(struct scene_file *s);

/* Adds a white material that reflects all incident light diffusely. */
uint32_t scene_add_material(struct scene_file *s, const char *name);
uint32_t scene_add_sphere(struct scene_file *s, const char *name,
                          uint32_t material, int32_t x, int32_t y, int32_t z,
                          int32_t radius);

/* Adds a plane through (0, y, 0), facing up. */
uint32_t scene_add_plane(struct scene_file *s, const char *name,
                         uint32_t material, int32_t y);

/* Add a light of RGB 1: a sun, or a lamp, whose light is 1 at DISTANCE
 * steps. */
uint32_t scene_add_sun(struct scene_file *s, const int32_t toward_q30[3]);
uint32_t scene_add_lamp(struct scene_file *s, const int32_t at[3],
                        int32_t distance);

/* Adds a mesh and its triangle grid. UV_Q16 and NORMAL_Q30 may be NULL. */
uint32_t scene_add_mesh(struct scene_file *s, const int32_t (*at)[3],
                        const int32_t (*uv_q16)[2],
                        const int32_t (*normal_q30)[3], int n_vertices,
                        const uint32_t (*triangle)[3], int n_triangles);
uint32_t scene_add_object(struct scene_file *s, const char *name,
                          uint32_t material, uint32_t mesh);

/* Adds a texture of 2^W_LOG2 x 2^H_LOG2 texels. Its mipmap levels are means of
 * codes. */
uint32_t scene_add_texture(struct scene_file *s, const uint8_t *rgb,
                           uint32_t w_log2, uint32_t h_log2);

/* Writes header and tables to s->data, and sets size and checksum. */
void scene_seal_checksum(struct scene_file *s);

/* Seals the scene and opens it; fails the test on an error. */
struct glint_scene_model scene_open_model(struct scene_file *s);

/* all optional modules of the scene renderer except highlights */
extern const struct glint_scene_parts scene_parts;

/* Opens S and starts it with CFG, in memory that the next call frees. Checks
 * that one byte less is rejected. STATS may be NULL. */
struct glint_scene *scene_init_renderer(struct scene_file *s,
                                        const struct glint_scene_config *cfg,
                                        struct glint_scene_stats *stats);

/* Writes the triangles of a ball, in left-handed order, to CORNERS. The
 * vertices are RINGS rings of SIDES points, then the poles before the first and
 * after the last ring. Returns the number of triangles, 2 RINGS SIDES. */
int scene_make_ball(int rings, int sides, uint32_t (*corners)[3]);

#endif
