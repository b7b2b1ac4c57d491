/* SPDX-License-Identifier: MIT
 *
 * Parses the lines "light", "texture" and "material". Materials are Ward
 * metals, translucent media or Phong.
 */
#include "bake/scene/describe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/scene/texels.h"
#include "glint/scene/translucent.h"
#include "glint/view.h"

/* tolerance for rounding errors where the sum of colours or weights must be at
 * most 1 */
#define SLACK 1e-9

/* ------------------------------------------------------------------- metal */

static bool read_ward_norm(struct glint_describer *d,
                           const struct glint_word *word,
                           struct glint_described_material *m)
{
    char quote[GLINT_QUOTE_BYTES];

    m->norm = glint_word_equals(word, "1992") ? GLINT_DESCRIBED_1992
                                              : GLINT_DESCRIBED_BOUNDED;
    return glint_word_equals(word, "1992") ||
           glint_word_equals(word, "bounded") ||
           glint_text_set_error(&d->text, word->place,
                                "'norm' must be bounded or 1992, not '%s'",
                                glint_word_quote(word, quote));
}

/* Raises the smaller one of the two Ward alphas to 1/10 of the larger one, with
 * a warning. */
static void limit_ward_alpha_ratio(struct glint_describer *d,
                                   struct glint_described_material *m)
{
    const int smaller = m->alpha[0] > m->alpha[1];
    const double least = m->alpha[1 - smaller] / GLINT_DESCRIPTION_MAX_RATIO;

    if (m->alpha[smaller] >= least * (1 - SLACK))
        return;
    if (!d->scene->warning[0])
        snprintf(d->scene->warning, sizeof d->scene->warning,
                 "material %s: the ratio of the alphas %.4g and %.4g is "
                 "limited to %d: the smaller is set to %.4g",
                 m->name, m->alpha[0], m->alpha[1], GLINT_DESCRIPTION_MAX_RATIO,
                 least);
    m->alpha[smaller] = least;
}

/* Parses NORM, the name of the Ward lobe's normalisation, if any. Limits the
 * ratio of the material's alphas. */
static bool read_ward_lobe(struct glint_describer *d,
                           struct glint_described_material *m,
                           const struct glint_word *norm)
{
    if (norm->length && !read_ward_norm(d, norm, m))
        return false;
    limit_ward_alpha_ratio(d, m);
    return true;
}

/* Parses a Ward material from the word "ward" on. TEXTURE receives the name of
 * its texture, if any. */
static bool read_ward_material(struct glint_describer *d,
                               struct glint_described_material *m,
                               struct glint_word *texture)
{
    struct glint_word norm = {0};
    struct glint_clause clause[] = {
        {"ward", .n = 0},
        {"specular", 3, 0, 1, .value = m->metal, .required = true},
        {"alpha", 2, .001, 1, .value = m->alpha, .required = true},
        {"diffuse", 3, 0, 1, .value = m->colour},
        {"norm", .name = &norm},
        {"texture", .name = texture},
        {0}};

    m->is_metal = true;
    m->diffuse = 1;
    for (int c = 0; c < 3; c++)
        m->colour[c] = 0;
    if (!glint_clauses_read(&d->text, "material", clause))
        return false;
    for (int c = 0; c < 3; c++)
        if (m->colour[c] + m->metal[c] > 1 + SLACK)
            return glint_text_set_error(
                &d->text, clause[1].place,
                "'diffuse' and 'specular' sum to %.6g; above 1 the surface "
                "would reflect more light than it receives",
                m->colour[c] + m->metal[c]);
    return read_ward_lobe(d, m, &norm);
}

/* Limits for the warning about stretched texels. MOST_STRETCH: texel size /
 * mean texel size of the mesh. STRETCHED_AREA: fraction of the surface on which
 * MOST_STRETCH is exceeded. */
#define MOST_STRETCH   1.5
#define STRETCHED_AREA .02

/* -------------------------------------------------------------------
 * translucent medium */

static bool read_translucent_file(struct glint_describer *d,
                                  const struct glint_word *word,
                                  struct glint_described_material *m)
{
    struct glint_description *s = d->scene;
    struct glint_described_stone *stone = &s->stone[s->n_stones];
    struct glint_translucent opened;
    char name[GLINT_FILE_BYTES];
    const char *reason = "";
    enum glint_status status;

    if (s->n_stones == GLINT_DESCRIPTION_MAX_STONES)
        return glint_text_set_error(&d->text, word->place,
                                    "more than %d translucent materials",
                                    GLINT_DESCRIPTION_MAX_STONES);
    if (!d->files->stone)
        return glint_text_set_error(
            &d->text, word->place,
            "this program cannot read translucent materials");
    glint_describe_copy_file_name(word, name);
    status = d->files->stone(d->files->ctx, name, &stone->data, &stone->bytes,
                             d->error);
    if (status != GLINT_OK)
        return glint_describe_set_file_error(d, word->place, status);
    m->stone = s->n_stones++;
    return glint_translucent_open(&opened, stone->data, stone->bytes,
                                  &reason) == GLINT_OK ||
           glint_text_set_error(&d->text, word->place, "%s", reason);
}

static bool read_fresnel_switch(struct glint_describer *d,
                                const struct glint_word *word,
                                struct glint_described_material *m)
{
    char quote[GLINT_QUOTE_BYTES];

    m->fresnel = !glint_word_equals(word, "off");
    return glint_word_equals(word, "on") || glint_word_equals(word, "off") ||
           glint_text_set_error(&d->text, word->place,
                                "'fresnel' must be on or off, not '%s'",
                                glint_word_quote(word, quote));
}

/* Parses a translucent material from the word "translucent" on. */
static bool read_translucent_material(struct glint_describer *d,
                                      struct glint_described_material *m,
                                      struct glint_word *texture)
{
    struct glint_word coat = {0}, norm = {0}, fresnel = {0}, file;
    struct glint_clause clause[] = {{"coat", .name = &coat},
                                    {"specular", 3, 0, 1, .value = m->metal},
                                    {"alpha", 2, .001, 1, .value = m->alpha},
                                    {"norm", .name = &norm},
                                    {"fresnel", .name = &fresnel},
                                    {"colour", 3, 0, 1, .value = m->colour},
                                    {0}};
    char quote[GLINT_QUOTE_BYTES];

    (void)texture; /* a translucent medium contains its own texture */
    m->is_stone = m->fresnel = true;
    glint_text_next_word(&d->text); /* skips the word "translucent" */
    file = glint_text_next_word(&d->text);
    if (!file.length)
        return glint_text_set_error(
            &d->text, file.place, "the file name is missing: translucent FILE");
    if (!glint_clauses_read(&d->text, "material", clause) ||
        (fresnel.length && !read_fresnel_switch(d, &fresnel, m)) ||
        !read_translucent_file(d, &file, m))
        return false;
    m->is_metal = coat.length > 0;
    if (m->is_metal && !glint_word_equals(&coat, "ward"))
        return glint_text_set_error(&d->text, coat.place,
                                    "'coat' must be ward, not '%s'",
                                    glint_word_quote(&coat, quote));
    for (int i = 1; i <= 3; i++)
        if (clause[i].place.line && !m->is_metal)
            return glint_text_set_error(&d->text, clause[i].place,
                                        "'%s' needs 'coat ward'",
                                        clause[i].word);
    for (int i = 1; i <= 2; i++)
        if (!clause[i].place.line && m->is_metal)
            return glint_text_set_error(
                &d->text, coat.place, "'coat ward' needs '%s'", clause[i].word);
    return !m->is_metal || read_ward_lobe(d, m, &norm);
}

/* ------------------------------------------------------------------ objects */

/* Measures how triangle T stretches its texture: a unit vector of texture space
 * (u, v) has a length of SHORTEST to LONGEST on T. Returns the area of T; 0 if
 * its area in (u, v) is 0. */
static double compute_texel_stretch(const struct glint_described_triangle *t,
                                    double *shortest, double *longest)
{
    const double du[2] = {t->uv[1][0] - t->uv[0][0], t->uv[2][0] - t->uv[0][0]};
    const double dv[2] = {t->uv[1][1] - t->uv[0][1], t->uv[2][1] - t->uv[0][1]};
    const double det = du[0] * dv[1] - du[1] * dv[0];
    double uu = 0, uv = 0, vv = 0, mean, off;

    if (!(fabs(det) > 1e-12))
        return 0;
    for (int k = 0; k < 3; k++) {
        const double a = t->place[1][k] - t->place[0][k];
        const double b = t->place[2][k] - t->place[0][k];
        const double along_u = (a * dv[1] - b * dv[0]) / det;
        const double along_v = (b * du[0] - a * du[1]) / det;

        uu += along_u * along_u;
        uv += along_u * along_v;
        vv += along_v * along_v;
    }
    mean = (uu + vv) / 2;
    off = hypot((uu - vv) / 2, uv);
    *longest = sqrt(mean + off);
    *shortest = sqrt(fmax(mean - off, 0));
    return *longest * *shortest * fabs(det) / 2;
}

/* Warns if the size of texels varies too much over a mesh. */
static void check_mesh_stretch(struct glint_describer *d,
                               const struct glint_described_object *o,
                               int material)
{
    const struct glint_description *s = d->scene;
    const struct glint_described_triangle *t = s->triangle + o->first_triangle;
    double area = 0, square = 0, worst = 1, stretched = 0, mean;

    for (int pass = 0; pass < 2; pass++) {
        mean = pass && square > 0 ? sqrt(area / square) : 1;
        for (int i = 0; i < o->n_triangles; i++) {
            double shortest = 1, longest = 1, of, here;

            if (t[i].material != material)
                continue;
            of = compute_texel_stretch(&t[i], &shortest, &longest);
            here = fmax(longest / mean, mean / fmax(shortest, 1e-30));
            if (!pass && of > 0) {
                area += of;
                square += of / (longest * shortest);
            } else if (of > 0 && here > MOST_STRETCH) {
                worst = fmax(worst, here);
                stretched += of;
            }
        }
    }
    if (stretched > STRETCHED_AREA * area && !d->scene->warning[0])
        snprintf(d->scene->warning, sizeof d->scene->warning,
                 "mesh %s: its texels are stretched up to %.3g times, and "
                 "above 1.5 times on %.0f %% of its area: light spreads "
                 "farther there by this factor",
                 o->name, worst, 100 * stretched / area);
}

/* Checks triangle T of a translucent object. FIRST: index of the translucent
 * material of the triangles before T; -1: there is none. */
static bool check_translucent_triangle(struct glint_describer *d,
                                       const struct glint_described_triangle *t,
                                       struct glint_text_place place,
                                       int *first)
{
    const struct glint_described_material *m = &d->scene->material[t->material];

    if (!t->has_uv)
        return glint_text_set_error(
            &d->text, place,
            "material %s is translucent, but a face has no "
            "texture coordinates (uv, vt)",
            m->name);
    if (*first >= 0 && *first != t->material)
        return glint_text_set_error(
            &d->text, place,
            "materials %s and %s are both translucent: a "
            "mesh can have one translucent material",
            d->scene->material[*first].name, m->name);
    *first = t->material;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++)
            if (t->uv[k][i] < -1e-6 || t->uv[k][i] > 1 + 1e-6)
                return glint_text_set_error(
                    &d->text, place,
                    "u and v of a translucent mesh must be 0 to 1, not %.4g: "
                    "its map does not repeat",
                    t->uv[k][i]);
    return true;
}

bool glint_describe_check_translucent_object(
    struct glint_describer *d, const struct glint_described_object *o,
    struct glint_text_place place)
{
    const struct glint_description *s = d->scene;
    int first = -1;

    if (o->kind == GLINT_DESCRIBED_PLANE && s->material[o->material].is_stone)
        return glint_text_set_error(
            &d->text, place,
            "an infinite plane cannot be translucent: use a "
            "sphere or a mesh with uv");
    for (int i = 0; i < o->n_triangles; i++) {
        const struct glint_described_triangle *t =
            &s->triangle[o->first_triangle + i];

        if (s->material[t->material].is_stone &&
            !check_translucent_triangle(d, t, place, &first))
            return false;
    }
    if (first >= 0)
        check_mesh_stretch(d, o, first);
    return true;
}

/* ------------------------------------------------------------------- light */

#define MAX_LIGHT 1e9
#define REACH     GLINT_DESCRIPTION_REACH
/* default angular radius of a sun, degrees */
#define SUN_DEG 0.267

/* Light of a sun on a white surface, display white, below which it changes no
 * 8-bit code, and above which it saturates nearly all colours. */
#define FAINT_SUN  (1. / 256)
#define BRIGHT_SUN 10.

/* Warns if the light of SUN on a surface is far from display white, which often
 * means that its colour is an irradiance or that its radius was changed. */
static void check_sun_light(struct glint_describer *d,
                            const struct glint_described_light *sun)
{
    const double sine = sin(sun->radius_deg * GLINT_PI / 180);
    const double most =
        fmax(sun->colour[0], fmax(sun->colour[1], sun->colour[2]));
    const double white = most * sine * sine;

    if (white > 0 && (white < FAINT_SUN || white > BRIGHT_SUN) &&
        !d->scene->warning[0])
        snprintf(
            d->scene->warning, sizeof d->scene->warning,
            "light sun: it lights a white surface to %.2g times display "
            "white; a colour of %.3g at this radius, or 'white 1 1 1' at any, "
            "lights it to 1",
            white, most / white);
}

/* Returns the index of the light NAME among the lights before LIGHT, or -1. */
static int find_light_index(const struct glint_description *s,
                            const struct glint_described_light *light,
                            const char *name)
{
    for (int i = 0; s->light + i < light; i++)
        if (strcmp(s->light[i].name, name) == 0)
            return i;
    return -1;
}

/* Sets the name of LIGHT: WORD, or without one its kind, plus a number from the
 * second light of this kind on: "sun", "lamp", "lamp2". */
static bool set_light_name(struct glint_describer *d,
                           struct glint_described_light *light,
                           const struct glint_word *word)
{
    const struct glint_description *s = d->scene;
    const char *kind = light->kind == GLINT_DESCRIBED_SUN ? "sun" : "lamp";
    bool is_used;

    snprintf(light->name, sizeof light->name, "%s", kind);
    if (!word->length) {
        for (int n = 2; find_light_index(s, light, light->name) >= 0; n++)
            snprintf(light->name, sizeof light->name, "%s%d", kind, n);
        return true;
    }
    if (!glint_name_copy(&d->text, word, light->name, sizeof light->name))
        return false;
    is_used = strcmp(light->name, "camera") == 0 ||
              strncmp(light->name, "environment", 11) == 0 ||
              find_light_index(s, light, light->name) >= 0;
    for (int i = 0; i < s->n_objects; i++)
        is_used |= strcmp(s->object[i].name, light->name) == 0;
    d->named_lights |= 1u << (light - s->light);
    return !is_used ||
           glint_text_set_error(&d->text, word->place,
                                "the name is that of another light or "
                                "object, or begins with 'environment'");
}

static bool read_sun_light(struct glint_describer *d,
                           struct glint_described_light *light)
{
    struct glint_word name = {0};
    double white[3] = {0}, sine;
    struct glint_clause clause[] = {
        {"direction", 3, -REACH, REACH, .value = light->at, .required = true},
        {"colour", 3, 0, MAX_LIGHT, .value = light->colour},
        {"white", 3, 0, MAX_LIGHT, .value = white},
        {"radius", 1, 0.01, 30, .value = &light->radius_deg},
        {"name", .name = &name},
        {0}};

    light->kind = GLINT_DESCRIBED_SUN;
    light->radius_deg = SUN_DEG;
    if (!glint_clauses_read(&d->text, "light sun", clause))
        return false;
    if (!clause[1].place.line == !clause[2].place.line)
        return glint_text_set_error(&d->text,
                                    clause[clause[2].place.line ? 2 : 0].place,
                                    "light sun needs 'colour' or 'white'%s",
                                    clause[2].place.line ? ", not both" : "");
    sine = sin(light->radius_deg * GLINT_PI / 180);
    for (int k = 0; clause[2].place.line && k < 3; k++)
        light->colour[k] = white[k] / (sine * sine);
    check_sun_light(d, light);
    if (!glint_describe_normalise_vector(light->at))
        return glint_text_set_error(
            &d->text, clause[0].place,
            "the direction to the sun must not be 0 0 0");
    return set_light_name(d, light, &name);
}

static bool attach_light_to_motion(struct glint_describer *d,
                                   const struct glint_described_light *light,
                                   const struct glint_word *word,
                                   struct glint_text_place place)
{
    char name[GLINT_FILE_BYTES];

    glint_describe_copy_file_name(word, name);
    if (d->rides.line && strcmp(d->rides_on, name) != 0)
        return glint_text_set_error(&d->text, place,
                                    "a scene has at most one motion");
    d->rides = place;
    snprintf(d->rides_on, sizeof d->rides_on, "%.31s", name);
    d->scene->motion.riders |= 1u << (light - d->scene->light);
    return true;
}

static bool read_lamp_light(struct glint_describer *d,
                            struct glint_described_light *light)
{
    struct glint_word on = {0}, name = {0};
    struct glint_clause clause[] = {
        {"at", 3, -REACH, REACH, .value = light->at, .required = true},
        {"colour", 3, 0, MAX_LIGHT, .value = light->colour, .required = true},
        {"radius", 1, 0, REACH, .value = &light->radius},
        {"on", .name = &on},
        {"name", .name = &name},
        {0}};

    light->kind = GLINT_DESCRIBED_LAMP;
    return glint_clauses_read(&d->text, "light lamp", clause) &&
           set_light_name(d, light, &name) &&
           (!clause[3].place.line ||
            attach_light_to_motion(d, light, &on, clause[3].place));
}

bool glint_describe_parse_light(struct glint_describer *d)
{
    struct glint_description *s = d->scene;
    struct glint_described_light *light = &s->light[s->n_lights];
    const struct glint_word word = glint_text_next_word(&d->text);
    char quote[GLINT_QUOTE_BYTES];
    bool good;

    if (s->n_lights == GLINT_DESCRIPTION_TEXT_LIGHTS)
        return glint_text_set_error(&d->text, word.place, "more than %d lights",
                                    GLINT_DESCRIPTION_TEXT_LIGHTS);
    if (!glint_word_equals(&word, "sun") && !glint_word_equals(&word, "lamp"))
        return word.length
                   ? glint_text_set_error(
                         &d->text, word.place,
                         "a light must be a sun or a lamp, not '%s'",
                         glint_word_quote(&word, quote))
                   : glint_text_set_error(&d->text, word.place,
                                          "a light must be a sun or a lamp");
    good = glint_word_equals(&word, "sun") ? read_sun_light(d, light)
                                           : read_lamp_light(d, light);
    s->n_lights++;
    return good;
}

static int64_t count_scene_texels(const struct glint_description *s)
{
    int64_t n = 0;

    for (int i = 0; i < s->n_textures; i++)
        n += (int64_t)s->texture[i].image.width * s->texture[i].image.height;
    return n;
}

bool glint_describe_parse_texture(struct glint_describer *d)
{
    struct glint_description *s = d->scene;
    struct glint_described_texture *t = &s->texture[s->n_textures];
    struct glint_text at = d->text;
    struct glint_word word = glint_text_next_word(&at);
    char name[GLINT_FILE_BYTES];
    enum glint_status status;

    if (s->n_textures == GLINT_DESCRIPTION_MAX_TEXTURES)
        return glint_text_set_error(&d->text, word.place,
                                    "more than %d textures",
                                    GLINT_DESCRIPTION_MAX_TEXTURES);
    if (!glint_name_read(&d->text, "texture", t->name, sizeof t->name))
        return false;
    for (int i = 0; i < s->n_textures; i++)
        if (strcmp(s->texture[i].name, t->name) == 0)
            return glint_text_set_error(
                &d->text, word.place,
                "a texture of this name is already defined");
    word = glint_text_next_word(&d->text);
    if (!word.length)
        return glint_text_set_error(
            &d->text, word.place,
            "the file name is missing: texture NAME FILE");
    if (!glint_line_check_end(&d->text, "texture"))
        return false;
    glint_describe_copy_file_name(&word, name);
    status = d->files->picture(d->files->ctx, name, &t->image, d->error);
    if (status != GLINT_OK)
        return glint_describe_set_file_error(d, word.place, status);
    s->n_textures++;
    d->status = glint_texels_resize_to_powers_of_two(
        &t->image, GLINT_DESCRIPTION_MAX_SIDE);
    if (d->status != GLINT_OK)
        return glint_describe_set_file_error(d, word.place, d->status);
    d->status = GLINT_E_LENS;
    if (count_scene_texels(s) > GLINT_DESCRIPTION_MAX_TEXELS)
        return glint_text_set_error(&d->text, word.place,
                                    "more than %d texels in all textures",
                                    GLINT_DESCRIPTION_MAX_TEXELS);
    return true;
}

/* ---------------------------------------------------------------- material */

static bool find_texture_index(struct glint_describer *d,
                               const struct glint_word *word, int *index)
{
    const struct glint_description *s = d->scene;

    return glint_name_find_index(&d->text, word, "texture", s->texture[0].name,
                                 sizeof *s->texture, s->n_textures, index);
}

bool glint_describe_find_material(struct glint_describer *d,
                                  const struct glint_word *word, int *index)
{
    const struct glint_description *s = d->scene;

    return glint_name_find_index(&d->text, word, "material",
                                 s->material[0].name, sizeof *s->material,
                                 s->n_materials, index);
}

/* Checks that the fractions of light that a material reflects sum to at most
 * 1. */
static bool check_reflected_fractions(struct glint_describer *d,
                                      const struct glint_described_material *m,
                                      const struct glint_clause *clause)
{
    const double sum = m->ambient + m->diffuse + m->specular;

    if (sum > 1 + SLACK)
        return glint_text_set_error(
            &d->text, clause[0].place,
            "the weights of phong sum to %.6g; above 1 the surface would "
            "reflect more light than it receives",
            sum);
    if (m->reflect + m->pass > 1 + SLACK)
        return glint_text_set_error(
            &d->text, clause[4].place,
            "'reflect' and 'pass' sum to %.6g; above 1 the "
            "surface would emit more light than it receives",
            m->reflect + m->pass);
    if (clause[6].place.line && !(m->pass > 0))
        return glint_text_set_error(&d->text, clause[6].place,
                                    "'refract' needs a 'pass' above 0");
    if (sum < 1 - SLACK && !(m->reflect > 0 || m->pass > 0) &&
        !d->scene->warning[0])
        snprintf(d->scene->warning, sizeof d->scene->warning,
                 "material %s: the weights of phong sum to %.6g; the surface "
                 "absorbs the rest",
                 m->name, sum);
    return true;
}

/* Parses a Phong material from the word "phong" on. TEXTURE receives the name
 * of its texture, if any. */
static bool read_phong_material(struct glint_describer *d,
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
    return check_reflected_fractions(d, m, clause);
}

bool glint_describe_parse_material(struct glint_describer *d)
{
    struct glint_description *s = d->scene;
    struct glint_described_material *m = &s->material[s->n_materials];
    struct glint_text at = d->text;
    const struct glint_text_place place = glint_text_next_word(&at).place;
    const struct glint_word kind = glint_text_next_word(&at);
    struct glint_word texture = {0};

    if (s->n_materials == GLINT_DESCRIPTION_MAX_MATERIALS)
        return glint_text_set_error(&d->text, place, "more than %d materials",
                                    GLINT_DESCRIPTION_MAX_MATERIALS);
    *m = (struct glint_described_material){
        .power = 32, .colour = {1, 1, 1}, .texture = -1, .index = 1};
    if (!glint_name_read(&d->text, "material", m->name, sizeof m->name))
        return false;
    for (int i = 0; i < s->n_materials; i++)
        if (strcmp(s->material[i].name, m->name) == 0)
            return glint_text_set_error(&d->text, place,
                                        "a material of this name is already "
                                        "defined");
    if (!(glint_word_equals(&kind, "ward") ? read_ward_material
          : glint_word_equals(&kind, "translucent")
              ? read_translucent_material
              : read_phong_material)(d, m, &texture) ||
        (texture.length && !find_texture_index(d, &texture, &m->texture)))
        return false;
    s->n_materials++;
    return true;
}
