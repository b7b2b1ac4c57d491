/* SPDX-License-Identifier: MIT */
#include "bake/trace/coating.h"

#include "glint/trace.h"

double glint_reflectance(double n_from, double n_to, double cos_from,
                         double film_n, double film_phase)
{
    const double ratio = n_from / n_to;
    const double cos2 = 1.0 - ratio * ratio * (1.0 - cos_from * cos_from);

    if (!(cos_from > 0.0 && cos2 > 0.0))
        return 1.0; /* grazing incidence, or beyond the critical angle */
    if (film_n > 0.0) {
        const double inside = film_inside(n_from, cos_from, film_n);

        return film_reflectance(n_from, cos_from, n_to, sqrt(cos2), film_n,
                                inside, film_sine2(inside, film_phase));
    }
    return bare_reflectance(n_from, cos_from, n_to, sqrt(cos2));
}
