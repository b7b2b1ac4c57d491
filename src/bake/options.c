/* SPDX-License-Identifier: MIT */
#include "bake/options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bake/visible/visible.h"
#include "glint/model.h"

enum {
    /* Versions of the models: raised if a lens would bake to another model. */
    REVISION = 13,
    WIDE_REVISION = 17, /* of those of lenses that open wider than GLINT_WIDE */
    SHAPED_REVISION =
        1,             /* besides, of those with surfaces that are no spheres */
    SKEW_REVISION = 2, /* of those that are not round */
    FAR_REVISION = 3   /* and of round ones with lights beyond GLINT_FAR */
};

void glint_bake_defaults(struct glint_bake_options *options)
{
    *options = (struct glint_bake_options){
        .band_nm = {400, 700}, .max_deg = 60, .tolerance = 1};
}

enum glint_status glint_bake_check(const struct glint_bake_options *options,
                                   struct glint_error *error)
{
    const struct glint_bake_options *const o = options;
    const char *wrong =
        !(o->band_nm[0] >= 300 && o->band_nm[1] <= 1100 &&
          o->band_nm[0] + 1 <= o->band_nm[1])
            ? "the band must rise by 1 nm or more within 300 to 1100 nm"
        : !(o->max_deg > 0 && o->max_deg <= 89)
            ? "the largest angle must be above 0 and at most 89 degrees"
        : !(o->field_mm >= 0 && o->field_mm < 1e6)
            ? "the field must be a length"
        : !(o->tolerance >= 0.1 && o->tolerance <= 100)
            ? "the tolerance must be 0.1 to 100"
        : !(o->n_beside >= 0 && o->n_beside <= GLINT_MAX_BESIDE) ||
                (o->n_beside > 0 && !o->beside)
            ? "a position has none, one or two beside it"
            : NULL;

    if (wrong)
        snprintf(error->text, sizeof error->text, "%s", wrong);
    return wrong ? GLINT_E_ARGUMENT : GLINT_OK;
}

double glint_bake_field_mm(const struct glint_prescription *lens,
                           const struct glint_bake_options *o)
{
    return o->field_mm > 0
               ? o->field_mm
               : 0.55 * hypot(lens->film_width_mm, lens->film_height_mm);
}

/* Adds the bytes of a number to a key, by FNV-1a. */
static void mix(uint64_t *key, double value)
{
    unsigned char byte[sizeof value];

    memcpy(byte, &value, sizeof value);
    for (size_t i = 0; i < sizeof byte; i++)
        *key = (*key ^ byte[i]) * UINT64_C(0x100000001b3);
}

/* Mixes in what makes COATING differ; a single quarter wave as ever, so that
 * models that are kept stay good. */
static void mix_coating(uint64_t *key, const struct glint_coating *coating)
{
    mix(key, coating->nm);
    mix(key, coating->film[0].index);
    if (coating->n_films == 0 ||
        (coating->n_films == 1 && coating->film[0].quarters == 1.0))
        return;
    mix(key, coating->n_films);
    for (int k = 0; k < coating->n_films; k++) {
        mix(key, coating->film[k].index);
        mix(key, coating->film[k].quarters);
    }
}

static void mix_shape(uint64_t *key, const struct glint_shape *s)
{
    mix(key, SHAPED_REVISION);
    mix(key, s->conic);
    for (int k = 0; k < GLINT_SHAPE_TERMS; k++)
        mix(key, s->term[k]);
    mix(key, s->bend);
    mix(key, s->across_mm);
    for (int k = 0; k < 2; k++) {
        mix(key, s->decentre_mm[k]);
        mix(key, s->tilt_deg[k]);
    }
    mix(key, s->pivot_mm);
}

static void mix_lens(uint64_t *key, const struct glint_prescription *lens)
{
    mix(key, lens->f_number);
    mix(key, lens->film_width_mm);
    mix(key, lens->film_height_mm);
    mix(key, lens->stop_after);
    mix(key, lens->stop_thickness_mm);
    for (int k = 0; k < lens->n_surfaces; k++) {
        const struct glint_surface *s = &lens->surface[k];

        mix(key, s->radius_mm);
        mix(key, s->thickness_mm);
        mix(key, s->semi_mm);
        mix(key, s->nd);
        mix(key, s->vd);
        for (int i = 0; i < 6 && s->sellmeier[0] > 0; i++)
            mix(key, s->sellmeier[i]);
        mix_coating(key, &s->coating);
        if (glint_surface_is_shaped(s))
            mix_shape(key, &s->shape);
    }
}

uint64_t glint_bake_key(const struct glint_prescription *lens,
                        const struct glint_bake_options *options)
{
    uint64_t key = UINT64_C(0xcbf29ce484222325);

    mix(&key, GLINT_MODEL_VERSION);
    mix(&key, lens->f_number < GLINT_WIDE ? WIDE_REVISION : REVISION);
    mix(&key, GLINT_BASIS_AUTO);
    mix(&key, options->band_nm[0]);
    mix(&key, options->band_nm[1]);
    mix(&key, options->max_deg);
    mix(&key, glint_bake_field_mm(lens, options));
    mix(&key, options->tolerance);
    for (int g = 0; options->ghosts && g < glint_ghost_list(lens, NULL, 0); g++)
        mix(&key, options->ghosts[g]);
    mix_lens(&key, lens);
    for (int k = 0; k < options->n_beside; k++)
        mix_lens(&key, &options->beside[k]);
    if (!glint_prescription_is_round(lens))
        mix(&key, SKEW_REVISION);
    else if (options->max_deg > GLINT_FAR)
        mix(&key, FAR_REVISION);
    for (const char *c = lens->name; *c; c++)
        mix(&key, (unsigned char)*c);
    return key;
}
