/* SPDX-License-Identifier: MIT
 *
 * Reads lenses in JSON, parsed by jansson.
 *
 * realflare: "lens_elements" with "radius", "distance", "refractive_index",
 * "abbe_nr" and "height"; "aperture_index", the index of the stop among them;
 * "fstop".
 *
 * lentil's lenses.json: an object of lenses by their keys, each with
 * "optical-elements-patent" that have "radius", "thickness", "ior", "abbe",
 * "housing-radius", "material" (may be "air" or "iris"), and "lens-geometry".
 */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "import/imported.h"

struct json_lens {
    struct imported *lens;
    /* the part of the file's text after the last element that was found */
    const char *text, *end;
    int line; /* number of the line at which text begins */
};

/* Moves j->text past the next WORD. Returns false if WORD does not occur
 * again. */
static bool skip_past_word(struct json_lens *j, const char *word)
{
    const size_t bytes = strlen(word);

    for (; j->end - j->text >= (ptrdiff_t)bytes; j->text++) {
        if (memcmp(j->text, word, bytes) == 0) {
            j->text += bytes;
            return true;
        }
        j->line += *j->text == '\n';
    }
    return false;
}

/* Returns the line number of the next element. Searches the text for its
 * "radius", because jansson does not store line numbers. */
static int find_next_element_line(struct json_lens *j)
{
    return skip_past_word(j, "\"radius\"") ? j->line : 0;
}

static bool read_json_number(struct json_lens *j, const json_t *element,
                             int line, const char *key, double *value)
{
    const json_t *found = json_object_get(element, key);

    if (!json_is_number(found))
        return imported_report_error(j->lens, line, "\"%s\" is %s", key,
                                     found ? "no number" : "missing");
    *value = json_number_value(found);
    return true;
}

/* Adds notes for keys of ELEMENT that are not in KNOWN, a list of words with
 * blanks around each. */
static void note_unread_keys(struct json_lens *j, json_t *element, int line,
                             const char *known)
{
    const char *key;
    json_t *value;

    json_object_foreach(element, key, value)
    {
        char word[40];

        snprintf(word, sizeof word, " %.36s ", key);
        if (!strstr(known, word) && !json_is_null(value))
            imported_note_unread_word(j->lens, line, key);
    }
}

/* Parses TEXT as JSON and passes the root object to TAKE, which fills LENS. */
static bool read_json_text(struct imported *lens, const char *text,
                           size_t bytes,
                           bool (*take)(struct json_lens *j, json_t *root))
{
    struct json_lens j = {lens, text, text + bytes, 1};
    json_error_t error;
    json_t *root = json_loadb(text, bytes, JSON_REJECT_DUPLICATES, &error);
    const bool good =
        root ? take(&j, root)
             : imported_report_error(lens, error.line, "%.150s", error.text);

    json_decref(root);
    return good;
}

/* ---------------------------------------------------------------- realflare */

static bool parse_element(struct json_lens *j, json_t *element, bool stop)
{
    const int line = find_next_element_line(j);
    struct imported_surface *s = imported_add_surface(j->lens, line);

    if (!s)
        return false;
    s->stop = stop;
    if (!read_json_number(j, element, line, "radius", &s->radius) ||
        !read_json_number(j, element, line, "distance", &s->thickness) ||
        !read_json_number(j, element, line, "refractive_index", &s->nd) ||
        !read_json_number(j, element, line, "abbe_nr", &s->vd) ||
        !read_json_number(j, element, line, "height", &s->semi))
        return false;
    if (s->nd == 1)
        s->vd = 0;
    note_unread_keys(j, element, line,
                     " radius distance refractive_index abbe_nr height ");
    return true;
}

static bool parse_realflare(struct json_lens *j, json_t *root)
{
    const json_t *elements = json_object_get(root, "lens_elements");
    const json_t *name = json_object_get(root, "name");
    double stop = -1;

    if (!json_is_array(elements) || json_array_size(elements) == 0)
        return imported_report_error(
            j->lens, 0,
            "has no \"lens_elements\" (lentil's lenses: "
            "--format lentil)");
    if (json_is_string(name))
        snprintf(j->lens->title, sizeof j->lens->title, "%.230s",
                 json_string_value(name));
    if (json_object_get(root, "fstop") &&
        !read_json_number(j, root, 0, "fstop", &j->lens->f_number))
        return false;
    if (json_object_get(root, "focal_length") &&
        !read_json_number(j, root, 0, "focal_length", &j->lens->nominal))
        return false;
    if (!read_json_number(j, root, 0, "aperture_index", &stop))
        return false;
    if (stop != floor(stop) || stop < 0 ||
        stop >= (double)json_array_size(elements))
        return imported_report_error(
            j->lens, 0,
            "\"aperture_index\" %g must be the number, from 0, of one of %d "
            "\"lens_elements\"",
            stop, (int)json_array_size(elements));
    for (int k = 0; k < (int)json_array_size(elements); k++)
        if (!parse_element(j, json_array_get(elements, (size_t)k),
                           k == (int)stop))
            return false;
    return imported_add_note(j->lens, 0, "coatings are ignored");
}

bool import_realflare(struct imported *lens, const char *text, size_t bytes)
{
    return read_json_text(lens, text, bytes, parse_realflare);
}

/* ------------------------------------------------------------------- lentil */

/* Sets the shape of S by "lens-geometry"; "cyl-y" is a cylinder with its axis
 * along y. */
static bool parse_geometry(struct json_lens *j, const json_t *element,
                           struct imported_surface *s)
{
    const char *kind =
        json_string_value(json_object_get(element, "lens-geometry"));

    if (!kind || strcmp(kind, "spherical") == 0)
        return true;
    if (strcmp(kind, "cyl-x") != 0 && strcmp(kind, "cyl-y") != 0)
        return imported_report_error(
            j->lens, s->line,
            "surfaces of geometry '%.40s' are not supported; "
            "spherical, cyl-x and cyl-y are",
            kind);
    s->shape.bend = kind[4] == 'x' ? GLINT_BEND_Y : GLINT_BEND_X;
    return true;
}

static bool parse_lentil_element(struct json_lens *j, json_t *element)
{
    const char *medium =
        json_string_value(json_object_get(element, "material"));
    const int line = find_next_element_line(j);
    struct imported_surface *s = imported_add_surface(j->lens, line);

    if (!s)
        return false;
    if (!medium)
        return imported_report_error(j->lens, line, "\"material\" is missing");
    if (json_object_get(element, "aspherical-equation") &&
        !json_is_null(json_object_get(element, "aspherical-equation")))
        return imported_report_error(
            j->lens, line,
            "aspheres (\"aspherical-equation\") are not "
            "supported; spheres and cylinders are");
    note_unread_keys(j, element, line,
                     " radius thickness housing-radius ior abbe material "
                     "lens-geometry ");
    s->stop = strcasecmp(medium, "iris") == 0;
    if (!read_json_number(j, element, line, "radius", &s->radius) ||
        !read_json_number(j, element, line, "thickness", &s->thickness) ||
        !read_json_number(j, element, line, "housing-radius", &s->semi))
        return false;
    if (!s->stop && strcasecmp(medium, "air") != 0 &&
        (!read_json_number(j, element, line, "ior", &s->nd) ||
         !read_json_number(j, element, line, "abbe", &s->vd)))
        return false;
    return parse_geometry(j, element, s);
}

/* Returns the lens with the requested key, or the only lens; NULL with the
 * error set. */
static const json_t *find_requested_lens(struct imported *lens, json_t *root)
{
    const char *key = lens->key ? lens->key : "";
    const json_t *found;

    lens->keyed = true;
    if (!lens->key && json_object_size(root) == 1)
        key = json_object_iter_key(json_object_iter(root));
    found = json_object_get(root, key);
    if (found)
        return found;
    if (json_object_size(root) == 0)
        imported_report_error(lens, 0, "the file contains no lenses");
    else
        imported_report_error(
            lens, 0, "has %d lenses%s%.40s%s: --lens %.40s or another",
            (int)json_object_size(root),
            lens->key ? ", but none with the key '" : "", key,
            lens->key ? "'" : "", json_object_iter_key(json_object_iter(root)));
    return NULL;
}

static bool parse_lentil(struct json_lens *j, json_t *root)
{
    static const char list[] = "optical-elements-patent";
    const json_t *found = find_requested_lens(j->lens, root), *elements, *said;
    char key[64];

    if (!found)
        return false;
    elements = json_object_get(found, list);
    if (!json_is_array(elements) || json_array_size(elements) == 0)
        return imported_report_error(j->lens, 0, "has no \"%s\"", list);
    said = json_object_get(found, "product-name");
    if (json_is_string(said))
        snprintf(j->lens->title, sizeof j->lens->title, "%.230s",
                 json_string_value(said));
    said = json_object_get(found, "focal-length-mm-patent");
    if (json_is_number(said))
        j->lens->nominal = json_number_value(said);
    if (j->lens->key) {
        snprintf(key, sizeof key, "\"%.60s\"", j->lens->key);
        skip_past_word(j, key);
    }
    skip_past_word(j, list);
    for (size_t k = 0; k < json_array_size(elements); k++)
        if (!parse_lentil_element(j, json_array_get(elements, k)))
            return false;
    return true;
}

bool import_lentil(struct imported *lens, const char *text, size_t bytes)
{
    return read_json_text(lens, text, bytes, parse_lentil);
}
