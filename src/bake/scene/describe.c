/* SPDX-License-Identifier: MIT
 *
 * Reads a scene text line by line. */
#include "bake/scene/describe.h"

#include <stdlib.h>
#include <string.h>

#include "bake/scene/near.h"

static const struct line {
    const char *word;
    bool (*read)(struct glint_describer *);
    bool once;
} lines[] = {
    {"hand", glint_describe_hand, true},
    {"camera", glint_describe_camera, true},
    {"background", glint_describe_background, true},
    {"environment", glint_describe_environment, false},
    {"light", glint_describe_light, false},
    {"texture", glint_describe_texture, false},
    {"material", glint_describe_material, false},
    {"sphere", glint_describe_sphere, false},
    {"triangle", glint_describe_triangle, false},
    {"plane", glint_describe_plane, false},
    {"mesh", glint_describe_mesh, false},
    {"motion", glint_describe_motion, true},
    {"shadow", glint_describe_shadow, true},
    {"flare", glint_describe_flare, true},
};

enum { N_LINES = sizeof lines / sizeof *lines };

static bool unknown(struct glint_describer *d, const struct glint_word *word)
{
    struct glint_near near = glint_near_begin(*word);
    char quote[GLINT_QUOTE_BYTES], mean[GLINT_NEAR_BYTES];

    glint_word_quote(word, quote);
    for (int i = 0; i < N_LINES; i++)
        glint_near_offer(&near, lines[i].word);
    return glint_text_fail(&d->text, word->place, "unknown word '%s'%s", quote,
                           glint_near_text(&near, mean));
}

/* Reads the line; FIRST has the number of the line on which each word that may
 * stand once was seen, or 0. */
static bool read_line(struct glint_describer *d, int first[N_LINES])
{
    const struct glint_word word = glint_text_next_word(&d->text);
    int i = 0;

    if (!word.length)
        return true;
    while (i < N_LINES && !glint_word_is(&word, lines[i].word))
        i++;
    if (i == N_LINES)
        return unknown(d, &word);
    if (lines[i].once && first[i])
        return glint_text_fail(&d->text, word.place,
                               "a second %s; the first is on line %d",
                               lines[i].word, first[i]);
    first[i] = word.place.line;
    return lines[i].read(d);
}

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
    while (good && glint_text_next_line(&d.text))
        good = read_line(&d, first);
    good = good && glint_describe_axes(&d) && glint_describe_around(&d) &&
           glint_describe_sensors(&d);
    if (good && !scene->n_objects)
        good =
            glint_text_fail(&d.text, glint_text_end(&d.text),
                            "there is no thing: sphere, triangle, plane, mesh "
                            "or motion");
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
