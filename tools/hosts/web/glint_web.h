/* SPDX-License-Identifier: MIT
 *
 * glint_web.h - what the page calls of the WebAssembly module.
 *
 *     web_set("lens", "heliar-tronnier");  options, by the names of the table
 *     name = web_open(0);                  the file name of the lens's model
 *     web_model(data, bytes);  or  web_bake();
 *     web_size(width, height);
 *     n = web_find(pixels);                rows of lamps in web_lamps()
 *     web_draw(pixels, WEB_FOUND, 0);
 *
 * One lens and one engine a module. Functions that return int return 0 on
 * failure, those that return pointers NULL; web_error() then has the reason.
 * Texts end with 0 and are UTF-8. Pictures are R G B A bytes, without padding,
 * as of ImageData; A stays. */
#ifndef GLINT_TOOLS_HOSTS_WEB_GLINT_WEB_H
#define GLINT_TOOLS_HOSTS_WEB_GLINT_WEB_H

#include <stddef.h>
#include <stdint.h>

#define WEB_EXPORT(name) __attribute__((export_name(#name)))

enum { WEB_FOUND = -1 };

/* A lens table that is part of the module. */
struct web_lens {
    const char *name, *folder, *text;
};
extern const struct web_lens web_lens[]; /* ends with a name NULL */

/* Columns of the rows of lamps, doubles in the units of glint overlay
 * --save-lights. */
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

/* Return memory for the caller to write to, and give it back. */
WEB_EXPORT(web_take) void *web_take(size_t bytes);
WEB_EXPORT(web_free) void web_free(void *mem);

/* Returns why the last call failed. */
WEB_EXPORT(web_error) const char *web_error(void);

/* Return JSON: the table of options, the styles, and the lenses with their
 * surfaces. Valid until the next of these calls. */
WEB_EXPORT(web_options) const char *web_options(void);
WEB_EXPORT(web_styles) const char *web_styles(void);
WEB_EXPORT(web_lenses) const char *web_lenses(void);

/* Sets all options to the defaults of glint overlay. */
WEB_EXPORT(web_reset) void web_reset(void);

/* Sets option NAME as on a command line. Files, scenes and --budget are
 * refused. */
WEB_EXPORT(web_set) int web_set(const char *name, const char *text);

/* Opens the lens of the options. WIDEST: its model is baked for that f-number,
 * as by glint bake --f-number WIDEST, and used as a model is; 0: for that of
 * the table or the options, as of glint overlay. Returns the name that glint
 * keeps the model under, NAME-KEY.glint; valid until the next call. */
WEB_EXPORT(web_open) const char *web_open(double widest);

/* Takes the model of the lens: DATA of web_take(), kept, or what a bake makes.
 * Without either, web_size() works with --rays exact alone. */
WEB_EXPORT(web_model) int web_model(void *data, size_t bytes);
WEB_EXPORT(web_bake) int web_bake(void);
WEB_EXPORT(web_model_data) const void *web_model_data(void);
WEB_EXPORT(web_model_bytes) size_t web_model_bytes(void);

/* Makes an engine for pictures of WIDTH x HEIGHT with the options as they are.
 */
WEB_EXPORT(web_size) int web_size(int width, int height);

/* Finds the lamps of a picture; returns how many rows of web_lamps() it set. */
WEB_EXPORT(web_find) int web_find(uint8_t *pixels);
WEB_EXPORT(web_lamps) double *web_lamps(void);

/* Sets X, Y of the brightest spot that was not taken for a lamp; returns 0 if
 * there is none. */
WEB_EXPORT(web_doubtful) int web_doubtful(double xy[2]);

/* Draws into PIXELS the flare of N rows of web_lamps(), 0 .. 1024, or of the
 * lamps as web_find() found them. QUICK, not 0: as a frame of a video, whose
 * brightness is estimated and whose wide lamps have fewer points. Options that
 * take effect with each frame may have changed: strength, exposure, gain,
 * starburst. */
WEB_EXPORT(web_draw) int web_draw(uint8_t *pixels, int n, int quick);

#endif
