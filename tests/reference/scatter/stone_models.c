/* SPDX-License-Identifier: MIT */
#include "reference/scatter/stone_models.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/measure.h"
#include "measure/plots/plot.h"
#include "measure/report_file.h"

enum {
    GAIN = 16,  /* of differences in pictures */
    PANELS = 3, /* of a picture: light, difference, error */
    LEAST = 96  /* pixels of a panel, at least */
};

static const struct {
    const char *words, *file;
    int series;
    enum glint_scatter_candidate_kind kind;
    int terms;
    int more; /* rank of factored, clusters of Peers, 1: Tucker's rows turned */
} listed[STONE_MODELS] = {
    {"clustered, 2 kernels", "clustered-2", 0, GLINT_CANDIDATE_CLUSTERED, 2, 0},
    {"clustered, 4 kernels", "clustered-4", 0, GLINT_CANDIDATE_CLUSTERED, 4, 0},
    {"factored, S 3, rank 3", "factored-3", 1, GLINT_CANDIDATE_FACTORED, 3, 3},
    {"factored, S 5, rank 3", "factored-5", 1, GLINT_CANDIDATE_FACTORED, 5, 3},
    {"albedo x one kernel", "albedo", 2, GLINT_CANDIDATE_ALBEDO, 1, 0},
    {"SVD, S 3", "svd-3", 3, GLINT_CANDIDATE_SVD, 3, 0},
    {"SVD, S 5", "svd-5", 3, GLINT_CANDIDATE_SVD, 5, 0},
    {"SVD, S 10", "svd-10", 3, GLINT_CANDIDATE_SVD, 10, 0},
    {"log-SVD, S 5", "log-svd-5", 4, GLINT_CANDIDATE_LOG_SVD, 5, 0},
    {"log-SVD, S 10", "log-svd-10", 4, GLINT_CANDIDATE_LOG_SVD, 10, 0},
    {"Tucker, T 5", "tucker-5", 5, GLINT_CANDIDATE_TUCKER, 5, 0},
    {"Tucker, T 15", "tucker-15", 5, GLINT_CANDIDATE_TUCKER, 15, 0},
    {"Tucker, T 5, turned", "tucker-turned-5", 6, GLINT_CANDIDATE_TUCKER, 5, 1},
    {"non-negative ALS, S 5", "als-5", 7, GLINT_CANDIDATE_ALS, 5, 0},
    {"Peers, 5 of 5 terms", "peers-5", 8, GLINT_CANDIDATE_PEERS, 5, 5},
    {"Peers, 5 of 10 terms", "peers-10", 8, GLINT_CANDIDATE_PEERS, 10, 5},
    {"SubEdit", "subedit", 9, GLINT_CANDIDATE_SUBEDIT, 1, 0},
};

static struct stone_model model_of(int i)
{
    struct stone_model model = {.words = listed[i].words,
                                .file = listed[i].file,
                                .series = listed[i].series};
    struct glint_scatter_candidate *o = &model.asked;

    glint_scatter_candidate_defaults(o, listed[i].kind);
    o->terms = listed[i].terms;
    if (o->kind == GLINT_CANDIDATE_FACTORED)
        o->rank = listed[i].more;
    if (o->kind == GLINT_CANDIDATE_PEERS)
        o->clusters = listed[i].more;
    o->turned = o->kind == GLINT_CANDIDATE_TUCKER && listed[i].more;
    return model;
}

static enum glint_status judge(const struct tool *tool, struct stone_models *m,
                               struct glint_scatter_rows *rows)
{
    struct tool_progress progress;
    const struct glint_watch watch = {.progress = tool_progress_show,
                                      .ctx = &progress};
    enum glint_status status = GLINT_OK;

    tool_progress_start(&progress, tool, "report");
    for (int k = 0; k < STONE_MODELS && status == GLINT_OK; k++) {
        struct stone_model *model = &m->model[k];

        *model = model_of(k);
        tool_progress_part(&progress, (double)k / STONE_MODELS,
                           1.0 / STONE_MODELS);
        status =
            glint_scatter_judge(rows, &model->asked, &watch, &model->judged);
        if (status == GLINT_OK)
            m->worst = fmax(m->worst, model->judged.largest);
    }
    tool_progress_end(&progress);
    return status;
}

static uint8_t code(double light)
{
    return (uint8_t)lrint(glint_measure_code(light));
}

/* Sets RGB to texel X of a panel: light, difference about grey, error. */
static void pixel(const struct stone_models *m,
                  const struct glint_scatter_judgement *j, int panel, int x,
                  uint8_t rgb[3])
{
    const double peak = m->peak > 0 ? m->peak : 1;
    const double worst = m->worst > 0 ? m->worst : 1;

    for (int c = 0; c < 3; c++) {
        const double got = j->light[3 * x + c] / peak;
        const double off = got - m->light[3 * x + c] / peak;

        rgb[c] =
            panel == 0 ? code(got)
            : panel == 1
                ? (uint8_t)lrint(fmin(255, fmax(0, 128 + 255 * GAIN * off)))
                : code(j->error[x] / worst);
    }
}

/* Writes the panels of a model side by side, texels as squares of pixels. */
static bool picture(const struct stone_models *m,
                    const struct glint_scatter_judgement *j, FILE *file)
{
    const int zoom = m->side < LEAST ? (LEAST + m->side - 1) / m->side : 1;
    const int high = m->side * zoom, wide = PANELS * high;
    uint8_t *rgb = malloc(3 * (size_t)wide * (size_t)high);
    bool good = rgb && j->light && j->error;

    for (int y = 0; good && y < high; y++)
        for (int x = 0; x < wide; x++)
            pixel(m, j, x / high, y / zoom * m->side + x % high / zoom,
                  rgb + 3 * (y * wide + x));
    good = good && plot_png(file, rgb, wide, high);
    free(rgb);
    return good;
}

/* Saves what WRITE or, of MODEL, the picture is, as NAME in FOLDER. */
static int save(const struct tool *tool, const struct stone_models *m,
                const char *folder, const char *name,
                void (*write)(const struct stone_models *, FILE *),
                const struct stone_model *model)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *file = open_memstream(&text, &bytes);
    bool good = true;

    if (!file)
        return tool_fail(tool, GLINT_E_MEMORY, "out of memory");
    if (write)
        write(m, file);
    else
        good = picture(m, &model->judged, file);
    if (good)
        return report_file_save(tool, folder, name, file, &text, &bytes);
    fclose(file);
    free(text);
    return tool_fail(tool, GLINT_E_MEMORY, "out of memory");
}

static int save_all(const struct tool *tool, const struct stone_models *m,
                    const char *folder)
{
    int code = EXIT_OK;

    for (int i = 0; i < STONE_MODELS && code == EXIT_OK; i++) {
        char name[64];

        snprintf(name, sizeof name, "%s.png", m->model[i].file);
        code = save(tool, m, folder, name, NULL, &m->model[i]);
    }
    if (code == EXIT_OK)
        code = save(tool, m, folder, "curves.svg", stone_page_svg, NULL);
    if (code == EXIT_OK)
        code = save(tool, m, folder, "report.md", stone_page_md, NULL);
    if (code == EXIT_OK)
        code = save(tool, m, folder, "report.html", stone_page_html, NULL);
    return code;
}

/* Sets what the full rows show. */
static bool set_light(struct stone_models *m,
                      const struct glint_scatter_rows *rows)
{
    const size_t n = 3 * (size_t)m->side * (size_t)m->side;
    double *lit = malloc(n * sizeof *lit);

    m->light = malloc(n * sizeof *m->light);
    if (lit && m->light) {
        glint_scatter_test_light(m->side, lit);
        glint_scatter_light_rows(rows, lit, m->light);
        for (size_t i = 0; i < n; i++)
            m->peak = fmax(m->peak, m->light[i]);
    }
    free(lit);
    return lit && m->light;
}

int stone_models_report(const struct tool *tool, const char *name,
                        struct glint_scatter_rows *rows, const char *folder)
{
    struct stone_models *m = calloc(1, sizeof *m);
    enum glint_status status = m ? GLINT_OK : GLINT_E_MEMORY;
    int code = EXIT_OK;

    if (!report_file_folder(folder)) {
        free(m);
        return tool_fail(tool, GLINT_E_OUTPUT, strerror(errno));
    }
    if (m) {
        m->name = name;
        m->side = rows->side;
        m->kernel = rows->kernel;
        status = set_light(m, rows) ? judge(tool, m, rows) : GLINT_E_MEMORY;
    }
    if (status == GLINT_OK)
        code = save_all(tool, m, folder);
    else
        code = tool_fail(tool, status, glint_status_text(status));
    for (int i = 0; m && i < STONE_MODELS; i++)
        glint_scatter_judgement_close(&m->model[i].judged);
    if (m)
        free(m->light);
    free(m);
    return code;
}
