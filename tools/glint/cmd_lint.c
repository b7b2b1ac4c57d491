/* SPDX-License-Identifier: MIT
 *
 * glint lint: finds misprinted numbers in a lens table. It tries changes of a
 * single number and lists those by which the lens gets the focal length and
 * back focus that the table states.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/table_file.h"
#include "options/command_line.h"
#include "model/settings.h"
#include "posix/input.h"

enum slip { SLIP_SIGN, SLIP_SWAP, SLIP_DIGIT, SLIP_POINT };

struct mend {
    int line, column; /* position of the number in the file, from 1 */
    enum slip slip;
    char from[24], to[24];
    /* focal length and back focal length with the corrected number, mm */
    double focal_mm, back_mm;
    /* true: the corrected glass is in the catalogue or also behind another
     * surface */
    bool listed;
    /* relative difference of the focal length or back focus from its stated
     * value, the larger of both */
    double off;
};

enum { MENDS = 8, LENS_TEXT = 1 << 16 };

/* Range of Vd that glasses of index nd have, by the makers' glass maps. The
 * lower limit follows flints with and without lead, the upper one fluorite,
 * fluor crowns, lanthanum crowns and the densest glasses. Both are widened by
 * twice the width of a label on the maps. */
static const struct {
    double nd, least, most;
} ends[] = {{1.42, 60.0, 97.5}, {1.45, 56.0, 96.0}, {1.50, 48.0, 84.0},
            {1.55, 40.0, 77.5}, {1.60, 33.5, 70.0}, {1.65, 29.0, 63.0},
            {1.70, 26.0, 59.0}, {1.75, 23.5, 55.0}, {1.80, 21.0, 50.0},
            {1.85, 19.0, 46.0}, {1.90, 17.5, 41.0}, {2.00, 15.5, 33.0},
            {2.20, 14.0, 26.0}};

enum { N_ENDS = sizeof ends / sizeof *ends };

/* Returns whether ND and VD are those of a plastic of phone lenses. Plastics
 * have a lower Vd than flints of the same nd, from 45.4 at nd 1.529 through
 * polycarbonate (29.9 at 1.585) to 14.0 at 1.705. */
static bool is_plastic(double nd, double vd)
{
    const double slope = nd < 1.585 ? 270 : 125;
    const double least = 28.5 - (nd - 1.585) * slope;

    return nd >= 1.525 && nd <= 1.71 && vd >= least &&
           vd <= fmax(least + 6.5, 35);
}

/* Returns whether a glass with ND and VD can exist, according to the table
 * ENDS. If MOULDED, plastics also count. */
static bool is_glass_possible(double nd, double vd, bool moulded)
{
    int k = 0;
    double part;

    if (moulded && is_plastic(nd, vd))
        return true;
    if (!(nd >= ends[0].nd && nd <= ends[N_ENDS - 1].nd))
        return false;
    while (k < N_ENDS - 2 && nd > ends[k + 1].nd)
        k++;
    part = (nd - ends[k].nd) / (ends[k + 1].nd - ends[k].nd);
    return vd >= ends[k].least + part * (ends[k + 1].least - ends[k].least) &&
           vd <= ends[k].most + part * (ends[k + 1].most - ends[k].most);
}

/* Returns whether the glass behind surface K of LENS is in the catalogue or
 * also behind another surface. A misprint would hardly occur twice. */
static bool is_glass_confirmed(const struct glint_prescription *lens, int k)
{
    const struct glint_surface *s = &lens->surface[k];
    const struct glint_glass *glass;

    for (int i = 0; i < lens->n_surfaces; i++)
        if (i != k && fabs(lens->surface[i].nd - s->nd) < 2e-6 &&
            fabs(lens->surface[i].vd - s->vd) < 0.05)
            return true;
    for (int i = 0; (glass = glint_glass_at(i)) != NULL; i++) {
        struct glint_surface known = {.nd = 1};
        double nd, spread;

        memcpy(known.sellmeier, glass->sellmeier, sizeof known.sellmeier);
        nd = glint_surface_index(&known, 587.5618);
        spread = glint_surface_index(&known, 486.1327) -
                 glint_surface_index(&known, 656.2725);
        if (fabs(nd - s->nd) < 2e-5 && fabs((nd - 1) / spread - s->vd) < 0.3)
            return true;
    }
    return false;
}

/* Returns whether the element between surface S and the next one has an
 * aspheric surface, so that it must be moulded. S must not be the last
 * surface. */
static bool is_element_moulded(const struct glint_surface *s)
{
    return glint_surface_is_shaped(&s[0]) || glint_surface_is_shaped(&s[1]);
}

/* Returns whether ND has more than three decimals. Fewer decimals do not
 * identify a glass: 1.755 is a lanthanum crown and a flint. */
static bool is_index_precise(double nd)
{
    return fabs(1e3 * nd - nearbyint(1e3 * nd)) > 1e-6;
}

/* Returns the index of the first surface of LENS whose nd or Vd is suspect, and
 * writes the reason to TEXT[BYTES]. Returns -1 if there is none. A surface is
 * suspect if no glass has its nd and Vd, or if an earlier surface has the same
 * nd, stated with four decimals or more, and a Vd that differs by over 1.5. */
static int find_suspect_glass(const struct glint_prescription *lens, char *text,
                              size_t bytes)
{
    for (int k = 0; k < lens->n_surfaces; k++) {
        const struct glint_surface *s = &lens->surface[k];

        if (!(s->vd > 0))
            continue;
        if (!is_glass_possible(s->nd, s->vd, is_element_moulded(s))) {
            snprintf(text, bytes, "no glass has nd %.6g and Vd %.4g", s->nd,
                     s->vd);
            return k;
        }
        for (int i = 0; i < k && is_index_precise(s->nd); i++)
            if (fabs(lens->surface[i].nd - s->nd) < 2e-6 &&
                fabs(lens->surface[i].vd - s->vd) > 1.5) {
                snprintf(text, bytes,
                         "nd %.6g has Vd %.4g here and %.4g at surface %d",
                         s->nd, s->vd, lens->surface[i].vd, i);
                return k;
            }
    }
    return -1;
}

/* A number in the table, and the corrections found for it */
struct search {
    const char *text;
    size_t bytes;
    size_t at, length; /* offset and length of the number in TEXT, bytes */
    int line, column;
    int surface; /* index of the surface defined by the line; -1: the stop */
    /* index of the surface if its glass is the only error of the table, else
     * -1 */
    int glass;
    struct mend *mend;
    int n;
    char edited[LENS_TEXT + 32];
};

/* Parses TEXT[BYTES] into LENS. Returns whether it is a table without
 * errors; else ERROR states the first error. */
static bool is_table_valid(const char *text, size_t bytes, const char *file,
                           struct glint_prescription *lens,
                           struct glint_error *error)
{
    char why[120];
    int k;

    if (glint_prescription_parse(lens, text, bytes, file, error) != GLINT_OK)
        return false;
    k = find_suspect_glass(lens, why, sizeof why);
    if (k >= 0)
        snprintf(error->text, sizeof error->text, "%s: surface %d: %s", file, k,
                 why);
    return k < 0;
}

static double compute_relative_deviation(double got, double stated)
{
    return stated > 0 ? fabs(got / stated - 1) : 0;
}

/* Returns whether correction A is likelier than B. Known glasses rank first,
 * then signs and swapped digits, then the smaller difference from the stated
 * values. */
static bool is_correction_likelier(const struct mend *a, const struct mend *b)
{
    const bool first = a->slip <= SLIP_SWAP, second = b->slip <= SLIP_SWAP;

    return a->listed != b->listed ? a->listed
           : first != second      ? first
                                  : a->off < b->off;
}

static void insert_correction(struct search *s, const struct mend *found)
{
    int k = s->n < MENDS ? s->n : MENDS;

    s->n++;
    for (; k > 0 && is_correction_likelier(found, &s->mend[k - 1]); k--)
        if (k < MENDS)
            s->mend[k] = s->mend[k - 1];
    if (k < MENDS)
        s->mend[k] = *found;
}

/* Replaces the current number by NUMBER and records this correction if the
 * changed table has no errors. */
static void try_replacement_number(struct search *s, const char *number,
                                   enum slip slip)
{
    static struct glint_prescription lens;
    struct glint_error error = {""};
    struct glint_optics optics;
    const size_t n = strlen(number), tail = s->at + s->length;
    struct mend found = {.line = s->line, .column = s->column, .slip = slip};

    if (s->bytes + n > sizeof s->edited || n >= sizeof found.to ||
        s->length >= sizeof found.from)
        return;
    memcpy(s->edited, s->text, s->at);
    memcpy(s->edited + s->at, number, n);
    memcpy(s->edited + s->at + n, s->text + tail, s->bytes - tail);
    if (!is_table_valid(s->edited, s->bytes - s->length + n, "t", &lens,
                        &error))
        return;
    glint_optics_of(&lens, &optics);
    memcpy(found.from, s->text + s->at, s->length);
    memcpy(found.to, number, n);
    found.listed = s->glass >= 0 && is_glass_confirmed(&lens, s->glass);
    found.focal_mm = optics.focal_mm;
    found.back_mm = optics.back_focal_mm;
    found.off = fmax(
        compute_relative_deviation(optics.focal_mm, lens.check_focal_mm),
        compute_relative_deviation(optics.back_focal_mm, lens.check_back_mm));
    insert_correction(s, &found);
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static void try_digit_misprints(struct search *s, char number[24])
{
    for (size_t i = 0; i < s->length; i++) {
        const char was = number[i];
        size_t next = i + 1 + (number[i + 1] == '.');

        if (!is_digit(was))
            continue;
        for (int digit = 0; digit < 10; digit++) {
            number[i] = (char)('0' + digit);
            if (number[i] != was)
                try_replacement_number(s, number, SLIP_DIGIT);
        }
        number[i] = was;
        if (next >= s->length || !is_digit(number[next]) || number[next] == was)
            continue;
        number[i] = number[next];
        number[next] = was;
        try_replacement_number(s, number, SLIP_SWAP);
        number[next] = number[i];
        number[i] = was;
    }
}

static void try_decimal_point_shifts(struct search *s, const char number[24])
{
    const char *point = strchr(number, '.');
    char moved[24];

    for (int way = -1; way <= 1; way += 2) {
        const ptrdiff_t i = point ? point - number : -1;

        if (i < 0 || i + way < 0 || !is_digit(number[i + way]))
            continue;
        memcpy(moved, number, sizeof moved);
        moved[i] = number[i + way];
        moved[i + way] = '.';
        try_replacement_number(s, moved, SLIP_POINT);
    }
}

static void try_misprints_of_number(struct search *s)
{
    char number[24] = "", flipped[24];

    if (s->length >= sizeof number - 2)
        return;
    memcpy(number, s->text + s->at, s->length);
    if (number[0] == '-')
        try_replacement_number(s, number + 1, SLIP_SIGN);
    else {
        snprintf(flipped, sizeof flipped, "-%.21s", number);
        try_replacement_number(s, flipped, SLIP_SIGN);
    }
    try_digit_misprints(s, number);
    try_decimal_point_shifts(s, number);
}

static void try_misprints_of_line(struct search *s, size_t start, size_t end)
{
    size_t at = start;

    for (int word = 0; at < end && word < 6; word++) {
        while (at < end && (s->text[at] == ' ' || s->text[at] == '\t'))
            at++;
        s->at = at;
        while (at < end && s->text[at] != ' ' && s->text[at] != '\t' &&
               s->text[at] != '\r')
            at++;
        s->length = at - s->at;
        s->column = (int)(s->at - start) + 1;
        if (s->length == 0 || s->text[s->at] == '#')
            return;
        if (word > (s->glass < 0 ? 0 : 3) &&
            (is_digit(s->text[s->at]) || s->text[s->at] == '-' ||
             s->text[s->at] == '.'))
            try_misprints_of_number(s);
    }
}

/* Tries all misprints of each number of the surfaces and the stop: a sign, two
 * swapped digits, a wrong digit, the decimal point. If a glass is the only
 * error, tries only its nd and Vd. Stores in MEND up to MENDS corrections,
 * likeliest first, that leave TEXT without errors. Returns the number of all
 * such corrections. */
static int find_corrections(const char *text, size_t bytes,
                            struct mend mend[MENDS])
{
    static struct search s;
    static struct glint_prescription lens;
    struct glint_error error = {""};
    char why[120];
    int surface = 0;

    if (bytes > LENS_TEXT)
        return 0;
    memset(&s, 0, sizeof s);
    s.text = text;
    s.bytes = bytes;
    s.mend = mend;
    s.glass =
        glint_prescription_parse(&lens, text, bytes, "t", &error) == GLINT_OK
            ? find_suspect_glass(&lens, why, sizeof why)
            : -1;
    for (size_t at = 0; at < bytes;) {
        size_t end = at;

        while (end < bytes && text[end] != '\n')
            end++;
        s.line++;
        if (end - at > 7 && (memcmp(text + at, "surface", 7) == 0 ||
                             memcmp(text + at, "stop", 4) == 0)) {
            s.surface = text[at + 1] == 'u' ? surface++ : -1;
            if (s.glass < 0 || s.surface == s.glass)
                try_misprints_of_line(&s, at, end);
        }
        at = end + 1;
    }
    /* S is static and must not keep a pointer to the caller's array. */
    s.mend = NULL;
    return s.n;
}

static const char help[] =
    "glint lint LENS\n"
    "\n"
    "Searches a table for misprints: rims that overlap, nd and Vd of no known\n"
    "glass, one nd with two Vd, focal lengths that differ from the stated "
    "ones,\n"
    "and errors that make the table unreadable. It then corrects one number at "
    "a\n"
    "time (a sign, two swapped digits, a wrong digit, a decimal point) and "
    "lists\n"
    "the corrections after which the table is consistent, the likeliest "
    "first.\n"
    "The exit code is 5 if something is wrong.\n"
    "\n"
    "The check needs stated values: give focal-length and back-focal-length "
    "both.\n";

static const char help_end[] = COMMON_HELP;

static const char *get_misprint_name(enum slip slip)
{
    return slip == SLIP_SIGN    ? "sign"
           : slip == SLIP_SWAP  ? "digits swapped"
           : slip == SLIP_DIGIT ? "digit"
                                : "decimal point";
}

static void print_lint_text(const char *file, const char *wrong,
                            const struct mend *mend, int n)
{
    if (!*wrong) {
        printf("%s: nothing found\n", file);
        return;
    }
    puts(wrong);
    if (n == 0)
        puts("no correction of a single number makes the table consistent");
    for (int k = 0; k < n && k < MENDS; k++)
        printf("%s:%d:%d: %s instead of %s? (%s; then f = %.3f mm, back focus "
               "%.3f "
               "mm)\n",
               file, mend[k].line, mend[k].column, mend[k].to, mend[k].from,
               get_misprint_name(mend[k].slip), mend[k].focal_mm,
               mend[k].back_mm);
    if (n > MENDS)
        printf("and %d more\n", n - MENDS);
}

static void print_lint_json(const char *wrong, const struct mend *mend, int n)
{
    struct json_writer json = {.to = stdout};

    json_write(&json, "{wrong: %s, mends: %d, likeliest: [", wrong, n);
    for (int k = 0; k < n && k < MENDS; k++)
        json_write(&json,
                   "{line: %d, column: %d, from: %s, to: %s, slip: %s, "
                   "focal_length_mm: %.6f, back_focal_length_mm: %.6f}",
                   mend[k].line, mend[k].column, mend[k].from, mend[k].to,
                   get_misprint_name(mend[k].slip), mend[k].focal_mm,
                   mend[k].back_mm);
    json_write(&json, "]}\n");
}

static int lint_lens_file(const struct tool *tool, const char *name)
{
    static struct glint_prescription lens;
    struct mend mend[MENDS];
    struct glint_error error = {""};
    char path[1024];
    const char *file = strcmp(name, "-") == 0
                           ? name
                           : tool_find_lens_file(tool, name, path, sizeof path);
    uint8_t *text = NULL;
    size_t bytes = 0;
    int n = 0;
    enum glint_status status;

    if (!file)
        return EXIT_LENS;
    status =
        glint_input_read_whole_file(&text, &bytes, file, LENS_TEXT, &error);
    if (status != GLINT_OK) {
        free(text);
        return tool_fail(tool, status, error.text);
    }
    if (!is_table_valid((const char *)text, bytes, file, &lens, &error))
        n = find_corrections((const char *)text, bytes, mend);
    if (tool->json)
        print_lint_json(error.text, mend, n);
    else
        print_lint_text(file, error.text, mend, n);
    free(text);
    return error.text[0] ? EXIT_LENS : EXIT_OK;
}

int cmd_lint(int argc, char **argv)
{
    static const struct option options[] = {TOOL_COMMON_OPTIONS};
    struct tool tool = {.name = "lint", .help = help, .help_end = help_end};
    int c, code = -1;

    while (code < 0 &&
           (c = tool_getopt(argc, argv, TOOL_COMMON_SHORT, options, NULL)) >= 0)
        code = tool_apply_option(&tool, c, optarg);
    if (code < 0)
        code = tool_check_inputs(&tool, argc, argv, 1, "expects one lens");
    if (code >= 0)
        return code;
    code = tool_start_threads(&tool);
    if (code == EXIT_OK)
        code = lint_lens_file(&tool, argv[optind]);
    tool_stop_threads(&tool);
    return code;
}
