/* SPDX-License-Identifier: MIT */
#include "desk/styles.h"

#include <stddef.h>
#include <string.h>

/* Styles differ in the shapes, colours and positions of ghosts, not in
 * brightness: at a given --strength the automatic exposure makes all lenses and
 * coatings equally bright. */
const struct style styles[] = {
    {"natural", "a current zoom lens, the default of overlay", {{NULL, NULL}}},
    {"clean",
     "the same with nine blades and a weak flare",
     {{"stop", "polygon:9,round:0.5"},
      {"strength", "0.25"},
      {"starburst", "0.5"}}},
    {"vintage",
     "five lenses without coatings: a warm veil, large soft ghosts",
     {{"lens", "heliar-tronnier"},
      {"coating", "none"},
      {"stop", "circle,soft:0.3"},
      {"strength", "0.5"},
      {"veil", "0.04"}}},
    {"cinema",
     "a coated prime of six blades: crisp ghosts, long stars",
     {{"lens", "double-gauss-angenieux"},
      {"stop", "polygon:6"},
      {"strength", "0.7"},
      {"starburst", "2"}}},
    {"toy",
     "no coatings, a circular stop: disc-shaped ghosts, faint starbursts",
     {{"lens", "double-gauss-angenieux"},
      {"coating", "none"},
      {"stop", "circle"},
      {"strength", "1.6"},
      {"starburst", "0.5"},
      {"veil", "0.02"},
      {"haze", "0.03"}}},
    {NULL, NULL, {{NULL, NULL}}}};

const struct style *find_style_by_name(const char *name)
{
    for (const struct style *s = styles; s->name; s++)
        if (strcmp(s->name, name) == 0)
            return s;
    return NULL;
}
