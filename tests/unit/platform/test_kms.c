/* SPDX-License-Identifier: MIT
 *
 * The requests of linux/kms_abi.h against the kernel's header, where a system
 * has it. Displays themselves: tests/vm/test-kms.sh.
 */
#include <stddef.h>
#include <string.h>

#include "linux/kms.h"
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

TEST(requests_equal_those_of_the_kernel)
{
#ifdef HAS_DRM
    /* A request's number contains the size of its structure. */
    assert_int_equal(KMS_CAPABILITY, DRM_IOCTL_GET_CAP);
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
    assert_true(strstr(error.text, "display") || strstr(error.text, "usermod"));
    kms.sink.close(&kms.sink);
}
