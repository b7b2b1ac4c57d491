/* SPDX-License-Identifier: MIT
 *
 * Checks files that solo, mute or tint single ghosts: they set the stated
 * values, and invalid files are rejected.
 */
#include "model/ghost_file.h"
#include "support/test.h"

/* Makes a setup with four table entries. The first three are ghosts; entry 3 is
 * a second pupil part of ghost 1. */
static struct glint_setup *make_setup_of_three_ghosts(void)
{
    static const int pair[4][2] = {{3, 1}, {12, 2}, {12, 5}, {12, 2}};
    struct glint_setup *s = calloc(1, sizeof *s);

    assert_non_null(s);
    s->n_ghosts = 4;
    s->n_parts = 1;
    for (int i = 0; i < 4; i++) {
        s->ghost[i].i = pair[i][0];
        s->ghost[i].j = pair[i][1];
    }
    return s;
}

static enum glint_status parse_ghost_file_text(const char *text,
                                               struct glint_tint **tints,
                                               struct glint_error *error)
{
    struct glint_setup *s = make_setup_of_three_ghosts();
    enum glint_status status;

    error->text[0] = '\0';
    status = ghost_file_parse(tints, "g.txt", text, strlen(text), s, "lens-a",
                              error);
    free(s);
    return status;
}

static double read_ghost_gain(const struct glint_tint *tints, int ghost)
{
    return glint_real_value(tints[ghost].gain);
}

TEST(parses_gains_and_mutes)
{
    struct glint_tint *t;
    struct glint_error error;

    assert_ok(parse_ghost_file_text("# remark\nlens lens-a\n\n0 mute # gone\r\n"
                                    "\t12-2  gain 2.5 tint 1,0.5,0\n",
                                    &t, &error));
    assert_true(read_ghost_gain(t, 0) == 0 && read_ghost_gain(t, 1) == 2.5 &&
                read_ghost_gain(t, 2) == 1);
    assert_int_equal(t[1].rgb_q14[0], 16384);
    assert_int_equal(t[1].rgb_q14[1], 8192);
    assert_int_equal(t[1].rgb_q14[2], 0);
    /* entry 3 is a second pupil part of ghost 1 */
    assert_memory_equal(&t[3], &t[1], sizeof *t);
    assert_int_equal(t[2].rgb_q14[2], 16384);
    free(t);
}

TEST(solo_mutes_all_other_ghosts)
{
    struct glint_tint *t;
    struct glint_error error;

    assert_ok(parse_ghost_file_text("1 solo gain 3\n2 mute\n", &t, &error));
    assert_true(read_ghost_gain(t, 0) == 0 && read_ghost_gain(t, 1) == 3);
    assert_true(read_ghost_gain(t, 2) == 0 && read_ghost_gain(t, 3) == 3);
    free(t);
    assert_int_equal(
        parse_ghost_file_text("1 mute\n2 solo\n1 solo\n", &t, &error),
        GLINT_E_FORMAT);
    assert_non_null(strstr(error.text, ":3: solo and mute"));
}

TEST(printed_lines_parse_to_the_same_values)
{
    const struct glint_tint odd = {{16384, 4096, 65536}, {1 << 30, -29}};
    struct glint_tint *t;
    struct glint_error error;
    char line[200];

    ghost_file_write_line(line, sizeof line, 2, &odd);
    assert_ok(parse_ghost_file_text(line, &t, &error));
    assert_memory_equal(&t[2], &odd, sizeof odd);
    free(t);
    ghost_file_write_line(line, sizeof line, 0, NULL);
    assert_ok(parse_ghost_file_text(line, &t, &error));
    assert_true(read_ghost_gain(t, 0) == 1);
    free(t);
}

TEST(rejects_wrong_lines)
{
    static const char *const bad[] = {
        "3 mute",       "-1 mute",     "x mute",         "5-1 solo",
        "1 quiet",      "1 gain",      "1 gain -1",      "1 gain 1001",
        "1 gain nan",   "1 tint 1,1",  "1 tint 1,1,1,1", "1 tint 5,1,1",
        "lens lens-b",  "lens",        "1 tint -1,0,0",  "12-9 mute",
        "1 gain 1 mut", "12-2-1 mute", "1 gain 1e400",   "1.5 mute",
        "2 solo mute"};

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct glint_tint *t;
        struct glint_error error;
        char text[100];

        strcpy(text, "# one\n\n0 mute\n");
        strcat(text, bad[i]);
        assert_int_equal(parse_ghost_file_text(text, &t, &error),
                         GLINT_E_FORMAT);
        assert_null(t);
        assert_ptr_equal(strstr(error.text, "g.txt:4: "), error.text);
    }
}
