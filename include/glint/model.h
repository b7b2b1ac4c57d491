/* SPDX-License-Identifier: MIT
 *
 * glint/model.h - a baked lens: its file, used where it lies.
 *
 *     status = glint_lens_open(&lens, data, bytes, &reason);    once
 *
 * A model holds, for every ghost, sparse polynomials from the pupil to the
 * stop, the sensor, the barrels and the energy. It is one block of 32-bit words
 * that is used where it lies, in ROM or a mapped file: nothing is copied,
 * nothing is allocated. After glint_lens_open() has accepted it, drawing cannot
 * fail. But the cost of a frame is not bounded by the size of the file:
 * thousands of ghosts that fold cost minutes. For untrusted models limit memory
 * by the capacities of glint/flare.h and time from outside, or draw through
 * glint/engine.h, which bounds both.
 *
 * Variables of a polynomial, each -1 .. 1:
 *   u, v   place in the ghost's box on the vertex plane of the first surface,
 *          u in the plane of the light, v across; everything is symmetric in v
 *   s      sine of the light's angle within the range of the system
 *   w      1 / wavelength^2 within the band of the system
 * s and w are the same for a whole bundle: init substitutes them, which leaves
 * polynomials in u and v. Method after [Bodonyi25], in coordinates in which
 * ghosts vary slowly.
 *
 * The ghosts of a lens that is not symmetric about its axis also depend on the
 * azimuth of the light. Its model uses the lens's own frame: u lies along x, v
 * along y, s is the x component of the light's direction and p, another
 * variable, the y component. Nothing is symmetric in v. If the lens has a plane
 * of symmetry, the model holds only lights on one side of it; for others light
 * and result are mirrored.
 *
 * The file: little-endian 32-bit words; offsets ("_at") are bytes from the
 * start of the file, multiples of 4. Header first, then in any order what it
 * points to.
 */
#ifndef GLINT_MODEL_H
#define GLINT_MODEL_H

#include <stddef.h>
#include <stdint.h>

#include "glint/real.h"
#include "glint/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define GLINT_MODEL_MAGIC   UINT32_C(0x544e4c47) /* "GLNT" */
#define GLINT_MODEL_VERSION 4
#define GLINT_FLUX_TERMS    6

enum glint_basis {
    GLINT_BASIS_AUTO, /* u, v, s, w: see above */
    /* u, v, s, p, w in the lens's own frame; plus GLINT_MIRRORS_X, where lights
     * have x of 0 or more and others are mirrored, and GLINT_MIRRORS_Y. */
    GLINT_BASIS_LENS = 4
};
enum { GLINT_MIRRORS_X = 1, GLINT_MIRRORS_Y = 2 };

/* Returns whether BASIS is GLINT_BASIS_LENS with any mirrors. */
static inline int glint_basis_is_lens(uint32_t basis)
{
    return basis >> 2 == 1;
}

struct glint_model_header {
    uint32_t magic, version;
    uint32_t bytes;  /* bytes of the whole file */
    uint32_t crc32;  /* checksum of all after this word: polynomial 0xedb88320,
                        reflected, begun and ended with all ones */
    uint32_t basis;  /* enum glint_basis */
    uint32_t key[2]; /* key of lens table and options, low word first */
    char name[64];   /* name of the lens, terminated */
    struct glint_real focal_mm, back_focal_mm, entrance_radius_mm,
        stop_radius_mm, f_number, film_width_mm, film_height_mm;
    struct glint_real field_mm; /* radius about the sensor's centre within which
                                   the model is accurate */
    struct glint_real front_mm; /* semi-diameter of the first surface */
    int32_t wave_lo_q24, wave_hi_q24; /* the band of 1 / wavelength^2, um^-2 */
    int32_t sine_hi_q30; /* sine of the largest angle of light in the model;
                            lights farther out are not drawn */
    /* Flux of the direct image at angle 0 for irradiance 1 through a circular
     * stop, mm^2: coefficients of powers of w over the band. */
    struct glint_real direct_flux[GLINT_FLUX_TERMS];
    /* If the stop's radius is R times that, the flux is R^2 (direct_flux + c
     * (stopped_flux[0] + c stopped_flux[1])) with c = 1 - R^2. */
    struct glint_real stopped_flux[2][GLINT_FLUX_TERMS];
    uint32_t n_surfaces;
    uint32_t n_ghosts, ghost_at; /* array of struct glint_model_ghost */
    uint32_t n_parts; /* the last n_parts ghosts are further parts of the pupil
                         of ghosts before them */
    uint32_t n_systems, system_at; /* array of struct glint_model_system */
};

/* Systems of one ghost follow each other by rising angle or band, without
 * overlap; the lists of the ghosts follow each other, too. A ghost without
 * systems is invisible. */
struct glint_model_ghost {
    uint32_t i, j; /* reflecting surfaces, i < j */
    uint32_t first_system, n_systems;
};

/* Polynomials for a range of angles and a band of wavelengths. */
struct glint_model_system {
    /* Range of the sine of the light's angle, 0 .. 2^30; in the lens basis of
     * the x component of its direction, -2^30 .. 2^30. */
    int32_t sine_lo_q30, sine_hi_q30;
    int32_t wave_lo_q24, wave_hi_q24; /* range of 1 / wavelength^2; with both
                                         equal, one wavelength */
    uint32_t zero_word;               /* 0 */
    uint32_t across_at; /* int32 [2], the range of the y component, _q30; in the
                           lens basis only */
    /* The box, mm: middle, half width, half height, int32 * 2^box_exponent.
     * Each is a polynomial with up to GLINT_BOX_TERMS terms: s^0, s^1 .. s^5,
     * w, s w. Those whose bits are set in box_terms are stored: [3][bits set].
     * In the lens basis terms are 1, s, s^2, p, s p, p^2, w, s w, and a fourth
     * side, the middle along y, follows: [4][bits set]. */
    uint32_t box_at;
    int32_t box_exponent;
    uint32_t output_at; /* array of struct glint_model_output, by rising kind */
    uint8_t n_outputs, box_terms;
    /* k: this part lacks |v| < k / (k + 1), which other parts of the pupil
     * cover; at most GLINT_MAX_ANNULUS, 0 in the lens basis. */
    uint8_t annulus;
    uint8_t zero;
};

enum {
    GLINT_BOX_POWERS = 6, /* number of powers of s alone, s^0 among them */
    GLINT_BOX_TERMS = GLINT_BOX_POWERS + 2,
    GLINT_MAX_POWER = 9,
    GLINT_MAX_ANNULUS = 15,
    GLINT_RAYS = 8, /* number of rays that are computed at once */
    /* Entries in a row of powers of u: a whole number of vectors. */
    GLINT_TABLE_WIDTH = 16,
    GLINT_MAX_MODEL_TERMS = 120,
    GLINT_LENS_SIDES = 4, /* number of sides of a box in the lens basis */
    /* In the lens basis powers of s and p are below the first, of w below the
     * second. */
    GLINT_LENS_POWERS = 6,
    GLINT_LENS_WAVE_POWERS = 7
};

enum glint_channel {
    GLINT_OUT_SENSOR_X, /* mm, in the light's frame; both y are odd in v, all
                           other kinds even, but in the lens basis */
    GLINT_OUT_SENSOR_Y,
    GLINT_OUT_STOP_X, /* stop radii */
    GLINT_OUT_STOP_Y,
    GLINT_OUT_ENERGY,
    GLINT_OUT_RADIUS,   /* largest height / semi-diameter of the ray over all
                           surfaces [Bodonyi25] */
    GLINT_OUT_BARREL_0, /* (1 + r^2) / 2, r = relative radius at a barrel that
                           cuts: above 1 the ray is cut */
    GLINT_OUT_BARREL_1,
    GLINT_OUT_BARREL_2,
    GLINT_OUT_BARREL_3,
    GLINT_OUT_KINDS
};

/* Every system has the first five kinds; sensor x and y have the same exponent,
 * and so have stop x and y. */
struct glint_model_output {
    uint8_t kind, n_terms;
    uint8_t n_narrow;     /* number of coefficients at the end that are int16
                             instead, padded to whole words */
    uint8_t narrow_shift; /* an int16 coefficient counts 2^narrow_shift times;
                             at most 20 */
    /* Both are 0 for all kinds but the energy. If head is not 0, the polynomial
     * P is clamped to 2^(29 - head), far above its values where light gets
     * through; head is 28 at most. The energy is P squared ROOTS times, 2 at
     * most, and 0 for P below 0. */
    uint8_t head, roots;
    int16_t exponent; /* value of the polynomial = integer * 2^exponent */
    uint32_t term_at; /* uint16 [n_terms], padded to whole words: powers of u,
                         v, s, w, four bits each, the first lowest; in the lens
                         basis those of s, p and w share the upper eight bits: s
                         + 6 p + 36 w */
    uint32_t coef_at; /* int32 [n_terms] */
    uint32_t bound;   /* proven: no intermediate is larger; < 2^30 */
    uint32_t rounding_q8; /* proven: integers differ from the polynomial by no
                             more than this, in units of the integer */
    /* Measured errors against exact rays, through the run-time arithmetic, as
     * arguments of glint_model_error_q20(): pixels of a film 1920 wide, stop
     * radii, fraction of the energy (of at least a fiftieth of the most in the
     * system), relative radius. */
    uint16_t rms, p50, p99, max;
};

/* Returns the error of the code E: its lower eleven bits, shifted up by its
 * upper five. If they are shifted the lower bits are above 1023, so that a
 * larger E is a larger error. */
static inline uint64_t glint_model_error_q20(uint16_t e)
{
    return (uint64_t)(e & 2047) << (e >> 11);
}

struct glint_lens {
    const struct glint_model_header *header;
    const struct glint_model_ghost *ghost;
    const struct glint_model_system *system;
    const struct glint_zoom_lens *zoom; /* the zoom that the lens is a position
                                           of; NULL: a single model */
};

/* Checks all of DATA[BYTES], aligned to 4, and points LENS into it; DATA is
 * kept and must not change. GLINT_E_LENS: *REASON, a constant text, states what
 * is wrong. Takes time in proportion to BYTES. */
enum glint_status glint_lens_open(struct glint_lens *lens, const void *data,
                                  size_t bytes, const char **reason);

/* Returns the checksum of BYTES bytes at DATA, as crc32 of the header. */
uint32_t glint_model_crc32(const void *data, size_t bytes);

/* ---------------------------------------------------------------------- zoom
 *
 *     status = glint_zoom_open(zoom, data, bytes, &reason);     once
 *     glint_zoom_set(zoom, along_q30);                          when it moves
 *     ... &zoom->lens is an ordinary lens
 *
 * A zoom is a set of models of one lens at several positions. Between two
 * positions a bundle's polynomials are interpolated linearly at the same place
 * of the pupil, after substituting angle and wavelength. Planning costs more,
 * and drawing too, as interpolated polynomials have more terms and there are
 * more ghosts: 1.3 to 2.1 times in total. A ghost that exists at only one of
 * the two positions is extrapolated from that one and its other neighbour, if
 * near enough, and otherwise fades. Ghosts change at different rates: positions
 * between the first and the last may have only some ghosts, and each ghost is
 * interpolated between the nearest two that have it.
 *
 * The file: a header, then for each position an ordinary model at a multiple of
 * 4 bytes; kept where it lies. */

#define GLINT_ZOOM_MAGIC   UINT32_C(0x5a4e4c47) /* "GLNZ" */
#define GLINT_ZOOM_VERSION 2

enum { GLINT_MAX_ZOOM_MODELS = 129, GLINT_MAX_ZOOM_GHOSTS = 2048 };

struct glint_zoom_header {
    uint32_t magic, version;
    uint32_t bytes, crc32; /* as in struct glint_model_header */
    uint32_t variant;      /* 0 */
    uint32_t key[2];       /* key of the table and options, low word first */
    char name[64];         /* name of the lens, terminated */
    uint32_t n_models, model_at; /* array of struct glint_zoom_model */
};

/* A position. They rise from 0 to 2^30. */
struct glint_zoom_model {
    int32_t along_q30;
    uint32_t at, bytes; /* place and size of the model in the file */
    uint32_t has_at;    /* bits of the ghosts that the model has, without parts,
                           the first one lowest, uint32 [(ghosts + 31) / 32]; 0:
                           all, as the first and the last position */
};

struct glint_transfer;
struct glint_zoom_lens {
    /* glint_transfer_init() between positions; linked only by programs that
     * zoom. */
    int (*transfer)(struct glint_transfer *transfer,
                    const struct glint_zoom_lens *zoom, int ghost,
                    int32_t sine_q30, int32_t wave_q24);
    struct glint_lens lens; /* the lens where the zoom is set */
    int n_models;
    struct glint_lens model[GLINT_MAX_ZOOM_MODELS];
    int32_t along_q30[GLINT_MAX_ZOOM_MODELS];
    const uint32_t *has[GLINT_MAX_ZOOM_MODELS]; /* as has_at; NULL: all */
    int32_t now_q30;                            /* where it is set */
    int below; /* the model there or before; the next is above */
    /* Of each ghost, the nearest two models that have it. */
    uint8_t side[2][GLINT_MAX_ZOOM_GHOSTS];
    /* Storage that LENS points to. */
    struct glint_model_header header;
    struct glint_model_ghost ghost[GLINT_MAX_ZOOM_GHOSTS];
    /* Of each ghost and part: the ghost that it is of, its number among that
     * one's parts, and its place in both models of its ghost, -1 where they
     * lack it. Further
     * parts of ghost G are PART_FROM[G] .. PART_FROM[G + 1] - 1. */
    int16_t whole[GLINT_MAX_ZOOM_GHOSTS], number[GLINT_MAX_ZOOM_GHOSTS];
    int16_t place[2][GLINT_MAX_ZOOM_GHOSTS];
    int16_t part_from[GLINT_MAX_ZOOM_GHOSTS + 1];
};

/* Checks all of DATA[BYTES], which is kept and must not change, and sets ZOOM
 * to its first position. GLINT_E_LENS: *REASON, a constant text, states what is
 * wrong. */
enum glint_status glint_zoom_open(struct glint_zoom_lens *zoom,
                                  const void *data, size_t bytes,
                                  const char **reason);

/* Does the same for N models that are open, at ALONG_Q30. */
enum glint_status glint_zoom_join(struct glint_zoom_lens *zoom,
                                  const struct glint_lens *model,
                                  const int32_t *along_q30, int n,
                                  const char **reason);

/* Sets ZOOM to ALONG_Q30, clamped to 0 .. 2^30. ZOOM->lens changes in place:
 * its numbers of ghosts and parts stay. */
void glint_zoom_set(struct glint_zoom_lens *zoom, int32_t along_q30);

#ifdef __cplusplus
}
#endif

#endif
