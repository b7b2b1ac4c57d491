/* SPDX-License-Identifier: MIT
 *
 * flicker MODEL.glint... - prints how steady frames of many lights are. For
 * FRAMES frames of 640x360 codes on black 16 lights move by a third of a pixel
 * a frame and their powers waver by 3 %. A row has, for five qualities, the
 * largest jump of a mean of 8 x 8 pixels from one frame to the next, in codes:
 * the last is the finest, in which each light has ghosts of its own.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options/tool.h"
#include "support/stage.h"

enum { W = 640, H = 360, BYTES = 3 * W * H, LIGHTS = 16, FRAMES = 300 };

static const int qualities_q15[] = {1 << 11, 1 << 12, 1 << 13, 1 << 14,
                                    1 << 15};

enum { QUALITIES = sizeof qualities_q15 / sizeof *qualities_q15 };

static struct stage stage;
static struct glint_lamp lamps[LIGHTS];
static uint8_t picture[2][BYTES];

/* Sets a street of lamps in groups, over seven octaves of power, in frame
 * TIME. They move towards the other half of the picture, so that none leaves
 * it, which would be a jump of the scene's own. */
static void set_lamps(int time, uint64_t *noise)
{
    for (int i = 0; i < LIGHTS; i++) {
        const double from = fmod(60 + 130 * (i % 5) + 11 * i, W);
        const double x = from + (from < 0.5 * W ? time : -time) / 3.;
        const int y = 90 + 40 * (i / 5) + 7 * (i % 3);

        lamps[i] = (struct glint_lamp){.rgb = {1, 0.8, 0.6}};
        lamps[i].power =
            3e5 * exp2(-0.45 * i) * stage_uniform(noise, 0.97, 1.03);
        glint_view_to_angles(&stage.view, stage.of_model.optics.focal_mm, x, y,
                             &lamps[i]);
    }
}

/* Returns the largest jump at a quality. */
static double jump_at(int quality_q15)
{
    uint64_t noise = 1;
    double worst = 0;

    for (int i = 0; i < FRAMES; i++) {
        uint8_t *now = picture[i % 2];

        set_lamps(i, &noise);
        stage.frame.dials = glint_dials_at(quality_q15);
        stage.frame.dials.dispersion_q8 = 0;
        memset(now, 0, BYTES);
        if (!stage_codes(&stage, lamps, LIGHTS, now))
            exit(1);
        if (i > 0)
            worst =
                fmax(worst, stage_block_jump(&stage, picture[1 - i % 2], now));
    }
    return worst;
}

int main(int argc, char **argv)
{
    puts("| lens | 0.0625 | 0.125 | 0.25 | 0.5 | 1 "
         "|\n|---|---|---|---|---|---|");
    for (int i = 1; i < argc; i++) {
        if (!stage_read(&stage, argv[i], W, H))
            return 1;
        printf("| %s |", stage.file.lens.header->name);
        for (int k = 0; k < QUALITIES; k++) {
            printf(" %.1f |", jump_at(qualities_q15[k]));
            fflush(stdout);
        }
        puts("");
        stage_close(&stage);
    }
    return 0;
}
