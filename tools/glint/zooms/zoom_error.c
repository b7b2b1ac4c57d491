/* SPDX-License-Identifier: MIT */
#include "zooms/zoom_error.h"

#include <math.h>
#include <stdlib.h>

#include "glint/engine.h"
#include "glint/measure.h"
#include "glint/glint.h"
#include "glint/transfer.h"
#include "model/picture_check.h"

/* Size of the compared images, pixels; the width is a quarter of that of 1080p.
 * Errors in the positions of outlines are the same fraction of the image as in
 * larger images. */
enum { WIDE = 480, MOST_HIGH = 480 };

/* max angle of lights, as a multiple of the angle of a corner of the film */
#define BEYOND 1.5

/* azimuth of lights, degrees; not on a symmetry axis of the film */
#define AZIMUTH_DEG 33

/* Wavelength of all images, nm. Three wavelengths would take twice as long.
 * Near the middle of the visible band coatings make ghosts too faint to be
 * measured. */
#define WAVE_NM 450

/* min linear light of a visible ghost, 1 = white; a third of that of code 1 */
#define FAINT 1e-4

enum { EACH = 4 }; /* the first pass measures every EACH-th angle */

/* State of a ghost at an angle, as bits */
enum {
    MEASURED = 1,
    IN_MODEL = 2, /* the ghost is visible in the image by the model */
    IN_EXACT = 4, /* the ghost is visible in the image by exact rays */
    IN_RANGE = 8, /* the model has rays of the ghost, which may be invisible */
    WANTED = 16   /* the angle must be measured in the present pass */
};
enum { SEEN = IN_MODEL | IN_EXACT };

/* Data that all jobs use. One thread does the job for an angle, because the
 * frames are too small to be divided among threads. */
struct measuring {
    const struct glint_setup *setup;
    const struct glint_zoom_lens *zoom;
    struct glint_view view;
    double max_deg, shift;
    int n;
    struct zoom_error *error;
    /* bits for each ghost at each angle, [n][ZOOM_ANGLES] */
    unsigned char (*known)[ZOOM_ANGLES];
    enum glint_status status[ZOOM_ANGLES];
};

static double compute_field_angle_deg(const struct measuring *m, int angle)
{
    return fmin(m->max_deg,
                m->max_deg * (angle + EACH * m->shift) / ZOOM_ANGLES);
}

/* ----------------------------------------------------------------- pictures */

/* Images of one light: ALL by the zoom model with all ghosts, MIXED by the zoom
 * model with one ghost, TRACED by exact rays with this ghost. They are grey,
 * because there is one wavelength. */
struct pictures {
    struct picture_pair by;
    struct glint_float_image all, mixed, traced;
    double exposure;
};

/* Sets ERROR to the mean squared error that this ghost alone causes: both
 * images have the model's other ghosts, and this one by the model or by exact
 * rays. Returns the bits of the images in which the ghost is visible. */
static int compute_image_error_of_ghost(const struct pictures *p, double *error)
{
    const size_t n = (size_t)p->all.width * (size_t)p->all.height;
    double sum = 0;
    int seen = 0;

    for (size_t i = 0; i < n; i++) {
        const double mixed = (double)p->mixed.rgb[3 * i];
        const double traced = (double)p->traced.rgb[3 * i];
        const double rest = fmax(0, (double)p->all.rgb[3 * i] - mixed);
        double off;

        if (mixed <= 0 && traced <= 0)
            continue;
        seen |= (mixed * p->exposure > FAINT ? IN_MODEL : 0) |
                (traced * p->exposure > FAINT ? IN_EXACT : 0);
        off = (glint_measure_code(p->exposure * (rest + mixed)) -
               glint_measure_code(p->exposure * (rest + traced))) /
              255;
        sum += off * off;
    }
    *error = sum / (double)n;
    return seen;
}

/* Draws GHOST, or all ghosts if GHOST < 0. */
static enum glint_status draw_ghost_image(struct glint_engine *engine,
                                          const struct glint_lamp *lamp,
                                          int ghost,
                                          struct glint_float_image *image)
{
    struct glint_engine_report report;

    glint_engine_set_only_ghost(engine, ghost);
    return glint_engine_render(engine, lamp, 1, 1, GLINT_ENGINE_GHOSTS,
                               image->rgb, &report);
}

static enum glint_status measure_ghosts_at_angle(const struct measuring *m,
                                                 struct pictures *p, int angle)
{
    const struct glint_lamp lamp = {.theta_deg =
                                        compute_field_angle_deg(m, angle),
                                    .phi_deg = AZIMUTH_DEG,
                                    .power = 1,
                                    .rgb = {1, 1, 1}};
    enum glint_status status =
        draw_ghost_image(p->by.model, &lamp, -1, &p->all);

    p->exposure = glint_measure_exposure(&p->all);
    for (int g = 0; g < m->n && status == GLINT_OK; g++) {
        if (!(m->known[g][angle] & WANTED))
            continue;
        status = draw_ghost_image(p->by.model, &lamp, g, &p->mixed);
        if (status == GLINT_OK)
            status = draw_ghost_image(p->by.exact, &lamp, g, &p->traced);
        m->known[g][angle] =
            (unsigned char)((m->known[g][angle] & IN_RANGE) | MEASURED |
                            compute_image_error_of_ghost(
                                p, &m->error[g].of[angle]));
    }
    return status;
}

static bool allocate_error_image(struct glint_float_image *image,
                                 const struct glint_view *view)
{
    image->width = view->width;
    image->height = view->height;
    image->rgb =
        calloc(3 * (size_t)view->width * (size_t)view->height, sizeof(float));
    return image->rgb != NULL;
}

static void run_measurement_at_angle(void *ctx, int angle, int worker)
{
    struct measuring *const m = ctx;
    struct pictures p = {.exposure = 1};
    struct glint_error error;
    bool any = false;

    (void)worker;
    for (int g = 0; g < m->n; g++)
        any |= m->known[g][angle] & WANTED;
    if (!any)
        return;
    m->status[angle] = allocate_error_image(&p.all, &m->view) &&
                               allocate_error_image(&p.mixed, &m->view) &&
                               allocate_error_image(&p.traced, &m->view)
                           ? picture_pair_open(&p.by, m->setup, &m->zoom->lens,
                                               &m->view, &error)
                           : GLINT_E_MEMORY;
    if (m->status[angle] == GLINT_OK)
        m->status[angle] = measure_ghosts_at_angle(m, &p, angle);
    picture_pair_close(&p.by);
    free(p.all.rgb);
    free(p.mixed.rgb);
    free(p.traced.rgb);
}

/* ------------------------------------------------------------------- angles */

/* Sets IN_RANGE for the requested ghosts at each angle where the model has rays
 * of them. */
static bool find_ghost_angle_ranges(struct measuring *m)
{
    struct glint_transfer *const transfer = malloc(sizeof *transfer);
    const bool has_room = transfer != NULL;
    const struct glint_model_header *const h = m->zoom->lens.header;
    const int32_t wave_q24 = h->wave_lo_q24 / 2 + h->wave_hi_q24 / 2;

    for (int g = 0; g < m->n && has_room; g++)
        for (int a = 0; a < ZOOM_ANGLES && m->error[g].of[0] < 0; a++) {
            const double sine =
                sin(compute_field_angle_deg(m, a) * GLINT_PI / 180);

            if (glint_transfer_init(transfer, &m->zoom->lens, g,
                                    (int32_t)(sine * 0x1p30), wave_q24))
                m->known[g][a] |= IN_RANGE;
        }
    free(transfer);
    return has_room;
}

/* Returns whether to measure a ghost with the states KNOWN at ANGLE. The ghost
 * must be measured at both neighbours, STEP before and after ANGLE. It is
 * measured at ANGLE if it is visible at only one of them, or in only one of the
 * two images, or if it has rays at ANGLE but at neither neighbour. */
static bool is_measurement_wanted(const unsigned char known[ZOOM_ANGLES],
                                  int angle, int step)
{
    const int before = known[angle - step];
    const int after = angle + step < ZOOM_ANGLES ? known[angle + step] : before;
    const int seen = before & SEEN;

    if (!(before & after & MEASURED))
        return false;
    return ((before ^ after) & SEEN) || (seen && seen != SEEN) ||
           (known[angle] & ~(before | after) & IN_RANGE);
}

/* In the first pass (STEP = EACH) marks every STEP-th angle of the requested
 * ghosts as wanted. Later passes mark those odd multiples of STEP that
 * is_measurement_wanted() chooses. */
static void mark_angles_to_measure(struct measuring *m, int step)
{
    for (int g = 0; g < m->n; g++)
        for (int a = 0; a < ZOOM_ANGLES; a += step)
            if (step == EACH ? m->error[g].of[0] < 0
                             : (m->known[g][0] & MEASURED) && a % (2 * step) &&
                                   is_measurement_wanted(m->known[g], a, step))
                m->known[g][a] |= WANTED;
}

/* Interpolates ERROR at the angles that KNOWN does not mark as measured. */
static void interpolate_angle_errors(const unsigned char known[ZOOM_ANGLES],
                                     struct zoom_error *error)
{
    int before = 0, after = 0;

    for (int a = 0; a < ZOOM_ANGLES; a++) {
        if (known[a] & MEASURED) {
            before = a;
            continue;
        }
        for (after = a; after < ZOOM_ANGLES && !(known[after] & MEASURED);)
            after++;
        error->of[a] =
            after < ZOOM_ANGLES
                ? error->of[before] + (error->of[after] - error->of[before]) *
                                          (a - before) / (after - before)
                : error->of[before];
    }
}

/* Returns the max angle, degrees, of lights to measure with LENS, at most
 * MAX_DEG. */
static double find_max_measured_angle_deg(const struct glint_prescription *lens,
                                          double max_deg)
{
    const double corner_mm =
        0.5 * hypot(lens->film_width_mm, lens->film_height_mm);
    struct glint_optics optics;

    glint_optics_of(lens, &optics);
    return fmin(max_deg, BEYOND * 180 / GLINT_PI *
                             atan(corner_mm / fabs(optics.focal_mm)));
}

/* Measures the errors in passes. Each pass halves the interval between
 * angles. */
static enum glint_status measure_all_angles(struct measuring *m,
                                            struct glint_workers *workers)
{
    enum glint_status status =
        find_ghost_angle_ranges(m) ? GLINT_OK : GLINT_E_MEMORY;

    for (int step = EACH; step > 0 && status == GLINT_OK; step /= 2) {
        mark_angles_to_measure(m, step);
        glint_workers_run(workers, ZOOM_ANGLES, run_measurement_at_angle, m);
        for (int k = 0; k < ZOOM_ANGLES && status == GLINT_OK; k++)
            status = m->status[k];
    }
    for (int g = 0; g < m->n && status == GLINT_OK; g++)
        if (m->known[g][0] & MEASURED)
            interpolate_angle_errors(m->known[g], &m->error[g]);
    return status;
}

enum glint_status zoom_error_measure_ghosts(
    const struct tool *tool, const struct glint_prescription *lens,
    const struct glint_zoom_lens *zoom, double max_deg, double shift, int n,
    struct zoom_error *error, struct glint_error *message)
{
    static const double wave_nm[] = {WAVE_NM};
    const double high = ceil(WIDE * lens->film_height_mm / lens->film_width_mm);
    struct glint_setup *const setup = malloc(sizeof *setup);
    struct measuring m = {
        .setup = setup,
        .zoom = zoom,
        .view = glint_view_fit(WIDE, (int)fmin(fmax(high, 8), MOST_HIGH),
                               lens->film_width_mm, lens->film_height_mm),
        .max_deg = find_max_measured_angle_deg(lens, max_deg),
        .shift = shift,
        .n = n,
        .error = error,
        .known = calloc((size_t)n + 1, sizeof *m.known)};
    enum glint_status status = GLINT_E_MEMORY;

    if (setup && m.known)
        status = glint_setup_init(setup, lens, 0, 0, wave_nm, 1, message);
    if (status == GLINT_OK)
        status = measure_all_angles(&m, tool->workers);
    free(m.known);
    free(setup);
    return status;
}
