/* SPDX-License-Identifier: MIT
 *
 * Internal header of the scene parser. Each function parses one type of line
 * after its keyword; it sets an error and returns false if the line is invalid.
 */
#ifndef GLINT_BAKE_SCENE_DESCRIBE_H
#define GLINT_BAKE_SCENE_DESCRIBE_H

#include "bake/scene/clauses.h"
#include "glint/scene/description.h"

struct glint_describer {
    struct glint_text text;
    struct glint_description *scene;
    const struct glint_description_files *files;
    struct glint_error *error;
    enum glint_status status; /* status of a failure outside the text, such as
                                 missing memory */
    int room; /* number of triangles that memory is allocated for */
    /* Position of the camera's line. It is evaluated after all lines, as it
     * depends on the handedness. */
    struct glint_text_place camera;
    struct glint_text_place background; /* position of the line "background" */
    double toward[3], up[3], orbit[3], distance, yaw_deg, pitch_deg;
    bool has_orbit;
    /* position of the word "sensor" of the camera */
    struct glint_text_place sensor;
    /* position of the first lamp that moves with a motion */
    struct glint_text_place rides;
    char rides_on[GLINT_DESCRIPTION_NAME_BYTES];
};

/* describe_motion.c: parses the motion; glint_describe_sensors() checks it
 * after all lines were parsed. */
bool glint_describe_motion(struct glint_describer *d);
bool glint_describe_sensors(struct glint_describer *d);

/* describe_things.c: appends an object of KIND. Returns NULL if there are
 * too many objects or the name is taken; the error refers to PLACE. */
struct glint_described_object *
glint_describe_thing(struct glint_describer *d, enum glint_described_kind kind,
                     const char *name, struct glint_text_place place);

/* describe_view.c: parse the lines hand, camera, background, shadow, flare. */
bool glint_describe_hand(struct glint_describer *d);
bool glint_describe_camera(struct glint_describer *d);
bool glint_describe_background(struct glint_describer *d);
bool glint_describe_shadow(struct glint_describer *d);
bool glint_describe_flare(struct glint_describer *d);
/* Computes position and direction of the camera, after all lines were
 * parsed. */
bool glint_describe_axes(struct glint_describer *d);

/* describe_looks.c: parse the lines light, texture, material. */
bool glint_describe_light(struct glint_describer *d);
bool glint_describe_texture(struct glint_describer *d);
bool glint_describe_material(struct glint_describer *d);
/* Sets INDEX to the index of the material with the name WORD. */
bool glint_describe_find(struct glint_describer *d,
                         const struct glint_word *word, int *index);

/* Rejects object O, the last one defined, if its material is translucent and
 * its surface cannot be mapped to a texture map. PLACE is the position of
 * its material. Warns if the mapping is stretched. */
bool glint_describe_skin(struct glint_describer *d,
                         const struct glint_described_object *o,
                         struct glint_text_place place);

/* describe_around.c: parses an environment; glint_describe_around() adds its
 * lights after all lines were parsed. */
bool glint_describe_environment(struct glint_describer *d);
bool glint_describe_around(struct glint_describer *d);

/* describe_things.c: parse the lines sphere, triangle, plane, mesh. */
bool glint_describe_sphere(struct glint_describer *d);
bool glint_describe_triangle(struct glint_describer *d);
bool glint_describe_plane(struct glint_describer *d);
bool glint_describe_mesh(struct glint_describer *d);

/* describer.c: normalises X. Returns false if X is 0. */
bool glint_describe_unit(double x[3]);

/* Copies WORD, a file name, to NAME. */
#define GLINT_FILE_BYTES (GLINT_LINE_BYTES + 1)
void glint_describe_file(const struct glint_word *word,
                         char name[GLINT_FILE_BYTES]);

/* Sets the error of a failed file access from STATUS and the error text of
 * FILES. Returns false. */
bool glint_describe_refuse(struct glint_describer *d,
                           struct glint_text_place place,
                           enum glint_status status);

#endif
