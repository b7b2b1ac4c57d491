/* SPDX-License-Identifier: MIT */
#include "linux/fbdev.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/kd.h>
#include <linux/vt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "linux/request.h"
#include "posix/at_death.h"
#include "posix/error.h"

/* File descriptor of the console in graphics mode, or -1. restore_console()
 * reads it, held_mode and holder when the process dies, so all are atomic. */
static int held_fd = -1;
static int held_mode; /* mode of the console before glint set it to graphics
                         mode */
/* id of the process that set graphics mode; child processes of this process
 * must not restore the mode */
static pid_t holder;

/* Restores the console's mode. Async-signal-safe, as ioctl() is a plain system
 * call in Linux. */
static void restore_console(void)
{
    const int saved = errno;
    const int fd = __atomic_load_n(&held_fd, __ATOMIC_SEQ_CST);

    if (fd >= 0 && getpid() == __atomic_load_n(&holder, __ATOMIC_SEQ_CST))
        ioctl(fd, KDSETMODE, __atomic_load_n(&held_mode, __ATOMIC_SEQ_CST));
    errno = saved;
}

/* Registered functions run from the latest to the earliest, so a function that
 * must run before the console is restored must be registered after this
 * call. */
static void register_console_restore(void)
{
    glint_at_death_register(restore_console);
}

/* Opens the console PATH and sets *FD to its descriptor. Returns the console's
 * mode, or -1 with errno set. */
static int open_console(const char *path, int *fd)
{
    struct vt_mode switching;
    int mode = KD_TEXT, saved;

    *fd = open(path, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (*fd < 0)
        return -1;
    if (ioctl(*fd, KDGETMODE, &mode) < 0) {
        saved = errno;
        close(*fd);
        *fd = -1;
        errno = saved;
        return -1;
    }
    /* A running program that draws on the console has set VT_PROCESS, so that
     * the kernel notifies it before it switches consoles. If the console is in
     * graphics mode with VT_AUTO, a killed program has left it in this
     * state. */
    if (mode == KD_GRAPHICS && ioctl(*fd, VT_GETMODE, &switching) == 0 &&
        switching.mode == VT_AUTO)
        mode = KD_TEXT;
    return mode;
}

static bool explain_console_refusal(int *fd, struct glint_error *note,
                                    const char *cause)
{
    if (*fd >= 0)
        close(*fd);
    *fd = -1;
    glint_error_report(note, GLINT_E_DEVICE, "console",
                       "%s; text and cursor may show in the picture", cause);
    return false;
}

/* Sets the console to graphics mode. A process may do this with only one
 * console at a time. If there is no console, the permission is missing, or
 * another program draws on the console, returns false and sets NOTE to the
 * reason. */
static bool acquire_console(int *fd, struct glint_error *note)
{
    int mode = open_console("/dev/tty", fd);

    if (mode < 0)
        mode = open_console("/dev/tty0", fd);
    if (mode < 0)
        return explain_console_refusal(fd, note,
                                       errno == ENOENT || errno == ENXIO ||
                                               errno == ENODEV
                                           ? "there is no console"
                                           : strerror(errno));
    if (mode == KD_GRAPHICS)
        return explain_console_refusal(fd, note,
                                       "another program draws on this console");
    __atomic_store_n(&held_mode, mode, __ATOMIC_SEQ_CST);
    __atomic_store_n(&holder, getpid(), __ATOMIC_SEQ_CST);
    __atomic_store_n(&held_fd, *fd, __ATOMIC_SEQ_CST);
    register_console_restore();
    if (ioctl(*fd, KDSETMODE, KD_GRAPHICS) < 0) {
        __atomic_store_n(&held_fd, -1, __ATOMIC_SEQ_CST);
        return explain_console_refusal(fd, note, strerror(errno));
    }
    return true;
}

/* Restores the console's mode and closes *FD, if acquire_console() has
 * succeeded before. */
static void release_console(int *fd)
{
    if (*fd < 0)
        return;
    restore_console();
    __atomic_store_n(&held_fd, -1, __ATOMIC_SEQ_CST);
    close(*fd);
    *fd = -1;
}

#ifndef FBIO_WAITFORVSYNC
#define FBIO_WAITFORVSYNC _IOW('F', 0x20, uint32_t)
#endif

/* Reports that ioctl WHAT failed, by errno. */
static enum glint_status report_ioctl_failure(const struct glint_fbdev *fb,
                                              const char *what,
                                              struct glint_error *error)
{
    if (errno == ENODEV)
        return glint_error_report(error, GLINT_E_DEVICE, fb->name,
                                  "the framebuffer was removed");
    return glint_error_report(error, GLINT_E_DEVICE, fb->name, "%s: %s", what,
                              strerror(errno));
}

/* -------------------------------------------------------------- when dying */

/* The console draws at the offset to which the panel was panned last, so glint
 * pans the panel back when it ends. That must happen before the console's mode
 * is restored: the console then adopts the current offset, and Linux 6.1 draws
 * at a wrong position if the offset differs from the original one. */
static int panned_fd = -1; /* framebuffer to pan back, or -1; atomic */
static struct fb_var_screeninfo panned_home;
static pid_t panner; /* id of the process that panned the panel; atomic */

/* Pans the panel back to its original offset. Async-signal-safe. */
static void restore_pan_offset(void)
{
    const int saved = errno;
    const int fd = __atomic_load_n(&panned_fd, __ATOMIC_SEQ_CST);

    if (fd >= 0 && getpid() == __atomic_load_n(&panner, __ATOMIC_SEQ_CST))
        ioctl(fd, FBIOPAN_DISPLAY, &panned_home);
    errno = saved;
}

static void register_pan_restore(const struct glint_fbdev *fb)
{
    panned_home = fb->home;
    __atomic_store_n(&panner, getpid(), __ATOMIC_SEQ_CST);
    __atomic_store_n(&panned_fd, fb->fd, __ATOMIC_SEQ_CST);
    register_console_restore();
    glint_at_death_register(restore_pan_offset);
}

static void restore_pan_offset_at_close(const struct glint_fbdev *fb)
{
    if (fb->fd < 0 || __atomic_load_n(&panned_fd, __ATOMIC_SEQ_CST) != fb->fd)
        return;
    restore_pan_offset();
    __atomic_store_n(&panned_fd, -1, __ATOMIC_SEQ_CST);
}

/* -------------------------------------------------------------------- mode */

static struct glint_pixel_field
convert_bit_field(const struct fb_bitfield *bits)
{
    return (struct glint_pixel_field){(int)bits->offset, (int)bits->length};
}

/* Returns the layout of pixels that V describes. If it has no bit fields,
 * assumes RGB565 for 2 bytes, else 8 bits per colour. */
static struct glint_pixel_layout
read_pixel_layout(const struct fb_var_screeninfo *v)
{
    const int bytes =
        v->bits_per_pixel > 32 ? 0 : (int)(v->bits_per_pixel + 7) / 8;

    if (v->red.length == 0 && v->green.length == 0 && v->blue.length == 0)
        return bytes == 2 ? (struct glint_pixel_layout){2,
                                                        {11, 5},
                                                        {5, 6},
                                                        {0, 5},
                                                        {0, 0}}
                          : (struct glint_pixel_layout){
                                bytes, {16, 8}, {8, 8}, {0, 8}, {0, 0}};
    return (struct glint_pixel_layout){
        bytes, convert_bit_field(&v->red), convert_bit_field(&v->green),
        convert_bit_field(&v->blue), convert_bit_field(&v->transp)};
}

static bool is_true_colour(const struct fb_fix_screeninfo *fix,
                           const struct fb_var_screeninfo *var)
{
    return fix->type == FB_TYPE_PACKED_PIXELS && var->grayscale == 0 &&
           (fix->visual == FB_VISUAL_TRUECOLOR ||
            fix->visual == FB_VISUAL_DIRECTCOLOR);
}

/* Sets size, layout and memory size of FB from the driver's data. Reports an
 * error if glint cannot draw on such a framebuffer. */
static enum glint_status
adopt_driver_layout(struct glint_fbdev *fb, const struct fb_fix_screeninfo *fix,
                    struct glint_error *error)
{
    const struct fb_var_screeninfo *const v = &fb->var;
    const uint64_t wanted =
        (uint64_t)fix->line_length *
        (v->yres_virtual > v->yres ? v->yres_virtual : v->yres);

    fb->layout = read_pixel_layout(v);
    if (!is_true_colour(fix, v) || !glint_pixel_layout_is_valid(&fb->layout))
        return glint_error_report(
            error, GLINT_E_DEVICE, fb->name,
            "pixels of %u bits (type %u, visual %u) are not packed true "
            "colour; try: fbset -depth 16",
            v->bits_per_pixel, fix->type, fix->visual);
    if (v->xres < 1 || v->xres > GLINT_PANEL_SIDE || v->yres < 1 ||
        v->yres > GLINT_PANEL_SIDE)
        return glint_error_report(
            error, GLINT_E_DEVICE, fb->name,
            "has %u x %u pixels; glint supports 1 to %d a side", v->xres,
            v->yres, GLINT_PANEL_SIDE);
    fb->width = (int)v->xres;
    fb->height = (int)v->yres;
    fb->stride_bytes = fix->line_length;
    fb->mem_bytes = wanted < fix->smem_len ? (size_t)wanted : fix->smem_len;
    if (fb->stride_bytes < (size_t)fb->width * (size_t)fb->layout.bytes ||
        fb->mem_bytes / fb->stride_bytes < v->yres)
        return glint_error_report(
            error, GLINT_E_DEVICE, fb->name,
            "the driver reports %u bytes in rows of %u bytes, too few for %u x "
            "%u pixels of %u bits",
            fix->smem_len, fix->line_length, v->xres, v->yres,
            v->bits_per_pixel);
    memcpy(fb->id, fix->id, 16);
    fb->skip_bytes = fix->smem_start & ((size_t)sysconf(_SC_PAGESIZE) - 1);
    return GLINT_OK;
}

static void unmap_panel(struct glint_fbdev *fb)
{
    if (fb->map)
        munmap(fb->map, fb->map_bytes);
    fb->map = NULL;
}

static enum glint_status map_panel(struct glint_fbdev *fb,
                                   struct glint_error *error)
{
    void *at;

    fb->map_bytes = fb->skip_bytes + fb->mem_bytes;
    at = mmap(NULL, fb->map_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fb->fd,
              0);
    if (at == MAP_FAILED)
        return report_ioctl_failure(fb, "mmap", error);
    fb->map = at;
    return GLINT_OK;
}

static uint8_t *get_mapped_row(const struct glint_fbdev *fb, uint32_t y)
{
    return fb->map + fb->skip_bytes + y * fb->stride_bytes;
}

static bool pan_to_page(struct glint_fbdev *fb, int page)
{
    struct fb_var_screeninfo to = fb->var;

    to.xoffset = 0;
    to.yoffset = (uint32_t)page * fb->var.yres;
    return glint_ioctl(fb->fd, FBIOPAN_DISPLAY, &to) == 0;
}

/* Returns whether the panel can pan between two screens (pages) of its memory.
 * Clears both first, so that old contents of the second screen are not
 * visible. */
static bool can_flip_pages(struct glint_fbdev *fb,
                           const struct fb_fix_screeninfo *fix)
{
    const uint32_t height = fb->var.yres;

    if (fix->ypanstep == 0 || height % fix->ypanstep != 0 ||
        fb->var.yres_virtual / 2 < height ||
        fb->mem_bytes / fb->stride_bytes / 2 < height)
        return false;
    memset(get_mapped_row(fb, 0), 0, 2 * (size_t)height * fb->stride_bytes);
    register_pan_restore(fb);
    return pan_to_page(fb, 1) && pan_to_page(fb, 0);
}

/* Sets FB's layout, memory mapping and number of screens for the mode in
 * fb->var. */
static enum glint_status set_up_video_mode(struct glint_fbdev *fb,
                                           struct glint_error *error)
{
    struct fb_fix_screeninfo fix;
    enum glint_status status;

    unmap_panel(fb);
    glint_panel_close(&fb->panel);
    fb->home = fb->var;
    /* A glint process that was killed may have left the second screen visible,
     * so the original offset is taken to be 0. */
    if (fb->home.yoffset == fb->var.yres)
        fb->home.yoffset = 0;
    if (glint_ioctl(fb->fd, FBIOGET_FSCREENINFO, &fix) < 0)
        return report_ioctl_failure(fb, "FBIOGET_FSCREENINFO", error);
    status = adopt_driver_layout(fb, &fix, error);
    if (!status)
        status = map_panel(fb, error);
    if (status)
        return status;
    fb->n_pages = can_flip_pages(fb, &fix) ? 2 : 1;
    return GLINT_OK;
}

static bool is_same_bit_field(const struct fb_bitfield *a,
                              const struct fb_bitfield *b)
{
    return a->offset == b->offset && a->length == b->length;
}

static bool is_same_video_mode(const struct fb_var_screeninfo *a,
                               const struct fb_var_screeninfo *b)
{
    return a->xres == b->xres && a->yres == b->yres &&
           a->yres_virtual == b->yres_virtual &&
           a->bits_per_pixel == b->bits_per_pixel &&
           a->grayscale == b->grayscale &&
           is_same_bit_field(&a->red, &b->red) &&
           is_same_bit_field(&a->green, &b->green) &&
           is_same_bit_field(&a->blue, &b->blue) &&
           is_same_bit_field(&a->transp, &b->transp);
}

/* Adapts FB if another program has changed the video mode. Fails if the device
 * was removed. */
static enum glint_status adapt_to_mode_change(struct glint_fbdev *fb,
                                              struct glint_error *error)
{
    const struct fb_var_screeninfo old = fb->var;

    if (glint_ioctl(fb->fd, FBIOGET_VSCREENINFO, &fb->var) < 0)
        return report_ioctl_failure(fb, "FBIOGET_VSCREENINFO", error);
    return fb->map && is_same_video_mode(&old, &fb->var)
               ? GLINT_OK
               : set_up_video_mode(fb, error);
}

/* ------------------------------------------------------------------ frames */

static enum glint_status open_panel_for_image(struct glint_fbdev *fb,
                                              const struct glint_image *image,
                                              struct glint_error *error)
{
    const struct glint_panel_config cfg = {.width = fb->width,
                                           .height = fb->height,
                                           .layout = fb->layout,
                                           .fit = fb->options.fit};
    bool is_new;
    const enum glint_status status =
        glint_panel_open_for_image(&fb->panel, &cfg, image, &is_new, error);

    if (is_new)
        fb->cleared[0] = fb->cleared[1] = NULL;
    return status;
}

static void draw_to_mapped_screen(struct glint_fbdev *fb,
                                  const struct glint_image *image, uint8_t *mem,
                                  int page)
{
    const ptrdiff_t stride = (ptrdiff_t)fb->stride_bytes;

    if (fb->cleared[page] != mem)
        glint_panel_clear(&fb->panel, mem, stride);
    fb->cleared[page] = mem;
    glint_panel_draw(&fb->panel, image, mem, stride);
}

/* For panels whose memory holds only one screen. */
static enum glint_status draw_to_visible_screen(struct glint_fbdev *fb,
                                                const struct glint_image *image,
                                                struct glint_error *error)
{
    const uint32_t first = fb->var.yoffset;
    const size_t left = fb->var.xoffset * (size_t)fb->layout.bytes;
    const size_t n_rows = fb->mem_bytes / fb->stride_bytes;
    uint32_t screen = 0;

    if (first > n_rows - fb->var.yres ||
        left + (size_t)fb->width * (size_t)fb->layout.bytes > fb->stride_bytes)
        return glint_error_report(
            error, GLINT_E_DEVICE, fb->name,
            "the driver reports that the visible picture begins at pixel %u, "
            "%u, outside the framebuffer",
            fb->var.xoffset, first);
    if (fb->has_vsync && glint_ioctl(fb->fd, FBIO_WAITFORVSYNC, &screen) < 0)
        fb->has_vsync = false;
    draw_to_mapped_screen(fb, image, get_mapped_row(fb, first) + left, 0);
    return GLINT_OK;
}

/* Draws IMAGE to the hidden one of two screens, then pans the panel to that
 * screen. */
static enum glint_status draw_to_hidden_screen(struct glint_fbdev *fb,
                                               const struct glint_image *image,
                                               struct glint_error *error)
{
    const int page = fb->var.yoffset < fb->var.yres ? 1 : 0;

    draw_to_mapped_screen(
        fb, image, get_mapped_row(fb, (uint32_t)page * fb->var.yres), page);
    if (pan_to_page(fb, page))
        return GLINT_OK;
    if (errno == ENODEV)
        return report_ioctl_failure(fb, "FBIOPAN_DISPLAY", error);
    fb->n_pages = 1;
    return draw_to_visible_screen(fb, image, error);
}

static enum glint_status show_panel_frame(struct glint_sink *sink,
                                          const struct glint_image *image,
                                          struct glint_error *error)
{
    struct glint_fbdev *const fb = (struct glint_fbdev *)sink;
    enum glint_status status = adapt_to_mode_change(fb, error);

    if (!status)
        status = open_panel_for_image(fb, image, error);
    if (status)
        return status;
    return fb->n_pages == 2 ? draw_to_hidden_screen(fb, image, error)
                            : draw_to_visible_screen(fb, image, error);
}

/* -------------------------------------------------------- opening, closing */

static enum glint_status report_open_failure(const struct glint_fbdev *fb,
                                             struct glint_error *error)
{
    const int number = errno;

    if (number == ENOENT || number == ENODEV || number == ENXIO)
        return glint_error_report(
            error, GLINT_E_DEVICE, fb->name,
            "there is no framebuffer, nor a display in /dev/dri; load its "
            "driver (dtoverlay=vc4-kms-v3d on a Raspberry Pi) or name another "
            "device");
    if (number == EACCES || number == EPERM)
        return glint_error_report(
            error, GLINT_E_DEVICE, fb->name,
            "%s; join its group: usermod -aG video USER, then log in again",
            strerror(number));
    return glint_error_report(error, GLINT_E_DEVICE, fb->name, "%s",
                              strerror(number));
}

static void close_framebuffer(struct glint_sink *sink)
{
    struct glint_fbdev *const fb = (struct glint_fbdev *)sink;

    restore_pan_offset_at_close(fb);
    release_console(&fb->console_fd);
    unmap_panel(fb);
    glint_panel_close(&fb->panel);
    if (fb->fd >= 0)
        close(fb->fd);
    fb->fd = -1;
}

static const char *get_default_path(void)
{
    const char *const path = getenv("FRAMEBUFFER");

    return path && *path ? path : "/dev/fb0";
}

static enum glint_status open_framebuffer(struct glint_fbdev *fb,
                                          struct glint_error *error)
{
    fb->fd = open(fb->name, O_RDWR | O_CLOEXEC);
    if (fb->fd < 0)
        return report_open_failure(fb, error);
    if (glint_ioctl(fb->fd, FBIOGET_VSCREENINFO, &fb->var) == 0)
        return GLINT_OK;
    if (errno == ENOTTY || errno == EINVAL)
        return glint_error_report(error, GLINT_E_DEVICE, fb->name,
                                  "is not a framebuffer");
    return report_ioctl_failure(fb, "FBIOGET_VSCREENINFO", error);
}

enum glint_status glint_fbdev_open(struct glint_fbdev *fb, const char *path,
                                   const struct glint_fbdev_options *options,
                                   struct glint_error *error)
{
    enum glint_status status;

    *fb = (struct glint_fbdev){
        .sink = {.put = show_panel_frame, .close = close_framebuffer},
        .options = *options,
        .name = path ? path : get_default_path(),
        .fd = -1,
        .has_vsync = options->vsync,
        .console_fd = -1,
    };
    status = open_framebuffer(fb, error);
    if (!status && options->console) {
        fb->has_note = !acquire_console(&fb->console_fd, &fb->note);
        /* Setting graphics mode may have changed the offset of the visible
         * screen, so the mode is read again. */
        if (glint_ioctl(fb->fd, FBIOGET_VSCREENINFO, &fb->var) < 0)
            status = report_ioctl_failure(fb, "FBIOGET_VSCREENINFO", error);
    }
    if (!status)
        status = set_up_video_mode(fb, error);
    if (status)
        close_framebuffer(&fb->sink);
    else
        ioctl(fb->fd, FBIOBLANK, FB_BLANK_UNBLANK); /* few drivers support it,
                                                       so errors are ignored */
    return status;
}
