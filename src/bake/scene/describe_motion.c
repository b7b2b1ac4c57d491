/* SPDX-License-Identifier: MIT
 *
 * Parses the line "motion". The body, its sensors and the foods (landmarks) of
 * a recorded motion become spheres of the scene, which the run time moves. The
 * run time draws the motion's shells, lines and box itself, so only their
 * materials are added.
 */
#include "bake/scene/describe.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "glint/scene/motion.h"

#define REACH GLINT_DESCRIPTION_REACH
#define LEAST GLINT_DESCRIPTION_LEAST

/* max bytes of a motion's name: with the suffix "-sensor32" it is still a valid
 * name */
enum { NAME_BYTES = 19 };

/* default materials, used unless the text defines materials of these names */
static const struct glint_described_material default_materials[] = {
    {.name = "body",
     .ambient = .3,
     .diffuse = .55,
     .specular = .15,
     .power = 40,
     .colour = {.75, .78, .82}},
    {.name = "sensors",
     .ambient = .5,
     .diffuse = .5,
     .power = 1,
     .colour = {.1, .75, 1}},
    {.name = "foods",
     .ambient = .4,
     .diffuse = .5,
     .specular = .1,
     .power = 32,
     .colour = {1, .5, .1}},
    {.name = "shells",
     .ambient = 1,
     .power = 1,
     .colour = {.25, 1, .4},
     .pass = .6},
    {.name = "lines", .ambient = 1, .power = 1, .colour = {1, .95, .3}},
    {.name = "box", .ambient = 1, .power = 1, .colour = {.45, .5, .55}}};

/* Sets INDEX to the index of the scene's material that has the name of LOOK.
 * Appends LOOK to the scene if there is no such material. */
static bool find_or_add_material(struct glint_describer *d,
                                 const struct glint_described_material *look,
                                 struct glint_text_place place, int *index)
{
    struct glint_description *s = d->scene;

    for (*index = 0; *index < s->n_materials; ++*index)
        if (strcmp(s->material[*index].name, look->name) == 0)
            return true;
    if (s->n_materials == GLINT_DESCRIPTION_MAX_MATERIALS)
        return glint_text_set_error(&d->text, place, "more than %d materials",
                                    GLINT_DESCRIPTION_MAX_MATERIALS);
    s->material[*index] = *look;
    s->material[*index].index = 1;
    s->material[*index].texture = -1;
    s->n_materials++;
    return true;
}

/* Appends a sphere of RADIUS at AT. Its name is the motion's name, followed by
 * KIND and NUMBER unless KIND is NULL. If NUMBER is at most 1, sets FIRST to
 * the sphere's index. */
static bool append_motion_sphere(struct glint_describer *d, const char *kind,
                                 int number, const double at[3], double radius,
                                 int material, struct glint_text_place place,
                                 int *first)
{
    const char *const name = d->scene->motion.name;
    char full[GLINT_DESCRIPTION_NAME_BYTES];
    struct glint_described_object *o;

    if (kind)
        snprintf(full, sizeof full, "%.18s-%s%d", name, kind, number);
    else
        snprintf(full, sizeof full, "%s", name);
    if (number <= 1)
        *first = d->scene->n_objects;
    o = glint_describe_append_object(d, GLINT_DESCRIBED_SPHERE, full, place);
    if (!o)
        return false;
    memcpy(o->at, at, sizeof o->at);
    o->radius = radius;
    o->material = material;
    return true;
}

/* Appends spheres for body, sensors and foods at their positions in frame 0. */
static bool append_motion_objects(struct glint_describer *d,
                                  struct glint_motion *motion,
                                  struct glint_text_place place)
{
    struct glint_described_motion *m = &d->scene->motion;
    const struct glint_motion_header *h = &motion->header;
    const double step = ldexp(1, -h->unit_log2);
    const double middle[3] = {0, 0, 0};
    struct glint_motion_frame frame;
    int material[3];

    for (int i = 0; i < 3; i++)
        if (!find_or_add_material(d, &default_materials[i], place,
                                  &material[i]))
            return false;
    if (!find_or_add_material(d, &default_materials[3], place,
                              &m->shell_material) ||
        !find_or_add_material(d, &default_materials[4], place,
                              &m->line_material) ||
        !find_or_add_material(d, &default_materials[5], place,
                              &m->box_material))
        return false;
    if (m->size > 0 && !append_motion_sphere(d, NULL, 0, middle, m->size,
                                             material[0], place, &m->body))
        return false;
    for (uint32_t i = 0; m->sensors > 0 && i < h->n_sensors; i++) {
        double at[3];

        for (int k = 0; k < 3; k++)
            at[k] = m->size * ldexp(motion->sensor[i].axis_q30[k], -30);
        if (!append_motion_sphere(d, "sensor", (int)i + 1, at, m->sensors,
                                  material[1], place, &m->sensor))
            return false;
    }
    /* cannot fail: the file was checked when it was opened */
    if (glint_motion_frame(motion, 0, &frame) != GLINT_OK)
        return false;
    for (uint32_t i = 0; m->foods > 0 && i < h->n_foods; i++) {
        double at[3];

        for (int k = 0; k < 3; k++)
            at[k] = step * frame.food[i][k];
        if (!append_motion_sphere(d, "food", (int)i + 1, at, m->foods,
                                  material[2], place, &m->food))
            return false;
    }
    for (int k = 0; k < 3; k++)
        m->reach =
            fmax(m->reach, step * fmax(-(double)h->low[k], (double)h->high[k]));
    return true;
}

/* Reads the motion file FILE and appends its objects to the scene. */
static bool read_motion_file(struct glint_describer *d,
                             const struct glint_word *file, bool has_size)
{
    struct glint_described_motion *m = &d->scene->motion;
    struct glint_motion motion;
    char name[GLINT_FILE_BYTES];
    const char *reason = "";
    enum glint_status status;

    glint_describe_copy_file_name(file, name);
    if (!d->files->motion)
        return glint_text_set_error(&d->text, file->place,
                                    "this program cannot read motion files");
    status =
        d->files->motion(d->files->ctx, name, &m->data, &m->bytes, d->error);
    if (status != GLINT_OK)
        return glint_describe_set_file_error(d, file->place, status);
    if (glint_motion_open(&motion, m->data, m->bytes, &reason) != GLINT_OK)
        return glint_text_set_error(&d->text, file->place, "%s", reason);
    if (!has_size)
        m->size = ldexp(motion.header.size, -motion.header.unit_log2);
    if (m->size > REACH)
        return glint_text_set_error(&d->text, file->place,
                                    "the body's radius is %g; the limit is %g",
                                    m->size, REACH);
    return append_motion_objects(d, &motion, file->place);
}

static bool check_detect_clauses(struct glint_describer *d,
                                 const struct glint_clause *detect,
                                 const struct glint_clause *angle,
                                 const struct glint_clause *both)
{
    d->scene->motion.both = both->place.line > 0;
    if (detect->place.line && (angle->place.line > 0) == (both->place.line > 0))
        return glint_text_set_error(
            &d->text, detect->place,
            "'detect' needs 'angle', or 'both' and a minimum intensity");
    if (!detect->place.line && (angle->place.line || both->place.line))
        return glint_text_set_error(
            &d->text, angle->place.line ? angle->place : both->place,
            "'angle' and 'both' may only follow 'detect'");
    return true;
}

bool glint_describe_parse_motion(struct glint_describer *d)
{
    struct glint_described_motion *m = &d->scene->motion;
    struct glint_clause clause[] = {
        {"size", 1, LEAST, REACH, .value = &m->size},
        {"sensors", 1, LEAST, REACH, .value = &m->sensors},
        {"foods", 1, LEAST, REACH, .value = &m->foods},
        {"shells", 1, 1, 100, .value = &m->shells},
        {"lines", 1, LEAST, REACH, .value = &m->lines},
        {"box", 1, 0, 10, .value = &m->box},
        {"detect", .n = 0},
        {"angle", .n = 0},
        {"both", 1, 0, 1, .value = &m->least},
        {0}};
    struct glint_word file;

    m->body = m->sensor = m->food = -1;
    if (!glint_name_read(&d->text, "motion", m->name, NAME_BYTES))
        return false;
    file = glint_text_next_word(&d->text);
    if (!file.length)
        return glint_text_set_error(
            &d->text, file.place, "the file name is missing: motion NAME FILE");
    if (!glint_clauses_read(&d->text, "motion", clause) ||
        !check_detect_clauses(d, &clause[6], &clause[7], &clause[8]))
        return false;
    if (clause[3].place.line && !clause[2].place.line)
        return glint_text_set_error(&d->text, clause[3].place,
                                    "'shells' needs 'foods' with a radius");
    if (m->box > 0 && !clause[4].place.line)
        return glint_text_set_error(
            &d->text, clause[5].place,
            "'box' is a factor on the width of 'lines', but "
            "'lines' is missing");
    m->box *= m->lines;
    return read_motion_file(d, &file, clause[0].place.line > 0);
}

bool glint_describe_check_sensors(struct glint_describer *d)
{
    const struct glint_described_motion *m = &d->scene->motion;
    struct glint_motion motion;
    const char *reason;
    int n = 0;

    if (m->data &&
        glint_motion_open(&motion, m->data, m->bytes, &reason) == GLINT_OK)
        n = (int)motion.header.n_sensors;
    if (d->sensor.line && m->camera >= n)
        return glint_text_set_error(
            &d->text, d->sensor,
            m->data ? "no such sensor: the motion has %d"
                    : "the scene has no motion, and so no sensors",
            n);
    if (d->rides.line && strcmp(d->rides_on, m->name) != 0)
        return glint_text_set_error(
            &d->text, d->rides, "the motion '%s' is not defined", d->rides_on);
    return true;
}
