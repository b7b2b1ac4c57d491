/* SPDX-License-Identifier: MIT
 *
 * Checks that control lines set their values or report errors with positions,
 * that keys and the playback position work, and that files and pipes are read
 * in the same way.
 */
#define _GNU_SOURCE /* for mkstemp() and posix_openpt() */
#include <fcntl.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "control/controls.h"
#include "control/playback.h"
#include "support/scratch.h"
#include "support/test.h"

static struct control_line line;
static struct glint_error error;
static struct controls input;

static void expect_parsed_line(const char *text, enum control_verb verb,
                               int frame, int n)
{
    assert_ok(control_parse_line(text, "f:1", &line, &error));
    assert_int_equal(line.verb, verb);
    assert_int_equal(line.frame, frame);
    assert_int_equal(line.n, n);
    assert_false(line.is_change);
}

TEST(parses_every_command)
{
    expect_parsed_line("orbit 30 -10", CONTROL_ORBIT, -1, 2);
    assert_true(line.v[0] == 30 && line.v[1] == -10);
    expect_parsed_line("  25\tdistance 2.5  # near\r\n", CONTROL_DISTANCE, 25,
                       1);
    assert_true(line.v[0] == 2.5);
    expect_parsed_line("set steel alpha .05 .2", CONTROL_ALPHA, -1, 2);
    assert_string_equal(line.name[0], "steel");
    assert_int_equal(line.name_column[0], 5);
    assert_int_equal(line.column, 17);
    expect_parsed_line("set steel alpha .05", CONTROL_ALPHA, -1, 1);
    expect_parsed_line("set red colour 1 0 0", CONTROL_COLOUR, -1, 3);
    expect_parsed_line("set steel diffuse 0 0 .1", CONTROL_DIFFUSE, -1, 3);
    expect_parsed_line("material ball steel", CONTROL_MATERIAL, -1, 0);
    assert_string_equal(line.name[1], "steel");
    expect_parsed_line("show ball", CONTROL_SHOW, -1, 0);
    expect_parsed_line("0 hide ball", CONTROL_HIDE, 0, 0);
    expect_parsed_line("size ball .25", CONTROL_SIZE, -1, 1);
    expect_parsed_line("environment turn -90", CONTROL_TURN, -1, 1);
    expect_parsed_line("environment scale .5", CONTROL_SCALE, -1, 1);
    expect_parsed_line("3 environment map forest # at dusk", CONTROL_MAP, 3, 0);
    assert_string_equal(line.name[0], "forest");
    assert_int_equal(line.name_column[0], 19);
    expect_parsed_line("environment next", CONTROL_NEXT_MAP, -1, 0);
    expect_parsed_line("step", CONTROL_STEP, -1, 0);
    expect_parsed_line("step -3", CONTROL_STEP, -1, 1);
    expect_parsed_line("jump 12", CONTROL_JUMP, -1, 1);
    expect_parsed_line("play", CONTROL_PLAY, -1, 0);
    expect_parsed_line("play 12.5", CONTROL_PLAY, -1, 1);
    expect_parsed_line("pause", CONTROL_PAUSE, -1, 0);
    expect_parsed_line("stop", CONTROL_STOP, -1, 0);
    expect_parsed_line("", CONTROL_NONE, -1, 0);
    expect_parsed_line(" # all a comment", CONTROL_NONE, -1, 0);
}

static void expect_error(const char *text, const char *cause)
{
    memset(&line, 0x55, sizeof line);
    assert_int_equal(control_parse_line(text, "f:1", &line, &error),
                     GLINT_E_FORMAT);
    assert_string_equal(error.text, cause);
    assert_int_equal(line.n, 0x55555555); /* unchanged */
}

TEST(rejects_wrong_commands)
{
    static char text[400];

    expect_error("orbti 3 4",
                 "f:1:1: 'orbti' is not a command; did you mean 'orbit'?");
    expect_error("frob", "f:1:1: 'frob' is not a command");
    expect_error("orbit 3", "f:1:8: expected orbit YAW PITCH");
    expect_error("orbit 3 x",
                 "f:1:9: 'x' is not a number; expected orbit YAW PITCH");
    expect_error("orbit 3 4 5",
                 "f:1:11: '5' is one value too many; expected orbit YAW PITCH");
    expect_error("orbit 3 400",
                 "f:1:9: orbit YAW PITCH must be -360 to 360, not 400");
    expect_error("orbit nan 4",
                 "f:1:7: 'nan' is not a number; expected orbit YAW PITCH");
    expect_error("set", "f:1:4: expected set MATERIAL alpha X [Y]");
    expect_error("set steel", "f:1:10: expected set MATERIAL alpha X [Y]");
    expect_error("set steel alhpa 1",
                 "f:1:11: 'alhpa' is not a word of set; did you mean 'alpha'?");
    expect_error("environment", "f:1:12: expected environment turn DEG");
    expect_error(
        "environment nxt",
        "f:1:13: 'nxt' is not a word of environment; did you mean 'next'?");
    expect_error("environment map", "f:1:16: expected environment map NAME");
    expect_error(
        "environment map a b",
        "f:1:19: 'b' is one value too many; expected environment map NAME");
    expect_error("environment scale 0",
                 "f:1:19: environment scale X must be 1e-06 to 1000000, not 0");
    expect_error("set steel alpha 0",
                 "f:1:17: set MATERIAL alpha X [Y] must be 0.001 to 1, not 0");
    expect_error("jump 1.5", "f:1:6: jump N needs whole numbers, not 1.5");
    expect_error(
        "-1 stop",
        "f:1:1: a frame must be a whole number from 0 to 1000000000, not '-1'");
    expect_error("1.5 stop", "f:1:1: a frame must be a whole number from "
                             "0 to 1000000000, not '1.5'");
    expect_error("7 ", "f:1:3: a command must follow the frame number");
    expect_error("show a23456789012345678901234567890123",
                 "f:1:6: a name has at most 31 letters");
    memset(text, 'a', sizeof text - 1);
    expect_error(text, "f:1:256: a line has at most 255 bytes");
}

/* Checks that all forms of a command, which begin with the same word, have the
 * same number of names. */
TEST(forms_of_a_word_have_equal_names)
{
    for (int i = 0; i < control_n_forms; i++)
        for (int k = 0; k < i; k++)
            if (strcmp(control_forms[i].word, control_forms[k].word) == 0) {
                assert_int_equal(control_forms[i].names,
                                 control_forms[k].names);
                assert_non_null(control_forms[i].clause);
                assert_non_null(control_forms[k].clause);
            }
}

TEST(keys_become_commands)
{
    assert_int_equal(keyboard_parse_key("\033[Cx", 4, &line), 3);
    assert_int_equal(line.verb, CONTROL_ORBIT);
    assert_true(line.is_change && line.v[0] > 0 && line.v[1] == 0);
    assert_int_equal(keyboard_parse_key("+", 1, &line), 1);
    assert_true(line.verb == CONTROL_DISTANCE && line.v[0] < 1);
    /* not control keys: a function key, a lone escape, a letter */
    assert_int_equal(keyboard_parse_key("\033[15~+", 6, &line), 5);
    assert_int_equal(line.verb, CONTROL_NONE);
    assert_int_equal(keyboard_parse_key("\033", 1, &line), 1);
    assert_int_equal(line.verb, CONTROL_NONE);
    assert_int_equal(keyboard_parse_key("}", 1, &line), 1);
    assert_true(line.verb == CONTROL_SCALE && line.v[0] > 1);
    assert_int_equal(keyboard_parse_key("e", 1, &line), 1);
    assert_true(line.verb == CONTROL_NEXT_MAP && line.is_change);
    assert_int_equal(keyboard_parse_key("z", 1, &line), 1);
    assert_int_equal(line.verb, CONTROL_NONE);
    assert_int_equal(keyboard_open(&(struct keyboard){0}, -1), GLINT_E_IO);
}

static int execute_line_and_play_next_frame(struct playback *p,
                                            const char *text, double elapsed_s)
{
    assert_ok(control_parse_line(text, "f:1", &line, &error));
    assert_int_equal(playback_execute_command(p, &line), *text != 0);
    return playback_next_frame(p, elapsed_s);
}

TEST(playback_advances_frames)
{
    struct playback p;

    playback_init(&p);
    /* Without a frame rate, each picture shows the next frame, whatever time
     * drawing takes. */
    for (int i = 0; i < 5; i++)
        assert_int_equal(playback_next_frame(&p, 7), i);
    assert_int_equal(execute_line_and_play_next_frame(&p, "pause", 1), 4);
    assert_int_equal(execute_line_and_play_next_frame(&p, "", 1), 4);
    assert_int_equal(execute_line_and_play_next_frame(&p, "step", 1), 5);
    assert_int_equal(execute_line_and_play_next_frame(&p, "step -2", 1), 3);
    assert_int_equal(execute_line_and_play_next_frame(&p, "step -9", 1), 0);
    assert_int_equal(execute_line_and_play_next_frame(&p, "jump 20", 1), 20);
    assert_int_equal(execute_line_and_play_next_frame(&p, "", 1), 20);
    assert_int_equal(execute_line_and_play_next_frame(&p, "play 10", .1), 21);
    /* at 40 pictures per second each frame is shown 4 times */
    for (int i = 1; i < 40; i++)
        assert_int_equal(playback_next_frame(&p, .025), 21 + i / 4);
    assert_int_equal(execute_line_and_play_next_frame(&p, "play 0", 9), 30);
    assert_int_equal(execute_line_and_play_next_frame(&p, "stop", 9), 0);
    assert_int_equal(execute_line_and_play_next_frame(&p, "", 9), 0);
    p.last = 2;
    assert_int_equal(execute_line_and_play_next_frame(&p, "play", 1), 1);
    assert_int_equal(execute_line_and_play_next_frame(&p, "", 1), 2);
    assert_int_equal(execute_line_and_play_next_frame(&p, "", 1), 2);
    assert_int_equal(execute_line_and_play_next_frame(&p, "jump 9", 1), 2);
}

static void expect_next_command(int picture, enum control_verb verb)
{
    const struct control_line *const l = controls_next_line(&input, picture);

    assert_non_null(l);
    assert_int_equal(l->verb, verb);
}

static enum glint_status read_controls_from_text(const char *text)
{
    FILE *const file = fopen(scratch_file, "w");

    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    return controls_open(&input, scratch_file, false, &error);
}

/* Checks that the lines of a file are applied in order, and that a line for a
 * later picture delays all lines after it. */
TEST(file_lines_are_applied_in_order)
{
    char where[CONTROL_WHERE], wanted[CONTROL_WHERE];

    assert_ok(
        read_controls_from_text("orbit 1 2\n\n# none\n3 stop\nplay\n2 pause"));
    assert_int_equal(controls_get_line(&input, 3)->verb, CONTROL_PAUSE);
    assert_null(controls_get_line(&input, 4));
    expect_next_command(0, CONTROL_ORBIT);
    assert_null(controls_next_line(&input, 2));
    expect_next_command(3, CONTROL_STOP);
    controls_format_location(&input, -1, where);
    snprintf(wanted, sizeof wanted, "%s:4", scratch_file);
    assert_string_equal(where, wanted);
    expect_next_command(3, CONTROL_PLAY);
    expect_next_command(3, CONTROL_PAUSE);
    assert_null(controls_next_line(&input, 9));
    controls_close(&input);
    assert_int_equal(read_controls_from_text("stop\n  jumb 3\n"),
                     GLINT_E_FORMAT);
    snprintf(wanted, sizeof wanted,
             "%s:2:3: 'jumb' is not a command; did you mean 'jump'?",
             scratch_file);
    assert_string_equal(error.text, wanted);
    assert_int_equal(controls_open(&input, "/nonexistent", false, &error),
                     GLINT_E_IO);
    controls_close(&input);
}

/* Checks that lines from a pipe are applied once complete, and that invalid
 * lines are counted but do not end reading. */
TEST(pipe_lines_are_applied_when_complete)
{
    int to;

    unlink(scratch_file);
    assert_int_equal(mkfifo(scratch_file, 0600), 0);
    assert_ok(controls_open(&input, scratch_file, true, &error));
    assert_null(controls_next_line(&input, 0));
    to = open(scratch_file, O_WRONLY);
    assert_true(to >= 0);
    assert_int_equal(write(to, "pau", 3), 3);
    assert_null(controls_next_line(&input, 1));
    assert_int_equal(write(to, "se\nrubbish\n5 play\nstop\n", 23), 23);
    expect_next_command(2, CONTROL_PAUSE);
    assert_null(controls_next_line(&input, 2));
    assert_int_equal(input.n_bad, 1);
    assert_non_null(strstr(input.bad.text, ":2:1: 'rubbish' is not a command"));
    assert_null(controls_next_line(&input, 4));
    expect_next_command(5, CONTROL_PLAY);
    expect_next_command(5, CONTROL_STOP);
    for (int i = 0; i < 700; i++) /* The line becomes too long. */
        assert_int_equal(write(to, "7", 1), 1);
    assert_int_equal(write(to, "\nstep\n", 6), 6);
    expect_next_command(6, CONTROL_STEP);
    assert_int_equal(input.n_bad, 2);
    close(to);
    controls_close(&input);
    unlink(scratch_file);
}

/* Reads keys from the terminal PATH in a new session. The process then ends by
 * itself or, if IS_KILLED is set, waits until it is killed. */
static void read_terminal_keys(const char *path, int is_killed)
{
    struct keyboard keys;
    int fd;

    setsid();
    fd = open(path, O_RDWR);
    ioctl(fd, TIOCSCTTY, 0);
    if (keyboard_open(&keys, fd) != GLINT_OK)
        _exit(3);
    while (!keyboard_next_command(&keys, &line))
        ;
    if (is_killed)
        raise(SIGTERM);
    exit(line.verb == CONTROL_ORBIT ? 7 : 4);
}

/* Checks that each key is received immediately, and that the terminal's mode is
 * restored, however the process ends. */
TEST(terminal_mode_is_restored)
{
    for (int is_killed = 0; is_killed < 2; is_killed++) {
        const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
        struct termios now;
        pid_t child;
        int status, fd;

        assert_true(terminal >= 0);
        assert_int_equal(grantpt(terminal) | unlockpt(terminal), 0);
        child = fork();
        if (child == 0)
            read_terminal_keys(ptsname(terminal), is_killed);
        fd = open(ptsname(terminal), O_RDWR | O_NOCTTY);
        do
            assert_int_equal(tcgetattr(fd, &now), 0);
        while (now.c_lflag & ECHO);
        assert_false(now.c_lflag & ICANON);
        assert_true(now.c_lflag & ISIG);
        assert_int_equal(write(terminal, "x\033[A", 4), 4);
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(is_killed ? WIFSIGNALED(status) : WEXITSTATUS(status) == 7);
        assert_int_equal(tcgetattr(fd, &now), 0);
        assert_int_equal(now.c_lflag & (ECHO | ICANON), ECHO | ICANON);
        close(fd);
        close(terminal);
    }
}

TEST_GROUP(scratch_create_file, scratch_remove_file);
