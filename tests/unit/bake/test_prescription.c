/* SPDX-License-Identifier: MIT
 *
 * Checks that the parser of lens tables reads valid tables, and reports the
 * position and cause of each mistake.
 */
#include <dirent.h>

#include "bake/table/text.h"
#include "support/lens_check.h"

#define CORPUS "tests/fuzz/corpus/lens"

/* A valid table. Each wrong table below replaces one of its lines. */
static const char *const good[] = {
    "name tiny-4",                       /* line 1 */
    "source Tiny, US 1,234",             /* line 2 */
    "f-number 8",                        /* line 3 */
    "film 36 24",                        /* line 4 */
    "glass N-BK7 1.5168 64.17",          /* line 5 */
    "surface   50  6 12  N-BK7",         /* line 6 */
    "surface  -50  3 12  air",           /* line 7 */
    "stop          5  8",                /* line 8 */
    "surface flat  2 10  1.62 36.3",     /* line 9 */
    "surface  -80 40 10  air  # behind", /* line 10 */
};

#define N_GOOD 10

static struct glint_prescription lens;
static struct glint_error error;

/* Writes the valid table to TEXT, with END after each line. Replaces line
 * NUMBER, from 1, by LINE; NUMBER 0: replaces none. Returns the size in
 * bytes. */
static size_t compose_table(char text[4096], int number, const char *line,
                            const char *end)
{
    text[0] = 0;
    for (int i = 0; i < N_GOOD; i++) {
        strcat(text, i + 1 == number ? line : good[i]);
        strcat(text, end);
    }
    return strlen(text);
}

static enum glint_status parse_copy_of_text(const char *text, size_t bytes)
{
    /* The copy has exactly the size of the text, so that ASan detects
     * overreads. */
    char *copy = test_free_later(malloc(bytes ? bytes : 1));
    enum glint_status status;

    if (bytes)
        memcpy(copy, text, bytes);
    status = glint_prescription_parse(&lens, copy, bytes, "x.lens", &error);
    return status;
}

static void expect_valid_text(const char *text, size_t bytes)
{
    if (parse_copy_of_text(text, bytes))
        fail_msg("%s", error.text);
}

/* Checks that TEXT is rejected with the error "x.lens:" EXPECTED, and that the
 * lens is unchanged. */
static void expect_parse_error(const char *text, size_t bytes,
                               const char *expected)
{
    static struct glint_prescription before;
    char prefixed[300];

    memset(&lens, 0x55, sizeof(lens));
    before = lens;
    assert_int_equal(parse_copy_of_text(text, bytes), GLINT_E_LENS);
    snprintf(prefixed, sizeof prefixed, "x.lens:%s", expected);
    assert_string_equal(error.text, prefixed);
    assert_memory_equal(&lens, &before, sizeof(lens));
}

/* ------------------------------------------------------------ valid tables */

static void expect_surface_values(const struct glint_surface *s, double radius,
                                  double thickness, double semi, double nd,
                                  double vd, double coating_nm)
{
    assert_true(s->radius_mm == radius);
    assert_true(s->thickness_mm == thickness);
    assert_true(s->semi_mm == semi);
    assert_true(s->nd == nd);
    assert_true(s->vd == vd);
    assert_true(s->coating.nm == coating_nm);
    assert_int_equal(s->coating.n_films, coating_nm > 0);
    assert_true(s->coating.film[0].index == (coating_nm > 0 ? 1.38 : 0.0));
    assert_true(s->coating.film[0].quarters == (coating_nm > 0));
}

static void expect_tiny_lens(void)
{
    assert_string_equal(lens.name, "tiny-4");
    assert_string_equal(lens.source, "Tiny, US 1,234");
    assert_true(lens.f_number == 8.0);
    assert_true(lens.film_width_mm == 36.0 && lens.film_height_mm == 24.0);
    assert_int_equal(lens.n_surfaces, 4);
    expect_surface_values(&lens.surface[0], 50, 6, 12, 1.5168, 64.17, 550);
    expect_surface_values(&lens.surface[1], -50, 3, 12, 1, 0, 550);
    expect_surface_values(&lens.surface[2], 0, 2, 10, 1.62, 36.3, 550);
    expect_surface_values(&lens.surface[3], -80, 40, 10, 1, 0, 550);
    assert_int_equal(lens.stop_after, 2);
    assert_true(lens.stop_thickness_mm == 5.0 && lens.stop_semi_mm == 8.0);
    assert_true(lens.check_focal_mm == 0.0 && lens.check_back_mm == 0.0);
}

TEST(parses_a_valid_table)
{
    char text[4096];

    expect_valid_text(text, compose_table(text, 0, NULL, "\n"));
    expect_tiny_lens();
    expect_valid_text(text, compose_table(text, 0, NULL, "\r\n"));
    expect_tiny_lens();
    expect_valid_text(text, compose_table(text, 0, NULL, " \t \n\n"));
    expect_tiny_lens();
    /* the last line may have no line end */
    expect_valid_text(text, compose_table(text, 0, NULL, "\n") - 1);
    expect_tiny_lens();
    expect_valid_text(
        text, compose_table(text, 1, "\xef\xbb\xbf# mark\nname tiny-4", "\n"));
    expect_tiny_lens();
    expect_valid_text(text, compose_table(text, 3, "\tf-number\t+.8E1", "\n"));
    expect_tiny_lens();
}

static void expect_surface_coatings(int number, const char *line,
                                    const double nm[4], const double n[4])
{
    char text[4096];

    expect_valid_text(text, compose_table(text, number, line, "\n"));
    for (int k = 0; k < 4; k++) {
        assert_true(lens.surface[k].coating.nm == nm[k]);
        assert_true(lens.surface[k].coating.film[0].index == n[k]);
    }
}

TEST(parses_coating_lines)
{
    static const double zero[4] = {0};

    expect_surface_coatings(5, "coating none\nglass N-BK7 1.5 64", zero, zero);
    expect_surface_coatings(
        10, "surface -80 40 10 air\ncoating 480", /* last line */
        (const double[]){480, 480, 480, 480},
        (const double[]){1.38, 1.38, 1.38, 1.38});
    expect_surface_coatings(7, "surface -50 3 12 air coating 600 1.46",
                            (const double[]){550, 600, 550, 550},
                            (const double[]){1.38, 1.46, 1.38, 1.38});
    expect_surface_coatings(7, "surface -50 3 12 air coating none",
                            (const double[]){550, 0, 550, 550},
                            (const double[]){1.38, 0, 1.38, 1.38});
    /* Surface 1 is cemented in this table, so it has no coating. */
    expect_surface_coatings(
        7, "surface -50 3 12 1.7 30\nsurface -90 3 12 air\ncoating 500 1.4",
        (const double[]){500, 0, 500, 500}, (const double[]){1.4, 0, 1.4, 1.4});
    expect_surface_coatings(7,
                            "surface -50 3 12 1.7 30 coating none\n"
                            "surface -90 3 12 air",
                            (const double[]){550, 0, 550, 550},
                            (const double[]){1.38, 0, 1.38, 1.38});
}

TEST(stop_may_be_first_or_last)
{
    static const char last[] = "name a\nf-number 8\nfilm 36 24\n"
                               "surface 50 6 12 1.5 60\nsurface -50 3 12 air\n"
                               "stop 40 8";
    static const char first[] = "name a\nf-number 8\nfilm 36 24\nstop 3 8\n"
                                "surface 50 6 12 1.5 60\n"
                                "surface -50 45 12 air";

    expect_valid_text(last, strlen(last));
    assert_int_equal(lens.stop_after, 2);
    expect_valid_text(first, strlen(first));
    assert_int_equal(lens.stop_after, 0);
}

TEST(parses_round_stops)
{
    static const char table[] = "name a\nf-number 8\nfilm 36 24\n"
                                "surface 50 6 12 1.5 60\n"
                                "surface -50 3 12 air\nstop 40 8";
    char text[sizeof table + 20];

    expect_valid_text(table, strlen(table));
    assert_false(lens.stop_is_circle);
    snprintf(text, sizeof text, "%s  circle # always", table);
    expect_valid_text(text, strlen(text));
    assert_true(lens.stop_is_circle);
    assert_true(lens.stop_thickness_mm == 40 && lens.stop_semi_mm == 8);
}

/* --------------------------------------------------------- rejected tables */

static const struct {
    int number; /* number of the line that is replaced, from 1 */
    const char *line, *error;
} mistakes[] = {
    /* mistakes in names and words */
    {1, "", "11:1: the line 'name' is missing"},
    {1, "name", "1:5: name is missing"},
    {1, "name Tiny",
     "1:6: a name may only contain a-z, 0-9 and -, and must not begin with -"},
    {1, "name -a",
     "1:6: a name may only contain a-z, 0-9 and -, and must not begin with -"},
    {1, "name ../a",
     "1:6: a name may only contain a-z, 0-9 and -, and must not begin with -"},
    {1, "name a b", "1:8: 'b' is one value too many for name"},
    {1,
     "name aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa",
     "1:6: name is longer than 63 bytes"},
    {2, "source   # none", "2:10: the text of 'source' is missing"},
    {2, "fnumber 8", "2:1: unknown word 'fnumber'"},
    {2, "  Surface 1", "2:3: unknown word 'Surface'"},
    {2, "\xc3\xa9tude", "2:1: unknown word '??tude'"},
    {2, "an-endless-word-of-forty-letters-or-more",
     "2:1: unknown word 'an-endless-word-of-forty-let...'"},
    /* mistakes in the lines f-number and film */
    {3, "", "11:1: the line 'f-number' is missing"},
    {3, "f-number", "3:9: f-number is missing"},
    {3, "f-number f8", "3:10: f-number 'f8' is not a number"},
    {3, "f-number 0", "3:10: f-number must be 0.5 .. 1000, not 0"},
    {3, "f-number 0.1", "3:10: f-number must be 0.5 .. 1000, not 0.1"},
    {3, "f-number -8", "3:10: f-number must be 0.5 .. 1000, not -8"},
    {3, "f-number 8\nf-number 8",
     "4:1: a second f-number; the first is on line 3"},
    {3, "f-number 1.5",
     "3:10: f/1.5 needs a stop of 11.42 mm radius, but its semi-diameter is 8 "
     "mm"},
    {4, "", "11:1: the line 'film' is missing"},
    {4, "film 36", "4:8: film height is missing"},
    {4, "film 0 24", "4:6: film width must be 0.1 .. 1000, not 0"},
    {4, "film 36 x24", "4:9: film height 'x24' is not a number"},
    /* Numbers must be decimal. strtod() would accept the first three words. */
    {3, "f-number inf", "3:10: f-number 'inf' is not a number"},
    {3, "f-number nan", "3:10: f-number 'nan' is not a number"},
    {3, "f-number 0x8", "3:10: f-number '0x8' is not a number"},
    {3, "f-number 5,6", "3:10: f-number '5,6' is not a number"},
    {3, "f-number 1e", "3:10: f-number '1e' is not a number"},
    {3, "f-number 1e+", "3:10: f-number '1e+' is not a number"},
    {3, "f-number .", "3:10: f-number '.' is not a number"},
    {3, "f-number +", "3:10: f-number '+' is not a number"},
    {3, "f-number --8", "3:10: f-number '--8' is not a number"},
    {3, "f-number 8#", "3:10: f-number '8#' is not a number"},
    {3, "f-number 1e400", "3:10: f-number '1e400' is too large or too small"},
    {3, "f-number 1e99999999999999999999",
     "3:10: f-number '1e99999999999999999999' is too large or too small"},
    {3, "f-number 80000000000000000000000000000000000000000",
     "3:10: f-number '8000000000000000000000000000...' is too large or too "
     "small"},
    /* mistakes in glasses */
    {5, "glass", "5:6: glass name is missing"},
    {5, "glass N-BK7", "5:12: index is missing"},
    {5, "glass N-BK7 1.5", "5:16: Abbe number is missing"},
    {5, "glass N-BK7 0.9 60", "5:13: index must be 1.01 .. 4, not 0.9"},
    {5, "glass N-BK7 1.5 5", "5:17: Abbe number must be 10 .. 150, not 5"},
    {5, "glass 7N 1.5 60",
     "5:7: glass name must be a letter and at most 22 letters, digits and -"},
    {5, "glass air 1.5 60", "5:7: glass of this name is already defined"},
    {5, "glass N-BK7 1.5 60\nglass N-BK7 1.6 50",
     "6:7: glass of this name is already defined"},
    {6, "surface 50 6 12 N-BK77",
     "6:17: no glass 'N-BK77' is defined above this line, nor in the "
     "catalogue; did you mean N-BK7?"},
    /* mistakes in surfaces */
    {6, "surface", "6:8: radius is missing"},
    {6, "surface 50 6 12",
     "6:16: medium is missing: write air, ND VD or the name of a glass"},
    {6, "surface 0 6 12 N-BK7",
     "6:9: radius must not be 0; a plane has the radius 'flat'"},
    {6, "surface plane 6 12 N-BK7", "6:9: radius 'plane' is not a number"},
    {6, "surface 1e-9 6 12 N-BK7",
     "6:9: radius must be 0.01 .. 1000000000, not 1e-09"},
    {6, "surface 50 -6 12 N-BK7",
     "6:12: thickness must be 0 .. 100000, not -6"},
    {6, "surface 50 6 0 N-BK7",
     "6:14: semi-diameter must be 0.01 .. 10000, not 0"},
    {6, "surface 50 6 50 N-BK7",
     "6:14: semi-diameter 50 must be less than the radius 50"},
    {6, "surface -50 6 51 N-BK7",
     "6:15: semi-diameter 51 must be less than the radius 50"},
    {6, "surface 50 6 12 1.5", "6:20: Abbe number is missing"},
    {6, "surface 50 6 12 1 60", "6:17: index must be 1.01 .. 4, not 1"},
    {6, "surface 50 6 12 air",
     "6:17: both sides of the surface have the same medium"},
    {6, "surface 50 6 12 N-BK7 1.5",
     "6:23: unexpected '1.5'; expected coating"},
    {6, "surface 50 6 12 N-BK7 coating", "6:30: coating wavelength is missing"},
    {6, "surface 50 6 12 N-BK7 coating 50",
     "6:31: coating wavelength must be 100 .. 5000, not 50"},
    {6, "surface 50 6 12 N-BK7 coating 550 1",
     "6:35: coating index must be 1.01 .. 4, not 1"},
    {6, "surface 50 6 12 N-BK7 coating none 1.4",
     "6:36: '1.4' is one value too many for surface"},
    {6, "surface 50 6 12 N-BK7 coating 550 1.38:0.5 2.1:17",
     "6:48: coating thickness must be 0.01 .. 16, not 17"},
    {6, "surface 50 6 12 N-BK7 coating 550 1.38:",
     "6:40: coating thickness is missing"},
    {6, "surface 50 6 12 N-BK7 coating 550 :1",
     "6:35: coating index is missing"},
    {6, "surface 50 6 12 N-BK7 coating 550 1.1 1.2 1.3 1.4 1.5 1.6 1.7 1.8 2",
     "6:67: more than 8 films"},
    {6, "surface 50 6 12 N-BK7 coating v-coat 500 1.38",
     "6:42: '1.38' is one value too many for surface"},
    {6, "surface 50 6 12 N-BK7 coating broadband-4 99",
     "6:43: coating wavelength must be 100 .. 5000, not 99"},
    {6, "surface 50 6 12 N-BK7 coating v2",
     "6:31: 'v2' is not a coating; expected none, v-coat, broadband-3, "
     "broadband-4 or a wavelength in nm"},
    {7, "surface -50 3 12 1.7 30 coating v-coat\nsurface -50 2 12 air",
     "7:25: a cemented surface has no coating"},
    {7, "surface -50 3 12 1.7 30 coating 550\nsurface -50 2 12 air",
     "7:25: a cemented surface has no coating"},
    {10, "surface -80 40 10 1.5 60", "10:19: the last medium must be air"},
    /* mistakes in the stop */
    {8, "", "11:1: the line 'stop' is missing"},
    {8, "stop 5 8\nstop 5 8", "9:1: a second stop; the first is on line 8"},
    {8, "stop 5", "8:7: semi-diameter is missing"},
    {8, "stop 5 8 circle 9", "8:17: '9' is one value too many for stop"},
    {8, "stop 5 8 9", "8:10: unexpected '9'; expected circle"},
    /* mistakes that are detected only in the complete lens */
    {6, "surface 50 2.3406 12 N-BK7",
     "6:12: element overlaps the next one by 0.02006 mm at 10.8 mm from the "
     "axis"},
    {6, "surface 50 2.3 12 N-BK7",
     "6:12: element overlaps the next one by 0.06066 mm at 10.8 mm from the "
     "axis"},
    {7, "surface -50 0 12 air\nsurface -40 3 12 1.6 40\nsurface -50 3 12 air",
     "7:13: element overlaps the next one by 0.3053 mm at 10.8 mm from the "
     "axis"},
    {8, "surface 20 0.5 9 1.7 30\nsurface 15 1 9 air\nstop 5 8",
     "9:12: element overlaps the next one by 0.841 mm at 7.2 mm from the axis"},
    {10, "surface 80 0 10 air",
     "10:12: the sensor must lie behind the last element"},
    {10, "surface 80 0.6 10 air",
     "10:12: the sensor must lie behind the last element"},
    {2, "focal-length 40",
     "2:14: focal-length is 38.1194 mm, not the stated 40 mm"},
    {2, "back-focal-length 40 # mm",
     "2:19: back-focal-length is 29.4328 mm, not the stated 40 mm"},
    {2, "focal-length -40",
     "2:14: focal length must be 0.01 .. 1000000, not -40"},
    /* bytes that are not valid text */
    {2, "source a\rb", "2:9: byte 0x0d is not text (UTF-8)"},
    {2, "# bell \a", "2:8: byte 0x07 is not text (UTF-8)"},
    {2, "# \x7f", "2:3: byte 0x7f is not text (UTF-8)"},
    {2, "# latin \xfc", "2:9: byte 0xfc is not text (UTF-8)"},
    {2, "# cut \xe2\x82", "2:7: byte 0xe2 is not text (UTF-8)"},
    {2, "# overlong \xc0\xaf", "2:12: byte 0xc0 is not text (UTF-8)"},
    {2, "# overlong \xe0\x80\xaf", "2:12: byte 0xe0 is not text (UTF-8)"},
    {2, "# surrogate \xed\xa0\x80", "2:13: byte 0xed is not text (UTF-8)"},
    {2, "# beyond \xf4\x90\x80\x80", "2:10: byte 0xf4 is not text (UTF-8)"},
    {2, "# escape \xc2\x9b", "2:10: byte 0xc2 is not text (UTF-8)"},
};

TEST(rejects_wrong_lines)
{
    char text[4096];

    for (size_t i = 0; i < sizeof(mistakes) / sizeof(mistakes[0]); i++)
        expect_parse_error(
            text,
            compose_table(text, mistakes[i].number, mistakes[i].line, "\n"),
            mistakes[i].error);
}

/* Checks that an overlap of 0.009 mm is a warning that names the surfaces, and
 * that a valid table has none. */
TEST(warns_of_small_overlaps)
{
    char text[4096];

    strcpy(error.text, "stale");
    assert_ok(parse_copy_of_text(text, compose_table(text, 0, NULL, "\n")));
    assert_string_equal(error.text, "");
    assert_ok(parse_copy_of_text(
        text, compose_table(text, 6, "surface 50 2.3517 12 N-BK7", "\n")));
    assert_string_equal(
        error.text, "x.lens:6:12: surface 0 and surface 1 overlap by 0.008964 "
                    "mm at 10.8 mm from the axis; drawn as they are");
}

TEST(rejects_invalid_bytes)
{
    char text[4096], line[300];
    size_t bytes;

    expect_parse_error(NULL, 0, "1:1: the line 'name' is missing");
    expect_parse_error("\n\n", 2, "3:1: the line 'name' is missing");
    bytes = compose_table(text, 0, NULL, "\n");
    text[5] = 0;
    expect_parse_error(text, bytes, "1:6: byte 0x00 is not text (UTF-8)");
    /* the text is cut off after the first byte of a multi-byte character */
    bytes = compose_table(text, 0, NULL, "\n");
    text[bytes - 1] = '\xe2';
    expect_parse_error(text, bytes, "10:34: byte 0xe2 is not text (UTF-8)");
    memset(line, '#', sizeof(line));
    line[201] = 0;
    expect_parse_error(text, compose_table(text, 2, line, "\r\n"),
                       "2:201: line is longer than 200 bytes");
}

TEST(rejects_too_long_lines_and_texts)
{
    static char big[70000];
    char text[4096], line[300] = "source ";

    memset(line + 7, 'x', 193); /* The line becomes 200 bytes long. */
    expect_valid_text(text, compose_table(text, 2, line, "\r\n"));
    assert_int_equal(strlen(lens.source), 193);
    memset(big, '\n', sizeof(big));
    memcpy(big, text, compose_table(text, 0, NULL, "\n"));
    expect_valid_text(big, 65536);
    expect_parse_error(big, 65537, "1:1: text is longer than 65536 bytes");
}

/* Checks that a comment may contain any UTF-8 text, and that a # inside a word
 * does not begin a comment. */
TEST(accepts_utf8_in_comments)
{
    char text[4096];

    expect_valid_text(text,
                      compose_table(text, 2,
                                    "# \xe2\x82\xac \xf0\x9f\x93\xb7\n"
                                    "source Voigtl\xc3\xa4nder a#1 \t # no",
                                    "\n"));
    assert_string_equal(lens.source, "Voigtl\xc3\xa4nder a#1");
}

TEST(rejects_too_many_surfaces)
{
    static char text[8192];
    int n = snprintf(text, sizeof(text),
                     "name a\nf-number 32\nfilm 36 24\nstop 1 9\n");

    for (int k = 0; k < 64; k++)
        n += snprintf(text + n, sizeof(text) - (size_t)n, "surface %s 1 9 %s\n",
                      k % 2 ? "-900" : "900", k % 2 ? "air" : "1.5 60");
    expect_valid_text(text, (size_t)n);
    assert_int_equal(lens.n_surfaces, 64);
    n += snprintf(text + n, sizeof(text) - (size_t)n, "surface 9 1 1 1.5 60");
    expect_parse_error(text, (size_t)n, "69:1: more than 64 surfaces");
}

static void expect_error_of_elements(const char *elements, const char *expected)
{
    char text[4096];

    snprintf(text, sizeof(text), "name a\nf-number 8\nfilm 36 24\n%s",
             elements);
    expect_parse_error(text, strlen(text), expected);
}

TEST(rejects_lenses_without_power)
{
    expect_error_of_elements("stop 1 20\nsurface flat 3 9 1.5 60\n"
                             "surface flat 9 9 air\n",
                             "7:1: the lens has no refractive power");
    /* With R1 - R2 = d (n - 1) / n, which these decimals satisfy exactly, the
     * lens is afocal and has no focus. */
    expect_error_of_elements("stop 1 20\nsurface 40 60 9 1.5 60\n"
                             "surface 20 9 9 air\n",
                             "7:1: the lens has no refractive power");
    expect_error_of_elements("stop 1 20\nsurface -50 3 9 1.5 60\n"
                             "surface 50 9 9 air\n",
                             "7:1: the lens has no focus behind it: focal "
                             "length -49.505 mm, back focal length -50.495 mm");
    /* The stop lies in the focus of a thick plano-convex rod of length R n / (n
     * - 1), so its image is at infinity; two relay lenses image it. */
    expect_error_of_elements(
        "surface 20 60 9 1.5 60\nsurface flat 0 9 air\n"
        "stop 100 5\n"
        "surface 50 3 9 1.5 60\nsurface -50 200 9 air\n"
        "surface 50 3 9 1.5 60\nsurface -50 100 9 air\n",
        "6:10: the stop lies in the focal plane of the surfaces before it");
}

/* Checks that focal lengths stated in a table may deviate from the computed
 * ones by up to 0.1 %. */
TEST(checks_stated_focal_lengths)
{
    char text[4096];

    expect_valid_text(
        text,
        compose_table(text, 2, "focal-length 38.15\nback-focal-length 29.41",
                      "\n"));
    assert_true(lens.check_focal_mm == 38.15);
    assert_true(lens.check_back_mm == 29.41);
    expect_parse_error(
        text, compose_table(text, 2, "focal-length 38.08", "\n"),
        "2:14: focal-length is 38.1194 mm, not the stated 38.08 mm");
}

/* Checks that error texts contain the cause, however long the file name is. */
TEST(errors_keep_the_cause_after_a_long_file_name)
{
    static char name[2000];

    memset(name, 'd', sizeof(name) - 1);
    strcpy(name + 1900, "/a.lens");
    assert_int_equal(glint_prescription_parse(&lens, "bad", 3, name, &error),
                     GLINT_E_LENS);
    assert_non_null(strstr(error.text, "/a.lens:1:1: unknown word 'bad'"));
    assert_memory_equal(error.text, "...ddd", 6);
}

/* Checks lenses whose widest f-number, rounded to nearest, would be too small.
 * The parser must accept the f-number that glint_prescription_widest()
 * returns. */
TEST(printed_widest_f_number_is_accepted)
{
    static const char *const names[] = {"heliar-tronnier", "canon-zoom-long",
                                        "itoh-zoom-mid", "nikon-zoom-short"};
    char text[32];

    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        double widest;

        load_lens(&lens, names[i]);
        widest = glint_prescription_widest(&lens);
        snprintf(text, sizeof text, "%.3g", widest);
        assert_ok(
            glint_prescription_set_f_number(&lens, strtod(text, NULL), &error));
        assert_int_equal(
            glint_prescription_set_f_number(&lens, 0.99 * widest, &error),
            GLINT_E_ARGUMENT);
    }
}

TEST(sets_the_f_number)
{
    struct glint_optics optics;

    load_lens(&lens, "heliar-tronnier");
    assert_ok(glint_prescription_set_f_number(&lens, 8.0, &error));
    assert_true(lens.f_number == 8.0);
    /* at f/8 the stop radius is twice the radius at f/16 */
    glint_optics_of(&lens, &optics);
    assert_near(optics.stop_radius_mm, 2.0 * 2.4868, 1e-4);
    assert_int_equal(glint_prescription_set_f_number(&lens, 2.0, &error),
                     GLINT_E_ARGUMENT);
    assert_string_equal(error.text, "f/2 needs a stop of 19.89 mm radius; "
                                    "heliar-tronnier opens to 11.6 mm, f/3.44");
    assert_int_equal(
        glint_prescription_set_f_number(&lens, (double)NAN, &error),
        GLINT_E_ARGUMENT);
    assert_int_equal(glint_prescription_set_f_number(&lens, HUGE_VAL, &error),
                     GLINT_E_ARGUMENT);
    assert_int_equal(glint_prescription_set_f_number(&lens, 0.0, &error),
                     GLINT_E_ARGUMENT);
    assert_int_equal(glint_prescription_set_f_number(&lens, -8.0, &error),
                     GLINT_E_ARGUMENT);
    assert_string_equal(error.text, "f-number must be 0.5 .. 1000, not -8");
    assert_true(lens.f_number == 8.0);
}

TEST(parses_the_table_of_the_manual)
{
    static const char fence[] = "```lens\n";
    static char text[65536];
    const char *start, *end;

    text[read_file("lenses/README.md", text, sizeof(text) - 1)] = 0;
    start = strstr(text, fence);
    assert_non_null(start);
    start += strlen(fence);
    end = strstr(start, "```");
    assert_non_null(end);
    expect_valid_text(start, (size_t)(end - start));
    assert_string_equal(lens.name, "achromat");
}

/* Checks the lens tables in the fuzzer's corpus by their names: good-* must
 * parse, bad-* must be rejected, others may do either. */
TEST(corpus_tables_match_their_names)
{
    static char text[70000];
    DIR *folder = opendir(CORPUS);
    const struct dirent *entry;
    int n = 0;

    assert_non_null(folder);
    while ((entry = readdir(folder))) {
        char path[400];
        enum glint_status status;

        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof(path), CORPUS "/%s", entry->d_name);
        status = parse_copy_of_text(text, read_file(path, text, sizeof(text)));
        if (!strncmp(entry->d_name, status ? "good-" : "bad-", status ? 5 : 4))
            fail_msg("%s: %s", path, status ? error.text : "accepted");
        n++;
    }
    closedir(folder);
    assert_true(n >= 20);
}

/* Checks that numbers with any number of digits become the nearest double, as
 * the compiler converts them. */
TEST(numbers_of_any_length_are_rounded_to_nearest)
{
    static const struct {
        const char *text;
        double value;
    } number[] = {
        {"1.6525", 1.6525},
        {"81.315056", 81.315056},
        {"0.1e2", 0.1e2},
        {"9.87654321012345", 9.87654321012345},
        {"00000000000000000000012.50", 12.5},
        {"123456789012345e-13", 123456789012345e-13},
        {"5.", 5.0},
        {"+3.3", 3.3},
        {"1e-0", 1.0},
        {"8.000000000000001", 8.000000000000001},
        {"-0.30000000000000004", -0.30000000000000004},
        {"00.1000000000000000055511151231257827", 0.1},
        {"9007199254740993", 9007199254740992.0},
        {"9007199254740993.00000000000000000000000001", 9007199254740994.0},
        {"1.7976931348623157081452742373e3", 1.7976931348623157e3},
        {"123456789012345678901234567890e-20", 1234567890.1234567890},
        {"2.2250738585072011e-5", 2.2250738585072011e-5},
    };

    for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
        const struct glint_word word = {.start = number[i].text,
                                        .length = (int)strlen(number[i].text)};
        double value = 0;

        assert_null(glint_word_parse_number(&word, &value));
        if (value != number[i].value)
            fail_msg("%s: %.17g", number[i].text, value);
    }
}
