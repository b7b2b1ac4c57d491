/* SPDX-License-Identifier: MIT
 *
 * linux/kms.h - a sink that shows frames on a display through the kernel's mode
 * setting interface (KMS), without libdrm.
 *
 *     glint_kms_open(&kms, NULL, fit, &error);
 *     kms.sink.put(&kms.sink, &image, &error); each frame
 *     kms.sink.close(&kms.sink);
 *
 * The display keeps its video mode if it has one, else it gets the mode that it
 * prefers. Frames are drawn to the hidden one of two buffers (XRGB8888, or
 * RGB565 if the driver prefers 16 bits) and shown at the next vertical blank,
 * so that they do not tear. The first frame replaces the text console.
 *
 * Closing shows again what was there before. After kill -9 the kernel shows its
 * text console, unless another program has the device open.
 *
 * One program at a time draws on a display: while the sink is open, consoles
 * and desktops cannot. While the display is switched off, put() drops frames
 * and counts them.
 */
#ifndef GLINT_PLATFORM_LINUX_KMS_H
#define GLINT_PLATFORM_LINUX_KMS_H

#include "linux/kms_abi.h"
#include "panel/panel.h"

/* max number of CRTCs, connectors and encoders that glint reads of each */
enum { KMS_MAX_IDS = 32 };

struct glint_kms {
    struct glint_sink sink;
    char connector[32]; /* name of the connector, "HDMI-A-1" */
    int width, height;  /* size of the display, pixels */
    int refresh_hz;
    struct glint_pixel_layout layout;
    long n_dropped; /* number of frames that were not shown */

    /* Private members. */
    enum glint_panel_fit fit;
    char path[32]; /* path of the device */
    int fd;        /* -1: closed */
    /* the connectors that show the picture, the one named CONNECTOR first */
    uint32_t connectors[KMS_MAX_IDS];
    struct kms_crtc crtc; /* what glint shows */
    struct kms_crtc home; /* what was shown before */
    struct glint_kms_buffer {
        struct kms_dumb dumb;
        uint32_t fb;
        uint8_t *map;  /* NULL: not allocated */
        bool is_clear; /* true: the borders around the picture are black */
    } buffer[2];
    int hidden;           /* index of the buffer that is not shown */
    bool is_shown;        /* true: the display shows glint's buffers */
    bool is_flip_pending; /* true: the next vertical blank swaps the buffers */
    int n_until_check;    /* number of frames until glint checks whether the
                             display is still connected */
    struct glint_panel panel;
};

/* Returns whether the system has a device of KMS. */
bool glint_kms_is_present(void);

/* Opens the display at CONNECTOR, or the first connected display if that is
 * NULL, and allocates both buffers. Returns GLINT_E_DEVICE if there is none,
 * permission is missing, or another program draws on it; ERROR states what to
 * do. On failure KMS is closed. */
enum glint_status glint_kms_open(struct glint_kms *kms, const char *connector,
                                 enum glint_panel_fit fit,
                                 struct glint_error *error);

#endif
