/* SPDX-License-Identifier: MIT
 *
 * camera_loop MODEL DEVICE FRAMES >FRAMES.yuyv - draws the flare of the lamps
 * in each frame of a camera, with one thread per processor. Frames have 640x480
 * pixels. They are read by read(), which the simplest cameras support. DEVICE
 * may also be a file of such frames. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <linux/videodev2.h>

#include "glint/engine.h"
#include "glint/pool.h"

enum { WIDTH = 640, HEIGHT = 480, BYTES = 2 * WIDTH * HEIGHT, US = 33333 };

static unsigned char frame[BYTES], model[8 << 20];

/* Requests 640x480 YUYV from CAMERA. Returns whether it has this format. An
 * open file, which is not a camera, is assumed to have it. */
static int request_camera_format(int camera)
{
    struct v4l2_capability can;
    static struct v4l2_format format;

    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    format.fmt.pix.width = WIDTH;
    format.fmt.pix.height = HEIGHT;
    format.fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
    if (ioctl(camera, VIDIOC_QUERYCAP, &can) < 0)
        return camera >= 0;
    return ioctl(camera, VIDIOC_S_FMT, &format) == 0 &&
           format.fmt.pix.sizeimage == BYTES;
}

int main(int argc, char **argv)
{
    const int camera = argc == 4 ? open(argv[2], O_RDONLY) : -1;
    FILE *file = argc == 4 ? fopen(argv[1], "rb") : NULL;
    const size_t bytes = file ? fread(model, 1, sizeof model, file) : 0;
    static struct glint_image image;
    struct glint_engine_config cfg;
    struct glint_engine_report report;
    struct glint_error error = {"cannot open the model or the camera, or the "
                                "camera lacks 640x480 YUYV; "
                                "usage: camera_loop MODEL DEVICE FRAMES;"};
    struct glint_engine *engine = NULL;
    struct glint_lens lens;
    struct glint_engine_lamp lamps[16];
    const char *reason = "";
    int left = argc == 4 ? atoi(argv[3]) : 0;

    image.format = GLINT_YUYV;
    image.range = GLINT_RANGE_LIMITED;
    image.width = WIDTH;
    image.height = HEIGHT;
    glint_image_place(&image, frame);
    glint_engine_defaults(&cfg, WIDTH, HEIGHT);
    cfg.model = &lens;
    if (glint_lens_open(&lens, model, bytes, &reason) == GLINT_OK &&
        request_camera_format(camera) &&
        glint_pool_create(&cfg.workers, 0) == GLINT_OK)
        glint_engine_create(&engine, &cfg, &error);
    while (engine && left > 0 && read(camera, frame, BYTES) == BYTES) {
        const int n = glint_engine_find(engine, &image, US, lamps, 16);

        glint_engine_draw(engine, lamps, n, &image, &report);
        left -= fwrite(frame, BYTES, 1, stdout) == 1;
    }
    if (!engine || left > 0)
        fprintf(stderr, "camera_loop: %s %s\n", engine ? "no more" : error.text,
                reason);
    glint_engine_destroy(engine);
    glint_pool_destroy(cfg.workers);
    return !engine || left > 0;
}
