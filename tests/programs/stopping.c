/* SPDX-License-Identifier: MIT
 *
 * stopping LENS.lens MODEL.glint PLOT.svg [GRID] - stops a lens down through a
 * video, by one model, and by exact rays of GRID cells a side (128). FRAMES
 * frames of 480x270 codes on black show one light; from frame to frame the
 * f-number grows by the same factor, from the model's to f/22. Prints a row for
 * each tenth frame and one for the worst: the largest jump of a mean of 8 x 8
 * pixels from the frame before, in codes, of the model and of exact rays, the
 * largest difference of the two jumps in one place, and the PSNR between both
 * pictures. PLOT.svg receives the jumps of all frames.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lab/plots/plot.h"
#include "model/model_file.h"
#include "options/tool.h"
#include "support/stage.h"

enum { W = 480, H = 270, COUNT = 3 * W * H, FRAMES = 100, LAST = 22 };

static struct stage stage;
static float linear[COUNT];
static uint8_t codes[2][2][COUNT]; /* [model, exact][frame % 2] */

struct row {
    double f_number, model, exact, apart, psnr_db, ms;
};

/* Reads the table at PATH and opens the model of it. */
static bool open_lens(const char *path, const char *model)
{
    static const struct tool tool = {.name = "stopping", .n_threads = 1};
    char text[65536];
    FILE *file = fopen(path, "rb");
    size_t bytes;

    if (!file)
        return false;
    bytes = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[bytes] = 0;
    return stage_parse(&stage, text) && stage_prepare(&stage, 8) &&
           tool_model(&tool, model, &stage.file) == EXIT_OK;
}

/* Draws LAMP's flare at F_NUMBER by the model and by exact rays. */
static bool draw(double f_number, const struct glint_lamp *lamp, int grid,
                 int frame)
{
    struct glint_float_image image = {W, H, linear};
    uint8_t *exact;

    memset(codes[0][frame % 2], 0, COUNT);
    if (!stage_stop(&stage, f_number) ||
        !stage_codes(&stage, lamp, 1, codes[0][frame % 2]) ||
        !stage_exact(&stage, lamp, 1, grid, linear))
        return false;
    exact = glint_measure_encode(&image, 1);
    if (exact)
        memcpy(codes[1][frame % 2], exact, COUNT);
    free(exact);
    return exact != NULL;
}

/* Returns the largest difference, over blocks of 8 x 8 pixels, between the jump
 * of the model's mean and that of exact rays'. */
static double jumps_apart(void)
{
    double worst = 0;

    for (int at = 0; at < W / 8 * (H / 8) * 3; at++) {
        const int block = at / 3, x = block % (W / 8) * 8,
                  y = block / (W / 8) * 8;
        int sum = 0;

        for (int k = 0; k < 64; k++) {
            const int i = 3 * ((y + k / 8) * W + x + k % 8) + at % 3;

            sum += codes[0][1][i] - codes[0][0][i] -
                   (codes[1][1][i] - codes[1][0][i]);
        }
        worst = fmax(worst, abs(sum) / 64.0);
    }
    return worst;
}

static void measure(struct row *row, int frame)
{
    struct glint_measure m = {.flux = 1};

    glint_measure_codes(codes[1][frame % 2], codes[0][frame % 2], W, H, &m);
    row->psnr_db = m.psnr_db;
    if (frame == 0)
        return;
    row->model = stage_block_jump(&stage, codes[0][0], codes[0][1]);
    row->exact = stage_block_jump(&stage, codes[1][0], codes[1][1]);
    row->apart = jumps_apart();
}

static void print_row(const struct row *row, const char *what)
{
    printf("| %s | f/%.3g | %.2f | %.2f | %.2f | %.1f |\n", what, row->f_number,
           row->model, row->exact, row->apart, row->psnr_db);
    fflush(stdout);
}

static void plot(FILE *file, const struct row *row)
{
    static const char *const words[] = {"model", "exact rays", "apart"};
    struct plot p;

    plot_open(file, 1);
    plot_init(&p, file, 0, "Stopping down, largest jump of 8 x 8 pixels");
    p.x = (struct plot_axis){"f-number", true, row[0].f_number, LAST, 0};
    p.y = (struct plot_axis){"codes a frame", false, 0, 1, 0};
    for (int i = 1; i < FRAMES; i++)
        plot_stretch(&p, row[i].f_number, fmax(row[i].model, row[i].exact));
    plot_frame(&p);
    for (int k = 0; k < 3; k++)
        plot_key(&p, 'o', plot_colour(k), words[k]);
    for (int i = 2; i < FRAMES; i++)
        for (int k = 0; k < 3; k++) {
            const double *a = &row[i - 1].model, *b = &row[i].model;

            plot_line(&p, row[i - 1].f_number, a[k], row[i].f_number, b[k],
                      plot_colour(k), false);
        }
    plot_close(file);
}

/* Sets the power of LAMP at which the flare is well exposed wide open. */
static bool expose(struct glint_lamp *lamp, double f_number)
{
    if (!stage_stop(&stage, f_number))
        return false;
    lamp->power = stage_power(&stage, lamp);
    return true;
}

int main(int argc, char **argv)
{
    static struct row row[FRAMES];
    struct row worst = {.psnr_db = HUGE_VAL};
    struct glint_lamp lamp = stage_lamp(7, 30, 1);
    FILE *file = argc > 3 ? fopen(argv[3], "w") : NULL;
    double open;

    if (!file || !open_lens(argv[1], argv[2]))
        return 2;
    open = glint_real_value(stage.file.lens.header->f_number);
    stage_view(&stage, W, H, 0);
    if (!expose(&lamp, open))
        return 1;
    puts("| frame | stop | model, codes | exact rays | apart | PSNR, dB |\n"
         "|---|---|---|---|---|---|");
    for (int i = 0; i < FRAMES; i++) {
        char what[16];

        row[i].f_number = open * pow(LAST / open, i / (FRAMES - 1.0));
        if (!draw(row[i].f_number, &lamp, argc > 4 ? atoi(argv[4]) : 128, i))
            return 1;
        measure(&row[i], i);
        snprintf(what, sizeof what, "%d", i);
        if (i % 10 == 0 || i == FRAMES - 1)
            print_row(&row[i], what);
        worst.model = fmax(worst.model, row[i].model);
        worst.exact = fmax(worst.exact, row[i].exact);
        worst.apart = fmax(worst.apart, row[i].apart);
        worst.psnr_db = fmin(worst.psnr_db, row[i].psnr_db);
    }
    worst.f_number = open;
    print_row(&worst, "worst");
    plot(file, row);
    stage_close(&stage);
    return fclose(file) == 0 ? 0 : 1;
}
