/* SPDX-License-Identifier: MIT */
#include "support/fakes/fake_fb.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <linux/kd.h>
#include <linux/vt.h>

#include "support/fakes/wrapped.h"
#include "support/test.h"

char fake_fb_path[] = "/tmp/glint-test-fb-XXXXXX";
char fake_tty_path[] = "/tmp/glint-test-tty-XXXXXX";
struct fake_fb *fake_fb;
int fake_fb_calls, fake_fb_fail_at, fake_fb_maps;

static bool must_fail_this_call(void)
{
    return ++fake_fb_calls == fake_fb_fail_at;
}

/* ---------------------------------------------------- replaced system calls */

static int set_errno_and_fail(int number)
{
    errno = number;
    return -1;
}

int __wrap_open64(const char *path, int flags, ...)
{
    const bool is_tty = !strcmp(path, "/dev/tty") || !strcmp(path, "/dev/tty0");

    if (strcmp(path, fake_fb_path) != 0 && !is_tty)
        return __real_open64(path, flags);
    if (must_fail_this_call())
        return set_errno_and_fail(EMFILE);
    if (!strcmp(path, "/dev/tty"))
        /* open() fails: a daemon has no terminal */
        return set_errno_and_fail(ENXIO);
    if (is_tty)
        return fake_fb->tty_errno ? set_errno_and_fail(fake_fb->tty_errno)
                                  : __real_open64(fake_tty_path, flags);
    return fake_fb->open_errno ? set_errno_and_fail(fake_fb->open_errno)
                               : __real_open64(path, flags);
}

static int answer_pan_display(const struct fb_var_screeninfo *to)
{
    const struct fb_var_screeninfo *const v = &fake_fb->var;

    fake_fb->n_pan++;
    if (!fake_fb->can_pan || to->yoffset > v->yres_virtual - v->yres)
        return set_errno_and_fail(EINVAL);
    fake_fb->var.yoffset = to->yoffset;
    return 0;
}

static int answer_framebuffer_ioctl(unsigned long request, void *arg)
{
    if (fake_fb->gone)
        return set_errno_and_fail(ENODEV);
    switch (request) {
    case FBIOGET_FSCREENINFO:
        memcpy(arg, &fake_fb->fix, sizeof fake_fb->fix);
        return 0;
    case FBIOGET_VSCREENINFO:
        memcpy(arg, &fake_fb->var, sizeof fake_fb->var);
        return 0;
    case FBIOPAN_DISPLAY:
        return answer_pan_display(arg);
    case FBIOBLANK:
        return set_errno_and_fail(EINVAL);
    case FBIO_WAITFORVSYNC:
        fake_fb->n_vsync++;
        return fake_fb->vsync_errno ? set_errno_and_fail(fake_fb->vsync_errno)
                                    : 0;
    }
    fail_msg("ioctl %lx", request); /* glint must never set the display mode */
    return -1;
}

static int answer_console_ioctl(unsigned long request, void *arg, int mode)
{
    switch (request) {
    case KDGETMODE:
        *(int *)arg = fake_fb->tty_mode;
        return 0;
    case KDSETMODE:
        fake_fb->tty_mode = mode;
        if (mode == KD_TEXT)
            fake_fb->yoffset_at_text = fake_fb->var.yoffset;
        return 0;
    case VT_GETMODE:
        *(struct vt_mode *)arg =
            (struct vt_mode){.mode = (char)fake_fb->tty_switching};
        return 0;
    }
    return set_errno_and_fail(ENOTTY);
}

int __wrap_ioctl(int fd, unsigned long request, ...)
{
    const bool is_fb = wrapped_is_file(fd, fake_fb_path),
               is_tty = wrapped_is_file(fd, fake_tty_path);
    unsigned long arg;
    va_list args;

    va_start(args, request);
    arg = va_arg(args, unsigned long);
    va_end(args);
    if (!is_fb && !is_tty)
        return __real_ioctl(fd, request, arg);
    if (!(request == KDSETMODE && arg == KD_TEXT) && must_fail_this_call())
        return set_errno_and_fail(EIO);
    return is_fb ? answer_framebuffer_ioctl(request, (void *)arg) /* NOLINT */
                 : answer_console_ioctl(request, (void *)arg, (int)arg);
}

void *__wrap_mmap64(void *at, size_t bytes, int how, int flags, int fd,
                    off_t offset)
{
    void *got = MAP_FAILED;

    if (fd < 0 || !wrapped_is_file(fd, fake_fb_path))
        return __real_mmap64(at, bytes, how, flags, fd, offset);
    if (must_fail_this_call())
        errno = ENOMEM;
    else
        got = __real_mmap64(at, bytes, how, flags, fd, offset);
    fake_fb_maps += got != MAP_FAILED;
    return got;
}

int __wrap_munmap(void *at, size_t bytes)
{
    fake_fb_maps--;
    return __real_munmap(at, bytes);
}

void *__wrap_malloc(size_t bytes)
{
    return must_fail_this_call() ? NULL : __real_malloc(bytes);
}
