/* SPDX-License-Identifier: MIT */
#include "bake/scene/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bake/table/text.h"

/* A growing array of items, each of WIDTH numbers: positions, texture
 * coordinates or normals. */
struct list {
    double *at;
    int n, capacity, width;
};

/* A corner of a face: indices of position, texture coordinates and normal, from
 * 0; -1: absent. */
struct corner {
    int place, uv, normal;
};

struct reader {
    struct glint_text text;
    struct list place, uv, normal;
    struct glint_mesh *mesh;
    int capacity; /* number of triangles for which memory is allocated */
    int material; /* index of the current material's name; -1: none */
    bool out_of_memory;
};

/* Appends an item to LIST and returns its numbers; NULL if there is no
 * memory. */
static double *append_list_item(struct reader *r, struct list *list)
{
    if (list->n == list->capacity) {
        const int capacity = list->capacity ? 2 * list->capacity : 256;
        double *at = realloc(list->at, (size_t)capacity * (size_t)list->width *
                                           sizeof *at);

        if (!at) {
            r->out_of_memory = true;
            return NULL;
        }
        list->at = at;
        list->capacity = capacity;
    }
    return list->at + (ptrdiff_t)list->n++ * list->width;
}

/* Returns the next word of the line. A backslash at its end continues the
 * line. */
static struct glint_word read_next_word(struct reader *r)
{
    struct glint_word word = glint_text_next_word(&r->text);

    while (glint_word_equals(&word, "\\") && r->text.at == r->text.stop &&
           glint_text_next_line(&r->text))
        word = glint_text_next_word(&r->text);
    return word;
}

/* Parses the numbers of a line into a new item of LIST. At least LEAST numbers
 * are required; other missing ones become 0. Further numbers, such as weights
 * and colours, are skipped. WHAT names the line in error texts. */
static bool read_vertex_item(struct reader *r, struct list *list, int least,
                             const char *what)
{
    double *item = append_list_item(r, list);
    char quote[GLINT_QUOTE_BYTES];

    for (int i = 0; item && i < list->width; i++) {
        const struct glint_word word = read_next_word(r);

        item[i] = 0.0;
        if (!word.length && i >= least)
            continue;
        if (!word.length)
            return glint_text_set_error(&r->text, word.place,
                                        "%s needs %d numbers, got %d", what,
                                        least, i);
        if (!glint_word_parse_long_number(&word, &item[i]))
            return glint_text_set_error(&r->text, word.place,
                                        "'%s' is not a number",
                                        glint_word_quote(&word, quote));
        if (!(fabs(item[i]) <=
              GLINT_DESCRIPTION_REACH * GLINT_DESCRIPTION_REACH))
            return glint_text_set_error(
                &r->text, word.place, "numbers of a mesh must be at most 1e12");
    }
    return item != NULL;
}

/* Parses the index that starts at character *AT of WORD and ends at a slash or
 * the end of WORD. Sets INDEX to the index in LIST, from 0; -1: absent. */
static bool read_corner_index(struct reader *r, const struct glint_word *word,
                              int *at, const struct list *list,
                              const char *what, int *index)
{
    const bool negative = *at < word->length && word->start[*at] == '-';
    const int start = *at + negative;
    long long value = 0;
    int i = start;

    for (; i < word->length && word->start[i] >= '0' && word->start[i] <= '9';
         i++)
        if (value < INT32_MAX)
            value = 10 * value + (word->start[i] - '0');
    *at = i;
    *index = -1;
    if (i == start && !negative && (i == word->length || word->start[i] == '/'))
        return true;
    if (i == start || (i < word->length && word->start[i] != '/')) {
        char quote[GLINT_QUOTE_BYTES];

        return glint_text_set_error(
            &r->text, word->place,
            "'%s' is not a corner; expected V, V/T, V//N or V/T/N",
            glint_word_quote(word, quote));
    }
    value = negative ? list->n - value : value - 1;
    if (value < 0 || value >= list->n)
        return glint_text_set_error(
            &r->text, word->place,
            "%s %.*s does not exist; %d are defined above", what,
            i - start + negative < 12 ? i - start + negative : 12,
            word->start + start - negative, list->n);
    *index = (int)value;
    return true;
}

static bool read_face_corner(struct reader *r, const struct glint_word *word,
                             struct corner *corner)
{
    int at = 0;

    *corner = (struct corner){-1, -1, -1};
    if (!read_corner_index(r, word, &at, &r->place, "vertex", &corner->place))
        return false;
    if (corner->place < 0)
        return glint_text_set_error(&r->text, word->place,
                                    "a corner needs a vertex index (V)");
    if (at < word->length) {
        at++; /* skips the slash between two indices */
        if (!read_corner_index(r, word, &at, &r->uv, "texture coordinate",
                               &corner->uv))
            return false;
    }
    if (at < word->length) {
        at++;
        if (!read_corner_index(r, word, &at, &r->normal, "normal",
                               &corner->normal))
            return false;
    }
    return at == word->length ||
           glint_text_set_error(&r->text, word->place,
                                "a corner has at most three indices, V/T/N");
}

static bool append_mesh_triangle(struct reader *r,
                                 const struct corner *const c[3],
                                 struct glint_text_place place)
{
    struct glint_mesh *mesh = r->mesh;
    struct glint_described_triangle *t;

    if (mesh->n_triangles == GLINT_DESCRIPTION_MAX_TRIANGLES)
        return glint_text_set_error(&r->text, place, "more than %d triangles",
                                    GLINT_DESCRIPTION_MAX_TRIANGLES);
    if (mesh->n_triangles == r->capacity) {
        const int capacity = r->capacity ? 2 * r->capacity : 64;

        t = realloc(mesh->triangle, (size_t)capacity * sizeof *t);
        if (!t) {
            r->out_of_memory = true;
            return false;
        }
        mesh->triangle = t;
        r->capacity = capacity;
    }
    t = &mesh->triangle[mesh->n_triangles++];
    *t = (struct glint_described_triangle){
        .material = r->material, .has_normals = true, .has_uv = true};
    for (int k = 0; k < 3; k++) {
        memcpy(t->place[k], r->place.at + 3 * (ptrdiff_t)c[k]->place,
               sizeof t->place[k]);
        if (c[k]->uv < 0)
            t->has_uv = false;
        else
            memcpy(t->uv[k], r->uv.at + 2 * (ptrdiff_t)c[k]->uv,
                   sizeof t->uv[k]);
        if (c[k]->normal < 0)
            t->has_normals = false;
        else
            memcpy(t->normal[k], r->normal.at + 3 * (ptrdiff_t)c[k]->normal,
                   sizeof t->normal[k]);
    }
    return true;
}

static bool read_face_line(struct reader *r, struct glint_text_place place)
{
    struct corner first = {-1, -1, -1}, last = first, now;
    int n = 0;

    for (;; n++) {
        const struct glint_word word = read_next_word(r);
        const struct corner *const c[3] = {&first, &last, &now};

        if (!word.length)
            break;
        if (!read_face_corner(r, &word, &now) ||
            (n >= 2 && !append_mesh_triangle(r, c, word.place)))
            return false;
        if (n == 0)
            first = now;
        last = now;
    }
    return n >= 3 || glint_text_set_error(
                         &r->text, place,
                         "a face needs 3 or more corners; this face has %d", n);
}

static bool read_material_name(struct reader *r)
{
    struct glint_mesh *mesh = r->mesh;
    const struct glint_word word = glint_text_get_rest(&r->text);
    const int n = word.length < GLINT_DESCRIPTION_NAME_BYTES
                      ? word.length
                      : GLINT_DESCRIPTION_NAME_BYTES - 1;
    char name[GLINT_DESCRIPTION_NAME_BYTES] = "";

    r->material = -1;
    if (!n)
        return true;
    memcpy(name, word.start, (size_t)n);
    for (int i = 0; i < mesh->n_names; i++)
        if (strcmp(mesh->name[i], name) == 0) {
            r->material = i;
            return true;
        }
    if (mesh->n_names == GLINT_MESH_MAX_NAMES)
        return glint_text_set_error(&r->text, word.place,
                                    "more than %d materials",
                                    GLINT_MESH_MAX_NAMES);
    memcpy(mesh->name[mesh->n_names], name, sizeof name);
    r->material = mesh->n_names++;
    return true;
}

static bool read_obj_line(struct reader *r)
{
    const struct glint_word word = glint_text_next_word(&r->text);

    if (glint_word_equals(&word, "v"))
        return read_vertex_item(r, &r->place, 3, "v");
    if (glint_word_equals(&word, "vt"))
        return read_vertex_item(r, &r->uv, 1, "vt");
    if (glint_word_equals(&word, "vn"))
        return read_vertex_item(r, &r->normal, 3, "vn");
    if (glint_word_equals(&word, "f"))
        return read_face_line(r, word.place);
    if (glint_word_equals(&word, "usemtl"))
        return read_material_name(r);
    return true;
}

enum glint_status glint_mesh_read(struct glint_mesh *mesh, const char *text,
                                  size_t bytes, const char *file_name,
                                  struct glint_error *error)
{
    struct reader r = {.place.width = 3,
                       .uv.width = 2,
                       .normal.width = 3,
                       .mesh = mesh,
                       .material = -1};
    bool good = true;

    mesh->n_triangles = mesh->n_names = 0;
    mesh->triangle = NULL;
    glint_text_open_data(&r.text, text, bytes, file_name, error);
    if (bytes > GLINT_DESCRIPTION_MAX_MESH_BYTES)
        good = glint_text_set_error(&r.text, (struct glint_text_place){1, 1},
                                    "a mesh has more than %d bytes",
                                    GLINT_DESCRIPTION_MAX_MESH_BYTES);
    while (good && glint_text_next_line(&r.text))
        good = read_obj_line(&r);
    if (good && !mesh->n_triangles)
        good = glint_text_set_error(&r.text, glint_text_get_end_place(&r.text),
                                    "there is no face");
    free(r.place.at);
    free(r.uv.at);
    free(r.normal.at);
    if (good)
        return GLINT_OK;
    free(mesh->triangle);
    mesh->triangle = NULL;
    return r.out_of_memory ? GLINT_E_MEMORY : GLINT_E_LENS;
}
