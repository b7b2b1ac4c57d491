/* SPDX-License-Identifier: MIT
 *
 * glint_web.h - functions of the WebAssembly module that the page calls.
 *
 *     web_set("lens", "heliar-tronnier");  options, by the names of the table
 *     name = web_open(0);                  the file name of the lens's model
 *     web_model(data, bytes);              or  web_bake();
 *     web_size(width, height);
 *     n = web_find(pixels);                rows of lamps in web_lamps()
 *     web_draw(pixels, WEB_FOUND, 0);
 *
 * A module has one lens and one engine. On failure functions return 0 or NULL,
 * and web_error() returns the cause. Texts end with 0 and are UTF-8. Pictures
 * have the layout of ImageData: bytes R, G, B, A without padding. The byte A
 * does not change.
 */
#ifndef GLINT_TOOLS_HOSTS_WEB_GLINT_WEB_H
#define GLINT_TOOLS_HOSTS_WEB_GLINT_WEB_H

#include <stddef.h>
#include <stdint.h>

#define WEB_EXPORT(name) __attribute__((export_name(#name)))

enum { WEB_FOUND = -1 };

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

/* web_options(), web_styles() and web_lenses() return JSON texts: the table of
 * options, the styles, and the lenses with their surfaces. A text is valid
 * until the next of these calls. */
WEB_EXPORT(web_options) const char *web_options(void);
WEB_EXPORT(web_styles) const char *web_styles(void);
WEB_EXPORT(web_lenses) const char *web_lenses(void);

/* Sets all options to the defaults of glint overlay. */
WEB_EXPORT(web_reset) void web_reset(void);

/* Sets option NAME to TEXT, as on a command line. Rejects files, scenes and
 * --budget. */
WEB_EXPORT(web_set) int web_set(const char *name, const char *text);

/* Opens the lens that the options name. WIDEST: the f-number that its model is
 * baked for, as with glint bake --f-number WIDEST. 0 means the f-number of the
 * table or the options, as with glint overlay. Returns the model's file name in
 * glint's cache, NAME-KEY.glint, which is valid until the next call. */
WEB_EXPORT(web_open) const char *web_open(double widest);

/* web_model() sets the model of the lens to DATA, which must come from
 * web_take() and is not copied. web_bake() bakes the model instead. Without a
 * model, web_size() succeeds only with --rays exact. */
WEB_EXPORT(web_model) int web_model(void *data, size_t bytes);
WEB_EXPORT(web_bake) int web_bake(void);
WEB_EXPORT(web_model_data) const void *web_model_data(void);
WEB_EXPORT(web_model_bytes) size_t web_model_bytes(void);

/* Makes an engine for pictures of WIDTH x HEIGHT with the current options. */
WEB_EXPORT(web_size) int web_size(int width, int height);

/* Finds the lamps of a picture and sets the rows of web_lamps(). Returns
 * their number. */
WEB_EXPORT(web_find) int web_find(uint8_t *pixels);
WEB_EXPORT(web_lamps) double *web_lamps(void);

/* Sets XY to the centre of the brightest region that was not accepted as a
 * lamp, and returns 1. Returns 0 if there is no such region. */
WEB_EXPORT(web_doubtful) int web_doubtful(double xy[2]);

/* Draws a flare into PIXELS: that of the first N rows of web_lamps(), N = 0 ..
 * 1024, or of the lamps that web_find() has found (N = WEB_FOUND). If QUICK is
 * not 0, draws as in a video: brightness is estimated, and wide lamps have
 * fewer points. The options strength, exposure, gain and starburst may change
 * between web_size() and this call. */
WEB_EXPORT(web_draw) int web_draw(uint8_t *pixels, int n, int quick);

#endif
