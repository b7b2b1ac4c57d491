/* SPDX-License-Identifier: MIT
 *
 * bars [/dev/fbN] - draws eight colour bars over ramps of red, green and blue
 *     by the bit fields that the driver reports.
 * bars LAYOUT WxH - writes a PPM of the image that a panel of LAYOUT (r5g6b5,
 *     x8r8g8b8 ...) must then show; needs no device.
 */
#include <linux/fb.h>
#include <sys/mman.h>

#include "device.h"
#include "layout.h"

/* Returns channel C, 0 .. 255, of the bars at (X, Y). The bars go from white to
 * black by decreasing luma. */
static uint32_t find_bar_colour(unsigned x, unsigned y, unsigned width,
                                unsigned height, unsigned c)
{
    static const unsigned bit[3] = {2, 4, 1};
    unsigned top = height * 3 / 4;
    if (y < top)
        return (7 - x * 8 / width) & bit[c] ? 255 : 0;
    return (y - top) * 3 / (height - top) == c ? x * 256 / width : 0;
}

static void write_bar_pixel(uint8_t *dst, const struct fb_var_screeninfo *var,
                            unsigned x, unsigned y)
{
    const struct fb_bitfield *field[3] = {&var->red, &var->green, &var->blue};
    uint32_t pixel = 0;
    if (var->transp.length)
        pixel = ((1u << var->transp.length) - 1) << var->transp.offset;
    for (unsigned c = 0; c < 3; c++)
        pixel |= find_bar_colour(x, y, var->xres, var->yres, c) >>
                 (8 - field[c]->length) << field[c]->offset;
    for (unsigned i = 0; i < var->bits_per_pixel / 8; i++)
        dst[i] = (uint8_t)(pixel >> 8 * i);
}

static void draw_colour_bars(const char *path)
{
    struct fb_var_screeninfo var;
    struct fb_fix_screeninfo fix;
    int fd = open_device(path);
    must_ioctl(fd, FBIOGET_VSCREENINFO, &var, "FBIOGET_VSCREENINFO");
    must_ioctl(fd, FBIOGET_FSCREENINFO, &fix, "FBIOGET_FSCREENINFO");
    printf("%s: %ux%u, %u bits, red %u+%u green %u+%u blue %u+%u, %u a line\n",
           fix.id, var.xres, var.yres, var.bits_per_pixel, var.red.offset,
           var.red.length, var.green.offset, var.green.length, var.blue.offset,
           var.blue.length, fix.line_length);
    if (fix.visual != FB_VISUAL_TRUECOLOR)
        die("not true colour");
    uint8_t *memory =
        mmap(NULL, fix.smem_len, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (memory == MAP_FAILED)
        die("mmap: %s", strerror(errno));
    for (unsigned y = 0; y < var.yres; y++)
        for (unsigned x = 0; x < var.xres; x++)
            write_bar_pixel(memory + (size_t)y * fix.line_length +
                                x * (var.bits_per_pixel / 8),
                            &var, x, y);
}

static void write_expected_image(const char *name, const char *size)
{
    struct layout layout;
    unsigned width, height;
    size_of(size, &width, &height);
    if (!layout_of(name, &layout))
        die("%s: no such layout", name);
    printf("P6\n%u %u\n255\n", width, height);
    for (unsigned y = 0; y < height; y++)
        for (unsigned x = 0; x < width; x++)
            for (unsigned c = 0; c < 3; c++)
                putchar(shown(&layout, c,
                              find_bar_colour(x, y, width, height, c) >>
                                  (8 - layout.length[c])));
}

int main(int argc, char **argv)
{
    if (argc == 3)
        write_expected_image(argv[1], argv[2]);
    else
        draw_colour_bars(argc == 2 ? argv[1] : "/dev/fb0");
    return 0;
}
