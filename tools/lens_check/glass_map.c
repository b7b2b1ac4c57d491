/* SPDX-License-Identifier: MIT */
#include "lens_check/glass_map.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Ends of the map of glasses: the least and the largest Vd at an nd. Makers'
 * maps from fluorite and fluor crowns over the lanthanum crowns to the densest,
 * and down the flints, with lead and without; two widths of a label beyond. */
static const struct {
    double nd, least, most;
} ends[] = {{1.42, 60.0, 97.5}, {1.45, 56.0, 96.0}, {1.50, 48.0, 84.0},
            {1.55, 40.0, 77.5}, {1.60, 33.5, 70.0}, {1.65, 29.0, 63.0},
            {1.70, 26.0, 59.0}, {1.75, 23.5, 55.0}, {1.80, 21.0, 50.0},
            {1.85, 19.0, 46.0}, {1.90, 17.5, 41.0}, {2.00, 15.5, 33.0},
            {2.20, 14.0, 26.0}};

enum { N_ENDS = sizeof ends / sizeof *ends };

/* Plastics of phone lenses have a lower Vd than flints of their nd: from 1.529,
 * 45.4 by polycarbonate, 1.585, 29.9, to the densest, 1.705, 14.0. */
static bool is_plastic(double nd, double vd)
{
    const double slope = nd < 1.585 ? 270 : 125;
    const double least = 28.5 - (nd - 1.585) * slope;

    return nd >= 1.525 && nd <= 1.71 && vd >= least &&
           vd <= fmax(least + 6.5, 35);
}

/* Returns whether there is, or has been, a glass like that: not beyond the
 * crowns and fluorides, nor beyond the flints; if MOULDED, also a plastic. */
static bool is_known_glass(double nd, double vd, bool moulded)
{
    int k = 0;
    double part;

    if (moulded && is_plastic(nd, vd))
        return true;
    if (!(nd >= ends[0].nd && nd <= ends[N_ENDS - 1].nd))
        return false;
    while (k < N_ENDS - 2 && nd > ends[k + 1].nd)
        k++;
    part = (nd - ends[k].nd) / (ends[k + 1].nd - ends[k].nd);
    return vd >= ends[k].least + part * (ends[k + 1].least - ends[k].least) &&
           vd <= ends[k].most + part * (ends[k + 1].most - ends[k].most);
}

bool glass_is_listed(const struct glint_prescription *lens, int k)
{
    const struct glint_surface *s = &lens->surface[k];
    const struct glint_glass *glass;

    for (int i = 0; i < lens->n_surfaces; i++)
        if (i != k && fabs(lens->surface[i].nd - s->nd) < 2e-6 &&
            fabs(lens->surface[i].vd - s->vd) < 0.05)
            return true;
    for (int i = 0; (glass = glint_glass_at(i)) != NULL; i++) {
        struct glint_surface known = {.nd = 1};
        double nd, spread;

        memcpy(known.sellmeier, glass->sellmeier, sizeof known.sellmeier);
        nd = glint_surface_index(&known, 587.5618);
        spread = glint_surface_index(&known, 486.1327) -
                 glint_surface_index(&known, 656.2725);
        if (fabs(nd - s->nd) < 2e-5 && fabs((nd - 1) / spread - s->vd) < 0.3)
            return true;
    }
    return false;
}

/* Returns whether the glass behind S, which is not the last surface, has a side
 * that is ground by nobody. */
static bool is_moulded(const struct glint_surface *s)
{
    return glint_surface_is_shaped(&s[0]) || glint_surface_is_shaped(&s[1]);
}

/* Returns whether ND has more than three decimals: rounder ones are shared, as
 * 1.755 is by a lanthanum crown and a flint. */
static bool is_precise(double nd)
{
    return fabs(1e3 * nd - nearbyint(1e3 * nd)) > 1e-6;
}

int glass_suspect(const struct glint_prescription *lens, char *text,
                  size_t bytes)
{
    for (int k = 0; k < lens->n_surfaces; k++) {
        const struct glint_surface *s = &lens->surface[k];

        if (!(s->vd > 0))
            continue;
        if (!is_known_glass(s->nd, s->vd, is_moulded(s))) {
            snprintf(text, bytes, "no glass has nd %.6g and Vd %.4g", s->nd,
                     s->vd);
            return k;
        }
        for (int i = 0; i < k && is_precise(s->nd); i++)
            if (fabs(lens->surface[i].nd - s->nd) < 2e-6 &&
                fabs(lens->surface[i].vd - s->vd) > 1.5) {
                snprintf(text, bytes,
                         "nd %.6g has Vd %.4g here and %.4g at surface %d",
                         s->nd, s->vd, lens->surface[i].vd, i);
                return k;
            }
    }
    return -1;
}
