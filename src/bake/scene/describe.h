/* SPDX-License-Identifier: MIT
 *
 * Internal header of the parser of scene texts. Each function parses one type
 * of line, from its second word on; if the line is invalid, it sets an error
 * and returns false.
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
    /* status of a failure that is not an error in the text, such as lack of
     * memory */
    enum glint_status status;
    int capacity; /* number of triangles for which memory is allocated */
    /* position of the line "camera", which is evaluated after all other lines,
     * as it depends on the line "hand" */
    struct glint_text_place camera;
    /* position in the text of the line "background" */
    struct glint_text_place background;
    double toward[3], up[3], orbit[3], distance, yaw_deg, pitch_deg;
    bool has_orbit;
    /* position of the word "sensor" in the line "camera" */
    struct glint_text_place sensor;
    /* position in the text of the first lamp that is attached to a motion, and
     * the name of that motion */
    struct glint_text_place rides;
    char rides_on[GLINT_DESCRIPTION_NAME_BYTES];
    uint32_t named_lights; /* bit I: light I has a clause "name" */
};

/* describe_motion.c: parses the line "motion"; glint_describe_check_sensors()
 * checks its sensors after all lines were parsed */
bool glint_describe_parse_motion(struct glint_describer *d);
bool glint_describe_check_sensors(struct glint_describer *d);

/* describe_things.c: appends an object of KIND. Returns NULL if there are too
 * many objects, or the name is reserved or already used; the error then refers
 * to PLACE. */
struct glint_described_object *
glint_describe_append_object(struct glint_describer *d,
                             enum glint_described_kind kind, const char *name,
                             struct glint_text_place place);

/* describe_view.c: parse the lines "hand", "camera", "background", "shadow" and
 * "flare" */
bool glint_describe_parse_hand(struct glint_describer *d);
bool glint_describe_parse_camera(struct glint_describer *d);
bool glint_describe_parse_background(struct glint_describer *d);
bool glint_describe_parse_shadow(struct glint_describer *d);
bool glint_describe_parse_flare(struct glint_describer *d);
/* Computes position and axes of the camera after all lines were parsed. */
bool glint_describe_set_camera_axes(struct glint_describer *d);

/* describe_looks.c: parse the lines "light", "texture" and "material" */
bool glint_describe_parse_light(struct glint_describer *d);
bool glint_describe_parse_texture(struct glint_describer *d);
bool glint_describe_parse_material(struct glint_describer *d);
/* Sets INDEX to the index of the material with the name WORD. */
bool glint_describe_find_material(struct glint_describer *d,
                                  const struct glint_word *word, int *index);

/* Checks object O, the last one defined, if its material is translucent.
 * Rejects the object if its texture coordinates cannot map the surface to a
 * texture; warns if the mapping is stretched. PLACE: position of the material's
 * name. */
bool glint_describe_check_translucent_object(
    struct glint_describer *d, const struct glint_described_object *o,
    struct glint_text_place place);

/* describe_around.c: parses the line "environment";
 * glint_describe_add_environment_lights() adds the lights of environments after
 * all lines were parsed */
bool glint_describe_parse_environment(struct glint_describer *d);
bool glint_describe_add_environment_lights(struct glint_describer *d);

/* describe_things.c: parse the lines "sphere", "triangle", "plane" and
 * "mesh" */
bool glint_describe_parse_sphere(struct glint_describer *d);
bool glint_describe_parse_triangle(struct glint_describer *d);
bool glint_describe_parse_plane(struct glint_describer *d);
bool glint_describe_parse_mesh(struct glint_describer *d);

/* describer.c: scales vector X to length 1. Returns false if X is 0. */
bool glint_describe_normalise_vector(double x[3]);

/* Copies the file name WORD to NAME. */
#define GLINT_FILE_BYTES (GLINT_LINE_BYTES + 1)
void glint_describe_copy_file_name(const struct glint_word *word,
                                   char name[GLINT_FILE_BYTES]);

/* Sets the error for a file that could not be read. Uses the error text of the
 * caller's file reader, or that of STATUS if the reader has set none. Returns
 * false. */
bool glint_describe_set_file_error(struct glint_describer *d,
                                   struct glint_text_place place,
                                   enum glint_status status);

#endif
