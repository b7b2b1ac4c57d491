/* SPDX-License-Identifier: MIT
 *
 * linux/kms_abi.h - the requests of the Linux kernel's mode setting interface
 * (KMS) that glint sends: structures and numbers of the kernel's headers
 * drm/drm.h and drm/drm_mode.h, which not every system has. test_kms compares
 * them with those headers where they are installed.
 */
#ifndef GLINT_PLATFORM_LINUX_KMS_ABI_H
#define GLINT_PLATFORM_LINUX_KMS_ABI_H

#include <linux/ioctl.h>
#include <stdint.h>

struct kms_capability {
    uint64_t capability, value;
};
enum { KMS_CAP_DUMB_BUFFER = 1, KMS_CAP_PREFERRED_DEPTH = 3 };

struct kms_mode {
    uint32_t clock;
    uint16_t width, hsync_start, hsync_end, htotal, hskew;
    uint16_t height, vsync_start, vsync_end, vtotal, vscan;
    uint32_t refresh_hz, flags, type;
    char name[32];
};
enum { KMS_MODE_PREFERRED = 8 }; /* a bit of TYPE */

/* Pointers are 64 bits wide on all systems. The kernel sets a count to the
 * number of elements that exist, and writes as many as the count allowed, but
 * no modes, encoders and properties of a connector if the count is too small.
 */
struct kms_resources {
    uint64_t fbs, crtcs, connectors, encoders;
    uint32_t n_fbs, n_crtcs, n_connectors, n_encoders;
    uint32_t min_width, max_width, min_height, max_height;
};

struct kms_crtc {
    uint64_t connectors;
    uint32_t n_connectors, crtc, fb, x, y, gamma_size, is_mode_valid;
    struct kms_mode mode;
};

struct kms_encoder {
    uint32_t encoder, type, crtc, possible_crtcs, possible_clones;
};

/* With N_MODES 0 the kernel asks the display for its modes. */
struct kms_connector {
    uint64_t encoders, modes, properties, values;
    uint32_t n_modes, n_properties, n_encoders;
    uint32_t encoder, connector, type, number, connection;
    uint32_t width_mm, height_mm, subpixel, pad;
};
enum { KMS_CONNECTED = 1, KMS_DISCONNECTED = 2 }; /* values of CONNECTION */

struct kms_fb {
    uint32_t fb, width, height, fourcc, flags;
    uint32_t handle[4], stride_bytes[4], offset[4];
    uint64_t modifier[4];
};

struct kms_flip {
    uint32_t crtc, fb, flags, reserved;
    uint64_t user_data;
};
enum { KMS_FLIP_EVENT = 1 }; /* a bit of FLAGS */

struct kms_dumb { /* memory for a picture, mapped by the processor */
    uint32_t height, width, bits, flags, handle, stride_bytes;
    uint64_t bytes;
};

struct kms_dumb_map {
    uint32_t handle, pad;
    uint64_t offset;
};

#define KMS_CAPABILITY   _IOWR('d', 0x0c, struct kms_capability)
#define KMS_AUTH_MAGIC   _IOW('d', 0x11, uint32_t)
#define KMS_SET_MASTER   _IO('d', 0x1e)
#define KMS_RESOURCES    _IOWR('d', 0xa0, struct kms_resources)
#define KMS_GET_CRTC     _IOWR('d', 0xa1, struct kms_crtc)
#define KMS_SET_CRTC     _IOWR('d', 0xa2, struct kms_crtc)
#define KMS_ENCODER      _IOWR('d', 0xa6, struct kms_encoder)
#define KMS_CONNECTOR    _IOWR('d', 0xa7, struct kms_connector)
#define KMS_REMOVE_FB    _IOWR('d', 0xaf, unsigned int)
#define KMS_FLIP         _IOWR('d', 0xb0, struct kms_flip)
#define KMS_CREATE_DUMB  _IOWR('d', 0xb2, struct kms_dumb)
#define KMS_MAP_DUMB     _IOWR('d', 0xb3, struct kms_dumb_map)
#define KMS_DESTROY_DUMB _IOWR('d', 0xb4, uint32_t)
#define KMS_ADD_FB       _IOWR('d', 0xb8, struct kms_fb)

#endif
