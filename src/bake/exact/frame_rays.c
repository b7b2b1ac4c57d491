/* SPDX-License-Identifier: MIT
 *
 * Draws a frame of exact rays: plans, traces and adds bundle by bundle. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/frame/block.h"
#include "engine/frame/frame_parts.h"

/* Most bundles of a frame, and most vertices, 0.94 GB. */
enum { MAX_BUNDLES = 65535, MAX_VERTICES = 1 << 25 };

/* Most bundles that are planned, 2.3 GB, before most turn out to miss the
 * picture. */
enum { MAX_PLANNED = 1 << 24 };

/* Parts of the work between which progress is told, and jobs of one at least.
 */
enum { PARTS = 100, LEAST_PART = 16 };

/* Share of planning in the work of a frame, about. */
#define PLAN_SHARE 0.5

/* --------------------------------------------------------------------- plan */

struct traced {
    struct glint_traced_bundle *bundle;
    int n_bundles, max_bundles;
    int n_dropped; /* number of bundles beyond what a frame may take */
    /* Vertices of each traced bundle, in the flare's block. */
    struct glint_vertex **vertices;
};

struct job {
    struct glint_frame *frame;
    struct glint_traced_bundle_config cfg;
    int first; /* number of the first job of a part */
};

/* Runs N jobs, in parts after each of which progress is told: FROM and TO,
 * shares of the frame's work. */
static void run(struct job *job, int n, glint_job_fn *each, double from,
                double to)
{
    const struct glint_frame *f = job->frame;
    const int part = f->progress ? larger(n / PARTS, LEAST_PART) : n;

    for (job->first = 0; job->first < n; job->first += part) {
        const int left = n - job->first;

        glint_workers_run(f->cfg.workers, smaller(part, left), each, job);
        if (f->progress)
            f->progress(f->progress_ctx,
                        from + (to - from) * smaller(job->first + part, n) / n);
    }
}

static struct glint_traced_bundle_config
traced_config(const struct glint_frame *f, double scale)
{
    return (struct glint_traced_bundle_config){
        f->setup,           f->view, scale, f->dials.fineness,
        f->picture.uniform, f->tints};
}

/* Plans all wavelengths of one ghost and lamp. */
static void plan_job(void *ctx, int job, int worker)
{
    struct job *j = ctx;
    const struct traced *const t = j->frame->memory.traced;
    const int waves = j->frame->setup->n_wavelengths, middle = waves / 2;
    struct glint_traced_bundle *traced = &t->bundle[(j->first + job) * waves];

    (void)worker;
    glint_traced_bundle_plan(&j->cfg, &traced[middle], NULL);
    for (int wave = 0; wave < waves; wave++)
        if (wave != middle)
            glint_traced_bundle_plan(&j->cfg, &traced[wave], &traced[middle]);
}

/* Makes room for N bundles to be planned, at most MAX_PLANNED. */
static enum glint_status reserve_feeds(struct glint_frame *f, uint64_t n)
{
    struct traced *const t = f->memory.traced;
    struct glint_traced_bundle *traced;
    struct glint_vertex **vertices;

    if (n <= (uint64_t)t->max_bundles)
        return GLINT_OK;
    if (n > MAX_PLANNED)
        return GLINT_E_MEMORY;
    traced = realloc(t->bundle, (size_t)n * sizeof *traced);
    if (!traced)
        return GLINT_E_MEMORY;
    t->bundle = traced;
    vertices = realloc(t->vertices, (size_t)n * sizeof *vertices);
    if (!vertices)
        return GLINT_E_MEMORY;
    t->vertices = vertices;
    t->max_bundles = (int)n;
    return GLINT_OK;
}

static bool begin(struct glint_frame *f)
{
    if (!f->memory.traced)
        f->memory.traced = calloc(1, sizeof(struct traced));
    return f->memory.traced;
}

/* Returns whether ghost or part GHOST is to be drawn. */
static bool is_wanted(const struct glint_frame *f, int ghost)
{
    return (f->only_ghost < 0 ||
            glint_frame_is_ghost(f->setup, ghost, f->only_ghost)) &&
           (!f->tints || f->tints[ghost].gain.mantissa > 0);
}

/* Plans all bundles, and keeps those that reach the picture. */
static enum glint_status plan(struct glint_frame *f,
                              const struct glint_lamp *lamps, int n_lamps)
{
    struct traced *const t = f->memory.traced;
    const struct glint_setup *s = f->setup;
    struct job job = {f, traced_config(f, 1), 0};
    const enum glint_status status =
        reserve_feeds(f, (uint64_t)n_lamps * (uint64_t)s->n_ghosts *
                             (uint64_t)s->n_wavelengths);
    int n = 0, kept = 0;

    t->n_bundles = 0;
    if (status != GLINT_OK || !t->bundle)
        return status;
    for (int lamp = 0; lamp < n_lamps; lamp++)
        for (int ghost = 0; ghost < s->n_ghosts; ghost++)
            for (int wave = 0; wave < s->n_wavelengths; wave++)
                if (is_wanted(f, ghost))
                    t->bundle[n++] =
                        (struct glint_traced_bundle){.lamp = &lamps[lamp],
                                                     .ghost = ghost,
                                                     .wavelength = wave};
    run(&job, n / s->n_wavelengths, plan_job, 0, PLAN_SHARE);
    for (int i = 0; i < n; i++)
        if (t->bundle[i].n_cells > 0)
            t->bundle[kept++] = t->bundle[i];
    t->n_bundles = kept;
    return GLINT_OK;
}

/* Returns the flux that a traced bundle's pupil sends, display white times
 * pixels at scale 1. */
static double flux_of(const struct glint_frame *f,
                      const struct glint_traced_bundle *traced)
{
    const struct glint_pupil *p = &traced->pupil;
    const double area = (p->x1_mm - p->x0_mm) * glint_pupil_height(p);
    const double gain =
        f->tints ? glint_real_value(f->tints[traced->ghost].gain) : 1;

    return traced->lamp->power * p->energy * area * gain /
           f->setup->unit_flux[traced->wavelength];
}

/* Returns the size in pixels of the box that the bundle's light falls in. */
static double pixels_of(const struct glint_frame *f,
                        const struct glint_traced_bundle *traced)
{
    const double *s = traced->pupil.sensor_mm;
    const double pixel = f->view.sensor_width_mm / f->view.width;

    return (s[1] - s[0]) * (s[3] - s[2]) / (pixel * pixel) + 1;
}

static enum glint_status set_scale(struct glint_frame *frame,
                                   const struct glint_lamp *lamps, int n_lamps,
                                   struct glint_frame_scale *scale)
{
    const enum glint_status status =
        begin(frame) ? plan(frame, lamps, n_lamps) : GLINT_E_MEMORY;
    const struct traced *const t = frame->memory.traced;
    double brightest = 0, together = 0;

    *scale = (struct glint_frame_scale){0, 0};
    if (status != GLINT_OK)
        return status;
    for (int i = 0; i < t->n_bundles; i++) {
        const double flux = flux_of(frame, &t->bundle[i]);

        brightest = fmax(brightest, flux / pixels_of(frame, &t->bundle[i]));
        together += flux;
    }
    if (brightest > 0)
        *scale = glint_frame_scale_of((int)ceil(log2(brightest)),
                                      (int)ceil(log2(together)));
    return GLINT_OK;
}

/* ------------------------------------------------------------------- memory */

/* Moves the flare to a new block for the capacities needed so far, with its
 * vertices. */
static enum glint_status regrow(struct glint_frame *f,
                                const struct glint_traced_bundle_config *cfg)
{
    struct traced *const t = f->memory.traced;
    const size_t bytes = glint_flare_bytes(&f->cfg);
    struct glint_flare *flare;
    enum glint_status status;
    void *mem, *const block = glint_block_take(bytes, &mem);

    if (!block)
        return GLINT_E_MEMORY;
    status = glint_flare_init(&flare, &f->cfg, block, bytes);
    for (int i = 0; i < t->n_bundles && status == GLINT_OK; i++) {
        const int nodes = t->bundle[i].n_cells + 1;
        struct glint_bundle bundle;
        struct glint_vertex *to;

        glint_traced_bundle_make(cfg, &t->bundle[i], &bundle);
        to = glint_flare_add(flare, &bundle);
        if (t->vertices[i])
            memcpy(to, t->vertices[i],
                   (size_t)nodes * (size_t)nodes * sizeof *to);
        t->vertices[i] = to;
    }
    free(f->memory.mem);
    f->memory.mem = mem;
    f->memory.block = block;
    f->memory.bytes = bytes;
    f->memory.flare = flare;
    return status;
}

/* -------------------------------------------------------------------- frame */

static void trace_job(void *ctx, int job, int worker)
{
    struct job *j = ctx;
    const struct traced *const t = j->frame->memory.traced;

    (void)worker;
    job += j->first;
    glint_traced_bundle_trace(&j->cfg, &t->bundle[job], t->vertices[job]);
}

/* Adds all bundles to the flare; makes room first if there is too little. */
static enum glint_status
add_bundles(struct glint_frame *f, const struct glint_traced_bundle_config *cfg)
{
    struct traced *const t = f->memory.traced;
    int vertices = 0;

    t->n_dropped = 0;
    for (int i = 0; i < t->n_bundles; i++) {
        const int n = t->bundle[i].n_cells + 1;

        if (i == MAX_BUNDLES || n * n > MAX_VERTICES - vertices) {
            /* These are of the faintest lamps, if lamps come as they were found
             * or merged. */
            t->n_dropped = t->n_bundles - i;
            t->n_bundles = i;
            break;
        }
        t->vertices[i] = NULL;
        vertices += n * n;
    }
    if (!f->memory.block || t->n_bundles > f->cfg.max_bundles ||
        vertices > f->cfg.max_vertices) {
        f->cfg.max_bundles = larger(f->cfg.max_bundles, t->n_bundles);
        f->cfg.max_vertices = larger(f->cfg.max_vertices, vertices);
        return regrow(f, cfg);
    }
    glint_flare_begin(f->memory.flare);
    for (int i = 0; i < t->n_bundles; i++) {
        struct glint_bundle bundle;

        glint_traced_bundle_make(cfg, &t->bundle[i], &bundle);
        t->vertices[i] = glint_flare_add(f->memory.flare, &bundle);
    }
    return GLINT_OK;
}

/* Bins, and repeats that with more room as long as something does not fit. */
static enum glint_status bin(struct glint_frame *f,
                             const struct glint_traced_bundle_config *cfg,
                             struct glint_flare_stats *s)
{
    for (;;) {
        enum glint_status status;

        glint_flare_bin(f->memory.flare, s);
        if (s->need_primitives <= f->cfg.max_primitives &&
            s->need_refs <= f->cfg.max_refs)
            return GLINT_OK;
        f->cfg.max_primitives =
            larger(f->cfg.max_primitives, s->need_primitives);
        f->cfg.max_refs = larger(f->cfg.max_refs, s->need_refs);
        status = regrow(f, cfg);
        if (status != GLINT_OK)
            return status;
    }
}

/* -------------------------------------------------------------------- frame */

static enum glint_status draw(struct glint_frame *frame,
                              const struct glint_lamp *lamps, int n_lamps,
                              double scale, const struct glint_image *image,
                              struct glint_flare_stats *stats, double times[5])
{
    struct job job = {frame, traced_config(frame, scale), 0};
    enum glint_status status;
    const struct traced *t;

    times[0] = now(frame);
    status = begin(frame) ? plan(frame, lamps, n_lamps) : GLINT_E_MEMORY;
    t = frame->memory.traced;
    if (status == GLINT_OK)
        status = add_bundles(frame, &job.cfg);
    if (status != GLINT_OK)
        return status;
    times[1] = now(frame);
    run(&job, t->n_bundles, trace_job, PLAN_SHARE, 1);
    times[2] = now(frame);
    status = bin(frame, &job.cfg, stats);
    if (status != GLINT_OK)
        return status;
    times[3] = now(frame);
    glint_frame_paint(frame, image);
    times[4] = now(frame);
    stats->dropped_bundles += t->n_dropped;
    return GLINT_OK;
}

static int n_bundles(const struct glint_frame *frame)
{
    const struct traced *const t = frame->memory.traced;

    return t->n_bundles;
}

static int ghost(const struct glint_frame *frame, int bundle)
{
    const struct traced *const t = frame->memory.traced;

    return t->bundle[bundle].ghost;
}

static void finish(struct glint_frame *frame)
{
    struct traced *const t = frame->memory.traced;

    if (t) {
        free(t->bundle);
        free(t->vertices);
    }
    free(t);
    frame->memory.traced = NULL;
}

const struct glint_frame_rays glint_frame_traces = {draw, set_scale, n_bundles,
                                                    ghost, finish};
