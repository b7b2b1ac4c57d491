/* SPDX-License-Identifier: MIT
 *
 * Lines on translucent stone, and what objects of it need. */
#include "bake/scene/describe.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "glint/scene/translucent.h"

/* A texel may be as much longer or shorter than in the mean, and this share of
 * the surface more, before that is warned of. */
#define MOST_STRETCH   1.5
#define STRETCHED_AREA .02

/* ---------------------------------------------------------------- materials */

/* Reads the stone WORD names. */
static bool read_file(struct glint_describer *d, const struct glint_word *word,
                      struct glint_described_material *m)
{
    struct glint_description *s = d->scene;
    struct glint_described_stone *stone = &s->stone[s->n_stones];
    struct glint_translucent opened;
    char name[GLINT_FILE_BYTES];
    const char *reason = "";
    enum glint_status status;

    if (s->n_stones == GLINT_DESCRIPTION_MAX_STONES)
        return glint_text_fail(&d->text, word->place,
                               "more than %d translucent materials",
                               GLINT_DESCRIPTION_MAX_STONES);
    if (!d->files->stone)
        return glint_text_fail(&d->text, word->place, "no stone is read here");
    glint_describe_file(word, name);
    status = d->files->stone(d->files->ctx, name, &stone->data, &stone->bytes,
                             d->error);
    if (status != GLINT_OK)
        return glint_describe_refuse(d, word->place, status);
    m->stone = s->n_stones++;
    return glint_translucent_open(&opened, stone->data, stone->bytes,
                                  &reason) == GLINT_OK ||
           glint_text_fail(&d->text, word->place, "%s", reason);
}

static bool read_fresnel(struct glint_describer *d,
                         const struct glint_word *word,
                         struct glint_described_material *m)
{
    char quote[GLINT_QUOTE_BYTES];

    m->fresnel = !glint_word_is(word, "off");
    return glint_word_is(word, "on") || glint_word_is(word, "off") ||
           glint_text_fail(&d->text, word->place,
                           "fresnel is on or off, not '%s'",
                           glint_word_quote(word, quote));
}

bool glint_describe_stone(struct glint_describer *d,
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

    (void)texture; /* the stone has its own pattern */
    m->is_stone = m->fresnel = true;
    glint_text_next_word(&d->text); /* translucent */
    file = glint_text_next_word(&d->text);
    if (!file.length)
        return glint_text_fail(&d->text, file.place,
                               "the stone's file is missing");
    if (!glint_clauses_read(&d->text, "material", clause) ||
        (fresnel.length && !read_fresnel(d, &fresnel, m)) ||
        !read_file(d, &file, m))
        return false;
    m->is_metal = coat.length > 0;
    if (m->is_metal && !glint_word_is(&coat, "ward"))
        return glint_text_fail(&d->text, coat.place, "a coat is ward, not '%s'",
                               glint_word_quote(&coat, quote));
    for (int i = 1; i <= 3; i++)
        if (clause[i].place.line && !m->is_metal)
            return glint_text_fail(&d->text, clause[i].place,
                                   "'%s' needs 'coat ward'", clause[i].word);
    for (int i = 1; i <= 2; i++)
        if (!clause[i].place.line && m->is_metal)
            return glint_text_fail(&d->text, coat.place, "a coat needs '%s'",
                                   clause[i].word);
    return !m->is_metal || glint_describe_lobe(d, m, &norm);
}

/* ------------------------------------------------------------------ objects */

/* Sets SHORT and LONG to how long a step of one in the square of u and v is on
 * triangle T, at least and at most; returns its area, 0 if it has none there.
 */
static double stretch_of(const struct glint_described_triangle *t,
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

/* Warns where texels of the mesh have other sizes than in the mean. */
static void check_stretch(struct glint_describer *d,
                          const struct glint_described_object *o, int material)
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
            of = stretch_of(&t[i], &shortest, &longest);
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
                 "mesh %s: its texels are stretched up to %.3g times, over 1.5 "
                 "on %.0f %% of the stone: light spreads as much farther there",
                 o->name, worst, 100 * stretched / area);
}

/* Checks triangle T of stone; FIRST is the stone of those before, or -1. */
static bool check_triangle(struct glint_describer *d,
                           const struct glint_described_triangle *t,
                           struct glint_text_place place, int *first)
{
    const struct glint_described_material *m = &d->scene->material[t->material];

    if (!t->has_uv)
        return glint_text_fail(&d->text, place,
                               "material %s is translucent, but a face has no "
                               "places on its map (uv, vt)",
                               m->name);
    if (*first >= 0 && *first != t->material)
        return glint_text_fail(&d->text, place,
                               "materials %s and %s are both translucent: a "
                               "mesh has one map",
                               d->scene->material[*first].name, m->name);
    *first = t->material;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 2; i++)
            if (t->uv[k][i] < -1e-6 || t->uv[k][i] > 1 + 1e-6)
                return glint_text_fail(&d->text, place,
                                       "u and v of what is translucent are 0 "
                                       "to 1, not %.4g: each place has a texel "
                                       "of its own",
                                       t->uv[k][i]);
    return true;
}

bool glint_describe_skin(struct glint_describer *d,
                         const struct glint_described_object *o,
                         struct glint_text_place place)
{
    const struct glint_description *s = d->scene;
    int first = -1;

    if (o->kind == GLINT_DESCRIBED_PLANE && s->material[o->material].is_stone)
        return glint_text_fail(&d->text, place,
                               "a plane has no end, and so no map: what is "
                               "translucent is a sphere or has uv");
    for (int i = 0; i < o->n_triangles; i++) {
        const struct glint_described_triangle *t =
            &s->triangle[o->first_triangle + i];

        if (s->material[t->material].is_stone &&
            !check_triangle(d, t, place, &first))
            return false;
    }
    if (first >= 0)
        check_stretch(d, o, first);
    return true;
}
