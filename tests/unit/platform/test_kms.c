/* SPDX-License-Identifier: MIT
 *
 * Tests the KMS sink on a fake display (an ioctl() of the test): which buffer
 * is drawn and shown when, and what is shown after the end. Compares the
 * requests of linux/kms_abi.h with the kernel's header, where a system has it.
 * Displays of real drivers: tests/vm/test-kms.sh.
 */
#include <stdarg.h>
#include <stddef.h>

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "linux/kms.h"
#include "support/fakes/wrapped.h"
#include "support/test.h"

#if defined __has_include
#if __has_include(<libdrm/drm.h>)
#include <libdrm/drm.h>
#define HAS_DRM
#elif __has_include(<drm/drm.h>)
#include <drm/drm.h>
#define HAS_DRM
#endif
#endif

/* ------------------------------------------------------------ fake display */

enum {
    WIDTH = 8,
    HEIGHT = 6,
    ROW_BYTES = 64,
    CRTC = 40,
    CONSOLE = 70, /* the framebuffer of the text console */
    FIRST_FB = 80 /* framebuffer of the buffer with handle 0 */
};

/* A card with one CRTC and two connectors, of which the CRTC drives N_DRIVEN,
 * both with its picture. */
static struct fake_display {
    int fd;               /* -1: the card is closed */
    uint32_t shown, next; /* framebuffers: on the display, and from the next
                             vertical blank; next 0: no flip is pending */
    uint32_t connectors[2], n_connectors; /* those that the CRTC drives */
    struct kms_mode mode;
    bool has_event;    /* true: a flip's event was not read yet */
    bool is_forbidden; /* true: opening the device fails with EACCES */
    bool is_off;       /* true: there are no vertical blanks */
    bool is_old; /* true: a kernel before 5.8, for a user other than root */
    bool has_other_master;
    int n_set_crtc, n_flips, n_fbs, n_dumbs, n_maps;
    int n_calls, fail_at; /* calls so far; the one that fails, from 1 */
    uint8_t memory[2][ROW_BYTES * HEIGHT];
} display;

static int set_errno_and_fail(int number)
{
    errno = number;
    return -1;
}

int __wrap_open64(const char *path, int flags, ...)
{
    if (strncmp(path, "/dev/dri/", 9) != 0)
        return __real_open64(path, flags);
    if (strcmp(path, "/dev/dri/card0") != 0)
        return set_errno_and_fail(ENOENT);
    if (display.is_forbidden)
        return set_errno_and_fail(EACCES);
    return display.fd = __real_open64("/dev/null", O_RDWR);
}

int __wrap_close(int fd)
{
    if (fd >= 0 && fd == display.fd)
        display.fd = -1;
    return __real_close(fd);
}

static void pass_vertical_blank(void)
{
    if (display.next) {
        display.shown = display.next;
        display.next = 0;
        display.has_event = true;
        display.n_flips++;
    }
}

int __wrap_poll(struct pollfd *fds, nfds_t n, int timeout_ms);
int __wrap_poll(struct pollfd *fds, nfds_t n, int timeout_ms)
{
    assert_int_equal(n, 1);
    assert_int_equal(fds->fd, display.fd);
    assert_true(timeout_ms > 0);
    if (!display.is_off)
        pass_vertical_blank();
    return display.has_event;
}

ssize_t __real_read(int fd, void *to, size_t bytes);
ssize_t __wrap_read(int fd, void *to, size_t bytes);
ssize_t __wrap_read(int fd, void *to, size_t bytes)
{
    if (fd != display.fd)
        return __real_read(fd, to, bytes);
    assert_true(display.has_event && bytes >= 32);
    display.has_event = false;
    return 32;
}

void *__wrap_mmap64(void *at, size_t bytes, int how, int flags, int fd,
                    off_t offset)
{
    if (fd < 0 || fd != display.fd)
        return __real_mmap64(at, bytes, how, flags, fd, offset);
    if (++display.n_calls == display.fail_at)
        return set_errno_and_fail(ENOMEM), MAP_FAILED;
    assert_int_equal(bytes, sizeof display.memory[0]);
    display.n_maps++;
    return display.memory[offset >> 12];
}

int __wrap_munmap(void *at, size_t bytes)
{
    if (at != display.memory[0] && at != display.memory[1])
        return __real_munmap(at, bytes);
    display.n_maps--;
    return 0;
}

static int answer_set_crtc(const struct kms_crtc *c)
{
    assert_int_equal(c->crtc, CRTC);
    assert_in_range(c->n_connectors, 1, 2);
    memcpy(display.connectors, (const void *)(uintptr_t)c->connectors,
           c->n_connectors * sizeof *display.connectors);
    display.n_connectors = c->n_connectors;
    display.mode = c->mode;
    display.shown = c->fb;
    display.n_set_crtc++;
    return 0;
}

static int answer_flip(const struct kms_flip *f)
{
    assert_int_equal(f->flags, KMS_FLIP_EVENT);
    if (display.next || display.has_event)
        return set_errno_and_fail(EBUSY);
    display.next = f->fb;
    return 0;
}

/* As the kernel does, without pointers for the first call, which counts. */
static int answer_connector(struct kms_connector *c)
{
    const bool is_driven =
        display.connectors[0] == c->connector ||
        (display.n_connectors == 2 && display.connectors[1] == c->connector);

    if (c->n_modes > 0 && c->modes)
        *(struct kms_mode *)(uintptr_t)c->modes = display.mode;
    if (c->n_encoders > 0)
        *(uint32_t *)(uintptr_t)c->encoders = c->connector + 10;
    c->n_modes = c->n_encoders = 1;
    c->encoder = is_driven ? c->connector + 10 : 0;
    c->type = 11; /* HDMI-A */
    c->number = c->connector - 49;
    c->connection = KMS_CONNECTED;
    return 0;
}

static int answer_resources(struct kms_resources *r)
{
    assert_true(r->n_crtcs >= 1 && r->n_connectors >= 2);
    *(uint32_t *)(uintptr_t)r->crtcs = CRTC;
    for (uint32_t i = 0; i < 2; i++)
        ((uint32_t *)(uintptr_t)r->connectors)[i] = 50 + i;
    r->n_crtcs = 1;
    r->n_connectors = 2;
    return 0;
}

static int answer_master(unsigned long request)
{
    if (request == KMS_SET_MASTER)
        return display.is_old || display.has_other_master
                   ? set_errno_and_fail(EACCES)
                   : 0;
    return set_errno_and_fail(display.has_other_master ? EACCES : EINVAL);
}

static int answer_dumb(struct kms_dumb *d)
{
    assert_true(d->width == WIDTH && d->height == HEIGHT && d->bits == 32);
    d->handle = (uint32_t)++display.n_dumbs;
    d->stride_bytes = ROW_BYTES;
    d->bytes = sizeof display.memory[0];
    return 0;
}

static int answer_buffer_ioctl(unsigned long request, void *arg)
{
    struct kms_fb *const fb = arg;
    struct kms_dumb_map *const map = arg;

    switch (request) {
    case KMS_CREATE_DUMB:
        return answer_dumb(arg);
    case KMS_ADD_FB:
        display.n_fbs++;
        fb->fb = FIRST_FB + fb->handle[0];
        return 0;
    case KMS_MAP_DUMB:
        map->offset = (uint64_t)(map->handle - 1) << 12;
        return 0;
    case KMS_REMOVE_FB:
        display.n_fbs--;
        return 0;
    case KMS_DESTROY_DUMB:
        display.n_dumbs--;
        return 0;
    }
    fail_msg("ioctl %lx", request);
    return -1;
}

static int answer_ioctl(unsigned long request, void *arg)
{
    switch (request) {
    case KMS_CAPABILITY:
        ((struct kms_capability *)arg)->value =
            ((struct kms_capability *)arg)->capability == KMS_CAP_DUMB_BUFFER
                ? 1
                : 24;
        return 0;
    case KMS_RESOURCES:
        return answer_resources(arg);
    case KMS_CONNECTOR:
        return answer_connector(arg);
    case KMS_ENCODER:
        ((struct kms_encoder *)arg)->crtc = CRTC;
        return 0;
    case KMS_GET_CRTC:
        *(struct kms_crtc *)arg = (struct kms_crtc){.crtc = CRTC,
                                                    .fb = display.shown,
                                                    .is_mode_valid = 1,
                                                    .mode = display.mode};
        return 0;
    case KMS_SET_CRTC:
        return answer_set_crtc(arg);
    case KMS_FLIP:
        return answer_flip(arg);
    }
    return answer_buffer_ioctl(request, arg);
}

int __wrap_ioctl(int fd, unsigned long request, ...)
{
    void *arg;
    va_list args;

    va_start(args, request);
    arg = va_arg(args, void *);
    va_end(args);
    if (fd != display.fd)
        return __real_ioctl(fd, request, arg);
    if (request == KMS_SET_MASTER || request == KMS_AUTH_MAGIC)
        return answer_master(request);
    if (request != KMS_REMOVE_FB && request != KMS_DESTROY_DUMB &&
        ++display.n_calls == display.fail_at)
        return set_errno_and_fail(EIO);
    return answer_ioctl(request, arg);
}

TEST_BEFORE
{
    display = (struct fake_display){
        .fd = -1,
        .shown = CONSOLE,
        .connectors = {50, 51},
        .n_connectors = 1,
        .mode = {
            .width = WIDTH, .height = HEIGHT, .refresh_hz = 60, .name = "8x6"}};
}

/* --------------------------------------------------------------- the sink */

static void open_display(struct glint_kms *kms)
{
    struct glint_error error;

    if (glint_kms_open(kms, NULL, GLINT_PANEL_FIT, &error))
        fail_msg("%s", error.text);
}

static enum glint_status put_grey(struct glint_kms *kms, int code)
{
    static uint8_t mem[WIDTH * HEIGHT];
    const struct glint_image image =
        glint_image_over(mem, GLINT_GREY, WIDTH, HEIGHT);
    struct glint_error error;

    memset(mem, code, sizeof mem);
    return kms->sink.put(&kms->sink, &image, &error);
}

/* Returns the grey of framebuffer FB, which all pixels must have. */
static int get_grey(uint32_t fb)
{
    const uint8_t *m;

    assert_in_range(fb, FIRST_FB + 1, FIRST_FB + 2);
    m = display.memory[fb - FIRST_FB - 1];
    for (int i = 0; i < ROW_BYTES * HEIGHT; i++)
        if (i % ROW_BYTES < 4 * WIDTH && i % 4 < 3)
            assert_int_equal(m[i], m[0]);
    return m[0];
}

static void expect_console(void)
{
    assert_int_equal(display.shown, CONSOLE);
    assert_string_equal(display.mode.name, "8x6");
    assert_int_equal(display.fd, -1);
    assert_int_equal(display.n_maps, 0);
    assert_int_equal(display.n_fbs, 0);
    assert_int_equal(display.n_dumbs, 0);
}

TEST(frames_alternate_between_two_buffers)
{
    struct glint_kms kms;

    open_display(&kms);
    assert_int_equal(display.shown, CONSOLE);
    assert_ok(put_grey(&kms, 10));
    assert_int_equal(get_grey(display.shown), 10);
    for (int i = 1; i < 6; i++) {
        assert_ok(put_grey(&kms, 10 + i));
        /* Until the vertical blank the frame before stays as it is. */
        assert_int_equal(get_grey(display.shown), 10 + i - 1);
        assert_int_equal(get_grey(display.next), 10 + i);
        assert_int_equal(display.n_flips, i - 1);
    }
    assert_int_equal(display.n_set_crtc, 1);
    assert_int_equal(kms.n_dropped, 0);
    kms.sink.close(&kms.sink);
    assert_int_equal(display.n_flips, 5);
    assert_int_equal(display.n_set_crtc, 2);
    expect_console();
}

TEST(a_flip_that_does_not_come_drops_frames)
{
    struct glint_kms kms;

    open_display(&kms);
    assert_ok(put_grey(&kms, 10));
    assert_ok(put_grey(&kms, 20));
    display.is_off = true;
    for (int i = 1; i <= 3; i++) {
        assert_ok(put_grey(&kms, 30));
        assert_int_equal(kms.n_dropped, i);
        assert_int_equal(get_grey(display.shown), 10);
        assert_int_equal(get_grey(display.next), 20);
    }
    display.is_off = false;
    assert_ok(put_grey(&kms, 40));
    assert_int_equal(get_grey(display.shown), 20);
    assert_int_equal(get_grey(display.next), 40);
    assert_int_equal(kms.n_dropped, 3);
    kms.sink.close(&kms.sink);
    expect_console();
}

TEST(cloned_displays_show_frames_and_the_console_again)
{
    struct glint_kms kms;

    display.n_connectors = 2;
    open_display(&kms);
    assert_string_equal(kms.connector, "HDMI-A-1");
    assert_ok(put_grey(&kms, 10));
    assert_int_equal(display.n_connectors, 2);
    kms.sink.close(&kms.sink);
    expect_console();
    assert_int_equal(display.n_connectors, 2);
    assert_int_equal(display.connectors[0], 50);
    assert_int_equal(display.connectors[1], 51);
}

TEST(a_display_beside_stays_as_it_is)
{
    struct glint_kms kms;

    open_display(&kms);
    assert_ok(put_grey(&kms, 10));
    assert_int_equal(display.n_connectors, 1);
    kms.sink.close(&kms.sink);
    expect_console();
    assert_int_equal(display.n_connectors, 1);
    assert_int_equal(display.connectors[0], 50);
}

TEST(kernels_before_5_8_let_the_first_program_draw)
{
    struct glint_error error;
    struct glint_kms kms;

    display.is_old = true;
    open_display(&kms);
    kms.sink.close(&kms.sink);
    expect_console();
    for (int old = 0; old < 2; old++) {
        display.is_old = old;
        display.has_other_master = true;
        assert_int_equal(glint_kms_open(&kms, NULL, GLINT_PANEL_FIT, &error),
                         GLINT_E_DEVICE);
        assert_non_null(strstr(error.text, "another program draws"));
        assert_int_equal(display.n_set_crtc, 0);
        expect_console();
    }
}

TEST(each_call_that_fails_leaves_the_console)
{
    struct glint_error error;
    struct glint_kms kms;
    int at = 0;

    do {
        test_before();
        display.fail_at = ++at;
        if (glint_kms_open(&kms, NULL, GLINT_PANEL_FIT, &error) == GLINT_OK) {
            put_grey(&kms, 10);
            put_grey(&kms, 20);
            display.fail_at = 0;
        }
        kms.sink.close(&kms.sink);
        expect_console();
    } while (display.n_calls >= at);
    assert_true(at > 10);
}

/* ----------------------------------------------------------- the interface */

TEST(requests_equal_those_of_the_kernel)
{
#ifdef HAS_DRM
    /* A request's number contains the size of its structure. */
    assert_int_equal(KMS_CAPABILITY, DRM_IOCTL_GET_CAP);
    assert_int_equal(KMS_AUTH_MAGIC, DRM_IOCTL_AUTH_MAGIC);
    assert_int_equal(KMS_SET_MASTER, DRM_IOCTL_SET_MASTER);
    assert_int_equal(KMS_RESOURCES, DRM_IOCTL_MODE_GETRESOURCES);
    assert_int_equal(KMS_GET_CRTC, DRM_IOCTL_MODE_GETCRTC);
    assert_int_equal(KMS_SET_CRTC, DRM_IOCTL_MODE_SETCRTC);
    assert_int_equal(KMS_ENCODER, DRM_IOCTL_MODE_GETENCODER);
    assert_int_equal(KMS_CONNECTOR, DRM_IOCTL_MODE_GETCONNECTOR);
    assert_int_equal(KMS_REMOVE_FB, DRM_IOCTL_MODE_RMFB);
    assert_int_equal(KMS_FLIP, DRM_IOCTL_MODE_PAGE_FLIP);
    assert_int_equal(KMS_CREATE_DUMB, DRM_IOCTL_MODE_CREATE_DUMB);
    assert_int_equal(KMS_MAP_DUMB, DRM_IOCTL_MODE_MAP_DUMB);
    assert_int_equal(KMS_DESTROY_DUMB, DRM_IOCTL_MODE_DESTROY_DUMB);
    assert_int_equal(KMS_ADD_FB, DRM_IOCTL_MODE_ADDFB2);
    assert_int_equal(offsetof(struct kms_mode, refresh_hz),
                     offsetof(struct drm_mode_modeinfo, vrefresh));
    assert_int_equal(offsetof(struct kms_connector, connection),
                     offsetof(struct drm_mode_get_connector, connection));
    assert_int_equal(offsetof(struct kms_crtc, is_mode_valid),
                     offsetof(struct drm_mode_crtc, mode_valid));
    assert_int_equal(offsetof(struct kms_fb, offset),
                     offsetof(struct drm_mode_fb_cmd2, offsets));
#else
    skip();
#endif
}

TEST(a_connector_that_is_not_there_is_an_error)
{
    struct glint_error error;
    struct glint_kms kms;

    assert_int_equal(glint_kms_open(&kms, "HDMI-Z-9", GLINT_PANEL_FIT, &error),
                     GLINT_E_DEVICE);
    assert_int_equal(kms.fd, -1);
    assert_non_null(strstr(error.text, "no display is connected to HDMI-Z-9; "
                                       "the connectors are HDMI-A-1, "
                                       "HDMI-A-2"));
    kms.sink.close(&kms.sink);
}

TEST(a_device_without_permission_names_the_group)
{
    struct glint_error error;
    struct glint_kms kms;

    display.is_forbidden = true;
    assert_int_equal(glint_kms_open(&kms, NULL, GLINT_PANEL_FIT, &error),
                     GLINT_E_DEVICE);
    assert_non_null(strstr(error.text, "usermod -aG video"));
    kms.sink.close(&kms.sink);
}
