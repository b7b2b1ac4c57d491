/* SPDX-License-Identifier: MIT */
#ifndef GLINT_TOOLS_LAB_SCENE_BENCH_H
#define GLINT_TOOLS_LAB_SCENE_BENCH_H

/* glint bench --scene: times frames of scenes. Returns an exit code. */
int cmd_bench_scene(int argc, char **argv);

#endif
