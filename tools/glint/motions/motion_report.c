/* SPDX-License-Identifier: MIT
 *
 * Prints the contents of a baked motion as text or JSON.
 */
#include <math.h>

#include "glint/view.h"
#include "motions/motion_file.h"
#include "options/json_writer.h"

struct counts {
    /* bytes of each section of the baked motion */
    size_t header, sensors, events, index, poses, intensities;
    double step; /* resolution of positions, units */
};

static struct counts count_motion_contents(const struct motion_file *file)
{
    const struct glint_motion_header *h = &file->motion.header;
    const size_t block = GLINT_MOTION_BLOCK;

    return (struct counts){
        .header = block,
        .sensors = block * (h->event_block - h->sensor_block),
        .events = block * (h->index_block - h->event_block),
        .index = block * (h->pose_block - h->index_block),
        .poses = block * (h->intensity_block - h->pose_block),
        .intensities = h->bytes - block * h->intensity_block,
        .step = ldexp(1, -h->unit_log2)};
}

static double compute_sensor_view_angle_deg(const struct glint_motion_header *h)
{
    return 360 / GLINT_PI * acos(ldexp(h->cos_half_q30, -30));
}

static void print_motion_json(const struct motion_file *file,
                              const struct counts *n)
{
    const struct glint_motion_header *h = &file->motion.header;
    const struct glint_motion_report *r = &file->report;
    struct json_writer json = {.to = stdout};

    json_write(&json,
               "{name: %s, motion: {frames: %u, foods: %u, "
               "sensors: %u, resets: %u, size: %.6g, angle_deg: %.6g, "
               "step: %.6g, low: [%.9g, %.9g, %.9g], "
               "high: [%.9g, %.9g, %.9g], residual: %.6g, residual_frame: %u",
               h->name, h->n_frames, h->n_foods, h->n_sensors,
               h->n_events - h->n_foods, n->step * h->size,
               compute_sensor_view_angle_deg(h), n->step, n->step * h->low[0],
               n->step * h->low[1], n->step * h->low[2], n->step * h->high[0],
               n->step * h->high[1], n->step * h->high[2],
               n->step * h->residual, h->residual_frame);
    if (file->is_baked_now)
        json_write(&json,
                   "path: %.9g, span: %.9g, residual_rms: %.6g, "
                   "bad_frames: %ld",
                   r->path, r->span, r->residual_rms, r->bad_frames);
    if (file->is_baked_now && r->has_senses)
        json_write(&json, "senses_off: %.6g, senses_most: %.6g", r->senses_off,
                   r->senses_most);
    json_write(&json,
               "bytes: {header: %zu, sensors: %zu, events: %zu, index: %zu, "
               "poses: %zu, intensities: %zu, all: %zu}}}\n",
               n->header, n->sensors, n->events, n->index, n->poses,
               n->intensities, file->bytes);
}

static void print_motion_text(const struct motion_file *file,
                              const struct counts *n)
{
    const struct glint_motion_header *h = &file->motion.header;
    const struct glint_motion_report *r = &file->report;

    printf("%s, a motion of %u frames\n\n", h->name, h->n_frames);
    printf("body         size %.4g, %u sensors that see %.4g degrees\n",
           n->step * h->size, h->n_sensors, compute_sensor_view_angle_deg(h));
    printf("landmarks    %u, %u replaced%s\n", h->n_foods,
           h->n_events - h->n_foods,
           h->intensities ? ", with intensities" : "");
    printf("extent       %.4g %.4g %.4g to %.4g %.4g %.4g, steps of %.3g\n",
           n->step * h->low[0], n->step * h->low[1], n->step * h->low[2],
           n->step * h->high[0], n->step * h->high[1], n->step * h->high[2],
           n->step);
    printf("residual     at most %.4g, in frame %u", n->step * h->residual,
           h->residual_frame);
    if (file->is_baked_now)
        printf("; rms %.4g", r->residual_rms);
    printf("\n");
    if (file->is_baked_now)
        printf("path         %.6g long\n", r->path);
    if (file->is_baked_now && r->has_senses)
        printf(
            "odometry     the sum of 'rv' and 'tv' is off by %.4g at the end, "
            "%.4g at most\n",
            r->senses_off, r->senses_most);
    printf("bytes        %zu\n  header       %8zu\n  sensors      %8zu\n"
           "  events       %8zu\n  index        %8zu\n  poses        %8zu\n",
           file->bytes, n->header, n->sensors, n->events, n->index, n->poses);
    if (n->intensities)
        printf("  intensities  %8zu\n", n->intensities);
}

void motion_file_print_contents(const struct tool *tool,
                                struct motion_file *file)
{
    const struct counts n = count_motion_contents(file);

    (tool->json ? print_motion_json : print_motion_text)(file, &n);
}
