/* SPDX-License-Identifier: MIT
 *
 * sheet.h - contact sheets: images of equal size in rows, each with a caption.
 *
 *     sheet_open(&sheet, n, 320, 240, sheet_count_caption_lines(320, "TEXT"));
 *     image = sheet_get_image(&sheet, k);       to draw on
 *     sheet_draw_caption(&sheet, k, "TEXT");
 *     glint_picture_save(path, &sheet.image, &error);
 *     sheet_close(&sheet);
 */
#ifndef GLINT_TOOLS_DESK_SHEET_H
#define GLINT_TOOLS_DESK_SHEET_H

#include "glint/image.h"
#include "glint/status.h"

struct sheet {
    struct glint_image image; /* GLINT_RGB24, dark grey between pictures */
    int width, height;        /* size of each image, pixels */
    /* number of columns, and stroke width of letters, pixels */
    int columns, line;
    int rows; /* number of text lines per caption */
};

/* Returns the number of lines that TEXT needs below an image of WIDTH
 * pixels. */
int sheet_count_caption_lines(int width, const char *text);

/* Makes a sheet of N black images of WIDTH x HEIGHT, with captions of ROWS
 * lines. Returns GLINT_E_MEMORY on failure. */
enum glint_status sheet_open(struct sheet *sheet, int n, int width, int height,
                             int rows);

/* Returns image K, which points into the memory of the sheet. */
struct glint_image sheet_get_image(const struct sheet *sheet, int k);

/* Writes TEXT below image K, with line breaks between words; text that does
 * not fit is truncated. */
void sheet_draw_caption(const struct sheet *sheet, int k, const char *text);

void sheet_close(struct sheet *sheet);

/* Sets SMALL to a copy of BIG, scaled down to at most WIDTH pixels of width by
 * averaging linear light. Both images are sRGB in GLINT_RGB24. The caller frees
 * small->plane[0]. Returns GLINT_E_MEMORY on failure. */
enum glint_status sheet_reduce_image(struct glint_image *small,
                                     const struct glint_image *big, int width);

#endif
