/* SPDX-License-Identifier: MIT
 *
 * Tests the framebuffer sink on a fake framebuffer and console (files, and an
 * ioctl() of the test): which pixels are drawn, and that the failure of any
 * call is handled.
 */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <linux/kd.h>
#include <linux/vt.h>

#include "linux/fbdev.h"
#include "support/fakes/fake_fb.h"
#include "support/scratch.h"
#include "support/test.h"

static struct glint_error error;

/* ------------------------------------------------------- fake framebuffer */

static struct glint_fbdev fb = {.fd = -1};

static void close_framebuffer_sink(void)
{
    if (fb.fd >= 0)
        fb.sink.close(&fb.sink);
}

/* Sets the fake framebuffer to 8 x 6 pixels of XRGB8888, 40 bytes per row,
 * without off-screen rows. */
static void set_fake_to_one_page(void)
{
    uint8_t old[256];
    int fd;

    *fake_fb = (struct fake_fb){
        .fix = {.id = "fake",
                .smem_len = FB_BYTES - 4096,
                .type = FB_TYPE_PACKED_PIXELS,
                .visual = FB_VISUAL_TRUECOLOR,
                .line_length = 40},
        .var = {.xres = 8,
                .yres = 6,
                .xres_virtual = 8,
                .yres_virtual = 6,
                .bits_per_pixel = 32,
                .red = {16, 8, 0},
                .green = {8, 8, 0},
                .blue = {0, 8, 0}},
        .vsync_errno = ENOTTY,
        .tty_mode = KD_TEXT,
        .tty_switching = VT_AUTO,
        .yoffset_at_text = 99,
    };
    memset(old, 0xaa, sizeof old);
    fd = open(fake_fb_path, O_WRONLY | O_TRUNC);
    for (int i = 0; i < FB_BYTES; i += (int)sizeof old)
        assert_int_equal(write(fd, old, sizeof old), sizeof old);
    close(fd);
    fake_fb_calls = fake_fb_fail_at = fake_fb_maps = 0;
}

static void reset_fake_to_one_page(void)
{
    close_framebuffer_sink();
    set_fake_to_one_page();
}

/* Sets the fake framebuffer to two pages of screen memory with vertical panning
 * in steps of one row, as the vc4 driver has. */
static void set_fake_to_two_pages(void)
{
    set_fake_to_one_page();
    fake_fb->var.yres_virtual = 12;
    fake_fb->fix.ypanstep = 1;
    fake_fb->can_pan = true;
}

static void reset_fake_to_two_pages(void)
{
    close_framebuffer_sink();
    set_fake_to_two_pages();
}

static const uint8_t *read_screen_byte(void)
{
    static uint8_t mem[FB_BYTES];
    const int fd = open(fake_fb_path, O_RDONLY);

    assert_int_equal(read(fd, mem, sizeof mem), sizeof mem);
    close(fd);
    return mem;
}

static void write_screen_byte(off_t at, uint8_t value)
{
    const int fd = open(fake_fb_path, O_WRONLY);

    assert_int_equal(pwrite(fd, &value, 1, at), 1);
    close(fd);
}

/* Returns a WIDTH x HEIGHT grey image whose pixels all have code CODE. */
static const struct glint_image *make_grey_image(int width, int height,
                                                 int code)
{
    static uint8_t mem[64 * 64];
    static struct glint_image image;

    image = (struct glint_image){
        .format = GLINT_GREY, .width = width, .height = height};
    glint_image_place(&image, mem);
    memset(mem, code, (size_t)(width * height));
    return &image;
}

/* Opens the sink FB, which the next opening, reset or end of a test closes. */
static void open_framebuffer_sink(const struct glint_fbdev_options *options)
{
    static const struct glint_fbdev_options none;

    close_framebuffer_sink();
    if (glint_fbdev_open(&fb, fake_fb_path, options ? options : &none, &error))
        fail_msg("%s", error.text);
}

static void draw_grey_image(int width, int height, int code)
{
    if (fb.sink.put(&fb.sink, make_grey_image(width, height, code), &error))
        fail_msg("%s", error.text);
}

/* Checks six rows of 40 bytes in the framebuffer, from byte FIRST on. Each
 * pixel must be CODE, CODE, CODE, 0, and the 8 bytes of padding per row must be
 * unchanged. */
static void expect_screen_rows(size_t first, int code)
{
    const uint8_t *const mem = read_screen_byte() + first;

    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 40; x++) {
            const int want = x >= 32 ? 0xaa : x % 4 == 3 ? 0 : code;

            if (mem[40 * y + x] != want)
                fail_msg("row %d byte %d: %d, not %d", y, x, mem[40 * y + x],
                         want);
        }
}

/* --------------------------------------------------------- pages and modes */

/* In a child process: shows the second page, then ends by signal HOW, or by
 * exit() if HOW is 0. */
static void end_child_by_signal(int how)
{
    static const struct glint_fbdev_options options = {.console = true};

    for (int i = 1; i < SIGRTMIN; i++)
        signal(i, SIG_DFL);
    open_framebuffer_sink(NULL);
    open_framebuffer_sink(&options);
    draw_grey_image(8, 6, 1);
    if (fake_fb->tty_mode != KD_GRAPHICS || fake_fb->var.yoffset != 6)
        _exit(99);
    if (fork() == 0)
        /* the end of this grandchild process must not restore the console */
        exit(0);
    while (wait(NULL) < 0)
        ;
    if (fake_fb->tty_mode != KD_GRAPHICS || fake_fb->var.yoffset != 6)
        _exit(98);
    if (how == 0)
        exit(0);
    raise(how);
}

TEST_BEFORE
{
    reset_fake_to_one_page();
}

TEST_AFTER
{
    close_framebuffer_sink();
}

/* Checks that however a process ends, the console returns to text mode and
 * shows the first page. This test runs first, as the first open installs the
 * signal handlers of the whole process. */
TEST(console_is_restored_after_every_end)
{
    static const int ends[] = {0,       SIGINT,  SIGTERM, SIGHUP,
                               SIGQUIT, SIGSEGV, SIGABRT};

    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        int how;
        pid_t child;

        reset_fake_to_two_pages();
        child = fork();
        if (child == 0)
            end_child_by_signal(ends[i]);
        assert_int_equal(waitpid(child, &how, 0), child);
        if (ends[i] == 0)
            assert_int_equal(how, 0);
        else
            assert_int_equal(WTERMSIG(how), ends[i]);
        assert_int_equal(fake_fb->tty_mode, KD_TEXT);
        assert_int_equal(fake_fb->var.yoffset, 0);
        /* The sink must show the first page before it sets text mode. */
        assert_int_equal(fake_fb->yoffset_at_text, 0);
    }
}

TEST(draws_a_grey_image)
{
    open_framebuffer_sink(NULL);
    assert_string_equal(fb.id, "fake");
    assert_int_equal(fb.n_pages, 1);
    draw_grey_image(8, 6, 100);
    expect_screen_rows(0, 100);
    draw_grey_image(16, 12, 50);
    expect_screen_rows(0, 50);
    assert_int_equal(read_screen_byte()[6 * 40],
                     /* the first byte below the screen's rows is unchanged */
                     0xaa);
    fb.sink.close(&fb.sink);
    fb.sink.close(&fb.sink);
    assert_int_equal(fb.fd, -1);
    assert_int_equal(fake_fb_maps, 0);
}

/* Checks that the area around the image is black, whatever the previous
 * image covered. */
TEST(border_around_the_image_is_black)
{
    const uint8_t *mem;

    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 100);
    draw_grey_image(8, 2, 50);
    mem = read_screen_byte();
    for (int y = 0; y < 6; y++)
        assert_int_equal(mem[40 * y], y == 2 || y == 3 ? 50 : 0);
    /* A second image of the same size does not draw the border again. */
    write_screen_byte(0, 123);
    draw_grey_image(8, 2, 50);
    assert_int_equal(read_screen_byte()[0], 123);
}

TEST(screen_may_start_inside_a_page)
{
    fake_fb->fix.smem_start = 0xfd000064;
    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 77);
    expect_screen_rows(0x64, 77);
    assert_int_equal(read_screen_byte()[0x63], 0xaa);
    /* A console that was scrolled begins at a later row. */
    reset_fake_to_one_page();
    fake_fb->var.yres_virtual = 20;
    fake_fb->var.yoffset = 5;
    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 78);
    expect_screen_rows(5 * 40, 78);
    assert_int_equal(read_screen_byte()[5 * 40 - 1], 0xaa);
    draw_grey_image(8, 2, 78);
    fake_fb->var.yoffset = 14;
    draw_grey_image(8, 2, 79);
    assert_int_equal(read_screen_byte()[14 * 40], 0);
    assert_int_equal(read_screen_byte()[16 * 40], 79);
}

TEST(frames_alternate_between_two_pages)
{
    reset_fake_to_two_pages();
    open_framebuffer_sink(NULL);
    assert_int_equal(fb.n_pages, 2);
    assert_int_equal(fake_fb->var.yoffset, 0);
    for (int i = 1; i <= 5; i++) {
        const uint32_t shown = i % 2 ? 6 : 0;
        const int before = read_screen_byte()[(6 - shown) * 40];

        draw_grey_image(8, 6, 10 * i);
        assert_int_equal(fake_fb->var.yoffset, shown);
        assert_int_equal(read_screen_byte()[shown * 40], 10 * i);
        assert_int_equal(read_screen_byte()[(6 - shown) * 40], before);
    }
    fb.sink.close(&fb.sink);
    assert_int_equal(fake_fb->var.yoffset, 0);
    /* a glint that was killed left the second page visible */
    fake_fb->var.yoffset = 6;
    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 1);
    fb.sink.close(&fb.sink);
    assert_int_equal(fake_fb->var.yoffset, 0);
}

TEST(without_panning_one_page_is_used)
{
    reset_fake_to_two_pages();
    fake_fb->can_pan = false;
    open_framebuffer_sink(NULL);
    assert_int_equal(fb.n_pages, 1);
    draw_grey_image(8, 6, 9);
    assert_int_equal(read_screen_byte()[0], 9);

    reset_fake_to_two_pages();
    /* The framebuffer memory is too small for two pages of 6 rows. */
    fake_fb->fix.smem_len = 11 * 40;
    open_framebuffer_sink(NULL);
    assert_int_equal(fb.n_pages, 1);
    assert_int_equal(fake_fb->n_pan, 0);

    reset_fake_to_two_pages();
    fake_fb->fix.ypanstep =
        /* the 6 rows of a page are not a multiple of the panning step of 4 */
        4;
    open_framebuffer_sink(NULL);
    assert_int_equal(fb.n_pages, 1);

    /* the first panning request succeeds, later ones fail */
    reset_fake_to_two_pages();
    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 9);
    fake_fb->can_pan = false;
    fake_fb->n_pan = 0;
    draw_grey_image(8, 6, 11);
    assert_int_equal(read_screen_byte()[fake_fb->var.yoffset * 40], 11);
    draw_grey_image(8, 6, 12);
    /* after a failure the sink does not pan again */
    assert_int_equal(fake_fb->n_pan, 1);
}

TEST(failed_vsync_ends_waiting)
{
    const struct glint_fbdev_options options = {.vsync = true};

    open_framebuffer_sink(&options);
    for (int i = 0; i < 3; i++)
        draw_grey_image(8, 6, i);
    /* after a failure the sink no longer waits for vsync */
    assert_int_equal(fake_fb->n_vsync, 1);
    reset_fake_to_one_page();
    fake_fb->vsync_errno = 0;
    open_framebuffer_sink(&options);
    for (int i = 0; i < 3; i++)
        draw_grey_image(8, 6, i);
    assert_int_equal(fake_fb->n_vsync, 3);
    fb.sink.close(&fb.sink);
    fake_fb->n_vsync = 0;
    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 1);
    assert_int_equal(fake_fb->n_vsync, 0);
}

TEST(reports_a_removed_framebuffer)
{
    char want[128];

    snprintf(want, sizeof want, "%s: the framebuffer was removed",
             fake_fb_path);
    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 5);
    fake_fb->gone = true;
    assert_int_equal(fb.sink.put(&fb.sink, make_grey_image(8, 6, 6), &error),
                     GLINT_E_DEVICE);
    assert_string_equal(error.text, want);
    assert_int_equal(read_screen_byte()[0], 5);
    fb.sink.close(&fb.sink);
    assert_int_equal(fake_fb_maps, 0);
}

/* Checks that the sink adapts to modes that another program sets: 16 bits per
 * pixel, then two pages of 32 bits. */
TEST(adopts_changed_modes)
{
    const uint8_t *mem;

    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 255);
    fake_fb->var.bits_per_pixel = 16;
    fake_fb->var.red = (struct fb_bitfield){11, 5, 0};
    fake_fb->var.green = (struct fb_bitfield){5, 6, 0};
    fake_fb->var.blue = (struct fb_bitfield){0, 5, 0};
    fake_fb->var.xres = 4;
    fake_fb->fix.line_length = 64;
    draw_grey_image(4, 6, 255);
    assert_int_equal(fb.width, 4);
    mem = read_screen_byte();
    for (int i = 0; i < 8; i++)
        assert_int_equal(mem[5 * 64 + i], 255);
    assert_int_equal(mem[5 * 64 + 8], 0xaa);
    set_fake_to_two_pages();
    draw_grey_image(8, 6, 3);
    assert_int_equal(fb.n_pages, 2);
    assert_int_equal(read_screen_byte()[6 * 40], 3);
    /* the page was mapped again, and its old mapping removed */
    assert_int_equal(fake_fb_maps, 0);
}

TEST(missing_bit_fields_mean_xrgb8888)
{
    static const struct fb_bitfield none;

    fake_fb->var.red = fake_fb->var.green = fake_fb->var.blue = none;
    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 100);
    expect_screen_rows(0, 100);
    fb.sink.close(&fb.sink);
    fake_fb->var.bits_per_pixel = 16;
    open_framebuffer_sink(NULL);
    draw_grey_image(8, 6, 255);
    assert_int_equal(fb.layout.green.length, 6);
    assert_int_equal(read_screen_byte()[15], 255);
}

/* -------------------------------------------------------- rejected devices */

static void expect_open_fails(const char *part)
{
    static const struct glint_fbdev_options options = {.console = true};

    assert_int_equal(glint_fbdev_open(&fb, fake_fb_path, &options, &error),
                     GLINT_E_DEVICE);
    if (!strstr(error.text, part))
        fail_msg("\"%s\" is not in \"%s\"", part, error.text);
    assert_int_equal(fb.fd, -1);
    assert_int_equal(fake_fb_maps, 0);
    assert_int_equal(fake_fb->tty_mode, KD_TEXT);
}

TEST(reports_why_opening_fails)
{
    static const struct glint_fbdev_options none;

    fake_fb->open_errno = ENOENT;
    expect_open_fails("there is no framebuffer");
    fake_fb->open_errno = EACCES;
    expect_open_fails("usermod -aG video");
    reset_fake_to_one_page();
    fake_fb->fix.visual = FB_VISUAL_PSEUDOCOLOR;
    fake_fb->var.bits_per_pixel = 8;
    expect_open_fails("pixels of 8 bits (type 0, visual 3) are not packed");
    reset_fake_to_one_page();
    fake_fb->fix.type = FB_TYPE_PLANES;
    expect_open_fails("not packed true colour");
    reset_fake_to_one_page();
    fake_fb->var.grayscale = 1;
    expect_open_fails("not packed true colour");
    reset_fake_to_one_page();
    fake_fb->var.bits_per_pixel = 4000000000;
    expect_open_fails("not packed true colour");
    reset_fake_to_one_page();
    fake_fb->fix.line_length = 31;
    expect_open_fails("too few for 8 x 6");
    reset_fake_to_one_page();
    fake_fb->fix.line_length = 0;
    expect_open_fails("too few for 8 x 6");
    reset_fake_to_one_page();
    fake_fb->fix.smem_len = 6 * 40 - 1;
    expect_open_fails("too few for 8 x 6");
    reset_fake_to_one_page();
    fake_fb->var.yres = 0;
    expect_open_fails("has 8 x 0 pixels");
    reset_fake_to_one_page();
    fake_fb->var.xres = 100000;
    expect_open_fails("has 100000 x 6 pixels");
    reset_fake_to_one_page();
    fake_fb->gone = true;
    expect_open_fails("was removed");
    assert_int_equal(glint_fbdev_open(&fb, "/dev/null", &none, &error),
                     GLINT_E_DEVICE);
    assert_string_equal(error.text, "/dev/null: is not a framebuffer");
}

TEST(environment_variable_names_the_framebuffer)
{
    static const struct glint_fbdev_options none;

    setenv("FRAMEBUFFER", fake_fb_path, 1);
    assert_ok(glint_fbdev_open(&fb, NULL, &none, &error));
    fb.sink.close(&fb.sink);
    setenv("FRAMEBUFFER", "/nowhere/fb", 1);
    assert_int_equal(glint_fbdev_open(&fb, NULL, &none, &error),
                     GLINT_E_DEVICE);
    assert_int_equal(strncmp(error.text, "/nowhere/fb: ", 13), 0);
    unsetenv("FRAMEBUFFER");
}

/* ----------------------------------------------------------------- console */

static void check_console_modes(bool taken, int during, int after)
{
    static const struct glint_fbdev_options options = {.console = true};

    open_framebuffer_sink(&options);
    assert_int_equal(fb.has_note, !taken);
    assert_int_equal(fake_fb->tty_mode, during);
    draw_grey_image(8, 6, 1);
    fb.sink.close(&fb.sink);
    assert_int_equal(fake_fb->tty_mode, after);
    if (!taken)
        assert_non_null(strstr(fb.note.text, "may show in the picture"));
}

TEST(console_mode_is_set_and_restored)
{
    check_console_modes(true, KD_GRAPHICS, KD_TEXT);
    /* a program that was killed left graphics mode set */
    fake_fb->tty_mode = KD_GRAPHICS;
    check_console_modes(true, KD_GRAPHICS, KD_TEXT);
    /* an X server owns the console, which is in graphics mode */
    fake_fb->tty_mode = KD_GRAPHICS;
    fake_fb->tty_switching = VT_PROCESS;
    check_console_modes(false, KD_GRAPHICS, KD_GRAPHICS);
    reset_fake_to_one_page();
    fake_fb->tty_errno = EACCES;
    check_console_modes(false, KD_TEXT, KD_TEXT);
}

/* Checks that a released console is not changed at the end of the process, even
 * if its file descriptor belongs to another file by then. */
TEST(released_console_is_not_touched)
{
    int how;
    pid_t child;

    child = fork();
    if (child == 0) {
        check_console_modes(true, KD_GRAPHICS, KD_TEXT);
        fake_fb->tty_mode = KD_GRAPHICS;
        while (open(fake_tty_path, O_RDWR) < 20)
            ;
        exit(0);
    }
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
    assert_int_equal(fake_fb->tty_mode, KD_GRAPHICS);
}

/* ----------------------------------------------------------- failing calls */

/* Draws three frames of two sizes. Returns false if a call failed; the sink
 * must then give an error message. */
static bool draw_three_frames(void)
{
    static const struct glint_fbdev_options options = {.console = true,
                                                       .vsync = true};
    enum glint_status status =
        glint_fbdev_open(&fb, fake_fb_path, &options, &error);

    if (!status) {
        status = fb.sink.put(&fb.sink, make_grey_image(8, 6, 1), &error);
        if (!status)
            status = fb.sink.put(&fb.sink, make_grey_image(8, 6, 2), &error);
        if (!status)
            status = fb.sink.put(&fb.sink, make_grey_image(4, 6, 3), &error);
        fake_fb_fail_at = 0;
        fb.sink.close(&fb.sink);
    }
    assert_int_equal(fb.fd, -1);
    if (status) {
        assert_true(status == GLINT_E_DEVICE || status == GLINT_E_MEMORY);
        assert_non_null(strstr(error.text, ": "));
    }
    return !status;
}

static void check_drawing_failing_calls(bool pages)
{
    const int fds = scratch_count_entries("/proc/self/fd");
    int n_failed = 0, n = 0, n_last;

    do {
        n++;
        if (pages)
            reset_fake_to_two_pages();
        else
            reset_fake_to_one_page();
        fake_fb_fail_at = n;
        n_failed += !draw_three_frames();
        n_last = fake_fb_calls;
        fake_fb_fail_at = 0;
        assert_int_equal(fake_fb_maps, 0);
        assert_int_equal(scratch_count_entries("/proc/self/fd"), fds);
        assert_int_equal(fake_fb->tty_mode, KD_TEXT);
        assert_int_equal(fake_fb->var.yoffset, 0);
    } while (n <= n_last);
    /* Not every run fails, as some failing calls have no effect. */
    assert_true(n_failed >= 8);
    assert_true(n > 15);
}

TEST(every_failing_call_is_handled)
{
    check_drawing_failing_calls(false);
    check_drawing_failing_calls(true);
}

TEST_OPEN
{
    close(mkstemp(fake_fb_path));
    close(mkstemp(fake_tty_path));
    fake_fb = mmap(NULL, sizeof *fake_fb, PROT_READ | PROT_WRITE,
                   MAP_SHARED | 0x20 /* MAP_ANONYMOUS */, -1, 0);
    assert_true(fake_fb != MAP_FAILED);
}

TEST_CLOSE
{
    assert_int_equal(unlink(fake_fb_path) | unlink(fake_tty_path), 0);
}
