/* SPDX-License-Identifier: MIT
 *
 * glint_web.h - functions of the WebAssembly module that the page calls.
 *
 *     web_set("lens", "heliar-tronnier");  options, by the names of the table
 *     web_size(width, height);
 *     n = web_find(pixels);                rows of lamps in web_lamps()
 *     web_draw(pixels, WEB_FOUND);
 *
 * A module has one lens and one engine, which traces exact rays. On failure
 * functions return 0 or NULL, and web_error() returns the cause. Texts end with
 * 0 and are UTF-8. Pictures have the layout of ImageData: bytes R, G, B, A
 * without padding. The byte A does not change.
 */
#ifndef GLINT_TOOLS_HOSTS_WEB_GLINT_WEB_H
#define GLINT_TOOLS_HOSTS_WEB_GLINT_WEB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WEB_EXPORT(name) __attribute__((export_name(#name)))

enum { WEB_FOUND = -1, WEB_GHOST_COLUMNS = 6 };

/* A lens table built into the module */
struct web_lens {
    const char *name, *folder, *text;
};
/* lens tables of the module; the last element has the name NULL */
extern const struct web_lens web_lens[];

/* Columns of a row that describes a lamp. Values are doubles in the units of
 * glint overlay --save-lights. */
enum {
    WEB_X,
    WEB_Y,
    WEB_POWER,
    WEB_RED,
    WEB_GREEN,
    WEB_BLUE,
    WEB_SIZE,
    WEB_SHAPE,
    WEB_TURN,
    WEB_LEVEL,
    WEB_SEEN,
    WEB_COLUMNS
};

/* web_take() allocates memory for the caller to write to; web_free() frees
 * it. */
WEB_EXPORT(web_take) void *web_take(size_t bytes);
WEB_EXPORT(web_free) void web_free(void *mem);

/* Returns the cause of the last failed call. */
WEB_EXPORT(web_error) const char *web_error(void);

/* Returns whether web_set() accepts the option ROW: files, scenes and --budget
 * are for programs, and rays are always exact. The option ghosts is the text of
 * its file. */
struct glint_option;
bool web_has_option(const struct glint_option *row);

/* web_options(), web_styles() and web_lenses() return JSON texts: the table of
 * options that web_set() accepts, the styles, and the lenses with their
 * surfaces. A text is valid until the next of these calls. */
WEB_EXPORT(web_options) const char *web_options(void);
WEB_EXPORT(web_styles) const char *web_styles(void);
WEB_EXPORT(web_lenses) const char *web_lenses(void);

/* Sets all options to the defaults of glint overlay. */
WEB_EXPORT(web_reset) void web_reset(void);

/* Sets option NAME to TEXT, as on a command line. */
WEB_EXPORT(web_set) int web_set(const char *name, const char *text);

/* Opens the lens of the options and makes an engine for pictures of WIDTH x
 * HEIGHT. */
WEB_EXPORT(web_size) int web_size(int width, int height);

/* Finds the lamps of a picture and sets the rows of web_lamps(). Returns
 * their number. */
WEB_EXPORT(web_find) int web_find(uint8_t *pixels);
WEB_EXPORT(web_lamps) double *web_lamps(void);

/* Sets XY to the position of the I-th region that was not accepted as a lamp,
 * the brightest first; returns 0 if there is no such region. */
WEB_EXPORT(web_doubtful) int web_doubtful(int i, double xy[2]);

/* Draws a flare into PIXELS: that of the first N rows of web_lamps(), N = 0 ..
 * 1024, or of the lamps that web_find() has found (N = WEB_FOUND). The options
 * strength, exposure, gain and starburst may change between web_size() and this
 * call. */
WEB_EXPORT(web_draw) int web_draw(uint8_t *pixels, int n);

/* Draws as web_draw() does, with 16 bits, or finds lamps if N = WEB_FOUND: sets
 * SAMPLES to the picture with the flare, R G B, or, if ALONE is not 0, to the
 * flare as glint overlay --layer flare-alpha writes it, R G B A. Samples have
 * the high byte first. PIXELS does not change. */
WEB_EXPORT(web_draw_deep)
int web_draw_deep(uint8_t *pixels, int n, int alone, uint8_t *samples);

/* Sets ROWS[MAX] to number, fraction of the light and bounding box (x0, y0, x1,
 * y1, pixels) of the brightest ghosts of the last picture. Returns how many
 * rows were set, or -1 on failure. */
WEB_EXPORT(web_ghosts)
int web_ghosts(double (*rows)[WEB_GHOST_COLUMNS], int max);

#endif
