/* SPDX-License-Identifier: MIT
 *
 * Joins models at the positions of a zoom lens into one file; format:
 * glint/model.h.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bake/table/draft.h"
#include "glint/bake.h"
#include "glint/model.h"

/* Appends a bit mask that states which ghosts of the zoom lens MODEL contains.
 * Returns its offset in the file, or 0 if MODEL contains all of them. */
static uint32_t append_ghost_mask(struct glint_draft *d,
                                  const struct glint_bake_model *model)
{
    const struct glint_model_header *const h = (const void *)model->data;
    const uint32_t n = h->n_ghosts - h->n_parts;
    uint32_t at = 0;

    for (uint32_t word = 0; model->ghosts && word < (n + 31) / 32; word++) {
        uint32_t bits = 0, to;

        for (uint32_t g = 32 * word; g < n && g < 32 * word + 32; g++)
            bits |= (uint32_t)model->ghosts[g] << g % 32;
        to = glint_draft_append(d, &bits, sizeof bits);
        at = word ? at : to;
    }
    return at;
}

/* Appends all models to the file and writes their table at offset LIST_AT. */
static void append_zoom_models(struct glint_draft *d, uint32_t list_at,
                               const struct glint_bake_model *model, int n)
{
    for (int k = 0; k < n; k++) {
        struct glint_zoom_model entry = {.along_q30 = model[k].along_q30,
                                         .bytes = (uint32_t)model[k].bytes};

        entry.at = glint_draft_append(d, model[k].data, model[k].bytes);
        entry.has_at = append_ghost_mask(d, &model[k]);

        glint_draft_overwrite(d, list_at + (uint32_t)k * (uint32_t)sizeof entry,
                              &entry, sizeof entry);
    }
}

/* Checks that glint_zoom_open() accepts the finished file. */
static enum glint_status check_zoom_opens(const unsigned char *data,
                                          size_t bytes,
                                          struct glint_error *error)
{
    struct glint_zoom_lens *const zoom = malloc(sizeof *zoom);
    enum glint_status status = GLINT_E_MEMORY;
    const char *reason;

    if (zoom &&
        (status = glint_zoom_open(zoom, data, bytes, &reason)) != GLINT_OK)
        snprintf(error->text, sizeof error->text, "%s", reason);
    free(zoom);
    return status;
}

enum glint_status glint_bake_zoom(const struct glint_bake_model *model, int n,
                                  unsigned char **zoom, size_t *bytes,
                                  struct glint_error *error)
{
    const struct glint_model_header *const first = (const void *)model[0].data;
    struct glint_zoom_header header = {.magic = GLINT_ZOOM_MAGIC,
                                       .version = GLINT_ZOOM_VERSION,
                                       .n_models = (uint32_t)n};
    struct glint_draft draft = {0};
    unsigned char *data;
    enum glint_status status;

    error->text[0] = 0;
    memcpy(header.name, first->name, sizeof header.name);
    for (int k = 0; k < n; k++)
        for (int i = 0; i < 2; i++)
            header.key[i] =
                header.key[i] * UINT32_C(16777619) ^
                ((const struct glint_model_header *)(const void *)model[k].data)
                    ->key[i];
    glint_draft_append(&draft, NULL, sizeof header);
    header.model_at = glint_draft_append(
        &draft, NULL, (size_t)n * sizeof(struct glint_zoom_model));
    append_zoom_models(&draft, header.model_at, model, n);
    if (!glint_draft_finish_file(&draft, &header, sizeof header, true, &data,
                                 bytes))
        return GLINT_E_MEMORY;
    status = check_zoom_opens(data, *bytes, error);
    if (status == GLINT_OK)
        *zoom = data;
    else
        free(data);
    return status;
}
