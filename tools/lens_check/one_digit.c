/* SPDX-License-Identifier: MIT */
#include "lens_check/one_digit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "lens_check/glass_map.h"

/* A number of the table, and what is tried for it. */
struct search {
    const char *text;
    size_t bytes;
    size_t at, length; /* the number */
    int line, column;
    int surface; /* of the line, -1: the stop */
    int glass;   /* surface whose glass alone is wrong; -1: more is */
    struct mend *mend;
    int n;
    char edited[LENS_TEXT + 32];
};

bool table_is_right(const char *text, size_t bytes, const char *file,
                    struct glint_prescription *lens, struct glint_error *error)
{
    char why[120];
    int k;

    if (glint_prescription_parse(lens, text, bytes, file, error) != GLINT_OK)
        return false;
    k = glass_suspect(lens, why, sizeof why);
    if (k >= 0)
        snprintf(error->text, sizeof error->text, "%s: surface %d: %s", file, k,
                 why);
    return k < 0;
}

static double off_by(double got, double stated)
{
    return stated > 0 ? fabs(got / stated - 1) : 0;
}

/* Returns whether A is likelier than B: a glass that there is, a sign or a swap
 * before a digit, then what meets the stated values better. */
static bool is_likelier(const struct mend *a, const struct mend *b)
{
    const bool first = a->slip <= SLIP_SWAP, second = b->slip <= SLIP_SWAP;

    return a->listed != b->listed ? a->listed
           : first != second      ? first
                                  : a->off < b->off;
}

static void keep(struct search *s, const struct mend *found)
{
    int k = s->n < MENDS ? s->n : MENDS;

    s->n++;
    for (; k > 0 && is_likelier(found, &s->mend[k - 1]); k--)
        if (k < MENDS)
            s->mend[k] = s->mend[k - 1];
    if (k < MENDS)
        s->mend[k] = *found;
}

/* Tries NUMBER in place of the number. */
static void try(struct search *s, const char *number, enum slip slip)
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
    if (!table_is_right(s->edited, s->bytes - s->length + n, "t", &lens,
                        &error))
        return;
    glint_optics_of(&lens, &optics);
    memcpy(found.from, s->text + s->at, s->length);
    memcpy(found.to, number, n);
    found.listed = s->glass >= 0 && glass_is_listed(&lens, s->glass);
    found.focal_mm = optics.focal_mm;
    found.back_mm = optics.back_focal_mm;
    found.off = fmax(off_by(optics.focal_mm, lens.check_focal_mm),
                     off_by(optics.back_focal_mm, lens.check_back_mm));
    keep(s, &found);
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static void try_digits(struct search *s, char number[24])
{
    for (size_t i = 0; i < s->length; i++) {
        const char was = number[i];
        size_t next = i + 1 + (number[i + 1] == '.');

        if (!is_digit(was))
            continue;
        for (int digit = 0; digit < 10; digit++) {
            number[i] = (char)('0' + digit);
            if (number[i] != was)
                try(s, number, SLIP_DIGIT);
        }
        number[i] = was;
        if (next >= s->length || !is_digit(number[next]) || number[next] == was)
            continue;
        number[i] = number[next];
        number[next] = was;
        try(s, number, SLIP_SWAP);
        number[next] = number[i];
        number[i] = was;
    }
}

static void try_point(struct search *s, const char number[24])
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
        try(s, moved, SLIP_POINT);
    }
}

/* Tries all slips of the number at S->at. */
static void try_number(struct search *s)
{
    char number[24] = "", flipped[24];

    if (s->length >= sizeof number - 2)
        return;
    memcpy(number, s->text + s->at, s->length);
    if (number[0] == '-')
        try(s, number + 1, SLIP_SIGN);
    else {
        snprintf(flipped, sizeof flipped, "-%.21s", number);
        try(s, flipped, SLIP_SIGN);
    }
    try_digits(s, number);
    try_point(s, number);
}

/* Tries the numbers of the line at START. */
static void try_line(struct search *s, size_t start, size_t end)
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
            try_number(s);
    }
}

int find_mends(const char *text, size_t bytes, struct mend mend[MENDS])
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
            ? glass_suspect(&lens, why, sizeof why)
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
                try_line(&s, at, end);
        }
        at = end + 1;
    }
    return s.n;
}
