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

/* Sets of waves (wavelengths). Each set represents the same light. Each ghost
 * is drawn with the smallest set whose steps of colour are invisible in the
 * ghost: its outlines in neighbouring waves are close to each other, or
 * faint. */
struct glint_wave_sets {
    /* &glint_wave_planner. It is a pointer so that only programs that use sets
     * link the planner. */
    const struct glint_wave_planner *planner;
    int n_sets; /* number of sets, 1 .. GLINT_MAX_WAVE_SETS */
    /* Number of waves of each set, 2 or more. The waves of all sets are in
     * glint_flare_frame.wave, one set after the other, in rising order of these
     * numbers. */
    int size[GLINT_MAX_WAVE_SETS];
    /* Max distance between the outlines of a ghost in neighbouring waves,
     * pixels. */
    int32_t apart_q8;
    /* Step of light, display white, that counts as invisible. A set whose steps
     * are smaller suffices for a ghost even if outlines are farther apart than
     * apart_q8. 0: every step counts as visible. */
    struct glint_real step;
};

enum { GLINT_DIM_NODES = 33, GLINT_DIM_VALUES = 4, GLINT_DIM_LIGHTS = 256 };
struct glint_dim_method;
extern const struct glint_dim_method glint_dim_method;

/* Cache of the brightness of each ghost, by the angle of the light and at three
 * wavelengths. A program uses one cache for all frames with the same lens,
 * stop, set of wavelengths and size. The plan of a frame fills missing entries.
 * The cache never changes a picture. */
struct glint_dim {
    /* &glint_dim_method. It is a pointer so that only programs that use the
     * cache link the method. */
    const struct glint_dim_method *method;
    /* Log2 of the brightness of each ghost, [GLINT_DIM_NODES][ghosts of the
     * lens][GLINT_DIM_VALUES]. */
    int16_t *log2_q8;
    /* 1: the node (angle) is filled. The caller clears all nodes before the
     * first plan, and when lens, stop, waves or size change. */
    uint8_t done[GLINT_DIM_NODES];
    /* Set by each plan. For each light but the first: index of the nearest
     * light among the lights before it, and log2 of the distance to that light.
     * Lights with an index of GLINT_DIM_LIGHTS or more do not share rays. */
    int16_t nearest[GLINT_DIM_LIGHTS];
    int16_t apart_log2_q8[GLINT_DIM_LIGHTS];
};

/* The input of a plan except the lights. */
struct glint_flare_frame {
    const struct glint_lens *lens;
    const struct glint_wave *wave;
    int n_waves; /* number of waves in all sets together, 1 or more */
    /* Sets of waves; NULL: every ghost uses all waves. */
    const struct glint_wave_sets *sets;
    struct glint_real pixels_per_mm;
    /* Number that determines the cells per side of ray grids, 4 ..
     * GLINT_MAX_CELLS. The cells per side of a grid are proportional to
     * FINENESS and to the square root of the curvature of the ghost: at least
     * GLINT_LEAST_CELLS, at most 2 * FINENESS, or 4 * FINENESS where the ghost
     * folds. At 64, straight lines between rays are off by 0.01 pixels on
     * average, outlines by 0.1. */
    int fineness;
    int uniform; /* 1: all ray grids have FINENESS cells per side */
    /* Index of the only ghost of the lens that is drawn, with its additional
     * pupil regions (parts); -1: all ghosts. */
    int only_ghost;
    /* Tints of the ghosts and their parts, [ghosts of the lens, parts
     * included]; NULL: no ghost is tinted. */
    const struct glint_tint *tints;
    /* For a picture in codes: the max light that changes no pixel, display
     * white. Ghosts fainter than this may be left out. Ghosts not much brighter
     * get coarser grids and coarser steps of irradiance. 0: the picture is in
     * linear light. */
    struct glint_real faintest;
    /* Parameters of dim ghosts. Used only with three waves and without sets;
     * lights must be in the order of glint_lights_merge(). A ghost is dim if
     * its mean light in wave 1, from one light, is below DIMMEST (display
     * white), or below DIMMEST / 8 if the ghost folds. A dim ghost is drawn
     * with the rays of wave 1 alone, in the colours of all three waves. Between
     * DIMMEST and twice DIMMEST, waves 0 and 2 draw a fraction of their light
     * with their own rays. Dim ghosts of lights near each other are drawn as
     * one ghost, between them, if their light is low enough for the distance.
     * DIM NULL or DIMMEST {0, 0}: every wave draws all of its light. */
    struct glint_dim *dim;
    struct glint_real dimmest;
    /* Limit of light, codes, 0 .. 2^15 in _q8. In a picture in codes, edges are
     * snapped to the pixel grid if the light changes across them by fewer
     * codes, which reduces their cost. 0: no edge is snapped. */
    int snap_codes_q8;
    /* &glint_half: the flare has half the resolution of the picture in x and y,
     * so that each pixel of the flare lights four pixels of the picture. In
     * Y'CbCr with subsampled chroma, all four pixels change by the change of
     * their mean. NULL: full resolution. HALF is a pointer so that only
     * programs that use it link half resolution. */
    const struct glint_half *half;
    /* Factors on red, green and blue of each light when it is drawn,
     * [n_lights], 0 .. 2^15; only with glint_reuse and reuse_gains. Changing
     * them does not require a new plan. NULL: all factors are 1. */
    const int32_t (*gain_q14)[3];
};

/* Static lights: lights of one frame of a video that also represent the lights
 * of later frames, so that traced rays can be reused. The caller owns the
 * arrays, which have MAX_LIGHTS entries each, and sets N to 0 before the first
 * frame. */
struct glint_still {
    int max_lights;
    int n; /* number of static lights in LIGHT, and of their factors */
    struct glint_light *light;
    /* Factors by which the static lights become the lights of the current
     * frame; passed as gain_q14 of struct glint_flare_frame. */
    int32_t (*gain_q14)[3];
    int64_t (*sum_q20)[3]; /* scratch */
};

/* Decides whether the static lights can represent LIGHTS. Two conditions must
 * hold: each of LIGHTS is within NEAR_Q30 (chord of the angle) of a static
 * light, and no static light must become more than 1.5 times as bright as it
 * was planned. Then the static lights stay the same, and their factors
 * reproduce LIGHTS; the factor is 0 if a light has vanished. Otherwise LIGHTS
 * become the static lights. Returns the number of static lights, or 0 if there
 * are more than max_lights. Factors are accurate to 2^-14; if the colour has
 * changed, each channel is accurate to 1/64 of the largest channel. */
int glint_lights_still(struct glint_still *still,
                       const struct glint_light *lights, int n_lights,
                       int32_t near_q30);

/* Merges LIGHTS in place and returns the number of lights that remain, sorted
 * by decreasing brightness; entries after these are undefined. First merges
 * lights whose distance, the chord of the angle between them, is at most
 * NEAR_Q30. Then, while more than MOST (1 or more) remain, merges the pair that
 * changes the picture least: faint lights merge over longer distances than
 * bright lights. A merged light has the power of both and a direction between
 * theirs, weighted by their powers. Lights without power or colour are left
 * out. *N_APART receives the number of distinct lights, before merging because
 * of MOST. The result does not depend on the order of LIGHTS. */
int glint_lights_merge(struct glint_light *lights, int n_lights,
                       int32_t near_q30, int most, int *n_apart);

/* ------------------------------------------------------------------ drawing */

/* Each cell of a ray grid is drawn with its exact area and one irradiance, so
 * that folds and slivers preserve their light. A primitive is an edge across
 * which light changes. */

/* Frame reuse. If the input of a plan equals the input of the previous plan,
 * the edges and lists of tiles of the previous frame are drawn again. */
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
     * 1 .. 4096. Edges between cells of equal irradiance are not drawn. Faint
     * ghosts of a picture in codes use fewer steps. 0: irradiance is not
     * rounded. */
    int irradiance_steps;

    /* Capacities. The statistics of glint_flare_bin() report the capacities
     * that a frame needed. */
    int max_bundles;
    int max_vertices; /* vertices of all bundles of a frame */
    /* max number of primitives (edges) of a frame. Each worker gets an equal
     * section of this memory. With 1.5 times the required number, bundles
     * rarely have to wait for free memory in the section of another worker. */
    int max_primitives;
    int max_refs; /* entries in the lists of all tiles */

    /* &glint_reuse: if lights, waves and quality parameters equal those of the
     * previous plan, and its bundles were binned, these are drawn again. The
     * output is the same. NULL: every frame is planned. REUSE is a pointer so
     * that only programs that use it link frame reuse. */
    const struct glint_reuse *reuse;
    /* Max number of lights of a frame that can be reused, 40 bytes each; a
     * frame with more lights is always planned again. */
    int reuse_lights;
    /* 1: frames may have gain_q14. This needs 12 bytes for each of
     * max_bundles. */
    int reuse_gains;
};

struct glint_flare_stats {
    /* Numbers of items drawn; VERTICES includes the vertices of bundles that
     * were left out. */
    int bundles, vertices, primitives, refs;
    /* Capacities with which everything would have been drawn. Exact if
     * max_bundles was large enough. */
    int need_bundles, need_vertices, need_primitives, need_refs;
    int dropped_bundles; /* number of bundles left out for lack of capacity */
    /* Number of cells left out of drawn bundles because they have an invalid
     * ray, a vertex out of range, or no area. */
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

/* Returns the scale of a picture, pixels per mm on the sensor. The picture has
 * WIDTH x HEIGHT pixels and is the largest that fits into the image area (film)
 * of LENS, as in glint_view_fit(). */
struct glint_real glint_flare_pixels_per_mm(const struct glint_lens *lens,
                                            int width, int height);

#define GLINT_FLARE_WAVES 3

/* Sets WAVE to red, green and blue: 650, 532 and 450 nm. The weight of each
 * wave is 1 / (flux of its direct image through LENS with a circular stop), so
 * that white light stays white. Weights are accurate to 2^-24. */
void glint_flare_waves(struct glint_wave wave[GLINT_FLARE_WAVES],
                       const struct glint_lens *lens);

/* Returns a white light of power 1 whose image through LENS lies at (X, Y),
 * pixels from the top left corner, y down. The picture has WIDTH x HEIGHT
 * pixels and is the largest that fits into the image area (film) of LENS.
 * Distances from the centre, across and down, are clamped to 2^22 pixels. This
 * is the integer counterpart of glint_view_to_angles(). The error of each sine
 * and cosine is at most 2^-28. */
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

/* Sets the stop of the following frames: STOP is copied, but not the SHADE
 * (soft edge, dust, mask) to which it points, which must outlive the flare.
 * Capacities do not change. Returns GLINT_E_ARGUMENT if STOP is out of range,
 * or the rasteriser does not support its SHADE. */
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
 * all LIGHTS and all ghosts of the lens of FRAME. Vertices are computed later;
 * the caller sets none. LIGHTS, FRAME and everything that FRAME points to must
 * stay valid until glint_flare_bin() has returned. Without capacity for
 * n_lights * ghosts * n_waves bundles the last bundles may be left out. With
 * sets of waves, capacity is needed for the waves of the first set and of the
 * sets that ghosts choose; if it is exceeded, the last ghosts use the first
 * set. */
void glint_flare_plan(struct glint_flare *flare,
                      const struct glint_flare_frame *frame,
                      const struct glint_light *lights, int n_lights);

/* Returns the index, in the lens, of the ghost to which planned bundle I
 * belongs, 0 <= I < bundles of the statistics. */
int glint_flare_ghost(const struct glint_flare *flare, int i);

/* A bundle that is planned, but not binned yet. Programs predict the cost of a
 * frame from all its planned bundles. */
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
    /* Fraction of the bounding box of the bundle's light that lies in the
     * picture, 0 .. 255. */
    int view_q8;
    /* Log2 of (irradiance of the brightest cell / mean irradiance), 0 .. 254.
     * 255: unknown, because the ghost folds. */
    int contrast_q4;
};

/* Sets PLANNED to planned bundle I, from 0. Returns 1, or 0 if there is no
 * bundle I. */
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
 * NULL, the light of every pixel is computed and discarded; programs use this
 * to measure the time of writing pixels. */
void glint_flare_draw(struct glint_flare *flare,
                      const struct glint_image *image);

/* Returns the number of small tiles, of side 2^tile_log2, to which the last
 * draw added light. */
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
    /* Not drawn because only_ghost selects another ghost, or because the tint
     * of the ghost mutes it. */
    GLINT_OUTCOME_OTHER,
    /* The light is farther off the axis than the model's range. */
    GLINT_OUTCOME_BEYOND,
    /* The model has no polynomials at this angle: no ray passes the lens. */
    GLINT_OUTCOME_CLOSED,
    /* Stop and barrels cut every ray that the plan probed. */
    GLINT_OUTCOME_BLOCKED,
    /* The light has no power in this wave, or no power at all. */
    GLINT_OUTCOME_DARK,
    GLINT_OUTCOME_OUTSIDE, /* the ghost's light lands off-screen */
    /* The ghost is too faint for any pixel, even if the ghosts of all lamps
     * fell on the same pixels. */
    GLINT_OUTCOME_FAINT,
    GLINT_OUTCOME_NO_ROOM,   /* left out because a capacity is full */
    GLINT_OUTCOME_OTHER_SET, /* the ghost uses another set of waves */
    /* The ghost is dim: it is drawn together with the same ghost of a brighter
     * light near by. */
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
    /* Number of polynomials per ray, and number of those that describe barrels
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
    /* Flux as planned, display white times pixels: before the stop, the barrels
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

/* Restricts drawing to some of the bundles that were planned and binned last:
 * those of ghost GHOST with all its additional pupil regions, of light LIGHT
 * and of wave WAVE (with sets of waves: of all waves of set WAVE). Each number
 * may be -1 for all. The restriction lasts until the next call of this function
 * or of glint_flare_bin(). */
void glint_flare_keep(struct glint_flare *flare, int ghost, int light,
                      int wave);

/* Returns the number of edges in the list of small tile TILE, of side
 * 2^tile_log2; tiles are numbered row by row. Light that enters a tile from the
 * tile to its left is in no list. */
int glint_flare_listed(const struct glint_flare *flare, int tile);

#ifdef __cplusplus
}
#endif

#endif
