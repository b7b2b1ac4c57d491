/* SPDX-License-Identifier: MIT
 *
 * Loads lenses, and compares doubles, for tests. Run from the root of the tree.
 */
#ifndef GLINT_TESTS_LENS_CHECK_H
#define GLINT_TESTS_LENS_CHECK_H

#include "glint/bake.h"
#include "support/test.h"

/* Checks that |GOT - EXPECTED| <= TOLERANCE in double precision; cmocka can
 * compare only floats. */
#define assert_near(got, expected, tolerance) \
    check_near(got, expected, tolerance, #got, __FILE__, __LINE__)

static inline void check_near(double got, double expected, double tolerance,
                              const char *what, const char *file, int line)
{
    if (fabs(got - expected) <= tolerance)
        return;
    print_error("%s is %.17g, not within %g of %.17g\n", what, got, tolerance,
                expected);
    _fail(file, line);
}

/* Reads at most SIZE bytes of the file PATH into TEXT. Returns their number. */
static inline size_t read_file(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "rb");
    size_t bytes;

    if (!file)
        fail_msg("%s: cannot be read; run from the root of the tree", path);
    bytes = fread(text, 1, size, file);
    fclose(file);
    return bytes;
}

static inline void parse_lens_text(struct glint_prescription *lens,
                                   const char *text)
{
    struct glint_error error = {""};

    if (glint_prescription_parse(lens, text, strlen(text), "t.lens", &error))
        fail_msg("%s", error.text);
}

/* Sets AT to the zoom lens LENS at the position ALONG, 0 .. 1. */
static inline void set_lens_at_position(struct glint_prescription *at,
                                        const struct glint_prescription *lens,
                                        double along)
{
    struct glint_error error = {""};

    *at = *lens;
    if (glint_prescription_zoom(at, along, &error))
        fail_msg("%s", error.text);
}

/* Reads lenses/NAME.lens into LENS. */
static inline void load_lens(struct glint_prescription *lens, const char *name)
{
    static char text[65536];
    struct glint_error error;
    char path[300];

    snprintf(path, sizeof(path), "lenses/%s.lens", name);
    if (glint_prescription_parse(
            lens, text, read_file(path, text, sizeof(text)), path, &error))
        fail_msg("%s", error.text);
}

/* Reads lenses/NAME.lens into LENS and sets it up with a stop of eight blades
 * and wavelengths of 650, 532 and 450 nm. */
static inline void load_setup(struct glint_setup *setup,
                              struct glint_prescription *lens, const char *name)
{
    static const double nm[3] = {650, 532, 450};
    struct glint_error error;

    load_lens(lens, name);
    if (glint_setup_init(setup, lens, 8, 0, nm, 3, &error))
        fail_msg("%s", error.text);
}

#endif
