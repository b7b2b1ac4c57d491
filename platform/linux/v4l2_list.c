/* SPDX-License-Identifier: MIT */
#include <dirent.h>
#include <linux/videodev2.h>
#include <stdlib.h>
#include <string.h>

#include "linux/fourcc.h"
#include "linux/request.h"
#include "linux/v4l2_device.h"

enum { MAX_NODES = 256 };

/* ------------------------------------------------------------------ devices */

static int by_number(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

/* Lists the numbers of all /dev/videoN, rising. Returns their count, at most
 * MAX_NODES. */
static int find_nodes(int number[MAX_NODES])
{
    DIR *dev = opendir("/dev");
    const struct dirent *entry;
    int n = 0;

    if (!dev)
        return 0;
    while (n < MAX_NODES && (entry = readdir(dev))) {
        char *end;

        if (strncmp(entry->d_name, "video", 5) != 0)
            continue;
        number[n] = (int)strtol(entry->d_name + 5, &end, 10);
        n += end > entry->d_name + 5 && *end == '\0';
    }
    closedir(dev);
    qsort(number, (size_t)n, sizeof *number, by_number);
    return n;
}

static void print_string(FILE *out, const char *text)
{
    putc('"', out);
    for (; *text; text++)
        if (*text == '"' || *text == '\\')
            fprintf(out, "\\%c", *text);
        else
            putc((unsigned char)*text < 32 ? ' ' : *text, out);
    putc('"', out);
}

static void print_inputs(FILE *out, const struct glint_v4l2_device *d,
                         bool json)
{
    struct v4l2_input input = {.index = 0};

    for (; glint_ioctl(d->fd, VIDIOC_ENUMINPUT, &input) == 0; input.index++) {
        if (json) {
            fprintf(out, "%s", input.index ? ", " : "");
            print_string(out, (const char *)input.name);
        } else
            fprintf(out, "    --input %u  %s\n", input.index,
                    (const char *)input.name);
    }
}

static void print_device(FILE *out, const struct glint_v4l2_device *d,
                         bool json, int n_before)
{
    if (!json) {
        fprintf(out, "%s  %s\n", d->path, d->card);
        print_inputs(out, d, false);
        return;
    }
    fprintf(out, "%s\n  {\"device\": ", n_before ? "," : "");
    print_string(out, d->path);
    fputs(", \"card\": ", out);
    print_string(out, d->card);
    fputs(", \"inputs\": [", out);
    print_inputs(out, d, true);
    fputs("]}", out);
}

enum glint_status glint_v4l2_list_devices(FILE *out, bool json)
{
    int number[MAX_NODES], n_cameras = 0, n_refused = 0;
    const int n = find_nodes(number);
    struct glint_error why = {""}, error;

    fputs(json ? "{\"devices\": [" : "", out);
    for (int i = 0; i < n; i++) {
        struct glint_v4l2_device d;
        char name[16];

        snprintf(name, sizeof name, "%d", number[i]);
        if (glint_v4l2_device_attach(&d, name, &error) != GLINT_OK) {
            n_refused++;
            why = error;
            continue;
        }
        print_device(out, &d, json, n_cameras++);
        glint_v4l2_device_close(&d);
    }
    if (json)
        fputs("\n]}\n", out);
    else if (n_cameras == 0)
        fprintf(out, "no camera: %s\n",
                n == 0 ? "there is no /dev/video*" : why.text);
    else if (n_refused)
        fprintf(out, "%d more node%s of /dev/video* capture%s no pictures\n",
                n_refused, n_refused == 1 ? "" : "s",
                n_refused == 1 ? "s" : "");
    return GLINT_OK;
}

/* ------------------------------------------------------------------ formats */

static double rate_of(struct v4l2_fract interval)
{
    return interval.numerator
               ? (double)interval.denominator / interval.numerator
               : 0;
}

static void print_rates(FILE *out, const struct glint_v4l2_device *d,
                        uint32_t fourcc, uint32_t width, uint32_t height,
                        bool json)
{
    struct v4l2_frmivalenum i = {
        .pixel_format = fourcc, .width = width, .height = height};

    fputs(json ? "\"fps\": [" : "", out);
    while (glint_ioctl(d->fd, VIDIOC_ENUM_FRAMEINTERVALS, &i) == 0) {
        if (i.type == V4L2_FRMIVAL_TYPE_DISCRETE)
            fprintf(out, json ? "%s%.5g" : "%s%.4g", i.index ? ", " : "",
                    rate_of(i.discrete));
        else
            fprintf(out, json ? "%.5g, %.5g" : "%.4g to %.4g",
                    rate_of(i.stepwise.max), rate_of(i.stepwise.min));
        i.index++;
        if (i.type != V4L2_FRMIVAL_TYPE_DISCRETE)
            break;
    }
    fputs(json ? "]" : i.index ? " fps\n" : "\n", out);
}

static void print_size(FILE *out, const struct glint_v4l2_device *d,
                       const struct v4l2_frmsizeenum *size, bool json)
{
    const bool discrete = size->type == V4L2_FRMSIZE_TYPE_DISCRETE;
    const uint32_t w =
        discrete ? size->discrete.width : size->stepwise.max_width;
    const uint32_t h =
        discrete ? size->discrete.height : size->stepwise.max_height;

    if (json)
        fprintf(out, "%s{\"width\": %u, \"height\": %u, ",
                size->index ? ", " : "", w, h);
    else
        fprintf(out, "    %s%ux%u  ", discrete ? "" : "up to ", w, h);
    print_rates(out, d, size->pixel_format, w, h, json);
    fputs(json ? "}" : "", out);
}

static void print_sizes(FILE *out, const struct glint_v4l2_device *d,
                        uint32_t fourcc, bool json)
{
    struct v4l2_frmsizeenum size = {.pixel_format = fourcc};

    for (; glint_ioctl(d->fd, VIDIOC_ENUM_FRAMESIZES, &size) == 0;
         size.index++) {
        print_size(out, d, &size, json);
        if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE)
            return;
    }
}

static void print_format(FILE *out, const struct glint_v4l2_device *d,
                         const struct v4l2_fmtdesc *f, bool json)
{
    const bool is_read = glint_v4l2_is_read(f->pixelformat);
    char name[5];

    glint_fourcc_text(f->pixelformat, name);
    if (json) {
        fprintf(out, "%s\n  {\"format\": ", f->index ? "," : "");
        print_string(out, name);
        fprintf(out, ", \"read\": %s, \"sizes\": [",
                is_read ? "true" : "false");
        print_sizes(out, d, f->pixelformat, true);
        fputs("]}", out);
    } else if (is_read) {
        fprintf(out, "%s  %s\n", name, (const char *)f->description);
        print_sizes(out, d, f->pixelformat, false);
    }
}

enum glint_status glint_v4l2_list_formats(FILE *out, const char *device,
                                          bool json, struct glint_error *error)
{
    struct glint_v4l2_device d;
    const enum glint_status status =
        glint_v4l2_device_attach(&d, device, error);
    struct v4l2_fmtdesc f = {.type = d.type};

    if (status != GLINT_OK)
        return status;
    fputs(json ? "{\"formats\": [" : "", out);
    for (; glint_ioctl(d.fd, VIDIOC_ENUM_FMT, &f) == 0; f.index++)
        print_format(out, &d, &f, json);
    fputs(json ? "\n]}\n" : "", out);
    glint_v4l2_device_close(&d);
    return GLINT_OK;
}
