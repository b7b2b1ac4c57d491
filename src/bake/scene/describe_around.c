/* SPDX-License-Identifier: MIT
 *
 * Lines on light from all around: the environment, whose bright lights become
 * suns of the scene. */
#include "bake/scene/describe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/scene/environment.h"
#include "glint/view.h"

/* Half of the angle of a light that is a point. */
#define LEAST_DEG 0.01

bool glint_describe_environment(struct glint_describer *d)
{
    struct glint_described_environment *e = &d->scene->environment;
    struct glint_clause clause[] = {
        {"turn", 1, -360, 360, .value = &e->turn_deg},
        {"scale", 1, 1e-6, 1e6, .value = &e->scale},
        {0}};
    const struct glint_word word = glint_text_next_word(&d->text);
    struct glint_environment opened;
    char name[GLINT_FILE_BYTES];
    const char *reason = "";
    enum glint_status status;

    e->scale = 1;
    if (!word.length)
        return glint_text_fail(&d->text, word.place,
                               "the environment's file is missing");
    if (!glint_clauses_read(&d->text, "environment", clause))
        return false;
    glint_describe_file(&word, name);
    if (!d->files->environment)
        return glint_text_fail(&d->text, word.place,
                               "no environment is read here");
    status = d->files->environment(d->files->ctx, name, &e->data, &e->bytes,
                                   d->error);
    if (status != GLINT_OK)
        return glint_describe_refuse(d, word.place, status);
    return glint_environment_open(&opened, e->data, e->bytes, &reason) ==
               GLINT_OK ||
           glint_text_fail(&d->text, word.place, "%s", reason);
}

/* Sets TO to FROM, a light of E, as a sun. The environment's z runs away. */
static void set_sun(const struct glint_description *s,
                    const struct glint_environment_light *from, int number,
                    struct glint_described_light *to)
{
    const double angle = s->environment.turn_deg * GLINT_PI / 180;
    const double x = from->toward_q30[0], z = from->toward_q30[2];
    const double sine =
        fmax(from->radius_q30 * 0x1p-30, sin(LEAST_DEG * GLINT_PI / 180));

    *to = (struct glint_described_light){
        .kind = GLINT_DESCRIBED_SUN,
        .radius_deg = asin(sine) * 180 / GLINT_PI,
        .at = {cos(angle) * x + sin(angle) * z, from->toward_q30[1],
               (s->left_handed ? 1 : -1) * (cos(angle) * z - sin(angle) * x)}};
    glint_describe_unit(to->at);
    for (int c = 0; c < 3; c++)
        to->colour[c] = s->environment.scale * glint_real_value(from->rgb[c]) /
                        (sine * sine);
    snprintf(to->name, sizeof to->name,
             number ? "environment%d" : "environment", number + 1);
}

bool glint_describe_around(struct glint_describer *d)
{
    struct glint_description *s = d->scene;
    struct glint_environment e;
    const char *reason;

    if (!s->environment.data)
        return s->background != GLINT_BEHIND_ENVIRONMENT ||
               glint_text_fail(&d->text, d->background,
                               "background environment needs a line "
                               "'environment FILE'");
    if (glint_environment_open(&e, s->environment.data, s->environment.bytes,
                               &reason) != GLINT_OK)
        return false; /* it was opened when it was read */
    for (uint32_t i = 0; i < e.header->n_lights; i++)
        set_sun(s, &e.light[i], (int)i, &s->light[s->n_lights++]);
    return true;
}
