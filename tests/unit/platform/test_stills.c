/* SPDX-License-Identifier: MIT
 *
 * Tests PNG and JPEG without the image plug-in: pixels, and what is preserved,
 * lost and reported of metadata. If $GLINT_OIIO names the plug-in, compares
 * pixels with it.
 */

#include <sys/resource.h>
#include <unistd.h>

#include "formats/picture.h"
#include "formats/stills.h"
#include "support/scratch.h"
#include "support/test.h"

enum { WIDTH = 24, HEIGHT = 16 };

static struct glint_error error;

/* Pieces of metadata as files hold them. Checksums of chunks are not read. */
static const char exif_jpeg[] = "\xff\xe1\x00\x22"
                                "Exif\0\0"
                                "II*\0\x08\0\0\0\x01\0"
                                "\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
static const char xmp_jpeg[] = "\xff\xe1\x00\x23http://ns.adobe.com/xap/1.0/\0"
                               "<x/>";
static const char claims_jpeg[] =
    "\xff\xe1\x00\x26http://ns.adobe.com/xap/1.0/\0"
    "hdrgm:1";
static const char comment_jpeg[] = "\xff\xfe\x00\x07words";
static const char index_jpeg[] = "\xff\xe2\x00\x08MPF\0ab";
static const char text_png[] = "\0\0\0\x07tEXta\0wordsCRC4";
static const char gamma_png[] = "\0\0\0\x04gAMA\0\0\xb1\x8f\x0b\xfc\x61\x05";
static const char bits_png[] = "\0\0\0\x03sBIT\5\6\5CRC4";
static const char signed_png[] = "\0\0\0\4caBXabcdCRC4";
static const char signed_jpeg[] = "\xff\xeb\0\7abcde";
static const char moving_png[] = "\0\0\0\x08"
                                 "acTL\0\0\0\x02\0\0\0\0CRC4";

static const struct glint_oiio *find(const char *type)
{
    const struct glint_oiio *const stills = glint_stills_find(type);

    if (!stills)
        skip();
    return stills;
}

/* Writes a picture of smooth colours to the file NAME, with the N bytes at MORE
 * behind the first HEAD bytes. */
static void write_picture(const char *name, size_t head, const char *more,
                          size_t n)
{
    static uint8_t rgb[HEIGHT][WIDTH][3];
    const struct glint_oiio_pixels pixels = {WIDTH, HEIGHT, 0, rgb};
    char file[8192];
    size_t bytes;
    void *data;

    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            rgb[y][x][0] = (uint8_t)(9 * x);
            rgb[y][x][1] = (uint8_t)(15 * y);
            rgb[y][x][2] = (uint8_t)(100 + 3 * x);
        }
    assert_ok(find(strrchr(name, '.'))
                  ->encode(&data, &bytes, name, &pixels,
                           (ptrdiff_t)sizeof rgb[0], &error));
    assert_in_range(bytes, head, sizeof file - n);
    memcpy(file, data, head);
    memcpy(file + head, more, n);
    memcpy(file + head + n, (char *)data + head, bytes - head);
    free(data);
    scratch_write_file(name, file, bytes + n);
}

struct opened {
    struct glint_oiio_file *file;
    struct glint_samples samples;
    struct glint_oiio_facts facts;
};

static struct opened open_file(const struct glint_oiio *by, const char *name)
{
    struct opened o;

    if (by->open(&o.file, &o.samples, &o.facts, scratch_make_path(name),
                 &error))
        fail_msg("%s", error.text);
    return o;
}

/* Encodes O, or PIXELS if it is not NULL, as the file NAME, which it writes.
 * Returns what is lost. */
static const char *save(const struct glint_oiio *by, struct opened *o,
                        const char *name, const struct glint_samples *pixels)
{
    static struct glint_oiio_options options;
    size_t bytes;
    void *data;

    options = (struct glint_oiio_options){.drop_colours = 0};
    if (by->encode_file(&data, &bytes, name, o ? o->file : NULL, pixels,
                        &options, &error))
        fail_msg("%s", error.text);
    scratch_write_file(name, data, bytes);
    free(data);
    return options.said;
}

/* A file in memory. */
struct bytes {
    char data[8192];
    size_t n;
};

static struct bytes read_bytes(const char *name)
{
    struct bytes b;
    FILE *const f = fopen(scratch_make_path(name), "rb");

    assert_non_null(f);
    b.n = fread(b.data, 1, sizeof b.data, f);
    fclose(f);
    return b;
}

/* Returns the position of BYTES[N] in FILE, or NULL. */
static const char *find_bytes(const struct bytes *file, const char *bytes,
                              size_t n)
{
    for (size_t i = 0; i + n <= file->n; i++)
        if (memcmp(file->data + i, bytes, n) == 0)
            return file->data + i;
    return NULL;
}

static bool has_bytes(const char *name, const char *bytes, size_t n)
{
    const struct bytes file = read_bytes(name);

    return find_bytes(&file, bytes, n) != NULL;
}

static void expect_equal_pixels(const struct glint_samples *a,
                                const struct glint_samples *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->orientation, b->orientation);
    assert_int_equal(a->pixel_bytes, b->pixel_bytes);
    assert_int_equal(a->n_colours, b->n_colours);
    assert_int_equal(a->has_alpha, b->has_alpha);
    assert_int_equal(a->maximum, b->maximum);
    assert_memory_equal(a->mem, b->mem,
                        (size_t)a->width * (size_t)a->height * a->pixel_bytes);
}

/* ------------------------------------------------------------------ pixels */

TEST(types_are_those_that_are_built_in)
{
    assert_null(glint_stills_find(".tif"));
    assert_null(glint_stills_find("TIFF"));
    assert_null(glint_stills_find("any file but PPM, PGM and PFM"));
    assert_ptr_equal(glint_stills_find(".JPG"), glint_stills_find("JPEG"));
    assert_ptr_equal(glint_stills_find("x.png"), glint_stills_find("PNG"));
}

TEST(a_png_keeps_8_bits)
{
    struct opened o;

    write_picture("a.png", 8, "", 0);
    o = open_file(find("PNG"), "a.png");
    assert_int_equal(o.samples.width, WIDTH);
    assert_int_equal(o.samples.pixel_bytes, 3);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        assert_int_equal(o.samples.mem[3 * i], 9 * (i % WIDTH));
        assert_int_equal(o.samples.mem[3 * i + 1], 15 * (i / WIDTH));
    }
    find("PNG")->close(o.file);
}

/* Writes deep.png, 16 bits with alpha, of N_COLOURS. */
static void write_deep_png(int n_colours)
{
    static uint16_t mem[HEIGHT * WIDTH * 4];
    struct glint_samples s = {.width = WIDTH,
                              .height = HEIGHT,
                              .n_colours = n_colours,
                              .has_alpha = true,
                              .pixel_bytes = 2 * (size_t)(n_colours + 1),
                              .colour = {{.sample = GLINT_SAMPLE_U16}},
                              .mem = (uint8_t *)mem};

    for (int i = 0; i < WIDTH * HEIGHT * (n_colours + 1); i++)
        mem[i] = (uint16_t)(i * 12345);
    save(find("PNG"), NULL, "deep.png", &s);
}

TEST(a_png_keeps_16_bits_and_alpha)
{
    for (int n_colours = 1; n_colours <= 3; n_colours += 2) {
        struct opened a, b;

        write_deep_png(n_colours);
        a = open_file(find("PNG"), "deep.png");
        assert_int_equal(a.samples.n_colours, n_colours);
        assert_int_equal(a.samples.maximum, 65535);
        assert_false(a.samples.is_premultiplied);
        for (int i = 0; i < WIDTH * HEIGHT * (n_colours + 1); i++)
            assert_int_equal(((const uint16_t *)(void *)a.samples.mem)[i],
                             (uint16_t)(i * 12345));
        assert_string_equal(save(find("PNG"), &a, "deeper.png", NULL), "");
        b = open_file(find("PNG"), "deeper.png");
        expect_equal_pixels(&a.samples, &b.samples);
        find("PNG")->close(a.file);
        find("PNG")->close(b.file);
    }
}

TEST(turned_pictures_are_read_upright)
{
    struct glint_oiio_pixels turned;
    const struct glint_oiio *const jpeg = find("JPEG");
    struct opened o;

    write_picture("a.jpg", 2, BYTES(exif_jpeg));
    o = open_file(jpeg, "a.jpg");
    assert_int_equal(o.samples.orientation, 6);
    assert_string_equal(o.facts.metadata, "Exif");
    assert_ok(jpeg->read(&turned, scratch_make_path("a.jpg"), &error));
    assert_int_equal(turned.width, HEIGHT);
    assert_int_equal(turned.height, WIDTH);
    /* 6: the first row of the file is the right edge */
    for (int x = 0; x < WIDTH; x++)
        assert_memory_equal((uint8_t *)turned.rgb +
                                3 * (x * HEIGHT + HEIGHT - 1),
                            o.samples.mem + 3 * x, 3);
    free(turned.rgb);
    jpeg->close(o.file);
}

/* ---------------------------------------------------------------- metadata */

TEST(a_jpeg_keeps_its_metadata_and_coding)
{
    const struct glint_oiio *const jpeg = find("JPEG");
    struct opened a, b;
    struct bytes file;
    char more[256];
    size_t n = 0;

    memcpy(more + n, exif_jpeg, sizeof exif_jpeg - 1), n += 36;
    memcpy(more + n, xmp_jpeg, sizeof xmp_jpeg - 1), n += sizeof xmp_jpeg - 1;
    memcpy(more + n, comment_jpeg, sizeof comment_jpeg - 1);
    n += sizeof comment_jpeg - 1;
    write_picture("a.jpg", 2, more, n);
    a = open_file(jpeg, "a.jpg");
    assert_string_equal(a.facts.note, "");
    assert_string_equal(save(jpeg, &a, "b.jpg", NULL), "");
    assert_true(has_bytes("b.jpg", more, n));
    assert_true(has_bytes("b.jpg", BYTES("JFIF")));
    b = open_file(jpeg, "b.jpg");
    assert_int_equal(b.samples.orientation, 6);
    /* the table of luma, and the segment that states the subsampling */
    file = read_bytes("a.jpg");
    assert_true(
        has_bytes("b.jpg", find_bytes(&file, BYTES("\xff\xdb\0\x43\0")), 69));
    assert_true(
        has_bytes("b.jpg", find_bytes(&file, BYTES("\xff\xc0\0\x11")), 19));
    assert_int_equal(jpeg->is_same_type(a.file, "x.JPEG"), true);
    assert_int_equal(jpeg->is_same_type(a.file, "x.png"), false);
    jpeg->close(a.file);
    jpeg->close(b.file);
}

TEST(a_jpeg_becomes_a_png_with_exif)
{
    const struct glint_oiio *const stills = find("PNG");
    struct opened a, b;

    write_picture("a.jpg", 2, BYTES(exif_jpeg));
    a = open_file(find("JPEG"), "a.jpg");
    assert_string_equal(save(stills, &a, "a.png", &a.samples), "");
    b = open_file(stills, "a.png");
    assert_int_equal(b.samples.orientation, 1);
    assert_string_equal(b.facts.metadata, "Exif");
    stills->close(a.file);
    write_picture("a.jpg", 2, BYTES(xmp_jpeg));
    a = open_file(stills, "a.jpg");
    assert_string_equal(a.facts.metadata, "XMP, text or resolution");
    assert_non_null(strstr(save(stills, &a, "a.png", &a.samples), "XMP"));
    /* and back, with its Exif */
    save(stills, &b, "b.jpg", &b.samples);
    assert_true(has_bytes("b.jpg", exif_jpeg, 28));
    stills->close(a.file);
    stills->close(b.file);
}

static char *add_number(char *at, unsigned long value, int bytes)
{
    while (bytes-- > 0) {
        *at++ = (char)(value & 255);
        value >>= 8;
    }
    return at;
}

static char *add_tag(char *at, unsigned tag, unsigned type, unsigned long value)
{
    at = add_number(at, tag, 2);
    at = add_number(at, type, 2);
    return add_number(add_number(at, 1, 4), value, 4);
}

enum { CAMERA_BYTES = 143 };

/* Sets TO to a segment with Exif: orientation 6, camera settings VALUES
 * (f-number and focal length, fractions; focal length for 35 mm film) and a
 * preview. */
static void make_camera_exif(char to[CAMERA_BYTES],
                             const unsigned long values[5])
{
    char *at = to + 18;

    memcpy(to,
           "\xff\xe1\0\x8d"
           "Exif\0\0II*\0\x08\0\0",
           18);
    at = add_number(at, 2, 2); /* offset 8 */
    at = add_tag(at, 0x0112, 3, 6);
    at = add_tag(at, 0x8769, 4, 38);
    at = add_number(at, 96, 4);
    at = add_number(at, 3, 2); /* offset 38 */
    at = add_tag(at, 0x829d, 5, 80);
    at = add_tag(at, 0x920a, 5, 88);
    at = add_tag(at, 0xa405, 3, values[4]);
    at = add_number(at, 0, 4);
    for (int i = 0; i < 4; i++) /* offset 80 */
        at = add_number(at, values[i], 4);
    at = add_number(at, 2, 2); /* offset 96 */
    at = add_tag(at, 0x0201, 4, 126);
    at = add_tag(at, 0x0202, 4, 7);
    at = add_number(at, 0, 4);
    memcpy(at, "PREVIEW", 7);
    assert_int_equal(at + 7 - to, CAMERA_BYTES);
}

TEST(a_preview_is_cut_from_exif)
{
    static const unsigned long values[5] = {1, 1, 1, 1, 1};
    char camera[CAMERA_BYTES];
    struct opened o;

    make_camera_exif(camera, values);
    write_picture("a.jpg", 2, camera, sizeof camera);
    o = open_file(find("JPEG"), "a.jpg");
    assert_true(has_bytes("a.jpg", BYTES("PREVIEW")));
    save(find("PNG"), &o, "b.png", &o.samples);
    assert_true(has_bytes("b.png", BYTES("\0\0\0\x7e"
                                         "eXIf")));
    assert_false(has_bytes("b.png", BYTES("PREVIEW")));
    find("JPEG")->close(o.file);
}

TEST(exif_states_the_camera)
{
    static const struct {
        unsigned long values[5];
        double f_number, focal_mm;
    } cameras[] = {
        {{28, 10, 50, 1, 0}, 2.8, 50}, {{2, 1, 4, 1, 28}, 14, 28},
        {{2, 1, 0, 1, 90}, 2, 90},     {{2, 1, 78, 10, 0}, 0, 0},
        {{2, 1, 10, 0, 0}, 0, 0},      {{2, 1, 10001, 1, 0}, 0, 0},
        {{2, 1, 10001, 1, 90}, 2, 90}, {{2, 1, 1, 4000, 90}, 2, 90},
        {{2, 1, 50, 1, 20000}, 2, 50},
    };
    struct glint_kept kept;

    find("JPEG");
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        char camera[CAMERA_BYTES];

        make_camera_exif(camera, cameras[i].values);
        write_picture("a.jpg", 2, camera, sizeof camera);
        assert_ok(glint_kept_open(&kept, scratch_make_path("a.jpg"), &error));
        assert_float_equal(kept.f_number, cameras[i].f_number, 1e-5);
        assert_float_equal(kept.focal_mm, cameras[i].focal_mm, 1e-5);
        glint_kept_close(&kept);
    }
}

TEST(what_is_dropped_is_reported)
{
    static const char first_only[] = "only its first picture";
    static const struct {
        const char *name, *more;
        size_t head, n;
        const char *note;
    } files[] = {
        {"a.jpg", claims_jpeg, 2, sizeof claims_jpeg - 1, first_only},
        {"a.jpg", index_jpeg, 2, sizeof index_jpeg - 1, first_only},
        {"a.png", moving_png, 33, sizeof moving_png - 1, first_only},
        {"a.png", signed_png, 33, sizeof signed_png - 1, "caBX, valid only"},
        {"a.jpg", signed_jpeg, 2, sizeof signed_jpeg - 1, "APP11 (C2PA"},
    };

    for (int i = 0; i < 5; i++) {
        const struct glint_oiio *const stills = find(files[i].name);
        struct opened o;

        write_picture(files[i].name, files[i].head, files[i].more, files[i].n);
        o = open_file(stills, files[i].name);
        assert_non_null(strstr(o.facts.note, files[i].note));
        save(stills, &o, files[i].name, NULL);
        assert_false(has_bytes(files[i].name, files[i].more, files[i].n));
        stills->close(o.file);
    }
}

TEST(bytes_behind_a_picture_are_reported)
{
    static const char *const names[] = {"a.jpg", "a.png"};

    for (int i = 0; i < 2; i++) {
        const struct glint_oiio *const stills = find(names[i]);
        struct opened o;
        FILE *f;

        if (i == 0)
            write_picture("a.jpg", 2, BYTES(index_jpeg));
        else
            write_picture("a.png", 33, "", 0);
        f = fopen(scratch_make_path(names[i]), "ab");
        assert_non_null(f);
        fwrite(text_png, 1, sizeof text_png - 1, f);
        fclose(f);
        o = open_file(stills, names[i]);
        assert_string_equal(
            o.facts.note,
            i ? "19 bytes behind its picture are dropped"
              : "19 bytes behind its picture are dropped; only its first "
                "picture is written, without gain map, video and preview");
        save(stills, &o, names[i], NULL);
        assert_false(has_bytes(names[i], BYTES("words")));
        stills->close(o.file);
    }
}

TEST(a_png_keeps_its_chunks)
{
    const struct glint_oiio *const png = find("PNG");
    struct opened o;

    write_picture("a.png", 33, BYTES(text_png));
    o = open_file(png, "a.png");
    assert_string_equal(save(png, &o, "b.png", NULL), "");
    assert_true(has_bytes("b.png", BYTES(text_png)));
    if (glint_stills_find("JPEG"))
        assert_non_null(strstr(save(png, &o, "b.jpg", &o.samples), "texts"));
    png->close(o.file);
    write_picture("a.png", 33, BYTES(bits_png));
    o = open_file(png, "a.png");
    save(png, &o, "b.png", NULL);
    assert_true(has_bytes("b.png", BYTES(bits_png)));
    png->close(o.file);
}

/* Writes to a.png the N bytes MORE in place of its chunk sRGB. */
static void write_png_of_colours(const char *more, size_t n)
{
    struct bytes file;
    const char *srgb;

    write_picture("a.png", 33, more, n);
    file = read_bytes("a.png");
    srgb = find_bytes(&file, BYTES("\0\0\0\1sRGB"));
    assert_non_null(srgb);
    memmove(file.data + (srgb - file.data), srgb + 13,
            file.n - 13 - (size_t)(srgb - file.data));
    scratch_write_file("a.png", file.data, file.n - 13);
}

TEST(a_png_states_its_colours)
{
    static const char colours[] =
        "\0\0\0\x04gAMA\0\0\xb1\x8f\x0b\xfc\x61\x05"
        "\0\0\0\x20"
        "cHRM\0\0\x7a\x26\0\0\x80\x84\0\0\xfa\0\0\0\x80\xe8"
        "\0\0\x75\x30\0\0\xea\x60\0\0\x3a\x98\0\0\x17\x70"
        "CRC4"
        "\0\0\0\4cICP\x09\x10\0\1CRC4";
    static const double primaries[4][2] = {
        {0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3127, 0.329}};
    const struct glint_oiio *const png = find("PNG");
    struct opened o;

    write_picture("a.png", 33, BYTES(gamma_png)); /* sRGB wins */
    o = open_file(png, "a.png");
    assert_true(o.facts.gamma == 0 && !o.facts.has_primaries);
    png->close(o.file);
    write_png_of_colours(BYTES(colours));
    o = open_file(png, "a.png");
    assert_float_equal(o.facts.gamma, 2.2, 1e-4);
    assert_true(o.facts.has_primaries);
    for (int i = 0; i < 8; i++)
        assert_float_equal(o.facts.primaries[i / 2][i % 2],
                           primaries[i / 2][i % 2], 1e-9);
    assert_int_equal(o.facts.cicp[0], 9);
    assert_int_equal(o.facts.cicp[1], 16);
    png->close(o.file);
}

/* ------------------------------------------------- unusual coding of JPEGs */

TEST(a_jpeg_keeps_only_tables_that_can_be_written)
{
    static const struct {
        unsigned step;
        bool is_kept;
    } tables[] = {{1, true}, {8191, true}, {0, false}, {8192, false}};
    const struct glint_oiio *const jpeg = find("JPEG");

    for (int i = 0; i < 4; i++) {
        char more[5 + 2 * 64] = "\xff\xdb\0\x83\x10"; /* 16 bits, luma */
        struct opened o;

        for (int k = 0; k < 64; k++) {
            more[5 + 2 * k] = (char)(tables[i].step >> 8);
            more[6 + 2 * k] = (char)tables[i].step;
        }
        write_picture("a.jpg", 158, more, sizeof more);
        o = open_file(jpeg, "a.jpg");
        assert_string_equal(save(jpeg, &o, "b.jpg", NULL),
                            tables[i].is_kept
                                ? ""
                                : "libjpeg cannot write its quantisation or "
                                  "subsampling: quality 95 without "
                                  "subsampling");
        assert_int_equal(
            has_bytes("b.jpg", more + 5, sizeof more - 5) ||
                has_bytes("b.jpg", BYTES("\xff\xdb\0\x43\0\1\1\1\1")),
            tables[i].is_kept);
        jpeg->close(o.file);
        o = open_file(jpeg, "b.jpg");
        jpeg->close(o.file);
    }
}

static void add_bytes(struct bytes *to, const char *bytes, size_t n)
{
    assert_in_range(to->n + n, 0, sizeof to->data);
    memcpy(to->data + to->n, bytes, n);
    to->n += n;
}

/* Writes to a.jpg a grey picture of 8 x 8 pixels in Y'CbCr, of which each scan
 * has one component, the last N_LAST times. LUMA: sampling factors of Y'.
 * CHROMA: quantisation table of the others; table 1 is behind the first scan.
 */
static void write_scans(int luma, int chroma, int n_last)
{
    char table[69] = "\xff\xdb\0\x43";
    char frame[] = "\xff\xc0\0\x11\x08\0\x08\0\x08\3\1\x11\0\2\x11\0\3\x11";
    struct bytes file = {.n = 0};

    memset(table + 5, 9, 64);
    frame[11] = (char)luma;
    frame[15] = frame[18] = (char)chroma;
    add_bytes(&file, BYTES("\xff\xd8"));
    add_bytes(&file, table, sizeof table);
    add_bytes(&file, frame, sizeof frame);
    for (int kind = 0; kind < 2; kind++) { /* DC, AC: code 0 is symbol 0 */
        char codes[22] = "\xff\xc4\0\x14";

        codes[4] = (char)(16 * kind);
        codes[5] = 1;
        add_bytes(&file, codes, sizeof codes);
    }
    for (int i = 0; i < 2 + n_last; i++) {
        char scan[] = "\xff\xda\0\x08\1\1\0\0\x3f\0\x3f";

        scan[5] = (char)(i < 2 ? i + 1 : 3);
        add_bytes(&file, scan, sizeof scan - 1);
        table[4] = 1;
        if (i == 0)
            add_bytes(&file, table, sizeof table);
    }
    add_bytes(&file, BYTES("\xff\xd9"));
    scratch_write_file("a.jpg", file.data, file.n);
}

TEST(a_jpeg_of_many_scans_is_written)
{
    static const struct {
        int luma, chroma, n_last;
        bool is_kept;
    } files[] = {{0x11, 0, 1, true},
                 {0x22, 0, 490, true},
                 {0x44, 0, 1, false},
                 {0x11, 1, 1, false}};
    const struct glint_oiio *const jpeg = find("JPEG");

    for (int i = 0; i < 4; i++) {
        struct opened o;

        write_scans(files[i].luma, files[i].chroma, files[i].n_last);
        o = open_file(jpeg, "a.jpg");
        assert_string_equal(o.facts.note, "");
        assert_int_equal(o.samples.mem[0], 128);
        assert_int_equal(!*save(jpeg, &o, "b.jpg", NULL), files[i].is_kept);
        jpeg->close(o.file);
        o = open_file(jpeg, "b.jpg");
        assert_int_equal(o.samples.mem[0], 128);
        jpeg->close(o.file);
    }
}

TEST(a_large_jpeg_is_written)
{
    static uint8_t rgb[256][256][3];
    const struct glint_oiio_pixels pixels = {256, 256, 0, rgb};
    struct glint_oiio_pixels again;
    size_t bytes;
    void *data;
    unsigned noise = 1;

    for (int i = 0; i < 256 * 256 * 3; i++)
        (&rgb[0][0][0])[i] = (uint8_t)((noise = noise * 69069 + 1) >> 24);
    assert_ok(find("JPEG")->encode(&data, &bytes, "a.jpg", &pixels,
                                   (ptrdiff_t)sizeof rgb[0], &error));
    assert_in_range(bytes, 100000, 300000); /* more than libjpeg's buffer */
    scratch_write_file("a.jpg", data, bytes);
    free(data);
    assert_ok(find("JPEG")->read(&again, scratch_make_path("a.jpg"), &error));
    free(again.rgb);
}

/* ------------------------------------------------------------------ errors */

static void expect_rejected(enum glint_status status, const char *name,
                            const char *cause)
{
    struct opened o;

    assert_int_equal(find(strrchr(name, '.'))
                         ->open(&o.file, &o.samples, &o.facts,
                                scratch_make_path(name), &error),
                     status);
    if (!strstr(error.text, cause))
        fail_msg("%s", error.text);
}

TEST(damaged_files_are_rejected)
{
    static const char *const names[] = {"a.jpg", "a.png"};
    static const char cmyk[] =
        "\xff\xd8\xff\xc0\x00\x14\x08\x00\x08\x00\x08\x04\x01\x11\x00\x02\x11"
        "\x00\x03\x11\x00\x04\x11\x00\xff\xda\x00\x0e\x04\x01\x00\x02\x00\x03"
        "\x00\x04\x00\x00\x3f\x00";

    for (int i = 0; i < 2; i++) {
        struct bytes file;

        write_picture(names[i], 2, "", 0);
        file = read_bytes(names[i]);
        for (size_t cut = file.n - 2; cut > 4; cut -= cut / 4) {
            scratch_write_file(names[i], file.data, cut);
            expect_rejected(GLINT_E_FORMAT, names[i], names[i]);
        }
    }
    scratch_write_file("a.jpg", BYTES(cmyk));
    expect_rejected(GLINT_E_UNSUPPORTED, "a.jpg", "'make oiio'");
    write_scans(0x11, 0, 510);
    expect_rejected(GLINT_E_UNSUPPORTED, "a.jpg", "more than 500 scans");
}

TEST(a_chunk_that_states_1_gib_allocates_no_memory)
{
    const char chunk[] = "\x40\0\0\0tEXt";
    struct rusage usage;
    long before_kb;

    write_picture("a.png", 33, BYTES(chunk));
    getrusage(RUSAGE_SELF, &usage);
    before_kb = usage.ru_maxrss;
    expect_rejected(GLINT_E_FORMAT, "a.png", "is cut off");
    getrusage(RUSAGE_SELF, &usage);
    assert_in_range(usage.ru_maxrss - before_kb, 0, 65536);
}

TEST(a_cut_jpeg_is_rejected_after_a_warning)
{
    struct bytes file;
    struct opened o;

    /* bytes between segments, of which libjpeg warns */
    write_picture("a.jpg", 158, BYTES("xyz"));
    file = read_bytes("a.jpg");
    o = open_file(find("JPEG"), "a.jpg");
    assert_non_null(strstr(o.facts.note, "extraneous bytes"));
    find("JPEG")->close(o.file);
    scratch_write_file("a.jpg", file.data, file.n - 20);
    expect_rejected(GLINT_E_FORMAT, "a.jpg", "is cut off");
}

/* --------------------------------------------------------- the same by both */

TEST(pixels_equal_those_of_the_plugin)
{
    static const char *const names[] = {"a.jpg", "a.png", "deep.png"};
    const struct glint_oiio *oiio, *const stills = find("PNG");

    if (!getenv("GLINT_OIIO") || glint_oiio_load(&oiio, &error))
        skip();
    write_picture("a.jpg", 2, BYTES(exif_jpeg));
    write_picture("a.png", 33, "", 0);
    write_deep_png(3);
    for (int i = 0; i < 3; i++) {
        struct glint_oiio_pixels p, q;
        struct opened a = open_file(stills, names[i]);
        struct opened b = open_file(oiio, names[i]);
        struct opened c, d;

        expect_equal_pixels(&a.samples, &b.samples);
        if (a.samples.has_alpha)
            assert_false(b.samples.is_premultiplied);
        save(stills, &a, "x.png", &a.samples);
        save(stills, &a, i ? "x.png" : "x.jpg", NULL);
        save(oiio, &b, i ? "y.png" : "y.jpg", NULL);
        c = open_file(stills, i ? "x.png" : "x.jpg");
        d = open_file(stills, i ? "y.png" : "y.jpg");
        expect_equal_pixels(&c.samples, &d.samples);
        stills->close(a.file);
        oiio->close(b.file);
        stills->close(c.file);
        stills->close(d.file);
        assert_ok(stills->read(&p, scratch_make_path(names[i]), &error));
        assert_ok(oiio->read(&q, scratch_make_path(names[i]), &error));
        assert_int_equal(p.width, q.width);
        for (int k = 0; k < WIDTH * HEIGHT * 3; k++) /* 1: rounding of alpha */
            assert_in_range(((uint8_t *)p.rgb)[k] - ((uint8_t *)q.rgb)[k] + 1,
                            i == 2 ? 0 : 1, i == 2 ? 2 : 1);
        free(p.rgb);
        free(q.rgb);
    }
}

TEST_OPEN
{
    scratch_create_dir();
}

TEST_CLOSE
{
    static const char *const names[] = {
        "a.jpg", "a.png", "b.jpg", "b.png",    "x.jpg",
        "x.png", "y.jpg", "y.png", "deep.png", "deeper.png"};

    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        unlink(scratch_make_path(names[i]));
    scratch_remove_dir();
}
