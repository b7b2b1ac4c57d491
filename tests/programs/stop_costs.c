/* SPDX-License-Identifier: MIT
 *
 * stop_costs MODEL.glint F - prints F and the processor milliseconds of a frame
 * through a model at f/F: one thread, the least of ROUNDS. Frames are 1920x1080
 * codes on black, at the default quality with three wavelengths, and show one
 * light 7 degrees off the axis, so bright that the 99.9th percentile of the
 * flare is display white.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "support/stage.h"

enum { WIDTH = 1920, HEIGHT = 1080, ROUNDS = 5 };

static double seconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char **argv)
{
    static struct stage stage;
    static uint8_t codes[3 * WIDTH * HEIGHT];
    struct glint_lamp lamp = stage_lamp(7, 30, 1);
    struct glint_error error;
    double least = HUGE_VAL;

    if (argc != 3 || !stage_read(&stage, argv[1], WIDTH, HEIGHT))
        return 2;
    if (glint_setup_stop_down(&stage.of_model, &stage.file.lens, atof(argv[2]),
                              &error) != GLINT_OK)
        return 1;
    stage.frame.dials = glint_dials_at(1 << 14);
    stage.frame.dials.dispersion_q8 = 0;
    lamp.power = stage_power(&stage, &lamp);
    for (int i = 0; i < ROUNDS; i++) {
        double from;

        memset(codes, 0, sizeof codes);
        from = seconds();
        if (!stage_codes(&stage, &lamp, 1, codes))
            return 1;
        least = fmin(least, seconds() - from);
    }
    printf("%g %.2f\n", atof(argv[2]), 1e3 * least);
    stage_close(&stage);
    return 0;
}
