/* SPDX-License-Identifier: MIT
 *
 * The dials that trade accuracy for time: one line each in dials.c, which is
 * all that glint sweep knows of them.
 */
#ifndef GLINT_TOOLS_OPTIONS_DIALS_H
#define GLINT_TOOLS_OPTIONS_DIALS_H

#include "model/settings.h"

enum {
    MAX_DIALS = 16,
    DIAL_VALUES = 10, /* values of one dial by itself */
    DIAL_TOGETHER =
        5 /* values of one dial that are combined with other dials' */
};

enum dial_id {
    DIAL_GRID,
    DIAL_QUANTUM,
    DIAL_CULL,
    DIAL_DIM,
    DIAL_WHOLE,
    DIAL_HALF,
    DIAL_TOLERANCE,
    DIAL_WAVELENGTHS,
    DIAL_TILE,
    DIAL_APART,
    DIAL_MAX_LIGHTS
};

struct dial {
    const char *name, *what; /* words for tables, and for plots */
    enum dial_id id;
    double standard;  /* value by default */
    bool opens;       /* Settings have to be opened anew for it. */
    bool many_lights; /* has no effect on a single light */
    int n_values, n_together;
    double value[DIAL_VALUES], together[DIAL_TOGETHER];
};

extern const struct dial dials[];
extern const int n_dials;

void dial_set(struct settings *settings, const struct dial *dial, double value);
double dial_get(const struct settings *settings, const struct dial *dial);

#endif
