/* SPDX-License-Identifier: MIT
 *
 * Checks that each kind of damage to a model file is rejected.
 */
#include "support/model_builder.h"
#include "support/rng.h"
#include "support/test.h"

/* Opens the model DATA. Returns the error, or NULL if it is valid. */
static const char *find_model_error(const void *data, size_t bytes)
{
    struct glint_lens lens = {0};
    const char *reason = NULL;

    if (glint_lens_open(&lens, data, bytes, &reason) == GLINT_OK) {
        assert_ptr_equal(lens.header, data);
        assert_null(reason);
        return NULL;
    }
    assert_non_null(reason);
    /* glint_lens_open() leaves LENS unchanged on an error */
    assert_null(lens.header);
    return reason;
}

TEST(crc32_of_known_text)
{
    assert_true(glint_model_crc32("123456789", 9) == UINT32_C(0xcbf43926));
    assert_true(glint_model_crc32("", 0) == 0);
}

TEST(accepts_a_valid_model)
{
    struct model_image a = model_make_three_ghosts();
    struct glint_lens lens = model_open_image(&a);

    assert_int_equal(lens.header->n_ghosts, 3);
    assert_int_equal(lens.ghost[2].j, 3);
    assert_int_equal(lens.system[1].sine_lo_q30, 1 << 28);
}

/* ------------------------------------------------------------------- damage */

/* Checks truncated copies of a model. Each copy has exactly its size allocated,
 * so that an overread is detected. */
TEST(rejects_truncated_models)
{
    struct model_image m = model_make_three_ghosts();

    for (size_t bytes = 0; bytes < m.bytes; bytes++) {
        void *copy = malloc(bytes ? bytes : 1);
        const char *expected =
            bytes < 8 ? "this is not a glint model" : "the model is truncated";

        memcpy(copy, m.data, bytes);
        assert_string_equal(find_model_error(copy, bytes), expected);
        free(copy);
    }
    assert_string_equal(find_model_error(m.data, m.bytes + 4),
                        "the model file is longer than its header says");
}

static void check_every_flipped_bit(struct model_image m)
{
    for (size_t bit = 0; bit < 8 * (size_t)m.bytes; bit++) {
        m.data[bit / 8] ^= (unsigned char)(1 << bit % 8);
        assert_non_null(find_model_error(m.data, m.bytes));
        m.data[bit / 8] ^= (unsigned char)(1 << bit % 8);
    }
    assert_null(find_model_error(m.data, m.bytes));
}

TEST(rejects_flipped_bits)
{
    check_every_flipped_bit(model_make_three_ghosts());
}

TEST(rejects_files_that_are_not_models)
{
    struct model_image m = model_make_three_ghosts();
    uint32_t *word = (uint32_t *)(void *)m.data;
    char text[8192] = "";
    FILE *file = fopen("lenses/heliar-tronnier.lens", "rb");
    uint32_t *copy = malloc(sizeof text);
    size_t bytes;

    assert_non_null(file);
    bytes = fread(text, 1, sizeof text, file);
    fclose(file);
    memcpy(copy, text, bytes);
    assert_string_equal(find_model_error(copy, bytes),
                        "this is not a glint model");
    free(copy);
    memmove(m.data + 2, m.data, m.bytes);
    assert_string_equal(
        find_model_error(m.data + 2, m.bytes),
        "the model's address in memory is not a multiple of 4 bytes");
    memmove(m.data, m.data + 2, m.bytes);
    word[1] = GLINT_MODEL_VERSION + 1;
    assert_string_equal(find_model_error(m.data, m.bytes),
                        "the model was made by a newer glint");
    assert_string_equal(find_model_error(m.data, 8),
                        "the model was made by a newer glint");
    word[1] = GLINT_MODEL_VERSION - 1;
    assert_string_equal(find_model_error(m.data, m.bytes),
                        "the model was made by an older glint: bake it again");
    word[1] = 0;
    assert_string_equal(find_model_error(m.data, m.bytes),
                        "this is not a glint model, or its version is damaged");
}

/* ---------------------------------------------------------- validity rules */

enum table { HEADER, GHOST, SYSTEM, OUTPUT, TERM, COEF, BOX };

/* A change to a valid model: VALUE is written to BYTES bytes at AT in TABLE.
 * REASON is the expected error, or NULL if the change is valid. Outputs are
 * those of system 0; terms and coefficients are those of output 0. */
struct rule {
    enum table table;
    size_t at, bytes;
    int64_t value;
    const char *reason;
};

#define FIELD_(type, field) \
    offsetof(struct type, field), sizeof((struct type *)0)->field
#define HEADER_(field)    HEADER, FIELD_(glint_model_header, field)
#define GHOST_(k, field)  GHOST, k * 16 + FIELD_(glint_model_ghost, field)
#define SYSTEM_(k, field) SYSTEM, k * 40 + FIELD_(glint_model_system, field)
#define OUTPUT_(k, field) OUTPUT, k * 32 + FIELD_(glint_model_output, field)

static const char
    outside[] = "damaged model: a table lies outside the file",
    unnormal[] = "damaged model: a number of the header is not normalised",
    not_above[] = "damaged model: a length or the f-number is not above 0",
    no_band[] =
        "damaged model: the band of wavelengths is empty or not above 0",
    no_angle[] = "damaged model: the largest angle is out of range",
    bad_pair[] = "damaged model: a ghost's surfaces are out of range",
    no_systems[] = "damaged model: a ghost's systems are out of range",
    shared[] =
        "damaged model: two ghosts share a system, or systems are unsorted",
    overlap[] = "damaged model: a ghost's systems overlap or are unsorted",
    energy[] = "damaged model: an output's roots or head are out of range",
    annulus[] = "damaged model: a system's annulus is out of range",
    bad_angles[] = "damaged model: a system's angles are out of range",
    bad_band[] = "damaged model: a system's band is out of range",
    far_box[] = "damaged model: the terms of a box are too large",
    small_box[] = "damaged model: a box has a negative size",
    box_exponent[] = "damaged model: the exponent of a box is out of range",
    n_outputs[] = "damaged model: a system has too few outputs or too many",
    lacking[] =
        "damaged model: a system lacks an output, or outputs are unsorted",
    bad_kind[] =
        "damaged model: an output's kind is unknown, or outputs are unsorted",
    n_terms[] = "damaged model: an output has no terms or too many",
    exponent[] = "damaged model: the exponent of an output is out of range",
    xy_exponent[] =
        "damaged model: x and y of a position have different exponents",
    bound[] = "damaged model: the bound of an output is too large",
    power[] = "damaged model: a power of u or v is too high",
    parity[] = "damaged model: a power of v has the wrong parity",
    twice[] = "damaged model: an output has a term twice",
    coefs[] = "damaged model: the coefficients of an output are too large";

/* clang-format off */
static const struct rule auto_rules[] = {
    {HEADER_(basis), 2, "damaged model: the basis is unknown"},
    {HEADER_(basis), 1, "damaged model: the basis is unknown"},
    {HEADER_(name[0]), 0, "damaged model: its name is empty"},
    {HEADER_(name[0]), 0x1b, "damaged model: its name has a control character"},
    {HEADER_(name[0]), 0x7f, "damaged model: its name has a control character"},
    {HEADER_(name[0]), 0x9b, "damaged model: its name has a byte outside ASCII"},
    {HEADER_(focal_mm.mantissa), 0, "damaged model: the focal length is 0"},
    {HEADER_(focal_mm.mantissa), (1 << 30) - 1, unnormal},
    {HEADER_(focal_mm.mantissa), 1 - (1 << 30), unnormal},
    {HEADER_(focal_mm.mantissa), INT32_MIN, unnormal},
    {HEADER_(focal_mm.mantissa), -(1 << 30), NULL},
    {HEADER_(focal_mm.mantissa), INT32_MAX, NULL},
    {HEADER_(focal_mm.exponent), 201, unnormal},
    {HEADER_(focal_mm.exponent), -201, unnormal},
    {HEADER_(focal_mm.exponent), 200, NULL},
    {HEADER_(focal_mm.exponent), -200, NULL},
    {HEADER_(focal_mm.exponent), INT32_MIN, unnormal},
    {HEADER_(back_focal_mm.mantissa), 5, unnormal},
    {HEADER_(back_focal_mm.mantissa), 0, NULL},
    {HEADER_(entrance_radius_mm.mantissa), 0, not_above},
    {HEADER_(stop_radius_mm.mantissa), 0, not_above},
    {HEADER_(stop_radius_mm.mantissa), -(1 << 30), not_above},
    {HEADER_(stop_radius_mm.exponent), 201, unnormal},
    {HEADER_(f_number.mantissa), -(1 << 30), not_above},
    {HEADER_(film_width_mm.mantissa), 0, not_above},
    {HEADER_(film_height_mm.mantissa), 0, not_above},
    {HEADER_(field_mm.mantissa), 0, not_above},
    {HEADER_(front_mm.mantissa), 0, not_above},
    {HEADER_(wave_lo_q24), 0, no_band},
    {HEADER_(wave_lo_q24), MODEL_WAVE_HI_Q24, no_band},
    {HEADER_(wave_hi_q24), INT32_MIN, no_band},
    {HEADER_(sine_hi_q30), 0, no_angle},
    {HEADER_(sine_hi_q30), (1 << 30) + 1, no_angle},
    {HEADER_(direct_flux[5].mantissa), 1,
        "damaged model: the flux of the direct image is not normalised"},
    {HEADER_(n_surfaces), 3, bad_pair},
    {HEADER_(n_ghosts), 1 << 28, outside},
    {HEADER_(n_ghosts), UINT32_MAX, outside},
    {HEADER_(n_parts), 4, "damaged model: there are more additional pupil regions than ghosts"},
    {HEADER_(n_parts), 3, NULL},
    {HEADER_(ghost_at), 246, outside},
    {HEADER_(ghost_at), 240, outside},
    {HEADER_(ghost_at), UINT32_MAX - 3, outside},
    {HEADER_(n_systems), 5, outside},
    {HEADER_(n_systems), UINT32_MAX, outside},
    {HEADER_(n_systems), 3, no_systems},
    {HEADER_(n_systems), 1, no_systems},
    {HEADER_(system_at), 0, outside},
    {GHOST_(0, i), 1, bad_pair},
    {GHOST_(0, j), 4, bad_pair},
    {GHOST_(0, i), UINT32_MAX, bad_pair},
    {GHOST_(0, n_systems), 5, no_systems},
    {GHOST_(0, first_system), UINT32_MAX, no_systems},
    {GHOST_(2, n_systems), UINT32_MAX, no_systems},
    /* not used, as ghost 1 has no systems */
    {GHOST_(1, first_system), UINT32_MAX, NULL},
    {GHOST_(2, first_system), 1, shared},
    {GHOST_(0, n_systems), 1, NULL},
    {SYSTEM_(0, sine_lo_q30), -1, bad_angles},
    {SYSTEM_(0, sine_lo_q30), 1 << 28, bad_angles},
    {SYSTEM_(1, sine_hi_q30), (1 << 30) + 1, bad_angles},
    {SYSTEM_(1, sine_hi_q30), 1 << 30, NULL},
    {SYSTEM_(1, sine_lo_q30), (1 << 28) - 1, overlap},
    {SYSTEM_(1, sine_lo_q30), (1 << 28) + 1, NULL},
    {SYSTEM_(0, sine_hi_q30), (1 << 28) + 1, overlap},
    {SYSTEM_(0, wave_lo_q24), 0, bad_band},
    {SYSTEM_(0, wave_lo_q24), MODEL_WAVE_HI_Q24 + 1, bad_band},
    {SYSTEM_(0, wave_lo_q24), MODEL_WAVE_HI_Q24, NULL},
    {SYSTEM_(0, wave_hi_q24), MODEL_WAVE_LO_Q24, NULL},
    {SYSTEM_(2, wave_hi_q24), MODEL_WAVE_HI_Q24, overlap},
    {SYSTEM_(3, wave_lo_q24), MODEL_WAVE_LO_Q24, overlap},
    {SYSTEM_(0, zero_word), 2, annulus},
    {SYSTEM_(3, zero_word), UINT32_MAX, annulus},
    {SYSTEM_(0, annulus), 1, NULL},
    {SYSTEM_(0, annulus), 15, NULL},
    {SYSTEM_(3, annulus), 16, annulus},
    {SYSTEM_(0, annulus), 255, annulus},
    {SYSTEM_(0, box_at), 2, outside},
    {SYSTEM_(0, box_at), 0x7ffffffc, outside},
    {SYSTEM_(0, box_exponent), 41, box_exponent},
    {SYSTEM_(0, box_exponent), -81, box_exponent},
    {SYSTEM_(0, n_outputs), 4, n_outputs},
    {SYSTEM_(0, n_outputs), 11, n_outputs},
    {SYSTEM_(0, n_outputs), 255, n_outputs},
    {SYSTEM_(0, output_at), 0x7ffffffd, outside},
    {SYSTEM_(0, zero), 1, annulus},
    {SYSTEM_(0, box_terms), 3, small_box},
    {SYSTEM_(0, box_terms), 0, NULL},
    {BOX, 0, 4, INT32_MIN, far_box},
    {BOX, 0, 4, (1 << 30) - (1 << 19), far_box},
    {BOX, 0, 4, (1 << 30) - (1 << 19) - 1, NULL},
    {BOX, 3 * 4, 4, 0, small_box}, /* half width -s */
    /* The half width of the pupil box, 1 - s, is 0 at s = 1. */
    {BOX, 3 * 4, 4, 1 << 20, NULL},
    {BOX, 3 * 4, 4, (1 << 20) - 1, small_box},
    /* The half width of the pupil box, 4 - s + 3 w, is 0 at s = 1 and w =
     * -1. */
    {BOX, 5 * 4, 4, 3 << 20, NULL},
    {BOX, 5 * 4, 4, (3 << 20) + 1, small_box},
    {BOX, 5 * 4, 4, -(3 << 20) - 1, small_box},
    {BOX, 6 * 4, 4, -1, small_box},
    {OUTPUT_(0, kind), 1, lacking},
    {OUTPUT_(4, kind), 5, lacking},
    {OUTPUT_(5, kind), GLINT_OUT_KINDS, bad_kind},
    {OUTPUT_(5, kind), 255, bad_kind},
    {OUTPUT_(5, kind), GLINT_OUT_ENERGY, bad_kind},
    {OUTPUT_(5, kind), GLINT_OUT_RADIUS, NULL},
    {OUTPUT_(0, n_terms), 0, n_terms},
    {OUTPUT_(0, n_terms), GLINT_MAX_MODEL_TERMS + 1, n_terms},
    {OUTPUT_(0, n_terms), 255, n_terms},
    {OUTPUT_(0, term_at), 0x7ffffffc, outside},
    {OUTPUT_(0, coef_at), 0x7ffffffc, outside},
    {OUTPUT_(0, coef_at), 243, outside},
    {OUTPUT_(4, exponent), 41, exponent},
    {OUTPUT_(4, exponent), 40, NULL},
    {OUTPUT_(4, exponent), -80, NULL},
    {OUTPUT_(4, exponent), -81, exponent},
    {OUTPUT_(0, exponent), -27, xy_exponent},
    {OUTPUT_(3, exponent), -27, xy_exponent},
    {OUTPUT_(4, roots), 2, NULL},
    {OUTPUT_(4, roots), 3, energy},
    {OUTPUT_(4, head), 28, NULL},
    {OUTPUT_(4, head), 29, energy},
    {OUTPUT_(3, head), 1, energy},
    {OUTPUT_(5, roots), 1, energy},
    {OUTPUT_(0, bound), 1 << 30, bound},
    {OUTPUT_(0, bound), UINT32_MAX, bound},
    {OUTPUT_(0, rounding_q8), UINT32_MAX, NULL},
    {TERM, 0, 2, MODEL_POWER(10, 0, 0, 0), power},
    {TERM, 0, 2, MODEL_POWER(0, 10, 0, 0), power},
    {TERM, 0, 2, MODEL_POWER(9, 8, 15, 15), NULL},
    {TERM, 0, 2, MODEL_POWER(1, 1, 0, 0), parity},
    {TERM, 0, 2, MODEL_POWER(1, 0, 0, 0), twice},
    {TERM, 0, 2, MODEL_POWER(0, 2, 1, 0), twice},
    {COEF, 0, 4, INT32_MIN, coefs},
    {COEF, 0, 4, (1 << 30) - (1 << 27) - (1 << 25), coefs},
    {COEF, 0, 4, (1 << 30) - (1 << 27) - (1 << 25) - 1, NULL},
    {COEF, 4, 4, -(1 << 30), coefs},
};

/* clang-format on */

static size_t compute_table_offset(const struct model_image *m, enum table t)
{
    const struct glint_model_header *h = model_header_of(m);
    const struct glint_model_system *s = (const void *)(m->data + h->system_at);
    const struct glint_model_output *o = (const void *)(m->data + s->output_at);
    const size_t at[] = {0,          h->ghost_at, h->system_at, s->output_at,
                         o->term_at, o->coef_at,  s->box_at};

    return at[t];
}

static void check_validity_rule(struct model_image m, const struct rule *r,
                                size_t number)
{
    const char *reason;

    memcpy(m.data + compute_table_offset(&m, r->table) + r->at, &r->value,
           r->bytes);
    model_seal_checksum(&m);
    reason = find_model_error(m.data, m.bytes);
    if (reason != r->reason &&
        (!reason || !r->reason || strcmp(reason, r->reason) != 0))
        fail_msg("rule %d: '%s', not '%s'", (int)number,
                 reason ? reason : "accepted",
                 r->reason ? r->reason : "accepted");
}

TEST(checks_every_rule)
{
    for (size_t k = 0; k < sizeof auto_rules / sizeof *auto_rules; k++)
        check_validity_rule(model_make_three_ghosts(), &auto_rules[k], k);
}

TEST(rejects_an_endless_name)
{
    struct model_image m = model_make_three_ghosts();

    memset(model_header_of(&m)->name, 'x', 64);
    model_seal_checksum(&m);
    assert_string_equal(find_model_error(m.data, m.bytes),
                        "damaged model: its name is not zero-terminated");
}

TEST(accepts_a_model_without_ghosts)
{
    struct model_image m = model_make_three_ghosts();

    model_header_of(&m)->n_ghosts = model_header_of(&m)->n_systems = 0;
    model_seal_checksum(&m);
    assert_null(find_model_error(m.data, m.bytes));
}

/* Checks that a model whose systems use too many tables in common is rejected,
 * as checking it would take quadratic time. */
TEST(rejects_too_many_shared_tables)
{
    enum { N = 1000 };
    static struct glint_model_system s[N];
    const struct glint_model_ghost ghost = {0, 1, 0, N};
    struct model_image m;

    model_begin_header(&m, GLINT_BASIS_AUTO, "shared");
    for (int k = 0; k < N; k++) {
        s[k] = k ? s[0]
                 : model_make_auto_system(&m, 0, 0, MODEL_WAVE_LO_Q24,
                                          MODEL_WAVE_HI_Q24, 0);
        s[k].sine_lo_q30 = 1000 * k;
        s[k].sine_hi_q30 = 1000 * (k + 1);
    }
    model_append_ghosts(&m, &ghost, 1, s, N);
    assert_string_equal(find_model_error(m.data, m.bytes),
                        "damaged model: systems share too many tables");
}

/* ---------------------------------------------------- corpus of the fuzzer */

static void check_corpus_model(const char *path, struct model_image m)
{
    const int update = getenv("GLINT_GOLDEN_UPDATE") != NULL;
    FILE *file = fopen(path, update ? "wb" : "rb");
    static unsigned char kept[MODEL_ROOM];

    assert_non_null(file);
    if (update) {
        assert_int_equal(fwrite(m.data, 1, m.bytes, file), m.bytes);
    } else {
        assert_int_equal(fread(kept, 1, sizeof kept, file), m.bytes);
        assert_memory_equal(kept, m.data, m.bytes);
    }
    fclose(file);
}

/* GLINT_GOLDEN_UPDATE=1 rewrites the models in the corpus of the fuzzer. */
TEST(corpus_models_have_the_present_layout)
{
    check_corpus_model("tests/fuzz/corpus/model/auto",
                       model_make_three_ghosts());
}
