/* SPDX-License-Identifier: MIT */
#include "zooms/zoom_error.h"

#include <math.h>
#include <stdlib.h>

#include "engine/frame/frame.h"
#include "engine/measure.h"
#include "glint/glint.h"

/* Pictures are so many pixels wide: a fourth of 1080p's, whose outlines are as
 * far off in shares of the picture. */
enum { WIDE = 480, MOST_HIGH = 480 };

/* Lights come from angles up to this times the half diagonal of what the lens
 * sees. */
#define BEYOND 1.5

/* A degree about the axis at which light falls in no symmetry of the film. */
#define AZIMUTH_DEG 33

/* Pictures of one light: all as the zoom has it, and one ghost of that and of
 * exact rays. */
struct pictures {
    struct glint_frame model, exact;
    struct glint_float_image all, mixed, traced;
    double exposure;
};

/* Returns the mean squared error if the ghost alone was mixed. */
static double error_of(const struct pictures *p)
{
    const size_t n = 3 * (size_t)p->all.width * (size_t)p->all.height;
    double sum = 0;

    for (size_t i = 0; i < n; i++) {
        const double mixed = (double)p->mixed.rgb[i];
        const double traced = (double)p->traced.rgb[i];
        const double rest = fmax(0, (double)p->all.rgb[i] - mixed);
        double off;

        if (mixed <= 0 && traced <= 0)
            continue;
        off = (glint_measure_code(p->exposure * (rest + mixed)) -
               glint_measure_code(p->exposure * (rest + traced))) /
              255;
        sum += off * off;
    }
    return sum / (double)n;
}

static enum glint_status draw(struct glint_frame *frame,
                              const struct glint_lamp *lamp, int ghost,
                              struct glint_float_image *image)
{
    struct glint_frame_report report;

    frame->only_ghost = ghost;
    return glint_frame_draw_alone(frame, lamp, 1, 1, image->rgb, &report);
}

/* What all angles share. Each is a job of its own, as frames are too small to
 * be shared out. */
struct measuring {
    const struct glint_setup *setup;
    const struct glint_zoom_lens *zoom;
    struct glint_view view;
    double max_deg, shift;
    int n;
    struct zoom_error *error;
    enum glint_status status[ZOOM_ANGLES];
};

/* Sets entry ANGLE of the errors. */
static enum glint_status measure_angle(const struct measuring *m,
                                       struct pictures *p, int angle)
{
    const struct glint_lamp lamp = {
        .theta_deg = m->max_deg * (angle + m->shift) / ZOOM_ANGLES,
        .phi_deg = AZIMUTH_DEG,
        .power = 1,
        .rgb = {1, 1, 1}};
    enum glint_status status = draw(&p->model, &lamp, -1, &p->all);

    p->exposure = glint_measure_exposure(&p->all);
    for (int g = 0; g < m->n && status == GLINT_OK; g++) {
        if (m->error[g].of[angle] >= 0)
            continue;
        status = draw(&p->model, &lamp, g, &p->mixed);
        if (status == GLINT_OK)
            status = draw(&p->exact, &lamp, g, &p->traced);
        m->error[g].of[angle] = error_of(p);
    }
    return status;
}

/* Returns the largest angle of a light, up to MAX_DEG, of which a picture of
 * LENS is asked. */
static double most_deg(const struct glint_prescription *lens, double max_deg)
{
    const double corner_mm =
        0.5 * hypot(lens->film_width_mm, lens->film_height_mm);
    struct glint_optics optics;

    glint_optics_of(lens, &optics);
    return fmin(max_deg, BEYOND * 180 / GLINT_PI *
                             atan(corner_mm / fabs(optics.focal_mm)));
}

static bool take_image(struct glint_float_image *image,
                       const struct glint_view *view)
{
    image->width = view->width;
    image->height = view->height;
    image->rgb =
        calloc(3 * (size_t)view->width * (size_t)view->height, sizeof(float));
    return image->rgb != NULL;
}

static void angle_job(void *ctx, int angle, int worker)
{
    struct measuring *const m = ctx;
    struct pictures p = {.exposure = 1};

    (void)worker;
    glint_frame_init(&p.model, m->setup, m->view, NULL);
    p.model.lens = &m->zoom->lens;
    glint_frame_init(&p.exact, m->setup, m->view, NULL);
    p.exact.trace = &glint_frame_traces;
    m->status[angle] = take_image(&p.all, &m->view) &&
                               take_image(&p.mixed, &m->view) &&
                               take_image(&p.traced, &m->view)
                           ? measure_angle(m, &p, angle)
                           : GLINT_E_MEMORY;
    glint_frame_finish(&p.model);
    glint_frame_finish(&p.exact);
    free(p.all.rgb);
    free(p.mixed.rgb);
    free(p.traced.rgb);
}

enum glint_status zoom_error_measure(const struct tool *tool,
                                     const struct glint_prescription *lens,
                                     const struct glint_zoom_lens *zoom,
                                     double max_deg, double shift, int n,
                                     struct zoom_error *error,
                                     struct glint_error *message)
{
    static const double rgb_nm[] = {650, 532, 450};
    const double high = ceil(WIDE * lens->film_height_mm / lens->film_width_mm);
    struct glint_setup *const setup = malloc(sizeof *setup);
    struct measuring m = {
        .setup = setup,
        .zoom = zoom,
        .view = glint_view_fit(WIDE, (int)fmin(fmax(high, 8), MOST_HIGH),
                               lens->film_width_mm, lens->film_height_mm),
        .max_deg = most_deg(lens, max_deg),
        .shift = shift,
        .n = n,
        .error = error};
    enum glint_status status = GLINT_E_MEMORY;

    if (setup)
        status = glint_setup_init(setup, lens, 0, 0, rgb_nm, 3, message);
    if (status == GLINT_OK)
        glint_workers_run(tool->workers, ZOOM_ANGLES, angle_job, &m);
    for (int k = 0; k < ZOOM_ANGLES && status == GLINT_OK; k++)
        status = m.status[k];
    free(setup);
    return status;
}
