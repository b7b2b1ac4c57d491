/* SPDX-License-Identifier: MIT
 *
 * Parses the line "environment". The bright lights extracted from an
 * environment become suns of the scene.
 */
#include "bake/scene/describe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/scene/environment.h"
#include "glint/view.h"

/* min angular radius of an environment's light, degrees */
#define LEAST_DEG 0.01

/* Sets NAME to the base name of FILE without its extension, truncated if it is
 * too long; other characters than printable ASCII become _. */
static void set_environment_name(const char *file,
                                 char name[GLINT_DESCRIPTION_NAME_BYTES])
{
    const char *const folder = strrchr(file, '/');
    const char *const from = folder ? folder + 1 : file;
    const char *const dot = strrchr(from, '.');
    size_t n = dot && dot > from ? (size_t)(dot - from) : strlen(from);

    if (n > GLINT_DESCRIPTION_NAME_BYTES - 1)
        n = GLINT_DESCRIPTION_NAME_BYTES - 1;
    for (size_t i = 0; i < n; i++)
        name[i] = from[i] > ' ' && from[i] < 0x7f ? from[i] : '_';
    name[n] = '\0';
}

/* Appends an environment named after FILE. Returns NULL if there are too many
 * environments or the name is already used; the error then refers to PLACE. */
static struct glint_described_environment *
append_environment(struct glint_describer *d, const char *file,
                   struct glint_text_place place)
{
    struct glint_description *s = d->scene;
    struct glint_described_environment *e;

    if (s->n_environments == GLINT_DESCRIPTION_MAX_ENVIRONMENTS) {
        glint_text_set_error(&d->text, place, "more than %d environments",
                             GLINT_DESCRIPTION_MAX_ENVIRONMENTS);
        return NULL;
    }
    e = &s->environment[s->n_environments];
    set_environment_name(file, e->name);
    for (int i = 0; i < s->n_environments; i++)
        if (strcmp(s->environment[i].name, e->name) == 0) {
            glint_text_set_error(
                &d->text, place,
                "environment '%s' is already defined; rename one of both "
                "files",
                e->name);
            return NULL;
        }
    s->n_environments++;
    e->scale = 1;
    return e;
}

bool glint_describe_parse_environment(struct glint_describer *d)
{
    const struct glint_word word = glint_text_next_word(&d->text);
    double turn_deg = 0, scale = 1;
    struct glint_clause clause[] = {{"turn", 1, -360, 360, .value = &turn_deg},
                                    {"scale", 1, 1e-6, 1e6, .value = &scale},
                                    {0}};
    struct glint_described_environment *e;
    struct glint_environment opened;
    char name[GLINT_FILE_BYTES];
    const char *reason = "";
    enum glint_status status;

    if (!word.length)
        return glint_text_set_error(
            &d->text, word.place, "the file name is missing: environment FILE");
    if (!glint_clauses_read(&d->text, "environment", clause))
        return false;
    glint_describe_copy_file_name(&word, name);
    if (!d->files->environment)
        return glint_text_set_error(
            &d->text, word.place, "this program cannot read environment files");
    e = append_environment(d, name, word.place);
    if (!e)
        return false;
    e->turn_deg = turn_deg;
    e->scale = scale;
    status = d->files->environment(d->files->ctx, name, &e->data, &e->bytes,
                                   d->error);
    if (status != GLINT_OK)
        return glint_describe_set_file_error(d, word.place, status);
    return glint_environment_open(&opened, e->data, e->bytes, &reason) ==
               GLINT_OK ||
           glint_text_set_error(&d->text, word.place, "%s", reason);
}

/* Converts light FROM of an environment to the sun TO. The z axis of an
 * environment points away from the viewer. */
static void convert_light_to_sun(const struct glint_description *s,
                                 const struct glint_environment_light *from,
                                 int number, struct glint_described_light *to)
{
    const double angle = s->environment[0].turn_deg * GLINT_PI / 180;
    const double x = from->toward_q30[0], z = from->toward_q30[2];
    const double sine =
        fmax(from->radius_q30 * 0x1p-30, sin(LEAST_DEG * GLINT_PI / 180));

    *to = (struct glint_described_light){
        .kind = GLINT_DESCRIBED_SUN,
        .radius_deg = asin(sine) * 180 / GLINT_PI,
        .at = {cos(angle) * x + sin(angle) * z, from->toward_q30[1],
               (s->left_handed ? 1 : -1) * (cos(angle) * z - sin(angle) * x)}};
    glint_describe_normalise_vector(to->at);
    for (int c = 0; c < 3; c++)
        to->colour[c] = s->environment[0].scale *
                        glint_real_value(from->rgb[c]) / (sine * sine);
    snprintf(to->name, sizeof to->name,
             number ? "environment%d" : "environment", number + 1);
}

bool glint_describe_add_environment_lights(struct glint_describer *d)
{
    /* black light: environments with fewer lights than the scene's max are
     * padded with it */
    static const struct glint_environment_light dark = {
        .toward_q30 = {0, 1 << 30, 0}};
    struct glint_description *s = d->scene;
    struct glint_environment e;
    const char *reason;

    if (!s->n_environments)
        return s->background != GLINT_BEHIND_ENVIRONMENT ||
               glint_text_set_error(
                   &d->text, d->background,
                   "'background environment' needs a line 'environment FILE'");
    /* The loop runs backwards, so that E is the first environment
     * afterwards. */
    for (int k = s->n_environments; k--;) {
        if (glint_environment_open(&e, s->environment[k].data,
                                   s->environment[k].bytes,
                                   /* cannot fail: the file was checked when its
                                    * line was parsed */
                                   &reason) != GLINT_OK)
            return false;
        if ((int)e.header->n_lights > s->n_environment_lights)
            s->n_environment_lights = (int)e.header->n_lights;
    }
    for (int i = 0; i < s->n_environment_lights; i++)
        convert_light_to_sun(s,
                             i < (int)e.header->n_lights ? &e.light[i] : &dark,
                             i, &s->light[s->n_lights++]);
    return true;
}
