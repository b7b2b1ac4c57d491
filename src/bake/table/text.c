/* SPDX-License-Identifier: MIT */
#include "bake/table/text.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/compiler.h"

STATIC_ASSERT(GLINT_TEXT_BYTES < INT_MAX);

/* max bytes of the file name in an error text; leaves space for the cause */
#define FILE_NAME_SHOWN 100

static bool is_blank_char(char c)
{
    return c == ' ' || c == '\t';
}

static bool is_digit_char(char c)
{
    return c >= '0' && c <= '9';
}

/* Returns the number of bytes of the UTF-8 character at AT; 0 if it is a
 * control character or malformed. */
static int compute_character_bytes(const char *at, const char *end)
{
    static const uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *byte = (const unsigned char *)at;
    const int length = byte[0] < 0x80   ? 1
                       : byte[0] < 0xc2 ? 0
                       : byte[0] < 0xe0 ? 2
                       : byte[0] < 0xf0 ? 3
                       : byte[0] < 0xf5 ? 4
                                        : 0;
    uint32_t code;

    if (length <= 1)
        return byte[0] == '\t' || (byte[0] >= ' ' && byte[0] != 0x7f) ? length
                                                                      : 0;
    if (end - at < length)
        return 0;
    code = byte[0] & (0x7fu >> length);
    for (int i = 1; i < length; i++) {
        if ((byte[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (byte[i] & 0x3fu);
    }
    if (code < smallest[length] || code < 0xa0 || code > 0x10ffff ||
        (code >= 0xd800 && code < 0xe000))
        return 0;
    return length;
}

/* Returns the number of bytes of the line end at AT: 0 (not a line end), 1 (LF)
 * or 2 (CRLF). */
static int compute_line_end_bytes(const char *at, const char *end)
{
    if (at < end && *at == '\n')
        return 1;
    return end - at >= 2 && at[0] == '\r' && at[1] == '\n' ? 2 : 0;
}

static bool check_text_characters(struct glint_text *text)
{
    struct glint_text_place place = {1, 1};

    for (const char *at = text->next; at < text->end;) {
        const int line_end = compute_line_end_bytes(at, text->end);
        const int length = compute_character_bytes(at, text->end);

        if (line_end) {
            place.line++;
            place.column = 1;
            at += line_end;
            continue;
        }
        if (!length)
            return glint_text_set_error(text, place,
                                        "byte 0x%02x is not text (UTF-8)",
                                        (unsigned)(unsigned char)*at);
        if (place.column + length - 1 > GLINT_LINE_BYTES)
            return glint_text_set_error(
                text, place, "line is longer than %d bytes", GLINT_LINE_BYTES);
        place.column += length;
        at += length;
    }
    return true;
}

/* Sets TEXT to the start of DATA[BYTES], after the byte order mark, if any. */
static void set_text_start(struct glint_text *text, const char *data,
                           size_t bytes, const char *file_name,
                           struct glint_error *error)
{
    static const char mark[] = {'\xef', '\xbb', '\xbf'};

    if (!bytes) /* DATA may be NULL if BYTES is 0 */
        data = "";
    if (bytes >= sizeof(mark) && memcmp(data, mark, sizeof(mark)) == 0) {
        data += sizeof(mark);
        bytes -= sizeof(mark);
    }
    *text = (struct glint_text){.file_name = file_name, .error = error};
    text->next = text->line = text->at = text->stop = data;
    text->end = data + bytes;
}

bool glint_text_open(struct glint_text *text, const char *data, size_t bytes,
                     const char *file_name, struct glint_error *error)
{
    set_text_start(text, data, bytes, file_name, error);
    if (bytes > GLINT_TEXT_BYTES)
        return glint_text_set_error(text, (struct glint_text_place){1, 1},
                                    "text is longer than %d bytes",
                                    GLINT_TEXT_BYTES);
    return check_text_characters(text);
}

void glint_text_open_data(struct glint_text *text, const char *data,
                          size_t bytes, const char *file_name,
                          struct glint_error *error)
{
    set_text_start(text, data, bytes, file_name, error);
}

bool glint_text_next_line(struct glint_text *text)
{
    const char *at = text->next;

    if (at == text->end)
        return false;
    text->line_number++;
    text->line = text->at = at;
    while (at < text->end && !compute_line_end_bytes(at, text->end) &&
           !(*at == '#' && (at == text->line || is_blank_char(at[-1]))))
        at++;
    text->stop = at;
    while (at < text->end && !compute_line_end_bytes(at, text->end))
        at++;
    text->next = at + compute_line_end_bytes(at, text->end);
    return true;
}

static struct glint_word skip_blanks_to_word(struct glint_text *text)
{
    struct glint_word word = {NULL, 0, {0, 0}};

    while (text->at < text->stop && is_blank_char(*text->at))
        text->at++;
    word.start = text->at;
    word.place.line = text->line_number;
    word.place.column = (int)(text->at - text->line) + 1;
    return word;
}

struct glint_word glint_text_next_word(struct glint_text *text)
{
    struct glint_word word = skip_blanks_to_word(text);

    while (text->at < text->stop && !is_blank_char(*text->at))
        text->at++;
    word.length = (int)(text->at - word.start);
    return word;
}

bool glint_text_read_optional_word(struct glint_text *text, const char *only,
                                   struct glint_word *word)
{
    char quote[GLINT_QUOTE_BYTES];

    *word = glint_text_next_word(text);
    return !word->length || glint_word_equals(word, only) ||
           glint_text_set_error(text, word->place,
                                "unexpected '%s'; expected %s",
                                glint_word_quote(word, quote), only);
}

struct glint_word glint_text_get_rest(struct glint_text *text)
{
    struct glint_word word = skip_blanks_to_word(text);

    text->at = text->stop;
    word.length = (int)(text->stop - word.start);
    while (word.length > 0 && is_blank_char(word.start[word.length - 1]))
        word.length--;
    return word;
}

struct glint_text_place glint_text_get_end_place(const struct glint_text *text)
{
    return (struct glint_text_place){text->line_number + 1, 1};
}

bool glint_text_set_error(const struct glint_text *text,
                          struct glint_text_place place, const char *format,
                          ...)
{
    struct glint_error *error = text->error;
    const size_t length = strlen(text->file_name);
    const bool cut = length > FILE_NAME_SHOWN;
    const char *name = text->file_name + (cut ? length - FILE_NAME_SHOWN : 0);
    const int n = snprintf(error->text, sizeof(error->text),
                           "%s%s:%d:%d: ", cut ? "..." : "", name, place.line,
                           place.column);
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(error->text + n, sizeof(error->text) - (size_t)n, format,
              arguments);
    va_end(arguments);
    return false;
}

bool glint_word_equals(const struct glint_word *word, const char *string)
{
    const size_t length = strlen(string);

    return (size_t)word->length == length &&
           memcmp(word->start, string, length) == 0;
}

const char *glint_word_quote(const struct glint_word *word,
                             char quote[GLINT_QUOTE_BYTES])
{
    /* leaves space for "..." and the terminating 0 */
    const int most = GLINT_QUOTE_BYTES - 4;
    const int n = word->length < most ? word->length : most;

    for (int i = 0; i < n; i++) {
        const char c = word->start[i];

        quote[i] = c > ' ' && c <= '~' ? c : '?';
    }
    strcpy(quote + n, n < word->length ? "..." : "");
    return quote;
}

/* State of reading a number: its unread characters, and the digits read so
 * far. */
struct digits {
    const char *at, *end;
    uint64_t value; /* value of the significant digits read so far */
    int significant, n;
};

/* Reads a run of digits and counts them in n. Only the first
 * GLINT_NUMBER_DIGITS significant ones enter the value. */
static void read_digit_run(struct digits *digits)
{
    digits->n = 0;
    for (; digits->at < digits->end && is_digit_char(*digits->at);
         digits->at++) {
        digits->n++;
        if (digits->significant || *digits->at != '0')
            digits->significant++;
        if (digits->significant <= GLINT_NUMBER_DIGITS)
            digits->value = 10 * digits->value + (uint64_t)(*digits->at - '0');
    }
}

/* Skips the next character if it is C1 or C2. Returns whether it was
 * skipped. */
static bool skip_either_char(struct digits *digits, char c1, char c2)
{
    if (digits->at == digits->end || (*digits->at != c1 && *digits->at != c2))
        return false;
    digits->at++;
    return true;
}

static bool read_number_sign(struct digits *digits)
{
    const bool negative = digits->at < digits->end && *digits->at == '-';

    skip_either_char(digits, '+', '-');
    return negative;
}

/* Reads the exponent of ten after the "e", clamped to +-1000. Returns false if
 * there are no digits. */
static bool read_decimal_exponent(struct digits *mantissa, int *exponent)
{
    struct digits power = {mantissa->at, mantissa->end, 0, 0, 0};
    const bool negative = read_number_sign(&power);

    read_digit_run(&power);
    *exponent =
        power.value < 1000 && power.significant < 4 ? (int)power.value : 1000;
    if (negative)
        *exponent = -*exponent;
    mantissa->at = power.at;
    return power.n > 0;
}

/* Returns 10^N for N = 0 .. 22, which is exact in a double. */
static double compute_power_of_ten(int n)
{
    double power = 1.0;

    while (n-- > 0)
        power *= 10.0;
    return power;
}

/* Splits WORD into DIGITS and EXPONENT, a power of ten, and sets NEGATIVE to
 * its sign. The magnitude is digits.value * 10^EXPONENT if WORD has at most
 * GLINT_NUMBER_DIGITS digits. Returns false if WORD is not a number. */
static bool split_decimal_number(const struct glint_word *word,
                                 struct digits *digits, bool *negative,
                                 int *exponent)
{
    int whole;

    *digits = (struct digits){word->start, word->start + word->length, 0, 0, 0};
    *exponent = 0;
    *negative = read_number_sign(digits);
    read_digit_run(digits);
    whole = digits->n;
    digits->n = 0;
    if (skip_either_char(digits, '.', '.'))
        read_digit_run(digits);
    if (whole + digits->n == 0 ||
        (skip_either_char(digits, 'e', 'E') &&
         !read_decimal_exponent(digits, exponent)) ||
        digits->at != digits->end)
        return false;
    *exponent -= digits->n;
    if (digits->value == 0)
        *exponent = 0;
    return true;
}

/* Returns the double nearest to the digits of WORD times 10^EXPONENT. The
 * locale has no effect, because strtod() gets no decimal point. */
static double find_nearest_double(const struct glint_word *word, int exponent)
{
    char text[GLINT_LINE_BYTES + 16];
    const char *at = word->start, *const end = at + word->length;
    int n = 0;

    for (; at < end && *at != 'e' && *at != 'E' && n < GLINT_LINE_BYTES; at++)
        if (is_digit_char(*at))
            text[n++] = *at;
    snprintf(text + n, sizeof text - (size_t)n, "e%d", exponent);
    return strtod(text, NULL);
}

const char *glint_word_parse_number(const struct glint_word *word,
                                    double *value)
{
    struct digits digits;
    bool negative;
    int exponent, more;
    double magnitude;

    if (!split_decimal_number(word, &digits, &negative, &exponent))
        return "is not a number";
    more = digits.significant > GLINT_NUMBER_DIGITS
               ? digits.significant - GLINT_NUMBER_DIGITS
               : 0;
    /* The limits are wide enough for coefficients of aspheric surfaces. For
     * example, the coefficient 1e-25 of the term h^20 adds 0.1 mm at h = 14
     * mm. */
    if (exponent + more < -60 || exponent + more > 22)
        return "is too large or too small";
    /* Integers of at most 15 digits and powers up to 10^22 are exact as
     * doubles. Their product or quotient is rounded once, so that it is the
     * nearest double. */
    magnitude = more > 0 || exponent < -22 ? find_nearest_double(word, exponent)
                : exponent < 0
                    ? (double)digits.value / compute_power_of_ten(-exponent)
                    : (double)digits.value * compute_power_of_ten(exponent);
    *value = negative ? -magnitude : magnitude;
    return NULL;
}

bool glint_word_parse_long_number(const struct glint_word *word, double *value)
{
    struct digits digits;
    bool negative;
    int exponent;
    double magnitude;

    if (!split_decimal_number(word, &digits, &negative, &exponent))
        return false;
    if (digits.significant > GLINT_NUMBER_DIGITS)
        exponent += digits.significant - GLINT_NUMBER_DIGITS;
    magnitude = (double)digits.value * pow(10.0, exponent);
    if (!isfinite(magnitude))
        return false;
    *value = negative ? -magnitude : magnitude;
    return true;
}

bool glint_text_parse_number(const struct glint_text *text,
                             const struct glint_word *word, const char *name,
                             double *value)
{
    char quote[GLINT_QUOTE_BYTES];
    const char *wrong;

    if (!word->length)
        return glint_text_set_error(text, word->place, "%s is missing", name);
    wrong = glint_word_parse_number(word, value);
    return !wrong || glint_text_set_error(text, word->place, "%s '%s' %s", name,
                                          glint_word_quote(word, quote), wrong);
}

bool glint_text_check_range(const struct glint_text *text,
                            struct glint_text_place place,
                            const struct glint_text_range *range, double value)
{
    return (value >= range->min && value <= range->max) ||
           glint_text_set_error(text, place,
                                "%s must be %.10g .. %.10g, not %g",
                                range->name, range->min, range->max, value);
}

bool glint_text_parse_value(const struct glint_text *text,
                            const struct glint_word *word,
                            const struct glint_text_range *range, double *value)
{
    return glint_text_parse_number(text, word, range->name, value) &&
           glint_text_check_range(text, word->place, range, *value);
}

bool glint_text_read_value(struct glint_text *text,
                           const struct glint_text_range *range, double *value,
                           struct glint_text_place *place)
{
    const struct glint_word word = glint_text_next_word(text);

    if (place)
        *place = word.place;
    return glint_text_parse_value(text, &word, range, value);
}
