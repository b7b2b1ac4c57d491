/* SPDX-License-Identifier: MIT
 *
 * glint/flare.h - draws lens-flare ghosts, tile by tile, in integers.
 *
 *     bytes = glint_flare_bytes(&cfg); once
 *     glint_flare_init(&flare, &cfg, mem, bytes);
 *     glint_flare_begin(flare); each frame
 *     for each ghost, light and wavelength:
 *         vertices = glint_flare_add(flare, &bundle); fill them in
 *     or, for a baked lens, instead of begin and the loop:
 *         glint_flare_plan(flare, &frame, lights, n_lights);
 *     glint_flare_bin(flare, &stats);
 *     glint_flare_draw(flare, &image);
 *
 * The caller passes all memory to glint_flare_init(); drawing never allocates
 * and cannot fail. Bundles for which a capacity is too small are left out and
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

/* Opaque: code that chooses a set of waves for each ghost. */
struct glint_wave_planner;
extern const struct glint_wave_planner glint_wave_planner;

/* Sets of waves (wavelengths) that represent the same light. Each ghost is
 * drawn with the smallest set whose steps are invisible, because the ghost's
 * outlines in neighbouring waves are close to each other, or faint. */
struct glint_wave_sets {
    /* &glint_wave_planner. It is a pointer so that only programs that use sets
     * link the planner. */
    const struct glint_wave_planner *planner;
    int n_sets; /* number of sets, 1 .. GLINT_MAX_WAVE_SETS */
    /* Number of waves of each set, 2 or more, in rising order. The sets follow
     * each other in glint_flare_frame.wave. */
    int size[GLINT_MAX_WAVE_SETS];
    /* Max distance between the outlines of a ghost in neighbouring waves,
     * pixels. */
    int32_t apart_q8;
    /* Step of light, display white: a set whose steps of light are smaller than
     * this suffices, too, for any distance of outlines; 0: every step counts as
     * visible. */
    struct glint_real step;
};

enum { GLINT_DIM_NODES = 33, GLINT_DIM_VALUES = 4, GLINT_DIM_LIGHTS = 256 };
struct glint_dim_method;
extern const struct glint_dim_method glint_dim_method;

/* Cache of the brightness of each ghost, by the angle of the light and at three
 * wavelengths. A program uses one cache for all frames of one lens, stop, set
 * of wavelengths and size. Planning a frame fills missing entries; the cache
 * never changes a picture. */
struct glint_dim {
    /* &glint_dim_method. It is a pointer so that only programs that use the
     * cache link the method. */
    const struct glint_dim_method *method;
    /* [GLINT_DIM_NODES][ghosts of the lens][GLINT_DIM_VALUES]: log2 of the
     * brightness */
    int16_t *log2_q8;
    /* 1: the node (angle) is filled. The caller clears all nodes before the
     * first plan, and when lens, stop, waves or size change. */
    uint8_t done[GLINT_DIM_NODES];
    /* Set by each plan: for each light but the first, the index of the nearest
     * one of the lights before it, and log2 of the distance. Lights with an
     * index of GLINT_DIM_LIGHTS or more do not share rays. */
    int16_t nearest[GLINT_DIM_LIGHTS];
    int16_t apart_log2_q8[GLINT_DIM_LIGHTS];
};

/* The input of a plan except the lights. */
struct glint_flare_frame {
    const struct glint_lens *lens;
    const struct glint_wave *wave;
    int n_waves; /* number of waves in all sets together, 1 or more */
    const struct glint_wave_sets *sets; /* NULL: all waves for every ghost */
    struct glint_real pixels_per_mm;
    /* Fineness of grids, 4 .. GLINT_MAX_CELLS. The number of cells per side of
     * a grid is proportional to FINENESS and to the square root of the
     * curvature of the ghost: at least GLINT_LEAST_CELLS, at most 2 * FINENESS,
     * or 4 * FINENESS where light folds. At 64, straight lines between rays are
     * off by 0.01 pixels on average, outlines by 0.1. */
    int fineness;
    int uniform; /* 1: all ray grids have FINENESS cells per side */
    /* Index of the only ghost of the lens that is drawn, with its additional
     * pupil regions (parts); -1: all ghosts. */
    int only_ghost;
    /* [ghosts of the lens, parts included]: tints; NULL: no ghost is tinted. */
    const struct glint_tint *tints;
    /* For a picture in codes: the max light that changes no pixel, display
     * white. Ghosts fainter than this may be left out; the closer a ghost's
     * light is to this limit, the coarser are its grid and its steps of
     * irradiance. 0: the picture is in linear light. */
    struct glint_real faintest;
    /* Used only with three waves and without sets. Lights must be in the order
     * of glint_lights_merge(). Dim ghosts of lights near each other are drawn
     * as one ghost, between them, if their light is low enough for the
     * distance. A ghost is drawn with the rays of wave 1 alone, in the colours
     * of all three waves, if its mean light in wave 1, from one light, is below
     * DIMMEST (display white), or below DIMMEST / 8 if the ghost folds. Between
     * DIMMEST and twice DIMMEST, waves 0 and 2 draw a fraction of their light
     * with their own rays. DIM NULL or DIMMEST {0, 0}: every wave draws all of
     * its light. */
    struct glint_dim *dim;
    struct glint_real dimmest;
    /* Codes, 0 .. 2^15 in _q8. In a picture in codes, edges across which light
     * changes by fewer codes are moved to whole pixels, which reduces their
     * cost. 0: no edge is moved. */
    int snap_codes_q8;
    /* &glint_half: the flare has half the resolution of the picture in x and y,
     * so each of its pixels lights four of the picture. In Y'CbCr with
     * subsampled chroma, the four pixels are changed together, by the change of
     * their mean. NULL: full resolution. It is a pointer so that only programs
     * that use it link half resolution. */
    const struct glint_half *half;
    /* With glint_reuse and reuse_gains only: [n_lights] factors on red,
     * green and blue of each light when it is drawn, 0 .. 2^15. Changing
     * them does not require a new plan. NULL: all are 1. */
    const int32_t (*gain_q14)[3];
};

/* Static lights: they represent the lights of several frames of a video, so
 * that rays can be reused in these frames. The caller owns the arrays, which
 * have MAX_LIGHTS entries each, and sets N to 0 before the first frame. */
struct glint_still {
    int max_lights;
    int n; /* number of static lights in LIGHT, and of their factors */
    struct glint_light *light;
    /* Factors on the static lights, for gain_q14 of struct
     * glint_flare_frame. */
    int32_t (*gain_q14)[3];
    int64_t (*sum_q20)[3]; /* scratch */
};

/* Decides whether the static lights can represent LIGHTS. They can if each of
 * LIGHTS is within NEAR_Q30 (chord of the angle) of a static light, and is at
 * most 1.5 times as bright as planned for it. Then the static lights stay the
 * same, with factors that reproduce LIGHTS: 0 for lights that have vanished.
 * Otherwise LIGHTS become the static lights. Returns the number of static
 * lights, or 0 if there are more than max_lights. Factors are accurate to
 * 2^-14; if the colour has changed, each channel is accurate to 1/64 of the
 * largest channel. */
int glint_lights_still(struct glint_still *still,
                       const struct glint_light *lights, int n_lights,
                       int32_t near_q30);

/* Merges lights in place and returns how many are left, sorted from the
 * brightest to the faintest; entries after these are undefined. First, lights
 * no farther apart than NEAR_Q30, the chord of the angle between them, merge.
 * Then, while more than MOST (1 or more) are left, the pairs merge that change
 * the picture least: faint lights merge over long distances before bright
 * lights do. A merged light has the power of both and a direction between
 * theirs, weighted by their powers. Lights without power or colour are left
 * out. *N_APART receives the number of distinct lights, before merging because
 * of MOST. The result does not depend on the order of lights. */
int glint_lights_merge(struct glint_light *lights, int n_lights,
                       int32_t near_q30, int most, int *n_apart);

/* ------------------------------------------------------------------ drawing */

/* The edge rasteriser draws the exact area of each cell, with one irradiance
 * per cell; folds and slivers preserve their light. A primitive is an edge
 * across which light changes. */

/* Frame reuse: if the input of a plan equals that of the previous plan, the
 * edges and lists of tiles of the previous frame are drawn again. */
struct glint_reuse;
extern const struct glint_reuse glint_reuse;

struct glint_flare_config {
    /* Worker threads; must outlive the flare; NULL: one thread. The output is
     * the same for any number of threads. */
    struct glint_workers *workers;
    unsigned sets; /* instruction sets, glint_sets_here() or a subset; 0: plain
                      C (kernels.h). The output is the same for all sets */
    int width, height;      /* size of the picture, 1 .. GLINT_MAX_SIDE */
    int tile_log2;          /* log2 of the side of a tile in pixels, 3 .. 6 */
    int dither;             /* 1: 8-bit output is dithered, deterministically */
    struct glint_stop stop; /* opening of the stop; copied */

    /* Number of steps per octave to which the irradiance of a cell is rounded,
     * 1 .. 4096; fewer are used for faint ghosts of a picture in codes. Edges
     * between cells of equal irradiance are not drawn. 0: irradiance is not
     * rounded. */
    int irradiance_steps;

    /* Capacities. The statistics of glint_flare_bin() report the capacities
     * that a frame needed. */
    int max_bundles;
    int max_vertices; /* vertices of all bundles of a frame */
    /* Primitives (edges) of a frame. Each worker gets an equal section of them.
     * If the capacity is 1.5 times the number needed, few bundles must wait for
     * capacity in the section of another worker. */
    int max_primitives;
    int max_refs; /* entries in the lists of all tiles */

    /* &glint_reuse: if lights, waves and dials equal those of the previous
     * plan, and its bundles were binned, these are drawn again. The output is
     * the same. NULL: every frame is planned. It is a pointer so that only
     * programs that use it link frame reuse. */
    const struct glint_reuse *reuse;
    /* Max number of lights of a frame that can be reused, 40 bytes each; a
     * frame with more lights is always planned again. */
    int reuse_lights;
    int reuse_gains; /* 1: frames may have gain_q14, which needs 12 bytes for
                        each of max_bundles */
};

struct glint_flare_stats {
    /* Numbers of items drawn; VERTICES includes the vertices of bundles that
     * were left out. */
    int bundles, vertices, primitives, refs;
    /* Capacities that would have sufficed to draw everything. Exact if
     * max_bundles was large enough. */
    int need_bundles, need_vertices, need_primitives, need_refs;
    int dropped_bundles; /* number of bundles left out for lack of capacity */
    /* Number of cells left out of drawn bundles: with an invalid ray, a vertex
     * out of range, or no area. */
    int dropped_cells;
    /* 1: the edges and the lists of tiles of the previous frame were drawn
     * again. */
    int reused;
    /* Number of cells, or halves of cells, of drawn bundles whose light was
     * clamped to the max light of a cell per pixel: 2048 times white, or less
     * if the sum over all cells could exceed 2^24. */
    int held_cells;
};

struct glint_flare; /* opaque, in the caller's memory */

/* Sets CFG to defaults for pictures of WIDTH x HEIGHT; the caller still has to
 * set capacities, workers and instruction sets. */
void glint_flare_defaults(struct glint_flare_config *cfg, int width,
                          int height);

/* Sets the capacities for N_LIGHTS lights through LENS in N_WAVES wavelengths:
 * the max number of bundles, at most 2^20, and a number of edges that suffices
 * for most frames. The statistics of a frame report the capacities that would
 * have drawn everything. */
void glint_flare_capacities(struct glint_flare_config *cfg,
                            const struct glint_lens *lens, int n_lights,
                            int n_waves);

/* Sets FRAME to defaults for a picture in codes through LENS; the caller still
 * has to set waves and pixels_per_mm. */
void glint_flare_frame_defaults(struct glint_flare_frame *frame,
                                const struct glint_lens *lens);

/* Returns pixels per mm on the sensor for a picture of WIDTH x HEIGHT pixels
 * that is as large as fits into the image area (film) of LENS, like
 * glint_view_fit(). */
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
 * is as large as fits into the image area (film) of LENS. Distances from the
 * centre, across and down, are clamped to 2^22 pixels. The integer counterpart
 * of glint_view_to_angles(): no sine or cosine is off by more than 2^-28. */
struct glint_light glint_light_from_pixel(const struct glint_lens *lens,
                                          int width, int height, int32_t x_q8,
                                          int32_t y_q8);

/* Returns the exact number of bytes that glint_flare_init() needs for CFG; 0 if
 * CFG is out of range. */
size_t glint_flare_bytes(const struct glint_flare_config *cfg);

/* Places a flare in MEM[BYTES], aligned to 64; *FLARE points into it. It needs
 * no cleanup. Returns GLINT_E_ARGUMENT if CFG or the alignment is wrong.
 * Returns GLINT_E_MEMORY if BYTES is too small. */
enum glint_status glint_flare_init(struct glint_flare **flare,
                                   const struct glint_flare_config *cfg,
                                   void *mem, size_t bytes);

/* Sets the stop of the following frames: STOP is copied, except its shade,
 * which must outlive the flare. Capacities do not change. Returns
 * GLINT_E_ARGUMENT if STOP is out of range, or has a shade that the rasteriser
 * does not support. */
enum glint_status glint_flare_set_stop(struct glint_flare *flare,
                                       const struct glint_stop *stop);

/* Removes all bundles of the previous frame. */
void glint_flare_begin(struct glint_flare *flare);

/* Removes all bundles of the previous frame. RAYS, which must stay valid until
 * the next begin or plan, computes the vertices of the bundles that are then
 * added; glint_flare_add() allocates no vertices for them and returns NULL. */
void glint_flare_begin_rays(struct glint_flare *flare,
                            const struct glint_flare_rays *rays);

/* Restricts glint_flare_bin() and glint_flare_draw() to the pixel rows Y0 .. Y1
 * - 1 until the next begin or plan. 0 <= Y0 < Y1 <= height; Y0 must be a
 * multiple of the side of a tile, Y1 must be such a multiple or the height. A
 * picture that is drawn in several bands of rows gets the same bits, with less
 * memory. Bundles may be binned again after each call. Must not be used at half
 * resolution. */
void glint_flare_set_rows(struct glint_flare *flare, int y0, int y1);

/* Adds BUNDLE and returns its vertices, [n_cells + 1][n_cells + 1], row by row;
 * the caller must fill them before glint_flare_bin(). Returns NULL if there is
 * no capacity; the bundle is then counted and left out. */
struct glint_vertex *glint_flare_add(struct glint_flare *flare,
                                     const struct glint_bundle *bundle);

/* Removes all bundles of the previous frame, then adds the visible bundles of
 * all LIGHTS and all ghosts of the lens of FRAME; the caller fills no vertices.
 * LIGHTS, FRAME and everything that FRAME points to must stay valid until
 * glint_flare_bin() has returned. Without capacity for n_lights * ghosts *
 * n_waves bundles the last bundles may be left out. With sets of waves,
 * capacity is needed for the waves of the first set and of the sets that ghosts
 * choose; if it is exceeded, the last ghosts use the first set. */
void glint_flare_plan(struct glint_flare *flare,
                      const struct glint_flare_frame *frame,
                      const struct glint_light *lights, int n_lights);

/* Returns the index, in the lens, of the ghost to which planned bundle I
 * belongs, 0 <= I < bundles of the statistics. */
int glint_flare_ghost(const struct glint_flare *flare, int i);

/* A bundle that is planned, but not binned yet. A program can predict the cost
 * of a frame from all its planned bundles. */
struct glint_planned {
    int n_cells; /* cells per side of the grid */
    /* planned flux; the unit is one pixel at display white */
    struct glint_real flux;
    /* Mean irradiance of the pixels that the bundle covers, display white. */
    struct glint_real irradiance;
    int ghost, light, wave; /* indices, as in glint_flare_account() */
    /* Fraction of the rays traced by the plan that the stop and the barrels
     * transmit, 0 .. 255. */
    int inside_q8;
    /* Fraction of the bounding box of its light that lies in the picture, 0 ..
     * 255. */
    int view_q8;
    /* Log2 of (irradiance of its brightest cell / mean irradiance), 0 .. 254;
     * 255: unknown, as the bundle folds. */
    int contrast_q4;
};

/* Sets PLANNED to planned bundle I, from 0. Returns 0 if there is no bundle
 * I. */
int glint_flare_planned(const struct glint_flare *flare, int i,
                        struct glint_planned *planned);

/* Sets *BRIGHTEST to the largest mean irradiance of a planned bundle, display
 * white, and *FLUX to the flux of all planned bundles, display white x
 * pixels. */
void glint_flare_light(const struct glint_flare *flare,
                       struct glint_real *brightest, struct glint_real *flux);

/* Returns the number of rays that the last plan traced to estimate ghosts. */
int64_t glint_flare_looked(const struct glint_flare *flare);

/* Converts the grids of all bundles into primitives and sorts the primitives
 * into tiles. Bundles that do not fit are left out completely, the last bundles
 * first. */
void glint_flare_bin(struct glint_flare *flare,
                     struct glint_flare_stats *stats);

/* Adds the flare to IMAGE, which has the size of the configuration. Tiles
 * without light are neither read nor written. May be called again. If IMAGE is
 * NULL, the light of every pixel is computed and discarded, so that the time of
 * writing pixels can be measured. */
void glint_flare_draw(struct glint_flare *flare,
                      const struct glint_image *image);

/* Returns the number of small tiles to which the last draw added light. */
int glint_flare_tiles(const struct glint_flare *flare);

/* Returns the number of samples of a linear picture that the last draw clamped
 * to the range of int32. */
int glint_flare_held(const struct glint_flare *flare);

/* ------------------------------------------------------------ what and why */

/* Why the bundle of one ghost, light and wave was drawn or left out. */
enum glint_outcome {
    GLINT_OUTCOME_DRAWN,
    GLINT_OUTCOME_EMPTY, /* the bundle was planned, but no edge of its ray grid
                            changes a pixel */
    /* Not drawn, as only_ghost selects another ghost, or a tint mutes this
     * one. */
    GLINT_OUTCOME_OTHER,
    /* The light is farther off the axis than the model's range. */
    GLINT_OUTCOME_BEYOND,
    /* The model has no polynomials at this angle: no ray passes the lens. */
    GLINT_OUTCOME_CLOSED,
    /* Stop and barrels cut every ray that the plan probed. */
    GLINT_OUTCOME_BLOCKED,
    /* The light or its colour has no power in this wave. */
    GLINT_OUTCOME_DARK,
    GLINT_OUTCOME_OUTSIDE, /* the ghost's light lands off-screen */
    /* No pixel can show the ghost, even with the light of all lamps
     * together. */
    GLINT_OUTCOME_FAINT,
    GLINT_OUTCOME_NO_ROOM,   /* left out because a capacity is full */
    GLINT_OUTCOME_OTHER_SET, /* the ghost uses another set of waves */
    /* The ghost is dim, and drawn as one with the ghost of a brighter light
     * near by. */
    GLINT_OUTCOME_SHARED,
    GLINT_OUTCOMES
};

/* The work of one bundle. Members other than outcome and probed are 0 unless
 * the outcome is DRAWN, EMPTY or NO_ROOM; edges, rows and refs are 0 unless the
 * outcome is DRAWN. */
struct glint_account {
    enum glint_outcome outcome;
    int probed; /* number of rays that the plan probed for the bundle */
    /* Cells per side of the grid, and vertices of the whole grid. */
    int cells, vertices;
    /* Number of polynomials per ray, and how many of these belong to barrels
     * that cut rays. */
    int outputs, barrels;
    /* Number of terms of all these polynomials after angle and wavelength were
     * substituted. */
    int terms;
    /* Number of edges drawn; their sum over all bundles is PRIMITIVES of struct
     * glint_flare_stats. */
    int edges;
    int64_t rows; /* number of pixel rows that the edges cross, summed over the
                     edges */
    int refs;     /* number of entries in the lists of all tiles */
    /* Flux as planned, display white times pixels, before the stop, the barrels
     * and the borders of the picture cut the light. */
    struct glint_real flux;
};

/* Returns the statistics of ghost GHOST (or part) of the lens, light LIGHT and
 * wave WAVE of the frame that was planned and binned last. The function plans
 * the bundle again, so LIGHTS and FRAME of glint_flare_plan() must still be
 * valid. It does not affect drawing and costs as much as planning the
 * bundle. */
void glint_flare_account(struct glint_flare *flare, int ghost, int light,
                         int wave, struct glint_account *account);

/* Restricts drawing to bundles that belong to ghost GHOST with all its
 * additional pupil regions, to light LIGHT and to wave WAVE (with sets of
 * waves: to all waves of set WAVE), among the bundles planned and binned last.
 * Each number may be -1 for all. The restriction lasts until the next call of
 * this function or of glint_flare_bin(). */
void glint_flare_keep(struct glint_flare *flare, int ghost, int light,
                      int wave);

/* Returns the number of edges in the list of small tile TILE; tiles are
 * numbered row by row. Light that enters a tile from the tile to its left is in
 * no list. */
int glint_flare_listed(const struct glint_flare *flare, int tile);

#ifdef __cplusplus
}
#endif

#endif
