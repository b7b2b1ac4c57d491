/* SPDX-License-Identifier: MIT
 *
 * expected LAYOUT WxH VIDEO OUT [scale|centre] - OUT.ppm: what a panel of these
 * pixels shows of the last frame of a y4m video.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "layout.h"
#include "plain/panel.h"
#include "plain/y4m.h"

static void die(const char *why)
{
    fprintf(stderr, "expected: %s\n", why);
    exit(2);
}

static struct glint_pixel_layout pixels_of(const struct layout *l)
{
    struct glint_pixel_layout p = {
        .bytes = (int)l->n_bytes,
        .red = {(int)l->offset[0], (int)l->length[0]},
        .green = {(int)l->offset[1], (int)l->length[1]},
        .blue = {(int)l->offset[2], (int)l->length[2]}};

    return p;
}

/* As eyes, and the emulator's picture, see it. */
static void put_pixel(const struct layout *l, const uint8_t *at, FILE *file)
{
    uint32_t word = 0;

    for (unsigned i = 0; i < l->n_bytes; i++)
        word |= (uint32_t)at[i] << (8 * i);
    for (unsigned c = 0; c < 3; c++)
        putc(shown(l, c, word >> l->offset[c] & ((1u << l->length[c]) - 1)),
             file);
}

int main(int argc, char **argv)
{
    struct glint_error error = {""};
    const struct glint_image *frame = NULL, *next;
    struct glint_panel_config cfg;
    struct glint_y4m_reader in;
    struct glint_panel panel;
    struct layout layout;
    int w, h;
    uint8_t *mem;
    FILE *file;

    if (argc < 5 || !layout_of(argv[1], &layout) ||
        sscanf(argv[2], "%dx%d", &w, &h) != 2)
        die("see the head of expected.c");
    if (glint_y4m_reader_open(&in, argv[3], &error) != GLINT_OK)
        die(error.text);
    while (glint_y4m_reader_next(&in, &next, &error) == GLINT_OK && next)
        frame = next; /* the same memory each time */
    if (!frame || *error.text)
        die(*error.text ? error.text : "no frame");
    cfg = (struct glint_panel_config){
        .width = w,
        .height = h,
        .layout = pixels_of(&layout),
        .image_width = frame->width,
        .image_height = frame->height,
        .fit = argc > 5 && strcmp(argv[5], "centre") == 0 ? GLINT_PANEL_CENTRE
                                                          : GLINT_PANEL_FIT};
    if (glint_panel_open(&panel, &cfg, &error) != GLINT_OK)
        die(error.text);
    mem = malloc((size_t)w * (size_t)h * layout.n_bytes);
    file = fopen(argv[4], "wb");
    if (!mem || !file)
        die("cannot write");
    glint_panel_clear(&panel, mem, (ptrdiff_t)(w * (int)layout.n_bytes));
    glint_panel_draw(&panel, frame, mem, (ptrdiff_t)(w * (int)layout.n_bytes));
    fprintf(file, "P6\n%d %d\n255\n", w, h);
    for (size_t i = 0; i < (size_t)w * (size_t)h; i++)
        put_pixel(&layout, mem + i * layout.n_bytes, file);
    free(mem);
    glint_panel_close(&panel);
    glint_y4m_reader_close(&in);
    return fclose(file) == 0 ? 0 : 1;
}
