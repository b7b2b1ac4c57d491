/* SPDX-License-Identifier: MIT */
#include "support/stage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/kernels.h"
#include "model/model_cache.h"
#include "options/tool.h"

static bool print_error_and_fail(const char *why)
{
    fprintf(stderr, "stage: %s\n", why);
    return false;
}

bool stage_load_lens(struct stage *stage, const char *name)
{
    char path[300], text[65537];
    FILE *file;
    size_t bytes;

    snprintf(path, sizeof path, "lenses/%s.lens", name);
    file = fopen(path, "rb");
    if (!file)
        return print_error_and_fail(path);
    bytes = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[bytes] = 0;
    return stage_parse_lens(stage, text);
}

bool stage_parse_lens(struct stage *stage, const char *text)
{
    struct glint_error error;

    return glint_prescription_parse(&stage->lens, text, strlen(text), "stage",
                                    &error) == GLINT_OK ||
           print_error_and_fail(error.text);
}

/* wavelengths of the red, green and blue channel */
static const double nm[3] = {650, 532, 450};

bool stage_set_up_lens(struct stage *stage, int n_blades)
{
    struct glint_error error = {"no setup"};

    return glint_setup_init(&stage->setup, &stage->lens, n_blades, 0, nm, 3,
                            &error) == GLINT_OK ||
           print_error_and_fail(error.text);
}

/* Sets stage->of_model, the lens data for drawing frames, from the baked
 * model. */
static bool set_lens_of_model(struct stage *stage)
{
    const struct glint_setup *s = &stage->setup;
    struct glint_error error;

    return glint_setup_from_model(&stage->of_model, &stage->file.lens,
                                  s->n_blades, s->blade_rotation_deg,
                                  s->wavelength_nm, s->n_wavelengths,
                                  &error) == GLINT_OK ||
           print_error_and_fail(error.text);
}

static struct glint_bake_options
make_bake_options(struct stage *stage, double tolerance, double max_deg)
{
    struct glint_bake_options options;

    glint_bake_defaults(&options);
    options.tolerance = tolerance;
    options.max_deg = max_deg;
    options.workers = stage->workers;
    model_file_close(&stage->file);
    return options;
}

bool stage_bake_model(struct stage *stage, double tolerance, double max_deg)
{
    const struct glint_bake_options options =
        make_bake_options(stage, tolerance, max_deg);
    struct glint_error error = {"no memory"};
    const char *reason = "";
    unsigned char *data;

    if (glint_bake(&stage->lens, &options, &data, &stage->file.bytes,
                   &stage->report, &error) != GLINT_OK)
        return print_error_and_fail(error.text);
    stage->file.data = data;
    if (glint_lens_open(&stage->file.lens, data, stage->file.bytes, &reason) !=
        GLINT_OK)
        return print_error_and_fail(reason);
    return set_lens_of_model(stage);
}

bool stage_bake_or_load_model(struct stage *stage, double tolerance,
                              double max_deg)
{
    const struct tool tool = {.name = "stage",
                              .quiet = true,
                              .n_threads = 1,
                              .workers = stage->workers};
    const struct coating coating = {.kind = COATING_TABLE};

    return model_open_cached(&tool, &stage->lens, stage->lens.name,
                             make_bake_options(stage, tolerance, max_deg),
                             &coating, &stage->file) == EXIT_OK &&
           set_lens_of_model(stage);
}

void stage_set_view(struct stage *stage, int width, int height,
                    double sensor_mm)
{
    if (stage->framed)
        glint_frame_finish(&stage->frame);
    stage->view = sensor_mm > 0
                      ? (struct glint_view){.width = width,
                                            .height = height,
                                            .sensor_width_mm = sensor_mm}
                      : glint_view_fit(width, height, stage->lens.film_width_mm,
                                       stage->lens.film_height_mm);
    glint_frame_init(&stage->frame,
                     stage->file.data ? &stage->of_model : &stage->setup,
                     stage->view, stage->workers);
    stage->frame.lens = stage->file.data ? &stage->file.lens : NULL;
    stage->frame.trace = &glint_frame_traces;
    stage->frame.dials.irradiance_steps = 69;
    stage->frame.cfg.sets = glint_sets_here();
    stage->framed = true;
}

bool stage_stop_down(struct stage *stage, double f_number)
{
    const struct glint_view view = stage->view;
    struct glint_error error = {"no view"};

    if (glint_prescription_set_f_number(&stage->lens, f_number, &error) !=
            GLINT_OK ||
        !stage_set_up_lens(stage, stage->setup.n_blades) ||
        !set_lens_of_model(stage) ||
        glint_setup_stop_down(&stage->of_model, &stage->file.lens, f_number,
                              &error) != GLINT_OK)
        return print_error_and_fail(error.text);
    stage_set_view(stage, view.width, view.height, view.sensor_width_mm);
    return true;
}

bool stage_open_lens(struct stage *stage, const char *name, int width,
                     int height)
{
    if (!stage_load_lens(stage, name) || !stage_set_up_lens(stage, 8) ||
        !stage_bake_or_load_model(stage, 1, 60))
        return false;
    stage_set_view(stage, width, height, 0);
    return true;
}

bool stage_open_model_file(struct stage *stage, const char *path, int width,
                           int height)
{
    static const struct tool tool = {.name = "tests", .n_threads = 1};
    const struct glint_model_header *header;
    struct glint_error error = {"no setup"};

    if (tool_open_model(&tool, path, &stage->file) != EXIT_OK)
        return false;
    header = stage->file.lens.header;
    if (glint_setup_from_model(&stage->of_model, &stage->file.lens, 8, 0, nm, 3,
                               &error) != GLINT_OK)
        return print_error_and_fail(error.text);
    stage->lens.film_width_mm = glint_real_value(header->film_width_mm);
    stage->lens.film_height_mm = glint_real_value(header->film_height_mm);
    stage_set_view(stage, width, height, 0);
    return true;
}

bool stage_draw_linear(struct stage *stage, const struct glint_lamp *lamps,
                       int n, float *rgb)
{
    return glint_frame_draw_flare_alone(&stage->frame, lamps, n, 1, rgb,
                                        &stage->drawn) == GLINT_OK ||
           print_error_and_fail("no picture in linear light");
}

bool stage_draw_exact(struct stage *stage, const struct glint_lamp *lamps,
                      int n, int grid, float *rgb)
{
    const size_t count =
        3 * (size_t)stage->view.width * (size_t)stage->view.height;
    const struct glint_exact_config cfg = {.setup = &stage->setup,
                                           .view = stage->view,
                                           .lamps = lamps,
                                           .n_lamps = n,
                                           .grid = grid,
                                           .only_ghost = -1,
                                           .workers = stage->workers};
    double *exact = malloc(count * sizeof *exact);
    bool ok;

    ok = exact && glint_exact_render(&cfg, exact) == GLINT_OK;
    for (size_t i = 0; ok && i < count; i++)
        rgb[i] = (float)exact[i];
    free(exact);
    return ok || print_error_and_fail("no exact picture");
}

bool stage_draw_codes(struct stage *stage, const struct glint_lamp *lamps,
                      int n, uint8_t *codes)
{
    struct glint_image image = glint_image_over(
        codes, GLINT_RGB24, stage->view.width, stage->view.height);

    return glint_frame_draw(&stage->frame, lamps, n, 1, &image,
                            &stage->drawn) == GLINT_OK ||
           print_error_and_fail("no picture in codes");
}

struct glint_measure stage_compare_images(const struct stage *stage,
                                          const float *reference,
                                          const float *test)
{
    const int w = stage->view.width, h = stage->view.height;
    struct glint_measure m = {0};
    float *copies = malloc(6 * sizeof(float) * (size_t)w * (size_t)h);
    const size_t n = 3 * (size_t)w * (size_t)h;

    if (!copies)
        return m;
    memcpy(copies, reference, n * sizeof(float));
    memcpy(copies + n, test, n * sizeof(float));
    if (!glint_measure_compare(&(struct glint_float_image){w, h, copies},
                               &(struct glint_float_image){w, h, copies + n},
                               false, &m))
        print_error_and_fail("no memory to compare");
    free(copies);
    return m;
}

double stage_find_exposed_power(struct stage *stage,
                                const struct glint_lamp *lamp)
{
    const int w = stage->view.width, h = stage->view.height;
    struct glint_lamp one = *lamp;
    struct glint_float_image image = {
        w, h, malloc(3 * sizeof(float) * (size_t)w * (size_t)h)};
    double power = 1;

    one.power = 1;
    if (image.rgb && stage_draw_linear(stage, &one, 1, image.rgb))
        power = glint_measure_exposure(&image);
    free(image.rgb);
    return power;
}

double stage_max_block_difference(const struct stage *stage, const uint8_t *a,
                                  const uint8_t *b)
{
    const int w = stage->view.width, h = stage->view.height;
    double worst = 0;

    for (int y = 0; y + 8 <= h; y += 8)
        for (int x = 0; x + 8 <= w; x += 8)
            for (int c = 0; c < 3; c++) {
                int sum = 0;

                for (int k = 0; k < 64; k++) {
                    const int at = 3 * ((y + k / 8) * w + x + k % 8) + c;

                    sum += a[at] - b[at];
                }
                worst = fmax(worst, abs(sum) / 64.0);
            }
    return worst;
}

double stage_sum_image(const struct stage *stage, const float *rgb)
{
    double sum = 0;

    for (int i = 0; i < 3 * stage->view.width * stage->view.height; i++)
        sum += (double)rgb[i];
    return sum;
}

void stage_free(struct stage *stage)
{
    if (stage->framed)
        glint_frame_finish(&stage->frame);
    model_file_close(&stage->file);
    *stage = (struct stage){.framed = false};
}

struct glint_lamp stage_make_lamp(double theta_deg, double phi_deg,
                                  double power)
{
    return (struct glint_lamp){theta_deg, phi_deg, power, {1, 1, 1}, {0, 0}, 0};
}

uint64_t stage_random_bits(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

double stage_random_uniform(uint64_t *state, double low, double high)
{
    return low +
           (high - low) * (double)(stage_random_bits(state) >> 11) * 0x1p-53;
}
