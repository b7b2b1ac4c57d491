/* SPDX-License-Identifier: MIT */
#include "lamp_files/lamp_keys.h"

#include <math.h>
#include <stdlib.h>

uint32_t lamp_hash_id(const char *text)
{
    uint32_t id = 2166136261u; /* FNV-1a */
    uint64_t number = 0;
    const char *digit = text;

    for (; *digit >= '0' && *digit <= '9' && number <= UINT32_MAX; digit++)
        number = 10 * number + (uint64_t)(*digit - '0');
    if (!*digit && *text != '0' && number > 0 && number <= UINT32_MAX)
        return (uint32_t)number;
    for (; *text; text++)
        id = (id ^ (unsigned char)*text) * 16777619u;
    return id | LAMP_ID_TEXT;
}

/* ---------------------------------------------------- key frames of a lamp */

struct key {
    int row, frame;
    /* identity of the lamp: 2^32 + id; for a lamp without an id, its index
     * among the frame's lamps without ids */
    uint64_t lamp;
};

static int compare_key_frames(const void *a, const void *b)
{
    const struct key *x = a, *y = b;

    if (x->frame != y->frame)
        return x->frame < y->frame ? -1 : 1;
    return (x->row > y->row) - (x->row < y->row);
}

static int compare_lamp_ids(const void *a, const void *b)
{
    const struct key *x = a, *y = b;

    if (x->lamp != y->lamp)
        return x->lamp < y->lamp ? -1 : 1;
    return compare_key_frames(a, b);
}

/* Sets the member LAMP of KEY[N], which must be sorted by frame. */
static void identify_lamps_of_keys(struct key *key, int n,
                                   const struct lamp_list *list)
{
    int place = 0;

    for (int i = 0; i < n; i++) {
        const uint32_t id = list->row[key[i].row].id;

        place = i > 0 && key[i].frame == key[i - 1].frame ? place : 0;
        key[i].lamp = id ? (uint64_t)1 << 32 | id : (uint64_t)place++;
    }
}

enum glint_status lamp_keys_link_rows(struct lamp_list *list)
{
    struct key *key = malloc(((size_t)list->n + 1) * sizeof *key);
    int n = 0;

    if (!key)
        return GLINT_E_MEMORY;
    for (int i = 0; i < list->n; i++)
        if (list->row[i].frame >= 0)
            key[n++] = (struct key){i, list->row[i].frame, 0};
    qsort(key, (size_t)n, sizeof *key, compare_key_frames);
    identify_lamps_of_keys(key, n, list);
    qsort(key, (size_t)n, sizeof *key, compare_lamp_ids);
    for (int i = 0; i + 1 < n; i++)
        if (key[i].lamp == key[i + 1].lamp)
            list->row[key[i].row].next = key[i + 1].row;
    free(key);
    return GLINT_OK;
}

static double interpolate_linearly(double a, double b, double t)
{
    return a + (b - a) * t;
}

bool lamp_keys_interpolate_at(const struct lamp_list *list, int i, int frame,
                              struct lamp_row *row)
{
    const struct lamp_row *a = &list->row[i];
    const struct lamp_row *b = a->next >= 0 ? &list->row[a->next] : NULL;
    double t;

    *row = *a;
    if (a->frame == -1 || a->frame == frame)
        return true;
    if (!b || a->frame > frame || b->frame <= frame)
        return false;
    t = (double)(frame - a->frame) / (b->frame - a->frame);
    row->x = interpolate_linearly(a->x, b->x, t);
    row->y = interpolate_linearly(a->y, b->y, t);
    row->size = interpolate_linearly(a->size, b->size, t);
    row->shape = interpolate_linearly(a->shape, b->shape, t);
    row->turn = a->turn + t * remainder(b->turn - a->turn, 180);
    row->level = interpolate_linearly(a->level, b->level, t);
    row->seen = interpolate_linearly(a->seen, b->seen, t);
    row->power =
        a->power > 0 && b->power > 0
            ? exp2(interpolate_linearly(log2(a->power), log2(b->power), t))
            : interpolate_linearly(a->power, b->power, t);
    for (int c = 0; c < 3; c++)
        row->rgb[c] = interpolate_linearly(a->rgb[c], b->rgb[c], t);
    return true;
}

static int list_lamp_ids_at_frame(const struct lamp_list *list, int frame,
                                  uint32_t id[GLINT_ENGINE_MAX_LAMPS])
{
    struct lamp_row row;
    int n = 0;

    for (int i = 0; i < list->n && n < GLINT_ENGINE_MAX_LAMPS; i++)
        if (list->row[i].id && lamp_keys_interpolate_at(list, i, frame, &row))
            id[n++] = row.id;
    return n;
}

bool lamp_keys_is_cut(const struct lamp_list *list, int frame)
{
    uint32_t now[GLINT_ENGINE_MAX_LAMPS], before[GLINT_ENGINE_MAX_LAMPS];
    const int n = list_lamp_ids_at_frame(list, frame, now);
    const int m =
        n && frame > 0 ? list_lamp_ids_at_frame(list, frame - 1, before) : 0;

    for (int i = 0; i < n; i++)
        for (int k = 0; k < m; k++)
            if (now[i] == before[k])
                return false;
    return n > 0 && m > 0;
}
