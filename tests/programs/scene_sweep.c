/* SPDX-License-Identifier: MIT
 *
 * scene_sweep --scene NAME.scene -o FOLDER - draws a scene with all values of
 * its dials and compares each picture with that of the reference renderer. */
#include "reference/scenes/scene_sweep.h"

int main(int argc, char **argv)
{
    return cmd_sweep_scene(argc, argv);
}
