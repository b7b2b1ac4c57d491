/* SPDX-License-Identifier: MIT
 *
 * glint sweep --scene: the dials of a scene, all together, against the
 * double-precision twin.
 */
#ifndef GLINT_TOOLS_LAB_SCENES_SCENE_SWEEP_H
#define GLINT_TOOLS_LAB_SCENES_SCENE_SWEEP_H

#include "lab/scenes/scene_trial.h"

enum { SCENE_POINTS = 96, SCENE_SHRUNK = 320 };

/* The dials: points of a pixel at outlines, of a light, shading, and of brushed
 * metal lookups and the levels of each. */
enum scene_dial {
    SCENE_EDGES,
    SCENE_SHADOWED,
    SCENE_SHADING,
    SCENE_LOOKUPS,
    SCENE_LEVELS,
    SCENE_DIALS
};
extern const char *const scene_dial_name[SCENE_DIALS];

enum scene_kind {
    SCENE_STANDARD,
    SCENE_ALONE,   /* one dial is turned */
    SCENE_TOGETHER /* several are */
};

/* A setting of the dials, and what became of it. NAN: not measured. */
struct scene_point {
    enum scene_kind kind;
    int dial;       /* the one that is turned alone; -1: none or several */
    double quality; /* of --budget, 0 .. 1; -1: it does not come by there */
    int value[SCENE_DIALS]; /* of shading 1: full, 2: half */
    struct scene_trial *trial;
    double ms, ratio, instructions;
    double psnr_db, ssim, p99, flux_error;
    bool front; /* none is both cheaper and better */
    /* For the page, small: sRGB codes and 16 times their difference to the
     * exact picture, about grey. */
    uint8_t *rgb, *difference;
};

struct scene_sweep {
    struct tool *tool;
    const char *file, *folder, *counts;
    struct glint_description *text;
    struct baked_scene scene;
    int width, height, rounds, samples, counter;
    bool by_instructions, count_only;
    struct glint_workers *one;
    struct canvas canvas;
    double floor_ms[SCENE_ROUNDS];
    struct glint_float_image exact, got;
    uint8_t *exact_codes;
    int by, shrunk_width, shrunk_height; /* pictures of the page */
    uint8_t *exact_rgb;
    struct scene_trial *trial; /* [SCENE_POINTS] */
    struct scene_point point[SCENE_POINTS];
    int n_points;
};

/* glint sweep --scene. Returns an exit code. */
int cmd_sweep_scene(int argc, char **argv);

/* scene_measure.c: time, and error against the twin. They return exit codes. */
int scene_sweep_measure(struct scene_sweep *s);
void scene_sweep_free(struct scene_sweep *s);

/* scene_report.c */

/* Returns the cost of a frame of P: in memory floors, or with by_instructions
 * in millions of instructions; NAN if it was not measured. */
double scene_sweep_cost(const struct scene_sweep *s,
                        const struct scene_point *p);
void scene_sweep_words(const struct scene_point *p, char *text, size_t bytes);
void scene_sweep_csv(const struct scene_sweep *s, FILE *file);
void scene_sweep_json(const struct scene_sweep *s, FILE *file);
void scene_sweep_front(const struct scene_sweep *s, FILE *file);
void scene_sweep_dials(const struct scene_sweep *s, FILE *file);
void scene_sweep_table(const struct scene_sweep *s, FILE *file);
void scene_sweep_page(const struct scene_sweep *s, FILE *file);

#endif
