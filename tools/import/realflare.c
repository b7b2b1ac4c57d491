/* SPDX-License-Identifier: MIT
 *
 * realflare's lens models in JSON: "lens_elements" of "radius", "distance",
 * "refractive_index", "abbe_nr" and "height", "aperture_index" the stop among
 * them, "fstop". jansson reads them.
 */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/imported.h"

struct realflare {
    struct imported *lens;
    const char *text, *end;
};

/* Returns the line of the Kth "radius" of the text, by which people find an
 * element; jansson does not keep places. */
static int line_of(const struct realflare *r, int k)
{
    static const char key[] = "\"radius\"";
    int line = 1;

    for (const char *at = r->text; r->end - at >= (ptrdiff_t)sizeof key; at++) {
        line += *at == '\n';
        if (memcmp(at, key, sizeof key - 1) == 0 && k-- == 0)
            return line;
    }
    return 0;
}

static bool number(struct realflare *r, const json_t *element, int line,
                   const char *key, double *value)
{
    const json_t *found = json_object_get(element, key);

    if (!json_is_number(found))
        return imported_fail(r->lens, line, "\"%s\" is %s", key,
                             found ? "no number" : "missing");
    *value = json_number_value(found);
    return true;
}

static bool take_element(struct realflare *r, const json_t *element, int k,
                         bool stop)
{
    const int line = line_of(r, k);
    struct imported_surface *s = imported_add(r->lens, line);

    if (!s)
        return false;
    s->stop = stop;
    if (!number(r, element, line, "radius", &s->radius) ||
        !number(r, element, line, "distance", &s->thickness) ||
        !number(r, element, line, "refractive_index", &s->nd) ||
        !number(r, element, line, "abbe_nr", &s->vd) ||
        !number(r, element, line, "height", &s->semi))
        return false;
    if (s->nd == 1)
        s->vd = 0;
    return true;
}

static bool take(struct realflare *r, const json_t *root)
{
    const json_t *elements = json_object_get(root, "lens_elements");
    const json_t *name = json_object_get(root, "name");
    double stop = -1;

    if (!json_is_array(elements) || json_array_size(elements) == 0)
        return imported_fail(r->lens, 0, "has no \"lens_elements\"");
    if (json_is_string(name))
        snprintf(r->lens->title, sizeof r->lens->title, "%.230s",
                 json_string_value(name));
    if (json_object_get(root, "fstop") &&
        !number(r, root, 0, "fstop", &r->lens->f_number))
        return false;
    if (json_object_get(root, "focal_length") &&
        !number(r, root, 0, "focal_length", &r->lens->nominal))
        return false;
    if (!number(r, root, 0, "aperture_index", &stop))
        return false;
    if (stop != floor(stop) || stop < 0 ||
        stop >= (double)json_array_size(elements))
        return imported_fail(r->lens, 0,
                             "\"aperture_index\" %g is none of the %d "
                             "\"lens_elements\", from 0",
                             stop, (int)json_array_size(elements));
    for (int k = 0; k < (int)json_array_size(elements); k++)
        if (!take_element(r, json_array_get(elements, (size_t)k), k,
                          k == (int)stop))
            return false;
    return imported_note(r->lens, 0, "coatings are not read");
}

bool import_realflare(struct imported *lens, const char *text, size_t bytes)
{
    struct realflare r = {lens, text, text + bytes};
    json_error_t error;
    json_t *root = json_loadb(text, bytes, JSON_REJECT_DUPLICATES, &error);
    bool good;

    if (!root)
        return imported_fail(lens, error.line, "%.150s", error.text);
    good = take(&r, root);
    json_decref(root);
    return good;
}
