/* SPDX-License-Identifier: MIT
 *
 * Checks colours, position and size of images drawn on panels of every pixel
 * layout.
 */
#include "support/rng.h"
#include "panel/panel.h"
#include "support/test.h"

static struct glint_error error;
static struct glint_panel panel;

static const struct glint_pixel_layout xrgb8888 = {
    4, {16, 8}, {8, 8}, {0, 8}, {0, 0}};

/* Opens PANEL with WIDTH x HEIGHT pixels for images of IMAGE_WIDTH x
 * IMAGE_HEIGHT. */
static void open_panel(int width, int height, struct glint_pixel_layout layout,
                       int image_width, int image_height,
                       enum glint_panel_fit fit)
{
    const struct glint_panel_config cfg = {width,       height,       layout,
                                           image_width, image_height, fit};

    assert_ok(glint_panel_open(&panel, &cfg, &error));
}

/* ------------------------------------------------------------ YCbCr to RGB */

/* Coefficients of the standards for YCbCr to RGB, full range, 6 digits: Cr to
 * R', Cb to G', Cr to G', Cb to B'. */
static const double constants[2][4] = {
    [GLINT_MATRIX_BT601] = {1.402, -.344136, -.714136, 1.772},
    [GLINT_MATRIX_BT709] = {1.5748, -.187324, -.468124, 1.8556},
};

static int round_and_clamp_code(double code)
{
    return (int)floor(fmin(fmax(code, 0), 255) + .5);
}

static void compute_rgb_of_ycc(int rgb[3], const struct glint_image *image,
                               double luma, double cb, double cr)
{
    const bool full = image->range == GLINT_RANGE_FULL;
    const double *const k = constants[image->matrix];
    const double y = full ? luma : (luma - 16) * 255 / 219;
    const double u = full ? cb - 128 : (cb - 128) * 255 / 224;
    const double v = full ? cr - 128 : (cr - 128) * 255 / 224;

    rgb[0] = round_and_clamp_code(y + k[0] * v);
    rgb[1] = round_and_clamp_code(y + k[1] * u + k[2] * v);
    rgb[2] = round_and_clamp_code(y + k[3] * u);
}

struct tally {
    long n, n_equal;
    int worst;
};

/* Converts a row of all luma codes with chroma (CB, CR), compares each pixel
 * with compute_rgb_of_ycc(), and adds the differences to the tally T. */
static void check_row_of_all_luma_codes(struct tally *t,
                                        struct glint_row_rgb *row,
                                        struct glint_image *image, int cb,
                                        int cr)
{
    memset(image->plane[1], cb, 256);
    memset(image->plane[2], cr, 256);
    glint_row_rgb_read(row, image, 0, 0, 256);
    for (int y = 0; y < 256; y++) {
        int want[3];

        compute_rgb_of_ycc(want, image, y, cb, cr);
        for (int i = 0; i < 3; i++) {
            const int off = abs(row->channel[i][y] - want[i]);

            t->n++;
            t->n_equal += off == 0;
            t->worst = off > t->worst ? off : t->worst;
            if (cb == 128 && cr == 128)
                /* Greys are converted without an error. */
                assert_int_equal(off, 0);
        }
    }
}

static void check_ycc_to_rgb_conversion(enum glint_matrix matrix,
                                        enum glint_range range)
{
#ifdef GLINT_SANITIZED
    enum { STEP = 4 };
#else
    enum { STEP = 1 };
#endif
    static uint8_t mem[8192], codes[3 * 256];
    struct glint_image image = glint_image_over(codes, GLINT_I444, 256, 1);
    struct glint_row_rgb row;
    struct tally t = {0, 0, 0};

    assert_true(glint_row_rgb_bytes(256) <= sizeof mem);
    image.range = range;
    image.matrix = matrix;
    glint_row_rgb_init(&row, mem, 256);
    for (int i = 0; i < 256; i++)
        codes[i] = (uint8_t)i;
    for (int cb = 0; cb < 256; cb += STEP)
        for (int cr = 0; cr < 256; cr += STEP)
            check_row_of_all_luma_codes(&t, &row, &image, cb, cr);
    print_message("matrix %d range %d: %.3f %% equal, worst %d\n", matrix,
                  range, 100. * (double)t.n_equal / (double)t.n, t.worst);
    assert_int_equal(t.worst, 1);
    assert_true(t.n_equal > t.n / 1000 * 996);
}

TEST(every_colour_is_converted_right)
{
    check_ycc_to_rgb_conversion(GLINT_MATRIX_BT601, GLINT_RANGE_FULL);
    check_ycc_to_rgb_conversion(GLINT_MATRIX_BT601, GLINT_RANGE_LIMITED);
    check_ycc_to_rgb_conversion(GLINT_MATRIX_BT709, GLINT_RANGE_FULL);
    check_ycc_to_rgb_conversion(GLINT_MATRIX_BT709, GLINT_RANGE_LIMITED);
}

/* ---------------------------------------------------------- panel layouts */

/* Panel layouts, with the words expected for red, green, blue, white, black
 * and mid grey. */
static const struct layout_case {
    const char *name;
    struct glint_pixel_layout layout;
    uint32_t word[6];
} layouts[] = {
    {"xrgb8888",
     {4, {16, 8}, {8, 8}, {0, 8}, {0, 0}},
     {0xff0000, 0xff00, 0xff, 0xffffff, 0, 0x808080}},
    {"argb8888",
     {4, {16, 8}, {8, 8}, {0, 8}, {24, 8}},
     {0xffff0000, 0xff00ff00, 0xff0000ff, 0xffffffff, 0xff000000, 0xff808080}},
    {"abgr8888",
     {4, {0, 8}, {8, 8}, {16, 8}, {24, 8}},
     {0xff0000ff, 0xff00ff00, 0xffff0000, 0xffffffff, 0xff000000, 0xff808080}},
    {"rgba8888",
     {4, {24, 8}, {16, 8}, {8, 8}, {0, 8}},
     {0xff0000ff, 0xff00ff, 0xffff, 0xffffffff, 0xff, 0x808080ff}},
    {"rgba with one bit of alpha",
     {4, {24, 8}, {16, 8}, {8, 8}, {7, 1}},
     {0xff000080, 0xff0080, 0xff80, 0xffffff80, 0x80, 0x80808080}},
    {"rgb888",
     {3, {16, 8}, {8, 8}, {0, 8}, {0, 0}},
     {0xff0000, 0xff00, 0xff, 0xffffff, 0, 0x808080}},
    {"bgr888",
     {3, {0, 8}, {8, 8}, {16, 8}, {0, 0}},
     {0xff, 0xff00, 0xff0000, 0xffffff, 0, 0x808080}},
    {"rgb565",
     {2, {11, 5}, {5, 6}, {0, 5}, {0, 0}},
     {0xf800, 0x07e0, 0x001f, 0xffff, 0, 0x8410}},
    {"bgr565",
     {2, {0, 5}, {5, 6}, {11, 5}, {0, 0}},
     {0x001f, 0x07e0, 0xf800, 0xffff, 0, 0x8410}},
    {"xrgb1555",
     {2, {10, 5}, {5, 5}, {0, 5}, {0, 0}},
     {0x7c00, 0x03e0, 0x001f, 0x7fff, 0, 0x4210}},
    {"argb1555",
     {2, {10, 5}, {5, 5}, {0, 5}, {15, 1}},
     {0xfc00, 0x83e0, 0x801f, 0xffff, 0x8000, 0xc210}},
    {"argb4444",
     {2, {8, 4}, {4, 4}, {0, 4}, {12, 4}},
     {0xff00, 0xf0f0, 0xf00f, 0xffff, 0xf000, 0xf888}},
    {"xrgb2101010",
     {4, {20, 10}, {10, 10}, {0, 10}, {30, 2}},
     {0xfff00000, 0xc00ffc00, 0xc00003ff, 0xffffffff, 0xc0000000, 0xe0280a02}},
    {"18 bits in 24",
     {3, {12, 6}, {6, 6}, {0, 6}, {0, 0}},
     {0x3f000, 0xfc0, 0x3f, 0x3ffff, 0, 0x20820}},
};

static uint32_t read_panel_word(const uint8_t *px, int bytes)
{
    uint32_t word = 0;

    for (int i = 0; i < bytes; i++)
        word |= (uint32_t)px[i] << 8 * i;
    return word;
}

static void expect_panel_words(const struct layout_case *c, const uint8_t *mem)
{
    static const uint32_t beyond = 0xa5a5a5a5;
    const int bytes = c->layout.bytes;

    for (int i = 0; i < 6; i++)
        if (read_panel_word(mem + i * bytes, bytes) != c->word[i])
            fail_msg("%s: bar %d is %08x", c->name, i,
                     (unsigned)read_panel_word(mem + i * bytes, bytes));
    assert_memory_equal(mem + 6 * bytes, &beyond, 4);
}

TEST(writes_every_pixel_layout)
{
    static uint8_t bars[] = {255, 0,   0,   0, 255, 0, 0,   0,   255,
                             255, 255, 255, 0, 0,   0, 128, 128, 128};
    struct glint_image image = glint_image_over(bars, GLINT_RGB24, 6, 1);

    for (size_t i = 0; i < sizeof layouts / sizeof *layouts; i++) {
        const int bytes = layouts[i].layout.bytes;
        uint8_t mem[28];

        open_panel(6, 1, layouts[i].layout, 6, 1, GLINT_PANEL_FIT);
        memset(mem, 0xa5, sizeof mem);
        glint_panel_draw(&panel, &image, mem, 6 * bytes);
        expect_panel_words(&layouts[i], mem);
        glint_panel_clear(&panel, mem, 6 * bytes);
        assert_int_equal(read_panel_word(mem + 5 * bytes, bytes),
                         layouts[i].word[4]);
        glint_panel_close(&panel);
    }
}

/* Checks that RGB565 codes are unchanged on a panel of 16 bits, although they
 * are widened to 8 bits per channel in between. */
TEST(writes_565_there_and_back)
{
    static uint8_t codes[2 * 65536], mem[2 * 65536];
    const struct glint_pixel_layout rgb565 = {
        2, {11, 5}, {5, 6}, {0, 5}, {0, 0}};
    struct glint_image image = glint_image_over(codes, GLINT_RGB565, 256, 256);

    for (int i = 0; i < 65536; i++) {
        codes[2 * i] = (uint8_t)(i & 255);
        codes[2 * i + 1] = (uint8_t)(i >> 8);
    }
    open_panel(256, 256, rgb565, 256, 256, GLINT_PANEL_FIT);
    glint_panel_draw(&panel, &image, mem, 512);
    assert_memory_equal(mem, codes, sizeof mem);
    glint_panel_close(&panel);
}

/* Checks that each 8-bit code becomes the nearest code of a panel with 1 .. 8
 * bits. */
TEST(codes_become_the_nearest_of_fewer_bits)
{
    uint8_t ramp[256], mem[2 * 256];

    for (int i = 0; i < 256; i++)
        ramp[i] = (uint8_t)i;
    for (int n = 1; n <= 8; n++) {
        const struct glint_pixel_layout layout = {
            2, {0, n}, {n, 4}, {15, 1}, {0, 0}};
        const uint8_t *const channel[] = {ramp, ramp, ramp};
        uint8_t work[8 * 256 + 4096];
        struct glint_row_pack pack;

        assert_true(glint_pixel_layout_is_valid(&layout));
        assert_true(glint_row_pack_bytes(256) <= sizeof work);
        glint_row_pack_init(&pack, &layout, work, 256);
        glint_row_pack_write(&pack, mem, channel, 256);
        for (int i = 0; i < 256; i++) {
            const int most = (1 << n) - 1;
            const int got = (int)read_panel_word(mem + 2 * i, 2) & most;

            assert_int_equal(got, (int)floor(i * most / 255. + .5));
        }
    }
}

TEST(rejects_invalid_layouts)
{
    static const struct glint_pixel_layout bad[] = {
        {1, {5, 3}, {2, 3}, {0, 2}, {0, 0}},  /* 8 bits per pixel */
        {5, {16, 8}, {8, 8}, {0, 8}, {0, 0}}, /* 40 bits per pixel */
        /* red lies above the highest bit of the word */
        {2, {16, 8}, {8, 8}, {0, 8}, {0, 0}},
        {4, {16, 8}, {12, 8}, {0, 8}, {0, 0}}, /* green overlaps red */
        {4, {16, 8}, {8, 8}, {0, 8}, {20, 8}}, /* alpha overlaps blue */
        {4, {16, 8}, {8, 8}, {0, 0}, {0, 0}},  /* no blue */
        {4, {-1, 8}, {8, 8}, {16, 8}, {0, 0}}, /* red lies below bit 0 */
        /* alpha lies above the highest bit of the word */
        {4, {16, 8}, {8, 8}, {0, 8}, {28, 8}},
        {4, {16, 2000}, {8, 8}, {0, 8}, {28, 8}}, /* red is 2000 bits wide */
    };
    struct glint_panel_config cfg = {.width = 8,
                                     .height = 8,
                                     .layout = xrgb8888,
                                     .image_width = 8,
                                     .image_height = 8};

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        cfg.layout = bad[i];
        assert_int_equal(glint_panel_open(&panel, &cfg, &error),
                         GLINT_E_UNSUPPORTED);
        assert_null(panel.mem);
    }
    cfg.layout = xrgb8888;
    cfg.width = 0;
    assert_int_equal(glint_panel_open(&panel, &cfg, &error),
                     GLINT_E_UNSUPPORTED);
    cfg.width = 8;
    cfg.image_height = GLINT_MAX_SIDE + 1;
    assert_int_equal(glint_panel_open(&panel, &cfg, &error),
                     GLINT_E_UNSUPPORTED);
    glint_panel_close(&panel);
}

/* ------------------------------------------------------------------ formats */

/* Returns an image of random codes in FORMAT, whose memory the caller frees.
 * Rows have |PAD| bytes of padding. If PAD is negative, the bottom row is
 * stored first. */
static uint8_t *make_random_picture(struct glint_image *image,
                                    enum glint_pixel_format format, int width,
                                    int height, int pad)
{
    const size_t bytes = glint_image_bytes(format, width, height) +
                         3 * (size_t)(abs(pad) * height);
    uint8_t *const mem = malloc(bytes);
    uint8_t *at = mem;
    uint32_t seed = 5;

    assert_non_null(mem);
    for (size_t i = 0; i < bytes; i++)
        mem[i] = (uint8_t)(rng_bits32(&seed) >> 8);
    *image = (struct glint_image){.format = format,
                                  .width = width,
                                  .height = height,
                                  .range = GLINT_RANGE_LIMITED,
                                  .matrix = GLINT_MATRIX_BT709};
    for (int i = 0; i < glint_image_planes(format); i++) {
        const ptrdiff_t stride =
            (ptrdiff_t)glint_image_row_bytes(format, i, width) + abs(pad);
        const int rows = glint_image_plane_height(format, i, height);

        image->plane[i] = pad < 0 ? at + (rows - 1) * stride : at;
        image->stride_bytes[i] = pad < 0 ? -stride : stride;
        at += rows * stride;
    }
    return mem;
}

/* Returns Y', Cb or Cr (I = 0, 1, 2) of pixel (X, Y), read as the image's
 * format defines. */
static int read_picture_sample(const struct glint_image *im, int i, int x,
                               int y)
{
    const uint8_t *row[3];

    for (int k = 0; k < glint_image_planes(im->format); k++)
        row[k] =
            im->plane[k] +
            (k && glint_image_plane_height(im->format, 1, 4) == 2 ? y / 2 : y) *
                im->stride_bytes[k];
    switch (im->format) {
    case GLINT_YUYV:
        return row[0][i == 0 ? 2 * x : 4 * (x / 2) + (i == 1 ? 1 : 3)];
    case GLINT_UYVY:
        return row[0][i == 0 ? 2 * x + 1 : 4 * (x / 2) + (i == 1 ? 0 : 2)];
    case GLINT_NV12:
        return i == 0 ? row[0][x] : row[1][x / 2 * 2 + (i == 1 ? 0 : 1)];
    case GLINT_NV21:
        return i == 0 ? row[0][x] : row[1][x / 2 * 2 + (i == 1 ? 1 : 0)];
    case GLINT_I420:
    case GLINT_I422:
        return row[i][i ? x / 2 : x];
    case GLINT_I444:
        return row[i][x];
    case GLINT_GREY:
        return i ? 128 : row[0][x];
    default:
        fail();
        return 0;
    }
}

static void compute_panel_pixel(int rgb[3], const struct glint_image *im, int x,
                                int y)
{
    const uint8_t *const row = im->plane[0] + y * im->stride_bytes[0];

    switch (im->format) {
    case GLINT_RGB24:
        for (int i = 0; i < 3; i++)
            rgb[i] = row[3 * x + i];
        return;
    case GLINT_BGR24:
        for (int i = 0; i < 3; i++)
            rgb[i] = row[3 * x + 2 - i];
        return;
    case GLINT_XRGB8888:
        for (int i = 0; i < 3; i++)
            rgb[i] = row[4 * x + 2 - i];
        return;
    case GLINT_XBGR8888:
        for (int i = 0; i < 3; i++)
            rgb[i] = row[4 * x + i];
        return;
    case GLINT_RGB565: {
        const int word = row[2 * x] | row[2 * x + 1] << 8;

        /* This conversion by definition differs by at most 1 from widening a
         * code by repeating its bits. */
        rgb[0] = (word >> 11) * 255 / 31;
        rgb[1] = (word >> 5 & 63) * 255 / 63;
        rgb[2] = (word & 31) * 255 / 31;
        return;
    }
    default:
        compute_rgb_of_ycc(rgb, im, read_picture_sample(im, 0, x, y),
                           read_picture_sample(im, 1, x, y),
                           read_picture_sample(im, 2, x, y));
    }
}

static void expect_panel_pixel(const struct glint_image *im, int from_x,
                               int from_y, const uint8_t *px)
{
    int want[3];

    compute_panel_pixel(want, im, from_x, from_y);
    for (int i = 0; i < 3; i++)
        if (abs(px[2 - i] - want[i]) > 1)
            fail_msg("format %d, %d x %d, pixel %d %d, channel %d: %d, not %d",
                     im->format, im->width, im->height, from_x, from_y, i,
                     px[2 - i], want[i]);
}

static void check_drawing_of_format(enum glint_pixel_format format, int width,
                                    int height, int pad, int panel_width)
{
    const int stride = 4 * panel_width;
    uint8_t *const mem = test_free_later(malloc((size_t)(stride * height)));
    struct glint_image image;
    uint8_t *const codes =
        make_random_picture(&image, format, width, height, pad);

    open_panel(panel_width, height, xrgb8888, width, height,
               GLINT_PANEL_CENTRE);
    glint_panel_clear(&panel, mem, stride);
    glint_panel_draw(&panel, &image, mem, stride);
    for (int y = 0; y < panel.shown.height; y++)
        for (int x = 0; x < panel.shown.width; x++)
            expect_panel_pixel(&image, panel.seen.x + x, panel.seen.y + y,
                               mem + y * stride + 4 * (panel.shown.x + x));
    glint_panel_close(&panel);
    free(codes);
}

/* Checks that every format is drawn correctly. Each image has exactly its size
 * allocated, so that ASan detects overreads. */
TEST(draws_every_format)
{
    for (int f = GLINT_RGB24; f <= GLINT_XBGR8888; f++) {
        const enum glint_pixel_format format = (enum glint_pixel_format)f;

        if (format == GLINT_LINEAR_Q20)
            continue;
        check_drawing_of_format(format, 64, 4, 0, 64);
        check_drawing_of_format(format, 101, 3, 0,
                                101); /* odd width and height */
        check_drawing_of_format(format, 1, 1, 0, 1);
        check_drawing_of_format(format, 37, 5, 11, 37);
        check_drawing_of_format(format, 37, 5, -3, 37);
        /* The image is cropped, from an odd pixel on. */
        check_drawing_of_format(format, 66, 3, 0, 63);
        check_drawing_of_format(format, 33, 3, 0,
                                70); /* centred on a wider panel */
    }
}

/* ---------------------------------------------------- scaling and position */

TEST(image_areas_fit_the_panel)
{
    static const struct {
        int panel[2], image[2];
        enum glint_panel_fit fit;
        struct {
            int x, y, width, height;
        } shown;
    } rows[] = {
        {{640, 480}, {640, 480}, GLINT_PANEL_FIT, {0, 0, 640, 480}},
        {{480, 320}, {640, 360}, GLINT_PANEL_FIT, {0, 25, 480, 270}},
        {{800, 480}, {640, 480}, GLINT_PANEL_FIT, {80, 0, 640, 480}},
        {{1366, 768}, {640, 480}, GLINT_PANEL_FIT, {171, 0, 1024, 768}},
        {{320, 240}, {1, 8192}, GLINT_PANEL_FIT, {159, 0, 1, 240}},
        {{1, 240}, {8192, 1}, GLINT_PANEL_FIT, {0, 119, 1, 1}},
        {{800, 480}, {640, 360}, GLINT_PANEL_CENTRE, {80, 60, 640, 360}},
        {{480, 320}, {640, 360}, GLINT_PANEL_CENTRE, {0, 0, 480, 320}},
    };

    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        open_panel(rows[i].panel[0], rows[i].panel[1], xrgb8888,
                   rows[i].image[0], rows[i].image[1], rows[i].fit);
        if (memcmp(&panel.shown, &rows[i].shown, sizeof panel.shown) != 0)
            fail_msg("%d x %d on %d x %d: at %d, %d, %d x %d", rows[i].image[0],
                     rows[i].image[1], rows[i].panel[0], rows[i].panel[1],
                     panel.shown.x, panel.shown.y, panel.shown.width,
                     panel.shown.height);
        glint_panel_close(&panel);
    }
}

/* Draws the grey ramp 0 .. 8 and stores the code of each panel pixel in SHOWN.
 * The ramp is an image of 9 x 1 pixels, or of 3 x 3 pixels if DOWN is set. */
static void draw_and_read_grey_ramp(uint8_t *shown, bool down, int panel_width,
                                    int panel_height, int bytes)
{
    static uint8_t ramp[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    const int width = down ? 3 : 9, height = down ? 3 : 1;
    struct glint_image image =
        glint_image_over(ramp, GLINT_GREY, width, height);
    const int stride = bytes * panel_width;
    uint8_t mem[4 * 256];

    open_panel(
        panel_width, panel_height,
        (struct glint_pixel_layout){bytes, {0, 8}, {8, 4}, {12, 4}, {0, 0}},
        width, height, GLINT_PANEL_FIT);
    memset(mem, 99, sizeof mem);
    glint_panel_draw(&panel, &image, mem, stride);
    for (int i = 0; i < panel_width * panel_height; i++)
        shown[i] = mem[i * bytes];
    glint_panel_close(&panel);
}

TEST(scales_by_nearest_pixel)
{
    static const uint8_t third[] = {1, 4, 7},
                         twice[] = {0, 0, 1, 1, 2, 2, 3, 3, 4,
                                    4, 5, 5, 6, 6, 7, 7, 8, 8},
                         square[] = {0, 0, 1, 1, 2, 2, 0, 0, 1, 1, 2, 2,
                                     3, 3, 4, 4, 5, 5, 3, 3, 4, 4, 5, 5,
                                     6, 6, 7, 7, 8, 8, 6, 6, 7, 7, 8, 8};
    uint8_t shown[36];

    for (int bytes = 2; bytes <= 4; bytes++) {
        draw_and_read_grey_ramp(shown, false, 3, 1, bytes);
        assert_memory_equal(shown, third, sizeof third);
        draw_and_read_grey_ramp(shown, false, 18, 2, bytes);
        assert_memory_equal(shown, twice, sizeof twice);
        assert_memory_equal(shown + 18, twice, sizeof twice);
        draw_and_read_grey_ramp(shown, true, 6, 6, bytes);
        assert_memory_equal(shown, square, sizeof square);
    }
}

/* Checks that neither bytes around the image nor the padding of rows are
 * written. */
TEST(writes_only_inside_the_image_area)
{
    enum { STRIDE = 53, ROWS = 12 };
    const struct glint_pixel_layout rgb888 = {
        3, {16, 8}, {8, 8}, {0, 8}, {0, 0}};
    uint8_t codes[15], mem[STRIDE * ROWS];
    struct glint_image image = glint_image_over(codes, GLINT_GREY, 5, 3);

    memset(codes, 77, sizeof codes);
    memset(mem, 200, sizeof mem);
    open_panel(16, ROWS, rgb888, 5, 3, GLINT_PANEL_CENTRE);
    glint_panel_draw(&panel, &image, mem, STRIDE);
    for (int i = 0; i < STRIDE * ROWS; i++) {
        const int x = i % STRIDE / 3, y = i / STRIDE;
        const bool inside = x >= 5 && x < 10 && y >= 4 && y < 7;

        assert_int_equal(mem[i], inside ? 77 : 200);
    }
    glint_panel_clear(&panel, mem, STRIDE);
    for (int i = 0; i < STRIDE * ROWS; i++)
        assert_int_equal(mem[i], i % STRIDE < 48 ? 0 : 200);
    glint_panel_close(&panel);
}
