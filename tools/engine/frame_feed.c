/* SPDX-License-Identifier: MIT
 *
 * A frame of exact rays: planned, traced and handed over bundle by bundle.
 */
#include "engine/frame_feed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/tool.h"

/* What one frame may take: 65535 bundles, 0.8 GB of vertices. */
enum { MAX_BUNDLES = 65535, MAX_VERTICES = 1 << 25 };

/* Bundles that are looked at before most of them turn out to miss the picture:
 * 2.3 GB of them. */
enum { MAX_FEEDS = 1 << 24 };

/* --------------------------------------------------------------------- plan */

struct job {
    struct frame *frame;
    struct glint_feed_config cfg;
};

static struct glint_feed_config feed_config(const struct frame *f, double scale)
{
    return (struct glint_feed_config){f->setup, f->view, scale,
                                      f->dials.fineness, f->uniform};
}

/* All wavelengths of one ghost and lamp. */
static void plan_job(void *ctx, int job, int worker)
{
    struct job *j = ctx;
    const int waves = j->frame->setup->n_wavelengths, middle = waves / 2;
    struct glint_feed *feed = &j->frame->feed[job * waves];

    (void)worker;
    glint_feed_plan(&j->cfg, &feed[middle], NULL);
    for (int wave = 0; wave < waves; wave++)
        if (wave != middle)
            glint_feed_plan(&j->cfg, &feed[wave], &feed[middle]);
}

/* N of them, of which MAX_FEEDS are as many as can be numbered and held. */
static enum glint_status reserve_feeds(struct frame *f, uint64_t n)
{
    struct glint_feed *feed;
    struct glint_vertex **vertices;

    if (n <= (uint64_t)f->max_feeds)
        return GLINT_OK;
    if (n > MAX_FEEDS)
        return GLINT_E_MEMORY;
    feed = realloc(f->feed, (size_t)n * sizeof *feed);
    if (!feed)
        return GLINT_E_MEMORY;
    f->feed = feed;
    vertices = realloc(f->vertices, (size_t)n * sizeof *vertices);
    if (!vertices)
        return GLINT_E_MEMORY;
    f->vertices = vertices;
    f->max_feeds = (int)n;
    return GLINT_OK;
}

/* Ghost or part GHOST is ghost NUMBER. */
static bool is_ghost(const struct glint_setup *s, int ghost, int number)
{
    return s->ghost[ghost].i == s->ghost[number].i &&
           s->ghost[ghost].j == s->ghost[number].j;
}

/* Every ghost, lamp and wavelength that reaches the picture. */
static enum glint_status plan(struct frame *f, const struct glint_lamp *lamps,
                              int n_lamps)
{
    const struct glint_setup *s = f->setup;
    struct job job = {f, feed_config(f, 1)};
    const enum glint_status status =
        reserve_feeds(f, (uint64_t)n_lamps * (uint64_t)s->n_ghosts *
                             (uint64_t)s->n_wavelengths);
    int n = 0, kept = 0;

    if (status != GLINT_OK)
        return status;
    for (int lamp = 0; lamp < n_lamps; lamp++)
        for (int ghost = 0; ghost < s->n_ghosts; ghost++)
            for (int wave = 0; wave < s->n_wavelengths; wave++)
                if (f->only_ghost < 0 || is_ghost(s, ghost, f->only_ghost))
                    f->feed[n++] = (struct glint_feed){.lamp = &lamps[lamp],
                                                       .ghost = ghost,
                                                       .wavelength = wave};
    glint_workers_run(f->cfg.workers, n / s->n_wavelengths, plan_job, &job);
    for (int i = 0; i < n; i++)
        if (f->feed[i].n_cells > 0)
            f->feed[kept++] = f->feed[i];
    f->n_feeds = kept;
    return GLINT_OK;
}

/* What a feed's pupil sends, display white times pixels at scale 1. */
static double flux_of(const struct frame *f, const struct glint_feed *feed)
{
    const struct glint_pupil *p = &feed->pupil;
    const double area = (p->x1_mm - p->x0_mm) * 2 * p->y1_mm;

    return feed->lamp->power * p->energy * area /
           f->setup->unit_flux[feed->wavelength];
}

/* Pixels of the box that its light falls in. */
static double pixels_of(const struct frame *f, const struct glint_feed *feed)
{
    const double *s = feed->pupil.sensor_mm;
    const double pixel = f->view.sensor_width_mm / f->view.width;

    return (s[1] - s[0]) * (s[3] - s[2]) / (pixel * pixel) + 1;
}

enum glint_status frame_feed_scale(struct frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   struct frame_scale *scale)
{
    const enum glint_status status = plan(frame, lamps, n_lamps);
    double brightest = 0, together = 0;

    *scale = (struct frame_scale){0, 0};
    if (status != GLINT_OK)
        return status;
    for (int i = 0; i < frame->n_feeds; i++) {
        const double flux = flux_of(frame, &frame->feed[i]);

        brightest = fmax(brightest, flux / pixels_of(frame, &frame->feed[i]));
        together += flux;
    }
    if (brightest > 0)
        *scale = frame_scale_of((int)ceil(log2(brightest)),
                                (int)ceil(log2(together)));
    return GLINT_OK;
}

/* ------------------------------------------------------------------- memory */

static int larger(int a, int b)
{
    return a > b ? a : b;
}

/* A new block of exactly what was needed so far; the vertices move over. */
static enum glint_status regrow(struct frame *f,
                                const struct glint_feed_config *cfg)
{
    const size_t bytes = glint_flare_bytes(&f->cfg);
    struct glint_flare *flare;
    enum glint_status status;
    void *mem = NULL;

    if (bytes == 0 || posix_memalign(&mem, 64, bytes) != 0)
        return GLINT_E_MEMORY;
    status = glint_flare_init(&flare, &f->cfg, mem, bytes);
    for (int i = 0; i < f->n_feeds && status == GLINT_OK; i++) {
        const int nodes = f->feed[i].n_cells + 1;
        struct glint_bundle bundle;
        struct glint_vertex *to;

        glint_feed_bundle(cfg, &f->feed[i], &bundle);
        to = glint_flare_add(flare, &bundle);
        if (f->vertices[i])
            memcpy(to, f->vertices[i],
                   (size_t)nodes * (size_t)nodes * sizeof *to);
        f->vertices[i] = to;
    }
    free(f->mem);
    f->mem = mem;
    f->bytes = bytes;
    f->flare = flare;
    return status;
}

/* -------------------------------------------------------------------- frame */

static void trace_job(void *ctx, int job, int worker)
{
    struct job *j = ctx;

    (void)worker;
    glint_feed_trace(&j->cfg, &j->frame->feed[job], j->frame->vertices[job]);
}

/* Takes all bundles in; makes room first where there is too little. */
static enum glint_status add_bundles(struct frame *f,
                                     const struct glint_feed_config *cfg)
{
    int vertices = 0;

    f->n_dropped = 0;
    for (int i = 0; i < f->n_feeds; i++) {
        const int n = f->feed[i].n_cells + 1;

        if (i == MAX_BUNDLES || n * n > MAX_VERTICES - vertices) {
            f->n_dropped = f->n_feeds - i; /* the weakest lamps come last */
            f->n_feeds = i;
            break;
        }
        f->vertices[i] = NULL;
        vertices += n * n;
    }
    if (!f->mem || f->n_feeds > f->cfg.max_bundles ||
        vertices > f->cfg.max_vertices) {
        f->cfg.max_bundles = larger(f->cfg.max_bundles, f->n_feeds);
        f->cfg.max_vertices = larger(f->cfg.max_vertices, vertices);
        return regrow(f, cfg);
    }
    glint_flare_begin(f->flare);
    for (int i = 0; i < f->n_feeds; i++) {
        struct glint_bundle bundle;

        glint_feed_bundle(cfg, &f->feed[i], &bundle);
        f->vertices[i] = glint_flare_add(f->flare, &bundle);
    }
    return GLINT_OK;
}

/* Bins, and where something did not fit, once more with room for it. */
static enum glint_status bin(struct frame *f,
                             const struct glint_feed_config *cfg,
                             struct glint_flare_stats *s)
{
    for (;;) {
        enum glint_status status;

        glint_flare_bin(f->flare, s);
        if (s->need_primitives <= f->cfg.max_primitives &&
            s->need_refs <= f->cfg.max_refs &&
            s->need_tile_refs <= f->cfg.max_tile_refs)
            return GLINT_OK;
        f->cfg.max_primitives =
            larger(f->cfg.max_primitives, s->need_primitives);
        f->cfg.max_refs = larger(f->cfg.max_refs, s->need_refs);
        f->cfg.max_tile_refs = larger(f->cfg.max_tile_refs, s->need_tile_refs);
        status = regrow(f, cfg);
        if (status != GLINT_OK)
            return status;
    }
}

/* -------------------------------------------------------------------- frame */

enum glint_status frame_feed_draw(struct frame *frame,
                                  const struct glint_lamp *lamps, int n_lamps,
                                  double scale, const struct glint_image *image,
                                  struct glint_flare_stats *stats,
                                  double times[5])
{
    struct job job = {frame, feed_config(frame, scale)};
    enum glint_status status;

    times[0] = tool_seconds();
    status = plan(frame, lamps, n_lamps);

    if (status == GLINT_OK)
        status = add_bundles(frame, &job.cfg);
    if (status != GLINT_OK)
        return status;
    times[1] = tool_seconds();
    glint_workers_run(frame->cfg.workers, frame->n_feeds, trace_job, &job);
    times[2] = tool_seconds();
    status = bin(frame, &job.cfg, stats);
    if (status != GLINT_OK)
        return status;
    times[3] = tool_seconds();
    glint_flare_draw(frame->flare, image);
    times[4] = tool_seconds();
    stats->dropped_bundles += frame->n_dropped;
    return GLINT_OK;
}
