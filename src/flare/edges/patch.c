/* SPDX-License-Identifier: MIT
 *
 * Stores patches (patch.h) in slots of the edge array, so that patches are
 * sorted into tiles like edges. */
#include "flare/edges/patch.h"

enum { WORDS = 7 }; /* number of 32-bit data words in an array element */

static void write_patch_word(struct glint_edge *e, int i, int32_t word)
{
    int32_t *const at[5] = {&e->x_q8, &e->y_q8, &e->end_y_q8, &e->left,
                            &e->right};
    const uint64_t both = (uint64_t)e->slope_q40;

    if (i < 5)
        *at[i] = word;
    else if (i == 5)
        e->slope_q40 =
            (int64_t)((both & ~(uint64_t)UINT32_MAX) | (uint32_t)word);
    else
        e->slope_q40 =
            (int64_t)((both & UINT32_MAX) | (uint64_t)(uint32_t)word << 32);
}

static int32_t read_patch_word(const struct glint_edge *e, int i)
{
    const int32_t at[5] = {e->x_q8, e->y_q8, e->end_y_q8, e->left, e->right};

    return i < 5 ? at[i]
                 : (int32_t)((uint64_t)e->slope_q40 >> (i == 5 ? 0 : 32));
}

void glint_patch_fill_empty_slots(struct glint_edge *edge, int n)
{
    for (int i = 0; i < n; i++)
        edge[i] = (struct glint_edge){.patch = 1, .whole = 1};
}

void glint_patch_write_slots(struct glint_edge *edge,
                             const struct glint_patch *p, unsigned bundle)
{
    int k = 0;

    glint_patch_fill_empty_slots(edge, glint_patch_count_slots(p->n));
    edge[0] = (struct glint_edge){.slope_q40 = 0,
                                  .x_q8 = p->box.x0 * 256,
                                  .y_q8 = p->box.y0 * 256,
                                  .end_y_q8 = p->box.y1 * 256,
                                  .left = p->light,
                                  .right = p->box.x1 - 1,
                                  .bundle = bundle & 0x3fffffff,
                                  .patch = 1};
    edge++;
    for (int i = 0; i < 2; i++) {
        const int32_t word[3] = {p->at_q24[i], p->across_q24[i],
                                 p->down_q24[i]};

        for (int j = 0; j < 3; j++, k++)
            write_patch_word(&edge[k / WORDS], k % WORDS, word[j]);
    }
    write_patch_word(&edge[k / WORDS], k % WORDS,
                     p->n * 64 + p->level * 2 + p->clear);
    k++;
    for (int i = 0; i < p->n; i++) {
        write_patch_word(&edge[k / WORDS], k % WORDS, p->x_q8[i]);
        k++;
        write_patch_word(&edge[k / WORDS], k % WORDS, p->y_q8[i]);
        k++;
    }
}

void glint_patch_read_slots(struct glint_patch *p,
                            const struct glint_edge *edge)
{
    const struct glint_edge *e = edge + 1;
    int k = 0;

    p->box = (struct glint_box){edge->x_q8 >> 8, edge->y_q8 >> 8,
                                edge->right + 1, edge->end_y_q8 >> 8};
    p->light = edge->left;
    for (int i = 0; i < 2; i++) {
        int32_t *const word[3] = {&p->at_q24[i], &p->across_q24[i],
                                  &p->down_q24[i]};

        for (int j = 0; j < 3; j++, k++)
            *word[j] = read_patch_word(&e[k / WORDS], k % WORDS);
    }
    p->n = read_patch_word(&e[k / WORDS], k % WORDS);
    k++;
    p->clear = p->n & 1;
    p->level = p->n >> 1 & 31;
    p->n >>= 6;
    for (int i = 0; i < p->n; i++) {
        p->x_q8[i] = read_patch_word(&e[k / WORDS], k % WORDS);
        k++;
        p->y_q8[i] = read_patch_word(&e[k / WORDS], k % WORDS);
        k++;
    }
}
