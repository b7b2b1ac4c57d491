/* SPDX-License-Identifier: MIT
 *
 * glint/flare.h - lens-flare ghosts, drawn tile by tile in integers.
 *
 *     bytes = glint_flare_bytes(&cfg);                       once
 *     glint_flare_init(&flare, &cfg, mem, bytes);
 *     glint_flare_begin(flare);                              each frame
 *     for each ghost, light and wavelength:
 *         vertices = glint_flare_add(flare, &bundle);        fill them in
 *     or, for a baked lens, in place of begin and the loop:
 *         glint_flare_plan(flare, &frame, lights, n_lights);
 *     glint_flare_bin(flare, &stats);
 *     glint_flare_draw(flare, &image);
 *
 * All memory is the caller's, passed to init; drawing never allocates and
 * cannot fail. Bundles for which a capacity is too small are left out and
 * counted, and the statistics report the capacities that would have sufficed.
 * No result depends on the number of workers, the order of jobs, the tile sizes
 * or the order of bundles. Method: [Bodonyi23], with irradiance per cell and
 * anti-aliased clipping. */
#ifndef GLINT_FLARE_H
#define GLINT_FLARE_H

#include <stddef.h>
#include <stdint.h>

#include "glint/bundle.h"
#include "glint/half.h"
#include "glint/image.h"
#include "glint/light.h"
#include "glint/model.h"
#include "glint/real.h"
#include "glint/status.h"
#include "glint/workers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Chooses a set of waves for each ghost. */
struct glint_wave_planner;
extern const struct glint_wave_planner glint_wave_planner;

/* Sets of waves that represent the same light. Each ghost gets the smallest
 * set whose steps are invisible: where outlines of neighbouring waves are
 * close to each other, or faint. */
struct glint_wave_sets {
    /* &glint_wave_planner. It is a pointer so that only programs that use sets
     * link the planner. */
    const struct glint_wave_planner *planner;
    int n_sets;                    /* 1 .. GLINT_MAX_WAVE_SETS */
    int size[GLINT_MAX_WAVE_SETS]; /* number of waves of each set, 2 or more,
                                      rising; the sets follow each other in
                                      glint_flare_frame.wave */
    int32_t apart_q8; /* max distance between outlines of neighbouring waves,
                         pixels */
    struct glint_real step; /* display white: a set also suffices if its steps
                               of light are below this, however far outlines are
                               apart; 0: every step counts as visible */
};

/* Brightness of each ghost of a lens in each of three waves, by the angle of
 * its light: a cache. A program keeps one for all frames with one lens,
 * stop, set of waves and size; plans fill it as needed, and no picture
 * depends on what was filled before. */
enum { GLINT_DIM_NODES = 33, GLINT_DIM_VALUES = 4, GLINT_DIM_LIGHTS = 256 };
struct glint_dim_method;
extern const struct glint_dim_method glint_dim_method;
struct glint_dim {
    /* glint_dim_method; linked only by programs that name it. */
    const struct glint_dim_method *method;
    /* [GLINT_DIM_NODES][ghosts of the lens][GLINT_DIM_VALUES] */
    int16_t *log2_q8;
    /* 1: the node is filled. The caller clears all before the first plan,
     * and when lens, stop, waves or size change. */
    uint8_t done[GLINT_DIM_NODES];
    /* Set by each plan: for each light but the first, the nearest light
     * before it, and the logarithm of its distance. Lights outside this
     * table share no rays.
     */
    int16_t nearest[GLINT_DIM_LIGHTS];
    int16_t apart_log2_q8[GLINT_DIM_LIGHTS];
};

/* The input of a plan, except its lights. */
struct glint_flare_frame {
    const struct glint_lens *lens;
    const struct glint_wave *wave;
    int n_waves; /* number of waves in all sets together, 1 or more */
    const struct glint_wave_sets *sets; /* NULL: all waves for every ghost */
    struct glint_real pixels_per_mm;
    /* 4 .. GLINT_MAX_CELLS. The cells per side of a grid are proportional to
     * it and to the square root of how much the ghost bends: at least
     * GLINT_LEAST_CELLS, at most 2 * FINENESS, or 4 * FINENESS where light
     * folds. At 64, straight lines between rays are off by 0.01 pixels in
     * the mean, outlines by 0.1. */
    int fineness;
    int uniform;    /* 1: all grids have FINENESS cells per side */
    int only_ghost; /* index of the only ghost of the lens to draw, with its
                       parts; -1: all */
    /* [ghosts of the lens, parts included]; NULL: all ghosts are as the lens
     * gives them. */
    const struct glint_tint *tints;
    /* Max light that no pixel of a picture in codes shows, display white.
     * Fainter ghosts may be left out, and a fainter ghost gets a coarser
     * grid and coarser steps of irradiance. 0: the picture is in linear
     * light. */
    struct glint_real faintest;
    /* For three waves without sets. Lights must be in the order of
     * glint_lights_merge(). Dim ghosts of lights near each other are drawn
     * as one, between them, if their light is low enough for the distance. A
     * ghost whose mean light in wave 1, from one light, is below DIMMEST
     * (display white), or below an eighth of that if it folds, is drawn with
     * the rays of wave 1 alone, in the colours of all three. Up to twice as
     * bright, waves 0 and 2 draw a fraction of their light with their own
     * rays. DIM NULL or DIMMEST {0, 0}: every wave draws all of its light. */
    struct glint_dim *dim;
    struct glint_real dimmest;
    /* Codes, 0 .. 2^15 in _q8: in a picture in codes, edges across which
     * light changes by fewer codes are moved to whole pixels, at a fraction
     * of the cost. 0: no edge is moved. */
    int snap_codes_q8;
    /* Half resolution: the flare has half as many pixels each way, each for
     * four of the picture. In Y'CbCr whose chroma is shared by pairs of
     * pixels, the four are lit at once, by the change of their mean. NULL,
     * or glint_half, linked only by programs that name it. */
    const struct glint_half *half;
    /* With glint_reuse and reuse_gains only: [n_lights] factors on red,
     * green and blue of each light when it is drawn, 0 .. 2^15. Changing
     * them does not require a new plan. NULL: all are 1. */
    const int32_t (*gain_q14)[3];
};

/* Lights over a video. Memory is the caller's, MAX_LIGHTS entries each; N is
 * 0 at first. */
struct glint_still {
    int max_lights;
    int n; /* the static lights, and their factors */
    struct glint_light *light;
    int32_t (*gain_q14)[3]; /* for struct glint_flare_frame */
    int64_t (*sum_q20)[3];  /* scratch */
};

/* Decides whether the static lights can represent LIGHTS. If each of LIGHTS
 * is within NEAR_Q30 (chord of the angle) of a static one, and the light
 * there is at most 1.5 times the planned light, the static lights stay, with
 * factors that reproduce LIGHTS: 0 for lights that have vanished. Otherwise
 * LIGHTS become the static lights. Returns the number of static lights; 0:
 * more than max_lights. Factors are accurate to 2^-14, a channel to 1/64 of
 * the largest one if the colour has changed. */
int glint_lights_still(struct glint_still *still,
                       const struct glint_light *lights, int n_lights,
                       int32_t near_q30);

/* Merges lights in place and returns how many are left, sorted from the
 * brightest to the faintest; entries after these are undefined. First,
 * lights no farther apart than NEAR_Q30, the chord of the angle between
 * them, merge. Then, while more than MOST (1 or more) are left, those pairs
 * merge that change the picture least: faint lights over long distances
 * before bright ones. A merged light has the power of both and a direction
 * between theirs, weighted by their powers. Lights without power or colour
 * are left out. *N_APART receives the number of distinct lights, before
 * merging because of MOST. The result does not depend on the order of
 * lights. */
int glint_lights_merge(struct glint_light *lights, int n_lights,
                       int32_t near_q30, int most, int *n_apart);

/* ------------------------------------------------------------------ drawing */

/* The edge rasteriser: the exact area of each cell, with one irradiance per
 * cell; folds and slivers preserve their light. A primitive is an edge
 * across which light changes. */

/* Frame reuse: if the plan's input has not changed, the edges and lists of
 * tiles of the previous frame are drawn again. */
struct glint_reuse;
extern const struct glint_reuse glint_reuse;

struct glint_flare_config {
    struct glint_workers *workers; /* must outlive the flare; NULL: one thread.
                                      The output is the same for any number of
                                      threads */
    unsigned sets; /* instruction sets, glint_sets_here() or fewer; 0: plain C
                      (kernels.h). Changes no output */
    int width, height;      /* size of the picture, 1 .. GLINT_MAX_SIDE */
    int tile_log2;          /* log2 of the side of a tile in pixels, 3 .. 6 */
    int dither;             /* 1: 8-bit output is dithered, deterministically */
    struct glint_stop stop; /* copied */

    /* Irradiance of a cell is rounded to so many steps per octave, 1 ..
     * 4096, and to fewer for faint ghosts planned for codes. Edges between
     * cells of equal irradiance are not drawn. 0: not rounded. */
    int irradiance_steps;

    /* Capacities. The statistics of glint_flare_bin() report what a frame
     * needed.
     */
    int max_bundles;
    int max_vertices;   /* of bundles, as added by glint_flare_add() */
    int max_primitives; /* primitives of a frame. Each worker gets an equal
                           part; with a reserve of a half, few bundles must wait
                           for capacity in another worker's part. */
    int max_refs;       /* entries in the lists of all tiles */

    /* glint_reuse: if lights, waves and dials are those of the previous
     * plan, and its bundles were binned, they are drawn again. No output
     * changes. NULL: every frame is planned. Linked only by programs that
     * name it. */
    const struct glint_reuse *reuse;
    int reuse_lights; /* lights that are compared for that, 40 bytes each; a
                         frame with more is always planned again */
    int reuse_gains;  /* 1: frames may have gain_q14, which needs 12 bytes for
                         each of max_bundles */
};

struct glint_flare_stats {
    /* Number of each that was drawn; VERTICES includes those of bundles left
     * out. */
    int bundles, vertices, primitives, refs;
    /* Capacities that would have drawn everything. Exact if max_bundles was
     * large enough. */
    int need_bundles, need_vertices, need_primitives, need_refs;
    int dropped_bundles; /* left out for lack of capacity */
    int dropped_cells; /* cells left out of drawn bundles: they have an invalid
                          ray, a vertex out of range, or no area */
    int reused; /* 1: edges and lists of tiles of the previous frame were reused
                 */
    int held_cells; /* cells, or halves of cells, of drawn bundles whose light
                       was clamped to what one cell may give a pixel: 2048 times
                       white, or less if the sum over all cells could pass 2^24
                     */
};

struct glint_flare; /* opaque, in the caller's memory */

/* Sets CFG to defaults for pictures of WIDTH x HEIGHT; the caller still sets
 * capacities, workers and instruction sets. */
void glint_flare_defaults(struct glint_flare_config *cfg, int width,
                          int height);

/* Sets the capacities for N_LIGHTS lights through LENS in N_WAVES
 * wavelengths: the max number of bundles, at most 2^20, and edges enough for
 * most frames. The statistics of a frame report the capacities that would
 * have drawn everything. */
void glint_flare_capacities(struct glint_flare_config *cfg,
                            const struct glint_lens *lens, int n_lights,
                            int n_waves);

/* Sets FRAME to defaults for a picture in codes through LENS; the caller
 * still sets waves and pixels_per_mm. */
void glint_flare_frame_defaults(struct glint_flare_frame *frame,
                                const struct glint_lens *lens);

/* Returns pixels per mm on the sensor for a picture of WIDTH x HEIGHT pixels
 * that is as large as fits the film of LENS, as by glint_view_fit(). */
struct glint_real glint_flare_pixels_per_mm(const struct glint_lens *lens,
                                            int width, int height);

#define GLINT_FLARE_WAVES 3

/* Sets WAVE to red, green and blue: 650, 532 and 450 nm, each relative to
 * its own direct image through LENS with a circular stop, so that white
 * light stays white. Weights are accurate to 2^-24. */
void glint_flare_waves(struct glint_wave wave[GLINT_FLARE_WAVES],
                       const struct glint_lens *lens);

/* Returns a white light of power 1 whose image through LENS lies at (X, Y):
 * pixels from the top left corner, y down, of a picture of WIDTH x HEIGHT that
 * is as large as fits the film of LENS. Distances from the centre, across and
 * down, beyond 2^22 pixels count as 2^22. Does in integers what
 * glint_view_to_angles() does in doubles: no sine or cosine is off by more than
 * 2^-28. */
struct glint_light glint_light_from_pixel(const struct glint_lens *lens,
                                          int width, int height, int32_t x_q8,
                                          int32_t y_q8);

/* Returns the exact number of bytes that init needs for CFG; 0 if CFG is out
 * of range. */
size_t glint_flare_bytes(const struct glint_flare_config *cfg);

/* Places a flare in MEM[BYTES], aligned to 64; *FLARE points into it. There is
 * nothing to release but the memory. GLINT_E_ARGUMENT: CFG or the alignment is
 * wrong. GLINT_E_MEMORY: BYTES is too small. */
enum glint_status glint_flare_init(struct glint_flare **flare,
                                   const struct glint_flare_config *cfg,
                                   void *mem, size_t bytes);

/* Sets the stop of the following frames: STOP is copied, its mask kept.
 * Capacities do not change. GLINT_E_ARGUMENT: STOP is out of range, or has a
 * mask that the raster does not support. */
enum glint_status glint_flare_set_stop(struct glint_flare *flare,
                                       const struct glint_stop *stop);

/* Forgets all bundles. */
void glint_flare_begin(struct glint_flare *flare);

/* Does as glint_flare_begin(). RAYS, kept, gives the vertices of all bundles
 * to come, for which glint_flare_add() takes no vertices and returns NULL. */
void glint_flare_begin_rays(struct glint_flare *flare,
                            const struct glint_flare_rays *rays);

/* Limits what glint_flare_bin() and glint_flare_draw() do to rows Y0 .. Y1 - 1
 * of pixels, from now to the next begin or plan: 0 <= Y0 < Y1 <= height, Y0 a
 * multiple of the side of a tile, and Y1 one or the height. A picture that is
 * drawn part by part gets the same bits, with less memory. Bundles may be
 * binned again after each call. Not at half resolution. */
void glint_flare_set_rows(struct glint_flare *flare, int y0, int y1);

/* Takes BUNDLE in and returns its vertices, which the caller fills before
 * glint_flare_bin(): row by row, [n_cells + 1][n_cells + 1]. Returns NULL if
 * there is no capacity; the bundle is then counted and left out. */
struct glint_vertex *glint_flare_add(struct glint_flare *flare,
                                     const struct glint_bundle *bundle);

/* Forgets all bundles, then adds the visible ones of LIGHTS and all ghosts
 * of the lens of FRAME; the caller fills no vertices. LIGHTS, FRAME and all
 * that it points to must stay until glint_flare_bin() has returned. Capacity
 * for n_lights * ghosts * n_waves bundles is needed, or the last ones are
 * left out. With sets of waves: capacity for the waves of the first set and
 * for the sets that ghosts choose, or the last ghosts use the first set. */
void glint_flare_plan(struct glint_flare *flare,
                      const struct glint_flare_frame *frame,
                      const struct glint_light *lights, int n_lights);

/* Returns the index, in the lens, of the ghost of planned bundle I, 0 <= I <
 * bundles of the statistics. */
int glint_flare_ghost(const struct glint_flare *flare, int i);

/* A bundle that is planned and not yet binned. A program can predict the
 * cost of a frame from all of them. */
struct glint_planned {
    int n_cells;            /* cells a side of the grid */
    struct glint_real flux; /* display white times pixels */
    /* Mean over the pixels that it covers, display white. */
    struct glint_real irradiance;
    int ghost, light, wave; /* as of glint_flare_account() */
    int inside_q8;   /* fraction of its rays that stop and barrels transmit, of
                        those that the plan probed, 0 .. 255 */
    int view_q8;     /* fraction of the box about its light that lies in the
                        picture, 0 .. 255 */
    int contrast_q4; /* log2 of its brightest cell's irradiance / the mean, 0 ..
                        254; 255: unknown, as it folds */
};

/* Sets PLANNED to planned bundle I, from 0; returns 0 if there are fewer. */
int glint_flare_planned(const struct glint_flare *flare, int i,
                        struct glint_planned *planned);

/* Sets *BRIGHTEST to the largest mean irradiance of a planned bundle,
 * display white, and *FLUX to the flux of all of them, display white x
 * pixels. */
void glint_flare_light(const struct glint_flare *flare,
                       struct glint_real *brightest, struct glint_real *flux);

/* Returns the number of rays that the last plan probed. */
int64_t glint_flare_looked(const struct glint_flare *flare);

/* Converts the grids of all bundles into primitives and sorts these into
 * tiles. Bundles that do not fit are left out completely, the last ones
 * first. */
void glint_flare_bin(struct glint_flare *flare,
                     struct glint_flare_stats *stats);

/* Adds the flare to IMAGE, which has the size of the configuration. Tiles
 * without light are neither read nor written. May be called again. IMAGE
 * NULL: computes the light of every pixel and drops it, to measure the time
 * of writing pictures. */
void glint_flare_draw(struct glint_flare *flare,
                      const struct glint_image *image);

/* Returns the number of small tiles in which the last draw drew something. */
int glint_flare_tiles(const struct glint_flare *flare);

/* Returns the number of samples of a linear picture that the last draw
 * clamped to the range. */
int glint_flare_held(const struct glint_flare *flare);

/* ------------------------------------------------------------ what and why */

/* What became of the rays of one ghost, light and wave. */
enum glint_outcome {
    GLINT_OUTCOME_DRAWN,
    GLINT_OUTCOME_EMPTY,  /* planned, but no edge of its grid changes a pixel */
    GLINT_OUTCOME_OTHER,  /* only_ghost selects another ghost, or a tint mutes
                             this one */
    GLINT_OUTCOME_BEYOND, /* the light is farther off the axis than the model's
                             range */
    GLINT_OUTCOME_CLOSED, /* the model has no polynomials at this angle: no ray
                             gets through */
    GLINT_OUTCOME_BLOCKED, /* stop and barrels cut every ray that the plan
                              probed */
    GLINT_OUTCOME_DARK,    /* the light has no power in this wave */
    GLINT_OUTCOME_OUTSIDE, /* the light lands off-screen */
    GLINT_OUTCOME_FAINT, /* no pixel can show the ghost, even with the light of
                            all lamps together */
    GLINT_OUTCOME_NO_ROOM,   /* a capacity is full */
    GLINT_OUTCOME_OTHER_SET, /* the ghost uses another set of waves */
    GLINT_OUTCOME_SHARED, /* dim, and drawn with the ghost of a brighter near-by
                             light */
    GLINT_OUTCOMES
};

/* The work of one bundle. Members other than outcome and probed are 0 unless
 * the outcome is DRAWN, EMPTY or NO_ROOM; edges, rows and refs are 0 unless
 * it is DRAWN. */
struct glint_account {
    enum glint_outcome outcome;
    int probed; /* rays that the plan probed */
    /* Cells per side of the grid, and vertices of the whole grid. */
    int cells, vertices;
    int outputs, barrels; /* polynomials of a ray, and those of them for barrels
                             that cut */
    int terms; /* terms of all these polynomials after substituting angle and
                  wavelength */
    int edges; /* edges drawn; their sum over all bundles is the primitives of
                  the statistics */
    int64_t rows; /* pixel rows that the edges cross */
    int refs;     /* entries in the lists of all tiles */
    /* Flux as planned, display white times pixels: before the stop, the barrels
     * and the sides of the picture cut it. */
    struct glint_real flux;
};

/* Returns the statistics of ghost GHOST (or part) of the lens, light LIGHT
 * and wave WAVE of the frame that was planned and binned last. It plans the
 * bundle again, so LIGHTS and FRAME of glint_flare_plan() must still exist.
 * It changes nothing that is drawn and costs as much as planning the bundle. */
void glint_flare_account(struct glint_flare *flare, int ghost, int light,
                         int wave, struct glint_account *account);

/* Restricts drawing to some of the bundles that were planned and binned last:
 * those of GHOST with all its parts, of LIGHT and of WAVE (with sets
 * of waves: all waves of set WAVE), each -1 for all. The restriction holds
 * until the next call of this function or of glint_flare_bin(). */
void glint_flare_keep(struct glint_flare *flare, int ghost, int light,
                      int wave);

/* Returns the number of edges in the list of small tile TILE; tiles count
 * row by row. Light that enters a tile from the left is in no list. */
int glint_flare_listed(const struct glint_flare *flare, int tile);

#ifdef __cplusplus
}
#endif

#endif
