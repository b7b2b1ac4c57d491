/* SPDX-License-Identifier: MIT */
#include "options/coating.h"

#include "glint/bake.h"

int coating_take(const struct tool *tool, struct coating *c, const char *text)
{
    static const char *const words[] = {"table", "mixed", NULL};
    struct glint_error error = {""};
    const int word = tool_word(text, words);

    c->given = true;
    c->kind = word < 0 ? COATING_FILMS : (enum coating_kind)word;
    if (word >= 0 ||
        glint_films_parse(c->film, &c->n_films, text, &error) == GLINT_OK)
        return -1;
    return tool_usage(tool,
                      "--coating takes table, mixed, none or films "
                      "NM[/INDEX][,...], not '%s': %s",
                      text, error.text);
}

void coating_apply(const struct coating *c, struct glint_prescription *lens)
{
    struct glint_film standard[GLINT_MAX_FILMS];
    const int n = glint_films_mixed(standard);

    if (c->kind == COATING_FILMS)
        glint_prescription_coat(lens, c->film, c->n_films);
    else if (c->kind == COATING_MIXED && lens->n_mixed)
        glint_prescription_coat(lens, lens->mixed, lens->n_mixed);
    else if (c->kind == COATING_MIXED)
        glint_prescription_coat(lens, standard, n);
}

int coating_of_model(const struct tool *tool, const struct coating *c,
                     const char *path)
{
    return c->given ? tool_usage(tool,
                                 "%s is a model, baked with its coatings: "
                                 "--coating needs the lens table",
                                 path)
                    : EXIT_OK;
}
