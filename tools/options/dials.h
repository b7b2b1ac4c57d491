/* SPDX-License-Identifier: MIT
 *
 * The dials that trade accuracy for time: one line each in dials.c, which is
 * all that glint sweep knows of them.
 */
#ifndef GLINT_TOOLS_OPTIONS_DIALS_H
#define GLINT_TOOLS_OPTIONS_DIALS_H

#include "options/scene.h"

enum {
    MAX_DIALS = 16,
    DIAL_VALUES = 10, /* of one dial by itself */
    DIAL_TOGETHER = 5 /* of these, in combination with the other dials' */
};

enum dial_kind { DIAL_INT, DIAL_BOOL, DIAL_DOUBLE };

struct dial {
    const char *name, *what; /* for tables; for plots */
    enum dial_kind kind;
    size_t at;        /* in struct scene */
    double standard;  /* what a scene has by default */
    bool opens;       /* a scene has to be opened anew for it */
    bool many_lights; /* does nothing to a single one */
    int n_values, n_together;
    double value[DIAL_VALUES], together[DIAL_TOGETHER];
};

extern const struct dial dials[];
extern const int n_dials;

void dial_set(struct scene *scene, const struct dial *dial, double value);
double dial_get(const struct scene *scene, const struct dial *dial);

#endif
