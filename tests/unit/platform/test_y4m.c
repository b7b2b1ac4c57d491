/* SPDX-License-Identifier: MIT
 *
 * Checks that YUV4MPEG2 frames of odd sizes survive writing and reading, and
 * that invalid headers and files cut at any byte are rejected.
 */
#include <errno.h>
#include <unistd.h>

#include "support/scratch.h"
#include "support/test.h"
#include "video/y4m.h"

/* Two frames of 17 bytes: 9 of luma, and 4 each of Cb and Cr. */
#define SMALL                  \
    "YUV4MPEG2 W3 H3 F25:1\n"  \
    "FRAME\nabcdefghiCDEFcdef" \
    "FRAME Ip Xq=1\nABCDEFGHI01234567"

static struct glint_error error;

/* A stream in memory that returns CHUNK bytes per read. After its last byte,
 * reading ends or fails. */
struct memory {
    const char *data;
    size_t bytes, at, chunk;
    bool fails;
};

static ptrdiff_t read_stream_bytes_from_memory(void *ctx, void *dst,
                                               size_t bytes)
{
    struct memory *const m = ctx;
    size_t n = m->bytes - m->at;

    if (n == 0 && m->fails) {
        errno = EIO;
        return -1;
    }
    n = n < m->chunk ? n : m->chunk;
    n = n < bytes ? n : bytes;
    memcpy(dst, m->data + m->at, n);
    m->at += n;
    return (ptrdiff_t)n;
}

static enum glint_status parse_header(struct glint_y4m_header *header,
                                      const char *line)
{
    return glint_y4m_header_parse(header, line, "x.y4m", &error);
}

/* ----------------------------------------------------------- stream header */

TEST(parses_a_header_of_ffmpeg)
{
    static const char line[] = "YUV4MPEG2 W720 H405 F25:1 Ip A1:1 C420mpeg2 "
                               "XYSCSS=420MPEG2 XCOLORRANGE=LIMITED";
    struct glint_y4m_header h;
    char printed[GLINT_Y4M_PRINTED];
    size_t len;

    assert_ok(parse_header(&h, line));
    assert_int_equal(h.width, 720);
    assert_int_equal(h.height, 405);
    assert_int_equal(h.format, GLINT_I420);
    assert_int_equal(h.range, GLINT_RANGE_LIMITED);
    assert_int_equal(h.matrix, GLINT_MATRIX_BT601);
    assert_int_equal(h.fps_num, 25);
    assert_int_equal(h.fps_den, 1);
    assert_int_equal(h.interlace, 'p');
    assert_string_equal(h.extra, " XYSCSS=420MPEG2");
    len = glint_y4m_header_print(printed, &h);
    assert_int_equal(len, sizeof line);
    assert_memory_equal(printed, line, sizeof line - 1);
    assert_int_equal(printed[len - 1], '\n');

    h.range = GLINT_RANGE_FULL; /* This range contradicts the tags. */
    glint_y4m_header_print(printed, &h);
    assert_non_null(strstr(printed, " XCOLORRANGE=FULL\n"));
    assert_null(strstr(printed, "LIMITED"));
}

static void expect_format_of_tags(const char *tag,
                                  enum glint_pixel_format format)
{
    struct glint_y4m_header h;
    char line[100], printed[GLINT_Y4M_PRINTED];

    snprintf(line, sizeof line, "YUV4MPEG2 W5 H3 F30000:1001%s\n", tag);
    line[strlen(line) - 1] = 0;
    assert_ok(parse_header(&h, line));
    assert_int_equal(h.format, format);
    assert_int_equal(h.range, GLINT_RANGE_LIMITED);
    assert_int_equal(h.fps_num, 30000);
    assert_int_equal(h.fps_den, 1001);
    glint_y4m_header_print(printed, &h);
    assert_memory_equal(printed, line, strlen(line));
    assert_string_equal(printed + strlen(line), "\n");
}

TEST(parses_every_format)
{
    expect_format_of_tags("", GLINT_I420);
    expect_format_of_tags(" C420", GLINT_I420);
    expect_format_of_tags(" C420jpeg", GLINT_I420);
    expect_format_of_tags(" C420mpeg2", GLINT_I420);
    expect_format_of_tags(" C420paldv", GLINT_I420);
    expect_format_of_tags(" It C422", GLINT_I422);
    expect_format_of_tags(" I? A0:0 C444", GLINT_I444);
    expect_format_of_tags(" Im A10:11 Cmono", GLINT_GREY);
    expect_format_of_tags(" Ib C420 Zwhat XANY=thing", GLINT_I420);
    expect_format_of_tags(" C420p10 XANY=thing Ip", GLINT_I420);
    expect_format_of_tags(" C422p12", GLINT_I422);
    expect_format_of_tags(" C444p16", GLINT_I444);
    expect_format_of_tags(" Cmono9", GLINT_GREY);
    expect_format_of_tags(" C411", GLINT_I422);
    expect_format_of_tags(" C444alpha", GLINT_I444);
}

TEST(parses_range_and_matrix)
{
    struct glint_y4m_header h;

    assert_ok(
        parse_header(&h, "YUV4MPEG2 W1280 H720 C420jpeg XCOLORRANGE=FULL"));
    assert_int_equal(h.range, GLINT_RANGE_FULL);
    assert_int_equal(h.matrix, GLINT_MATRIX_BT601);
    assert_int_equal(h.fps_num, 0);
    assert_int_equal(h.fps_den, 0);
    assert_ok(parse_header(&h, "YUV4MPEG2 W1280 H719 XCOLORRANGE=OTHER"));
    assert_int_equal(h.range, GLINT_RANGE_LIMITED);
    assert_int_equal(h.matrix, GLINT_MATRIX_BT601);
    assert_string_equal(h.extra, " XCOLORRANGE=OTHER");
    /* C420jpeg with full range means BT.601, at any image size */
    assert_ok(
        parse_header(&h, "YUV4MPEG2 W1280 H720 C420jpeg XCOLORRANGE=FULL"));
    assert_int_equal(h.matrix, GLINT_MATRIX_BT601);
    assert_ok(
        parse_header(&h, "YUV4MPEG2 W1280 H720 C420mpeg2 XCOLORRANGE=FULL"));
    assert_int_equal(h.matrix, GLINT_MATRIX_BT709);
    assert_ok(parse_header(&h, "YUV4MPEG2 W1280 H720 C420jpeg"));
    assert_int_equal(h.matrix, GLINT_MATRIX_BT709);
}

static void check_stream_is_rejected(enum glint_status status, const char *line)
{
    struct glint_y4m_header h = {.width = 77};

    if (parse_header(&h, line) != status)
        fail_msg("%s", line);
    assert_memory_equal(error.text, "x.y4m: ", 7);
    assert_int_equal(h.width, 77);
}

TEST(rejects_invalid_headers)
{
    static const char *const malformed[] = {
        "",
        "YUV4MPEG",
        "YUV4MPEG2",
        "YUV4MPEG22 W3 H3",
        "YUV4MPEG2 W3",
        "YUV4MPEG2 H3",
        "YUV4MPEG2 W0 H3",
        "YUV4MPEG2 W3 H-3",
        "YUV4MPEG2 W3 H3.0",
        "YUV4MPEG2 W H3",
        "YUV4MPEG2 W3 H3 F",
        "YUV4MPEG2 W3 H3 F25",
        "YUV4MPEG2 W3 H3 F25:",
        "YUV4MPEG2 W3 H3 F25:0",
        "YUV4MPEG2 W3 H3 F25:1:1",
        "YUV4MPEG2 W3 H3 F-1:1",
        "YUV4MPEG2 W3 H3 I",
        "YUV4MPEG2 W3 H3 Ix",
        "YUV4MPEG2 W3 H3 Ipp",
        "YUV4MPEG2 W3 H3 A1",
        "YUV4MPEG2 W3 H3 A1:1234567890123456789012345",
        "YUV4MPEG2 W3 H3 C",
        "YUV4MPEG2 W3 H3 C420jpegjpegjpegjpeg",
        "YUV4MPEG2 W3 H3 X\tY",
        "YUV4MPEG2 W3 H3\r",
    };

    for (size_t i = 0; i < sizeof malformed / sizeof *malformed; i++)
        check_stream_is_rejected(GLINT_E_FORMAT, malformed[i]);
    check_stream_is_rejected(GLINT_E_UNSUPPORTED, "YUV4MPEG2 W32769 H3");
    check_stream_is_rejected(GLINT_E_UNSUPPORTED, "YUV4MPEG2 W3 H32769");
    check_stream_is_rejected(GLINT_E_UNSUPPORTED, "YUV4MPEG2 W4294967299 H3");
    check_stream_is_rejected(GLINT_E_UNSUPPORTED, "YUV4MPEG2 W3 H3 C440");
    check_stream_is_rejected(GLINT_E_UNSUPPORTED,
                             "YUV4MPEG2 W3 H3 C444alphap10");
    check_stream_is_rejected(GLINT_E_UNSUPPORTED,
                             "YUV4MPEG2 W3 H3 C420jpegp10");
    check_stream_is_rejected(GLINT_E_UNSUPPORTED, "YUV4MPEG2 W3 H3 Cmono8");
    check_stream_is_rejected(GLINT_E_UNSUPPORTED, "YUV4MPEG2 W3 H3 C420p11");
    check_stream_is_rejected(GLINT_E_UNSUPPORTED, "YUV4MPEG2 W3 H3 C420p100");
    assert_string_equal(
        error.text,
        "x.y4m: C420p100 is not a supported colour space: 420, 422, 444 (up to "
        "p16), 411, 444alpha and mono (up to mono16) are");
}

TEST(prints_a_header)
{
    struct glint_y4m_header h;
    char printed[GLINT_Y4M_PRINTED];

    glint_y4m_header_init(&h, 640, 480, GLINT_I420, 30, 1);
    glint_y4m_header_print(printed, &h);
    assert_string_equal(printed,
                        "YUV4MPEG2 W640 H480 F30:1 Ip A1:1 C420jpeg\n");
    glint_y4m_header_init(&h, 5, 1080, GLINT_GREY, 0, 0);
    h.range = GLINT_RANGE_FULL;
    assert_int_equal(h.matrix, GLINT_MATRIX_BT709);
    glint_y4m_header_print(printed, &h);
    assert_string_equal(
        printed, "YUV4MPEG2 W5 H1080 F0:0 Ip A1:1 Cmono XCOLORRANGE=FULL\n");
}

/* ---------------------------------------------------------- reading frames */

TEST(reads_frames_in_pieces)
{
    for (size_t chunk = 1; chunk < 90; chunk++) {
        struct memory memory = {BYTES(SMALL), 0, chunk, false};
        struct glint_y4m_reader reader;
        const struct glint_image *frame;

        assert_ok(glint_y4m_reader_start(&reader, read_stream_bytes_from_memory,
                                         &memory, "x.y4m", &error));
        assert_ok(glint_y4m_reader_next(&reader, &frame, &error));
        assert_int_equal(frame->format, GLINT_I420);
        assert_int_equal(frame->transfer, GLINT_TONE_BT709);
        assert_int_equal(frame->stride_bytes[0], 3);
        assert_int_equal(frame->stride_bytes[1], 2);
        assert_memory_equal(frame->plane[0], "abcdefghi", 9);
        assert_memory_equal(frame->plane[1], "CDEF", 4);
        assert_memory_equal(frame->plane[2], "cdef", 4);
        assert_string_equal(reader.frame_tags, "");
        assert_ok(glint_y4m_reader_next(&reader, &frame, &error));
        assert_memory_equal(frame->plane[2], "4567", 4);
        assert_string_equal(reader.frame_tags, " Ip Xq=1");
        assert_int_equal(reader.n_frames, 2);
        assert_ok(glint_y4m_reader_next(&reader, &frame, &error));
        assert_null(frame);
        glint_y4m_reader_close(&reader);
        glint_y4m_reader_close(&reader);
    }
}

/* Reads the stream DATA until its end or the first error. Sets *FRAMES to the
 * number of complete frames. Returns the status of the last read. */
static enum glint_status read_all_frames(const char *data, size_t bytes,
                                         long *frames, bool fails)
{
    struct memory memory = {data, bytes, 0, 7, fails};
    struct glint_y4m_reader reader;
    const struct glint_image *frame = NULL;
    enum glint_status status = glint_y4m_reader_start(
        &reader, read_stream_bytes_from_memory, &memory, "x.y4m", &error);

    while (!status &&
           !(status = glint_y4m_reader_next(&reader, &frame, &error)) && frame)
        ;
    *frames = reader.n_frames;
    glint_y4m_reader_close(&reader);
    return status;
}

/* Checks that a stream truncated at any byte ends with the right message. The
 * header has 22 bytes. The first frame has a line of 6 bytes and 17 bytes of
 * samples, the second frame 14 and 17. */
TEST(reports_every_truncation)
{
    long frames;

    for (size_t n = 0; n < sizeof SMALL; n++) {
        const int whole = n == 22 || n == 45 || n == 76;

        assert_int_equal(read_all_frames(SMALL, n, &frames, false),
                         whole ? GLINT_OK : GLINT_E_FORMAT);
        assert_int_equal(frames, n < 45 ? 0 : n < 76 ? 1 : 2);
        assert_int_equal(read_all_frames(SMALL, n, &frames, true), GLINT_E_IO);
    }
    read_all_frames(SMALL, 75, &frames, false);
    assert_string_equal(error.text, "x.y4m: frame 1: ends after 16 of 17 "
                                    "bytes");
    read_all_frames(SMALL, 47, &frames, false);
    assert_string_equal(error.text, "x.y4m: frame 1: malformed FRAME line");
    read_all_frames(SMALL, 21, &frames, false);
    assert_string_equal(error.text, "x.y4m: ends inside the Y4M header");
    read_all_frames(SMALL, 0, &frames, false);
    assert_string_equal(error.text, "x.y4m: is empty");
    read_all_frames("RIFFxxxxAVI \n", 13, &frames, false);
    assert_string_equal(error.text, "x.y4m: is not a YUV4MPEG2 stream");
}

TEST(rejects_too_long_lines)
{
    static char text[2000];
    const size_t magic = strlen("YUV4MPEG2 W1 H1 C444 X");
    long frames;

    memset(text, 'x', sizeof text);
    memcpy(text, "YUV4MPEG2 W1 H1 C444 X", magic);
    assert_int_equal(read_all_frames(text, sizeof text, &frames, false),
                     GLINT_E_FORMAT);
    assert_string_equal(error.text, "x.y4m: has a Y4M header that is too long");
    text[GLINT_Y4M_LINE] = '\n';
    assert_int_equal(read_all_frames(text, sizeof text, &frames, false),
                     GLINT_E_FORMAT);
    text[GLINT_Y4M_LINE - 1] = '\n';
    memcpy(text + GLINT_Y4M_LINE, "FRAME ", 6);
    assert_int_equal(read_all_frames(text, sizeof text, &frames, false),
                     GLINT_E_FORMAT);
    assert_string_equal(error.text, "x.y4m: frame 0: malformed FRAME line");
    text[GLINT_Y4M_LINE + 5 + GLINT_Y4M_FRAME_TAGS - 1] = '\n';
    assert_ok(read_all_frames(
        text, GLINT_Y4M_LINE + 5 + GLINT_Y4M_FRAME_TAGS + 3, &frames, false));
    assert_int_equal(frames, 1);
}

TEST(rejects_invalid_frames)
{
    static const struct {
        const char *text;
        size_t bytes;
    } bad[] = {
        {BYTES("YUV4MPEG2 W1 H1 Cmono\nFRAMEaFRAME\nb")},
        {BYTES("YUV4MPEG2 W1 H1 Cmono\nFRAME\nab")},
        {BYTES("YUV4MPEG2 W1 H1 Cmono\nframe\na")},
        {BYTES("YUV4MPEG2 W1 H1 Cmono\n\nFRAME\na")},
        {BYTES("YUV4MPEG2 W1 H1 Cmono\nFRAME \0\na")},
        {BYTES("YUV4MPEG2 W1 H1 Cmono\nFRAME\r\na")},
        {BYTES("YUV4MPEG2 W1 H1 \0Cmono\nFRAME\na")},
        {BYTES("YUV4MPEG2 W8192 H8192 C444\nFRAME\na")},
    };
    long frames;

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        if (read_all_frames(bad[i].text, bad[i].bytes, &frames, false) !=
            GLINT_E_FORMAT)
            fail_msg("%s", bad[i].text);
}

/* -------------------------------------------------------------- round trips */

/* Checks that copying DATA frame by frame to a file preserves every byte. */
static void check_copied_stream(const char *data, size_t bytes)
{
    struct memory memory = {data, bytes, 0, 5000, false};
    struct glint_y4m_reader reader;
    struct glint_y4m_writer writer;
    const struct glint_image *frame;

    assert_ok(glint_y4m_reader_start(&reader, read_stream_bytes_from_memory,
                                     &memory, "x.y4m", &error));
    assert_ok(
        glint_y4m_writer_open(&writer, scratch_file, &reader.header, &error));
    while (!glint_y4m_reader_next(&reader, &frame, &error) && frame)
        assert_ok(
            glint_y4m_writer_put(&writer, frame, reader.frame_tags, &error));
    assert_int_equal(writer.n_frames, reader.n_frames);
    assert_ok(glint_y4m_writer_commit(&writer, &error));
    glint_y4m_reader_close(&reader);
    scratch_expect_bytes(scratch_file, data, bytes);
}

TEST(copies_streams_unchanged)
{
    check_copied_stream(BYTES(SMALL));
    check_copied_stream(BYTES("YUV4MPEG2 W3 H1 F0:0 It A1:1 C422 XYSCSS=422\n"
                              "FRAME\nabcBCbc"));
    check_copied_stream(BYTES("YUV4MPEG2 W2 H1 F5:1 C444\nFRAME\nabBCbc"));
    check_copied_stream(BYTES("YUV4MPEG2 W2 H1 F5:1 Cmono XCOLORRANGE=FULL\n"
                              "FRAME\nab"));
    check_copied_stream(BYTES("YUV4MPEG2 W1 H1 F5:1\nFRAME\nabc"));
    /* a stream without frames is valid */
    check_copied_stream(BYTES("YUV4MPEG2 W8192 H8192 F5:1\n"));
}

/* ----------------------------------------------------- bit depth and layout */

/* Reads the frame in DATA and checks that its planes, converted to 8 bits,
 * equal SEEN. */
static void check_8bit_planes(const char *data, size_t bytes, const char *seen,
                              size_t n_seen)
{
    const struct glint_image *frame;
    struct memory m = {data, bytes, 0, 7, false};
    struct glint_y4m_reader reader;

    assert_ok(glint_y4m_reader_start(&reader, read_stream_bytes_from_memory, &m,
                                     "x.y4m", &error));
    assert_ok(glint_y4m_reader_next(&reader, &frame, &error));
    assert_non_null(frame);
    assert_memory_equal(frame->plane[0], seen, n_seen);
    glint_y4m_reader_close(&reader);
}

TEST(reads_deep_frames)
{
    /* 3 x 1 pixels of 10 bits: 3 luma and 2 + 2 chroma samples, of two bytes
     * each */
    check_8bit_planes(BYTES("YUV4MPEG2 W3 H1 C420p10\nFRAME\n"
                            "\x40\x00\xac\x03\xff\x03"
                            "\x00\x02\x04\x02"
                            "\xff\x01\x00\x00"),
                      BYTES("\x10\xeb\xff"
                            "\x80\x81"
                            "\x7f\x00"));
    check_8bit_planes(BYTES("YUV4MPEG2 W2 H1 Cmono16\nFRAME\n\xff\x12\x00\xab"),
                      BYTES("\x12\xab"));
    check_8bit_planes(BYTES("YUV4MPEG2 W6 H1 C411\nFRAME\nabcdefuvUV"),
                      BYTES("abcdefuuvUUV"));
    check_8bit_planes(BYTES("YUV4MPEG2 W1 H1 C444alpha\nFRAME\nabcd"),
                      BYTES("abc"));
}

/* Fills PLANES with a frame of 3 x 3 pixels of format TAG, luma CODE and chroma
 * MIDDLE, and adds the light of LAYER to it. */
static void add_light_to_frame(const char *tag, int code, int middle,
                               const float *layer, uint8_t planes[72])
{
    static struct glint_y4m_light light;
    struct glint_y4m_header h;
    char line[80];
    bool wide;
    size_t n;

    snprintf(line, sizeof line, "YUV4MPEG2 W3 H3 %s", tag);
    assert_ok(parse_header(&h, line));
    wide = h.layout.bits > 8;
    n = glint_y4m_layout_bytes(&h.layout, 3, 3) / (wide ? 2 : 1);
    for (size_t i = 0; i < n; i++) {
        const int value = i < 9 ? code : middle;

        planes[wide ? 2 * i : i] = (uint8_t)value;
        if (wide)
            planes[2 * i + 1] = (uint8_t)(value >> 8);
    }
    glint_y4m_light_init(&light, &h);
    glint_y4m_light_add(&light, planes, layer);
}

static int read_16bit_sample(const uint8_t *planes, int i)
{
    return planes[2 * i] | planes[2 * i + 1] << 8;
}

/* Checks white light of 0.18, computed by hand: BT.709 encodes it as 1.099 *
 * 0.18^0.45 - 0.099 = 0.4090, which is 64 + 876 * 0.4090 = 422.3 in 10 bits. */
TEST(adds_light_to_10_bit_codes)
{
    float layer[27] = {0};
    uint8_t planes[72];

    add_light_to_frame("C420p10", 500, 512, layer, planes);
    for (int i = 0; i < 9; i++)
        assert_int_equal(read_16bit_sample(planes, i), 500);
    layer[3 * 4] = layer[3 * 4 + 1] = layer[3 * 4 + 2] = 0.18F;
    add_light_to_frame("C420p10", 64, 512, layer, planes);
    for (int i = 0; i < 17; i++)
        assert_int_equal(read_16bit_sample(planes, i), i == 4  ? 422
                                                       : i < 9 ? 64
                                                               : 512);
    add_light_to_frame("Cmono12 XCOLORRANGE=FULL", 0, 0, layer, planes);
    assert_int_equal(read_16bit_sample(planes, 4), 1675); /* 4095 * 0.40901 */
    /* The last of 3 x 3 pixels gets red light of 9, which clips. No other pixel
     * shares its chroma sample. */
    layer[3 * 8] = 9;
    add_light_to_frame("C420p10", 64, 512, layer, planes);
    /* luma of red: 64 + 876 * 0.299 */
    assert_int_equal(read_16bit_sample(planes, 8), 326);
    assert_int_equal(read_16bit_sample(planes, 12),
                     361); /* Cb of red: 512 - 896 * 0.1687 */
    /* Cr of red: 512 + 896 * 0.5 */
    assert_int_equal(read_16bit_sample(planes, 16), 960);
    assert_int_equal(read_16bit_sample(planes, 9), 512);
}

/* Checks that adding light does not change codes at or above white, nor
 * alpha. */
TEST(codes_above_white_are_unchanged)
{
    float layer[27];
    uint8_t planes[72];

    for (int i = 0; i < 27; i++)
        layer[i] = 0.5F;
    add_light_to_frame("C444p12 XCOLORRANGE=LIMITED", 3760, 2048, layer,
                       planes);
    for (int i = 0; i < 27; i++)
        assert_int_equal(read_16bit_sample(planes, i), i < 9 ? 3760 : 2048);
    add_light_to_frame("C444p12", 4000, 2048, layer, planes);
    assert_int_equal(read_16bit_sample(planes, 0), 4000);
    add_light_to_frame("C444alpha", 16, 128, layer, planes);
    assert_int_equal(planes[35], 128);
    assert_in_range(planes[0], 170, 176);
}

/* Returns the linear light of code V by the formulas in the standards. 1 is
 * diffuse white: 203 cd/m2 in PQ, code 0.75 in HLG [BT.2408]. */
static double decode_transfer_code(enum glint_transfer_curve curve, double v)
{
    const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * log(4 * a);
    double p;

    switch (curve) {
    case GLINT_TRANSFER_SRGB:
        return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    case GLINT_TRANSFER_LINEAR:
        return v;
    case GLINT_TRANSFER_GAMMA22:
        return pow(v, 2.2);
    case GLINT_TRANSFER_GAMMA28:
        return pow(v, 2.8);
    case GLINT_TRANSFER_240M:
        return v < 0.0912 ? v / 4 : pow((v + 0.1115) / 1.1115, 1 / 0.45);
    case GLINT_TRANSFER_PQ:
        p = pow(v, 32 / 2523.0);
        return 10000 / 203.0 *
               pow(fmax(p - 3424 / 4096.0, 0) /
                       (2413 / 128.0 - 2392 / 128.0 * p),
                   8192 / 1305.0);
    case GLINT_TRANSFER_HLG:
        return (v <= 0.5 ? v * v / 3 : (exp((v - c) / a) + b) / 12) /
               ((exp((0.75 - c) / a) + b) / 12);
    case GLINT_TRANSFER_LOG100:
        return v > 0 ? pow(10, 2 * (v - 1)) : 0;
    case GLINT_TRANSFER_LOG316:
        return v > 0 ? pow(10, 2.5 * (v - 1)) : 0;
    default:
        return v < 0.081 ? v / 4.5 : pow((v + 0.099) / 1.099, 1 / 0.45);
    }
}

TEST(transfer_tables_match_the_standards)
{
    for (int t = 0; t < GLINT_TRANSFERS; t++)
        for (int i = 0; i <= GLINT_Y4M_STEPS; i++) {
            const double want =
                decode_transfer_code((enum glint_transfer_curve)t, i / 4096.0);
            const int32_t light_q24 = glint_transfer_decode_q24(
                (enum glint_transfer_curve)t, i, GLINT_Y4M_STEPS);

            assert_true(fabs(ldexp(light_q24, -24) - want) <=
                        2e-5 * want + 1e-7);
        }
    assert_int_equal(glint_transfer_from_tag("arib-std-b67"),
                     GLINT_TRANSFER_HLG);
    assert_int_equal(glint_transfer_from_tag("hlg"), -1);
    assert_int_equal(glint_primaries_from_tag("bt2020"),
                     GLINT_PRIMARIES_BT2020);
    assert_int_equal(glint_primaries_from_tag("film"), -1);
}

/* Returns the code, 0 .. 1, of LIGHT by bisection: the inverse of
 * decode_transfer_code(). */
static double encode_light(enum glint_transfer_curve curve, double light)
{
    double low = 0, high = 1;

    for (int i = 0; i < 60; i++) {
        const double middle = (low + high) / 2;

        *(decode_transfer_code(curve, middle) < light ? &low : &high) = middle;
    }
    return high;
}

/* Adds LIGHT to 16-bit pixels of 0.001 .. 4 times white, encoded by CURVE, and
 * checks that their light increases by LIGHT. The light is white, or red of
 * BT.709 if IS_RED is set. */
static void check_added_light(enum glint_transfer_curve curve,
                              enum glint_primaries primaries, double light,
                              bool is_red)
{
    static const double red_2020[] = {0.627404, 0.069097, 0.016391};
    static struct glint_y4m_light y4m;
    struct glint_y4m_header h;
    const double most = fmin(4, decode_transfer_code(curve, 1) - light);
    float layer[3] = {(float)light, is_red ? 0 : (float)light,
                      is_red ? 0 : (float)light};

    assert_ok(parse_header(&h, "YUV4MPEG2 W1 H1 C444p16 XCOLORRANGE=FULL"));
    h.matrix = GLINT_MATRIX_BT2020;
    h.transfer = curve;
    h.primaries = primaries;
    glint_y4m_light_init(&y4m, &h);
    /* logarithmic curves have no codes for light near 0 */
    for (double ground = fmax(0.001, 2 * decode_transfer_code(curve, 1e-5));
         ground < most; ground *= 1.7) {
        const int code = (int)(65535 * encode_light(curve, ground) + 0.5);
        uint8_t planes[6] = {
            (uint8_t)code, (uint8_t)(code >> 8), 0, 128, 0, 128};
        double y, cb, cr, rgb[3];

        glint_y4m_light_add(&y4m, planes, layer);
        y = read_16bit_sample(planes, 0) / 65535.0;
        cb = (read_16bit_sample(planes, 1) - 32768) / 65535.0;
        cr = (read_16bit_sample(planes, 2) - 32768) / 65535.0;
        rgb[0] = y + 2 * (1 - 0.2627) * cr;
        rgb[2] = y + 2 * (1 - 0.0593) * cb;
        rgb[1] = (y - 0.2627 * rgb[0] - 0.0593 * rgb[2]) / 0.678;
        for (int c = 0; c < 3; c++) {
            const double want = light * (is_red ? red_2020[c] : 1);
            const double got = decode_transfer_code(curve, rgb[c]) -
                               decode_transfer_code(curve, code / 65535.0);

            assert_true(fabs(got - want) <=
                        0.02 * want + 2e-4 * (ground + light));
        }
    }
}

/* Checks that light is added in linear light, with the transfer curve and
 * primaries of the stream, within 2 % and the rounding to 16 bits. */
TEST(light_is_added_in_linear_light)
{
    for (int t = 0; t < GLINT_TRANSFERS; t++)
        for (double light = 0.02; light < 1; light *= 3) {
            check_added_light((enum glint_transfer_curve)t,
                              GLINT_PRIMARIES_BT709, light, false);
            check_added_light((enum glint_transfer_curve)t,
                              GLINT_PRIMARIES_BT2020, light, false);
            check_added_light((enum glint_transfer_curve)t,
                              GLINT_PRIMARIES_BT2020, light, true);
        }
}

/* Checks the SDR copy of a PQ stream: white (203 cd/m2) and all brighter codes
 * become white of BT.709, also in 8 bits. */
TEST(pq_copy_is_graded_to_sdr)
{
    static const double nits[] = {0, 20.3, 203, 4000};
    static const int want[] = {16, 80, 235, 235};
    struct glint_y4m_reader in;
    const struct glint_image *frame;
    char bytes[64] = "YUV4MPEG2 W4 H1 Cmono10\nFRAME\n";
    const size_t at = strlen(bytes);
    struct memory memory = {bytes, at + 8, 0, 7, false};

    for (int i = 0; i < 4; i++) {
        const int code =
            (int)(64.5 + 876 * encode_light(GLINT_TRANSFER_PQ, nits[i] / 203));

        bytes[at + 2 * (size_t)i] = (char)code;
        bytes[at + 2 * (size_t)i + 1] = (char)(code >> 8);
    }
    assert_ok(glint_y4m_reader_start(&in, read_stream_bytes_from_memory,
                                     &memory, "pq", &error));
    in.header.transfer = GLINT_TRANSFER_PQ;
    in.header.primaries = GLINT_PRIMARIES_BT2020;
    assert_ok(glint_y4m_reader_next(&in, &frame, &error));
    for (int i = 0; i < 4; i++)
        assert_in_range(frame->plane[0][i], want[i] - 1, want[i] + 1);
    glint_y4m_reader_close(&in);
}

/* Checks that a video of 720 x 405 pixels with 203 rows of chroma, as ffmpeg
 * writes them, is copied unchanged. */
TEST(copies_a_video_of_odd_height)
{
    enum { FRAME = 720 * 405 + 2 * 360 * 203, HEADER = 80 };
    const size_t bytes = HEADER + 2 * (6 + FRAME);
    char *const data = test_free_later(malloc(bytes + 1));

    assert_int_equal(snprintf(data, bytes, "%s%s\n",
                              "YUV4MPEG2 W720 H405 F25:1 Ip A1:1 C420mpeg2 ",
                              "XYSCSS=420MPEG2 XCOLORRANGE=LIMITED"),
                     HEADER);
    for (size_t i = 0; i < bytes; i++)
        if (i >= HEADER)
            data[i] = (char)(i * 7);
    memcpy(data + HEADER, "FRAME\n", 6);
    memcpy(data + HEADER + 6 + FRAME, "FRAME\n", 6);
    check_copied_stream(data, HEADER + 2 * (6 + FRAME));
}

/* Checks that images whose rows are padded, or stored bottom row first, are
 * written without padding, top row first. */
TEST(writes_images_without_padding)
{
    uint8_t luma[] = "ab--cd--ef--", cb[] = "y-z-", cr[] = "Y-Z-";
    const struct glint_image frame = {.format = GLINT_I420,
                                      .width = 2,
                                      .height = 3,
                                      .plane = {luma + 8, cb, cr},
                                      .stride_bytes = {-4, 2, 2}};
    struct glint_y4m_header header;
    struct glint_y4m_writer writer;

    glint_y4m_header_init(&header, 2, 3, GLINT_I420, 1, 1);
    assert_ok(glint_y4m_writer_open(&writer, scratch_file, &header, &error));
    assert_ok(glint_y4m_writer_put(&writer, &frame, "", &error));
    assert_ok(glint_y4m_writer_commit(&writer, &error));
    scratch_expect_bytes(scratch_file,
                         BYTES("YUV4MPEG2 W2 H3 F1:1 Ip A1:1 C420jpeg\n"
                               "FRAME\nefcdabyzYZ"));
}

TEST(full_device_is_an_error)
{
    struct glint_y4m_header header;
    struct glint_y4m_writer writer;
    uint8_t sample = 0;
    const struct glint_image frame = {.format = GLINT_GREY,
                                      .width = 1,
                                      .height = 1,
                                      .plane = {&sample, NULL, NULL},
                                      .stride_bytes = {1, 0, 0}};

    glint_y4m_header_init(&header, 1, 1, GLINT_GREY, 1, 1);
    assert_ok(glint_y4m_writer_open(&writer, "/dev/full", &header, &error));
    assert_int_equal(glint_y4m_writer_put(&writer, &frame, "", &error),
                     GLINT_E_OUTPUT);
    assert_int_equal(writer.n_frames, 0);
    glint_y4m_writer_abort(&writer);
}

TEST(reports_a_missing_file)
{
    struct glint_y4m_reader reader;

    assert_int_equal(glint_y4m_reader_open(&reader, "/nowhere/x.y4m", &error),
                     GLINT_E_IO);
    assert_string_equal(error.text,
                        "/nowhere/x.y4m: No such file or directory");
    glint_y4m_reader_close(&reader);
}

TEST_GROUP(scratch_create_file, scratch_remove_file);
