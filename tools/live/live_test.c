/* SPDX-License-Identifier: MIT */
#include "live/live_test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/paint.h"
#include "posix/error.h"

enum { HOUSES = 14, DARKEST = 22, BRIGHTEST = 235 };

/* Returns a hash of X. */
static uint32_t mixed(uint32_t x)
{
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/* Draws house number HOUSE from the bottom up, some of its windows lit, none so
 * bright that it would count as a lamp. */
static void build_house(struct live_test *s, int house)
{
    const int w = s->image.width, h = s->image.height;
    const int left = house * w / HOUSES, right = (house + 1) * w / HOUSES;
    const int tall = h / 5 + (int)(mixed((uint32_t)house + 7) % 100) * h / 400;
    const int pane = 2 + h / 120;

    for (int y = h - tall; y < h; y++)
        for (int x = left; x < right; x++) {
            const int column = (x - left) / (2 * pane),
                      row = (y - h + tall) / (3 * pane);
            const uint32_t bits =
                mixed((uint32_t)(house * 997 + column * 31 + row * 7));
            const int is_pane = (x - left) % (2 * pane) < pane &&
                                (y - h + tall) % (3 * pane) < 2 * pane;

            s->still[y * w + x] =
                (uint8_t)(is_pane && bits % 5 == 0 ? 70 + bits % 40 : 30);
        }
}

static void build(struct live_test *s)
{
    const int w = s->image.width, h = s->image.height;

    for (int y = 0; y < h; y++)
        memset(s->still + (size_t)y * (size_t)w, DARKEST + 14 * y / h,
               (size_t)w);
    for (int house = 0; house < HOUSES; house++)
        build_house(s, house);
}

/* Copies the still picture to the frame and adds noise of -1 to 2 codes, by the
 * seed and N. */
static void expose(struct live_test *s, int64_t n)
{
    const int w = s->image.width;
    uint32_t bits = mixed(s->seed * 2654435761u + (uint32_t)n) | 1;

    for (int y = 0; y < s->image.height; y++) {
        uint8_t *row = s->image.plane[0] + y * s->image.stride_bytes[0];
        const uint8_t *from = s->still + (size_t)y * (size_t)w;

        for (int x = 0; x < w; x++) {
            bits ^= bits << 13; /* [Marsaglia03] */
            bits ^= bits >> 17;
            bits ^= bits << 5;
            row[x] = (uint8_t)(from[x] + (bits >> 8 & 3) - 1);
        }
    }
}

/* Adds a disc of RADIUS at CX, CY, with a halo that falls with the square of
 * the distance. */
static void light(struct live_test *s, double cx, double cy, double radius)
{
    const int reach = (int)(12 * radius) + 1;

    for (int y = (int)cy - reach; y <= (int)cy + reach; y++)
        for (int x = (int)cx - reach; x <= (int)cx + reach; x++) {
            const double r = hypot(x - cx, y - cy) / radius;
            const double halo = 60 / (1 + r * r) - 60 / 145.0;
            const double add = r < 1 ? 255 : r < 2 ? 255 * (2 - r) : 0;
            uint8_t *at;
            double code;

            if (x < 0 || y < 0 || x >= s->image.width || y >= s->image.height)
                continue;
            at = s->image.plane[0] + y * s->image.stride_bytes[0] + x;
            code = *at + fmax(halo, 0) + add;
            *at = (uint8_t)(code < BRIGHTEST ? code : BRIGHTEST);
        }
}

/* Draws frame N. */
static void draw(struct live_test *s, int64_t n)
{
    const struct glint_image *i = &s->image;
    const double per_second =
        (double)s->timed.format.fps_num / s->timed.format.fps_den;
    const double turn = fmod((double)n / (8 * per_second), 1);
    const double angle = 6.283185307179586 * turn;

    if (s->is_black) {
        paint_black(i);
        return;
    }
    expose(s, n);
    for (int p = 1; p < 3; p++) /* a bluish night */
        for (int y = 0; y < glint_image_plane_height(i->format, p, i->height);
             y++)
            memset(i->plane[p] + y * i->stride_bytes[p], p == 1 ? 134 : 125,
                   glint_image_row_bytes(i->format, p, i->width));
    light(s, i->width * (0.5 + 0.32 * cos(angle)),
          i->height * (0.38 + 0.25 * sin(angle)), fmax(1.5, i->height / 120.0));
}

/* ------------------------------------------------------------------- source */

static enum glint_status next(struct glint_source *source,
                              struct glint_source_frame *frame,
                              struct glint_error *error)
{
    struct live_test *s = (struct live_test *)source;
    const uint64_t n = live_timed_due(&s->timed, frame);

    (void)error;
    if (n == 0)
        return GLINT_OK;
    s->timed.n += (int64_t)n;
    draw(s, s->timed.n - 1);
    live_timed_show(&s->timed, frame, &s->image, n);
    return GLINT_OK;
}

static void close_test(struct glint_source *source)
{
    struct live_test *s = (struct live_test *)source;

    live_timed_stop(&s->timed);
    free(s->mem);
    s->mem = NULL;
}

/* Returns the picture of frames, of limited range and without memory, in the
 * size of WISH or 640 x 360. */
static struct glint_image lay_out(const struct glint_v4l2_config *wish)
{
    const int width = wish->width ? wish->width : 640;
    const int height = wish->width ? wish->height : 360;

    return (struct glint_image){.format = GLINT_I420,
                                .width = width,
                                .height = height,
                                .range = GLINT_RANGE_LIMITED,
                                .matrix = height < 720 ? GLINT_MATRIX_BT601
                                                       : GLINT_MATRIX_BT709,
                                .transfer = GLINT_TONE_BT709};
}

static enum glint_status place(struct live_test *s)
{
    const int w = s->image.width, h = s->image.height;
    const size_t luma = (size_t)w * (size_t)h;

    s->mem = malloc(glint_image_bytes(GLINT_I420, w, h) + luma);
    if (!s->mem)
        return GLINT_E_MEMORY;
    s->still = s->mem;
    glint_image_place(&s->image, s->still + luma);
    build(s);
    return GLINT_OK;
}

enum glint_status live_test_open(struct live_test *test,
                                 const struct glint_v4l2_config *wish,
                                 uint32_t seed, bool is_black,
                                 struct glint_error *error)
{
    const struct glint_image image = lay_out(wish);

    if (image.width < 16 || image.height < 16 ||
        image.width > GLINT_PANEL_SIDE || image.height > GLINT_PANEL_SIDE)
        return glint_error_report(error, GLINT_E_UNSUPPORTED, "test",
                                  "has sides of 16 to %d pixels",
                                  GLINT_PANEL_SIDE);
    *test =
        (struct live_test){.image = image, .seed = seed, .is_black = is_black};
    if (place(test) != GLINT_OK)
        return glint_error_report(error, GLINT_E_MEMORY, "test",
                                  "no memory for %d x %d pixels", image.width,
                                  image.height);
    live_timed_init(&test->timed, &(struct glint_source_format){.image = image},
                    wish, is_black ? "black" : "a lamp over a night street");
    test->timed.source.next = next;
    test->timed.source.close = close_test;
    return GLINT_OK;
}
