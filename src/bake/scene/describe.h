/* SPDX-License-Identifier: MIT
 *
 * Shared by the readers of a scene's lines. Each reads one type of line after
 * its keyword, and returns false if it has written an error. */
#ifndef GLINT_BAKE_SCENE_DESCRIBE_H
#define GLINT_BAKE_SCENE_DESCRIBE_H

#include "bake/scene/clauses.h"
#include "glint/scene/description.h"

struct glint_describer {
    struct glint_text text;
    struct glint_description *scene;
    const struct glint_description_files *files;
    struct glint_error *error;
    enum glint_status status; /* of a failure that is not the text's */
    int room;                 /* triangles that there is memory for */
    /* Position of the camera's line, which is evaluated when the handedness is
     * known. */
    struct glint_text_place camera;
    struct glint_text_place background; /* of its word */
    double toward[3], up[3], orbit[3], distance, yaw_deg, pitch_deg;
    bool has_orbit;
    struct glint_text_place sensor; /* of the camera's */
    struct glint_text_place rides;  /* of the first lamp that rides */
    char rides_on[GLINT_DESCRIPTION_NAME_BYTES];
};

/* describe_motion.c: reads the motion; the further functions run once all lines
 * are read. */
bool glint_describe_motion(struct glint_describer *d);
bool glint_describe_sensors(struct glint_describer *d);

/* describe_things.c: appends an object of KIND. Returns NULL if there are too
 * many objects or the name is used; the error is at PLACE and calls the object
 * WHAT. */
struct glint_described_object *
glint_describe_thing(struct glint_describer *d, enum glint_described_kind kind,
                     const char *name, struct glint_text_place place);

/* describe_view.c: hand, camera, background, shadow, flare. */
bool glint_describe_hand(struct glint_describer *d);
bool glint_describe_camera(struct glint_describer *d);
bool glint_describe_background(struct glint_describer *d);
bool glint_describe_shadow(struct glint_describer *d);
bool glint_describe_flare(struct glint_describer *d);
/* Computes position and direction of the camera, when all lines are read. */
bool glint_describe_axes(struct glint_describer *d);

/* describe_looks.c: light, texture, material. */
bool glint_describe_light(struct glint_describer *d);
bool glint_describe_texture(struct glint_describer *d);
bool glint_describe_material(struct glint_describer *d);
/* Sets INDEX to the material called WORD. */
bool glint_describe_find(struct glint_describer *d,
                         const struct glint_word *word, int *index);

/* Rejects the object O, defined last, if it is translucent and cannot be mapped
 * to the texels of a map; PLACE is the position of its material. Warns of
 * stretch. */
bool glint_describe_skin(struct glint_describer *d,
                         const struct glint_described_object *o,
                         struct glint_text_place place);

/* describe_around.c: environment; and its lights, when all lines are read. */
bool glint_describe_environment(struct glint_describer *d);
bool glint_describe_around(struct glint_describer *d);

/* describe_things.c: sphere, triangle, plane, mesh. */
bool glint_describe_sphere(struct glint_describer *d);
bool glint_describe_triangle(struct glint_describer *d);
bool glint_describe_plane(struct glint_describer *d);
bool glint_describe_mesh(struct glint_describer *d);

/* describer.c: makes X a unit vector; returns false if it has no direction. */
bool glint_describe_unit(double x[3]);

/* Copies WORD, the name of a file, to NAME. */
#define GLINT_FILE_BYTES (GLINT_LINE_BYTES + 1)
void glint_describe_file(const struct glint_word *word,
                         char name[GLINT_FILE_BYTES]);

/* Fails because FILES failed, with their STATUS and error text. */
bool glint_describe_refuse(struct glint_describer *d,
                           struct glint_text_place place,
                           enum glint_status status);

#endif
