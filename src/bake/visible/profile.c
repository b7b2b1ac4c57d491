/* SPDX-License-Identifier: MIT
 *
 * Finds the boxes of a ghost through a range of angles. */
#include <math.h>

#include "bake/visible/boxes.h"
#include "engine/setup/degrees.h"

enum {
    AFRESH = 4, /* angles after which boxes are looked for everywhere again */
    AFRESH_SHAPED = 12 /* the same of shaped lenses, whose rays take long */
};

/* Returns BOX moved on by RATIO times the way from BEFORE to BOX. */
static struct glint_pupil predict(const struct glint_pupil *before,
                                  const struct glint_pupil *box, double ratio)
{
    const double step =
        0.5 * ratio * (box->x0_mm + box->x1_mm - before->x0_mm - before->x1_mm);
    struct glint_pupil p = *box;

    p.x0_mm += step;
    p.x1_mm += step;
    return p;
}

/* The boxes of visible light, by angle and wavelength. */
struct box_samples {
    bool seen[GLINT_PROFILE][GLINT_VISIBLE_WAVES];
    struct glint_pupil box[GLINT_PROFILE][GLINT_VISIBLE_WAVES];
};

/* Finds the boxes of one wavelength at the angles that WANTED marks. */
static void look(const struct glint_visible *h, const double *sine,
                 const bool *wanted, int wave, struct box_samples *g)
{
    const struct glint_path *path = &h->position_path[wave];
    struct glint_pupil box = {.y1_mm = 0}, before = box;
    int have = 0; /* number of angles in a row with a box */

    for (int k = 0; k < GLINT_PROFILE; k++) {
        const double *s = sine + k;
        struct glint_pupil near = box;
        bool now;

        if (!wanted[k]) {
            have = 0;
            continue;
        }
        if (have > 1)
            near = predict(&before, &box, (s[0] - s[-1]) / (s[-1] - s[-2]));
        before = box;
        now = have ? glint_boxes_follow(h, path, *s, &near, &box)
                   : glint_boxes_find(h, path, *s, &box);
        if (have && k % (h->shaped ? AFRESH_SHAPED : AFRESH) == 0 &&
            glint_boxes_find(h, path, *s, &near)) {
            if (now)
                glint_visible_join(&near, &box);
            box = near;
            now = true;
        }
        have = now ? have + 1 : 0;
        g->seen[k][wave] = now;
        g->box[k][wave] = box;
    }
}

static void add_angle(struct glint_visible_profile *p, double sine,
                      const struct box_samples *g, int k)
{
    const int first = p->n_samples;

    for (int wave = 0; wave < GLINT_VISIBLE_WAVES; wave++)
        if (g->seen[k][wave])
            p->sample[p->n_samples++] = (struct glint_box_sample){
                sine, -cos(GLINT_PI * wave / (GLINT_VISIBLE_WAVES - 1)),
                g->box[k][wave]};
    if (p->n_samples == first)
        return;
    p->sine[p->n] = sine;
    p->box[p->n] = p->sample[first].box;
    for (int i = first + 1; i < p->n_samples; i++)
        glint_visible_join(&p->box[p->n], &p->sample[i].box);
    p->n++;
}

/* Finds the boxes of one ghost at the angles SINE. If it is ALONE it is seen at
 * all of them in some colour, so that all wavelengths are tried where three are
 * not; one of several beside each other may be dark. */
static void find_boxes(const struct glint_visible *h, bool alone,
                       const double *sine, struct box_samples *g)
{
    bool wanted[GLINT_PROFILE];

    *g = (struct box_samples){.seen = {{false}}};
    for (int k = 0; k < GLINT_PROFILE; k++)
        wanted[k] = true;
    for (int i = 0; i < 3; i++)
        look(h, sine, wanted, glint_visible_colour[i], g);
    /* Where only some of the three colours get through, boxes of others may lie
     * between them. */
    for (int k = 0; k < GLINT_PROFILE; k++) {
        const int n = g->seen[k][glint_visible_colour[0]] +
                      g->seen[k][glint_visible_colour[1]] +
                      g->seen[k][glint_visible_colour[2]];

        wanted[k] = n < 3 && (n > 0 || alone);
    }
    for (int wave = 1; wave < GLINT_VISIBLE_WAVES - 1; wave++)
        if (wave != GLINT_VISIBLE_WAVES / 2)
            look(h, sine, wanted, wave, g);
}

/* Widens the boxes A to contain B. */
static void join_boxes(struct box_samples *a, const struct box_samples *b)
{
    for (int k = 0; k < GLINT_PROFILE; k++)
        for (int wave = 0; wave < GLINT_VISIBLE_WAVES; wave++) {
            if (a->seen[k][wave] && b->seen[k][wave])
                glint_visible_join(&a->box[k][wave], &b->box[k][wave]);
            else if (b->seen[k][wave])
                a->box[k][wave] = b->box[k][wave];
            a->seen[k][wave] |= b->seen[k][wave];
        }
}

void glint_visible_profile_find(const struct glint_visible *visible,
                                const double range[2],
                                struct glint_visible_profile *profile)
{
    struct box_samples g, other;
    double sine[GLINT_PROFILE];

    for (int k = 0; k < GLINT_PROFILE; k++) {
        const double t = sin(0.5 * GLINT_PI * k / (GLINT_PROFILE - 1));

        sine[k] = range[0] + t * (range[1] - range[0]);
    }
    find_boxes(visible, visible->n_beside == 0, sine, &g);
    for (int k = 0; k < visible->n_beside; k++) {
        find_boxes(&visible->beside[k], false, sine, &other);
        join_boxes(&g, &other);
    }
    profile->n = profile->n_samples = 0;
    for (int k = 0; k < GLINT_PROFILE; k++)
        add_angle(profile, sine[k], &g, k);
}
