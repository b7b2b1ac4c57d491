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
 * All memory is the caller's, taken at init; drawing never allocates and cannot
 * fail. Bundles for which a capacity is too small are left out and counted, and
 * the statistics say which capacities would have served. No result depends on
 * the number of workers, the order of jobs, the tile sizes or the order of
 * bundles. Method: [Bodonyi23], with irradiance per cell and anti-aliased
 * clipping. */
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

/* Sets of waves that each stand for the same light. Each ghost takes the
 * smallest set whose steps cannot be seen: where the outlines of neighbouring
 * waves lie near each other, or are faint. */
struct glint_wave_sets {
    /* glint_wave_planner; a program that does not name it does not link it. */
    const struct glint_wave_planner *planner;
    int n_sets;                    /* 1 .. GLINT_MAX_WAVE_SETS */
    int size[GLINT_MAX_WAVE_SETS]; /* number of waves of each set, 2 or more,
                                      rising; the sets follow each other in
                                      glint_flare_frame.wave */
    int32_t apart_q8;       /* pixels: largest distance between outlines of
                               neighbouring waves */
    struct glint_real step; /* display white: a set serves, too, if its steps of
                               light are below this, however far outlines are
                               apart; 0: every step counts as seen */
};

/* How bright each ghost of a lens is in each of three waves, by the angle of
 * its light. A program keeps one for all frames of a lens, a stop, three waves
 * and a size; plans fill it as lights need it, and no picture depends on what
 * was filled before. */
enum { GLINT_DIM_NODES = 33, GLINT_DIM_VALUES = 4, GLINT_DIM_LIGHTS = 256 };
struct glint_dim_method;
extern const struct glint_dim_method glint_dim_method;
struct glint_dim {
    /* glint_dim_method; a program that does not name it does not link it. */
    const struct glint_dim_method *method;
    /* [GLINT_DIM_NODES][ghosts of the lens][GLINT_DIM_VALUES] */
    int16_t *log2_q8;
    /* 1: the node is filled. Before the first plan, and when the lens, stop,
     * waves or size change, the caller sets all to 0. */
    uint8_t done[GLINT_DIM_NODES];
    /* Set by each plan: of each light but the first, the nearest one before it,
     * and the logarithm of how far that is. Lights beyond these share no rays.
     */
    int16_t nearest[GLINT_DIM_LIGHTS];
    int16_t apart_log2_q8[GLINT_DIM_LIGHTS];
};

/* Everything that a frame is planned from, except its lights. */
struct glint_flare_frame {
    const struct glint_lens *lens;
    const struct glint_wave *wave;
    int n_waves; /* number of waves of all sets together, 1 or more */
    const struct glint_wave_sets *sets; /* NULL: all waves for every ghost */
    struct glint_real pixels_per_mm;
    /* 4 .. GLINT_MAX_CELLS. The cells a side of a grid are in proportion to it
     * and to the root of how much the ghost bends: at least GLINT_LEAST_CELLS,
     * at most twice FINENESS, or four times where light folds. With 64,
     * straight lines between rays are 0.01 pixels off in the mean, outlines
     * 0.1. */
    int fineness;
    int uniform;    /* 1: all grids have FINENESS cells a side */
    int only_ghost; /* number of the one ghost of the lens to draw, with its
                       parts; -1: all */
    /* [ghosts of the lens, parts included]; NULL: all ghosts are as the lens
     * gives them. */
    const struct glint_tint *tints;
    /* Largest light that no pixel of a picture in codes shows, display white.
     * Ghosts below it may be left out, and a fainter ghost gets a coarser grid
     * and coarser steps of irradiance. 0: the picture is in linear light. */
    struct glint_real faintest;
    /* For three waves without sets. Lights are as glint_lights_merge() leaves
     * them: dim ghosts of lights near each other are drawn as one, between
     * them, where their light is low enough for that distance. And a ghost
     * whose mean light in wave 1, from one light, is below DIMMEST (display
     * white), or below an eighth of that if it folds, is drawn by the rays of
     * wave 1 alone, in the colours of all three. Up to twice as bright, waves 0
     * and 2 draw a part of their light by their own rays. DIM NULL or DIMMEST
     * {0, 0}: every wave draws all of its light. */
    struct glint_dim *dim;
    struct glint_real dimmest;
    /* Codes, 0 .. 2^15 in _q8: in a picture in codes, edges across which light
     * changes by fewer codes than this are moved to whole pixels, which takes a
     * fraction of the time. 0: no edge is moved. */
    int snap_codes_q8;
    /* If set, the flare has half as many pixels each
     * way, and each of them stands for four of the picture. In Y'CbCr whose
     * chroma is shared by pairs of pixels, the four are lit at once, by the
     * change of their mean. NULL, or glint_half, which is linked only by a
     * program that names it. */
    const struct glint_half *half;
    /* Only with glint_reuse and reuse_gains: [n_lights] factors on red, green
     * and blue of each light as it is drawn, 0 .. 2^15. They make no other
     * frame of it. NULL: all are 1. */
    const int32_t (*gain_q14)[3];
};

/* Lights over a video. Memory is the caller's, of MAX_LIGHTS entries each; N
 * is 0 at first. */
struct glint_still {
    int max_lights;
    int n; /* lights that stand, and their factors */
    struct glint_light *light;
    int32_t (*gain_q14)[3]; /* for struct glint_flare_frame */
    int64_t (*sum_q20)[3];  /* scratch */
};

/* Tells whether each of LIGHTS is within NEAR_Q30, the chord of an angle, of
 * one of those that stand, and the light there at most half as much again as
 * it was: then these stand for them, with factors that give the light that
 * LIGHTS have there, 0 where there are none any more. Else LIGHTS stand from
 * now on, as they are. Returns how many stand; 0: more than max_lights. A
 * factor is off by 2^-14, a channel by a 64th of the largest one where another
 * colour was planned. */
int glint_lights_still(struct glint_still *still,
                       const struct glint_light *lights, int n_lights,
                       int32_t near_q30);

/* Merges lights in place and returns how many are left, sorted from the
 * brightest to the faintest; entries after these are undefined. Lights no
 * farther apart than NEAR_Q30, the chord of the angle between them, merge
 * first, as they cannot be distinguished. Then, while more than MOST (1 or
 * more) are left, those merge whose merging changes the picture least: faint
 * lights over long distances before bright ones. A merged light has the power
 * of both and a direction between theirs, weighted by their powers. Lights
 * without power or colour are left out. *N_APART receives the number of lights
 * before any merged because of MOST. The result does not depend on the order of
 * lights. */
int glint_lights_merge(struct glint_light *lights, int n_lights,
                       int32_t near_q30, int most, int *n_apart);

/* ------------------------------------------------------------------ drawing */

/* The exact area that each cell covers is drawn with one irradiance per cell;
 * folds and slivers keep their light. A primitive is an edge across which light
 * changes. */

/* Draws a frame that is planned from what the last one was planned from with
 * the edges and lists of tiles that are still there. */
struct glint_reuse;
extern const struct glint_reuse glint_reuse;

struct glint_flare_config {
    struct glint_workers *workers; /* kept; NULL: serial. Changes no output */
    unsigned sets; /* instruction sets, glint_sets_here() or fewer; 0: plain C
                      (kernels.h). Changes no output */
    int width, height;      /* size of the picture, 1 .. GLINT_MAX_SIDE */
    int tile_log2;          /* log2 of the side of a tile in pixels, 3 .. 6 */
    int dither;             /* 1: 8-bit output is dithered, deterministically */
    struct glint_stop stop; /* copied */

    /* Irradiance of a cell is rounded to this many steps
     * an octave, 1 .. 4096, and to fewer for faint ghosts planned for codes.
     * Edges between cells of equal irradiance are not drawn. 0: it is not
     * rounded. */
    int irradiance_steps;

    /* Capacities. The statistics of glint_flare_bin() say what a frame needed.
     */
    int max_bundles;
    int max_vertices;   /* of bundles that glint_flare_add() takes in */
    int max_primitives; /* primitives of a frame. Each worker gets an equal
                           fraction; with half as many more than needed, few
                           bundles have to wait for room in another worker's
                           share. */
    int max_refs;       /* entries in the lists of all tiles */

    /* glint_reuse: a plan of the lights, waves and dials of the plan before,
     * whose bundles were binned, keeps these. No output changes. NULL: every
     * frame is rebuilt. Only a program that names it links it. */
    const struct glint_reuse *reuse;
    int reuse_lights; /* lights that are remembered for that, 40 bytes each; a
                         frame of more is always rebuilt */
    int reuse_gains;  /* 1: frames may have gain_q14, which takes 12 bytes for
                         each of max_bundles */
};

struct glint_flare_stats {
    /* Number of each that was drawn; VERTICES counts all that were taken in. */
    int bundles, vertices, primitives, refs;
    /* Capacities that would have drawn everything. They are exact if
     * max_bundles was large enough. */
    int need_bundles, need_vertices, need_primitives, need_refs;
    int dropped_bundles; /* left out for want of capacity */
    int dropped_cells; /* cells left out of bundles that were drawn: they have a
                          invalid ray, a vertex out of range, or no area */
    int reused; /* 1: edges and lists of tiles are those of the last frame */
    int held_cells; /* cells, or halves of cells, of drawn bundles whose light
                       was clamped to what one cell may give a pixel: 2048 times
                       white, or less if the sum over all cells could pass 2^24
                     */
};

struct glint_flare; /* opaque, in the caller's memory */

/* Sets CFG to good starting values for pictures of WIDTH x HEIGHT; the caller
 * still sets capacities, workers and instruction sets. */
void glint_flare_defaults(struct glint_flare_config *cfg, int width,
                          int height);

/* Sets the capacities for drawing N_LIGHTS lights through LENS in
 * N_WAVES wavelengths: as many bundles as there can be, 2^20 at most, and edges
 * enough for most frames. The statistics of a frame say what would have drawn
 * everything. */
void glint_flare_capacities(struct glint_flare_config *cfg,
                            const struct glint_lens *lens, int n_lights,
                            int n_waves);

/* Sets FRAME to good starting values for a picture in codes through LENS; the
 * caller still sets waves and pixels_per_mm. */
void glint_flare_frame_defaults(struct glint_flare_frame *frame,
                                const struct glint_lens *lens);

/* Returns pixels per mm on the sensor for a picture of WIDTH x HEIGHT pixels
 * that is as large as fits the film of LENS, as by glint_view_fit(). */
struct glint_real glint_flare_pixels_per_mm(const struct glint_lens *lens,
                                            int width, int height);

#define GLINT_FLARE_WAVES 3

/* Sets WAVE to red, green and blue: 650, 532 and 450 nm, each measured by its
 * own direct image through LENS with a circular stop, so that white light stays
 * white. Weights are off by 2^-24 at most. */
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

/* Returns the exact bytes that init takes for CFG; 0 if CFG is out of range. */
size_t glint_flare_bytes(const struct glint_flare_config *cfg);

/* Places a flare in MEM[BYTES], aligned to 64; *FLARE points into it. There is
 * nothing to release but the memory. GLINT_E_ARGUMENT: CFG or the alignment is
 * wrong. GLINT_E_MEMORY: BYTES is too small. */
enum glint_status glint_flare_init(struct glint_flare **flare,
                                   const struct glint_flare_config *cfg,
                                   void *mem, size_t bytes);

/* Sets the stop that frames to come are drawn through: STOP is copied, its mask
 * kept. Capacities stay as they are, whatever the opening. GLINT_E_ARGUMENT:
 * STOP is out of range, or has a mask that the raster does not take. */
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
 * there is no room; the bundle is then counted and left out. */
struct glint_vertex *glint_flare_add(struct glint_flare *flare,
                                     const struct glint_bundle *bundle);

/* Forgets all bundles, then takes in those that LIGHTS make of the ghosts of
 * the lens of FRAME, as far as they can be seen; the caller fills no vertices.
 * LIGHTS, FRAME and all that it points to must stay until glint_flare_bin() has
 * returned. Needs room for n_lights * ghosts * n_waves bundles, or the last
 * ones are left out. With sets of waves it needs that room for the waves of the
 * first set, and room for the sets that ghosts choose, or the last ghosts take
 * the first set. */
void glint_flare_plan(struct glint_flare *flare,
                      const struct glint_flare_frame *frame,
                      const struct glint_light *lights, int n_lights);

/* Returns the number, in the lens, of the ghost that planned bundle I belongs
 * to, 0 <= I < bundles of the statistics. */
int glint_flare_ghost(const struct glint_flare *flare, int i);

/* A bundle that is planned and not yet binned. From all of them a program can
 * tell what a frame will take before it is drawn. */
struct glint_planned {
    int n_cells;            /* cells a side of the grid */
    struct glint_real flux; /* display white times pixels */
    /* Flux over the pixels that it falls on, display white. */
    struct glint_real irradiance;
    int ghost, light, wave; /* as of glint_flare_account() */
    int inside_q8; /* fraction of its rays that stop and barrels let through, of
                      those that the plan looked at, 0 .. 255 */
    int view_q8;   /* fraction of the box about its light that lies in the
                      picture,   0 .. 255 */
    int contrast_q4; /* log2 of its brightest cell's irradiance over the mean, 0
                        .. 254; 255: it folds, and is not known */
};

/* Sets PLANNED to planned bundle I, counted from 0; returns 0 if there are not
 * so many. */
int glint_flare_planned(const struct glint_flare *flare, int i,
                        struct glint_planned *planned);

/* Sets *BRIGHTEST to the largest mean irradiance of a planned bundle, in
 * display white, and *FLUX to the flux of all of them, in display white times
 * pixels. */
void glint_flare_light(const struct glint_flare *flare,
                       struct glint_real *brightest, struct glint_real *flux);

/* Returns the number of rays that the last plan looked at. */
int64_t glint_flare_looked(const struct glint_flare *flare);

/* Turns the grids of all bundles into primitives and sorts these into tiles.
 * Bundles that do not fit are left out whole, the last ones added first. */
void glint_flare_bin(struct glint_flare *flare,
                     struct glint_flare_stats *stats);

/* Adds the flare to IMAGE, which has the size of the configuration. Tiles that
 * no light touches are neither read nor written. May be called again. If IMAGE
 * is NULL, the light of every pixel is worked out and dropped: so a program can
 * measure how much of the time of drawing to 8 bits that takes. */
void glint_flare_draw(struct glint_flare *flare,
                      const struct glint_image *image);

/* Returns the number of small tiles in which the last draw drew something. */
int glint_flare_tiles(const struct glint_flare *flare);

/* Returns how many samples of a linear picture the last draw clamped to an end
 * of their range. */
int glint_flare_held(const struct glint_flare *flare);

/* ------------------------------------------------------------ what and why */

/* The fate of the rays of one ghost, light and wave. */
enum glint_outcome {
    GLINT_OUTCOME_DRAWN,
    GLINT_OUTCOME_EMPTY,  /* planned, but no edge of its grid changes a pixel */
    GLINT_OUTCOME_OTHER,  /* only_ghost requests another ghost, or a tint mutes
                             this one */
    GLINT_OUTCOME_BEYOND, /* the light comes from farther out than the model
                           * goes
                           */
    GLINT_OUTCOME_CLOSED, /* the model has no polynomials for this angle: no ray
                             gets through */
    GLINT_OUTCOME_BLOCKED, /* the stop and the barrels cut every ray that the
                              plan looked at */
    GLINT_OUTCOME_DARK,    /* the light has no power in this wave */
    GLINT_OUTCOME_OUTSIDE, /* the light lands off-screen */
    GLINT_OUTCOME_FAINT, /* no pixel can show the ghost, even with the light of
                            all lamps together */
    GLINT_OUTCOME_NO_ROOM,   /* a capacity is full */
    GLINT_OUTCOME_OTHER_SET, /* the ghost takes another set of waves */
    GLINT_OUTCOME_SHARED, /* dim, and drawn with the ghost of a brighter light
                             near by */
    GLINT_OUTCOMES
};

/* The work that one bundle took. Members other than outcome and probed are 0
 * unless the outcome is DRAWN, EMPTY or NO_ROOM; edges, rows and refs are 0
 * unless it is DRAWN. */
struct glint_account {
    enum glint_outcome outcome;
    int probed; /* rays that the plan looked at */
    /* Cells a side of the grid, and vertices of the whole grid. */
    int cells, vertices;
    int outputs, barrels; /* polynomials of a ray, and how many of them are of
                             barrels that cut */
    int terms; /* terms of all these polynomials once angle and wavelength are
                  put in */
    int edges; /* edges drawn; summed over all bundles they are the primitives
                  of the statistics */
    int64_t rows; /* rows of pixels that the edges cross */
    int refs;     /* entries in the lists of all tiles */
    /* Flux as planned, display white times pixels: before the stop, the barrels
     * and the sides of the picture cut it. */
    struct glint_real flux;
};

/* Gives the account of ghost GHOST (or part) of the lens, light LIGHT and wave
 * WAVE of the frame that was planned and binned last. It plans the
 * bundle once more, so LIGHTS and FRAME of glint_flare_plan() must still be
 * there. It changes nothing that is drawn and costs as much as planning the
 * bundle. */
void glint_flare_account(struct glint_flare *flare, int ghost, int light,
                         int wave, struct glint_account *account);

/* Restricts drawing to some of the bundles that were planned and binned last:
 * those of GHOST with all its parts, of LIGHT and of WAVE (with sets
 * of waves: all waves of set WAVE), each -1 for all. The restriction holds
 * until the next call of this function or of glint_flare_bin(). */
void glint_flare_keep(struct glint_flare *flare, int ghost, int light,
                      int wave);

/* Returns the number of edges in the list of small tile TILE; tiles count row
 * by row. Light that runs in from the left is in no list. */
int glint_flare_listed(const struct glint_flare *flare, int tile);

#ifdef __cplusplus
}
#endif

#endif
