/* SPDX-License-Identifier: MIT
 *
 * values.h - compares and copies the filter's parameter values.
 */
#ifndef GLINT_TOOLS_FILTER_VALUES_H
#define GLINT_TOOLS_FILTER_VALUES_H

#include "filter/filter.h"

/* Indices of the parameters that are not options. */
enum { FILTER_AUTO = 5, FILTER_X, FILTER_Y };

bool filter_is_default(const struct filter_parameter *parameter, double number);

/* Copies FROM to TO, without freeing the old texts of TO. */
void filter_values_copy(struct filter_values *to,
                        const struct filter_values *from);

/* Returns whether all values that are not live are equal in A and B. */
bool filter_values_same_except_live(const struct filter_values *a,
                                    const struct filter_values *b);

#endif
