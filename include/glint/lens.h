/* SPDX-License-Identifier: MIT
 *
 * glint/lens.h - a baked lens: its model file, and rays through it in integers.
 *
 *     status = glint_lens_open(&lens, data, bytes, &reason);    once
 *     glint_transfer_init(&transfer, &lens, ghost, sine_q30, wave_q24);
 *     glint_transfer_ray(&transfer, u_q30, v_q30, &out);        or
 *     glint_transfer_grid(&transfer, &place, n_cells, vertices);
 *
 * A model holds, for every ghost, sparse polynomials from the pupil to the
 * stop, the sensor, the barrels and the energy. It is one block of 32-bit words
 * that is used where it lies, in ROM or a mapped file: nothing is copied,
 * nothing is allocated. After glint_lens_open() has accepted it nothing can go
 * wrong; but what a frame costs is not bounded by the size of the file: ghosts
 * that fold, in their thousands, take minutes. Where models are not trusted,
 * hold memory by the capacities of glint/flare.h and time from outside.
 *
 * Variables of a polynomial, each -1 .. 1:
 *   u, v   place in the ghost's box on the vertex plane of the first surface,
 *          u in the plane of the light, v across; everything is symmetric in v
 *   s      sine of the light's angle within the range of the system
 *   w      1 / wavelength^2 within the band of the system
 * s and w are the same for a whole bundle: init puts them in and leaves
 * polynomials in u and v. Method after [Bodonyi25], in coordinates in which
 * ghosts are tame.
 */
#ifndef GLINT_LENS_H
#define GLINT_LENS_H

#include <stddef.h>
#include <stdint.h>

#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MAX_WAVE_SETS 5 /* see struct glint_wave_sets, flare.h */

struct glint_vertex;

/* ------------------------------------------------------------- model file
 *
 * Little-endian 32-bit words; offsets ("_at") are bytes from the start of the
 * file, multiples of 4. Header first, then in any order what it points to. */

#define GLINT_MODEL_MAGIC   UINT32_C(0x544e4c47) /* "GLNT" */
#define GLINT_MODEL_VERSION 3

/* mantissa * 2^exponent; mantissa 0, or 2^30 .. 2^31 - 1 in magnitude;
 * exponent within +-200. */
struct glint_real {
    int32_t mantissa;
    int32_t exponent;
};

enum glint_basis {
    GLINT_BASIS_AUTO,  /* u, v, s, w as above */
    GLINT_BASIS_SPARSE /* x, y, r and 1 - r, [Bodonyi25]: the place on the
                          vertex plane over 2^(30 + box_exponent) mm, a
                          radius that holds all boxes of the system
                        */
};

struct glint_model_header {
    uint32_t magic, version;
    uint32_t bytes;  /* of the whole file */
    uint32_t crc32;  /* of all after this word: polynomial 0xedb88320,
                        reflected, begun and ended with all ones */
    uint32_t basis;  /* enum glint_basis */
    uint32_t key[2]; /* of lens table and options, low word first */
    char name[64];   /* of the lens, terminated */
    struct glint_real focal_mm, back_focal_mm, entrance_radius_mm,
        stop_radius_mm, f_number, film_width_mm, film_height_mm;
    struct glint_real field_mm; /* light farther from the sensor's centre was
                                   not asked to be right */
    struct glint_real front_mm; /* semi-diameter of the first surface */
    int32_t wave_lo_q24, wave_hi_q24; /* the band, 1 / wavelength^2, um^-2 */
    int32_t sine_hi_q30;              /* of the largest angle looked at; of
                                         lights beyond nothing is drawn */
    /* Flux of the direct image at angle 0 for irradiance 1 through a circular
     * stop, mm^2: coefficients of powers of w over the band. */
    struct glint_real direct_flux[6];
    uint32_t n_surfaces;
    uint32_t n_ghosts, ghost_at; /* struct glint_model_ghost */
    uint32_t n_parts; /* so many of the ghosts, the last ones, are further parts
                         of the pupil of some of those before them */
    uint32_t n_systems, system_at; /* struct glint_model_system */
};

/* Systems of one ghost follow each other by rising angle or band, without
 * overlap; so do the ghosts' lists. No systems: the ghost is never seen. */
struct glint_model_ghost {
    uint32_t i, j; /* reflecting surfaces, i < j */
    uint32_t first_system, n_systems;
};

/* Polynomials for a range of angles and a band of wavelengths.
 *
 * n_knots = 0: the coefficients are good for the whole range, and s and w are
 * among the variables. n_knots >= 2: there is a set of coefficients at each of
 * so many angles, rising, and between two neighbours they are interpolated
 * linearly in the sine; the variables are those of the basis alone. */
struct glint_model_system {
    int32_t sine_lo_q30, sine_hi_q30; /* of the light's angle, 0 .. 2^30 */
    int32_t wave_lo_q24, wave_hi_q24; /* the same twice: one wavelength */
    uint32_t n_knots, knot_at;        /* int32 sines _q30 [n_knots] */
    /* The box, mm: middle, half width, half height, int32 * 2^box_exponent.
     * Without knots each is a polynomial of GLINT_BOX_TERMS terms, s^0, s^1 ..
     * and then w and s w, of which those are here whose bits are set in
     * box_terms: [3][bits set]. With knots [n_knots][3], and box_terms 0. */
    uint32_t box_at;
    int32_t box_exponent;
    uint32_t output_at; /* struct glint_model_output, kinds rising */
    uint8_t n_outputs, box_terms;
    uint8_t hollow; /* k: what is seen within |v| < k / (k + 1), its rim, is
                       other parts' and not this one's; at most
                       GLINT_MAX_HOLLOW, 0 with knots */
    uint8_t zero;
};

enum {
    GLINT_MAX_CELLS = 1024, /* of a ray grid, per side */
    GLINT_BOX_POWERS = 6,   /* of s alone, the 0th among them */
    GLINT_BOX_TERMS = GLINT_BOX_POWERS + 2,
    GLINT_MAX_POWER = 9,
    GLINT_MAX_HOLLOW = 15,
    GLINT_RAYS = 8,         /* that are computed at once */
    GLINT_TABLE_WIDTH = 16, /* of a row of powers of u: whole vectors */
    GLINT_MAX_MODEL_TERMS = 120
};

enum glint_channel {
    GLINT_OUT_SENSOR_X, /* mm, in the light's frame; odd kinds are odd in v */
    GLINT_OUT_SENSOR_Y,
    GLINT_OUT_STOP_X, /* stop radii */
    GLINT_OUT_STOP_Y,
    GLINT_OUT_ENERGY,
    GLINT_OUT_RADIUS,   /* the largest relative radius [Bodonyi25] */
    GLINT_OUT_BARREL_0, /* (1 + r^2) / 2, r = relative radius at a barrel that
                           cuts: above 1 it does */
    GLINT_OUT_BARREL_1,
    GLINT_OUT_BARREL_2,
    GLINT_OUT_BARREL_3,
    GLINT_OUT_KINDS
};

/* The first five kinds are in every system; sensor x and y have the same
 * exponent, and so have stop x and y. */
struct glint_model_output {
    uint8_t kind, n_terms;
    uint8_t n_narrow; /* so many of the coefficients, the last ones, are int16
                         instead, padded to whole words, */
    uint8_t narrow_shift; /* and count 2^so many times as much, at most 20; with
                             knots 0 */
    /* Of the energy, where not 0: its polynomial P counts as at most
     * 2^(29 - head), head at most 28, far above what it is where light gets
     * through; the energy is P squared so many times, roots at most 2, 0 for P
     * below 0. */
    uint8_t head, roots;
    int16_t exponent; /* a polynomial's value is integer * 2^exponent */
    uint32_t term_at; /* uint16 [n_terms], padded to whole words: powers of u,
                         v, s, w (or x, y, r, 1 - r), four bits each, the first
                         lowest */
    uint32_t coef_at; /* int32 [n_terms], with knots [n_knots][n_terms] */
    uint32_t bound;   /* proven: no intermediate is larger; < 2^30 */
    uint32_t rounding_q8; /* proven: integers stray from the polynomial by no
                             more than so many steps */
    /* Measured against exact rays through the run-time arithmetic, q20: pixels
     * of a film 1920 wide, stop radii, share of the energy (of at least a
     * fiftieth of the most in the system), relative radius. Each is
     * glint_model_error_q20() of these. */
    uint16_t rms, p50, p99, max;
};

/* The upper five bits of E are how far up the lower eleven are shifted, which
 * are above 1023 then: a larger E is a larger error. */
static inline uint64_t glint_model_error_q20(uint16_t e)
{
    return (uint64_t)(e & 2047) << (e >> 11);
}

/* ------------------------------------------------------------------ opening */

struct glint_lens {
    const struct glint_model_header *header;
    const struct glint_model_ghost *ghost;
    const struct glint_model_system *system;
};

/* Checks DATA[BYTES], aligned to 4, all of it, and points LENS into it; it is
 * kept and must not change. GLINT_E_LENS: *REASON (a constant text) says what
 * is wrong. Takes time in proportion to BYTES. */
enum glint_status glint_lens_open(struct glint_lens *lens, const void *data,
                                  size_t bytes, const char **reason);

/* CRC of BYTES bytes as in the header. */
uint32_t glint_model_crc32(const void *data, size_t bytes);

/* ----------------------------------------------------------------- transfer */

/* The polynomials of one bundle: one ghost, light and wavelength. */
struct glint_transfer {
    const struct glint_model_system *system;
    uint32_t outputs; /* bit KIND is set where there is that output */
    int32_t exponent[GLINT_OUT_KINDS]; /* of what comes out */
    uint8_t head, roots;               /* of the energy */
    uint8_t energy_up; /* a vertex's energy counts 2^so many times, at most 29:
                          0 after init, for the caller to set */
    int32_t box[3];    /* middle, half width, half height at this angle */
    int32_t box_exponent;
    uint8_t hollow;
    enum glint_basis basis;
    union {
        /* of u^a v^b: [b][a] */
        int32_t table[GLINT_OUT_KINDS][GLINT_MAX_POWER + 1][GLINT_TABLE_WIDTH];
        struct {
            int32_t n_terms;
            uint16_t power[GLINT_MAX_MODEL_TERMS];
            int32_t coef[GLINT_MAX_MODEL_TERMS];
        } sparse[GLINT_OUT_KINDS];
    } of;
    uint8_t degree_u[GLINT_OUT_KINDS], degree_v[GLINT_OUT_KINDS];
    unsigned sets; /* instruction sets for rows, GLINT_SET_: 0 after init, for
                      the caller to set; changes no result */
    /* Scratch: polynomials in u, of one row of rays; places along a row. */
    int32_t of_u[GLINT_OUT_KINDS][GLINT_TABLE_WIDTH];
    int32_t n_nodes, node_q30[GLINT_MAX_CELLS + GLINT_RAYS];
};

/* Puts angle and wavelength into the polynomials of GHOST. SINE_Q30 0 .. 2^30,
 * WAVE_Q24 within the band (else held to it). Returns 0 where nothing of the
 * ghost gets through. */
int glint_transfer_init(struct glint_transfer *transfer,
                        const struct glint_lens *lens, int ghost,
                        int32_t sine_q30, int32_t wave_q24);

/* Where the ray at (U, V), each within +-2^30, goes: integers by kind, to be
 * scaled by 2^exponent; 0 for outputs that are not there. */
struct glint_outputs {
    int32_t at[GLINT_OUT_KINDS];
};
void glint_transfer_ray(const struct glint_transfer *transfer, int32_t u_q30,
                        int32_t v_q30, struct glint_outputs *out);

/* Where the rays at (U[i], V) go, by kind; kinds that are not there are left as
 * they are. IS_NEW: V is another one than in the last call. */
void glint_transfer_rays(struct glint_transfer *transfer, int32_t v_q30,
                         const int32_t u_q30[GLINT_RAYS], int is_new,
                         int32_t out[GLINT_OUT_KINDS][GLINT_RAYS]);

/* Where the bundle lies in the picture. */
struct glint_place {
    int32_t cos_q30, sin_q30; /* of the light's azimuth */
    struct glint_real pixels_per_mm;
    int32_t middle_x_q8, middle_y_q8; /* the sensor's centre, pixels */
};

/* V, _q30, at J of N steps from the middle of the box, or from the rim of a
 * hollow one, to 1. */
int32_t glint_transfer_v(const struct glint_transfer *transfer, int j, int n);

/* Fills the vertices of a grid of N_CELLS a side over the whole box, row by
 * row, [n_cells + 1][n_cells + 1], v rising, u fastest. The energy 65536 of a
 * vertex is 2^(exponent[ENERGY] + 29 - energy_up); more saturates. What does
 * not fit a vertex is lost. Of a hollow box N_CELLS is even, at least 4; the
 * row in the middle is lost, and those beside it are its rim: n_cells - 2 rows
 * of cells cover what there is. */
void glint_transfer_grid(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells,
                         struct glint_vertex *vertices);

/* Row J of it alone, 0 .. N_CELLS. */
void glint_transfer_row(struct glint_transfer *transfer,
                        const struct glint_place *place, int n_cells, int j,
                        struct glint_vertex *row);

/* Row J and, for little more, row N_CELLS - J, its mirror image. */
void glint_transfer_rows(struct glint_transfer *transfer,
                         const struct glint_place *place, int n_cells, int j,
                         struct glint_vertex *row,
                         struct glint_vertex *mirrored);

#ifdef __cplusplus
}
#endif

#endif
