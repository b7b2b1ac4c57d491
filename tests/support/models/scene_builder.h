/* SPDX-License-Identifier: MIT
 *
 * Baked scenes that tests make in memory.
 *
 *     scene_begin(&s);
 *     m = scene_material(&s, "red");
 *     scene_sphere(&s, "ball", m, 0, 0, 1000, 100);
 *     scene_seal(&s);           again after every change
 *     glint_scene_open(&model, s.data, s.bytes, &reason);
 *
 * Parts may be changed in place until they are sealed; what scene_...() return
 * is an index. */
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
    size_t tables; /* bytes at which the six tables begin */
    size_t bytes;
    uint32_t data[SCENE_BYTES / 4];
};

/* An empty scene: a camera at the origin that looks along z, 90 degrees wide,
 * on the picture that is drawn onto. One unit is 2^16 steps. */
void scene_begin(struct scene_file *s);

/* A material of colour white that shows its colour times the light. */
uint32_t scene_material(struct scene_file *s, const char *name);
uint32_t scene_sphere(struct scene_file *s, const char *name, uint32_t material,
                      int32_t x, int32_t y, int32_t z, int32_t radius);

/* A plane through (0, y, 0), facing up. */
uint32_t scene_plane(struct scene_file *s, const char *name, uint32_t material,
                     int32_t y);

/* Lights of RGB 1 (at DISTANCE, steps, of a lamp). */
uint32_t scene_sun(struct scene_file *s, const int32_t toward_q30[3]);
uint32_t scene_lamp(struct scene_file *s, const int32_t at[3],
                    int32_t distance);

/* A mesh, and its grid. UV_Q16 and NORMAL_Q30 may be NULL. */
uint32_t scene_mesh(struct scene_file *s, const int32_t (*at)[3],
                    const int32_t (*uv_q16)[2], const int32_t (*normal_q30)[3],
                    int n_vertices, const uint32_t (*triangle)[3],
                    int n_triangles);
uint32_t scene_object(struct scene_file *s, const char *name, uint32_t material,
                      uint32_t mesh);

/* A picture of 2^W_LOG2 x 2^H_LOG2 texels; levels are means of codes. */
uint32_t scene_texture(struct scene_file *s, const uint8_t *rgb,
                       uint32_t w_log2, uint32_t h_log2);

/* Writes header and tables to data and seals it. */
void scene_seal(struct scene_file *s);

/* Seals and opens; fails the test if it is refused. */
struct glint_scene_model scene_open(struct scene_file *s);

/* All parts but highlights. */
extern const struct glint_scene_parts scene_parts;

/* Opens S and begins it with CFG, in memory that the next call frees; fails the
 * test if it does in a byte less. STATS may be NULL. */
struct glint_scene *scene_start(struct scene_file *s,
                                const struct glint_scene_config *cfg,
                                struct glint_scene_stats *stats);

/* Writes the triangles of a ball to CORNERS, left-handed: RINGS rings of SIDES
 * points, ring by ring, then the pole before the first and the one after the
 * last. Returns their number, 2 RINGS SIDES. */
int scene_ball(int rings, int sides, uint32_t (*corners)[3]);

#endif
