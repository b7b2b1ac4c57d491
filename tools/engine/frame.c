/* SPDX-License-Identifier: MIT */
#include "engine/frame.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/area.h"
#include "engine/frame_feed.h"
#include "engine/quality.h"
#include "options/tool.h"

/* What one frame may take, by edges and by cells. */
enum { MAX_BUNDLES = 1 << 20, MAX_BUNDLES_CELLS = 65535 };

void frame_init(struct frame *frame, const struct glint_setup *setup,
                struct glint_view view, struct glint_workers *workers)
{
    *frame = (struct frame){.setup = setup,
                            .view = view,
                            .cfg = {.workers = workers,
                                    .width = view.width,
                                    .height = view.height,
                                    .tile_log2 = 6,
                                    .weights = GLINT_WEIGHTS_WACHSPRESS,
                                    .antialias = 1},
                            .dials = glint_dials_at(1 << 14),
                            .apart_px = FRAME_APART_PX,
                            .only_ghost = -1};
    glint_setup_stop(setup, &frame->cfg.stop);
}

enum glint_status frame_use_mask(struct frame *frame, int nodes)
{
    const double span = 1.25;

    frame->mask = malloc((size_t)nodes * (size_t)nodes * sizeof *frame->mask);
    if (!frame->mask)
        return GLINT_E_MEMORY;
    glint_setup_mask(frame->setup, frame->mask, nodes, span);
    frame->cfg.raster = &glint_raster_cells;
    frame->cfg.stop.mask_q13 = frame->mask;
    frame->cfg.stop.mask_nodes = nodes;
    frame->cfg.stop.mask_span_q16 = (int32_t)(span * 65536);
    return GLINT_OK;
}

void frame_finish(struct frame *frame)
{
    free(frame->mask);
    free(frame->feed);
    free(frame->vertices);
    free(frame->beam);
    free(frame->merged);
    free(frame->seen);
    free(frame->mem);
}

/* ----------------------------------------------------------------------- rays
 */

static struct glint_real largest_of(const double rgb[3], int32_t rgb_q14[3])
{
    const double most = fmax(fabs(rgb[0]), fmax(fabs(rgb[1]), fabs(rgb[2])));

    for (int c = 0; c < 3; c++)
        rgb_q14[c] = most > 0 ? (int32_t)lrint(rgb[c] / most * 16384) : 0;
    return glint_real_of(most);
}

static struct glint_wave wave_of(double nm, const double rgb[3],
                                 double unit_flux)
{
    struct glint_wave w;
    const double size = glint_real_value(largest_of(rgb, w.rgb_q14));

    w.wave_q24 = (int32_t)lrint(1e6 / (nm * nm) * 0x1p24);
    w.weight = glint_real_of(size / unit_flux);
    return w;
}

/* Of all sets together. */
static int all_waves(const struct glint_setup *s)
{
    int n = 0;

    for (int i = 0; i < s->n_sets; i++)
        n += s->set_size[i];
    return n;
}

static bool has_sets(const struct frame *f)
{
    return f->lens && f->setup->n_sets && f->dials.dispersion_q8 > 0;
}

static void set_waves(struct frame *f)
{
    const struct glint_setup *s = f->setup;
    const struct glint_set_wave *w = s->set_wave;

    f->sets = (struct glint_wave_sets){.planner = &glint_wave_planner,
                                       .n_sets = s->n_sets,
                                       .apart_q8 = f->dials.dispersion_q8};
    for (int i = 0; i < s->n_sets; i++)
        f->sets.size[i] = s->set_size[i];
    if (has_sets(f))
        for (int i = 0; i < all_waves(s); i++)
            f->wave[i] = wave_of(w[i].nm, w[i].rgb, w[i].unit_flux);
    else
        for (int i = 0; i < s->n_wavelengths; i++)
            f->wave[i] =
                wave_of(s->wavelength_nm[i], s->rgb[i], s->unit_flux[i]);
}

static struct glint_light beam_of(const struct glint_lamp *l, double scale)
{
    const double degree = 3.14159265358979323846 / 180;
    struct glint_light b;
    const double size = glint_real_value(largest_of(l->rgb, b.rgb_q14));
    const double power = size * l->power * scale;

    b.sine_q30 = (int32_t)lrint(sin(l->theta_deg * degree) * 0x1p30);
    b.cosine_q30 = (int32_t)lrint(cos(l->theta_deg * degree) * 0x1p30);
    b.cos_q30 = (int32_t)lrint(cos(l->phi_deg * degree) * 0x1p30);
    b.sin_q30 = (int32_t)lrint(sin(l->phi_deg * degree) * 0x1p30);
    b.power = glint_real_of(isfinite(power) && power > 0 ? power : 0);
    return b;
}

static struct glint_lamp lamp_of(const struct glint_light *b)
{
    const double degree = 3.14159265358979323846 / 180;

    return (struct glint_lamp){
        .theta_deg = atan2(b->sine_q30, b->cosine_q30) / degree,
        .phi_deg = atan2(b->sin_q30, b->cos_q30) / degree,
        .power = glint_real_value(b->power),
        .rgb = {b->rgb_q14[0] * 0x1p-14, b->rgb_q14[1] * 0x1p-14,
                b->rgb_q14[2] * 0x1p-14}};
}

static int larger(int a, int b)
{
    return a > b ? a : b;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static double pixels_per_tangent(const struct frame *f)
{
    return fabs(f->setup->optics.focal_mm * f->view.width /
                f->view.sensor_width_mm);
}

/* The angle in which lights are one. */
static int32_t near_q30(const struct frame *f)
{
    const double pixels = pixels_per_tangent(f);

    return (int32_t)lrint(fmin(1, f->apart_px / pixels) * 0x1p30);
}

/* Beams that give nothing must not be merged with others into one that does. */
static bool is_beyond(const struct frame *f, const struct glint_light *b)
{
    return f->lens && b->sine_q30 > f->lens->header->sine_hi_q30;
}

bool frame_is_beyond(const struct frame *frame, const struct glint_lamp *lamp)
{
    const struct glint_light b = beam_of(lamp, 1);

    return is_beyond(frame, &b);
}

static enum glint_status hold_beams(struct frame *f, int n)
{
    struct glint_light *beam;

    if (n <= f->max_beams)
        return GLINT_OK;
    beam = realloc(f->beam, (size_t)n * sizeof *f->beam);
    if (!beam)
        return GLINT_E_MEMORY;
    f->beam = beam;
    f->max_beams = n;
    return GLINT_OK;
}

/* Appends the beams of LAMP's points that the model reaches; WITHIN are there
 * already. Returns how many there are then. */
static int add_beams(struct frame *f, const struct glint_lamp *lamp,
                     const struct area_rule *rule, double scale, int within)
{
    struct area area;
    const int n = area_plan(&area, lamp, rule);

    for (int i = 0; i < n; i++) {
        const struct glint_lamp point = area_point(&area, i);

        f->beam[within] = beam_of(&point, scale);
        within += !is_beyond(f, &f->beam[within]);
    }
    return within;
}

/* Makes F's beams of LAMPS, those merged that are too many. */
static enum glint_status
set_beams(struct frame *f, const struct glint_lamp *lamps, int n, double scale)
{
    const int room = f->reserved ? smaller(f->dials.max_lights, f->max_beams)
                                 : f->dials.max_lights;
    int within = 0, total;
    const struct area_rule rule = area_rule_of(
        lamps, n, pixels_per_tangent(f), f->dials.area_points, room, &total);

    if (hold_beams(f, total) != GLINT_OK)
        return GLINT_E_MEMORY;
    f->n_beyond = 0;
    for (int i = 0; i < n; i++) {
        const int before = within;

        within = add_beams(f, &lamps[i], &rule, scale, within);
        f->n_beyond += within == before;
    }
    f->n_more = within - (n - f->n_beyond);
    f->n_beams = glint_lights_merge(f->beam, within, near_q30(f),
                                    f->dials.max_lights, &f->n_apart);
    return GLINT_OK;
}

static bool is_in_codes(const struct frame *f, const struct glint_image *image)
{
    return image->format != GLINT_LINEAR_Q20 || f->for_codes;
}

/* The light of CODES near black; 0: the picture is linear. */
static double light_of(const struct frame *f, const struct glint_image *image,
                       double codes)
{
    return !image || !is_in_codes(f, image)
               ? 0
               : codes / 255 /
                     (image->transfer == GLINT_TONE_SRGB ? 12.92 : 4.5);
}

/* IMAGE: NULL for a linear one. */
static struct glint_flare_frame rays_of(struct frame *f,
                                        const struct glint_image *image)
{
    set_waves(f);
    f->sets.step = glint_real_of(light_of(f, image, FRAME_STEP_CODES));
    return (struct glint_flare_frame){
        .lens = f->lens,
        .wave = f->wave,
        .n_waves = has_sets(f) ? all_waves(f->setup) : f->setup->n_wavelengths,
        .sets = has_sets(f) ? &f->sets : NULL,
        .pixels_per_mm = glint_real_of(f->view.width / f->view.sensor_width_mm),
        .fineness = f->dials.fineness,
        .uniform = f->uniform,
        .only_ghost = f->only_ghost,
        .faintest = glint_real_of(light_of(f, image, f->dials.cull_codes)),
        .whole_codes_q8 = f->dials.snap_codes_q8,
        .half =
            glint_dials_half(&f->dials) && f->can_half ? &glint_half : NULL};
}

/* --------------------------------------------------------------------- memory
 */

/* A new block for the capacities there are. */
static enum glint_status regrow(struct frame *f)
{
    const size_t bytes = glint_flare_bytes(&f->cfg);
    void *mem = NULL;

    free(f->mem);
    f->mem = NULL;
    f->bytes = 0;
    if (bytes == 0 || posix_memalign(&mem, 64, bytes) != 0)
        return GLINT_E_MEMORY;
    f->mem = mem;
    f->bytes = bytes;
    return glint_flare_init(&f->flare, &f->cfg, mem, bytes);
}

/* What a frame may take of N bundles. */
static int bundles_within(const struct frame *f, double n)
{
    const int most =
        f->cfg.raster == &glint_raster_cells ? MAX_BUNDLES_CELLS : MAX_BUNDLES;

    return n < most ? (int)n : most;
}

/* Bundles that N_BEAMS need; with sets, to choose from these. */
static int bundles_of(const struct frame *f, int n_beams)
{
    const struct glint_setup *s = f->setup;

    return bundles_within(
        f, (double)n_beams * s->n_ghosts *
               (has_sets(f) ? s->set_size[0] : s->n_wavelengths));
}

void frame_retune(struct frame *f)
{
    f->cfg.irradiance_steps = f->dials.irradiance_steps;
    if (f->mem)
        glint_flare_init(&f->flare, &f->cfg, f->mem, f->bytes);
}

/* The flare has the steps of the dials. */
static void follow_dials(struct frame *f)
{
    if (f->cfg.irradiance_steps != f->dials.irradiance_steps)
        frame_retune(f);
}

/* Plans, with room for all bundles there can be. */
static enum glint_status plan(struct frame *f,
                              const struct glint_flare_frame *rays)
{
    const int bundles = bundles_of(f, f->n_beams);

    follow_dials(f);
    if (!f->reserved && (!f->mem || bundles > f->cfg.max_bundles)) {
        enum glint_status status;

        f->cfg.max_bundles = larger(bundles, f->cfg.max_bundles);
        status = regrow(f);
        if (status != GLINT_OK)
            return status;
    }
    glint_flare_plan(f->flare, rays, f->beam, f->n_beams);
    return GLINT_OK;
}

/* Whether all fitted; makes room where it did not. */
static bool is_served(struct frame *f, const struct glint_flare_stats *s)
{
    struct glint_flare_config *c = &f->cfg;

    const int bundles = bundles_within(f, s->need_bundles);

    if (f->reserved)
        return true;
    if (bundles <= c->max_bundles && s->need_vertices <= c->max_vertices &&
        s->need_primitives <= c->max_primitives &&
        s->need_refs <= c->max_refs && s->need_tile_refs <= c->max_tile_refs)
        return true;
    c->max_bundles = larger(c->max_bundles, bundles);
    c->max_vertices = larger(c->max_vertices, s->need_vertices);
    /* workers' shares are never quite even */
    c->max_primitives = larger(
        c->max_primitives,
        (int)fmin(INT_MAX,
                  s->need_primitives *
                      (glint_workers_count(c->workers) > 1 ? 1.5 : 1.0)));
    c->max_refs = larger(c->max_refs, s->need_refs);
    c->max_tile_refs = larger(c->max_tile_refs, s->need_tile_refs);
    return false;
}

/* References for each primitive, and vertices by cells: rather too many. */
static size_t bytes_for(struct frame *f, int primitives)
{
    const bool by_cells = f->cfg.raster == &glint_raster_cells;

    f->cfg.max_primitives = primitives;
    f->cfg.max_refs = 2 * primitives;
    f->cfg.max_vertices = by_cells ? 2 * primitives : 0;
    f->cfg.max_tile_refs = f->cfg.coarse_log2 ? primitives : 0;
    return glint_flare_bytes(&f->cfg);
}

enum glint_status frame_reserve(struct frame *f, size_t bytes, int n_lamps,
                                int n_drawn)
{
    int most = 0;

    f->dials.max_lights =
        smaller(f->dials.max_lights, smaller(n_drawn, n_lamps));
    /* not all ghosts are seen, and few take the largest set */
    f->cfg.max_bundles = bundles_within(
        f, (has_sets(f) ? 2. : 1) * bundles_of(f, f->dials.max_lights));
    for (int step = 1 << 24; step > 0; step /= 2) {
        const size_t need = bytes_for(f, most + step);

        if (need != 0 && need <= bytes)
            most += step;
    }
    if (most == 0 || bytes_for(f, most) > bytes)
        return GLINT_E_MEMORY;
    if (!f->seen)
        f->seen = calloc(GLINT_MAX_GHOSTS, sizeof *f->seen);
    if (!f->seen || hold_beams(f, n_lamps) != GLINT_OK)
        return GLINT_E_MEMORY;
    f->reserved = true;
    return regrow(f);
}

/* What the frame took, by the same measure that sized the block. */
static size_t bytes_used(const struct frame *f,
                         const struct glint_flare_stats *s)
{
    struct glint_flare_config used = f->cfg;

    used.max_bundles = smaller(s->need_bundles, f->cfg.max_bundles);
    used.max_vertices = s->vertices;
    used.max_primitives = s->primitives;
    used.max_refs = s->refs;
    used.max_tile_refs = s->tile_refs;
    return glint_flare_bytes(&used);
}

/* ---------------------------------------------------------------------- frame
 */

/* Ghost or part GHOST is ghost NUMBER. */
static bool is_ghost(const struct glint_setup *s, int ghost, int number)
{
    return s->ghost[ghost].i == s->ghost[number].i &&
           s->ghost[ghost].j == s->ghost[number].j;
}

/* Returns whether it is the first of its ghost in the frame. */
static bool note_ghost(struct frame *frame, int ghost)
{
    const struct glint_setup *s = frame->setup;
    int number = ghost;

    if (ghost >= s->n_ghosts - s->n_parts)
        for (number = 0; !is_ghost(s, ghost, number);)
            number++;
    if (frame->seen[number])
        return false;
    return frame->seen[number] = true;
}

/* How many ghosts the last frame has, of N bundles. */
static int count_ghosts(struct frame *frame, int n)
{
    int n_ghosts = 0;

    memset(frame->seen, 0,
           (size_t)frame->setup->n_ghosts * sizeof *frame->seen);
    for (int i = 0; i < n; i++)
        n_ghosts +=
            note_ghost(frame, frame->lens ? glint_flare_ghost(frame->flare, i)
                                          : frame->feed[i].ghost);
    return n_ghosts;
}

/* What F has planned, for telling what it takes. */
struct cost_plan frame_plan(const struct frame *f)
{
    return (struct cost_plan){.flare = f->flare,
                              .width = f->cfg.width,
                              .height = f->cfg.height,
                              .n_looked_at = (double)f->n_beams *
                                             f->setup->n_ghosts *
                                             f->setup->n_wavelengths,
                              .can_half = f->can_half,
                              .dials = f->dials};
}

/* Whether dials were turned and the frame has to be planned anew. */
static bool choose(struct frame *f)
{
    const struct cost_plan plan = frame_plan(f);

    return budget_choose(&f->budget, &plan, &f->dials);
}

static enum glint_status
draw_model(struct frame *f, const struct glint_lamp *lamps, int n_lamps,
           double scale, const struct glint_image *image,
           struct glint_flare_stats *stats, double times[5])
{
    enum glint_status status;

    f->can_half = is_in_codes(f, image) && !f->cfg.raster;
    f->rays = rays_of(f, image);
    f->scale = scale;
    budget_begin(&f->budget);
    times[0] = tool_seconds();
    status = set_beams(f, lamps, n_lamps, scale);
    while (status == GLINT_OK) {
        status = plan(f, &f->rays);
        if (status != GLINT_OK)
            return status;
        if (f->budget.ms > 0 && choose(f)) {
            f->rays = rays_of(f, image);
            continue;
        }
        times[1] = times[2] = tool_seconds();
        glint_flare_bin(f->flare, stats);
        if (is_served(f, stats))
            break;
        status = regrow(f);
    }
    if (status != GLINT_OK)
        return status;
    times[3] = tool_seconds();
    glint_flare_draw(f->flare, image);
    times[4] = tool_seconds();
    return GLINT_OK;
}

/* For exact rays: what LAMPS are after merging, N of them. NULL: no memory. */
static const struct glint_lamp *
merged_lamps(struct frame *f, const struct glint_lamp *lamps, int *n)
{
    struct glint_lamp *merged;

    if (set_beams(f, lamps, *n, 1) != GLINT_OK)
        return NULL;
    if (f->n_beams == *n && f->n_more == 0)
        return lamps;
    *n = f->n_beams;
    merged = realloc(f->merged, ((size_t)*n + 1) * sizeof *merged);
    if (!merged)
        return NULL;
    f->merged = merged;
    for (int i = 0; i < *n; i++)
        merged[i] = lamp_of(&f->beam[i]);
    return merged;
}

static enum glint_status
draw_exact(struct frame *f, const struct glint_lamp *lamps, int n_lamps,
           double scale, const struct glint_image *image,
           struct glint_flare_stats *stats, double times[5])
{
    const struct glint_lamp *merged = merged_lamps(f, lamps, &n_lamps);

    follow_dials(f);
    return merged
               ? frame_feed_draw(f, merged, n_lamps, scale, image, stats, times)
               : GLINT_E_MEMORY;
}

static enum glint_status model_scale(struct frame *frame,
                                     const struct glint_lamp *lamps,
                                     int n_lamps, struct frame_scale *scale)
{
    struct glint_real brightest, together;
    struct glint_flare_frame rays;
    enum glint_status status = set_beams(frame, lamps, n_lamps, 1);

    frame->can_half = false;
    rays = rays_of(frame, NULL);
    if (status == GLINT_OK)
        status = plan(frame, &rays);
    if (status != GLINT_OK)
        return status;
    glint_flare_light(frame->flare, &brightest, &together);
    if (brightest.mantissa)
        *scale =
            frame_scale_of(brightest.exponent + 31, together.exponent + 31);
    return GLINT_OK;
}

/* As the plan tells without drawing anything; {0, 0}: there is no light. */
static enum glint_status plan_scale(struct frame *frame,
                                    const struct glint_lamp *lamps, int n_lamps,
                                    struct frame_scale *scale)
{
    *scale = (struct frame_scale){0, 0};
    if (frame->lens)
        return model_scale(frame, lamps, n_lamps, scale);
    lamps = merged_lamps(frame, lamps, &n_lamps);
    return lamps ? frame_feed_scale(frame, lamps, n_lamps, scale)
                 : GLINT_E_MEMORY;
}

/* Bundles whose ghosts are known. */
static int n_drawn(const struct frame *f, const struct frame_report *r)
{
    return f->lens ? r->stats.bundles : f->n_feeds;
}

enum glint_status frame_draw(struct frame *frame,
                             const struct glint_lamp *lamps, int n_lamps,
                             double scale, const struct glint_image *image,
                             struct frame_report *report)
{
    double times[5] = {0, 0, 0, 0, 0};
    const size_t bytes = frame->bytes;
    enum glint_status status;

    *report = (struct frame_report){.lights = n_lamps, .quality = -1};
    if (n_lamps == 0) { /* the picture is not so much as looked at */
        report->arena_bytes = frame->bytes;
        return GLINT_OK;
    }
    if (!frame->seen)
        frame->seen = calloc(GLINT_MAX_GHOSTS, sizeof *frame->seen);
    if (!frame->seen)
        return GLINT_E_MEMORY;
    status = (frame->lens ? draw_model : draw_exact)(
        frame, lamps, n_lamps, scale, image, &report->stats, times);
    if (status != GLINT_OK)
        return status;
    report->plan_ms = 1e3 * (times[1] - times[0]);
    report->trace_ms = 1e3 * (times[2] - times[1]);
    report->bin_ms = 1e3 * (times[3] - times[2]);
    report->draw_ms = 1e3 * (times[4] - times[3]);
    if (frame->lens && frame->budget.ms > 0) {
        report->predicted_ms = frame->budget.predicted_ms;
        report->calibrated_minsn = frame->budget.calibrated_minsn;
        report->quality = budget_quality(&frame->budget);
        if (frame->bytes == bytes) /* else it made room, once */
            budget_note(&frame->budget, 1e3 * (times[4] - times[0]));
    }
    report->beyond_lights = frame->n_beyond;
    report->apart_lights = larger(frame->n_apart - frame->n_more, 1);
    report->drawn_lights = larger(frame->n_beams - frame->n_more, 1);
    report->tiles = glint_flare_tiles(frame->flare);
    report->held_samples = glint_flare_held(frame->flare);
    report->arena_bytes = frame->bytes;
    report->peak_bytes = bytes_used(frame, &report->stats);
    report->ghosts = count_ghosts(frame, n_drawn(frame, report));
    return GLINT_OK;
}

/* ---------------------------------------------------------------------- alone
 */

struct frame_scale frame_scale_of(int brightest_log2, int together_log2)
{
    const int most = 23 - together_log2, likely = 5 - brightest_log2;

    return (struct frame_scale){likely < most ? likely : most, most};
}

/* The size of the largest of N values. */
static uint32_t peak_of(const int32_t *linear_q20, size_t n)
{
    uint32_t peak = 0;

    for (size_t i = 0; i < n; i++) {
        const uint32_t size = linear_q20[i] < 0 ? 0U - (uint32_t)linear_q20[i]
                                                : (uint32_t)linear_q20[i];

        peak = size > peak ? size : peak;
    }
    return peak;
}

/* Octaves that a picture with that PEAK should have been drawn brighter; of
 * held light nobody knows how bright it is. A single one is not worth it. */
static int octaves_up(uint32_t peak, struct frame_scale scale)
{
    const int room = scale.most - scale.likely;
    int up = 0;

    if (peak >= INT32_MAX)
        return -6;
    for (; peak && peak < UINT32_C(1) << 29; peak *= 2)
        up++;
    up = up < room ? up : room;
    return up > 1 ? up : 0;
}

enum glint_status frame_draw_alone(struct frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   double gain, float *rgb,
                                   struct frame_report *report)
{
    const int width = frame->view.width, height = frame->view.height;
    const size_t n = 3 * (size_t)width * (size_t)height;
    struct frame_scale scale;
    struct glint_image layer = {
        .format = GLINT_LINEAR_Q20, .width = width, .height = height};
    int32_t *linear_q20 = malloc(n * sizeof *linear_q20);
    enum glint_status status =
        linear_q20 ? plan_scale(frame, lamps, n_lamps, &scale) : GLINT_E_MEMORY;
    int up = 1;

    glint_image_place(&layer, linear_q20);
    for (int i = 0; i < 4 && up && status == GLINT_OK; i++) {
        memset(linear_q20, 0, n * sizeof *linear_q20);
        status = frame_draw(frame, lamps, n_lamps, exp2(scale.likely), &layer,
                            report);
        up = octaves_up(peak_of(linear_q20, n), scale);
        scale.likely += i < 3 ? up : 0;
    }
    for (size_t i = 0; i < n && status == GLINT_OK; i++)
        rgb[i] = (float)(linear_q20[i] * exp2(-20 - scale.likely) * gain);
    free(linear_q20);
    return status;
}
