/* SPDX-License-Identifier: MIT
 *
 * ctl DEVICE - lists the controls of a video device.
 * ctl DEVICE NAME|0xID [VALUE] - prints a control, or sets it to VALUE. Tests
 *     use it to inject faults into vivid while another program streams.
 * ctl DEVICE format FOURCC WxH - tries to change the capture format.
 * ctl DEVICE input N - selects an input.
 */
#include "device.h"

static void print_camera_control(int fd, const struct v4l2_queryctrl *query)
{
    struct v4l2_control control = {query->id, 0};
    printf("0x%08x %s (%d .. %d)", query->id, (const char *)query->name,
           query->minimum, query->maximum);
    if (try_ioctl(fd, VIDIOC_G_CTRL, &control) == 0)
        printf(" = %d", control.value);
    putchar('\n');
}

static int is_control_requested(const struct v4l2_queryctrl *query,
                                const char *name)
{
    char *end;
    unsigned long id = strtoul(name, &end, 16);
    return (strncmp(name, "0x", 2) == 0 && !*end && id == query->id) ||
           strcmp(name, (const char *)query->name) == 0;
}

/* Prints the control NAME, or all controls if NAME is NULL. If VALUE is not
 * NULL, sets the control NAME to it instead. Returns the number of controls. */
static int print_or_set_controls(int fd, const char *name, const char *value)
{
    int n = 0;
    struct v4l2_queryctrl query = {.id = V4L2_CTRL_FLAG_NEXT_CTRL};
    for (; try_ioctl(fd, VIDIOC_QUERYCTRL, &query) == 0;
         query.id |= V4L2_CTRL_FLAG_NEXT_CTRL) {
        if (query.type == V4L2_CTRL_TYPE_CTRL_CLASS ||
            (name && !is_control_requested(&query, name)))
            continue;
        n++;
        if (!value) {
            print_camera_control(fd, &query);
            continue;
        }
        struct v4l2_control control = {query.id, atoi(value)};
        must_ioctl(fd, VIDIOC_S_CTRL, &control, (const char *)query.name);
        return n;
    }
    return n;
}

int main(int argc, char **argv)
{
    if (argc < 2)
        die("ctl DEVICE [NAME|0xID [VALUE] | format FOURCC WxH | input N]");
    int fd = open_device(argv[1]);
    if (argc == 5 && strcmp(argv[2], "format") == 0) {
        uint32_t width, height;
        size_of(argv[4], &width, &height);
        set_format(fd, V4L2_BUF_TYPE_VIDEO_CAPTURE, fourcc_of(argv[3]), width,
                   height);
    } else if (argc == 4 && strcmp(argv[2], "input") == 0) {
        int input = atoi(argv[3]);
        must_ioctl(fd, VIDIOC_S_INPUT, &input, "VIDIOC_S_INPUT");
    } else if (print_or_set_controls(fd, argc > 2 ? argv[2] : NULL,
                                     argc > 3 ? argv[3] : NULL) == 0) {
        die("%s: no such control", argc > 2 ? argv[2] : argv[1]);
    }
    return 0;
}
