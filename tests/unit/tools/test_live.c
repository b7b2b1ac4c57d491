/* SPDX-License-Identifier: MIT
 *
 * Runs glint live with a fake camera, from its command line to its exit code.
 * Tests that it leaks no resource, allocates nothing per frame, and handles
 * signals and unplugged cameras.
 */
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include "support/fakes/fake_camera.h"
#include "options/tool.h"
#include "support/test.h"

#define LENS "lenses/heliar-tronnier.lens"

static char config_path[] = "/tmp/glint-test-live-XXXXXX";
static char said_path[] = "/tmp/glint-test-said-XXXXXX";
static char shot_dir[] = "/tmp/glint-test-shot-XXXXXX";

static int n_waits, n_unwaited;
/* function that each wait of the program calls with the number of the wait */
static void (*script)(int wait);

/* This function replaces the program's wait for the camera. Each call delivers
 * a frame, which the script may remove. */
int __wrap_ppoll(struct pollfd *p, nfds_t n, const struct timespec *timeout,
                 const sigset_t *mask);
int __wrap_ppoll(struct pollfd *p, nfds_t n, const struct timespec *timeout,
                 const sigset_t *mask)
{
    (void)p;
    (void)n;
    (void)timeout;
    (void)mask;
    n_waits++;
    n_unwaited = 0;
    fake_camera_advance_clock(33333);
    if (camera.n_frames < 100)
        fake_camera_add_frame((uint32_t)n_waits, n_waits % 2 ? 0x80 : 0x7f);
    if (script)
        script(n_waits);
    return 1;
}

/* Makes the test fail if the program dequeues repeatedly without waiting. */
static void on_dequeue(void)
{
    if (++n_unwaited == 1000)
        raise(SIGTERM);
}

static void fail_after_many_dequeues(void)
{
    assert_true(n_unwaited < 1000);
}

static void write_live_config(const char *text)
{
    FILE *const f = fopen(config_path, "w");

    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

/* Runs `glint live -d FAKE -o null -q LINE` with standard error in a file.
 * Returns the exit code. Without the option stop in LINE, the stop is a circle:
 * the starburst of rounded blades, computed at each start and reload, would
 * take 100 times as long as the rest of the test. */
static int run_live_command(const char *line)
{
    static char words[1024];
    char *argv[64] = {NULL};
    int argc = 0, code, err;

    snprintf(words, sizeof words,
             "live -d " FAKE_PATH " -o null --stats none --lens " LENS
             " -j 1 --light 8,20,1e4 --memory 4 --stop circle %s",
             line);
    for (char *w = strtok(words, " "); w; w = strtok(NULL, " "))
        argv[argc++] = w;
    n_waits = n_unwaited = 0;
    camera.on_dequeue = on_dequeue;
    fflush(stderr);
    err = dup(STDERR_FILENO);
    assert_non_null(freopen(said_path, "w", stderr));
    code = cmd_live(argc, argv);
    fflush(stderr);
    dup2(err, STDERR_FILENO);
    close(err);
    return code;
}

/* Returns how often TEXT was printed to standard error. */
static int count_messages(const char *text)
{
    static char all[100000];
    FILE *const f = fopen(said_path, "r");
    int n = 0;

    assert_non_null(f);
    all[fread(all, 1, sizeof all - 1, f)] = '\0';
    fclose(f);
    for (const char *at = all; (at = strstr(at, text)) != NULL; at++)
        n++;
    return n;
}

static void expect_closed_without_leaks(void)
{
    fail_after_many_dequeues();
    assert_int_equal(camera.fd, -1);
    assert_int_equal(camera.n_maps, 0);
    assert_int_equal(camera.breaches, 0);
    assert_int_equal(fake_camera_count_leaks(), 0);
}

/* ------------------------------------------------------- frames and memory */

static int asked[200], blocks[200];

static void count_allocations(int wait)
{
    if (wait < 200) {
        asked[wait] = fake_camera_count_allocations();
        blocks[wait] = fake_camera_count_leaks();
    }
}

TEST_BEFORE
{
    fake_camera_reset();
}

TEST(frames_allocate_no_memory)
{
    script = count_allocations;
    assert_ok(run_live_command("--count 150 --stop polygon:6,round:0.2"));
    expect_closed_without_leaks();
    assert_int_equal(n_waits, 150);
    assert_true(asked[2] >= 5);
    /* drawing frames must allocate no memory */
    assert_int_equal(asked[149] - asked[2], 0);
}

static int asked_at_stream[200], n_streams;

static void count_allocations_at_stream_start(void)
{
    asked_at_stream[n_streams++] = fake_camera_count_allocations();
}

/* Runs LINE and calls FOLLOW at each wait. Checks that streaming was started
 * N_STARTS times, each time after all memory was allocated: between start
 * number i and the wait number wait[i], nothing may be allocated. */
static void check_allocations(const char *line, void (*follow)(int wait),
                              const int *wait, int n_starts)
{
    fake_camera_reset();
    camera.on_stream = count_allocations_at_stream_start;
    n_streams = 0;
    script = follow;
    assert_ok(run_live_command(line));
    expect_closed_without_leaks();
    assert_int_equal(n_streams, n_starts);
    for (int i = 0; i < n_starts; i++)
        if (asked[wait[i]] != asked_at_stream[i])
            fail_msg("%s: %d blocks after start %d", line,
                     asked[wait[i]] - asked_at_stream[i], i);
}

static void unplug_camera_during_wait(int wait)
{
    camera.is_gone = wait >= 20 && wait < 30;
    count_allocations(wait);
}

static void change_camera_size(int wait)
{
    if (wait % 10 == 5) {
        camera.now.width = wait % 20 == 5 ? 128 : 64;
        camera.n_events = 1;
        camera.n_frames = 0;
    }
    count_allocations(wait);
}

/* Checks that the camera starts streaming only after set-up is complete: at the
 * start, after it was unplugged, and after its size changed. */
TEST(streaming_starts_after_all_setup)
{
    static const int start[] = {10}, back[] = {10, 40},
                     sizes[] = {4, 14, 24, 29};

    check_allocations("--count 20", count_allocations, start, 1);
    check_allocations("--count 50 --reconnect", unplug_camera_during_wait, back,
                      2);
    check_allocations("--count 27", change_camera_size, sizes, 4);
}

TEST(skips_frames_before_counting)
{
    script = NULL;
    assert_ok(run_live_command("--count 5 --skip 20"));
    assert_int_equal(n_waits, 25);
    expect_closed_without_leaks();
}

static void raise_sigterm_at_wait_30(int wait)
{
    if (wait == 30)
        raise(SIGTERM);
}

/* ------------------------------------------------------------------ reload */

static int last_shot = 149;

static void raise_reload_signals(int wait)
{
    /* At both of these waits, the camera delivers frames with the same code. */
    if (wait == 3 || wait == last_shot)
        raise(SIGUSR2);
    if (wait % 10 == 5)
        raise(SIGHUP);
    count_allocations(wait);
}

static const char *read_snapshot_file(int number)
{
    static char mem[2][20000], path[64];
    char *const into = mem[number % 2];
    FILE *f;

    snprintf(path, sizeof path, "%s/%02d.ppm", shot_dir, number);
    f = fopen(path, "rb");
    assert_non_null(f);
    memset(into, 0, sizeof mem[0]);
    assert_true(fread(into, 1, sizeof mem[0], f) > 3 * 64 * 48);
    fclose(f);
    unlink(path);
    return into;
}

/* Checks that many reloads of the configuration neither increase the memory in
 * use nor change the image. */
TEST(reloads_neither_leak_nor_change_the_image)
{
    char line[200];

    snprintf(line, sizeof line,
             "lens = " LENS "\nlight = 5,60,1e4\nmemory = 4\n"
             "snapshot = %s/%%02d.ppm\n",
             shot_dir);
    write_live_config(line);
    for (int exact = 0; exact < 2; exact++) {
        fake_camera_reset();
        script = raise_reload_signals;
        last_shot = exact ? 29 : 149; /* exact rays take 0.15 s per frame */
        snprintf(line, sizeof line, "--count %d --config %s%s", last_shot + 1,
                 config_path, exact ? " --rays exact --grid 8" : "");
        assert_ok(run_live_command(line));
        expect_closed_without_leaks();
        assert_int_equal(count_messages("glint live: reloaded"),
                         exact ? 3 : 15);
        assert_int_equal(blocks[last_shot - 1], blocks[exact ? 18 : 28]);
        assert_memory_equal(read_snapshot_file(1), read_snapshot_file(2),
                            3 * 64 * 48);
    }
    last_shot = 149;
}

static void write_invalid_config(int wait)
{
    if (wait == 20)
        write_live_config("lens = " LENS "\nno-such-thing = 1\n");
    if (wait == 60)
        write_live_config("lens = " LENS "\nlights = /nowhere/lights.csv\n");
    if (wait == 80)
        write_live_config("lens = " LENS "\nlight = 5,60,1e4\n");
    if (wait >= 20)
        raise_reload_signals(wait);
}

TEST(invalid_reload_keeps_the_old_settings)
{
    char line[200];

    write_live_config("lens = " LENS "\n");
    fake_camera_reset();
    script = write_invalid_config;
    snprintf(line, sizeof line, "--count 100 --config %s", config_path);
    assert_ok(run_live_command(line));
    expect_closed_without_leaks();
    assert_int_equal(
        count_messages("not reloaded: the previous configuration stays in use"),
        6);
    assert_int_equal(count_messages("live: reloaded"), 2);
    assert_int_equal(count_messages(":2: no-such-thing is not an option"), 4);
}

/* ---------------------------------------------------------------- snapshot */

static void request_snapshot_without_frames(int wait)
{
    if (wait > 10 && wait < 40)
        camera.n_frames = 0;
    if (wait == 12)
        raise(SIGUSR2);
}

static void request_snapshot_at_wait_2(int wait)
{
    if (wait == 2)
        raise(SIGUSR2);
}

/* Checks that the image with --layer flare and almost no light is black, in
 * every format and range. */
TEST(flare_layer_without_light_is_black)
{
    static const uint32_t kind[] = {V4L2_PIX_FMT_YUYV,  V4L2_PIX_FMT_UYVY,
                                    V4L2_PIX_FMT_NV12,  V4L2_PIX_FMT_BGR24,
                                    V4L2_PIX_FMT_RGB24, V4L2_PIX_FMT_RGB565,
                                    V4L2_PIX_FMT_GREY};

    for (size_t i = 0; i < 2 * sizeof kind / sizeof *kind; i++) {
        const char *rgb;
        char line[200];

        fake_camera_reset();
        camera.mode[0].fourcc = camera.now.fourcc = kind[i / 2];
        script = request_snapshot_at_wait_2;
        snprintf(line, sizeof line,
                 "--count 3 --layer flare --exposure -60 --range %s --snapshot "
                 "%s/%%02d.ppm",
                 i % 2 ? "full" : "limited", shot_dir);
        assert_ok(run_live_command(line));
        expect_closed_without_leaks();
        rgb = read_snapshot_file(1) + strlen("P6\n64 48\n255\n");
        for (int k = 0; k < 3 * 64 * 48; k++)
            if (rgb[k] != 0)
                fail_msg("%.4s: byte %d is %d", (const char *)&kind[i / 2], k,
                         rgb[k]);
    }
}

/* Checks that a snapshot shows the frame after its request, and that waiting
 * for it is not a busy loop. */
TEST(snapshot_waits_for_the_next_frame)
{
    char line[100], path[60], said[80];

    snprintf(path, sizeof path, "%s/01.ppm", shot_dir);
    snprintf(said, sizeof said, "snapshot %s", path);
    snprintf(line, sizeof line, "--count 20 --snapshot %s/%%02d.ppm", shot_dir);
    unlink(path);
    fake_camera_reset();
    script = request_snapshot_without_frames;
    assert_ok(run_live_command(line));
    expect_closed_without_leaks();
    assert_int_equal(count_messages(said), 1);
    assert_int_equal(unlink(path), 0);
}

/* ------------------------------------------- unplugged and changed cameras */

TEST(unplugged_camera_ends_the_run)
{
    script = unplug_camera_during_wait;
    assert_int_equal(run_live_command("--count 100"), EXIT_DEVICE);
    expect_closed_without_leaks();
    assert_int_equal(count_messages("the camera was removed\n"), 1);
    assert_true(n_waits <= 21);
}

TEST(reconnects_to_a_camera_that_returns)
{
    {
        fake_camera_reset();
        script = unplug_camera_during_wait;
        assert_ok(run_live_command("--count 100 --reconnect"));
        expect_closed_without_leaks();
        assert_int_equal(count_messages("waiting for the camera"), 1);
        assert_int_equal(count_messages("(Fake): YUYV 64x48 at 30 fps"), 2);
    }
}

TEST(adapts_to_changed_camera_sizes)
{
    script = change_camera_size;
    assert_ok(run_live_command("--count 150"));
    expect_closed_without_leaks();
    assert_true(count_messages("YUYV 128x48") >= 7);
    assert_int_equal(blocks[149], blocks[29]);
}

/* ----------------------------------------------- failing calls and signals */

/* Makes each call fail once. Checks that frames continue, or that the run ends
 * with an exit code and a message. */
TEST(every_failing_call_is_handled)
{
    int n = 0, n_failed = 0, n_calls;

    script = NULL;
    do {
        int code;

        n += n < 60 ? 1 : 7;
        fake_camera_reset();
        fake_camera_fail_call(n, ENOMEM, false);
        code = run_live_command("--count 6");
        n_calls = fake_camera_fail_call(0, 0, false);
        expect_closed_without_leaks();
        if (code != EXIT_OK) {
            n_failed++;
            assert_true(count_messages("glint live: ") >= 1);
        }
    } while (n <= n_calls);
    assert_true(n_failed >= 10);
}

/* This test runs last, as the request to stop cannot be reset. */
TEST(sigterm_stops_the_run)
{
    script = raise_sigterm_at_wait_30;
    assert_ok(run_live_command(""));
    expect_closed_without_leaks();
    assert_int_equal(n_waits, 30);
}

TEST_OPEN
{
    close(mkstemp(config_path));
    if (!mkdtemp(shot_dir))
        fail();
    close(mkstemp(said_path));
}

TEST_CLOSE
{
    assert_int_equal(unlink(config_path) | unlink(said_path) | rmdir(shot_dir),
                     0);
}
