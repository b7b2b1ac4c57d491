/* SPDX-License-Identifier: MIT */
#include "formats/tones.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void glint_tone_curve_set(struct glint_tone_curve *transfer,
                          enum glint_tone_kind kind, double gamma)
{
    static const struct glint_tone_curve curves[] = {
        [GLINT_TONE_IS_LINEAR] = {.gamma = 1, .a = 1},
        [GLINT_TONE_IS_SRGB] = {.gamma = 2.4,
                                .a = 1 / 1.055,
                                .b = 0.055 / 1.055,
                                .c = 1 / 12.92,
                                .d = 0.04045},
        [GLINT_TONE_IS_BT709] = {.gamma = 1 / 0.45,
                                 .a = 1 / 1.099,
                                 .b = 0.099 / 1.099,
                                 .c = 1 / 4.5,
                                 .d = 0.081},
        [GLINT_TONE_IS_GAMMA] = {.gamma = 1, .a = 1},
        [GLINT_TONE_IS_PQ] = {.is_pq = true},
        [GLINT_TONE_IS_HLG] = {.is_hlg = true}};

    *transfer = curves[kind];
    if (kind == GLINT_TONE_IS_GAMMA)
        transfer->gamma = gamma;
}

bool glint_tone_curve_is_hdr(const struct glint_tone_curve *transfer)
{
    return transfer->is_pq || transfer->is_hlg;
}

/* light of code 1 by the PQ curve, and by the HLG curve */
#define PQ_PEAK  (10000 / 203.0)
#define HLG_PEAK 3.7741178

/* decode_pq() and encode_pq() convert between code and light of PQ [SMPTE ST
 * 2084], both 0 .. 1. */
static double decode_pq(double code)
{
    const double p = pow(code, 32 / 2523.0);

    return pow(fmax(p - 3424 / 4096.0, 0) / (2413 / 128.0 - 2392 / 128.0 * p),
               8192 / 1305.0);
}

static double encode_pq(double light)
{
    const double p = pow(light, 1305 / 8192.0);

    return pow((3424 / 4096.0 + 2413 / 128.0 * p) / (1 + 2392 / 128.0 * p),
               2523 / 32.0);
}

/* constants of HLG [ITU-R BT.2100], which decode_hlg() and encode_hlg() use to
 * convert between code and scene light */
static const double hlg_a = 0.17883277, hlg_b = 0.28466892, hlg_c = 0.55991073;

static double decode_hlg(double code)
{
    return code <= 0.5 ? code * code / 3
                       : (exp((code - hlg_c) / hlg_a) + hlg_b) / 12;
}

static double encode_hlg(double light)
{
    return light <= 1 / 12.0 ? sqrt(3 * light)
                             : hlg_a * log(12 * light - hlg_b) + hlg_c;
}

static double interpolate_tone_table(const struct glint_tone_curve *t,
                                     double code)
{
    const double at = code * (t->n_entries - 1);
    /* Codes of 1 and more, and NaN, use the last interval. */
    const int i = code < 1 ? (int)at : t->n_entries - 2;

    return (t->entry[i] + (at - i) * (t->entry[i + 1] - t->entry[i])) / 65535;
}

double glint_tone_curve_decode(const struct glint_tone_curve *transfer,
                               double code)
{
    const struct glint_tone_curve *const t = transfer;

    if (code < 0)
        return -glint_tone_curve_decode(t, -code);
    if (t->n_entries)
        return interpolate_tone_table(t, code);
    if (t->is_pq)
        return PQ_PEAK * decode_pq(fmin(code, 1));
    if (t->is_hlg)
        return HLG_PEAK * decode_hlg(code);
    if (code < t->d)
        return t->c * code + t->f;
    return (t->gamma == 1 ? t->a * code + t->b
                          : pow(t->a * code + t->b, t->gamma)) +
           t->e;
}

/* Returns the code that T's table decodes to LIGHT, extrapolated outside the
 * table; its values must not fall. */
static double find_code_of_light(const struct glint_tone_curve *t, double light)
{
    const double level = light * 65535;
    int low = 0, high = t->n_entries - 1;

    while (high - low > 1) {
        const int middle = (low + high) / 2;

        if (t->entry[middle] <= level)
            low = middle;
        else
            high = middle;
    }
    if (t->entry[high] <= t->entry[low])
        return (double)low / (t->n_entries - 1);
    return (low + (level - t->entry[low]) / (t->entry[high] - t->entry[low])) /
           (t->n_entries - 1);
}

double glint_tone_curve_encode(const struct glint_tone_curve *transfer,
                               double light)
{
    const struct glint_tone_curve *const t = transfer;
    double code;

    if (light < 0)
        return -glint_tone_curve_encode(t, -light);
    if (t->n_entries)
        return find_code_of_light(t, light);
    if (t->is_pq)
        return encode_pq(fmin(light / PQ_PEAK, 1));
    if (t->is_hlg)
        return encode_hlg(light / HLG_PEAK);
    if (t->d > 0 && light < t->c * t->d + t->f)
        return t->c > 0 ? fmax(0, (light - t->f) / t->c) : 0;
    code = fmax(0, light - t->e);
    code = t->gamma == 1 ? code : pow(code, 1 / t->gamma);
    return fmax(t->d, (code - t->b) / t->a);
}

/* --------------------------------------------------------------- primaries */

static bool invert_matrix(double to[3][3], const double m[3][3])
{
    double det = 0;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (j + 1) % 3, b = (j + 2) % 3;
            const int c = (i + 1) % 3, d = (i + 2) % 3;

            to[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    for (int j = 0; j < 3; j++)
        det += m[0][j] * to[j][0];
    if (!(fabs(det) > 1e-9))
        return false;
    for (int i = 0; i < 9; i++)
        to[i / 3][i % 3] /= det;
    return true;
}

static void multiply_matrices(double to[3][3], const double a[3][3],
                              const double b[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            to[i][j] =
                a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

/* Sets M to the matrix from R, G, B to X, Y, Z for the chromaticities XY of
 * red, green, blue and white; white has luminance 1. Returns false if no matrix
 * has these chromaticities. */
static bool set_rgb_to_xyz_matrix(double m[3][3], const double xy[4][2])
{
    double columns[3][3], back[3][3], white[3];

    for (int c = 0; c < 4; c++) {
        const double x = xy[c][0], y = xy[c][1];

        if (!(y > 1e-6) && c == 3)
            return false;
        for (int i = 0; i < 3; i++) {
            const double v = i == 0 ? x : i == 1 ? y : 1 - x - y;

            *(c < 3 ? &columns[i][c] : &white[i]) = c < 3 ? v : v / y;
        }
    }
    if (!invert_matrix(back, (const double(*)[3])columns))
        return false;
    for (int c = 0; c < 3; c++) {
        const double s = back[c][0] * white[0] + back[c][1] * white[1] +
                         back[c][2] * white[2];

        for (int i = 0; i < 3; i++)
            m[i][c] = columns[i][c] * s;
    }
    return true;
}

/* Sets the matrices of COLOURS. FILE and BT709 are the matrices from R, G, B to
 * X, Y, Z of the file's primaries and of BT.709, with the same white point.
 * Returns false if either has no inverse. */
static bool set_colour_matrices(struct glint_colours *colours,
                                const double file[3][3],
                                const double bt709[3][3])
{
    double back[3][3], to[3][3], from[3][3];
    bool is_same = true;

    if (!invert_matrix(back, bt709))
        return false;
    multiply_matrices(to, (const double(*)[3])back, file);
    if (!invert_matrix(from, (const double(*)[3])to))
        return false;
    for (int i = 0; i < 9; i++)
        is_same = is_same && fabs(to[i / 3][i % 3] - (i % 4 == 0)) < 2e-3;
    for (int i = 0; i < 9; i++) {
        const double one = i % 4 == 0;

        colours->to_bt709[i / 3][i % 3] = is_same ? one : to[i / 3][i % 3];
        colours->from_bt709[i / 3][i % 3] = is_same ? one : from[i / 3][i % 3];
    }
    colours->is_srgb = colours->is_srgb && is_same;
    return true;
}

bool glint_colours_set_primaries(struct glint_colours *colours,
                                 const double xy[4][2])
{
    static const double bt709_xy[4][2] = {
        {0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3127, 0.329}};
    double file[3][3], bt709[3][3], own[4][2];

    /* The file's white point replaces D65, so that white stays white. */
    memcpy(own, bt709_xy, sizeof own);
    memcpy(own[3], xy[3], sizeof own[3]);
    return set_rgb_to_xyz_matrix(file, xy) &&
           set_rgb_to_xyz_matrix(bt709, (const double(*)[2])own) &&
           set_colour_matrices(colours, (const double(*)[3])file,
                               (const double(*)[3])bt709);
}

void glint_colours_set_bt709(struct glint_colours *colours,
                             enum glint_tone_kind kind, double gamma,
                             const char *name)
{
    memset(colours, 0, sizeof *colours);
    for (int c = 0; c < 3; c++) {
        glint_tone_curve_set(&colours->transfer[c], kind, gamma);
        colours->to_bt709[c][c] = colours->from_bt709[c][c] = 1;
    }
    colours->is_srgb = kind == GLINT_TONE_IS_SRGB;
    snprintf(colours->name, sizeof colours->name, "%s", name);
}

/* --------------------------------------------------------------------- ICC */

struct profile {
    const uint8_t *data;
    size_t bytes;
};

static uint32_t read_big_endian_u32(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 |
           (uint32_t)at[2] << 8 | at[3];
}

static double read_s15f16(const uint8_t *at)
{
    return (int32_t)read_big_endian_u32(at) / 65536.0;
}

/* Returns the data of tag NAME of profile P and sets *BYTES to their length;
 * NULL if P has no such tag or it is shorter than LEAST bytes. */
static const uint8_t *find_icc_tag(const struct profile *p, const char *name,
                                   size_t least, size_t *bytes)
{
    const uint32_t n = p->bytes >= 132 ? read_big_endian_u32(p->data + 128) : 0;

    for (uint32_t i = 0; i < n && 144 + (size_t)i * 12 <= p->bytes; i++) {
        const uint8_t *const entry = p->data + 132 + (size_t)i * 12;
        const size_t at = read_big_endian_u32(entry + 4);

        *bytes = read_big_endian_u32(entry + 8);
        if (memcmp(entry, name, 4) == 0)
            return at <= p->bytes && *bytes <= p->bytes - at && *bytes >= least
                       ? p->data + at
                       : NULL;
    }
    return NULL;
}

static bool read_curve_table(struct glint_tone_curve *t, const uint8_t *at,
                             size_t n)
{
    const int n_entries = n < GLINT_TONE_ENTRIES ? (int)n : GLINT_TONE_ENTRIES;

    t->n_entries = n_entries;
    for (int i = 0; i < n_entries; i++) {
        const size_t from =
            n == (size_t)n_entries
                ? (size_t)i
                : (size_t)llrint((double)i * (double)(n - 1) / (n_entries - 1));

        t->entry[i] = (uint16_t)(at[2 * from] << 8 | at[2 * from + 1]);
        if (i > 0 && t->entry[i] < t->entry[i - 1])
            return false;
    }
    return t->entry[n_entries - 1] > t->entry[0];
}

static bool read_curve_formula(struct glint_tone_curve *t, const uint8_t *at,
                               size_t bytes)
{
    static const uint8_t n_values[] = {1, 3, 4, 5, 7};
    const int kind = at[8] << 8 | at[9];
    double v[7] = {0};

    if (kind > 4 || bytes < 12 + 4 * (size_t)n_values[kind])
        return false;
    for (int i = 0; i < n_values[kind]; i++)
        v[i] = read_s15f16(at + 12 + 4 * i);
    *t = (struct glint_tone_curve){.gamma = v[0], .a = kind ? v[1] : 1};
    t->b = v[2];
    if (kind == 1 || kind == 2) {
        t->d = v[1] > 0 ? -v[2] / v[1] : 0;
        t->e = t->f = kind == 2 ? v[3] : 0;
    } else {
        t->c = v[3];
        t->d = v[4];
        t->e = v[5];
        t->f = v[6];
    }
    return t->gamma > 0.1 && t->gamma < 10 && t->a > 0;
}

static bool read_tone_curve(struct glint_tone_curve *t, const struct profile *p,
                            const char *name)
{
    size_t bytes;
    const uint8_t *const at = find_icc_tag(p, name, 12, &bytes);
    uint32_t n;

    memset(t, 0, sizeof *t);
    t->gamma = t->a = 1;
    if (at && memcmp(at, "para", 4) == 0)
        return read_curve_formula(t, at, bytes);
    if (!at || memcmp(at, "curv", 4) != 0)
        return false;
    n = read_big_endian_u32(at + 8);
    if (n > (bytes - 12) / 2)
        return false;
    if (n == 1)
        t->gamma = (at[12] << 8 | at[13]) / 256.0;
    return n <= 1 ? t->gamma > 0.1 : read_curve_table(t, at + 12, n);
}

/* Returns whether curve T is within a quarter of an 8-bit code of the sRGB
 * curve. */
static bool is_srgb_curve(const struct glint_tone_curve *t)
{
    struct glint_tone_curve srgb;

    glint_tone_curve_set(&srgb, GLINT_TONE_IS_SRGB, 0);
    for (int i = 0; i < 256; i++) {
        const double light = glint_tone_curve_decode(t, i / 255.0);

        if (!(fabs(glint_tone_curve_encode(&srgb, light) * 255 - i) < 0.25))
            return false;
    }
    return true;
}

static bool read_colour_matrix(struct glint_colours *colours,
                               const struct profile *p)
{
    /* BT.709 primaries in X, Y, Z under D50, the white point of ICC profiles */
    static const double bt709[3][3] = {{0.43607, 0.38515, 0.14307},
                                       {0.22249, 0.71687, 0.06061},
                                       {0.01392, 0.09708, 0.71410}};
    static const char *const names[] = {"rXYZ", "gXYZ", "bXYZ"};
    double file[3][3];

    for (int c = 0; c < 3; c++) {
        size_t bytes;
        const uint8_t *const at = find_icc_tag(p, names[c], 20, &bytes);

        for (int i = 0; at && i < 3; i++)
            file[i][c] = read_s15f16(at + 8 + 4 * i);
        if (!at)
            return false;
    }
    return set_colour_matrices(colours, (const double(*)[3])file, bt709);
}

bool glint_icc_read_colours(struct glint_colours *colours,
                            const uint8_t *profile, size_t bytes)
{
    static const char *const names[] = {"rTRC", "gTRC", "bTRC"};
    const struct profile p = {profile, bytes};
    struct glint_colours made;
    bool is_grey;

    if (bytes < 132 || memcmp(profile + 36, "acsp", 4) != 0)
        return false;
    is_grey = memcmp(profile + 16, "GRAY", 4) == 0;
    if (!is_grey && memcmp(profile + 16, "RGB ", 4) != 0)
        return false;
    glint_colours_set_bt709(&made, GLINT_TONE_IS_SRGB, 0, "its ICC profile");
    for (int c = 0; c < 3; c++) {
        if (!read_tone_curve(&made.transfer[c], &p,
                             is_grey ? "kTRC" : names[c]))
            return false;
        made.is_srgb = made.is_srgb && is_srgb_curve(&made.transfer[c]);
    }
    if (!is_grey && !read_colour_matrix(&made, &p))
        return false;
    *colours = made;
    return true;
}
