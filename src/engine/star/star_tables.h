/* SPDX-License-Identifier: MIT
 *
 * Makes the tables of the starburst of a stop, at setup, in doubles.
 */
#ifndef GLINT_ENGINE_STAR_STAR_TABLES_H
#define GLINT_ENGINE_STAR_STAR_TABLES_H

#include "engine/star/smear.h"
#include "star/starburst.h"

struct glint_star_optics {
    int n_blades; /* number of blades, 3 .. GLINT_MAX_BLADES; 0: circle */
    double rotation_deg, f_number;
    double round, soft; /* as in struct glint_iris */
    double pixel_um;    /* side of a pixel on the sensor, um */
    bool draft;         /* true: coarser tables */
    bool has_core;      /* false: the core table, which only lamps that the
                           picture does not show need, is not made */
    /* diffraction by dirt in the stop, or NULL */
    const struct glint_smear *smear;
};

/* Returns airy_px: 550 nm times the f-number, pixels. */
static inline double
glint_star_compute_airy_px(const struct glint_star_optics *o)
{
    return 0.55 * o->f_number / o->pixel_um;
}

/* Makes the tables for optics O, to be freed by glint_star_tables_free().
 * Returns GLINT_E_MEMORY on failure. */
enum glint_status glint_star_tables_make(struct glint_star_tables **tables,
                                         const struct glint_star_optics *o);
/* Frees TABLES, which may be NULL. */
void glint_star_tables_free(struct glint_star_tables *tables);
size_t glint_star_tables_count_bytes(const struct glint_star_tables *tables);

#endif
