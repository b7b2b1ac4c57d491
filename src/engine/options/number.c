/* SPDX-License-Identifier: MIT */
#include "glint/options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* max number of digits of a number; longer numbers are rejected */
enum { MOST_DIGITS = 100 };

static const char *find_digits_end(const char *at)
{
    while (*at >= '0' && *at <= '9')
        at++;
    return at;
}

/* Parses the exponent at AT, such as "e-3". Sets EXPONENT to its value, and
 * returns a pointer to the end of the text that was parsed. If there is no
 * exponent, sets EXPONENT to 0 and returns AT. */
static const char *parse_exponent(const char *at, long *exponent)
{
    const bool is_signed = *at && (at[1] == '-' || at[1] == '+');
    const char *const first = at + 1 + is_signed;
    const char *end;

    *exponent = 0;
    if ((*at != 'e' && *at != 'E') || find_digits_end(first) == first)
        return at;
    end = find_digits_end(first);
    if (end - first > 6)
        return at;
    *exponent = strtol(at + 1, NULL, 10);
    return end;
}

/* strtod() gets digits and an exponent without a decimal point, such as
 * "125e-1" for 12.5. So the result is correctly rounded and does not depend on
 * the locale. */
double glint_option_number(const char *text, const char **end)
{
    const char *const first = text + strspn(text, " \t");
    const char *const whole = first + (*first == '-' || *first == '+');
    const char *const point = find_digits_end(whole);
    const char *const decimals = *point == '.' ? point + 1 : point;
    const char *const last = find_digits_end(decimals);
    const int n_whole = (int)(point - whole), n = (int)(last - decimals);
    char digits[MOST_DIGITS + 24];
    long exponent;

    *end = text;
    if (n_whole + n == 0 || n_whole + n > MOST_DIGITS)
        return 0;
    *end = parse_exponent(last, &exponent);
    snprintf(digits, sizeof digits, "%s%.*s%.*se%ld", *first == '-' ? "-" : "",
             n_whole, whole, n, decimals, exponent - n);
    return strtod(digits, NULL);
}

int glint_option_numbers(const char *text, double *values, int max)
{
    for (int n = 0; n < max;) {
        const char *end;

        values[n] = glint_option_number(text, &end);
        if (end == text || !isfinite(values[n]))
            return 0;
        n++;
        if (*end == '\0')
            return n;
        if (*end != ',')
            return 0;
        text = end + 1;
    }
    return 0;
}
