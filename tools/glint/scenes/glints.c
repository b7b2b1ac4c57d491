/* SPDX-License-Identifier: MIT */
#include "scenes/glints.h"

#include <math.h>
#include <stdlib.h>

/* alignment of the tracker's memory, bytes */
#define ALIGNMENT 64

enum glint_status glints_open(struct glints *glints, int width, int height)
{
    struct glint_lamp_tracker_config cfg;
    size_t bytes;

    *glints = (struct glints){.n = 0};
    glint_lamp_tracker_defaults(&cfg, width, height);
    cfg.max_tracks = GLINTS_MAX;
    cfg.max_shown = GLINT_SCENE_MAX_HIGHLIGHTS;
    /* Disables the detection of cuts: when objects rotate, several highlights
     * may appear at once. */
    cfg.cut_q15 = (1 << 15) + 1;
    bytes = glint_lamp_tracker_bytes(&cfg);
    if (posix_memalign(&glints->mem, ALIGNMENT, bytes)) {
        glints->mem = NULL;
        return GLINT_E_MEMORY;
    }
    return glint_lamp_tracker_init(&glints->tracks, &cfg, glints->mem, bytes);
}

void glints_close(struct glints *glints)
{
    free(glints->mem);
    *glints = (struct glints){.n = 0};
}

/* Returns SPOT, highlight number NUMBER of an independent picture, as a track
 * that does not fade. */
static struct glint_lamp_track
make_highlight_track(const struct glint_spot *spot, int number)
{
    return (struct glint_lamp_track){
        .id = (uint32_t)number + 1,
        .state = GLINT_LAMP_STEADY,
        .x_q8 = spot->x_q8,
        .y_q8 = spot->y_q8,
        .size_q8 = spot->size_q8,
        .level_q15 = 1 << 15,
        .flux_q16 = spot->flux_q16,
        .power_q16 = spot->power_q16,
        .axis_q8 = {spot->axis_q8[0], spot->axis_q8[1]},
        .cos_q15 = spot->cos_q15,
        .sin_q15 = spot->sin_q15,
        .rgb_q15 = {spot->rgb_q15[0], spot->rgb_q15[1], spot->rgb_q15[2]}};
}

int glints_track_frame(struct glints *glints, const struct glint_scene *scene,
                       int32_t elapsed_us)
{
    struct glints *const g = glints;
    struct glint_spot spot[GLINT_SCENE_MAX_HIGHLIGHTS];

    g->n_found = glint_scene_find_highlights(scene, g->found);
    g->n = g->n_found;
    for (int i = 0; i < g->n_found; i++) {
        spot[i] = g->found[i].spot;
        g->track[i] = make_highlight_track(&spot[i], i);
    }
    if (elapsed_us > 0)
        g->n = glint_lamp_tracker_step(g->tracks, spot, g->n_found, elapsed_us,
                                       g->track, GLINTS_MAX);
    return g->n;
}

double glints_get_lamp(const struct glints *glints, int i,
                       const struct glint_view *view, double focal_mm,
                       struct glint_lamp *lamp)
{
    const struct glint_lamp_track *const t = &glints->track[i];
    const double tangent = glint_view_pixel_tangent(view, focal_mm);

    glint_view_to_angles(view, focal_mm, t->x_q8 / 256.0, t->y_q8 / 256.0,
                         lamp);
    for (int k = 0; k < 2; k++)
        lamp->axis[k] = t->axis_q8[k] / 256.0 * tangent;
    lamp->turn_deg = atan2(-t->sin_q15, t->cos_q15) * 180 / GLINT_PI;
    lamp->power = (double)t->power_q16 * 0x1p-16;
    for (int c = 0; c < 3; c++)
        lamp->rgb[c] = t->rgb_q15[c] * 0x1p-15;
    return t->level_q15 * 0x1p-15;
}
