/* SPDX-License-Identifier: MIT
 *
 * Checks the container of baked files: hand-written bytes are accepted, and
 * each possible fault is rejected.
 */
#include "base/blob.h"
#include "support/test.h"

static struct glint_blob blob;

enum { HEADER = 100, BYTES = 124 };

static const struct glint_blob_kind kind = {UINT32_C(0x424f4c42), 3, HEADER};

/* A baked file with two additional words at the end of its header, followed by
 * 24 bytes of sections. */
struct file {
    uint32_t word[BYTES / 4];
};

static void make_baked_file(struct file *f)
{
    memset(f, 0, sizeof *f);
    f->word[0] = kind.magic;
    f->word[1] = kind.version;
    f->word[5] = 0x89abcdef;
    f->word[6] = 0x01234567;
    memcpy(&f->word[7], "Heliar", 6);
    for (int k = 0; k < 6; k++)
        f->word[HEADER / 4 + k] = (uint32_t)k;
    glint_blob_set_size_and_checksum(f, BYTES);
}

static enum glint_blob_fault open_baked_file(const struct file *f, size_t bytes)
{
    return glint_blob_open(&blob, &kind, f, bytes);
}

TEST(crc32_of_known_text)
{
    assert_true(glint_blob_compute_crc32("123456789", 9) ==
                UINT32_C(0xcbf43926));
    assert_true(glint_blob_compute_crc32("", 0) == 0);
}

TEST(fields_have_the_offsets_of_existing_files)
{
    struct file f;

    make_baked_file(&f);
    assert_int_equal(f.word[2], BYTES);
    assert_true(f.word[3] == glint_blob_compute_crc32(&f.word[4], BYTES - 16));
    assert_int_equal(glint_blob_open(&blob, &kind, &f, BYTES), GLINT_BLOB_OK);
    assert_true(blob.header->key[0] == 0x89abcdef);
    assert_true(blob.header->key[1] == 0x01234567);
    assert_string_equal(blob.header->name, "Heliar");
    assert_int_equal(glint_blob_check_name(&blob), GLINT_BLOB_OK);
}

TEST(reports_the_fault_of_a_header)
{
    static const struct {
        int word;
        uint32_t value;
        enum glint_blob_fault fault;
    } of[] = {{0, 0x544e4c47, GLINT_BLOB_FOREIGN},
              {1, 4, GLINT_BLOB_NEWER},
              {1, 0, GLINT_BLOB_NO_VERSION},
              {1, 2, GLINT_BLOB_OLDER},
              {2, BYTES + 4, GLINT_BLOB_TRUNCATED},
              {2, BYTES - 4, GLINT_BLOB_LONGER}};
    struct file f;

    for (size_t k = 0; k < sizeof of / sizeof *of; k++) {
        make_baked_file(&f);
        f.word[of[k].word] = of[k].value;
        assert_int_equal(open_baked_file(&f, BYTES), of[k].fault);
    }
    make_baked_file(&f);
    assert_int_equal(open_baked_file(&f, 7), GLINT_BLOB_FOREIGN);
    assert_int_equal(open_baked_file(&f, 8), GLINT_BLOB_TRUNCATED);
    assert_int_equal(open_baked_file(&f, HEADER - 1), GLINT_BLOB_TRUNCATED);
    assert_int_equal(glint_blob_open(&(struct glint_blob){0}, &kind,
                                     (const unsigned char *)&f + 1, BYTES - 4),
                     GLINT_BLOB_UNALIGNED);
}

/* Checks every single wrong bit from the checksum to the end of the file. */
TEST(detects_any_changed_bit)
{
    struct file f;

    for (int bit = 8 * 12; bit < 8 * BYTES; bit++) {
        make_baked_file(&f);
        ((unsigned char *)&f)[bit / 8] ^= (unsigned char)(1 << bit % 8);
        assert_int_equal(open_baked_file(&f, BYTES), GLINT_BLOB_DAMAGED);
    }
}

static enum glint_blob_fault check_blob_name(const char *name, size_t length)
{
    struct file f;

    make_baked_file(&f);
    memset(&f.word[7], 0, 64);
    memcpy(&f.word[7], name, length);
    glint_blob_set_size_and_checksum(&f, BYTES);
    assert_int_equal(glint_blob_open(&blob, &kind, &f, BYTES), GLINT_BLOB_OK);
    return glint_blob_check_name(&blob);
}

TEST(rejects_endless_and_unprintable_names)
{
    char longest[64];

    memset(longest, '~', sizeof longest);
    assert_int_equal(check_blob_name(longest, 63), GLINT_BLOB_OK);
    assert_int_equal(check_blob_name(longest, 64), GLINT_BLOB_NAME_ENDLESS);
    assert_int_equal(check_blob_name("", 0), GLINT_BLOB_NAME_EMPTY);
    assert_int_equal(check_blob_name("a\033[2J", 5), GLINT_BLOB_NAME_CONTROL);
    assert_int_equal(check_blob_name("a\177", 2), GLINT_BLOB_NAME_CONTROL);
    assert_int_equal(check_blob_name("a\233", 2), GLINT_BLOB_NAME_FOREIGN);
}

TEST(rejects_sections_outside_the_file)
{
    struct file f;

    make_baked_file(&f);
    assert_int_equal(glint_blob_open(&blob, &kind, &f, BYTES), GLINT_BLOB_OK);
    assert_ptr_equal(glint_blob_find_section(&blob, HEADER, 3, 8),
                     &f.word[HEADER / 4]);
    assert_ptr_equal(glint_blob_find_section(&blob, HEADER + 4, 5, 4),
                     &f.word[HEADER / 4 + 1]);
    assert_ptr_equal(glint_blob_find_section(&blob, BYTES, 0, 4),
                     &f.word[BYTES / 4]);
    assert_true(blob.referred == 24 + 20);
    assert_null(glint_blob_find_section(&blob, HEADER, 25, 1));
    assert_null(glint_blob_find_section(&blob, HEADER + 4, 6, 4));
    assert_null(glint_blob_find_section(&blob, HEADER + 2, 1, 4));
    assert_null(glint_blob_find_section(&blob, HEADER - 4, 1, 4));
    assert_null(glint_blob_find_section(&blob, BYTES + 4, 0, 4));
    assert_null(glint_blob_find_section(&blob, UINT32_MAX - 3, 1, 4));
    assert_null(glint_blob_find_section(&blob, HEADER, (UINT64_C(1) << 38) - 1,
                                        1 << 25));
}
