/* SPDX-License-Identifier: MIT
 *
 * grab [-s SKIP] DEVICE FOURCC WxH COUNT OUT [REFERENCE] - captures COUNT
 * frames of a camera and writes them to OUT after the last one, so that writing
 * causes no dropped frames. Prints for each frame which frame of REFERENCE (a
 * file of frames of this size) it equals bit by bit, and fails if there is
 * none.
 */
#include <poll.h>
#include <sys/mman.h>

#include "device.h"

#define N_BUFFERS 4

struct camera {
    int fd;
    size_t image_bytes;
    void *memory[N_BUFFERS];
    size_t length[N_BUFFERS];
};

static void queue_buffer(const struct camera *camera, uint32_t index)
{
    struct v4l2_buffer buffer = {.index = index,
                                 .type = V4L2_BUF_TYPE_VIDEO_CAPTURE,
                                 .memory = V4L2_MEMORY_MMAP};
    must_ioctl(camera->fd, VIDIOC_QBUF, &buffer, "VIDIOC_QBUF");
}

static void start_camera(struct camera *camera)
{
    struct v4l2_requestbuffers request = {.count = N_BUFFERS,
                                          .type = V4L2_BUF_TYPE_VIDEO_CAPTURE,
                                          .memory = V4L2_MEMORY_MMAP};
    must_ioctl(camera->fd, VIDIOC_REQBUFS, &request, "VIDIOC_REQBUFS");
    for (uint32_t i = 0; i < request.count && i < N_BUFFERS; i++) {
        struct v4l2_buffer buffer = {
            .index = i, .type = request.type, .memory = request.memory};
        must_ioctl(camera->fd, VIDIOC_QUERYBUF, &buffer, "VIDIOC_QUERYBUF");
        camera->length[i] = buffer.length;
        camera->memory[i] = mmap(NULL, buffer.length, PROT_READ, MAP_SHARED,
                                 camera->fd, (off_t)buffer.m.offset);
        if (camera->memory[i] == MAP_FAILED)
            die("mmap: %s", strerror(errno));
        queue_buffer(camera, i);
    }
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    must_ioctl(camera->fd, VIDIOC_STREAMON, &type, "VIDIOC_STREAMON");
}

/* Copies the next frame of the camera to DST[image_bytes]. Returns its number
 * of bytes. */
static size_t copy_next_frame(const struct camera *camera, uint8_t *dst)
{
    struct pollfd ready = {.fd = camera->fd, .events = POLLIN};
    if (poll(&ready, 1, 5000) != 1)
        die("no frame for 5 s");
    struct v4l2_buffer buffer = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE,
                                 .memory = V4L2_MEMORY_MMAP};
    must_ioctl(camera->fd, VIDIOC_DQBUF, &buffer, "VIDIOC_DQBUF");
    size_t n_bytes = buffer.bytesused < camera->image_bytes
                         ? buffer.bytesused
                         : camera->image_bytes;
    memcpy(dst, camera->memory[buffer.index], n_bytes);
    printf("sequence %u, %zu bytes%s", buffer.sequence, n_bytes,
           buffer.flags & V4L2_BUF_FLAG_ERROR ? ", ERROR" : "");
    queue_buffer(camera, buffer.index);
    return n_bytes;
}

struct reference {
    const uint8_t *bytes;
    size_t n_bytes;
};

static int find_reference_frame(const struct reference *reference,
                                const uint8_t *frame, size_t n_bytes)
{
    for (size_t at = 0; at + n_bytes <= reference->n_bytes; at += n_bytes)
        if (memcmp(reference->bytes + at, frame, n_bytes) == 0)
            return (int)(at / n_bytes);
    return -1;
}

static int grab_camera_frames(const struct camera *camera, int skip, int count,
                              FILE *out, const struct reference *reference)
{
    int n_strange = 0;
    uint8_t *frames = malloc((size_t)count * camera->image_bytes);
    size_t n_bytes = 0;
    if (!frames)
        die("no memory for %d frames", count);
    for (int i = -skip; i < count; i++) {
        uint8_t *dst = frames + n_bytes;
        size_t n = copy_next_frame(camera, dst);
        if (i >= 0) {
            int found =
                reference->bytes ? find_reference_frame(reference, dst, n) : 0;
            if (reference->bytes)
                printf(", frame %d", found);
            n_strange += found < 0;
            n_bytes += n;
        }
        puts(i < 0 ? ", skipped" : "");
    }
    if (fwrite(frames, 1, n_bytes, out) != n_bytes || fclose(out))
        die("cannot write");
    free(frames);
    return n_strange;
}

int main(int argc, char **argv)
{
    int skip = 0, option;
    while ((option = getopt(argc, argv, "s:")) != -1)
        skip = option == 's' ? atoi(optarg) : skip;
    if (argc - optind < 5)
        die("grab [-s SKIP] DEVICE FOURCC WxH COUNT OUT [REFERENCE]");
    char **word = argv + optind;
    struct camera camera = {.fd = open_device(word[0])};
    struct reference reference = {0};
    uint32_t width, height;
    int count = atoi(word[3]);
    size_of(word[2], &width, &height);
    camera.image_bytes = set_format(camera.fd, V4L2_BUF_TYPE_VIDEO_CAPTURE,
                                    fourcc_of(word[1]), width, height);
    if (word[5])
        reference.bytes = read_file(word[5], &reference.n_bytes);
    FILE *out = fopen(word[4], "wb");
    if (!out)
        die("%s: %s", word[4], strerror(errno));
    start_camera(&camera);
    int n_strange = grab_camera_frames(&camera, skip, count, out, &reference);
    printf("%d frames, %d not of the reference\n", count, n_strange);
    return n_strange > 0;
}
