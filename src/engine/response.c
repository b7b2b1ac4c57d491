/* SPDX-License-Identifier: MIT */
#include "engine/response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/area.h"
#include "engine/frame/frame_parts.h"
#include "engine/setup/spectrum.h"

/* max number of values that find_largest_values() finds */
enum { TOP_MAX = GLINT_RESPONSE_FINE / 5000 };

static const double none_log2 = -100;

/* EXACT_ANGLES, EXACT_GRID: number of measured angles, and fineness of grids,
 * with exact rays. GRID: fineness of grids with a model. Exact rays cost fifty
 * times as much as a model, so they have fewer angles and coarser grids. */
enum { EXACT_ANGLES = 4, EXACT_GRID = 6, GRID = 12 };

/* The powers of lamps are scaled until the brightest pixels are 2^AIM_LOG2
 * times display white, within a factor of 2^AIM_SPAN. This is in the middle
 * between saturation and the quantisation step. */
enum { AIM_LOG2 = 4, AIM_SPAN = 6 };

/* First estimate of log2 of the light of the brightest pixels of a draft, with
 * which most drafts need no second picture. */
enum { DRAFT_PEAK_LOG2 = -8 };

/* -------------------------------------------------------- brightest pixels */

/* Puts VALUE into TOP, which has N values in falling order, and drops the
 * smallest. Returns the new smallest value. */
static float insert_into_largest_values(float *top, int n, float value)
{
    int i = n - 1;

    for (; i > 0 && top[i - 1] < value; i--)
        top[i] = top[i - 1];
    top[i] = value;
    return top[n - 1];
}

/* Sets TOP to the N largest values of channel CHANNEL of RGB, in falling order.
 * RGB has PIXELS pixels. */
static void find_largest_values(const float *rgb, size_t pixels, int channel,
                                float *top, int n)
{
    float least = 0;

    memset(top, 0, (size_t)n * sizeof *top);
    for (size_t i = 0; i < pixels; i++)
        if (rgb[3 * i + (size_t)channel] > least)
            least = insert_into_largest_values(top, n,
                                               rgb[3 * i + (size_t)channel]);
}

/* Returns N / PARTS, the number of the brightest pixels to average, clamped to
 * 1 .. TOP_MAX. */
static int count_brightest_pixels(size_t n, int parts)
{
    return (int)fmin(fmax(floor((double)n / parts), 1), TOP_MAX);
}

/* Returns the mean of channel CHANNEL over the brightest 1/1000 of N pixels. */
static double compute_peak_light(const float *rgb, size_t n, int channel)
{
    float top[TOP_MAX];
    const int n_top = count_brightest_pixels(n, 1000);
    double sum = 0;

    find_largest_values(rgb, n, channel, top, n_top);
    for (int i = 0; i < n_top; i++)
        sum += (double)top[i];
    return sum / n_top;
}

void glint_response_around(const float *rgb, size_t n,
                           struct glint_response_light *light)
{
    for (int c = 0; c < 3; c++) {
        double sum = 0;

        for (size_t i = 0; i < n; i++)
            sum += (double)rgb[3 * i + (size_t)c];
        light->mean[c] = fmax(sum / (double)n, 0);
        light->peak[c] = compute_peak_light(rgb, n, c);
    }
}

/* ----------------------------------------------------------------- drawing */

static struct glint_view make_small_view(struct glint_view view, int pixels)
{
    const double by = sqrt(pixels / ((double)view.width * view.height));

    view.width = (int)fmax(8, rint(view.width * by));
    view.height = (int)fmax(8, rint(view.height * by));
    return view;
}

/* A small frame with the field of view of another frame, and its picture.
 * close_small_frame() must be called even if opening fails. */
struct proxy {
    struct glint_view view;
    struct glint_frame frame;
    int32_t *linear_q20;
    float *rgb;
};

/* Opens a small frame of about PIXELS pixels. It has all settings of LIKE that
 * affect brightness. BYTES: memory for drawing; 0: no limit. */
static enum glint_status open_small_frame(const struct glint_frame *like,
                                          int pixels, size_t bytes,
                                          struct proxy *p)
{
    size_t samples;

    *p = (struct proxy){.view = make_small_view(like->view, pixels)};
    glint_frame_init_like(&p->frame, like, p->view);
    p->frame.only_ghost = -1;
    p->frame.picture.uniform = false;
    p->frame.dials.fineness = like->lens ? GRID : EXACT_GRID;
    p->frame.picture.for_codes = true;
    samples = 3 * (size_t)p->view.width * (size_t)p->view.height;
    p->rgb = malloc(samples * sizeof *p->rgb);
    p->linear_q20 = malloc(samples * sizeof *p->linear_q20);
    if (!p->rgb || !p->linear_q20)
        return GLINT_E_MEMORY;
    return bytes ? glint_frame_reserve_memory(&p->frame, NULL, bytes, 1,
                                              GLINT_AREA_SAMPLES)
                 : GLINT_OK;
}

static void close_small_frame(struct proxy *p)
{
    glint_frame_finish(&p->frame);
    free(p->linear_q20);
    free(p->rgb);
}

/* Draws N LAMPS with powers times 2^BY, and sets LIGHT to the measured light of
 * lamps with powers times 1. */
static enum glint_status
draw_and_measure_lamps(struct proxy *p, const struct glint_lamp *lamps, int n,
                       double by, struct glint_response_light *light)
{
    const size_t pixels = (size_t)p->view.width * (size_t)p->view.height;
    struct glint_image layer = glint_image_over(p->linear_q20, GLINT_LINEAR_Q20,
                                                p->view.width, p->view.height);
    const double unit = exp2(-20 - by);
    struct glint_engine_report report;
    enum glint_status status;

    memset(p->linear_q20, 0, 3 * pixels * sizeof *p->linear_q20);
    status = glint_frame_draw(&p->frame, lamps, n, exp2(by), &layer, &report);
    for (size_t i = 0; i < 3 * pixels; i++)
        p->rgb[i] = (float)(p->linear_q20[i] * unit);
    glint_response_around(p->rgb, pixels, light);
    return status;
}

/* Draws N LAMPS and measures their LIGHT. Repeats this with other scales, at
 * most 12 times in total, until the brightest pixels lie in the range of
 * AIM_LOG2 and AIM_SPAN. *PEAK_LOG2 is log2 of the light of the brightest
 * pixels at scale 1: on entry an estimate, on return the measured value. */
static enum glint_status
draw_at_measurable_scale(struct proxy *p, const struct glint_lamp *lamps, int n,
                         double *peak_log2, struct glint_response_light *light)
{
    enum glint_status status = GLINT_OK;

    for (int i = 0; i < 12 && status == GLINT_OK; i++) {
        const double by = AIM_LOG2 - *peak_log2;

        status = draw_and_measure_lamps(p, lamps, n, by, light);
        const double peak = glint_largest_channel(light->peak);
        *peak_log2 = peak > 0 ? log2(peak) : *peak_log2 - 2 * AIM_SPAN;
        if (fabs(*peak_log2 + by - AIM_LOG2) <= AIM_SPAN)
            break;
    }
    return status;
}

/* --------------------------------------------------------------- measuring */

static double compute_corner_angle_deg(struct glint_view view, double focal_mm)
{
    const double half =
        0.5 * view.sensor_width_mm * hypot(1, (double)view.height / view.width);

    return atan(half / fabs(focal_mm)) * 180 / GLINT_PI;
}

/* Sets the N angles to measure, degrees, from 0 to CORNER. They are denser near
 * the axis, where ghosts overlap. Angles above END, the max angle of the model,
 * are omitted. */
static void set_measured_angles(struct glint_response *r, int n, double corner,
                                double end)
{
    r->n = 0;
    for (int i = 0; i < n; i++) {
        const double theta = corner * pow(i / (n - 1.0), 1.5);

        if (theta > end && r->n > 0)
            break;
        r->theta_deg[r->n++] = theta;
    }
}

static double compute_clamped_log2(double value)
{
    return value > 0 ? fmax(log2(value), none_log2) : none_log2;
}

static void convert_light_to_log2(struct glint_response_light *light)
{
    for (int c = 0; c < 3; c++) {
        light->peak[c] = compute_clamped_log2(light->peak[c]);
        light->mean[c] = compute_clamped_log2(light->mean[c]);
    }
}

bool glint_response_has_extent(const struct glint_response *response,
                               double extent)
{
    for (int i = 1; i < GLINT_RESPONSE_EXTENTS; i++)
        if (response->extent[i] <= 0)
            return extent <= response->extent[i - 1];
    return true;
}

/* Measures (peak of the flare if LAMP is a disc) / (peak if LAMP is a point),
 * at most 1, for discs with RMS radii up to an eighth of the picture's
 * diagonal, or up to EXTENT if this is less. */
static enum glint_status measure_extent_softening(struct proxy *p,
                                                  struct glint_response *r,
                                                  struct glint_lamp lamp,
                                                  double extent)
{
    const double diagonal =
        2 *
        tan(compute_corner_angle_deg(p->view, p->frame.setup->optics.focal_mm) *
            GLINT_PI / 180);
    double point_log2 = 0, peak_log2 = 0;

    for (int i = 0; i < GLINT_RESPONSE_EXTENTS; i++)
        r->extent[i] = r->softened_log2[i] = 0;
    for (int i = 0; i < GLINT_RESPONSE_EXTENTS &&
                    (i == 0 || !glint_response_has_extent(r, extent));
         i++) {
        struct glint_response_light light;
        enum glint_status status;

        r->extent[i] =
            i ? diagonal / (1 << (GLINT_RESPONSE_EXTENTS + 2 - i)) : 0;
        glint_area_set_round(&lamp, r->extent[i]);
        status = draw_at_measurable_scale(p, &lamp, 1, &peak_log2, &light);
        if (status != GLINT_OK)
            return status;
        if (i == 0)
            point_log2 = peak_log2;
        r->softened_log2[i] = fmin(peak_log2 - point_log2, 0);
    }
    return GLINT_OK;
}

static enum glint_status measure_light_at_angles(struct proxy *p, double extent,
                                                 struct glint_response *r)
{
    const double azimuth = /* azimuth of a corner of the picture, degrees */
        atan2(p->view.height, p->view.width) * 180 / GLINT_PI;
    const double all = (double)p->view.width * p->view.height;
    struct glint_lamp lamp = {
        .phi_deg = azimuth, .power = all, .rgb = {1, 1, 1}};
    double peak_log2 = 0;

    set_measured_angles(
        r, p->frame.lens ? GLINT_RESPONSE_ANGLES : EXACT_ANGLES,
        compute_corner_angle_deg(p->view, p->frame.setup->optics.focal_mm),
        glint_frame_get_max_angle_deg(&p->frame));
    for (int i = 0; i < r->n; i++) {
        enum glint_status status;

        lamp.theta_deg = r->theta_deg[i];
        status =
            draw_at_measurable_scale(p, &lamp, 1, &peak_log2, &r->log2_of[i]);
        if (status != GLINT_OK)
            return status;
        convert_light_to_log2(&r->log2_of[i]);
    }
    lamp.theta_deg = r->theta_deg[r->n / 2];
    return measure_extent_softening(p, r, lamp, extent);
}

enum glint_status glint_response_measure(const struct glint_frame *like,
                                         size_t bytes, double extent,
                                         struct glint_response *response)
{
    const double start = like->clock ? like->clock() : 0;
    struct proxy proxy;
    enum glint_status status =
        open_small_frame(like, GLINT_RESPONSE_COARSE, bytes, &proxy);

    if (status == GLINT_OK)
        status = measure_light_at_angles(&proxy, extent, response);
    response->ms = like->clock ? 1e3 * (like->clock() - start) : 0;
    close_small_frame(&proxy);
    return status;
}

static double interpolate_and_exp2(double a, double b, double part)
{
    return exp2(a + part * (b - a));
}

void glint_response_interpolate_light(const struct glint_response *r,
                                      double theta_deg,
                                      struct glint_response_light *light)
{
    const double *const theta = r->theta_deg;
    int i = 0;
    double part = 0;

    while (i + 2 < r->n && theta[i + 1] < theta_deg)
        i++;
    if (r->n > 1)
        part = (theta_deg - theta[i]) / (theta[i + 1] - theta[i]);
    part = fmin(fmax(part, 0), 1);
    for (int c = 0; c < 3; c++) {
        const int j = r->n > 1 ? i + 1 : i;

        light->peak[c] = interpolate_and_exp2(r->log2_of[i].peak[c],
                                              r->log2_of[j].peak[c], part);
        light->mean[c] = interpolate_and_exp2(r->log2_of[i].mean[c],
                                              r->log2_of[j].mean[c], part);
    }
}

double glint_response_compute_softening(const struct glint_response *r,
                                        const struct glint_lamp *lamp)
{
    const double extent = hypot(lamp->axis[0], lamp->axis[1]);
    int i = 0;
    double part;

    while (i + 2 < GLINT_RESPONSE_EXTENTS && r->extent[i + 1] < extent &&
           r->extent[i + 2] > r->extent[i + 1])
        i++;
    if (!(r->extent[i + 1] > r->extent[i]))
        return 1; /* nothing was measured */
    part = (extent - r->extent[i]) / (r->extent[i + 1] - r->extent[i]);
    return interpolate_and_exp2(r->softened_log2[i], r->softened_log2[i + 1],
                                fmin(part, 1));
}

/* ------------------------------------------------------------ drawn flares */

/* Sets the peak of LIGHT to the light that the brightest 1/10000 of the pixels
 * of the last drawing reach. */
static void set_peak_from_brightest_pixels(const struct proxy *p,
                                           struct glint_response_light *light)
{
    const size_t pixels = (size_t)p->view.width * (size_t)p->view.height;
    const int n = count_brightest_pixels(pixels, 10000);
    float top[TOP_MAX];

    for (int c = 0; c < 3; c++) {
        find_largest_values(p->rgb, pixels, c, top, n);
        light->peak[c] = (double)top[n - 1];
    }
}

/* Reports the progress of FRAME while exact rays find the ghosts of its small
 * picture. FRAME has the same ghosts. */
static void report_ghost_search_progress(void *frame, double done)
{
    const struct glint_frame *const f = frame;

    if (done <= GLINT_FRAME_FOUND)
        f->progress(f->progress_ctx, done);
}

enum glint_status glint_response_draw_and_measure(
    struct glint_frame *frame, const struct glint_lamp *lamps, int n,
    int pixels, const struct glint_ground *ground,
    struct glint_response_light *light, struct glint_seen *seen)
{
    struct glint_lamp *small = malloc((size_t)(n ? n : 1) * sizeof *small);
    struct proxy p;
    enum glint_status status = GLINT_OK;
    double by, peak_log2 = glint_frame_is_draft(frame) ? DRAFT_PEAK_LOG2 : 0;

    *light = (struct glint_response_light){{0}, {0}};
    if (!small)
        return GLINT_E_MEMORY;
    if (n) {
        status = open_small_frame(frame, pixels, 0, &p);
        by = (double)p.view.width * p.view.height /
             ((double)frame->view.width * frame->view.height);
        memcpy(small, lamps, (size_t)n * sizeof *small);
        for (int i = 0; i < n; i++)
            small[i].power *= by;
        if (frame->trace)
            frame->trace->adopt(&p.frame, frame);
        p.frame.progress =
            frame->progress ? report_ghost_search_progress : NULL;
        p.frame.progress_ctx = frame;
        if (status == GLINT_OK)
            status = draw_at_measurable_scale(&p, small, n, &peak_log2, light);
        if (status == GLINT_OK)
            set_peak_from_brightest_pixels(&p, light);
        if (status == GLINT_OK && ground && seen)
            glint_seen_measure_visibility(seen, ground, p.rgb, p.view.width,
                                          p.view.height);
        if (frame->trace)
            frame->trace->adopt(frame, &p.frame);
        close_small_frame(&p);
    }
    free(small);
    return status;
}
