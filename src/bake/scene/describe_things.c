/* SPDX-License-Identifier: MIT
 *
 * Parses the lines of objects, "sphere", "triangle", "plane" and "mesh":
 * shape, position and material.
 */
#include "bake/scene/describe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/scene/mesh.h"
#include "glint/view.h"

#define REACH GLINT_DESCRIPTION_REACH
#define LEAST GLINT_DESCRIPTION_LEAST
/* max number of times that a texture may repeat across a triangle */
#define REPEATS 250.0
#define NO_AXIS "the axis of a rotation must not be 0 0 0"

struct glint_described_object *
glint_describe_append_object(struct glint_describer *d,
                             enum glint_described_kind kind, const char *name,
                             struct glint_text_place place)
{
    struct glint_description *s = d->scene;
    struct glint_described_object *o = &s->object[s->n_objects];

    if (s->n_objects == GLINT_DESCRIPTION_MAX_OBJECTS) {
        glint_text_set_error(&d->text, place, "more than %d objects",
                             GLINT_DESCRIPTION_MAX_OBJECTS);
        return NULL;
    }
    if (strcmp(name, "camera") == 0) {
        glint_text_set_error(&d->text, place, "the name 'camera' is reserved");
        return NULL;
    }
    for (int i = 0; i < s->n_objects; i++)
        if (strcmp(s->object[i].name, name) == 0) {
            glint_text_set_error(&d->text, place,
                                 "an object of this name is already defined");
            return NULL;
        }
    for (int i = 0; i < s->n_lights; i++)
        if (d->named_lights >> i & 1 && strcmp(s->light[i].name, name) == 0) {
            glint_text_set_error(&d->text, place,
                                 "a light of this name is already defined");
            return NULL;
        }
    *o = (struct glint_described_object){.kind = kind,
                                         .turn = {1, 0, 0, 0},
                                         .material = -1,
                                         .shadow = 1,
                                         .first_triangle = s->n_triangles};
    snprintf(o->name, sizeof o->name, "%s", name);
    s->n_objects++;
    return o;
}

/* Parses the name of an object and appends the object. Returns NULL if the name
 * is invalid or already used, or there are too many objects. */
static struct glint_described_object *
begin_named_object(struct glint_describer *d, enum glint_described_kind kind,
                   const char *what)
{
    struct glint_text at = d->text;
    const struct glint_text_place place = glint_text_next_word(&at).place;
    char name[GLINT_DESCRIPTION_NAME_BYTES];

    return glint_name_read(&d->text, what, name, sizeof name)
               ? glint_describe_append_object(d, kind, name, place)
               : NULL;
}

/* Returns whether the texture repeats more than REPEATS times across T. */
static bool
is_texture_repeated_too_often(const struct glint_described_triangle *t)
{
    for (int i = 0; t->has_uv && i < 2; i++) {
        const double low = fmin(t->uv[0][i], fmin(t->uv[1][i], t->uv[2][i]));
        const double high = fmax(t->uv[0][i], fmax(t->uv[1][i], t->uv[2][i]));

        if (high - low > REPEATS)
            return true;
    }
    return false;
}

/* Sets TURN to the unit quaternion of a rotation by ANGLE_DEG about AXIS.
 * Returns false if AXIS is 0. */
static bool set_rotation_quaternion(double turn[4], double axis[3],
                                    double angle_deg)
{
    const double half = angle_deg * GLINT_PI / 360;

    if (!glint_describe_normalise_vector(axis))
        return false;
    turn[0] = cos(half);
    for (int i = 0; i < 3; i++)
        turn[i + 1] = sin(half) * axis[i];
    return true;
}

bool glint_describe_parse_sphere(struct glint_describer *d)
{
    struct glint_described_object *o =
        begin_named_object(d, GLINT_DESCRIBED_SPHERE, "sphere");
    double turn[4] = {0, 1, 0, 0};
    struct glint_word material;
    struct glint_clause clause[] = {
        {"at", 3, -REACH, REACH, .value = o ? o->at : NULL, .required = true},
        {"radius", 1, LEAST, REACH, .value = o ? &o->radius : NULL,
         .required = true},
        {"material", .name = &material, .required = true},
        {"turn", 4, -REACH, REACH, .value = turn},
        {"shadow", 1, 0, 1, .value = o ? &o->shadow : NULL},
        {0}};

    return o && glint_clauses_read(&d->text, "sphere", clause) &&
           glint_describe_find_material(d, &material, &o->material) &&
           glint_describe_check_translucent_object(d, o, clause[2].place) &&
           (set_rotation_quaternion(o->turn, turn, turn[3]) ||
            glint_text_set_error(&d->text, clause[3].place, NO_AXIS));
}

/* Appends N triangles to the scene and returns the first one. Returns NULL if
 * there are too many triangles or if there is no memory. */
static struct glint_described_triangle *
append_triangles(struct glint_describer *d, int n,
                 struct glint_text_place place)
{
    struct glint_description *s = d->scene;

    if (n > GLINT_DESCRIPTION_MAX_TRIANGLES - s->n_triangles) {
        glint_text_set_error(&d->text, place, "more than %d triangles",
                             GLINT_DESCRIPTION_MAX_TRIANGLES);
        return NULL;
    }
    if (s->n_triangles + n > d->capacity) {
        const int capacity = 2 * (s->n_triangles + n);
        struct glint_described_triangle *t =
            realloc(s->triangle, (size_t)capacity * sizeof *t);

        if (!t) {
            d->status = GLINT_E_MEMORY;
            return NULL;
        }
        s->triangle = t;
        d->capacity = capacity;
    }
    s->n_triangles += n;
    return s->triangle + s->n_triangles - n;
}

bool glint_describe_parse_triangle(struct glint_describer *d)
{
    struct glint_described_object *o =
        begin_named_object(d, GLINT_DESCRIBED_TRIANGLE, "triangle");
    struct glint_described_triangle t = {.has_uv = false}, *to;
    struct glint_word material;
    struct glint_clause clause[] = {
        {"uv", 6, -REACH, REACH, .value = t.uv[0]},
        {"material", .name = &material, .required = true},
        {"shadow", 1, 0, 1, .value = o ? &o->shadow : NULL},
        {0}};

    if (!o ||
        !glint_numbers_read(&d->text, "triangle", 9, -REACH, REACH,
                            t.place[0]) ||
        !glint_clauses_read(&d->text, "triangle", clause) ||
        !glint_describe_find_material(d, &material, &o->material))
        return false;
    t.has_uv = clause[0].place.line > 0;
    t.object = d->scene->n_objects - 1;
    t.material = o->material;
    if (d->scene->material[t.material].texture >= 0 && !t.has_uv)
        return glint_text_set_error(&d->text, clause[1].place,
                                    "a material with a texture needs 'uv'");
    if (is_texture_repeated_too_often(&t))
        return glint_text_set_error(
            &d->text, clause[0].place,
            "a texture may repeat at most %g times over a triangle", REPEATS);
    to = append_triangles(d, 1, clause[1].place);
    if (!to)
        return false;
    *to = t;
    o->n_triangles = 1;
    return glint_describe_check_translucent_object(d, o, clause[1].place);
}

bool glint_describe_parse_plane(struct glint_describer *d)
{
    struct glint_described_object *o =
        begin_named_object(d, GLINT_DESCRIBED_PLANE, "plane");
    struct glint_word material;
    struct glint_clause clause[] = {
        {"at", 3, -REACH, REACH, .value = o ? o->at : NULL, .required = true},
        {"normal", 3, -REACH, REACH, .value = o ? o->normal : NULL,
         .required = true},
        {"material", .name = &material},
        {"catcher", 1, 0.001, 1, .value = o ? &o->catcher : NULL},
        {0}};

    if (!o || !glint_clauses_read(&d->text, "plane", clause))
        return false;
    if (!glint_describe_normalise_vector(o->normal))
        return glint_text_set_error(&d->text, clause[1].place,
                                    "a normal must not be 0 0 0");
    if (!clause[2].place.line == !clause[3].place.line)
        return glint_text_set_error(
            &d->text, clause[2].place.line ? clause[2].place : clause[0].place,
            "a plane needs a material or the word 'catcher'%s",
            clause[2].place.line ? ", not both" : "");
    return !clause[2].place.line ||
           (glint_describe_find_material(d, &material, &o->material) &&
            glint_describe_check_translucent_object(d, o, clause[2].place));
}

/* -------------------------------------------------------------------- mesh */

/* Sets OF[n_names] to the indices of the scene's materials for the names in
 * MESH. A name that the scene does not define gets the material of object O, or
 * is an error if O has none. */
static bool find_mesh_materials(struct glint_describer *d,
                                const struct glint_described_object *o,
                                const struct glint_mesh *mesh, const char *file,
                                struct glint_text_place place, int *of)
{
    const struct glint_description *s = d->scene;

    for (int i = 0; i < mesh->n_names; i++) {
        of[i] = o->material;
        for (int m = 0; m < s->n_materials; m++)
            if (strcmp(s->material[m].name, mesh->name[i]) == 0)
                of[i] = m;
        if (of[i] < 0)
            return glint_text_set_error(
                &d->text, place,
                "%s uses '%s', which is not a material above this line; "
                "define it there, or add 'material NAME' to the mesh",
                file, mesh->name[i]);
    }
    return true;
}

static bool append_mesh_triangles(struct glint_describer *d,
                                  struct glint_described_object *o,
                                  const struct glint_mesh *mesh, const int *of,
                                  double scale, struct glint_text_place place)
{
    const struct glint_description *s = d->scene;
    struct glint_described_triangle *to =
        append_triangles(d, mesh->n_triangles, place);

    if (!to)
        return false;
    o->n_triangles = mesh->n_triangles;
    for (int i = 0; i < mesh->n_triangles; i++) {
        struct glint_described_triangle *t = &to[i];

        *t = mesh->triangle[i];
        t->object = s->n_objects - 1;
        t->material = t->material < 0 ? o->material : of[t->material];
        if (t->material < 0)
            return glint_text_set_error(
                &d->text, place,
                "the mesh has faces without a material; "
                "add 'material'");
        if (s->material[t->material].texture >= 0 && !t->has_uv)
            return glint_text_set_error(
                &d->text, place,
                "material %s has a texture, but faces of "
                "the mesh have no texture coordinates (vt)",
                s->material[t->material].name);
        if (is_texture_repeated_too_often(t))
            return glint_text_set_error(
                &d->text, place,
                "a texture may repeat at most %g times over a triangle, but "
                "repeats more often on this mesh",
                REPEATS);
        for (int k = 0; k < 3; k++) {
            if (t->has_normals &&
                !glint_describe_normalise_vector(t->normal[k]))
                t->has_normals = false;
            for (int axis = 0; axis < 3; axis++) {
                t->place[k][axis] *= scale;
                if (!(fabs(t->place[k][axis]) <= REACH))
                    return glint_text_set_error(
                        &d->text, place,
                        "the mesh extends %.4g from its "
                        "origin; the limit is %g",
                        fabs(t->place[k][axis]), REACH);
            }
        }
    }
    return true;
}

static bool read_mesh_file(struct glint_describer *d,
                           struct glint_described_object *o,
                           const struct glint_word *word, double scale)
{
    struct glint_mesh *mesh = malloc(sizeof *mesh);
    char name[GLINT_FILE_BYTES];
    int of[GLINT_MESH_MAX_NAMES];
    uint8_t *data = NULL;
    size_t bytes = 0;
    bool good = false;
    enum glint_status status;

    glint_describe_copy_file_name(word, name);
    status = mesh ? d->files->read(d->files->ctx, name, &data, &bytes, d->error)
                  : GLINT_E_MEMORY;
    if (status != GLINT_OK) {
        glint_describe_set_file_error(d, word->place, status);
    } else {
        status =
            glint_mesh_read(mesh, (const char *)data, bytes, name, d->error);
        d->status = status == GLINT_OK ? d->status : status;
        good = status == GLINT_OK &&
               find_mesh_materials(d, o, mesh, name, word->place, of) &&
               append_mesh_triangles(d, o, mesh, of, scale, word->place) &&
               glint_describe_check_translucent_object(d, o, word->place);
        if (status == GLINT_OK)
            free(mesh->triangle);
    }
    free(data);
    free(mesh);
    return good;
}

bool glint_describe_parse_mesh(struct glint_describer *d)
{
    struct glint_described_object *o =
        begin_named_object(d, GLINT_DESCRIBED_MESH, "mesh");
    struct glint_word material, file;
    double scale = 1, turn[4] = {0, 1, 0, 0};
    struct glint_clause clause[] = {
        {"at", 3, -REACH, REACH, .value = o ? o->at : NULL, .required = true},
        {"scale", 1, 1e-9, 1e9, .value = &scale},
        {"material", .name = &material},
        {"turn", 4, -REACH, REACH, .value = turn},
        {"shadow", 1, 0, 1, .value = o ? &o->shadow : NULL},
        {0}};

    if (!o)
        return false;
    file = glint_text_next_word(&d->text);
    if (!file.length)
        return glint_text_set_error(&d->text, file.place,
                                    "the file name is missing: mesh NAME FILE");
    if (!glint_clauses_read(&d->text, "mesh", clause) ||
        (clause[2].place.line &&
         !glint_describe_find_material(d, &material, &o->material)))
        return false;
    if (!set_rotation_quaternion(o->turn, turn, turn[3]))
        return glint_text_set_error(&d->text, clause[3].place, NO_AXIS);
    return read_mesh_file(d, o, &file, scale);
}
