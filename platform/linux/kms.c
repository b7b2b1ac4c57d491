/* SPDX-License-Identifier: MIT */
#include "linux/kms.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "linux/request.h"
#include "posix/clock.h"
#include "posix/error.h"

enum {
    MAX_CARDS = 8,
    MAX_MODES = 256, /* of a connector */
    /* Time to wait for a vertical blank; displays that are switched off have
     * none. */
    FLIP_TIMEOUT_MS = 100,
    CHECK_FRAMES = 30
};

/* What find_display() looks for, and what it found instead. */
struct search {
    const char *connector; /* name, or NULL: any that is connected */
    char others[240];      /* names of connectors without a display */
    struct kms_mode modes[MAX_MODES];
};

static enum glint_status report_failure(const struct glint_kms *kms,
                                        const char *request,
                                        struct glint_error *error)
{
    return glint_report_ioctl_error(error, kms->path, request);
}

/* ----------------------------------------------------------------- display */

static void name_connector(const struct kms_connector *c, char *name,
                           size_t size)
{
    static const char *const types[] = {
        "Unknown",   "VGA",  "DVI-I",     "DVI-D",   "DVI-A", "Composite",
        "SVIDEO",    "LVDS", "Component", "DIN",     "DP",    "HDMI-A",
        "HDMI-B",    "TV",   "eDP",       "Virtual", "DSI",   "DPI",
        "Writeback", "SPI",  "USB"};
    const size_t n = sizeof types / sizeof types[0];

    snprintf(name, size, "%s-%u", types[c->type < n ? c->type : 0], c->number);
}

/* Returns the mode that the display of C prefers, or NULL if it has none. */
static const struct kms_mode *find_preferred_mode(const struct kms_connector *c,
                                                  const struct search *search)
{
    for (uint32_t i = 0; i < c->n_modes && c->n_modes <= MAX_MODES; i++)
        if (search->modes[i].type & KMS_MODE_PREFERRED)
            return &search->modes[i];
    return c->n_modes > 0 && c->n_modes <= MAX_MODES ? &search->modes[0] : NULL;
}

/* Sets kms->home to the CRTC that drives connector C, or else to one that can
 * and drives nothing. */
static bool find_crtc(struct glint_kms *kms, const struct kms_connector *c,
                      const struct kms_resources *res, const uint32_t *crtcs,
                      const uint32_t *encoders)
{
    struct kms_encoder e = {.encoder = c->encoder};

    if (c->encoder && glint_ioctl(kms->fd, KMS_ENCODER, &e) == 0 && e.crtc) {
        kms->home = (struct kms_crtc){.crtc = e.crtc};
        return glint_ioctl(kms->fd, KMS_GET_CRTC, &kms->home) == 0;
    }
    for (uint32_t i = 0; i < c->n_encoders; i++) {
        e = (struct kms_encoder){.encoder = encoders[i]};
        if (glint_ioctl(kms->fd, KMS_ENCODER, &e) < 0)
            continue;
        for (uint32_t k = 0; k < res->n_crtcs; k++) {
            kms->home = (struct kms_crtc){.crtc = crtcs[k]};
            if (e.possible_crtcs >> k & 1 &&
                glint_ioctl(kms->fd, KMS_GET_CRTC, &kms->home) == 0 &&
                !kms->home.is_mode_valid)
                return true;
        }
    }
    return false;
}

/* Sets the connectors that show the picture of kms->home: those that it drives
 * already (several of cloned displays), or else connector ID. */
static void find_connectors(struct glint_kms *kms, uint32_t id,
                            const struct kms_resources *res,
                            const uint32_t *connectors)
{
    kms->connectors[0] = id;
    kms->crtc.n_connectors = 1;
    for (uint32_t i = 0; kms->home.is_mode_valid && i < res->n_connectors;
         i++) {
        struct kms_mode mode;
        struct kms_connector c = {.connector = connectors[i],
                                  .modes = (uintptr_t)&mode,
                                  .n_modes = 1};
        struct kms_encoder e;

        if (connectors[i] == id || kms->crtc.n_connectors == KMS_MAX_IDS ||
            glint_ioctl(kms->fd, KMS_CONNECTOR, &c) < 0)
            continue;
        e = (struct kms_encoder){.encoder = c.encoder};
        if (c.encoder && glint_ioctl(kms->fd, KMS_ENCODER, &e) == 0 &&
            e.crtc == kms->home.crtc)
            kms->connectors[kms->crtc.n_connectors++] = connectors[i];
    }
}

/* Adds the connector to those that SEARCH lists, with the reason WHY. Returns
 * false. */
static bool reject_connector(const struct glint_kms *kms, struct search *search,
                             const char *why)
{
    const size_t used = strlen(search->others);

    snprintf(search->others + used, sizeof search->others - used, "%s%s%s",
             used > 0 ? ", " : "", kms->connector, why);
    return false;
}

/* Reads connector ID. Returns whether KMS can show pictures on it. */
static bool try_connector(struct glint_kms *kms, uint32_t id,
                          const struct kms_resources *res,
                          const uint32_t *crtcs, struct search *search)
{
    uint32_t encoders[KMS_MAX_IDS];
    struct kms_connector c = {.connector = id};
    const struct kms_mode *mode;

    /* The first call asks the display for its modes. */
    if (glint_ioctl(kms->fd, KMS_CONNECTOR, &c) < 0)
        return false;
    name_connector(&c, kms->connector, sizeof kms->connector);
    if (search->connector && strcmp(search->connector, kms->connector) != 0)
        return reject_connector(kms, search, "");
    c = (struct kms_connector){.connector = id,
                               .modes = (uintptr_t)search->modes,
                               .n_modes = MAX_MODES,
                               .encoders = (uintptr_t)encoders,
                               .n_encoders = KMS_MAX_IDS};
    if (glint_ioctl(kms->fd, KMS_CONNECTOR, &c) < 0 ||
        c.connection != KMS_CONNECTED)
        return reject_connector(kms, search, "");
    if (c.n_encoders > KMS_MAX_IDS || !find_crtc(kms, &c, res, crtcs, encoders))
        return reject_connector(kms, search,
                                " (connected, no free controller)");
    mode = kms->home.is_mode_valid ? &kms->home.mode
                                   : find_preferred_mode(&c, search);
    if (!mode)
        return reject_connector(kms, search, " (connected, no video mode)");
    kms->crtc = (struct kms_crtc){.crtc = kms->home.crtc,
                                  .connectors = (uintptr_t)kms->connectors,
                                  .is_mode_valid = 1,
                                  .mode = *mode};
    return true;
}

/* Opens card number CARD if a display for SEARCH is connected to it. */
static bool try_card(struct glint_kms *kms, int card, struct search *search)
{
    uint32_t crtcs[KMS_MAX_IDS], connectors[KMS_MAX_IDS];
    struct kms_capability dumb = {.capability = KMS_CAP_DUMB_BUFFER};
    struct kms_resources res = {.crtcs = (uintptr_t)crtcs,
                                .connectors = (uintptr_t)connectors,
                                .n_crtcs = KMS_MAX_IDS,
                                .n_connectors = KMS_MAX_IDS};

    snprintf(kms->path, sizeof kms->path, "/dev/dri/card%d", card);
    kms->fd = open(kms->path, O_RDWR | O_CLOEXEC);
    if (kms->fd < 0)
        return false;
    if (glint_ioctl(kms->fd, KMS_CAPABILITY, &dumb) == 0 && dumb.value &&
        glint_ioctl(kms->fd, KMS_RESOURCES, &res) == 0) {
        if (res.n_crtcs > KMS_MAX_IDS)
            res.n_crtcs = KMS_MAX_IDS;
        if (res.n_connectors > KMS_MAX_IDS)
            res.n_connectors = KMS_MAX_IDS;
        for (uint32_t i = 0; i < res.n_connectors; i++)
            if (try_connector(kms, connectors[i], &res, crtcs, search)) {
                find_connectors(kms, connectors[i], &res, connectors);
                return true;
            }
    }
    close(kms->fd);
    kms->fd = -1;
    return false;
}

bool glint_kms_is_present(void)
{
    char path[32];

    for (int card = 0; card < MAX_CARDS; card++) {
        snprintf(path, sizeof path, "/dev/dri/card%d", card);
        if (access(path, F_OK) == 0)
            return true;
    }
    return false;
}

static enum glint_status find_display(struct glint_kms *kms,
                                      const char *connector,
                                      struct glint_error *error)
{
    struct search search = {.connector = connector};
    bool is_forbidden = false;

    for (int card = 0; card < MAX_CARDS; card++) {
        errno = 0;
        if (try_card(kms, card, &search))
            return GLINT_OK;
        is_forbidden |= errno == EACCES || errno == EPERM;
    }
    if (search.others[0])
        return glint_error_report(
            error, GLINT_E_DEVICE, "kms",
            "no display is connected%s%s; the connectors are %s",
            connector ? " to " : "", connector ? connector : "", search.others);
    if (is_forbidden)
        return glint_error_report(
            error, GLINT_E_DEVICE, "/dev/dri",
            "%s; join its group: usermod -aG video USER, then log in again",
            strerror(EACCES));
    return glint_error_report(
        error, GLINT_E_DEVICE, "/dev/dri",
        "there is no display; load its driver (dtoverlay=vc4-kms-v3d on a "
        "Raspberry Pi)");
}

/* ------------------------------------------------------------------ buffers */

static void free_buffer(struct glint_kms *kms, struct glint_kms_buffer *b)
{
    if (b->map)
        munmap(b->map, (size_t)b->dumb.bytes);
    if (b->fb)
        glint_ioctl(kms->fd, KMS_REMOVE_FB, &b->fb);
    if (b->dumb.handle)
        glint_ioctl(kms->fd, KMS_DESTROY_DUMB, &b->dumb.handle);
    *b = (struct glint_kms_buffer){.map = NULL};
}

static enum glint_status allocate_buffer(struct glint_kms *kms,
                                         struct glint_kms_buffer *b,
                                         struct glint_error *error)
{
    /* the codes of DRM_FORMAT_RGB565 and DRM_FORMAT_XRGB8888 */
    const uint32_t fourcc = kms->layout.bytes == 2 ? 0x36314752 : 0x34325258;
    struct kms_fb fb = {.width = (uint32_t)kms->width,
                        .height = (uint32_t)kms->height,
                        .fourcc = fourcc};
    struct kms_dumb_map at = {.handle = 0};
    void *map;

    b->dumb = (struct kms_dumb){.width = fb.width,
                                .height = fb.height,
                                .bits = 8 * (uint32_t)kms->layout.bytes};
    if (glint_ioctl(kms->fd, KMS_CREATE_DUMB, &b->dumb) < 0)
        return report_failure(kms, "CREATE_DUMB", error);
    fb.handle[0] = at.handle = b->dumb.handle;
    fb.stride_bytes[0] = b->dumb.stride_bytes;
    if (glint_ioctl(kms->fd, KMS_ADD_FB, &fb) < 0)
        return report_failure(kms, "ADDFB2", error);
    b->fb = fb.fb;
    if (glint_ioctl(kms->fd, KMS_MAP_DUMB, &at) < 0)
        return report_failure(kms, "MAP_DUMB", error);
    map = mmap(NULL, (size_t)b->dumb.bytes, PROT_READ | PROT_WRITE, MAP_SHARED,
               kms->fd, (off_t)at.offset);
    if (map == MAP_FAILED)
        return report_failure(kms, "mmap", error);
    b->map = map;
    return GLINT_OK;
}

/* Sets size and layout of KMS and allocates both buffers. */
static enum glint_status allocate_buffers(struct glint_kms *kms,
                                          struct glint_error *error)
{
    static const struct glint_pixel_layout rgb565 = {
        2, {11, 5}, {5, 6}, {0, 5}, {0, 0}};
    static const struct glint_pixel_layout xrgb8888 = {
        4, {16, 8}, {8, 8}, {0, 8}, {0, 0}};
    struct kms_capability depth = {.capability = KMS_CAP_PREFERRED_DEPTH};
    enum glint_status status = GLINT_OK;

    kms->width = kms->crtc.mode.width;
    kms->height = kms->crtc.mode.height;
    kms->refresh_hz = (int)kms->crtc.mode.refresh_hz;
    kms->layout =
        glint_ioctl(kms->fd, KMS_CAPABILITY, &depth) == 0 && depth.value == 16
            ? rgb565
            : xrgb8888;
    if (kms->width < 1 || kms->width > GLINT_PANEL_SIDE || kms->height < 1 ||
        kms->height > GLINT_PANEL_SIDE)
        return glint_error_report(
            error, GLINT_E_DEVICE, kms->connector,
            "has %d x %d pixels; glint supports 1 to %d a side", kms->width,
            kms->height, GLINT_PANEL_SIDE);
    for (int i = 0; i < 2 && !status; i++)
        status = allocate_buffer(kms, &kms->buffer[i], error);
    return status;
}

/* ------------------------------------------------------------------- frames */

/* Waits until the buffers are swapped. Returns false if that takes too long,
 * because the display is switched off. */
static bool finish_flip(struct glint_kms *kms)
{
    const int64_t begin_us = glint_get_time_us();
    struct pollfd event = {.fd = kms->fd, .events = POLLIN};
    char events[256]; /* each is of a flip, as glint requests no others */
    int n;

    kms->sink.wait_us = 0;
    if (!kms->is_flip_pending)
        return true;
    do
        n = poll(&event, 1, FLIP_TIMEOUT_MS);
    while (n < 0 && errno == EINTR);
    kms->is_flip_pending = n <= 0 || read(kms->fd, events, sizeof events) <= 0;
    kms->sink.wait_us = glint_get_time_us() - begin_us;
    return !kms->is_flip_pending;
}

/* Shows the hidden buffer at once, and sets the video mode. */
static bool set_mode(struct glint_kms *kms)
{
    kms->crtc.fb = kms->buffer[kms->hidden].fb;
    if (glint_ioctl(kms->fd, KMS_SET_CRTC, &kms->crtc) < 0)
        return false;
    kms->is_shown = true;
    return true;
}

/* Shows the hidden buffer at the next vertical blank, or at once if the display
 * does not show glint's buffers yet or the driver cannot wait. Returns false
 * with errno set on failure. */
static bool show_hidden_buffer(struct glint_kms *kms)
{
    struct kms_flip flip = {.crtc = kms->crtc.crtc,
                            .fb = kms->buffer[kms->hidden].fb,
                            .flags = KMS_FLIP_EVENT};

    if (kms->is_shown && glint_ioctl(kms->fd, KMS_FLIP, &flip) == 0) {
        kms->is_flip_pending = true;
        return true;
    }
    return (!kms->is_shown || errno != ENODEV) && set_mode(kms);
}

/* Returns whether the display was unplugged or its device removed, as far as
 * the kernel has noticed; does not ask the display. */
static bool is_unplugged(struct glint_kms *kms)
{
    struct kms_mode mode;
    struct kms_connector c = {.connector = kms->connectors[0],
                              .modes = (uintptr_t)&mode,
                              .n_modes = 1};

    if (--kms->n_until_check > 0)
        return false;
    kms->n_until_check = CHECK_FRAMES;
    if (glint_ioctl(kms->fd, KMS_CONNECTOR, &c) < 0)
        return errno == ENODEV || errno == ENOENT;
    return c.connection == KMS_DISCONNECTED;
}

static enum glint_status open_panel_for_image(struct glint_kms *kms,
                                              const struct glint_image *image,
                                              struct glint_error *error)
{
    const struct glint_panel_config cfg = {.width = kms->width,
                                           .height = kms->height,
                                           .layout = kms->layout,
                                           .fit = kms->fit};
    bool is_new;
    const enum glint_status status =
        glint_panel_open_for_image(&kms->panel, &cfg, image, &is_new, error);

    if (is_new)
        kms->buffer[0].is_clear = kms->buffer[1].is_clear = false;
    return status;
}

static void draw_to_buffer(struct glint_kms *kms, struct glint_kms_buffer *b,
                           const struct glint_image *image)
{
    const ptrdiff_t stride = (ptrdiff_t)b->dumb.stride_bytes;

    if (!b->is_clear)
        glint_panel_clear(&kms->panel, b->map, stride);
    b->is_clear = true;
    glint_panel_draw(&kms->panel, image, b->map, stride);
}

static enum glint_status show_frame(struct glint_sink *sink,
                                    const struct glint_image *image,
                                    struct glint_error *error)
{
    struct glint_kms *const kms = (struct glint_kms *)sink;
    enum glint_status status;

    if (is_unplugged(kms))
        return glint_error_report(error, GLINT_E_DEVICE, kms->connector,
                                  "the display was unplugged");
    status = open_panel_for_image(kms, image, error);
    if (status)
        return status;
    if (!finish_flip(kms)) {
        kms->n_until_check = 0; /* It may be unplugged. */
        kms->n_dropped++;
        return GLINT_OK;
    }
    draw_to_buffer(kms, &kms->buffer[kms->hidden], image);
    if (!show_hidden_buffer(kms))
        return report_failure(kms, "SETCRTC", error);
    kms->hidden = !kms->hidden;
    return GLINT_OK;
}

/* --------------------------------------------------------- opening, closing */

static void close_display(struct glint_sink *sink)
{
    struct glint_kms *const kms = (struct glint_kms *)sink;

    if (kms->fd < 0)
        return;
    finish_flip(kms);
    if (kms->is_shown && kms->home.is_mode_valid) {
        kms->home.connectors = kms->crtc.connectors;
        kms->home.n_connectors = kms->crtc.n_connectors;
        glint_ioctl(kms->fd, KMS_SET_CRTC, &kms->home);
    }
    for (int i = 0; i < 2; i++)
        free_buffer(kms, &kms->buffer[i]);
    glint_panel_close(&kms->panel);
    close(kms->fd);
    kms->fd = -1;
}

/* Makes glint the one program that draws on the device. Opening it does so if
 * no other program is. Before version 5.8 the kernel then allows SET_MASTER to
 * root only, so that the error of AUTH_MAGIC decides: for the value 0, the
 * master gets EINVAL and others get EACCES. */
static bool become_master(const struct glint_kms *kms)
{
    uint32_t none = 0;

    return ioctl(kms->fd, KMS_SET_MASTER, 0) == 0 ||
           (errno == EACCES &&
            glint_ioctl(kms->fd, KMS_AUTH_MAGIC, &none) < 0 && errno == EINVAL);
}

enum glint_status glint_kms_open(struct glint_kms *kms, const char *connector,
                                 enum glint_panel_fit fit,
                                 struct glint_error *error)
{
    enum glint_status status;

    *kms = (struct glint_kms){
        .sink = {.put = show_frame, .close = close_display},
        .fit = fit,
        .fd = -1,
        .n_until_check = CHECK_FRAMES,
    };
    status = find_display(kms, connector, error);
    if (!status && !become_master(kms))
        status = glint_error_report(
            error, GLINT_E_DEVICE, kms->path,
            "another program draws on the display; leave the desktop for a "
            "text console (Ctrl+Alt+F3), or use -o window");
    if (!status)
        status = allocate_buffers(kms, error);
    if (status)
        close_display(&kms->sink);
    return status;
}
