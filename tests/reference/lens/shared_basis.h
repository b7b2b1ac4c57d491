/* SPDX-License-Identifier: MIT
 *
 * Finds one sparse basis for many zones of a ghost.
 *
 *   in   rays of some zones
 *   out  the few monomials that serve all of them
 *
 * Method: adaptive sparse regression [Zheng17], as [Bodonyi25] shares it among
 * zones. A basis begins with its best single term. It then grows by a term that
 * is one exponent away from one of its terms, or by a pure power; terms are
 * swapped for such terms while that helps; a term is dropped if the basis
 * without it beats the best known basis of that size. The error is the mean
 * over the zones of the weighted squared error (shared_zone.h). Outputs that
 * are even in y get even powers of y only, odd outputs odd powers.
 *
 * Limits: a local search; it tries only the neighbours named above. */
#ifndef REFERENCE_LENS_SHARED_BASIS_H
#define REFERENCE_LENS_SHARED_BASIS_H

#include "reference/lens/shared_zone.h"

/* Finds the basis of output KIND for RAYS[N_ZONES], N_ZONES >= 1: the smallest
 * one with at most MAX_TERMS whose root mean square error is at most
 * TOLERANCE, or the best one. ZONE[N_ZONES] is scratch. */
void glint_shared_search(struct glint_shared_zone *zone,
                         const struct glint_shared_rays *rays, int n_zones,
                         enum glint_channel kind, int max_terms,
                         double tolerance, struct glint_shared_basis *basis);

#endif
