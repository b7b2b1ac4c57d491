/* SPDX-License-Identifier: MIT
 *
 * expected LAYOUT WxH VIDEO OUT [scale|centre]
 *     Writes OUT, a PPM of what a panel of LAYOUT shows of the last frame of a
 *     y4m video.
 * expected yuyv WxH VIDEO OUT
 *     Writes this frame, C422, as a camera sends it.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "layout.h"
#include "panel/panel.h"
#include "video/y4m.h"

static void exit_with_error(const char *why)
{
    fprintf(stderr, "expected: %s\n", why);
    exit(2);
}

static struct glint_pixel_layout convert_to_pixel_layout(const struct layout *l)
{
    struct glint_pixel_layout p = {
        .bytes = (int)l->n_bytes,
        .red = {(int)l->offset[0], (int)l->length[0]},
        .green = {(int)l->offset[1], (int)l->length[1]},
        .blue = {(int)l->offset[2], (int)l->length[2]}};

    return p;
}

/* Writes a pixel with 8 bits per channel, like the screenshots of the
 * emulator. */
static void write_rgb_pixel(const struct layout *l, const uint8_t *at,
                            FILE *file)
{
    uint32_t word = 0;

    for (unsigned i = 0; i < l->n_bytes; i++)
        word |= (uint32_t)at[i] << (8 * i);
    for (unsigned c = 0; c < 3; c++)
        putc(shown(l, c, word >> l->offset[c] & ((1u << l->length[c]) - 1)),
             file);
}

static void write_yuyv_frame(const struct glint_image *frame, FILE *file)
{
    for (int y = 0; y < frame->height; y++) {
        const uint8_t *row[3];

        for (int p = 0; p < 3; p++)
            row[p] = frame->plane[p] + y * frame->stride_bytes[p];
        for (int x = 0; x < frame->width; x++) {
            putc(row[0][x], file);
            putc(row[1 + x % 2][x / 2], file);
        }
    }
}

static void write_panel_screen(const struct glint_image *frame, int w, int h,
                               const struct layout *layout,
                               enum glint_panel_fit fit, FILE *file)
{
    const ptrdiff_t stride = (ptrdiff_t)layout->n_bytes * w;
    const struct glint_panel_config cfg = {.width = w,
                                           .height = h,
                                           .layout =
                                               convert_to_pixel_layout(layout),
                                           .image_width = frame->width,
                                           .image_height = frame->height,
                                           .fit = fit};
    struct glint_error error;
    struct glint_panel panel;
    uint8_t *mem = malloc((size_t)stride * (size_t)h);

    if (!mem)
        exit_with_error("out of memory");
    if (glint_panel_open(&panel, &cfg, &error) != GLINT_OK)
        exit_with_error(error.text);
    glint_panel_clear(&panel, mem, stride);
    glint_panel_draw(&panel, frame, mem, stride);
    fprintf(file, "P6\n%d %d\n255\n", w, h);
    for (size_t i = 0; i < (size_t)w * (size_t)h; i++)
        write_rgb_pixel(layout, mem + i * layout->n_bytes, file);
    free(mem);
    glint_panel_close(&panel);
}

int main(int argc, char **argv)
{
    struct glint_error error = {""};
    const struct glint_image *frame = NULL, *next;
    struct glint_y4m_reader in;
    struct layout layout = {0};
    bool yuyv, centre;
    int w, h;
    FILE *file;

    yuyv = argc > 1 && strcmp(argv[1], "yuyv") == 0;
    centre = argc > 5 && strcmp(argv[5], "centre") == 0;
    if (argc < 5 || (!yuyv && !layout_of(argv[1], &layout)) ||
        sscanf(argv[2], "%dx%d", &w, &h) != 2)
        exit_with_error("see the head of expected.c");
    if (glint_y4m_reader_open(&in, argv[3], &error) != GLINT_OK)
        exit_with_error(error.text);
    while (glint_y4m_reader_next(&in, &next, &error) == GLINT_OK && next)
        frame = next; /* The reader uses the same memory for each frame. */
    if (!frame || *error.text)
        exit_with_error(*error.text ? error.text : "the video has no frame");
    if (yuyv && (frame->format != GLINT_I422 || frame->width != w ||
                 frame->height != h))
        exit_with_error("the video is not C422 of that size");
    file = fopen(argv[4], "wb");
    if (!file)
        exit_with_error("cannot write the output");
    if (yuyv)
        write_yuyv_frame(frame, file);
    else
        write_panel_screen(frame, w, h, &layout,
                           centre ? GLINT_PANEL_CENTRE : GLINT_PANEL_FIT, file);
    glint_y4m_reader_close(&in);
    return fclose(file) == 0 ? 0 : 1;
}
