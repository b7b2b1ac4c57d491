/* SPDX-License-Identifier: MIT
 *
 * glint/flare.h - lens-flare ghosts, drawn tile by tile in integers.
 *
 *     bytes = glint_flare_bytes(&cfg);                       once
 *     glint_flare_init(&flare, &cfg, mem, bytes);
 *     glint_flare_begin(flare);                              each frame
 *     for each ghost, light and wavelength:
 *         vertices = glint_flare_add(flare, &bundle);        fill them in
 *     or for those of a baked lens at once, instead of both:
 *         glint_flare_plan(flare, &frame, lights, n_lights);
 *     glint_flare_bin(flare, &stats);
 *     glint_flare_draw(flare, &image);
 *
 * All memory is the caller's, taken at init; drawing never allocates and cannot
 * fail. What did not fit the capacities is left out and counted, together with
 * the capacities that would have served. No result depends on the number of
 * workers, the order of jobs, the tile sizes or the order of bundles.
 * Method: [Bodonyi23], with irradiance per cell and anti-aliased clipping.
 */
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

/* Chooses among sets of waves. */
struct glint_wave_planner;
extern const struct glint_wave_planner glint_wave_planner;

/* Sets of waves that each stand for the same light, so that a ghost takes the
 * smallest one whose steps cannot be seen: where the outlines of neighbouring
 * waves lie near each other, or are faint. */
struct glint_wave_sets {
    /* glint_wave_planner, which only a program that names it links. */
    const struct glint_wave_planner *planner;
    int n_sets;                    /* 1 .. GLINT_MAX_WAVE_SETS */
    int size[GLINT_MAX_WAVE_SETS]; /* waves of each, 2 or more, rising: one set
                                      after the other in glint_flare_frame.wave
                                    */
    int32_t apart_q8;       /* pixels that neighbouring outlines may be apart */
    struct glint_real step; /* display white: what no step of light may pass
                               for outlines farther apart; 0: any is seen */
};

/* Everything that a frame is planned from, but its lights. */
struct glint_flare_frame {
    const struct glint_lens *lens;
    const struct glint_wave *wave;
    int n_waves;                        /* 1 or more; of all sets together */
    const struct glint_wave_sets *sets; /* NULL: all waves for every ghost */
    struct glint_real pixels_per_mm;
    int fineness;   /* 4 .. GLINT_MAX_CELLS: of grids, so that with 64 what lies
                       between rays is off by 0.01 px, outlines by 0.1 */
    int uniform;    /* all grids have so many cells a side */
    int only_ghost; /* number of the one ghost of the lens to draw, with its
                       parts; -1: all */
    /* Light that no pixel of a picture in codes shows, display white. Ghosts
     * that stay below may be left out, and the fainter one is, the coarser are
     * its grid and its steps of irradiance. 0: the picture is in linear light.
     */
    struct glint_real faintest;
    /* Edges of a picture in codes across which light changes by less than so
     * many codes, 0 .. 2^15, lie on whole pixels, which takes a fraction of the
     * time. 0: no edge does. */
    int snap_codes_q8;
    /* Only for drawing by edges: there are half as many pixels each way, each
     * of which stands for four of the picture. In Y'CbCr whose chroma is shared
     * by pairs the four are lit at once, by what light does to their mean.
     * NULL, or glint_half, which only a program that names it links. */
    const struct glint_half *half;
};

/* Merges lights in place, and returns how many are left, the brightest first;
 * what lies behind them means nothing any more. Those nearer than NEAR, as the
 * chord of the angle between them, merge as they cannot be told apart; then,
 * while there are more than MOST (1 or more), those whose merging changes the
 * picture least, faint ones over long distances before bright ones. A merged
 * light has the power of both and the direction between, by their powers. What
 * has no light is left out. *N_APART is how many were left before MOST asked
 * for fewer. The result does not depend on the order of lights. */
int glint_lights_merge(struct glint_light *lights, int n_lights,
                       int32_t near_q30, int most, int *n_apart);

/* ------------------------------------------------------------------ drawing */

/* Edges draw the exact area that each cell covers, one irradiance a cell; folds
 * and slivers keep their light; a primitive is an edge across which light
 * changes. Cells interpolate at pixel centres, [Bodonyi23]; a primitive is a
 * cell; a stop with a mask takes this way, and is refused by edges. A program
 * links only the one that it names. */
struct glint_raster;
extern const struct glint_raster glint_raster_edges, glint_raster_cells;

enum glint_weights { GLINT_WEIGHTS_LOOP_DEROSE, GLINT_WEIGHTS_WACHSPRESS };

struct glint_flare_config {
    struct glint_workers *workers; /* kept; NULL: serial. Changes no output */
    unsigned sets; /* instruction sets, glint_sets_here() or fewer; 0: plain C
                      (kernels.h). Changes no output */
    int width, height; /* size of the picture, 1 .. GLINT_MAX_SIDE */
    int tile_log2;     /* small tiles of 2^n pixels square, 3 .. 6 */
    const struct glint_raster *raster; /* NULL: by edges */
    int dither;             /* 1: 8-bit output is dithered, deterministically */
    struct glint_stop stop; /* copied; its mask is kept */

    /* For drawing by edges. The irradiance of a cell is rounded to so many
     * steps an octave, 1 .. 4096, fewer for faint ghosts planned for codes, and
     * edges between equal cells are not drawn; 0: it is not rounded. */
    int irradiance_steps;

    /* The rest is for drawing by cells. */
    int coarse_log2; /* large tiles, tile_log2 + 1 .. 8; 0: one level only */
    enum glint_weights weights;
    int merge_steps; /* blocks of 2^n cells may become one, 0 .. 4 */
    /* largest relative disagreement of edges that merge */
    int32_t merge_gamma_q16;
    int antialias; /* 0: a pixel's centre decides, as published */

    /* Capacities. glint_flare_bin() reports what a frame needed. */
    int max_bundles;
    int max_vertices;
    int max_primitives; /* primitives of a frame; by edges each worker begins
                           with an equal share, and half as much again keeps
                           them from waiting */
    int max_refs;       /* entries of the index lists of the first level */
    int max_tile_refs;  /* entries for one large tile; 0 with one level */
};

struct glint_flare_stats {
    /* Number of each that was drawn. */
    int bundles, vertices, primitives, refs, tile_refs;
    /* Capacities that would have drawn everything, exactly where there is room
     * for need_bundles, and by cells for need_vertices. */
    int need_bundles, need_vertices, need_primitives, need_refs, need_tile_refs;
    int dropped_bundles; /* left out for want of capacity */
    int dropped_cells; /* cells left out of bundles that were drawn: they have a
                          lost ray, a vertex out of range, or no area */
    int merged_cells;  /* cells that went into a larger primitive */
    int held_cells; /* cells, or halves of one, of bundles that were drawn that
                       have more light than one may give a pixel (2048 times
                       white, less if all together would pass 2^24), and were
                       cut down to that */
};

struct glint_flare; /* opaque, in the caller's memory */

/* Sets CFG to what a newcomer should start from, for pictures of WIDTH x
 * HEIGHT; capacities, workers and instruction sets are still to be set. */
void glint_flare_defaults(struct glint_flare_config *cfg, int width,
                          int height);

/* Sets the capacities, by edges, for frames of N_LIGHTS through LENS in N_WAVES
 * wavelengths: as many bundles as there can be, and edges enough for most
 * frames. Statistics tell what would have drawn everything. */
void glint_flare_capacities(struct glint_flare_config *cfg,
                            const struct glint_lens *lens, int n_lights,
                            int n_waves);

/* Sets FRAME to what a newcomer should start from, for a picture in codes
 * through LENS; waves and pixels_per_mm are still to be set. */
void glint_flare_frame_defaults(struct glint_flare_frame *frame,
                                const struct glint_lens *lens);

/* Pixels per mm of the largest picture of WIDTH x HEIGHT that fits the film of
 * LENS, as glint_view_fit() has it. */
struct glint_real glint_flare_pixels_per_mm(const struct glint_lens *lens,
                                            int width, int height);

#define GLINT_FLARE_WAVES 3

/* Red, green and blue: 650, 532 and 450 nm, each measured by its own direct
 * image through LENS, whose stop is a circle, so that white light stays white.
 * Weights are off by 2^-24 at most. */
void glint_flare_waves(struct glint_wave wave[GLINT_FLARE_WAVES],
                       const struct glint_lens *lens);

/* The light, white and of power 1, that LENS shows at (X, Y), pixels from the
 * top left corner, y down, of the picture of WIDTH x HEIGHT above; places
 * beyond 2^22 pixels count as there. In integers what glint_view_to_angles() is
 * in doubles: no sine or cosine is off by more than 2^-28. */
struct glint_light glint_light_from_pixel(const struct glint_lens *lens,
                                          int width, int height, int32_t x_q8,
                                          int32_t y_q8);

/* Bytes that init takes for CFG, exactly; 0 if CFG is out of range. */
size_t glint_flare_bytes(const struct glint_flare_config *cfg);

/* Places a flare in MEM[BYTES], aligned to 64; *FLARE points into it. There is
 * no finish: drop the memory. GLINT_E_MEMORY: BYTES is too small. */
enum glint_status glint_flare_init(struct glint_flare **flare,
                                   const struct glint_flare_config *cfg,
                                   void *mem, size_t bytes);

/* Has the frames to come drawn through STOP, which is copied, its mask kept.
 * Whatever its opening, capacities serve as before. GLINT_E_ARGUMENT: it is out
 * of range, or has a mask that the raster does not take. */
enum glint_status glint_flare_set_stop(struct glint_flare *flare,
                                       const struct glint_stop *stop);

/* Forgets all bundles. */
void glint_flare_begin(struct glint_flare *flare);

/* Takes BUNDLE in and returns its vertices, to be filled before bin: row by
 * row, [n_cells + 1][n_cells + 1]. NULL: no room; the bundle is counted and
 * left out. */
struct glint_vertex *glint_flare_add(struct glint_flare *flare,
                                     const struct glint_bundle *bundle);

/* Forgets all bundles and takes those in that the ghosts of a lens make of
 * LIGHTS, as far as they can be seen; no vertices are to be filled in. All that
 * FRAME points to, and LIGHTS, are kept until bin has returned. Needs room for
 * n_lights * ghosts * n_waves bundles, or the last ones are left out; with sets
 * for as many of the first set, and for those of the sets that are chosen, or
 * the last ghosts take the first set. */
void glint_flare_plan(struct glint_flare *flare,
                      const struct glint_flare_frame *frame,
                      const struct glint_light *lights, int n_lights);

/* Returns the ghost of the lens that planned bundle I belongs to; I is from 0
 * to the bundles of the statistics. */
int glint_flare_ghost(const struct glint_flare *flare, int i);

/* A bundle that was planned and is not yet binned: from these a program can
 * tell what a frame will take before it is drawn. */
struct glint_planned {
    int n_cells;                  /* per side */
    struct glint_real flux;       /* display white times pixels */
    struct glint_real irradiance; /* the same over the pixels it falls on */
};

/* 0: there are not so many. */
int glint_flare_planned(const struct glint_flare *flare, int i,
                        struct glint_planned *planned);

/* Gives the largest mean irradiance of the bundles planned, display white, and
 * the flux of all, display white times pixels. */
void glint_flare_light(const struct glint_flare *flare,
                       struct glint_real *brightest, struct glint_real *flux);

/* Turns the grids into primitives and sorts these into tiles. Bundles that do
 * not fit are left out whole, the last ones added first. */
void glint_flare_bin(struct glint_flare *flare,
                     struct glint_flare_stats *stats);

/* Adds the flare to IMAGE, which has the size of the configuration. Tiles that
 * nothing touches are neither read nor written. May be repeated. NULL: works
 * the light of every pixel out and drops it, to measure what that takes of
 * drawing to 8 bits. */
void glint_flare_draw(struct glint_flare *flare,
                      const struct glint_image *image);

/* Small tiles that the last draw touched. */
int glint_flare_tiles(const struct glint_flare *flare);

/* Samples of a linear picture that the last draw brought to an end of their
 * range, where they saturate. */
int glint_flare_held(const struct glint_flare *flare);

/* ------------------------------------------------------------ what and why */

/* The fate of the rays of one ghost, light and wave. */
enum glint_outcome {
    GLINT_OUTCOME_DRAWN,
    GLINT_OUTCOME_EMPTY,  /* planned, but no edge of its grid changes a pixel */
    GLINT_OUTCOME_OTHER,  /* only_ghost asks for another one */
    GLINT_OUTCOME_BEYOND, /* the light comes from farther out than the model
                           * goes
                           */
    GLINT_OUTCOME_CLOSED, /* the model has no polynomials for this angle: no ray
                             gets through */
    GLINT_OUTCOME_BLOCKED,   /* the stop and the barrels take all rays looked at
                              */
    GLINT_OUTCOME_DARK,      /* the light has no power in this wave */
    GLINT_OUTCOME_OUTSIDE,   /* it lies beside the picture */
    GLINT_OUTCOME_FAINT,     /* no pixel can show it, of all lights together */
    GLINT_OUTCOME_NO_ROOM,   /* a capacity is full */
    GLINT_OUTCOME_OTHER_SET, /* the ghost takes another set of waves */
    GLINT_OUTCOMES
};

/* The work that one bundle took. All but the outcome is 0 unless DRAWN, EMPTY
 * or NO_ROOM; edges, rows and refs are 0 unless DRAWN. */
struct glint_account {
    enum glint_outcome outcome;
    int probed;           /* rays that the plan looked at */
    int cells, vertices;  /* cells a side of the grid, vertices of all of it */
    int outputs, barrels; /* polynomials of a ray; of these, barrels that cut */
    int terms; /* terms of all these polynomials, with angle and wavelength put
                  in */
    int edges; /* drawn; all edges of all bundles are the primitives */
    int64_t rows; /* rows of pixels that the edges cross */
    int refs;     /* entries in the lists of tiles */
    /* Display white times pixels, as planned, before the stop, the barrels and
     * the sides of the picture cut. */
    struct glint_real flux;
};

/* The account of ghost GHOST (or part) of the lens, of light LIGHT and wave
 * WAVE of the frame that was planned and binned last, by edges. It asks the
 * plan again, so that what plan was given must still be there; changes nothing
 * that is drawn. Costs as much as planning that bundle. */
void glint_flare_account(struct glint_flare *flare, int ghost, int light,
                         int wave, struct glint_account *account);

/* Restricts drawing to the bundles of GHOST with all its parts, LIGHT and WAVE
 * (with sets: all waves of set WAVE), each -1 for all, of those planned and
 * binned last, by edges. It holds until the next call of this or of bin. */
void glint_flare_keep(struct glint_flare *flare, int ghost, int light,
                      int wave);

/* Edges in the list of small tile TILE, row by row; light that runs in from the
 * left is in none. */
int glint_flare_listed(const struct glint_flare *flare, int tile);

#ifdef __cplusplus
}
#endif

#endif
