/* SPDX-License-Identifier: MIT
 *
 * sheet.h - contact sheets: pictures of one size in rows, each with a caption.
 *
 *     sheet_open(&sheet, n, 320, 240, sheet_caption_lines(320, "TEXT"));
 *     image = sheet_picture(&sheet, k);       to draw on
 *     sheet_caption(&sheet, k, "TEXT");
 *     glint_picture_save(path, &sheet.image, &error);
 *     sheet_close(&sheet);
 */
#ifndef GLINT_TOOLS_DESK_SHEET_H
#define GLINT_TOOLS_DESK_SHEET_H

#include "glint/image.h"
#include "glint/status.h"

struct sheet {
    struct glint_image image; /* GLINT_RGB24, dark grey between pictures */
    int width, height;        /* of a picture */
    int columns, line;        /* line: thickness of strokes of letters */
    int rows;                 /* of letters, of a caption */
};

/* Returns how many rows TEXT takes below a picture of that WIDTH. */
int sheet_caption_lines(int width, const char *text);

/* Makes a sheet of N pictures of WIDTH x HEIGHT, black, with captions of ROWS
 * rows of letters. GLINT_E_MEMORY. */
enum glint_status sheet_open(struct sheet *sheet, int n, int width, int height,
                             int rows);

/* Returns the picture K, within the sheet's memory. */
struct glint_image sheet_picture(const struct sheet *sheet, int k);

/* Writes TEXT below the picture K, broken between words; what the rows do not
 * hold is left out. */
void sheet_caption(const struct sheet *sheet, int k, const char *text);

void sheet_close(struct sheet *sheet);

/* Makes SMALL, GLINT_RGB24 of BIG's shape and at most WIDTH wide, of means of
 * the light of BIG, sRGB GLINT_RGB24; the caller frees its plane[0].
 * GLINT_E_MEMORY. */
enum glint_status sheet_reduce(struct glint_image *small,
                               const struct glint_image *big, int width);

#endif
