/* SPDX-License-Identifier: MIT
 *
 * Tests adding light that a program computed itself to an image: it is added
 * in linear light as defined, in every format and size, and changes nothing
 * else.
 */
#include "glint/composite.h"
#include "glint/kernels.h"
#include "support/canvas.h"
#include "support/test.h"

enum { MOST = 150, N_MOST = MOST * MOST };

static uint16_t light[3][N_MOST];

/* Returns a layer with a lamp near (30, 20) that has different light in R, G
 * and B. From column 100 on it has no light. */
static struct glint_layer make_lamp_layer(int width, int height)
{
    static const int most[3] = {65535, 30000, 900};

    for (int c = 0; c < 3; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const int r2 = (x - 30) * (x - 30) + (y - 20) * (y - 20);

                light[c][y * MOST + x] =
                    (uint16_t)(x < 100 ? most[c] / (1 + r2 / 16) : 0);
            }
    return (struct glint_layer){{light[0], light[1], light[2]}, MOST};
}

static struct glint_composite *create_composite(const struct glint_image *image,
                                                unsigned sets, void **mem)
{
    const size_t bytes = glint_composite_bytes();
    struct glint_composite *c;

    assert_int_equal(posix_memalign(mem, 64, bytes), 0);
    assert_ok(glint_composite_init(&c, image, sets, 0, *mem, bytes));
    return c;
}

static void add_layer_to_image(const struct glint_image *image, unsigned sets)
{
    const struct glint_layer layer =
        make_lamp_layer(image->width, image->height);
    void *mem;

    glint_composite_add(create_composite(image, sets, &mem), image, &layer);
    free(mem);
}

TEST(composite_matches_its_definition)
{
    static uint8_t rgb[3 * N_MOST];
    struct glint_image image = {
        .format = GLINT_RGB24, .width = 131, .height = 77};

    for (int code = 0; code < 256; code += 15) {
        memset(rgb, code, sizeof rgb);
        glint_image_place(&image, rgb);
        add_layer_to_image(&image, 0);
        for (int y = 0; y < 77; y++)
            for (int x = 0; x < 131; x++)
                for (int c = 0; c < 3; c++) {
                    const double want = canvas_encode_srgb_exactly(
                        canvas_decode_srgb(code) +
                        light[c][y * MOST + x] / 65535.0);

                    assert_true(fabs(rgb[3 * (131 * y + x) + c] - want) < 0.65);
                    if (light[c][y * MOST + x] == 0)
                        assert_int_equal(rgb[3 * (131 * y + x) + c], code);
                }
    }
}

/* Checks that the image is bit-identical with all instruction sets, and that
 * pixels without light and guard bytes are unchanged. */
TEST(all_instruction_sets_give_the_same_bits)
{
    enum { GUARD = 256, BYTES = 3 * N_MOST + 2 * GUARD };
    static uint8_t plain[BYTES], fast[BYTES];

    for (int format = GLINT_RGB24; format <= GLINT_RGB565; format++) {
        if (format == GLINT_LINEAR_Q20 || format == GLINT_XRGB8888)
            continue;
        for (int size = 1; size < MOST; size += 1 + size / 2) {
            struct glint_image image = {.format =
                                            (enum glint_pixel_format)format,
                                        .width = size,
                                        .height = MOST - size};
            const size_t bytes =
                glint_image_bytes(image.format, image.width, image.height);
            int changed = 0;

            memset(plain, 99, sizeof plain);
            memset(fast, 99, sizeof fast);
            glint_image_place(&image, plain + GUARD);
            add_layer_to_image(&image, 0);
            glint_image_place(&image, fast + GUARD);
            add_layer_to_image(&image, glint_sets_here());
            assert_memory_equal(plain, fast, sizeof plain);
            for (size_t i = 0; i < BYTES; i++) {
                changed += plain[i] != 99;
                if (i < GUARD || i >= GUARD + bytes)
                    assert_int_equal(plain[i], 99);
            }
            assert_true(changed > 0);
        }
    }
}

TEST(rejects_images_that_cannot_be_composited)
{
    const struct glint_image linear = {
        .format = GLINT_LINEAR_Q20, .width = 8, .height = 8};
    const struct glint_image image = {
        .format = GLINT_YUYV, .width = 8, .height = 8};
    const size_t bytes = glint_composite_bytes();
    struct glint_composite *c;
    void *mem;

    assert_int_equal(posix_memalign(&mem, 64, bytes), 0);
    assert_int_equal(glint_composite_init(&c, &linear, 0, 0, mem, bytes),
                     GLINT_E_ARGUMENT);
    assert_int_equal(
        glint_composite_init(&c, &image, 0, 0, (char *)mem + 8, bytes),
        GLINT_E_ARGUMENT);
    assert_int_equal(glint_composite_init(&c, &image, 0, 0, mem, bytes - 1),
                     GLINT_E_MEMORY);
    assert_ok(glint_composite_init(&c, &image, 0, 0, mem, bytes));
    free(mem);
}
