/* SPDX-License-Identifier: MIT
 *
 * Checks a baked translucent medium once, so that drawing need not. */
#include "glint/scene/translucent.h"

#include "base/blob.h"
#include "base/compiler.h"
#include "base/q.h"

/* The program reads the file in place: this struct is the file's layout. */
STATIC_ASSERT(sizeof(struct glint_translucent_header) == 172);

/* checks that the members that all baked files share have the same offsets */
GLINT_BLOB_HEADER(struct glint_translucent_header, variant);

enum { CHANNELS = 3, MOST_SHIFT = 16, LEAST_GAIN = -200 };

static const char outside[] =
    "damaged translucent medium: a table lies outside the file";

static const char *const fault_text[GLINT_BLOB_FAULTS] =
    GLINT_BLOB_FAULT_TEXT("stone", "stones", "baked");

static int is_value_between(int64_t x, int64_t lo, int64_t hi)
{
    return x >= lo && x <= hi;
}

static const char *check_medium_header(const struct glint_translucent_header *h)
{
    if (h->variant > GLINT_TRANSLUCENT_ALBEDO)
        return "the translucent medium is of a model that this glint does not "
               "know";
    if (!is_value_between(h->side_log2, GLINT_TRANSLUCENT_LEAST_LOG2,
                          GLINT_TRANSLUCENT_MOST_LOG2) ||
        !is_value_between(h->kernel, 1, GLINT_TRANSLUCENT_MOST_KERNEL) ||
        h->kernel % 2 == 0)
        return "damaged translucent medium: its texel count or kernel size is "
               "out of range";
    if (!is_value_between(h->n_planes, 1,
                          h->variant == GLINT_TRANSLUCENT_ALBEDO
                              ? 1
                              : GLINT_TRANSLUCENT_MOST_PLANES) ||
        !is_value_between(h->rank, 1, GLINT_TRANSLUCENT_MOST_RANK))
        return "damaged translucent medium: it has too many kernels or terms "
               "per kernel";
    if (!is_value_between(h->texel_um, 1, 1000000) ||
        !is_value_between(h->index_q16, 1 << 16, 3 << 16))
        return "damaged translucent medium: its texel size or refractive index "
               "is out of range";
    if (h->code_bits != GLINT_TRANSLUCENT_CODE_BITS ||
        h->tap_bits != GLINT_TRANSLUCENT_TAP_BITS)
        return "damaged translucent medium: its codes have an unsupported "
               "number of bits";
    if (!is_value_between(h->mean_transmit_q15, 0, 1 << 15))
        return "damaged translucent medium: its transmittance is not 0 .. 1";
    for (int c = 0; c < CHANNELS; c++)
        if (h->gain[c].mantissa != 0 &&
            (h->gain[c].mantissa < 1 << 30 ||
             !is_value_between(h->gain[c].exponent, LEAST_GAIN, -31)))
            return "damaged translucent medium: its gain is not normalised, or "
                   "not 0 .. 1";
    return NULL;
}

/* Adds the magnitudes of N taps to SUM; returns whether each magnitude is below
 * LIMIT. */
static int add_magnitudes_of_taps(const int16_t *tap, uint32_t n, int32_t limit,
                                  uint32_t *sum)
{
    int fits = 1;

    for (uint32_t k = 0; k < n; k++) {
        const uint32_t size = (uint32_t)q_magnitude(tap[k]);

        fits &= size < (uint32_t)limit;
        *sum += size;
    }
    return fits;
}

/* Checks that the sums of the taps' magnitudes are so small that convolutions
 * of values within +-32767 do not overflow. */
static const char *check_tap_sums(const struct glint_translucent *t)
{
    const struct glint_translucent_header *h = t->header;
    const uint32_t n = h->n_planes * h->rank;
    const int32_t limit = 1 << (GLINT_TRANSLUCENT_TAP_BITS - 1);
    const int16_t *tap = t->tap;

    for (uint32_t c = 0; c < CHANNELS; c++) {
        uint32_t columns = 0;

        for (uint32_t i = 0; i < n; i++, tap += 2 * h->kernel) {
            const uint32_t shift = t->shift[c * n + i];
            uint32_t row = 0;

            if (!add_magnitudes_of_taps(tap, h->kernel, limit, &row) ||
                !add_magnitudes_of_taps(tap + h->kernel, h->kernel, limit,
                                        &columns))
                return "damaged translucent medium: a kernel coefficient has "
                       "too many bits";
            if (shift > MOST_SHIFT || row > UINT32_C(1) << shift ||
                row > GLINT_TRANSLUCENT_MOST_TAPS)
                return "damaged translucent medium: the row coefficients of a "
                       "kernel are too large";
        }
        if (columns > GLINT_TRANSLUCENT_MOST_TAPS)
            return "damaged translucent medium: the column coefficients of a "
                   "kernel are too large";
    }
    return NULL;
}

static uint32_t count_weight_codes(const struct glint_translucent_header *h)
{
    const uint32_t texels = 1U << 2 * h->side_log2;

    return CHANNELS * texels *
           (h->variant == GLINT_TRANSLUCENT_FACTORED    ? h->n_planes
            : h->variant == GLINT_TRANSLUCENT_CLUSTERED ? 2
                                                        : 1);
}

/* Returns the number of 4-byte words that N items of BYTES bytes each
 * occupy. */
static uint64_t count_words(uint64_t n, uint64_t bytes)
{
    return (n * bytes + 3) / 4;
}

static const char *locate_tables_in_file(struct glint_translucent *t,
                                         struct glint_blob *b)
{
    const struct glint_translucent_header *h = t->header;
    const uint32_t n = CHANNELS * h->n_planes * h->rank;
    const uint32_t texels = 1U << 2 * h->side_log2;

    t->code = glint_blob_find_section(b, h->code_at,
                                      count_words(count_weight_codes(h), 1), 4);
    t->tap = glint_blob_find_section(b, h->tap_at,
                                     count_words(2 * n * h->kernel, 2), 4);
    t->shift = glint_blob_find_section(b, h->shift_at, n, 4);
    t->transmit_q15 = glint_blob_find_section(
        b, h->transmit_at, count_words(GLINT_TRANSLUCENT_COSINES + 1, 2), 4);
    if (!t->code || !t->tap || !t->shift || !t->transmit_q15)
        return outside;
    if (h->variant != GLINT_TRANSLUCENT_CLUSTERED)
        return h->cluster_at ? "damaged translucent medium: only the clustered "
                               "model may have clusters"
                             : NULL;
    t->cluster = glint_blob_find_section(b, h->cluster_at, texels / 4, 4);
    return t->cluster ? NULL : outside;
}

static const char *check_medium_contents(struct glint_translucent *t,
                                         struct glint_blob *blob)
{
    const struct glint_translucent_header *h = t->header;
    const char *wrong = fault_text[glint_blob_check_name(blob)];

    if (!wrong)
        wrong = check_medium_header(h);
    if (!wrong)
        wrong = locate_tables_in_file(t, blob);
    if (!wrong)
        wrong = check_tap_sums(t);
    for (uint32_t i = 0; !wrong && i < count_weight_codes(h); i++)
        if (h->variant == GLINT_TRANSLUCENT_FACTORED && t->code[i] == 128)
            wrong = "damaged translucent medium: a signed code is -128";
    for (uint32_t i = 0; !wrong && t->cluster && i < 1U << 2 * h->side_log2;
         i++)
        if (t->cluster[i] >= h->n_planes)
            wrong = "damaged translucent medium: a texel refers to a cluster "
                    "that does not exist";
    for (int i = 0; !wrong && i <= GLINT_TRANSLUCENT_COSINES; i++)
        if (t->transmit_q15[i] > 1 << 15)
            wrong =
                "damaged translucent medium: its transmittance is not 0 .. 1";
    return wrong;
}

enum glint_status glint_translucent_open(struct glint_translucent *stone,
                                         const void *data, size_t bytes,
                                         const char **reason)
{
    static const struct glint_blob_kind kind = {
        GLINT_TRANSLUCENT_MAGIC, GLINT_TRANSLUCENT_VERSION,
        sizeof(struct glint_translucent_header)};
    struct glint_translucent t = {.header = data};
    struct glint_blob blob;
    const char *wrong = fault_text[glint_blob_open(&blob, &kind, data, bytes)];

    if (!wrong)
        wrong = check_medium_contents(&t, &blob);
    if (wrong) {
        *reason = wrong;
        return GLINT_E_FORMAT;
    }
    *stone = t;
    return GLINT_OK;
}
