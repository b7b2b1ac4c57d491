/* SPDX-License-Identifier: MIT
 *
 * Lines on light and on how surfaces look. */
#include "bake/scene/describe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/scene/texels.h"
#include "glint/view.h"

#define MAX_LIGHT 1e9
#define REACH     GLINT_DESCRIPTION_REACH
/* Half of the sun's angle in the sky. */
#define SUN_DEG 0.267
/* What rounding may add to weights that sum to 1. */
#define SLACK 1e-9

/* Warns of a sun whose COLOUR was taken for the light that falls on things: no
 * code of 8 bits would show it. */
static void check_sun(struct glint_describer *d,
                      const struct glint_described_light *sun)
{
    const double sine = sin(sun->radius_deg * GLINT_PI / 180);
    const double most =
        fmax(sun->colour[0], fmax(sun->colour[1], sun->colour[2]));
    const double white = most * sine * sine;

    if (white > 0 && white < 1. / 256 && !d->scene->warning[0])
        snprintf(d->scene->warning, sizeof d->scene->warning,
                 "light sun: its colour is the radiance of a disc, and of this "
                 "radius %.3g lights a white surface to %.2g; %.3g would to 1",
                 most, white, most / white);
}

static bool read_sun(struct glint_describer *d,
                     struct glint_described_light *light)
{
    struct glint_clause clause[] = {
        {"direction", 3, -REACH, REACH, .value = light->at, .required = true},
        {"colour", 3, 0, MAX_LIGHT, .value = light->colour, .required = true},
        {"radius", 1, 0.01, 30, .value = &light->radius_deg},
        {0}};

    light->kind = GLINT_DESCRIBED_SUN;
    light->radius_deg = SUN_DEG;
    if (!glint_clauses_read(&d->text, "light sun", clause))
        return false;
    check_sun(d, light);
    return glint_describe_unit(light->at) ||
           glint_text_fail(&d->text, clause[0].place,
                           "the direction to the sun must not be 0 0 0");
}

/* Notes that LIGHT rides on the motion called WORD. */
static bool ride(struct glint_describer *d,
                 const struct glint_described_light *light,
                 const struct glint_word *word, struct glint_text_place place)
{
    char name[GLINT_FILE_BYTES];

    glint_describe_file(word, name);
    if (d->rides.line && strcmp(d->rides_on, name) != 0)
        return glint_text_fail(&d->text, place, "there is one motion at most");
    d->rides = place;
    snprintf(d->rides_on, sizeof d->rides_on, "%.31s", name);
    d->scene->motion.riders |= 1u << (light - d->scene->light);
    return true;
}

static bool read_lamp(struct glint_describer *d,
                      struct glint_described_light *light)
{
    struct glint_word on = {0};
    struct glint_clause clause[] = {
        {"at", 3, -REACH, REACH, .value = light->at, .required = true},
        {"colour", 3, 0, MAX_LIGHT, .value = light->colour, .required = true},
        {"radius", 1, 0, REACH, .value = &light->radius},
        {"on", .name = &on},
        {0}};

    light->kind = GLINT_DESCRIBED_LAMP;
    return glint_clauses_read(&d->text, "light lamp", clause) &&
           (!clause[3].place.line || ride(d, light, &on, clause[3].place));
}

/* Names LIGHT after its kind and, from the second on, its number. */
static void name_light(struct glint_description *s,
                       struct glint_described_light *light, const char *kind)
{
    int n = 1;

    for (const struct glint_described_light *l = s->light; l < light; l++)
        n += l->kind == light->kind;
    snprintf(light->name, sizeof light->name, n > 1 ? "%s%d" : "%s", kind, n);
}

bool glint_describe_light(struct glint_describer *d)
{
    struct glint_description *s = d->scene;
    struct glint_described_light *light = &s->light[s->n_lights];
    const struct glint_word word = glint_text_next_word(&d->text);
    char quote[GLINT_QUOTE_BYTES];
    bool good;

    if (s->n_lights == GLINT_DESCRIPTION_TEXT_LIGHTS)
        return glint_text_fail(&d->text, word.place, "more than %d lights",
                               GLINT_DESCRIPTION_TEXT_LIGHTS);
    if (!glint_word_is(&word, "sun") && !glint_word_is(&word, "lamp"))
        return word.length
                   ? glint_text_fail(&d->text, word.place,
                                     "a light is a sun or a lamp, not '%s'",
                                     glint_word_quote(&word, quote))
                   : glint_text_fail(&d->text, word.place,
                                     "a light is a sun or a lamp");
    good =
        glint_word_is(&word, "sun") ? read_sun(d, light) : read_lamp(d, light);
    name_light(s, light, light->kind == GLINT_DESCRIBED_SUN ? "sun" : "lamp");
    s->n_lights++;
    return good;
}

bool glint_describe_texture(struct glint_describer *d)
{
    struct glint_description *s = d->scene;
    struct glint_described_texture *t = &s->texture[s->n_textures];
    struct glint_text at = d->text;
    struct glint_word word = glint_text_next_word(&at);
    char name[GLINT_FILE_BYTES];
    enum glint_status status;

    if (s->n_textures == GLINT_DESCRIPTION_MAX_TEXTURES)
        return glint_text_fail(&d->text, word.place, "more than %d textures",
                               GLINT_DESCRIPTION_MAX_TEXTURES);
    if (!glint_name_read(&d->text, "texture", t->name, sizeof t->name))
        return false;
    for (int i = 0; i < s->n_textures; i++)
        if (strcmp(s->texture[i].name, t->name) == 0)
            return glint_text_fail(&d->text, word.place,
                                   "a texture of this name is already defined");
    word = glint_text_next_word(&d->text);
    if (!word.length)
        return glint_text_fail(&d->text, word.place,
                               "the texture's file is missing");
    if (!glint_line_ends(&d->text, "texture"))
        return false;
    glint_describe_file(&word, name);
    status = d->files->picture(d->files->ctx, name, &t->image, d->error);
    if (status != GLINT_OK)
        return glint_describe_refuse(d, word.place, status);
    s->n_textures++;
    d->status = glint_texels_fit(&t->image, GLINT_DESCRIPTION_MAX_SIDE);
    if (d->status != GLINT_OK)
        return glint_describe_refuse(d, word.place, d->status);
    d->status = GLINT_E_LENS;
    return true;
}

/* ---------------------------------------------------------------- material */

static bool find_texture(struct glint_describer *d,
                         const struct glint_word *word, int *index)
{
    const struct glint_description *s = d->scene;

    return glint_name_find(&d->text, word, "texture", s->texture[0].name,
                           sizeof *s->texture, s->n_textures, index);
}

bool glint_describe_find(struct glint_describer *d,
                         const struct glint_word *word, int *index)
{
    const struct glint_description *s = d->scene;

    return glint_name_find(&d->text, word, "material", s->material[0].name,
                           sizeof *s->material, s->n_materials, index);
}

/* Checks what the parts of a material give together. */
static bool check_shares(struct glint_describer *d,
                         const struct glint_described_material *m,
                         const struct glint_clause *clause)
{
    const double sum = m->ambient + m->diffuse + m->specular;

    if (sum > 1 + SLACK)
        return glint_text_fail(&d->text, clause[0].place,
                               "weights of phong sum to %.6g; more than 1 "
                               "would make light",
                               sum);
    if (m->reflect + m->pass > 1 + SLACK)
        return glint_text_fail(&d->text, clause[4].place,
                               "'reflect' and 'pass' sum to %.6g; more than 1 "
                               "would make light",
                               m->reflect + m->pass);
    if (clause[6].place.line && !(m->pass > 0))
        return glint_text_fail(&d->text, clause[6].place,
                               "'refract' needs a 'pass' above 0");
    if (sum < 1 - SLACK && !(m->reflect > 0 || m->pass > 0) &&
        !d->scene->warning[0])
        snprintf(d->scene->warning, sizeof d->scene->warning,
                 "material %s: weights of phong sum to %.6g, what is left to 1 "
                 "is dark",
                 m->name, sum);
    return true;
}

/* Reads a material's line from 'phong' on, as glint_describe_metal() does from
 * 'ward' on. */
static bool read_phong(struct glint_describer *d,
                       struct glint_described_material *m,
                       struct glint_word *texture)
{
    double phong[3] = {0};
    struct glint_clause clause[] = {
        {"phong", 3, 0, 1, .value = phong, .required = true},
        {"colour", 3, 0, 1, .value = m->colour},
        {"power", 1, 1, 4096, .value = &m->power},
        {"texture", .name = texture},
        {"reflect", 1, 0, 1, .value = &m->reflect},
        {"pass", 1, 0, 1, .value = &m->pass},
        {"refract", 1, 0.25, 4, .value = &m->index},
        {0}};

    if (!glint_clauses_read(&d->text, "material", clause))
        return false;
    m->ambient = phong[0];
    m->diffuse = phong[1];
    m->specular = phong[2];
    return check_shares(d, m, clause);
}

bool glint_describe_material(struct glint_describer *d)
{
    struct glint_description *s = d->scene;
    struct glint_described_material *m = &s->material[s->n_materials];
    struct glint_text at = d->text;
    const struct glint_text_place place = glint_text_next_word(&at).place;
    const struct glint_word kind = glint_text_next_word(&at);
    struct glint_word texture = {0};

    if (s->n_materials == GLINT_DESCRIPTION_MAX_MATERIALS)
        return glint_text_fail(&d->text, place, "more than %d materials",
                               GLINT_DESCRIPTION_MAX_MATERIALS);
    *m = (struct glint_described_material){
        .power = 32, .colour = {1, 1, 1}, .texture = -1, .index = 1};
    if (!glint_name_read(&d->text, "material", m->name, sizeof m->name))
        return false;
    for (int i = 0; i < s->n_materials; i++)
        if (strcmp(s->material[i].name, m->name) == 0)
            return glint_text_fail(&d->text, place,
                                   "a material of this name is already "
                                   "defined");
    if (!(glint_word_is(&kind, "ward")          ? glint_describe_metal
          : glint_word_is(&kind, "translucent") ? glint_describe_stone
                                                : read_phong)(d, m, &texture) ||
        (texture.length && !find_texture(d, &texture, &m->texture)))
        return false;
    s->n_materials++;
    return true;
}
