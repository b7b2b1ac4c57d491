/* SPDX-License-Identifier: MIT */
#include "engine/detector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/block.h"

/* Min number of spots (bright regions that may be lamps) of a still picture
 * around which light is measured. The lamps of highest power are selected from
 * these. */
enum { MEASURED = 16 };

/* Returns the max number of tracked lamps if MAX lamps are shown. The result
 * exceeds MAX, so that a lamp is tracked before it is strong enough to be
 * shown. */
static int choose_max_tracks(int max)
{
    const int wanted = max < 64 ? 128 : 2 * max;

    return wanted < GLINT_LAMP_DETECTOR_MAX ? wanted : GLINT_LAMP_DETECTOR_MAX;
}

/* Returns BYTES rounded up to a multiple of 64, the alignment that the init
 * functions require. */
static size_t round_bytes_up_to_64(size_t bytes)
{
    return (bytes + 63) & ~(size_t)63;
}

/* Allocates one block of memory, and initialises the finder, tracker, profile
 * and arrays of F in it. */
static enum glint_status
allocate_detector_memory(struct glint_lamp_detector *f,
                         const struct glint_lamp_finder_config *lights,
                         const struct glint_lamp_tracker_config *tracks)
{
    const size_t lights_bytes =
        round_bytes_up_to_64(glint_lamp_finder_bytes(lights));
    const size_t tracks_bytes =
        round_bytes_up_to_64(glint_lamp_tracker_bytes(tracks));
    const size_t profile_bytes = round_bytes_up_to_64(glint_profile_bytes());
    const size_t spot_bytes =
        round_bytes_up_to_64(GLINT_LAMP_DETECTOR_MAX * sizeof *f->spot);
    enum glint_status status;
    uint8_t *at;

    if (lights_bytes == 0 || tracks_bytes == 0)
        return GLINT_E_ARGUMENT;
    at = glint_block_allocate_aligned(
        lights_bytes + tracks_bytes + profile_bytes + spot_bytes +
            (size_t)f->max_tracks * sizeof *f->track,
        &f->mem);
    if (!at)
        return GLINT_E_MEMORY;
    status = glint_lamp_finder_init(&f->lights, lights, at, lights_bytes);
    if (status == GLINT_OK)
        status = glint_lamp_tracker_init(&f->tracks, tracks, at + lights_bytes,
                                         tracks_bytes);
    at += lights_bytes + tracks_bytes;
    if (status == GLINT_OK)
        status = glint_profile_init(&f->profile, at, profile_bytes);
    at += profile_bytes;
    f->spot = (struct glint_spot *)(void *)at;
    f->track = (struct glint_lamp_track *)(void *)(at + spot_bytes);
    return status;
}

enum glint_status
glint_lamp_detector_open(struct glint_lamp_detector *detector,
                         const struct glint_lamp_finder_config *cfg)
{
    struct glint_lamp_finder_config lights = *cfg;
    struct glint_lamp_tracker_config tracks;
    enum glint_status status;

    detector->mem = NULL;
    detector->n_tracks = detector->n_spots = 0;
    detector->max_tracks = choose_max_tracks(detector->max);
    lights.keep_faint = 1;
    glint_lamp_tracker_defaults(&tracks, cfg->width, cfg->height);
    tracks.max_tracks = detector->max_tracks;
    tracks.max_shown = detector->max;
    status = allocate_detector_memory(detector, &lights, &tracks);
    if (status != GLINT_OK)
        glint_lamp_detector_close(detector);
    return status;
}

enum glint_status
glint_lamp_detector_open_at(struct glint_lamp_detector *detector, int width,
                            int height, const double threshold_ev[2])
{
    struct glint_lamp_finder_config cfg;

    glint_lamp_finder_defaults(&cfg, width, height);
    cfg.threshold_high_q8 = (int32_t)floor(256 * threshold_ev[0] + 0.5);
    cfg.threshold_low_q8 = (int32_t)floor(256 * threshold_ev[1] + 0.5);
    return glint_lamp_detector_open(detector, &cfg);
}

void glint_lamp_detector_close(struct glint_lamp_detector *detector)
{
    free(detector->mem);
    detector->mem = NULL;
}

void glint_lamp_detector_restart_tracking(struct glint_lamp_detector *detector)
{
    glint_lamp_tracker_restart(detector->tracks);
}

static int32_t max_i32(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* Returns the min semi-axis, pixels, of a lamp whose image in a still picture
 * is SPOT. Glare around a clipped core hides how small the lamp is. Without
 * this minimum the lamp would be drawn as a point, and the outlines of its
 * ghosts would be too sharp. */
static int32_t compute_min_axis_q8(const struct glint_spot *spot)
{
    return spot->size_q8 / 6;
}

static struct glint_lamp_track
make_track_of_still_picture(const struct glint_spot *spot, uint32_t id)
{
    const int32_t least_q8 = compute_min_axis_q8(spot);
    const bool is_round = spot->axis_q8[0] <= least_q8;

    return (struct glint_lamp_track){
        .id = id,
        .state = GLINT_LAMP_STEADY,
        .x_q8 = spot->x_q8,
        .y_q8 = spot->y_q8,
        .size_q8 = spot->size_q8,
        .level_q15 = 1 << 15,
        .flux_q16 = spot->flux_q16,
        .power_q16 = spot->power_q16,
        .axis_q8 = {max_i32(spot->axis_q8[0], least_q8),
                    max_i32(spot->axis_q8[1], least_q8)},
        .cos_q15 = is_round ? 1 << 15 : spot->cos_q15,
        .sin_q15 = is_round ? 0 : spot->sin_q15,
        .rgb_q15 = {spot->rgb_q15[0], spot->rgb_q15[1], spot->rgb_q15[2]}};
}

/* Sets the power of a spot as if each clipped pixel had the light 2^headroom.
 * Tracks can store powers only up to 2^42. So for a headroom above 8 stops
 * powers are divided by 2^(headroom - 8), which is stored in member scale. */
static void set_spot_power(struct glint_lamp_detector *f,
                           struct glint_spot *spot)
{
    const double each = 65536 * (exp2(f->headroom_ev) - 1);

    f->scale = exp2(fmax(f->headroom_ev - 8, 0));
    spot->power_q16 = (int64_t)fmin(
        ((double)spot->flux_q16 + spot->n_clipped * each) / f->scale, 0x1p42);
}

/* Finds the spots of IMAGE, at most MAX, and measures the light around the
 * strongest, at most max_tracks. Returns the number of spots. In a city at
 * night, to measure all of a thousand spots would cost several times as much as
 * to find them. */
static int find_and_measure_spots(struct glint_lamp_detector *f,
                                  const struct glint_image *image, int max)
{
    const int n = glint_lamp_finder_find(f->lights, image, f->spot, max);

    glint_profile_measure(f->profile, image, f->spot,
                          n < f->max_tracks ? n : f->max_tracks);
    f->n_spots = n;
    f->scale = 1;
    for (int i = 0; i < n && f->headroom_ev >= 0; i++)
        set_spot_power(f, &f->spot[i]);
    return n;
}

/* Moves the MAX strongest of N spots to the beginning of the array, sorted by
 * falling power. Spots of equal power stay in order. */
static void move_strongest_spots_to_front(struct glint_spot *spot, int n,
                                          int max)
{
    for (int i = 0; i < max; i++) {
        int best = i;
        struct glint_spot strongest;

        for (int k = i + 1; k < n; k++)
            if (spot[k].power_q16 > spot[best].power_q16)
                best = k;
        strongest = spot[best];
        memmove(&spot[i + 1], &spot[i], (size_t)(best - i) * sizeof *spot);
        spot[i] = strongest;
    }
}

/* Finds the lamps of a still picture, without tracking. Returns their number,
 * at most f->max. The light around at least MEASURED spots is measured before
 * the spots of highest power are selected: a lit window may have more clipped
 * light than a brighter lamp. */
static int find_lamps_in_still_picture(struct glint_lamp_detector *f,
                                       const struct glint_image *image)
{
    const int n = find_and_measure_spots(f, image, max_i32(f->max, MEASURED));
    int n_lights = 0;

    while (n_lights < n && !f->spot[n_lights].faint)
        n_lights++;
    if (n_lights > f->max) {
        move_strongest_spots_to_front(f->spot, n_lights, f->max);
        n_lights = f->max;
    }
    for (int i = 0; i < n_lights; i++)
        f->track[i] = make_track_of_still_picture(&f->spot[i], (uint32_t)i + 1);
    return n_lights;
}

static double compute_track_power(const struct glint_lamp_detector *f,
                                  const struct glint_lamp_track *track)
{
    return track->level_q15 / 32768.0 * (double)track->power_q16 / 65536 *
           f->scale;
}

static void set_lamp_extent(struct glint_lamp *lamp,
                            const struct glint_lamp_track *track,
                            double tangent)
{
    for (int k = 0; k < 2; k++)
        lamp->axis[k] = track->axis_q8[k] / 256.0 * tangent;
    lamp->turn_deg = atan2(-track->sin_q15, track->cos_q15) * 180 / GLINT_PI;
}

int glint_lamp_detector_find_lamps(struct glint_lamp_detector *detector,
                                   const struct glint_image *image,
                                   int32_t elapsed_us,
                                   const struct glint_view *view,
                                   double focal_mm, struct glint_lamp *lamps)
{
    struct glint_lamp_detector *f = detector;

    if (elapsed_us > 0) {
        int n;

        glint_lamp_finder_keep_white(
            f->lights, glint_lamp_tracker_white_q15(f->tracks, elapsed_us));
        n = find_and_measure_spots(f, image, GLINT_LAMP_DETECTOR_MAX);
        f->n_tracks = glint_lamp_tracker_step(f->tracks, f->spot, n, elapsed_us,
                                              f->track, f->max_tracks);
    } else {
        f->n_tracks = find_lamps_in_still_picture(f, image);
    }
    for (int i = 0; i < f->n_tracks; i++) {
        const struct glint_lamp_track *track = &f->track[i];

        glint_view_to_angles(view, focal_mm, track->x_q8 / 256.0,
                             track->y_q8 / 256.0, &lamps[i]);
        set_lamp_extent(&lamps[i], track,
                        glint_view_pixel_tangent(view, focal_mm));
        lamps[i].power = compute_track_power(f, track);
        for (int c = 0; c < 3; c++)
            lamps[i].rgb[c] = track->rgb_q15[c] / 32768.0;
    }
    return f->n_tracks;
}

/* Returns whether a spot is about as compact as a disc: its area is at least 60
 * % of the area of a disc with the same RMS radius, 2 pi times the squared RMS
 * radius. */
static int is_spot_disc_shaped(const struct glint_spot *spot)
{
    const double r = spot->size_q8 / 256.0;

    return spot->area >= 0.6 * 2 * GLINT_PI * r * r;
}

const struct glint_spot *
glint_lamp_detector_doubtful(const struct glint_lamp_detector *detector, int i)
{
    for (int k = 0; k < detector->n_spots; k++) {
        const struct glint_spot *spot = &detector->spot[k];

        if (spot->faint && spot->flux_q16 >= (int64_t)spot->area << 15 &&
            is_spot_disc_shaped(spot) && i-- == 0)
            return spot;
    }
    return NULL;
}

double glint_lamp_compute_excess_light(const struct glint_lamp *lamp,
                                       const struct glint_lamp_track *track,
                                       double level, double share, double white)
{
    const double shown =
        (double)track->flux_q16 / 65536 * level / share * white;

    return fmax(lamp->power / share - shown, 0);
}
