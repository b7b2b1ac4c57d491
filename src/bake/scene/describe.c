/* SPDX-License-Identifier: MIT
 *
 * Parses a scene text line by line.
 */
#include "bake/scene/describe.h"

#include <stdlib.h>
#include <string.h>

static const struct glint_text_line lines[] = {
    {"hand", false},       {"camera", false}, {"background", false},
    {"environment", true}, {"light", true},   {"texture", true},
    {"material", true},    {"sphere", true},  {"triangle", true},
    {"plane", true},       {"mesh", true},    {"motion", false},
    {"shadow", false},     {"flare", false}};

enum { N_LINES = sizeof lines / sizeof *lines };

static bool (*const read[N_LINES])(struct glint_describer *) = {
    glint_describe_parse_hand,       glint_describe_parse_camera,
    glint_describe_parse_background, glint_describe_parse_environment,
    glint_describe_parse_light,      glint_describe_parse_texture,
    glint_describe_parse_material,   glint_describe_parse_sphere,
    glint_describe_parse_triangle,   glint_describe_parse_plane,
    glint_describe_parse_mesh,       glint_describe_parse_motion,
    glint_describe_parse_shadow,     glint_describe_parse_flare};

enum glint_status
glint_description_parse(struct glint_description *scene, const char *text,
                        size_t bytes, const char *file_name,
                        const struct glint_description_files *files,
                        struct glint_error *error)
{
    struct glint_describer d = {.scene = scene,
                                .files = files,
                                .error = error,
                                .status = GLINT_E_LENS,
                                .up = {0, 1, 0}};
    int first[N_LINES] = {0};
    bool good;

    memset(scene, 0, sizeof *scene);
    scene->camera.fov_deg = 53.0;
    scene->motion.camera = -1;
    good = glint_text_open(&d.text, text, bytes, file_name, error);
    while (good && glint_text_next_line(&d.text)) {
        int i;

        good = glint_line_read_first_word(&d.text, lines, N_LINES, first, &i) &&
               (i < 0 || read[i](&d));
    }
    good = good && glint_describe_set_camera_axes(&d) &&
           glint_describe_add_environment_lights(&d) &&
           glint_describe_check_sensors(&d);
    if (good && !scene->n_objects)
        good = glint_text_set_error(
            &d.text, glint_text_get_end_place(&d.text),
            "the scene has no object; add a sphere, triangle, "
            "plane, mesh or motion");
    if (good)
        return GLINT_OK;
    glint_description_free(scene);
    return d.status;
}

void glint_description_free(struct glint_description *scene)
{
    for (int i = 0; i < scene->n_textures; i++)
        free(scene->texture[i].image.plane[0]);
    free(scene->triangle);
    for (int i = 0; i < scene->n_stones; i++)
        free(scene->stone[i].data);
    for (int i = 0; i < scene->n_environments; i++)
        free(scene->environment[i].data);
    free(scene->motion.data);
    memset(scene, 0, sizeof *scene);
}
