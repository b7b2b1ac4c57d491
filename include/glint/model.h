/* SPDX-License-Identifier: MIT
 *
 * glint/model.h - the file of a baked lens, used in place.
 *
 *     status = glint_lens_open(&lens, data, bytes, &reason);    once
 *
 * A model holds, for every ghost, sparse polynomials from the pupil to the
 * stop, the sensor, the barrels and the energy. It is one block of 32-bit words
 * that is used in place, in ROM or a mapped file: nothing is copied or
 * allocated. After glint_lens_open() has accepted a file, drawing cannot fail.
 * But the cost of a frame is not bounded by the size of the file: thousands of
 * ghosts that fold cost minutes. For untrusted models, limit memory by the
 * capacities of glint/flare.h and interrupt frames that take too long, or draw
 * through glint/engine.h, which limits both.
 *
 * Variables of a polynomial, each -1 .. 1:
 *   u, v   position in the ghost's pupil box, a rectangle of the vertex plane
 *          of the first surface: u in the plane of the light, v across;
 *          everything is symmetric in v
 *   s      sine of the light's angle, scaled to the range of the system
 *   w      1 / wavelength^2, scaled to the band of the system
 *
 * A system is the polynomials for one range of angles and wavelengths. The
 * method follows [Bodonyi25], in coordinates in which ghosts vary slowly.
 *
 * The ghosts of a lens that is not symmetric about its axis also depend on the
 * azimuth of the light. Its model uses the lens's own frame: u lies along x, v
 * along y, s is the x component of the light's direction and p, another
 * variable, the y component. Nothing is symmetric in v. If the lens has a plane
 * of symmetry, the model covers only lights on one side of it; a light on the
 * other side is mirrored, and so are its ghosts.
 *
 * The file: little-endian 32-bit words; offsets ("_at") are bytes from the
 * start of the file, multiples of 4. Header first, then in any order what it
 * points to, then what glint_bake_add_note() appends, struct glint_model_note.
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
    /* Variables u, v, s, p, w in the frame of the lens. May be combined with
     * GLINT_MIRRORS_X: then the model covers only lights with x of 0 or more,
     * and all others are mirrored. GLINT_MIRRORS_Y is the same for y. */
    GLINT_BASIS_LENS = 4
};
enum { GLINT_MIRRORS_X = 1, GLINT_MIRRORS_Y = 2 };

/* Returns whether BASIS is GLINT_BASIS_LENS, with or without GLINT_MIRRORS_
 * bits. */
static inline int glint_basis_is_lens(uint32_t basis)
{
    return basis >> 2 == 1;
}

struct glint_model_header {
    uint32_t magic, version;
    uint32_t bytes;  /* bytes of the whole file */
    uint32_t crc32;  /* CRC-32 of all bytes after this word: polynomial
                        0xedb88320, reflected; initial value and final XOR are
                        all ones */
    uint32_t basis;  /* enum glint_basis, possibly with GLINT_MIRRORS_ bits */
    uint32_t key[2]; /* key of lens table and options, low word first */
    char name[64];   /* name of the lens, terminated */
    struct glint_real focal_mm, back_focal_mm, entrance_radius_mm,
        stop_radius_mm, f_number, film_width_mm, film_height_mm;
    /* Radius around the middle of the sensor, mm, within which the model is
     * accurate. */
    struct glint_real field_mm;
    struct glint_real front_mm; /* semi-diameter of the front surface */
    /* Range of 1 / wavelength^2 that the model covers, um^-2. */
    int32_t wave_lo_q24, wave_hi_q24;
    /* Sine of the max angle of lights that the model covers; lights farther off
     * the axis are not drawn. */
    int32_t sine_hi_q30;
    /* Flux of the direct image at angle 0 through a circular stop, if the
     * irradiance is 1, mm^2; of lenses faster than f/10 through eight straight
     * blades, divided by their fraction of the circle's area. The flux is a
     * polynomial in w over the wavelength band; these are the coefficients. */
    struct glint_real direct_flux[GLINT_FLUX_TERMS];
    /* Correction for smaller stops: at R times the radius of the stop, the flux
     * is R^2 (direct_flux + c (stopped_flux[0] + c stopped_flux[1])) with c = 1
     * - R^2. */
    struct glint_real stopped_flux[2][GLINT_FLUX_TERMS];
    uint32_t n_surfaces;
    uint32_t n_ghosts, ghost_at; /* array of struct glint_model_ghost */
    /* The last n_parts ghosts are additional pupil regions (parts), each of one
     * of the ghosts before them. */
    uint32_t n_parts;
    uint32_t n_systems, system_at; /* array of struct glint_model_system */
};

/* A ghost and its systems. The systems of one ghost are sorted by rising angle
 * or wavelength band, without overlap. The systems of successive ghosts follow
 * each other, too. A ghost without systems is invisible. */
struct glint_model_ghost {
    uint32_t i, j; /* indices of the two reflecting surfaces, i < j */
    uint32_t first_system, n_systems;
};

/* Polynomials for a range of angles and a band of wavelengths. */
struct glint_model_system {
    /* Range of the sine of the angle of lights, 0 .. 2^30; in the lens basis,
     * range of the x component of their direction, -2^30 .. 2^30. */
    int32_t sine_lo_q30, sine_hi_q30;
    /* Range of 1 / wavelength^2. If both ends are equal, the system is for one
     * wavelength. */
    int32_t wave_lo_q24, wave_hi_q24;
    uint32_t zero_word; /* must be 0 */
    uint32_t across_at; /* int32 _q30 [2]: range of the y component of the
                           direction; in the lens basis only */
    /* The box, mm: middle, half width and half height, int32 * 2^box_exponent.
     * Each is a polynomial with up to GLINT_BOX_TERMS terms: s^0, s^1 .. s^5,
     * w, s w. Only terms whose bits are set in box_terms are stored: [3][bits
     * set]. In the lens basis the terms are 1, s, s^2, p, s p, p^2, w, s w. A
     * fourth polynomial, the middle along y, then follows: [4][bits set]. */
    uint32_t box_at;
    int32_t box_exponent;
    uint32_t output_at; /* array of struct glint_model_output, by rising kind */
    uint8_t n_outputs, box_terms;
    /* If annulus is k above 0, the system does not cover |v| < k / (k + 1);
     * other pupil regions of the ghost cover this range. At most
     * GLINT_MAX_ANNULUS; 0 in the lens basis. */
    uint8_t annulus;
    uint8_t zero;
};

enum {
    GLINT_BOX_POWERS = 6, /* number of powers of s alone, including s^0 */
    GLINT_BOX_TERMS = GLINT_BOX_POWERS + 2,
    GLINT_MAX_POWER = 9,
    GLINT_MAX_ANNULUS = 15,
    GLINT_RAYS = 8, /* number of rays that are traced at a time */
    /* Number of entries in a row of powers of u: a multiple of the width of
     * SIMD vectors. */
    GLINT_TABLE_WIDTH = 16,
    GLINT_MAX_MODEL_TERMS = 120,
    GLINT_LENS_SIDES = 4, /* number of polynomials of a box in the lens basis */
    /* Limits of exponents in the lens basis: those of s and p are below
     * GLINT_LENS_POWERS, those of w below GLINT_LENS_WAVE_POWERS. */
    GLINT_LENS_POWERS = 6,
    GLINT_LENS_WAVE_POWERS = 7
};

enum glint_channel {
    /* Position on the sensor, mm, in the frame of the light. SENSOR_Y and
     * STOP_Y are odd in v and all other outputs are even, except in the lens
     * basis. */
    GLINT_OUT_SENSOR_X,
    GLINT_OUT_SENSOR_Y,
    GLINT_OUT_STOP_X, /* position in the stop, stop radii */
    GLINT_OUT_STOP_Y,
    GLINT_OUT_ENERGY,
    /* Max of (height of the ray) / (semi-diameter) over all surfaces that the
     * ray crosses [Bodonyi25]. */
    GLINT_OUT_RADIUS,
    /* (1 + r^2) / 2, where r = (height of the ray) / (semi-diameter) at a
     * barrel that cuts rays: the ray is cut if the value is above 1. */
    GLINT_OUT_BARREL_0,
    GLINT_OUT_BARREL_1,
    GLINT_OUT_BARREL_2,
    GLINT_OUT_BARREL_3,
    GLINT_OUT_KINDS
};

/* An output of a system. Every system has the first five kinds. Sensor x and
 * sensor y have the same exponent; stop x and stop y have the same exponent. */
struct glint_model_output {
    uint8_t kind, n_terms;
    /* Number of coefficients, at the end of the list, that are stored as int16
     * instead of int32 and padded to whole words. */
    uint8_t n_narrow;
    uint8_t narrow_shift; /* int16 coefficients are multiplied by
                             2^narrow_shift; at most 20 */
    /* For the energy only; both are 0 for other kinds. If head is not 0, the
     * polynomial P is clamped to 2^(29 - head), which is far above its values
     * where light passes; head is at most 28. The energy is P after squaring it
     * ROOTS times (at most 2), or 0 if P is below 0. */
    uint8_t head, roots;
    int16_t exponent; /* value of the polynomial = integer * 2^exponent */
    uint32_t term_at; /* uint16 [n_terms], padded to whole words: exponents of
                         u, v, s, w, four bits each, u in the lowest; in the
                         lens basis the upper eight bits hold the exponents of
                         s, p and w as s + 6 p + 36 w */
    uint32_t coef_at; /* int32 [n_terms]: coefficients */
    uint32_t bound;   /* proven bound of the magnitude of all intermediate
                         results; < 2^30 */
    uint32_t rounding_q8; /* proven bound of the rounding error of the
                             polynomial, in units of the integer */
    /* Measured errors of the run-time arithmetic against exact rays: RMS, 50th
     * and 99th percentile, max. They are coded for glint_model_error_q20().
     * Units: pixels (of a picture 1920 pixels wide), stop radii, fraction of
     * the energy (for energies of at least a fiftieth of the system's max), or
     * relative radius. */
    uint16_t rms, p50, p99, max;
};

/* Returns the error that the code E stands for: the lower eleven bits of E,
 * shifted left by the upper five bits. If the shift is not 0, the lower bits
 * exceed 1023. So a larger E is always a larger error. */
static inline uint64_t glint_model_error_q20(uint16_t e)
{
    return (uint64_t)(e & 2047) << (e >> 11);
}

/* The last bytes of a file that glint bake wrote. No value is used in drawing.
 * The magic number exceeds all values at this place in files without a note,
 * bounds below 2^30. */
#define GLINT_MODEL_NOTE_MAGIC UINT32_C(0x4f4e4c47) /* "GLNO" */
struct glint_model_note {
    char coating[204]; /* value of --coating, terminated */
    /* The light whose picture differs most from the picture by exact rays. */
    uint32_t n;        /* number of lights compared; 0: none */
    uint32_t psnr_q8;  /* dB; 999: all pictures are identical */
    uint32_t angle_q8; /* angle of the light off the axis, degrees */
    uint32_t magic;
};

struct glint_lens {
    const struct glint_model_header *header;
    const struct glint_model_ghost *ghost;
    const struct glint_model_system *system;
    /* The zoom lens of which this model is one position; NULL: a single
     * model. */
    const struct glint_zoom_lens *zoom;
};

/* Checks all of DATA[BYTES], aligned to 4, and points LENS into it; DATA must
 * outlive LENS and must not change. On GLINT_E_LENS, *REASON, a constant text,
 * states what is wrong. The time is proportional to BYTES. */
enum glint_status glint_lens_open(struct glint_lens *lens, const void *data,
                                  size_t bytes, const char **reason);

/* Returns the checksum of DATA[BYTES], by the same method as crc32 of the
 * header. */
uint32_t glint_model_crc32(const void *data, size_t bytes);

/* ---------------------------------------------------------------------- zoom
 *
 *     status = glint_zoom_open(zoom, data, bytes, &reason);     once
 *     glint_zoom_set(zoom, along_q30);                          when it moves
 *     ... &zoom->lens is an ordinary lens
 *
 * A zoom is a set of models of one lens at several positions. Between two
 * positions, angle and wavelength are substituted into the polynomials of both
 * models; the results are then interpolated linearly at each point of the
 * pupil. A frame costs 1.3 to 2.1 times as much, because interpolated
 * polynomials have more terms and there are more ghosts. A ghost may exist at
 * only one of the two positions. It is then extrapolated from that position and
 * the next position on the same side, if that is near enough; otherwise the
 * ghost fades. Ghosts change at different rates: positions between the first
 * and the last may have only some of the ghosts, and each ghost is interpolated
 * between the two nearest positions that have it.
 *
 * The file: a header, then for each position an ordinary model at a multiple of
 * 4 bytes. It is used in place. */

#define GLINT_ZOOM_MAGIC   UINT32_C(0x5a4e4c47) /* "GLNZ" */
#define GLINT_ZOOM_VERSION 2

enum { GLINT_MAX_ZOOM_MODELS = 129, GLINT_MAX_ZOOM_GHOSTS = 2048 };

struct glint_zoom_header {
    uint32_t magic, version;
    uint32_t bytes, crc32; /* as in struct glint_model_header */
    uint32_t variant;      /* must be 0 */
    uint32_t key[2];       /* key of the table and options, low word first */
    char name[64];         /* name of the lens, terminated */
    uint32_t n_models, model_at; /* array of struct glint_zoom_model */
};

/* A zoom position with its model. Positions are 0 .. 2^30, sorted; the first is
 * 0, the last 2^30. */
struct glint_zoom_model {
    int32_t along_q30;
    uint32_t at, bytes; /* offset and size of the model in the file */
    /* Offset of a bit mask of the ghosts (without parts) that the model has,
     * uint32 [(ghosts + 31) / 32]; the first ghost is the lowest bit. 0: the
     * model has all ghosts, as the models of the first and the last position
     * do. */
    uint32_t has_at;
};

struct glint_transfer;
struct glint_zoom_lens {
    /* Function that does the work of glint_transfer_init() for a focal length
     * between two positions. It is a pointer so that only programs that zoom
     * link the function. */
    int (*transfer)(struct glint_transfer *transfer,
                    const struct glint_zoom_lens *zoom, int ghost,
                    int32_t sine_q30, int32_t wave_q24);
    struct glint_lens lens; /* the lens at the current position */
    int n_models;
    struct glint_lens model[GLINT_MAX_ZOOM_MODELS];
    int32_t along_q30[GLINT_MAX_ZOOM_MODELS];
    /* Bit masks of the ghosts that each model has, as has_at describes; NULL:
     * the model has all ghosts. */
    const uint32_t *has[GLINT_MAX_ZOOM_MODELS];
    int32_t now_q30; /* current position */
    /* Index of the last model whose position is at or below the current
     * position. */
    int below;
    /* For each ghost, the indices of the two nearest models that have it: the
     * one below and the one above the current position. */
    uint8_t side[2][GLINT_MAX_ZOOM_GHOSTS];
    /* Header and ghosts of LENS at the current position. */
    struct glint_model_header header;
    struct glint_model_ghost ghost[GLINT_MAX_ZOOM_GHOSTS];
    /* For each ghost or additional pupil region (part), whole: the ghost to
     * which it belongs; number: its number among the parts of that ghost;
     * place: its index in both models of that ghost, or -1 in a model that
     * lacks it. The additional parts of ghost G are PART_FROM[G] .. PART_FROM[G
     * + 1] - 1. */
    int16_t whole[GLINT_MAX_ZOOM_GHOSTS], number[GLINT_MAX_ZOOM_GHOSTS];
    int16_t place[2][GLINT_MAX_ZOOM_GHOSTS];
    int16_t part_from[GLINT_MAX_ZOOM_GHOSTS + 1];
};

/* Checks all of DATA[BYTES], which must outlive ZOOM and must not change, and
 * sets ZOOM to its first position. On GLINT_E_LENS, *REASON, a constant text,
 * states what is wrong. */
enum glint_status glint_zoom_open(struct glint_zoom_lens *zoom,
                                  const void *data, size_t bytes,
                                  const char **reason);

/* Makes ZOOM of N opened models at the rising positions ALONG_Q30[N], and sets
 * it to the first position. On GLINT_E_LENS, *REASON, a constant text, states
 * what is wrong. */
enum glint_status glint_zoom_join(struct glint_zoom_lens *zoom,
                                  const struct glint_lens *model,
                                  const int32_t *along_q30, int n,
                                  const char **reason);

/* Sets ZOOM to the position ALONG_Q30, clamped to 0 .. 2^30. Changes ZOOM->lens
 * in place; its numbers of ghosts and parts stay the same. */
void glint_zoom_set(struct glint_zoom_lens *zoom, int32_t along_q30);

#ifdef __cplusplus
}
#endif

#endif
