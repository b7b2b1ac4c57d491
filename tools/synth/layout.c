/* SPDX-License-Identifier: MIT */
#include "synth/layout.h"

#include <string.h>

#define BASE   (1u << SYNTH_BASE)
#define SOURCE (1u << SYNTH_SOURCE)
#define GLARE  (1u << SYNTH_GLARE)
#define GHOSTS (1u << SYNTH_GHOSTS)

static const struct synth_layout layouts[] = {
    {"plain",
     "ppm",
     {{"input/", "", BASE | SOURCE | GLARE | GHOSTS, true},
      {"gt/", "", BASE | SOURCE, false},
      {"flare/", "", GLARE | GHOSTS, false},
      {"mask/", "", 0, false}}},
    /* Flares on black, which a loader of [Dai22] puts on pictures of its own,
     * and pairs to test with. */
    {"flare7k",
     "png",
     {{"Flare7K/Scattering_Flare/Compound_Flare/", "", SOURCE | GLARE, false},
      {"Flare7K/Scattering_Flare/Light_Source/", "", SOURCE, false},
      {"Flare7K/Reflective_Flare/", "", GHOSTS, false},
      {"test_data/synthetic/input/", "input_", BASE | SOURCE | GLARE | GHOSTS,
       true},
      {"test_data/synthetic/gt/", "gt_", BASE | SOURCE, false},
      {"test_data/synthetic/mask/", "mask_", 0, false}}},
    /* The test half of [Dai23]: ghosts alone trouble the picture. */
    {"bracketflare",
     "png",
     {{"test/lq/", "", BASE | SOURCE | GHOSTS, true},
      {"test/gt/", "", BASE | SOURCE, false},
      {"test/flare/", "", GHOSTS, false},
      {"test/mask/", "", 0, false}}},
    /* Flares on black and scenes, which the programs of [Wu21] add. */
    {"wu2021",
     "png",
     {{"lens-flare/simulated/", "", SOURCE | GLARE | GHOSTS, false},
      {"scenes/", "", BASE, false}}},
};

const struct synth_layout *synth_layout_named(const char *name)
{
    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++)
        if (strcmp(layouts[i].name, name) == 0)
            return &layouts[i];
    return NULL;
}

bool synth_layout_path(char path[SYNTH_PATH_BYTES], const char *folder,
                       const struct synth_file *file, int number,
                       const char *type)
{
    return snprintf(path, SYNTH_PATH_BYTES, "%s/%s%s%06d.%s", folder,
                    file->folder, file->prefix, number,
                    type) < SYNTH_PATH_BYTES;
}
