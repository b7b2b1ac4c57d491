/* SPDX-License-Identifier: MIT */
#include "model/coating.h"

#include "glint/bake.h"

int coating_parse_option(const struct tool *tool, struct coating *c,
                         const char *text)
{
    static const char *const words[] = {"mixed", "table", NULL};
    struct glint_error error = {""};
    const int word = tool_find_word_index(text, words);

    c->given = true;
    c->text = text;
    c->kind = word < 0 ? COATING_DEALT : (enum coating_kind)word;
    if (word >= 0 || glint_coatings_parse(c->coating, &c->n_coatings, text,
                                          &error) == GLINT_OK)
        return -1;
    return tool_usage(
        tool,
        "--coating must be table, mixed, none or coatings NAME[/NM] or "
        "NM[/INDEX[:QUARTERS]]...[,...], such as 510/1.38/2.1:2/1.69, not "
        "'%s': %s",
        text, error.text);
}

static const char *find_coating_name(const struct glint_coating *coating)
{
    struct glint_coating known;
    const char *name;

    for (int k = 0; (name = glint_coating_named(k, &known)); k++) {
        bool same = known.n_films == coating->n_films;

        for (int i = 0; i < known.n_films && same; i++)
            same = known.film[i].index == coating->film[i].index &&
                   known.film[i].quarters == coating->film[i].quarters;
        if (same)
            return name;
    }
    return NULL;
}

void coating_print(FILE *file, const struct glint_coating *c)
{
    const char *name = find_coating_name(c);

    if (c->n_films == 0)
        fprintf(file, "none");
    else if (name)
        fprintf(file, "%s, %g nm", name, c->nm);
    else
        fprintf(file, "%g nm, index %g", c->nm, c->film[0].index);
    if (c->n_films == 0 || (c->n_films == 1 && c->film[0].quarters == 1))
        return;
    for (int i = 0; i < c->n_films; i++)
        fprintf(file, "%s%g:%g", i ? " " : " (", c->film[i].index,
                c->film[i].quarters);
    fprintf(file, ")");
}

const char *coating_get_text(const struct coating *c)
{
    return c->text ? c->text : c->kind == COATING_TABLE ? "table" : "mixed";
}

void coating_apply(const struct coating *c, struct glint_prescription *lens)
{
    struct glint_coating standard[GLINT_MAX_COATINGS];
    const int n = glint_coatings_mixed(standard);

    if (c->kind == COATING_DEALT)
        glint_prescription_coat(lens, c->coating, c->n_coatings);
    else if (c->kind == COATING_MIXED && lens->n_mixed)
        glint_prescription_coat(lens, lens->mixed, lens->n_mixed);
    else if (c->kind == COATING_MIXED)
        glint_prescription_coat(lens, standard, n);
}

int coating_reject_option_for_model(const struct tool *tool,
                                    const struct coating *c, const char *path)
{
    return c->given ? tool_usage(tool,
                                 "%s is a model, baked with its coatings: "
                                 "--coating needs the lens table",
                                 path)
                    : EXIT_OK;
}
