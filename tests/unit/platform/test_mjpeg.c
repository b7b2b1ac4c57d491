/* SPDX-License-Identifier: MIT
 *
 * Tests the MJPEG decoder with frames that the test encodes with libjpeg. They
 * must decode to their original planes, and to the scan lines of libjpeg's own
 * decoder. The decoder must accept the deviations of real cameras and reject
 * damaged frames.
 */
#include <malloc.h>
#include <unistd.h>

#include <jpeglib.h>

#include "support/rng.h"
#include "jpeg/mjpeg.h"
#include "support/test.h"

#define NAME "cam"

static struct glint_error error;

/* -------------------------------------------------- encoding of test frames */

/* Parameters for encoding a frame. */
struct coding {
    int width, height;
    /* sampling factors of Y, Cb, Cr, horizontal and vertical, 1 .. 4; 0: the
     * component is absent */
    int factor[3][2];
    int restart; /* number of MCUs between restart markers; 0: no markers */
    /* true: optimised Huffman tables instead of the standard's */
    bool optimised;
    bool noisy;
};

static const struct coding y420 = {64, 48, {{2, 2}, {1, 1}, {1, 1}}, 0, 0, 0};
static const struct coding y422 = {64, 48, {{2, 1}, {1, 1}, {1, 1}}, 0, 0, 0};
static const struct coding grey = {64, 48, {{1, 1}, {0, 0}, {0, 0}}, 0, 0, 0};

struct bytes {
    /* N bytes, exactly allocated, so that ASan detects overreads */
    uint8_t *data;
    size_t n;
};

static struct bytes allocate_copy_of_bytes(const void *data, size_t n)
{
    const struct bytes b = {test_free_later(malloc(n ? n : 1)), n};

    memcpy(b.data, data, n);
    return b;
}

/* Returns the sample of plane P at (X, Y): a gradient that differs per plane,
 * plus noise if C is noisy. */
static uint8_t make_plane_sample(const struct coding *c, int p, int x, int y)
{
    static const int base[] = {20, 60, 200}, dx[] = {2, 1, -1},
                     dy[] = {1, 2, 0};
    const int value = base[p] + (dx[p] * x + dy[p] * y) / 4;
    const uint32_t hash = (uint32_t)(x * 7919 + y * 104729 + p) * 2654435761U;

    return (uint8_t)(c->noisy ? value + (int)(hash >> 27) : value % 256);
}

static int count_planes_of_coding(const struct coding *c)
{
    return c->factor[1][0] ? 3 : 1;
}

static void compress_planes(struct jpeg_compress_struct *j,
                            const struct coding *c)
{
    static uint8_t mem[3][32][2048];
    JSAMPROW row[3][32];
    JSAMPARRAY planes[3] = {row[0], row[1], row[2]};

    for (int mcu = 0; j->next_scanline < j->image_height; mcu++) {
        for (int p = 0; p < count_planes_of_coding(c); p++)
            for (int y = 0; y < c->factor[p][1] * 8; y++) {
                row[p][y] = mem[p][y];
                for (int x = 0; x < 2048; x++)
                    mem[p][y][x] = make_plane_sample(
                        c, p, x, mcu * c->factor[p][1] * 8 + y);
            }
        jpeg_write_raw_data(j, planes, (JDIMENSION)(j->max_v_samp_factor * 8));
    }
}

/* Returns a frame encoded with the parameters C. If TUNE is not NULL, it is
 * called before encoding, to change libjpeg's settings. */
static struct bytes
encode_jpeg_frame(const struct coding *c,
                  void (*tune)(struct jpeg_compress_struct *))
{
    struct jpeg_compress_struct j;
    struct jpeg_error_mgr errors;
    unsigned char *data = NULL;
    unsigned long n = 0;
    struct bytes exact;

    j.err = jpeg_std_error(&errors);
    jpeg_create_compress(&j);
    jpeg_mem_dest(&j, &data, &n);
    j.image_width = (JDIMENSION)c->width;
    j.image_height = (JDIMENSION)c->height;
    j.input_components = count_planes_of_coding(c);
    j.in_color_space =
        count_planes_of_coding(c) == 3 ? JCS_YCbCr : JCS_GRAYSCALE;
    jpeg_set_defaults(&j);
    jpeg_set_quality(&j, 100, TRUE);
    j.restart_interval = (unsigned)c->restart;
    j.optimize_coding = c->optimised;
    j.raw_data_in = TRUE;
    for (int p = 0; p < count_planes_of_coding(c); p++) {
        j.comp_info[p].h_samp_factor = c->factor[p][0];
        j.comp_info[p].v_samp_factor = c->factor[p][1];
    }
    if (tune)
        tune(&j);
    jpeg_start_compress(&j, TRUE);
    compress_planes(&j, c);
    jpeg_finish_compress(&j);
    jpeg_destroy_compress(&j);
    exact = allocate_copy_of_bytes(data, n);
    free(data);
    return exact;
}

/* Returns the offset of the first JPEG segment with marker MARKER at or after
 * AT. */
static size_t find_jpeg_segment(const struct bytes *b, int marker, size_t at)
{
    while (at + 1 < b->n && (b->data[at] != 0xff || b->data[at + 1] != marker))
        at++;
    assert_true(at + 1 < b->n);
    return at;
}

/* Replaces CUT bytes at offset AT by INSERT[N]. */
static void replace_bytes(struct bytes *b, size_t at, size_t cut,
                          const void *insert, size_t n)
{
    uint8_t *const data = test_free_later(malloc(b->n - cut + n));

    memcpy(data, b->data, at);
    memcpy(data + at, insert, n);
    memcpy(data + at + n, b->data + at + cut, b->n - at - cut);
    b->data = data;
    b->n += n - cut;
}

static void remove_jpeg_segments(struct bytes *b, int marker, int times)
{
    for (int i = 0; i < times; i++) {
        const size_t at = find_jpeg_segment(b, marker, 0);
        const size_t length = (size_t)(b->data[at + 2] << 8 | b->data[at + 3]);

        replace_bytes(b, at, 2 + length, "", 0);
    }
}

/* --------------------------------------------------- decoding and checking */

static struct glint_mjpeg *open_mjpeg_decoder(int width, int height)
{
    struct glint_mjpeg *d;

    assert_ok(glint_mjpeg_open(&d, NAME, width, height, &error));
    return d;
}

static struct glint_image decode_valid_frame(struct glint_mjpeg *d,
                                             const struct bytes *b)
{
    struct glint_image image;

    if (glint_mjpeg_decode(d, b->data, b->n, &image, &error))
        fail_msg("%s", error.text);
    return image;
}

static void expect_decoding_fails(struct glint_mjpeg *d, const struct bytes *b,
                                  enum glint_status status, const char *text)
{
    struct glint_image image = {.width = 77};

    assert_int_equal(glint_mjpeg_decode(d, b->data, b->n, &image, &error),
                     status);
    assert_int_equal(image.width, 77);
    if (!strstr(error.text, text))
        fail_msg("'%s' does not contain '%s'", error.text, text);
    assert_memory_equal(error.text, NAME ": MJPEG: ", strlen(NAME ": MJPEG: "));
}

static void expect_decoded_planes(const struct glint_image *i,
                                  const struct coding *c)
{
    assert_int_equal(i->width, c->width);
    assert_int_equal(i->height, c->height);
    assert_int_equal(i->range, GLINT_RANGE_FULL);
    assert_int_equal(i->matrix, GLINT_MATRIX_BT601);
    assert_int_equal(i->transfer, GLINT_TONE_SRGB);
    assert_int_equal(glint_image_planes(i->format), count_planes_of_coding(c));
    for (int p = 0; p < count_planes_of_coding(c); p++) {
        const int across = (int)glint_image_row_bytes(i->format, p, i->width);
        const int down = glint_image_plane_height(i->format, p, i->height);

        for (int y = 0; y < down; y++)
            for (int x = 0; x < across; x++) {
                const int is = i->plane[p][y * i->stride_bytes[p] + x];

                if (abs(is - make_plane_sample(c, p, x, y)) > 3)
                    fail_msg("plane %d, %d, %d: %d is not %d", p, x, y, is,
                             make_plane_sample(c, p, x, y));
            }
    }
    for (int p = count_planes_of_coding(c); p < 3; p++)
        assert_null(i->plane[p]);
}

/* Compares the planes with the scan lines of libjpeg's decoder, which is set to
 * repeat chroma samples instead of interpolating them. */
static void expect_libjpeg_scanlines(const struct glint_image *i,
                                     const struct bytes *b)
{
    const int halved = i->format == GLINT_I420 || i->format == GLINT_I422;
    const int halved_down = i->format == GLINT_I420;
    struct jpeg_decompress_struct j;
    struct jpeg_error_mgr errors;
    static JSAMPLE line[3 * 2048];
    JSAMPROW row = line;

    j.err = jpeg_std_error(&errors);
    jpeg_create_decompress(&j);
    jpeg_mem_src(&j, b->data, b->n);
    jpeg_read_header(&j, TRUE);
    j.out_color_space = j.jpeg_color_space;
    j.do_fancy_upsampling = FALSE;
    jpeg_start_decompress(&j);
    for (int y = 0; y < i->height; y++) {
        jpeg_read_scanlines(&j, &row, 1);
        for (int x = 0; x < i->width; x++)
            for (int p = 0; p < j.num_components; p++) {
                const int at_x = p ? x >> halved : x;
                const int at_y = p ? y >> halved_down : y;

                assert_int_equal(i->plane[p][at_y * i->stride_bytes[p] + at_x],
                                 line[x * j.num_components + p]);
            }
    }
    jpeg_destroy_decompress(&j);
}

/* ------------------------------------------------------------- whole frames */

static void check_decoding_of_coding(const struct coding *c,
                                     enum glint_pixel_format format)
{
    struct glint_mjpeg *const d = open_mjpeg_decoder(c->width, c->height);
    const struct bytes b = encode_jpeg_frame(c, NULL);
    const struct glint_image image = decode_valid_frame(d, &b);

    assert_int_equal(image.format, format);
    expect_decoded_planes(&image, c);
    expect_libjpeg_scanlines(&image, &b);
    glint_mjpeg_close(d);
}

TEST(decodes_every_coding)
{
    static const struct {
        int factor[3][2];
        enum glint_pixel_format format;
    } way[] = {
        {{{1, 1}, {0, 0}, {0, 0}}, GLINT_GREY},
        {{{2, 2}, {0, 0}, {0, 0}}, GLINT_GREY},
        {{{1, 1}, {1, 1}, {1, 1}}, GLINT_I444},
        {{{1, 2}, {1, 2}, {1, 2}}, GLINT_I444},
        {{{1, 3}, {1, 3}, {1, 3}}, GLINT_I444},
        {{{2, 1}, {1, 1}, {1, 1}}, GLINT_I422},
        /* sampling factors that ffmpeg uses for 4:2:2 */
        {{{2, 2}, {1, 2}, {1, 2}}, GLINT_I422},
        {{{2, 2}, {1, 1}, {1, 1}}, GLINT_I420},
    };
    static const int size[][2] = {
        {1, 1},   {8, 8},     {16, 16},  {17, 9},    {15, 33},
        {64, 64}, {720, 405}, {641, 65}, {1, 100},   {333, 1},
        {40, 72}, {128, 40},  {16, 64},  {1280, 31},
    };

    for (size_t i = 0; i < sizeof way / sizeof *way; i++)
        for (size_t s = 0; s < sizeof size / sizeof *size; s++) {
            struct coding c = {.width = size[s][0], .height = size[s][1]};

            memcpy(c.factor, way[i].factor, sizeof c.factor);
            check_decoding_of_coding(&c, way[i].format);
        }
}

/* Checks a frame without Huffman tables that was written by hand: one block of
 * 8 x 8 samples, with quantiser steps of 1. Its DC difference of 400 has
 * category 9 (code 1111110) and the value bits 110010000. Then follow the end
 * of the block, 1010, and padding. All samples must decode to 128 + 400 / 8 =
 * 178. */
TEST(decodes_a_frame_written_by_hand)
{
    static const uint8_t head[] = {0xff, 0xd8, 0xff, 0xdb, 0, 67, 0};
    static const uint8_t tail[] = {
        /* frame header (SOF0) */
        0xff, 0xc0, 0,    11,   8,   0, 8, 0, 8, 1,  1, 0x11,
        0,    0xff, 0xda, 0,    8,   1, 1, 0, 0, 63, 0, /* scan header (SOS) */
        0xfd, 0x90, 0xaf, 0xff, 0xd9};
    uint8_t frame[sizeof head + 64 + sizeof tail];
    struct glint_mjpeg *const d = open_mjpeg_decoder(8, 8);
    struct bytes b;
    struct glint_image image;

    memcpy(frame, head, sizeof head);
    memset(frame + sizeof head, 1, 64);
    memcpy(frame + sizeof head + 64, tail, sizeof tail);
    b = allocate_copy_of_bytes(frame, sizeof frame);
    image = decode_valid_frame(d, &b);
    assert_int_equal(image.format, GLINT_GREY);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            assert_int_equal(image.plane[0][y * image.stride_bytes[0] + x],
                             178);
    glint_mjpeg_close(d);
}

/* ---------------------------------------------------- deviations of cameras */

TEST(missing_huffman_tables_are_the_standard_ones)
{
    struct glint_mjpeg *const d = open_mjpeg_decoder(64, 48);
    struct coding own = y420;
    struct bytes b = encode_jpeg_frame(&y422, NULL), other;
    struct glint_image image;

    own.optimised = true;
    other = encode_jpeg_frame(&own, NULL);
    remove_jpeg_segments(&b, 0xc4, 4);
    image = decode_valid_frame(d, &b);
    expect_decoded_planes(&image, &y422);
    image = decode_valid_frame(d, &other);
    expect_decoded_planes(&image, &own);
    image =
        /* frame B has no tables, so the tables of frame OTHER must not apply */
        decode_valid_frame(d, &b);
    expect_decoded_planes(&image, &y422);
    glint_mjpeg_close(d);
}

TEST(tables_are_not_kept_between_frames)
{
    struct glint_mjpeg *const d = open_mjpeg_decoder(64, 48);
    struct bytes whole = encode_jpeg_frame(&y422, NULL),
                 bare = encode_jpeg_frame(&y422, NULL);

    remove_jpeg_segments(&bare, 0xdb, 2);
    decode_valid_frame(d, &whole);
    expect_decoding_fails(d, &bare, GLINT_E_FORMAT, "Quantization table");
    decode_valid_frame(d, &whole);
    glint_mjpeg_close(d);
}

/* Checks that frames decode with every combination of the following deviations
 * of cameras. */
TEST(decodes_deviations_of_cameras)
{
    static const uint8_t avi1[] = {0xff, 0xe0, 0, 16, 'A', 'V', 'I', '1', 0,
                                   0,    0,    0, 0,  0,   0,   0,   0,   0};
    static const uint8_t soi[] = {0xff, 0xd8};
    static const uint8_t filler[] = {0xff, 0xff, 0xff};
    static const uint8_t comment[] = {0xff, 0xfe, 0, 4, 0xff, 0xd8};
    struct coding c = y422;
    struct glint_mjpeg *const d = open_mjpeg_decoder(64, 48);

    c.restart = 4;
    c.noisy = true;
    for (int habits = 1; habits < 128; habits++) {
        struct bytes b = encode_jpeg_frame(&c, NULL);
        struct glint_image image;

        if (habits & 1) { /* An AVI1 segment replaces JFIF. */
            remove_jpeg_segments(&b, 0xe0, 1);
            replace_bytes(&b, 2, 0, avi1, sizeof avi1);
        }
        /* An additional start of image precedes the quantiser tables. */
        if (habits & 2)
            replace_bytes(&b, find_jpeg_segment(&b, 0xdb, 0), 0, soi,
                          sizeof soi);
        if (habits & 4) /* A second start of image follows the first. */
            replace_bytes(&b, 0, 0, soi, sizeof soi);
        if (habits & 8) /* Two extra bytes precede the third restart marker. */
            replace_bytes(&b, find_jpeg_segment(&b, 0xd2, 300), 0, "\x12\x34",
                          2);
        if (habits & 16) /* Half of the frame is repeated after its end. */
            replace_bytes(&b, b.n, 0, b.data, b.n / 2);
        else if (habits & 32) /* The end-of-image marker is missing. */
            b.n -= 2;
        if (habits & 64) {
            replace_bytes(&b, find_jpeg_segment(&b, 0xdb, 0), 0, comment,
                          sizeof comment);
            replace_bytes(&b, find_jpeg_segment(&b, 0xdb, 0), 0, filler,
                          sizeof filler);
        }
        b = allocate_copy_of_bytes(b.data, b.n);
        image = decode_valid_frame(d, &b);
        expect_decoded_planes(&image, &c);
    }
    glint_mjpeg_close(d);
}

TEST(frames_may_be_smaller_but_not_larger)
{
    struct coding small = y420, high = grey;
    struct glint_mjpeg *const d = open_mjpeg_decoder(64, 48);
    struct bytes b[3];
    struct glint_image image;

    small.width = 31;
    small.height = 17;
    high.height = 49;
    b[0] = encode_jpeg_frame(&y422, NULL);
    b[1] = encode_jpeg_frame(&small, NULL);
    b[2] = encode_jpeg_frame(&high, NULL);
    for (int i = 0; i < 4; i++) {
        image = decode_valid_frame(d, &b[i % 2]);
        expect_decoded_planes(&image, i % 2 ? &small : &y422);
        expect_decoding_fails(d, &b[2], GLINT_E_UNSUPPORTED,
                              "frame of 64 x 49 pixels is larger than 64 x 48");
    }
    glint_mjpeg_close(d);
}

/* ---------------------------------------------------------- rejected frames */

static void set_progressive_coding(struct jpeg_compress_struct *j)
{
    jpeg_simple_progression(j);
}

static void set_rgb_coding(struct jpeg_compress_struct *j)
{
    j->in_color_space = JCS_RGB;
    jpeg_set_colorspace(j, JCS_RGB);
}

static void set_arithmetic_coding(struct jpeg_compress_struct *j)
{
    j->arith_code = TRUE;
}

static void set_two_scans(struct jpeg_compress_struct *j)
{
    static const jpeg_scan_info scans[] = {
        {1, {0, 0, 0, 0}, 0, 63, 0, 0},
        {2, {1, 2, 0, 0}, 0, 63, 0, 0},
    };

    j->scan_info = scans;
    j->num_scans = 2;
}

static void
check_coding_is_rejected(struct coding c,
                         void (*tune)(struct jpeg_compress_struct *),
                         const char *text)
{
    struct glint_mjpeg *const d = open_mjpeg_decoder(64, 48);
    const struct bytes b = encode_jpeg_frame(&c, tune);

    expect_decoding_fails(d, &b, GLINT_E_UNSUPPORTED, text);
    glint_mjpeg_close(d);
}

TEST(rejects_unsupported_codings)
{
    static const struct coding y444 = {64, 48, {{1, 1}, {1, 1}, {1, 1}},
                                       0,  0,  0};
    static const int odd[][3][2] = {
        {{1, 2}, {1, 1}, {1, 1}}, {{4, 1}, {1, 1}, {1, 1}},
        {{1, 1}, {2, 1}, {2, 1}}, {{2, 2}, {2, 1}, {1, 1}},
        {{2, 1}, {1, 1}, {2, 1}},
    };
    struct coding c = y444;

    check_coding_is_rejected(y444, set_progressive_coding, "several scans");
    check_coding_is_rejected(y444, set_two_scans, "several scans");
    check_coding_is_rejected(y420, set_arithmetic_coding, "arithmetic");
    check_coding_is_rejected(y444, set_rgb_coding, "YCbCr");
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        memcpy(c.factor, odd[i], sizeof c.factor);
        check_coding_is_rejected(c, NULL, "subsampling");
    }
    assert_string_equal(
        error.text,
        NAME ": MJPEG: chroma subsampling 2x1,1x1,2x1 is not supported");
}

TEST(rejects_other_depths_and_processes)
{
    struct glint_mjpeg *const d = open_mjpeg_decoder(64, 48);
    struct bytes b = encode_jpeg_frame(&y420, NULL);
    const size_t frame = find_jpeg_segment(&b, 0xc0, 0);

    b.data[frame + 4] = 12;
    expect_decoding_fails(d, &b, GLINT_E_UNSUPPORTED, "precision 12");
    b.data[frame + 4] = 8;
    b.data[frame + 1] = 0xc3;
    expect_decoding_fails(d, &b, GLINT_E_UNSUPPORTED, "SOF type 0xc3");
    b.data[frame + 1] = 0xc0;
    /* The height is 0, as if a DNL marker followed that sets it. */
    b.data[frame + 6] = 0;
    expect_decoding_fails(d, &b, GLINT_E_FORMAT, "Empty JPEG image");
    glint_mjpeg_close(d);
}

TEST(open_rejects_invalid_sizes)
{
    struct glint_mjpeg *d = (struct glint_mjpeg *)&error;

    assert_true(glint_mjpeg_available());
    assert_int_equal(glint_mjpeg_open(&d, NAME, 0, 8, &error),
                     GLINT_E_ARGUMENT);
    assert_null(d);
    assert_int_equal(
        glint_mjpeg_open(&d, NAME, 8, GLINT_PANEL_SIDE + 1, &error),
        GLINT_E_ARGUMENT);
    assert_string_equal(error.text, NAME ": MJPEG frames of 8 x 8193 pixels: "
                                         "width and height must be 1 to 8192");
    glint_mjpeg_close(NULL);
}

/* ---------------------------------------------------------- damaged frames */

static void check_every_truncation(struct coding c)
{
    struct glint_mjpeg *const d = open_mjpeg_decoder(c.width, c.height);
    const struct bytes whole = encode_jpeg_frame(&c, NULL);
    const size_t end = whole.n - 2;

    assert_int_equal(whole.data[end + 1], 0xd9);
    for (size_t n = 0; n < end; n++) {
        const struct bytes b = allocate_copy_of_bytes(whole.data, n);

        expect_decoding_fails(d, &b, GLINT_E_FORMAT,
                              n == 0    ? "frame is empty"
                              : n < 100 ? "cut off in its header"
                                        : "");
        if (n == end - 1)
            assert_non_null(strstr(error.text, "cut off in row "));
    }
    for (size_t n = end; n <= whole.n; n++) {
        const struct bytes b = allocate_copy_of_bytes(whole.data, n);
        const struct glint_image image = decode_valid_frame(d, &b);

        expect_decoded_planes(&image, &c);
    }
    glint_mjpeg_close(d);
}

TEST(rejects_frames_truncated_anywhere)
{
    struct coding c = {33, 17, {{2, 1}, {1, 1}, {1, 1}}, 0, 0, 1};

    check_every_truncation(c);
    c.restart = 2;
    check_every_truncation(c);
    c.noisy = false;
    c.factor[0][1] = 2;
    check_every_truncation(c);
    c.factor[1][0] = 0;
    check_every_truncation(c);
}

/* Redirects stderr to FILE. Returns a duplicate of the old stderr, by which to
 * restore it. */
static int redirect_stderr(FILE *file)
{
    const int kept = dup(STDERR_FILENO);

    assert_true(kept >= 0 && dup2(fileno(file), STDERR_FILENO) >= 0);
    return kept;
}

/* Checks that decoding frames with random damage prints nothing to stderr,
 * and that the next intact frame decodes correctly. */
TEST(damaged_frames_print_nothing)
{
    struct coding c = {48, 32, {{2, 1}, {1, 1}, {1, 1}}, 3, 0, 1};
    struct glint_mjpeg *const d = open_mjpeg_decoder(48, 32);
    const struct bytes whole = encode_jpeg_frame(&c, NULL);
    FILE *const said = tmpfile();
    int kept, n_refused = 0;
    uint32_t seed = 1;
    struct glint_image image;

    assert_non_null(said);
    kept = redirect_stderr(said);
    for (int i = 0; i < 3000; i++) {
        struct bytes b = allocate_copy_of_bytes(whole.data, whole.n);
        enum glint_status status;

        for (int n = 1 + i % 4; n > 0; n--)
            b.data[(rng_bits32(&seed) >> 8) % b.n] =
                (uint8_t)(rng_bits32(&seed) >> 8);
        status = glint_mjpeg_decode(d, b.data, b.n, &image, &error);
        assert_true(status == GLINT_OK || status == GLINT_E_FORMAT ||
                    status == GLINT_E_UNSUPPORTED);
        n_refused += status != GLINT_OK;
    }
    dup2(kept, STDERR_FILENO);
    close(kept);
    assert_int_equal(fseek(said, 0, SEEK_END), 0);
    assert_int_equal(ftell(said), 0);
    fclose(said);
    /* some damage cannot be detected */
    assert_in_range(n_refused, 300, 2999);
    image = decode_valid_frame(d, &whole);
    expect_decoded_planes(&image, &c);
    glint_mjpeg_close(d);
}

TEST(rejects_random_bytes)
{
    struct glint_mjpeg *const d = open_mjpeg_decoder(64, 64);
    uint32_t seed = 2;

    for (size_t n = 0; n < 600; n++) {
        struct bytes b = allocate_copy_of_bytes("", 0);
        uint8_t noise[600];

        for (size_t i = 0; i < n; i++)
            noise[i] = n % 3 ? (uint8_t)(rng_bits32(&seed) >> 8) : 0;
        replace_bytes(&b, 0, 0, noise, n);
        expect_decoding_fails(d, &b, GLINT_E_FORMAT, "");
        /* random bytes after a start-of-image marker may look like a large
         * frame */
        if (n > 2) {
            struct glint_image image;

            memcpy(b.data, "\xff\xd8", 2);
            assert_int_not_equal(
                glint_mjpeg_decode(d, b.data, b.n, &image, &error), GLINT_OK);
        }
    }
    glint_mjpeg_close(d);
}

/* The restart markers of a frame are numbered. Checks that these numbers reveal
 * a missing restart interval, which would shift all later blocks. */
TEST(detects_a_missing_restart_interval)
{
    struct coding c = y422;
    struct glint_mjpeg *const d = open_mjpeg_decoder(64, 48);
    struct bytes b;
    size_t from;

    c.restart = 4;
    c.noisy = true;
    b = encode_jpeg_frame(&c, NULL);
    from = find_jpeg_segment(&b, 0xd1, 300);
    replace_bytes(&b, from, find_jpeg_segment(&b, 0xd2, from) - from, "", 0);
    expect_decoding_fails(d, &b, GLINT_E_FORMAT, "instead of RST1");
    glint_mjpeg_close(d);
}

/* Checks that the size of the heap after 100 valid and damaged frames equals
 * that after 10. */
TEST(decoding_does_not_grow_the_heap)
{
    struct glint_mjpeg *const d = open_mjpeg_decoder(720, 405);
    struct coding c = {720, 405, {{2, 1}, {1, 1}, {1, 1}}, 0, 0, 1};
    const struct bytes whole = encode_jpeg_frame(&c, NULL);
    const struct bytes half = allocate_copy_of_bytes(whole.data, whole.n / 2);
    struct mallinfo2 early = {0}, late;

    for (int i = 0; i < 100; i++) {
        if (i == 10)
            early = mallinfo2();
        decode_valid_frame(d, &whole);
        expect_decoding_fails(d, &half, GLINT_E_FORMAT, "cut off in row ");
    }
    late = mallinfo2();
    assert_int_equal(late.uordblks, early.uordblks);
    assert_int_equal(late.arena, early.arena);
    assert_int_equal(late.hblkhd, early.hblkhd);
    glint_mjpeg_close(d);
}
