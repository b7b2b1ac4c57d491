/* SPDX-License-Identifier: MIT
 *
 * Tests output files: after any failure an output file is either complete or
 * absent.
 */
/* NOLINTNEXTLINE(bugprone-reserved-identifier): flock */
#define _DEFAULT_SOURCE

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "posix/input.h"
#include "posix/output.h"
#include "support/fakes/wrapped.h"
#include "support/scratch.h"
#include "support/test.h"

static struct glint_error error;

static char path[64];
/* errno that the next close() sets; 0: close() succeeds */
static int close_errno;

int __wrap_close(int fd)
{
    const int number = close_errno, result = __real_close(fd);

    close_errno = 0;
    errno = number ? number : errno;
    return number ? -1 : result;
}

TEST_OPEN
{
    scratch_create_dir();
    snprintf(path, sizeof path, "%s/x.ppm", scratch_dir);
}

static void write_text_file(const char *text)
{
    FILE *const f = fopen(path, "w");

    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void expect_file_text(const char *text)
{
    uint8_t *data;
    size_t bytes;

    assert_ok(glint_input_read_whole_file(&data, &bytes, path, 1000, &error));
    assert_int_equal(bytes, strlen(text));
    assert_memory_equal(data, text, bytes);
    free(data);
}

static mode_t read_file_mode(const char *name)
{
    struct stat st;

    assert_int_equal(stat(name, &st), 0);
    return st.st_mode & 0777;
}

static void open_output_with_text(struct glint_output *out, const char *text)
{
    assert_ok(glint_output_open(out, path, GLINT_OUTPUT_BINARY, &error));
    assert_ok(glint_output_write(out, text, strlen(text), &error));
}

static void check_no_file_after_signal(int signal_number, int handled)
{
    int how;
    const pid_t child = fork();

    if (child == 0) {
        struct glint_output out, other;

        signal(signal_number, handled ? SIG_IGN : SIG_DFL);
        if (glint_output_open(&other, path, GLINT_OUTPUT_BINARY, &error) ||
            glint_output_open(&out, path, GLINT_OUTPUT_BINARY, &error))
            _exit(99);
        glint_output_abort(&other);
        raise(signal_number);
        glint_output_abort(&out);
        _exit(7);
    }
    assert_int_equal(waitpid(child, &how, 0), child);
    if (handled) {
        assert_true(WIFEXITED(how));
        assert_int_equal(WEXITSTATUS(how), 7);
    } else {
        assert_true(WIFSIGNALED(how));
        assert_int_equal(WTERMSIG(how), signal_number);
    }
    assert_int_equal(scratch_count_entries(scratch_dir), 0);
}

/* Checks that a signal leaves no file behind. This test runs first, as the
 * first open installs the signal handlers of the whole process. */
TEST(no_file_is_left_after_signals)
{
    check_no_file_after_signal(SIGINT, 0);
    check_no_file_after_signal(SIGTERM, 0);
    check_no_file_after_signal(SIGHUP, 0);
    check_no_file_after_signal(SIGHUP,
                               /* nohup starts processes that ignore SIGHUP */
                               1);
}

TEST(no_file_is_left_after_exit)
{
    int how;
    const pid_t child = fork();

    if (child == 0) {
        struct glint_output out;

        exit(glint_output_open(&out, path, GLINT_OUTPUT_TEXT, &error) ? 1 : 0);
    }
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
    assert_int_equal(scratch_count_entries(scratch_dir), 0);
}

TEST(commit_creates_the_file)
{
    const mode_t old = umask(027);
    struct glint_output out;

    open_output_with_text(&out, "one");
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(scratch_count_entries(scratch_dir),
                     1); /* the temporary file */
    assert_string_equal(strrchr(out.tmp, '.'), ".ppm");
    assert_ok(glint_output_commit(&out, &error));
    umask(old);
    expect_file_text("one");
    assert_int_equal(read_file_mode(path), 0640);
    assert_int_equal(scratch_count_entries(scratch_dir), 1);
    glint_output_abort(&out); /* After a commit, there is nothing to remove. */
    unlink(path);
}

TEST(abort_leaves_no_file)
{
    struct glint_output out;

    open_output_with_text(&out, "one");
    glint_output_abort(&out);
    glint_output_abort(&out);
    assert_int_equal(scratch_count_entries(scratch_dir), 0);
}

TEST(commit_replaces_the_old_file)
{
    struct glint_output out;

    write_text_file("old");
    chmod(path, 0604);
    open_output_with_text(&out, "new");
    expect_file_text("old");
    glint_output_abort(&out);
    expect_file_text("old");
    open_output_with_text(&out, "new");
    assert_ok(glint_output_commit(&out, &error));
    expect_file_text("new");
    assert_int_equal(read_file_mode(path), 0604);
    assert_int_equal(scratch_count_entries(scratch_dir), 1);
    unlink(path);
}

/* Checks that a temporary file is locked. Without the lock, other processes
 * would take it for an abandoned file and delete it. */
TEST(temporary_file_is_locked)
{
    struct glint_output out;
    int fd;

    open_output_with_text(&out, "one");
    fd = open(out.tmp, O_RDONLY);
    assert_true(fd >= 0);
    assert_int_equal(flock(fd, LOCK_EX | LOCK_NB), -1);
    glint_output_abort(&out);
    assert_int_equal(flock(fd, LOCK_EX | LOCK_NB), 0);
    close(fd);
}

TEST(existing_temporary_name_is_not_overwritten)
{
    struct glint_output out;
    char taken[80];
    unsigned n;

    open_output_with_text(&out, "one");
    assert_int_equal(sscanf(strrchr(out.tmp, '-'), "-%u", &n), 1);
    glint_output_abort(&out);
    write_text_file("theirs");
    snprintf(taken, sizeof taken, "%s/.glint-%ld-%u.ppm", scratch_dir,
             (long)getpid(), n + 1);
    assert_int_equal(rename(path, taken), 0);
    open_output_with_text(&out, "ours");
    assert_string_not_equal(out.tmp, taken);
    assert_ok(glint_output_commit(&out, &error));
    expect_file_text("ours");
    assert_int_equal(rename(taken, path), 0);
    expect_file_text("theirs");
    unlink(path);
}

/* Checks that flushed data is in the file before the commit, which must not
 * write it again. */
TEST(flushed_data_is_in_the_file)
{
    struct glint_output out;
    struct stat st;

    open_output_with_text(&out, "one");
    assert_ok(glint_output_flush(&out, &error));
    assert_int_equal(stat(out.tmp, &st), 0);
    assert_int_equal(st.st_size, 3);
    assert_ok(glint_output_write(&out, "two", 3, &error));
    assert_ok(glint_output_commit(&out, &error));
    expect_file_text("onetwo");
    unlink(path);
}

/* Checks that close() is tested for errors: some file systems report the loss
 * of data only there. */
TEST(failing_close_is_an_error)
{
    struct glint_output out;

    write_text_file("old");
    open_output_with_text(&out, "new");
    close_errno = EIO;
    assert_int_equal(glint_output_commit(&out, &error), GLINT_E_OUTPUT);
    expect_file_text("old");
    assert_int_equal(scratch_count_entries(scratch_dir), 1);
    open_output_with_text(&out, "new");
    close_errno = EINTR;
    assert_ok(glint_output_commit(&out, &error));
    expect_file_text("new");
    unlink(path);
}

TEST(follows_links)
{
    char link_path[80];
    struct glint_output out;
    struct stat st;

    snprintf(link_path, sizeof link_path, "%s/link.ppm", scratch_dir);
    write_text_file("old");
    assert_int_equal(symlink(path, link_path), 0);
    assert_ok(glint_output_open(&out, link_path, GLINT_OUTPUT_BINARY, &error));
    assert_ok(glint_output_write(&out, "new", 3, &error));
    assert_ok(glint_output_commit(&out, &error));
    expect_file_text("new");
    assert_int_equal(lstat(link_path, &st), 0);
    assert_true(S_ISLNK(st.st_mode));
    unlink(link_path);
    unlink(path);
}

/* Checks that data arrives in order if writes are smaller than the buffer, as
 * large as the buffer, or larger. */
TEST(writes_of_any_size_keep_their_order)
{
    static const size_t sizes[] = {1, 65535, 1, 65536, 3, 200000, 65537, 7};
    static uint8_t data[200000];
    uint8_t *read_back;
    size_t bytes, at = 0;
    struct glint_output out;

    open_output_with_text(&out, "");
    for (size_t i = 0; i < 8; i++) {
        memset(data, (int)i + 1, sizes[i]);
        assert_ok(glint_output_write(&out, data, sizes[i], &error));
    }
    assert_ok(glint_output_commit(&out, &error));
    assert_ok(
        glint_input_read_whole_file(&read_back, &bytes, path, 1 << 20, &error));
    assert_int_equal(bytes, 396620);
    for (size_t i = 0; i < 8; i++)
        for (size_t j = 0; j < sizes[i]; j++)
            if (read_back[at++] != i + 1)
                fail_msg("write %zu, byte %zu", i, j);
    free(read_back);
    unlink(path);
}

TEST(full_device_is_an_error)
{
    static uint8_t data[100000];
    struct glint_output out;

    assert_ok(
        glint_output_open(&out, "/dev/full", GLINT_OUTPUT_BINARY, &error));
    assert_ok(glint_output_write(&out, data, 10, &error));
    assert_int_equal(glint_output_write(&out, data, sizeof data, &error),
                     GLINT_E_OUTPUT);
    assert_string_equal(error.text, "/dev/full: No space left on device");
    assert_int_equal(glint_output_write(&out, data, 1, &error), GLINT_E_OUTPUT);
    assert_int_equal(glint_output_commit(&out, &error), GLINT_E_OUTPUT);

    /* If all data fits into the buffer, only the commit can fail. */
    assert_ok(glint_output_open(&out, "/dev/full", GLINT_OUTPUT_TEXT, &error));
    assert_ok(glint_output_write(&out, data, 10, &error));
    assert_int_equal(glint_output_commit(&out, &error), GLINT_E_OUTPUT);
    assert_int_equal(out.fd, -1);
}

/* Writes more than the process's file size limit, which simulates a full
 * disk. Returns 0 if the error is reported. */
static int write_beyond_file_size_limit(void)
{
    static uint8_t data[100000];
    const struct rlimit limit = {5000, 5000};
    struct glint_output out;

    if (setrlimit(RLIMIT_FSIZE, &limit) ||
        glint_output_open(&out, path, GLINT_OUTPUT_BINARY, &error))
        return 1;
    if (glint_output_write(&out, data, sizeof data, &error) != GLINT_E_OUTPUT)
        return 2;
    return glint_output_commit(&out, &error) == GLINT_E_OUTPUT ? 0 : 3;
}

TEST(full_disk_keeps_the_old_file)
{
    int how;

    write_text_file("old");
    const pid_t child = fork();
    if (child == 0)
        _exit(write_beyond_file_size_limit());
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
    expect_file_text("old");
    assert_int_equal(scratch_count_entries(scratch_dir), 1);
    unlink(path);
}

TEST(closed_pipe_is_an_error)
{
    static uint8_t data[100000];
    char name[32];
    struct glint_output out;
    int fd[2];

    assert_int_equal(pipe(fd), 0);
    snprintf(name, sizeof name, "/dev/fd/%d", fd[1]);
    assert_ok(glint_output_open(&out, name, GLINT_OUTPUT_BINARY, &error));
    assert_null(out.tmp);
    close(fd[0]);
    assert_int_equal(glint_output_write(&out, data, sizeof data, &error),
                     GLINT_E_CLOSED);
    assert_int_equal(glint_output_flush(&out, &error), GLINT_E_CLOSED);
    assert_int_equal(glint_output_commit(&out, &error), GLINT_E_CLOSED);
    close(fd[1]);
}

TEST(nonblocking_pipe_gets_all_data)
{
    static uint8_t data[300000];
    struct glint_output out;
    char name[32];
    int fd[2], how;

    assert_int_equal(pipe(fd), 0);
    const pid_t child = fork();
    if (child == 0) {
        static uint8_t got[1000];
        size_t sum = 0;
        ssize_t n;

        close(fd[1]);
        while ((n = read(fd[0], got, sizeof got)) > 0)
            sum += (size_t)n;
        _exit(sum == sizeof data ? 0 : 1);
    }
    close(fd[0]);
    snprintf(name, sizeof name, "/dev/fd/%d", fd[1]);
    assert_ok(glint_output_open(&out, name, GLINT_OUTPUT_BINARY, &error));
    assert_int_equal(fcntl(out.fd, F_SETFL, O_NONBLOCK), 0);
    assert_ok(glint_output_write(&out, data, sizeof data, &error));
    assert_ok(glint_output_commit(&out, &error));
    close(fd[1]);
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
}

static void check_path_is_rejected(const char *name, const char *text)
{
    struct glint_output out;

    assert_int_equal(glint_output_open(&out, name, GLINT_OUTPUT_BINARY, &error),
                     GLINT_E_OUTPUT);
    assert_string_equal(error.text, text);
    assert_int_equal(out.fd, -1);
}

TEST(rejects_paths_that_cannot_be_written)
{
    char name[300], text[300];
    struct glint_output out;

    check_path_is_rejected("/nowhere/x.ppm",
                           "/nowhere/x.ppm: cannot create a temporary file in "
                           "its folder '/nowhere': No such file or directory");
    check_path_is_rejected("", ": No such file or directory");
    snprintf(text, sizeof text, "%s: Is a directory", scratch_dir);
    check_path_is_rejected(scratch_dir, text);

    /* The message must omit the beginning of a long file name, and contain the
     * complete cause. */
    snprintf(name, sizeof name, "/nowhere/%0250d/x\n.ppm", 1);
    assert_int_equal(glint_output_open(&out, name, GLINT_OUTPUT_BINARY, &error),
                     GLINT_E_OUTPUT);
    assert_memory_equal(error.text, "...000", 6);
    assert_non_null(strstr(
        error.text,
        "1/x?.ppm: cannot create a temporary file in its folder '...000000"));
    assert_non_null(strstr(error.text, "': No such file or directory"));
}

TEST(checks_paths_before_writing)
{
    char name[300], text[300];

    snprintf(text, sizeof text, "%s: is a folder; name a file in it",
             scratch_dir);
    assert_int_equal(glint_output_check_path(scratch_dir, &error),
                     GLINT_E_OUTPUT);
    assert_string_equal(error.text, text);
    assert_int_equal(glint_output_check_path("/nowhere/x.ppm", &error),
                     GLINT_E_OUTPUT);
    assert_string_equal(error.text,
                        "/nowhere/x.ppm: cannot create a temporary file in its "
                        "folder '/nowhere': No such file or directory");
    assert_ok(glint_output_check_path("-", &error));
    assert_ok(glint_output_check_path("/dev/null", &error));
    snprintf(name, sizeof name, "%s/x.ppm", scratch_dir);
    assert_ok(glint_output_check_path(name, &error));
    assert_int_equal(scratch_count_entries(scratch_dir), 0);
}

TEST(limits_the_number_of_open_outputs)
{
    struct glint_output out[17];
    char name[80];
    int n = 0;

    for (; n < 17; n++) {
        snprintf(name, sizeof name, "%s/%d", scratch_dir, n);
        if (glint_output_open(&out[n], name, GLINT_OUTPUT_TEXT, &error))
            break;
        assert_int_equal(scratch_count_entries(scratch_dir), n + 1);
    }
    assert_int_equal(n, 16);
    while (n-- > 0)
        glint_output_abort(&out[n]);
    assert_int_equal(scratch_count_entries(scratch_dir), 0);
}

TEST_CLOSE
{
    scratch_remove_dir();
}
