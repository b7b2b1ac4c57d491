/* SPDX-License-Identifier: MIT
 *
 * Checks which characters of untrusted text are printed to a terminal, and how
 * strings are escaped in JSON.
 */
#include "posix/error.h"
#include "options/json_writer.h"
#include "support/test.h"

static const struct {
    const char *text, *clean, *json;
} cases[] = {
    {"plain", "plain", "\"plain\""},
    {"a\033[2Jb\x7f", "a?[2Jb?", "\"a\\u001b[2Jb\\u007f\""},
    {"K\xc3\xb6ln \xe2\x98\x85 \xf0\x9f\x94\xa6",
     "K\xc3\xb6ln \xe2\x98\x85 \xf0\x9f\x94\xa6",
     "\"K\xc3\xb6ln \xe2\x98\x85 \xf0\x9f\x94\xa6\""},
    {"\xc2\x9b"
     "31m",
     "??31m", "\"\\ufffd\\ufffd31m\""}, /* U+009B, CSI */
    {"\x9b"
     "31m",
     "?31m", "\"\\ufffd31m\""},
    {"\xc0\xaf \xed\xa0\x80 \xf4\x90\x80\x80", "?? ??? ????",
     "\"\\ufffd\\ufffd \\ufffd\\ufffd\\ufffd \\ufffd\\ufffd\\ufffd\\ufffd\""},
    {"cut \xe2\x98", "cut ??", "\"cut \\ufffd\\ufffd\""},
    {"\"\\", "\"\\", "\"\\\"\\\\\""},
};

TEST(replaces_invalid_utf8)
{
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[64];

        snprintf(text, sizeof text, "%s", cases[k].text);
        glint_utf8_replace_unprintable(text);
        assert_string_equal(text, cases[k].clean);
    }
}

TEST(error_texts_are_valid_utf8)
{
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct glint_error error;
        char want[80];

        glint_error_report(&error, GLINT_E_IO, "x", "%s", cases[k].text);
        snprintf(want, sizeof want, "x: %s", cases[k].clean);
        assert_string_equal(error.text, want);
    }
}

TEST(json_strings_are_valid_utf8)
{
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        FILE *file = tmpfile();
        char got[128];

        assert_non_null(file);
        json_write(&(struct json_writer){.to = file}, "%s", cases[k].text);
        rewind(file);
        got[fread(got, 1, sizeof got - 1, file)] = '\0';
        assert_string_equal(got, cases[k].json);
        fclose(file);
    }
}

TEST(json_writer_prints_objects)
{
    FILE *file = tmpfile();
    struct json_writer json = {.to = file};
    /* volatile, so that the compiler does not know the value */
    const char *volatile const none = NULL;
    char got[256];

    assert_non_null(file);
    json_write(&json, "{name: %s, none: %s, x: %.2f, y: %.2f, list: [", "a\"b",
               none, 0.5, (double)NAN);
    for (int i = 0; i < 2; i++)
        json_write(&json, "\n {%s: %d, %s_ms: %zu, is: %c}", "n", i, "draw",
                   (size_t)7, i == 1);
    json_write(&json, "\n], empty: {}, zero: 0, big: %lld}\n", -(1LL << 40));
    rewind(file);
    got[fread(got, 1, sizeof got - 1, file)] = '\0';
    assert_string_equal(
        got, "{\"name\": \"a\\\"b\", \"none\": null, \"x\": 0.50, \"y\": null, "
             "\"list\": [\n {\"n\": 0, \"draw_ms\": 7, \"is\": false},\n "
             "{\"n\": 1, \"draw_ms\": 7, \"is\": true}\n], \"empty\": {}, "
             "\"zero\": 0, \"big\": -1099511627776}\n");
    fclose(file);
}
