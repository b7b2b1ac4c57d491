/* SPDX-License-Identifier: MIT
 *
 * Lines on brushed metal. */
#include "bake/scene/describe.h"

#include <math.h>
#include <stdio.h>

/* What rounding may add to colours that sum to 1. */
#define SLACK 1e-9

static bool read_norm(struct glint_describer *d, const struct glint_word *word,
                      struct glint_described_material *m)
{
    char quote[GLINT_QUOTE_BYTES];

    m->norm = glint_word_is(word, "1992") ? GLINT_DESCRIBED_1992
                                          : GLINT_DESCRIBED_BOUNDED;
    return glint_word_is(word, "1992") || glint_word_is(word, "bounded") ||
           glint_text_fail(&d->text, word->place,
                           "a norm is bounded or 1992, not '%s'",
                           glint_word_quote(word, quote));
}

/* Holds the smaller alpha at a tenth of the other, with a warning. */
static void hold_ratio(struct glint_describer *d,
                       struct glint_described_material *m)
{
    const int smaller = m->alpha[0] > m->alpha[1];
    const double least = m->alpha[1 - smaller] / GLINT_DESCRIPTION_MAX_RATIO;

    if (m->alpha[smaller] >= least * (1 - SLACK))
        return;
    if (!d->scene->warning[0])
        snprintf(d->scene->warning, sizeof d->scene->warning,
                 "material %s: alphas of %.4g and %.4g are held to a ratio of "
                 "%d: the smaller is %.4g",
                 m->name, m->alpha[0], m->alpha[1], GLINT_DESCRIPTION_MAX_RATIO,
                 least);
    m->alpha[smaller] = least;
}

bool glint_describe_lobe(struct glint_describer *d,
                         struct glint_described_material *m,
                         const struct glint_word *norm)
{
    if (norm->length && !read_norm(d, norm, m))
        return false;
    hold_ratio(d, m);
    return true;
}

bool glint_describe_metal(struct glint_describer *d,
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
            return glint_text_fail(&d->text, clause[1].place,
                                   "'diffuse' and 'specular' sum to %.6g; more "
                                   "than 1 would make light",
                                   m->colour[c] + m->metal[c]);
    return glint_describe_lobe(d, m, &norm);
}
