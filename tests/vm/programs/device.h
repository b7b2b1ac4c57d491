/* SPDX-License-Identifier: MIT
 *
 * device.h - functions for the programs that run in the virtual machine: they
 * parse the command line, and call ioctl(), ending the program on failure.
 */
#ifndef GLINT_VM_DEVICE_H
#define GLINT_VM_DEVICE_H

#include <errno.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

__attribute__((noreturn, format(printf, 1, 2), unused)) static void
die(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vfprintf(stderr, format, args);
    va_end(args);
    fputc('\n', stderr);
    exit(1);
}

__attribute__((unused)) static int try_ioctl(int fd, unsigned long request,
                                             void *arg)
{
    int rc;
    do {
        rc = ioctl(fd, request, arg);
    } while (rc < 0 && errno == EINTR);
    return rc;
}

/* Calls ioctl(). On failure, prints a message that contains NAME and ends the
 * program. */
__attribute__((unused)) static void must_ioctl(int fd, unsigned long request,
                                               void *arg, const char *name)
{
    if (try_ioctl(fd, request, arg) < 0)
        die("%s: %s", name, strerror(errno));
}

__attribute__((unused)) static int open_device(const char *path)
{
    int fd = open(path, O_RDWR | O_CLOEXEC);
    if (fd < 0)
        die("%s: %s", path, strerror(errno));
    return fd;
}

__attribute__((unused)) static uint32_t fourcc_of(const char *word)
{
    if (strlen(word) != 4)
        die("%s: not a FOURCC", word);
    return v4l2_fourcc(word[0], word[1], word[2], word[3]);
}

__attribute__((unused)) static void size_of(const char *word, uint32_t *width,
                                            uint32_t *height)
{
    if (sscanf(word, "%ux%u", width, height) != 2)
        die("%s: not WxH", word);
}

/* Returns the contents of the file, which the caller frees. */
__attribute__((unused)) static uint8_t *read_file(const char *path,
                                                  size_t *n_bytes)
{
    struct stat stat;
    int fd = open(path, O_RDONLY);
    if (fd < 0 || fstat(fd, &stat) < 0)
        die("%s: %s", path, strerror(errno));
    *n_bytes = (size_t)stat.st_size;
    uint8_t *bytes = malloc(*n_bytes + 1);
    if (!bytes)
        die("%s: no memory", path);
    for (size_t done = 0; done < *n_bytes;) {
        ssize_t n = read(fd, bytes + done, *n_bytes - done);
        if (n <= 0)
            die("%s: cannot read", path);
        done += (size_t)n;
    }
    close(fd);
    return bytes;
}

/* Returns the number of bytes of a frame in a file, without padding, or 0 for
 * compressed formats. This differs from the sizeimage of v4l2loopback, which is
 * rounded up to pages. */
__attribute__((unused)) static size_t
packed_bytes(uint32_t fourcc, uint32_t width, uint32_t height)
{
    static const struct {
        char name[5];
        uint8_t bits;
    } depth[] = {{"YUYV", 16}, {"UYVY", 16}, {"YVYU", 16}, {"VYUY", 16},
                 {"NV16", 16}, {"422P", 16}, {"RGBP", 16}, {"XR15", 16},
                 {"NV12", 12}, {"NV21", 12}, {"YU12", 12}, {"YV12", 12},
                 {"RGB3", 24}, {"BGR3", 24}, {"XR24", 32}, {"GREY", 8},
                 {"MJPG", 0},  {"JPEG", 0}};
    for (size_t i = 0; i < sizeof depth / sizeof depth[0]; i++)
        if (fourcc_of(depth[i].name) == fourcc)
            return (size_t)width * height * depth[i].bits / 8;
    die("%.4s: no such format here", (const char *)&fourcc);
}

/* Sets the format of a single-planar device and checks that the device accepted
 * it unchanged. Returns its sizeimage. */
__attribute__((unused)) static uint32_t set_format(int fd, uint32_t type,
                                                   uint32_t fourcc,
                                                   uint32_t width,
                                                   uint32_t height)
{
    struct v4l2_format format = {.type = type};
    must_ioctl(fd, VIDIOC_G_FMT, &format, "VIDIOC_G_FMT");
    format.fmt.pix.pixelformat = fourcc;
    format.fmt.pix.width = width;
    format.fmt.pix.height = height;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    format.fmt.pix.bytesperline = 0;
    format.fmt.pix.sizeimage = 0;
    must_ioctl(fd, VIDIOC_S_FMT, &format, "VIDIOC_S_FMT");
    if (format.fmt.pix.pixelformat != fourcc || format.fmt.pix.width != width ||
        format.fmt.pix.height != height)
        die("device offers %.4s %ux%u instead",
            (const char *)&format.fmt.pix.pixelformat, format.fmt.pix.width,
            format.fmt.pix.height);
    return format.fmt.pix.sizeimage;
}

#endif
