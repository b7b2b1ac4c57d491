/* SPDX-License-Identifier: MIT */
#include "model/picture_check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/exact.h"
#include "glint/measure.h"

/* Max size of the images, pixels. The width is a quarter of that of 1080p. */
enum { WIDE = 480, MOST_HIGH = 480 };

/* azimuth of lights, degrees; not on a symmetry axis of the film */
#define AZIMUTH_DEG 33

/* Angles of lights near the axis, degrees, at which ghosts have caustics. STEPS
 * more lights are evenly spaced up to the corner. */
static const double near_deg[] = {0, 0.3, 2, 5};
enum { NEAR = sizeof near_deg / sizeof *near_deg, STEPS = 6 };

/* the constants of a linear congruential generator (Knuth, TAOCP 3.3.4) */
enum { SEED = 46 };
#define MULTIPLIER UINT64_C(6364136223846793005)
#define INCREMENT  UINT64_C(1442695040888963407)

enum glint_status picture_pair_open(struct picture_pair *pair,
                                    const struct glint_setup *setup,
                                    const struct glint_lens *model,
                                    const struct glint_view *view,
                                    struct glint_error *error)
{
    struct glint_engine_config cfg;
    enum glint_status status;

    *pair = (struct picture_pair){NULL, NULL};
    glint_engine_defaults(&cfg, view->width, view->height);
    cfg.camera.setup = setup;
    cfg.camera.sensor_width_mm = view->sensor_width_mm;
    /* Twice the height of the image: then the width determines the scale. */
    cfg.camera.sensor_height_mm =
        2 * view->sensor_width_mm * view->height / view->width;
    cfg.light.by_hand = 1;
    cfg.search.max_found = 0;
    cfg.drawing.is_fresh = 1;
    cfg.model = model;
    status = glint_engine_create(&pair->model, &cfg, error);
    cfg.model = NULL;
    cfg.camera.rays = &glint_frame_traces;
    return status == GLINT_OK ? glint_engine_create(&pair->exact, &cfg, error)
                              : status;
}

void picture_pair_close(struct picture_pair *pair)
{
    glint_engine_destroy(pair->model);
    glint_engine_destroy(pair->exact);
}

/* A light, and the result of the comparison of its images */
struct light {
    double angle_deg, azimuth_deg;
    bool is_black; /* whether no light reaches either image */
    struct glint_measure measure;
    struct glint_error error;
    enum glint_status status;
};

struct job {
    const struct glint_setup *setup;
    const struct glint_lens *model;
    struct glint_view view;
    struct light light[PICTURE_CHECK_LIGHTS];
    int n;
    int first; /* index of the first light that is being compared */
};

static enum glint_status
render_model_and_exact_pictures(const struct picture_pair *pair,
                                const struct light *light,
                                struct glint_float_image image[2])
{
    const struct glint_lamp lamp = {.theta_deg = light->angle_deg,
                                    .phi_deg = light->azimuth_deg,
                                    .power = 1,
                                    .rgb = {1, 1, 1}};
    struct glint_engine_report report;
    enum glint_status status = GLINT_OK;

    for (int k = 0; k < 2 && status == GLINT_OK; k++)
        status =
            glint_engine_render(k ? pair->model : pair->exact, &lamp, 1, 1,
                                GLINT_ENGINE_GHOSTS, image[k].rgb, &report);
    return status;
}

static bool is_image_black(const struct glint_float_image *image)
{
    const size_t n = 3 * (size_t)image->width * (size_t)image->height;
    size_t i = 0;

    while (i < n && !(image->rgb[i] > 0))
        i++;
    return i == n;
}

static void compare_pictures_of_light(void *ctx, int i, int worker)
{
    struct job *const job = ctx;
    struct light *const light = &job->light[job->first + i];
    const int width = job->view.width, height = job->view.height;
    const size_t samples = 3 * (size_t)width * (size_t)height;
    struct glint_float_image image[2] = {{width, height, NULL},
                                         {width, height, NULL}};
    struct picture_pair pair = {NULL, NULL};

    (void)worker;
    for (int k = 0; k < 2; k++)
        image[k].rgb = calloc(samples, sizeof(float));
    light->status = GLINT_E_MEMORY;
    if (image[0].rgb && image[1].rgb)
        light->status = picture_pair_open(&pair, job->setup, job->model,
                                          &job->view, &light->error);
    if (light->status == GLINT_OK)
        light->status = render_model_and_exact_pictures(&pair, light, image);
    if (light->status == GLINT_OK &&
        !glint_measure_compare(&image[0], &image[1], false, &light->measure))
        light->status = GLINT_E_MEMORY;
    if (light->status == GLINT_OK)
        light->is_black =
            is_image_black(&image[0]) && is_image_black(&image[1]);
    picture_pair_close(&pair);
    free(image[0].rgb);
    free(image[1].rgb);
}

/* Compares the pictures of all lights, as many at a time as there are workers,
 * and shows the progress. */
static void compare_all_lights(const struct tool *tool, struct job *job)
{
    const int workers = glint_workers_count(tool->workers);
    struct tool_progress progress;

    tool_progress_start(&progress, tool, "check");
    for (; job->first < job->n; job->first += workers) {
        const int left = job->n - job->first;

        glint_workers_run(tool->workers, left < workers ? left : workers,
                          compare_pictures_of_light, job);
        tool_progress_show(&progress,
                           fmin(job->first + workers, job->n) / job->n);
    }
    tool_progress_end(&progress);
}

static void add_test_light(struct job *job, double angle_deg,
                           double azimuth_deg)
{
    job->light[job->n].angle_deg = angle_deg;
    job->light[job->n++].azimuth_deg = azimuth_deg;
}

/* Lists the lights of picture_check_run(), up to the angle MOST, degrees. */
static void list_test_lights(struct job *job, double most)
{
    for (int i = 0; i < NEAR; i++)
        if (near_deg[i] < most)
            add_test_light(job, near_deg[i], AZIMUTH_DEG);
    for (int i = 1; i <= STEPS; i++)
        add_test_light(job, most * i / STEPS, AZIMUTH_DEG);
}

/* Returns the next random number of STATE, 0 .. 1. */
static double compute_random_fraction(uint64_t *state)
{
    *state = *state * MULTIPLIER + INCREMENT;
    return (double)(*state >> 32) / 0x1p32;
}

/* Lists N random lights up to the angle MOST, degrees. */
static void list_random_lights(struct job *job, int n, double most)
{
    uint64_t state = SEED;

    for (int i = 0; i < n; i++) {
        const double angle_deg = most * compute_random_fraction(&state);

        add_test_light(job, angle_deg, 360 * compute_random_fraction(&state));
    }
}

static enum glint_status find_failed_light(const struct job *job,
                                           struct glint_error *error)
{
    for (int i = 0; i < job->n; i++)
        if (job->light[i].status != GLINT_OK) {
            *error = job->light[i].error;
            return job->light[i].status;
        }
    return GLINT_OK;
}

static void find_light_with_lowest_psnr(const struct job *job,
                                        struct picture_check *check)
{
    *check = (struct picture_check){.psnr_db = PICTURE_IDENTICAL_DB};
    for (int i = 0; i < job->n; i++) {
        const struct light *const light = &job->light[i];

        if (light->is_black)
            continue;
        if (check->n++ == 0 || light->measure.psnr_db < check->psnr_db) {
            check->psnr_db = light->measure.psnr_db;
            check->angle_deg = light->angle_deg;
        }
    }
    check->psnr_db = fmax(0, floor(ldexp(check->psnr_db, 8)) / 256);
    check->angle_deg = rint(ldexp(check->angle_deg, 8)) / 256;
}

/* Compares the pictures of N random lights, or, if N is 0, of those of
 * picture_check_run(), and leaves the results in JOB. */
static enum glint_status compare_lights(const struct tool *tool,
                                        const struct glint_prescription *lens,
                                        const struct glint_lens *model,
                                        const struct glint_bake_options *baked,
                                        int n, struct job *job,
                                        struct glint_error *error)
{
    const double *const band = baked->band_nm, span = band[1] - band[0];
    /* about 620, 540 and 460 nm for the default wavelength range */
    const double wave_nm[] = {band[0] + 0.73 * span, band[0] + 0.47 * span,
                              band[0] + 0.2 * span};
    const double diagonal_mm = hypot(lens->film_width_mm, lens->film_height_mm);
    /* fraction of the film for which the model was baked */
    const double part =
        baked->field_mm > 0 ? fmin(1, 2 * baked->field_mm / diagonal_mm) : 1;
    const double high = ceil(WIDE * lens->film_height_mm / lens->film_width_mm);
    struct glint_setup *const setup = malloc(sizeof *setup);
    enum glint_status status = GLINT_E_MEMORY;
    struct glint_optics optics;
    double most_deg;

    *job = (struct job){
        .setup = setup,
        .model = model,
        .view = glint_view_fit(WIDE, (int)fmin(fmax(high, 8), MOST_HIGH),
                               part * lens->film_width_mm,
                               part * lens->film_height_mm)};
    glint_optics_of(lens, &optics);
    most_deg =
        fmin(baked->max_deg,
             180 / GLINT_PI * atan(0.5 * part * diagonal_mm / optics.focal_mm));
    if (n)
        list_random_lights(job, n, most_deg);
    else
        list_test_lights(job, most_deg);
    if (setup)
        status = glint_setup_init(setup, lens, 0, 0, wave_nm,
                                  sizeof wave_nm / sizeof *wave_nm, error);
    if (status == GLINT_OK) {
        compare_all_lights(tool, job);
        status = find_failed_light(job, error);
    }
    free(setup);
    return status;
}

enum glint_status picture_check_run(const struct tool *tool,
                                    const struct glint_prescription *lens,
                                    const struct glint_lens *model,
                                    const struct glint_bake_options *baked,
                                    struct picture_check *check,
                                    struct glint_error *error)
{
    struct job job;
    const enum glint_status status =
        compare_lights(tool, lens, model, baked, 0, &job, error);

    if (status == GLINT_OK)
        find_light_with_lowest_psnr(&job, check);
    return status;
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

enum glint_status picture_check_run_random(
    const struct tool *tool, const struct glint_prescription *lens,
    const struct glint_lens *model, const struct glint_bake_options *baked,
    int *n, double *psnr_db, struct glint_error *error)
{
    struct job job;
    const enum glint_status status =
        compare_lights(tool, lens, model, baked, *n, &job, error);

    *n = 0;
    for (int i = 0; i < job.n; i++)
        if (!job.light[i].is_black)
            psnr_db[(*n)++] = job.light[i].measure.psnr_db;
    qsort(psnr_db, (size_t)*n, sizeof *psnr_db, compare_numbers);
    return status;
}

enum glint_status picture_check_store(const struct picture_check *check,
                                      const struct coating *coating,
                                      unsigned char **data, size_t *bytes)
{
    struct glint_model_note note = {.magic = GLINT_MODEL_NOTE_MAGIC};

    snprintf(note.coating, sizeof note.coating, "%s",
             coating_get_text(coating));
    if (check) {
        note.n = (uint32_t)check->n;
        note.psnr_q8 = (uint32_t)ldexp(check->psnr_db, 8);
        note.angle_q8 = (uint32_t)ldexp(check->angle_deg, 8);
    }
    return glint_bake_add_note(&note, data, bytes);
}
