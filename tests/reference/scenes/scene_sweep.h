/* SPDX-License-Identifier: MIT
 *
 * scene_sweep: the dials of a scene, all together, against the
 * double-precision twin.
 */
#ifndef REFERENCE_SCENES_SCENE_SWEEP_H
#define REFERENCE_SCENES_SCENE_SWEEP_H

#include "glint/scene/translucent_bake.h"
#include "lab/scenes/scene_trial.h"

enum { SCENE_POINTS = 256, SCENE_SHRUNK = 320, SCENE_SETS = 32 };

/* The dials: points of a pixel at outlines, of a light, shading; of brushed
 * metal lookups and the levels of each; of translucent stones, which are baked
 * anew for each, the model, its kernels or terms, their rank, bits of codes and
 * taps, texels each way, and every how many frames maps are worked out. */
enum scene_dial {
    SCENE_EDGES,
    SCENE_SHADOWED,
    SCENE_SHADING,
    SCENE_LOOKUPS,
    SCENE_LEVELS,
    SCENE_MODEL, /* 1 albedo, 2 clustered, 3 factored; 0: there are no stones */
    SCENE_PLANES,
    SCENE_RANK,
    SCENE_CODES,
    SCENE_TAPS,
    SCENE_TEXELS,
    SCENE_FRAMES,
    SCENE_DIALS
};

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
    const struct baked_scene *scene;
    struct scene_trial *trial;
    double ms, ratio, instructions;
    double psnr_db, ssim, p99, flux_error;
    bool front; /* none is both cheaper and better */
    /* For the page, small: sRGB codes and 16 times their difference to the
     * exact picture, about grey. */
    uint8_t *rgb, *difference;
};

/* A scene whose stones are baked as VALUE of SCENE_MODEL .. SCENE_TEXELS says.
 */
struct scene_set {
    int value[SCENE_DIALS];
    struct baked_scene scene;
};

struct scene_sweep {
    struct tool *tool;
    const char *file, *folder, *counts;
    struct glint_description *text;
    struct scene_stones *stones;
    int standard[SCENE_DIALS]; /* as a video is drawn that asks for nothing */
    struct baked_scene scene;
    struct scene_set *set; /* [SCENE_SETS] */
    int n_sets;
    /* Of each stone, while the exact picture is drawn. */
    struct glint_scatter_rows rows[GLINT_DESCRIPTION_MAX_STONES];
    double exact_db; /* the least that what balls are exact by, a fit, has to
                        the rows; 0: there are no balls of stone */
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

/* The program. Returns an exit code. */
int cmd_sweep_scene(int argc, char **argv);

/* Adds the point of VALUE. */
void scene_sweep_add(struct scene_sweep *s, const int value[SCENE_DIALS]);

/* stone_sweep.c: dials of translucent things. They return exit codes. */

/* Sets what is usual, by what the texts of the stones say. */
int stone_sweep_open(struct scene_sweep *s);
/* Adds values of each dial by itself, and models, ranks and frames together. */
void stone_sweep_points(struct scene_sweep *s);
/* Bakes what the points ask for. */
int stone_sweep_bake(struct scene_sweep *s);
/* Makes S->text exact: by all rows, of balls by the nearest fit there is. OLD
 * is what it was, for stone_sweep_restore(). */
int stone_sweep_exact(struct scene_sweep *s, struct glint_described_stone *old);
void stone_sweep_restore(struct scene_sweep *s,
                         struct glint_described_stone *old);
/* Moves a thing of stone before FRAME, to and fro, so that its map is worked
 * out anew. */
void stone_sweep_stir(const struct scene_point *p, int frame);
/* Prepares the frame of P as one that shows a map as old as it may be, of a
 * thing that turns one degree a frame. */
void stone_sweep_age(const struct scene_point *p);
const char *stone_sweep_model(const struct scene_point *p);
void stone_sweep_words(const struct scene_point *p, char *text, size_t bytes);
void stone_sweep_free(struct scene_sweep *s);

/* scene_measure.c: time, and error against the twin. They return exit codes. */
int scene_sweep_measure(struct scene_sweep *s);
void scene_sweep_free(struct scene_sweep *s);

/* scene_report.c */

/* Returns the cost of a frame of P: in memory floors, or with by_instructions
 * in millions of instructions; NAN if it was not measured. */
double scene_sweep_cost(const struct scene_sweep *s,
                        const struct scene_point *p);
void scene_sweep_csv(const struct scene_sweep *s, FILE *file);
void scene_sweep_json(const struct scene_sweep *s, FILE *file);
void scene_sweep_front(const struct scene_sweep *s, FILE *file);
void scene_sweep_dials(const struct scene_sweep *s, FILE *file);
void scene_sweep_table(const struct scene_sweep *s, FILE *file);
void scene_sweep_page(const struct scene_sweep *s, FILE *file);

#endif
